// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual/promotion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/mechanism/kinematic_tree.hpp>
#include <duet/mechanism/tree_loop.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <span>

/// \file
/// The equations of loops and their derivatives. For those who extend duet.

namespace duet::detail {

/// What a loop asks of the pose (r, t) of its second frame in its first: that some of the six
/// numbers t and 2 (r_x, r_y, r_z) vanish. Those of a rotation vanish where it is none, or one
/// about z, and nowhere else, so axes do not come to rest the wrong way round.
[[nodiscard]] inline std::span<const int> vanishing_components(loop_kind kind) {
  static constexpr std::array all{0, 1, 2, 3, 4, 5};
  static constexpr std::array slides{0, 1, 3, 4, 5};
  static constexpr std::array on_axis{0, 1, 3, 4};
  static constexpr std::array in_plane{2, 3, 4};
  const std::span<const int> whole(all);
  switch (kind) {
  case loop_kind::weld:
    return whole;
  case loop_kind::hinge:
    return whole.first(5);
  case loop_kind::slider:
    return slides;
  case loop_kind::cylindrical:
    return on_axis;
  case loop_kind::planar:
    return in_plane;
  case loop_kind::universal:
  case loop_kind::ball:
    return whole.first(3);
  default:
    return {};
  }
}

/// A loop, ready to be evaluated.
struct loop_equations {
  loop_kind kind;
  relative_frame frames; ///< the second, as the first sees it
  double rod = 0;        ///< its length

  [[nodiscard]] Eigen::Index size() const {
    const bool has_one_more = kind == loop_kind::universal || kind == loop_kind::rod;
    return Eigen::Index(vanishing_components(kind).size()) + (has_one_more ? 1 : 0);
  }

  /// Of the pose a; lengths in parts of `unit`.
  template <class S, class Out>
  void residuals(const dual_quaternion<S>& a, double unit, Out&& out) const {
    const quaternion<S> r = rotation(a);
    const vector3<S> t = translation(a);
    Eigen::Index i = 0;
    for (const int k : vanishing_components(kind)) {
      const int m = k % 3;
      out[i++] = k < 3 ? S(t[m] / unit) : S(2 * (m == 0 ? r.x() : m == 1 ? r.y() : r.z()));
    }
    if (kind == loop_kind::universal) { // x · R y
      out[i] = 2 * (r.x() * r.y() - r.w() * r.z());
    } else if (kind == loop_kind::rod) { // smooth where both frames meet, and nearly |t| − length
      out[i] = (t[0] * t[0] + t[1] * t[1] + t[2] * t[2] - rod * rod) / (2 * rod * unit);
    }
  }

  /// Their derivatives by what the twist (ṫ, ω) in the axes of the first frame is linear in: the
  /// columns of J, its Jacobian in `frame::hybrid`. With 2 ṙ = ω r, twice the vector of r moves by
  /// w ω + ω × (x, y, z).
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
      const vector3<S> turning = r.w() * omega + omega.cross(vector);
      Eigen::Index i = 0;
      for (const int k : vanishing_components(kind)) {
        out(i++, c) = k < 3 ? S(velocity[k % 3] / unit) : turning[k % 3];
      }
      if (kind == loop_kind::universal) {
        out(i, c) = omega[1] * y_axis[2] - omega[2] * y_axis[1];
      } else if (kind == loop_kind::rod) {
        out(i, c) = t.dot(velocity) / (rod * unit);
      }
    }
  }
};

} // namespace duet::detail
