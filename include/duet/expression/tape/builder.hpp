// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/tree/exact.hpp>
#include <duet/expression/tree/node.hpp>

#include <cstddef>
#include <cstdint>

/// \file
/// The tape of a formula while it is built, at compile time: one entry for each different node,
/// operands first, with the simplifications of scalar arithmetic decided on data.

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
  power, ///< by an integer
  sine,
  cosine,
  other, ///< a leaf or an operation of its own
  sines  ///< in a program: all sines and cosines of a stage
};

class tape_builder;

/// Makes the rate of an entry: x are the indices of its operands, rates those of the rates of all
/// entries.
using tape_rate = int (*)(tape_builder& tape, const int* x, const int* rates);

/// Identity of an operation or leaf that the algebra does not know.
struct tape_operation {
  const char* id = nullptr;
  unsigned hash = 0;
  tape_rate rate = nullptr;
  bool drops_dual = false; ///< true for parts of dual numbers, whose values are not dual
};

/// One operation, number or input.
struct tape_entry {
  tape_code code;
  kind kind_of;
  int parameter; ///< the exponent of a power, the index of an input
  int first;     ///< index of the first operand in the list of operands
  int count;     ///< of operands
  int next;      ///< entry with the same hash
  double number;
  tape_operation operation;
};

/// A node of the written formula that is on the tape.
struct tape_memo {
  unsigned hash;
  const char* id;
  int entry;
  int next;
};

/// Memory of a tape.
template <int Capacity>
struct tape_memory {
  tape_entry entries[std::size_t(Capacity)] = {};
  int operands[std::size_t(4 * Capacity)] = {};
  int table[std::size_t(Capacity)] = {};
  tape_memo memos[std::size_t(Capacity)] = {};
  int memo_table[std::size_t(Capacity)] = {};
  int size = 0;
  int operand_count = 0;
  int memo_count = 0;
  bool is_full = false; ///< true if the tape needs more memory
};

/// A tape that grows. Entries are indices; entry 0 is the scalar zero, entry 1 the number 1.
class tape_builder {
public:
  /// Continues the tape in a memory.
  template <int Capacity>
  constexpr explicit tape_builder(tape_memory<Capacity>& memory)
      : entries_(memory.entries), operands_(memory.operands), table_(memory.table),
        memos_(memory.memos), memo_table_(memory.memo_table), capacity_(Capacity),
        memo_count_(memory.memo_count), size_(memory.size), operand_count_(memory.operand_count),
        is_full_(memory.is_full) {
    if (size_ == 0) {
      static_cast<void>(zero(kind::scalar));
      static_cast<void>(number(1));
    }
  }
  /// Writes the sizes into the memory.
  template <int Capacity>
  constexpr void finish(tape_memory<Capacity>& memory) const {
    memory.memo_count = memo_count_;
    memory.size = size_;
    memory.operand_count = operand_count_;
    memory.is_full = is_full_;
  }

  [[nodiscard]] constexpr int size() const { return size_; }
  [[nodiscard]] constexpr const tape_entry& operator[](int i) const { return entries_[i]; }
  [[nodiscard]] constexpr int operand(int i, int k) const {
    return operands_[entries_[i].first + k];
  }
  [[nodiscard]] constexpr const int* operands(int i) const { return operands_ + entries_[i].first; }
  [[nodiscard]] constexpr tape_code code(int i) const { return entries_[i].code; }
  [[nodiscard]] constexpr bool is_zero(int i) const { return entries_[i].code == tape_code::zero; }

