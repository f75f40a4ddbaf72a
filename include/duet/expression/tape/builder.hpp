// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/type_id.hpp>
#include <duet/expression/tree/exact_rules.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/printed.hpp>

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

/// \file
/// The tape of a formula while it is built: one entry for each different operation, operands first,
/// with exact simplifications, which are decided on data. They hold for all finite numbers: those
/// of 0, 1 and signs, exact arithmetic of numbers, and zeros of matrices.

namespace duet::expression::detail {

/// Entries that the algebra of the tape distinguishes.
enum class tape_code {
  zero, ///< of any kind
  number,
  input,       ///< symbol or constant
  unit_vector, ///< along an axis
  negative,
  sum,
  difference,
  product,
  quotient,
  slope_product,
  conj,
  transpose,
  trace,
  trace_of_product,
  matrix_product,
  entries,        ///< matrix of scalars, row by row
  power,          ///< by an integer
  component,      ///< of a column
  block,          ///< of a matrix
  embedded_block, ///< matrix of zeros with a block
  sine,
  cosine,
  other, ///< a leaf or an operation of its own
  sines  ///< in a program: all sines and cosines of a stage
};

class tape_builder;
struct tape_motion;

/// Makes the rate of an entry with operands x.
using tape_rate = int (*)(tape_builder& tape, const int* x, tape_motion& motion);
/// Text of an entry, whose operands are given as text.
using tape_print = printed (*)(notation style, const printed* x);

/// Operation or leaf that the algebra does not know.
struct tape_operation {
  const duet::detail::type_mark* id = nullptr;
  unsigned hash = 0;
  bool drops_dual = false; ///< true for parts of dual numbers, whose values are not dual
  int order = 0;           ///< number of times that rates can be made
  tape_rate rate = nullptr;
  tape_print print = nullptr; ///< if the tape is printed
};

/// One operation, number or input.
struct tape_entry {
  tape_code code;
  kind kind_of;
  int parameter; ///< exponent of a power, index of an input or component, 8 I + J of a block
  int first;     ///< index of the first operand in the list of operands
  int count;     ///< of operands
  int next;      ///< entry with the same hash
  int head;      ///< 1 + the last entry whose hash leads to this one, 0 without
  double number;
  const tape_operation* operation;
};

/// A node of the written formula that is on the tape.
struct tape_memo {
  unsigned hash;
  const duet::detail::type_mark* id;
  int entry;
  int order; ///< number of times that its rates can be made
  int next;
  int head; ///< as of an entry
};

/// Numbers of what is on a tape.
struct tape_counts {
  int size = 0; ///< entries
  int operand_count = 0;
  int memo_count = 0;
  bool is_full = false; ///< true if the tape needs more memory
};

/// Memory of a tape, as arrays or as vectors.
template <class Entries, class Operands, class Memos>
struct tape_lists : tape_counts {
  Entries entries = {};
  Operands operands = {}; ///< four for each entry
  Memos memos = {};       ///< one for each entry
};
/// Memory of a tape at compile time.
template <int Capacity>
using tape_memory = tape_lists<tape_entry[std::size_t(Capacity)], int[std::size_t(4 * Capacity)],
                               tape_memo[std::size_t(Capacity)]>;
/// Memory of a tape at run time.
using tape_vectors = tape_lists<std::vector<tape_entry>, std::vector<int>, std::vector<tape_memo>>;

/// Whole numbers, 0 at first, one for each entry of a tape.
class tape_numbers {
public:
  constexpr explicit tape_numbers(int size) : values_(new int[std::size_t(size)]()) {}
  tape_numbers(const tape_numbers&) = delete;
  tape_numbers& operator=(const tape_numbers&) = delete;
  constexpr ~tape_numbers() { delete[] values_; }
  [[nodiscard]] constexpr int& operator[](int i) const { return values_[i]; }

private:
  int* values_;
};

/// A tape that grows. Entries are indices; entry 0 is the scalar zero, entry 1 the number 1.
class tape_builder : public exact_rules<tape_builder, tape_code> {
public:
  /// Continues the tape in a memory.
  template <class Memory>
  constexpr explicit tape_builder(Memory& memory, bool is_printed = false)
      : counts_(memory), entries_(std::data(memory.entries)), operands_(std::data(memory.operands)),
        memos_(std::data(memory.memos)), capacity_(int(std::size(memory.entries))),
        is_printed_(is_printed) {
    if (size() == 0) {
      static_cast<void>(zero(kind::scalar));
      static_cast<void>(number(1));
    }
  }

