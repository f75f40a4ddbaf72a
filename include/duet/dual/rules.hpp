// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/constants.hpp>
#include <duet/core/scalar_traits.hpp>

#include <cmath>
#include <concepts>

/// \file
/// The derivatives of the elementary functions: the one place where each stands.
///
/// A rule has `value(x)`, the function over any scalar, and `slope(x, y)`, its derivative at x where
/// the value there is y. Both are generic: for a nested scalar they recurse, for a taylor number the
/// slope is itself a series. Forms are chosen to be accurate over the whole domain.

namespace duet::rule {

struct sqrt {
  template <class T>
  T value(const T& x) const {
    using std::sqrt;
    return sqrt(x);
  }
  template <class T>
  T slope(const T&, const T& y) const {
    return 1 / (2 * y);
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
    using std::exp;
    return exp(x);
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
    using std::log;
    return log(x);
  }
  template <class T>
  T slope(const T& x, const T&) const {
    return 1 / x;
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
  template <class T>
  T slope(const T& x, const T&) const {
    using std::cos;
    return cos(x);
  }
};

struct cos {
  template <class T>
  T value(const T& x) const {
    using std::cos;
    return cos(x);
  }
  template <class T>
  T slope(const T& x, const T&) const {
    using std::sin;
    return -sin(x);
  }
};

struct tan {
  template <class T>
  T value(const T& x) const {
    using std::tan;
    return tan(x);
  }
  template <class T>
  T slope(const T&, const T& y) const {
    return 1 + y * y;
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
    return 1 / sqrt((1 - x) * (1 + x));
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
    return -1 / sqrt((1 - x) * (1 + x));
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
    return 1 / (1 + x * x);
  }
};

struct sinh {
  template <class T>
  T value(const T& x) const {
    using std::sinh;
    return sinh(x);
  }
  template <class T>
  T slope(const T& x, const T&) const {
    using std::cosh;
    return cosh(x);
  }
};

struct cosh {
  template <class T>
  T value(const T& x) const {
    using std::cosh;
    return cosh(x);
  }
  template <class T>
  T slope(const T& x, const T&) const {
    using std::sinh;
    return sinh(x);
  }
};

struct tanh {
  template <class T>
  T value(const T& x) const {
    using std::tanh;
    return tanh(x);
  }
  template <class T>
  T slope(const T& x, const T&) const {
    using std::cosh;
    const T secant = 1 / cosh(x); // 1 − y² would cancel where tanh saturates
    return secant * secant;
  }
};

struct asinh {
  template <class T>
  T value(const T& x) const {
    using std::asinh;
    return asinh(x);
  }
  template <class T>
  T slope(const T& x, const T&) const {
    using std::hypot;
    return 1 / hypot(T(1), x);
  }
};

struct acosh {
  template <class T>
  T value(const T& x) const {
    using std::acosh;
    return acosh(x);
  }
  template <class T>
  T slope(const T& x, const T&) const {
    using std::sqrt;
    return 1 / (sqrt(x - 1) * sqrt(x + 1));
  }
};

struct atanh {
  template <class T>
  T value(const T& x) const {
    using std::atanh;
    return atanh(x);
  }
  template <class T>
  T slope(const T& x, const T&) const {
    return 1 / ((1 - x) * (1 + x));
  }
};

struct erf {
  template <class T>
  T value(const T& x) const {
    using std::erf;
    return erf(x);
  }
  template <class T>
  T slope(const T& x, const T&) const {
    using std::exp;
    return constant::two_over_sqrt_pi<real_type_t<T>>() * exp(-(x * x));
  }
};

struct erfc {
  template <class T>
  T value(const T& x) const {
    using std::erfc;
    return erfc(x);
  }
  template <class T>
  T slope(const T& x, const T&) const {
    using std::exp;
    return -constant::two_over_sqrt_pi<real_type_t<T>>() * exp(-(x * x));
  }
};

} // namespace duet::rule
