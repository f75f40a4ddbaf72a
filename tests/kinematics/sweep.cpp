// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "kinematics/arms.hpp"
#include "support/lanes.hpp"
#include "support/message.hpp"

#include <duet/duet.hpp>
#include <duet/kinematics/sweep.hpp>

namespace test_kinematics_sweep {
namespace {

using namespace duet;
using duet_test::message_of;
using duet_test::ulps_apart;

/// Sines of duet and of the C library are within 1 ulp; the errors of seven joints add up.
constexpr double limit = 16;

using angles = Eigen::Matrix<double, 7, 1>;
using matrix = Eigen::Matrix<double, 6, 7>;

std::vector<angles> configurations(std::size_t count) {
  duet_test::random_source random(5);
  std::vector<angles> result(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < 7; ++j) {
      result[i][j] = i == 1 ? 0 : i == 2 ? 1e-9 : random.uniform(-3, 3);
    }
  }
  if (count > 3) {
    result[3][2] = 1e7; // beyond the vector sine
  }
  return result;
}

TEST_CASE("poses, jacobians: a sweep equals single evaluations for any number of threads") {
  const auto known = robots::panda();
  const auto table = known.table();
  const bounded_chain<9> unsized = table;
  for (const std::size_t count : {0U, 1U, 3U, 4U, 5U, 18U}) {
    const auto theta = configurations(count);
    const auto check = [&](const auto& chain, const auto& frame) {
      std::vector<dual_quaternion<double>> a(count);
      std::vector<matrix> m(count), again(count);
      std::vector<value_and_jacobian<dual_quaternion<double>, matrix>> both(count);
      poses(chain, theta, a);
      jacobians(chain, theta, frame, m);
      poses_and_jacobians(chain, theta, frame, both, execution{3});
      jacobians(chain, std::span(theta), frame, std::span(again), execution{2});
      for (std::size_t i = 0; i < count; ++i) {
        CHECK(ulps_apart(a[i], chain.pose(theta[i])) <= limit);
        CHECK(ulps_apart(m[i], matrix(jacobian(chain, theta[i], frame))) <= limit);
        CHECK(m[i] == again[i]);
        CHECK(ulps_apart(both[i].jacobian, m[i]) <= limit);
        CHECK(ulps_apart(both[i].value, a[i]) <= limit);
      }
    };
    duet_test::for_each_frame([&](const auto& frame) { check(known, frame); });
    check(table, frame::body);
    check(unsized, frame::hybrid);
  }
}

TEST_CASE("poses: a cancelled sweep reports the completed results") {
  const auto arm = robots::panda();
  const auto theta = configurations(1000);
  for (const unsigned threads : {1U, 3U}) {
    std::vector<dual_quaternion<double>> a(theta.size());
    std::size_t done = 0;
    const auto report = [&](const progress& p) {
      done = p.done;
      return p.share() < 0.4;
    };
    try {
      poses(arm, theta, a, execution{threads, report});
      FAIL("not cancelled");
    } catch (const cancelled& error) {
      CHECK(done >= 400);
      REQUIRE(error.completed() >= done);
      CHECK(error.completed() < theta.size());
      for (std::size_t i = 0; i < a.size(); ++i) {
        CHECK((ulps_apart(a[i], arm.pose(theta[i])) <= limit) == (i < error.completed()));
      }
    }
  }
}

TEST_CASE("poses, jacobians: sweeps of other frames resize dynamic matrices") {
  const auto chain = robots::panda();
  const auto theta = configurations(6);
  std::vector<dual_quaternion<double>> a(6);
  std::vector<Eigen::MatrixXd> m(6); // are resized
  m[2].resize(6, 9);
  m[4].resize(6, 7);
  poses(chain, theta, a, one_core, 3);
  jacobians(chain, theta, frame::hybrid, m, one_core, chain.tip().at_point({0.1, 0, 0}));
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK(ulps_apart(a[i], chain.pose(theta[i], 3)) <= limit);
    const matrix expected =
        jacobian(chain, theta[i], frame::hybrid, chain.tip().at_point({0.1, 0, 0}));
    CHECK(m[i].cols() == 7);
    CHECK(ulps_apart(matrix(m[i]), expected) <= limit);
  }
  std::vector<value_and_jacobian<dual_quaternion<double>, Eigen::MatrixXd>> both(6);
  poses_and_jacobians(chain, theta, frame::hybrid, both);
  std::vector<Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 7>> bounded(6);
  jacobians(chain, theta, frame::hybrid, bounded);
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK(bounded[i] == both[i].jacobian);
  }
}

