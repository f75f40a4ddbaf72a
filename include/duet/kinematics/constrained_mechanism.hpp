// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/structure.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/implicit_function.hpp>
#include <duet/derivative/manifold.hpp>
#include <duet/dual/dual.hpp>
#include <duet/kinematics/tree_loop.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

/// \file
/// Mechanisms given by constraint equations: positions x(u) with the loop-closure constraints F(x,
/// u) = 0.

namespace duet {

/// Options of the continuation of a `constrained_mechanism`.
struct constrained_mechanism_options {
  double largest_step = .5; ///< maximum step of u; large steps miss full turns of driving angles
};

/// The positions x(u) of a mechanism given by its constraints F(x, u) = 0, followed by
/// predictor–corrector continuation.
///
/// Loops usually close in several assembly configurations. The position at one u selects the
/// assembly; from there x is followed along the straight line to any other u, by a tangent step and
/// Newton's method. Steps are small enough for the rates at both ends to agree with the
/// displacement, and for det ∂F/∂x, whose sign differs on the two branches that meet at a dead
/// point, to change little. As a function of u it is differentiated by all drivers, by the implicit
/// function theorem: `derivatives<2>(loop, u)` are position, velocity and acceleration per unit of
/// u. Evaluation is `const` and uses no heap memory.
///
/// Source: P. Deuflhard, Newton Methods for Nonlinear Problems, chapter 5.
///
/// \tparam F  callable, templated over the scalars of both arguments: returns as many residuals as
///            x has coordinates, of which a rotation has three; see `implicit_function`
/// \tparam X  positions, in double: a scalar, a fixed-size vector, a unit quaternion, or a tuple
/// \tparam P  the driving parameter u, double, or a fixed-size vector of them
template <class F, class X, class P = double>
class constrained_mechanism {
  static constexpr int size = manifold<P>::dimension;
  using coordinates = Eigen::Matrix<double, size, 1>;
  using solution = detail::newton<F, X, P>;
  using tangent = typename solution::vector;
  using tag = derivative_tag<constrained_mechanism>;

public:
  /// \param constraints  F
  /// \param position     initial guess near the position at u0
  /// \param u0           parameter at which the motion starts
  /// \throws loop_closure_failure if no position is near the given one, or ∂F/∂x is singular
  constrained_mechanism(F constraints, const X& position, const P& u0,
                        const constrained_mechanism_options& options =
                            {}) requires(manifold<X>::dimension != Eigen::Dynamic &&
                                         manifold<P>::dimension != Eigen::Dynamic)
      : constraints_(std::move(constraints)), u_(u0), options_(options),
        start_(assembled(position)) {}

  DUET_REFUSED(
      "constrained_mechanism: positions and parameters need a size known at compile time, as "
      "Eigen::Vector2d has")
  constrained_mechanism(F, const X&, const P&, const constrained_mechanism_options& = {}) requires(
      manifold<X>::dimension == Eigen::Dynamic || manifold<P>::dimension == Eigen::Dynamic);

  /// The parameter u at which all evaluations start.
  [[nodiscard]] const P& parameter() const { return u_; }
  /// The position at `parameter()`.
  [[nodiscard]] const X& position() const { return start_.x; }

  /// The position x(u), over any scalar of duet; real values are in double precision.
  ///
  /// \throws loop_closure_failure if the loops do not close on the straight line to u, because of a
  /// dead point; invalid_input for a u that is not finite
  template <class U>
  [[nodiscard]] auto operator()(const U& u) const {
    const P target = map_scalars([](const auto& s) { return double(innermost(s)); }, u);
    return detail::with_infinitesimals(constraints_, followed(target), u);
  }

  /// This mechanism with its start moved to u (warm start): positions near the start are
  /// found faster.
  ///
  /// \throws as evaluation
  [[nodiscard]] constrained_mechanism warm_started_at(const P& u) const {
    constrained_mechanism result = *this;
    result.start_ = followed(u);
    result.u_ = u;
    return result;
  }

private:
  [[nodiscard]] static coordinates numbers(const P& u) {
    coordinates result;
    Eigen::Index i = 0;
    static_cast<void>(map_scalars([&](double x) { return result[i++] = x; }, u));
    return result;
  }

