// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/quaternion/exponential.hpp>

/// \file
/// The tangent space of rotations, `manifold<quaternion<T>>`: it stands beside the exponential that
/// moves them, so that it is known wherever a rotation can be formed.
