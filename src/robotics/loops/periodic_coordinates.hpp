// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/robotics/closed_tree.hpp>

#include <vector>

/// \file
/// Coordinates that are periodic with a full turn. For those who extend duet.

namespace duet::detail {
DUET_ABI_BEGIN

struct periodic_coordinates {
  std::vector<bool> angles; ///< for each coordinate, true if a full turn of it changes no pose
  std::vector<int> vectors; ///< numbers of the first coordinates of rotation vectors

  explicit periodic_coordinates(const closed_chain_mechanism& of);
};

DUET_ABI_END
} // namespace duet::detail
