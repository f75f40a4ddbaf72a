// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: no match for .operator<|invalid operands to binary expression

#include <duet/dual/complex.hpp>

#ifdef DUET_MUST_FAIL
bool is_less(const duet::dual<std::complex<double>>& x) { return x < 1; }
#else
bool is_less(const duet::dual<std::complex<double>>& x) { return x == 1; }
#endif
