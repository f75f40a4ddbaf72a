// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Sensitivities of the wheel carrier's angles to its hardpoints, by dual numbers through the closed
// loop, against the closed form of rods that keep their lengths, and against the mechanism solved
// with errors.

#include "../../examples/tolerance_study/samples.hpp"
#include "../../examples/tolerance_study/toleranced_carrier.hpp"
#include "support/test.hpp"

#include <Eigen/LU>

namespace test_examples_tolerance_study {
namespace {

using namespace tolerance_study;

const std::vector<double> heights{-0.19, -0.1, 0, 0.07, 0.2};

/// The length of a rod is constant: d·(dW + ω × R s) = d·dA − d·R de, d = W + R s − A, where
/// dW_z = 0. Then dh = ω × h of the wheel's axes h.
sensitivity by_hand(const wheel_carrier::state& s, const hardpoints& points) {
  Eigen::Matrix<double, 5, 5> matrix;
  Eigen::Matrix<double, 5, coordinate_count> right =
      Eigen::Matrix<double, 5, coordinate_count>::Zero();
  for (int i = 0; i < 5; ++i) {
    const rod& r = points.rods[std::size_t(i)];
    const vector3 arm = rotate(s.q, vector3(r.carrier - points.wheel_centre));
    const vector3 d = s.centre + arm - r.chassis;
    matrix.row(i) << d.head<2>().transpose(), arm.cross(d).transpose();
    right.row(i).segment<3>(6 * i) = d;
    right.row(i).segment<3>(6 * i + 3) = -rotate(conj(s.q), d);
  }
  const Eigen::Matrix<double, 5, coordinate_count> moved = matrix.inverse() * right;
  const vector3 ahead = rotate(s.q, vector3(1, 0, 0));
  const vector3 up = rotate(s.q, vector3(0, 0, 1));
  sensitivity result;
  for (int j = 0; j < coordinate_count; ++j) {
    const vector3 omega = moved.col(j).tail<3>();
    const vector3 da = omega.cross(ahead);
    const vector3 du = omega.cross(up);
    result(0, j) =
        -(ahead[0] * da[1] - ahead[1] * da[0]) / (ahead[0] * ahead[0] + ahead[1] * ahead[1]);
    result(1, j) = (up[2] * du[1] - up[1] * du[2]) / (up[1] * up[1] + up[2] * up[2]);
  }
  return result;
}

TEST_CASE("toleranced_carrier: without errors, toe-in and camber are those of the wheel carrier") {
  const hardpoints points = wheel_carrier::example_hardpoints();
  const wheel_carrier::carrier design(points);
  const toleranced_carrier mechanism(points, heights);
  for (std::size_t row = 0; row < heights.size(); ++row) {
    CHECK(mechanism.height(row) == heights[row]);
    const vector2 angles = mechanism.angles(row, errors::Zero());
    const auto q = design.at(heights[row]).q;
    CHECK(std::abs(angles[0] - wheel_carrier::toe_in(q)) < 1e-14);
    CHECK(std::abs(angles[1] - wheel_carrier::camber(q)) < 1e-14);
  }
}

TEST_CASE("toleranced_carrier: sensitivities by dual numbers agree with the closed form") {
  const hardpoints points = wheel_carrier::example_hardpoints();
  const wheel_carrier::carrier design(points);
  const toleranced_carrier mechanism(points, heights);
  for (std::size_t row = 0; row < heights.size(); ++row) {
    CAPTURE(heights[row]);
    const sensitivity expected = by_hand(design.at(heights[row]), points);
    const double error = (mechanism.sensitivities(row) - expected).cwiseAbs().maxCoeff();
    CHECK(error < 1e-12 * expected.cwiseAbs().maxCoeff());
  }
}

TEST_CASE("toleranced_carrier: the error of the first-order prediction is of second order") {
  const toleranced_carrier mechanism(wheel_carrier::example_hardpoints(), heights);
  const errors direction = sample_errors(1, 0, 1);
  for (std::size_t row = 0; row < heights.size(); ++row) {
    CAPTURE(heights[row]);
    const vector2 design = mechanism.angles(row, errors::Zero());
    const vector2 linear = mechanism.sensitivities(row) * direction;
    const auto missed = [&](double h) {
      return (mechanism.angles(row, h * direction) - design - h * linear).norm();
    };
    const double order = std::log2(missed(2e-4) / missed(1e-4));
    CHECK(std::abs(order - 2) < 0.05);
  }
}

TEST_CASE("sample_errors: samples depend on seed and number only and are standard normal") {
  CHECK(sample_errors(1, 7, 2) == 2 * sample_errors(1, 7, 1));
  CHECK(sample_errors(1, 7, 1) != sample_errors(1, 8, 1));
  CHECK(sample_errors(1, 7, 1) != sample_errors(2, 7, 1));
  CHECK(sample_errors(1, 7, 1) != sample_errors(2, 6, 1));
  constexpr int count = 400;
  errors sum = errors::Zero(), squares = errors::Zero();
  double neighbours = 0;
  for (int i = 0; i < count; ++i) {
    const errors e = sample_errors(1, std::uint64_t(i), 1);
    sum += e;
    squares += e.cwiseProduct(e);
    neighbours += e.dot(sample_errors(1, std::uint64_t(i) + 1, 1));
  }
  // Four and a half standard errors for the worst of thirty.
  CHECK(sum.cwiseAbs().maxCoeff() / count < 4.5 / std::sqrt(count));
  CHECK((squares / count - errors::Ones()).cwiseAbs().maxCoeff() < 4.5 * std::sqrt(2.0 / count));
  CHECK(std::abs(neighbours) < 4.5 * std::sqrt(30.0 * count));
}

TEST_CASE("statistics_of: mean, deviation and quantiles of known numbers are exact") {
  std::vector<double> numbers;
  for (int i = 200; i >= 0; --i) {
    numbers.push_back(i);
  }
  const statistics s = statistics_of(numbers);
  CHECK(s.mean == 100);
  CHECK(std::abs(s.deviation - std::sqrt(201 * 202 / 12.0)) < 1e-12);
  CHECK(s.low == 5);
  CHECK(s.high == 195);
  const statistics two = statistics_of({3, 1});
  CHECK(two.low == 1.05);
  CHECK(two.high == 2.95);
}

} // namespace
} // namespace test_examples_tolerance_study
