// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"

#include <duet/duet.hpp>

namespace test_spline_interpolate_second_derivatives {
namespace {

using duet::dual;
template <class T>
using curve = duet::cumulative_bspline<T>;

const std::vector<double> u = {0, 0.7, 1.1, 2, 2.6, 3.5};

/// Samples exp(h · direction) q over the scalar of h, with a separate direction for each.
template <class T>
std::vector<duet::quaternion<T>> moved(const T& h) {
  duet_test::random_source random(9);
  std::vector<duet::quaternion<T>> result;
  for (const auto& q : duet_test::random_orientations(u.size(), 1.6)) {
    const auto n = random.direction<3>();
    result.push_back(duet::exp(duet::vector3<T>(h * n[0], h * n[1], h * n[2])) *
                     duet::quaternion<T>(q));
  }
  return result;
}

} // namespace

TEST_CASE("interpolate: second derivatives with respect to the data and derivatives of poses agree "
          "with differences") {
  // The derivative of the dual part is compared with the difference of two curves of poses, the
  // second derivative of a rotation with the difference of two first derivatives.
  using D = dual<double>;
  const double h = 1e-6;
  const auto check_second = [&](auto variable, auto at) {
    using T = decltype(variable);
    using S = decltype(at(0.0));
    const auto s = duet::interpolate<curve<T>>(u, moved(variable), duet::natural{});
    const auto a = duet::interpolate<curve<S>>(u, moved(at(h)), duet::natural{});
    const auto b = duet::interpolate<curve<S>>(u, moved(at(-h)), duet::natural{});
    for (const double x : {0.0, 0.3, 0.9, 1.7, 2.3, 3.5}) {
      const auto q = s(x);
      const auto difference = (a(x) - b(x)) / (2 * h);
      CHECK(std::abs(q.w().epsilon().epsilon() - difference.w().epsilon()) < 1e-8);
      CHECK(std::abs(q.y().epsilon().epsilon() - difference.y().epsilon()) < 1e-8);
    }
  };
  struct second;
  using nested = dual<D, 1, duet::derivative_tag<second>>;
  check_second(nested(D::variable(0), D(1)), [](double x) { return D(x, 1); });
  check_second(duet::screw_dual<D>(D::variable(0), D(1)),
               [](double x) { return duet::screw_dual<double>(x, 1); });
}

} // namespace test_spline_interpolate_second_derivatives
