// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/types.hpp>

#include <cstdint>
#include <type_traits>

/// \file
/// Nodes of formulas: types without data, so that equal subexpressions are equal types and nothing
/// can dangle. For those who extend duet.

namespace duet::expression {

/// Kind of the value of a node. Matrices of other sizes have the kind `matrix_kind(rows, columns)`.
enum class kind {
  scalar,
  condition,   ///< true or false
  vector,      ///< three scalars
  quaternion,  ///< a rotation, if of unit norm
  dual_vector, ///< a line, screw or twist of rigid motion
  pose         ///< a dual quaternion, a rigid motion if unit
};

/// Kind of a matrix of 1 to 6 rows and columns: `scalar` for 1 x 1, `vector` for 3 x 1, otherwise a
/// value above all named kinds.
[[nodiscard]] constexpr kind matrix_kind(int rows, int columns) {
  return columns == 1 && rows == 1   ? kind::scalar
         : columns == 1 && rows == 3 ? kind::vector
                                     : static_cast<kind>(8 * rows + columns);
}
/// True for a matrix that is neither a scalar nor a vector of three.
[[nodiscard]] constexpr bool is_sized_matrix(kind k) { return k > kind::pose; }
/// True for a vector of three and any other matrix that is not a scalar.
[[nodiscard]] constexpr bool is_matrix(kind k) { return is_sized_matrix(k) || k == kind::vector; }
/// Number of rows, or of columns, of a scalar or a matrix.
[[nodiscard]] constexpr int rows_of(kind k) {
  return is_sized_matrix(k) ? static_cast<int>(k) / 8 : k == kind::vector ? 3 : 1;
}
[[nodiscard]] constexpr int columns_of(kind k) {
  return is_sized_matrix(k) ? static_cast<int>(k) % 8 : 1;
}

/// Symbol with a name, spelt out in letters, so that every compiler prints it in messages.
template <kind K, char... Letters>
struct symbol_node {
  static constexpr kind kind_of = K;
};

/// Constant whose value is known at run time and held by the formula. The tag is a type that
/// differs for each expression in the source code that makes a constant.
template <kind K, class Tag>
struct constant_node {
  static constexpr kind kind_of = K;
};

/// Number known at compile time, as the bits of a double.
template <std::uint64_t Bits>
struct number_node {
  static constexpr kind kind_of = kind::scalar;
  static constexpr double value = duet::detail::bit_cast<double>(Bits);
};

/// Zero of a kind other than scalar.
template <kind K>
struct zero_node {
  static constexpr kind kind_of = K;
};

/// Operation applied to operands.
template <class Operation, class... Operands>
struct applied_node {
  static constexpr kind kind_of = Operation::kind_of(Operands::kind_of...);
};

/// Rate of a node if symbols move, each a `moving`; other symbols are constant.
template <class NodeType, class... Moving>
struct rate_node {
  static constexpr kind kind_of = NodeType::kind_of;
};

/// Base of operations that are linear in all operands together: f(0, …) = 0, and the derivative is
/// the operation applied to the rates of the operands.
struct linear_operation {};
/// Base of operations that are linear in each of two operands: f(0, b) = f(a, 0) = 0, with the
/// derivative f(ȧ, b) + f(a, ḃ).
struct bilinear_operation {};

/// Type of the tree of a formula: an empty class with a `kind`.
template <class T>
concept Node = requires {
  T::kind_of;
  requires std::is_empty_v<T>;
  requires std::is_same_v<std::remove_cvref_t<decltype(T::kind_of)>, kind>;
};

/// True if T is a number known at compile time.
template <class T>
inline constexpr bool is_number = false;
template <std::uint64_t Bits>
inline constexpr bool is_number<number_node<Bits>> = true;

/// True if T is a symbol.
template <class T>
inline constexpr bool is_symbol = false;
template <kind K, char... Letters>
inline constexpr bool is_symbol<symbol_node<K, Letters...>> = true;

} // namespace duet::expression
