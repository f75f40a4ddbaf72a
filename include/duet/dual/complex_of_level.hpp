// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/lanes.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual/algebra.hpp>
#include <duet/dual/promotion.hpp>

#include <complex>
#include <concepts>
#include <type_traits>

/// \file
/// `std::complex` over numbers with derivatives: the class and its operators.
///
/// Products and quotients are those of the other nesting, a + εb of complex a and b. (The standard
/// library's quotient by |z|² would overflow, or branch on values.)

namespace duet {

/// Complex numbers of built-in precision, and `std::complex` over other reals.
template <Real T>
  requires(!lane_traits<T>::is_batch)
struct field_traits<std::complex<T>> {
  static constexpr bool is_field = true;
  using constant_type = T;
};

namespace detail {

/// D over the complex numbers, from a complex number over D.
template <class D>
[[nodiscard]] auto level_of_complex(const D& real, const D& imaginary) {
  if constexpr (Infinitesimal<D>) {
    return real.zip([](const auto& x, const auto& y) { return level_of_complex(x, y); }, imaginary);
  } else {
    return std::complex<D>(real, imaginary);
  }
}
template <class T>
[[nodiscard]] auto level_of_complex(const std::complex<T>& z) {
  return level_of_complex(z.real(), z.imag());
}

/// The real part of every part of x, or the imaginary part if `Part` is 1.
template <int Part, class X>
[[nodiscard]] auto part_of_complex(const X& x) {
  if constexpr (Infinitesimal<X>) {
    return x.zip([](const auto& below) { return part_of_complex<Part>(below); });
  } else {
    return Part == 0 ? x.real() : x.imag();
  }
}

/// A complex number over D, from D over the complex numbers.
template <class X>
[[nodiscard]] auto complex_of_level(const X& x) {
  const auto real = part_of_complex<0>(x);
  return std::complex<std::remove_const_t<decltype(real)>>(real, part_of_complex<1>(x));
}

/// An analytic function of complex numbers over D.
template <class F, class... D>
[[nodiscard]] auto analytic(const F& f, const std::complex<D>&... z) {
  return by_lane([&](const auto&... w) { return complex_of_level(f(level_of_complex(w)...)); },
                 z...);
}

/// U is a real number that meets D, but is not a D; or at least one of the two is over numbers with
/// derivatives.
template <class U, class D>
concept OtherReal = !std::same_as<U, D> && MixedReals<U, D>;

} // namespace detail
} // namespace duet

/// A complex number over numbers with derivatives: its parts.
template <duet::Infinitesimal D>
class std::complex<D> {
  static_assert(duet::Real<duet::real_type_t<D>>,
                "duet: std::complex<D> needs real numbers with derivatives as D; those of complex "
                "numbers, as dual<std::complex<double>>, are complex themselves");

public:
  using value_type = D;

  constexpr complex(const D& real = D(), const D& imaginary = D())
      : real_(real), imaginary_(imaginary) {}
  /// Conversion from other parts; implicit if no precision or level is lost.
  template <class U>
    requires(!std::same_as<U, D> && std::constructible_from<D, U>)
  constexpr explicit(!std::convertible_to<U, D>) complex(const complex<U>& other)
      : real_(static_cast<D>(other.real())), imaginary_(static_cast<D>(other.imag())) {}

  [[nodiscard]] constexpr D real() const { return real_; }
  [[nodiscard]] constexpr D imag() const { return imaginary_; }
  constexpr void real(const D& x) { real_ = x; }
  constexpr void imag(const D& x) { imaginary_ = x; }

  template <std::convertible_to<D> U>
  constexpr complex& operator=(const U& x) {
    return *this = complex(D(x));
  }
  template <std::convertible_to<D> U>
  constexpr complex& operator+=(const U& x) {
    real_ += x;
    return *this;
  }
  template <std::convertible_to<D> U>
  constexpr complex& operator-=(const U& x) {
    real_ -= x;
    return *this;
  }
  template <std::convertible_to<D> U>
  constexpr complex& operator*=(const U& x) {
    const D factor(x);
    real_ *= factor;
    imaginary_ *= factor;
    return *this;
  }
  template <std::convertible_to<D> U>
  constexpr complex& operator/=(const U& x) {
    const D divisor(x);
    real_ /= divisor;
    imaginary_ /= divisor;
    return *this;
  }
  template <std::convertible_to<D> U>
  constexpr complex& operator+=(const complex<U>& z) {
    real_ += z.real();
    imaginary_ += z.imag();
    return *this;
  }
  template <std::convertible_to<D> U>
  constexpr complex& operator-=(const complex<U>& z) {
    real_ -= z.real();
    imaginary_ -= z.imag();
    return *this;
  }
  template <std::convertible_to<D> U>
  complex& operator*=(const complex<U>& z) {
    return *this = *this * z;
  }
  template <std::convertible_to<D> U>
  complex& operator/=(const complex<U>& z) {
    return *this = *this / z;
  }

private:
  D real_;
  D imaginary_;
};

