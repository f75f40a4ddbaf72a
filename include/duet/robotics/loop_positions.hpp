// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <duet/robotics/closed_tree.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstdint>
#include <vector>

/// \file
/// Assembly configurations of a closed-chain mechanism.

namespace duet {
DUET_ABI_BEGIN

/// One of the configurations in which the loops close (an assembly mode if the driven coordinates
/// are fixed).
struct assembly_configuration {
  Eigen::VectorXd coordinates; ///< coordinates of the tree, angles within (−π, π]
  /// Smallest singular value of ∂F/∂q with respect to the free coordinates; 0 at a branch point.
  double smallest_singular_value = 0;
  int hits = 0;              ///< number of random starts that led to it
  bool within_limits = true; ///< true if all coordinates are within the limits of their joints
};

/// Result of a search for assembly configurations.
struct assembly_search_result {
  std::vector<assembly_configuration>
      positions;     ///< assembly configurations, ordered by their first coordinates that differ
  int starts = 0;    ///< number of initial guesses
  int converged = 0; ///< number of guesses that converged to closed loops

  /// Good–Turing estimate of the probability that one more converged start finds a new
  /// configuration: the fraction of converged starts whose configuration no other start found. No
  /// proof that none is missing.
  [[nodiscard]] double missing_probability() const {
    const auto once =
        std::count_if(positions.begin(), positions.end(),
                      [](const assembly_configuration& each) { return each.hits == 1; });
    return converged > 0 ? double(once) / converged : 1;
  }
};

/// Options of the search for assembly configurations.
struct assembly_search_options {
  int random_starts = 200; ///< minimum number of random initial guesses
  std::uint64_t seed = 1;  ///< seed of the random numbers
  /// Upper bound on the Good–Turing estimate `assembly_search_result::missing_probability()`, also
  /// if one more configuration had been found once, as fewer guesses than 1 / bound cannot show it.
  /// The search continues beyond `starts` until the bound is met; the default is always met.
  double missing_probability = 2;
  int max_starts = 20000; ///< maximum number of guesses
};

/// Assembly configurations of a closed-chain mechanism with some coordinates fixed, from random
/// initial guesses: within the limits of joints whose limits are finite, otherwise angles within
/// (−π, π) and lengths within ±π `length()`. Each is accurate to round-off. The search cannot prove
/// that it is complete, but estimates the probability that one more guess finds another
/// configuration: `assembly_search_options::missing_probability`.
///
/// \param fixed  numbers of coordinates, as many as the mechanism has degrees of freedom, so that
///              configurations are isolated
/// \param at    values of the fixed coordinates, in the order of `fixed`
/// \throws invalid_input for coordinates that do not exist, and if `fixed` and `at` differ in size
[[nodiscard]] assembly_search_result
find_assembly_configurations(const closed_chain_mechanism& mechanism, const std::vector<int>& fixed,
                             const Eigen::VectorXd& at,
                             const assembly_search_options& options = {});

DUET_ABI_END
} // namespace duet
