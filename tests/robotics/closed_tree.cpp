// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "kinematics/loops.hpp"
#include "support/message.hpp"
#include "support/shared_tag.hpp"

#include <duet/duet.hpp>
#include <duet/robotics/closed_tree.hpp>

#include <Eigen/QR>
#include <Eigen/SVD>

namespace test_robotics_closed_tree {
namespace {

using namespace duet;
using duet_test::all_joints;
using duet_test::at_point;
using duet_test::coordinates_of;
using duet_test::four_bar;
using duet_test::max_abs_difference;
using duet_test::placement_at;
using duet_test::revolute_joint;
using duet_test::vector_of;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kinds = int(constraint_kind::distance) + 1;

/// A floating body with one constraint of a type, between rotated and displaced frames.
closed_chain_mechanism constrained_body(constraint_kind kind, double scale = 1) {
  robot_description robot;
  robot.links = {{"base"}, {"body"}};
  robot.joints = {{"free", "base", "body", {joint_kind::floating}}};
  return closed_chain_mechanism(
      kinematic_tree(robot),
      {{{kind,
         {"base", placement_at(.3, -.2, .5, .4 * scale, .1 * scale, -.2 * scale)},
         {"body", placement_at(-.1, .7, .2, -.3 * scale, .2 * scale, .5 * scale)},
         .8 * scale}}});
}

/// Pose of the second frame relative to the first.
dual_quaternion<double> seen(const closed_chain_mechanism& mechanism, const VectorXd& q) {
  const loop_constraint& loop = mechanism.loops()[0];
  const auto at = [&](const constraint_frame& frame) {
    return mechanism.tree().pose(q, mechanism.tree().link(frame.link)) * frame.offset.pose();
  };
  return conj(at(loop.first)) * at(loop.second);
}

TEST_CASE("closed_chain_mechanism: every constraint type has its number of equations and aligns "
          "its frames") {
  const std::array<int, kinds> equations{6, 5, 5, 4, 4, 3, 3, 1};
  duet_test::random_source random(5);
  for (int k = 0; k < kinds; ++k) {
    const auto kind = constraint_kind(k);
    CAPTURE(std::string(to_text(kind)));
    const closed_chain_mechanism mechanism = constrained_body(kind);
    CHECK(mechanism.equation_count() == equations[std::size_t(k)]);
    for (int i = 0; i < 5; ++i) {
      VectorXd guess(6);
      for (double& x : guess) {
        x = random.uniform(-2, 2);
      }
      const VectorXd q = mechanism.assemble(guess);
      const auto a = seen(mechanism, q);
      const Eigen::Matrix3d r = rotation_matrix(rotation(a));
      const Vector3d t = translation(a);
      const bool is_point = kind == constraint_kind::fixed || kind == constraint_kind::revolute ||
                            kind == constraint_kind::universal ||
                            kind == constraint_kind::spherical;
      const bool has_axis = kind == constraint_kind::fixed || kind == constraint_kind::revolute ||
                            kind == constraint_kind::prismatic ||
                            kind == constraint_kind::cylindrical || kind == constraint_kind::planar;
      if (is_point) {
        CHECK(t.norm() < 1e-12);
      }
      if (has_axis) { // in the same direction
        CHECK((r.col(2) - Vector3d::UnitZ()).norm() < 1e-12);
      }
      if (kind == constraint_kind::fixed || kind == constraint_kind::prismatic) {
        CHECK((r - Eigen::Matrix3d::Identity()).norm() < 1e-12);
      }
      if (kind == constraint_kind::prismatic || kind == constraint_kind::cylindrical) {
        CHECK(t.head<2>().norm() < 1e-12);
      }
      if (kind == constraint_kind::planar) {
        CHECK(std::abs(t[2]) < 1e-12);
      }
      if (kind == constraint_kind::universal) {
        CHECK(std::abs(r(0, 1)) < 1e-12);
      }
      if (kind == constraint_kind::distance) {
        CHECK(std::abs(t.norm() - .8) < 1e-12);
      }
      // The pivots of Eigen's QR of the rates.
      const MatrixXd j = mechanism.constraint_jacobian(q) * mechanism.units().asDiagonal();
      const MatrixXd rates = Eigen::JacobiSVD<MatrixXd, Eigen::FullPivHouseholderQRPreconditioner>(
                                 j, Eigen::ComputeFullU | Eigen::ComputeFullV)
                                 .matrixV()
                                 .rightCols(6 - equations[std::size_t(k)]);
      std::vector<int> pivots;
      if (rates.cols() > 0) {
        const Eigen::ColPivHouseholderQR<MatrixXd> qr(rates.transpose());
        const auto& order = qr.colsPermutation().indices();
        pivots.assign(order.data(), order.data() + rates.cols());
        std::sort(pivots.begin(), pivots.end());
      }
      CHECK(mechanism.independent_coordinates(q) == pivots);
    }
  }
}

TEST_CASE("constraint_jacobian: equals dual numbers for all constraint and joint types") {
  const kinematic_tree tree(all_joints());
  loop_constraints loops;
  const std::array links{"finger", "cart", "flange", "screw", "tool", "thumb", "body", "hand"};
  for (int k = 0; k < kinds; ++k) {
    loops.loops.push_back(
        {constraint_kind(k),
         {links[std::size_t(k)], placement_at(.3, .1 * k, -.2, .2, -.1, .3)},
         {links[std::size_t(k + 3) % 8], placement_at(-.4, .2, .1 * k, 0, .4, .1)},
         .5 + k});
  }
  const closed_chain_mechanism mechanism(tree, loops);
  for (const VectorXd& q : coordinates_of(tree, 10)) {
    const auto expected =
        jacobian<duet_test::shared_tag>([&](const auto& x) { return mechanism.residuals(x); }, q);
    CHECK(max_abs_difference(mechanism.residuals(q), expected.value) < 1e-14);
    CHECK(max_abs_difference(mechanism.constraint_jacobian(q), expected.jacobian) <
          1e-14 * std::max(1.0, expected.jacobian.cwiseAbs().maxCoeff()));
  }
}

TEST_CASE("closed_chain_mechanism: results do not depend on the unit of length") {
  const double mm = 1000;
  for (int k = 0; k < kinds; ++k) {
    const closed_chain_mechanism in_m = constrained_body(constraint_kind(k)),
                                 in_mm = constrained_body(constraint_kind(k), mm);
    const VectorXd guess = vector_of({.3, -.4, .2, .5, 1.1, -.7});
    VectorXd scaled = guess;
    scaled.head<3>() *= mm;
    CHECK(in_mm.length() == doctest::Approx(mm * in_m.length()).epsilon(1e-15));
    CHECK(max_abs_difference(in_m.residuals(guess), in_mm.residuals(scaled)) < 1e-13);
    VectorXd closed = in_mm.assemble(scaled);
    CHECK(in_m.independent_coordinates(in_m.assemble(guess)) ==
          in_mm.independent_coordinates(closed));
    closed.head<3>() /= mm;
    CHECK(max_abs_difference(in_m.assemble(guess), closed) < 1e-10);
  }
}

TEST_CASE("find_assembly_configurations: a four-bar has the solutions of Freudenstein's equation") {
  const double a = .2, b = .5, c = .4, d = .55;
  const closed_chain_mechanism mechanism = four_bar(a, b, c, d);
  for (const double theta : {-2.5, 0., .4, 2., 3.1}) {
    const auto search =
        find_assembly_configurations(mechanism, {0}, vector_of({theta}), {.random_starts = 30});
    CHECK(search.missing_probability() == 0);
    REQUIRE(search.positions.size() == 2);
    const double k = a * std::cos(theta) - d, s = a * std::sin(theta);
    const double q = (c * c + k * k + s * s - b * b) / (2 * c);
    for (const double side : {-1., 1.}) {
      const double psi = std::atan2(s, k) + side * std::atan2(std::sqrt(k * k + s * s - q * q), q);
      double nearest = 1;
      for (const assembly_configuration& each : search.positions) {
        CHECK(each.smallest_singular_value > .01);
        nearest = std::min(
            nearest, std::abs(std::remainder(each.coordinates[2] - psi, 2 * std::numbers::pi)));
      }
      CHECK(nearest < 1e-13);
    }
  }
  CHECK(find_assembly_configurations(four_bar(.2, .5, .4, 3), {0}, vector_of({0}),
                                     {.random_starts = 10})
            .positions.empty());
  CHECK(
      duet_test::message_of<loop_closure_failure>([] {
        (void)four_bar(.2, .5, .4, 3).assemble(vector_of({0, 0, 0}));
      })
          .starts_with(
              "duet: closed_chain_mechanism: no configuration near the initial guess, residual "));
}

TEST_CASE("find_assembly_configurations: joint limits bound the guesses and are reported") {
  robot_description robot = four_bar(.2, .5, .4, .55).tree().description();
  robot.joints[2].motion.kind = joint_kind::revolute;
  robot.joints[2].motion.limits = {0, 3};
  const closed_chain_mechanism mechanism(
      kinematic_tree(robot),
      {{{constraint_kind::revolute, {"coupler", at_point(.5, 0)}, {"rocker", at_point(.4, 0)}}}});
  const auto search =
      find_assembly_configurations(mechanism, {0}, vector_of({2}), {.random_starts = 40});
  int within = 0;
  for (const assembly_configuration& each : search.positions) {
    CHECK(each.within_limits == (each.coordinates[2] >= 0 && each.coordinates[2] <= 3));
    within += each.within_limits ? 1 : 0;
  }
  CHECK(within == 1);
}

TEST_CASE("closed: fixed coordinates keep their values, and the step is the shortest") {
  const closed_chain_mechanism mechanism = four_bar(.2, .5, .4, .55);
  const VectorXd q = mechanism.assemble(vector_of({2, -1.6, 2}), {0});
  CHECK(q[0] == 2);
  CHECK(std::abs(q[2] - 2.002371114722) < 1e-12);
  const VectorXd again = mechanism.assemble(q);
  CHECK(max_abs_difference(q, again) < 1e-14);
  // A guess next to the curve of configurations returns to it orthogonally to its tangent.
  const Eigen::JacobiSVD<MatrixXd> svd(mechanism.constraint_jacobian(q), Eigen::ComputeFullV);
  const VectorXd tangent = svd.matrixV().col(2);
  const VectorXd nearby = q + 1e-4 * vector_of({.3, .5, -.2});
  CHECK(std::abs((mechanism.assemble(nearby) - nearby).dot(tangent)) < 1e-8);
}

TEST_CASE("closed_chain_mechanism: errors name the constraint, the frame and the value") {
  using duet_test::message_of;
  const kinematic_tree tree = four_bar(.2, .5, .4, .55).tree();
  const auto message = [&](const loop_constraint& loop, const std::string& file = {}) {
    return message_of([&] { closed_chain_mechanism(tree, {{loop}, file}); });
  };
  const constraint_frame coupler{"coupler", at_point(.5, 0)}, rocker{"rocker", at_point(.4, 0)};
  CHECK(message({constraint_kind::revolute, {"couple", {}}, rocker})
            .starts_with(
                "duet: closed_chain_mechanism: loop 0, revolute: no link \"couple\": there are "
                "\"coupler\", "));
  CHECK(message({constraint_kind::revolute, {"couple", {}}, rocker, 0, 7}, "loops.txt")
            .starts_with("duet: loops.txt:7: revolute: no link \"couple\": "));
  CHECK(message({constraint_kind::spherical, coupler, coupler}) ==
        "duet: closed_chain_mechanism: loop 0, spherical: both frames are on the link \"coupler\"");
  CHECK(message({constraint_kind::distance, coupler, rocker}) ==
        "duet: closed_chain_mechanism: loop 0, distance: the length is 0 (expected > 0)");
  CHECK(message({constraint_kind::distance, coupler, rocker, std::nan("")}) ==
        "duet: closed_chain_mechanism: loop 0, distance: the length is nan (expected > 0)");
  constraint_frame infinite = coupler;
  infinite.offset.translation[1] = std::numeric_limits<double>::infinity();
  CHECK(message({constraint_kind::spherical, infinite, rocker}) ==
        "duet: closed_chain_mechanism: loop 0, spherical: the frame on \"coupler\" is not finite");
  DUET_CHECK_REFUSED("duet: frame_with_z_axis: the direction (0, 0, 0) is zero or not finite",
                     frame_with_z_axis({0, 0, 0}, {0, 0, 0}));
  const closed_chain_mechanism mechanism = four_bar(.2, .5, .4, .55);
  DUET_CHECK_REFUSED(
      "duet: closed_chain_mechanism: coordinate 3 does not exist, the mechanism has 3",
      mechanism.assemble(vector_of({0, 0, 0}), {3}));
  DUET_CHECK_REFUSED("duet: closed_chain_mechanism: the initial guess is not finite",
                     mechanism.assemble(vector_of({0, 0, std::nan("")})));
  DUET_CHECK_REFUSED("duet: kinematic_tree: 2 coordinates (expected 3)",
                     mechanism.assemble(vector_of({0, 0})));
  DUET_CHECK_REFUSED("duet: find_assembly_configurations: 0 values for 1 fixed coordinates",
                     find_assembly_configurations(mechanism, {0}, VectorXd()));
}

TEST_CASE("frame_with_z_axis: the z axis has any direction, also at extreme magnitudes") {
  for (const Vector3d& n :
       {Vector3d(0, 0, 1), Vector3d(0, 0, -1), Vector3d(1, 2, -.3), Vector3d(0, -1e-9, -1),
        Vector3d(3, 0, 0), Vector3d(0, 1e308, 1e308), Vector3d(5e-324, 5e-324, 0)}) {
    const auto at = frame_with_z_axis({1, 2, 3}, {n[0], n[1], n[2]});
    const Vector3d direction = (n / n.cwiseAbs().maxCoeff()).normalized();
    CHECK((rotation_matrix(at.rotation).col(2) - direction).norm() < 4e-15);
    CHECK(at.translation == std::array<double, 3>{1, 2, 3});
  }
}

TEST_CASE("find_assembly_configurations: stops at the missing probability or at the maximum number "
          "of guesses") {
  const closed_chain_mechanism mechanism = four_bar(.2, .5, .4, .55);
  const auto search = [&](const std::vector<int>& fixed, const assembly_search_options& options) {
    return find_assembly_configurations(mechanism, fixed,
                                        VectorXd::Constant(Eigen::Index(fixed.size()), 2), options);
  };
  CHECK(search({0}, {}).starts == 200);
  const assembly_search_result until =
      search({0}, {.random_starts = 1, .missing_probability = .02});
  CHECK(until.positions.size() == 2);
  CHECK(until.converged == 50); // 1 / 50 does not exceed the required probability
  CHECK(until.missing_probability() == 0);
  CHECK(search({0}, {.random_starts = 70, .missing_probability = .02}).starts == 70);
  CHECK(search({0}, {.random_starts = 1, .missing_probability = 0, .max_starts = 60}).starts == 60);
  CHECK(search({0}, {.random_starts = 80, .missing_probability = 0, .max_starts = 60}).starts ==
        80);
  // No coordinate is fixed: each guess finds another configuration.
  const assembly_search_result curve =
      search({}, {.random_starts = 1, .missing_probability = .5, .max_starts = 90});
  CHECK(curve.starts == 90);
  CHECK(int(curve.positions.size()) == curve.converged);
}

} // namespace
} // namespace test_robotics_closed_tree
