// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/dual/rules/elementary.hpp>

#include <cmath>

/// \file
/// The derivatives of the hyperbolic functions and their inverses; see elementary.hpp.

namespace duet::rule {

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
  T slope(const T& x, [[maybe_unused]] const T& y) const {
    if constexpr (Real<real_type_t<T>>) {
      // 1 − y² would cancel where tanh saturates, and 1/cosh² overflow within.
      return select(
          detail::quiet_less(innermost(y) * innermost(y), 0.5), [&] { return T(1 - y * y); },
          [&] {
            using std::exp;
            const T e = exp(select(
                detail::quiet_less(innermost(x), real_type_t<T>(0)), [&] { return T(2 * x); },
                [&] { return T(-2 * x); }));
            return T(4 * e / ((1 + e) * (1 + e)));
          });
    } else {
      using std::cosh;
      const T inverse = detail::integer<T>(1) / cosh(x);
      return inverse * inverse;
    }
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
    return 1 / sqrt(x - 1) / sqrt(x + 1); // the radicand x² − 1 would cancel and overflow
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
    return 1 / detail::one_minus_square(x);
  }
};

} // namespace duet::rule
