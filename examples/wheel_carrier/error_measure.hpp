// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <Eigen/Core>

/// \file
/// The paper's measure of errors (P6).

namespace wheel_carrier {

/// ‖x − reference‖ / ‖reference‖ of two vectors of the same length.
template <class X>
[[nodiscard]] typename X::Scalar relative(const X& x, const X& reference) {
  return (x - reference).norm() / reference.norm();
}

} // namespace wheel_carrier
