// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "spline/curves.hpp"
#include "support/multiprecision.hpp"

#include <Eigen/Core>

/// \file
/// Jacobians of curves by dual numbers over 50 digits, the truth for those in closed form.

namespace duet_test {

template <class T>
inline constexpr bool is_pose = duet::manifold<duet::quaternion<T>>::dimension == 6;

/// The scalar of T over 50 digits.
template <class T>
using wide = std::conditional_t<is_pose<T>, duet::screw_dual<real_50>, real_50>;

template <class T>
[[nodiscard]] wide<T> widened(const T& x) {
  if constexpr (is_pose<T>) {
    return {real_50(x.value()), real_50(x.epsilon())};
  } else {
    return real_50(x);
  }
}

/// σ of a step of the value, S exp(σ/2) or exp(σ/2) S.
template <class W>
[[nodiscard]] auto tangent_of_step(const duet::quaternion<W>& value,
                                   const duet::quaternion<W>& step, duet::perturbation side) {
  const auto product = side == duet::perturbation::right ? conj(value) * step : step * conj(value);
  const duet::vector3<W> v(2 * product.x(), 2 * product.y(), 2 * product.z());
  if constexpr (is_pose<W>) {
    return duet::twist_of(v);
  } else {
    return v;
  }
}

/// Largest errors of the Jacobians of value, velocity, acceleration and jerk, relative to the
/// largest entry of the quantity's Jacobian at the parameter and at the ends of its span, and where
/// they were found. (Derivatives of weights that vanish at an end of the span have errors relative
/// to those at the other end.)
struct jacobian_errors {
  std::array<double, 4> worst{};
  std::array<std::string, 4> where;

  void add(std::size_t d, const real_50& error, const real_50& largest, const std::string& name) {
    const double relative = double(real_50(error / largest));
    if (!(relative <= worst[d])) {
      worst[d] = relative;
      where[d] = name;
    }
  }
  [[nodiscard]] bool within(double tolerance) const {
    return std::all_of(worst.begin(), worst.end(), [&](double x) { return x <= tolerance; });
  }
  friend std::ostream& operator<<(std::ostream& out, const jacobian_errors& e) {
    for (std::size_t d = 0; d < 4; ++d) {
      out << "derivative " << d << ": " << e.worst[d] << " (" << e.where[d] << ")  ";
    }
    return out;
  }
};

/// The active segment of a curve over 50 digits, with one control point moved.
template <class T, int Order>
class wide_segment {
public:
  using W = wide<T>;
  using curve_type = duet::cumulative_bspline<W, Order>;
  using tangent_space = duet::manifold<duet::quaternion<W>>;
  static constexpr int dimension = tangent_space::dimension;

  wide_segment(const duet::cumulative_bspline<T, Order>& s, double u) {
    const std::size_t first = s.basis().first_function(s.basis().find_span(u));
    for (std::size_t i = 0; i < 2 * std::size_t(Order); ++i) {
      knots_.push_back(real_50(s.basis().knots()[first + i]));
    }
    for (std::size_t i = 0; i < std::size_t(Order); ++i) {
      const auto& q = s.control_points()[first + i];
      controls_.push_back({widened(q.w()), widened(q.x()), widened(q.y()), widened(q.z())});
    }
  }

