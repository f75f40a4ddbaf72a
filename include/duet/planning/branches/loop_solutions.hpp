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
  /// The number of isolated solutions, with multiplicity.
  [[nodiscard]] int count() const {
    int result = -on_curves_;
    for (const loop_solution& x : all_) {
      result += x.multiplicity;
    }
    return result;
  }

  static constexpr std::size_t nowhere = std::size_t(-1);

  /// The smallest singular value of all solutions found.
  [[nodiscard]] double smallest_singular_value() const { return least_sigma_; }
  /// The number of solutions on curves of solutions.
  [[nodiscard]] int on_curves() const { return on_curves_; }

  /// Refines θ and adds what it is near to, and the solution beside that near a singularity.
  /// \return where that stands, or `nowhere` if there is none
  std::size_t add(six_coordinates theta) {
    constexpr std::size_t most = 100; // more than are isolated
    if (all_.size() == most || !close_loop(loop_, theta)) {
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
    return look_beside(last) ? last : nowhere;
  }

private:
  static constexpr double close_together = 1e-3; // half of how far what is one may be apart

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
  /// second order: near t = −2σ/κ is another solution. Where σ is 0 it may be one of a curve.
  /// \return does it stay? Some points of curves do.
  bool look_beside(std::size_t at) {
    constexpr double close_by = .05, closer = 2e-3, singular = 1e-5, h = 1e-3,
                     nudge = 1e-9; // of pivots from zero
    constexpr int enough = 24;     // singular solutions: others are on curves
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
    least_sigma_ = std::min(least_sigma_, sigma);
    if (!(sigma < close_by)) {
      return true;
    }
    if (sigma < singular) {
      if (singular_ == enough) {
        all_.pop_back();
        return false;
      }
      ++singular_;
      if (is_on_curve(theta, v) || is_on_curve(theta, -v)) {
        ++on_curves_;
        return true;
      }
    } else if (sigma < closer) { // terms of third order may count
      for (const double t : {-.3, -.1, -.03, -.01, .01, .03, .1, .3}) {
        static_cast<void>(add(theta + t * v));
      }
    }
    const auto along = [&](double t) { return u.dot(loop_gap(loop_, theta + t * v).twist); };
    const double slope = u.dot(loop_gap(loop_, theta).jacobian * v);
    const double t = 2 * slope * h * h / (along(h) + along(-h));
    if (!(std::abs(t) < 1)) {
      return true;
    }
    // That solution may be the same one once it is refined.
    const bool is_one = is_closed(theta + t / 2 * v) ||
                        (add(theta + t * v) == at && std::abs(t) < 2 * close_together);
    if (is_one) {
      all_[at].multiplicity = 2;
    }
    return true;
  }

  /// Is another solution, or what is next to one, beside a singular one, in the direction v?
  [[nodiscard]] bool is_on_curve(const six_coordinates& theta, const six_coordinates& v) const {
    constexpr double part = 1e-2, nearly = 1e-7, rounding = 1e-12;
    const double size = loop_gap(loop_, theta).size;
    double h = HUGE_VAL;
    for (Eigen::Index i = 0; i < 6; ++i) {
      h = std::min(h, part * (loop_.joints[std::size_t(i)].turns ? 1 : size) / std::abs(v[i]));
    }
    six_coordinates other = theta + h * v;
    static_cast<void>(close_loop(loop_, other));
    const double way = (other - theta).norm();
    return loop_gap(loop_, other).twist.norm() < std::max(nearly, rounding * size) &&
           way > h / 10 && way < 10 * h;
  }

  joint_loop loop_;
  std::vector<loop_solution> all_;
  int on_curves_ = 0, singular_ = 0;
  double least_sigma_ = HUGE_VAL;
};

} // namespace duet::detail
