// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual/level.hpp>
#include <duet/dual/partials.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual/rules/elementary.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>

/// \file
/// Truncated Taylor series x₀ + x₁ε + … + x_K ε^K, ε^{K+1} = 0: a value and its first K derivatives
/// along one direction, in one pass.
///
/// For y = f(x) the chain rule y′ = f′(x) x′ gives, coefficient by coefficient, k y_k = Σ_{j=1…k} j
/// x_j s_{k−j}, where s is the series of the slope f′(x). The slope is needed to order K−1 only, so
/// the rule of a function is applied to shorter and shorter series.

namespace duet {
DUET_ABI_BEGIN
template <class T, int K, class Tag>
class taylor;
DUET_ABI_END

namespace detail {

/// x with the powers above L dropped; a plain value for L = 0.
template <int L, class T, int K, class Tag>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto truncated(const taylor<T, K, Tag>& x) {
  if constexpr (L == 0) {
    return x.value();
  } else if constexpr (L == K) {
    return x;
  } else {
    taylor<T, L, Tag> result;
    unrolled<L + 1>([&](int k) DUET_INLINE_LAMBDA { result.set_coefficient(k, x.coefficient(k)); });
    return result;
  }
}

/// The k-th coefficient of a series, or of a plain value.
template <class T, class S>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr const T& coefficient_of(const S& s,
                                                                   [[maybe_unused]] int k) {
  if constexpr (std::same_as<T, S>) {
    return s;
  } else {
    return s.coefficient(k);
  }
}

/// x / k. For built-in reals 1/k is a constant, accurate to half a unit in the last place: a
/// division would be the slowest link in the chain of coefficients.
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr T divided_by_order(const T& x, int k) {
  if constexpr (std::floating_point<T>) {
    return x * (T(1) / T(k));
  } else {
    return x / integer<T>(k);
  }
}

/// Σ_{j=1…K} j x_j s_{K−j}, zero coefficients of x not touching infinite slopes.
template <class T, int K, class Tag, class S>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr T chain_coefficient(const taylor<T, K, Tag>& x,
                                                               const S& slope) {
  T probe = coefficient_of<T>(slope, 0);
  unrolled<K - 1>([&](int i)
                      DUET_INLINE_LAMBDA { probe = probe + coefficient_of<T>(slope, i + 1); });
  return with_surviving_products(probe, [&](const auto& product) DUET_INLINE_LAMBDA {
    T sum(0);
    unrolled<K>([&](int i) DUET_INLINE_LAMBDA {
      const int j = i + 1;
      const T term = product(coefficient_of<T>(slope, K - j), x.coefficient(j));
      sum = j == 1 ? T(sum + term) : T(sum + term * integer<T>(j));
    });
    return sum;
  });
}

/// `shorter`, the series to order K−1, extended by the coefficient of ε^K.
template <class D, class S, class T>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr D extended(const S& shorter, const T& last, int order) {
  D result;
  unrolled<scalar_traits<D>::order - scalar_traits<T>::order>(
      [&](int k) DUET_INLINE_LAMBDA { result.set_coefficient(k, coefficient_of<T>(shorter, k)); });
  result.set_coefficient(order, last);
  return result;
}

template <class Rule, class T, int K, class Tag>
[[nodiscard]] DUET_ALWAYS_INLINE taylor<T, K, Tag> lift_in_place(const Rule& rule,
                                                                 const taylor<T, K, Tag>& x) {
  const auto shorter_x = truncated<K - 1>(x);
  if constexpr (K == 1) {
    const T y = rule.value(shorter_x);
    return extended<taylor<T, K, Tag>>(y, chain_coefficient(x, rule.slope(shorter_x, y)), K);
  } else {
    const auto y = lift(rule, shorter_x);
    const T last = divided_by_order(chain_coefficient(x, rule.slope(shorter_x, y)), K);
    return extended<taylor<T, K, Tag>>(y, last, K);
  }
}

/// Variant that the compiler may call instead of inlining it.
template <class Rule, class T, int K, class Tag>
[[nodiscard]] inline taylor<T, K, Tag> lift_by_call(const Rule& rule, const taylor<T, K, Tag>& x) {
  return lift_in_place(rule, x);
}

/// Maximum order for inlining over built-in numbers: there a call, with all coefficients through
/// memory, costs more than its computation.
inline constexpr int in_place_order = 3;

/// The further coefficients of s and c, s′ = c x′ and c′ = Sign s x′.
template <int Sign, class T, int K, class Tag>
inline void extend_pair(const taylor<T, K, Tag>& x, taylor<T, K, Tag>& s, taylor<T, K, Tag>& c) {
  with_surviving_products(T(s.value() + c.value()), [&](const auto& product) DUET_INLINE_LAMBDA {
    unrolled<K>([&](int i) DUET_INLINE_LAMBDA {
      const int k = i + 1;
      T ds(0);
      T dc(0);
      unrolled<K>([&](int m) DUET_INLINE_LAMBDA {
        const int j = m + 1;
        if (j <= k) {
          const T jx = x.coefficient(j) * integer<T>(j);
          ds = ds + product(c.coefficient(k - j), jx);
          dc = dc + product(s.coefficient(k - j), jx);
        }
      });
      s.set_coefficient(k, divided_by_order(ds, k));
      c.set_coefficient(k, divided_by_order(T(dc * integer<T>(Sign)), k));
    });
  });
}

/// Variant for several arguments.
template <class Rule, class T, int K, class Tag, class... Rest>
[[nodiscard]] inline taylor<T, K, Tag> lift_by_call(const Rule& rule, const taylor<T, K, Tag>& x,
                                                    const taylor<T, K, Tag>& y,
                                                    const Rest&... rest) {
  const auto z = [&] {
    if constexpr (K == 1) {
      return rule.value(x.value(), y.value(), rest.value()...);
    } else {
      return lift(rule, truncated<K - 1>(x), truncated<K - 1>(y), truncated<K - 1>(rest)...);
    }
  }();
  const auto slopes =
      rule.slopes(z, truncated<K - 1>(x), truncated<K - 1>(y), truncated<K - 1>(rest)...);
  T last = chain_coefficient(x, slopes[0]) + chain_coefficient(y, slopes[1]);
  if constexpr (sizeof...(rest) > 0) {
    static_assert(sizeof...(rest) == 1);
    last = last + (chain_coefficient(rest, slopes[2]) + ...);
  }
  return extended<taylor<T, K, Tag>>(z, divided_by_order(last, K), K);
}

} // namespace detail

DUET_ABI_BEGIN

/// A truncated Taylor series x₀ + x₁ε + … + x_K ε^K: a value and its first K derivatives.
///
/// \tparam T    the scalar below
/// \tparam K    highest power of ε kept
/// \tparam Tag  meaning of the ε
///
/// Coefficients are the Taylor coefficients x_k = x^(k)/k!; `derivative(k)` multiplies by k!.
template <class T, int K, class Tag = derivative_tag<>>
class taylor : public detail::infinitesimal_operators<taylor<T, K, Tag>, T> {
  static_assert(Scalar<T>,
                "duet: taylor<T, K> needs a real number, one of an opted-in field (field_traits), "
                "or a scalar of duet as T");
  static_assert(K >= 1, "duet: taylor<T, K> needs at least the first power");
  static_assert(
      !detail::contains_tag<T, Tag>(),
      "duet: this differentiation happens inside another one with the same tag, and their "
      "infinitesimals could not be distinguished; give it a separate tag: "
      "derivatives<K, struct my_tag>(f, x)");

public:
  using value_type = T;
  using coefficients_type = std::array<T, std::size_t(K) + 1>;

