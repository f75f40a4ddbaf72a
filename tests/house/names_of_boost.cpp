// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Functions that duet, the standard library and Boost.Math have: code that names all three, as
// generic code does, gets duet's.

#include <duet/dual/math.hpp>
#include <duet/dual/second_dual.hpp>

#ifdef DUET_WITH_INTEROP
#include <duet/interop/boost_math.hpp>
#endif

#include <boost/math/special_functions.hpp>

#include <cmath>
#include <type_traits>

#define CHECK_NAME(name, ...)                                                                      \
  {                                                                                                \
    using boost::math::name;                                                                       \
    using std::name;                                                                               \
    static_assert(std::is_same_v<decltype(name(__VA_ARGS__)), decltype(duet::name(__VA_ARGS__))>); \
  }

template <class T>
void check_names(const T& x) {
  CHECK_NAME(acosh, x);
  CHECK_NAME(asinh, x);
  CHECK_NAME(atanh, x);
  CHECK_NAME(cbrt, x);
  CHECK_NAME(erf, x);
  CHECK_NAME(erfc, x);
  CHECK_NAME(expm1, x);
  CHECK_NAME(log1p, x);
  CHECK_NAME(lgamma, x);
  CHECK_NAME(tgamma, x);
  CHECK_NAME(round, x);
  CHECK_NAME(trunc, x);
  CHECK_NAME(isfinite, x);
  CHECK_NAME(isinf, x);
  CHECK_NAME(isnan, x);
  CHECK_NAME(isnormal, x);
  CHECK_NAME(fpclassify, x);
  CHECK_NAME(signbit, x);
  CHECK_NAME(lround, x);
  CHECK_NAME(llround, x);
  CHECK_NAME(copysign, x, x);
  CHECK_NAME(hypot, x, x);
  CHECK_NAME(nextafter, x, x);
  CHECK_NAME(hypot, x, 2.0);
  CHECK_NAME(copysign, x, 2.0);
}

int main() {
  struct tag;
  check_names(duet::dual<double, 2>(.5));
  check_names(duet::dual<double, 1, tag>(.5));
  check_names(duet::taylor<double, 2>(.5));
  check_names(duet::second_order_dual<double, 2>(.5));
}
