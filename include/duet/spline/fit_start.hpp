// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/orientations.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <vector>

/// \file
/// Initial guesses of fits and outlier limits of robust fits, from medians, which outliers among up
/// to half of the samples do not move far.

namespace duet::detail {

/// Greville abscissa: mean of the Order − 1 inner knots of basis function i.
template <int Order, Real R>
[[nodiscard]] R knot_average(const bspline_basis<Order, R>& basis, std::size_t i) {
  R sum(0);
  for (std::size_t j = 1; j < std::size_t(Order); ++j) {
    sum += basis.knots()[i + j];
  }
  return sum / R(Order - 1);
}

/// Initial guess of plain fits: the samples interpolated at the Greville abscissae.
template <class T, int Order>
[[nodiscard]] std::vector<quaternion<T>>
control_points_at_averages(const bspline_basis<Order, real_type_t<T>>& basis,
                           const std::vector<real_type_t<T>>& u,
                           const std::vector<quaternion<T>>& samples) {
  using R = real_type_t<T>;
  std::vector<quaternion<T>> result;
  for (std::size_t i = 0; i < basis.size(); ++i) {
    const R at = knot_average(basis, i);
    const auto above = std::size_t(std::upper_bound(u.begin(), u.end(), at) - u.begin());
    const std::size_t right = std::clamp<std::size_t>(above, 1, u.size() - 1);
    const R fraction = std::clamp(R((at - u[right - 1]) / (u[right] - u[right - 1])), R(0), R(1));
    result.push_back(slerp(samples[right - 1], samples[right], fraction));
    if (i > 0 && innermost(dot(result[i - 1], result[i])) < 0) {
      result[i] = -result[i];
    }
  }
  return result;
}

/// Upper median of x, whose order it changes; x must not be empty. NaN counts as infinite.
template <Real R>
[[nodiscard]] R median_within(std::vector<R>& x) {
  for (R& each : x) {
    each = each == each ? each : std::numeric_limits<R>::infinity();
  }
  const auto middle = x.begin() + std::ptrdiff_t(x.size() / 2);
  std::nth_element(x.begin(), middle, x.end());
  return *middle;
}

/// Median of x around each sample, over 61 samples or more if there are as many: the samples on the
/// same segment of the curve and their neighbours.
///
/// \param piece  number of the segment of each sample, not decreasing
template <Real R>
[[nodiscard]] std::vector<R> local_medians(const std::vector<R>& x,
                                           const std::vector<std::size_t>& piece) {
  constexpr std::size_t enough = 61;
  const std::size_t n = x.size();
  std::vector<R> result, around;
  result.reserve(n);
  for (std::size_t first = 0, last = 0; first < n; first = last) {
    while (last < n && piece[last] == piece[first]) {
      ++last;
    }
    const std::size_t more = last - first < enough ? (enough - (last - first) + 1) / 2 : 0;
    const std::size_t count = std::min(n, last - first + 2 * more);
    const std::size_t from = std::min(first > more ? first - more : 0, n - count);
    const auto begin = x.begin() + std::ptrdiff_t(from);
    around.assign(begin, begin + std::ptrdiff_t(count));
    result.resize(last, median_within(around));
  }
  return result;
}

/// Bound on residuals: squares of larger ones, and products of those, would overflow.
template <Real R>
[[nodiscard]] R too_far() {
  using std::sqrt;
  return sqrt(sqrt(std::numeric_limits<R>::max()));
}

/// Sets the limits of Huber's loss: three times the median residual around each sample, at least
/// `min_limit`; zero for samples at four times that distance or more. Returns the sum of the
/// limits.
template <Real R>
[[nodiscard]] R set_outlier_limits(const std::vector<R>& sizes,
                                   const std::vector<std::size_t>& piece, const R& min_limit,
                                   std::vector<R>& limits) {
  const std::vector<R> medians = local_medians(sizes, piece);
  R sum(0);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const R limit = std::max(R(3 * medians[i]), min_limit);
    limits[i] = sizes[i] <= 4 * limit && sizes[i] < too_far<R>() ? limit : R(0);
    sum += std::min(limit, too_far<R>());
  }
  return sum;
}

/// Coordinates of samples for medians: the rotation matrix, which is independent of the sign of the
/// quaternion, and for a pose also its translation divided by the characteristic length.
template <class T>
class median_coordinates {
  static constexpr bool is_pose = contains_tag<T, screw_tag>();

public:
  using R = real_type_t<T>;
  using point = std::array<R, is_pose ? 12 : 9>;

  [[nodiscard]] static point of(const quaternion<T>& q, const R& characteristic_length) {
    point result;
    const auto put = [&](const auto& entries, std::size_t at) {
      for (Eigen::Index i = 0; i < entries.size(); ++i) {
        result[at + std::size_t(i)] = entries(i);
      }
    };
    if constexpr (is_pose) {
      constexpr R max_coordinate =
          std::numeric_limits<R>::max() / 64; // sums of differences stay finite
      put(rotation_matrix(rotation(q)), 0);
      put(vector3<R>((translation(q) / characteristic_length)
                         .cwiseMin(max_coordinate)
                         .cwiseMax(-max_coordinate)),
          9);
    } else {
      put(rotation_matrix(q), 0);
    }
    return result;
  }

  /// Sum of the absolute differences of the coordinates.
  [[nodiscard]] static R separation(const point& a, const point& b) {
    using std::abs;
    R sum(0);
    for (std::size_t i = 0; i < a.size(); ++i) {
      sum += abs(a[i] - b[i]);
    }
    return sum;
  }
};

