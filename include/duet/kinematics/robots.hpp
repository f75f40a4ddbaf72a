// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/kinematics/chain_parameters.hpp>
#include <duet/kinematics/serial_chain.hpp>

#include <array>
#include <numbers>

/// \file
/// Four arms known to the compiler, in metres and radians, from the parameters of their
/// manufacturers.

namespace duet::robots {

namespace detail {

inline constexpr double quarter = std::numbers::pi / 2;

/// Limits ±x.
[[nodiscard]] constexpr joint_limits<> within(double x) { return {-x, x}; }

} // namespace detail

/// The table of Franka Emika's Panda, in the modified Denavit–Hartenberg convention; the tip
/// is the flange.
struct panda_arm {
  static constexpr auto chain = [] {
    using detail::quarter;
    using detail::within;
    const std::array<dh_row<>, 7> rows{
        {{.d = .333, .limits = within(2.8973)},
         {.alpha = -quarter, .limits = within(1.7628)},
         {.d = .316, .alpha = quarter, .limits = within(2.8973)},
         {.a = .0825, .alpha = quarter, .limits = {-3.0718, -.0698}},
         {.a = -.0825, .d = .384, .alpha = -quarter, .limits = within(2.8973)},
         {.alpha = quarter, .limits = {-.0175, 3.7525}},
         {.a = .088, .alpha = quarter, .limits = within(2.8973)}}};
    return from_modified_dh(rows, {quaternion<double>(1), {0, 0, .107}});
  }();
};

/// The table of KUKA's LBR iiwa 14, in the standard Denavit–Hartenberg convention.
struct iiwa14_arm {
  static constexpr auto chain = [] {
    using detail::quarter;
    using detail::within;
    const std::array<dh_row<>, 7> rows{{{.d = .36, .alpha = -quarter, .limits = within(2.9668)},
                                        {.alpha = quarter, .limits = within(2.0942)},
                                        {.d = .42, .alpha = quarter, .limits = within(2.9668)},
                                        {.alpha = -quarter, .limits = within(2.0942)},
                                        {.d = .4, .alpha = -quarter, .limits = within(2.9668)},
                                        {.alpha = quarter, .limits = within(2.0942)},
                                        {.d = .126, .limits = within(3.0541)}}};
    return from_dh(rows);
  }();
};

/// The table of Universal Robots' UR5e, in the standard Denavit–Hartenberg convention.
struct ur5e_arm {
  static constexpr auto chain = [] {
    using detail::quarter;
    const joint_limits<> full_turn = detail::within(2 * std::numbers::pi);
    const joint_limits<> elbow = detail::within(std::numbers::pi);
    const std::array<dh_row<>, 6> rows{{{.d = .1625, .alpha = quarter, .limits = full_turn},
                                        {.a = -.425, .limits = full_turn},
                                        {.a = -.3922, .limits = elbow},
                                        {.d = .1333, .alpha = quarter, .limits = full_turn},
                                        {.d = .0997, .alpha = -quarter, .limits = full_turn},
                                        {.d = .0996, .limits = full_turn}}};
    return from_dh(rows);
  }();
};

/// The table of the left arm of Rethink's Baxter, in the standard Denavit–Hartenberg convention,
/// from the origin of the joint left_s0 to left_hand.
struct baxter_left_arm {
  static constexpr auto chain = [] {
    using detail::quarter;
    const std::array<dh_row<>, 7> rows{
        {{.a = .069, .d = .27035, .alpha = -quarter, .limits = detail::within(1.70168)},
         {.alpha = quarter, .theta = quarter, .limits = {-2.147, 1.047}},
         {.a = .069, .d = .36442, .alpha = -quarter, .limits = detail::within(3.05418)},
         {.alpha = quarter, .limits = {-.05, 2.618}},
         {.a = .01, .d = .37429, .alpha = -quarter, .limits = detail::within(3.059)},
         {.alpha = quarter, .limits = {-1.5708, 2.094}},
         {.d = .229525, .limits = detail::within(3.059)}}};
    return from_dh(rows);
  }();
};

/// Franka Emika's Panda, seven joints, metres; the tip is the flange.
[[nodiscard]] constexpr static_chain<panda_arm> panda() { return {}; }
/// KUKA's LBR iiwa 14, seven joints, metres.
[[nodiscard]] constexpr static_chain<iiwa14_arm> iiwa14() { return {}; }
/// Universal Robots' UR5e, six joints, metres.
[[nodiscard]] constexpr static_chain<ur5e_arm> ur5e() { return {}; }
/// The left arm of Rethink's Baxter, seven joints, metres.
[[nodiscard]] constexpr static_chain<baxter_left_arm> baxter_left() { return {}; }

} // namespace duet::robots
