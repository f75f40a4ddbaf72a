// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: -ffast-math
// flags: -ffast-math

#ifndef DUET_MUST_FAIL
#define DUET_ALLOW_FAST_MATH
#endif
#include <duet/dual/dual.hpp>
