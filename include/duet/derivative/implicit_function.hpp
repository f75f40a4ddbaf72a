// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/structure.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/derivative.hpp>
#include <duet/derivative/manifold.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <utility>

/// \file
/// Functions defined by equations: x(p) with F(x, p) = 0.

namespace duet::detail {

/// A matrix J and its inverse, by Gauss–Jordan elimination with full pivoting of R J C, where the
/// diagonal matrices R and C bring the largest entry of every row, then of every column to 1
/// (equilibration): whether J counts as singular does not depend on units. (g++ takes 1.5 s for
/// Eigen's FullPivLU, 0.2 s for this.)
template <int N>
class equilibrated_matrix {
public:
  using vector = Eigen::Matrix<double, N, 1>;
  using matrix = Eigen::Matrix<double, N, N>;

  void compute(const matrix& entries) {
    inverse_ = entries;
    vector row_scale, column_scale;
    for (int i = 0; i < N; ++i) {
      row_scale[i] = inverse_of_size(inverse_.row(i).cwiseAbs().maxCoeff());
      inverse_.row(i) *= row_scale[i];
    }
    for (int j = 0; j < N; ++j) {
      column_scale[j] = inverse_of_size(inverse_.col(j).cwiseAbs().maxCoeff());
      inverse_.col(j) *= column_scale[j];
    }
    eliminate();
    for (int i = 0; i < N; ++i) {
      determinant_ /= row_scale[i] * column_scale[i];
      for (int j = 0; j < N; ++j) {
        inverse_(i, j) *= column_scale[i] * row_scale[j];
      }
    }
  }

  /// True if the smallest pivot exceeds the round-off of a zero.
  [[nodiscard]] bool is_invertible() const { return is_invertible_; }
  [[nodiscard]] double determinant() const { return determinant_; }
  /// J⁻¹, infinite if a pivot is zero
  [[nodiscard]] const matrix& inverse() const { return inverse_; }
  /// x with J x = right
  [[nodiscard]] vector solve(const vector& right) const { return inverse_ * right; }

private:
  /// 1/x, or 1 for what cannot be scaled: zero, infinite or not a number.
  static double inverse_of_size(double x) {
    const bool is_usable = x >= std::numeric_limits<double>::min() && x - x == 0;
    return is_usable ? 1 / x : 1.0;
  }

  /// Elimination in place: with row and column k exchanged for those of the pivot p, column k
  /// becomes that of the unit matrix, which is then the inverse's.
  void eliminate() {
    std::array<int, std::size_t(N)> rows{}, columns{};
    double largest = 0, smallest = HUGE_VAL;
    determinant_ = 1;
    for (int k = 0; k < N; ++k) {
      int row = k, column = k;
      for (int j = k; j < N; ++j) {
        for (int i = k; i < N; ++i) {
          if (std::abs(inverse_(i, j)) > std::abs(inverse_(row, column))) {
            row = i, column = j;
          }
        }
      }
      exchange(inverse_.row(k), inverse_.row(row));
      exchange(inverse_.col(k), inverse_.col(column));
      rows[std::size_t(k)] = row;
      columns[std::size_t(k)] = column;
      const double pivot = inverse_(k, k);
      if (pivot == 0) { // all remaining pivots are zero too
        determinant_ = 0;
        is_invertible_ = false;
        inverse_.setConstant(HUGE_VAL);
        return;
      }
      determinant_ *= (row != k) == (column != k) ? pivot : -pivot;
      largest = std::max(largest, std::abs(pivot));
      if (!(std::abs(pivot) >= smallest)) { // or not a number
        smallest = std::abs(pivot);
      }
      inverse_(k, k) = 1;
      inverse_.row(k) /= pivot;
      for (int i = 0; i < N; ++i) {
        if (i != k) {
          const double factor = inverse_(i, k);
          inverse_(i, k) = 0;
          inverse_.row(i) -= factor * inverse_.row(k);
        }
      }
    }
    for (int k = N - 1; k >= 0; --k) { // P J Q = L, J⁻¹ = Q L⁻¹ P
      exchange(inverse_.col(k), inverse_.col(rows[std::size_t(k)]));
      exchange(inverse_.row(k), inverse_.row(columns[std::size_t(k)]));
    }
    is_invertible_ = smallest > N * std::numeric_limits<double>::epsilon() * largest;
  }

