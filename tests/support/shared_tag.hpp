// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

namespace duet_test {

/// For derivatives of many functions: tagged by their types each would instantiate Eigen anew.
struct shared_tag;

} // namespace duet_test
