// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: no viable conversion|cannot convert

#include <duet/dual/math.hpp>

// A dual does not convert to a double implicitly: derivatives would be lost unnoticed.
const duet::dual<double> x(1, 2);
#ifdef DUET_MUST_FAIL
const double y = x;
#else
const double y = static_cast<double>(x);
#endif

int main() { return y == 1 ? 0 : 1; }
