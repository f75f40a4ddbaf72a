// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual/algebra.hpp>
#include <duet/dual/level.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual/rules/taylor_lift.hpp>
#include <duet/dual/storage/partials.hpp>
#include <duet/dual/storage/structural_zero.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>

/// \file
/// Truncated Taylor series x₀ + x₁ε + … + x_K ε^K, ε^{K+1} = 0: a value and its first K derivatives
/// along one direction, in one pass.

namespace duet {
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
  /// The function of a rule, see rules/elementary.hpp and rules/taylor_lift.hpp.
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
