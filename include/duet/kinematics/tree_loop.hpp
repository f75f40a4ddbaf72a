// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/text/file_error.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Loop-closure constraints of a closed-chain mechanism whose cut joints leave a tree, and the
/// error of closed-chain mechanisms.

namespace duet {

/// Types of loop-closure constraint, by the freedom of the second frame relative to the first.
enum class constraint_kind {
  fixed,       ///< none: both frames coincide. 6 equations
  revolute,    ///< rotation about z, as of a revolute joint. 5 equations
  prismatic,   ///< translation along z, as of a prismatic joint. 5 equations
  cylindrical, ///< rotation about z and translation along it. 4 equations
  universal,   ///< the origins coincide; its y is perpendicular to the first frame's x. 4 equations
  spherical,   ///< rotation about the origin, as of a spherical joint. 3 equations
  planar,      ///< translation along x and y, rotation about z. 3 equations
  distance     ///< constant distance between the origins. 1 equation
};

/// The name of a type of constraint, as in files.
[[nodiscard]] constexpr const char* to_text(constraint_kind kind) {
  constexpr std::array names{"fixed",     "revolute",  "prismatic", "cylindrical",
                             "universal", "spherical", "planar",    "distance"};
  return names[std::size_t(kind)];
}

/// A frame on a link of a robot, given by the name of the link.
struct constraint_frame {
  std::string link;              ///< name of the link
  placement<double> offset = {}; ///< pose of the frame in the frame of the link
};

/// A loop-closure constraint: two frames on links of a tree that coincide, wholly or partly.
struct loop_constraint {
  constraint_kind kind = constraint_kind::fixed; ///< freedom of the second frame
  constraint_frame first = {};                   ///< reference frame
  constraint_frame second = {};                  ///< constrained frame
  double length = 0;                             ///< length of a rod, in units of length
  std::size_t line = 0;                          ///< line in its file; 0: not from a file
};

/// The loop-closure constraints of a mechanism.
struct loop_constraints {
  std::vector<loop_constraint> loops = {}; ///< constraints in the order of their equations
  std::string file = {};                   ///< name of their file; empty: not from a file
};

/// A frame at a point whose z axis is along a direction: the frame of the link after the shortest
/// rotation, a half turn about x to z = (0, 0, −1). It defines, for example, the axis of a hinge.
///
/// \throws invalid_input for a direction that is zero or not finite
[[nodiscard]] inline placement<double> frame_with_z_axis(const std::array<double, 3>& point,
                                                         const std::array<double, 3>& direction) {
  const auto n = detail::components(direction);
  const double scale = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
  detail::require(scale > 0 && n.x - n.x == 0 && n.y - n.y == 0 && n.z - n.z == 0,
                  "duet: frame_with_z_axis: the direction (", n.x, ", ", n.y, ", ", n.z,
                  ") is zero or not finite");
  const double x = n.x / scale, y = n.y / scale, z = n.z / scale;
  const double length = std::hypot(x, y, z);
  return {detail::rotation_from_z({x / length, y / length, z / length}), point};
}

namespace detail {

/// Throws the error of a constraint, with its line if it is from a file.
[[noreturn]] inline void bad_loop(const loop_constraints& loops, std::size_t i,
                                  const std::string& what) {
  const loop_constraint& loop = loops.loops[i];
  if (loops.file.empty()) {
    raise(invalid_input(printable("duet: closed_chain_mechanism: loop " + std::to_string(i) + ", " +
                                  to_text(loop.kind) + ": " + what)));
  }
  raise(file_error(loops.file, loop.line, std::string(to_text(loop.kind)) + ": " + what));
}

} // namespace detail

/// Loop-closure failure: a closed chain has no configuration at the requested parameters.
class loop_closure_failure : public no_convergence {
public:
  loop_closure_failure(const std::string& message, std::vector<double> parameter)
      : no_convergence(message), parameter_(std::move(parameter)) {}

  /// The driving parameters at which the loops closed last, or were to close first.
  [[nodiscard]] const std::vector<double>& parameter() const { return parameter_; }

private:
  std::vector<double> parameter_;
};

} // namespace duet
