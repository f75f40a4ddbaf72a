// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <cstdlib>

namespace duet_test {

/// Number of inputs of a test that was added as SAMPLED: all of them if the environment has
/// DUET_TEST_ALL_SAMPLES, as before a release, otherwise a quarter.
inline int sample_count(int all) {
  static const bool takes_all = std::getenv("DUET_TEST_ALL_SAMPLES") != nullptr;
  return takes_all ? all : (all + 3) / 4;
}

} // namespace duet_test
