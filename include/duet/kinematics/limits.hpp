// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/kinematics/chain_walk.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/joint_checks.hpp>
#include <duet/kinematics/serial_chain.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <string_view>

/// \file
/// Serial chains with changed joint limits.

namespace duet {
namespace detail {

/// A copy of a chain in memory, with its names if it has some; for a chain known to the compiler
/// its table.
template <SerialChain C>
[[nodiscard]] constexpr auto copy_of_chain(const C& chain) {
  if constexpr (requires { chain.table(); }) {
    return chain.table();
  } else {
    return chain;
  }
}

/// A joint argument: the number of a joint or, if the chain has names, its name.
template <class Which, class C>
concept JointOf = std::integral<Which> ||
    (std::convertible_to<const Which&, std::string_view>&& requires(const C& chain) {
      chain.joint_names();
    });

/// A joint name given for a chain without names.
template <class Which, class C>
concept NameInVain = std::convertible_to<const Which&, std::string_view> && !JointOf<Which, C>;

/// The name of a joint, empty if it has none.
template <class C>
[[nodiscard]] constexpr std::string_view joint_name([[maybe_unused]] const C& chain,
                                                    [[maybe_unused]] int i) {
  if constexpr (requires { chain.joint_names(); }) {
    return chain.joint_names()[std::size_t(i)];
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
      raise(invalid_input(message("duet: ", function, ": joint ", which,
                                  " does not exist, the chain has ", chain.size(),
                                  " moving joints")));
    }
    return int(which);
  } else {
    const auto& names = chain.joint_names();
    const auto found = std::find(names.begin(), names.end(), std::string_view(which));
    if (found == names.end()) {
      raise(invalid_input(
          printable(message("duet: ", function, ": no joint \"", std::string_view(which),
                            "\": ", closest_names(which, names)))));
    }
    return int(found - names.begin());
  }
}

} // namespace detail

/// The chain with other limits of a joint, given by its number or, if the chain is from a file, by
/// its name. All three limits are replaced, so the velocity is not limited if `limits.velocity` is
/// the default. A `continuous` joint that gets a lower or an upper limit becomes `revolute`.
///
/// Example: `auto limits = arm.limits(3); limits.upper = -0.5; arm = with_limits(arm, 3, limits);`
///
/// \return a chain of the same type, with the same names; for a `static_chain` a `serial_chain`
/// \throws invalid_input for a joint that does not exist, and for limits that allow no motion: a
/// lower limit above the upper one, NaN, a negative velocity
template <SerialChain C, detail::JointOf<C> Which>
[[nodiscard]] constexpr auto with_limits(const C& chain, const Which& which,
                                         const joint_limits<typename C::scalar_type>& limits) {
  auto result = detail::copy_of_chain(chain);
  const int i = detail::joint_number(chain, which, "with_limits");
  detail::require_limits(limits, std::size_t(i), "with_limits", detail::joint_name(chain, i));
  result.set_limits(i, limits);
  return result;
}

/// The chain with other lower and upper limits of all moving joints, in radians or units of length;
/// velocity limits are kept. Limits are any vectors: Eigen's, `std::array`, `std::vector`.
///
/// Example: `with_limits(arm, (0.9 * lower_limits(arm)).eval(), (0.9 * upper_limits(arm)).eval())`
///
/// \return as for one joint
/// \throws invalid_input if the number of limits differs from that of joints, and as for one joint
template <SerialChain C, VectorLike Lower, VectorLike Upper>
[[nodiscard]] auto with_limits(const C& chain, const Lower& lower, const Upper& upper) {
  using T = typename C::scalar_type;
  using below = detail::vector_argument<Lower>;
  using above = detail::vector_argument<Upper>;
  detail::require(below::size(lower) == chain.size() && above::size(upper) == chain.size(),
                  "duet: with_limits: ", below::size(lower), " lower and ", above::size(upper),
                  " upper limits for ", chain.size(), " moving joints");
  auto result = detail::copy_of_chain(chain);
  for (int i = 0; i < chain.size(); ++i) {
    const joint_limits<T> limits{T(below::get(lower, i)), T(above::get(upper, i)),
                                 chain.limits(i).velocity};
    detail::require_limits(limits, std::size_t(i), "with_limits", detail::joint_name(chain, i));
    result.set_limits(i, limits);
  }
  return result;
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
  auto result = detail::copy_of_chain(chain);
  for (int i = 0; i < chain.size(); ++i) {
    const auto& current = chain.limits(i);
    const T at(about::get(theta, i)), by(bound::get(max_change, i));
    const T lower = at - by, upper = at + by;
    const joint_limits<T> limits{lower > current.lower ? lower : current.lower,
                                 upper < current.upper ? upper : current.upper, current.velocity};
    detail::require(lower == lower && upper == upper, "duet: with_limits_about: joint ", i,
                    ": the interval ", at, " ± ", by, " is not a number");
    detail::require_limits(limits, std::size_t(i), "with_limits_about",
                           detail::joint_name(chain, i));
    result.set_limits(i, limits);
  }
  return result;
}

template <SerialChain C, detail::NameInVain<C> Which>
DUET_REFUSED("only chains of read_urdf have names: with_limits(chain, number, limits)")
C with_limits(const C&, const Which&, const joint_limits<typename C::scalar_type>&);

} // namespace duet
