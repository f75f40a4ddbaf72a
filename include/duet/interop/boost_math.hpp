// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/dual/rules/functions.hpp>
#include <duet/dual/stumpff.hpp>

#include <boost/math/special_functions/cbrt.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <boost/math/special_functions/hypot.hpp>
#include <boost/math/special_functions/lambert_w.hpp>
#include <boost/math/special_functions/sinc.hpp>

#include <cmath>

/// \file
/// Functions of Boost.Math that duet has too, with duet's derivatives.
///
/// Boost returns table values or special cases for some arguments, as Γ(3) = 2 and erf(0) = 0,
/// which lose the derivative: the result is a constant. Series and Newton's method (sinc_pi,
/// lambert_w0) stop when the value is right and higher derivatives are not. Most of Boost.Math
/// takes dual numbers without any header of duet's; docs/reference/boost_functions.md lists the
/// exceptions.

namespace duet::rule {

/// Lambert's W on its principal branch: W′ = e^−W/(1 + W).
struct lambert_w0 {
  template <class T>
  T value(const T& x) const {
    if constexpr (Infinitesimal<T>) {
      return detail::lift(*this, x);
    } else {
      return boost::math::lambert_w0(x);
    }
  }
  template <class T>
  T slope(const T&, const T& y) const {
    using std::exp;
    return exp(-y) / (1 + y);
  }
};

} // namespace duet::rule

namespace duet::detail {

template <class D>
[[nodiscard]] D sinc(const D& x) {
  const auto value = innermost(x);
  return select( // for large numbers the square leaves the range, or its powers do
      value * value > 64, [&] { return D(sin(x) / x); }, [&] { return D(stumpff<1>(D(x * x))); });
}

} // namespace duet::detail

namespace boost::math {

using duet::cbrt;
using duet::erf;
using duet::erfc;
using duet::hypot;
using duet::lgamma;
using duet::tgamma;

/// sin x/x
template <duet::RealInfinitesimal D>
[[nodiscard]] inline D sinc_pi(D x) {
  return duet::detail::sinc(x);
}
/// Boost has a separate overload for every type with one parameter, as `dual<double>` is to
/// compilers that consider only parameters without default.
template <class T, template <class> class U>
  requires duet::RealInfinitesimal<U<T>>
[[nodiscard]] inline U<T> sinc_pi(const U<T> x) { return duet::detail::sinc(x); }
template <duet::RealInfinitesimal D>
[[nodiscard]] inline D lambert_w0(D x) {
  return duet::rule::lambert_w0{}.value(x);
}

} // namespace boost::math
