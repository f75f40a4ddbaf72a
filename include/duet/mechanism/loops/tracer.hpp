// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/core/errors.hpp>
#include <duet/mechanism/closed_tree.hpp>
#include <duet/mechanism/coordinate_turns.hpp>
#include <duet/mechanism/loop_motion.hpp>
#include <duet/mechanism/loop_trace.hpp>
#include <duet/mechanism/loops/curve.hpp>
#include <duet/mechanism/loops/motion_follower.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

/// \file
/// How a motion is traced, which the library duet::compiled holds. For those who extend duet.

namespace duet {

namespace detail {

/// What a curve is like at its start, to see that it comes back.
class way_back {
public:
  way_back(const closed_tree& of, const loop_curve& curve, const curve_point& start)
      : units_(of.units()), angles_(coordinate_turns(of).angles), q_(curve.coordinates(start.x)),
        rates_(curve.rates(start.tangent).cwiseQuotient(units_)) {}

  /// Does the start lie between both points?
  [[nodiscard]] bool is_between(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const {
    const Eigen::VectorXd before = apart(from), after = apart(to);
    const double step = (after - before).norm();
    return before.norm() < 2 * step && after.norm() < 2 * step && before.dot(rates_) < 0 &&
           after.dot(rates_) >= 0;
  }

private:
  /// But for whole turns.
  [[nodiscard]] Eigen::VectorXd apart(const Eigen::VectorXd& q) const {
    Eigen::VectorXd result = (q - q_).cwiseQuotient(units_);
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      if (angles_[std::size_t(i)]) {
        result[i] = std::remainder(result[i], 2 * std::numbers::pi);
      }
    }
    return result;
  }

  const Eigen::VectorXd& units_;
  std::vector<bool> angles_;
  Eigen::VectorXd q_, rates_;
};

} // namespace detail

#ifdef DUET_DEFINES_COMPILED
DUET_COMPILED_FUNCTION loop_trace_result trace(const loop_motion& motion, int drive,
                                               const loop_trace_options& options) {
  const closed_tree& of = motion.mechanism();
  const auto count = int(motion.drives().size());
  detail::require(0 <= drive && drive < count, "duet: trace: no drive ", drive, " of ", count);
  const detail::loop_curve curve(of, motion.start(), motion.drives(),
                                 Eigen::VectorXd::Unit(count, drive));
  loop_trace_result result;
  const auto follow = [&](double direction) {
    std::vector<Eigen::VectorXd> positions;
    auto here = *curve.start(direction);
    const detail::way_back back(of, curve, here);
    double done = 0;
    for (double step = options.largest_step; step > 1e-7 && done < options.longest;) {
      const auto next = curve.advance(here, step);
      if (!next) {
        step /= 2;
        continue;
      }
      const Eigen::VectorXd q = curve.coordinates(here.x), to = curve.coordinates(next->x);
      result.is_closed = done > 0 && back.is_between(q, to);
      const Eigen::VectorXd before = curve.rates(here.tangent), after = curve.rates(next->tangent);
      for (int i = 0; i < of.size(); ++i) {
        const bool turns = (before[i] < 0) != (after[i] < 0) &&
                           std::abs(after[i] - before[i]) > 1e-9 * of.units()[i];
        if (turns) {
          const auto dead = curve.zero(here, *next, step, [&](const detail::curve_point& at) {
            return curve.rates(at.tangent)[i] / of.units()[i];
          });
          const Eigen::VectorXd rates = curve.rates(dead.end.tangent);
          result.dead_points.push_back(
              {i, curve.coordinates(dead.end.x), rates, detail::moving_coordinates(of, rates)});
        }
      }
      if (result.is_closed) {
        return positions;
      }
      positions.push_back(to);
      here = *next;
      done += step;
      step = std::min(options.largest_step, 2 * step);
    }
    result.meets_branches |= done < options.longest;
    return positions;
  };
  result.positions = follow(1);
  result.positions.insert(result.positions.begin(), motion.start());
  if (!result.is_closed) {
    std::vector<Eigen::VectorXd> other_way = follow(-1);
    std::reverse(other_way.begin(), other_way.end());
    result.positions.insert(result.positions.begin(), other_way.begin(), other_way.end());
  }
  return result;
}
#endif

} // namespace duet
