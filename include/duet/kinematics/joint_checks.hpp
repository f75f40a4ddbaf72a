// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/dual_quaternion/displacement.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/joint_step.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>

/// \file
/// Validation of the joints of a table, and their conversion to evaluation steps.

namespace duet::detail {

/// Throws the error message for joint i.
///
/// \param name  name of the joint, if it has one
/// \throws invalid_input always
[[noreturn]] inline void bad_joint(std::size_t i, const std::string& reason,
                                   const char* function = "serial_chain",
                                   std::string_view name = {}) {
  const std::string named = name.empty() ? "" : message(" \"", name, "\"");
  raise(invalid_input(message("duet: ", function, ": joint ", i, named, ": ", reason)));
}

/// Checks that a joint has a coordinate within its limits and a velocity limit of at least 0.
///
/// \throws invalid_input for a lower limit above the upper one, NaN, and infinite bounds of the
/// wrong sign
template <class T>
constexpr void require_limits(const joint_limits<T>& limits, std::size_t i,
                              const char* function = "serial_chain", std::string_view name = {}) {
  const T infinity = std::numeric_limits<T>::infinity();
  if (!(limits.lower <= limits.upper && infinity > limits.lower && limits.upper > -infinity)) {
    bad_joint(i,
              message("the limits ", limits.lower, " to ", limits.upper, " contain no coordinate"),
              function, name);
  }
  if (!(limits.velocity >= 0)) {
    bad_joint(i, message("the velocity limit is ", limits.velocity, " (expected >= 0)"), function,
              name);
  }
}

template <class T>
constexpr void require_joint(const joint<T>& joint, std::size_t i,
                             const char* function = "serial_chain", std::string_view name = {}) {
  const auto& t = joint.origin.translation;
  if (!std::all_of(t.begin(), t.end(), [](const T& x) { return x - x == 0; })) {
    bad_joint(i, "the origin is not finite", function, name);
  }
  if (!is_nearly_one(squared_norm(joint.origin.rotation))) {
    bad_joint(i,
              message("the rotation ", joint.origin.rotation,
                      " of the origin is not a unit quaternion: normalized(q)"),
              function, name);
  }
  const auto n = components(joint.axis);
  if (joint.kind != joint_kind::fixed && !is_nearly_one(dot(n, n))) {
    bad_joint(i, message("the axis (", n.x, ", ", n.y, ", ", n.z, ") is not a unit vector"),
              function, name);
  }
  if (!(joint.pitch - joint.pitch == 0)) {
    bad_joint(i, message("the pitch ", joint.pitch, " is not finite"), function, name);
  }
  require_limits(joint.limits, i, function, name);
}

/// The type of a joint with limits: a `continuous` joint that gets a bound becomes `revolute`.
template <class T>
[[nodiscard]] constexpr joint_kind kind_within(joint_kind kind, const joint_limits<T>& limits) {
  const T infinity = std::numeric_limits<T>::infinity();
  const bool is_limited = limits.lower > -infinity || infinity > limits.upper;
  return kind == joint_kind::continuous && is_limited ? joint_kind::revolute : kind;
}

/// The evaluation step of a joint whose frame is at an origin.
template <class T>
[[nodiscard]] constexpr joint_step<T> step_of(const joint<T>& joint, const placement<T>& origin) {
  const quaternion<T> a = origin.rotation * inverse_root_near_one(squared_norm(origin.rotation));
  const auto axis = components(joint.axis);
  const auto n = inverse_root_near_one(dot(axis, axis)) * axis;
  joint_step<T> result;
  result.a = a;
  result.an = a * quaternion<T>(T(0), n.x, n.y, n.z);
  result.offset = components(origin.translation);
  result.axis = cleaned_direction(rotated(a, n));
  result.is_rotational = joint.is_rotational();
  result.is_translational = joint.is_translational();
  result.pitch = joint.translation_per_unit();
  return result;
}

/// The step of a joint after the previous frame has been displaced.
template <class T>
[[nodiscard]] constexpr joint_step<T> displaced(const placement<T>& by, joint_step<T> step) {
  const displacement frame{by.rotation, components(by.translation)};
  step.a = by.rotation * step.a;
  step.an = by.rotation * step.an;
  step.offset = frame.point(step.offset);
  step.axis = cleaned_direction(rotated(by.rotation, step.axis));
  return step;
}

/// Pose of a joint's frame at the coordinate θ relative to the previous frame.
template <class T>
[[nodiscard]] constexpr placement<T> placement_at(const joint_step<T>& step, const T& theta) {
  const auto half = sine_and_cosine_of_constant(T(theta / 2));
  const quaternion<T> r = step.is_rotational ? half.cosine * step.a + half.sine * step.an : step.a;
  const T travel = step.is_translational ? T(theta * step.pitch) : T(0);
  const three_vector<T> t = step.offset + travel * step.axis;
  return {r, {t.x, t.y, t.z}};
}

} // namespace duet::detail
