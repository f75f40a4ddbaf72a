// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <numeric>

/// \file
/// Derivatives of atan2, hypot, fma, lerp, midpoint and the remainders. `slopes(y, x…)` returns the
/// partial derivatives at the value y.

namespace duet::rule {

struct atan2 {
  template <class T>
  T value(const T& y, const T& x) const {
    using std::atan2;
    return atan2(y, x);
  }
  template <class T>
  std::array<T, 2> slopes(const T&, const T& y, const T& x) const {
    // Uses the ratio of the smaller to the larger: x² + y² would overflow or vanish first.
    using std::abs;
    return select(
        detail::quiet_less_equal(abs(innermost(y)), abs(innermost(x))),
        [&] {
          const T ratio = y / x;
          const T slope = 1 / (1 + ratio * ratio) / x;
          return std::array<T, 2>{slope, -(ratio * slope)};
        },
        [&] {
          const T ratio = x / y;
          const T slope = 1 / (1 + ratio * ratio) / y;
          return std::array<T, 2>{ratio * slope, -slope};
        });
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
  template <class T>
  std::array<T, 2> slopes(const T&, const T& x, const T& y) const {
    using std::abs;
    return select(
        detail::quiet_less_equal(abs(innermost(y)), abs(innermost(x))),
        [&] { return by_largest(x, y); },
        [&] {
          const std::array<T, 2> s = by_largest(y, x);
          return std::array<T, 2>{s[1], s[0]};
        });
  }
  template <class T>
  std::array<T, 3> slopes(const T&, const T& x, const T& y, const T& z) const {
    using std::abs;
    const auto a = abs(innermost(x)), b = abs(innermost(y)), c = abs(innermost(z));
    return select(
        detail::quiet_less_equal(b, a) && detail::quiet_less_equal(c, a),
        [&] { return by_largest(x, y, z); },
        [&] {
          return select(
              detail::quiet_less_equal(c, b),
              [&] {
                const std::array<T, 3> s = by_largest(y, x, z);
                return std::array<T, 3>{s[1], s[0], s[2]};
              },
              [&] {
                const std::array<T, 3> s = by_largest(z, x, y);
                return std::array<T, 3>{s[1], s[2], s[0]};
              });
        });
  }

private:
  /// Uses ratios to the largest: 1/r − x²/r³, the derivative of x/r, would cancel if x is the
  /// largest.
  template <class T, class... Rest>
  static std::array<T, 1 + sizeof...(Rest)> by_largest(const T& largest, const Rest&... rest) {
    using std::sqrt;
    std::array<T, 1 + sizeof...(Rest)> result{T(0), rest / largest...};
    T square(1);
    for (const T& ratio : result) {
      square = square + ratio * ratio;
    }
    const T length = sqrt(square);
    result[0] = select(
        detail::quiet_less(innermost(largest), real_type_t<T>(0)), [&] { return T(-1 / length); },
        [&] { return T(1 / length); });
    for (std::size_t i = 1; i < result.size(); ++i) {
      result[i] = result[i] * result[0];
    }
    return result;
  }
};

/// x y + z, rounded once.
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

/// fmod and remainder: x − n y with a constant integer n.
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

/// a + t (b − a)
struct lerp {
  template <class T>
  T value(const T& a, const T& b, const T& t) const {
    if constexpr (std::floating_point<lane_type_t<T>> || Infinitesimal<T>) {
      using std::lerp;
      return lerp(a, b, t);
    } else { // <cmath> supports built-in types only
      return select(
          t < T(0.5), [&] { return T(a + t * (b - a)); }, [&] { return T(b - (1 - t) * (b - a)); });
    }
  }
  template <class T>
  std::array<T, 3> slopes(const T&, const T& a, const T& b, const T& t) const {
    return {1 - t, t, b - a};
  }
};

/// (a + b)/2
struct midpoint {
  template <class T>
  T value(const T& a, const T& b) const {
    if constexpr (std::floating_point<lane_type_t<T>> || Infinitesimal<T>) {
      using std::midpoint;
      return midpoint(a, b);
    } else { // <numeric> supports built-in types only; wider exponents leave room for the sum
      return (a + b) / 2;
    }
  }
  template <class T>
  std::array<T, 2> slopes(const T&, const T&, const T&) const {
    return {T(real_type_t<T>(0.5)), T(real_type_t<T>(0.5))};
  }
};

} // namespace duet::rule
