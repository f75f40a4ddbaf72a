// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/lanes.hpp>
#include <duet/core/constants.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/dual/rules/elementary.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

/// \file
/// Derivatives of the error, gamma and hyperbolic functions and the inverses of these; see
/// elementary.hpp.

namespace duet {
namespace detail {

template <class T>
[[nodiscard]] T digamma(const T& argument);

/// π cot πx. The tangent has a pole at the zeros of the cotangent, where derivatives would be lost.
template <class T>
[[nodiscard]] T pi_cotangent_pi(const T& x) {
  using std::cos;
  using std::round;
  using std::sin;
  using real = real_type_t<T>;
  // Whole periods are removed first: they would cost the digits of πx.
  const T angle = (x - real(round(innermost(x)))) * constant::pi<real>();
  return constant::pi<real>() * cos(angle) / sin(angle);
}

/// Digamma function ψ(x) = Γ′(x)/Γ(x), from its asymptotic series after enough steps
/// ψ(x) = ψ(x + 1) − 1/x. Only algebra, log, sin and cos, so every scalar of duet gives the
/// derivatives of ψ too.
template <class T>
[[nodiscard]] T digamma_of_one(const T& argument) {
  using std::log;
  using real = real_type_t<T>;
  if (quiet_less(innermost(argument), 0.5)) {
    return digamma(T(1 - argument)) - pi_cotangent_pi(argument);
  }
  // B₂ₖ = numerator/denominator; the first term left out, B₃₆/(36 x³⁶), is below the last digit.
  constexpr std::array<std::array<long long, 2>, 17> bernoulli{{{1, 6},
                                                                {-1, 30},
                                                                {1, 42},
                                                                {-1, 30},
                                                                {5, 66},
                                                                {-691, 2730},
                                                                {7, 6},
                                                                {-3617, 510},
                                                                {43867, 798},
                                                                {-174611, 330},
                                                                {854513, 138},
                                                                {-236364091, 2730},
                                                                {8553103, 6},
                                                                {-23749461029, 870},
                                                                {8615841276005, 14322},
                                                                {-7709321041217, 510},
                                                                {2577687858367, 6}}};
  const double enough = std::pow(10.0, (std::numeric_limits<real>::digits10 + 14) / 36.0) + 3;
  T x = argument;
  T sum(0);
  while (quiet_less(innermost(x), enough)) {
    sum = sum - 1 / x;
    x = x + 1;
  }
  const T r = 1 / x;
  const T z = r * r;
  T series(0);
  for (int k = int(bernoulli.size()); k >= 1; --k) {
    const auto& b = bernoulli[std::size_t(k - 1)];
    series = (series + real(b[0]) / real(b[1] * 2 * k)) * z;
  }
  return sum + log(x) - r / 2 - series;
}

template <class T>
[[nodiscard]] T digamma(const T& argument) {
  return by_lane([](const auto& x) { return digamma_of_one(x); }, argument);
}

} // namespace detail

namespace rule {

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

struct tgamma {
  template <class T>
  T value(const T& x) const {
    using std::tgamma;
    return tgamma(x);
  }
  template <class T>
  T slope(const T& x, const T& y) const {
    return y * detail::digamma(x);
  }
};

/// log|Γ(x)|
struct lgamma {
  template <class T>
  T value(const T& x) const {
    using std::lgamma;
    return lgamma(x);
  }
  template <class T>
  T slope(const T& x, const T&) const {
    return detail::digamma(x);
  }
};

} // namespace rule
} // namespace duet

namespace duet::rule {

struct sinh {
  template <class T>
  T value(const T& x) const {
    using std::sinh;
    return sinh(x);
  }
};

struct cosh {
  template <class T>
  T value(const T& x) const {
    using std::cosh;
    return cosh(x);
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
    } else { // cosh x = cos ix
      return detail::inverse_square_of_cosine(detail::times_i(x));
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
    if constexpr (Real<real_type_t<T>>) {
      using std::hypot;
      return 1 / hypot(T(1), x);
    } else {
      return detail::integer<T>(1) / detail::root_of_one_minus_square(detail::times_i(x));
    }
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
    const auto by_factors = [&] { // the radicand x² − 1 would cancel and overflow
      const auto one = detail::integer<T>(1);
      return T(one / sqrt(T(x - one)) / sqrt(T(x + one)));
    };
    if constexpr (Real<real_type_t<T>>) {
      return by_factors();
    } else { // √(x − 1) √(x + 1) = ±i √(1 − x²), + above the real axis
      return select(
          detail::is_below_half(x),
          [&] {
            const T y =
                detail::times_i(T(detail::integer<T>(1) / detail::root_of_one_minus_square(x)));
            return std::signbit(innermost(x).imag()) ? y : T(-y);
          },
          by_factors);
    }
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
    if constexpr (Real<real_type_t<T>>) {
      return 1 / detail::one_minus_square(x);
    } else {
      return detail::inverse_of_one_minus_square(x);
    }
  }
};

} // namespace duet::rule
