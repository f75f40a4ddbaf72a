// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/expression/algebra/product.hpp>
#include <duet/expression/algebra/scalar_factor.hpp>
#include <duet/expression/evaluate/pushforward.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/function.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>
#include <duet/expression/tree/printed.hpp>
#include <duet/expression/vector.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/rotation.hpp>

#include <string>
#include <type_traits>
#include <utility>

/// \file
/// Formulas of rotations, by unit quaternions, and of rigid motions, by unit dual quaternions: the
/// same operations (N1–N5, N9, N19), on vectors and on dual vectors.

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
  static constexpr kind kind_of(kind q) { return q; }
  template <class Q>
  static constexpr auto simplified(Q q) {
    if constexpr (is_applied<Q, conj>) {
      return operand<0>(q);
    } else if constexpr (is_zero<Q>) {
      return q;
    } else {
      return applied_node<conj, Q>{};
    }
  }
  template <class Q>
  DUET_ALWAYS_INLINE static constexpr auto value(const Q& q) {
    return duet::conj(q);
  }
  template <class Q, class DQ>
  static constexpr auto differential(Q, DQ dq) {
    return apply<conj>(dq);
  }
  static printed print(notation style, const printed& q) {
    return style == notation::latex
               ? printed{q.inside(precedence::atom) + "^{*}", precedence::power}
               : printed{"conj(" + q.text + ")"};
  }
};

/// The quaternion 0 + v.
struct pure {
  static constexpr kind kind_of(kind v) { return detail::quaternion_kind(v); }
  template <class V>
  DUET_ALWAYS_INLINE static auto value(const V& v) {
    using T = typename V::Scalar;
    return quaternion<T>(T(0), v[0], v[1], v[2]);
  }
  template <class V, class DV>
  static constexpr auto differential(V, DV dv) {
    return apply<pure>(dv);
  }
  static printed print(notation, const printed& v) { return v; }
};

/// The vector part.
struct vec {
  static constexpr kind kind_of(kind q) { return detail::vector_kind(q); }
  template <class Q>
  static constexpr auto simplified(Q q) {
    if constexpr (is_zero<Q>) {
      return zero_of<detail::vector_kind(Q::kind_of)>();
    } else if constexpr (is_applied<Q, pure>) {
      return operand<0>(q);
    } else {
      return applied_node<vec, Q>{};
    }
  }
  template <class Q>
  DUET_ALWAYS_INLINE static auto value(const Q& q) {
    return q.vec();
  }
  template <class Q, class DQ>
  static constexpr auto differential(Q, DQ dq) {
    return apply<vec>(dq);
  }
  static printed print(notation style, const printed& q) {
    return detail::printed_call(style, {"vec", ""}, q.text);
  }
};

/// exp(v), v half a rotation vector.
struct exp_vector {
  static constexpr kind kind_of(kind v) { return detail::quaternion_kind(v); }
  template <class V>
  static auto value(const V& v) {
    return duet::exp(v);
  }
  template <class V, class DV>
  static constexpr auto differential(V v, DV dv) {
    constexpr detail::direction_t<V> w;
    constexpr auto rate = detail::factor_of(dv, w);
    if constexpr (is_zero<std::remove_const_t<decltype(rate)>>) {
      return apply<pushforward<exp_vector, std::index_sequence<0>>>(v, dv);
    } else { // the axis stands still
      return rate * (apply<pure>(w) * apply<exp_vector>(v));
    }
  }
  static printed print(notation style, const printed& v) {
    return detail::printed_call(style, {"exp", "\\exp"}, v.text);
  }
};

struct log_quaternion {
  static constexpr kind kind_of(kind q) { return q; }
  template <class Q>
  static auto value(const Q& q) {
    return duet::log(q);
  }
  template <class Q, class DQ>
  static constexpr auto differential(Q q, DQ dq) {
    return apply<pushforward<log_quaternion, std::index_sequence<0>>>(q, dq);
  }
  static printed print(notation style, const printed& q) {
    return detail::printed_call(style, {"log", "\\log"}, q.text);
  }
};

/// q^ρ
struct power_of_quaternion {
  static constexpr kind kind_of(kind q, kind) { return q; }
  template <class Q, class S>
  static auto value(const Q& q, const S& exponent) {
    return duet::pow(q, exponent);
  }
  template <class Q, class S, class DQ, class DS>
  static constexpr auto differential(Q q, S s, DQ dq, DS ds) {
    if constexpr (is_zero<DQ>) {
      return ds * (apply<log_quaternion>(q) * apply<power_of_quaternion>(q, s));
    } else {
      return apply<pushforward<power_of_quaternion, std::index_sequence<0, 1>>>(q, s, dq, ds);
    }
  }
  static printed print(notation style, const printed& q, const printed& s) {
    return power::print(style, q, s);
  }
};

