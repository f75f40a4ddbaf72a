// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: no matching function for call to .abs

#include <duet/dual/complex.hpp>

// |z| has no complex derivative; along a real parameter it has one.
#ifdef DUET_MUST_FAIL
auto modulus(const duet::dual<std::complex<double>>& z) { return abs(z); }
#else
auto modulus(const std::complex<duet::dual<double>>& z) { return abs(z); }
#endif
