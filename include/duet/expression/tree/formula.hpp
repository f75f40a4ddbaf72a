// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/expression/tape/program.hpp>
#include <duet/expression/tree/bindings.hpp>
#include <duet/expression/tree/held.hpp>
#include <duet/expression/tree/node.hpp>

#include <Eigen/Core>

#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>

/// \file
/// Formulas, which are a tree of operations and the constants in it, and the application of
/// operations.

namespace duet::expression {

/// A formula of symbols: a value without references, safe to store by `auto` and in `constexpr`
/// variables and to return from functions.
///
/// \tparam NodeType  the tree of operations
/// \tparam Held      the constants in it, and the symbols it was written with
template <Node NodeType, class Held>
class formula;

/// True if T is a `formula`.
template <class T>
inline constexpr bool is_formula = false;
template <class NodeType, class Held>
inline constexpr bool is_formula<formula<NodeType, Held>> = true;

} // namespace duet::expression

template <class NodeType, class Held>
inline constexpr bool duet::detail::is_symbolic<duet::expression::formula<NodeType, Held>> = true;

namespace duet::expression {

/// A formula, or a symbol.
template <class T>
concept Formula = is_formula<std::remove_cv_t<T>>;

/// A formula, or a node alone, as in rules of differentiation.
template <class T>
concept Term = Node<T> || Formula<T>;

namespace detail {

template <class T>
struct node_of {
  using type = T;
};
template <class N, class Held>
struct node_of<formula<N, Held>> {
  using type = N;
};
template <class T>
using node_t = typename node_of<std::remove_cv_t<T>>::type;

template <class T>
[[nodiscard]] constexpr kind kind_of_term() {
  return node_t<T>::kind_of;
}

} // namespace detail

// Terms of one kind.

/// A formula or node of a scalar.
template <class T>
concept ScalarTerm = Term<T> && detail::kind_of_term<T>()
== kind::scalar;
/// A formula or node of a vector of three.
template <class T>
concept VectorTerm = Term<T> && detail::kind_of_term<T>()
== kind::vector;
/// A formula or node of a vector of three or any other matrix that is not a scalar.
template <class T>
concept MatrixTerm = Term<T> && is_matrix(detail::kind_of_term<T>());
/// A formula or node of a quaternion, dual vector or dual quaternion.
template <class T>
concept QuaternionTerm = Term<T> && detail::kind_of_term<T>()
== kind::quaternion;
template <class T>
concept DualVectorTerm = Term<T> && detail::kind_of_term<T>()
== kind::dual_vector;
template <class T>
concept PoseTerm = Term<T> && detail::kind_of_term<T>()
== kind::pose;

namespace detail {

/// Eigen column vector of three components.
template <class T>
concept ThreeComponents = std::derived_from<T, Eigen::MatrixBase<T>> && T::RowsAtCompileTime == 3 &&
                          T::ColsAtCompileTime == 1;

/// Kind of an ordinary value, and the type that holds it in a formula.
template <class T>
struct constant_traits {};
template <class T>
  requires(Scalar<T> || Arithmetic<T>)
struct constant_traits<T> {
  static constexpr kind kind_of = kind::scalar;
  using held_type = std::conditional_t<std::integral<T>, double, T>;
};
template <class T>
  requires std::derived_from<T, Eigen::MatrixBase<T>>
struct constant_traits<T> {
  static constexpr int rows = T::RowsAtCompileTime;
  static constexpr int columns = T::ColsAtCompileTime;
  static_assert(
      1 <= rows && rows <= 6 && 1 <= columns && columns <= 6 && rows * columns > 1,
      "duet: a matrix in a formula has 1 to 6 rows and columns, known to the compiler; of "
      "1 x 1 it is a scalar");
  static constexpr kind kind_of =
      is_screw_dual<typename T::Scalar> ? kind::dual_vector : matrix_kind(rows, columns);
  using held_type = Eigen::Matrix<typename T::Scalar, rows, columns>;
};
template <class T>
struct constant_traits<quaternion<T>> {
  static constexpr kind kind_of = is_screw_dual<T> ? kind::pose : kind::quaternion;
  using held_type = quaternion<T>;
};

} // namespace detail

/// A number, vector, matrix, quaternion, dual vector or dual quaternion.
template <class T>
concept Constant = !std::is_array_v<T> && requires {
  detail::constant_traits<T>::kind_of;
};

/// Operands of an operation: at least one term, the others terms or constants.
template <class... T>
concept Operands = (Term<T> || ...) && ((Term<T> || Constant<T>)&&...);

/// A term and a constant, in either order.
template <class A, class B>
concept TermAndConstant = Operands<A, B> && !(Term<A> && Term<B>);

namespace detail {

/// Kind of a term or a constant.
template <class T>
[[nodiscard]] constexpr kind kind_of_operand() {
  if constexpr (Term<T>) {
    return kind_of_term<T>();
  } else {
    return constant_traits<T>::kind_of;
  }
}
/// Ordinary value of kind K.
template <class T, kind K>
concept ConstantOf = Constant<T> && constant_traits<T>::kind_of == K;
/// Operands of which at least one is a matrix that is neither a scalar nor a vector of three.
template <class... T>
concept SizedOperands = Operands<T...> &&(is_sized_matrix(kind_of_operand<T>()) || ...);

} // namespace detail

/// A formula: its type is the tree of its operations, its only data are its constants.
template <Node NodeType, class Held>
class formula : detail::refused_calls<Held, detail::value_of_kind<NodeType::kind_of>> {
public:
  using node_type = NodeType;
  using held_type = Held;

