// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: happens inside another one with the same tag.*derivative<struct my_tag>

#include <duet/dual/math.hpp>

struct outer;
struct inner;

#ifdef DUET_MUST_FAIL
duet::dual<duet::dual<double, 1, outer>, 1, outer> x;
#else
duet::dual<duet::dual<double, 1, outer>, 1, inner> x;
#endif

int main() { return x == 0 ? 0 : 1; }
