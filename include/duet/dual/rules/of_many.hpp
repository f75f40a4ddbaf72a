// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/dual/level.hpp>
#include <duet/dual/partials.hpp>
#include <duet/dual/rules/elementary.hpp>

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <type_traits>

/// \file
/// Derivatives of atan2, hypot, fma, lerp, midpoint, the remainders and powers. `slopes(y, x…)`
/// returns the partial derivatives at the value y.

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

namespace duet::detail {

/// The part of x that determines how fast 0^x vanishes: x, or its real part.
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr decltype(auto) real_part(const T& x) {
  if constexpr (Real<T>) {
    return (x);
  } else {
    return x.real();
  }
}

/// log b as a number that multiplies T's numbers; log(−2) is complex if they are.
template <class T, class Base>
[[nodiscard]] DUET_ALWAYS_INLINE auto log_of_base(const Base& base) {
  using std::log;
  if constexpr (Arithmetic<Base> && !Real<real_type_t<T>>) {
    return log(real_type_t<T>(base));
  } else {
    return log(base);
  }
}

/// Power of two constants as `<complex>` has it for their types; it is a C. (For other than
/// built-in numbers libc++ has only that of two complex ones.)
template <class C, class X, class P>
[[nodiscard]] C complex_power_of_constants(const X& x, const P& p) {
  using std::pow;
  const auto with_precision = [](const auto& a) {
    if constexpr (std::floating_point<std::remove_cvref_t<decltype(a)>>) {
      return static_cast<constant_t<C>>(a);
    } else {
      return a;
    }
  };
  const auto base = with_precision(x);
  const auto exponent = with_precision(p);
  if constexpr (requires { pow(base, exponent); }) {
    return C(pow(base, exponent));
  } else {
    return pow(C(base), C(exponent));
  }
}

/// x^p for use in slopes: for complex numbers with 0⁰ = 1, for which `<complex>` returns NaN, and
/// with integer powers by products, as the logarithm of a large x would cost digits.
template <class T, class Exponent>
[[nodiscard]] T power_in_slope(const T& x, const Exponent& p);

} // namespace duet::detail

namespace duet::rule {

/// x ↦ x^p. A zero exponent has no slope, even at x = 0.
template <class Exponent>
struct power {
  Exponent exponent;

  template <class T>
  T value(const T& x) const {
    return detail::power_in_slope(x, exponent);
  }
  template <class T>
  T slope(const T& x, [[maybe_unused]] const T& y) const {
    const auto by_power = [&] {
      return T(exponent *
               detail::power_in_slope(x, Exponent(exponent - detail::integer<Exponent>(1))));
    };
    return select(
        detail::is_structural_zero(exponent) ||
            (innermost(exponent) == detail::integer<Exponent>(0) &&
             innermost(x) == detail::integer<T>(0)),
        [] { return T(0); },
        [&] {
          if constexpr (Real<real_type_t<T>>) {
            // Below ½ p − 1 is rounded, which x^(p−1) far from 1 shows; from there on it is exact,
            // and x^p may overflow or vanish before its slope does.
            using std::isfinite;
            return select(
                detail::quiet_less(innermost(exponent), 0.5) && innermost(x) != 0 &&
                    isfinite(innermost(x)),
                [&] { return T(exponent * y / x); }, by_power);
          } else {
            return by_power();
          }
        });
  }
};

/// x ↦ b^x. For b = 0 the value jumps at x = 0 and is flat beyond, for b = ∞ likewise below.
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
    const T regular = y * detail::log_of_base<T>(base);
    // 0^x log 0 vanishes, and so do its derivatives with respect to the base, except those of order
    // x and above.
    const auto& real_x = detail::real_part(innermost(x));
    using R = std::remove_cvref_t<decltype(real_x)>;
    const auto vanishes =
        innermost(base) == detail::integer<Base>(0) && detail::quiet_less(R(0), real_x);
    const auto is_flat =
        detail::is_constant(base) || detail::quiet_less(R(scalar_traits<T>::order), real_x);
    return select((vanishes && is_flat) || vanishes_at_infinity(real_x), [] { return T(0); },
                  [&] {
                    return select(
                        vanishes,
                        [&] { return T(detail::with_innermost(regular, real_type_t<T>(0))); },
                        [&] { return regular; });
                  });
  }

private:
  /// True if b = ∞ and x < 0: ∞^x log ∞ vanishes, with all its derivatives.
  template <class R>
  [[nodiscard]] auto vanishes_at_infinity([[maybe_unused]] const R& x) const {
    using real = real_type_t<Base>;
    if constexpr (Real<real> && Real<R> && !detail::is_recording<R>) {
      return innermost(base) == std::numeric_limits<real>::infinity() &&
             detail::quiet_less(x, R(0));
    } else {
      return false;
    }
  }
};

struct pow {
  template <class T>
  T value(const T& x, const T& p) const {
    return detail::power_in_slope(x, p);
  }
  template <class T>
  std::array<T, 2> slopes(const T& y, const T& x, const T& p) const {
    return {power<T>{p}.slope(x, y), exponential<T>{x}.slope(p, y)};
  }
};

} // namespace duet::rule

namespace duet::detail {

/// x^n by products.
template <class T>
[[nodiscard]] T integer_power(T x, int n) {
  T result(integer<T>(1));
  for (int k = std::abs(n); k > 0; k /= 2) {
    if (k % 2 == 1) {
      result = result * x;
    }
    x = x * x;
  }
  return n < 0 ? T(integer<T>(1) / result) : result;
}

/// Integer exponents up to this one are computed by products in slopes of complex powers.
inline constexpr int integer_power_limit = 64;

template <class T, class Exponent>
[[nodiscard]] T power_in_slope(const T& x, const Exponent& p) {
  using std::fabs;
  using std::pow;
  using std::trunc;
  if constexpr (Real<real_type_t<T>> || std::integral<constant_t<T>>) {
    return pow(x, p);
  } else if constexpr (Infinitesimal<Exponent>) {
    return lift(rule::pow{}, x, p);
  } else if constexpr (Infinitesimal<T>) {
    return lift(rule::power<Exponent>{p}, x);
  } else {
    const auto& real = real_part(p);
    if (p == real && fabs(real) <= integer_power_limit && trunc(real) == real) {
      return integer_power(x, int(real));
    }
    return complex_power_of_constants<T>(x, p);
  }
}

} // namespace duet::detail
