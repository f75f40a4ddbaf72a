// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

namespace duet_test {

/// For derivatives of many functions: tagged by their types each would instantiate Eigen anew.
struct shared_tag;

/// For the outer one of two nested derivatives.
struct outer_shared_tag;

} // namespace duet_test
