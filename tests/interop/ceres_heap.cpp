// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/allocations.hpp"

#include <duet/dual_quaternion/pose.hpp>
#include <duet/interop/ceres.hpp>
#include <duet/interop/ceres_curves.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/split_bspline.hpp>

#include <memory>

#include "support/test.hpp"

// Evaluations of cost functions use no heap memory.

namespace test_interop_ceres_heap {
namespace {

using vector3 = duet::vector3<double>;
constexpr auto order = duet::quaternion_order::xyzw;

/// Number of allocations in evaluations with Jacobians and without.
std::size_t allocations_of(ceres::CostFunction* made, const std::vector<double*>& blocks) {
  const std::unique_ptr<ceres::CostFunction> cost(made);
  const std::size_t rows = std::size_t(cost->num_residuals());
  std::vector<double> residuals(rows);
  std::vector<std::vector<double>> memory;
  std::vector<double*> jacobians;
  for (const int size : cost->parameter_block_sizes()) {
    memory.emplace_back(rows * std::size_t(size));
  }
  for (auto& each : memory) {
    jacobians.push_back(each.data());
  }
  const std::size_t before = duet_test::allocations;
  bool is_evaluated = cost->Evaluate(blocks.data(), residuals.data(), jacobians.data());
  is_evaluated = cost->Evaluate(blocks.data(), residuals.data(), nullptr) && is_evaluated;
  const std::size_t count = duet_test::allocations - before;
  CHECK(is_evaluated);
  return count;
}

TEST_CASE("cost functions: no heap memory") {
  const duet::pose_block block(order);
  std::array<double, 7> a, b;
  block.store(duet::pose(duet::from_rotation_vector(vector3(.1, .2, .3)), vector3(1, 2, 3)),
              a.data());
  block.store(duet::pose(duet::from_rotation_vector(vector3(.4, .2, -1)), vector3(2, 1, 0)),
              b.data());
  CHECK(allocations_of(duet::cost_function(
                           [](const auto& p, const auto& q) {
                             return (2 * duet::twist_of(duet::log(conj(p) * q).vec())).eval();
                           },
                           block, block),
                       {a.data(), b.data()}) == 0);
  CHECK(allocations_of(duet::cost_function<2, 7, 7>([](const auto* p, const auto* q, auto* r) {
                         r[0] = p[0] * q[1];
                         r[1] = p[4] - q[6];
                       }),
                       {a.data(), b.data()}) == 0);
}

TEST_CASE("curve residuals: no heap memory") {
  std::vector<double> knots;
  std::vector<duet::quaternion<double>> rotations;
  std::vector<vector3> positions;
  std::vector<duet::dual_quaternion<double>> poses;
  for (int i = 0; i < 12; ++i) {
    knots.push_back(i);
    if (i < 8) {
      rotations.push_back(duet::from_rotation_vector(vector3(.3 * i, .1 * i * i, .2)));
      positions.emplace_back(i, std::sin(i), 1);
    }
  }
  rotations = duet::align_quaternion_signs(rotations);
  for (std::size_t i = 0; i < 8; ++i) {
    poses.push_back(duet::pose(rotations[i], positions[i]));
  }
  const duet::curve_blocks<double> of_rotations(duet::cumulative_bspline<double>(knots, rotations),
                                                order);
  const duet::curve_blocks<duet::screw_dual<double>> of_poses(
      duet::cumulative_bspline<duet::screw_dual<double>>(knots, poses), order);
  const duet::split_curve_blocks<4> split(
      duet::split_bspline<double>(duet::bspline_basis<4>(knots), rotations, positions), order);
  const duet::pose_block block(order);
  double offset = .3;
  std::array<double, 3> bias{}, gravity{0, 0, -9.8}, point{1, 2, 3};
  std::array<double, 7> sensor{0, 0, .1, 0, 0, 0, 1};
  const duet::measurement_time when(5.9, .5);
  const vector3 measured(1, 2, 3);
  const auto check = [&](const auto& curve) {
    CHECK(allocations_of(orientation_residual(curve, when, rotations[4]),
                         curve.blocks(when, {&offset})) == 0);
    CHECK(allocations_of(point_residual(curve, when, measured),
                         curve.blocks(when, {&offset, point.data()})) == 0);
    CHECK(allocations_of(gyroscope_residual(curve, when, measured, block),
                         curve.blocks(when, {&offset, bias.data(), sensor.data()})) == 0);
    if constexpr (std::decay_t<decltype(curve)>::has_positions) {
      CHECK(allocations_of(pose_residual(curve, when, poses[4]), curve.blocks(when, {&offset})) ==
            0);
      CHECK(allocations_of(
                accelerometer_residual(curve, when, measured, block),
                curve.blocks(when, {&offset, bias.data(), sensor.data(), gravity.data()})) == 0);
    }
  };
  check(of_rotations);
  check(of_poses);
  check(split);
}

} // namespace
} // namespace test_interop_ceres_heap
