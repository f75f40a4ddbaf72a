// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "kinematics/trees.hpp"
#include "support/gap.hpp"
#include "support/message.hpp"
#include "support/random.hpp"
#include "support/shared_tag.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/derivative/tangent_coordinates.hpp>
#include <duet/kinematics/coupled_tree.hpp>

#include <array>
#include <cmath>
#include <type_traits>
#include <vector>

namespace test_kinematics_coupled_tree {
namespace {

using namespace duet;
using duet_test::all_joints;
using duet_test::for_each_frame;
using duet_test::max_abs_difference;

/// All coordinates of the tree as functions of four numbers.
constexpr auto waves = [](const auto& y) {
  using std::sin;
  using S = std::decay_t<decltype(y[0] + 0.)>;
  std::vector<S> q;
  for (int i = 0; i < 15; ++i) {
    q.push_back(sin(y[i % 4] + .3 * i) * y[(i + 1) % 4] + .1 * i);
  }
  return q;
};

template <class T>
Eigen::Matrix<T, 4, 1> along(const Eigen::Vector4d& y, const Eigen::Vector4d& v, const T& t) {
  Eigen::Matrix<T, 4, 1> x;
  for (int i = 0; i < 4; ++i) {
    x[i] = y[i] + t * v[i];
  }
  return x;
}

} // namespace

TEST_CASE("coupled_tree: Jacobians, rates and Hessians equal dual numbers through a coupling of "
          "all joints") {
  const coupled_tree tree(kinematic_tree(all_joints()), waves);
  const auto hand = tree.tree().link("hand").at_point({.1, .2, .3});
  const relative_frame relative{hand, tree.tree().link("screw")};
  duet_test::random_source random(3);
  for (int k = 0; k < 3; ++k) {
    Eigen::Vector4d y, v;
    for (int i = 0; i < 4; ++i) {
      y[i] = random.uniform(-2, 2);
      v[i] = random.uniform(-2, 2);
    }
    const auto check = [&](const auto& at) {
      for_each_frame([&](auto frame) {
        const auto by_duals = jacobian<duet_test::shared_tag>(
            [&](const auto& x) { return tree.pose(x, at); }, y, frame);
        const auto closed = pose_and_jacobian(tree, y, frame, at);
        CHECK(max_abs_difference(transform_matrix(closed.value), transform_matrix(by_duals.value)) <
              2e-14);
        CHECK(max_abs_difference(closed.jacobian, by_duals.jacobian) < 1e-13);
        CHECK(max_abs_difference(jacobian(tree, y, frame, at), closed.jacobian) < 1e-13);
        const auto rate =
            derivative<duet_test::shared_tag>(
                [&](const auto& t) { return jacobian(tree, along(y, v, t), frame, at); }, 0.)
                .derivative;
        const auto both = jacobian_with_rate(tree, y, v, frame, at);
        const double scale = 1 + rate.cwiseAbs().maxCoeff();
        CHECK(max_abs_difference(both.rate, rate) < 1e-13 * scale);
        CHECK(max_abs_difference(both.jacobian, closed.jacobian) < 1e-13);
        CHECK(max_abs_difference(jacobian_rate(tree, y, v, frame, at), both.rate) < 1e-13 * scale);
        const auto h = kinematic_hessian(tree, y, frame, at);
        Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(6, 4);
        for (int j = 0; j < 4; ++j) {
          sum += h[std::size_t(j)] * v[j];
        }
        CHECK(max_abs_difference(sum, rate) < 1e-13 * scale);
      });
    };
    check(hand);
    check(relative);
    check(tree.tree().link("finger").link);
    CHECK(max_abs_difference(translation(tree.poses(y)[0]), translation(tree.pose(y, 0))) < 1e-14);
    const auto m =
        jacobian<duet_test::shared_tag>([&](const auto& x) { return centre_of_mass(tree, x); }, y)
            .jacobian;
    CHECK(max_abs_difference(centre_of_mass_jacobian(tree, y), m) < 2e-14);
    const auto rate =
        derivative<duet_test::shared_tag>(
            [&](const auto& t) { return centre_of_mass_jacobian(tree, along(y, v, t)); }, 0.)
            .derivative;
    CHECK(max_abs_difference(centre_of_mass_jacobian_rate(tree, y, v), rate) < 1e-13);
    const auto h = centre_of_mass_hessian(tree, y);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(3, 4);
    for (int j = 0; j < 4; ++j) {
      sum += h[std::size_t(j)] * v[j];
    }
    CHECK(max_abs_difference(sum, rate) < 1e-13);
  }
}

TEST_CASE("coupled_tree: a linear coupling equals mimic joints") {
  auto robot = all_joints();
  const kinematic_tree follows(robot);
  for (tree_joint& joint : robot.joints) {
    joint.mimic.reset();
  }
  const coupled_tree coupled(kinematic_tree(robot), [](const auto& y) {
    using S = std::decay_t<decltype(y[0] + 0.)>;
    std::vector<S> q;
    for (int i = 0; i < 15; ++i) {
      q.push_back(y[i]);
      if (i == 11) { // the coordinate after `turn` mimics `grip`
        q.push_back(-2.5 * y[0] + .1);
      }
    }
    q.push_back(.5 * (-2.5 * y[0] + .1) - .2);
    return q;
  });
  CHECK(coupled.tree().size() == 17);
  for (const Eigen::VectorXd& y : duet_test::coordinates_of(follows, 3)) {
    for (const char* name : {"thumb", "screw", "tool"}) {
      const relative_frame at{follows.link(name), follows.link("finger")};
      CHECK(max_abs_difference(jacobian(coupled, y, frame::body, at),
                               jacobian(follows, y, frame::body, at)) < 1e-14);
    }
    CHECK(max_abs_difference(centre_of_mass_jacobian(coupled, y),
                             centre_of_mass_jacobian(follows, y)) < 1e-14);
  }
  CHECK(
      duet_test::message_of([&] {
        (void)coupled_tree(follows, [](const auto& y) { return y; }).pose(Eigen::Vector2d(1, 2), 0);
      }) == "duet: kinematic_tree: 2 coordinates (expected 15)");
}

} // namespace test_kinematics_coupled_tree
