// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "dual/multiprecision_cases.hpp"

namespace test_dual_multiprecision_et {

TEST_CASE("dual of 50 digits with expression templates: functions") {
  duet_test::check_functions_over<duet_test::real_50_et>();
}

TEST_CASE("dual of 50 digits with expression templates: algebra") {
  duet_test::check_algebra_over<duet_test::real_50_et>();
}

} // namespace test_dual_multiprecision_et
