// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/kinematics/chain_walk.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/serial_chain.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <string_view>

/// \file
/// Chains and trees with other limits; chains with a tool, on a base, with a locked joint.

namespace duet {

namespace detail {

/// A copy of a chain in memory, with its names if it has some; for a chain known to the compiler
/// its table.
template <HasLimits C>
[[nodiscard]] constexpr auto copy_of_chain(const C& chain) {
  if constexpr (requires { typename C::arm; }) {
    return chain.table();
  } else {
    return chain;
  }
}

/// A joint argument: the number of a joint or, if the chain has names, its name; of a tree the
/// number or the name of a coordinate.
template <class Which, class C>
concept JointOf = std::integral<Which> ||
    (std::convertible_to<const Which&, std::string_view> &&
     (!SerialChain<C> || requires(const C& chain) { chain.joint_names(); }));

/// A joint name given for a chain without names.
template <class Which, class C>
concept NameInVain = std::convertible_to<const Which&, std::string_view> && !JointOf<Which, C>;

/// The name of a joint, empty if it has none.
template <class C>
[[nodiscard]] constexpr std::string_view joint_name([[maybe_unused]] const C& chain,
                                                    [[maybe_unused]] int i) {
  if constexpr (requires { chain.joint_names(); }) {
    return chain.joint_names()[std::size_t(i)];
  } else if constexpr (!SerialChain<C>) {
    return chain.coordinate_names()[std::size_t(i)];
  } else {
    return {};
  }
}

/// The number of a joint.
///
/// \throws invalid_input for a joint that does not exist
template <class C, JointOf<C> Which>
[[nodiscard]] constexpr int joint_number(const C& chain, const Which& which, const char* function) {
  if constexpr (std::integral<Which>) {
    if (which < 0 || which >= chain.size()) {
      constexpr bool is_tree = !SerialChain<C>;
      raise(invalid_input(message("duet: ", function, is_tree ? ": coordinate " : ": joint ", which,
                                  " does not exist, the ", is_tree ? "tree has " : "chain has ",
                                  chain.size(), is_tree ? "" : " moving joints")));
    }
    return int(which);
  } else if constexpr (!SerialChain<C>) {
    return chain.coordinate(which);
  } else {
    const auto& names = chain.joint_names();
    const auto found = std::find(names.begin(), names.end(), std::string_view(which));
    if (found == names.end()) {
      unknown_name(function, "joint", which, names);
    }
    return int(found - names.begin());
  }
}

/// The chain or tree with the limits `limits_at(i)` of joint i, from `first` to `last` − 1.
///
/// \throws invalid_input for limits that allow no motion
template <HasLimits C, class LimitsAt>
[[nodiscard]] constexpr auto with_limits_at(const C& chain, int first, int last,
                                            const char* function, const LimitsAt& limits_at) {
  auto result = copy_of_chain(chain);
  for (int i = first; i < last; ++i) {
    const joint_limits<typename C::scalar_type> limits = limits_at(i);
    require_limits(limits, std::size_t(i), function, joint_name(chain, i));
    result.set_limits(i, limits);
  }
  return result;
}

} // namespace detail

/// The chain with other limits of a joint, given by its number or, if the chain is from a file, by
/// its name; or the tree with other limits of a coordinate, given by its number or name. All three
/// limits are replaced, so the velocity is not limited if `limits.velocity` is the default. A
/// `continuous` joint that gets a lower or an upper limit becomes `revolute`.
///
/// Joints of a tree that mimic the coordinate no longer narrow its limits. Chains of the tree have
/// the new limits, too.
///
/// Example: `auto limits = arm.limits(3); limits.upper = -0.5; arm = with_limits(arm, 3, limits);`
///
/// \return a chain of the same type, with the same names, for a `static_chain` a `serial_chain`; or
/// a `kinematic_tree`
/// \throws invalid_input for a joint that does not exist, and for limits that allow no motion: a
/// lower limit above the upper one, NaN, a negative velocity
template <HasLimits C, detail::JointOf<C> Which>
[[nodiscard]] constexpr auto with_limits(const C& chain, const Which& which,
                                         const joint_limits<typename C::scalar_type>& limits) {
  const int i = detail::joint_number(chain, which, "with_limits");
  return detail::with_limits_at(chain, i, i + 1, "with_limits", [&](int) { return limits; });
}

/// The chain or tree with other lower and upper limits of all moving joints or coordinates, in
/// radians or units of length; velocity limits are kept. Limits are any vectors: Eigen's,
/// `std::array`, `std::vector`.
///
/// Example: `with_limits(arm, (0.9 * lower_limits(arm)).eval(), (0.9 * upper_limits(arm)).eval())`
///
/// \return as for one joint
/// \throws invalid_input if the number of limits differs from that of joints, and as for one joint
template <HasLimits C, VectorLike Lower, VectorLike Upper>
[[nodiscard]] auto with_limits(const C& chain, const Lower& lower, const Upper& upper) {
  using T = typename C::scalar_type;
  using below = detail::vector_argument<Lower>;
  using above = detail::vector_argument<Upper>;
  detail::require(below::size(lower) == chain.size() && above::size(upper) == chain.size(),
                  "duet: with_limits: ", below::size(lower), " lower and ", above::size(upper),
                  " upper limits for ", chain.size(),
                  SerialChain<C> ? " moving joints" : " coordinates");
  return detail::with_limits_at(chain, 0, chain.size(), "with_limits", [&](int i) {
    return joint_limits<T>{T(below::get(lower, i)), T(above::get(upper, i)),
                           chain.limits(i).velocity};
  });
}

/// The chain with its limits narrowed to configurations that differ from θ by at most `max_change`,
/// one number for each joint: inverse kinematics and plans within these limits stay near θ.
///
/// Example: `inverse_kinematics(with_limits_about(arm, start, max_change), goal, start)`
///
/// \return as for one joint
/// \throws invalid_input if the number of coordinates differs from that of joints, and if no
/// coordinate within the limits is that near
template <SerialChain C, VectorLike X, VectorLike MaxChange>
[[nodiscard]] auto with_limits_about(const C& chain, const X& theta, const MaxChange& max_change) {
  using T = typename C::scalar_type;
  using about = detail::vector_argument<X>;
  using bound = detail::vector_argument<MaxChange>;
  detail::require(about::size(theta) == chain.size() && bound::size(max_change) == chain.size(),
                  "duet: with_limits_about: ", about::size(theta), " coordinates and ",
                  bound::size(max_change), " bounds for ", chain.size(), " moving joints");
  return detail::with_limits_at(chain, 0, chain.size(), "with_limits_about", [&](int i) {
    const auto& current = chain.limits(i);
    const T at(about::get(theta, i)), by(bound::get(max_change, i));
    const T lower = at - by, upper = at + by;
    detail::require(lower == lower && upper == upper, "duet: with_limits_about: joint ", i,
                    ": the interval ", at, " ± ", by, " is not a number");
    return joint_limits<T>{lower > current.lower ? lower : current.lower,
                           upper < current.upper ? upper : current.upper, current.velocity};
  });
}

template <SerialChain C, detail::NameInVain<C> Which>
DUET_REFUSED("only chains of read_urdf have names: with_limits(chain, number, limits)")
C with_limits(const C&, const Which&, const joint_limits<typename C::scalar_type>&);

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
