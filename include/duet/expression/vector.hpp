// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual/rules/of_many.hpp>
#include <duet/expression/arithmetic.hpp>
#include <duet/expression/tree/bindings.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/latex_arithmetic.hpp>
#include <duet/expression/tree/latex_text.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/printed.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <cmath>
#include <string>
#include <type_traits>
#include <utility>

/// \file
/// Vectors of three scalars: dot, cross, norm, components. (Sums and scaling are those of
/// scalars.) Cross products are also of lines, screws and twists.

namespace duet::expression {

/// The unit vector along the I-th axis. As a dual vector: the I-th axis as a line, or for I = 3, 4,
/// 5 the translation along axis I − 3. For those who extend duet.
template <kind K, int I>
struct unit_vector_node {
  static constexpr kind kind_of = K;
};

namespace detail {

template <kind K, int I, class Bindings>
struct leaf<unit_vector_node<K, I>, Bindings> {
  static auto value(const Bindings&) {
    using real = typename Bindings::real;
    using T = std::conditional_t<K == kind::vector, real, screw_dual<real>>;
    vector3<T> axis = vector3<T>::Zero();
    if constexpr (I < 3) {
      axis[I] = T(real(1));
    } else {
      axis[I - 3] = T(real(0), real(1));
    }
    return axis;
  }
};

/// Text of the unit vector along an axis.
[[nodiscard]] inline printed print_unit_vector(notation style, int i) {
  const std::string axis = std::to_string(i % 3 + 1);
  if (style != notation::text) {
    return {std::string(i < 3 ? "" : "\\varepsilon ") + "\\vec{e}_{" + axis + "}", precedence::atom,
            style, factor_order::in_order};
  }
  return {std::string(i < 3 ? "" : "epsilon ") + "e" + axis};
}

} // namespace detail

namespace op {

/// The sum of the products of components, of vectors and quaternions.
struct dot : bilinear_operation {
  static constexpr kind kind_of(kind, kind) { return kind::scalar; }
  template <class A, class B>
  static auto value(const A& a, const B& b) {
    if constexpr (detail::ThreeComponents<A>) {
      return duet::detail::dot(duet::detail::components(a), duet::detail::components(b));
    } else {
      return duet::dot(a, b);
    }
  }
  static printed print(notation style, const printed& a, const printed& b) {
    return style != notation::text ? detail::latex_bilinear(a, " \\cdot ", b, precedence::product,
                                                            factor_order::function)
                                   : printed{"dot(" + a.text + ", " + b.text + ")"};
  }
};

struct cross : bilinear_operation {
  static constexpr kind kind_of(kind a, kind) { return a; }
  static constexpr auto simplified(auto a, auto b) {
    return a.index == b.index ? a.at(a.tape->zero(a.of_kind())) : a.none();
  }
  static auto value(const auto& a, const auto& b) {
    return duet::detail::cross(duet::detail::components(a), duet::detail::components(b)).eigen();
  }
  static printed print(notation style, const printed& a, const printed& b) {
    return style != notation::text ? detail::latex_bilinear(a, " \\times ", b, precedence::power,
                                                            factor_order::in_order)
                                   : printed{"cross(" + a.text + ", " + b.text + ")"};
  }
};

/// |v|, of vectors and quaternions
struct norm;

/// v/|v|, the gradient of |v|, by the rule of dual numbers.
struct direction {
  static constexpr kind kind_of(kind v) { return v; }
  template <class V>
  static auto value(const V& v) {
    using T = typename V::Scalar;
    const auto u = duet::rule::hypot{}.slopes(T(0), T(v[0]), T(v[1]), T(v[2]));
    return vector3<T>(u[0], u[1], u[2]);
  }
  /// (u × dv) × u/|v|, without the cancellation in dv − u (u · dv).
  static constexpr auto differential(auto v, auto dv) {
    const auto u = apply<direction>(v);
    return apply<cross>(apply<cross>(u, dv) / apply<norm>(v), u);
  }
  static printed print(notation style, const printed& v);
};

struct norm {
  static constexpr detail::function_name name = {"norm", "\\left|#\\right|"};
  static constexpr kind kind_of(kind) { return kind::scalar; }
  template <class V>
  static auto value(const V& v) {
    if constexpr (detail::ThreeComponents<V>) {
      using std::hypot;
      return duet::rule::hypot{}.value(v[0], v[1], v[2]);
    } else {
      return duet::norm(v);
    }
  }
  static constexpr auto differential(auto v, auto dv) {
    return v.of_kind() == kind::vector ? apply<dot>(apply<direction>(v), dv)
                                       : apply<dot>(v, dv) / apply<norm>(v);
  }
};

inline printed direction::print(notation style, const printed& v) {
  return quotient::print(style, v, detail::printed_operation<norm>(style, v));
}

/// The I-th component.
template <int I>
struct component {
  static constexpr kind kind_of(kind) { return kind::scalar; }
  static auto value(const auto& v) { return v[I]; }
};

/// The vector of three scalars.
struct column : linear_operation {
  static constexpr kind kind_of(kind, kind, kind) { return kind::vector; }
  template <class X, class Y, class Z>
  static auto value(const X& x, const Y& y, const Z& z) {
    using T = promote_t<promote_t<X, Y>, Z>;
    return vector3<T>(T(x), T(y), T(z));
  }
  static printed print(notation, const printed& x, const printed& y, const printed& z) {
    return {"(" + x.text + ", " + y.text + ", " + z.text + ")"};
  }
};

} // namespace op

namespace detail {

template <class A, class B>
concept VectorOperands =
    Operands<A, B> && !SizedOperands<A, B> && (VectorTerm<A> || DualVectorTerm<A> || !Term<A>)&&(
                                                  VectorTerm<B> || DualVectorTerm<B> || !Term<B>);

} // namespace detail

/// a · b
template <class A, detail::VectorOperands<A> B, class Tag = decltype([](op::cross*) {})>
[[nodiscard]] constexpr auto dot(const A& a, const B& b) {
  return apply<op::dot>(detail::term<Tag>(a), detail::term<Tag>(b));
}
/// a × b
template <class A, detail::VectorOperands<A> B, class Tag = decltype([](op::cross*) {})>
[[nodiscard]] constexpr auto cross(const A& a, const B& b) {
  return apply<op::cross>(detail::term<Tag>(a), detail::term<Tag>(b));
}
/// |v|, without overflow. Not differentiable at 0.
[[nodiscard]] constexpr auto norm(const VectorTerm auto& v) { return apply<op::norm>(v); }
/// v_I, I = 0, 1, 2.
template <int I, VectorTerm V>
[[nodiscard]] constexpr auto component(const V& v) {
  static_assert(0 <= I && I < 3, "duet: a vector has the components 0, 1 and 2");
  return apply<op::component<I>>(v);
}
/// The vector of three scalars.
template <class X, class Y, Operands<X, Y> Z, class Tag = decltype([](op::cross*) {})>
[[nodiscard]] constexpr auto make_vector(const X& x, const Y& y, const Z& z) {
  return detail::apply_to<op::column, Tag>(std::index_sequence_for<X, Y, Z>{}, x, y, z);
}

} // namespace duet::expression
