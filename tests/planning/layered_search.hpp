// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "planning/complete_search.hpp"

#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/mechanism/jacobian.hpp>
#include <duet/mechanism/serial_chain.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/planning/self_motion_curves.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <utility>
#include <vector>

/// \file
/// How far an arm of seven joints can follow a path that may be left for motions in place.

namespace duet_test {

/// Layer by layer along a path: all curves of self-motion, cut into pieces by limits, and which
/// pieces joints get to from those before, from any of their points. Ranges of joints are less than
/// a turn, so configurations are told apart by their angles.
class layered_search {
public:
  using joints = Eigen::Matrix<double, 7, 1>;
  using path_function = std::function<duet::dual_quaternion<double>(double)>;

  /// \param known  a configuration that is known to be within reach at a parameter, or nothing
  layered_search(const duet::serial_chain<7>& arm, path_function path,
                 std::function<std::optional<joints>(double)> known)
      : arm_(arm), path_(std::move(path)), known_(std::move(known)) {}

  [[nodiscard]] path_verdict operator()(const joints& start) const {
    constexpr int layers = 48;
    layer here = layer_at(0);
    reach(here, start);
    for (int k = 0; k < layers; ++k) {
      const double end = double(k + 1) / layers;
      double step = end - here.u;
      while (here.u < end) {
        layer next = layer_at(here.u + step > end - 1e-9 ? end : here.u + step);
        advance(here, next);
        if (next.reached.empty()) {
          step /= 4;
          if (step < least) {
            const bool is_beyond = goes_on_without_limits(here, 4 * least);
            return {here.u,
                    is_beyond ? duet::stop_reason::joint_limit : duet::stop_reason::singular,
                    is_beyond && !goes_on_without_limits(here, 1e-4)};
          }
        } else {
          here = std::move(next);
        }
      }
    }
    return {1, duet::stop_reason::reached};
  }

private:
  static constexpr double least = 1e-6, resolution = .2;
  static constexpr int none = -1;

  struct point {
    joints x;
    int curve, piece;    ///< `none`: outside the limits
    std::ptrdiff_t next; ///< on its curve
  };
  struct layer {
    double u;
    std::vector<point> points;
    int pieces = 0;
    std::set<int> reached;
    std::vector<joints> beside; ///< what is reached and on no piece that points show
  };

  [[nodiscard]] bool is_within_limits(const joints& x) const {
    for (int i = 0; i < 7; ++i) {
      if (!(x[i] >= arm_.limits(i).lower - 1e-9 && x[i] <= arm_.limits(i).upper + 1e-9)) {
        return false;
      }
    }
    return true;
  }

  [[nodiscard]] layer layer_at(double u) const {
    layer result;
    result.u = u;
    int number = 0;
    for (const auto& curve : duet::self_motion_curves(arm_, path_(u), {resolution})) {
      const std::size_t first = result.points.size();
      for (joints x : curve.joints) {
        for (int i = 0; i < 7; ++i) {
          const double middle = (arm_.limits(i).lower + arm_.limits(i).upper) / 2;
          x[i] = middle + std::remainder(x[i] - middle, 2 * std::numbers::pi);
        }
        const bool is_inside = is_within_limits(x);
        if (result.points.size() > first && curve.dimension == 1) {
          result.points.back().next = std::ptrdiff_t(result.points.size());
        }
        const bool goes_on = is_inside && curve.dimension == 1 && result.points.size() > first &&
                             result.points.back().piece != none &&
                             (result.points.back().x - x).norm() < 1;
        result.points.push_back({x, number,
                                 !is_inside ? none
                                 : goes_on  ? result.points.back().piece
                                            : result.pieces++,
                                 none});
      }
      if (curve.is_closed && result.points.size() > first) {
        point& last = result.points.back();
        last.next = std::ptrdiff_t(first);
        const int piece = result.points[first].piece;
        if (last.piece != none && piece != none && (last.x - result.points[first].x).norm() < 1) {
          const int same = last.piece;
          for (std::size_t i = first; i < result.points.size(); ++i) {
            point& p = result.points[i];
            p.piece = p.piece == same ? piece : p.piece;
          }
        }
      }
      ++number;
    }
    return result;
  }

