// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual/promotion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/kinematics/kinematic_tree.hpp>
#include <duet/kinematics/tree_loop.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <span>

/// \file
/// Loop-closure equations and their derivatives. For those who extend duet.

namespace duet::detail {

/// Components of the pose (r, t) of the second frame relative to the first, of the six numbers
/// t and 2 (r_x, r_y, r_z), that a constraint requires to vanish. Those of a rotation vanish
/// for the identity, or rotations about z, and nowhere else, so axes cannot converge to the
/// opposite direction.
[[nodiscard]] inline std::span<const int> vanishing_components(constraint_kind kind) {
  static constexpr std::array all{0, 1, 2, 3, 4, 5};
  static constexpr std::array along_axis{0, 1, 3, 4, 5};
  static constexpr std::array on_axis{0, 1, 3, 4};
  static constexpr std::array in_plane{2, 3, 4};
  const std::span<const int> pose_components(all);
  switch (kind) {
  case constraint_kind::fixed:
    return pose_components;
  case constraint_kind::revolute:
    return pose_components.first(5);
  case constraint_kind::prismatic:
    return along_axis;
  case constraint_kind::cylindrical:
    return on_axis;
  case constraint_kind::planar:
    return in_plane;
  case constraint_kind::universal:
  case constraint_kind::spherical:
    return pose_components.first(3);
  default:
    return {};
  }
}

/// A loop-closure constraint, prepared for evaluation.
struct loop_equations {
  constraint_kind kind;
  relative_frame frames; ///< the second frame relative to the first
  double rod = 0;        ///< length of a rod

  [[nodiscard]] Eigen::Index size() const {
    const bool has_one_more =
        kind == constraint_kind::universal || kind == constraint_kind::distance;
    return Eigen::Index(vanishing_components(kind).size()) + (has_one_more ? 1 : 0);
  }

  /// Residuals at the relative pose a; lengths relative to `unit`.
  template <class S, class Out>
  void residuals(const dual_quaternion<S>& a, double unit, Out&& out) const {
    const quaternion<S> r = rotation(a);
    const vector3<S> t = translation(a);
    Eigen::Index i = 0;
    for (const int k : vanishing_components(kind)) {
      const int m = k % 3;
      out[i++] = k < 3 ? S(t[m] / unit) : S(2 * (m == 0 ? r.x() : m == 1 ? r.y() : r.z()));
    }
    if (kind == constraint_kind::universal) { // x · R y
      out[i] = 2 * (r.x() * r.y() - r.w() * r.z());
    } else if (kind == constraint_kind::distance) { // smooth if both origins coincide, and nearly
                                                    // |t| − length
      out[i] = (t[0] * t[0] + t[1] * t[1] + t[2] * t[2] - rod * rod) / (2 * rod * unit);
    }
  }

  /// Derivatives of the residuals with respect to the variable of which the twist (ṫ, ω) in the
  /// axes of the first frame is linear: J is the Jacobian of the relative pose in `frame::hybrid`.
  /// With 2 ṙ = ω r, twice the vector of r moves by w ω + ω × (x, y, z).
  template <class S, class J, class Out>
  void jacobian(const dual_quaternion<S>& a, const J& j, double unit, Out&& out) const {
    const quaternion<S> r = rotation(a);
    const vector3<S> t = translation(a);
    const vector3<S> vector(r.x(), r.y(), r.z());
    const vector3<S> y_axis(2 * (r.x() * r.y() - r.w() * r.z()),
                            1 - 2 * (r.x() * r.x() + r.z() * r.z()),
                            2 * (r.y() * r.z() + r.w() * r.x()));
    for (Eigen::Index c = 0; c < j.cols(); ++c) {
      const vector3<S> velocity = j.col(c).template head<3>();
      const vector3<S> omega = j.col(c).template tail<3>();
      const vector3<S> vector_rate = r.w() * omega + omega.cross(vector);
      Eigen::Index i = 0;
      for (const int k : vanishing_components(kind)) {
        out(i++, c) = k < 3 ? S(velocity[k % 3] / unit) : vector_rate[k % 3];
      }
      if (kind == constraint_kind::universal) {
        out(i, c) = omega[1] * y_axis[2] - omega[2] * y_axis[1];
      } else if (kind == constraint_kind::distance) {
        out(i, c) = t.dot(velocity) / (rod * unit);
      }
    }
  }
};

} // namespace duet::detail
