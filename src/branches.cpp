// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// All solutions of six and seven joints.

#define DUET_DEFINES_COMPILED

#include <duet/robotics/branches/branch_solver.hpp>
#include <duet/robotics/branches/chain_loop_units.hpp>
#include <duet/robotics/branches/component_search.hpp>
