// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/expression/dual_parts.hpp>
#include <duet/expression/elementary_functions.hpp>
#include <duet/expression/evaluate/pushforward.hpp>
#include <duet/expression/rotation.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>
#include <duet/expression/tree/printed.hpp>
#include <duet/expression/vector.hpp>

#include <string>
#include <type_traits>
#include <utility>

/// \file
/// Turns about axes that stand still, screws, and the parts of poses (N17–N19).

namespace duet::expression {

namespace op {

/// exp(½θ n) of a unit vector or unit line n, with sine and cosine of the half angle as operands,
/// so that they are shared.
struct turn {
  static constexpr kind kind_of(kind n, kind, kind, kind) { return detail::quaternion_kind(n); }
  template <class N, class Angle, class S, class C>
  DUET_ALWAYS_INLINE static auto value(const N& n, const Angle& angle, const S& s, const C& c) {
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
  template <class N, class Angle, class S, class C, class DN, class DAngle, class DS, class DC>
  static constexpr auto differential(N n, Angle angle, S s, C c, DN dn, DAngle da, DS ds, DC dc) {
    if constexpr (is_zero<DN>) {
      return number_node<detail::bits_of(0.5)>{} *
             (da * (apply<pure>(n) * applied_node<turn, N, Angle, S, C>{}));
    } else {
      return apply<pushforward<turn, std::index_sequence<0, 1, 2, 3>>>(n, angle, s, c, dn, da, ds,
                                                                       dc);
    }
  }
  static printed print(notation style, const printed& n, const printed& angle, const printed&,
                       const printed&) {
    const printed half = quotient::print(style, angle, {"2"});
    return exp_vector::print(style, product::print(style, half, n));
  }
};

/// The translation by d along the unit vector n.
struct slide {
  static constexpr kind kind_of(kind, kind) { return kind::pose; }
  template <class N, class D>
  static auto value(const N& n, const D& d) {
    using T = promote_t<typename N::Scalar, D>;
    return pose(quaternion<T>(T(1)), vector3<T>(n[0] * d, n[1] * d, n[2] * d));
  }
  template <class N, class D, class DN, class DD>
  static constexpr auto differential(N n, D d, DN dn, DD dd) {
    return apply<pushforward<slide, std::index_sequence<0, 1>>>(n, d, dn, dd);
  }
  static printed print(notation style, const printed& n, const printed& d) {
    return detail::printed_call(style, {"slide", ""}, n.text + ", " + d.text);
  }
};

/// The pose of a rotation, then a translation (N17).
struct make_pose {
  static constexpr kind kind_of(kind, kind) { return kind::pose; }
  template <class Q, class T>
  static auto value(const Q& q, const T& t) {
    return duet::pose(q, t);
  }
  template <class Q, class T, class DQ, class DT>
  static constexpr auto differential(Q q, T t, DQ dq, DT dt) {
    return apply<pushforward<make_pose, std::index_sequence<0, 1>>>(q, t, dq, dt);
  }
  static printed print(notation style, const printed& q, const printed& t) {
    return detail::printed_call(style, {"pose", ""}, q.text + ", " + t.text);
  }
};

struct translation {
  static constexpr kind kind_of(kind) { return kind::vector; }
  template <class A>
  static auto value(const A& a) {
    return duet::translation(a);
  }
  static printed print(notation style, const printed& a) {
    return detail::printed_call(style, {"translation", ""}, a.text);
  }
};

} // namespace op

namespace detail {

template <Node N, Node Angle>
[[nodiscard]] constexpr auto turn_about(N n, Angle angle) {
  constexpr auto half = angle / whole<2>;
  return apply<op::turn>(n, angle, apply<op::sin>(half), apply<op::cos>(half));
}

} // namespace detail

/// The rigid motion by the angle θ about and along a screw n + ε(m + h n): a unit direction n, the
/// moment m = point × n and the pitch h, in units of length per radian. exp(½θ(n + …)) with sine
/// and cosine instead of exponentials. Directions of other lengths give garbage.
template <class L, class Angle, class Tag = decltype([](op::turn*) {})>
  requires Operands<L, Angle>
[[nodiscard]] constexpr auto screw(const L& line, const Angle& angle) {
  const auto l = detail::term<Tag>(line);
  const auto a = detail::term<Tag>(angle);
  static_assert(detail::kind_of_term<std::remove_cvref_t<decltype(l)>>() == kind::dual_vector,
                "duet: screw(line, angle) takes a dual vector n + εm, made by axis_through or "
                "make_dual_vector");
  return make_formula(detail::turn_about(detail::node_t<std::remove_cvref_t<decltype(l)>>{},
                                         detail::node_t<std::remove_cvref_t<decltype(a)>>{}),
                      merged(detail::held_of(l), detail::held_of(a)));
}
/// The rotation by θ about a unit vector n; other lengths give garbage.
template <class N, class Angle, class Tag = decltype([](op::turn*) {})>
  requires Operands<N, Angle>
[[nodiscard]] constexpr auto turn(const N& n, const Angle& angle) {
  const auto axis = detail::term<Tag>(n);
  const auto a = detail::term<Tag>(angle);
  static_assert(detail::kind_of_term<std::remove_cvref_t<decltype(axis)>>() == kind::vector,
                "duet: turn(n, angle) takes a unit vector; for lines there is screw(line, angle)");
  return make_formula(detail::turn_about(detail::node_t<std::remove_cvref_t<decltype(axis)>>{},
                                         detail::node_t<std::remove_cvref_t<decltype(a)>>{}),
                      merged(detail::held_of(axis), detail::held_of(a)));
}
/// The translation by d along a unit vector or line, a prismatic joint.
template <class N, class D, class Tag = decltype([](op::turn*) {})>
  requires Operands<N, D>
[[nodiscard]] constexpr auto slide(const N& n, const D& d) {
  const auto direction = detail::term<Tag>(n);
  if constexpr (DualVectorTerm<std::remove_cvref_t<decltype(direction)>>) {
    return apply<op::slide>(apply<op::part_of_dual<false>>(direction), detail::term<Tag>(d));
  } else {
    return apply<op::slide>(direction, detail::term<Tag>(d));
  }
}
/// The coordinate axes, lines through the origin, known to the compiler: `screw(axis::z, theta)`,
/// `slide(axis::x, 0.3)`.
namespace axis {

template <int I>
using coordinate = formula<unit_vector_node<kind::dual_vector, I>, held<>>;
inline constexpr coordinate<0> x{};
inline constexpr coordinate<1> y{};
inline constexpr coordinate<2> z{};

} // namespace axis

/// The line along n through a point, n + ε point × n, for `screw`.
[[nodiscard]] inline dual_vector<double> axis_through(const vector3<double>& point,
                                                      const vector3<double>& n) {
  return make_dual_vector(n, vector3<double>(point.cross(n)));
}
/// N17: the pose x ↦ q x q* + t.
template <class Q, class T, class Tag = decltype([](op::turn*) {})>
  requires Operands<Q, T>
[[nodiscard]] constexpr auto pose(const Q& q, const T& t) {
  return apply<op::make_pose>(detail::term<Tag>(q), detail::term<Tag>(t));
}
/// The rotation of a pose.
template <PoseTerm A>
[[nodiscard]] constexpr auto rotation(const A& a) {
  return apply<op::rotation>(a);
}
/// N17: the translation of a pose.
template <PoseTerm A>
[[nodiscard]] constexpr auto translation(const A& a) {
  return apply<op::translation>(a);
}
/// The point x carried along by a pose: R x + t.
template <PoseTerm A, class X, class Tag = decltype([](op::turn*) {})>
[[nodiscard]] constexpr auto transform_point(const A& a, const X& x) {
  return rotate(rotation(a), detail::term<Tag>(x)) + translation(a);
}
/// N19: a (a* b)^τ of poses.
template <class A, class B, class S, class TagA = decltype([](op::turn*) {}),
          class TagB = decltype([](op::turn*) {}), class TagS = decltype([](op::turn*) {})>
  requires Operands<A, B, S>
[[nodiscard]] constexpr auto sclerp(const A& a, const B& b, const S& tau) {
  return slerp<A, B, S, TagA, TagB, TagS>(a, b, tau);
}

} // namespace duet::expression
