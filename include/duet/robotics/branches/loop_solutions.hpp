// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/robotics/branches/connecting_rotation.hpp>
#include <duet/robotics/branches/loop_equation.hpp>
#include <duet/robotics/branches/loop_solution_set.hpp>
#include <duet/robotics/branches/orthonormalise.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

/// \file
/// Collection of the solutions of a loop of six joints: each once, with neighbouring ones.

namespace duet::detail {

/// Squared ratio of the goal's translation to ten times the size of the loop, as by long travels of
/// prismatic joints; at least 1.
[[nodiscard]] inline double squared_travel(const loop_equation& loop) {
  const vector3d offset = .1 * loop.closing.translation;
  return std::max(1., dot(offset, offset));
}

/// Solutions of a loop found so far.
class loop_solutions {
public:
  explicit loop_solutions(const loop_equation& loop) : loop_(loop) {}

  [[nodiscard]] const std::vector<loop_solution>& all() const { return all_; }
  /// Number of isolated solutions, with multiplicity.
  [[nodiscard]] int count() const {
    int result = -on_curves_;
    for (const loop_solution& x : all_) {
      result += x.multiplicity;
    }
    return result;
  }

  static constexpr std::size_t not_found = std::size_t(-1);

  /// Smallest singular value of all solutions found.
  [[nodiscard]] double smallest_singular_value() const { return min_sigma_; }
  /// Number of solutions on curves of solutions.
  [[nodiscard]] int on_curves() const { return on_curves_; }

  /// True if a singular solution is on what would be a curve of solutions except
  /// for 1e-5 of the size.
  [[nodiscard]] bool is_near_curve() const { return is_near_curve_; }
  /// False if a singular solution may be more than double.
  [[nodiscard]] bool is_count_certain() const { return degenerate_ == 0; }
  [[nodiscard]] bool is_singular(std::size_t i) const { return all_[i].sigma < nearly_singular; }

  /// Refines θ and adds the solution it leads to, and its neighbour near a singularity.
  ///
  /// \return the index of the solution, or `not_found` if it leads to no solution
  std::size_t add(six_coordinates theta) {
    constexpr std::size_t max_count = 100; // more than there are isolated ones
    if (all_.size() == max_count || !close_loop(loop_, theta)) {
      return not_found;
    }
    for (Eigen::Index i = 0; i < 6; ++i) {
      if (loop_.joints[std::size_t(i)].is_revolute) {
        theta[i] = wrap_angle(theta[i]);
      }
    }
    for (std::size_t i = 0; i < all_.size(); ++i) {
      if (is_same(all_[i].theta, theta)) {
        return i;
      }
    }
    const std::size_t last = all_.size();
    all_.push_back({theta, 1});
    return find_neighbour(last);
  }

private:
  static constexpr double close_together = 1e-3; // half the distance of coinciding solutions
  static constexpr double nearly_singular = 1e-5;

  /// b − a, revolute joints by the shorter arc.
  [[nodiscard]] six_coordinates difference(const six_coordinates& a,
                                           const six_coordinates& b) const {
    six_coordinates result = b - a;
    for (Eigen::Index i = 0; i < 6; ++i) {
      if (loop_.joints[std::size_t(i)].is_revolute) {
        result[i] = wrap_angle(result[i]);
      }
    }
    return result;
  }
  /// True if two solutions coincide to round-off: then the configuration halfway is one, too.
  [[nodiscard]] bool is_same(const six_coordinates& a, const six_coordinates& b) const {
    const six_coordinates half = difference(a, b) / 2;
    return half.cwiseAbs().maxCoeff() < close_together && is_closed(a + half);
  }
  /// True if two singular solutions coincide to round-off. If more than two coincide, the
  /// closure error vanishes to round-off on a curve; for two separate ones σ would be as
  /// large as their distance.
  [[nodiscard]] bool is_same_singularity(std::size_t a, std::size_t b) const {
    constexpr double singular = 1e-8, fraction = 1e-3;
    const double sigma = std::max(all_[a].sigma, all_[b].sigma),
                 distance = difference(all_[a].theta, all_[b].theta).cwiseAbs().maxCoeff();
    return sigma < singular && distance < 2 * close_together && sigma < fraction * distance;
  }
  [[nodiscard]] bool is_closed(const six_coordinates& theta) const {
    constexpr double rounding = 3e-13;
    const closure_error closure(loop_, theta);
    return closure.twist.norm() < rounding * closure.size;
  }

