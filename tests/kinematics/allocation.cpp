// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#define EIGEN_RUNTIME_NO_MALLOC

#include "kinematics/arms.hpp"
#include "kinematics/everything.hpp"
#include "support/allocations.hpp"

#include <duet/io/urdf.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/kinematics/sweep.hpp>
#include <duet/kinematics/tree_jacobian.hpp>

#include <filesystem>
#include <fstream>

namespace test_kinematics_allocation {

using namespace duet;

TEST_CASE("chains: evaluation allocates no memory") {
  const auto known = robots::panda();
  const bounded_chain<16> chain = robots::panda().table();
  const auto theta = duet_test::configurations(known.table(), 3).back();
  const std::size_t before = duet_test::allocations;
  double sum = duet_test::everything(known, theta);
  sum += duet_test::everything(known.table(), theta);
  sum += duet_test::everything(chain, theta);
  const std::size_t during = duet_test::allocations - before;
  CHECK(during == 0);
  CHECK(sum == sum);

  const std::size_t start = duet_test::allocations; // the counter itself works
  const std::vector<double> copy(3);
  CHECK(duet_test::allocations > start);
}

TEST_CASE("poses, jacobians: sweeps on one core allocate no memory") {
  const bounded_chain<16> chain = robots::panda().table();
  const auto theta = duet_test::configurations(robots::panda().table(), 9);
  std::vector<dual_quaternion<double>> tips(theta.size());
  std::vector<Eigen::Matrix<double, 6, 7>> columns(theta.size());
  const std::size_t before = duet_test::allocations;
  poses(chain, theta, tips);
  jacobians(chain, theta, frame::body, columns);
  const std::size_t during = duet_test::allocations - before;
  CHECK(during == 0);
  CHECK(columns.back().norm() > 1);
}

TEST_CASE("joint_trajectory: evaluation into the same state uses no heap") {
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(7);
  const joint_trajectory trajectory({{{0, 1, .5}, {0 * one, one, 2 * one, -one, 1}}}, {0, .7});
  const auto expected = trajectory(.5);
  joint_state<Eigen::VectorXd> state = trajectory(.1);
  const std::size_t before = duet_test::allocations;
  Eigen::internal::set_is_malloc_allowed(false);
  trajectory(.5, state);
  Eigen::internal::set_is_malloc_allowed(true);
  CHECK(duet_test::allocations == before);
  // s = t + t²/4 by hand, and the derivatives of the path.
  const double s = .5 + .5 * .25 / 2, speed = 1.25, rate = .5;
  CHECK(state.value[3] == doctest::Approx(s + 2 * s * s - s * s * s).epsilon(1e-15));
  const double slope = 1 + 4 * s - 3 * s * s, bend = 4 - 6 * s;
  CHECK(state.velocity[3] == doctest::Approx(speed * slope).epsilon(1e-15));
  CHECK(state.acceleration[3] ==
        doctest::Approx(rate * slope + speed * speed * bend).epsilon(1e-15));
  CHECK(state.value == expected.value);
  CHECK(state.velocity == expected.velocity);
  CHECK(state.acceleration == expected.acceleration);
}

TEST_CASE("kinematic_tree: poses and Jacobians allocate only their results") {
  robot_description robot{.links = {{"0"}}};
  for (int i = 1; i <= 30; ++i) {
    const std::string name = std::to_string(i);
    robot.links.push_back({name});
    robot.joints.push_back({name, i % 2 == 0 ? "0" : std::to_string(i / 2), name, {}});
  }
  const kinematic_tree tree(robot);
  const Eigen::VectorXd q = Eigen::VectorXd::LinSpaced(30, -1, 1);
  const auto hand = tree.link("29");
  const relative_frame seen{hand, tree.link("28")};
  const std::size_t before = duet_test::allocations; // matrices of Eigen are not counted
  double sum = norm(rotation(tree.pose(q, hand))) + norm(rotation(tree.pose(q, seen)));
  sum += jacobian(tree, q, frame::body, hand)(0, 0);
  sum += pose_and_jacobian(tree, q, frame::hybrid, seen).jacobian(0, 0);
  CHECK(duet_test::allocations - before == 0);
  CHECK(sum == sum);
  CHECK(tree.poses(q).size() == 31); // and the frames of the nodes
  CHECK(duet_test::allocations - before == 2);
}

TEST_CASE("read_urdf: the number of allocations is proportional to the number of links") {
  const std::string path = "test_kinematics_allocation.urdf";
  const auto allocations_of = [&](int count) {
    std::string text = "<robot name=\"r\"><link name=\"l0\"/>";
    for (int i = 1; i <= count; ++i) {
      const std::string name = "l" + std::to_string(i);
      text += "<link name=\"" + name + "\"/><joint type=\"fixed\" name=\"" + name +
              "\"><parent link=\"l" + std::to_string(i - 1) + "\"/><child link=\"" + name +
              "\"/></joint>";
    }
    std::ofstream(path) << text << "</robot>";
    const std::size_t before = duet_test::allocations;
    CHECK(read_urdf(path, "l0", "l" + std::to_string(count)).links().size() ==
          std::size_t(count + 1));
    return double(duet_test::allocations - before);
  };
  const double few = allocations_of(2500);
  const double many = allocations_of(20000);
  CHECK(few > 2500); // each has its own names
  CHECK(many / few > 7.9);
  CHECK(many / few < 8.1);
  std::filesystem::remove(path);
}

} // namespace test_kinematics_allocation
