// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual/complex.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual/rules/functions.hpp>
#include <duet/dual/rules/piecewise.hpp>
#include <duet/dual/standard_names.hpp>
#include <duet/dual/taylor.hpp>

#include <istream>
#include <limits>
#include <math.h>
#include <ostream>
#include <sstream>

/// \file
/// Functions, limits and streams of `double` for dual and Taylor numbers.
///
/// Limits are those of the innermost real, as constants. In streams a dual is `value[partial, …]`,
/// a Taylor number its coefficients `(x0 + x1 e + x2 e^2)`; input gives a constant. Digits, decimal
/// point and width are the stream's own; the width counts for the whole number, as for
/// `std::complex`.
///
/// With <math.h> the functions of `float` and `long double` are in the global namespace, too, not
/// only C's of `double`: in a formula over any scalar `sqrt(x)` is then right for all of them.

namespace duet {

/// Writes through a buffer of the same format, so that padding surrounds the whole text.
template <class Char, Infinitesimal D>
std::basic_ostream<Char>& operator<<(std::basic_ostream<Char>& out, const D& x) {
  std::basic_ostringstream<Char> text;
  text.copyfmt(out);
  text.width(0);
  text.exceptions(std::ios_base::goodbit);
  x.write(text);
  return out << text.str();
}

template <class Char, Infinitesimal D>
std::basic_istream<Char>& operator>>(std::basic_istream<Char>& in, D& x) {
  typename scalar_traits<D>::value_type value{};
  if (in >> value) {
    x = D(value);
  }
  return in;
}

} // namespace duet

template <duet::Infinitesimal D>
class std::numeric_limits<D> : public std::numeric_limits<duet::real_type_t<D>> {
  using real = std::numeric_limits<duet::real_type_t<D>>;

public:
  static constexpr D min() noexcept { return real::min(); }
  static constexpr D max() noexcept { return real::max(); }
  static constexpr D lowest() noexcept { return real::lowest(); }
  static constexpr D epsilon() noexcept { return real::epsilon(); }
  static constexpr D round_error() noexcept { return real::round_error(); }
  static constexpr D infinity() noexcept { return real::infinity(); }
  static constexpr D quiet_NaN() noexcept { return real::quiet_NaN(); }
  static constexpr D signaling_NaN() noexcept { return real::signaling_NaN(); }
  static constexpr D denorm_min() noexcept { return real::denorm_min(); }
};
