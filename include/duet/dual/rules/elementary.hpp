// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/batch.hpp>
#include <duet/core/batch/math.hpp>
#include <duet/core/compiler/pure_functions.hpp>
#include <duet/core/config.hpp>
#include <duet/core/constants.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/dual/level.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

/// \file
/// Derivatives of roots, exponentials, logarithms, circular, hyperbolic, error and gamma functions
/// and their inverses, each defined here alone.
///
/// A rule has `value(x)`, the function over any scalar, and `slope(x, y)`, its derivative at x with
/// value y. Both are generic: for a nested scalar they recurse, for a taylor number the slope is
/// itself a series. Forms are chosen to be accurate over the whole domain. `lift` makes of a rule
/// the function over infinitesimal numbers. Sine and cosine, each the slope of the other, have no
/// slopes: both are computed at once.

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

/// The value of a rule is that of the function of `<cmath>`, or of one found by its argument.
#define DUET_VALUE_OF_RULE(name)                                                                   \
  template <class T>                                                                               \
  T value(const T& x) const {                                                                      \
    using std::name;                                                                               \
    return name(x);                                                                                \
  }

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
  DUET_VALUE_OF_RULE(cbrt)
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
  DUET_VALUE_OF_RULE(exp2)
  template <class T>
  T slope(const T&, const T& y) const {
    return y * constant::ln2<real_type_t<T>>();
  }
};

struct expm1 {
  DUET_VALUE_OF_RULE(expm1)
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
  DUET_VALUE_OF_RULE(log2)
  template <class T>
  T slope(const T& x, const T&) const {
    return 1 / (x * constant::ln2<real_type_t<T>>());
  }
};

struct log10 {
  DUET_VALUE_OF_RULE(log10)
  template <class T>
  T slope(const T& x, const T&) const {
    return detail::integer<T>(1) / constant::ln10<detail::constant_t<T>>() / x;
  }
};

struct log1p {
  DUET_VALUE_OF_RULE(log1p)
  template <class T>
  T slope(const T& x, const T&) const {
    return 1 / (1 + x);
  }
};

struct sin {
  DUET_VALUE_OF_RULE(sin)
};
struct cos {
  DUET_VALUE_OF_RULE(cos)
};
struct sinh {
  DUET_VALUE_OF_RULE(sinh)
};
struct cosh {
  DUET_VALUE_OF_RULE(cosh)
};

struct tan {
  DUET_VALUE_OF_RULE(tan)
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
  DUET_VALUE_OF_RULE(asin)
  template <class T>
  T slope(const T& x, const T&) const {
    return detail::integer<T>(1) / detail::root_of_one_minus_square(x);
  }
};

struct acos {
  DUET_VALUE_OF_RULE(acos)
  template <class T>
  T slope(const T& x, const T&) const {
    return detail::integer<T>(-1) / detail::root_of_one_minus_square(x);
  }
};

struct atan {
  DUET_VALUE_OF_RULE(atan)
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

namespace duet::detail {

template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE sine_cosine<T> sine_and_cosine_of(const T& x) {
  if constexpr (lane_traits<T>::is_batch) {
    return sine_cosine_of_batch(x);
  } else {
    return {pure_sin(x), pure_cos(x)};
  }
}

template <class T>
[[nodiscard]] sine_cosine<T> hyperbolic_sine_and_cosine_of(const T& x) {
  using std::cosh;
  using std::sinh;
  return {sinh(x), cosh(x)};
}

/// Sine and cosine of x, given those of its innermost value as y.
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE sine_cosine<T>
sine_and_cosine_from(const sine_cosine<real_type_t<T>>& y, const T& x) {
  if constexpr (Infinitesimal<T>) {
    return T::template lift_pair<-1>(sine_and_cosine_from(y, x.value()), x);
  } else {
    return y;
  }
}

template <class Rule, Infinitesimal D, class... Rest>
[[nodiscard]] DUET_ALWAYS_INLINE D lift(const Rule& rule, const D& x, const Rest&... rest) {
  return D::lift(rule, x, rest...);
}
/// Lane by lane.
template <class Rule, class T, int W, class... Rest>
[[nodiscard]] batch<T, W> lift(const Rule& rule, const batch<T, W>& x, const Rest&... rest) {
  return each_lane([&](const auto&... lane) { return rule.value(lane...); }, x, rest...);
}

// Applied separately, the rules of sine and cosine would each evaluate both.

template <Infinitesimal D>
[[nodiscard]] DUET_ALWAYS_INLINE D lift(const rule::sin&, const D& x) {
  return D::template lift_pair<-1>(sine_and_cosine_of(x.value()), x).sine;
}
template <Infinitesimal D>
[[nodiscard]] DUET_ALWAYS_INLINE D lift(const rule::cos&, const D& x) {
  return D::template lift_pair<-1>(sine_and_cosine_of(x.value()), x).cosine;
}
template <Infinitesimal D>
[[nodiscard]] D lift(const rule::sinh&, const D& x) {
  return D::template lift_pair<1>(hyperbolic_sine_and_cosine_of(x.value()), x).sine;
}
template <Infinitesimal D>
[[nodiscard]] D lift(const rule::cosh&, const D& x) {
  return D::template lift_pair<1>(hyperbolic_sine_and_cosine_of(x.value()), x).cosine;
}

} // namespace duet::detail

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
  DUET_VALUE_OF_RULE(erf)
  template <class T>
  T slope(const T& x, const T&) const {
    using std::exp;
    return constant::two_over_sqrt_pi<real_type_t<T>>() * exp(-(x * x));
  }
};

struct erfc {
  DUET_VALUE_OF_RULE(erfc)
  template <class T>
  T slope(const T& x, const T&) const {
    using std::exp;
    return -constant::two_over_sqrt_pi<real_type_t<T>>() * exp(-(x * x));
  }
};

struct tgamma {
  DUET_VALUE_OF_RULE(tgamma)
  template <class T>
  T slope(const T& x, const T& y) const {
    return y * detail::digamma(x);
  }
};

/// log|Γ(x)|
struct lgamma {
  DUET_VALUE_OF_RULE(lgamma)
  template <class T>
  T slope(const T& x, const T&) const {
    return detail::digamma(x);
  }
};

} // namespace rule
} // namespace duet

namespace duet::rule {

struct tanh {
  DUET_VALUE_OF_RULE(tanh)
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
  DUET_VALUE_OF_RULE(asinh)
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
  DUET_VALUE_OF_RULE(acosh)
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
  DUET_VALUE_OF_RULE(atanh)
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

#undef DUET_VALUE_OF_RULE
