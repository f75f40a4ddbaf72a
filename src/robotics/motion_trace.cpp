// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "loops/branch_finder.hpp"
#include "loops/periodic_coordinates.hpp"
#include "loops/solution_curve.hpp"

#include <duet/core/errors.hpp>
#include <duet/robotics/closed_tree.hpp>
#include <duet/robotics/loop_motion.hpp>
#include <duet/robotics/loop_trace.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

namespace duet::detail {
namespace {

/// Start of a curve with its rates, to detect that the curve returns.
class closure_test {
public:
  closure_test(const closed_chain_mechanism& of, const solution_curve& curve,
               const curve_point& start)
      : units_(of.units()), angles_(periodic_coordinates(of).angles),
        q_(curve.coordinates(start.x)), rates_(curve.rates(start.tangent).cwiseQuotient(units_)) {}

  /// True if the start is between both points.
  [[nodiscard]] bool is_between(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const {
    const Eigen::VectorXd displacement = (to - from).cwiseQuotient(units_);
    const Eigen::VectorXd before = difference(from), after = before + displacement;
    const double step = displacement.norm();
    return before.norm() < 2 * step && after.norm() < 2 * step && before.dot(rates_) < 0 &&
           after.dot(rates_) >= 0;
  }

private:
  /// Difference of q from the start, except for full turns.
  [[nodiscard]] Eigen::VectorXd difference(const Eigen::VectorXd& q) const {
    Eigen::VectorXd result = (q - q_).cwiseQuotient(units_);
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      if (angles_[std::size_t(i)]) {
        result[i] = std::remainder(result[i], 2 * std::numbers::pi);
      }
    }
    return result;
  }

  Eigen::VectorXd units_;
  std::vector<bool> angles_;
  Eigen::VectorXd q_, rates_;
};

/// Traces a motion along one of its driven coordinates.
class tracer {
public:
  tracer(const driven_motion& motion, int drive, const trace_options& options)
      : of_(motion.mechanism()), options_(options),
        curve_(of_, motion.start(), motion.drives(),
               Eigen::VectorXd::Unit(Eigen::Index(motion.drives().size()), drive)) {}

  [[nodiscard]] motion_trace run() {
    result_.positions = follow(1);
    result_.positions.insert(result_.positions.begin(), curve_.coordinates(curve_.start(1)->x));
    if (!result_.is_closed) {
      std::vector<Eigen::VectorXd> backwards = follow(-1);
      std::reverse(backwards.begin(), backwards.end());
      result_.positions.insert(result_.positions.begin(), backwards.begin(), backwards.end());
    }
    return result_;
  }

private:
  [[nodiscard]] std::vector<Eigen::VectorXd> follow(double direction) {
    std::vector<Eigen::VectorXd> positions;
    curve_point current = *curve_.start(direction);
    closure_test closure(of_, curve_, current);
    double done = 0;
    for (double step = options_.largest_step; step > 1e-7 && done < options_.max_length;) {
      auto next = curve_.advance(current, step);
      bool changes_branch = false;
      if (next) {
        add_dead_points(current, *next, step);
      } else {
        step /= 2;
        next = past_branch_point(current, step);
        if (!next) {
          continue;
        }
        step = (next->x - current.x).norm();
        changes_branch = result_.branch_points.back().chosen != 0;
      }
      const Eigen::VectorXd to = curve_.coordinates(next->x);
      if (changes_branch) {
        closure = closure_test(of_, curve_, *next);
      } else if (done > 0 && closure.is_between(curve_.coordinates(current.x), to)) {
        result_.is_closed = true;
        return positions;
      }
      positions.push_back(to);
      current = *next;
      done += step;
      step = std::min(options_.largest_step, 2 * step);
    }
    result_.stopped_early |= done < options_.max_length;
    return positions;
  }

  void add_dead_points(const curve_point& from, const curve_point& to, double step) {
    const Eigen::VectorXd before = curve_.rates(from.tangent), after = curve_.rates(to.tangent);
    for (int i = 0; i < of_.size(); ++i) {
      if (changes_sign(before[i], after[i], i)) {
        const auto dead = curve_.zero(from, to, step, [&](const curve_point& at) {
          return curve_.rates(at.tangent)[i] / of_.units()[i];
        });
        add_dead_point(i, dead.end.x, dead.end.tangent);
      }
    }
  }
  [[nodiscard]] bool changes_sign(double before, double after, int i) const {
    return (before < 0) != (after < 0) && std::abs(after - before) > 1e-9 * of_.units()[i];
  }
  void add_dead_point(int i, const Eigen::VectorXd& x, const Eigen::VectorXd& tangent) {
    const Eigen::VectorXd rates = curve_.rates(tangent);
    result_.dead_points.push_back(
        {i, curve_.coordinates(x), rates, moving_coordinates(of_, rates)});
  }

  /// A point behind a branch point, if steps became so small that one may be near.
  [[nodiscard]] std::optional<curve_point> past_branch_point(const curve_point& from, double step) {
    const auto crossing = branch_point_ahead(curve_, from, step);
    if (!crossing) {
      return std::nullopt;
    }
    branch_point at{curve_.coordinates(crossing->x), {}, 0};
    for (const Eigen::VectorXd& tangent : crossing->tangents) {
      at.tangents.push_back(curve_.rates(tangent));
    }
    const std::size_t met = result_.branch_points.size();
    at.chosen = met < options_.branches.size() ? options_.branches[met] : 0;
    require(at.chosen < at.tangents.size(), "duet: trace: branch ", at.chosen,
            " does not exist, branch point ", met, " has ", at.tangents.size());
    result_.branch_points.push_back(at);
    const curve_point& to = crossing->points[at.chosen];
    const Eigen::VectorXd before = curve_.rates(from.tangent), after = curve_.rates(to.tangent);
    for (int i = 0; i < of_.size(); ++i) {
      const bool rests = std::abs(at.tangents[0][i]) < 1e-9 * of_.units()[i];
      if (at.chosen == 0 && rests && changes_sign(before[i], after[i], i)) {
        add_dead_point(i, crossing->x, crossing->tangents[0]);
      }
    }
    return to;
  }

  const closed_chain_mechanism& of_;
  trace_options options_;
  solution_curve curve_;
  motion_trace result_;
};

} // namespace
} // namespace duet::detail

namespace duet {
DUET_ABI_BEGIN

motion_trace trace(const driven_motion& motion, int drive, const trace_options& options) {
  const auto count = int(motion.drives().size());
  detail::require(0 <= drive && drive < count, "duet: trace: driven coordinate ", drive,
                  " does not exist, the motion has ", count);
  return detail::tracer(motion, drive, options).run();
}
DUET_ABI_END
} // namespace duet
