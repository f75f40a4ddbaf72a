// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#ifdef DUET_MUST_FAIL
static_assert(false);
#endif