namespace duet {

template <Infinitesimal D>
[[nodiscard]] std::complex<D> operator*(const std::complex<D>& z, const std::complex<D>& w) {
  return detail::analytic([](const auto& a, const auto& b) { return a * b; }, z, w);
}
template <Infinitesimal D>
[[nodiscard]] std::complex<D> operator/(const std::complex<D>& z, const std::complex<D>& w) {
  return detail::analytic([](const auto& a, const auto& b) { return a / b; }, z, w);
}

// With a real number of another type: a constant, or a number with further derivatives.

template <Infinitesimal D, detail::OtherReal<D> U>
[[nodiscard]] auto operator+(const std::complex<D>& z, const U& x) {
  return std::complex<promote_t<D, U>>(z.real() + x, promote_t<D, U>(z.imag()));
}
template <Infinitesimal D, detail::OtherReal<D> U>
[[nodiscard]] auto operator+(const U& x, const std::complex<D>& z) {
  return z + x;
}
template <Infinitesimal D, detail::OtherReal<D> U>
[[nodiscard]] auto operator-(const std::complex<D>& z, const U& x) {
  return std::complex<promote_t<D, U>>(z.real() - x, promote_t<D, U>(z.imag()));
}
template <Infinitesimal D, detail::OtherReal<D> U>
[[nodiscard]] auto operator-(const U& x, const std::complex<D>& z) {
  return std::complex<promote_t<D, U>>(x - z.real(), promote_t<D, U>(-z.imag()));
}
template <Infinitesimal D, detail::OtherReal<D> U>
[[nodiscard]] auto operator*(const std::complex<D>& z, const U& x) {
  return std::complex<promote_t<D, U>>(z.real() * x, z.imag() * x);
}
template <Infinitesimal D, detail::OtherReal<D> U>
[[nodiscard]] auto operator*(const U& x, const std::complex<D>& z) {
  return z * x;
}
template <Infinitesimal D, detail::OtherReal<D> U>
[[nodiscard]] auto operator/(const std::complex<D>& z, const U& x) {
  return std::complex<promote_t<D, U>>(z.real() / x, z.imag() / x);
}
template <Infinitesimal D, detail::OtherReal<D> U>
[[nodiscard]] auto operator/(const U& x, const std::complex<D>& z) {
  using common = promote_t<D, U>;
  return std::complex<common>(common(x)) / std::complex<common>(z);
}
template <Infinitesimal D, detail::OtherReal<D> U>
[[nodiscard]] auto operator==(const std::complex<D>& z, const U& x) {
  return z.real() == x && z.imag() == 0;
}
template <Infinitesimal D, detail::OtherReal<D> U>
[[nodiscard]] auto operator!=(const std::complex<D>& z, const U& x) {
  return !(z == x);
}

// Operands of two types, one of them perhaps without derivatives.

template <class A, detail::OtherReal<A> B>
[[nodiscard]] auto operator+(const std::complex<A>& z, const std::complex<B>& w) {
  return std::complex<promote_t<A, B>>(z.real() + w.real(), z.imag() + w.imag());
}
template <class A, detail::OtherReal<A> B>
[[nodiscard]] auto operator-(const std::complex<A>& z, const std::complex<B>& w) {
  return std::complex<promote_t<A, B>>(z.real() - w.real(), z.imag() - w.imag());
}
template <class A, detail::OtherReal<A> B>
[[nodiscard]] auto operator*(const std::complex<A>& z, const std::complex<B>& w) {
  return detail::analytic([](const auto& a, const auto& b) { return a * b; }, z, w);
}
template <class A, detail::OtherReal<A> B>
[[nodiscard]] auto operator/(const std::complex<A>& z, const std::complex<B>& w) {
  return detail::analytic([](const auto& a, const auto& b) { return a / b; }, z, w);
}
template <class A, detail::OtherReal<A> B>
[[nodiscard]] auto operator==(const std::complex<A>& z, const std::complex<B>& w) {
  return z.real() == w.real() && z.imag() == w.imag();
}
template <class A, detail::OtherReal<A> B>
[[nodiscard]] auto operator!=(const std::complex<A>& z, const std::complex<B>& w) {
  return !(z == w);
}

} // namespace duet