  template <class Line>
  static void exchange(Line&& a, Line&& b) {
    for (int i = 0; i < N; ++i) {
      std::swap(a[i], b[i]);
    }
  }

  matrix inverse_;
  double determinant_ = 0;
  bool is_invertible_ = false;
};

} // namespace duet::detail

namespace duet {

/// Limits of Newton's method in `implicit_solution`.
struct newton_options {
  int max_iterations = 50; ///< maximum number of Newton steps
};

namespace detail {

/// The result of F, as an object that counts as many residuals as the unknown has coordinates.
template <int N, class R>
[[nodiscard]] auto residuals(R&& returned) {
  auto r = result_of_call(std::forward<R>(returned));
  using type = decltype(r);
  if constexpr (Scalar<type>) {
    static_assert(N == 1, "duet: implicit_function: F returns one residual, but the unknown has "
                          "several coordinates");
    return std::array<type, 1>{r};
  } else {
    static_assert(VectorLike<type>, "duet: implicit_function: F must return a scalar, an Eigen "
                                    "vector or a std::array");
    constexpr int size = vector_argument<type>::size_at_compile_time;
    static_assert(size == N || size == Eigen::Dynamic,
                  "duet: implicit_function: F must return as many residuals as the unknown has "
                  "coordinates, of which a rotation has three");
    require(vector_argument<type>::size(r) == N, "duet: implicit_function: F returned ",
            vector_argument<type>::size(r), " residuals for an unknown of ", N, " coordinates");
    return r;
  }
}

/// Damped Newton's method with AD Jacobian on the innermost real values: the solution and the
/// inverse of the Jacobian there.
///
/// Progress is measured by the step that the old Jacobian would still take, ‖J⁻¹F(x_new)‖, which
/// depends neither on the units nor on the mixture of the residuals.
template <class F, class X, class P>
class newton {
  static constexpr int n = manifold<X>::dimension;
  using tag = derivative_tag<newton>;

public:
  using vector = Eigen::Matrix<double, n, 1>;
  using matrix = Eigen::Matrix<double, n, n>;

  newton(const F& f, const X& start, const P& p, const newton_options& options) : x(start) {
    static_assert(n > 0, "duet: an unknown vector needs a size known at compile time");
    linearise(f, p);
    for (; iterations_ < options.max_iterations; ++iterations_) {
      if (advance(f, p)) {
        return;
      }
    }
    failure_ = "did not converge";
  }

  [[nodiscard]] bool has_converged() const { return failure_ == nullptr; }
  /// \throws no_convergence unless the iteration has converged
  void require_converged() const {
    if (!has_converged()) {
      raise(no_convergence(message("duet: implicit_function: Newton's method ", failure_, " after ",
                                   iterations_, " iterations; residual ", residual.norm())));
    }
  }

  X x;
  equilibrated_matrix<n> jacobian;

  /// Largest absolute value among the components of x.
  [[nodiscard]] double magnitude() const {
    double largest = 0;
    static_cast<void>(map_scalars(
        [&](double component) {
          largest = std::max(largest, std::abs(component));
          return component;
        },
        x));
    return largest;
  }

private:
  vector residual;

  double scale_ = 1; ///< size of x: at a solution 0 that of what round-off comes from
  const char* failure_ = nullptr;
  int iterations_ = 0;

  /// One step, halved until it brings x nearer to the solution. Returns true if x is as accurate as
  /// possible, and on failure.
  [[nodiscard]] bool advance(const F& f, const P& p) {
    const vector step = jacobian.solve(-residual);
    if (!jacobian.is_invertible() || !step.allFinite()) {
      failure_ = "met a singular Jacobian";
      return true;
    }
    const X previous = x;
    scale_ = std::max(scale_, magnitude());
    const equilibrated_matrix<n> previous_jacobian = jacobian;
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    for (double fraction = 1; fraction > 1e-6; fraction /= 2) {
      x = manifold<X>::plus(previous, vector(fraction * step));
      linearise(f, p);
      const vector remaining = previous_jacobian.solve(-residual);
      if (remaining.norm() <= epsilon / 4 * magnitude() && jacobian.is_invertible()) {
        return true;
      }
      // Small steps over which the Jacobian does not change bring little or no gain: the remaining
      // residual is round-off.
      const vector next = jacobian.solve(-residual);
      const auto is_small = [&](double limit, double change) {
        return fraction == 1 && step.norm() <= limit * scale_ &&
               (next - remaining).norm() <= change * next.norm() && jacobian.is_invertible();
      };
      if (remaining.norm() <= (1 - fraction / 4) * step.norm()) {
        return remaining.norm() > step.norm() / 16 && is_small(epsilon, .125);
      }
      if (is_small(std::sqrt(epsilon), .5)) {
        return true;
      }
    }
    failure_ = "cannot reduce the residual";
    return true;
  }

