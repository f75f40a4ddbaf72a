// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/mechanism/cannot_close.hpp>
#include <duet/mechanism/kinematic_tree.hpp>
#include <duet/mechanism/loops/equations.hpp>
#include <duet/mechanism/tree_jacobian.hpp>
#include <duet/mechanism/tree_loop.hpp>
#include <duet/mechanism/tree_walk.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <vector>

/// \file
/// Mechanisms with loops: a tree, and frames on its links that coincide.

namespace duet {

/// A mechanism with loops: those of its joints that close them are cut, which leaves a tree, and
/// stand here as pairs of frames that coincide, wholly or partly.
///
/// Its positions are the coordinates q of the tree with F(q) = 0, where F has the equations of all
/// loops, one loop after the other. Equations may depend on each other, as those of all planar
/// mechanisms do. Lengths in F are in parts of `length()`, so that no result depends on their unit.
///
/// Example: `const closed_tree four_bar(tree, {{{loop_kind::hinge, {"coupler", along_axis({.5, 0,
/// 0}, {0, 0, 1})}, {"rocker", along_axis({.4, 0, 0}, {0, 0, 1})}}}});`
class closed_tree {
public:
  using own_jacobian = void;

  /// \throws invalid_input (`file_error` with the line if it is from a file) for frames on links
  /// that are not there or on one link, numbers that are not finite, rods without length
  closed_tree(kinematic_tree tree, loop_description given);

  /// The tree that is left where joints are cut.
  [[nodiscard]] const kinematic_tree& tree() const { return tree_; }
  /// What closes the loops.
  [[nodiscard]] const std::vector<tree_loop>& loops() const { return given_.loops; }
  /// Number of coordinates, those of the tree.
  [[nodiscard]] int size() const { return tree_.size(); }
  /// Number of equations of all loops.
  [[nodiscard]] int equations() const { return int(rows_); }
  /// The longest offset of a joint or a loop, or rod: what lengths are measured by; 1 where all are
  /// zero.
  [[nodiscard]] double length() const { return length_; }

  /// F(q), over any scalar.
  /// \return an Eigen vector of `equations()` numbers
  /// \throws invalid_input for another number of coordinates than `size()`
  template <VectorLike X>
  [[nodiscard]] auto residuals(const X& q) const {
    return residuals_at(q);
  }
  [[nodiscard]] Eigen::VectorXd residuals(const Eigen::VectorXd& q) const;

  /// ∂F/∂q in closed form, over any scalar. Arguments and errors as `residuals`.
  /// \return a matrix of a row for each equation and a column for each coordinate
  template <VectorLike X>
  [[nodiscard]] auto constraint_jacobian(const X& q) const {
    return jacobian_at(q);
  }
  [[nodiscard]] Eigen::MatrixXd constraint_jacobian(const Eigen::VectorXd& q) const;

  /// The position near a guess, by Levenberg and Marquardt's method, whose steps are the shortest.
  /// Some coordinates may be held where the guess has them.
  ///
  /// Source: J. Fan and Y. Yuan, On the quadratic convergence of the Levenberg–Marquardt method
  /// without nonsingularity assumption, 2005: the damping goes with ‖F‖, and equations that depend
  /// on each other do no harm.
  /// \param held  numbers of coordinates
  /// \throws cannot_close where no position is near; invalid_input for another number of
  /// coordinates than `size()`, and for numbers that are not finite
  [[nodiscard]] Eigen::VectorXd closed(const Eigen::VectorXd& guess,
                                       const std::vector<int>& held = {}) const;

  /// Coordinates that all others follow from, to first order, chosen so that these move as little
  /// as possible per unit of the former: by pivots of a QR factorisation of the rates that the
  /// loops allow. Lengths count in parts of `length()`.
  /// \param q  a position
  /// \return their numbers in ascending order, as many as there are independent rates
  [[nodiscard]] std::vector<int> independent_coordinates(const Eigen::VectorXd& q) const;

  // For those who extend duet.

  /// Of each coordinate the unit that is as much as a radian: `length()` where it is a length.
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
  [[nodiscard]] attached_frame<double> frame(std::size_t i, const loop_frame& at) const;
  void measure();

  kinematic_tree tree_;
  loop_description given_;
  std::vector<detail::loop_equations> equations_;
  Eigen::Index rows_ = 0;
  double length_ = 0;
  Eigen::VectorXd units_;
};

} // namespace duet

#ifndef DUET_COMPILED
#include <duet/mechanism/loops/tree_closing.hpp>
#endif
