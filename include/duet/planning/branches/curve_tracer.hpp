// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/planning/branches/branch_search.hpp>
#include <duet/planning/branches/chain_loop.hpp>
#include <duet/planning/branches/joint_loop.hpp>
#include <duet/planning/branches/loop_answer.hpp>
#include <duet/planning/branches/orthonormalise.hpp>
#include <duet/planning/branches/seven_joints.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

/// \file
/// Curves of joint coordinates of seven joints on which the tip stays where it is are followed; the
/// library duet::compiled holds it.

namespace duet::detail {

/// Follows the curves of one arm and goal.
class curve_tracer {
public:
  /// \param step  from one point to the next at most
  curve_tracer(const seven_joints& arm, double step) : arm_(arm), step_(step) {}

  /// The curve through a point on it: once around, or to both ends.
  [[nodiscard]] traced_curve trace(const seven_coordinates& start) const {
    traced_curve result{{start}, false};
    const auto first = direction(start);
    if (!first || follow(result, *first)) {
      return result;
    }
    std::reverse(result.points.begin(), result.points.end());
    follow(result, -*first);
    return result;
  }

  /// Is a point with the tip at the goal on a curve?
  [[nodiscard]] bool is_on(const traced_curve& curve, const seven_coordinates& x) const {
    const std::size_t n = curve.points.size(), pieces = curve.is_closed ? n : n - 1;
    for (std::size_t k = 0; k < pieces; ++k) {
      const seven_coordinates &a = curve.points[k], &b = curve.points[(k + 1) % n];
      const seven_coordinates to_x = difference(x, a), way = difference(b, a);
      if (to_x.squaredNorm() > 4 * way.squaredNorm()) {
        continue;
      }
      // What of the curve is nearest to x, is x: from there Newton's method leads to it.
      const double part = std::clamp(to_x.dot(way) / way.squaredNorm(), 0., 1.);
      const auto between = corrected(moved(a, part * way));
      if (between && nearer(*between, x)) {
        return true;
      }
    }
    return false;
  }

private:
  /// b − a, the short way round; lengths in parts of the arm's size.
  [[nodiscard]] seven_coordinates difference(const seven_coordinates& b,
                                             const seven_coordinates& a) const {
    seven_coordinates d = b - a;
    for (int i = 0; i < 7; ++i) {
      d[i] = arm_.turns[std::size_t(i)] ? turned_back(d[i]) : d[i] / arm_.size;
    }
    return d;
  }
  [[nodiscard]] seven_coordinates moved(seven_coordinates x, const seven_coordinates& d) const {
    for (int i = 0; i < 7; ++i) {
      x[i] += arm_.turns[std::size_t(i)] ? d[i] : arm_.size * d[i];
    }
    return x;
  }

  /// Newton's method with the least steps.
  [[nodiscard]] std::optional<seven_coordinates> corrected(seven_coordinates x) const {
    constexpr double rounding = 1e-12;
    for (int k = 0; k < 12; ++k) {
      seven_columns j;
      const six_coordinates e = arm_.gap(x, j);
      if (e.norm() < rounding) {
        return x;
      }
      const seven_coordinates step = least_solution(j, e);
      if (!(step.norm() < step_)) {
        return {};
      }
      x = moved(x, step);
    }
    return {};
  }

  /// The unit vector that the Jacobian takes to 0; none where there are two.
  [[nodiscard]] std::optional<seven_coordinates> direction(const seven_coordinates& x) const {
    constexpr double singular = 1e-9;
    seven_columns j;
    static_cast<void>(arm_.gap(x, j));
    Eigen::Matrix<double, 7, 6> rows = j.transpose();
    orthonormalise(rows);
    const six_coordinates sizes = rows.cwiseProduct(j.transpose()).colwise().sum();
    if (!(sizes.minCoeff() > singular * sizes.maxCoeff())) {
      return {};
    }
    Eigen::Index least = 0; // the joint that is in the rows least
    rows.rowwise().squaredNorm().minCoeff(&least);
    seven_coordinates result = seven_coordinates::Unit(least);
    for (int k = 0; k < 2; ++k) { // once more for what was rounded
      result -= rows * (rows.transpose() * result);
      result.normalize();
    }
    return result;
  }

