// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

/// \file
/// Contents of the compiled library duet::compiled. Programs that are linked to it are compiled
/// with `DUET_COMPILED`: headers then end with a list of templates that need not be instantiated,
/// as the library has them. Its sources instantiate those in the lists of the headers that they
/// include after having redefined `DUET_COMPILED_TEMPLATE` as `template`.
///
/// A list suppresses the instantiation of functions that are neither inline, as are those defined
/// within a class, nor return `auto`. Functions that are not templates are declared with
/// `DUET_COMPILED_FUNCTION` and defined in a separate header, which is included only without the
/// library, between `#ifdef DUET_DEFINES_COMPILED`, which the library's sources define.

#ifndef DUET_COMPILED
#define DUET_COMPILED_FUNCTION inline
#define DUET_DEFINES_COMPILED
#else
#define DUET_COMPILED_FUNCTION
#define DUET_COMPILED_TEMPLATE extern template

namespace duet::detail {
DUET_ABI_BEGIN

/// Symbol of the library. Its name depends on the vector width: programs that differ in that do not
/// link.
extern const char library_for_this_vector_width;
DUET_KEPT inline const char* const needed_library = &library_for_this_vector_width;

DUET_ABI_END
} // namespace duet::detail
#endif
