// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: what is right
// within: 2

#ifdef DUET_MUST_FAIL
static_assert(false, "what is said first");
static_assert(false, "what is right");
#endif
