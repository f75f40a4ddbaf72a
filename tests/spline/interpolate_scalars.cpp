// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"

#include <duet/spline/interpolate.hpp>

namespace test_spline_interpolate_scalars {

using duet_test::cast;
using duet_test::max_abs_difference;

TEST_CASE("interpolate: float and long double agree with double to their precision") {
  const auto q = duet_test::random_orientations(10, 0.7);
  std::vector<double> u = {3};
  while (u.size() < q.size()) {
    u.push_back(u.back() + 0.5 + 0.25 * double(u.size() % 3));
  }
  const auto s = duet::interpolate<duet::cumulative_bspline<double>>(u, q);
  const auto in_float =
      duet::interpolate<duet::cumulative_bspline<float>>(cast<float>(u), cast<float>(q));
  const auto in_long_double = duet::interpolate<duet::cumulative_bspline<long double>>(
      cast<long double>(u), cast<long double>(q));
  for (double x = u.front(); x <= u.back(); x += 0.0625) {
    CHECK(max_abs_difference(in_float(float(x)), s(x)) < 2e-6);
    CHECK(max_abs_difference(in_long_double(x), s(x)) < 1e-14);
  }
  for (std::size_t i = 0; i < u.size(); ++i) {
    CHECK(max_abs_difference(in_float(float(u[i])), q[i]) < 1e-6);
    const auto exact = normalized(cast<long double>(q)[i]);
    CHECK(max_abs_difference(in_long_double(u[i]), exact) < 1e-18);
  }
}

} // namespace test_spline_interpolate_scalars
