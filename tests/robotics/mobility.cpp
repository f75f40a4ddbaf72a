// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "kinematics/loops.hpp"

#include <duet/robotics.hpp>

namespace test_robotics_mobility {
namespace {

using namespace duet;
using duet_test::at_point;
using duet_test::four_bar;
using duet_test::revolute_joint;
using duet_test::ring;
using duet_test::vector_of;
using Eigen::VectorXd;

/// A link whose twist angle has a given sine per length.
std::array<double, 2> with_twist(double length, double ratio) {
  return {length, std::asin(length * ratio)};
}

TEST_CASE("mobility: a planar four-bar moves despite three redundant equations") {
  const closed_chain_mechanism mechanism = four_bar(.2, .5, .4, .55);
  const VectorXd q = mechanism.assemble(vector_of({2, -1, 1.7}), {0});
  const mobility_result m = mobility(mechanism, q);
  CHECK(m.count_is_wrong());
  CHECK(!m.is_singular());
  CHECK(to_text(m) == "mobility 1: counted -2, first order 1 here, 1 nearby");
  CHECK_THROWS_AS((void)mobility(mechanism, vector_of({2, -1, 1.7})), invalid_input);
  const closed_chain_mechanism by_ball = four_bar(.2, .5, .4, .55, constraint_kind::spherical);
  CHECK(mobility(by_ball, q).kutzbach == 0);
  CHECK(mobility(by_ball, q).mobility == 1);
}

TEST_CASE("mobility: Bennett's and Goldberg's linkages have mobility 1, a general ring has no "
          "configuration") {
  const auto a = with_twist(.6, .9), b = with_twist(.9, .9), c = with_twist(.45, .9);
  const closed_chain_mechanism bennett = ring({a, b, a, b});
  const auto assemblies =
      find_assembly_configurations(bennett, {0}, vector_of({.8}), {.random_starts = 30});
  REQUIRE(!assemblies.positions.empty());
  const VectorXd& q = assemblies.positions[0].coordinates;
  const mobility_result m = mobility(bennett, q);
  CHECK(m.mobility == 1);
  CHECK(m.kutzbach == -2);
  CHECK(m.evidence == mobility_evidence::sampled);
  // tan(θ1/2) tan(θ2/2) = ± sin((β + α)/2) / sin((β − α)/2), constant along the motion.
  const driven_motion by_first(bennett, q, {0});
  const double constant = std::sin((b[1] + a[1]) / 2) / std::sin((b[1] - a[1]) / 2);
  for (const double theta : {.3, .8, 1.9, 2.8}) {
    const VectorXd x = by_first(theta);
    CHECK(std::abs(std::abs(std::tan(x[0] / 2) * std::tan(x[1] / 2)) - std::abs(constant)) < 1e-12);
  }

  const closed_chain_mechanism goldberg = ring({{a[0] + c[0], a[1] + c[1]}, b, c, a, b});
  const auto of_five =
      find_assembly_configurations(goldberg, {0}, vector_of({.8}), {.random_starts = 60});
  REQUIRE(!of_five.positions.empty());
  int moving = 0;
  for (const assembly_configuration& each : of_five.positions) {
    const mobility_result n = mobility(goldberg, each.coordinates);
    CHECK(n.kutzbach == -1);
    moving += n.mobility == 1 ? 1 : 0;
  }
  CHECK(moving > 0);

  // The lengths of Bennett's linkage with another twist: no configuration exists.
  const closed_chain_mechanism general = ring({a, b, a, {b[0], b[1] + .1}});
  CHECK(find_assembly_configurations(general, {}, VectorXd(), {.random_starts = 30})
            .positions.empty());
}

TEST_CASE("mobility: a stretched frame is first-order flexible and rigid") {
  // Two collinear links between pins at the distance of their total length.
  robot_description robot;
  robot.links = {{"ground"}, {"first"}, {"second"}};
  robot.joints = {revolute_joint("first", "ground", {}),
                  revolute_joint("second", "first", at_point(.7, 0))};
  const closed_chain_mechanism shaky(
      kinematic_tree(robot),
      {{{constraint_kind::revolute, {"second", at_point(.5, 0)}, {"ground", at_point(1.2, 0)}}}});
  const mobility_result m = mobility(shaky, vector_of({0, 0}));
  CHECK(to_text(m) == "mobility 0: counted -3, first order 1 here, 1 nearby");
  CHECK(m.evidence == mobility_evidence::second_order_rigid);
  CHECK(m.is_singular());
  DUET_CHECK_REFUSED("duet: driven_motion: a rate of first satisfies the equations to first "
                     "order only: the mechanism does not move",
                     driven_motion(shaky, vector_of({0, 0}), {0}));

  // Closer pins: rigid to first order.
  const closed_chain_mechanism rigid(
      kinematic_tree(robot),
      {{{constraint_kind::revolute, {"second", at_point(.5, 0)}, {"ground", at_point(.9, 0)}}}});
  const auto assemblies =
      find_assembly_configurations(rigid, {}, VectorXd(), {.random_starts = 20});
  CHECK(assemblies.positions.size() == 2);
  for (const assembly_configuration& each : assemblies.positions) {
    CHECK(mobility(rigid, each.coordinates).mobility == 0);
    CHECK(mobility(rigid, each.coordinates).evidence == mobility_evidence::first_order_rigid);
  }
}

TEST_CASE("mobility: a parallelogram has two rates if flat, or if it carries a first-order "
          "flexible frame") {
  const closed_chain_mechanism flat = four_bar(.3, .8, .3, .8);
  const mobility_result m = mobility(flat, vector_of({0, 0, 0}));
  CHECK(to_text(m) == "mobility 1: counted -2, first order 2 here, 1 nearby");
  CHECK(m.is_singular());
  CHECK(mobility(flat, vector_of({1, -1, 1})).instantaneous == 1);

  robot_description robot = flat.tree().description();
  robot.links.insert(robot.links.end(), {{"first"}, {"second"}});
  robot.joints.push_back(revolute_joint("first", "coupler", at_point(0, .1)));
  robot.joints.push_back(revolute_joint("second", "first", at_point(.3, 0)));
  const closed_chain_mechanism both(
      kinematic_tree(robot),
      {{{constraint_kind::revolute, {"coupler", at_point(.8, 0)}, {"rocker", at_point(.3, 0)}},
        {constraint_kind::revolute, {"second", at_point(.3, 0)}, {"coupler", at_point(.6, .1)}}}});
  const mobility_result n = mobility(both, vector_of({1, -1, 1, 0, 0}));
  CHECK(to_text(n) == "mobility 1: counted -5, first order 2 here, 2 nearby"); // everywhere
}

TEST_CASE(
    "mobility: an open tree moves by all coordinates, a mechanism without coordinates not at all") {
  const kinematic_tree tree(duet_test::revolute_chain({{}, at_point(1, 0)}));
  const closed_chain_mechanism open(tree, {});
  CHECK(open.equation_count() == 0);
  CHECK(mobility(open, vector_of({1, 2})).mobility == 2);
  CHECK(open.independent_coordinates(vector_of({1, 2})) == std::vector<int>{0, 1});
  CHECK(open.assemble(vector_of({1, 2})) == vector_of({1, 2}));
  CHECK(driven_motion(open, vector_of({1, 2}), {0, 1})(vector_of({3, 4})) == vector_of({3, 4}));
  CHECK_THROWS_AS(driven_motion(open, vector_of({1, 2}), {0}), invalid_input);
  robot_description robot;
  robot.links = {{"a"}, {"b"}};
  robot.joints = {{"weld", "a", "b", {joint_kind::fixed, at_point(1, 0)}}};
  const closed_chain_mechanism still(
      kinematic_tree(robot), {{{constraint_kind::spherical, {"a", at_point(1, 0)}, {"b", {}}}}});
  CHECK(mobility(still, VectorXd()).mobility == 0);
  CHECK(still.independent_coordinates(VectorXd()).empty());
  const auto assemblies = find_assembly_configurations(still, {}, VectorXd(), {.random_starts = 3});
  CHECK(assemblies.positions.size() == 1);
}

TEST_CASE("mobility: independent equations give the Grübler–Kutzbach count") {
  // A plate on three rods has three degrees of freedom.
  robot_description robot;
  robot.links = {{"base"}, {"plate"}};
  robot.joints = {{"free", "base", "plate", {joint_kind::floating}}};
  loop_constraints rods;
  for (int i = 0; i < 3; ++i) {
    const double x = std::cos(2. * i), y = std::sin(2. * i);
    rods.loops.push_back(
        {constraint_kind::distance, {"base", at_point(x, y)}, {"plate", at_point(y, x, .1)}, 1.5});
  }
  const closed_chain_mechanism mechanism(kinematic_tree(robot), rods);
  const VectorXd q = mechanism.assemble(vector_of({.1, .2, 1.4, .1, .2, .3}));
  const mobility_result m = mobility(mechanism, q);
  CHECK(to_text(m) == "mobility 3: counted 3, first order 3 here, 3 nearby");
  CHECK(m.evidence == mobility_evidence::full_rank);
  CHECK(mechanism.independent_coordinates(q).size() == 3);
}

} // namespace
} // namespace test_robotics_mobility
