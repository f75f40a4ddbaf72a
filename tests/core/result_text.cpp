// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/core/text/result_text.hpp>
#include <duet/derivative/derivative.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/derivative/sparse.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/robotics/inverse_kinematics.hpp>
#include <duet/spline/orientations.hpp>

// Results as text, field by field.

namespace test_core_result_text {

using duet::to_text;

TEST_CASE("to_text of a result: numbers, vectors and matrices are fields") {
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

TEST_CASE("to_text: vectors and matrices alone") {
  CHECK(to_text(Eigen::Vector3d(1, 2.5, -3)) == "(1, 2.5, -3)");
  CHECK(to_text(Eigen::RowVector2d(1, 2)) == "[1, 2]");
  CHECK(to_text(Eigen::Matrix2d::Identity()) == "[1, 0; 0, 1]");
}

TEST_CASE("to_text: rotations and poses alone and as fields") {
  using rotation = duet::quaternion<double>;
  const rotation quarter = duet::from_rotation_vector(Eigen::Vector3d(0, 0, std::acos(-1.0) / 2));
  CHECK(to_text(rotation(0.6, 0, 0, -0.8)) == "(0.6, 0, 0, -0.8)");
  CHECK(to_text(rotation(3, 1, 2, 9)) == "(3, 1, 2, 9)");
  const auto a = duet::pose(quarter, Eigen::Vector3d(1, -2, 0.5));
  CHECK(to_text(a) == "(0.707107, 0, 0, 0.707107) at (1, -2, 0.5)");
  CHECK(to_text(duet::dual_quaternion<double>(1)) == "(1, 0, 0, 0) at (0, 0, 0)");
  const duet::quaternion<float> one(1);
  CHECK(to_text(duet::pose(one, duet::vector3<float>(1, 2, 3))) == "(1, 0, 0, 0) at (1, 2, 3)");
  const auto far = duet::pose(normalized(rotation(1, 2, -3, 4)), Eigen::Vector3d(1e12, 3e12, 7e11));
  CHECK(to_text(far).ends_with(" at (1e+12, 3e+12, 7e+11)"));
  // Not poses: the norm of the real part, or its angle to the dual part, is wrong.
  for (const auto& other : {duet::dual_quaternion<double>(2 * a),
                            duet::make_dual_quaternion(quarter, rotation(1, 0, 0, 0)),
                            duet::make_dual_quaternion(quarter, rotation(std::nan("")))}) {
    CHECK(to_text(other) == duet::detail::message(other));
  }
  duet::lookup_table<duet::screw_dual<double>> table{{0, 1}, {a, a}};
  CHECK(to_text(table) ==
        "parameters: (0, 1)\nelements: (" + to_text(a) + ", " + to_text(a) + ")\n");
  const auto moved = duet::derivative(
      [](const auto& t) {
        using T = std::decay_t<decltype(t)>;
        return duet::pose(duet::quaternion<T>(T(1)), duet::vector3<T>(t, T(0), T(0)));
      },
      3.0);
  CHECK(to_text(moved).starts_with("value: (1, 0, 0, 0) at (3, 0, 0)\nderivative: (0"));
  CHECK(to_text(moved).find("at", 40) == std::string::npos);
}

TEST_CASE("to_text of a result: enumerations, lists of results and nested results are fields") {
  CHECK(to_text(duet::screw_motion<double>{duet::vector3<double>(0, 0, 1),
                                           duet::vector3<double>::Zero(), 0.5, 2,
                                           duet::screw_kind::screw}) ==
        "axis: (0, 0, 1)\nmoment: (0, 0, 0)\nangle: 0.5\ntranslation: 2\nkind: screw\n");
  duet::motion_plan plan;
  plan.joints = {Eigen::Vector2d(1, 2), Eigen::Vector2d(3, 4), Eigen::Vector2d(5, 6)};
  plan.tau = {0, 1, 2};
  plan.deviations = {{1, 2}, {3, 4}};
  plan.reason = duet::stop_reason::singular;
  CHECK(to_text(plan) == "joints: ((1, 2), ... (5, 6)) of 3\n"
                         "poses: ()\n"
                         "tau: (0, 1, 2)\n"
                         "deviations: ({translation 1, rotation 2}, {translation 3, rotation 4})\n"
                         "smallest_singular_value: inf\n"
                         "smallest_limit_margin: inf\n"
                         "smallest_clearance: inf\n"
                         "iterations: 0\n"
                         "reason: singular\n");
  const auto result = duet::inverse_kinematics_result{
      Eigen::Vector2d(1, 2), {0.25, 0.5}, 3, 1, duet::stop_reason::reached};
  CHECK(to_text(result) == "joints: (1, 2)\ndeviation.translation: 0.25\ndeviation.rotation: 0.5\n"
                           "iterations: 3\nrestarts: 1\nreason: reached\n");
}

} // namespace test_core_result_text
