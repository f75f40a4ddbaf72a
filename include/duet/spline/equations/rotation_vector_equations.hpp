// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/spline/end_conditions.hpp>
#include <duet/spline/equations/rotation_vector_ends.hpp>
#include <duet/spline/equations/small_angles.hpp>
#include <duet/spline/orientations.hpp>
#include <duet/spline/rotation_vector_spline.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

/// \file
/// Common part of the equations of cubic and quintic rotation-vector splines.

namespace duet::detail {

/// Samples of a rotation-vector spline, as steps and rotations between neighbours, and its end
/// conditions. The unit of the parameter is about one step, so that all derivatives are of similar
/// size.
///
/// \tparam Piece  segment, constructed from a step and a rotation, which are constant while rates
///                are solved for
template <class T, int Order, class Piece>
class rotation_vector_equations {
protected:
  using R = real_type_t<T>;
  using ends_type = rotation_vector_ends<T, Order>;

public:
  using real_type = R;

  /// \param u     increasing parameters, as many as `ends` need or more
  /// \param q     as many unit quaternions or poses, signs aligned
  /// \param ends  end conditions
  rotation_vector_equations(const std::vector<R>& u, const std::vector<quaternion<T>>& q,
                            const curve_ends<T>& ends)
      : ends_(ends, q.front(), q.back()) {
    using std::frexp;
    using std::ldexp;
    const std::size_t last = u.size() - 1;
    int exponent = 0;
    static_cast<void>(frexp(R((u.back() - u.front()) / R(last)), &exponent));
    unit_ = ldexp(R(1), exponent);
    steps_.resize(last);
    rotations_.resize(last);
    for (std::size_t i = 0; i < last; ++i) {
      steps_[i] = (u[i + 1] - u[i]) / unit_;
      rotations_[i] = rotation_vector_between(relative_rotation(q[i], q[i + 1]));
    }
    make_pieces();
  }

  [[nodiscard]] static std::size_t min_samples(end_condition_kind kind) {
    return ends_type::min_samples(kind);
  }

  /// Changes the equations to those of a smaller motion: rotations between samples and rates at the
  /// ends times λ.
  void scale(const R& lambda) {
    for (vector3<T>& half_angle : rotations_) {
      half_angle = lambda * components(half_angle);
    }
    for (auto& end : ends_.values) {
      for (vector3<T>& rate : end) {
        rate = lambda * components(rate);
      }
    }
    make_pieces();
  }

  /// Ratio of the longest to the shortest interval of the parameter.
  [[nodiscard]] R unevenness() const {
    const auto [shortest, longest] = std::minmax_element(steps_.begin(), steps_.end());
    return *longest / *shortest;
  }

  /// Largest rotation angle between neighbouring samples, rad, and the index of the sample before
  /// it.
  [[nodiscard]] std::pair<R, std::size_t> max_rotation() const {
    using std::sqrt;
    std::pair<R, std::size_t> largest{R(-1), 0};
    for (std::size_t i = 0; i < rotations_.size(); ++i) {
      const R angle =
          2 * sqrt(R(innermost(dot(components(rotations_[i]), components(rotations_[i])))));
      if (angle > largest.first) {
        largest = {angle, i};
      }
    }
    return largest;
  }

  /// Size of a step from x relative to the values it changes. For real T.
  template <class Unknowns>
  [[nodiscard]] R relative_step(const Unknowns& x, const Unknowns& step) const {
    return relative_step_of_rates(x, step, rotations_, steps_);
  }

protected:
  /// Number of knots; the first and the last knot of a closed curve count once.
  [[nodiscard]] std::size_t knots() const { return steps_.size() + (ends_.is_cyclic ? 0 : 1); }

  /// Velocity and acceleration at a sample of the parabola through it and its neighbours, as for
  /// small rotations.
  [[nodiscard]] std::pair<vector3<T>, vector3<T>> parabola(std::size_t i) const {
    const std::size_t last = steps_.size();
    const std::size_t left = i > 0 ? i - 1 : ends_.is_cyclic ? last - 1 : 0;
    const std::size_t right = i < last ? i : last - 1;
    const R h = steps_[left] + steps_[right];
    std::pair<vector3<T>, vector3<T>> result;
    for (int k = 0; k < 3; ++k) {
      const T before = rotations_[left][k] / steps_[left],
              after = rotations_[right][k] / steps_[right];
      result.first[k] = (before * steps_[right] + after * steps_[left]) / h;
      result.second[k] = (after - before) * (2 / h);
    }
    return result;
  }

  /// Power of the unit of the parameter.
  [[nodiscard]] R unit_to(std::size_t exponent) const {
    R result(1);
    for (std::size_t i = 0; i < exponent; ++i) {
      result *= unit_;
    }
    return result;
  }

  using curve = rotation_vector_spline<T, Order>;
  /// Curve with these polynomials, whose parameter is in multiples of the unit.
  [[nodiscard]] curve made_of(const std::vector<R>& u, std::vector<quaternion<T>> q,
                              std::vector<typename curve::polynomial> polynomials) const {
    for (auto& each : polynomials) {
      R per_unit(1);
      for (vector3<T>& coefficient : each) {
        coefficient = per_unit * components(coefficient);
        per_unit /= unit_;
      }
    }
    return curve(typename curve::from_segments_tag(), u, std::move(q), std::move(polynomials));
  }

  ends_type ends_;
  R unit_;
  std::vector<R> steps_;              ///< steps of the parameter, in multiples of the unit
  std::vector<vector3<T>> rotations_; ///< rotations between samples, half-angle vectors
  std::vector<Piece> pieces_;

private:
  void make_pieces() {
    pieces_.clear();
    pieces_.reserve(steps_.size());
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      pieces_.emplace_back(steps_[i], rotations_[i]);
    }
  }
};

} // namespace duet::detail
