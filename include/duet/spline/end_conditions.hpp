// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>

#include <Eigen/Core>

#include <sstream>

/// \file
/// What an interpolating curve does at its ends.
///
/// Rates are per unit of the parameter, in spatial axes: angular velocities and accelerations as
/// 3-vectors for rotations, twists [v; ω] and their derivatives as 6-vectors for poses.

namespace duet {
namespace detail {

/// \throws invalid_input for a rate that is not finite
template <class V>
void check_end_rates(const char* condition, const V& start, const V& end) {
  static_assert(V::SizeAtCompileTime == 3 || V::SizeAtCompileTime == 6,
                "duet: end rates are angular, 3-vectors, or twists [v; ω], 6-vectors");
  const auto check = [&](const char* which, const V& rate) {
    for (int i = 0; i < V::SizeAtCompileTime; ++i) {
      if (!(innermost(rate[i]) - innermost(rate[i]) == 0)) {
        std::ostringstream message;
        message << "duet: " << condition << ": the rate at the " << which << ", ("
                << rate.transpose().format({Eigen::StreamPrecision, Eigen::DontAlignCols, ", "})
                << "), is not finite";
        throw invalid_input(message.str());
      }
    }
  };
  check("start", start);
  check("end", end);
}

} // namespace detail

/// No angular or twist acceleration at either end: what to assume when a motion starts and ends
/// evenly. The assumption is wrong for most motions and costs accuracy near the ends.
struct natural {
  void check() const {}
};

/// Given angular velocities, or twists.
template <class V = Eigen::Matrix<double, 3, 1>>
struct clamped {
  V start, end;

  /// \throws invalid_input for a rate that is not finite
  void check() const { detail::check_end_rates("clamped", start, end); }
};

/// Given angular accelerations, or derivatives of twists.
template <class V = Eigen::Matrix<double, 3, 1>>
struct end_acceleration {
  V start, end;

  /// \throws invalid_input for a rate that is not finite
  void check() const { detail::check_end_rates("end_acceleration", start, end); }
};

/// Given angular velocities and accelerations, or twists and their derivatives: all that the
/// ends of a quintic can be told. (Of only one of them, the fifth derivative's continuity at the
/// second knot takes the other's place.)
template <class V = Eigen::Matrix<double, 3, 1>>
struct fully_clamped {
  clamped<V> velocity;
  end_acceleration<V> acceleration;

  /// \throws invalid_input for a rate that is not finite
  void check() const {
    velocity.check();
    acceleration.check();
  }
};

/// The first two pieces are one, and so are the last two: what to assume when nothing is known.
struct not_a_knot {
  void check() const {}
};

/// The motion closes on itself, with its rates; the last row repeats the first.
struct periodic {
  void check() const {}
};

template <class V>
clamped(V, V) -> clamped<typename V::PlainObject>;
template <class A, class B>
clamped(A, B) -> clamped<typename A::PlainObject>;
template <class V>
end_acceleration(V, V) -> end_acceleration<typename V::PlainObject>;
template <class A, class B>
end_acceleration(A, B) -> end_acceleration<typename A::PlainObject>;
template <class V, class W>
fully_clamped(clamped<V>, end_acceleration<W>) -> fully_clamped<V>;

} // namespace duet