  [[nodiscard]] constexpr int size() const { return counts_.size; }
  [[nodiscard]] constexpr int capacity() const { return capacity_; }
  [[nodiscard]] constexpr const tape_entry& operator[](int i) const { return entries_[i]; }
  [[nodiscard]] constexpr int operand(int i, int k) const {
    return operands_[entries_[i].first + k];
  }
  [[nodiscard]] constexpr const int* operands(int i) const { return operands_ + entries_[i].first; }
  [[nodiscard]] constexpr tape_code code(int i) const { return entries_[i].code; }
  [[nodiscard]] constexpr bool is_zero(int i) const { return entries_[i].code == tape_code::zero; }

  [[nodiscard]] constexpr kind kind_of(int i) const { return entries_[i].kind_of; }
  [[nodiscard]] constexpr bool is_number(int i) const {
    return code(i) == tape_code::number || i == 0;
  }
  /// The value of a number.
  [[nodiscard]] constexpr double value(int i) const { return entries_[i].number; }

  [[nodiscard]] constexpr int zero(kind k) {
    return add(tape_code::zero, k, 0, 0, nullptr, nullptr, 0);
  }
  [[nodiscard]] constexpr int number(double x) {
    return x == 0 ? 0 : add(tape_code::number, kind::scalar, 0, x, nullptr, nullptr, 0);
  }
  /// The unit vector along an axis.
  [[nodiscard]] constexpr int unit_vector(kind k, int axis) {
    return add(tape_code::unit_vector, k, axis, 0, nullptr, nullptr, 0);
  }
  [[nodiscard]] constexpr int input(kind k, int index) {
    return add(tape_code::input, k, index, 0, nullptr, nullptr, 0);
  }
  [[nodiscard]] constexpr int other(kind k, const tape_operation& operation, const int* x,
                                    int count) {
    return add(tape_code::other, k, 0, 0, &operation, x, count);
  }
  /// x^n
  [[nodiscard]] constexpr int power(int x, int n) {
    return n == 0 || x == 1 ? 1 : n == 1 ? x : plain(tape_code::power, kind_of(x), x, n);
  }

  [[nodiscard]] constexpr int negative(int a) {
    const int simple = simplified_negative(a);
    return simple >= 0                            ? simple
           : code(a) == tape_code::difference     ? difference(operand(a, 1), operand(a, 0))
           : code(a) == tape_code::embedded_block ? embedded_like(a, negative(operand(a, 0)))
                                                  : plain(tape_code::negative, kind_of(a), a);
  }

  [[nodiscard]] constexpr int sum(int a, int b) {
    const int simple = simplified_sum(a, b);
    return simple >= 0 ? simple
           : is_of_number_and(a, tape_code::sum, b) // doubling is exact
               ? sum(operand(a, 0), product(number(2), b))
               : is_of_number_and(b, tape_code::sum, a)
                     ? sum(operand(b, 0), product(number(2), a))
                     : plain_of_two(tape_code::sum, kind_of(a), a, b);
  }

  [[nodiscard]] constexpr int difference(int a, int b) {
    const int simple = simplified_difference(a, b);
    return simple >= 0 ? simple
           : a == b    ? zero(kind_of(a))
           : is_of_number_and(a, tape_code::difference, b)
               ? difference(operand(a, 0), product(number(2), b))
               : plain_of_two(tape_code::difference, kind_of(a), a, b);
  }