  /// Curve of control points one of which is q exp(d/2), or exp(d/2) q. Increments keep the arc of
  /// the given signs.
  [[nodiscard]] curve_type moved(std::size_t control, const Eigen::Matrix<real_50, dimension, 1>& d,
                                 duet::perturbation side) const {
    auto controls = controls_;
    controls[control] = side == duet::perturbation::right
                            ? tangent_space::plus(controls[control], d, duet::frame::body)
                            : tangent_space::plus(controls[control], d, duet::frame::spatial);
    std::vector<duet::vector3<W>> increments(controls.size(), duet::vector3<W>::Zero());
    for (std::size_t i = 1; i < controls.size(); ++i) {
      increments[i] = log(conj(controls[i - 1]) * controls[i]).vec();
    }
    return curve_type(typename curve_type::basis_type(knots_), controls, increments);
  }

private:
  std::vector<real_50> knots_;
  std::vector<duet::quaternion<W>> controls_;
};

/// Compares all blocks at u with central differences of the curve over 50 digits, which are exact
/// to 30.
template <class T, int Order, class Frame>
void compare_blocks(jacobian_errors& errors, const std::string& name,
                    const duet::cumulative_bspline<T, Order>& s, double u, Frame frame,
                    duet::perturbation side) {
  constexpr int dimension = wide_segment<T, Order>::dimension;
  const wide_segment<T, Order> truth(s, u);
  const auto m = s.template motion_jacobian<3>(u, frame, side);
  const real_50 h("1e-17");
  std::array<real_50, 4> error{}, largest{};
  for (int i = 0; i < Order; ++i) {
    const std::array blocks{m.value.block(i), m.velocity.block(i), m.acceleration.block(i),
                            m.jerk.block(i)};
    for (int c = 0; c < dimension; ++c) {
      Eigen::Matrix<real_50, dimension, 1> d = Eigen::Matrix<real_50, dimension, 1>::Zero();
      d[c] = h;
      const auto after = truth.moved(std::size_t(i), d, side).motion(real_50(u), frame);
      d[c] = -h;
      const auto before = truth.moved(std::size_t(i), d, side).motion(real_50(u), frame);
      const auto middle = normalized(after.value + before.value);
      const auto sigma = tangent_of_step(middle, after.value - before.value, side);
      for (int r = 0; r < dimension; ++r) {
        const std::array<real_50, 4> steps{sigma[r], after.velocity[r] - before.velocity[r],
                                           after.acceleration[r] - before.acceleration[r],
                                           after.jerk[r] - before.jerk[r]};
        for (std::size_t k = 0; k < 4; ++k) {
          const real_50 exact = steps[k] / (2 * h);
          error[k] = std::max(error[k], real_50(abs(exact - real_50(blocks[k](r, c)))));
          largest[k] = std::max(largest[k], real_50(abs(exact)));
        }
      }
    }
  }
  const std::size_t span = s.basis().find_span(u);
  const std::array ends{s.breaks()[span], std::nextafter(s.breaks()[span + 1], u)};
  double slope = 0;
  const auto weights = s.basis().template weights<1>(span, u);
  for (const double b : weights[1]) {
    slope = std::max(slope, std::abs(b));
  }
  for (const double end : ends) {
    const auto at_end = s.template motion_jacobian<3>(end, frame, side);
    const std::array sizes{at_end.value.matrix().cwiseAbs().maxCoeff(),
                           at_end.velocity.matrix().cwiseAbs().maxCoeff(),
                           at_end.acceleration.matrix().cwiseAbs().maxCoeff(),
                           at_end.jerk.matrix().cwiseAbs().maxCoeff()};
    for (std::size_t k = 0; k < 4; ++k) {
      largest[k] = std::max(largest[k], real_50(sizes[k]));
    }
  }
  // A curve of order 2 has no acceleration.
  const double floor = Order == 2 ? 1 : 1e-9;
  for (std::size_t k = 0; k < 4; ++k) {
    errors.add(k, error[k], std::max(largest[k], real_50(floor * std::pow(slope, double(k)))),
               name + ", u = " + std::to_string(u));
  }
}

/// A curve over these knots whose control points are `step` apart in rotation, above π the long way
/// round; poses by as much in translation.
template <class T, int Order>
[[nodiscard]] duet::cumulative_bspline<T, Order> curve_of_steps(const std::vector<double>& knots,
                                                                double step, std::uint64_t seed) {
  const std::size_t count = knots.size() - std::size_t(Order);
  const auto rotations = rotated_by(step, count, seed);
  std::vector<duet::quaternion<T>> controls;
  if constexpr (is_pose<T>) {
    random_source random(seed);
    duet::vector3<double> t(1, -2, 0.5);
    for (const auto& q : rotations) {
      controls.push_back(duet::pose(q, t));
      const auto n = random.template direction<3>();
      t += step * duet::vector3<double>(n[0], n[1], n[2]);
    }
  } else {
    controls = rotations;
  }
  std::vector<duet::vector3<T>> increments(count, duet::vector3<T>::Zero());
  for (std::size_t i = 1; i < count; ++i) {
    increments[i] =
        duet::detail::log_vector(duet::detail::relative_rotation(controls[i - 1], controls[i]), "");
  }
  return {knots, controls, increments};
}

} // namespace duet_test
