// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/screw.hpp>
#include <duet/expression/symbol.hpp>
#include <duet/expression/tree/number.hpp>

#include <tuple>

/// \file
/// Arms as products of their joints, with the numbers of the manufacturers' tables.

namespace duet_formulas {

using namespace duet::expression::literals;

inline constexpr duet::expression::symbol<"theta1"> theta1{};
inline constexpr duet::expression::symbol<"theta2"> theta2{};
inline constexpr duet::expression::symbol<"theta3"> theta3{};
inline constexpr duet::expression::symbol<"theta4"> theta4{};
inline constexpr duet::expression::symbol<"theta5"> theta5{};
inline constexpr duet::expression::symbol<"theta6"> theta6{};
inline constexpr duet::expression::symbol<"theta7"> theta7{};
/// Symbols of the joint rates.
inline constexpr duet::expression::symbol<"dtheta1"> dtheta1{};
inline constexpr duet::expression::symbol<"dtheta2"> dtheta2{};
inline constexpr duet::expression::symbol<"dtheta3"> dtheta3{};
inline constexpr duet::expression::symbol<"dtheta4"> dtheta4{};
inline constexpr duet::expression::symbol<"dtheta5"> dtheta5{};
inline constexpr duet::expression::symbol<"dtheta6"> dtheta6{};
inline constexpr duet::expression::symbol<"dtheta7"> dtheta7{};

inline constexpr auto quarter_turn = duet::expression::pi / duet::expression::c<2>;
inline constexpr auto up = screw(duet::expression::axis::x, quarter_turn);
inline constexpr auto down = screw(duet::expression::axis::x, -quarter_turn);

/// Poses of the Panda's joint frames, each relative to the preceding one, and of the flange.
inline auto panda_frames() {
  using namespace duet::expression;
  const auto a1 = translation_along(axis::z, .333_c);
  const auto a2 = a1 * screw(axis::z, theta1) * down;
  const auto a3 = a2 * screw(axis::z, theta2) * up * translation_along(axis::z, .316_c);
  const auto a4 = a3 * screw(axis::z, theta3) * translation_along(axis::x, .0825_c) * up;
  const auto a5 = a4 * screw(axis::z, theta4) * translation_along(axis::x, -.0825_c) * down *
                  translation_along(axis::z, .384_c);
  const auto a6 = a5 * screw(axis::z, theta5) * up;
  const auto a7 = a6 * screw(axis::z, theta6) * translation_along(axis::x, .088_c) * up;
  return std::tuple(a1, a2, a3, a4, a5, a6, a7,
                    a7 * screw(axis::z, theta7) * translation_along(axis::z, .107_c));
}

} // namespace duet_formulas