  /// Finds the neighbour of a solution near a singularity. Along the direction v that changes the
  /// loop least, by u σ t, the change is u (σ t + κ t²/2) to second order: near t = −2σ/κ is
  /// another solution. If σ is 0 the solution may be on a curve.
  ///
  /// \return the index of the solution; `not_found` for most points of curves
  std::size_t find_neighbour(std::size_t at) {
    constexpr double close_by = .05, closer = 1e-2, h = 1e-3, fold = 1e-4,
                     nudge = 1e-9;     // displacement of pivots from zero
    constexpr std::size_t enough = 24; // number of singular solutions: others are on curves
    const six_coordinates theta = all_[at].theta;
    const six_coordinates nearby = theta + six_coordinates::Constant(nudge);
    six_columns rows = closure_error(loop_, nearby).jacobian.transpose(); // J = L Q, then Qᵀ
    six_columns inverse = six_columns::Identity();                        // then L⁻ᵀ
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
    all_[at].sigma = sigma;
    min_sigma_ = std::min(min_sigma_, sigma);
    if (!(sigma < close_by)) {
      return at;
    }
    if (sigma < nearly_singular) {
      for (std::size_t i = 0; i < at; ++i) {
        if (is_same_singularity(i, at)) {
          all_.pop_back();
          return i;
        }
      }
      if (singular_ == enough) {
        all_.pop_back();
        return not_found;
      }
      ++singular_;
      if (is_on_curve(theta, v) || is_on_curve(theta, -v)) {
        ++on_curves_;
        return at;
      }
    }
    if (sigma < closer) { // terms of third order may count
      const double almost_none = 1e-5 / squared_travel(loop_);
      const double forwards = search_along(theta, u, v), backwards = search_along(theta, -u, -v);
      is_near_curve_ = is_near_curve_ ||
                       (sigma < nearly_singular && std::max(forwards, backwards) < almost_none);
    }
    const auto along = [&](double t) { return u.dot(closure_error(loop_, theta + t * v).twist); };
    const double derivative = u.dot(closure_error(loop_, theta).jacobian * v);
    const double curvature = (along(h) + along(-h)) / (h * h), t = 2 * derivative / curvature;
    degenerate_ += sigma < nearly_singular && !(std::abs(curvature) > fold);
    if (!(std::abs(t) < 1)) {
      return at;
    }
    // The neighbour may coincide with this solution once it is refined.
    const bool is_one = is_closed(theta + t / 2 * v) ||
                        (add(theta + t * v) == at && std::abs(t) < 2 * close_together);
    if (is_one) {
      all_[at].multiplicity = 2;
    }
    return at;
  }

  /// Adds the solutions near a nearly singular one by a Lyapunov–Schmidt reduction: with v·(x − θ)
  /// fixed at t, the closure error is made 0 except for μ(t) u; solutions are zeros of μ.
  ///
  /// \return the largest |μ| in the range of the search
  double search_along(const six_coordinates& theta, const six_coordinates& u,
                      const six_coordinates& v) {
    six_coordinates x = theta, x_before = theta;
    double largest = 0, ratio_before = 0; // ratio of μ to t, without the zero at t = 0
    for (const double t : {.004, .01, .02, .04, .07, .1, .15, .22, .33, .5}) {
      double mu = 0;
      for (int k = 0; k < 2; ++k) {
        const closure_error closure(loop_, x);
        Eigen::Matrix<double, 7, 7> bordered;
        bordered << closure.jacobian, u, v.transpose(), 0;
        Eigen::Matrix<double, 7, 1> right_side;
        right_side << closure.twist, t - v.dot(x - theta);
        const Eigen::Matrix<double, 7, 1> step =
            Eigen::PartialPivLU<Eigen::Matrix<double, 7, 7>>(bordered).solve(right_side);
        x += step.head<6>();
        mu = step[6];
      }
      if (!((x - theta).norm() < 3 * t)) {
        return largest;
      }
      largest = std::max(largest, std::abs(mu));
      const double ratio = mu / t;
      if (ratio * ratio_before < 0) {
        const double fraction = ratio / (ratio - ratio_before);
        static_cast<void>(add(x + fraction * (x_before - x)));
      }
      x_before = x;
      ratio_before = ratio;
    }
    return largest;
  }

  /// True if there is another solution, or nearly one, in the direction v from a singular one.
  [[nodiscard]] bool is_on_curve(const six_coordinates& theta, const six_coordinates& v) const {
    constexpr double fraction = 1e-2, nearly = 1e-7, rounding = 1e-12;
    const double size = closure_error(loop_, theta).size;
    double h = HUGE_VAL;
    for (Eigen::Index i = 0; i < 6; ++i) {
      h = std::min(h, fraction * (loop_.joints[std::size_t(i)].is_revolute ? 1 : size) /
                          std::abs(v[i]));
    }
    six_coordinates other = theta + h * v;
    static_cast<void>(close_loop(loop_, other));
    const double distance = (other - theta).norm();
    return closure_error(loop_, other).twist.norm() < std::max(nearly, rounding * size) &&
           distance > h / 10 && distance < 10 * h;
  }

  loop_equation loop_;
  std::vector<loop_solution> all_;
  int on_curves_ = 0, degenerate_ = 0;
  std::size_t singular_ = 0;
  bool is_near_curve_ = false;
  double min_sigma_ = HUGE_VAL;
};

} // namespace duet::detail
