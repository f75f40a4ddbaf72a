// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/batch.hpp>
#include <duet/core/config.hpp>
#include <duet/core/constants.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/derivative/manifold.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual/rules/elementary.hpp>
#include <duet/dual/stumpff.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rate.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

/// \file
/// Exponential, logarithm, powers (N4, N5) and spherical interpolation `slerp` (N9), in half
/// angles.
///
/// All are computed from s = v·v by functions that are regular at s = 0, so the identity, a pure
/// translation and every order of derivative need no special case.

namespace duet::detail {

template <class R>
struct undetermined_rule {
  R chosen;

  template <class T>
  T value(const T&, const T&, const T&) const {
    return T(chosen);
  }
  template <class T>
  std::array<T, 3> slopes(const T&, const T&, const T&, const T&) const {
    const T nan(std::numeric_limits<real_type_t<T>>::quiet_NaN());
    return {nan, nan, nan};
  }
};

/// `chosen`, to which the values at neighbouring x, y, z do not tend: its derivatives are NaN,
/// except with respect to variables that x, y and z do not depend on.
template <class T>
[[nodiscard]] T undetermined(const real_type_t<T>& chosen, const T& x, const T& y, const T& z) {
  if constexpr (Infinitesimal<T>) {
    return lift(undetermined_rule<real_type_t<T>>{chosen}, x, y, z);
  } else {
    return chosen;
  }
}

} // namespace duet::detail

