// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/expression/arithmetic.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/printed.hpp>
#include <duet/expression/vector.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/rotation.hpp>

#include <string>
#include <utility>

/// \file
/// Formulas of rotations, as unit quaternions, and of rigid motions, as unit dual quaternions: the
/// same operations (N1–N5, N9, N19) on vectors and on dual vectors.

namespace duet::expression {

namespace detail {

[[nodiscard]] constexpr kind vector_kind(kind k) {
  return k == kind::pose || k == kind::dual_vector ? kind::dual_vector : kind::vector;
}
[[nodiscard]] constexpr kind quaternion_kind(kind k) {
  return k == kind::pose || k == kind::dual_vector ? kind::pose : kind::quaternion;
}

} // namespace detail

namespace op {

struct conj {
  static constexpr detail::function_name name = {"conj", "#^{*}"};
  static constexpr kind kind_of(kind q) { return q; }
  static constexpr auto value(const auto& q) { return duet::conj(q); }
};

/// The quaternion 0 + v.
struct pure : linear_operation {
  static constexpr kind kind_of(kind v) { return detail::quaternion_kind(v); }
  template <class V>
  static auto value(const V& v) {
    using T = typename V::Scalar;
    return quaternion<T>(T(0), v[0], v[1], v[2]);
  }
  static printed print(notation, const printed& v) { return v; }
};

/// The vector part.
struct vec : linear_operation {
  static constexpr detail::function_name name = {"vec", ""};
  static constexpr kind kind_of(kind q) { return detail::vector_kind(q); }
  static constexpr auto simplified(auto q) {
    return q.template is<pure>() ? q.operand(0) : q.none();
  }
  static auto value(const auto& q) { return q.vec(); }
};

/// exp(v) of half a rotation vector v.
struct exp_vector {
  static constexpr detail::function_name name = {"exp", "e^{#}"};
  static constexpr kind kind_of(kind v) { return detail::quaternion_kind(v); }
  static auto value(const auto& v) { return duet::exp(v); }
  /// Derivative for a constant axis.
  static constexpr auto differential(auto v, auto dv) {
    const auto rate = rate_along(v, dv);
    return rate.is_zero() ? v.none() : rate * (apply<pure>(direction_of(v)) * apply<exp_vector>(v));
  }
};

struct log_quaternion {
  static constexpr detail::function_name name = {"log", "\\log"};
  static constexpr kind kind_of(kind q) { return q; }
  static auto value(const auto& q) { return duet::log(q); }
};

/// q^ρ
struct power_of_quaternion {
  static constexpr kind kind_of(kind q, kind) { return q; }
  static auto value(const auto& q, const auto& exponent) { return duet::pow(q, exponent); }
  static constexpr auto differential(auto q, auto s, auto dq, auto ds) {
    return dq.is_zero() ? ds * (apply<log_quaternion>(q) * apply<power_of_quaternion>(q, s))
                        : q.none();
  }
  static printed print(notation style, const printed& q, const printed& s) {
    return power::print(style, q, s);
  }
};

struct slerp {
  static constexpr detail::function_name name = {"slerp", ""};
  static constexpr kind kind_of(kind a, kind, kind) { return a; }
  static auto value(const auto& a, const auto& b, const auto& tau) {
    return duet::slerp(a, b, tau);
  }
};

/// q v q*
struct rotate {
  static constexpr kind kind_of(kind, kind v) { return v; }
  static constexpr auto simplified(auto q, auto v) {
    return v.is_zero()     ? v
           : v.is_scaled() ? v.scaled_outside([&](auto w) { return apply<rotate>(q, w); })
                           : v.none();
  }
  /// (q v q*)˙ = ω × q v q* + q v̇ q*, for unit q with the velocity ω in spatial axes.
  static constexpr auto rate_by_velocity(auto omega, auto q, auto v, auto, auto dv) {
    return apply<cross>(omega, apply<rotate>(q, v)) + apply<rotate>(q, dv);
  }
  static auto value(const auto& q, const auto& v) { return duet::rotate(q, v); }
  static printed print(notation style, const printed& q, const printed& v) {
    if (style == notation::text) {
      return {"rotate(" + q.text + ", " + v.text + ")"};
    }
    const std::string q_text = q.inside(precedence::product);
    return {q_text + " " + v.inside(precedence::product) + " " +
                detail::printed_operation<conj>(style, printed{q.text, q.outermost, style}).text,
            precedence::product};
  }
};

} // namespace op

namespace detail {

template <class T>
concept QuaternionOrPose = QuaternionTerm<T> || PoseTerm<T>;
template <class T>
concept AnyVector = VectorTerm<T> || DualVectorTerm<T>;

} // namespace detail

/// N2: q*, the inverse of a unit quaternion; of a pose the first conjugate.
[[nodiscard]] constexpr auto conj(const detail::QuaternionOrPose auto& q) {
  return apply<op::conj>(q);
}
/// p · q, the dot product of quaternions as vectors of four components; of dual quaternions a dual
/// number.
template <class P, class Q, class Tag = decltype([](op::rotate*) {})>
  requires(Operands<P, Q> && (detail::QuaternionOrPose<P> || detail::QuaternionOrPose<Q>))
[[nodiscard]] constexpr auto dot(const P& p, const Q& q) {
  return apply<op::dot>(detail::term<Tag>(p), detail::term<Tag>(q));
}
/// N3: |q|, without overflow; of a dual quaternion a dual number (N16). Not differentiable at 0.
[[nodiscard]] constexpr auto norm(const detail::QuaternionOrPose auto& q) {
  return apply<op::norm>(q);
}
/// The vector part of a quaternion.
[[nodiscard]] constexpr auto vec(const detail::QuaternionOrPose auto& q) {
  return apply<op::vec>(q);
}
/// The quaternion 0 + v.
[[nodiscard]] constexpr auto pure(const detail::AnyVector auto& v) { return apply<op::pure>(v); }
/// N4: exp(v), the rotation by 2|v| about v; of a dual vector, the rigid motion about and along
/// that screw.
[[nodiscard]] constexpr auto exp(const detail::AnyVector auto& v) {
  return apply<op::exp_vector>(v);
}
/// N4: log q, half the rotation vector as a quaternion.
[[nodiscard]] constexpr auto log(const detail::QuaternionOrPose auto& q) {
  return apply<op::log_quaternion>(q);
}
/// N5: q^ρ.
template <detail::QuaternionOrPose Q, class S, class Tag = decltype([](op::rotate*) {})>
  requires Operands<Q, S>
[[nodiscard]] constexpr auto pow(const Q& q, const S& exponent) {
  return apply<op::power_of_quaternion>(q, detail::term<Tag>(exponent));
}
/// N9: a (a* b)^τ along the shorter arc.
template <class A, class B, Operands<A, B> S, class Tag = decltype([](op::rotate*) {})>
[[nodiscard]] constexpr auto slerp(const A& a, const B& b, const S& tau) {
  return detail::apply_to<op::slerp, Tag>(std::index_sequence_for<A, B, S>{}, a, b, tau);
}
/// q v q*: v rotated by q, or a line, screw or twist displaced by a rigid motion.
template <class Q, Operands<Q> V, class Tag = decltype([](op::rotate*) {})>
[[nodiscard]] constexpr auto rotate(const Q& q, const V& v) {
  return apply<op::rotate>(detail::term<Tag>(q), detail::term<Tag>(v));
}

} // namespace duet::expression
