// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <duet/derivative/argument.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/kinematics/kinematic_tree.hpp>
#include <duet/kinematics/tree_jacobian.hpp>
#include <duet/kinematics/tree_loop.hpp>
#include <duet/kinematics/tree_table.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// \file
/// Closed-chain mechanisms: a kinematic tree and loop-closure constraints between frames
/// on its links. Their assembly configurations and their mobility.

namespace duet::detail {
DUET_ABI_BEGIN

/// Components of the pose (r, t) of the second frame relative to the first, of the six numbers
/// t and 2 (r_x, r_y, r_z), that a constraint requires to vanish. Those of a rotation vanish
/// for the identity, or rotations about z, and nowhere else, so axes cannot converge to the
/// opposite direction.
[[nodiscard]] inline std::span<const int> vanishing_components(constraint_kind kind) {
  static constexpr std::array all{0, 1, 2, 3, 4, 5};
  static constexpr std::array along_axis{0, 1, 3, 4, 5};
  static constexpr std::array in_plane{2, 3, 4};
  const std::span<const int> fixed(all), prismatic(along_axis), planar(in_plane);
  switch (kind) {
  case constraint_kind::fixed:
    return fixed;
  case constraint_kind::revolute:
    return fixed.first(5);
  case constraint_kind::prismatic:
    return prismatic;
  case constraint_kind::cylindrical:
    return prismatic.first(4);
  case constraint_kind::planar:
    return planar;
  case constraint_kind::distance:
    return {};
  default: // universal and spherical
    return fixed.first(3);
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
    using S = detail::tree_scalar<X>;
    Eigen::Matrix<S, Eigen::Dynamic, 1> result(rows_);
    Eigen::Index row = 0;
    for (const detail::loop_equations& each : equations_) {
      each.residuals(tree_.pose(q, each.frames), length_, result.segment(row, each.size()));
      row += each.size();
    }
    return result;
  }
  [[nodiscard]] Eigen::VectorXd residuals(const Eigen::VectorXd& q) const;

  /// Constraint Jacobian ∂F/∂q in closed form, over any scalar. Arguments and errors
  /// as `residuals`.
  ///
  /// \return a matrix with a row for each equation and a column for each coordinate
  template <VectorLike X>
  [[nodiscard]] auto constraint_jacobian(const X& q) const {
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
  [[nodiscard]] attached_frame<double> frame(std::size_t i, const constraint_frame& at) const;
  void measure();

  kinematic_tree tree_;
  loop_constraints constraints_;
  std::vector<detail::loop_equations> equations_;
  Eigen::Index rows_ = 0;
  double length_ = 0;
  Eigen::VectorXd units_;
};

/// One of the configurations in which the loops close (an assembly mode if the driven coordinates
/// are fixed).
struct assembly_configuration {
  Eigen::VectorXd coordinates; ///< coordinates of the tree, angles within (−π, π]
  /// Smallest singular value of ∂F/∂q with respect to the free coordinates; 0 at a branch point.
  double smallest_singular_value = 0;
  int hits = 0;              ///< number of random starts that led to it
  bool within_limits = true; ///< true if all coordinates are within the limits of their joints
};

/// Result of a search for assembly configurations.
struct assembly_search_result {
  std::vector<assembly_configuration>
      positions;     ///< assembly configurations, ordered by their first coordinates that differ
  int starts = 0;    ///< number of initial guesses
  int converged = 0; ///< number of guesses that converged to closed loops

  /// Good–Turing estimate of the probability that one more converged start finds a new
  /// configuration: the fraction of converged starts whose configuration no other start found. No
  /// proof that none is missing.
  [[nodiscard]] double missing_probability() const {
    const auto once =
        std::count_if(positions.begin(), positions.end(),
                      [](const assembly_configuration& each) { return each.hits == 1; });
    return converged > 0 ? double(once) / converged : 1;
  }
};

/// Options of the search for assembly configurations.
struct assembly_search_options {
  int random_starts = 200; ///< minimum number of random initial guesses
  std::uint64_t seed = 1;  ///< seed of the random numbers
  /// Upper bound on the Good–Turing estimate `assembly_search_result::missing_probability()`, also
  /// if one more configuration had been found once, as fewer guesses than 1 / bound cannot show it.
  /// The search continues beyond `starts` until the bound is met; the default is always met.
  double missing_probability = 2;
  int max_starts = 20000; ///< maximum number of guesses
};

/// Assembly configurations of a closed-chain mechanism with some coordinates fixed, from random
/// initial guesses: within the limits of joints whose limits are finite, otherwise angles within
/// (−π, π) and lengths within ±π `length()`. Each is accurate to round-off. The search cannot prove
/// that it is complete, but estimates the probability that one more guess finds another
/// configuration: `assembly_search_options::missing_probability`.
///
/// \param fixed  numbers of coordinates, as many as the mechanism has degrees of freedom, so that
///              configurations are isolated
/// \param at    values of the fixed coordinates, in the order of `fixed`
/// \throws invalid_input for coordinates that do not exist, and if `fixed` and `at` differ in size
[[nodiscard]] assembly_search_result
find_assembly_configurations(const closed_chain_mechanism& mechanism, const std::vector<int>& fixed,
                             const Eigen::VectorXd& at,
                             const assembly_search_options& options = {});

/// Evidence for a mobility.
enum class mobility_evidence {
  full_rank,          ///< the equations are independent here: certain
  first_order_rigid,  ///< no rates fulfil the equations: rigid, certain
  second_order_rigid, ///< no rates that fulfil the equations have an acceleration: rigid, certain
  sampled             ///< configurations nearby were searched for
};

/// Mobility of a mechanism, and the results of simpler counts.
struct mobility_result {
  int mobility = 0;      ///< degrees of freedom: local dimension of the configuration space
  int kutzbach = 0;      ///< coordinates − equations, the Grübler–Kutzbach count
  int instantaneous = 0; ///< coordinates − rank of ∂F/∂q here: number of independent rates
  int local = 0;         ///< coordinates − rank of ∂F/∂q at configurations nearby
  mobility_evidence evidence = mobility_evidence::full_rank; ///< evidence for `mobility`

  /// True if the count of coordinates and equations differs from the mobility.
  [[nodiscard]] bool count_is_wrong() const { return kutzbach != mobility; }
  /// True if some rates do not move the mechanism: it is first-order flexible ("shaky"), or several
  /// motions meet here.
  [[nodiscard]] bool is_singular() const { return instantaneous != mobility; }
};

/// `mobility 1: counted -2, first order 1 here, 1 nearby`
[[nodiscard]] inline std::string to_text(const mobility_result& m) {
  return "mobility " + std::to_string(m.mobility) + ": counted " + std::to_string(m.kutzbach) +
         ", first order " + std::to_string(m.instantaneous) + " here, " + std::to_string(m.local) +
         " nearby";
}

/// Mobility of a mechanism at a configuration, its number of degrees of freedom.
///
/// If equations are redundant, neither their number nor the rank of ∂F/∂q determines the mobility:
/// planar mechanisms and those of Bennett and Goldberg have more equations than they need, a
/// first-order flexible ("shaky") frame has rates and does not move, and at a branch point there
/// are more rates than branches. Second derivatives then decide whether any of the rates has an
/// acceleration. If so, configurations are searched for 0.05 radians (or lengths relative to
/// `length()`) away along random rates, and around those that are found; the largest dimension that
/// they span is the mobility.
///
/// \param q  a configuration
/// \throws invalid_input if the loops are not closed at q
[[nodiscard]] mobility_result mobility(const closed_chain_mechanism& mechanism,
                                       const Eigen::VectorXd& q);

DUET_ABI_END
} // namespace duet
