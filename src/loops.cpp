// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Mechanisms with loops.

#define DUET_DEFINES_COMPILED

#include <duet/robotics/loops/assembly_search.hpp>
#include <duet/robotics/loops/motion_follower.hpp>
#include <duet/robotics/loops/neighbourhood.hpp>
#include <duet/robotics/loops/tracer.hpp>
#include <duet/robotics/loops/tree_closure_solver.hpp>
