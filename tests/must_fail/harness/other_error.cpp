// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: a message nobody wrote

#ifdef DUET_MUST_FAIL
static_assert(false);
#endif
