// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Mechanisms with loops.

#define DUET_DEFINES_COMPILED

#include <duet/mechanism/loops/assembly_search.hpp>
#include <duet/mechanism/loops/motion_follower.hpp>
#include <duet/mechanism/loops/neighbourhood.hpp>
#include <duet/mechanism/loops/tracer.hpp>
#include <duet/mechanism/loops/tree_closure_solver.hpp>
