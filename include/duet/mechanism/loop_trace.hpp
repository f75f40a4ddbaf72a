// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/mechanism/loop_motion.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

/// \file
/// The whole motion of a mechanism with loops, through its dead points.

namespace duet {

/// A position beyond which a coordinate does not go: as a drive it is dead there.
struct dead_point {
  int coordinate = 0;          ///< its number
  Eigen::VectorXd coordinates; ///< of the tree
  Eigen::VectorXd rates;       ///< of all coordinates while that one rests
  std::string moving;          ///< the names of those that move
};

/// A position in which branches of a motion meet.
struct branch_point {
  Eigen::VectorXd coordinates; ///< of the tree
  /// Rates of all coordinates along the branches, per unit of their length: first straight on, last
  /// back to where it came from; between them those of other branches in pairs of opposites, on the
  /// first of which the first coordinate that moves increases. Two alone: no branch is met, but
  /// there are rates that do not move it.
  std::vector<Eigen::VectorXd> ways;
  std::size_t taken = 0; ///< by which of them it goes on
};

/// The whole motion of a mechanism by one drive.
struct loop_trace_result {
  std::vector<Eigen::VectorXd> positions;  ///< one after the other, from where the motion starts
  std::vector<dead_point> dead_points;     ///< of all coordinates, in the order they are met
  std::vector<branch_point> branch_points; ///< in the order they are met
  bool is_closed = false; ///< does it come back to where it starts, or turned off last?
  bool meets_branches =
      false; ///< does it end where branches touch, or where it cannot be followed?
};

/// How a motion is traced.
struct loop_trace_options {
  double largest_step = .1; ///< of all coordinates together: radians, or parts of `length()`
  double longest = 200;     ///< the whole way in these, after which to stop
  /// By which of `branch_point::ways` to go on from the first one that is met, the second …;
  /// straight on from all others.
  std::vector<std::size_t> ways = {};
};

/// The positions of a motion along one of its drives, the others held: from its start on, through
/// dead points, until it comes back; where it cannot be followed further, also the other way, that
/// first. Limits of joints are not heeded.
///
/// Dead points of a coordinate are where its rate changes its sign, found to rounding. Where
/// branches cross the trace goes straight on, or by `loop_trace_options::ways`; it ends where they
/// touch.
/// \param drive  which of the motion's drives, from 0
/// \throws invalid_input for a drive that there is none of
[[nodiscard]] DUET_COMPILED_FUNCTION loop_trace_result
trace(const loop_motion& motion, int drive = 0, const loop_trace_options& options = {});

} // namespace duet

#ifndef DUET_COMPILED
#include <duet/mechanism/loops/tracer.hpp>
#endif
