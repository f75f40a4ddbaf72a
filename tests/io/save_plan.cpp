// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/core/text/csv.hpp>
#include <duet/duet.hpp>
#include <duet/io/save_plan.hpp>
#include <duet/robotics/time_parametrised.hpp>

#include <Eigen/Core>

#include <cstdio>
#include <fstream>

namespace test_io_save_plan {
namespace {

using namespace duet;
using vector = Eigen::Matrix<double, 2, 1>;

const std::string path = "test_io_save_plan.csv";

TEST_CASE("save_plan, save_trajectory: files contain all digits") {
  motion_plan plan;
  CHECK_THROWS_AS(save_plan(path, plan), invalid_input);
  for (int k = 0; k < 3; ++k) {
    plan.joints.push_back(Eigen::Vector2d(k / 3.0, -std::sqrt(k + 2.0)));
    plan.poses.push_back(pose(from_rotation_vector(Eigen::Vector3d(.1 * k, .2, 1e-300)),
                              Eigen::Vector3d(k / 7.0, 1e-17, 3)));
    plan.tau.push_back(k / 2.0);
    plan.deviations.push_back({1e-9 * k, 1e-8 / 3});
  }
  save_plan(path, plan);
  const csv_file file(path, 12);
  REQUIRE(file.rows().size() == 3);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& x = file.rows()[k].numbers;
    CHECK(x[0] == plan.tau[k]);
    CHECK(vector(x[1], x[2]) == plan.joints[k]);
    const auto gamma = pose_coordinates(plan.poses[k]);
    for (std::size_t i = 0; i < 7; ++i) {
      CHECK(x[3 + i] == gamma[Eigen::Index(i)]);
    }
    CHECK(x[10] == plan.deviations[k].translation);
    CHECK(x[11] == plan.deviations[k].rotation);
  }
  std::ifstream in(path);
  std::string header;
  std::getline(in, header);
  CHECK(header == "tau,theta0 [rad or m],theta1 [rad or m],x [m],y [m],z [m],qw,qx,qy,qz,"
                  "deviation [m],deviation [rad]");
  in.close();

  const auto q = time_optimal_trajectory(plan, vector(1, 1), vector(2, 2));
  save_trajectory(path, q, .1);
  const csv_file timed(path, 7);
  CHECK(timed.rows().size() == std::size_t(std::ceil(q.duration() / .1)) + 1);
  CHECK(timed.rows().back().numbers[0] == q.duration());
  CHECK(timed.rows()[2].numbers[4] == q(.2).velocity[1]);
  CHECK(timed.rows()[2].numbers[6] == q(.2).acceleration[1]);
  CHECK_THROWS_AS(save_trajectory(path, q, 0), invalid_input);
  std::remove(path.c_str());
  CHECK_THROWS_AS(save_plan("no/such/folder/plan.csv", plan), file_error);
}

TEST_CASE("save_plan: names of joints as columns; join_plans: plans that meet") {
  motion_plan first, second, other;
  for (int k = 0; k < 3; ++k) {
    for (motion_plan* plan : {&first, &second, &other}) {
      const double x = plan == &first ? k : k + 2;
      plan->joints.push_back(Eigen::Vector2d(x, plan == &other ? 1 : 0));
      plan->poses.push_back(dual_quaternion<double>(1));
      plan->tau.push_back(k / 2.0);
      plan->deviations.push_back({});
      plan->iterations = 5;
    }
  }
  second.reason = stop_reason::reached;
  const motion_plan both = join_plans(first, second);
  CHECK(both.joints.size() == 5);
  CHECK(both.joints.back()[0] == 4);
  CHECK(both.tau.back() == 2);
  CHECK(both.iterations == 10);
  CHECK(both.reason == stop_reason::reached);
  CHECK_THROWS_WITH_AS((void)join_plans(first, other),
                       "duet: join_plans: joint 1 ends at 0, but starts at 1", invalid_input);
  CHECK_THROWS_AS((void)join_plans(first, {}), invalid_input);

  save_plan(path, both, {"shoulder", "elbow"});
  std::ifstream in(path);
  std::string header;
  std::getline(in, header);
  CHECK(header.find("tau,shoulder [rad or m],elbow [rad or m],x [m]") == 0);
  in.close();
  std::remove(path.c_str());
  CHECK_THROWS_WITH_AS(save_plan(path, both, {"shoulder"}),
                       "duet: save_plan: 1 names of joints (expected 2)", invalid_input);
}

} // namespace
} // namespace test_io_save_plan
