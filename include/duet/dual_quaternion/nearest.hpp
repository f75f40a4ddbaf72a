// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/constants.hpp>
#include <duet/derivative/derivative.hpp>
#include <duet/dual_quaternion/distance.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/norm.hpp>

#include <boost/math/tools/minima.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <type_traits>

/// \file
/// The pose on a screw motion that is nearest to a given one.

namespace duet {

namespace detail {

/// A exp(½τ(φ + εd)(n + εm)) over the scalar of τ.
template <class T, class S>
[[nodiscard]] dual_quaternion<S> pose_on_screw(const dual_quaternion<T>& start,
                                               const screw_motion<T>& motion, const S& tau) {
  return dual_quaternion<S>(start) * from_screw(vector3<S>(motion.axis.template cast<S>()),
                                                vector3<S>(motion.moment.template cast<S>()),
                                                S(motion.angle * tau), S(motion.translation * tau));
}

/// The best of 32 places a turn, refined in the interval between its neighbours as far as values
/// can tell, to half the digits.
template <class R, class F>
[[nodiscard]] R coarse_minimum(const F& f, const R& angle) {
  using std::abs;
  const int cells = 32 * (1 + int(abs(double(angle)) / (2 * constant::pi<double>())));
  int best = 0;
  R least = f(R(0));
  for (int i = 1; i <= cells; ++i) {
    const R here = f(R(i) / R(cells));
    if (here < least) {
      least = here;
      best = i;
    }
  }
  const R low = R(best > 0 ? best - 1 : 0) / R(cells);
  const R high = R(best < cells ? best + 1 : cells) / R(cells);
  return boost::math::tools::brent_find_minima(f, low, high, std::numeric_limits<R>::digits / 2)
      .first;
}

/// e where the largest length is about 2^e and its square would overflow or vanish, otherwise 0.
template <class T>
[[nodiscard]] int extreme_exponent_of_lengths(const dual_quaternion<T>& start,
                                              const screw_motion<T>& motion,
                                              const dual_quaternion<T>& p, double length) {
  using std::abs;
  using R = real_type_t<T>;
  R largest = std::max(R(abs(length)), R(abs(innermost(motion.translation))));
  for (const vector3<T>& v : {translation(start), translation(p), motion.moment}) {
    for (int i = 0; i < 3; ++i) {
      largest = std::max(largest, R(abs(innermost(v[i]))));
    }
  }
  const int e = binary_exponent(largest);
  constexpr int limit = std::numeric_limits<R>::max_exponent;
  return abs(e) > 2 * (limit / 5) ? std::clamp(e, 4 - limit, limit - 4) : 0;
}

} // namespace detail

/// Where a screw motion comes nearest to a pose.
template <class T>
struct nearest_result {
  T tau = T(0);                 ///< the fraction of the motion, in [0, 1]
  dual_quaternion<T> pose = {}; ///< there
  T squared_distance = T(0);    ///< from there to the given pose, in squared units of length

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("tau", tau);
    f("pose", pose);
    f("squared_distance", squared_distance);
  }
};

namespace detail {

template <class T>
[[nodiscard]] nearest_result<T> nearest_place(const dual_quaternion<T>& start,
                                              const screw_motion<T>& motion,
                                              const dual_quaternion<T>& p, double length) {
  using R = real_type_t<T>;
  if (const int e = extreme_exponent_of_lengths(start, motion, p, length); e != 0) {
    using std::ldexp;
    const R unit = ldexp(R(1), -e);
    const auto in_unit = [&](const dual_quaternion<T>& a) {
      return duet::pose(rotation(a), vector3<T>(translation(a) * unit));
    };
    const screw_motion<T> scaled{motion.axis, vector3<T>(motion.moment * unit), motion.angle,
                                 T(motion.translation * unit), motion.kind};
    const T tau = nearest_place(in_unit(start), scaled, in_unit(p), double(length * unit)).tau;
    const dual_quaternion<T> there = pose_on_screw(start, motion, tau);
    return {tau, there, squared_distance(there, p, length)};
  }
  const auto distance_at = [&](const auto& tau) {
    using S = std::decay_t<decltype(tau)>;
    return squared_distance(pose_on_screw(start, motion, tau), dual_quaternion<S>(p), length);
  };
  T tau(coarse_minimum<R>([&](const R& t) { return innermost(distance_at(T(t))); },
                          innermost(motion.angle)));
  // Two steps of Newton's method give the value its other half of the digits, each further one an
  // order of derivatives.
  for (int step = 0; step < 2 + scalar_traits<T>::order; ++step) {
    const auto d = derivatives<2>(distance_at, tau);
    if (!(innermost(d[2]) > 0)) { // at an end, or all along the motion it is as far
      for (const int end : {0, 1}) {
        if (innermost(distance_at(T(R(end)))) <= innermost(d[0])) {
          tau = T(R(end));
        }
      }
      break;
    }
    tau = tau - d[1] / innermost(d[2]);
    if (!(innermost(tau) > 0 && innermost(tau) < 1)) {
      tau = T(R(innermost(tau) > 0 ? 1 : 0));
      break;
    }
  }
  const dual_quaternion<T> there = pose_on_screw(start, motion, tau);
  return {tau, there, squared_distance(there, p, length)};
}

} // namespace detail

/// The τ in [0, 1] at which the motion A exp(½τ(φ + εd)(n + εm)) is nearest to a pose P, by
/// `squared_distance`. Where it is not an end, derivatives follow from the equation that it solves;
/// where a whole part of the motion is equally near, they are zero.
///
/// \param start   A
/// \param motion  in body axes of A, as `screw_parameters(conj(A) * B)`; the angle, in radians, may
///                be many turns
/// \param length  how far a turn by one radian is
/// \return `nearest_result<T>`
/// \throws invalid_input where the length is negative or not finite
template <class A, Promotable<A> M, Promotable<A> P>
[[nodiscard]] auto nearest_on_screw(const dual_quaternion<A>& start, const screw_motion<M>& motion,
                                    const dual_quaternion<P>& p, double length) {
  using T = promote_t<promote_t<A, M>, P>;
  const screw_motion<T> over{motion.axis.template cast<T>(), motion.moment.template cast<T>(),
                             T(motion.angle), T(motion.translation), motion.kind};
  return detail::nearest_place(dual_quaternion<T>(start), over, dual_quaternion<T>(p), length);
}

} // namespace duet
