// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Chains from URDF.

#include <duet/mechanism/urdf_library.hpp>

#undef DUET_COMPILED_TEMPLATE
#define DUET_COMPILED_TEMPLATE template

#include <duet/mechanism/srdf.hpp>
#include <duet/mechanism/urdf.hpp>
