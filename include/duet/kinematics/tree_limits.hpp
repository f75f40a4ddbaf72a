// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/kinematics/chain_walk.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/kinematic_tree.hpp>

#include <concepts>
#include <cstddef>
#include <string_view>

/// \file
/// Kinematic trees with changed limits.

namespace duet {

/// The tree with other limits of a coordinate, given by its number or its name. All three limits
/// are replaced, so the velocity is not limited if `limits.velocity` is the default, and joints
/// that mimic the coordinate no longer narrow them. Chains of the tree have the new limits, too.
///
/// Example: `tree = with_limits(tree, "elbow", {.lower = 0, .upper = 2});`
///
/// \throws invalid_input for a coordinate that does not exist, and for limits that allow no motion:
/// a lower limit above the upper one, NaN, a negative velocity
template <class Which>
  requires(std::integral<Which> || std::convertible_to<const Which&, std::string_view>)
[[nodiscard]] kinematic_tree with_limits(const kinematic_tree& tree, const Which& which,
                                         const joint_limits<double>& limits) {
  int i = 0;
  if constexpr (std::integral<Which>) {
    detail::require(0 <= which && which < tree.size(), "duet: with_limits: coordinate ", which,
                    " does not exist, the tree has ", tree.size());
    i = int(which);
  } else {
    i = tree.coordinate(which);
  }
  detail::require_limits(limits, std::size_t(i), "with_limits",
                         tree.coordinate_names()[std::size_t(i)]);
  kinematic_tree result = tree;
  result.set_limits(i, limits);
  return result;
}

/// The tree with other lower and upper limits of all coordinates, in radians or units of length;
/// velocity limits are kept. Limits are any vectors: Eigen's, `std::array`, `std::vector`.
///
/// \throws invalid_input if the number of limits differs from that of coordinates, and as for
/// one coordinate
template <VectorLike Lower, VectorLike Upper>
[[nodiscard]] kinematic_tree with_limits(const kinematic_tree& tree, const Lower& lower,
                                         const Upper& upper) {
  using below = detail::vector_argument<Lower>;
  using above = detail::vector_argument<Upper>;
  detail::require(below::size(lower) == tree.size() && above::size(upper) == tree.size(),
                  "duet: with_limits: ", below::size(lower), " lower and ", above::size(upper),
                  " upper limits for ", tree.size(), " coordinates");
  kinematic_tree result = tree;
  for (int i = 0; i < tree.size(); ++i) {
    const joint_limits<double> limits{double(below::get(lower, i)), double(above::get(upper, i)),
                                      tree.limits(i).velocity};
    detail::require_limits(limits, std::size_t(i), "with_limits",
                           tree.coordinate_names()[std::size_t(i)]);
    result.set_limits(i, limits);
  }
  return result;
}

} // namespace duet