namespace duet {

/// Exponential of a pure quaternion, exp(v) = cos|v| + v sin|v|/|v| (N4), v half the rotation
/// vector.
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE quaternion<detail::differentiable_t<T>> exp(const vector3<T>& v) {
  const detail::differentiable_t<T> s = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  const auto c = detail::first_stumpff_pair(s);
  return {c[0], v[0] * c[1], v[1] * c[1], v[2] * c[1]};
}

/// Exponential exp(w + v) = e^w (cos|v| + v sin|v|/|v|) (N4).
template <class T>
[[nodiscard]] quaternion<T> exp(const quaternion<T>& q) {
  using std::exp;
  return duet::exp(q.vec()) * T(exp(q.w()));
}

namespace detail {

/// exp(b v). If v does not depend on all variables of b, derivatives with respect to b cost no more
/// than those of a sine and a cosine.
template <class S, class T>
[[nodiscard]] DUET_ALWAYS_INLINE quaternion<promote_t<T, S>> exp_of_multiple(const S& b,
                                                                             const vector3<T>& v) {
  const auto u = universal_functions<2>(b, T(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
  return {u[0], v[0] * u[1], v[1] * u[1], v[2] * u[1]};
}

/// Unit vector û along the vector part of q; undetermined if that is zero.
template <class T>
[[nodiscard]] quaternion<T> axis_of(const quaternion<T>& q) {
  using real = real_type_t<T>;
  const quaternion<T> v(T(0), q.x(), q.y(), q.z());
  const auto component = [&](int value) { return undetermined(real(value), q.x(), q.y(), q.z()); };
  return normalized(select(
      is_zero(v), [&] { return quaternion<T>(T(0), component(1), component(0), component(0)); },
      [&] { return v; }));
}

/// û φ, the vector part of log q; `s` = |q⃗|², `square` = |q|². Near a full turn |v|⁻³ and higher
/// powers in the derivatives with respect to s would overflow before those with respect to v do.
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE vector3<T> log_vector(const quaternion<T>& q, const T& s,
                                                       const T& square, const char* function) {
  using real = real_type_t<T>;
  const real& value = innermost(square);
  return by_range(
      is_moderate(value) && !(innermost(q.w()) < 0 && innermost(s) < value * min_moderate<real>()),
      q,
      [&]() DUET_INLINE_LAMBDA {
        const T ratio = arc_ratio(s, q.w());
        return vector3<T>(q.x() * ratio, q.y() * ratio, q.z() * ratio);
      },
      [=]<class P>(const quaternion<P>& near_one, int) {
        require_not_zero(near_one, function);
        const quaternion<P> v(P(0), near_one.x(), near_one.y(), near_one.z());
        const P of_v = squared_norm(v);
        return select(
            innermost(near_one.w()) > 0 || innermost(of_v) > min_moderate<real_type_t<P>>(),
            [&] {
              const P ratio = arc_ratio(of_v, near_one.w());
              return vector3<P>(v.x() * ratio, v.y() * ratio, v.z() * ratio);
            },
            [&] { // atan2(|v|, w) = π − atan2(|v|, −w)
              const P shorter_arc = arc_ratio(of_v, P(-near_one.w()));
              const quaternion<P> half_turn = axis_of(near_one) * constant::pi<real_type_t<P>>();
              return vector3<P>((half_turn - v * shorter_arc).vec());
            });
      });
}
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE vector3<T> log_vector(const quaternion<T>& q,
                                                       const char* function) {
  const T s = q.x() * q.x() + q.y() * q.y() + q.z() * q.z();
  return log_vector(q, s, T(s + q.w() * q.w()), function);
}

/// log|q|; `square` = |q|².
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE T log_norm(const quaternion<T>& q, const T& square) {
  using std::log;
  return by_range(
      is_moderate(innermost(square)), q, [&]() DUET_INLINE_LAMBDA { return T(log(square) / 2); },
      []<class P>(const quaternion<P>& near_one, int e) {
        using real = real_type_t<P>;
        return P(log(squared_norm(near_one)) / 2 + real(e) * constant::ln2<real>());
      });
}

} // namespace detail

/// Logarithm log q = log|q| + û φ, φ = atan2(|q⃗|, q₀) ∈ [0, π] (N4): the inverse of exp, in half
/// angles.
///
/// Never flips the sign of q, so log(−q) belongs to the longer arc. Singular at q = −|q|, a full
/// turn, where the axis is undetermined: the value there is (log|q|, π, 0, 0), and derivatives with
/// respect to the vector part are NaN.
///
/// \throws invalid_input for the zero quaternion
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE quaternion<T> log(const quaternion<T>& q) {
  const T s = q.x() * q.x() + q.y() * q.y() + q.z() * q.z();
  const T square = s + q.w() * q.w();
  const vector3<T> v = detail::log_vector(q, s, square, "log");
  return {detail::log_norm(q, square), v[0], v[1], v[2]};
}

namespace detail {

/// The vector part of log(a* b), or of log(−a* b) if b is on the other side; `cosine` = a·b.
template <class A, class B, class T, class Side>
[[nodiscard]] DUET_ALWAYS_INLINE vector3<T> half_arc(const quaternion<A>& a, const quaternion<B>& b,
                                                     const T& cosine, const Side& other_side,
                                                     const char* function) {
  if (surely_any(innermost(cosine) == 0)) [[unlikely]] {
    require_not_zero(b, function);
  }
  // a* a has no vector part. Subtracting it first avoids cancellation for a small rotation.
  // Lanes of a batch may differ in sign, and recorded numbers have either.
  using end = std::conditional_t<Batched<T> || is_recording<real_type_t<T>>, T, B>;
  const quaternion<end> aligned = select(
      other_side, [&] { return quaternion<end>(-b); }, [&] { return quaternion<end>(b); });
  const quaternion<T> difference = conj(a) * (aligned - a);
  const T w = select(
      other_side, [&] { return T(-cosine); }, [&] { return cosine; });
  return log_vector(quaternion<T>(w, difference.x(), difference.y(), difference.z()), function);
}

template <class T, class S>
[[nodiscard]] DUET_ALWAYS_INLINE quaternion<promote_t<T, S>>
pow_of_regular(const quaternion<T>& q, const vector3<T>& v, const S& exponent) {
  using std::pow;
  using R = promote_t<T, S>;
  return duet::exp(vector3<R>(v[0] * exponent, v[1] * exponent, v[2] * exponent)) *
         R(pow(norm(q), exponent));
}

/// q^ρ away from a full turn, as q^n q^(ρ−n) with the integer n ≤ 3 nearest to ρ > 0, so that
/// nothing cancels in the k-th derivative, which vanishes with ρ (ρ − 1) … (ρ − k + 1).
template <class T, class S>
[[nodiscard]] DUET_ALWAYS_INLINE quaternion<promote_t<T, S>> pow_by_integer(const quaternion<T>& q,
                                                                            const S& exponent) {
  using R = promote_t<T, S>;
  const auto v = log_vector(q, "pow");
  if constexpr (!Infinitesimal<R>) {
    return pow_of_regular(q, v, exponent);
  } else {
    using real = real_type_t<R>;
    const real value(innermost(exponent));
    const real square(innermost(squared_norm(q)));
    const auto reaches = [&](int k) { return value > real(k) - real(0.5) && is_moderate(square); };
    real integer(0);
    for (int k = 1; k <= 3; ++k) {
      integer = select(
          reaches(k), [&] { return real(k); }, [&] { return integer; });
    }
    quaternion<R> power = pow_of_regular(q, v, exponent - integer);
    for (int k = 1; k <= 3; ++k) {
      power = select(
          reaches(k), [&] { return quaternion<R>(power * q); }, [&] { return power; });
    }
    return power;
  }
}

/// q^ρ = (−1)^n exp(ûπ(ρ − n)) (−q)^ρ with the integer n nearest to ρ.
///
/// Near a full turn û varies arbitrarily fast with q; the last factor, being near 1, does not
/// depend on û, and for integer ρ the power does not depend on û at all.
template <class T, class S>
[[nodiscard]] quaternion<promote_t<T, S>> pow_near_full_turn(const quaternion<T>& q,
                                                             const S& exponent) {
  using std::cos;
  using std::fmod;
  using std::round;
  using std::sin;
  using R = promote_t<T, S>;
  using real = real_type_t<R>;
  const real integer = round(real(innermost(exponent)));
  const auto rest = exponent - integer;
  const auto power = pow_by_integer(-q, exponent);
  const auto half_turns = select(
      fmod(integer, real(2)) == 0, [&] { return power; }, [&] { return -power; });
  return select(
      is_structural_zero(rest), [&] { return half_turns; },
      [&] {
        const R angle = constant::pi<real>() * rest;
        return (quaternion<R>(cos(angle)) + axis_of(q) * R(sin(angle))) * half_turns;
      });
}

} // namespace detail

/// Power q^ρ = |q|^ρ (cos ρφ + û sin ρφ) (N5), ρ any scalar. At q = −|q| the axis û is
/// undetermined: x is chosen, and derivatives are NaN unless ρ is an integer.
///
/// \throws invalid_input for the zero quaternion
template <class T, ScalarFor<T> S>
[[nodiscard]] quaternion<promote_t<T, S>> pow(const quaternion<T>& q, const S& exponent) {
  const auto rho = detail::as_constant<promote_t<T, S>>(exponent);
  const auto s = innermost(q.x()) * innermost(q.x()) + innermost(q.y()) * innermost(q.y()) +
                 innermost(q.z()) * innermost(q.z());
  return select(
      innermost(q.w()) < 0 && 64 * s < innermost(q.w()) * innermost(q.w()),
      [&] {
        return detail::by_lane(
            [](const auto& p, const auto& r) { return detail::pow_near_full_turn(p, r); }, q, rho);
      },
      [&]() DUET_INLINE_LAMBDA { return detail::pow_by_integer(q, rho); });
}

/// Arc taken by `slerp`: q and −q are the same rotation, reached by two arcs.
enum class slerp_arc {
  shortest, ///< shorter arc: the sign of b is aligned with that of a
  longest,  ///< longer arc
  as_given  ///< arc of the given signs of a and b
};

/// True if two rotations, or those of two poses, are half a turn apart within a tolerance in
/// radians, so that neither arc between them is the shorter.
template <class A, class B>
[[nodiscard]] auto differs_by_half_turn(const quaternion<A>& a, const quaternion<B>& b,
                                        double tolerance = 1e-9) {
  using std::abs;
  return 2 * abs(innermost(dot(a, b))) <= tolerance;
}

/// SLERP, spherical linear interpolation from a to b, both of unit norm: a (a* b)^τ (N9), along the
/// shorter arc by default. If a and b are exactly half a turn apart, both arcs have the same length
/// and the sign of b is kept, see `differs_by_half_turn`.
///
/// \throws invalid_input if a or b is zero
/// \return `quaternion<T>`
template <class A, class B, class S>
  requires Promotable<A, B> && ScalarFor<S, promote_t<A, B>>
[[nodiscard]] auto slerp(const quaternion<A>& a, const quaternion<B>& b, const S& tau,
                         slerp_arc arc = slerp_arc::shortest) {
  using T = promote_t<A, B>;
  const T cosine = dot(a, b);
  const auto other_side = (arc == slerp_arc::shortest && innermost(cosine) < 0) ||
                          (arc == slerp_arc::longest && innermost(cosine) > 0);
  const vector3<T> v = detail::half_arc(a, b, cosine, other_side, "slerp");
  using R = promote_t<T, S>;
  const auto t = detail::as_constant<R>(tau);
  return a * duet::exp(vector3<R>(v[0] * t, v[1] * t, v[2] * t));
}

/// Tangent space of unit quaternions: a small rotation vector δ is a left perturbation exp(δ/2) q
/// in spatial and hybrid axes, a right perturbation q exp(δ/2) in body axes. Rates are angular
/// velocities (N7). (Defined here so that every user of rotations can differentiate with respect to
/// them.)
template <class T>
  requires(!detail::contains_tag<T, screw_tag>())
struct manifold<quaternion<T>> {
  static constexpr int dimension = 3;
  using scalar = T;
  template <class Delta, class Frame = spatial_frame>
  [[nodiscard]] static auto plus(const quaternion<T>& q, const Delta& delta, Frame frame = {}) {
    using S = std::decay_t<decltype(delta[0])>;
    const auto small_rotation = duet::exp(vector3<S>(delta[0] / 2, delta[1] / 2, delta[2] / 2));
    return detail::composed_in(detail::rotation_frame_of(frame), small_rotation, q);
  }
  static constexpr bool takes_rates_of_any_scalar = true;
  template <class R, class Frame>
  [[nodiscard]] static vector3<promote_t<T, R>> velocity(const quaternion<T>& q,
                                                         const quaternion<R>& rate, Frame frame) {
    return angular_velocity(q, rate, detail::rotation_frame_of(frame));
  }
};

DUET_REFUSES_FOREIGN(exp, quaternion<double>)
DUET_REFUSES_FOREIGN(log, quaternion<double>)
DUET_REFUSES_FOREIGN(slerp, quaternion<double>)

} // namespace duet