  constexpr formula() = default;
  constexpr explicit formula(const Held& held) : held_(held) {}

  /// The constants.
  [[nodiscard]] constexpr const Held& held() const { return held_; }

  /// Evaluates the formula for values of its symbols, `f(u = 0.3, w = w0)`, over any scalars. Every
  /// symbol that the formula was written with takes one value, even if simplification removed it.
  /// Equal subexpressions are evaluated once.
  template <class... Arguments>
    requires(detail::binding_error_of_call<Held, Arguments...> == detail::binding_error::none)
  [[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator()(const Arguments&... arguments) const {
    using values = detail::bindings<Held, Arguments...>;
    return detail::evaluated_nodes<NodeType>(
        values{held_, arguments...},
        [](auto& computed) DUET_INLINE_LAMBDA { return computed.template get<0>(); });
  }
  using detail::refused_calls<Held, detail::value_of_kind<NodeType::kind_of>>::operator();

  /// Binds a value to a symbol, as an argument of a formula.
  template <class T>
    requires(is_symbol<NodeType>&& detail::ConstantOf<T, NodeType::kind_of>)
  [[nodiscard]] constexpr auto operator=(const T& value) const {
    using held_type_of_value = typename detail::constant_traits<T>::held_type;
    return detail::argument<NodeType, held_type_of_value>{static_cast<held_type_of_value>(value)};
  }
  template <class T>
    requires(is_symbol<NodeType> && !detail::ConstantOf<T, NodeType::kind_of> &&
             !is_sized_matrix(NodeType::kind_of))
  DUET_REFUSED("a symbol is given a value of another kind; scalar, vector, quaternion, dual vector "
               "and pose symbols take just that")
  detail::argument<NodeType, detail::value_of_kind<NodeType::kind_of>> operator=(const T&) const;
  template <class T>
    requires(is_symbol<NodeType> && !detail::ConstantOf<T, NodeType::kind_of> &&
             is_sized_matrix(NodeType::kind_of))
  DUET_REFUSED("a matrix symbol is given a value of another size; matrix_symbol<\"A\", 2, 4> takes "
               "a matrix of Eigen of 2 rows and 4 columns")
  detail::argument<NodeType, detail::value_of_kind<NodeType::kind_of>> operator=(const T&) const;

private:
  DUET_NO_UNIQUE_ADDRESS Held held_;
};

/// Formula of a node.
template <class NodeType, class Held>
[[nodiscard]] constexpr formula<NodeType, Held> make_formula(NodeType, const Held& held) {
  return formula<NodeType, Held>(held);
}

namespace detail {

// Constants are distinguished by the type of a closure in a default template argument: each call in
// the source code has a new one. The closures of each header have a separate type of parameter:
// clang 14 numbers closures per namespace block but mangles them per namespace, so that closures of
// two headers would be one type.

template <class Tag, Term T>
[[nodiscard]] constexpr const T& term(const T& x) {
  return x;
}
template <class Tag, Constant T>
[[nodiscard]] constexpr auto term(const T& x) {
  using traits = constant_traits<T>;
  using node = constant_node<traits::kind_of, Tag>;
  using value = typename traits::held_type;
  return make_formula(node{}, held<held_constant<node, value>>{{static_cast<value>(x)}});
}

[[nodiscard]] constexpr held<> held_of(const Node auto&) { return {}; }
[[nodiscard]] constexpr const auto& held_of(const Formula auto& x) { return x.held(); }

/// Checks the kinds of operands, where an operation has requirements.
template <class Operation, Node... N>
constexpr void require_kinds() {
  if constexpr (requires { Operation::template require<N::kind_of...>(); }) {
    Operation::template require<N::kind_of...>();
  }
}

} // namespace detail

/// Applies an operation to terms: a node of nodes, a formula of formulas.
template <class Operation, Node... N>
[[nodiscard]] constexpr auto apply(N...) {
  detail::require_kinds<Operation, N...>();
  return applied_node<Operation, N...>{};
}
template <class Operation, Term... T>
  requires(Formula<T> || ...)
[[nodiscard]] constexpr auto apply(const T&... x) {
  detail::require_kinds<Operation, detail::node_t<T>...>();
  using held = decltype(merged(detail::held_of(x)...));
  return formula<applied_node<Operation, detail::node_t<T>...>, held>(
      merged(detail::held_of(x)...));
}

namespace detail {

template <class Tag, std::size_t I>
struct numbered_tag {};

/// Applies an operation to terms and constants of one call, whose constants share a tag.
template <class Operation, class Tag, std::size_t... I, class... X>
[[nodiscard]] constexpr auto apply_to(std::index_sequence<I...>, const X&... x) {
  return apply<Operation>(term<numbered_tag<Tag, I>>(x)...);
}

} // namespace detail

} // namespace duet::expression