  [[nodiscard]] constexpr int product(int a, int b) {
    const kind of_a = kind_of(a), of_b = kind_of(b);
    if (is_matrix(of_a) && is_matrix(of_b)) {
      return matrix_product(a, b);
    }
    if (of_b == kind::scalar && of_a != kind::scalar) {
      return product(b, a);
    }
    if (is_zero(a) || is_zero(b)) {
      return zero(of_b);
    }
    if (code(b) == tape_code::embedded_block) {
      return embedded_like(b, product(a, operand(b, 0)));
    }
    if (const int simple = simplified_product(a, b); simple >= 0) {
      return simple;
    }
    if (!is_number(a)) {
      if (has_leading_number(a)) {
        return product(operand(a, 0), product(operand(a, 1), b));
      }
      if (has_leading_number(b)) {
        return product(operand(b, 0), product(a, operand(b, 1)));
      }
      if (is_inverse(a)) {
        return quotient(b, operand(a, 1));
      }
      if (is_inverse(b)) {
        return quotient(a, operand(b, 1));
      }
      const int m = exponent(a), n = exponent(b);
      const int base = m == 1 ? a : operand(a, 0);
      if (of_b == kind::scalar && base == (n == 1 ? b : operand(b, 0)) && m > 0 && n > 0) {
        return power(base, m + n);
      }
    }
    return plain_of_two(tape_code::product, of_b, a, b);
  }

  [[nodiscard]] constexpr int quotient(int a, int b) {
    if (code(a) == tape_code::embedded_block) {
      return embedded_like(a, quotient(operand(a, 0), b));
    }
    if (const int simple = simplified_quotient(a, b); simple >= 0) {
      return simple;
    }
    if (!is_number(b) || !is_divided_exactly(a, b)) {
      return plain_of_two(tape_code::quotient, kind_of(a), a, b);
    }
    if (code(a) == tape_code::sum) { // (4 x + 2)/2 becomes 2 x + 1
      return sum(quotient(operand(a, 0), b), quotient(operand(a, 1), b));
    }
    if (code(a) == tape_code::difference) {
      return difference(quotient(operand(a, 0), b), quotient(operand(a, 1), b));
    }
    return product(quotient(operand(a, 0), b), operand(a, 1));
  }

  /// Slope times rate; a product if the tape is printed.
  [[nodiscard]] constexpr int slope_product(int a, int b) {
    if (is_printed_) {
      return product(a, b);
    }
    const tape_code x = code(a), y = code(b);
    if (x == tape_code::zero || y == tape_code::zero) {
      return 0;
    }
    if (x == tape_code::number || y == tape_code::number) {
      return product(a, b);
    }
    if (x == tape_code::negative) {
      return negative(slope_product(operand(a, 0), b));
    }
    if (y == tape_code::negative) {
      return negative(slope_product(a, operand(b, 0)));
    }
    if (has_small_number(a)) {
      return product(operand(a, 0), slope_product(operand(a, 1), b));
    }
    if (has_small_number(b)) {
      return product(operand(b, 0), slope_product(a, operand(b, 1)));
    }
    return plain_of_two(tape_code::slope_product, kind::scalar, a, b);
  }

  [[nodiscard]] constexpr int sine(int x) {
    return code(x) == tape_code::negative ? negative(sine(operand(x, 0)))
                                          : plain(tape_code::sine, kind::scalar, x);
  }
  [[nodiscard]] constexpr int cosine(int x) {
    return code(x) == tape_code::negative ? cosine(operand(x, 0))
                                          : plain(tape_code::cosine, kind::scalar, x);
  }

  /// Conjugate of a quaternion or pose.
  [[nodiscard]] constexpr int conj(int q) {
    return is_zero(q)                   ? q
           : code(q) == tape_code::conj ? operand(q, 0)
                                        : plain(tape_code::conj, kind_of(q), q);
  }

  // Matrices. Those of zeros with a block are products, sums and so on of that block.

  /// Matrix of scalars, which are given row by row.
  [[nodiscard]] constexpr int entries(kind size, const int* x) {
    const int count = rows_of(size) * columns_of(size);
    bool is_zero_matrix = true;
    for (int i = 0; i < count; ++i) {
      is_zero_matrix = is_zero_matrix && is_zero(x[i]);
    }
    return is_zero_matrix ? zero(size) : add(tape_code::entries, size, 0, 0, nullptr, x, count);
  }

