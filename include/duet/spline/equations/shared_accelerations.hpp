// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/rotation_vector_segment.hpp>

#include <array>
#include <cstddef>
#include <vector>

/// \file
/// Pieces of cubic rotation-vector splines that have the same accelerations where they meet,
/// however different their lengths.

namespace duet::detail {

/// The cubic polynomials of a curve once more, from accelerations at its knots that are those of
/// the longer piece there, which knows them best.
/// \param steps  the lengths of the pieces
/// \param knots  their number: that of the pieces where the last one is the first again
template <class T>
void share_accelerations(const std::vector<rotation_vector_segment<T, 4>>& pieces,
                         const std::vector<real_type_t<T>>& steps, std::size_t knots,
                         std::vector<std::array<vector3<T>, 4>>& polynomials) {
  using R = real_type_t<T>;
  const typename rotation_vector_segment<T, 4>::identity_coefficients at_identity(R(0));
  std::vector<std::array<vector3<T>, 2>> rates(knots);
  std::vector<R> lengths(knots, R(0));
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const std::size_t next = (i + 1) % knots;
    const auto w = pieces[i].template rates<2, T>(at_identity, polynomials[i]);
    if (steps[i] > lengths[i]) {
      rates[i] = w.start;
      lengths[i] = steps[i];
    }
    if (steps[i] > lengths[next]) {
      rates[next] = w.end;
      lengths[next] = steps[i];
    }
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    polynomials[i] = pieces[i].polynomial_of_accelerations(rates[i], rates[(i + 1) % knots]);
  }
}

} // namespace duet::detail
