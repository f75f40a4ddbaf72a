// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual/level.hpp>
#include <duet/dual/partials.hpp>
#include <duet/dual/promotion.hpp>

#include <algorithm>
#include <concepts>
#include <type_traits>

/// \file
/// Dual numbers `a + ε₁b₁ + … + ε_N b_N`, εᵢεⱼ = 0, and their algebra (N10, N11).

namespace duet {
DUET_ABI_BEGIN

/// A number with N first-order infinitesimal parts.
///
/// A plain value type: nothing is lazy, so `auto`, `?:` and lambdas behave as with double. The
/// value part of every operation is the result of T alone. Arithmetic types and scalars below
/// convert implicitly; so do duals that one nesting of levels can hold.
///
/// \tparam T    the scalar below: a number, or another dual or taylor number
/// \tparam N    number of partial derivatives (negative: the capacity of a `dynamic_dual`)
/// \tparam Tag  meaning of the ε: `derivative_tag<F>`, or `screw_tag` for rigid motion
///
/// Example: `auto x = dual<double>::variable(3); (x * x).epsilon() == 6`.
template <class T, int N = 1, class Tag = derivative_tag<>>
class dual : public detail::infinitesimal_operators<dual<T, N, Tag>, T> {
  static_assert(Scalar<T>,
                "duet: dual<T> needs a real number, one of an opted-in field (field_traits), "
                "or a scalar of duet as T");
  static_assert(N != 0, "duet: dual<T, N> needs at least one partial derivative");
  static_assert(
      !detail::contains_tag<T, Tag>(),
      "duet: this differentiation happens inside another one with the same tag, and their "
      "infinitesimals could not be distinguished; give it a separate tag: "
      "derivative<struct my_tag>(f, x)");

public:
  using value_type = T;
  using partials_type = detail::partials<T, N>;

  /// Zero.
  constexpr dual() : value_(T(0)) {}
  /// A constant: its partials are zero.
  template <ConstantOf<dual> U>
  DUET_ALWAYS_INLINE constexpr dual(const U& constant) : value_(static_cast<T>(constant)) {}
  /// value + ε epsilon
  DUET_ALWAYS_INLINE constexpr dual(const T& value, const T& epsilon) requires(N == 1)
      : value_(value) {
    partials_.set(0, epsilon);
  }
  DUET_ALWAYS_INLINE constexpr dual(const T& value, const partials_type& partials)
      : value_(value), partials_(partials) {}
  /// Conversion from a dual over another scalar; implicit if no precision or level is lost.
  template <class U>
    requires(!std::same_as<U, T> && std::constructible_from<T, U>)
  constexpr explicit(!std::convertible_to<U, T> || !std::same_as<promote_t<T, U>, T>)
      dual(const dual<U, N, Tag>& other)
      : dual(other.zip([](const U& x) { return static_cast<T>(x); })) {}

  /// The i-th variable of a function of N: value + εᵢ.
  [[nodiscard]] DUET_ALWAYS_INLINE static constexpr dual variable(const T& value,
                                                                  int i = 0) requires(N > 0) {
    return dual(value, partials_type::unit(i));
  }

  /// The i-th variable of a function of n, if N is a capacity.
  ///
  /// \throws invalid_input if n exceeds the capacity
  [[nodiscard]] static dual variable(const T& value, int i, int n) requires(N < 0) {
    return dual(value, partials_type::unit(i, n));
  }

  /// Number of partials.
  [[nodiscard]] constexpr int size() const { return partials_.size(); }
  /// The part without ε.
  [[nodiscard]] constexpr const T& value() const { return value_; }
  /// Coefficient of εᵢ, i from 0: the i-th partial derivative.
  [[nodiscard]] constexpr T partial(int i) const { return partials_.get(i); }
  /// Coefficient of the only ε: the derivative.
  [[nodiscard]] constexpr T epsilon() const requires(N == 1) { return partials_.get(0); }
  /// Sets the coefficient of εᵢ.
  constexpr void set_partial(int i, const T& x) { partials_.set(i, x); }

  // For those who extend duet: the members that `Level` requires.

  [[nodiscard]] constexpr const partials_type& partials() const { return partials_; }

