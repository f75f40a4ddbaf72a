// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: cannot bind non-const lvalue|no viable conversion

#include <duet/core/parallel_for.hpp>

const auto proceed = [](const duet::progress&) { return true; };

#ifdef DUET_MUST_FAIL
// The lambda it refers to is destroyed before the run begins.
const duet::execution how{2, [](const duet::progress&) { return true; }};
#else
const duet::execution how{2, proceed};
#endif

int main() { return how.report ? 0 : 1; }
