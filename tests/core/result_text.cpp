// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/core/text/result_text.hpp>
#include <duet/derivative/derivative.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/derivative/sparse.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/planning/inverse_kinematics.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <string>
#include <vector>

// Results as text, field by field.

namespace test_core_result_text {

using duet::to_text;

TEST_CASE("numbers, vectors and matrices") {
  const auto f = [](const auto& x) { return x[0] * x[1] * x[1]; };
  CHECK(to_text(duet::hessian(f, Eigen::Vector2d(1, 2))) ==
        "value: 4\ngradient: (4, 4)\nhessian: [0, 4; 4, 2]\n");
  CHECK(to_text(duet::derivative([](const auto& x) { return x / 3; }, 1.0)) ==
        "value: 0.333333\nderivative: 0.333333\n");
  CHECK(to_text(duet::derivative(
            [](const auto& t) {
              using T = std::decay_t<decltype(t)>;
              return duet::quaternion<T>(t, T(1), T(2), t * t);
            },
            3.0)) == "value: (3, 1, 2, 9)\nderivative: (1, 0, 0, 6)\n");
  const auto squares = [](const auto& x) {
    auto y = x;
    for (auto& each : y) {
      each *= each;
    }
    return y;
  };
  CHECK(to_text(duet::jacobian(squares, std::vector<double>{1, 2})) ==
        "value: (1, 4)\njacobian: [2, 0; 0, 4]\n");
  CHECK(to_text(duet::jacobian(squares, std::vector<double>(20, 1.0)))
            .starts_with("value: (1, 1, 1, 1, ... 1, 1, 1, 1) of 20\n"));
  Eigen::SparseMatrix<double> structure(2, 2);
  structure.setIdentity();
  CHECK(to_text(duet::sparse_jacobian(squares, std::vector<double>{1, 2}, structure)) ==
        "value: (1, 4)\njacobian: 2 x 2, 2 entries\n");
}

TEST_CASE("vectors and matrices by themselves") {
  CHECK(to_text(Eigen::Vector3d(1, 2.5, -3)) == "(1, 2.5, -3)");
  CHECK(to_text(Eigen::RowVector2d(1, 2)) == "[1, 2]");
  CHECK(to_text(Eigen::Matrix2d::Identity()) == "[1, 0; 0, 1]");
}

TEST_CASE("enumerations, lists of results, results in results") {
  CHECK(to_text(duet::screw_motion<double>{duet::vector3<double>(0, 0, 1),
                                           duet::vector3<double>::Zero(), 0.5, 2,
                                           duet::screw_kind::screw}) ==
        "axis: (0, 0, 1)\nmoment: (0, 0, 0)\nangle: 0.5\ntranslation: 2\nkind: screw\n");
  duet::motion_plan<2> plan;
  plan.joints = {Eigen::Vector2d(1, 2), Eigen::Vector2d(3, 4), Eigen::Vector2d(5, 6)};
  plan.tau = {0, 1, 2};
  plan.deviations = {{1, 2}, {3, 4}};
  plan.reason = duet::stop_reason::singular;
  CHECK(to_text(plan) == "joints: ((1, 2), ... (5, 6)) of 3\n"
                         "poses: ()\n"
                         "tau: (0, 1, 2)\n"
                         "deviations: ({length 1, angle 2}, {length 3, angle 4})\n"
                         "smallest_singular_value: inf\n"
                         "smallest_limit_margin: inf\n"
                         "smallest_clearance: inf\n"
                         "iterations: 0\n"
                         "reason: singular\n");
  const auto found = duet::inverse_kinematics_result<2>{
      Eigen::Vector2d(1, 2), {0.25, 0.5}, 3, 1, duet::stop_reason::reached};
  CHECK(to_text(found) == "joints: (1, 2)\ndeviation.length: 0.25\ndeviation.angle: 0.5\n"
                          "iterations: 3\nrestarts: 1\nreason: reached\n");
}

} // namespace test_core_result_text
