// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "loops/loop_closure_solver.hpp"

#include <duet/core/errors.hpp>
#include <duet/core/text/closest_names.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/dual_quaternion/displacement.hpp>
#include <duet/kinematics/closed_loop.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/kinematic_tree.hpp>
#include <duet/kinematics/tree_loop.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/robotics/closed_tree.hpp>

#include <Eigen/Core>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace duet {
DUET_ABI_BEGIN

closed_chain_mechanism::closed_chain_mechanism(kinematic_tree tree, loop_constraints constraints)
    : tree_(std::move(tree)), constraints_(std::move(constraints)) {
  measure();
  for (std::size_t i = 0; i < constraints_.loops.size(); ++i) {
    const loop_constraint& loop = constraints_.loops[i];
    equations_.push_back({loop.kind, {frame(i, loop.second), frame(i, loop.first)}, loop.length});
    if (equations_.back().frames.frame.link == equations_.back().frames.observer.link) {
      detail::bad_loop(constraints_, i, "both frames are on the link \"" + loop.first.link + "\"");
    }
    if (loop.kind == constraint_kind::distance &&
        !(loop.length > 0 && std::isfinite(loop.length))) {
      detail::bad_loop(constraints_, i,
                       "the length is " + to_text(loop.length) + " (expected > 0)");
    }
    rows_ += equations_.back().size();
  }
}

Eigen::VectorXd closed_chain_mechanism::residuals(const Eigen::VectorXd& q) const {
  return residuals_at(q);
}
Eigen::MatrixXd closed_chain_mechanism::constraint_jacobian(const Eigen::VectorXd& q) const {
  return jacobian_at(q);
}

Eigen::VectorXd closed_chain_mechanism::assemble(const Eigen::VectorXd& guess,
                                                 const std::vector<int>& fixed) const {
  detail::require(guess.allFinite(),
                  "duet: closed_chain_mechanism: the initial guess is not finite");
  const detail::loop_closure_solver solver(*this, guess, detail::all_but(size(), fixed));
  if (!solver.has_closed()) {
    detail::raise(loop_closure_failure(
        "duet: closed_chain_mechanism: no configuration near the initial guess, residual " +
            to_text(solver.residual()),
        {guess.begin(), guess.end()}));
  }
  return solver.coordinates();
}

std::vector<int> closed_chain_mechanism::independent_coordinates(const Eigen::VectorXd& q) const {
  const Eigen::MatrixXd rates = detail::linearised(*this, q).kernel();
  if (rates.cols() == 0) {
    return {}; // Eigen does not factorise empty matrices
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(rates.transpose());
  const auto pivots = factors.colsPermutation().indices().head(rates.cols());
  std::vector<int> result(pivots.begin(), pivots.end());
  std::sort(result.begin(), result.end());
  return result;
}

attached_frame<double> closed_chain_mechanism::frame(std::size_t i,
                                                     const constraint_frame& at) const {
  const auto& links = tree_.table().link_numbers;
  const auto link = links.find(at.link);
  if (link == links.end()) {
    std::vector<std::string> names;
    for (const tree_link& each : tree_.links()) {
      names.push_back(each.name);
    }
    detail::bad_loop(constraints_, i,
                     "no link \"" + at.link + "\": " + detail::closest_names(at.link, names));
  }
  const auto& [r, t] = at.offset;
  if (!std::isfinite(t[0] + t[1] + t[2]) || !std::isfinite(squared_norm(r))) {
    detail::bad_loop(constraints_, i, "the frame on \"" + at.link + "\" is not finite");
  }
  return {link->second, at.offset};
}

void closed_chain_mechanism::measure() {
  const auto include_length = [&](const placement<double>& at) {
    const auto& t = at.translation;
    length_ = std::max(length_, std::hypot(t[0], t[1], t[2]));
  };
  for (const loop_constraint& loop : constraints_.loops) {
    include_length(loop.first.offset);
    include_length(loop.second.offset);
    length_ = std::max(length_, loop.length);
  }
  units_ = Eigen::VectorXd::Ones(size());
  Eigen::Index i = 0;
  for (const tree_joint& each : tree_.joints()) {
    include_length(each.motion.origin);
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
DUET_ABI_END
} // namespace duet
