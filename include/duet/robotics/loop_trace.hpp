// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <duet/robotics/loop_motion.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

/// \file
/// The whole motion of a closed-chain mechanism, through its dead points.

namespace duet {
DUET_ABI_BEGIN

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
