// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "dual/function_cases.hpp"
#include "support/multiprecision.hpp"
#include "support/test.hpp"

namespace test_dual_function_truth {

using duet_test::central_difference, duet_test::domain, duet_test::real_100;

// Checks the references of the other tests: derivatives by hand agree with difference quotients of
// the functions themselves.
TEST_CASE("function_cases: derivatives by hand agree with difference quotients") {
  duet_test::for_each_function([](const std::string& name, auto f, auto df, const domain& d,
                                  auto length) {
    CAPTURE(name);
    int count = 0;
    for (const double input : d.inputs) {
      const real_100 x(input);
      if (abs(x) < 0.01 || abs(x) > 25 || length(x) < 0.01) {
        continue;
      }
      const real_100 difference =
          central_difference([&](const real_100& t) -> real_100 { return f(t); }, x, 1, length(x));
      const real_100 exact = df(x);
      CHECK(abs(difference - exact) <= 1e-45 * (1 + abs(exact)));
      if (++count == 20) {
        break;
      }
    }
    CHECK(count >= 4);
  });
}

} // namespace test_dual_function_truth
