// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/mechanism/jacobian.hpp>
#include <duet/planning/branches/loop_solutions.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/planning/planning_model.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

/// \file
/// Curves of joint coordinates of seven joints on which the tip stays where it is.

namespace duet::detail {

using seven_coordinates = Eigen::Matrix<double, 7, 1>;

/// Points of a curve, one after the other.
struct traced_curve {
  std::vector<seven_coordinates> points;
  bool is_closed = false;
};

/// Follows the curves of one chain and goal.
template <class C>
class curve_tracer {
  using jacobian_matrix = Eigen::Matrix<double, 6, 7>;

public:
  curve_tracer(const C& chain, const tip_place& goal, double step)
      : chain_(chain), goal_(goal), step_(step) {
    const chain_model<C> model(chain);
    size_ = model.length;
    for (int i = 0; i < 7; ++i) {
      turns_[std::size_t(i)] = chain.steps()[std::size_t(i)].turns;
    }
  }

  [[nodiscard]] bool turns(int i) const { return turns_[std::size_t(i)]; }

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
      d[i] = turns(i) ? turned_back(d[i]) : d[i] / size_;
    }
    return d;
  }
  [[nodiscard]] seven_coordinates moved(seven_coordinates x, const seven_coordinates& d) const {
    for (int i = 0; i < 7; ++i) {
      x[i] += turns(i) ? d[i] : size_ * d[i];
    }
    return x;
  }

  /// The tip's gap from the goal, and the Jacobian, lengths in parts of the arm's size.
  [[nodiscard]] six_coordinates gap(const seven_coordinates& x, jacobian_matrix& jacobian) const {
    small_matrix<6, 8> columns;
    const tip_place tip = fill_jacobian<hybrid_frame, true, double>(
        columns, chain_, own_joints(chain_, x), tip_of_chain{});
    const small_twist e = error_twist(tip, goal_);
    six_coordinates result;
    for (int k = 0; k < 6; ++k) {
      const double unit = k < 3 ? 1 / size_ : 1;
      result[k] = unit * e[k];
      for (int i = 0; i < 7; ++i) {
        jacobian(k, i) = unit * (turns(i) ? 1 : size_) * columns(k, i);
      }
    }
    return result;
  }

  /// Newton's method with the least steps.
  [[nodiscard]] std::optional<seven_coordinates> corrected(seven_coordinates x) const {
    constexpr double rounding = 1e-12;
    for (int k = 0; k < 12; ++k) {
      jacobian_matrix j;
      const six_coordinates e = gap(x, j);
      if (e.norm() < rounding) {
        return x;
      }
      const six_columns square = j * j.transpose();
      const seven_coordinates step = j.transpose() * square.ldlt().solve(e);
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
    jacobian_matrix j;
    static_cast<void>(gap(x, j));
    const Eigen::ColPivHouseholderQR<Eigen::Matrix<double, 7, 6>> qr(j.transpose());
    const auto pivots = qr.matrixQR().diagonal().cwiseAbs();
    if (!(pivots.minCoeff() > singular * pivots.maxCoeff())) {
      return {};
    }
    return seven_coordinates(qr.householderQ() * seven_coordinates::Unit(6));
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

  const C& chain_;
  tip_place goal_;
  double step_;
  double size_ = 1;
  std::array<bool, 7> turns_{};
};

} // namespace duet::detail