  /// Zero.
  constexpr taylor() : coefficients_{} {}
  /// A constant.
  template <ConstantOf<taylor> U>
  DUET_ALWAYS_INLINE constexpr taylor(const U& constant)
      : coefficients_{static_cast<T>(constant)} {}
  DUET_ALWAYS_INLINE constexpr explicit taylor(const coefficients_type& coefficients)
      : coefficients_(coefficients) {}
  /// Conversion from another scalar; implicit if no precision or level is lost.
  template <class U>
    requires(!std::same_as<U, T> && std::constructible_from<T, U>)
  constexpr explicit(!std::convertible_to<U, T> || !std::same_as<promote_t<T, U>, T>)
      taylor(const taylor<U, K, Tag>& other)
      : taylor(other.zip([](const U& x) { return static_cast<T>(x); })) {}

  /// value + ε, the variable of differentiation.
  [[nodiscard]] static constexpr taylor variable(const T& value) {
    taylor result(value);
    result.coefficients_[1] = T(1);
    return result;
  }

  /// x₀
  [[nodiscard]] constexpr const T& value() const { return coefficients_[0]; }
  /// x_k
  [[nodiscard]] constexpr const T& coefficient(int k) const {
    return coefficients_[std::size_t(k)];
  }
  /// Sets x_k.
  constexpr void set_coefficient(int k, const T& x) { coefficients_[std::size_t(k)] = x; }
  /// The k-th derivative, k! x_k.
  [[nodiscard]] constexpr T derivative(int k) const {
    T result = coefficient(k);
    for (int i = 2; i <= k; ++i) {
      result = result * detail::integer<T>(i);
    }
    return result;
  }