  void linearise(const F& f, const P& p) {
    using D = dual<double, n, tag>;
    Eigen::Matrix<D, n, 1> delta;
    for (int i = 0; i < n; ++i) {
      delta[i] = D::variable(0, i);
    }
    const auto r = residuals<n>(f(manifold<X>::plus(x, delta), p));
    matrix entries;
    for (int i = 0; i < n; ++i) {
      residual[i] = innermost(part<tag>(component(r, i), 0));
      for (int j = 0; j < n; ++j) {
        entries(i, j) = innermost(part<tag>(component(r, i), j + 1));
      }
    }
    jacobian.compute(entries);
  }
};

/// The solution over all of p's scalar, given that of the real values: with J = ∂F/∂x there, each
/// step x ← x − J⁻¹F(x, p) in the algebra of the infinitesimals makes one more order exact.
template <class F, class Newton, class P>
[[nodiscard]] auto with_infinitesimals(const F& f, const Newton& solved, const P& p) {
  using unknown = std::decay_t<decltype(solved.x)>;
  constexpr int n = manifold<unknown>::dimension;
  using S = std::decay_t<decltype(residuals<n>(f(solved.x, p))[0])>;
  auto x = map_scalars([](const auto& s) { return S(s); }, solved.x);
  if constexpr (scalar_traits<S>::order > 0) {
    const Eigen::Matrix<double, n, n>& inverse = solved.jacobian.inverse();
    for (int order = 1; order <= scalar_traits<S>::order; ++order) {
      const auto r = residuals<n>(f(x, p));
      Eigen::Matrix<S, n, 1> step;
      for (int i = 0; i < n; ++i) {
        step[i] = S(0);
        for (int j = 0; j < n; ++j) {
          step[i] -= inverse(i, j) * component(r, j);
        }
      }
      x = manifold<std::decay_t<decltype(x)>>::plus(x, step);
    }
  }
  return x;
}

} // namespace detail

/// The x with F(x, p) = 0 near the initial guess x0, over the scalars of p and of all that F
/// captures.
///
/// Newton's method with AD Jacobian runs on the real values only, in double precision, to machine
/// precision. The derivatives follow by the implicit function theorem, order by order.
///
/// \param f   F(x, p), templated over the scalars of both: an Eigen vector or array of as many
///   residuals as x has coordinates, or a scalar if that is one
/// \param x0  initial guess: a scalar, a fixed-size vector, a unit quaternion, or a tuple of them
/// \param p   parameters, of any scalars of duet and any shape
/// \return x, of the shape of x0
/// \throws no_convergence if there is no solution near x0 or ∂F/∂x is singular.
template <class F, class X, class P>
[[nodiscard]] auto implicit_solution(const F& f, const X& x0, const P& p,
                                     const newton_options& options = {}) {
  const auto start = map_scalars([](const auto& s) { return double(innermost(s)); }, x0);
  using unknown = std::remove_const_t<decltype(start)>;
  const auto real_p = map_scalars([](const auto& s) { return innermost(s); }, p);
  const detail::newton<F, unknown, std::remove_const_t<decltype(real_p)>> solved(f, start, real_p,
                                                                                 options);
  solved.require_converged();
  return detail::with_infinitesimals(f, solved, p);
}

/// x(p), x′(p), …, x^(K)(p) of the function defined by F(x, p) = 0, p a scalar. Element k has the
/// shape of x0; for a rotation it is the k-th derivative of the quaternion.
///
/// \return a `std::array` of K + 1 values, each of the shape of x0
/// \throws no_convergence as `implicit_solution`.
template <int K, class Tag = void, class F, class X, class P>
  requires(Scalar<P> || Arithmetic<P>)
[[nodiscard]] auto implicit_function(const F& f, const X& x0, const P& p,
                                     const newton_options& options = {}) {
  return derivatives<K, std::conditional_t<std::is_void_v<Tag>, F, Tag>>(
      [&](const auto& parameter) { return implicit_solution(f, x0, parameter, options); }, p);
}

} // namespace duet
