// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <duet/derivative/argument.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/kinematics/cannot_close.hpp>
#include <duet/kinematics/kinematic_tree.hpp>
#include <duet/kinematics/tree_jacobian.hpp>
#include <duet/kinematics/tree_loop.hpp>
#include <duet/kinematics/tree_walk.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

/// \file
/// Closed-chain mechanisms: a kinematic tree and loop-closure constraints between frames
/// on its links.

namespace duet::detail {
DUET_ABI_BEGIN

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

DUET_ABI_END
} // namespace duet::detail

namespace duet {
DUET_ABI_BEGIN

/// A closed-chain mechanism. The joints that close its loops are cut, which leaves a tree; they are
/// given as loop-closure constraints, pairs of frames that coincide, wholly or partly.
///
/// Its configurations are the coordinates q of the tree with F(q) = 0, where F has the
/// equations of all loops, one loop after the other. Equations may be redundant, as those of
/// all planar mechanisms are. Lengths in F are relative to `length()`, so that no result
/// depends on their unit.
///
/// Example: `const closed_chain_mechanism four_bar(tree, {{{constraint_kind::revolute, {"coupler",
/// frame_with_z_axis({.5, 0, 0}, {0, 0, 1})}, {"rocker", frame_with_z_axis({.4, 0, 0}, {0, 0,
/// 1})}}}});`
class closed_chain_mechanism {
public:
  using own_jacobian = void;

  /// \throws invalid_input (`file_error` with the line if the constraints are from a file) for
  /// frames on links that do not exist or on the same link, numbers that are not finite, rods
  /// without length
  closed_chain_mechanism(kinematic_tree tree, loop_constraints constraints);

  /// The tree that is left after joints are cut.
  [[nodiscard]] const kinematic_tree& tree() const { return tree_; }
  /// The loop-closure constraints.
  [[nodiscard]] const std::vector<loop_constraint>& loops() const { return constraints_.loops; }
  /// Number of coordinates, which are those of the tree.
  [[nodiscard]] int size() const { return tree_.size(); }
  /// Number of equations of all loops.
  [[nodiscard]] int equation_count() const { return int(rows_); }
  /// Characteristic length: the longest offset of a joint or constraint, or rod; 1 if all are zero.
  [[nodiscard]] double length() const { return length_; }

  /// Residuals F(q) of the loop-closure constraints, over any scalar.
  ///
  /// \return an Eigen vector of `equation_count()` numbers
  /// \throws invalid_input if the number of coordinates differs from `size()`
  template <VectorLike X>
  [[nodiscard]] auto residuals(const X& q) const {
    return residuals_at(q);
  }
  [[nodiscard]] Eigen::VectorXd residuals(const Eigen::VectorXd& q) const;

  /// Constraint Jacobian ∂F/∂q in closed form, over any scalar. Arguments and errors
  /// as `residuals`.
  ///
  /// \return a matrix with a row for each equation and a column for each coordinate
  template <VectorLike X>
  [[nodiscard]] auto constraint_jacobian(const X& q) const {
    return jacobian_at(q);
  }
  [[nodiscard]] Eigen::MatrixXd constraint_jacobian(const Eigen::VectorXd& q) const;

  /// The configuration near an initial guess, by damped least squares (Levenberg–Marquardt) with
  /// minimum-norm steps. Some coordinates may be fixed at their values in the guess.
  ///
  /// Source: J. Fan and Y. Yuan, On the quadratic convergence of the Levenberg–Marquardt method
  /// without nonsingularity assumption, 2005: the damping is proportional to ‖F‖, and redundant
  /// equations do no harm.
  ///
  /// \param guess  initial guess of all coordinates
  /// \param fixed  numbers of the fixed coordinates
  /// \throws loop_closure_failure if no configuration is near; invalid_input if the number of
  /// coordinates differs from `size()`, and for numbers that are not finite
  [[nodiscard]] Eigen::VectorXd assemble(const Eigen::VectorXd& guess,
                                         const std::vector<int>& fixed = {}) const;

  /// Independent coordinates, which to first order determine all others, chosen so that the
  /// dependent ones move as little as possible per unit of the independent ones: pivots of a QR
  /// factorisation of the null space of ∂F/∂q. Lengths count relative to `length()`.
  ///
  /// \param q  a configuration with closed loops
  /// \return their numbers in ascending order, as many as there are independent rates
  [[nodiscard]] std::vector<int> independent_coordinates(const Eigen::VectorXd& q) const;

  // For those who extend duet.

  /// Unit of each coordinate that counts as much as a radian: `length()` for lengths, otherwise 1.
  [[nodiscard]] const Eigen::VectorXd& units() const { return units_; }

private:
  template <class X>
  [[nodiscard]] auto residuals_at(const X& q) const {
    using S = detail::tree_scalar<X>;
    Eigen::Matrix<S, Eigen::Dynamic, 1> result(rows_);
    Eigen::Index row = 0;
    for (const detail::loop_equations& each : equations_) {
      each.residuals(tree_.pose(q, each.frames), length_, result.segment(row, each.size()));
      row += each.size();
    }
    return result;
  }
  template <class X>
  [[nodiscard]] auto jacobian_at(const X& q) const {
    using S = detail::tree_scalar<X>;
    Eigen::Matrix<S, Eigen::Dynamic, Eigen::Dynamic> result(rows_, size());
    Eigen::Index row = 0;
    for (const detail::loop_equations& each : equations_) {
      const auto both = pose_and_jacobian(tree_, q, frame::hybrid, each.frames);
      each.jacobian(both.value, both.jacobian, length_, result.middleRows(row, each.size()));
      row += each.size();
    }
    return result;
  }
  [[nodiscard]] attached_frame<double> frame(std::size_t i, const constraint_frame& at) const;
  void measure();

  kinematic_tree tree_;
  loop_constraints constraints_;
  std::vector<detail::loop_equations> equations_;
  Eigen::Index rows_ = 0;
  double length_ = 0;
  Eigen::VectorXd units_;
};

DUET_ABI_END
} // namespace duet
