// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/planning/branches/elimination.hpp>
#include <duet/planning/branches/joint_loop.hpp>
#include <duet/planning/branches/loop_solutions.hpp>
#include <duet/planning/branches/two_slides.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

/// \file
/// All solutions of a loop of six joints in general position.

namespace duet::detail {

/// A loop run through from one of its joints on, forwards or backwards.
struct loop_order {
  joint_loop loop;
  int first = 0;
  bool is_reversed = false;
  double quality = 0; ///< how well equations can be solved that way; 0 if not at all

  [[nodiscard]] six_coordinates in_loop(const six_coordinates& theta) const {
    six_coordinates result;
    for (int k = 0; k < 6; ++k) {
      result[(k + first) % 6] = theta[is_reversed ? 5 - k : k];
    }
    return result;
  }
};

/// Of the elimination of the first two joints: |(p₁ − p₂)·(n₁ × n₂)|, which is 0 where their axes
/// meet or are parallel; where they slide |n₁ × n₂|, less for one of them. The third and the sixth
/// joint have to turn.
[[nodiscard]] inline double quality_of(const joint_loop& loop, const elimination*) {
  const loop_joint &a = loop.joints[0], &b = loop.joints[1];
  const auto across = cross(a.axis, b.axis);
  return !loop.joints[2].turns || !loop.joints[5].turns ? 0
         : a.turns && b.turns                           ? std::abs(dot(a.point - b.point, across))
         : a.turns || b.turns                           ? length_of(across) / 4
                                                        : length_of(across);
}
/// Of three turns after that of the first joint: none of their axes is parallel to the next.
[[nodiscard]] inline double quality_of(const joint_loop& loop, const two_slides*) {
  double result = loop.joints[0].turns ? 1 : 0;
  const loop_joint* before = nullptr;
  for (std::size_t i = 1; i < 6; ++i) {
    const loop_joint& j = loop.joints[i];
    if (j.turns) {
      result = std::min(result, before == nullptr ? 1 : length_of(cross(before->axis, j.axis)));
      before = &j;
    }
  }
  return result;
}

/// The orders of a loop in which a system of equations can be solved, the best first.
template <class System>
[[nodiscard]] std::vector<loop_order> orders_of(const joint_loop& loop) {
  std::vector<loop_order> result;
  result.reserve(12);
  const auto add = [&](const joint_loop& l, int first, bool is_reversed) {
    const double quality = quality_of(l, static_cast<const System*>(nullptr));
    if (quality > 0) {
      const loop_order next{l, first, is_reversed, quality};
      const auto is_better = [](const auto& a, const auto& b) { return a.quality > b.quality; };
      result.insert(std::upper_bound(result.begin(), result.end(), next, is_better), next);
    }
  };
  joint_loop from = loop;
  for (int first = 0; first < 6; ++first) {
    add(from, first, false);
    add(from.reversed(), first, true);
    from = from.shifted();
  }
  constexpr double usable = 1e-6; // worse ones lose solutions, and serve where there is no other
  const auto is_usable = [](const loop_order& o) { return o.quality > usable; };
  const auto worse = std::find_if_not(result.begin(), result.end(), is_usable);
  if (worse != result.begin()) {
    result.erase(worse, result.end());
  }
  return result;
}

/// What one order of a loop says of the number of its solutions.
struct solution_count {
  int real = 0; ///< zeros that are real, but for rounding
  int all = 0;  ///< complex ones included
};

/// Adds the solutions that one order of a loop leads to.
template <class System>
[[nodiscard]] solution_count solve_in_order(const loop_order& order, loop_solutions& solutions) {
  solution_count result;
  const System system(order.loop);
  const auto determinants = system.determinants();
  if (determinants[0] == 0) {
    return result;
  }
  using all_roots = typename System::roots;
  const all_roots roots(all_roots::interpolated(determinants));
  constexpr double rounding = 1e-13, farthest = .05;
  std::vector<int> candidates;
  candidates.reserve(std::size_t(all_roots::count));
  const auto error_of = [&](int i) { return std::min(.03, rounding * roots.sensitivity(i)); };
  const auto from_circle = [&](int i) { return std::abs(std::log(std::abs(roots[i]))); };
  for (int i = 0; i < all_roots::count; ++i) {
    const double distance = from_circle(i);
    result.all += distance < 9; // others are at infinity
    if (distance < farthest) {
      candidates.push_back(i);
    }
  }
  std::sort(candidates.begin(), candidates.end(),
            [&](int i, int j) { return std::arg(roots[i]) < std::arg(roots[j]); });
  const auto add = [&](const six_coordinates& theta) { solutions.add(order.in_loop(theta)); };
  // Solutions with one θ₃ are a zero of higher order, which rounding takes apart.
  for (std::size_t i = 0, end = 0; i < candidates.size(); i = end) {
    std::complex<double> sum = 0;
    int real = 0;
    bool is_one = true;
    for (end = i; end < candidates.size() && is_one; end += is_one) {
      is_one = end == i || std::abs(roots[candidates[end]] - roots[candidates[end - 1]]) <
                               1e-4 + error_of(candidates[end]);
      if (is_one) {
        real = system.solutions_at(std::arg(roots[candidates[end]]), 1, add);
        sum += roots[candidates[end]];
      }
    }
    if (end > i + 1) {
      real = system.solutions_at(std::arg(sum), int(end - i), add);
    }
    if (from_circle(candidates[i]) < 1e-8 + 10 * error_of(candidates[i])) {
      result.real += real;
    }
  }
  return result;
}

/// All solutions of a loop by a system of equations. They are complete where as many are found as
/// there are real zeros, and a second order of the joints finds no others: axes that meet or are
/// parallel may hide solutions from an order, and rounding a pair in some 1e6.
template <class System>
[[nodiscard]] loop_answer solve_general_loop(const joint_loop& loop) {
  loop_solutions found(loop);
  loop_answer result;
  int expected = 0, all = 0, agreeing = 0;
  for (const loop_order& order : orders_of<System>(loop)) {
    const int before = found.count();
    const solution_count count = solve_in_order<System>(order, found);
    if (count.all == 0) {
      continue;
    }
    expected = std::max(expected, count.real);
    all = all == 0 ? count.all : std::min(all, count.all);
    agreeing = found.count() == before ? agreeing + 1 : 1;
    if (found.count() >= expected && found.count() % 2 == 0 && agreeing >= 2) {
      result.is_complete = true;
      break;
    }
  }
  result.solutions = found.all();
  result.complex_solutions = std::max(0, all - found.count());
  return result;
}

} // namespace duet::detail
