// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual/taylor.hpp>
#include <duet/mechanism/closed_loop.hpp>
#include <duet/mechanism/closed_tree.hpp>
#include <duet/mechanism/loop_closing.hpp>
#include <duet/mechanism/loop_curve.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Mechanisms with loops as functions of their drives.

namespace duet {

/// How a motion is followed.
struct loop_motion_options {
  double largest_step = .2; ///< of all coordinates together: radians, or parts of `length()`
};

/// The coordinates q(u) of a mechanism with loops by some of them, its drives u.
///
/// As a function it is differentiated by all drivers, by the implicit function theorem, and a
/// coupling of a `coupled_tree`: that has poses, Jacobians and Hessians of all links by u.
/// Which of several positions is meant is said by the one at the start; from there the curve of
/// positions along the straight line to any u is followed by tangents and Newton's method.
///
/// Example: `const loop_motion by_crank(four_bar, q0, {four_bar.tree().coordinate("crank")});`
/// `const coupled_tree driven(four_bar.tree(), by_crank);`
class loop_motion {
public:
  /// \param q0      near the position to begin with; drives are taken as they are
  /// \param drives  numbers of coordinates, as many as the mechanism moves in ways
  /// \throws cannot_close where no position is near q0; invalid_input where the drives do not
  /// determine the rates of all other coordinates, as in dead points, or are not independent, and
  /// for mechanisms that have such rates and yet do not move
  loop_motion(closed_tree mechanism, const Eigen::VectorXd& q0, std::vector<int> drives,
              const loop_motion_options& options = {})
      : mechanism_(std::move(mechanism)), drives_(std::move(drives)),
        dependent_(detail::all_but(mechanism_.size(), drives_)), options_(options),
        start_(mechanism_.closed(q0, drives_)), solve_(solver(start_)) {
    const detail::ranked_matrix all = detail::linearised(mechanism_, start_);
    const Eigen::Index free = mechanism_.size() - all.rank();
    detail::require(free == Eigen::Index(drives_.size()), "duet: loop_motion: ", drives_.size(),
                    " drives, but the loops leave ", free, " independent rates");
    require_accelerations();
  }

  /// The mechanism.
  [[nodiscard]] const closed_tree& mechanism() const { return mechanism_; }
  /// The numbers of the coordinates u.
  [[nodiscard]] const std::vector<int>& drives() const { return drives_; }
  /// All coordinates where the motion starts.
  [[nodiscard]] const Eigen::VectorXd& start() const { return start_; }

  /// q(u), all coordinates of the tree, over any scalar of duet; real values are in double
  /// precision.
  /// \param u  a number for one drive, or as many as there are
  /// \throws cannot_close where the loops do not close on the straight way to u, with what happens
  /// there: a dead point of the drives, or no step that leads on, as where branches meet;
  /// invalid_input for another number of drives, and for what is not finite
  template <class U>
  [[nodiscard]] auto operator()(const U& u) const {
    if constexpr (Scalar<U> || Arithmetic<U>) {
      return (*this)(std::array{u});
    } else {
      using argument = detail::vector_argument<U>;
      using S = promote_t<double, typename argument::scalar>;
      const auto count = Eigen::Index(drives_.size());
      detail::require(argument::size(u) == count, "duet: loop_motion: ", count, " drives, but ",
                      argument::size(u), " numbers are given");
      Eigen::VectorXd target(count);
      for (Eigen::Index i = 0; i < count; ++i) {
        target[i] = double(innermost(argument::get(u, i)));
      }
      const Eigen::VectorXd real = followed(target);
      Eigen::Matrix<S, Eigen::Dynamic, 1> q = real.template cast<S>();
      for (Eigen::Index i = 0; i < count; ++i) {
        q[drives_[std::size_t(i)]] = S(argument::get(u, i));
      }
      if constexpr (scalar_traits<S>::order > 0) {
        add_infinitesimals(q, real == start_ ? solve_ : solver(real));
      }
      return q;
    }
  }

  /// This motion, started from u: other positions are found faster the nearer it starts.
  /// \throws as evaluation
  [[nodiscard]] loop_motion moved_to(const Eigen::VectorXd& u) const {
    loop_motion result = *this;
    result.start_ = (*this)(u);
    result.solve_ = solver(result.start_);
    return result;
  }

private:
  /// What takes residuals to the changes of dependent coordinates that make up for them.
  [[nodiscard]] Eigen::MatrixXd solver(const Eigen::VectorXd& q) const {
    const Eigen::MatrixXd all = mechanism_.constraint_jacobian(q) * mechanism_.units().asDiagonal();
    const Eigen::MatrixXd j = all(Eigen::indexing::all, dependent_);
    const detail::ranked_matrix svd(j);
    detail::require(svd.rank() == j.cols(), "duet: loop_motion: ", driven(),
                    " does not determine the rates of the other coordinates: a dead point");
    Eigen::MatrixXd result(j.cols(), j.rows());
    for (Eigen::Index i = 0; i < j.rows(); ++i) {
      result.col(i) = svd.solve(Eigen::VectorXd::Unit(j.rows(), i), j.cols())
                          .cwiseProduct(mechanism_.units()(dependent_));
    }
    return result;
  }

