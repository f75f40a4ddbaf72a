// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/multiprecision.hpp"

DUET_TEST_MULTIPRECISION(, boost::multiprecision::cpp_bin_float<50>);
DUET_TEST_MULTIPRECISION(, boost::multiprecision::cpp_bin_float<100>);
