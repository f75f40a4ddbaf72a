// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/constants.hpp>
#include <duet/derivative/derivative.hpp>
#include <duet/dual_quaternion/distance.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/norm.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <type_traits>
#include <vector>

/// \file
/// Nearest pose on a screw motion to a given pose.

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

/// Finds all minima of the squared distance f(τ) of a screw motion and a pose, over real numbers.
template <class R>
class distance_minima {
public:
  distance_minima(const dual_quaternion<R>& start, const screw_motion<R>& motion,
                  const dual_quaternion<R>& p, double characteristic_length)
      : start_(start), motion_(motion), p_(p), characteristic_length_(characteristic_length) {}

  /// The τ in [0, 1] that minimises f.
  ///
  /// f is (τd − h)², h the height of P along the axis, and a function of period 2π of the angle τφ.
  /// If a minimum is farther than a full turn from the τ in [0, 1] nearest to h/d, another one is
  /// nearer, so two full turns are searched at most. In each, the angle between the rotations
  /// has one kink, at its maximum π; elsewhere f is smooth, and between samples 1/32 of a full turn
  /// apart f′ has at most one zero or one extremum.
  [[nodiscard]] R minimizer() {
    using std::abs;
    using std::atan2;
    using std::ceil;
    const R full_turn =
        2 * constant::pi<R>() / abs(motion_.angle); // infinite if there is no rotation
    const R height = motion_.axis.dot(translation(dual_quaternion<R>(conj(start_) * p_)));
    const R ratio = motion_.translation != 0 ? R(height / motion_.translation) : R(0);
    const R centre = ratio > 0 ? std::min(ratio, R(1)) : R(0);
    const R low = std::max(R(centre - full_turn), R(0)),
            high = std::min(R(centre + full_turn), R(1));
    const int cells = high - low > full_turn ? 64 : 32;
    std::vector<R> taus;
    for (int i = 0; i < cells; ++i) {
      taus.push_back(low + (high - low) * R(i) / R(cells));
    }
    taus.push_back(high);
    // The scalar part of P* A exp(½τφ n), w cos ½τφ − v·n sin ½τφ, is 0 at the kinks.
    const quaternion<R> q = rotation(dual_quaternion<R>(conj(p_) * start_));
    const R along = vector3<R>(q.x(), q.y(), q.z()).dot(motion_.axis);
    const R kink = 2 * atan2(q.w(), along) / motion_.angle;
    const R first = ceil((low - kink) / full_turn);
    for (const double k : {-1e-9, 1e-9, 1 - 1e-9, 1 + 1e-9, 2 - 1e-9, 2 + 1e-9}) {
      if (const R tau = kink + (first + R(k)) * full_turn; tau > low && tau < high) {
        taus.push_back(tau);
      }
    }
    std::sort(taus.begin(), taus.end());
    keep(low);
    keep(high);
    point left = at(taus.front());
    for (std::size_t i = 1; i < taus.size(); ++i) {
      const point right = at(taus[i]);
      search_between(left, right);
      left = right;
    }
    return best_;
  }

private:
  /// f, f′ and f″ at τ.
  struct point {
    R tau;
    std::array<R, 3> f;
  };
  [[nodiscard]] point at(const R& tau) const {
    return {tau, derivatives<2>(
                     [&](const auto& t) {
                       using S = std::decay_t<decltype(t)>;
                       return squared_distance(pose_on_screw(start_, motion_, t),
                                               dual_quaternion<S>(p_), characteristic_length_);
                     },
                     tau)};
  }

  void keep(const R& tau) {
    const R f = squared_distance(pose_on_screw(start_, motion_, tau), p_, characteristic_length_);
    if (!(f >= min_distance_)) {
      min_distance_ = f;
      best_ = tau;
    }
  }

  /// Keeps the minima between two points.
  void search_between(point left, point right) {
    // If f′ has one sign at both ends but an extremum between them, two of its zeros may lie
    // on either side of the extremum. Bisection finds the extremum.
    while (left.f[1] * right.f[1] > 0 && left.f[1] * left.f[2] < 0 && right.f[1] * right.f[2] > 0) {
      const point midpoint = at(R(left.tau + (right.tau - left.tau) / 2));
      if (!(midpoint.tau > left.tau && midpoint.tau < right.tau)) {
        return;
      }
      if (!(midpoint.f[1] * left.f[1] > 0)) {
        refine(left, midpoint);
        refine(midpoint, right);
        return;
      }
      (midpoint.f[1] * midpoint.f[2] < 0 ? left : right) = midpoint;
    }
    refine(left, right);
  }

  /// Keeps the minimum between a point where f decreases and one where it increases, by Newton's
  /// method with bisection if a step would leave the interval.
  void refine(point low, point high) {
    if (!(low.f[1] < 0 && high.f[1] >= 0)) {
      return;
    }
    using std::abs;
    point x = low;
    for (int step = 0; step < 200; ++step) {
      R next = x.tau - x.f[1] / x.f[2];
      if (!(next > low.tau && next < high.tau)) {
        next = low.tau + (high.tau - low.tau) / 2;
      }
      if (!(next > low.tau && next < high.tau) ||
          abs(next - x.tau) <= 2 * std::numeric_limits<R>::epsilon() * abs(next)) {
        break;
      }
      x = at(next);
      (x.f[1] < 0 ? low : high) = x;
    }
    keep(x.tau);
  }

