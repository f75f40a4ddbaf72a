// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "../wheel_carrier/carrier.hpp"

#include <duet/core/text/number_text.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/kinematics/constrained_mechanism.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

/// \file
/// The wheel carrier with errors of its hardpoints.

namespace tolerance_study {

using wheel_carrier::hardpoints;
using wheel_carrier::rod;
using wheel_carrier::rotation;
using wheel_carrier::vector2;
using wheel_carrier::vector3;

/// Number of coordinates of the ten hardpoints: rod by rod, the chassis end before the carrier end,
/// each x, y, z.
inline constexpr int coordinate_count = 30;

/// Errors of the coordinates, metres.
using errors = Eigen::Matrix<double, coordinate_count, 1>;

/// Derivatives of toe-in and camber of the left wheel, rad, with respect to the coordinates.
using sensitivity = Eigen::Matrix<double, 2, coordinate_count>;

[[nodiscard]] inline std::string coordinate_name(const hardpoints& points, int i) {
  const char* const ends[] = {", chassis ", ", carrier "};
  return points.rods[std::size_t(i / 6)].name + ends[i / 3 % 2] + "xyz"[i % 3];
}

/// |W + R (s_i + e_i) − A_i − d_i|² = L_i², i = 1 … 5, for W_x, W_y and the rotation, given
/// W_z = u and the errors d_i of the chassis, e_i of the carrier. The rods have the lengths L_i of
/// the design.
struct toleranced_constraints {
  hardpoints points;

  /// \param p  u, then the errors
  template <class X, class P>
  [[nodiscard]] auto operator()(const X& x, const P& p) const {
    const auto& [xy, q] = x;
    using S = std::common_type_t<std::decay_t<decltype(q.w())>, typename P::Scalar>;
    const duet::vector3<S> centre(xy[0], xy[1], S(p[0]));
    const duet::quaternion<S> orientation(q);
    Eigen::Matrix<S, 5, 1> result;
    for (int i = 0; i < 5; ++i) {
      const rod& r = points.rods[std::size_t(i)];
      const auto off = [&p](int first, const vector3& design) {
        return duet::vector3<S>(S(design[0] + p[first]), S(design[1] + p[first + 1]),
                                S(design[2] + p[first + 2]));
      };
      const duet::vector3<S> arm = off(6 * i + 4, r.carrier - points.wheel_centre);
      const duet::vector3<S> d = centre + rotate(orientation, arm) - off(6 * i + 1, r.chassis);
      result[i] = d.squaredNorm() - (r.carrier - r.chassis).squaredNorm();
    }
    return result;
  }
};

/// Toe-in and camber, rad, of a position that the closed loop returns.
template <class X>
[[nodiscard]] auto angles_of(const X& x) {
  const auto& q = std::get<1>(x);
  using S = std::decay_t<decltype(q.w())>;
  return Eigen::Matrix<S, 2, 1>(wheel_carrier::toe_in(q), wheel_carrier::camber(q));
}

/// Toe-in and camber at given wheel heights u, over the hardpoints' errors: a closed loop of 31
/// driving parameters, so that errors, too, are followed without change of branch.
class toleranced_carrier {
public:
  /// \throws std::runtime_error if the rods of the design cannot close
  toleranced_carrier(const hardpoints& points, const std::vector<double>& heights) {
    const unknowns design(points.wheel_centre.head<2>(), rotation(1));
    try {
      const loop start(toleranced_constraints{points}, design,
                       parameters_at(points.wheel_centre[2], errors::Zero()));
      for (const double u : heights) {
        loops_.push_back(start.warm_started_at(parameters_at(u, errors::Zero())));
      }
    } catch (const duet::loop_closure_failure& error) {
      throw std::runtime_error(
          "the rods cannot close beyond u = " + duet::to_text(error.parameter().front()) + " m");
    }
  }

  [[nodiscard]] std::size_t rows() const { return loops_.size(); }
  [[nodiscard]] double height(std::size_t row) const { return loops_[row].parameter()[0]; }

  /// Toe-in and camber, rad.
  /// \throws duet::loop_closure_failure if the rods cannot close
  [[nodiscard]] vector2 angles(std::size_t row, const errors& e) const {
    return angles_of(loops_[row](parameters_at(height(row), e)));
  }

  /// Derivatives of toe-in and camber with respect to the errors at the design, by dual numbers
  /// through the closed loop.
  [[nodiscard]] sensitivity sensitivities(std::size_t row) const {
    const loop& loop_at_height = loops_[row];
    return duet::jacobian([&loop_at_height](const auto& p) { return angles_of(loop_at_height(p)); },
                          loop_at_height.parameter())
        .jacobian.rightCols<coordinate_count>();
  }

private:
  using parameters = Eigen::Matrix<double, 1 + coordinate_count, 1>;
  using unknowns = std::tuple<vector2, rotation>;
  using loop = duet::constrained_mechanism<toleranced_constraints, unknowns, parameters>;

  [[nodiscard]] static parameters parameters_at(double u, const errors& e) {
    parameters p;
    p << u, e;
    return p;
  }

  std::vector<loop> loops_;
};

} // namespace tolerance_study