  [[nodiscard]] static std::string text(const P& u) {
    std::string result;
    for (const double x : numbers(u)) {
      result += (result.empty() ? "" : ", ") + to_text(x);
    }
    return size == 1 ? result : "(" + result + ")";
  }

  [[noreturn]] static void fail(const std::string& what, const P& u) {
    const coordinates x = numbers(u);
    detail::raise(
        loop_closure_failure("duet: constrained_mechanism: " + what, {x.begin(), x.end()}));
  }

  [[nodiscard]] solution assembled(const X& position) const {
    const solution result(constraints_, position, u_, {});
    if (!result.has_converged()) {
      fail("no position near the initial guess at u = " + text(u_), u_);
    }
    return result;
  }

  /// Rate dx for a change du, by the implicit function theorem.
  [[nodiscard]] tangent rate(const solution& at, const P& u, const coordinates& du) const {
    using D = dual<double, 1, tag>;
    Eigen::Matrix<D, size, 1> delta;
    for (int i = 0; i < size; ++i) {
      delta[i] = D(0, du[i]);
    }
    return at.jacobian.solve(-residual(at.x, manifold<P>::plus(u, delta), 1));
  }

  template <class U>
  [[nodiscard]] tangent residual(const X& x, const U& u, int part) const {
    const auto r = detail::residuals<tangent::SizeAtCompileTime>(constraints_(x, u));
    tangent result;
    for (Eigen::Index i = 0; i < result.size(); ++i) {
      result[i] = innermost(detail::part<tag>(detail::component(r, i), part));
    }
    return result;
  }

  /// The position at `next` after one step from `u`; empty if the step may have left the branch.
  [[nodiscard]] std::optional<solution> step(const solution& from, const P& u,
                                             const P& next) const {
    const coordinates du = numbers(next) - numbers(u);
    const tangent before = rate(from, u, du);
    const solution to(constraints_, manifold<X>::plus(from.x, before), next, {10});
    const double change = to.jacobian.determinant() / from.jacobian.determinant();
    if (!to.has_converged() || !(change > .25 && change < 4)) {
      return std::nullopt;
    }
    // The rates at both ends must explain the displacement, and x must not reverse, as it would
    // beyond a gap.
    const tangent after = rate(to, next, du);
    const double fastest = std::max(before.norm(), after.norm());
    const X explained = manifold<X>::plus(from.x, tangent((before + after) / 2));
    const double missing = to.jacobian.solve(residual(explained, next, 0)).norm();
    const double rounding = 1e-12 * std::max(1.0, to.magnitude());
    if (missing <= fastest / 16 + rounding &&
        (after - before).norm() <= 1.25 * fastest + rounding) {
      return to;
    }
    return std::nullopt;
  }

  /// The position at `target`, reached from the start of the motion.
  [[nodiscard]] solution followed(const P& target) const {
    const coordinates displacement = numbers(target) - numbers(u_);
    if (!displacement.allFinite()) {
      detail::raise(
          invalid_input("duet: constrained_mechanism: u = " + text(target) + " is not finite"));
    }
    solution current = start_;
    P u = u_;
    const double limit = options_.largest_step / displacement.norm();
    double done = displacement.isZero(0) ? 1 : 0;
    for (double max_step = limit; done < 1;) {
      const bool is_last = 1 - done <= max_step;
      const double to = is_last ? 1 : done + max_step;
      const P next = is_last ? target : P(manifold<P>::plus(u_, coordinates(to * displacement)));
      const double length = to - done;
      if (const auto reached = step(current, u, next)) {
        current = *reached;
        u = next;
        done = to;
        max_step = std::min(limit, 2 * length);
      } else if (length <= 1e-6 * (1 - done)) {
        fail("the loops do not close beyond u = " + text(u) + " on the line from " + text(u_) +
                 " to " + text(target),
             u);
      } else {
        max_step = length / 2;
      }
    }
    return current;
  }

  F constraints_;
  P u_;
  constrained_mechanism_options options_;
  solution start_;
};

template <class F, class X, class P>
constrained_mechanism(F, X, P, constrained_mechanism_options = {})
    -> constrained_mechanism<F, detail::own_t<X>, detail::differentiable_t<detail::own_t<P>>>;

} // namespace duet