  /// The I-th component of a column.
  [[nodiscard]] constexpr int component(int v, int i) {
    const tape_entry& e = entries_[v];
    return e.code == tape_code::zero          ? 0
           : e.code == tape_code::unit_vector ? number(e.parameter == i ? 1 : 0)
           : is_sized_matrix(e.kind_of)       ? block(v, kind::scalar, i, 0)
                                              : plain(tape_code::component, kind::scalar, v, i);
  }

  /// Matrix of a size, with a block x that begins at (i, j), and 0 elsewhere.
  [[nodiscard]] constexpr int embedded_block(int x, kind size, int i, int j) {
    if (kind_of(x) == size || is_zero(x)) {
      return is_zero(x) ? zero(size) : x;
    }
    return size == kind::vector && kind_of(x) == kind::scalar
               ? product(x, unit_vector(kind::vector, i))
               : plain(tape_code::embedded_block, size, x, 8 * i + j);
  }

  /// Block of a size that begins at (i, j).
  [[nodiscard]] constexpr int block(int m, kind size, int i, int j) {
    const tape_entry& e = entries_[m];
    if (e.kind_of == size) {
      return m;
    }
    if (e.code == tape_code::zero) {
      return zero(size);
    }
    if (is_scaled(m)) {
      return scaled_like(m, block(operand_without_scale(m), size, i, j));
    }
    if (e.code == tape_code::transpose) {
      return transpose(block(operand(m, 0), matrix_kind(columns_of(size), rows_of(size)), j, i));
    }
    if (is_sparse(m)) { // intersection of this block with the one outside of which m is 0
      const sparse_matrix s = sparsity(m);
      const int top = greater(i, s.row), bottom = less(i + rows_of(size), s.row + s.rows);
      const int left = greater(j, s.column),
                right = less(j + columns_of(size), s.column + s.columns);
      return top >= bottom || left >= right
                 ? zero(size)
                 : embedded_block(block(s.block, matrix_kind(bottom - top, right - left),
                                        top - s.row, left - s.column),
                                  size, top - i, left - j);
    }
    if (e.code == tape_code::block) {
      return block(operand(m, 0), size, i + e.parameter / 8, j + e.parameter % 8);
    }
    if (size == kind::scalar && e.code == tape_code::entries) {
      return operand(m, i * columns_of(e.kind_of) + j);
    }
    if (size == kind::scalar && columns_of(e.kind_of) == 1) {
      return plain(tape_code::component, size, m, i);
    }
    return plain(tape_code::block, size, m, 8 * i + j);
  }

  [[nodiscard]] constexpr int transpose(int m) {
    const tape_entry& e = entries_[m];
    const kind size = matrix_kind(columns_of(e.kind_of), rows_of(e.kind_of));
    if (e.kind_of == kind::scalar) {
      return m;
    }
    if (e.code == tape_code::zero) {
      return zero(size);
    }
    if (e.code == tape_code::transpose) {
      return operand(m, 0);
    }
    if (is_scaled(m)) {
      return scaled_like(m, transpose(operand_without_scale(m)));
    }
    if (is_sparse(m)) {
      const sparse_matrix s = sparsity(m);
      return embedded_block(transpose(s.block), size, s.column, s.row);
    }
    return plain(tape_code::transpose, size, m);
  }

  [[nodiscard]] constexpr int matrix_product(int a, int b) {
    const int rows = rows_of(kind_of(a)), columns = columns_of(kind_of(b));
    const kind size = matrix_kind(rows, columns);
    if (is_zero(a) || is_zero(b)) {
      return zero(size);
    }
    if (is_scaled(a)) {
      return scaled_like(a, product(operand_without_scale(a), b));
    }
    if (is_scaled(b)) {
      return scaled_like(b, product(a, operand_without_scale(b)));
    }
    // Only those rows or columns of a factor that meet the block of the other one are multiplied.
    if (is_sparse(a)) {
      const sparse_matrix s = sparsity(a);
      return embedded_block(
          product(s.block, block(b, matrix_kind(s.columns, columns), s.column, 0)), size, s.row, 0);
    }
    if (is_sparse(b)) {
      const sparse_matrix s = sparsity(b);
      return embedded_block(product(block(a, matrix_kind(rows, s.rows), 0, s.row), s.block), size,
                            0, s.column);
    }
    return plain_of_two(tape_code::matrix_product, size, a, b);
  }

