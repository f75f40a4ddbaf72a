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
/// Sampled orientations and poses: lookup tables, validation and sign alignment. Tables as files:
/// io/table_file.hpp.

namespace duet {

/// Lookup table of rotations (T = double) or poses (T = dual<double, 1, screw_tag>) at increasing
/// parameters.
template <class T>
struct lookup_table {
  std::vector<real_type_t<T>> parameters; ///< increasing parameters u_0 < u_1 < …
  std::vector<quaternion<T>> elements;    ///< as many unit quaternions or poses

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("parameters", parameters);
    f("elements", elements);
  }
};

/// Sample that no curve can pass through.
class invalid_sample : public invalid_input {
public:
  DUET_COLD invalid_sample(std::size_t sample, const std::string& reason)
      : invalid_input(detail::message("duet: sample ", sample, ": ", reason)), index_(sample),
        reason_(reason) {}

  /// Index of the sample, counted from 0.
  [[nodiscard]] std::size_t index() const { return index_; }
  /// Reason why it is invalid.
  [[nodiscard]] const std::string& reason() const { return reason_; }

private:
  std::size_t index_;
  std::string reason_;
};

namespace detail {

/// \param samples  number of samples
/// \param minimum  number of samples that the caller needs
/// \throws invalid_input unless there are as many parameters as samples, and enough of them
/// \throws invalid_sample unless the parameters are finite and increase
template <Real R>
void check_samples(const char* caller, const std::vector<R>& parameters, std::size_t samples,
                   std::size_t minimum) {
  require(parameters.size() == samples, "duet: ", caller, ": ", parameters.size(),
          " parameters, but ", samples, " samples");
  require(samples >= minimum, "duet: ", caller, ": needs ", minimum, " samples or more",
          minimum > 2 ? " with these end conditions" : "", ", got ", samples);
  for (std::size_t i = 0; i < samples; ++i) {
    const R& u = parameters[i];
    if (!(u - u == 0)) {
      raise(invalid_sample(i, message("parameter ", u, " is not finite")));
    }
    if (i > 0 && !(u > parameters[i - 1])) {
      raise(invalid_sample(i, message("parameter ", u, " does not increase, the sample before has ",
                                      parameters[i - 1])));
    }
  }
}

/// Relative rotation a* b with all digits of a small rotation: a* a has no vector part, and
/// subtracting it first is exact.
template <class T>
[[nodiscard]] quaternion<T> relative_rotation(const quaternion<T>& a, const quaternion<T>& b) {
  const quaternion<T> difference = conj(a) * (b - a);
  return {dot(a, b), difference.x(), difference.y(), difference.z()};
}

/// True if |q|² is 1 to round-off. Normalising such a quaternion would only round it once more, and
/// small rotations between neighbouring samples would lose digits that the samples have.
template <class T>
[[nodiscard]] bool is_unit_to_rounding(const quaternion<T>& q) {
  using std::abs;
  constexpr double digits = 8;
  if constexpr (Real<T>) {
    return abs(squared_norm(q) - 1) <= T(digits) * std::numeric_limits<T>::epsilon();
  } else if constexpr (std::is_same_v<T, dual<real_type_t<T>, 1, screw_tag>>) {
    using R = real_type_t<T>;
    const auto part = [](const T& x) { return R(abs(R(x.value() * x.epsilon()))); };
    const T square = squared_norm(q);
    const R rounding = R(digits) * std::numeric_limits<R>::epsilon();
    return abs(square.value() - 1) <= rounding &&
           abs(square.epsilon()) <=
               rounding * (part(q.w()) + part(q.x()) + part(q.y()) + part(q.z()));
  } else {
    return false;
  }
}

/// Logarithm and exponential as elsewhere, but compiled once: in interpolation the cost of calls
/// does not matter.
template <class T>
[[nodiscard]] DUET_OUT_OF_LINE vector3<T> log_out_of_line(const quaternion<T>& q) {
  return log_vector(q, "interpolate");
}
template <class T>
[[nodiscard]] DUET_OUT_OF_LINE quaternion<T> exp_out_of_line(const vector3<T>& v) {
  return duet::exp(v);
}

} // namespace detail

/// Normalises quaternions that are units except for a few digits; those that are units to round-off
/// stay as they are.
///
/// \throws invalid_sample for a quaternion that is not finite, including its infinitesimal parts,
/// or whose norm is not 1 to `unit_norm_tolerance`
template <class T>
[[nodiscard]] std::vector<quaternion<T>> normalized_quaternions(std::vector<quaternion<T>> q) {
  using std::abs;
  for (std::size_t i = 0; i < q.size(); ++i) {
    const auto length = norm(detail::innermost_of(q[i]));
    const bool is_finite = detail::is_all_finite(q[i]);
    if (!is_finite || !(abs(length - 1) <= unit_norm_tolerance)) {
      detail::raise(invalid_sample(
          i, is_finite ? detail::message("quaternion ", q[i], " has norm ", length, ", not 1")
                       : detail::message("quaternion ", q[i], " is not finite")));
    }
    if (!detail::is_unit_to_rounding(q[i])) {
      q[i] = normalized(q[i]);
    }
  }
  return q;
}

/// Normalises quaternions and aligns their signs, each with its predecessor's.
///
/// \throws invalid_sample as `normalized_quaternions`, and if two neighbours are half a turn apart,
/// so that both arcs are equally short
template <class T>
[[nodiscard]] std::vector<quaternion<T>> align_quaternion_signs(std::vector<quaternion<T>> q) {
  q = normalized_quaternions(std::move(q));
  for (std::size_t i = 1; i < q.size(); ++i) {
    if (differs_by_half_turn(q[i - 1], q[i])) {
      detail::raise(
          invalid_sample(i, "half a turn from the sample before: both arcs are equally short"));
    }
    if (innermost(dot(q[i - 1], q[i])) < 0) {
      q[i] = -q[i];
    }
  }
  return q;
}

} // namespace duet
