// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/constants.hpp>
#include <duet/core/errors.hpp>
#include <duet/derivative/derivative.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/quaternion/rotation.hpp>

#include <cmath>
#include <limits>
#include <sstream>
#include <type_traits>

/// \file
/// How far poses are from each other and from a screw motion.
///
/// There is no distance of poses without a choice: turning must be weighed against moving. Here a
/// turn by one radian is as far as a move by `length`, the size of the body, say.

namespace duet {

/// d² = |t_B − t_A|² + length² φ², φ ∈ [0, π] the angle between the rotations. Does not depend on
/// the fixed frame, but does on the body's, whose origin is compared. Smooth where φ < π.
/// \param length  of the same unit as the translations, at least 0
/// \throws invalid_input where the length is negative or not finite
template <class T>
[[nodiscard]] T squared_distance(const dual_quaternion<T>& a, const dual_quaternion<T>& b,
                                 double length) {
  if (!(length >= 0 && length - length == 0)) {
    std::ostringstream message;
    message << "duet: distance: length is " << length << ", not a number from 0 up";
    throw invalid_input(message.str());
  }
  const vector3<T> move = translation(b) - translation(a);
  const vector3<T> turn = rotation_vector(quaternion<T>(conj(rotation(a)) * rotation(b)));
  return move.dot(move) + real_type_t<T>(length * length) * turn.dot(turn);
}

/// d, the root of `squared_distance`: a metric of poses, in units of length. Its derivative at
/// d = 0 does not exist.
template <class T>
[[nodiscard]] T distance(const dual_quaternion<T>& a, const dual_quaternion<T>& b, double length) {
  using std::sqrt;
  return sqrt(squared_distance(a, b, length));
}

/// Where a screw motion comes nearest to a pose.
template <class T>
struct nearest_result {
  T tau;                   ///< the fraction of the motion, in [0, 1]
  dual_quaternion<T> pose; ///< there
  T squared_distance;      ///< from there to the given pose
};

/// The τ in [0, 1] at which the motion A exp(½τ(φ + εd)(n + εm)) is nearest to a pose P, by
/// `squared_distance`.
///
/// The motion may go round many times. Its turn is searched at 32 places each, the best of which
/// Newton's method and bisection refine; where τ is inside, derivatives follow from the equation
/// that it solves.
/// \param start   A
/// \param motion  in body axes of A, as `screw_parameters(conj(A) * B)`; the angle may be any
template <class T>
[[nodiscard]] nearest_result<T> nearest_on_screw(const dual_quaternion<T>& start,
                                                 const screw_motion<T>& motion,
                                                 const dual_quaternion<T>& p, double length) {
  using R = real_type_t<T>;
  using std::abs;
  const auto at = [&](const auto& tau) {
    using S = std::decay_t<decltype(tau)>;
    const dual_vector<S> half =
        make_dual_vector(vector3<S>(motion.axis.template cast<S>()),
                         vector3<S>(motion.moment.template cast<S>())) *
        screw_dual<S>(S(motion.angle * tau / 2), S(motion.translation * tau / 2));
    return dual_quaternion<S>(start) * duet::exp(half);
  };
  const auto slopes = [&](const T& tau) {
    return derivatives<2>(
        [&](const auto& t) {
          using S = std::decay_t<decltype(t)>;
          return squared_distance(at(t), dual_quaternion<S>(p), length);
        },
        tau);
  };
  const auto square = [&](const R& tau) {
    return innermost(squared_distance(at(T(tau)), p, length));
  };
  constexpr int per_turn = 32;
  const int cells =
      per_turn * (1 + int(abs(double(innermost(motion.angle))) / (2 * constant::pi<double>())));
  int best = 0;
  R least = square(R(0));
  for (int i = 1; i <= cells; ++i) {
    const R here = square(R(i) / R(cells));
    if (here < least) {
      least = here;
      best = i;
    }
  }
  R low = R(best > 0 ? best - 1 : 0) / R(cells);
  R high = R(best < cells ? best + 1 : cells) / R(cells);
  R tau = R(best) / R(cells);
  const auto slope_at = [&](const R& t) { return innermost(slopes(T(t))[1]); };
  const bool is_at_start = best == 0 && slope_at(R(0)) >= 0;
  const bool is_at_end = best == cells && slope_at(R(1)) <= 0;
  if (!is_at_start && !is_at_end) {
    for (int i = 0; i < 100 && high > low; ++i) {
      const auto d = slopes(T(tau));
      const R slope = innermost(d[1]);
      (slope > 0 ? high : low) = tau;
      const R step = -slope / innermost(d[2]);
      const R newton = tau + step;
      const R next = newton > low && newton < high ? newton : R((low + high) / 2);
      const bool is_done = abs(R(next - tau)) <= std::numeric_limits<R>::epsilon();
      tau = next;
      if (is_done) {
        break;
      }
    }
  }
  T result(tau);
  if (!is_at_start && !is_at_end) {
    for (int order = 1; order <= scalar_traits<T>::order; ++order) {
      const auto d = slopes(result);
      result = result - d[1] / innermost(d[2]);
    }
  }
  const dual_quaternion<T> there = at(result);
  return {result, there, squared_distance(there, p, length)};
}

} // namespace duet
