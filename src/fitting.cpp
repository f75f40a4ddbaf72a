// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Curves near rotations and poses.

#include <duet/spline/interpolate.hpp>

#undef DUET_COMPILED_TEMPLATE
#define DUET_COMPILED_TEMPLATE template

#include <duet/spline/fit.hpp>
