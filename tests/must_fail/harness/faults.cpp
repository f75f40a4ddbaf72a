// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// What the check must not pass.

//// control_is_broken
// expect: static.assert

static_assert(false);

//// compiles
// expect: static.assert

#ifdef DUET_MUST_FAIL
static_assert(true);
#endif

//// other_error
// expect: a message nobody wrote

#ifdef DUET_MUST_FAIL
static_assert(false);
#endif

//// second_form
// expect: static.assert
// forms: 2

#if DUET_MUST_FAIL == 1
static_assert(false);
#endif

//// too_late
// expect: what is right
// within: 2

#ifdef DUET_MUST_FAIL
static_assert(false, "what is said first");
static_assert(false, "what is right");
#endif

//// one_of_two
// expect: static.assert

#ifdef DUET_MUST_FAIL
static_assert(false); // mistake
static_assert(true);  // mistake
#endif

//// expects_nothing

#ifdef DUET_MUST_FAIL
static_assert(false);
#endif
