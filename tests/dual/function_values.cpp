// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "dual/function_cases.hpp"
#include "support/identical.hpp"
#include "support/test.hpp"

namespace test_dual_function_values {
namespace {

using duet::dual, duet::taylor, duet_test::domain, duet_test::for_each_function,
    duet_test::identical;

struct outer_tag;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

TEST_CASE("functions over dual: values equal those of <cmath> bit by bit") {
  for_each_function([](const std::string& name, auto f, auto, domain d, auto) {
    CAPTURE(name);
    d.inputs.insert(d.inputs.end(), {infinity, -infinity, not_a_number, 5e-324, -5e-324, 1e308,
                                     -1e308, 800, -800, 1, -1, 2, -2, 0, -0.0});
    for (const double x : d.inputs) {
      CAPTURE(x);
      CHECK(identical(f(dual<double>::variable(x)).value(), f(x)));
      CHECK(identical(f(dual<double, 7>::variable(x, 3)).value(), f(x)));
      CHECK(identical(f(taylor<double, 3>::variable(x)).value(), f(x)));
      CHECK(identical(f(dual<dual<double>, 1, outer_tag>::variable(x)).value().value(), f(x)));
    }
  });
}

TEST_CASE("functions over dual: a constant at any nesting level has no derivative") {
  for_each_function([](const std::string& name, auto f, auto, domain d, auto) {
    CAPTURE(name);
    d.inputs.insert(d.inputs.end(),
                    {infinity, -infinity, not_a_number, 800, 1, -1, 2, -2, 0, -0.0});
    for (const double x : d.inputs) {
      CAPTURE(x);
      CHECK(f(dual<double>(x)).epsilon() == 0);
      CHECK(f(dual<double, 5>(x)).partial(4) == 0);
      const auto series = f(taylor<double, 3>(x));
      const auto nested = f(dual<dual<double>, 1, outer_tag>(x));
      // A constant of the inner level that varies in the outer one.
      const auto outer_only = f(dual<dual<double>, 1, outer_tag>::variable(x));
      for (int k = 1; k <= 3; ++k) {
        CHECK(series.coefficient(k) == 0);
      }
      CHECK(nested.epsilon() == 0);
      CHECK(nested.epsilon().epsilon() == 0);
      CHECK(nested.value().epsilon() == 0);
      CHECK(outer_only.value().epsilon() == 0);
      // Products are not guarded, so slopes that multiply infinities are left out.
      if (std::isfinite(x)) {
        CHECK(outer_only.epsilon().epsilon() == 0);
      }
    }
  });
}

} // namespace
} // namespace test_dual_function_values