  // For those who extend duet: the members that `Level` requires.

  static constexpr int part_count = K + 1;
  /// The k-th derivative.
  [[nodiscard]] constexpr T part(int k) const { return derivative(k); }
  /// Number with another value and the same derivatives.
  [[nodiscard]] constexpr taylor with_value(const T& value) const {
    taylor result = *this;
    result.coefficients_[0] = value;
    return result;
  }
  /// f of every coefficient: the same level over the result type of f.
  template <class F, class... Series>
  [[nodiscard]] DUET_ALWAYS_INLINE constexpr auto zip(F&& f, const Series&... other) const {
    using U = std::remove_cvref_t<decltype(f(value(), other.value()...))>;
    taylor<U, K, Tag> result;
    for (int k = 0; k <= K; ++k) {
      result.set_coefficient(k, f(coefficient(k), other.coefficient(k)...));
    }
    return result;
  }
  /// slope · x, where zero parts stay zero even if slopes are not finite.
  [[nodiscard]] static constexpr taylor zero_preserving_product(const taylor& slope,
                                                                const taylor& x) {
    taylor result;
    for (int k = 0; k <= K; ++k) {
      T sum = detail::guarded_product(slope.value(), x.coefficient(k));
      for (int j = 1; j <= k; ++j) {
        sum = sum + detail::product_of_partial(slope.coefficient(j), x.coefficient(k - j));
      }
      result.coefficients_[std::size_t(k)] = sum;
    }
    return result;
  }
  /// The function of a rule, see rules/elementary.hpp and `lift_in_place`.
  template <class Rule, class... Series>
  [[nodiscard]] DUET_ALWAYS_INLINE static taylor lift(const Rule& rule, const taylor& x,
                                                      const Series&... rest) {
    if constexpr (std::floating_point<T> && K <= detail::in_place_order && sizeof...(rest) == 0) {
      return detail::lift_in_place(rule, x);
    } else {
      return detail::lift_by_call(rule, x, rest...);
    }
  }
  /// Sine and cosine of x from those of its value, circular (Sign −1) or hyperbolic (1), by one
  /// recurrence: applying their rules separately would evaluate the pair at every order.
  template <int Sign>
  [[nodiscard]] DUET_ALWAYS_INLINE static detail::sine_cosine<taylor>
  lift_pair(const detail::sine_cosine<T>& y, const taylor& x) {
    detail::sine_cosine<taylor> result{taylor(y.sine), taylor(y.cosine)};
    detail::extend_pair<Sign>(x, result.sine, result.cosine);
    return result;
  }
  /// Writes (x0 + x1 e + x2 e^2 + …).
  template <class Out>
  void write(Out& out) const {
    out << "(" << value();
    for (int k = 1; k <= K; ++k) {
      out << " + " << coefficient(k) << " e";
      if (k > 1) {
        out << "^" << k;
      }
    }
    out << ")";
  }
  /// True if the predicate holds for every coefficient.
  template <class Predicate>
  [[nodiscard]] constexpr auto all_of(Predicate&& predicate) const {
    auto result = predicate(value());
    for (int k = 1; k <= K; ++k) {
      result = result && predicate(coefficient(k));
    }
    return result;
  }

  /// Rejects mixing the ε of a rigid motion with the ε of a derivative.
  template <detail::OtherKindOfEpsilon<taylor> U>
  taylor(const U&, detail::epsilon_of_a_rigid_motion_is_not_that_of_a_derivative = {}) = delete;

  // The kernels behind the operators of detail::infinitesimal_operators. `each` calls them with
  // indices that are constants after inlining, which keeps coefficients in registers.

