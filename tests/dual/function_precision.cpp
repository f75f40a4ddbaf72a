// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "dual/function_cases.hpp"
#include "support/multiprecision.hpp"
#include "support/test.hpp"
#include "support/ulp.hpp"

namespace test_dual_function_precision {

using duet::dual, duet_test::domain, duet_test::for_each_function, duet_test::scale,
    duet_test::ulps, duet_test::worst_error;

// float and long double beside double: the same rules in another precision.
TEST_CASE_TEMPLATE("functions over dual: first derivatives in every built-in precision", T, float,
                   long double) {
  using wide = duet_test::real_50;
  for_each_function([](const std::string& name, auto f, auto df, const domain& d, auto length) {
    worst_error worst(name);
    for (const double input : d.inputs) {
      const T x = T(input);
      if (x - x != 0 || T(std::abs(x)) < std::numeric_limits<T>::min() * 10) {
        continue;
      }
      const wide w(x);
      if (length(w) <= 0) {
        continue;
      } // rounded onto a singularity
      const wide exact = df(w);
      const wide h = length(w) * 1e-15;
      const wide second = (df(wide(w + h)) - df(wide(w - h))) / (2 * h);
      const auto y = f(dual<T>::variable(x));
      CHECK(y.value() == f(x));
      worst.add(ulps(y.epsilon(), exact, scale(exact, second, w)), x);
    }
    CHECK_MESSAGE(worst <= 4, worst);
  });
}

} // namespace test_dual_function_precision