  [[nodiscard]] constexpr int trace(int m) {
    const tape_entry& e = entries_[m];
    if (e.kind_of == kind::scalar) {
      return m;
    }
    if (is_scaled(m)) {
      return scaled_like(m, trace(operand_without_scale(m)));
    }
    switch (e.code) {
    case tape_code::zero:
      return 0;
    case tape_code::transpose:
      return trace(operand(m, 0));
    case tape_code::matrix_product:
      return trace_of_product(operand(m, 0), operand(m, 1));
    case tape_code::embedded_block: { // trace of the part of the block on the diagonal
      const sparse_matrix s = sparsity(m);
      const int begin = greater(s.row, s.column);
      const int size = less(s.row + s.rows, s.column + s.columns) - begin;
      return size <= 0
                 ? 0
                 : trace(block(s.block, matrix_kind(size, size), begin - s.row, begin - s.column));
    }
    default:
      return plain(tape_code::trace, kind::scalar, m);
    }
  }
  /// tr(A B), without computing A B.
  [[nodiscard]] constexpr int trace_of_product(int a, int b) {
    if (is_zero(a) || is_zero(b)) {
      return 0;
    }
    if (is_scaled(a) || is_scaled(b) || is_sparse(a)) {
      return trace(product(a, b));
    }
    return is_sparse(b) ? trace(product(b, a))
                        : plain_of_two(tape_code::trace_of_product, kind::scalar, a, b);
  }

  // Scales of what a linear operation is applied to.

  /// True for −x, s x and x/s.
  [[nodiscard]] constexpr bool is_scaled(int i) const {
    const tape_code c = code(i);
    return c == tape_code::negative || c == tape_code::quotient ||
           (c == tape_code::product && kind_of(operand(i, 0)) == kind::scalar);
  }
  [[nodiscard]] constexpr int operand_without_scale(int i) const {
    return operand(i, code(i) == tape_code::product ? 1 : 0);
  }
  /// x with the scale of an entry.
  [[nodiscard]] constexpr int scaled_like(int i, int x) {
    return code(i) == tape_code::negative  ? negative(x)
           : code(i) == tape_code::product ? product(operand(i, 0), x)
                                           : quotient(x, operand(i, 1));
  }

  /// Entry of a node of the written formula, or −1 if it is not on the tape with rates of an order.
  [[nodiscard]] constexpr int recalled(unsigned hash, const duet::detail::type_mark* id,
                                       int order) const {
    for (int i = memos_[hash % unsigned(capacity_)].head - 1; i >= 0; i = memos_[i].next) {
      if (memos_[i].hash == hash && duet::detail::is_same_type(memos_[i].id, id) &&
          memos_[i].order >= order) {
        return memos_[i].entry;
      }
    }
    return -1;
  }
  constexpr int remember(unsigned hash, const duet::detail::type_mark* id, int order, int entry) {
    if (counts_.memo_count == capacity_) {
      counts_.is_full = true;
      return entry;
    }
    int& head = memos_[hash % unsigned(capacity_)].head;
    tape_memo& memo = memos_[counts_.memo_count];
    memo = {hash, id, entry, order, head - 1, memo.head};
    head = ++counts_.memo_count;
    return entry;
  }

