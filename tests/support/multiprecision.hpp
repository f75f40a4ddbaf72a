// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>

#include <concepts>

/// \file
/// The number types that tests take as the truth, and those they use as scalars.

/// The arithmetic of such numbers is compiled once, optimised, in multiprecision.cpp: without,
/// tests that need a truth would run for several times as long.
#define DUET_TEST_MULTIPRECISION(prefix, ...)                                                      \
  prefix template class __VA_ARGS__;                                                               \
  prefix template void boost::multiprecision::backends::eval_add(__VA_ARGS__&, const __VA_ARGS__&, \
                                                                 const __VA_ARGS__&);              \
  prefix template void boost::multiprecision::backends::eval_subtract(                             \
      __VA_ARGS__&, const __VA_ARGS__&, const __VA_ARGS__&);                                       \
  prefix template void boost::multiprecision::backends::eval_multiply(                             \
      __VA_ARGS__&, const __VA_ARGS__&, const __VA_ARGS__&);                                       \
  prefix template void boost::multiprecision::backends::eval_divide(                               \
      __VA_ARGS__&, const __VA_ARGS__&, const __VA_ARGS__&);                                       \
  prefix template void boost::multiprecision::backends::eval_sqrt(__VA_ARGS__&, const __VA_ARGS__&)

DUET_TEST_MULTIPRECISION(extern, boost::multiprecision::cpp_bin_float<50>);
DUET_TEST_MULTIPRECISION(extern, boost::multiprecision::cpp_bin_float<100>);

namespace duet_test {

namespace mp = boost::multiprecision;

/// 50 digits, the usual scalar of Boost.Multiprecision, and the same with expression templates.
using real_50 = mp::number<mp::cpp_bin_float<50>, mp::et_off>;
using real_50_et = mp::number<mp::cpp_bin_float<50>, mp::et_on>;

/// 100 digits: enough that differences of functions are exact to 50 and more.
using real_100 = mp::number<mp::cpp_bin_float<100>, mp::et_off>;

/// The k-th derivative of f at x by a central difference of step `length` · 10^(−90/(k+2)).
/// `length` is how far f is smooth: the distance to its nearest singularity, or 1. Relative error
/// about 1e-60 for k = 1, 1e-30 for k = 4.
template <class F>
[[nodiscard]] real_100 central_difference(F&& f, const real_100& x, int k, const real_100& length) {
  const real_100 h = length * pow(real_100(10), -90 / (k + 2));
  real_100 sum = 0;
  real_100 binomial = 1;
  for (int i = 0; i <= k; ++i) {
    const real_100 term = binomial * f(real_100(x + h * (real_100(k) / 2 - i)));
    sum += i % 2 == 0 ? term : real_100(-term);
    binomial = binomial * (k - i) / (i + 1);
  }
  return sum / pow(h, k);
}

} // namespace duet_test