  [[nodiscard]] constexpr int zero(kind k) { return add(tape_code::zero, k, 0, 0, {}, nullptr, 0); }
  [[nodiscard]] constexpr int number(double x) {
    return x == 0 ? 0 : add(tape_code::number, kind::scalar, 0, x, {}, nullptr, 0);
  }
  /// The unit vector along an axis.
  [[nodiscard]] constexpr int unit_vector(kind k, int axis) {
    return add(tape_code::unit_vector, k, axis, 0, {}, nullptr, 0);
  }
  [[nodiscard]] constexpr int input(kind k, int index) {
    return add(tape_code::input, k, index, 0, {}, nullptr, 0);
  }
  [[nodiscard]] constexpr int other(kind k, tape_operation operation, const int* x, int count) {
    return add(tape_code::other, k, 0, 0, operation, x, count);
  }
  /// An operation that the algebra knows, as it is.
  [[nodiscard]] constexpr int plain(tape_code code, kind k, int a) {
    return add(code, k, 0, 0, {}, &a, 1);
  }
  [[nodiscard]] constexpr int plain(tape_code code, kind k, int a, int b) {
    const int x[] = {a, b};
    return add(code, k, 0, 0, {}, x, 2);
  }
  /// x^n
  [[nodiscard]] constexpr int power(int x, int n) {
    return n == 1 ? x : add(tape_code::power, entries_[x].kind_of, n, 0, {}, &x, 1);
  }

  [[nodiscard]] constexpr int negative(int a) {
    const tape_entry& e = entries_[a];
    switch (e.code) {
    case tape_code::zero:
      return a;
    case tape_code::number:
      return number(-e.number);
    case tape_code::negative:
      return operand(a, 0);
    case tape_code::difference:
      return difference(operand(a, 1), operand(a, 0));
    case tape_code::product:
      if (is_number(operand(a, 0))) {
        return product(negative(operand(a, 0)), operand(a, 1));
      }
      break;
    default:
      break;
    }
    return plain(tape_code::negative, e.kind_of, a);
  }

  [[nodiscard]] constexpr int sum(int a, int b) {
    const tape_entry& x = entries_[a];
    const tape_entry& y = entries_[b];
    if (x.code == tape_code::zero) {
      return b;
    }
    if (y.code == tape_code::zero) {
      return a;
    }
    if (x.code == tape_code::number && y.code == tape_code::number &&
        is_sum_exact(x.number, y.number)) {
      return number(x.number + y.number);
    }
    if (a == b) {
      return product(number(2), a);
    }
    if (is_of_number_and(a, tape_code::sum, b)) {
      return sum(operand(a, 0), product(number(2), b)); // doubling is exact
    }
    if (is_of_number_and(b, tape_code::sum, a)) {
      return sum(operand(b, 0), product(number(2), a));
    }
    if (starts_with_minus(b)) {
      return difference(a, negative(b));
    }
    if (x.code == tape_code::negative) {
      return difference(b, negative(a));
    }
    return plain(tape_code::sum, x.kind_of, a, b);
  }

  [[nodiscard]] constexpr int difference(int a, int b) {
    const tape_entry& x = entries_[a];
    const tape_entry& y = entries_[b];
    if (x.code == tape_code::zero) {
      return negative(b);
    }
    if (y.code == tape_code::zero) {
      return a;
    }
    if (x.code == tape_code::number && y.code == tape_code::number &&
        is_sum_exact(x.number, -y.number)) {
      return number(x.number - y.number);
    }
    if (a == b) {
      return zero(x.kind_of);
    }
    if (is_of_number_and(a, tape_code::difference, b)) {
      return difference(operand(a, 0), product(number(2), b));
    }
    if (starts_with_minus(b)) {
      return sum(a, negative(b));
    }
    return plain(tape_code::difference, x.kind_of, a, b);
  }

