// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual/algebra.hpp>
#include <duet/dual/partials.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual/structural_zero.hpp>
#include <duet/dual/tag.hpp>

#include <concepts>
#include <type_traits>

/// \file
/// Dual numbers `a + ε₁b₁ + … + ε_N b_N`, εᵢεⱼ = 0, and their algebra (N10, N11).

namespace duet {
DUET_ABI_BEGIN

/// A number with N first-order infinitesimal parts.
///
/// \tparam T    the scalar below: a number, or another dual or taylor number
/// \tparam N    number of partial derivatives (negative: the capacity of a `dynamic_dual`)
/// \tparam Tag  what the ε means: `derivative_tag<F>`, or `screw_tag` for rigid motion
///
/// A plain value type: nothing is lazy, so `auto`, `?:` and lambdas behave as with double. The
/// value part of every operation is what T alone would give. Arithmetic types and scalars below
/// convert implicitly; so do duals that one nesting of levels can hold.
///
/// Example: `auto x = dual<double>::variable(3); (x * x).epsilon() == 6`.
template <class T, int N = 1, class Tag = derivative_tag<>>
class dual : detail::infinitesimal_operators<dual<T, N, Tag>, T> {
  static_assert(Scalar<T>,
                "duet: dual<T> needs a real number, one of an opted-in field (field_traits), "
                "or a scalar of duet as T");
  static_assert(N != 0, "duet: dual<T, N> needs at least one partial derivative");
  static_assert(
      !detail::contains_tag<T, Tag>(),
      "duet: this differentiation happens inside another one with the same tag, and their "
      "infinitesimals could not be told apart; give it its own: "
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
  /// This number with another scalar inside; implicit where no precision or level is lost.
  template <class U>
    requires(!std::same_as<U, T> && std::constructible_from<T, U>)
  constexpr explicit(!std::convertible_to<U, T> || !std::same_as<promote_t<T, U>, T>)
      dual(const dual<U, N, Tag>& other)
      : value_(static_cast<T>(other.value())) {
    for (int i = 0; i < other.size(); ++i) {
      partials_.set(i, static_cast<T>(other.partial(i)));
    }
  }

  /// The i-th variable of a function of N: value + εᵢ.
  [[nodiscard]] DUET_ALWAYS_INLINE static constexpr dual variable(const T& value,
                                                                  int i = 0) requires(N > 0) {
    if constexpr (requires { partials_type::unit(i); }) {
      return dual(value, partials_type::unit(i));
    } else {
      dual result(value);
      result.partials_.set(i, T(1));
      return result;
    }
  }

  /// The i-th variable of a function of n, where N is a capacity.
  /// \throws invalid_input for n beyond it
  [[nodiscard]] static dual variable(const T& value, int i, int n) requires(N < 0) {
    return dual(value, partials_type::unit(i, n));
  }

  /// Number of partials.
  [[nodiscard]] constexpr int size() const {
    if constexpr (N > 0) {
      return N;
    } else {
      return partials_.size();
    }
  }
  [[nodiscard]] constexpr const T& value() const { return value_; }
  [[nodiscard]] constexpr T partial(int i) const { return partials_.get(i); }
  [[nodiscard]] constexpr T epsilon() const requires(N == 1) { return partials_.get(0); }
  [[nodiscard]] constexpr const partials_type& partials() const { return partials_; }
  constexpr void set_partial(int i, const T& x) { partials_.set(i, x); }

  /// Does the predicate hold for the value and for every partial?
  template <class Predicate>
  [[nodiscard]] DUET_ALWAYS_INLINE constexpr auto all_of(Predicate&& predicate) const {
    auto result = predicate(value_);
    for (int i = 0; i < size(); ++i) {
      result = result && predicate(partials_.get(i));
    }
    return result;
  }

  /// Drops the derivatives; explicit for that reason.
  template <Arithmetic U>
    requires std::constructible_from<U, T>
  [[nodiscard]] constexpr explicit operator U() const { return static_cast<U>(value_); }

  /// The ε of a rigid motion is not the ε of a derivative, whichever way: put one inside the other,
  /// or take the part you mean.
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
    // One expression, which is fused in any case: said as two, clang leaves loops rolled.
    return {value,
            partials_type::map([&](const auto& p, const auto& q)
                                   DUET_INLINE_LAMBDA { return p * b.value_ + q * a.value_; },
                               a.partials_, b.partials_)};
  }
  /// N11: (a₁ + εb₁)/(a₂ + εb₂) = a₁/a₂ + ε(b₁ − (a₁/a₂)b₂)/a₂
  [[nodiscard]] DUET_ALWAYS_INLINE static constexpr dual quotient(const dual& a, const dual& b) {
    // The derivative goes through the inverse, so that it need not wait for the exact quotient.
    const T inverse = T(1) / b.value_;
    if constexpr (Infinitesimal<T>) { // zero partials of T survive in quotients only
      const T value = a.value_ / b.value_;
      const detail::chain_of_quotient<T> kernel{value, inverse};
      return {value, detail::combined(kernel, kernel.is_finite(), a.partials_, b.partials_)};
    } else {
      const detail::chain_of_quotient<T> kernel{T(a.value_ * inverse), inverse};
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
struct scalar_traits<dual<T, N, Tag>> {
  using value_type = T;
  using real_type = typename scalar_traits<T>::real_type;
  static constexpr bool is_infinitesimal = true;
  static constexpr int order = scalar_traits<T>::order + 1;
};

template <class T, int N, class Tag>
struct level_traits<dual<T, N, Tag>> {
  using tag = Tag;
  template <class U>
  using rebind = dual<U, N, Tag>;
};

} // namespace duet
