// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"
#include "support/message.hpp"

#include <duet/spline/interpolate.hpp>

// Infinitesimal parts through the solve: derivatives of a curve with respect to its data.

namespace test_spline_rotation_vector_data {

using duet::interpolate;

namespace {

const std::vector<double> knots{0, 0.3, 0.5, 1.1, 1.3, 1.9, 2, 2.4};

} // namespace

TEST_CASE_TEMPLATE(
    "rotation_vector_spline: derivatives with respect to a sample agree with differences", order,
    std::integral_constant<int, 4>, std::integral_constant<int, 6>) {
  // Sample 3 is rotated by t about (1, −2, 2)/3: derivative duals through the solve against central
  // differences.
  const auto data = duet_test::random_orientations(knots.size(), 1.4, 6);
  const auto value = [&](const auto& t) {
    using S = std::decay_t<decltype(t)>;
    std::vector<duet::quaternion<S>> q = duet_test::cast<S>(data);
    const S sixth = t / 6;
    q[3] = q[3] * duet::exp(duet::vector3<S>(sixth, S(-2 * sixth), S(2 * sixth)));
    using spline = duet::rotation_vector_spline<S, order::value>;
    return interpolate<spline>(knots, q, duet::not_a_knot{})(0.4);
  };
  const auto automatic = value(duet::dual<double>::variable(0.0));
  const double h = 1e-5;
  const auto difference = (value(h) - value(-h)) / (2 * h);
  CHECK(norm(difference) > 1e-3);
  CHECK(std::abs(automatic.w().epsilon() - difference.w()) < 1e-9);
  CHECK(std::abs(automatic.x().epsilon() - difference.x()) < 1e-9);
  CHECK(std::abs(automatic.y().epsilon() - difference.y()) < 1e-9);
  CHECK(std::abs(automatic.z().epsilon() - difference.z()) < 1e-9);
}

TEST_CASE("rotation_vector_spline: parameters too close or too far apart for finite rates throw") {
  using duet_test::message_of;
  using curve = duet::rotation_vector_spline<double>;
  const duet::quaternion<double> one(1);
  const Eigen::Vector3d still = Eigen::Vector3d::Zero();
  const auto over = [&](double from, double to) {
    return message_of([&] {
      static_cast<void>(curve::from_pieces({from, to}, {one, one}, {{still, still, still, still}}));
    });
  };
  CHECK(over(0, 1) == "");
  CHECK(over(0, 5e-324) ==
        "duet: rotation_vector_spline: parameter 0 = 0 and parameter 1 = 4.94066e-324 are too "
        "close: a derivative overflows");
  CHECK(over(-1.7e308, 1.7e308) ==
        "duet: rotation_vector_spline: the distance from -1.7e+308 to 1.7e+308 overflows");
}

TEST_CASE("rotation_vector_spline: rates that are not finite throw, with the sample") {
  using quintic = duet::rotation_vector_spline<double, 6>;
  const duet::quaternion<double> one(1);
  const Eigen::Vector3d still = Eigen::Vector3d::Zero();
  for (const double x : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    for (const std::size_t i : {0, 1}) {
      std::vector<std::array<Eigen::Vector3d, 2>> rates(2, {still, still});
      rates[i][1 - i][2] = x;
      CHECK(duet_test::message_of([&] {
              quintic({0, 1}, {one, one}, rates);
            }) == "duet: sample " + std::to_string(i) + ": a rate is not finite");
    }
  }
}

} // namespace test_spline_rotation_vector_data