  [[nodiscard]] constexpr int product(int a, int b) {
    const tape_entry& x = entries_[a];
    const tape_entry& y = entries_[b];
    const kind k = x.kind_of == kind::scalar ? y.kind_of : x.kind_of;
    if (x.code == tape_code::zero || y.code == tape_code::zero) {
      return zero(k);
    }
    if (a == 1) {
      return b;
    }
    if (b == 1) {
      return a;
    }
    if (x.code == tape_code::number) {
      if (y.code == tape_code::number && is_product_exact(x.number, y.number)) {
        return number(x.number * y.number);
      }
      if (x.number == -1) {
        return negative(b);
      }
      if (y.code == tape_code::negative) {
        return negative(product(a, operand(b, 0)));
      }
      if (y.code == tape_code::product) {
        const int n = operand(b, 0);
        if (is_number(n) && is_product_exact(x.number, entries_[n].number)) {
          return product(product(a, n), operand(b, 1));
        }
      }
      return plain(tape_code::product, k, a, b);
    }
    if (y.kind_of == kind::scalar && (x.kind_of != kind::scalar || y.code == tape_code::number)) {
      return product(b, a);
    }
    if (x.code == tape_code::negative) {
      return negative(product(operand(a, 0), b));
    }
    if (y.code == tape_code::negative) {
      return negative(product(a, operand(b, 0)));
    }
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
    if (k == kind::scalar) {
      const int m = exponent(a), n = exponent(b);
      const int base = m == 1 ? a : operand(a, 0);
      if (base == (n == 1 ? b : operand(b, 0)) && m > 0 && n > 0) {
        return power(base, m + n);
      }
    }
    return plain(tape_code::product, k, a, b);
  }

  [[nodiscard]] constexpr int quotient(int a, int b) {
    const tape_entry& x = entries_[a];
    if (x.code == tape_code::zero || b == 1) {
      return a;
    }
    if (x.code == tape_code::number && is_divided_exactly(a, b)) {
      return number(x.number / entries_[b].number);
    }
    if (starts_with_minus(a)) {
      return negative(quotient(negative(a), b));
    }
    if (starts_with_minus(b)) {
      return negative(quotient(a, negative(b)));
    }
    if (!is_number(b) || !is_divided_exactly(a, b)) {
      return plain(tape_code::quotient, x.kind_of, a, b);
    }
    if (x.code == tape_code::sum) { // (4 x + 2)/2 becomes 2 x + 1
      return sum(quotient(operand(a, 0), b), quotient(operand(a, 1), b));
    }
    if (x.code == tape_code::difference) {
      return difference(quotient(operand(a, 0), b), quotient(operand(a, 1), b));
    }
    return product(quotient(operand(a, 0), b), operand(a, 1));
  }

  [[nodiscard]] constexpr int slope_product(int a, int b) {
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
    return plain(tape_code::slope_product, kind::scalar, a, b);
  }

  [[nodiscard]] constexpr int sine(int x) {
    return code(x) == tape_code::negative ? negative(sine(operand(x, 0)))
                                          : plain(tape_code::sine, kind::scalar, x);
  }
  [[nodiscard]] constexpr int cosine(int x) {
    return code(x) == tape_code::negative ? cosine(operand(x, 0))
                                          : plain(tape_code::cosine, kind::scalar, x);
  }

  /// Entry of a node of the written formula, or −1 if it is not on the tape.
  [[nodiscard]] constexpr int recalled(unsigned hash, const char* id) const {
    for (int i = memo_table_[hash % unsigned(capacity_)] - 1; i >= 0; i = memos_[i].next) {
      if (memos_[i].hash == hash && memos_[i].id == id) {
        return memos_[i].entry;
      }
    }
    return -1;
  }
  constexpr int remember(unsigned hash, const char* id, int entry) {
    if (memo_count_ == capacity_) {
      is_full_ = true;
      return entry;
    }
    int& head = memo_table_[hash % unsigned(capacity_)];
    memos_[memo_count_] = {hash, id, entry, head - 1};
    head = ++memo_count_;
    return entry;
  }