  static constexpr int part_count = N > 0 ? N + 1 : N - 1;
  /// The value, then the partials.
  [[nodiscard]] constexpr T part(int k) const { return k == 0 ? value_ : partials_.get(k - 1); }
  /// Number with another value and the same partials.
  [[nodiscard]] constexpr dual with_value(const T& value) const { return {value, partials_}; }
  /// f of the values, then of every partial: the same level over the result type of f.
  template <class F, class... Duals>
  [[nodiscard]] DUET_ALWAYS_INLINE constexpr auto zip(F&& f, const Duals&... other) const {
    using U = std::remove_cvref_t<decltype(f(value_, other.value()...))>;
    dual<U, N, Tag> result(f(value_, other.value()...));
    const int count = std::max({size(), other.size()...});
    for (int i = 0; i < count; ++i) {
      result.set_partial(i, f(partial(i), other.partial(i)...));
    }
    return result;
  }
  /// slope · x, where zero parts stay zero even if slopes are not finite.
  [[nodiscard]] static constexpr dual zero_preserving_product(const dual& slope, const dual& x) {
    return {detail::guarded_product(slope.value_, x.value_),
            partials_type::map_elements(
                [&](const T& s, const T& p) {
                  return T(detail::guarded_product(slope.value_, p) +
                           detail::product_of_partial(s, x.value_));
                },
                slope.partials_, x.partials_)};
  }
  /// The function of a rule, see rules/elementary.hpp: f(a + εb) = f(a) + ε f′(a) b.
  template <class Rule>
  [[nodiscard]] DUET_ALWAYS_INLINE static dual lift(const Rule& rule, const dual& x) {
    const T y = rule.value(x.value_);
    return x.composed(y, rule.slope(x.value_, y));
  }
  template <class Rule, class... Rest>
  [[nodiscard]] DUET_ALWAYS_INLINE static dual lift(const Rule& rule, const dual& x, const dual& y,
                                                    const Rest&... rest) {
    const T value = rule.value(x.value_, y.value_, rest.value()...);
    const auto slopes = rule.slopes(value, x.value_, y.value_, rest.value()...);
    auto result = detail::chain(slopes[0], x.partials_, slopes[1], y.partials_);
    if constexpr (sizeof...(rest) > 0) {
      static_assert(sizeof...(rest) == 1);
      result =
          partials_type::map([](const auto& p, const auto& q) DUET_INLINE_LAMBDA { return p + q; },
                             result, detail::chain(slopes[2], rest.partials()...));
    }
    return {value, result};
  }
  /// Sine and cosine of x from those of its value, circular (Sign −1) or hyperbolic (1): each is
  /// the slope of the other, up to the sign.
  template <int Sign>
  [[nodiscard]] DUET_ALWAYS_INLINE static detail::sine_cosine<dual>
  lift_pair(const detail::sine_cosine<T>& y, const dual& x) {
    const T minus = Sign < 0 ? T(-y.sine) : y.sine;
    if constexpr (std::floating_point<T>) {
      // Both are finite or neither; testing their sum lets clang compute both at once.
      const bool is_finite = detail::is_all_finite(T(y.sine + y.cosine));
      return {{y.sine, combined(detail::unary_chain<T>{y.cosine}, is_finite, x.partials_)},
              {y.cosine, combined(detail::unary_chain<T>{minus}, is_finite, x.partials_)}};
    } else {
      return {x.composed(y.sine, y.cosine), x.composed(y.cosine, minus)};
    }
  }
  /// A function of this number, given its value y and its slope. (Further derivatives are for
  /// levels of higher order.)
  template <class... Further>
  [[nodiscard]] DUET_ALWAYS_INLINE constexpr dual composed(const T& y, const T& slope,
                                                           const Further&...) const {
    return {y, detail::chain(slope, partials_)};
  }
  /// Writes value[partial, …].
  template <class Out>
  void write(Out& out) const {
    out << value_ << "[";
    for (int i = 0; i < size(); ++i) {
      out << (i == 0 ? "" : ", ") << partial(i);
    }
    out << "]";
  }
  /// True if the predicate holds for the value and for every partial.
  template <class Predicate>
  [[nodiscard]] DUET_ALWAYS_INLINE constexpr auto all_of(Predicate&& predicate) const {
    auto result = predicate(value_);
    for (int i = 0; i < size(); ++i) {
      result = result && predicate(partials_.get(i));
    }
    return result;
  }

  /// Rejects mixing the ε of a rigid motion with the ε of a derivative, in either direction: nest
  /// one in the other, or take the part you need.
  template <detail::OtherKindOfEpsilon<dual> U>
  dual(const U&, detail::epsilon_of_a_rigid_motion_is_not_that_of_a_derivative = {}) = delete;

  // The kernels behind the operators of detail::infinitesimal_operators.

