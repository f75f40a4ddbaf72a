// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/multiprecision.hpp"
#include "support/random.hpp"
#include "support/ulp.hpp"

#include <duet/dual/math.hpp>

#include <boost/math/special_functions/digamma.hpp>
#include <doctest/doctest.h>

#include <cmath>
#include <vector>

namespace test_dual_function_gamma {

using duet::dual;
using duet_test::central_difference;
using duet_test::real_100;
using duet_test::scale;
using duet_test::ulps;
using duet_test::worst_error;

TEST_CASE("derivatives of gamma functions") {
  worst_error worst_tgamma("tgamma");
  worst_error worst_lgamma("lgamma");
  duet_test::random_source random(3);
  std::vector<double> inputs{1e-300, 1e-8,  0.5,   1.0,  1.4616321449683623, 2.0,  8.0,
                             30.0,   170.0, -1e-8, -0.4, -1 + 1e-10,         -1.5, -2.5,
                             -9.75,  -20.25};
  for (int i = 0; i < 40; ++i) {
    inputs.push_back(random.uniform(-6, 12));
  }
  for (const double x : inputs) {
    const auto psi = [](const real_100& t) -> real_100 { return boost::math::digamma(t); };
    const real_100 wide(x);
    const real_100 slope = psi(wide);
    const real_100 near = abs(wide - round(wide));
    const real_100 length = x > 1 ? real_100(1) : real_100(near > 1e-40 ? near : abs(wide));
    const real_100 curvature = central_difference(psi, wide, 1, length);
    const auto y = lgamma(dual<double>::variable(x));
    CHECK(y.value() == std::lgamma(x));
    worst_lgamma.add(ulps(y.epsilon(), slope, scale(slope, curvature, wide)), x);

    const real_100 gamma = boost::math::tgamma(wide);
    const auto z = tgamma(dual<double>::variable(x));
    const real_100 exact = gamma * slope;
    const real_100 second = gamma * (slope * slope + curvature);
    CHECK(z.value() == std::tgamma(x));
    worst_tgamma.add(ulps(z.epsilon(), exact, scale(exact, second, wide)), x);
  }
  CHECK_MESSAGE(worst_lgamma <= 16, worst_lgamma);
  CHECK_MESSAGE(worst_tgamma <= 16, worst_tgamma);
}

} // namespace test_dual_function_gamma
