// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/expression/elementary_functions.hpp>
#include <duet/expression/rotation.hpp>
#include <duet/expression/tree/bindings.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>
#include <duet/expression/tree/printed.hpp>
#include <duet/expression/vector.hpp>

#include <string>
#include <type_traits>

/// \file
/// Rotations about fixed axes, screws, poses and their parts (N17–N19); real and dual parts
/// of a + εb, and the conjugates a − εb (N10, N13, N15).

namespace duet::expression {

namespace op {

/// a or b of a + εb, over real instead of dual numbers.
template <bool Dual>
struct part_of_dual : linear_operation {
  static constexpr detail::function_name name = {
      Dual ? "dual_part" : "real_part", Dual ? "\\operatorname{dual}" : "\\operatorname{real}"};
  static constexpr kind kind_of(kind k) {
    return k == kind::dual_vector ? kind::vector : k == kind::pose ? kind::quaternion : k;
  }
  static constexpr auto simplified(auto x) {
    const auto& e = x.entry();
    return e.kind_of == kind::vector && !Dual         ? x
           : e.code != detail::tape_code::unit_vector ? x.none()
           : (e.parameter < 3) != Dual ? x.at(x.tape->unit_vector(kind::vector, e.parameter % 3))
                                       : x.at(x.tape->zero(kind::vector));
  }
  template <class X>
  static auto value(const X& x) {
    if constexpr (detail::is_screw_dual<X>) {
      return Dual ? x.epsilon() : x.value();
    } else if constexpr (Scalar<X>) { // a real number
      return Dual ? X(0) : x;
    } else if constexpr (Dual) {
      return duet::dual_part(x);
    } else {
      return duet::real_part(x);
    }
  }
};

/// n + εm of two vectors.
struct dual_vector_of : linear_operation {
  static constexpr kind kind_of(kind, kind) { return kind::dual_vector; }
  static auto value(const auto& n, const auto& m) {
    using T = promote_t<std::remove_cvref_t<decltype(n[0])>, std::remove_cvref_t<decltype(m[0])>>;
    return make_dual_vector(vector3<T>(T(n[0]), T(n[1]), T(n[2])),
                            vector3<T>(T(m[0]), T(m[1]), T(m[2])));
  }
  static printed print(notation style, const printed& n, const printed& m) {
    const std::string unit = style == notation::text ? " + eps * " : " + \\varepsilon ";
    return {n.inside(precedence::sum) + unit + m.inside(precedence::product), precedence::sum,
            style};
  }
};

/// p of a rigid motion p + εq, whose velocity follows from that of the motion.
struct rotation : linear_operation {
  static printed print(notation style, const printed& a) {
    const char* name = style == notation::notes ? "real" : "rotation";
    return detail::printed_call(style, {name, ""}, {a});
  }
  static constexpr kind kind_of(kind) { return kind::quaternion; }
  static auto value(const auto& a) { return duet::rotation(a); }
};

/// a − εb.
struct dual_conj : linear_operation {
  static constexpr detail::function_name name = {"dual_conj", "\\overline{#}"};
  static constexpr kind kind_of(kind k) { return k; }
  static constexpr auto simplified(auto x) {
    return x.template is<dual_conj>() ? x.operand(0) : x.none();
  }
  template <class X>
  static constexpr auto value(const X& x) {
    if constexpr (Scalar<X> && !detail::is_screw_dual<X>) {
      return x; // a real number
    } else {
      return duet::dual_conj(x);
    }
  }
};

} // namespace op

/// a of a + εb: of a dual number, such as the product of two lines, of a dual vector or of a dual
/// quaternion, of which it is the rotation if it is unit.
template <Term X>
  requires(!VectorTerm<X> && !QuaternionTerm<X>)
[[nodiscard]] constexpr auto real_part(const X& x) {
  if constexpr (PoseTerm<X>) {
    return apply<op::rotation>(x);
  } else {
    return apply<op::part_of_dual<false>>(x);
  }
}
/// b of a + εb.
template <Term X>
  requires(!VectorTerm<X> && !QuaternionTerm<X>)
[[nodiscard]] constexpr auto dual_part(const X& x) { return apply<op::part_of_dual<true>>(x); }
/// a − εb of a dual number (N10) or dual quaternion, its second conjugate (N15).
template <Term X>
  requires(ScalarTerm<X> || PoseTerm<X>)
[[nodiscard]] constexpr auto dual_conj(const X& x) { return apply<op::dual_conj>(x); }
/// N15: the third conjugate p* − εq* of p + εq, which transforms points: A (1 + εx) A^(3).
[[nodiscard]] constexpr auto point_conj(const PoseTerm auto& a) { return dual_conj(conj(a)); }

namespace detail {

/// q + ½ε x.
[[nodiscard]] inline printed plus_half_epsilon(const printed& q, const printed& x) {
  return {q.inside(precedence::sum) + " + \\frac{\\varepsilon}{2} " + x.inside(precedence::product),
          precedence::sum, notation::latex};
}

} // namespace detail

namespace op {

/// exp(½θ n) of a unit vector, unit line or screw n. Sine and cosine of the half angle are
/// operands, so that several nodes share them.
struct axis_exponential {
  static constexpr kind kind_of(kind n, kind, kind, kind) { return detail::quaternion_kind(n); }
  template <class N, class Angle, class S, class C>
  static auto value(const N& n, const Angle& angle, const S& s, const C& c) {
    using T = typename N::Scalar;
    if constexpr (detail::is_screw_dual<T>) {
      // n = (1 + εh)(unit line), h the pitch: cos and sin are those of the dual angle ½θ(1 + εh).
      const auto pitch = n[0].value() * n[0].epsilon() + n[1].value() * n[1].epsilon() +
                         n[2].value() * n[2].epsilon();
      const auto shift = angle * pitch / 2;
      using D = screw_dual<std::decay_t<decltype(c * shift)>>;
      const D dual_cosine(c, -s * shift), dual_sine(s, c * shift - s * pitch);
      return quaternion<D>(dual_cosine, n[0] * dual_sine, n[1] * dual_sine, n[2] * dual_sine);
    } else {
      using R = promote_t<T, S>;
      return quaternion<R>(R(c), n[0] * s, n[1] * s, n[2] * s);
    }
  }
  static constexpr auto differential(auto n, auto angle, auto s, auto c, auto dn, auto da, auto,
                                     auto) {
    return dn.is_zero() ? number_node<detail::bits_of(0.5)>{} *
                              (da * (apply<pure>(n) * apply<axis_exponential>(n, angle, s, c)))
                        : n.none();
  }
  static printed print(notation style, const printed& n, const printed& angle, const printed& s,
                       const printed& c) {
    if (style == notation::notes) { // N4: cos ½θ + n sin ½θ
      return detail::latex_sum_of(c, 1, detail::latex_product_of(s, n));
    }
    const printed half =
        quotient::print(style, angle, {"2", precedence::atom, style, factor_order::number});
    return detail::printed_operation<exp_vector>(style, product::print(style, half, n));
  }
};

/// The translation by d along the unit vector n.
struct translation_along {
  static constexpr kind kind_of(kind, kind) { return kind::pose; }
  template <class N, class D>
  static auto value(const N& n, const D& d) {
    using T = promote_t<typename N::Scalar, D>;
    return pose(quaternion<T>(T(1)), vector3<T>(n[0] * d, n[1] * d, n[2] * d));
  }
  static printed print(notation style, const printed& n, const printed& d) {
    if (style != notation::notes) {
      return detail::printed_call(style, {"translation_along", "\\operatorname{Trans}"}, {n, d});
    }
    return detail::plus_half_epsilon({"1"}, detail::latex_product_of(d, n));
  }
};

/// The pose of a rotation followed by a translation (N17).
struct make_pose {
  static constexpr kind kind_of(kind, kind) { return kind::pose; }
  static auto value(const auto& q, const auto& t) { return duet::pose(q, t); }
  static printed print(notation style, const printed& q, const printed& t) {
    if (style != notation::notes) {
      return detail::printed_call(style, {"pose", ""}, {q, t});
    }
    return detail::plus_half_epsilon(q, detail::latex_product_of(t, q));
  }
};

struct translation {
  static constexpr kind kind_of(kind) { return kind::vector; }
  /// ṫ = v + ω × t of the twist ω + εv in spatial axes (N18).
  static constexpr auto rate_by_velocity(auto twist, auto a, auto) {
    return apply<part_of_dual<true>>(twist) +
           apply<cross>(apply<part_of_dual<false>>(twist), apply<translation>(a));
  }
  static printed print(notation style, const printed& a) {
    if (style != notation::notes) {
      return detail::printed_call(style, {"translation", ""}, {a});
    }
    const std::string of = a.in_parentheses(); // N17: t = 2 β α*
    return {"2 \\operatorname{dual}" + of + " \\operatorname{real}" + of + "^{*}",
            precedence::product};
  }
  static auto value(const auto& a) { return duet::translation(a); }
};

} // namespace op

namespace detail {

[[nodiscard]] constexpr auto motion_about_axis(const Formula auto& n, const Formula auto& angle) {
  const auto half = angle / whole<2>;
  return apply<op::axis_exponential>(n, angle, apply<op::sin>(half), apply<op::cos>(half));
}

} // namespace detail

/// The rigid motion by the angle θ, in radians, about and along a screw n + ε(m + h n) with a unit
/// direction n, the moment m = point × n and the pitch h, in units of length per radian. It is
/// exp(½θ(n + …)), with sine and cosine instead of an exponential. That |n| = 1 is not checked.
template <class L, Operands<L> Angle, class Tag = decltype([](op::axis_exponential*) {})>
[[nodiscard]] constexpr auto screw(const L& line, const Angle& angle) {
  static_assert(detail::kind_of_operand<L>() == kind::dual_vector,
                "duet: screw(line, angle) takes a dual vector n + εm, made by line_through or "
                "make_dual_vector");
  return detail::motion_about_axis(detail::term<Tag>(line), detail::term<Tag>(angle));
}
/// The rotation by θ, in radians, about a unit vector n, whose length is not checked.
template <class N, Operands<N> Angle, class Tag = decltype([](op::axis_exponential*) {})>
[[nodiscard]] constexpr auto rotation_about(const N& n, const Angle& angle) {
  static_assert(
      detail::kind_of_operand<N>() == kind::vector,
      "duet: rotation_about(n, angle) takes a unit vector; for lines there is screw(line, angle)");
  return detail::motion_about_axis(detail::term<Tag>(n), detail::term<Tag>(angle));
}
/// The translation by d along a unit vector or line, a prismatic joint.
template <class N, Operands<N> D, class Tag = decltype([](op::axis_exponential*) {})>
[[nodiscard]] constexpr auto translation_along(const N& n, const D& d) {
  const auto direction = apply<op::part_of_dual<false>>(detail::term<Tag>(n));
  return apply<op::translation_along>(direction, detail::term<Tag>(d));
}
namespace axis {

/// Type of `axis::x`, `axis::y` and `axis::z`.
template <int I>
using coordinate = formula<unit_vector_node<kind::dual_vector, I>, held<>>;

/// The coordinate axes, lines through the origin, known at compile time: `screw(axis::z, theta)`,
/// `translation_along(axis::x, 0.3)`.
inline constexpr coordinate<0> x{};
inline constexpr coordinate<1> y{};
inline constexpr coordinate<2> z{};

} // namespace axis

/// The line along n through a point, n + ε point × n, for `screw`.
[[nodiscard]] inline dual_vector<double> line_through(const vector3<double>& point,
                                                      const vector3<double>& n) {
  const vector3<double> moment = point.cross(n);
  return make_dual_vector(n, moment);
}
/// N17: the pose x ↦ q x q* + t.
template <class Q, Operands<Q> T, class Tag = decltype([](op::axis_exponential*) {})>
[[nodiscard]] constexpr auto pose(const Q& q, const T& t) {
  return apply<op::make_pose>(detail::term<Tag>(q), detail::term<Tag>(t));
}
/// The rotation of a pose.
[[nodiscard]] constexpr auto rotation(const PoseTerm auto& a) { return apply<op::rotation>(a); }
/// N17: the translation of a pose.
[[nodiscard]] constexpr auto translation(const PoseTerm auto& a) {
  return apply<op::translation>(a);
}
/// The point x transformed by a pose: R x + t.
template <PoseTerm A, class X, class Tag = decltype([](op::axis_exponential*) {})>
[[nodiscard]] constexpr auto transform_point(const A& a, const X& x) {
  return rotate(rotation(a), detail::term<Tag>(x)) + translation(a);
}
/// N19: a (a* b)^τ of poses.
template <class A, class B, Operands<A, B> S, class Tag = decltype([](op::axis_exponential*) {})>
[[nodiscard]] constexpr auto sclerp(const A& a, const B& b, const S& tau) {
  return slerp<A, B, S, Tag>(a, b, tau);
}

} // namespace duet::expression