struct slerp {
  static constexpr kind kind_of(kind a, kind, kind) { return a; }
  template <class A, class B, class S>
  static auto value(const A& a, const B& b, const S& tau) {
    return duet::slerp(a, b, tau);
  }
  template <class A, class B, class S, class DA, class DB, class DS>
  static constexpr auto differential(A a, B b, S tau, DA da, DB db, DS dtau) {
    return apply<pushforward<slerp, std::index_sequence<0, 1, 2>>>(a, b, tau, da, db, dtau);
  }
  static printed print(notation style, const printed& a, const printed& b, const printed& tau) {
    return detail::printed_call(style, {"slerp", ""}, a.text + ", " + b.text + ", " + tau.text);
  }
};

/// q v q*; its derivative is told by velocities, see velocity.hpp.
struct rotate {
  static constexpr kind kind_of(kind, kind v) { return v; }
  template <class Q, class V>
  static constexpr auto simplified([[maybe_unused]] Q q, V v) {
    if constexpr (is_zero<V>) {
      return v;
    } else if constexpr (is_applied<V, product>) { // of a scalar
      return operand<0>(v) * apply<rotate>(q, operand<1>(v));
    } else if constexpr (is_applied<V, negative>) {
      return -apply<rotate>(q, operand<0>(v));
    } else {
      return applied_node<rotate, Q, V>{};
    }
  }
  template <class Q, class V>
  DUET_ALWAYS_INLINE static auto value(const Q& q, const V& v) {
    return duet::rotate(q, v);
  }
  static printed print(notation style, const printed& q, const printed& v) {
    if (style == notation::text) {
      return {"rotate(" + q.text + ", " + v.text + ")"};
    }
    const std::string turned = q.inside(precedence::product);
    return {turned + " " + v.inside(precedence::product) + " " +
                conj::print(style, {q.text, q.outermost, style}).text,
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

/// N2: q*, the inverse of a unit; of poses the first conjugate.
template <detail::QuaternionOrPose Q>
[[nodiscard]] constexpr auto conj(const Q& q) {
  return apply<op::conj>(q);
}
/// p · q, the product of quaternions as vectors of four components; of dual quaternions, as of
/// lines, a dual number.
template <class P, class Q, class Tag = decltype([](op::rotate*) {})>
  requires(Operands<P, Q> && (detail::QuaternionOrPose<P> || detail::QuaternionOrPose<Q>))
[[nodiscard]] constexpr auto dot(const P& p, const Q& q) {
  return apply<op::dot>(detail::term<Tag>(p), detail::term<Tag>(q));
}
/// N3: |q|, without overflow; of a dual quaternion a dual number (N16). Not differentiable at 0.
template <detail::QuaternionOrPose Q>
[[nodiscard]] constexpr auto norm(const Q& q) {
  return apply<op::norm>(q);
}
/// The vector part of a quaternion.
template <detail::QuaternionOrPose Q>
[[nodiscard]] constexpr auto vec(const Q& q) {
  return apply<op::vec>(q);
}
/// The quaternion 0 + v.
template <detail::AnyVector V>
[[nodiscard]] constexpr auto pure(const V& v) {
  return apply<op::pure>(v);
}
/// N4: exp(v), the rotation by 2|v| about v; of a dual vector, the rigid motion along that screw.
template <detail::AnyVector V>
[[nodiscard]] constexpr auto exp(const V& v) {
  return apply<op::exp_vector>(v);
}
/// N4: log q, in half angles.
template <detail::QuaternionOrPose Q>
[[nodiscard]] constexpr auto log(const Q& q) {
  return apply<op::log_quaternion>(q);
}
/// N5: q^ρ.
template <detail::QuaternionOrPose Q, class S, class Tag = decltype([](op::rotate*) {})>
  requires Operands<Q, S>
[[nodiscard]] constexpr auto pow(const Q& q, const S& exponent) {
  return apply<op::power_of_quaternion>(q, detail::term<Tag>(exponent));
}
/// N9: a (a* b)^τ the shorter way round.
template <class A, class B, class S, class TagA = decltype([](op::rotate*) {}),
          class TagB = decltype([](op::rotate*) {}), class TagS = decltype([](op::rotate*) {})>
  requires Operands<A, B, S>
[[nodiscard]] constexpr auto slerp(const A& a, const B& b, const S& tau) {
  return apply<op::slerp>(detail::term<TagA>(a), detail::term<TagB>(b), detail::term<TagS>(tau));
}
/// q v q*, v turned by the rotation; a line, screw or twist carried along by a rigid motion.
template <class Q, class V, class Tag = decltype([](op::rotate*) {})>
  requires Operands<Q, V>
[[nodiscard]] constexpr auto rotate(const Q& q, const V& v) {
  return apply<op::rotate>(detail::term<Tag>(q), detail::term<Tag>(v));
}

} // namespace duet::expression
