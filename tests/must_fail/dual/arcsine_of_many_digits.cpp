// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: asin of a complex number needs float, double or long double

#include <duet/dual/complex.hpp>

#include <boost/multiprecision/cpp_bin_float.hpp>

using real_50 = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>,
                                              boost::multiprecision::et_off>;
using number = duet::dual<real_50>;

// The standard library's arcsine uses π of 36 digits.
#ifdef DUET_MUST_FAIL
auto arcsine(const std::complex<number>& z) { return std::asin(z); }
#else
auto arcsine(const std::complex<number>& z) { return std::sqrt(z); }
#endif
