// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/text/file.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/mechanism/joint.hpp>
#include <duet/mechanism/tree_table.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

/// \file
/// What closes the loops of a mechanism whose cut joints leave a tree.

namespace duet {

/// What is left to the second frame of a loop, as the first one sees it.
enum class loop_kind {
  weld,        ///< nothing: both frames coincide. 6 equations
  hinge,       ///< to turn about z, as of a revolute joint. 5 equations
  slider,      ///< to slide along z, as of a prismatic joint. 5 equations
  cylindrical, ///< to turn about z and slide along it. 4 equations
  universal,   ///< its origin stays; its y stays perpendicular to the first frame's x. 4 equations
  ball,        ///< to turn about its origin. 3 equations
  planar,      ///< to slide along x and y and turn about z. 3 equations
  rod          ///< its origin keeps its distance from the first one's. 1 equation
};

/// The name of a kind of loop, as in files.
[[nodiscard]] constexpr const char* to_text(loop_kind kind) {
  constexpr std::array names{"weld",      "hinge", "slider", "cylindrical",
                             "universal", "ball",  "planar", "rod"};
  return names[std::size_t(kind)];
}

/// A frame on a link of a robot, by its name.
struct loop_frame {
  std::string link;              ///< its name
  placement<double> offset = {}; ///< in the frame of the link
};

/// Two frames on links of a tree that coincide, wholly or partly.
struct tree_loop {
  loop_kind kind = loop_kind::weld; ///< what is left to the second frame
  loop_frame first = {};            ///< the one that looks
  loop_frame second = {};           ///< the one that is looked at
  double length = 0;                ///< of a rod, in units of length
  std::size_t line = 0;             ///< of the file that it is from; 0: of none
};

/// The loops of a mechanism.
struct loop_description {
  std::vector<tree_loop> loops = {}; ///< in the order of their equations
  std::string file = {};             ///< that they are from; empty: none
};

/// The frame at a point whose z points along a direction: that of the link, turned the shortest
/// way, z = (0, 0, −1) by a half turn about x. So one says where the axis of a hinge is.
/// \throws invalid_input for a direction that is zero or not finite
[[nodiscard]] inline placement<double> along_axis(const std::array<double, 3>& point,
                                                  const std::array<double, 3>& direction) {
  const auto n = detail::components(direction);
  const double largest = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
  detail::require(largest > 0 && n.x - n.x == 0 && n.y - n.y == 0 && n.z - n.z == 0,
                  "duet: along_axis: (", n.x, ", ", n.y, ", ", n.z, ") is no direction");
  const double x = n.x / largest, y = n.y / largest, z = n.z / largest;
  const double length = std::hypot(x, y, z);
  return {detail::turn_to({x / length, y / length, z / length}), point};
}

namespace detail {

/// Says what is wrong with a loop, and where in the file it is.
[[noreturn]] inline void bad_loop(const loop_description& loops, std::size_t i,
                                  const std::string& what) {
  const tree_loop& loop = loops.loops[i];
  if (loops.file.empty()) {
    raise(invalid_input(printable("duet: closed_tree: loop " + std::to_string(i) + ", " +
                                  to_text(loop.kind) + ": " + what)));
  }
  raise(file_error(loops.file, loop.line, std::string(to_text(loop.kind)) + ": " + what));
}

} // namespace detail
} // namespace duet
