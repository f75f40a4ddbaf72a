// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/derivative.hpp>
#include <duet/derivative/manifold.hpp>
#include <duet/derivative/structure.hpp>

#include <Eigen/LU>

#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <type_traits>
#include <utility>

/// \file
/// Functions defined by equations: x(p) with F(x, p) = 0.

namespace duet {

/// When Newton's method gives up.
struct newton_options {
  int max_iterations = 50;
};

namespace detail {

/// The scalar type of a residual, and its values at the bottom of all nesting.
template <class R>
using residual_scalar = std::decay_t<decltype(std::declval<const R&>()[0])>;

/// Newton's method with AD Jacobian on the innermost real values. Returns the solution and the
/// factorised Jacobian there.
template <class F, class X, class P>
class newton {
  static constexpr int n = manifold<X>::dimension;
  using tag = derivative_tag<newton>;

public:
  using real = double;
  using vector = Eigen::Matrix<real, n, 1>;
  using matrix = Eigen::Matrix<real, n, n>;

  newton(const F& f, const X& start, const P& p, const newton_options& options) : x(start) {
    // A full step is halved while it makes the residual grow; near the solution it never does, and
    // the residual stops falling at the level of rounding, which ends the iteration.
    linearise(f, p);
    real best_step = std::numeric_limits<real>::infinity();
    for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
      const vector step = lu.solve(-residual);
      if (!lu.isInvertible() || !step.allFinite()) {
        fail("has a singular Jacobian", iteration);
      }
      const real size = step.norm();
      const X previous = x;
      const real previous_residual = residual.norm();
      x = moved(previous, step);
      linearise(f, p);
      for (real fraction = 0.5;
           !(residual.norm() <= previous_residual) && size > small() && fraction > 1e-6;
           fraction /= 2) {
        x = moved(previous, vector(fraction * step));
        linearise(f, p);
      }
      if (size <= small() && size >= 0.5 * best_step) {
        return;
      }
      if (residual.norm() == 0) {
        return;
      }
      best_step = std::min(best_step, size);
    }
    if (best_step > small()) {
      fail("did not converge", options.max_iterations);
    }
  }

  X x;
  Eigen::FullPivLU<matrix> lu;

private:
  vector residual;

  /// Steps below this are in the quadratic range: the next one ends at rounding.
  static real small() { return std::sqrt(std::numeric_limits<real>::epsilon()); }

  static X moved(const X& x, const vector& step) { return X(manifold<X>::plus(x, step)); }

  void linearise(const F& f, const P& p) {
    using D = dual<real, n, tag>;
    Eigen::Matrix<D, n, 1> delta;
    for (int i = 0; i < n; ++i) {
      delta[i] = D::variable(0, i);
    }
    const auto r = evaluated(f(manifold<X>::plus(x, delta), p));
    matrix jacobian;
    for (int i = 0; i < n; ++i) {
      residual[i] = innermost(part<tag>(r[std::size_t(i)], 0));
      for (int j = 0; j < n; ++j) {
        jacobian(i, j) = innermost(part<tag>(r[std::size_t(i)], j + 1));
      }
    }
    lu.compute(jacobian);
  }

  [[noreturn]] void fail(const char* what, int iterations) const {
    std::ostringstream message;
    message << "duet: implicit_function: Newton's method " << what << " after " << iterations
            << " iterations; residual " << residual.norm();
    throw no_convergence(message.str());
  }
};

} // namespace detail

/// The x with F(x, p) = 0 near x0, over the scalars of p and of whatever F captures.
///
/// \param f   F(x, p): an Eigen vector or array of as many residuals as x has coordinates,
/// templated
///            over the scalars of both
/// \param x0  start: a scalar, a fixed-size vector, a rotation, or a tuple of them, of doubles
/// \param p   parameters, of any scalars of duet and any shape
///
/// Newton's method with AD Jacobian runs on the real values only. The derivatives follow by the
/// implicit function theorem, order by order: with J = ∂F/∂x at the solution, each step
/// x ← x − J⁻¹F(x, p) in the algebra of the infinitesimals makes one more order exact.
///
/// \throws no_convergence where Newton's method fails or ∂F/∂x is singular.
template <class F, class X, class P>
[[nodiscard]] auto implicit_solution(const F& f, const X& x0, const P& p,
                                     const newton_options& options = {}) {
  constexpr int n = manifold<X>::dimension;
  const auto real_p = map_scalars([](const auto& s) { return innermost(s); }, p);
  const detail::newton<F, X, std::decay_t<decltype(real_p)>> solved(f, x0, real_p, options);
  using S = detail::residual_scalar<std::decay_t<decltype(detail::evaluated(f(solved.x, p)))>>;
  auto x = map_scalars([](const auto& s) { return S(s); }, solved.x);
  if constexpr (scalar_traits<S>::order > 0) {
    const Eigen::Matrix<double, n, n> inverse = solved.lu.inverse();
    for (int order = 1; order <= scalar_traits<S>::order; ++order) {
      const auto r = detail::evaluated(f(x, p));
      Eigen::Matrix<S, n, 1> step;
      for (int i = 0; i < n; ++i) {
        step[i] = S(0);
        for (int j = 0; j < n; ++j) {
          step[i] -= inverse(i, j) * r[std::size_t(j)];
        }
      }
      x = manifold<std::decay_t<decltype(x)>>::plus(x, step);
    }
  }
  return x;
}

/// x(p), x′(p), …, x^(K)(p) of the function defined by F(x, p) = 0, p a scalar. Element k has the
/// shape of x0; for a rotation it is the k-th derivative of the quaternion.
///
/// \throws no_convergence as `implicit_solution`.
template <int K, class Tag = void, class F, class X, class P>
  requires(scalar<P> || arithmetic<P>)
[[nodiscard]] auto implicit_function(const F& f, const X& x0, const P& p,
                                     const newton_options& options = {}) {
  return derivatives<K, std::conditional_t<std::is_void_v<Tag>, F, Tag>>(
      [&](const auto& parameter) { return implicit_solution(f, x0, parameter, options); }, p);
}

} // namespace duet
