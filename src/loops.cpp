// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Mechanisms with loops.

#define DUET_DEFINES_COMPILED

#include <duet/mechanism/loops/motion_follower.hpp>
#include <duet/mechanism/loops/position_search.hpp>
#include <duet/mechanism/loops/surroundings.hpp>
#include <duet/mechanism/loops/tracer.hpp>
#include <duet/mechanism/loops/tree_closing.hpp>
