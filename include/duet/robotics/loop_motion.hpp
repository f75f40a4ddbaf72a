// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/kinematics/constrained_mechanism.hpp>
#include <duet/robotics/closed_tree.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

/// \file
/// Motion of closed-chain mechanisms as a function of their driven coordinates, and the whole
/// motion through dead points.

namespace duet {
DUET_ABI_BEGIN

/// Options of the continuation of a `driven_motion`.
struct driven_motion_options {
  double largest_step = .2; ///< maximum norm of a step: radians, or relative to `length()`
};

/// The coordinates q(u) of a closed-chain mechanism as a function of its driven (input)
/// coordinates u.
///
/// As a function it is differentiated by all drivers, by the implicit function theorem, and so are
/// compositions with it, such as the pose of a link at q(u). The configuration at the start selects
/// the assembly; from there the curve of configurations along the straight line to any u is
/// followed by predictor–corrector continuation (tangent steps and Newton's method), straight on
/// where branches cross.
///
/// Example: `const driven_motion by_crank(four_bar, q0, {four_bar.tree().coordinate("crank")});`
/// `jacobian([&](const auto& u) { return four_bar.tree().pose(by_crank(u), link); }, u, frame)`
class driven_motion {
public:
  /// \param q0      initial guess near the start configuration; driven coordinates are taken as
  ///                given
  /// \param drives  numbers of the driven coordinates, as many as the mechanism has degrees of
  ///                freedom
  /// \throws loop_closure_failure if no configuration is near q0; invalid_input if the driven
  /// coordinates do not determine the rates of all others, as at dead points, or are not
  /// independent, and for mechanisms that are only first-order flexible: they have such rates and
  /// do not move
  driven_motion(closed_chain_mechanism mechanism, const Eigen::VectorXd& q0,
                std::vector<int> drives, const driven_motion_options& options = {});

  /// The mechanism.
  [[nodiscard]] const closed_chain_mechanism& mechanism() const { return mechanism_; }
  /// The numbers of the driven coordinates u.
  [[nodiscard]] const std::vector<int>& drives() const { return drives_; }
  /// All coordinates at the start of the motion.
  [[nodiscard]] const Eigen::VectorXd& start() const { return start_; }

  /// Coordinates q(u) of the tree, over any scalar of duet; real values are in double precision.
  ///
  /// \param u  a number for one driven coordinate, or as many as there are
  /// \throws loop_closure_failure if the loops do not close on the straight line to u, with the
  /// reason: a dead point of the drives, or no step that leads on, as where branches touch;
  /// invalid_input for another number of driven coordinates, and for numbers that are not finite
  template <class U>
  [[nodiscard]] auto operator()(const U& u) const {
    if constexpr (Scalar<U> || Arithmetic<U>) {
      return (*this)(std::array{u});
    } else {
      using argument = detail::vector_argument<U>;
      using S = promote_t<double, typename argument::scalar>;
      const auto count = Eigen::Index(drives_.size());
      detail::require(argument::size(u) == count, "duet: driven_motion: ", argument::size(u),
                      " numbers (expected ", count, ")");
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

  /// This motion with its start moved to u (warm start): configurations near the start are
  /// found faster.
  ///
  /// \throws as evaluation
  [[nodiscard]] driven_motion warm_started_at(const Eigen::VectorXd& u) const;

private:
  /// The matrix that maps residuals to the changes of the dependent coordinates that
  /// compensate for them.
  [[nodiscard]] Eigen::MatrixXd solver(const Eigen::VectorXd& q) const;

  /// Each step makes one more order exact, as in `implicit_function`. Redundant equations are
  /// consistent with the others.
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

  /// Rejects a first-order flexible (shaky) mechanism: it has rates, but its equations are
  /// inconsistent at second order.
  void require_accelerations() const;
  [[nodiscard]] std::string driven() const;
  [[nodiscard]] std::string text(const Eigen::VectorXd& q) const;
  [[noreturn]] void fail(const std::string& what, const Eigen::VectorXd& q,
                         const Eigen::VectorXd& target) const;
  /// All coordinates at `target`, reached from the start of the motion.
  [[nodiscard]] Eigen::VectorXd followed(const Eigen::VectorXd& target) const;

  closed_chain_mechanism mechanism_;
  std::vector<int> drives_, dependent_;
  driven_motion_options options_;
  Eigen::VectorXd start_;
  Eigen::MatrixXd solve_; ///< `solver` at the start
};

/// A dead point: a configuration beyond which a coordinate does not go. As a drive it is
/// singular there.
struct dead_point {
  int coordinate = 0;          ///< number of the coordinate
  Eigen::VectorXd coordinates; ///< coordinates of the tree
  Eigen::VectorXd rates;       ///< rates of all coordinates while that one is at rest
  std::string moving;          ///< names of the moving coordinates
};

/// A branch point: a configuration in which branches of a motion meet.
struct branch_point {
  Eigen::VectorXd coordinates; ///< coordinates of the tree
  /// Tangents of the branches: rates of all coordinates per unit of their length. The first is
  /// straight on, the last back along the motion; between them are those of other branches in pairs
  /// of opposites, of which the first increases the first moving coordinate. If there are only two,
  /// no other branch meets the motion, but there are rates that do not move the mechanism.
  std::vector<Eigen::VectorXd> tangents;
  std::size_t chosen = 0; ///< index of the tangent along which the motion continues
};

/// The whole motion of a mechanism by one driven coordinate.
struct motion_trace {
  std::vector<Eigen::VectorXd> positions;  ///< configurations in order along the motion
  std::vector<dead_point> dead_points;     ///< dead points of all coordinates, as met
  std::vector<branch_point> branch_points; ///< branch points, in the order they are met
  bool is_closed = false; ///< true if it returns to its start, or to the branch that it changed to
  bool stopped_early =
      false; ///< true if it ends where branches touch, or where it cannot be followed
};

/// Options of `trace`.
struct trace_options {
  double largest_step = .1; ///< maximum norm of a step: radians, or relative to `length()`
  double max_length = 200;  ///< maximum length of the motion in these units, then the trace stops
  /// Indices of the tangents `branch_point::tangents` to continue along from the first branch
  /// point, the second …; straight on from all others.
  std::vector<std::size_t> branches = {};
};

/// Traces the motion along one driven coordinate, the others fixed, by predictor–corrector
/// continuation: from its start through dead points until it returns. If it cannot be followed
/// further, it is also traced from the start in the opposite direction, whose configurations come
/// first. Joint limits are ignored.
///
/// Dead points of a coordinate, where its rate changes sign, are found to round-off. At branch
/// points the trace continues straight on, or along `trace_options::branches`; it ends where
/// branches touch.
///
/// \param drive  index of the driven coordinate among those of the motion, from 0
/// \throws invalid_input for a driven coordinate that does not exist
[[nodiscard]] motion_trace trace(const driven_motion& motion, int drive = 0,
                                 const trace_options& options = {});

DUET_ABI_END
} // namespace duet
