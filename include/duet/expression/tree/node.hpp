// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/types.hpp>

#include <cstdint>
#include <type_traits>

/// \file
/// Nodes of formulas: types without data, so that equal subexpressions are equal types and nothing
/// can dangle. For those who extend duet.

namespace duet::expression {

/// What a node stands for. Matrices of a size have the kind `matrix_kind(rows, columns)`.
enum class kind {
  scalar,
  condition,   ///< true or false
  vector,      ///< three scalars
  quaternion,  ///< a rotation, if of unit norm
  dual_vector, ///< a line, screw or twist of rigid motion
  pose         ///< a dual quaternion, a rigid motion if unit
};

/// The kind of matrices of a size, of 1 to 6 rows and columns: of 1 x 1 a scalar, of 3 x 1 a
/// vector, of any other size one of its own, behind the kinds that have a name.
[[nodiscard]] constexpr kind matrix_kind(int rows, int columns) {
  return columns == 1 && rows == 1   ? kind::scalar
         : columns == 1 && rows == 3 ? kind::vector
                                     : static_cast<kind>(8 * rows + columns);
}
/// A matrix that is neither a scalar nor a vector of three.
[[nodiscard]] constexpr bool is_sized_matrix(kind k) { return k > kind::pose; }
/// A matrix that is no scalar.
[[nodiscard]] constexpr bool is_matrix(kind k) { return is_sized_matrix(k) || k == kind::vector; }
/// Of a scalar or a matrix.
[[nodiscard]] constexpr int rows_of(kind k) {
  return is_sized_matrix(k) ? static_cast<int>(k) / 8 : k == kind::vector ? 3 : 1;
}
[[nodiscard]] constexpr int columns_of(kind k) {
  return is_sized_matrix(k) ? static_cast<int>(k) % 8 : 1;
}

/// A variable with a name, spelt out in letters, for every compiler to print.
template <kind K, char... Letters>
struct symbol_node {
  static constexpr kind kind_of = K;
};

/// A number known when the program runs, which its formula holds. The tag is that of the place in
/// the code where it was written.
template <kind K, class Tag>
struct constant_node {
  static constexpr kind kind_of = K;
};

/// A number known to the compiler, by the bits of a double.
template <std::uint64_t Bits>
struct number_node {
  static constexpr kind kind_of = kind::scalar;
  static constexpr double value = duet::detail::bit_cast<double>(Bits);
};

/// 0 of what is no scalar.
template <kind K>
struct zero_node {
  static constexpr kind kind_of = K;
};

/// An operation and what it is applied to.
template <class Operation, class... Operands>
struct applied_node {
  static constexpr kind kind_of = Operation::kind_of(Operands::kind_of...);
};

/// What operations derive from whose value is linear in all operands together: it is 0 where they
/// are, and its derivative is that operation of their rates.
struct linear_operation {};
/// What operations of two operands derive from whose value is linear in each: it is 0 where one is,
/// and its derivative follows the rule of products.
struct bilinear_operation {};

/// A formula's type: empty, and of a `kind`.
template <class T>
concept Node = requires {
  T::kind_of;
  requires std::is_empty_v<T>;
  requires std::is_same_v<std::remove_cvref_t<decltype(T::kind_of)>, kind>;
};

/// A number known to the compiler?
template <class T>
inline constexpr bool is_number = false;
template <std::uint64_t Bits>
inline constexpr bool is_number<number_node<Bits>> = true;

/// A variable?
template <class T>
inline constexpr bool is_symbol = false;
template <kind K, char... Letters>
inline constexpr bool is_symbol<symbol_node<K, Letters...>> = true;

/// That operation, applied?
template <class T, class Operation>
inline constexpr bool is_applied = false;
template <class Operation, class... Operands>
inline constexpr bool is_applied<applied_node<Operation, Operands...>, Operation> = true;

/// Any operation, applied?
template <class T>
inline constexpr bool is_operation = false;
template <class Operation, class... Operands>
inline constexpr bool is_operation<applied_node<Operation, Operands...>> = true;

/// The whole number N, known to the compiler?
template <class T, int N>
inline constexpr bool is_whole = false;
template <std::uint64_t Bits, int N>
inline constexpr bool is_whole<number_node<Bits>, N> = number_node<Bits>::value == N;
template <class T>
inline constexpr bool is_one = is_whole<T, 1>;
/// 0 of any kind?
template <class T>
inline constexpr bool is_zero = is_whole<T, 0>;
template <kind K>
inline constexpr bool is_zero<zero_node<K>> = true;

/// 0 of a kind.
template <kind K>
[[nodiscard]] constexpr auto zero_of() {
  return std::conditional_t<K == kind::scalar, number_node<0>, zero_node<K>>{};
}

/// The I-th operand.
template <int I, class Operation, class First, class... Rest>
[[nodiscard]] constexpr auto operand(applied_node<Operation, First, Rest...>) {
  if constexpr (I == 0) {
    return First{};
  } else {
    return operand<I - 1>(applied_node<Operation, Rest...>{});
  }
}

} // namespace duet::expression
