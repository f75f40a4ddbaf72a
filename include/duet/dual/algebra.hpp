// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual/promotion.hpp>

#include <concepts>
#include <type_traits>

/// \file
/// The operators of infinitesimal numbers, written once for `dual` and `taylor`.

namespace duet::detail {

/// Base of an infinitesimal number D over T, which supplies the kernels: `sum`, `difference`,
/// `product`, `quotient` of two D, and `negated`, `plus`, `times`, `divided_by`, `dividing` with a
/// constant of type T.
template <class D, class T>
struct infinitesimal_operators {
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator+(const D& a) { return a; }
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator-(const D& a) { return a.negated(); }

  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator+(const D& a, const D& b) {
    return D::sum(a, b);
  }
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator-(const D& a, const D& b) {
    return D::difference(a, b);
  }
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator*(const D& a, const D& b) {
    return D::product(a, b);
  }
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator/(const D& a, const D& b) {
    return D::quotient(a, b);
  }

  // A constant meets a number without being widened to one, which would multiply by zeros.
  template <ConstantOf<D> U>
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator+(const D& a, const U& b) {
    return a.plus(static_cast<T>(b));
  }
  template <ConstantOf<D> U>
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator+(const U& a, const D& b) {
    return b.plus(static_cast<T>(a));
  }
  template <ConstantOf<D> U>
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator-(const D& a, const U& b) {
    return a.plus(T(-static_cast<T>(b)));
  }
  template <ConstantOf<D> U>
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator-(const U& a, const D& b) {
    return b.negated().plus(static_cast<T>(a));
  }
  template <ConstantOf<D> U>
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator*(const D& a, const U& b) {
    return a.times(static_cast<T>(b));
  }
  template <ConstantOf<D> U>
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator*(const U& a, const D& b) {
    return b.times(static_cast<T>(a));
  }
  template <ConstantOf<D> U>
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator/(const D& a, const U& b) {
    return a.divided_by(static_cast<T>(b));
  }
  template <ConstantOf<D> U>
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator/(const U& a, const D& b) {
    return b.dividing(static_cast<T>(a));
  }

  template <std::convertible_to<D> U>
  friend DUET_ALWAYS_INLINE constexpr D& operator+=(D& a, const U& b) {
    return a = a + b;
  }
  template <std::convertible_to<D> U>
  friend DUET_ALWAYS_INLINE constexpr D& operator-=(D& a, const U& b) {
    return a = a - b;
  }
  template <std::convertible_to<D> U>
  friend DUET_ALWAYS_INLINE constexpr D& operator*=(D& a, const U& b) {
    return a = a * b;
  }
  template <std::convertible_to<D> U>
  friend DUET_ALWAYS_INLINE constexpr D& operator/=(D& a, const U& b) {
    return a = a / b;
  }
  friend DUET_ALWAYS_INLINE constexpr void swap(D& a, D& b) {
    const D c = a;
    a = b;
    b = c;
  }
  friend constexpr D& operator++(D& a) { return a = a.plus(T(1)); }
  friend constexpr D& operator--(D& a) { return a = a.plus(T(-1)); }
  friend constexpr D operator++(D& a, int) {
    const D before = a;
    ++a;
    return before;
  }
  friend constexpr D operator--(D& a, int) {
    const D before = a;
    --a;
    return before;
  }
};

/// At least one of the two is infinitesimal, and they can meet.
template <class A, class B>
concept MixedScalars = (Infinitesimal<A> || Infinitesimal<B>)&&(Scalar<A> || Arithmetic<A>)&&(
    Scalar<B> || Arithmetic<B>)&&Promotable<A, B>;

/// Neither is a constant for the other: both must be brought to their common nesting first.
template <class A, class B>
concept DifferentNestings = (Infinitesimal<A> || Infinitesimal<B>)&&Scalar<A>&& Scalar<B> &&
                            !std::is_same_v<A, B> && Promotable<A, B> && !ConstantOf<A, B> &&
                            !ConstantOf<B, A>;

} // namespace duet::detail

namespace duet {
// Comparisons look at values only, as an `if` in the differentiated function should.
template <class A, class B>
  requires detail::MixedScalars<A, B>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator==(const A& a, const B& b) {
  return innermost(a) == innermost(b);
}
template <class A, class B>
  requires detail::MixedScalars<A, B>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator!=(const A& a, const B& b) {
  return innermost(a) != innermost(b);
}
template <class A, class B>
  requires detail::MixedScalars<A, B>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator<(const A& a, const B& b) {
  return innermost(a) < innermost(b);
}
template <class A, class B>
  requires detail::MixedScalars<A, B>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator<=(const A& a, const B& b) {
  return innermost(a) <= innermost(b);
}
template <class A, class B>
  requires detail::MixedScalars<A, B>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator>(const A& a, const B& b) {
  return innermost(a) > innermost(b);
}
template <class A, class B>
  requires detail::MixedScalars<A, B>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator>=(const A& a, const B& b) {
  return innermost(a) >= innermost(b);
}

template <class A, class B>
  requires detail::DifferentNestings<A, B>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator+(const A& a, const B& b) {
  using common = promote_t<A, B>;
  return static_cast<common>(a) + static_cast<common>(b);
}
template <class A, class B>
  requires detail::DifferentNestings<A, B>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator-(const A& a, const B& b) {
  using common = promote_t<A, B>;
  return static_cast<common>(a) - static_cast<common>(b);
}
template <class A, class B>
  requires detail::DifferentNestings<A, B>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator*(const A& a, const B& b) {
  using common = promote_t<A, B>;
  return static_cast<common>(a) * static_cast<common>(b);
}
template <class A, class B>
  requires detail::DifferentNestings<A, B>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator/(const A& a, const B& b) {
  using common = promote_t<A, B>;
  return static_cast<common>(a) / static_cast<common>(b);
}

} // namespace duet

namespace std {

template <class A, class B>
  requires duet::detail::MixedScalars<A, B>
struct common_type<A, B> {
  using type = duet::promote_t<A, B>;
};

} // namespace std
