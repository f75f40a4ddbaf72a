// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// What all comparisons have in common.

#include <duet/core/compiled.hpp>

#undef DUET_COMPILED_TEMPLATE
#define DUET_COMPILED_TEMPLATE template

#include <duet/comparison/compare.hpp>
