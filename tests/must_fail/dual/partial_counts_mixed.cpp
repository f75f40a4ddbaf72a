// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: use of deleted function .*different_numbers_of_partials|selected deleted operator '\*'

#include <duet/dual/math.hpp>

// Partials of a function of two variables and of one of three have no common meaning.
const duet::dual<double, 2> x = duet::dual<double, 2>::variable(1, 1);
#ifdef DUET_MUST_FAIL
const duet::dual<double, 3> y = 2;
#else
const duet::dual<double, 2> y = 2;
#endif
const auto z = x * y;

int main() { return z == 2 ? 0 : 1; }
