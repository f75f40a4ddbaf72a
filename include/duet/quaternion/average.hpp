// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/select.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/exponential_jacobian.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <vector>

/// \file
/// Karcher (Fréchet) means of rotations and of poses.

namespace duet {

namespace detail {

inline void require_weights(const char* function, std::size_t count,
                            const std::vector<double>& weights) {
  require(count > 0, "duet: ", function, ": there are no elements");
  require(weights.empty() || weights.size() == count, "duet: ", function, ": ", weights.size(),
          " weights for ", count, " elements (expected as many weights as elements)");
  for (std::size_t i = 0; i < weights.size(); ++i) {
    require(weights[i] >= 0 && weights[i] <= std::numeric_limits<double>::max(), "duet: ", function,
            ": weight ", i, " is ", weights[i], " (expected a finite number >= 0)");
  }
  require(weights.empty() || *std::max_element(weights.begin(), weights.end()) > 0,
          "duet: ", function, ": all weights are 0 (expected at least one positive weight)");
}

/// Newton's method for the Karcher mean of real rotations, with the inverse Jacobian of its last
/// equation, which also gives the infinitesimal parts of the mean.
template <class R>
struct rotation_mean {
  quaternion<R> value;
  matrix3<R> inverse_jacobian;

  rotation_mean(const std::vector<quaternion<R>>& q, const std::vector<R>& weights)
      : value(start(q, weights)), inverse_jacobian(matrix3<R>::Identity()) {
    constexpr int max_iterations = 50;
    R last_step = std::numeric_limits<R>::max();
    for (int i = 0; i < max_iterations; ++i) {
      vector3<R> residual = vector3<R>::Zero();
      matrix3<R> jacobian = matrix3<R>::Zero();
      for (std::size_t k = 0; k < q.size(); ++k) {
        const vector3<R> r = rotation_vector(quaternion<R>(conj(value) * q[k]));
        residual += weights[k] * r;
        jacobian += weights[k] * left_jacobian_inverse(r);
      }
      inverse_jacobian = jacobian.inverse();
      const vector3<R> step = inverse_jacobian * residual;
      const R length = step.norm();
      value = normalized(quaternion<R>(value * duet::exp(vector3<R>(step / R(2)))));
      // Quadratic convergence ends in round-off: the last step is not shorter than the previous
      // one.
      if (length <= 8 * std::numeric_limits<R>::epsilon() ||
          (length < R(1e-10) && length >= last_step)) {
        return;
      }
      last_step = length;
    }
    raise(no_convergence(message("duet: average: Newton's method does not converge in ",
                                 max_iterations, " steps (last step ", last_step,
                                 " rad): the rotations are too far apart")));
  }

private:
  /// Initial guess: the weighted sum of all quaternions, with signs aligned to the one of largest
  /// weight so that the sum is not zero.
  static quaternion<R> start(const std::vector<quaternion<R>>& q, const std::vector<R>& weights) {
    const auto heaviest = std::max_element(weights.begin(), weights.end()) - weights.begin();
    const quaternion<R>& reference = q[std::size_t(heaviest)];
    quaternion<R> sum;
    for (std::size_t k = 0; k < q.size(); ++k) {
      sum = sum + q[k] * (dot(reference, q[k]) < 0 ? R(-weights[k]) : weights[k]);
    }
    return normalized(sum);
  }
};

} // namespace detail

/// Karcher (Fréchet) mean m of unit quaternions, that is of rotations or of poses:
/// Σ wᵢ log(m* qᵢ) = 0, each qᵢ with the sign nearer to m.
///
/// For rotations, m minimises the sum of squared angles and is unique if all are less than a
/// quarter turn from one common rotation. If they are farther apart, the equation may have several
/// solutions, of which one is returned. For poses, m is the bi-invariant mean: a rigid motion of
/// all poses, from the left or from the right, moves the mean with them, and the rotation of m is
/// the mean of the rotations. Infinitesimal parts, those of poses among them, follow from the
/// equation, not from the iteration.
///
/// \param weights  wᵢ ≥ 0, up to a common factor; empty (the default) for equal weights
/// \throws invalid_input if there are no elements, if elements are not finite, and if weights are
///   negative, not finite, all zero or not as many as the elements
/// \throws no_convergence if the rotations are too far apart
template <class T>
[[nodiscard]] quaternion<T> average(const std::vector<quaternion<T>>& q,
                                    const std::vector<double>& weights = {}) {
  using R = real_type_t<T>;
  detail::require_weights("average", q.size(), weights);
  // Relative to the largest weight, so that the sum does not overflow.
  const double largest = weights.empty() ? 1 : *std::max_element(weights.begin(), weights.end());
  double sum = 0;
  for (std::size_t k = 0; k < q.size(); ++k) {
    sum += weights.empty() ? 1 : weights[k] / largest;
  }
  std::vector<R> w;
  std::vector<quaternion<R>> values;
  for (std::size_t k = 0; k < q.size(); ++k) {
    detail::require(detail::is_all_finite(q[k]), "duet: average: element ", k,
                    " is not finite: ", q[k]);
    w.push_back(R(weights.empty() ? 1 : weights[k] / largest) / R(sum));
    values.push_back(detail::innermost_of(q[k]));
  }
  const detail::rotation_mean<R> mean(values, w);
  quaternion<T> m(mean.value);
  for (int order = 1; order <= scalar_traits<T>::order; ++order) {
    vector3<T> residual = vector3<T>::Zero();
    for (std::size_t k = 0; k < q.size(); ++k) {
      const quaternion<T> aligned = select(
          dot(mean.value, values[k]) < 0, [&] { return -q[k]; }, [&] { return q[k]; });
      const vector3<T> half = detail::log_vector(quaternion<T>(conj(m) * aligned), "average");
      for (int i = 0; i < 3; ++i) {
        residual[i] += w[k] * half[i];
      }
    }
    m = m * duet::exp(vector3<T>(mean.inverse_jacobian.template cast<T>() * residual));
  }
  return m;
}

/// Karcher mean of listed elements, `average({p, q})`; otherwise as for a vector.
template <class T>
[[nodiscard]] quaternion<T> average(std::initializer_list<quaternion<T>> q,
                                    const std::vector<double>& weights = {}) {
  return average(std::vector<quaternion<T>>(q), weights);
}

template <class T, class... More>
DUET_REFUSED("average takes a list or vector of quaternions: average({p, q})")
quaternion<T> average(const quaternion<T>&, const More&...);
template <class T, std::size_t N, class... More>
DUET_REFUSED("average takes a vector of quaternions: average(std::vector(q.begin(), q.end()))")
quaternion<T> average(const std::array<quaternion<T>, N>&, const More&...);
template <detail::ForeignRows Rows, class... More>
DUET_REFUSED_FOREIGN_ROWS(average)
quaternion<double> average(const Rows&, const More&...);

} // namespace duet
