// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "solution_curve.hpp"

#include <Eigen/Core>

#include <optional>
#include <vector>

/// \file
/// Branch points of a curve of configurations, and the tangents of the branches there. For those
/// who extend duet.

namespace duet::detail {
DUET_ABI_BEGIN

/// A branch point of a curve.
struct branch_point_data {
  Eigen::VectorXd x; ///< coordinates as in `curve_point`
  /// Unit tangents: straight on, those of other branches in pairs of opposites, back.
  std::vector<Eigen::VectorXd> tangents;
  std::vector<curve_point> points; ///< a point of the curve along each tangent
};

/// The branch point ahead of a point of the curve, to round-off; empty if no branch point is
/// near, or if branches touch there, so that second derivatives do not separate them.
///
/// \param step  half of the last rejected step; a branch point is near if it is small
[[nodiscard]] std::optional<branch_point_data>
branch_point_ahead(const solution_curve& curve, const curve_point& from, double step);

DUET_ABI_END
} // namespace duet::detail
