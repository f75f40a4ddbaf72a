// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/dual/rules/of_many.hpp>
#include <duet/expression/algebra/arithmetic.hpp>
#include <duet/expression/algebra/product.hpp>
#include <duet/expression/elementary_functions.hpp>
#include <duet/expression/evaluate/node_values.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/function.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>
#include <duet/expression/tree/printed.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <cmath>
#include <string>

/// \file
/// Vectors of three scalars: dot, cross, norm, components. (Sums and scaling are those of
/// scalars.) Cross products are also of lines, screws and twists.

namespace duet::expression {

/// The unit vector along the I-th axis; of rigid motion, the line through the origin, or for I = 3,
/// 4, 5 the translation along an axis.
template <kind K, int I>
struct unit_vector_node {
  static constexpr kind kind_of = K;
};

namespace detail {

template <kind K, int I, class Given>
struct leaf<unit_vector_node<K, I>, Given> {
  DUET_ALWAYS_INLINE static auto value(const Given&) {
    using real = typename Given::real;
    const auto component = [](int i) { return real(I % 3 == i ? 1 : 0); };
    if constexpr (K == kind::vector) {
      return vector3<real>(component(0), component(1), component(2));
    } else {
      using D = screw_dual<real>;
      const auto dual_component = [&](int i) {
        return I < 3 ? D(component(i), real(0)) : D(real(0), component(i));
      };
      return dual_vector<real>(dual_component(0), dual_component(1), dual_component(2));
    }
  }
};

template <kind K, int I, class Held>
[[nodiscard]] printed print(notation style, unit_vector_node<K, I>, const Held&) {
  const std::string axis = std::to_string(I % 3 + 1);
  if (style == notation::latex) {
    return {std::string(I < 3 ? "" : "\\varepsilon ") + "\\vec{e}_{" + axis + "}"};
  }
  return {std::string(I < 3 ? "" : "epsilon ") + "e" + axis};
}

} // namespace detail

namespace op {

template <int I, int J, int Rows, int Columns>
struct block;

/// The sum of the products of components, of vectors and quaternions.
struct dot {
  static constexpr kind kind_of(kind, kind) { return kind::scalar; }
  template <class A, class B>
  DUET_ALWAYS_INLINE static auto value(const A& a, const B& b) {
    if constexpr (detail::ThreeComponents<A>) {
      return duet::detail::dot(duet::detail::components(a), duet::detail::components(b));
    } else {
      return duet::dot(a, b);
    }
  }
  template <class A, class B, class DA, class DB>
  static constexpr auto differential(A a, B b, DA da, DB db) {
    return sum_of_products(a, db) + sum_of_products(b, da);
  }
  static printed print(notation style, const printed& a, const printed& b) {
    return style == notation::latex
               ? printed{a.inside(precedence::product) + " \\cdot " + b.inside(precedence::product),
                         precedence::product}
               : printed{"dot(" + a.text + ", " + b.text + ")"};
  }

private:
  template <class A, class B>
  static constexpr auto sum_of_products(A a, B b) {
    if constexpr (is_zero<B>) {
      return whole<0>;
    } else {
      return apply<dot>(a, b);
    }
  }
};

struct cross {
  static constexpr kind kind_of(kind a, kind) { return a; }
  template <class A, class B>
  static constexpr auto simplified(A, B) {
    if constexpr (is_zero<A> || is_zero<B>) {
      return zero_of<A::kind_of>();
    } else if constexpr (std::is_same_v<A, B>) {
      return zero_of<A::kind_of>();
    } else {
      return applied_node<cross, A, B>{};
    }
  }
  template <class A, class B>
  DUET_ALWAYS_INLINE static auto value(const A& a, const B& b) {
    return duet::detail::cross(duet::detail::components(a), duet::detail::components(b)).eigen();
  }
  template <class A, class B, class DA, class DB>
  static constexpr auto differential(A a, B b, DA da, DB db) {
    return apply<cross>(da, b) + apply<cross>(a, db);
  }
  static printed print(notation style, const printed& a, const printed& b) {
    return style == notation::latex
               ? printed{a.inside(precedence::power) + " \\times " + b.inside(precedence::power),
                         precedence::product}
               : printed{"cross(" + a.text + ", " + b.text + ")"};
  }
};

/// |v|, of vectors and quaternions
struct norm;

/// v/|v|, the slopes of the norm, by the rule of the dual numbers.
struct direction {
  static constexpr kind kind_of(kind v) { return v; }
  template <class V>
  static auto value(const V& v) {
    using T = typename V::Scalar;
    const auto u = duet::rule::hypot{}.slopes(T(0), T(v[0]), T(v[1]), T(v[2]));
    return vector3<T>(u[0], u[1], u[2]);
  }
  /// (u × dv) × u/|v|: in dv − u (u · dv) what differs from dv by little would cancel.
  template <class V, class DV>
  static constexpr auto differential(V v, DV dv) {
    const auto u = apply<direction>(v);
    return apply<cross>(apply<cross>(u, dv) / apply<norm>(v), u);
  }
  static printed print(notation style, const printed& v);
};

struct norm {
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
  template <class V, class DV>
  static constexpr auto differential(V v, DV dv) {
    if constexpr (V::kind_of == kind::vector) {
      return apply<dot>(apply<direction>(v), dv);
    } else {
      return apply<dot>(v, dv) / apply<norm>(v);
    }
  }
  static printed print(notation style, const printed& v) {
    return style == notation::latex ? printed{"\\left|" + v.text + "\\right|"}
                                    : printed{"norm(" + v.text + ")"};
  }
};

inline printed direction::print(notation style, const printed& v) {
  return quotient::print(style, v, norm::print(style, v));
}

/// The I-th component.
template <int I>
struct component {
  static constexpr kind kind_of(kind) { return kind::scalar; }
  template <class V>
  DUET_ALWAYS_INLINE static auto value(const V& v) {
    return v[I];
  }
  template <class V, class DV>
  static constexpr auto differential(V, DV dv) {
    if constexpr (is_sized_matrix(DV::kind_of)) {
      return apply<block<I, 0, 1, 1>>(dv);
    } else {
      return apply<component>(dv);
    }
  }
  static printed print(notation style, const printed& v) {
    const std::string i = std::to_string(I);
    return style == notation::latex ? detail::with_index(v, std::to_string(I + 1))
                                    : printed{v.inside(precedence::atom) + "[" + i + "]"};
  }
  template <kind K, int J>
  static constexpr auto simplified(unit_vector_node<K, J>) {
    return whole<(I == J ? 1 : 0)>;
  }
  template <class V>
  static constexpr auto simplified(V) {
    return applied_node<component, V>{};
  }
};

/// The vector of three scalars.
struct column {
  static constexpr kind kind_of(kind, kind, kind) { return kind::vector; }
  template <class X, class Y, class Z>
  DUET_ALWAYS_INLINE static auto value(const X& x, const Y& y, const Z& z) {
    using T = promote_t<promote_t<X, Y>, Z>;
    return vector3<T>(T(x), T(y), T(z));
  }
  template <class X, class Y, class Z, class DX, class DY, class DZ>
  static constexpr auto differential(X, Y, Z, DX dx, DY dy, DZ dz) {
    return apply<column>(dx, dy, dz);
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
template <class A, class B, class Tag = decltype([](op::cross*) {})>
  requires detail::VectorOperands<A, B>
[[nodiscard]] constexpr auto dot(const A& a, const B& b) {
  return apply<op::dot>(detail::term<Tag>(a), detail::term<Tag>(b));
}
/// a × b
template <class A, class B, class Tag = decltype([](op::cross*) {})>
  requires detail::VectorOperands<A, B>
[[nodiscard]] constexpr auto cross(const A& a, const B& b) {
  return apply<op::cross>(detail::term<Tag>(a), detail::term<Tag>(b));
}
/// |v|, without overflow. Not differentiable at 0.
template <VectorTerm V>
[[nodiscard]] constexpr auto norm(const V& v) {
  return apply<op::norm>(v);
}
/// v_I, I = 0, 1, 2.
template <int I, VectorTerm V>
[[nodiscard]] constexpr auto component(const V& v) {
  static_assert(0 <= I && I < 3, "duet: a vector has the components 0, 1 and 2");
  return apply<op::component<I>>(v);
}
/// The vector of three scalars.
template <class X, class Y, class Z, class TagX = decltype([](op::cross*) {}),
          class TagY = decltype([](op::cross*) {}), class TagZ = decltype([](op::cross*) {})>
  requires Operands<X, Y, Z>
[[nodiscard]] constexpr auto column(const X& x, const Y& y, const Z& z) {
  return apply<op::column>(detail::term<TagX>(x), detail::term<TagY>(y), detail::term<TagZ>(z));
}

} // namespace duet::expression
