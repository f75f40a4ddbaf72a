// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/mechanism/denavit_hartenberg.hpp>
#include <duet/mechanism/serial_chain.hpp>

#include <array>
#include <numbers>

/// \file
/// Four arms known to the compiler, in metres and radians, from their makers' parameters.

namespace duet::robots {

namespace detail {

inline constexpr double quarter = std::numbers::pi / 2;

/// Limits ±x.
[[nodiscard]] constexpr joint_limits<> within(double x) { return {-x, x}; }

} // namespace detail

/// The table of Franka Emika's Panda, in the modified convention; the tip is the flange.
struct panda_arm {
  static constexpr auto chain = [] {
    using detail::quarter;
    using detail::within;
    const std::array<dh_row<>, 7> rows{{{0, .333, 0, 0, within(2.8973)},
                                        {0, 0, -quarter, 0, within(1.7628)},
                                        {0, .316, quarter, 0, within(2.8973)},
                                        {.0825, 0, quarter, 0, {-3.0718, -.0698}},
                                        {-.0825, .384, -quarter, 0, within(2.8973)},
                                        {0, 0, quarter, 0, {-.0175, 3.7525}},
                                        {.088, 0, quarter, 0, within(2.8973)}}};
    return from_modified_dh(rows, {quaternion<double>(1), {0, 0, .107}});
  }();
};

/// The table of KUKA's LBR iiwa 14, in the standard convention.
struct iiwa14_arm {
  static constexpr auto chain = [] {
    using detail::quarter;
    using detail::within;
    const std::array<dh_row<>, 7> rows{{{0, .36, -quarter, 0, within(2.9668)},
                                        {0, 0, quarter, 0, within(2.0942)},
                                        {0, .42, quarter, 0, within(2.9668)},
                                        {0, 0, -quarter, 0, within(2.0942)},
                                        {0, .4, -quarter, 0, within(2.9668)},
                                        {0, 0, quarter, 0, within(2.0942)},
                                        {0, .126, 0, 0, within(3.0541)}}};
    return from_dh(rows);
  }();
};

/// The table of Universal Robots' UR5e, in the standard convention.
struct ur5e_arm {
  static constexpr auto chain = [] {
    using detail::quarter;
    const joint_limits<> turn = detail::within(2 * std::numbers::pi);
    const joint_limits<> elbow = detail::within(std::numbers::pi);
    const std::array<dh_row<>, 6> rows{{{0, .1625, quarter, 0, turn},
                                        {-.425, 0, 0, 0, turn},
                                        {-.3922, 0, 0, 0, elbow},
                                        {0, .1333, quarter, 0, turn},
                                        {0, .0997, -quarter, 0, turn},
                                        {0, .0996, 0, 0, turn}}};
    return from_dh(rows);
  }();
};

/// The table of the left arm of Rethink's Baxter, in the standard convention, from the origin of
/// the joint left_s0 to left_hand.
struct baxter_left_arm {
  static constexpr auto chain = [] {
    using detail::quarter;
    const std::array<dh_row<>, 7> rows{{{.069, .27035, -quarter, 0, detail::within(1.70168)},
                                        {0, 0, quarter, quarter, {-2.147, 1.047}},
                                        {.069, .36442, -quarter, 0, detail::within(3.05418)},
                                        {0, 0, quarter, 0, {-.05, 2.618}},
                                        {.01, .37429, -quarter, 0, detail::within(3.059)},
                                        {0, 0, quarter, 0, {-1.5708, 2.094}},
                                        {0, .229525, 0, 0, detail::within(3.059)}}};
    return from_dh(rows);
  }();
};

[[nodiscard]] constexpr compiled_chain<panda_arm> panda() { return {}; }
[[nodiscard]] constexpr compiled_chain<iiwa14_arm> iiwa14() { return {}; }
[[nodiscard]] constexpr compiled_chain<ur5e_arm> ur5e() { return {}; }
[[nodiscard]] constexpr compiled_chain<baxter_left_arm> baxter_left() { return {}; }

} // namespace duet::robots
