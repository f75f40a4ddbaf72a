// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Chains from URDF, pairs of links from SRDF, surfaces.

#define DUET_DEFINES_COMPILED

#include <duet/mechanism/meshes/mesh_reading.hpp>
#include <duet/mechanism/urdf_library.hpp>

#undef DUET_COMPILED_TEMPLATE
#define DUET_COMPILED_TEMPLATE template

#include <duet/mechanism/srdf.hpp>
#include <duet/mechanism/urdf.hpp>
