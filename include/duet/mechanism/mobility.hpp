// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/mechanism/closed_tree.hpp>

#include <Eigen/Core>

#include <string>

/// \file
/// In how many ways a mechanism with loops moves.

namespace duet {

/// What a mobility is known by.
enum class mobility_evidence {
  full_rank,       ///< the equations do not depend on each other here: certain
  no_rates,        ///< no rates fulfil the equations: rigid, certain
  no_acceleration, ///< of the rates that fulfil them none has an acceleration: rigid, certain
  nearby_positions ///< positions were looked for around this one
};

/// In how many ways a mechanism moves, and what simpler counts would say.
struct mobility_result {
  int mobility = 0;    ///< how many coordinates the positions around this one have
  int counted = 0;     ///< coordinates − equations, as Grübler and Kutzbach count
  int first_order = 0; ///< coordinates − rank of ∂F/∂q here: independent rates
  int nearby = 0;      ///< the same at positions nearby
  mobility_evidence evidence = mobility_evidence::full_rank; ///< what it is known by

  /// Does counting coordinates and equations say something else?
  [[nodiscard]] bool is_miscounted() const { return counted != mobility; }
  /// Are there rates with which it does not move: is it shaky, or do several motions meet here?
  [[nodiscard]] bool is_singular() const { return first_order != mobility; }
};

/// `mobility 1: counted -2, first order 1 here, 1 nearby`
[[nodiscard]] inline std::string to_text(const mobility_result& m) {
  return "mobility " + std::to_string(m.mobility) + ": counted " + std::to_string(m.counted) +
         ", first order " + std::to_string(m.first_order) + " here, " + std::to_string(m.nearby) +
         " nearby";
}

/// In how many ways a mechanism moves from a position.
///
/// Where equations depend on each other neither their number nor the rank of ∂F/∂q says so: planar
/// mechanisms and those of Bennett and Goldberg have more equations than they need, a shaky frame
/// has rates and does not move, and where motions meet there are more rates than ways to go on.
/// Then second derivatives are asked whether any of the rates has an acceleration, and if so,
/// positions are looked for 0.05 radians (or parts of `length()`) away along random rates, and
/// around those that are found; the largest dimension of what they span is the mobility.
///
/// \param q  a position
/// \throws invalid_input for a q at which the loops are not closed
[[nodiscard]] DUET_COMPILED_FUNCTION mobility_result mobility(const closed_tree& mechanism,
                                                              const Eigen::VectorXd& q);

} // namespace duet

#ifndef DUET_COMPILED
#include <duet/mechanism/loops/surroundings.hpp>
#endif
