// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/spline/motion.hpp>

#include <sstream>

/// \file
/// What an interpolating curve does at its ends.

namespace duet {

/// No angular acceleration at either end: what to assume when nothing is known. The assumption is
/// wrong for most motions and costs accuracy near the ends.
struct natural {
  void check() const {}

  template <class D>
  [[nodiscard]] vector3<D> start_residual(const motion<D>& half) const {
    return half.acceleration;
  }
  template <class D>
  [[nodiscard]] vector3<D> end_residual(const motion<D>& half) const {
    return half.acceleration;
  }
};

/// Given angular velocities at the ends: spatial axes, rad per unit of the parameter.
template <class R = double>
struct clamped {
  vector3<R> start, end;

  /// \throws invalid_input for a rate that is not finite
  void check() const {
    check("start", start);
    check("end", end);
  }

  template <class D>
  [[nodiscard]] vector3<D> start_residual(const motion<D>& half) const {
    return residual(half, start);
  }
  template <class D>
  [[nodiscard]] vector3<D> end_residual(const motion<D>& half) const {
    return residual(half, end);
  }

private:
  static void check(const char* which, const vector3<R>& omega) {
    if (!omega.allFinite()) {
      std::ostringstream message;
      message << "duet: clamped: the angular velocity at the " << which << ", (" << omega[0] << ", "
              << omega[1] << ", " << omega[2] << "), is not finite";
      throw invalid_input(message.str());
    }
  }

  /// The curve's rates are halves, in body axes.
  template <class D>
  [[nodiscard]] static vector3<D> residual(const motion<D>& half, const vector3<R>& omega) {
    return rotate(half.value, half.velocity) - (omega / 2).template cast<D>();
  }
};

template <class V>
clamped(V, V) -> clamped<typename V::Scalar>;

} // namespace duet