  /// Each step makes one more order exact, as in `implicit_function`. Equations that depend on
  /// others agree with them.
  template <class S>
  void add_infinitesimals(Eigen::Matrix<S, Eigen::Dynamic, 1>& q,
                          const Eigen::MatrixXd& solve) const {
    for (int order = 1; order <= scalar_traits<S>::order; ++order) {
      const auto f = mechanism_.residuals(q);
      for (std::size_t i = 0; i < dependent_.size(); ++i) {
        S& x = q[dependent_[i]];
        for (Eigen::Index k = 0; k < f.size(); ++k) {
          x -= solve(Eigen::Index(i), k) * f[k];
        }
      }
    }
  }

  /// A shaky mechanism has rates, but equations that agree with each other no further.
  void require_accelerations() const {
    using T = taylor<double, 2, derivative_tag<loop_motion>>;
    for (const int drive : drives_) {
      Eigen::Matrix<T, Eigen::Dynamic, 1> q = start_.cast<T>();
      q[drive] = T::variable(start_[drive]);
      q[drive] = start_[drive] + mechanism_.units()[drive] * (q[drive] - start_[drive]);
      add_infinitesimals(q, solve_);
      double left = 0;
      for (const T& f : mechanism_.residuals(q)) {
        left = std::max(left, std::abs(f.derivative(2)));
      }
      double largest = 1;
      for (const T& x : q) {
        largest = std::max({largest, std::abs(x.derivative(1)), std::abs(x.derivative(2))});
      }
      detail::require(left <= 1e-7 * largest * largest, "duet: loop_motion: a rate of ",
                      mechanism_.tree().coordinate_names()[std::size_t(drive)],
                      " fulfils the equations, but has no acceleration: it does not move so");
    }
  }

  [[nodiscard]] std::string driven() const {
    std::string result;
    for (const int i : drives_) {
      result += (result.empty() ? "" : ", ") + mechanism_.tree().coordinate_names()[std::size_t(i)];
    }
    return printable(result);
  }
  [[nodiscard]] std::string text(const Eigen::VectorXd& q) const {
    std::string result;
    for (const int i : drives_) {
      result += (result.empty() ? "" : ", ") + to_text(q[i]);
    }
    return drives_.size() == 1 ? result : "(" + result + ")";
  }
  [[noreturn]] void fail(const std::string& what, const Eigen::VectorXd& q,
                         const Eigen::VectorXd& target) const {
    const Eigen::VectorXd u = q(drives_);
    Eigen::VectorXd to = q;
    to(drives_) = target;
    detail::raise(cannot_close("duet: loop_motion: cannot close beyond " + driven() + " = " +
                                   text(q) + " on the way from " + text(start_) + " to " +
                                   text(to) + ": " + what,
                               {u.begin(), u.end()}));
  }

  /// All coordinates at `target`, reached from where the motion starts.
  [[nodiscard]] Eigen::VectorXd followed(const Eigen::VectorXd& target) const;

  closed_tree mechanism_;
  std::vector<int> drives_, dependent_;
  loop_motion_options options_;
  Eigen::VectorXd start_;
  Eigen::MatrixXd solve_; ///< at the start
};

namespace detail {

/// The names of the coordinates that move most, of those whose rates are not zero.
[[nodiscard]] inline std::string moving_coordinates(const closed_tree& of,
                                                    const Eigen::VectorXd& rates) {
  const Eigen::VectorXd sizes = rates.cwiseQuotient(of.units()).cwiseAbs();
  std::string result;
  for (int i = 0; i < of.size(); ++i) {
    if (sizes[i] > 1e-4 * sizes.maxCoeff()) {
      result += (result.empty() ? "" : ", ") + of.tree().coordinate_names()[std::size_t(i)];
    }
  }
  return printable(result);
}

} // namespace detail

inline Eigen::VectorXd loop_motion::followed(const Eigen::VectorXd& target) const {
  detail::require(target.allFinite(), "duet: loop_motion: drives are not finite");
  const Eigen::VectorXd units = mechanism_.units();
  const Eigen::VectorXd way = (target - start_(drives_)).cwiseQuotient(units(drives_));
  const double length = way.norm();
  if (length == 0) {
    return start_;
  }
  const detail::loop_curve curve(mechanism_, start_, drives_, way);
  constexpr double least = 1e-7; // of steps
  auto here = *curve.start(1);   // its direction is known: drives determine all rates
  for (double step = options_.largest_step;;) {
    const auto next = curve.advance(here, step);
    if (!next) {
      step /= 2;
      if (step < least) {
        fail("no step leads on, branches meet or coordinates are singular",
             curve.coordinates(here.x), target);
      }
      continue;
    }
    detail::loop_curve::stretch to{*next, step};
    if (next->s_rate() <= 0) {
      to = curve.zero(here, *next, step, [](const auto& at) { return at.s_rate(); });
    }
    if (to.end.s() >= length) { // between both points it reaches the target
      const double part = (length - here.s()) / (to.end.s() - here.s());
      const auto guess = curve.advance(here, part * to.step);
      if (const auto there = curve.at(length, guess ? *guess : to.end, step)) {
        Eigen::VectorXd q = curve.coordinates(there->x);
        q(drives_) = target;
        return q;
      }
    }
    if (next->s_rate() <= 0 && (to.end.s() < length || step < least)) {
      fail("a dead point, " + detail::moving_coordinates(mechanism_, curve.rates(to.end.tangent)) +
               " move on",
           curve.coordinates(to.end.x), target);
    }
    if (to.end.s() >= length) {
      step /= 2;
      if (step < least) {
        fail("no step leads on, branches meet or coordinates are singular",
             curve.coordinates(here.x), target);
      }
      continue;
    }
    here = to.end;
    step = std::min(options_.largest_step, 2 * step);
  }
}

} // namespace duet
