// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual_quaternion/displacement.hpp>
#include <duet/mechanism/closed_loop.hpp>
#include <duet/mechanism/joint.hpp>
#include <duet/mechanism/joint_checks.hpp>
#include <duet/mechanism/kinematic_tree.hpp>
#include <duet/mechanism/loop_closing.hpp>
#include <duet/mechanism/loop_equations.hpp>
#include <duet/mechanism/tree_jacobian.hpp>
#include <duet/mechanism/tree_loop.hpp>
#include <duet/mechanism/tree_walk.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Core>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
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
  closed_tree(kinematic_tree tree, loop_description given)
      : tree_(std::move(tree)), given_(std::move(given)) {
    measure();
    for (std::size_t i = 0; i < given_.loops.size(); ++i) {
      const tree_loop& loop = given_.loops[i];
      equations_.push_back({loop.kind, {frame(i, loop.second), frame(i, loop.first)}, loop.length});
      if (equations_.back().frames.frame.link == equations_.back().frames.observer.link) {
        detail::bad_loop(given_, i, "both frames are on the link \"" + loop.first.link + "\"");
      }
      if (loop.kind == loop_kind::rod && !(loop.length > 0 && std::isfinite(loop.length))) {
        detail::bad_loop(given_, i, "its length is " + to_text(loop.length));
      }
      rows_ += equations_.back().size();
    }
  }

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
    using S = detail::tree_scalar<X>;
    Eigen::Matrix<S, Eigen::Dynamic, 1> result(rows_);
    Eigen::Index row = 0;
    for (const detail::loop_equations& each : equations_) {
      each.residuals(tree_.pose(q, each.frames), length_, result.segment(row, each.size()));
      row += each.size();
    }
    return result;
  }

  /// ∂F/∂q in closed form, over any scalar. Arguments and errors as `residuals`.
  /// \return a matrix of a row for each equation and a column for each coordinate
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
                                       const std::vector<int>& held = {}) const {
    detail::require(guess.allFinite(), "duet: closed_tree: the guess is not finite");
    const detail::closing found(*this, guess, detail::all_but(size(), held));
    if (!found.has_closed()) {
      detail::raise(cannot_close("duet: closed_tree: no position near the guess: residual " +
                                     to_text(found.residual()),
                                 {guess.begin(), guess.end()}));
    }
    return found.coordinates();
  }

  /// Coordinates that all others follow from, to first order, chosen so that these move as little
  /// as possible per unit of the former: by pivots of a QR factorisation of the rates that the
  /// loops allow. Lengths count in parts of `length()`.
  /// \param q  a position
  /// \return their numbers in ascending order, as many as there are independent rates
  [[nodiscard]] std::vector<int> independent_coordinates(const Eigen::VectorXd& q) const {
    const Eigen::MatrixXd rates = detail::linearised(*this, q).kernel();
    if (rates.cols() == 0) {
      return {};
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(rates.transpose());
    const auto& order = qr.colsPermutation().indices();
    std::vector<int> result(order.data(), order.data() + rates.cols());
    std::sort(result.begin(), result.end());
    return result;
  }

  // For those who extend duet.

  /// Of each coordinate the unit that is as much as a radian: `length()` where it is a length.
  [[nodiscard]] const Eigen::VectorXd& units() const { return units_; }

private:
  [[nodiscard]] attached_frame<double> frame(std::size_t i, const loop_frame& at) const {
    const auto& links = tree_.table().link_numbers;
    const auto found = links.find(at.link);
    if (found == links.end()) {
      std::vector<std::string> names;
      for (const tree_link& each : tree_.links()) {
        names.push_back(each.name);
      }
      detail::bad_loop(given_, i,
                       "no link \"" + at.link + "\": " + detail::nearest_names(at.link, names));
    }
    const auto& [r, t] = at.offset;
    if (!std::isfinite(t[0] + t[1] + t[2]) || !std::isfinite(norm2(r))) {
      detail::bad_loop(given_, i, "its frame on \"" + at.link + "\" is not finite");
    }
    return {found->second, at.offset};
  }

  void measure() {
    const auto longest = [&](const placement<double>& at) {
      const auto& t = at.translation;
      length_ = std::max(length_, std::hypot(t[0], t[1], t[2]));
    };
    for (const tree_loop& loop : given_.loops) {
      longest(loop.first.offset);
      longest(loop.second.offset);
      length_ = std::max(length_, loop.length);
    }
    units_ = Eigen::VectorXd::Ones(size());
    Eigen::Index i = 0;
    for (const tree_joint& each : tree_.joints()) {
      longest(each.motion.origin);
    }
    length_ = length_ > 0 && std::isfinite(length_) ? length_ : 1;
    for (const tree_joint& each : tree_.joints()) {
      if (each.mimic) {
        continue;
      }
      const joint_kind kind = each.motion.kind;
      const int lengths = kind == joint_kind::prismatic  ? 1
                          : kind == joint_kind::planar   ? 2
                          : kind == joint_kind::floating ? 3
                                                         : 0;
      units_.segment(i, lengths).setConstant(length_);
      i += each.motion.coordinates();
    }
  }

  kinematic_tree tree_;
  loop_description given_;
  std::vector<detail::loop_equations> equations_;
  Eigen::Index rows_ = 0;
  double length_ = 0;
  Eigen::VectorXd units_;
};

} // namespace duet
