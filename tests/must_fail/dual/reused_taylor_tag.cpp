// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: happens inside another one with the same tag.*derivatives<K, struct my_tag>

#include <duet/dual/math.hpp>

struct inner;

#ifdef DUET_MUST_FAIL
duet::taylor<duet::dual<double>, 2> x;
#else
duet::taylor<duet::dual<double>, 2, inner> x;
#endif

int main() { return x == 0 ? 0 : 1; }
