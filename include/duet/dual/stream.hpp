// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual/dual.hpp>
#include <duet/dual/taylor.hpp>

#include <istream>
#include <ostream>

/// \file
/// Streams: a dual prints as `value[partial, …]`, a Taylor number as its coefficients
/// `x0 + x1 e + x2 e^2`; what is read is a constant's value.

namespace duet {

template <class Char, class T, int N, class Tag>
std::basic_ostream<Char>& operator<<(std::basic_ostream<Char>& out, const dual<T, N, Tag>& x) {
  out << x.value() << "[";
  for (int i = 0; i < N; ++i) { out << (i == 0 ? "" : ", ") << x.partial(i); }
  return out << "]";
}

template <class Char, class T, int K, class Tag>
std::basic_ostream<Char>& operator<<(std::basic_ostream<Char>& out, const taylor<T, K, Tag>& x) {
  out << "(" << x.value();
  for (int k = 1; k <= K; ++k) {
    out << " + " << x.coefficient(k) << " e";
    if (k > 1) { out << "^" << k; }
  }
  return out << ")";
}

template <class Char, infinitesimal D>
std::basic_istream<Char>& operator>>(std::basic_istream<Char>& in, D& x) {
  typename scalar_traits<D>::value_type value{};
  if (in >> value) { x = D(value); }
  return in;
}

} // namespace duet
