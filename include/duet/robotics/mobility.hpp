// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <duet/robotics/closed_tree.hpp>

#include <Eigen/Core>

#include <string>

/// \file
/// Mobility (degrees of freedom) of a closed-chain mechanism.

namespace duet {
DUET_ABI_BEGIN

/// Evidence for a mobility.
enum class mobility_evidence {
  full_rank,          ///< the equations are independent here: certain
  first_order_rigid,  ///< no rates fulfil the equations: rigid, certain
  second_order_rigid, ///< no rates that fulfil the equations have an acceleration: rigid, certain
  sampled             ///< configurations nearby were searched for
};

/// Mobility of a mechanism, and the results of simpler counts.
struct mobility_result {
  int mobility = 0;      ///< degrees of freedom: local dimension of the configuration space
  int kutzbach = 0;      ///< coordinates − equations, the Grübler–Kutzbach count
  int instantaneous = 0; ///< coordinates − rank of ∂F/∂q here: number of independent rates
  int local = 0;         ///< coordinates − rank of ∂F/∂q at configurations nearby
  mobility_evidence evidence = mobility_evidence::full_rank; ///< evidence for `mobility`

  /// True if the count of coordinates and equations differs from the mobility.
  [[nodiscard]] bool count_is_wrong() const { return kutzbach != mobility; }
  /// True if some rates do not move the mechanism: it is first-order flexible ("shaky"), or several
  /// motions meet here.
  [[nodiscard]] bool is_singular() const { return instantaneous != mobility; }
};

/// `mobility 1: counted -2, first order 1 here, 1 nearby`
[[nodiscard]] inline std::string to_text(const mobility_result& m) {
  return "mobility " + std::to_string(m.mobility) + ": counted " + std::to_string(m.kutzbach) +
         ", first order " + std::to_string(m.instantaneous) + " here, " + std::to_string(m.local) +
         " nearby";
}

/// Mobility of a mechanism at a configuration, its number of degrees of freedom.
///
/// If equations are redundant, neither their number nor the rank of ∂F/∂q determines the mobility:
/// planar mechanisms and those of Bennett and Goldberg have more equations than they need, a
/// first-order flexible ("shaky") frame has rates and does not move, and at a branch point there
/// are more rates than branches. Second derivatives then decide whether any of the rates has an
/// acceleration. If so, configurations are searched for 0.05 radians (or lengths relative to
/// `length()`) away along random rates, and around those that are found; the largest dimension that
/// they span is the mobility.
///
/// \param q  a configuration
/// \throws invalid_input if the loops are not closed at q
[[nodiscard]] mobility_result mobility(const closed_chain_mechanism& mechanism,
                                       const Eigen::VectorXd& q);

DUET_ABI_END
} // namespace duet