  /// Newton's method by least steps of the joints that limits do not hold; nothing where it leads
  /// far away.
  [[nodiscard]] std::optional<joints> at(double u, const joints& from, bool keeps_limits) const {
    const auto goal = duet::detail::to_tip_pose(path_(u));
    joints x = from;
    for (int round = 0; round < 8; ++round) {
      const auto e = duet::detail::error_twist(duet::detail::to_tip_pose(arm_.pose(x)), goal);
      const Eigen::Map<const Eigen::Matrix<double, 6, 1>> error(&e.values[0]);
      if (error.norm() < 1e-9) {
        return x;
      }
      Eigen::Matrix<double, 6, 7> j = duet::jacobian(arm_, x, duet::frame::hybrid);
      const auto step = [&] {
        Eigen::Matrix<double, 6, 6> gram = j * j.transpose();
        gram.diagonal().array() += 1e-14;
        return joints(j.transpose() * gram.ldlt().solve(error));
      };
      joints y = x + step();
      if (keeps_limits) {
        bool is_held = false;
        for (int i = 0; i < 7; ++i) {
          const double bounded = std::clamp(y[i], arm_.limits(i).lower, arm_.limits(i).upper);
          if (bounded != y[i] && bounded == x[i]) {
            j.col(i).setZero();
            is_held = true;
          }
        }
        y = is_held ? joints(x + step()) : y;
        for (int i = 0; i < 7; ++i) {
          y[i] = std::clamp(y[i], arm_.limits(i).lower, arm_.limits(i).upper);
        }
      }
      if (!((y - from).norm() < .15)) {
        return {};
      }
      x = y;
    }
    return {};
  }

  [[nodiscard]] std::optional<joints> follow(joints x, double u, double to,
                                             bool keeps_limits) const {
    constexpr int parts = 4;
    for (int k = 1; k <= parts; ++k) {
      const auto next = at(u + (to - u) * k / parts, x, keeps_limits);
      if (!next) {
        return {};
      }
      x = *next;
    }
    return x;
  }

  /// What is next to a configuration is reached with it.
  void reach(layer& at, const joints& x) const {
    double nearest = .05;
    int piece = none;
    for (const point& p : at.points) {
      if (p.next == none) {
        continue;
      }
      const point& q = at.points[std::size_t(p.next)];
      const joints way = q.x - p.x;
      const int its = p.piece != none ? p.piece : q.piece;
      if (its == none || way.norm() > 1) {
        continue;
      }
      const double part = std::clamp(way.dot(x - p.x) / way.squaredNorm(), 0., 1.);
      const double distance = (p.x + part * way - x).norm();
      if (distance < nearest) {
        nearest = distance;
        piece = p.piece != none && q.piece != none && part > .5 ? q.piece : its;
      }
    }
    if (piece != none) {
      at.reached.insert(piece);
    } else {
      if (std::none_of(at.beside.begin(), at.beside.end(),
                       [&](const joints& y) { return (x - y).norm() < .02; })) {
        at.beside.push_back(x);
      }
      at.reached.insert(at.pieces); // one that no point is on
    }
  }

  void advance(const layer& here, layer& next) const {
    const auto go = [&](const joints& x) {
      if (const auto y = follow(x, here.u, next.u, true)) {
        reach(next, *y);
      }
    };
    for (const point& p : here.points) {
      if (p.piece != none && here.reached.count(p.piece) > 0) {
        go(p.x);
      }
    }
    for (const joints& x : here.beside) {
      go(x);
    }
    if (const auto x = known_(next.u)) {
      if (const auto y = at(next.u, *x, true)) {
        reach(next, *y);
      }
    }
  }

  [[nodiscard]] bool goes_on_without_limits(const layer& here, double by) const {
    std::set<int> curves;
    for (const point& p : here.points) {
      if (here.reached.count(p.piece) > 0) {
        curves.insert(p.curve);
      }
    }
    const auto goes_on = [&](const joints& x) {
      return bool(follow(x, here.u, std::min(1., here.u + by), false));
    };
    return std::any_of(here.points.begin(), here.points.end(),
                       [&](const point& p) { return curves.count(p.curve) > 0 && goes_on(p.x); }) ||
           std::any_of(here.beside.begin(), here.beside.end(), goes_on);
  }

  const duet::serial_chain<7>& arm_;
  path_function path_;
  std::function<std::optional<joints>(double)> known_;
};

/// How far a way leads that may leave a plan anywhere.
template <class Plan>
[[nodiscard]] path_verdict complete_way(const duet::serial_chain<7>& arm,
                                        const layered_search::path_function& path,
                                        const Plan& plan) {
  const auto known = [&](double u) -> std::optional<layered_search::joints> {
    const auto next = std::lower_bound(plan.tau.begin(), plan.tau.end(), u) - plan.tau.begin();
    if (next == std::ptrdiff_t(plan.tau.size())) {
      return {};
    }
    const auto k = std::size_t(next);
    const double part = k == 0 ? 0 : (u - plan.tau[k - 1]) / (plan.tau[k] - plan.tau[k - 1]);
    return k == 0 ? plan.joints[0] : (1 - part) * plan.joints[k - 1] + part * plan.joints[k];
  };
  return layered_search(arm, path, known)(plan.joints.front());
}

} // namespace duet_test