  /// An operation that the algebra knows, by its code, with a result of a kind.
  [[nodiscard]] constexpr int apply(tape_code c, kind k, int parameter, const int* x) {
    switch (c) {
    case tape_code::negative:
      return negative(x[0]);
    case tape_code::sum:
      return sum(x[0], x[1]);
    case tape_code::difference:
      return difference(x[0], x[1]);
    case tape_code::quotient:
      return quotient(x[0], x[1]);
    case tape_code::slope_product:
      return slope_product(x[0], x[1]);
    case tape_code::conj:
      return conj(x[0]);
    case tape_code::transpose:
      return transpose(x[0]);
    case tape_code::trace:
      return trace(x[0]);
    case tape_code::trace_of_product:
      return trace_of_product(x[0], x[1]);
    case tape_code::entries:
      return entries(k, x);
    case tape_code::power:
      return power(x[0], parameter);
    case tape_code::component:
      return component(x[0], parameter);
    case tape_code::block:
      return block(x[0], k, parameter / 8, parameter % 8);
    case tape_code::embedded_block:
      return embedded_block(x[0], k, parameter / 8, parameter % 8);
    case tape_code::sine:
      return sine(x[0]);
    case tape_code::cosine:
      return cosine(x[0]);
    default: // products
      return product(x[0], x[1]);
    }
  }

  /// Rate of an operation, of whose operands at least one has a rate other than zero.
  [[nodiscard]] constexpr int rate(int i, tape_motion& motion, const tape_numbers& rates) {
    const tape_entry e = entries_[i];
    const int* x = operands_ + e.first;
    if (e.code == tape_code::other) {
      return e.operation->rate(*this, x, motion);
    }
    int dx[36] = {};
    for (int k = 0; k < e.count; ++k) {
      dx[k] = rates[x[k]];
    }
    switch (e.code) {
    case tape_code::sine:
      return product(cosine(x[0]), dx[0]);
    case tape_code::cosine:
      return product(negative(sine(x[0])), dx[0]);
    case tape_code::power:
      return e.parameter == 2
                 ? product(product(number(2), x[0]), dx[0])
                 : slope_product(product(number(e.parameter), power(x[0], e.parameter - 1)), dx[0]);
    case tape_code::quotient:
      return quotient(is_zero(dx[1]) ? dx[0] : difference(dx[0], product(dx[1], i)), x[1]);
    case tape_code::product:
    case tape_code::matrix_product:
    case tape_code::trace_of_product:
    case tape_code::slope_product: {
      const int first[] = {dx[0], x[1]}, second[] = {x[0], dx[1]};
      return sum(apply(e.code, e.kind_of, 0, first), apply(e.code, e.kind_of, 0, second));
    }
    default: // linear in all operands together
      return apply(e.code, e.kind_of, e.parameter, dx);
    }
  }

private:
  /// An operation that the algebra knows, as it is.
  [[nodiscard]] constexpr int plain(tape_code code, kind k, int a, int parameter = 0) {
    return add(code, k, parameter, 0, nullptr, &a, 1);
  }
  [[nodiscard]] constexpr int plain_of_two(tape_code code, kind k, int a, int b) {
    const int x[] = {a, b};
    return add(code, k, 0, 0, nullptr, x, 2);
  }

  [[nodiscard]] constexpr int add(tape_code code, kind k, int parameter, double number,
                                  const tape_operation* operation, const int* x, int count) {
    unsigned hash = (unsigned(code) * 31 + unsigned(k)) * 31 + unsigned(parameter) +
                    (code == tape_code::other ? operation->hash : 0);
    if (code == tape_code::number) {
      const std::uint64_t bits = bits_of(number);
      hash += unsigned(bits >> 48);
    }
    for (int i = 0; i < count; ++i) {
      hash = hash * 37 + unsigned(x[i]);
    }
    int& head = entries_[hash % unsigned(capacity_)].head;
    for (int i = head - 1; i >= 0; i = entries_[i].next) {
      tape_entry& e = entries_[i];
      if (e.code == code && is_equal(e, k, parameter, number, operation, x, count)) {
        if (code == tape_code::other && operation->order > e.operation->order) {
          e.operation = operation;
        }
        return i;
      }
    }
    if (size() == capacity_ || counts_.operand_count + count > 4 * capacity_) {
      counts_.is_full = true;
      return 0;
    }
    tape_entry& e = entries_[size()];
    e = {code, k, parameter, counts_.operand_count, count, head - 1, e.head, number, operation};
    for (int i = 0; i < count; ++i) {
      operands_[counts_.operand_count++] = x[i];
    }
    head = ++counts_.size;
    return head - 1;
  }
  [[nodiscard]] constexpr bool is_equal(const tape_entry& e, kind k, int parameter, double number,
                                        const tape_operation* operation, const int* x,
                                        int count) const {
    if (e.count != count || e.kind_of != k || e.parameter != parameter || e.number != number ||
        (e.code == tape_code::other &&
         (e.operation->hash != operation->hash ||
          !duet::detail::is_same_type(e.operation->id, operation->id)))) {
      return false;
    }
    for (int i = 0; i < count; ++i) {
      if (operands_[e.first + i] != x[i]) {
        return false;
      }
    }
    return true;
  }

