// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

/// \file
/// Dual and Taylor numbers with everything a `double` has: functions, limits, streams.

#include <duet/dual/dual.hpp>
#include <duet/dual/functions.hpp>
#include <duet/dual/limits.hpp>
#include <duet/dual/piecewise.hpp>
#include <duet/dual/scaling.hpp>
#include <duet/dual/stream.hpp>
#include <duet/dual/taylor.hpp>