  [[nodiscard]] DUET_ALWAYS_INLINE constexpr taylor negated() const {
    return each([&](int k) DUET_INLINE_LAMBDA { return T(-coefficient(k)); });
  }
  template <class C>
  [[nodiscard]] DUET_ALWAYS_INLINE constexpr taylor plus(const C& c) const {
    taylor result = *this;
    result.coefficients_[0] = coefficients_[0] + c;
    return result;
  }
  template <class C>
  [[nodiscard]] DUET_ALWAYS_INLINE constexpr taylor times(const C& c) const {
    return each([&](int k) DUET_INLINE_LAMBDA { return T(coefficient(k) * c); });
  }
  template <class C>
  [[nodiscard]] DUET_ALWAYS_INLINE constexpr taylor divided_by(const C& c) const {
    if constexpr (Infinitesimal<T> && !Infinitesimal<C>) {
      // As a T its inverse would multiply infinite coefficients by zeros.
      const C inverse = C(1) / c;
      if (all(detail::is_all_finite(inverse))) {
        taylor result = times(inverse);
        result.coefficients_[0] = coefficients_[0] / c;
        return result;
      }
    }
    const T inverse = T(1) / c;
    taylor result = each([&](int k) DUET_INLINE_LAMBDA {
      return detail::zero_preserving_product(inverse, coefficient(k));
    });
    result.coefficients_[0] = coefficients_[0] / c;
    return result;
  }
  /// c / *this
  [[nodiscard]] DUET_ALWAYS_INLINE constexpr taylor dividing(const T& c) const {
    return quotient(taylor(coefficients_type{c}), *this);
  }
  [[nodiscard]] DUET_ALWAYS_INLINE static constexpr taylor sum(const taylor& a, const taylor& b) {
    return each([&](int k) DUET_INLINE_LAMBDA { return T(a.coefficient(k) + b.coefficient(k)); });
  }
  [[nodiscard]] DUET_ALWAYS_INLINE static constexpr taylor difference(const taylor& a,
                                                                      const taylor& b) {
    return each([&](int k) DUET_INLINE_LAMBDA { return T(a.coefficient(k) - b.coefficient(k)); });
  }
  /// c_k = Σ_j a_j b_{k−j}
  [[nodiscard]] DUET_ALWAYS_INLINE static constexpr taylor product(const taylor& a,
                                                                   const taylor& b) {
    return [&]<int... I>(std::integer_sequence<int, I...>) DUET_INLINE_LAMBDA {
      return taylor(coefficients_type{product_coefficient<I>(a, b)...});
    }
    (std::make_integer_sequence<int, K + 1>{});
  }
  /// q_k = (a_k − Σ_{j≥1} b_j q_{k−j}) / b_0
  [[nodiscard]] DUET_ALWAYS_INLINE static constexpr taylor quotient(const taylor& a,
                                                                    const taylor& b) {
    const T inverse = T(1) / b.value();
    const T first = a.value() / b.value();
    const T probe = inverse + first;
    return detail::with_surviving_products(probe, [&](const auto& product) DUET_INLINE_LAMBDA {
      taylor result(coefficients_type{first});
      detail::unrolled<K>([&](int i) DUET_INLINE_LAMBDA {
        const int k = i + 1;
        T remainder = a.coefficient(k);
        detail::unrolled<K>([&](int j) DUET_INLINE_LAMBDA {
          if (j < k) {
            remainder = remainder - product(result.coefficient(k - j - 1), b.coefficient(j + 1));
          }
        });
        result.set_coefficient(k, product(inverse, remainder));
      });
      return result;
    });
  }

private:
  template <class F>
  [[nodiscard]] DUET_ALWAYS_INLINE static constexpr taylor each(F&& f) {
    return [&]<int... I>(std::integer_sequence<int, I...>) DUET_INLINE_LAMBDA {
      return taylor(coefficients_type{f(I)...});
    }
    (std::make_integer_sequence<int, K + 1>{});
  }

  template <int Power>
  [[nodiscard]] DUET_ALWAYS_INLINE static constexpr T product_coefficient(const taylor& a,
                                                                          const taylor& b) {
    return [&]<int... J>(std::integer_sequence<int, J...>) DUET_INLINE_LAMBDA {
      T sum = a.coefficient(0) * b.coefficient(Power);
      ((sum = sum + a.coefficient(J + 1) * b.coefficient(Power - J - 1)), ...);
      return sum;
    }
    (std::make_integer_sequence<int, Power>{});
  }

  coefficients_type coefficients_;
};

DUET_ABI_END

template <class T, int K, class Tag>
struct scalar_traits<taylor<T, K, Tag>> : detail::level_traits<T, Tag, K> {
  template <class U>
  using over = taylor<U, K, Tag>;
};

} // namespace duet
