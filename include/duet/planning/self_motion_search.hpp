// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/planning/bounded_step.hpp>
#include <duet/planning/path_step.hpp>
#include <duet/planning/planning_model.hpp>
#include <duet/planning/singularity.hpp>
#include <duet/planning/small_vector.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

/// \file
/// What a chain can reach along a path of its tip, if it may also move with the tip in place.

namespace duet::detail {

/// A configuration that can be reached, and from which: one at the same parameter, in place, or one
/// before.
template <int Room>
struct reachable {
  chain_state<Room> state;
  double u;
  std::ptrdiff_t from;     ///< its number, −1 for none
  bool is_way_out = false; ///< is that one singular, and this one beside it?
  bool is_alone = false;   ///< is it a piece of its own?
};

/// Collects what is reachable, parameter by parameter.
///
/// At each parameter the configurations that hold the tip at its pose form curves (one joint to
/// spare), cut by the limits. One point of such a piece is as good as any other, as the arm can
/// move along it with the tip in place; so the whole piece is followed, in steps of `spacing`, and
/// from all its points one step is taken to the next parameter, where those pieces are followed
/// that are new. With several joints to spare one curve of the manifold is, with none a piece is a
/// point.
template <int Room>
class self_motion_search {
public:
  using vector = small_vector<Room>;

  /// \param singular  configurations with a singular value below it are left to both sides, too
  self_motion_search(const pose_solver<Room>& solver, const place_function& target, double spacing,
                     double singular, int iterations)
      : solver_(solver), target_(target), spacing_(spacing), singular_(singular),
        left_(iterations) {
    for (std::ptrdiff_t i = 0; i < solver.model.size; ++i) {
      is_endless_ = is_endless_ || solver.is_endless(i);
    }
  }

  /// Each configuration a step from the one before.
  using configurations = std::vector<reachable<Room>>;

  /// Ways from a state at u.front() to u.back(), or as far as they go: one that leads farthest, and
  /// one to each other piece that is a point.
  [[nodiscard]] std::vector<configurations> run(const chain_state<Room>& start,
                                                const std::vector<double>& u) {
    found_.push_back({start, u.front(), -1});
    follow(0, target_(u.front()));
    std::size_t first = 0;
    farthest_ = {};
    for (std::size_t k = 1; k < u.size(); ++k) {
      const std::size_t end = found_.size();
      const tip_place target = target_(u[k]);
      for (std::size_t i = first; i < end && left_ > 0; ++i) {
        const chain_state<Room> here = found_[i].state;
        const bool is_singular = smallest_singular_value_of(here.jacobian) < singular_;
        const auto add = [&](const attempt<Room>& next) {
          if (next.is_within(solver_.tolerance) && !is_known(next.state.theta, end) &&
              (!is_singular || leads(next.state, u[k], here, u[k - 1]))) {
            found_.push_back({next.state, u[k], std::ptrdiff_t(i), is_singular});
            follow(found_.size() - 1, target);
          }
        };
        farthest_.now = i;
        add(go(here, found_[i].u, u[k], 6));
        if (is_singular) {
          leave(here, target, add);
          const std::ptrdiff_t before = found_[i].from;
          if (before >= 0 && found_[std::size_t(before)].u == found_[i].u) {
            leave_between(found_[std::size_t(before)].state, here, target, add);
          }
        }
      }
      if (found_.size() == end) {
        break;
      }
      first = end;
    }
    const std::size_t best = std::max(first, farthest_.from);
    std::vector<configurations> result{way_to(best)};
    for (std::size_t i = first; i < found_.size(); ++i) {
      if (i != best && found_[i].is_alone) {
        result.push_back(way_to(i));
      }
    }
    return result;
  }
  [[nodiscard]] int iterations_left() const { return left_; }

private:
  [[nodiscard]] configurations way_to(std::size_t last) const {
    configurations result;
    for (auto i = std::ptrdiff_t(last); i >= 0; i = found_[std::size_t(i)].from) {
      result.push_back(found_[std::size_t(i)]);
    }
    std::reverse(result.begin(), result.end());
    return result;
  }

  [[nodiscard]] attempt<Room> tried(const chain_state<Room>& from, const tip_place& target,
                                    const vector& wish) {
    auto result = solver_.approach(from, target, wish);
    left_ -= result.iterations;
    return result;
  }

  /// On to another parameter, in up to 2^`halvings` steps.
  [[nodiscard]] attempt<Room> go(const chain_state<Room>& from, double u, double to, int halvings) {
    auto direct = tried(from, target_(to), {});
    const bool is_jump = norm(direct.state.theta - from.theta) > .15;
    if ((direct.is_within(solver_.tolerance) && !is_jump) || halvings == 0) {
      if (is_jump) {
        direct.left.length = std::numeric_limits<double>::infinity();
      } else if (direct.is_within(solver_.tolerance) && to > farthest_.u) {
        farthest_ = {to, farthest_.now, farthest_.now};
      }
      return direct;
    }
    const double middle = (u + to) / 2;
    auto half = go(from, u, middle, halvings - 1);
    return half.is_within(solver_.tolerance) ? go(half.state, middle, to, halvings - 1) : half;
  }

  /// Configurations for a target near that of a singular one, which lie to both sides of it.
  template <class Add>
  void leave(const chain_state<Room>& singular, const tip_place& target, const Add& add) {
    const singular_point<Room> here(singular.jacobian);
    const small_twist e = error_twist(singular.tip, target);
    const vector out = here.way_out();
    const auto [step, other] = here.steps_for(e);
    const double way = norm(e);
    for (const vector& offset :
         {step, other, way * out, -way * out, std::sqrt(way) * out, -std::sqrt(way) * out}) {
      if (!(norm(offset) > 0)) {
        continue;
      }
      vector beside = singular.theta + offset;
      for (std::ptrdiff_t i = 0; i < beside.size(); ++i) {
        beside[i] = std::clamp(beside[i], solver_.lower[i], solver_.upper[i]);
      }
      const auto next = tried(solver_.model.at(beside), target, {});
      if (norm(next.state.theta - singular.theta) < .5) {
        add(next);
      }
    }
  }

