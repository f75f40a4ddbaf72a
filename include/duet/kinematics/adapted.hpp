// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/kinematics/chain_walk.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/joint_checks.hpp>
#include <duet/kinematics/limits.hpp>
#include <duet/kinematics/serial_chain.hpp>

#include <algorithm>
#include <cstddef>

/// \file
/// Modified serial chains: with a tool, on a base, with a locked joint.

namespace duet {

namespace detail {

/// Checks the translation of a placement.
///
/// \throws invalid_input if the translation is not finite
template <class T>
constexpr void require_finite(const placement<T>& offset, const char* function) {
  const auto& t = offset.translation;
  if (!std::all_of(t.begin(), t.end(), [](const T& x) { return x - x == 0; })) {
    raise(invalid_input(message("duet: ", function, ": the translation (", t[0], ", ", t[1], ", ",
                                t[2], ") is not finite")));
  }
}

} // namespace detail

/// The chain with a tool at its tip: the new tip (end-effector) frame has the pose `tool` relative
/// to the previous one, A(θ) T.
///
/// Example: `const auto arm = with_tool(robots::panda(), {quaternion<double>(1), {0, 0, .1}});`
///
/// \return a chain of the same type, with the same names; for a `static_chain` a `serial_chain`
/// \throws invalid_input for a translation that is not finite
template <SerialChain C>
[[nodiscard]] constexpr auto with_tool(const C& chain,
                                       const placement<typename C::scalar_type>& tool) {
  detail::require_finite(tool, "with_tool");
  auto result = detail::copy_of_chain(chain);
  result.set_tip_offset(chain.tip().offset * tool);
  return result;
}

/// The chain on a base: the previous base has the pose `base` in the new reference frame, which is
/// link 0; the pose of the tip is B A(θ).
///
/// \return as `with_tool`
/// \throws invalid_input for a translation that is not finite
template <SerialChain C>
[[nodiscard]] constexpr auto with_base(const C& chain,
                                       const placement<typename C::scalar_type>& base) {
  detail::require_finite(base, "with_base");
  auto result = detail::copy_of_chain(chain);
  result.displace(0, base);
  return result;
}

/// The chain with one joint, given by its number or its name, locked at a coordinate in radians or
/// units of length. The chain has one joint less, and the numbers of the joints behind it decrease
/// by one; to lock several, begin with the last.
///
/// Example: `const serial_chain<6> arm = with_locked_joint(robots::panda(), 2, 0);`
///
/// \return a chain with one joint less if the number of joints is in the type, otherwise a chain of
/// the same type, with the remaining names
/// \throws invalid_input for a joint that does not exist, and for a coordinate outside its limits
template <SerialChain C, detail::JointOf<C> Which>
[[nodiscard]] constexpr auto with_locked_joint(const C& chain, const Which& which,
                                               const typename C::scalar_type& theta) {
  static_assert(C::joints != 1, "duet: with_locked_joint: the only moving joint cannot be locked");
  using T = typename C::scalar_type;
  const int i = detail::joint_number(chain, which, "with_locked_joint");
  const auto& limits = chain.limits(i);
  if (!(limits.lower <= theta && theta <= limits.upper && theta - theta == 0)) {
    detail::bad_joint(std::size_t(i),
                      detail::message("the coordinate ", theta, " is outside the limits ",
                                      limits.lower, " to ", limits.upper),
                      "with_locked_joint", detail::joint_name(chain, i));
  }
  const auto locked = detail::placement_at(chain.steps()[std::size_t(i)], theta);
  if constexpr (C::joints > 1) {
    return serial_chain<C::joints - 1, T>(detail::copy_of_chain(chain), i, locked);
  } else {
    return C(chain, i, locked);
  }
}

template <SerialChain C, detail::NameInVain<C> Which>
DUET_REFUSED("only chains of read_urdf have names: with_locked_joint(chain, number, coordinate)")
C with_locked_joint(const C&, const Which&, const typename C::scalar_type&);

} // namespace duet
