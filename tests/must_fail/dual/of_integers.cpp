// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: dual<T> needs a real number

#include <duet/dual/dual.hpp>

#ifdef DUET_MUST_FAIL
duet::dual<int> x;
#else
duet::dual<double> x;
#endif