  [[nodiscard]] static constexpr int greater(int a, int b) { return a > b ? a : b; }
  [[nodiscard]] static constexpr int less(int a, int b) { return a < b ? a : b; }

  /// Block of a matrix outside of which all entries are known to be 0.
  struct sparse_matrix {
    int block, row, column, rows, columns;
  };
  [[nodiscard]] constexpr bool is_sparse(int i) const {
    return code(i) == tape_code::embedded_block ||
           (code(i) == tape_code::unit_vector && kind_of(i) == kind::vector);
  }
  [[nodiscard]] constexpr sparse_matrix sparsity(int i) const {
    const int p = entries_[i].parameter;
    if (code(i) == tape_code::unit_vector) {
      return {1, p, 0, 1, 1};
    }
    const int x = operand(i, 0);
    return {x, p / 8, p % 8, rows_of(kind_of(x)), columns_of(kind_of(x))};
  }
  /// The matrix of zeros with a block x at the position of the one of an entry.
  [[nodiscard]] constexpr int embedded_like(int i, int x) {
    const int p = entries_[i].parameter;
    return embedded_block(x, kind_of(i), p / 8, p % 8);
  }

  [[nodiscard]] constexpr bool has_small_number(int i) const {
    if (code(i) != tape_code::product) {
      return false;
    }
    const tape_entry& n = entries_[operand(i, 0)];
    return n.code == tape_code::number && n.number >= 1 && n.number <= 16 &&
           n.number == int(n.number);
  }
  [[nodiscard]] constexpr bool has_leading_number(int i) const {
    return has_small_number(i) || (code(i) == tape_code::product &&
                                   entries_[i].kind_of != kind::scalar && is_number(operand(i, 0)));
  }
  [[nodiscard]] constexpr bool is_inverse(int i) const {
    return code(i) == tape_code::quotient && operand(i, 0) == 1;
  }
  [[nodiscard]] constexpr int exponent(int i) const {
    return code(i) == tape_code::power ? entries_[i].parameter : 1;
  }
  [[nodiscard]] constexpr bool is_of_number_and(int i, tape_code code_of_i, int u) const {
    if (code(i) != code_of_i || operand(i, 1) != u) {
      return false;
    }
    const tape_entry& n = entries_[operand(i, 0)];
    return n.code == tape_code::number ||
           (n.code == tape_code::input && n.kind_of == kind::scalar && n.parameter < 0);
  }
  [[nodiscard]] constexpr bool is_divided_exactly(int a, int b) const {
    switch (code(a)) {
    case tape_code::zero:
    case tape_code::number:
      return is_quotient_exact(value(a), value(b));
    case tape_code::product:
    case tape_code::negative:
      return is_divided_exactly(operand(a, 0), b);
    case tape_code::sum:
    case tape_code::difference:
      return is_divided_exactly(operand(a, 0), b) && is_divided_exactly(operand(a, 1), b);
    default:
      return false;
    }
  }

  tape_counts& counts_;
  tape_entry* entries_;
  int* operands_;
  tape_memo* memos_;
  int capacity_;
  bool is_printed_; ///< true if derivatives of functions are formulas of other functions
};

/// Marks the operands of all marked entries, from the last-th down.
constexpr void mark_operands(const tape_builder& tape, auto& is_marked, int last) {
  for (int i = last; i >= 0; --i) {
    for (int k = 0; is_marked[i] != 0 && k < tape[i].count; ++k) {
      is_marked[tape.operand(i, k)] = 1;
    }
  }
}

} // namespace duet::expression::detail
