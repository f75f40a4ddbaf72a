// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: static.assert

#ifdef DUET_MUST_FAIL
static_assert(false);
#else
static_assert(false);
#endif
