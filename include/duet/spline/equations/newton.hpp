// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/spline/blocks.hpp>
#include <duet/spline/end_conditions.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Requirements of `interpolate` on a type of curve and its equations, for those who extend duet,
/// and Newton's method with continuation for these equations, over real numbers.

namespace duet {

/// Type of curves through rotations or poses, with its scalar, its parameter's type and its order.
template <class S>
concept CurveType = requires {
  typename S::scalar_type;
  typename S::real_type;
  S::order;
};

namespace detail {

/// Equations over T of curves of type `Spline`, found by `interpolate`; a new type of curve
/// specialises this.
template <class Spline, class T = typename Spline::scalar_type>
struct equations_of {};
template <class Spline, class T = typename Spline::scalar_type>
using equations_of_t = typename equations_of<Spline, T>::type;

/// Equations F(x) = 0 for the parameters of an interpolating curve, in blocks of N numbers.
///
/// They are constructed from parameters, samples with aligned signs and end conditions, and have
/// - `min_samples(kind)`, the minimum number of samples for these end conditions;
/// - `start()`, the initial guess, near the solution for small rotations;
/// - `residuals(x, r)`, which sets r = F(x);
/// - `scale(λ)`, which changes the equations to those of a smaller motion;
/// - `relative_step(x, step)`, the size of a step relative to the values it changes;
/// - `curve(u, q, x)`, the curve of a solution;
/// - over real numbers, `linearise(x, r, matrix)`: F and its factorised Jacobian, false if that is
///   singular.
template <class E>
concept CurveEquations = requires(E e, const E f, const typename E::unknowns x,
                                  typename E::unknowns r, typename E::real_type lambda,
                                  const typename E::matrix& jacobian) {
  { E::min_samples(end_condition_kind()) } -> std::same_as<std::size_t>;
  f.residuals(x, r);
  e.scale(lambda);
  { f.max_rotation() } -> std::same_as<std::pair<typename E::real_type, std::size_t>>;
  { f.unevenness() } -> std::convertible_to<typename E::real_type>;
  jacobian.solve(r);
};

/// Largest rotation angle, rad, and its index, of half-angle vectors between neighbouring samples.
template <class T>
[[nodiscard]] std::pair<real_type_t<T>, std::size_t>
largest_rotation(const std::vector<vector3<T>>& half_angles) {
  using R = real_type_t<T>;
  using std::sqrt;
  std::pair<R, std::size_t> result{R(0), 0};
  for (std::size_t i = 0; i < half_angles.size(); ++i) {
    const R angle =
        2 * sqrt(R(innermost(dot(components(half_angles[i]), components(half_angles[i])))));
    if (angle > result.first) {
      result = {angle, i};
    }
  }
  return result;
}

/// Newton's method on real equations, from their own initial guess. If it fails because rotations
/// are too large, predictor–corrector continuation from smaller rotations follows; among several
/// solutions it selects the one that is continuous with small rotations.
///
/// \tparam Equations  equations to be solved: `residuals`, `linearise`, and `scale` for smaller
///                    rotations
template <class Equations>
class spline_newton {
  using R = typename Equations::real_type;

public:
  using equations = Equations;
  using unknowns = typename Equations::unknowns;
  using unknown = typename unknowns::value_type;
  using matrix = typename Equations::matrix;

  explicit spline_newton(const equations& full) : full_(full), x_(full.start()) {
    if (!descend(full)) {
      continue_from_smaller_angles();
    }
  }

  [[nodiscard]] const unknowns& solution() const { return x_; }
  [[nodiscard]] int iterations() const { return iterations_; }

  /// Largest residual at the solution.
  [[nodiscard]] R residual() {
    full_.residuals(x_, residual_);
    return largest(residual_);
  }

  /// Factorised Jacobian at the solution.
  [[nodiscard]] const matrix& jacobian() {
    if (!linearise(full_)) {
      raise(no_convergence("duet: interpolate: the equations are singular at their solution"));
    }
    return matrix_;
  }

private:
  static constexpr double smallest_lambda = 1e-4;

