// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>

#include <array>
#include <cmath>

/// \file
/// The derivatives of pow, atan2, hypot and the remainders. `slopes(y, x…)` returns the partial
/// derivatives where the value is y.

namespace duet::rule {

/// x ↦ x^p, p a constant. A zero exponent has no slope, even at x = 0.
template <class Exponent>
struct power {
  Exponent exponent;

  template <class T>
  T value(const T& x) const {
    using std::pow;
    return pow(x, exponent);
  }
  template <class T>
  T slope(const T& x, const T&) const {
    using std::pow;
    if (innermost(exponent) == 0) { return T(0); }
    return exponent * pow(x, Exponent(exponent - 1));
  }
};

/// x ↦ b^x, b a constant. Where b = 0 the value jumps at x = 0 and is flat beyond.
template <class Base>
struct exponential {
  Base base;

  template <class T>
  T value(const T& x) const {
    using std::pow;
    return pow(base, x);
  }
  template <class T>
  T slope(const T& x, const T& y) const {
    using std::log;
    if (innermost(base) == 0 && innermost(x) > 0) { return T(0); }
    return y * log(base);
  }
};

struct pow {
  template <class T>
  T value(const T& x, const T& p) const {
    using std::pow;
    return pow(x, p);
  }
  template <class T>
  std::array<T, 2> slopes(const T& y, const T& x, const T& p) const {
    return {power<T>{p}.slope(x, y), exponential<T>{x}.slope(p, y)};
  }
};

struct atan2 {
  template <class T>
  T value(const T& y, const T& x) const {
    using std::atan2;
    return atan2(y, x);
  }
  template <class T>
  std::array<T, 2> slopes(const T&, const T& y, const T& x) const {
    using std::hypot;
    const T r = hypot(x, y); // x² + y² would overflow or vanish first
    return {x / r / r, -(y / r / r)};
  }
};

struct hypot {
  template <class T>
  T value(const T& x, const T& y) const {
    using std::hypot;
    return hypot(x, y);
  }
  template <class T>
  T value(const T& x, const T& y, const T& z) const {
    using std::hypot;
    if constexpr (requires { hypot(x, y, z); }) {
      return hypot(x, y, z);
    } else { // Boost.Multiprecision has two arguments only
      return hypot(T(hypot(x, y)), z);
    }
  }
  template <class T, class... Rest>
  std::array<T, 1 + sizeof...(Rest)> slopes(const T& y, const T& x, const Rest&... rest) const {
    return {x / y, rest / y...};
  }
};

struct fma {
  template <class T>
  T value(const T& x, const T& y, const T& z) const {
    using std::fma;
    return fma(x, y, z);
  }
  template <class T>
  std::array<T, 3> slopes(const T&, const T& x, const T& y, const T&) const {
    return {y, x, T(1)};
  }
};

/// fmod and remainder: x − n y, where the integer n does not change.
struct fmod {
  template <class T>
  T value(const T& x, const T& y) const {
    using std::fmod;
    return fmod(x, y);
  }
  template <class T>
  std::array<T, 2> slopes(const T& r, const T& x, const T& y) const {
    using std::round;
    return {T(1), -T(round((x - r) / y))};
  }
};

struct remainder {
  template <class T>
  T value(const T& x, const T& y) const {
    using std::remainder;
    return remainder(x, y);
  }
  template <class T>
  std::array<T, 2> slopes(const T& r, const T& x, const T& y) const {
    return fmod{}.slopes(r, x, y);
  }
};

} // namespace duet::rule