  /// Between two neighbours on a piece of singular configurations: from where the twist to the
  /// target is one that joint rates make. Beside that Newton's method does not get there.
  template <class Add>
  void leave_between(chain_state<Room> a, chain_state<Room> b, const tip_place& target,
                     const Add& add) {
    const tip_place here = a.tip;
    small_twist w = left_out_twist(a.jacobian);
    const auto missing = [&](const chain_state<Room>& x) {
      const small_twist next = left_out_twist(x.jacobian);
      w = dot(next, w) < 0 ? -1 * next : next;
      return dot(w, error_twist(x.tip, target));
    };
    double at_a = missing(a), at_b = missing(b);
    if (!(at_a * at_b < 0)) {
      return;
    }
    for (int round = 0; round < 4 && at_a != at_b; ++round) { // the secant method
      const vector between = a.theta + at_a / (at_a - at_b) * (b.theta - a.theta);
      const auto there = tried(solver_.model.at(between), here, {});
      if (!there.is_within(solver_.tolerance)) {
        return;
      }
      a = b;
      at_a = at_b;
      b = there.state;
      at_b = missing(b);
    }
    add(tried(b, target, {}));
  }

  /// Does the way back lead to where a configuration is?
  [[nodiscard]] bool leads(const chain_state<Room>& from, double u, const chain_state<Room>& to,
                           double back) {
    const auto end = go(from, u, back, 6);
    return end.is_within(solver_.tolerance) && norm(end.state.theta - to.theta) < spacing_;
  }

  /// Whole turns of joints without limits do not count.
  [[nodiscard]] bool is_near(const vector& a, const vector& b, double square) const {
    const vector apart = a - b;
    const auto square_of = [](const vector& x) { return dot(x, x); };
    return square_of(apart) < square ||
           (is_endless_ && square_of(solver_.without_turns(apart)) < square);
  }

  [[nodiscard]] bool is_known(const vector& theta, std::size_t first) const {
    return std::any_of(found_.begin() + std::ptrdiff_t(first), found_.end(), [&](const auto& x) {
      // Two that part at a singularity are near each other at first.
      return is_near(x.state.theta, theta, (x.is_alone ? 1e-4 : .5) * spacing_ * spacing_);
    });
  }

  /// Adds the piece that found_[start] is on, unless no more than `tolerance` makes it one.
  void follow(std::size_t start, const tip_place& target) {
    extend(start, target);
    const bool is_alone =
        std::all_of(found_.begin() + std::ptrdiff_t(start), found_.end(), [&](const auto& x) {
          return norm(x.state.theta - found_[start].state.theta) < .1 * spacing_;
        });
    if (is_alone) {
      found_.erase(found_.begin() + std::ptrdiff_t(start) + 1, found_.end());
      found_[start].is_alone = true;
    }
  }

  /// Adds what is on a curve with found_[start], in both directions by turns, so that what is near
  /// comes first.
  void extend(std::size_t start, const tip_place& target) {
    const vector along = motion_in_place(found_[start].state.jacobian).any_direction();
    front ends[2] = {{start, along, spacing_}, {start, -1 * along, spacing_}};
    bool is_open[2] = {norm(along) > 0, norm(along) > 0};
    for (int count = 0; (is_open[0] || is_open[1]) && left_ > 0; ++count) {
      const int side = count % 2;
      if (is_open[side]) {
        is_open[side] = slide(ends[side], target);
        // A closed curve: the ends meet.
        if (count > 6 && is_near(found_[ends[0].at].state.theta, found_[ends[1].at].state.theta,
                                 .64 * spacing_ * spacing_)) {
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
  bool slide(front& end, const tip_place& target) {
    const chain_state<Room>& here = found_[end.at].state;
    // As far as the limits allow.
    double reach = end.step;
    for (std::ptrdiff_t i = 0; i < here.theta.size(); ++i) {
      const double d = end.direction[i];
      if (std::abs(d) > 1e-9) {
        const double bound = d > 0 ? solver_.upper[i] : solver_.lower[i];
        reach = std::min(reach, (bound - here.theta[i]) / d);
      }
    }
    for (; reach > spacing_ / 100; reach /= 2) {
      const auto next = tried(here, target, reach * end.direction);
      const vector moved = next.state.theta - here.theta;
      if (next.is_within(solver_.tolerance) && norm(moved) < 2 * reach &&
          dot(moved, end.direction) > .7 * reach) {
        const vector direction = motion_in_place(next.state.jacobian).direction(end.direction);
        const bool is_turned = orientation(next.state.jacobian, direction) *
                                   orientation(here.jacobian, end.direction) <
                               0;
        if (dot(direction, end.direction) > .7 && (!is_turned || reach < spacing_ / 50)) {
          found_.push_back({next.state, found_[end.at].u, std::ptrdiff_t(end.at)});
          end = {found_.size() - 1, direction, std::min(spacing_, 2 * reach)};
          return true;
        }
      }
    }
    return false;
  }

  const pose_solver<Room>& solver_;
  const place_function& target_;
  double spacing_, singular_;
  int left_;
  bool is_endless_ = false; ///< has any joint no limits?
  struct {
    double u = 0;
    std::size_t from = 0, now = 0;
  } farthest_; ///< how far steps have led, and from which configuration
  std::vector<reachable<Room>> found_;
};

} // namespace duet::detail