  /// Iterates from x_ to a nearby solution. The last Jacobian is reused while steps decrease fast,
  /// and recomputed otherwise. False if a step with a new Jacobian is more than half as long as the
  /// step before.
  ///
  /// Steps are measured relative to the values they change, so that different sizes of the
  /// equations or the unknowns do not matter.
  [[nodiscard]] bool descend(const equations& f) {
    using std::sqrt;
    const R epsilon = std::numeric_limits<R>::epsilon();
    if (!linearise(f)) {
      return false;
    }
    bool is_new = true; // true if the Jacobian is new
    R moved(0);         // change of x since the last Jacobian
    R before = std::numeric_limits<R>::max();
    for (;;) {
      matrix_.solve(residual_);
      const R size = f.relative_step(x_, residual_);
      if (!is_new && !(size <= before / 32)) {
        if (!linearise(f)) {
          return false;
        }
        is_new = true;
        moved = R(0);
        continue;
      }
      if (!(size <= before / 2)) {
        return size <= sqrt(epsilon); // true if only round-off is left
      }
      moved += largest(residual_);
      for (std::size_t k = 0; k < x_.size(); ++k) {
        add_multiple(x_[k], R(-1), residual_[k]);
      }
      ++iterations_;
      // The relative error of the Jacobian is about the distance that x has moved since: the next
      // step would be below round-off.
      if (4 * moved * size <= epsilon) {
        return true;
      }
      before = size;
      is_new = false;
      f.residuals(x_, residual_);
    }
  }

  /// Continuation in λ from 0 to 1: rotations to the power λ; each solution is extrapolated to the
  /// initial guess for the next.
  DUET_COLD DUET_OUT_OF_LINE void continue_from_smaller_angles() {
    R lambda(0);
    R h(0.25);
    x_.assign(x_.size(), unknown::Zero());
    unknowns tangent = x_;
    while (lambda < 1) {
      const unknowns at = x_;
      h = std::min(h, R(1 - lambda));
      for (std::size_t k = 0; k < x_.size(); ++k) {
        add_multiple(x_[k], h, tangent[k]);
      }
      const int before = iterations_;
      equations part = full_;
      if (lambda + h < 1) {
        part.scale(lambda + h);
      }
      if (descend(part)) {
        for (std::size_t k = 0; k < x_.size(); ++k) {
          for (int j = 0; j < unknown::SizeAtCompileTime; ++j) {
            tangent[k][j] = (x_[k][j] - at[k][j]) / h;
          }
        }
        lambda += h;
        h *= iterations_ - before <= 8 ? 2 : 1;
      } else {
        x_ = at;
        h /= 2;
        if (h < smallest_lambda) {
          fail(lambda);
        }
      }
    }
  }

  [[noreturn]] DUET_COLD DUET_OUT_OF_LINE void fail(const R& lambda) const {
    const auto [angle, sample] = full_.max_rotation();
    const std::string problem =
        lambda > 0
            ? message("a curve exists for the rotations between samples scaled by ", lambda,
                      ", but continuation from it fails")
            : message("no curve was found, even with the rotations between samples scaled by ",
                      smallest_lambda);
    const R ratio = full_.unevenness();
    const std::string uneven =
        ratio >= 100 ? message("; the parameters may be too uneven for these end conditions, the "
                               "longest interval is ",
                               ratio, " times the shortest")
                     : "";
    raise(no_convergence(message("duet: interpolate: ", problem, " after ", iterations_,
                                 " iterations; the largest rotation is ", angle,
                                 " rad, from sample ", sample, " to the next", uneven)));
  }

  [[nodiscard]] bool linearise(const equations& f) { return f.linearise(x_, residual_, matrix_); }

  [[nodiscard]] static R largest(const unknowns& x) {
    using std::sqrt;
    R result(0);
    for (const unknown& v : x) {
      R square(0);
      for (int j = 0; j < unknown::SizeAtCompileTime; ++j) {
        square += v[j] * v[j];
      }
      result = larger_or_nan(result, R(sqrt(square)));
    }
    return result;
  }

  const equations& full_;
  unknowns x_, residual_;
  matrix matrix_;
  int iterations_ = 0;
};

} // namespace detail
} // namespace duet