  /// Rate of an operation, of whose operands at least one has a rate other than zero.
  [[nodiscard]] constexpr int rate(int i, const int* rates) {
    const tape_entry& e = entries_[i];
    const int* x = operands_ + e.first;
    if (e.code == tape_code::other) {
      return e.operation.rate(*this, x, rates);
    }
    const int a = x[0];
    const int da = rates[a];
    if (e.count == 1) {
      switch (e.code) {
      case tape_code::negative:
        return negative(da);
      case tape_code::sine:
        return product(cosine(a), da);
      case tape_code::cosine:
        return product(negative(sine(a)), da);
      default: // power
        return e.parameter == 2
                   ? product(product(number(2), a), da)
                   : slope_product(product(number(e.parameter), power(a, e.parameter - 1)), da);
      }
    }
    const int b = x[1];
    const int db = rates[b];
    switch (e.code) {
    case tape_code::sum:
      return sum(da, db);
    case tape_code::difference:
      return difference(da, db);
    case tape_code::product:
      return sum(product(da, b), product(a, db));
    case tape_code::quotient:
      return quotient(is_zero(db) ? da : difference(da, product(db, i)), b);
    default: // slope_product
      return sum(slope_product(da, b), slope_product(a, db));
    }
  }

private:
  [[nodiscard]] constexpr int add(tape_code code, kind k, int parameter, double number,
                                  tape_operation operation, const int* x, int count) {
    unsigned hash = (unsigned(code) * 31 + unsigned(k)) * 31 + unsigned(parameter) + operation.hash;
    if (code == tape_code::number) {
      const std::uint64_t bits = bits_of(number);
      hash += unsigned(bits >> 48);
    }
    for (int i = 0; i < count; ++i) {
      hash = hash * 37 + unsigned(x[i]);
    }
    int& head = table_[hash % unsigned(capacity_)];
    for (int i = head - 1; i >= 0; i = entries_[i].next) {
      const tape_entry& e = entries_[i];
      if (e.code == code && is_equal(e, k, parameter, number, operation, x, count)) {
        return i;
      }
    }
    if (size_ == capacity_ || operand_count_ + count > 4 * capacity_) {
      is_full_ = true;
      return 0;
    }
    entries_[size_] = {code, k, parameter, operand_count_, count, head - 1, number, operation};
    for (int i = 0; i < count; ++i) {
      operands_[operand_count_++] = x[i];
    }
    head = ++size_;
    return size_ - 1;
  }
  [[nodiscard]] constexpr bool is_equal(const tape_entry& e, kind k, int parameter, double number,
                                        const tape_operation& operation, const int* x,
                                        int count) const {
    if (e.count != count || e.kind_of != k || e.parameter != parameter || e.number != number ||
        e.operation.hash != operation.hash || e.operation.id != operation.id) {
      return false;
    }
    for (int i = 0; i < count; ++i) {
      if (operands_[e.first + i] != x[i]) {
        return false;
      }
    }
    return true;
  }

  [[nodiscard]] constexpr bool is_number(int i) const {
    return code(i) == tape_code::number || i == 0;
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
  [[nodiscard]] constexpr bool starts_with_minus(int i) const {
    const tape_entry& e = entries_[i];
    return e.code == tape_code::negative || (e.code == tape_code::number && e.number < 0) ||
           (e.code == tape_code::product && code(operand(i, 0)) == tape_code::number &&
            entries_[operand(i, 0)].number < 0);
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
    const tape_entry& x = entries_[a];
    switch (x.code) {
    case tape_code::zero:
    case tape_code::number: {
      const double divisor = entries_[b].number;
      const double ratio = divisor == 0 ? 0 : x.number / divisor;
      return is_number(b) && divisor != 0 && ratio * divisor == x.number &&
             is_product_exact(ratio, divisor);
    }
    case tape_code::product:
      return is_number(operand(a, 0)) && is_divided_exactly(operand(a, 0), b);
    case tape_code::sum:
    case tape_code::difference:
      return is_divided_exactly(operand(a, 0), b) && is_divided_exactly(operand(a, 1), b);
    default:
      return false;
    }
  }

  tape_entry* entries_;
  int* operands_;
  int* table_;
  tape_memo* memos_;
  int* memo_table_;
  int capacity_;
  int memo_count_;
  int size_;
  int operand_count_;
  bool is_full_;
};

} // namespace duet::expression::detail
