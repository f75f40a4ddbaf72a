// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

/// \file
/// What the library duet::compiled holds. Programs that are linked to it are compiled with
/// `DUET_COMPILED`: headers then end with a list of templates that compilers need not make, as the
/// library has them. Its sources make what is in the lists of the headers that they include after
/// having defined `DUET_COMPILED_TEMPLATE` anew, as `template`.
///
/// A list keeps compilers from functions that are neither inline, as are those defined within a
/// class, nor return `auto`. Functions that are no templates are declared with
/// `DUET_COMPILED_FUNCTION` and defined in a header of their own, which comes in only where there
/// is no library, between `#ifdef DUET_DEFINES_COMPILED`, which the library's sources define.

#ifndef DUET_COMPILED
#define DUET_COMPILED_FUNCTION inline
#define DUET_DEFINES_COMPILED
#else
#define DUET_COMPILED_FUNCTION
#define DUET_COMPILED_TEMPLATE extern template

namespace duet::detail {
DUET_ABI_BEGIN

/// The library's. For vectors of another width it is of another name: programs that differ in that
/// do not link.
extern const char library_for_this_vector_width;
DUET_KEPT inline const char* const needed_library = &library_for_this_vector_width;

DUET_ABI_END
} // namespace duet::detail
#endif