  [[nodiscard]] DUET_ALWAYS_INLINE constexpr dual negated() const {
    return {T(-value_),
            partials_type::map([](const auto& p) DUET_INLINE_LAMBDA { return -p; }, partials_)};
  }
  template <class C>
  [[nodiscard]] DUET_ALWAYS_INLINE constexpr dual plus(const C& c) const {
    DUET_CONTRACTED
    return {T(value_ + c), partials_};
  }
  template <class C>
  [[nodiscard]] DUET_ALWAYS_INLINE constexpr dual times(const C& c) const {
    DUET_CONTRACTED
    return {T(value_ * c),
            partials_type::map([&](const auto& p) DUET_INLINE_LAMBDA { return p * c; }, partials_)};
  }
  template <class C>
  [[nodiscard]] DUET_ALWAYS_INLINE constexpr dual divided_by(const C& c) const {
    if constexpr (Infinitesimal<T> && !Infinitesimal<C>) {
      // As a T its inverse would multiply infinite partials by zeros.
      const C inverse = C(1) / c;
      if (all(detail::is_all_finite(inverse))) {
        return {T(value_ / c),
                partials_type::map([&](const auto& p) DUET_INLINE_LAMBDA { return p * inverse; },
                                   partials_)};
      }
    }
    return {T(value_ / c), detail::chain(T(T(1) / c), partials_)};
  }
  /// c / *this
  [[nodiscard]] DUET_ALWAYS_INLINE constexpr dual dividing(const T& c) const {
    if constexpr (Infinitesimal<T>) { // zero partials of T survive in quotients only
      const T value = c / value_;
      return {value, detail::chain(T(-(value / value_)), partials_)};
    } else {
      const T inverse = T(1) / value_;
      return {T(c / value_), detail::chain(T(-(c * inverse) * inverse), partials_)};
    }
  }
  [[nodiscard]] DUET_ALWAYS_INLINE static constexpr dual sum(const dual& a, const dual& b) {
    DUET_CONTRACTED
    return {T(a.value_ + b.value_), partials_type::map([](const auto& p, const auto& q)
                                                           DUET_INLINE_LAMBDA { return p + q; },
                                                       a.partials_, b.partials_)};
  }
  [[nodiscard]] DUET_ALWAYS_INLINE static constexpr dual difference(const dual& a, const dual& b) {
    DUET_CONTRACTED
    return {T(a.value_ - b.value_), partials_type::map([](const auto& p, const auto& q)
                                                           DUET_INLINE_LAMBDA { return p - q; },
                                                       a.partials_, b.partials_)};
  }
  /// N10: (a₁ + εb₁)(a₂ + εb₂) = a₁a₂ + ε(a₁b₂ + b₁a₂)
  [[nodiscard]] DUET_ALWAYS_INLINE static constexpr dual product(const dual& a, const dual& b) {
    const T value = [&]() DUET_INLINE_LAMBDA {
      DUET_CONTRACTED
      return T(a.value_ * b.value_);
    }();
    // One expression, which is fused in any case: split in two, clang leaves loops rolled.
    return {value,
            partials_type::map([&](const auto& p, const auto& q)
                                   DUET_INLINE_LAMBDA { return p * b.value_ + q * a.value_; },
                               a.partials_, b.partials_)};
  }
  /// N11: (a₁ + εb₁)/(a₂ + εb₂) = a₁/a₂ + ε(b₁ − (a₁/a₂)b₂)/a₂
  [[nodiscard]] DUET_ALWAYS_INLINE static constexpr dual quotient(const dual& a, const dual& b) {
    // The derivative uses the inverse, so that it need not wait for the exact quotient.
    const T inverse = T(1) / b.value_;
    if constexpr (Infinitesimal<T>) { // zero partials of T survive in quotients only
      const T value = a.value_ / b.value_;
      const detail::quotient_chain<T> kernel{value, inverse};
      return {value, detail::combined(kernel, kernel.is_finite(), a.partials_, b.partials_)};
    } else {
      const detail::quotient_chain<T> kernel{T(a.value_ * inverse), inverse};
      return {T(a.value_ / b.value_),
              detail::combined(kernel, kernel.is_finite(), a.partials_, b.partials_)};
    }
  }

private:
  T value_;
  partials_type partials_;
};

DUET_ABI_END

template <class T, int N, class Tag>
struct scalar_traits<dual<T, N, Tag>> : detail::level_traits<T, Tag, 1> {
  template <class U>
  using over = dual<U, N, Tag>;
};

} // namespace duet
