// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>

#include <istream>
#include <ostream>
#include <sstream>

/// \file
/// Streams: a dual prints as `value[partial, …]`, a Taylor number as its coefficients
/// `(x0 + x1 e + x2 e^2)`; what is read is a constant's value. Digits, decimal point and width are
/// the stream's own; the width counts for the whole number, as for `std::complex`.

namespace duet {
namespace detail {

/// Writes through a buffer of the same format, so that padding surrounds the whole text.
template <class Char, class Write>
std::basic_ostream<Char>& write_padded(std::basic_ostream<Char>& out, Write&& write) {
  std::basic_ostringstream<Char> text;
  text.copyfmt(out);
  text.width(0);
  text.exceptions(std::ios_base::goodbit);
  write(text);
  return out << text.str();
}

} // namespace detail

template <class Char, Infinitesimal D>
std::basic_ostream<Char>& operator<<(std::basic_ostream<Char>& out, const D& x) {
  return detail::write_padded(out, [&](auto& text) { x.write(text); });
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
