// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Curves through rotations and poses.

#include <duet/core/compiled.hpp>

#undef DUET_COMPILED_TEMPLATE
#define DUET_COMPILED_TEMPLATE template

#include <duet/spline/interpolate.hpp>