  /// Newton's method, with x kept where it is along the curve, from a point beside x.
  [[nodiscard]] bool nearer(const seven_coordinates& from, const seven_coordinates& x) const {
    constexpr double same = 1e-6;
    seven_coordinates at = from;
    for (int k = 0; k < 8; ++k) {
      const auto along = direction(at);
      if (!along) {
        return false;
      }
      const seven_coordinates left = difference(x, at);
      if (left.norm() < same) {
        return true;
      }
      const auto next = corrected(moved(at, left.dot(*along) * *along));
      if (!next) {
        return false;
      }
      at = *next;
    }
    return difference(x, at).norm() < same;
  }

  /// Adds points until the curve is back at its first one.
  /// \return did it get there?
  bool follow(traced_curve& curve, seven_coordinates along) const {
    constexpr int most = 100000;
    constexpr double smallest = 1e-5;
    const seven_coordinates home = curve.points.front(), leaving = along;
    double step = step_ / 2;
    for (int k = 0; k < most && step > smallest; ++k) {
      const seven_coordinates& last = curve.points.back();
      const auto next = corrected(moved(last, step * along));
      auto ahead = next ? direction(*next) : std::nullopt;
      if (ahead && ahead->dot(along) < 0) {
        ahead = -*ahead;
      }
      const double bend = ahead ? (*ahead - along).norm() : 1;
      if (!(bend < .3) || difference(*next, last).norm() > step_) {
        step /= 2;
        continue;
      }
      const seven_coordinates back = difference(home, last);
      const double way = back.dot(along);
      const bool is_home = curve.points.size() > 2 && way > 0 && way <= 1.5 * step &&
                           back.norm() < 2 * way && along.dot(leaving) > .5;
      if (is_home && (curve.points.size() > 3)) {
        curve.is_closed = true;
        return true;
      }
      curve.points.push_back(*next);
      along = *ahead;
      step = std::min(step_ / 2, bend < .1 ? 2 * step : step);
    }
    return false;
  }

  const seven_joints& arm_;
  double step_;
};

/// The configurations with joint `held` at a value, from all solutions of the other six.
inline void add_held(const seven_joints& arm, int held, double value,
                     std::vector<seven_coordinates>& found) {
  const chain_axes axes = arm.axes_beside(held, value);
  const branch_search search(axes.loop_to(arm.goal));
  if (!search.answer().is_complete) {
    return; // this joint stands still, or cannot be held there
  }
  for (const loop_solution& x : search.answer().solutions) {
    seven_coordinates result;
    for (int i = 0, k = 0; i < 7; ++i) {
      result[i] = i == held ? value : x.theta[k] * (arm.turns[std::size_t(i)] ? 1 : axes.size);
      k += i != held;
    }
    found.push_back(result);
  }
}

#ifdef DUET_DEFINES_COMPILED
DUET_COMPILED_FUNCTION std::vector<traced_curve> all_curves(const seven_joints& arm,
                                                            double resolution) {
  const curve_tracer tracer(arm, resolution);
  std::vector<seven_coordinates> seeds;
  const int count = int(std::ceil(2 * std::numbers::pi / resolution));
  for (int held = 0; held < 7; ++held) {
    for (int k = 0; k < count && arm.turns[std::size_t(held)]; ++k) {
      // not at a table's round numbers, where arms are singular
      const double turn = 2 * std::numbers::pi * (k + .37) / count - std::numbers::pi;
      add_held(arm, held, turn, seeds);
    }
  }
  std::vector<traced_curve> result;
  while (!seeds.empty()) {
    result.push_back(tracer.trace(seeds.back()));
    seeds.pop_back();
    std::erase_if(seeds, [&](const auto& seed) { return tracer.is_on(result.back(), seed); });
  }
  return result;
}
#endif

} // namespace duet::detail
