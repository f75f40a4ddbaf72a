// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/derivative/derivative.hpp>
#include <duet/kinematics/constrained_mechanism.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/rate.hpp>
#include <duet/quaternion/rotation.hpp>

#include <array>
#include <cmath>
#include <string>
#include <tuple>

/// \file
/// A wheel carrier on five rods: a closed loop with one degree of freedom, the wheel centre's
/// height u.

namespace wheel_carrier {

using vector2 = Eigen::Vector2d;
using vector3 = Eigen::Vector3d;
using rotation = duet::quaternion<double>;

/// A rod with ball joints: one end on the chassis, the other on the carrier. Metres, design
/// position.
struct rod {
  std::string name;
  vector3 chassis;
  vector3 carrier;
};

/// x forward, y left, z up.
struct hardpoints {
  vector3 wheel_centre;
  std::array<rod, 5> rods;
};

/// The carrier of our examples: a multi-link suspension of the size of a passenger car's.
inline hardpoints example_hardpoints() {
  return {{0, 0.950, 0},
          {{{"upper front", {0.060, 0.547, 0.082}, {0.056, 0.864, 0.151}},
            {"upper rear", {-0.157, 0.508, 0.062}, {0.056, 0.864, 0.151}},
            {"lateral", {0.036, 0.338, -0.133}, {0.029, 0.842, -0.093}},
            {"trailing", {0.723, 0.599, -0.072}, {0, 0.864, -0.156}},
            {"tie rod", {-0.257, 0.320, -0.116}, {-0.144, 0.862, -0.056}}}}};
}

/// Toe-in of the left wheel for the orientation q of the carrier, rad.
template <class T>
[[nodiscard]] T toe_in(const duet::quaternion<T>& q) {
  using std::atan2;
  const duet::vector3<T> ahead = rotate(q, vector3(1, 0, 0));
  return -atan2(ahead[1], ahead[0]);
}

/// Camber of the left wheel for the orientation q of the carrier, rad.
template <class T>
[[nodiscard]] T camber(const duet::quaternion<T>& q) {
  using std::atan2;
  const duet::vector3<T> up = rotate(q, vector3(0, 0, 1));
  return atan2(up[1], up[2]);
}

/// The carrier at some u, and its derivatives with respect to u.
struct state {
  double u;
  vector3 centre, centre_first, centre_second;
  rotation q, q_first, q_second;

  /// Angular velocity per unit of u, spatial axes.
  [[nodiscard]] vector3 omega() const {
    return duet::angular_velocity(q, q_first, duet::frame::spatial);
  }
  /// Its derivative: 2 vec(q″ q* + q′ q′*), of which the second term is a scalar.
  [[nodiscard]] vector3 omega_first() const { return 2 * (q_second * conj(q)).vec(); }
};

/// |W + R s_i − A_i|² = L_i², i = 1 … 5, for W_x, W_y and the rotation at W_z = u.
struct constraints {
  hardpoints points;

  template <class X, class T>
  [[nodiscard]] auto operator()(const X& x, const T& height) const {
    const auto& [xy, q] = x;
    using S = std::common_type_t<std::decay_t<decltype(q.w())>, T>;
    const duet::vector3<S> centre(xy[0], xy[1], S(height));
    Eigen::Matrix<S, 5, 1> result;
    for (int i = 0; i < 5; ++i) {
      const rod& r = points.rods[std::size_t(i)];
      const vector3 arm = r.carrier - points.wheel_centre;
      const duet::vector3<S> d = centre + rotate(duet::quaternion<S>(q), arm) - r.chassis;
      result[i] = d.squaredNorm() - (r.carrier - r.chassis).squaredNorm();
    }
    return result;
  }
};

/// The carrier on its rods, solved by continuation from the design position.
class carrier {
public:
  explicit carrier(const hardpoints& points)
      : points_(points),
        loop_(constraints{points}, unknowns(points.wheel_centre.head<2>(), rotation(1)),
              points.wheel_centre[2]) {}

  [[nodiscard]] const hardpoints& points() const { return points_; }

  /// Position, orientation and their first two derivatives.
  /// \throws duet::loop_closure_failure if the rods cannot close
  [[nodiscard]] state at(double u) const {
    const auto x = duet::derivatives<2>(loop_, u);
    const auto centre = [&](std::size_t order, double height) {
      const vector2& xy = std::get<0>(x[order]);
      return vector3(xy[0], xy[1], height);
    };
    return {u,
            centre(0, u),
            centre(1, 1),
            centre(2, 0),
            std::get<1>(x[0]),
            std::get<1>(x[1]),
            std::get<1>(x[2])};
  }

private:
  using unknowns = std::tuple<vector2, rotation>;

  hardpoints points_;
  duet::constrained_mechanism<constraints, unknowns> loop_;
};

} // namespace wheel_carrier
