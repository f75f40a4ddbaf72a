// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

/// \file
/// All of duet but `interop/`.

#include <duet/core/version.hpp>
#include <duet/dual/eigen_traits.hpp>
#include <duet/dual/math.hpp>
