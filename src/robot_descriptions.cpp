// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Chains from URDF, pairs of links from SRDF, surfaces.

#define DUET_DEFINES_COMPILED

#include <duet/io/meshes/mesh_reading.hpp>
#include <duet/io/urdf_library.hpp>

#undef DUET_COMPILED_TEMPLATE
#define DUET_COMPILED_TEMPLATE template

#include <duet/io/srdf.hpp>
#include <duet/io/urdf.hpp>
