// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/planning/branches/joint_loop.hpp>
#include <duet/planning/branches/loop_answer.hpp>
#include <duet/planning/branches/orthonormalise.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

/// \file
/// Solutions of a loop of six joints as they are gathered: each once, with those beside it.

namespace duet::detail {

/// The solutions of a loop that were found so far.
class loop_solutions {
public:
  explicit loop_solutions(const joint_loop& loop) : loop_(loop) {}

  [[nodiscard]] const std::vector<loop_solution>& all() const { return all_; }
  /// How many there are, each as often as it counts.
  [[nodiscard]] int count() const {
    int result = 0;
    for (const loop_solution& x : all_) {
      result += x.multiplicity;
    }
    return result;
  }

  /// Refines θ and adds what it is near to, and the solution beside that near a singularity.
  void add(six_coordinates theta) { static_cast<void>(place_of_added(theta)); }

private:
  static constexpr std::size_t nowhere = std::size_t(-1);
  static constexpr double close_together = 1e-3; // half of how far what is one may be apart

  /// Where the solution that θ is near to stands, or `nowhere` if there is none.
  std::size_t place_of_added(six_coordinates theta) {
    if (!close_loop(loop_, theta)) {
      return nowhere;
    }
    for (Eigen::Index i = 0; i < 6; ++i) {
      if (loop_.joints[std::size_t(i)].turns) {
        theta[i] = turned_back(theta[i]);
      }
    }
    for (std::size_t i = 0; i < all_.size(); ++i) {
      if (is_same(all_[i].theta, theta)) {
        return i;
      }
    }
    const std::size_t last = all_.size();
    all_.push_back({theta, 1});
    look_beside(last);
    return last;
  }

  /// Are two solutions one, but for rounding? Then what is in their middle is one, too.
  [[nodiscard]] bool is_same(const six_coordinates& a, const six_coordinates& b) const {
    six_coordinates half = (b - a) / 2;
    for (Eigen::Index i = 0; i < 6; ++i) {
      if (loop_.joints[std::size_t(i)].turns) {
        half[i] = turned_back(2 * half[i]) / 2;
      }
    }
    return half.cwiseAbs().maxCoeff() < close_together && is_closed(a + half);
  }
  [[nodiscard]] bool is_closed(const six_coordinates& theta) const {
    constexpr double rounding = 3e-13;
    const loop_gap gap(loop_, theta);
    return gap.twist.norm() < rounding * gap.size;
  }

  /// Along the direction v that changes the loop least, by u σ t, it changes by u (σ t + κ t²/2) to
  /// second order: near t = −2σ/κ is another solution.
  void look_beside(std::size_t at) {
    constexpr double close_by = .05, h = 1e-3, nudge = 1e-9; // which leaves no pivot zero
    const six_coordinates theta = all_[at].theta;
    const six_coordinates nearby = theta + six_coordinates::Constant(nudge);
    six_columns rows = loop_gap(loop_, nearby).jacobian.transpose(); // J = L Q, then Qᵀ
    six_columns inverse = six_columns::Identity();                   // then L⁻ᵀ
    orthonormalise(rows, inverse);
    six_coordinates v, u;
    v << 1, .7, -.4, .9, -.6, .5;
    double sigma = 0;
    for (int k = 0; k < 3; ++k) {
      u = (inverse * (rows.transpose() * v)).normalized();
      v = rows * (inverse.transpose() * u);
      sigma = 1 / v.norm();
      v *= sigma;
    }
    if (!(sigma < close_by)) {
      return;
    }
    const auto along = [&](double t) { return u.dot(loop_gap(loop_, theta + t * v).twist); };
    const double slope = u.dot(loop_gap(loop_, theta).jacobian * v);
    const double t = 2 * slope * h * h / (along(h) + along(-h));
    if (!(std::abs(t) < 1)) {
      return;
    }
    // That solution may be the same one once it is refined.
    const bool is_one = is_closed(theta + t / 2 * v) ||
                        (place_of_added(theta + t * v) == at && std::abs(t) < 2 * close_together);
    if (is_one) {
      all_[at].multiplicity = 2;
    }
  }

  joint_loop loop_;
  std::vector<loop_solution> all_;
};

} // namespace duet::detail