TEST_CASE("poses, jacobians: errors name index and size") {
  const auto chain = robots::panda();
  auto theta = configurations(5);
  std::vector<dual_quaternion<double>> a(4);
  CHECK(message_of([&] { poses(chain, theta, a); }) ==
        "duet: poses: 5 configurations, but room for 4 results");
  std::vector<Eigen::Matrix<double, 6, 6>> fixed(5);
  CHECK(message_of([&] { jacobians(chain, theta, frame::body, fixed); }) ==
        "duet: jacobians: result 0 is a 6 × 6 matrix, not 6 × 7");
  // Capacity for at most six columns, and maps, which cannot be resized.
  std::vector<Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6>> bounded(5);
  bounded[0].resize(6, 6);
  CHECK(message_of([&] { jacobians(chain, theta, frame::body, bounded); }) ==
        "duet: jacobians: result 0 is a 6 × 6 matrix, not 6 × 7");
  std::vector<double> memory(6 * 6);
  std::vector<Eigen::Map<Eigen::MatrixXd>> maps(5, {memory.data(), 6, 6});
  CHECK(message_of([&] { jacobians(chain, theta, frame::body, maps); }) ==
        "duet: jacobians: result 0 is a 6 × 6 matrix, not 6 × 7");
  std::vector<Eigen::VectorXd> wrong(4, Eigen::VectorXd::Zero(7));
  wrong[2].resize(5);
  CHECK(message_of([&] { poses(chain, wrong, a); }) ==
        "duet: poses: configuration 2 has 5 coordinates (expected 7)");
}

TEST_CASE("jacobian_rate, pose: batches equal their lanes") {
  const auto chain = robots::panda();
  const auto table = chain.table();
  std::vector<angles> theta = configurations(6), velocity = configurations(6);
  std::swap(velocity[0], velocity[4]);
  duet_test::check_lanes<4>(
      [&](const auto& x, const auto& v) { return jacobian_rate(chain, x, v, frame::body); }, limit,
      theta, velocity);
  using D = dual<double>;
  std::vector<Eigen::Matrix<D, 7, 1>> moving(theta.size());
  for (std::size_t i = 0; i < theta.size(); ++i) {
    for (Eigen::Index j = 0; j < 7; ++j) {
      moving[i][j] = D(theta[i][j], velocity[i][j] / 3e6);
    }
  }
  duet_test::check_lanes<4>([&](const auto& x) { return table.pose(x); }, 4 * limit, moving);
}

TEST_CASE("Hessians, efforts, analytical Jacobians and manipulability: batches equal their lanes") {
  const auto chain = robots::panda();
  const auto theta = configurations(7);
  std::vector<vector6<double>> wrenches;
  duet_test::random_source random(3);
  for (int k = 0; k < 5; ++k) {
    wrenches.emplace_back();
    for (int i = 0; i < 6; ++i) {
      wrenches.back()[i] = k == 1 ? 0 : random.uniform(-1, 1);
    }
  }
  duet_test::check_lanes<4>(
      [&](const auto& x) {
        const auto h = kinematic_hessian(chain, x, frame::body);
        return (h[0] + h[3] + h[6]).eval();
      },
      limit, theta);
  duet_test::check_lanes<4>(
      [&](const auto& x, const auto& w) { return joint_efforts(chain, x, w, frame::hybrid); },
      limit, theta, wrenches);
  duet_test::check_lanes<4>([&](const auto& x) { return pose_coordinates_jacobian(chain, x); },
                            limit, theta);
  const std::vector<angles> regular(theta.begin() + 3, theta.end());
  duet_test::check_lanes<4>([&](const auto& x) { return euler_jacobian<zyx>(chain, x); },
                            16 * limit, regular);
  duet_test::check_lanes<4>([&](const auto& x) { return manipulability(chain, x); }, 16 * limit,
                            regular);
  duet_test::check_lanes<4>(
      [&](const auto& x) { return manipulability_gradient(chain, x).gradient; }, 64 * limit,
      regular);
}

} // namespace
} // namespace test_kinematics_sweep
