// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: needs C..20: compile with -std=c..20
// wrong flags: -std=c++17
// within: 5
// forms: 3

#if DUET_MUST_FAIL == 1
#include <duet/spline/evaluate.hpp>
#elif DUET_MUST_FAIL == 2
#include <duet/expression/gradient.hpp>
#else
#include <duet/duet.hpp>
#endif
