// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: those of complex numbers, as dual<std::complex<double>>, are complex themselves

#include <duet/dual/complex.hpp>

#ifdef DUET_MUST_FAIL
std::complex<duet::dual<std::complex<double>>> z; // mistake
#else
std::complex<duet::dual<double>> z;
#endif
