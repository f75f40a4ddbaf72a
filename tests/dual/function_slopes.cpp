// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "dual/function_cases.hpp"
#include "support/multiprecision.hpp"
#include "support/test.hpp"
#include "support/ulp.hpp"

namespace test_dual_function_slopes {

using duet::dual, duet_test::central_difference, duet_test::domain, duet_test::for_each_function,
    duet_test::real_100, duet_test::scale, duet_test::ulps, duet_test::worst_error;

TEST_CASE("functions over dual: first derivatives agree with 100 digits") {
  for_each_function([](const std::string& name, auto f, auto df, const domain& d, auto length) {
    worst_error worst(name);
    for (const double x : d.inputs) {
      const real_100 wide(x);
      const real_100 exact = df(wide);
      const real_100 second = central_difference(df, wide, 1, length(wide));
      const double computed = f(dual<double>::variable(x)).epsilon();
      worst.add(ulps(computed, exact, scale(exact, second, wide)), x);
    }
    CHECK_MESSAGE(worst <= 4, worst);
  });
}

} // namespace test_dual_function_slopes
