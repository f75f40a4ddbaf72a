// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

/// \file
/// Dual and Taylor numbers with everything a `double` has: functions, limits, streams.

#include <duet/dual/dual.hpp>
#include <duet/dual/number/limits.hpp>
#include <duet/dual/number/stream.hpp>
#include <duet/dual/rules/functions.hpp>
#include <duet/dual/rules/piecewise.hpp>
#include <duet/dual/rules/scaling.hpp>
#include <duet/dual/taylor.hpp>
