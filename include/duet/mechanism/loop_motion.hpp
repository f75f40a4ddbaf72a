// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/mechanism/closed_loop.hpp>
#include <duet/mechanism/closed_tree.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <string>
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
/// positions along the straight line to any u is followed by tangents and Newton's method, straight
/// on where branches cross.
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
              const loop_motion_options& options = {});

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
  /// there: a dead point of the drives, or no step that leads on, as where branches touch;
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
  [[nodiscard]] loop_motion moved_to(const Eigen::VectorXd& u) const;

private:
  /// What takes residuals to the changes of dependent coordinates that make up for them.
  [[nodiscard]] Eigen::MatrixXd solver(const Eigen::VectorXd& q) const;

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
  void require_accelerations() const;
  [[nodiscard]] std::string driven() const;
  [[nodiscard]] std::string text(const Eigen::VectorXd& q) const;
  [[noreturn]] void fail(const std::string& what, const Eigen::VectorXd& q,
                         const Eigen::VectorXd& target) const;
  /// All coordinates at `target`, reached from where the motion starts.
  [[nodiscard]] Eigen::VectorXd followed(const Eigen::VectorXd& target) const;

  closed_tree mechanism_;
  std::vector<int> drives_, dependent_;
  loop_motion_options options_;
  Eigen::VectorXd start_;
  Eigen::MatrixXd solve_; ///< at the start
};

} // namespace duet

#ifndef DUET_COMPILED
#include <duet/mechanism/loops/motion_follower.hpp>
#endif
