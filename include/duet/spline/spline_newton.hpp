// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/structure.hpp>
#include <duet/dual/dual.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/block_tridiagonal.hpp>
#include <duet/spline/interpolation_equations.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>
#include <utility>
#include <vector>

/// \file
/// The real increments of an interpolating cubic.

namespace duet::detail {

/// Newton's method with AD Jacobian on the equations of real increments, from none at all. Where
/// the turns are too large for that, by continuation from smaller ones: that also finds the curve
/// that belongs to them, where several fulfil the equations.
template <Real R, class Ends>
class spline_newton {
  using tag = derivative_tag<spline_newton>;
  using D = dual<R, 9, tag>;

public:
  using equations = cubic_equations<R, Ends>;
  using unknowns = std::vector<vector3<R>>;

  explicit spline_newton(const equations& full) : full_(full), x_(full.size(), vector3<R>::Zero()) {
    if (std::getenv("CONT") || !descend(full)) {
      continue_from_smaller_turns();
    }
  }

  [[nodiscard]] const unknowns& solution() const { return x_; }
  [[nodiscard]] int iterations() const { return iterations_; }

  /// The largest residual at the solution.
  [[nodiscard]] R residual() {
    full_.residuals(x_, residual_);
    return largest(residual_);
  }

  /// The Jacobian at the solution.
  [[nodiscard]] const block_tridiagonal<R, 3>& jacobian() {
    if (!linearise(full_)) {
      throw no_convergence("duet: interpolate: the equations are singular at their solution");
    }
    return matrix_;
  }

private:
  /// From x_ to the solution near it: steps with the last Jacobian while they gain much, with a new
  /// one otherwise. False where a step does not halve the residual.
  [[nodiscard]] bool descend(const equations& f) {
    using std::sqrt;
    const R epsilon = std::numeric_limits<R>::epsilon();
    R before = std::numeric_limits<R>::infinity();
    R step = before;
    R moved(0); // since the Jacobian was new
    for (bool is_first = true;; is_first = false) {
      f.residuals(x_, residual_);
      const R left = largest(residual_);
      if (!(left <= before / 2)) {
        return step <= sqrt(epsilon); // nothing but rounding is left
      }
      if (is_first || left > before / 32) {
        if (!linearise(f)) {
          return false;
        }
        moved = R(0);
      }
      matrix_.solve(residual_);
      for (std::size_t k = 0; k < x_.size(); ++k) {
        x_[k] -= residual_[k];
      }
      ++iterations_;
      step = largest(residual_);
      moved += step;
      // The Jacobian is about as far off as x has moved: the next step would be less than rounding.
      if (4 * moved * step <= epsilon) {
        return true;
      }
      before = left;
    }
  }

  /// λ from 0 to 1: turns to the power λ, where each solution is the start for the next.
  void continue_from_smaller_turns() {
    R lambda(0);
    R h(0.25);
    x_.assign(x_.size(), vector3<R>::Zero());
    unknowns slope = x_;
    while (lambda < 1) {
      const unknowns at = x_;
      h = std::min(h, R(1 - lambda));
      for (std::size_t k = 0; k < x_.size(); ++k) {
        x_[k] += h * slope[k];
      }
      const int before = iterations_;
      if (lambda + h < 1 ? descend(full_.scaled(lambda + h)) : descend(full_)) {
        for (std::size_t k = 0; k < x_.size(); ++k) {
          slope[k] = (x_[k] - at[k]) / h;
        }
        lambda += h;
        h *= iterations_ - before <= 8 ? 2 : 1;
      } else {
        x_ = at;
        h /= 2;
        if (h < R(1e-4)) {
          fail(lambda);
        }
      }
    }
  }

  [[noreturn]] void fail(const R& lambda) const {
    const auto [angle, row] = full_.largest_turn();
    std::ostringstream message;
    message << "duet: interpolate: with all steps between rows turning by no more than " << lambda
            << " of their angles there is a curve, but it ends there; after " << iterations_
            << " iterations. The largest step is " << angle << " rad, from row " << row
            << " to the next";
    throw no_convergence(message.str());
  }

  [[nodiscard]] bool linearise(const equations& f) {
    residual_.resize(x_.size());
    std::vector<block_row<R, 3>> rows(x_.size());
    for (std::size_t row = 0; row < x_.size(); ++row) {
      std::array<vector3<D>, 3> omega;
      for (std::size_t j = 0; j < 3; ++j) {
        const vector3<R>& value = x_[f.unknown(row, j)];
        for (int b = 0; b < 3; ++b) {
          omega[j][b] = D::variable(value[b], int(3 * j) + b);
        }
      }
      const vector3<D> r = f.residual(row, omega);
      for (std::size_t j = 0; j < 3; ++j) {
        const int place = f.place(row, j);
        auto& block = place == 0   ? rows[row].lower
                      : place == 1 ? rows[row].diagonal
                                   : rows[row].upper;
        for (int a = 0; a < 3; ++a) {
          residual_[row][a] = r[a].value();
          for (int b = 0; b < 3; ++b) {
            block(a, b) = r[a].partial(int(3 * j) + b);
          }
        }
      }
    }
    return matrix_.factorise(std::move(rows), f.corner_columns());
  }

  [[nodiscard]] static R largest(const unknowns& x) {
    R result(0);
    for (const vector3<R>& v : x) {
      const R size = v.norm();
      result = size <= result ? result : size; // NaN comes through
    }
    return result;
  }
  const equations& full_;
  unknowns x_, residual_;
  block_tridiagonal<R, 3> matrix_;
  int iterations_ = 0;
};

} // namespace duet::detail
