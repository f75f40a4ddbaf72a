// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/mechanism/closed_tree.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstdint>
#include <vector>

/// \file
/// All ways in which the loops of a mechanism close.

namespace duet {

/// One of the ways in which loops close.
struct loop_position {
  Eigen::VectorXd coordinates; ///< of the tree: of what turns within (−π, π]
  /// Of ∂F/∂q by the coordinates that are not held: 0 where ways meet.
  double smallest_singular_value = 0;
  int found = 0;             ///< how many of the starts led to it
  bool within_limits = true; ///< are all coordinates within the limits of their joints?
};

/// The ways in which loops close that were found.
struct loop_positions {
  std::vector<loop_position> positions; ///< in the order of their first coordinates that differ
  int starts = 0;                       ///< from how many guesses loops were to be closed
  int closed = 0;                       ///< from how many they were

  /// The part of the closed starts whose position no other start found: about how probable it is,
  /// by Good and Turing, that one more start finds a new position. No proof that there is none.
  [[nodiscard]] double chance_of_more() const {
    const auto once = std::count_if(positions.begin(), positions.end(),
                                    [](const loop_position& each) { return each.found == 1; });
    return closed > 0 ? double(once) / closed : 1;
  }
};

/// From where positions are looked for.
struct loop_search_options {
  int starts = 200;       ///< how many random guesses
  std::uint64_t seed = 1; ///< of the random numbers
  /// Go on after these until `loop_positions::chance_of_more()` is below this, and would be if one
  /// more position had been found once, as fewer guesses than 1 / chance cannot tell.
  double chance_of_more = 2;
  int most_starts = 20000; ///< but not after so many
};

/// The ways in which loops close while some coordinates are held: from random guesses, within the
/// limits of joints that have some, else of angles within (−π, π), of lengths within
/// ±π `length()`. Each is known to rounding; whether all were found is not known, but
/// how probable it is that one more guess finds another: `loop_search_options::chance_of_more`.
///
/// \param held  numbers of coordinates, as many as the mechanism moves in ways, so that positions
///              are single
/// \param at    where these are held, one after the other
/// \throws invalid_input for coordinates that there are none of, and where both are not as many
[[nodiscard]] DUET_COMPILED_FUNCTION loop_positions
all_positions(const closed_tree& mechanism, const std::vector<int>& held, const Eigen::VectorXd& at,
              const loop_search_options& options = {});

} // namespace duet

#ifndef DUET_COMPILED
#include <duet/mechanism/loops/position_search.hpp>
#endif
