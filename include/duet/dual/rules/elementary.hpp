// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <duet/core/compiler/pure_functions.hpp>
#include <duet/core/constants.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/dual/parts.hpp>

#include <cmath>

/// \file
/// Derivatives of roots, exponentials, logarithms and circular functions, each defined here alone.
/// (Hyperbolic and special functions: special.hpp.)
///
/// A rule has `value(x)`, the function over any scalar, and `slope(x, y)`, its derivative at x with
/// value y. Both are generic: for a nested scalar they recurse, for a taylor number the slope is
/// itself a series. Forms are chosen to be accurate over the whole domain. Sine and cosine, each
/// the slope of the other, have no slopes here: lift.hpp computes both at once.

namespace duet::detail {

/// True if |x| < ½: there derivatives of (1 − x)(1 + x) would cancel, beyond it 1 − x² does.
template <class T>
[[nodiscard]] auto is_below_half(const T& x) {
  if constexpr (Real<real_type_t<T>>) {
    return quiet_less(innermost(x) * innermost(x), 0.25);
  } else {
    return norm(innermost(x)) < 0.25;
  }
}

/// 1 − x²
template <class T>
[[nodiscard]] T one_minus_square(const T& x) {
  return select(
      is_below_half(x), [&] { return T(integer<T>(1) - x * x); },
      [&] { return T((integer<T>(1) - x) * (integer<T>(1) + x)); });
}

/// √(1 − x²), of complex numbers √(1 − x) √(1 + x): the branch that arcsines need, also on the
/// cuts, without overflow.
template <class T>
[[nodiscard]] T root_of_one_minus_square(const T& x) {
  using std::sqrt;
  if constexpr (Real<real_type_t<T>>) {
    return sqrt(one_minus_square(x));
  } else {
    return select(
        is_below_half(x), [&] { return T(sqrt(T(integer<T>(1) - x * x))); },
        [&] { return T(sqrt(T(integer<T>(1) - x)) * sqrt(T(integer<T>(1) + x))); });
  }
}

/// 1/(1 − x²) of complex numbers, without overflow.
template <class T>
[[nodiscard]] T inverse_of_one_minus_square(const T& x) {
  return select(
      is_below_half(x), [&] { return T(integer<T>(1) / (integer<T>(1) - x * x)); },
      [&] { return T(integer<T>(1) / (integer<T>(1) - x) / (integer<T>(1) + x)); });
}

/// i x of a complex number, with the signs of its zeros.
template <class T>
[[nodiscard]] T times_i(const T& x) {
  using complex = real_type_t<T>;
  return map_reals(x, [](const complex& z) { return complex(-z.imag(), z.real()); });
}

/// 1/cos²x of a complex number. Far from the real axis the cosine overflows, and 1 + tan²x would
/// cancel.
template <class T>
[[nodiscard]] T inverse_square_of_cosine(const T& x) {
  using std::abs;
  using std::cos;
  using std::exp;
  const auto y = innermost(x).imag();
  return select(
      quiet_less_equal(abs(y), 1),
      [&] {
        const T inverse = integer<T>(1) / cos(x);
        return T(inverse * inverse);
      },
      [&] {
        const T e = exp(T(times_i(x) * integer<T>(y < 0 ? -2 : 2)));
        const T sum = integer<T>(1) + e;
        return T(integer<T>(4) * e / (sum * sum));
      });
}

} // namespace duet::detail

namespace duet::rule {

struct sqrt {
  template <class T>
  T value(const T& x) const {
    return detail::pure_sqrt(x);
  }
  template <class T>
  T slope(const T&, const T& y) const {
    return real_type_t<T>(0.5) / y;
  }
};

struct cbrt {
  template <class T>
  T value(const T& x) const {
    using std::cbrt;
    return cbrt(x);
  }
  template <class T>
  T slope(const T&, const T& y) const {
    using std::pow; // in products of y one factor would be 0 and the other's derivative infinite
    return static_cast<T>(pow(y, -2)) / 3;
  }
};

struct exp {
  template <class T>
  T value(const T& x) const {
    return detail::pure_exp(x);
  }
  template <class T>
  T slope(const T&, const T& y) const {
    return y;
  }
};

struct exp2 {
  template <class T>
  T value(const T& x) const {
    using std::exp2;
    return exp2(x);
  }
  template <class T>
  T slope(const T&, const T& y) const {
    return y * constant::ln2<real_type_t<T>>();
  }
};

struct expm1 {
  template <class T>
  T value(const T& x) const {
    using std::expm1;
    return expm1(x);
  }
  template <class T>
  T slope(const T& x, const T&) const {
    using std::exp;
    return exp(x); // y + 1 would cancel for x ≪ 0
  }
};

struct log {
  template <class T>
  T value(const T& x) const {
    return detail::pure_log(x);
  }
  template <class T>
  T slope(const T& x, const T&) const {
    return detail::integer<T>(1) / x;
  }
};

struct log2 {
  template <class T>
  T value(const T& x) const {
    using std::log2;
    return log2(x);
  }
  template <class T>
  T slope(const T& x, const T&) const {
    return 1 / (x * constant::ln2<real_type_t<T>>());
  }
};

struct log10 {
  template <class T>
  T value(const T& x) const {
    using std::log10;
    return log10(x);
  }
  template <class T>
  T slope(const T& x, const T&) const {
    return detail::integer<T>(1) / (x * constant::ln10<detail::constant_t<T>>());
  }
};

struct log1p {
  template <class T>
  T value(const T& x) const {
    using std::log1p;
    return log1p(x);
  }
  template <class T>
  T slope(const T& x, const T&) const {
    return 1 / (1 + x);
  }
};

struct sin {
  template <class T>
  T value(const T& x) const {
    using std::sin;
    return sin(x);
  }
};

struct cos {
  template <class T>
  T value(const T& x) const {
    using std::cos;
    return cos(x);
  }
};

struct tan {
  template <class T>
  T value(const T& x) const {
    using std::tan;
    return tan(x);
  }
  template <class T>
  T slope([[maybe_unused]] const T& x, [[maybe_unused]] const T& y) const {
    if constexpr (Real<real_type_t<T>>) {
      return 1 + y * y;
    } else {
      return detail::inverse_square_of_cosine(x);
    }
  }
};

struct asin {
  template <class T>
  T value(const T& x) const {
    using std::asin;
    return asin(x);
  }
  template <class T>
  T slope(const T& x, const T&) const {
    return detail::integer<T>(1) / detail::root_of_one_minus_square(x);
  }
};

struct acos {
  template <class T>
  T value(const T& x) const {
    using std::acos;
    return acos(x);
  }
  template <class T>
  T slope(const T& x, const T&) const {
    return detail::integer<T>(-1) / detail::root_of_one_minus_square(x);
  }
};

struct atan {
  template <class T>
  T value(const T& x) const {
    using std::atan;
    return atan(x);
  }
  template <class T>
  T slope(const T& x, const T&) const {
    if constexpr (Real<real_type_t<T>>) {
      using std::abs;
      // x² would overflow long before its reciprocal vanishes.
      return select(
          detail::quiet_less_equal(abs(innermost(x)), real_type_t<T>(1)),
          [&] { return T(1 / (1 + x * x)); },
          [&] {
            const T r = 1 / x;
            return T(r * r / (1 + r * r));
          });
    } else {
      return detail::inverse_of_one_minus_square(detail::times_i(x));
    }
  }
};

} // namespace duet::rule
