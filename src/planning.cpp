// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Searches for joints and plans.

#include <duet/core/compiled.hpp>

#define DUET_DEFINES_COMPILED
#undef DUET_COMPILED_TEMPLATE
#define DUET_COMPILED_TEMPLATE template

#include <duet/planning/enclosing_capsule.hpp>
#include <duet/planning/goals.hpp>
#include <duet/planning/inverse_kinematics.hpp>
#include <duet/planning/plan_screw_motion.hpp>
#include <duet/planning/start_search.hpp>
#include <duet/planning/timing/log_barrier_solver.hpp>
