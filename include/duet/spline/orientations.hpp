// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Sequences of orientations or poses, as read from a table.

namespace duet {

/// A row of a table that no curve can be put through.
class invalid_row : public invalid_input {
public:
  DUET_COLD invalid_row(std::size_t row, const std::string& reason)
      : invalid_input(detail::message("duet: row ", row, ": ", reason)), row_(row),
        reason_(reason) {}

  /// Its number, counted from 0.
  [[nodiscard]] std::size_t row() const { return row_; }
  /// What is wrong with it.
  [[nodiscard]] const std::string& reason() const { return reason_; }

private:
  std::size_t row_;
  std::string reason_;
};

namespace detail {

/// \throws invalid_input unless there are as many parameters as elements, and enough; invalid_row
/// unless the parameters are finite and increase
template <Real R>
void check_rows(const char* caller, const std::vector<R>& parameters, std::size_t elements,
                std::size_t minimum) {
  require(parameters.size() == elements, "duet: ", caller, ": ", parameters.size(),
          " parameters, but ", elements, " rows");
  require(elements >= minimum, "duet: ", caller, ": needs ", minimum, " rows or more",
          minimum > 2 ? " with these ends" : "", ", got ", elements);
  for (std::size_t i = 0; i < elements; ++i) {
    const R& u = parameters[i];
    if (!(u - u == 0)) {
      raise(invalid_row(i, message("parameter ", u, " is not finite")));
    }
    if (i > 0 && !(u > parameters[i - 1])) {
      raise(invalid_row(i, message("parameter ", u, " does not increase, the row before has ",
                                   parameters[i - 1])));
    }
  }
}

/// a* b with all digits of a small turn: a* a has no vector part, and subtracting it first is
/// exact.
template <class T>
[[nodiscard]] quaternion<T> turn_between(const quaternion<T>& a, const quaternion<T>& b) {
  const quaternion<T> difference = conj(a) * (b - a);
  return {dot(a, b), difference.x(), difference.y(), difference.z()};
}

/// Whether |q|² is 1 to rounding. Normalising such a quaternion would only round it once more, and
/// small rotations from one row to the next would lose digits that the rows have.
template <class T>
[[nodiscard]] bool is_unit_to_rounding(const quaternion<T>& q) {
  using std::abs;
  constexpr double digits = 8;
  if constexpr (Real<T>) {
    return abs(norm2(q) - 1) <= T(digits) * std::numeric_limits<T>::epsilon();
  } else if constexpr (std::is_same_v<T, dual<real_type_t<T>, 1, screw_tag>>) {
    using R = real_type_t<T>;
    const auto part = [](const T& x) { return R(abs(R(x.value() * x.epsilon()))); };
    const T square = norm2(q);
    const R rounding = R(digits) * std::numeric_limits<R>::epsilon();
    return abs(square.value() - 1) <= rounding &&
           abs(square.epsilon()) <=
               rounding * (part(q.w()) + part(q.x()) + part(q.y()) + part(q.z()));
  } else {
    return false;
  }
}

/// log and exp as they are, but compiled once: where curves are found, calls do not count.
template <class T>
[[nodiscard]] DUET_OUT_OF_LINE vector3<T> turn_vector(const quaternion<T>& q) {
  return log_vector(q, "interpolate");
}
template <class T>
[[nodiscard]] DUET_OUT_OF_LINE quaternion<T> turn_by(const vector3<T>& v) {
  return duet::exp(v);
}

} // namespace detail

/// Quaternions that are units except for a few digits, normalised; those that are units to rounding
/// stay as they are.
///
/// \throws invalid_row for a quaternion that is not finite, its infinitesimal parts included, or
/// whose norm is not 1
template <class T>
[[nodiscard]] std::vector<quaternion<T>> unit_quaternions(std::vector<quaternion<T>> q) {
  using std::abs;
  for (std::size_t i = 0; i < q.size(); ++i) {
    const auto length = norm(detail::innermost_of(q[i]));
    const bool is_finite = detail::is_all_finite(q[i]);
    if (!is_finite || !(abs(length - 1) <= unit_norm_tolerance)) {
      detail::raise(invalid_row(
          i, is_finite ? detail::message("quaternion ", q[i], " has norm ", length, ", not 1")
                       : detail::message("quaternion ", q[i], " is not finite")));
    }
    if (!detail::is_unit_to_rounding(q[i])) {
      q[i] = normalized(q[i]);
    }
  }
  return q;
}

/// Rotations by normalised quaternions, each with the sign nearer to its predecessor's.
///
/// \throws invalid_row as `unit_quaternions`, and where two neighbours are half a turn apart, so
/// that either way round is as short
template <class T>
[[nodiscard]] std::vector<quaternion<T>> aligned_orientations(std::vector<quaternion<T>> q) {
  q = unit_quaternions(std::move(q));
  for (std::size_t i = 1; i < q.size(); ++i) {
    if (is_half_turn_apart(q[i - 1], q[i])) {
      detail::raise(
          invalid_row(i, "half a turn from the row before: either way round is as short"));
    }
    if (innermost(dot(q[i - 1], q[i])) < 0) {
      q[i] = -q[i];
    }
  }
  return q;
}

} // namespace duet
