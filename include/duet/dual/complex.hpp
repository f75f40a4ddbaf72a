// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/batch.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual/level.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual/rules/functions.hpp>
#include <duet/dual/taylor.hpp>

#include <cmath>
#include <complex>
#include <concepts>
#include <limits>
#include <type_traits>

/// \file
/// Complex numbers and derivatives, in both nestings.
///
/// A dual or Taylor number over the complex numbers, `dual<std::complex<double>>`, carries f′(z) of
/// an analytic function: algebra, ==, pow, streams and `exp`, `log`, `log10`, `sqrt`, `sin`, `cos`,
/// `tan`, `asin`, `acos`, `atan` and the hyperbolic ones, on the branches of `<complex>`. There is
/// no order, and no `abs`, `arg`, `conj`, `real`, `imag`, which have no complex derivative.
///
/// The other nesting, `std::complex<dual<double>>`, is a complex number whose parts have
/// derivatives. Products, quotients and analytic functions of it are those of the first nesting, a
/// + εb of complex a and b: f(a + εb) = f(a) + ε f′(a) b. `std::complex` is specialised here, and
/// its functions are overloaded, for those of the standard library branch on values or, as a
/// quotient by |z|², overflow.
///
/// If f′ is infinite, at least one part of the derivative is infinite; zero partials stay zero.

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

namespace duet::detail {

/// Power of D over complex or real numbers, or of constants. An operand whose infinitesimal parts
/// are all zero counts as a constant.
template <class X, class P>
[[nodiscard]] auto power_of_levels(const X& x, const P& p) {
  using std::pow;
  using result = decltype(pow(x, p));
  if constexpr (Infinitesimal<X> && Infinitesimal<P>) {
    if (is_constant(p)) {
      return result(pow(x, innermost(p)));
    }
    if (is_constant(x)) {
      return result(pow(innermost(x), p));
    }
  }
  return pow(x, p);
}

/// x as an operand of a level over complex numbers.
template <class X>
[[nodiscard]] auto operand_of_level(const X& x) {
  if constexpr (requires { x.real(); }) {
    return level_of_complex(x);
  } else {
    return x;
  }
}

/// The power of two numbers, at least one of them complex over numbers with derivatives.
template <class X, class P>
[[nodiscard]] auto complex_power(const X& x, const P& p) {
  return by_lane(
      [](const auto& y, const auto& q) {
        return complex_of_level(power_of_levels(operand_of_level(y), operand_of_level(q)));
      },
      x, p);
}

} // namespace duet::detail

// The functions of <complex>. The standard reserves its namespace, but std::sqrt(z) finds nothing
// elsewhere. Each is declared as one of the standard library's is, and preferred to it as the more
// constrained. (`norm`, `conj`, `real`, `imag` and `polar` of one type are right as the standard
// library has them.)

#define DUET_ANALYTIC(function)                                                                    \
  template <duet::Infinitesimal D>                                                                 \
  [[nodiscard]] complex<D> function(const complex<D>& z) {                                         \
    return duet::detail::analytic([](const auto& w) { return function(w); }, z);                   \
  }
#define DUET_ANALYTIC_OF_BUILT_IN(function)                                                        \
  template <duet::Infinitesimal D>                                                                 \
  [[nodiscard]] complex<D> function(const complex<D>& z) {                                         \
    if constexpr (std::floating_point<duet::lane_type_t<D>>) {                                     \
      return duet::detail::analytic([](const auto& w) { return function(w); }, z);                 \
    } else {                                                                                       \
      static_assert(std::floating_point<duet::lane_type_t<D>>,                                     \
                    "duet: " #function " of a complex number needs float, double or long double, " \
                    "the only types for which the standard library has it");                       \
    }                                                                                              \
  }

namespace std {

DUET_ANALYTIC(exp)
DUET_ANALYTIC(log)
DUET_ANALYTIC(sqrt)
DUET_ANALYTIC(sin)
DUET_ANALYTIC(cos)
DUET_ANALYTIC(tan)
DUET_ANALYTIC(sinh)
DUET_ANALYTIC(cosh)
DUET_ANALYTIC(tanh)
DUET_ANALYTIC_OF_BUILT_IN(log10)
DUET_ANALYTIC_OF_BUILT_IN(asin)
DUET_ANALYTIC_OF_BUILT_IN(acos)
DUET_ANALYTIC_OF_BUILT_IN(atan)
DUET_ANALYTIC_OF_BUILT_IN(asinh)
DUET_ANALYTIC_OF_BUILT_IN(acosh)
DUET_ANALYTIC_OF_BUILT_IN(atanh)

template <duet::Infinitesimal D>
[[nodiscard]] complex<D> pow(const complex<D>& z, const complex<D>& p) {
  return duet::detail::complex_power(z, p);
}
template <duet::Infinitesimal D>
[[nodiscard]] complex<D> pow(const complex<D>& z, const D& p) {
  return duet::detail::complex_power(z, p);
}
template <duet::Infinitesimal D>
[[nodiscard]] complex<D> pow(const D& x, const complex<D>& p) {
  return duet::detail::complex_power(x, p);
}
template <duet::Infinitesimal D>
[[nodiscard]] complex<D> pow(const complex<D>& z, int p) {
  return duet::detail::complex_power(z, p);
}
template <class A, class B>
  requires duet::detail::OtherReal<B, A>
[[nodiscard]] auto pow(const complex<A>& z, const complex<B>& p) {
  return duet::detail::complex_power(z, p);
}
template <class A, class B>
  requires duet::Infinitesimal<A> && duet::detail::OtherReal<B, A>
[[nodiscard]] auto pow(const complex<A>& z, const B& p) {
  return duet::detail::complex_power(z, p);
}
template <class A, class B>
  requires duet::Infinitesimal<B> && duet::detail::OtherReal<A, B>
[[nodiscard]] auto pow(const A& x, const complex<B>& p) {
  return duet::detail::complex_power(x, p);
}

/// |z|, without overflow.
template <duet::Infinitesimal D>
[[nodiscard]] D abs(const complex<D>& z) {
  return hypot(z.real(), z.imag());
}

/// Argument (angle) of z, in (−π, π] radians.
template <duet::Infinitesimal D>
[[nodiscard]] D arg(const complex<D>& z) {
  return atan2(z.imag(), z.real());
}

/// z, or +∞ for every infinite z, with the sign of the imaginary part.
template <duet::Infinitesimal D>
[[nodiscard]] complex<D> proj(const complex<D>& z) {
  return duet::detail::by_lane(
      [](const auto& w) {
        using number = typename remove_cvref_t<decltype(w)>::value_type;
        if (isinf(w.real()) || isinf(w.imag())) {
          return complex<number>(numeric_limits<number>::infinity(), copysign(number(0), w.imag()));
        }
        return w;
      },
      z);
}

/// r e^{iφ} for r and φ of two types.
template <class A, duet::detail::OtherReal<A> B>
[[nodiscard]] auto polar(const A& r, const B& angle) {
  using common = duet::promote_t<A, B>;
  return polar(common(r), common(angle));
}

} // namespace std

#undef DUET_ANALYTIC
#undef DUET_ANALYTIC_OF_BUILT_IN
