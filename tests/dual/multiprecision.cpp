// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "dual/multiprecision_cases.hpp"

namespace test_dual_multiprecision {

TEST_CASE("dual of 50 digits: functions") { duet_test::check_functions_over<duet_test::real_50>(); }

TEST_CASE("dual of 50 digits: algebra") { duet_test::check_algebra_over<duet_test::real_50>(); }

} // namespace test_dual_multiprecision
