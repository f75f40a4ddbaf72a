// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/planning/bounded_step.hpp>
#include <duet/planning/cholesky.hpp>
#include <duet/planning/path_step.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

/// \file
/// What a chain can reach along a path of its tip, if it may also move with the tip in place.

namespace duet::detail {

/// The direction next to `wish`, of unit length, in which the joints move without the tip; zero
/// where there is none.
/// \param gram  the factors of J Jᵀ
template <class J, class V>
[[nodiscard]] V self_motion_direction(const J& jacobian, const cholesky<matrix6<double>>& gram,
                                      V wish) {
  for (int round = 0; round < 2; ++round) { // the second time for rounding
    vector6<double> moved = vector6<double>::Zero();
    for (Eigen::Index i = 0; i < wish.size(); ++i) {
      moved += wish[i] * jacobian.col(i);
    }
    const vector6<double> force = gram.solve(moved);
    for (Eigen::Index i = 0; i < wish.size(); ++i) {
      wish[i] -= jacobian.col(i).dot(force);
    }
    const double length = wish.norm();
    if (!(length > 1e-3)) {
      return V::Zero(wish.size());
    }
    wish /= length;
  }
  return wish;
}

/// A configuration that can be reached, and from which: one at the same parameter, in place, or one
/// before.
template <int N>
struct reachable {
  chain_state<N> state;
  double u;
  std::ptrdiff_t from; ///< its number, −1 for none
};

/// Collects what is reachable, parameter by parameter.
///
/// At each parameter the configurations that hold the tip at its pose form curves (one joint to
/// spare), cut by the limits. One point of such a piece is as good as any other, as the arm can
/// move along it with the tip in place; so the whole piece is followed, in steps of `spacing`, and
/// from all its points one step is taken to the next parameter, where those pieces are followed
/// that are new. With several joints to spare one curve of the manifold is, with none a piece is a
/// point.
template <int N>
class self_motion_search {
public:
  using vector = joint_vector<double, N>;

  self_motion_search(const pose_solver<N>& solver, const path_function& target, double spacing,
                     int iterations)
      : solver_(solver), target_(target), spacing_(spacing), left_(iterations) {}

  /// The way from a state at u.front() to u.back(), or as far as it goes, each configuration a step
  /// from the one before.
  [[nodiscard]] std::vector<reachable<N>> run(const chain_state<N>& start,
                                              const std::vector<double>& u) {
    found_.push_back({start, u.front(), -1});
    follow(0, target_(u.front()));
    std::size_t first = 0;
    for (std::size_t k = 1; k < u.size(); ++k) {
      const std::size_t end = found_.size();
      const auto target = target_(u[k]);
      for (std::size_t i = first; i < end && left_ > 0; ++i) {
        const auto next = go(found_[i].state, found_[i].u, u[k], 3);
        if (next.is_within(solver_.tolerance()) && !is_known(next.state.theta, end)) {
          found_.push_back({next.state, u[k], std::ptrdiff_t(i)});
          follow(found_.size() - 1, target);
        }
      }
      if (found_.size() == end) {
        break;
      }
      first = end;
    }
    std::vector<reachable<N>> way;
    for (auto i = std::ptrdiff_t(first); i >= 0; i = found_[std::size_t(i)].from) {
      way.push_back(found_[std::size_t(i)]);
    }
    std::reverse(way.begin(), way.end());
    return way;
  }
  [[nodiscard]] int iterations_left() const { return left_; }

private:
  [[nodiscard]] attempt<N> tried(const chain_state<N>& from, const dual_quaternion<double>& target,
                                 const vector& wish) {
    auto result = solver_.approach(from, target, wish);
    left_ -= result.iterations;
    return result;
  }

  /// On to another parameter, in up to 2^`halvings` steps.
  [[nodiscard]] attempt<N> go(const chain_state<N>& from, double u, double to, int halvings) {
    const vector none = vector::Zero(from.theta.size());
    auto direct = tried(from, target_(to), none);
    const bool is_jump = (direct.state.theta - from.theta).norm() > .5;
    if ((direct.is_within(solver_.tolerance()) && !is_jump) || halvings == 0) {
      if (is_jump) {
        direct.left.length = std::numeric_limits<double>::infinity();
      }
      return direct;
    }
    const double middle = (u + to) / 2;
    auto half = go(from, u, middle, halvings - 1);
    return half.is_within(solver_.tolerance()) ? go(half.state, middle, to, halvings - 1) : half;
  }

  [[nodiscard]] bool is_known(const vector& theta, std::size_t first) const {
    return std::any_of(found_.begin() + std::ptrdiff_t(first), found_.end(), [&](const auto& x) {
      return (x.state.theta - theta).squaredNorm() < .5 * spacing_ * spacing_;
    });
  }

  /// Adds the piece that found_[start] is on, in both directions by turns, so that what is near
  /// comes first.
  void follow(std::size_t start, const dual_quaternion<double>& target) {
    const auto& jacobian = found_[start].state.jacobian;
    const cholesky gram(gram_matrix(jacobian));
    const Eigen::Index n = jacobian.cols();
    vector best = vector::Zero(n);
    double largest = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const vector d = self_motion_direction(jacobian, gram, vector(vector::Unit(n, i)));
      if (std::abs(d[i]) > largest) { // d[i] is how much of the unit vector is in d
        largest = std::abs(d[i]);
        best = d;
      }
    }
    front ends[2] = {{start, best, spacing_}, {start, -best, spacing_}};
    bool is_open[2] = {largest > 0, largest > 0};
    for (int count = 0; (is_open[0] || is_open[1]) && left_ > 0; ++count) {
      const int side = count % 2;
      if (is_open[side]) {
        is_open[side] = slide(ends[side], target);
        // A closed curve: the ends meet.
        if (count > 6 && (found_[ends[0].at].state.theta - found_[ends[1].at].state.theta).norm() <
                             .8 * spacing_) {
          return;
        }
      }
    }
  }

  struct front {
    std::size_t at;
    vector direction;
    double step;
  };

  /// One step on; false at the end of the piece.
  bool slide(front& end, const dual_quaternion<double>& target) {
    const chain_state<N>& here = found_[end.at].state;
    // As far as the limits allow.
    double reach = end.step;
    for (Eigen::Index i = 0; i < here.theta.size(); ++i) {
      const double d = end.direction[i];
      if (std::abs(d) > 1e-9) {
        const double bound = d > 0 ? solver_.model().upper()[i] : solver_.model().lower()[i];
        reach = std::min(reach, (bound - here.theta[i]) / d);
      }
    }
    for (; reach > spacing_ / 100; reach /= 2) {
      const auto next = tried(here, target, vector(reach * end.direction));
      const vector moved = next.state.theta - here.theta;
      if (next.is_within(solver_.tolerance()) && moved.norm() < 2 * reach &&
          moved.dot(end.direction) > .7 * reach) {
        const auto& jacobian = next.state.jacobian;
        const vector direction =
            self_motion_direction(jacobian, cholesky(gram_matrix(jacobian)), end.direction);
        if (direction.dot(end.direction) > .7) {
          found_.push_back({next.state, found_[end.at].u, std::ptrdiff_t(end.at)});
          end = {found_.size() - 1, direction, std::min(spacing_, 2 * reach)};
          return true;
        }
      }
    }
    return false;
  }

  const pose_solver<N>& solver_;
  const path_function& target_;
  double spacing_;
  int left_;
  std::vector<reachable<N>> found_;
};

} // namespace duet::detail
