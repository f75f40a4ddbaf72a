// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: static.assert
// forms: 2

#if DUET_MUST_FAIL == 1
static_assert(false);
#endif
