// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <duet/core/compiler/pure_functions.hpp>
#include <duet/core/constants.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>

#include <cmath>

/// \file
/// The derivatives of roots, exponentials, logarithms and circular functions: the one place where
/// each stands. (Hyperbolic and special functions: special.hpp.)
///
/// A rule has `value(x)`, the function over any scalar, and `slope(x, y)`, its derivative at x
/// where the value there is y. Both are generic: for a nested scalar they recurse, for a taylor
/// number the slope is itself a series. Forms are chosen to be accurate over the whole domain. Sine
/// and cosine, each the slope of the other, have no slopes here: lift.hpp computes both at once.

namespace duet::detail {

/// 1 − x². Factors are accurate near ±1; near 0 the derivative of their product would cancel.
template <class T>
[[nodiscard]] T one_minus_square(const T& x) {
  return select(
      quiet_less(innermost(x) * innermost(x), 0.25), [&] { return T(1 - x * x); },
      [&] { return T((1 - x) * (1 + x)); });
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
    return 1 / (3 * y * y);
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
    return 1 / (x * constant::ln10<real_type_t<T>>());
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
    } else { // far from the real axis tan x is nearly ±i, and 1 + y² would cancel
      using std::cos;
      const T inverse = detail::integer<T>(1) / cos(x);
      return inverse * inverse;
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
    using std::sqrt;
    return 1 / sqrt(detail::one_minus_square(x));
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
    using std::sqrt;
    return -1 / sqrt(detail::one_minus_square(x));
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
    using std::abs;
    // x² would overflow long before its reciprocal vanishes.
    return select(
        detail::quiet_less_equal(abs(innermost(x)), real_type_t<T>(1)),
        [&] { return T(1 / (1 + x * x)); },
        [&] {
          const T r = 1 / x;
          return T(r * r / (1 + r * r));
        });
  }
};

} // namespace duet::rule