/// Sample with the smallest median separation from the others, among nine spread over all samples.
template <class T>
[[nodiscard]] quaternion<T> central_sample(const std::vector<quaternion<T>>& samples,
                                           const real_type_t<T>& characteristic_length) {
  using R = real_type_t<T>;
  using coordinates = median_coordinates<T>;
  constexpr std::size_t count = 9;
  std::array<typename coordinates::point, count> points;
  for (std::size_t k = 0; k < count; ++k) {
    points[k] =
        coordinates::of(samples[k * (samples.size() - 1) / (count - 1)], characteristic_length);
  }
  std::vector<R> medians, separations(count);
  for (const auto& point : points) {
    std::transform(points.begin(), points.end(), separations.begin(),
                   [&](const auto& other) { return coordinates::separation(point, other); });
    medians.push_back(median_within(separations));
  }
  const auto best = std::min_element(medians.begin(), medians.end()) - medians.begin();
  return samples[std::size_t(best) * (samples.size() - 1) / (count - 1)];
}

/// Samples relative to one of them, with all digits of small differences.
template <class T>
[[nodiscard]] std::vector<quaternion<T>> samples_relative_to(const quaternion<T>& origin,
                                                             std::vector<quaternion<T>> samples) {
  for (quaternion<T>& each : samples) {
    each =
        relative_rotation(origin, innermost(dot(origin, each)) < 0 ? quaternion<T>(-each) : each);
  }
  return samples;
}

/// Huber's loss: ½ r² up to the limit, beyond it linear along the tangent.
template <Real R>
[[nodiscard]] R huber_loss(const R& r, const R& limit) {
  return r <= limit ? R(r * r / 2) : R(limit * (r - limit / 2));
}

/// Robust centre of samples, up to half of which may be outliers: the sample nearest to the medians
/// of the coordinates.
template <class T>
class robust_centre {
  using coordinates = median_coordinates<T>;
  using point = typename coordinates::point;
  using R = real_type_t<T>;

public:
  /// Initial control points of a robust fit: the centre of the samples around each Greville
  /// abscissa. It is searched for in windows from many samples to few, so that local accumulations
  /// of outliers are not mistaken for the motion.
  template <int Order>
  [[nodiscard]] std::vector<quaternion<T>>
  controls(const bspline_basis<Order, R>& basis, const std::vector<R>& u,
           const std::vector<quaternion<T>>& samples, const R& characteristic_length) {
    constexpr std::array<std::size_t, 5> windows{81, 41, 21, 11, 5};
    std::vector<quaternion<T>> result;
    for (std::size_t i = 0; i < basis.size(); ++i) {
      const auto above = std::lower_bound(u.begin(), u.end(), knot_average(basis, i));
      const std::size_t middle = std::min(std::size_t(above - u.begin()), samples.size() - 1);
      const auto first_of = [&](std::size_t count) {
        return std::min(middle > count / 2 ? middle - count / 2 : 0, samples.size() - count);
      };
      const std::size_t all = std::min(samples.size(), windows.front()), from = first_of(all);
      points_.clear();
      for (std::size_t k = from; k < from + all; ++k) {
        points_.push_back(coordinates::of(samples[k], characteristic_length));
      }
      centre_ = middle - from;
      radius_ = std::numeric_limits<R>::infinity();
      for (const std::size_t window : windows) {
        const std::size_t count = std::min(all, window);
        move(first_of(count) - from, count);
      }
      result.push_back(samples[from + centre_]);
      if (i > 0 && innermost(dot(result[i - 1], result[i])) < 0) {
        result[i] = -result[i];
      }
    }
    return result;
  }

private:
  /// Moves the centre to that of the points within the radius, among `count` points from `first`
  /// on. The radius becomes three times the median separation from the new centre.
  void move(std::size_t first, std::size_t count) {
    near_samples_.clear();
    for (std::size_t k = first; k < first + count; ++k) {
      if (coordinates::separation(points_[centre_], points_[k]) <= radius_) {
        near_samples_.push_back(k);
      }
    }
    if (3 * near_samples_.size() < count) {
      if (count < 21) {
        return; // a majority of few samples may be due to chance
      }
      near_samples_.resize(count); // the motion has left the radius: all samples count
      std::iota(near_samples_.begin(), near_samples_.end(), first);
    }
    point middle;
    for (std::size_t i = 0; i < middle.size(); ++i) {
      numbers_.clear();
      for (const std::size_t k : near_samples_) {
        numbers_.push_back(points_[k][i]);
      }
      middle[i] = median_within(numbers_);
    }
    const auto is_nearer = [&](std::size_t a, std::size_t b) {
      return coordinates::separation(points_[a], middle) <
             coordinates::separation(points_[b], middle);
    };
    centre_ = *std::min_element(near_samples_.begin(), near_samples_.end(), is_nearer);
    numbers_.clear();
    for (const std::size_t k : near_samples_) {
      numbers_.push_back(coordinates::separation(points_[k], points_[centre_]));
    }
    radius_ = 3 * median_within(numbers_);
  }

  std::vector<point> points_; ///< coordinates of the samples around the abscissa
  std::vector<std::size_t> near_samples_;
  std::vector<R> numbers_;
  std::size_t centre_ = 0;
  R radius_ = 0;
};

} // namespace duet::detail