  dual_quaternion<R> start_;
  screw_motion<R> motion_;
  dual_quaternion<R> p_;
  double characteristic_length_;
  R best_ = 0, min_distance_ = std::numeric_limits<R>::infinity();
};

/// e if the largest length is about 2^e and its square would overflow or vanish, otherwise 0.
template <class T>
[[nodiscard]] int
extreme_exponent_of_lengths(const dual_quaternion<T>& start, const screw_motion<T>& motion,
                            const dual_quaternion<T>& p, double characteristic_length) {
  using std::abs;
  using R = real_type_t<T>;
  R largest = std::max(R(abs(characteristic_length)), R(abs(innermost(motion.translation))));
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

/// Nearest pose on a screw motion.
template <class T>
struct nearest_result {
  T tau = T(0);                 ///< fraction of the motion, in [0, 1]
  dual_quaternion<T> pose = {}; ///< pose at τ
  T squared_distance = T(0);    ///< squared distance to the given pose, in squared units of length

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("tau", tau);
    f("pose", pose);
    f("squared_distance", squared_distance);
  }
};

namespace detail {

template <class T>
[[nodiscard]] nearest_result<T>
find_nearest(const dual_quaternion<T>& start, const screw_motion<T>& motion,
             const dual_quaternion<T>& p, double characteristic_length) {
  using R = real_type_t<T>;
  if (const int e = extreme_exponent_of_lengths(start, motion, p, characteristic_length); e != 0) {
    using std::ldexp;
    const R unit = ldexp(R(1), -e);
    const auto in_unit = [&](const dual_quaternion<T>& a) {
      return duet::pose(rotation(a), vector3<T>(translation(a) * unit));
    };
    const screw_motion<T> scaled{motion.axis, vector3<T>(motion.moment * unit), motion.angle,
                                 T(motion.translation * unit), motion.kind};
    const T tau =
        find_nearest(in_unit(start), scaled, in_unit(p), double(characteristic_length * unit)).tau;
    const dual_quaternion<T> nearest = pose_on_screw(start, motion, tau);
    return {tau, nearest, squared_distance(nearest, p, characteristic_length)};
  }
  const auto distance_at = [&](const auto& tau) {
    using S = std::decay_t<decltype(tau)>;
    return squared_distance(pose_on_screw(start, motion, tau), dual_quaternion<S>(p),
                            characteristic_length);
  };
  const auto number = [](const T& x) { return R(innermost(x)); };
  const auto numbers = [&](const dual_quaternion<T>& a) {
    const auto part = [&](const screw_dual<T>& x) {
      return screw_dual<R>(number(x.value()), number(x.epsilon()));
    };
    return dual_quaternion<R>(part(a.w()), part(a.x()), part(a.y()), part(a.z()));
  };
  const screw_motion<R> values{motion.axis.unaryExpr(number), motion.moment.unaryExpr(number),
                               number(motion.angle), number(motion.translation), motion.kind};
  T tau(distance_minima<R>(numbers(start), values, numbers(p), characteristic_length).minimizer());
  // The real part has converged. Each step of Newton's method adds an order of derivatives.
  for (int step = 0; step < scalar_traits<T>::order; ++step) {
    const auto d = derivatives<2>(distance_at, tau);
    if (!(innermost(d[2]) > 0)) { // at an end, or at constant distance along the motion
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
  const dual_quaternion<T> nearest = pose_on_screw(start, motion, tau);
  return {tau, nearest, squared_distance(nearest, p, characteristic_length)};
}

} // namespace detail

/// The τ in [0, 1] at which the motion A exp(½τ(φ + εd)(n + εm)) is nearest to a pose P, by
/// `squared_distance`. If τ is not an end, derivatives follow from the equation that it solves; if
/// an entire part of the motion is equally near, they are zero.
///
/// \param start   A
/// \param motion  in body axes of A, as `screw_parameters(conj(A) * B)`; the angle, in radians, may
///   exceed a full turn
/// \param characteristic_length  translation that counts as much as a rotation by 1 rad
/// \return `nearest_result<T>`
/// \throws invalid_input if the characteristic length is negative or not finite
template <class A, Promotable<A> M, Promotable<A> P>
[[nodiscard]] auto nearest_on_screw(const dual_quaternion<A>& start, const screw_motion<M>& motion,
                                    const dual_quaternion<P>& p, double characteristic_length) {
  using T = promote_t<promote_t<A, M>, P>;
  const screw_motion<T> over{motion.axis.template cast<T>(), motion.moment.template cast<T>(),
                             T(motion.angle), T(motion.translation), motion.kind};
  return detail::find_nearest(dual_quaternion<T>(start), over, dual_quaternion<T>(p),
                              characteristic_length);
}

} // namespace duet
