// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "../../src/robotics/branches/chain_loop.hpp"
#include "../../src/robotics/branches/loop_equation.hpp"
#include "robotics/limits.hpp"
#include "robotics/singular_problems.hpp"
#include "support/random.hpp"
#include "support/samples.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>
#include <duet/robotics.hpp>

#include <Eigen/SVD>

namespace test_robotics_all_inverse_kinematics {
namespace {

using namespace duet;
using std::numbers::pi;
/// Chain with its number of joints at run time, so that templates are compiled once.
using chain = bounded_chain<16>;
using vector = detail::joint_vector<double, -16>;
using result = all_inverse_kinematics_result;

const chain puma = singular_problems::six_joints()[1].chain;

struct arm_kind {
  const char* name;
  bool parallel_2_3 = false, meet_1_2 = false, meet_4_5 = false, right_angles = false;
  std::vector<std::size_t> prismatic = {};
  int meeting = -1, parallel = -1; ///< first of three axes that meet or are parallel; −1: none
  solution_method method = solution_method::elimination;
  int max_solutions = 16; ///< maximum number of solutions
  bool is_certain = true; ///< true if the number of solutions is certain
};

/// Arm with random joint frames, except for the special geometry of a kind.
chain random_arm(const arm_kind& kind, duet_test::random_source& random) {
  std::array<joint<>, 6> joints;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto a = random.direction<4>();
    const auto at = [&] { return random.uniform(-1, 1); };
    joints[i].origin = {quaternion<double>(a[0], a[1], a[2], a[3]), {at(), at(), at()}};
    if (kind.right_angles) { // each axis perpendicular to the previous one
      joints[i].origin = {quaternion<double>(std::sqrt(.5), random.sign() * std::sqrt(.5), 0, 0),
                          {at(), at(), at()}};
    }
  }
  if (kind.parallel_2_3) {
    joints[2].origin.rotation = quaternion<double>(1);
  }
  if (kind.meet_1_2) {
    joints[1].origin.translation = {0, 0, 0};
  }
  if (kind.meet_4_5) {
    joints[4].origin.translation = {0, 0, 0};
  }
  for (const int k : {1, 2}) {
    if (kind.meeting >= 0) {
      joints[std::size_t(kind.meeting + k)].origin.translation = {0, 0, 0};
    }
    if (kind.parallel >= 0) { // or antiparallel
      joints[std::size_t(kind.parallel + k)].origin.rotation =
          k == 1 ? quaternion<double>(1) : quaternion<double>(0, 1, 0, 0);
    }
  }
  for (const std::size_t i : kind.prismatic) {
    joints[i].kind = joint_kind::prismatic;
  }
  const auto tool = random.direction<4>();
  return serial_chain<6>(joints, {quaternion<double>(tool[0], tool[1], tool[2], tool[3]),
                                  {random.uniform(-1, 1), .2, .3}});
}

vector configuration(const chain& arm, duet_test::random_source& random) {
  vector theta(arm.size());
  for (int i = 0; i < arm.size(); ++i) {
    const double max_solutions = arm.kind(i) == joint_kind::prismatic ? 1 : pi;
    theta[i] = random.uniform(-max_solutions, max_solutions);
  }
  return theta;
}

/// Largest difference of a coordinate, modulo full turns.
double joint_distance(const chain& arm, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  double largest = 0;
  for (int i = 0; i < arm.size(); ++i) {
    const double d = a[i] - b[i];
    largest = std::max(
        largest, std::abs(arm.kind(i) == joint_kind::prismatic ? d : std::remainder(d, 2 * pi)));
  }
  return largest;
}

bool contains(const chain& arm, const result& found, const vector& theta, double tolerance = 1e-7) {
  return std::any_of(found.solutions.begin(), found.solutions.end(), [&](const auto& s) {
    return joint_distance(arm, s.joints, theta) < tolerance;
  });
}

double smallest_singular_value(const chain& arm, const vector& theta) {
  const Eigen::MatrixXd j = jacobian(arm, theta, frame::hybrid);
  return Eigen::JacobiSVD<Eigen::MatrixXd>(j).singularValues().minCoeff();
}

/// Distance of the tip from the goal, by homogeneous matrices.
double matrix_distance(const chain& arm, const vector& theta, const dual_quaternion<double>& goal) {
  return (transform_matrix(arm.pose(theta)) - transform_matrix(goal)).norm();
}

/// Checks the fields of every solution, and that solutions are distinct and in order.
void check_solutions(const chain& arm, const result& found, const dual_quaternion<double>& goal) {
  for (std::size_t k = 0; k < found.solutions.size(); ++k) {
    const auto& s = found.solutions[k];
    CHECK(s.residual <= 1e-12);
    CHECK(matrix_distance(arm, s.joints, goal) <= 1e-11);
    CHECK(s.multiplicity == 1);
    CHECK(s.smallest_singular_value ==
          doctest::Approx(smallest_singular_value(arm, s.joints)).epsilon(1e-9));
    for (int i = 0; i < arm.size(); ++i) {
      const bool is_angle = arm.kind(i) != joint_kind::prismatic;
      CHECK((!is_angle || (s.joints[i] > -pi && s.joints[i] <= pi)));
    }
    for (std::size_t other = 0; other < k; ++other) {
      CHECK(joint_distance(arm, s.joints, found.solutions[other].joints) > 1e-7);
      CHECK_FALSE(std::lexicographical_compare(s.joints.begin(), s.joints.end(),
                                               found.solutions[other].joints.begin(),
                                               found.solutions[other].joints.end()));
    }
  }
}

/// Checks that the result at θ is complete and contains θ, and all of its solutions.
result check_complete(const chain& arm, const vector& theta) {
  const auto goal = arm.pose(theta);
  const result found = all_inverse_kinematics(arm, goal);
  CHECK(found.is_complete);
  CHECK(contains(arm, found, theta));
  check_solutions(arm, found, goal);
  return found;
}

/// The arm of R. Manseur and K. L. Doty, A robot manipulator with 16 real inverse kinematic
/// solution sets, 1989.
chain manseur_doty() {
  const double one = pi / 180;
  const std::array<dh_row<>, 6> rows{{{.a = .3, .alpha = pi / 2},
                                      {.a = 1, .alpha = one},
                                      {.d = .2, .alpha = pi / 2},
                                      {.a = 1.5, .alpha = one},
                                      {.alpha = pi / 2},
                                      {.alpha = one}}};
  return from_dh(rows);
}

TEST_CASE("all_inverse_kinematics: an arm with sixteen real solutions yields all of them") {
  Eigen::Matrix3d rotation;
  rotation << -.760117, -.641689, .102262, .133333, 0, .991071, -.635959, .766965, .085558;
  const auto goal =
      normalized(pose(from_rotation_matrix(rotation), Eigen::Vector3d(-1.140175, 0, 0)));
  const chain arm = manseur_doty();
  const result found = all_inverse_kinematics(arm, goal);
  CHECK(found.solutions.size() == 16);
  CHECK(found.complex_solutions == 0);
  CHECK(found.is_complete);
  check_solutions(arm, found, goal);
}

void check_kind(const arm_kind& kind, int count) {
  const std::string name = kind.name;
  CAPTURE(name);
  duet_test::random_source random(7);
  for (int k = 0; k < duet_test::sample_count(count); ++k) {
    CAPTURE(k);
    const chain arm = random_arm(kind, random);
    const vector theta = configuration(arm, random);
    const auto goal = arm.pose(theta);
    const result found = all_inverse_kinematics(arm, goal);
    CHECK(contains(arm, found, theta));
    CHECK((found.is_complete || !kind.is_certain));
    CHECK(found.method == kind.method);
    CHECK(found.solutions.size() % 2 == 0);
    const int all = int(found.solutions.size()) + found.complex_solutions;
    CHECK(all <= kind.max_solutions);
    if (name == "general" || kind.method != solution_method::elimination) {
      CHECK(all == kind.max_solutions);
    }
    check_solutions(arm, found, goal);
  }
}

TEST_CASE(
    "all_inverse_kinematics: the configuration of a goal is among the solutions of general arms") {
  check_kind({"general"}, 40);
  check_kind({.name = "2 and 3 parallel", .parallel_2_3 = true}, 20);
  check_kind({.name = "1 and 2 meet", .meet_1_2 = true}, 20);
  check_kind({.name = "right angles", .right_angles = true}, 20);
  check_kind({.name = "as in industry",
              .parallel_2_3 = true,
              .meet_1_2 = true,
              .meet_4_5 = true,
              .right_angles = true},
             20);
  check_kind({.name = "1 prismatic", .prismatic = {0}}, 10);
  check_kind({.name = "3 prismatic", .prismatic = {2}}, 10);
  check_kind({.name = "6 prismatic", .prismatic = {5}}, 10);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      CAPTURE(i);
      CAPTURE(j);
      check_kind({.name = "two prismatic",
                  .prismatic = {i, j},
                  .method = solution_method::two_prismatic,
                  .max_solutions = 8},
                 6);
    }
  }
}

TEST_CASE("all_inverse_kinematics: arms of special geometry are solved in closed form") {
  for (const int first : {0, 1, 2, 3}) {
    CAPTURE(first);
    check_kind({.name = "three axes meet",
                .meeting = first,
                .method = solution_method::spherical_wrist,
                .max_solutions = 8},
               20);
    check_kind({.name = "three axes are parallel",
                .parallel = first,
                .method = solution_method::parallel_axes,
                .max_solutions = 8},
               20);
  }
  check_kind({.name = "as in industry",
              .parallel_2_3 = true,
              .meet_1_2 = true,
              .right_angles = true,
              .meeting = 3,
              .method = solution_method::spherical_wrist,
              .max_solutions = 8},
             20);
  for (const auto& prismatic :
       {std::vector<std::size_t>{0, 1, 2}, std::vector<std::size_t>{0, 2, 4},
        std::vector<std::size_t>{2, 3, 5}}) {
    check_kind({.name = "three prismatic",
                .prismatic = prismatic,
                .method = solution_method::three_prismatic,
                .max_solutions = 2},
               10);
  }
}

/// Only the prismatic displacements have a length.
TEST_CASE(
    "all_inverse_kinematics: two prismatic joints and four axes through one point are solved") {
  std::array<joint<>, 6> joints;
  for (std::size_t i = 0; i < 6; ++i) {
    joints[i].origin = {quaternion<double>(std::sqrt(.5), std::sqrt(.5), 0, 0), {0, 0, 0}};
    joints[i].kind = i == 2 || i == 3 ? joint_kind::prismatic : joint_kind::revolute;
  }
  const chain arm = serial_chain<6>(joints);
  vector theta(6);
  theta << .3, -1.1, .4, -.5, .9, .2;
  check_complete(arm, theta);
}

/// Only the tool has a length.
TEST_CASE(
    "all_inverse_kinematics: six axes through one point are solved, with tools of any length") {
  std::array<joint<>, 6> joints;
  for (std::size_t i = 0; i < 6; ++i) {
    joints[i].origin.rotation =
        quaternion<double>(1, i % 2 == 0 ? 0 : 1, i % 2 == 0 ? 1 : 0, 0) * std::sqrt(.5);
  }
  vector theta(6);
  theta << .3, .4, -.7, .6, .2, .5;
  for (const double length : {0., .3, 1e6}) {
    CAPTURE(length);
    const chain arm = serial_chain<6>(joints, {quaternion<double>(1), {0, 0, length}});
    const auto goal = arm.pose(theta);
    const result found = all_inverse_kinematics(arm, goal);
    CHECK_FALSE(found.is_complete); // the joints have a self-motion
    CHECK(!found.solutions.empty());
    for (const auto& s : found.solutions) {
      CHECK(matrix_distance(arm, s.joints, goal) <= 1e-13 * std::max(1., length));
    }
  }
}

/// Round-off in the position of the tip is proportional to the displacements.
TEST_CASE("all_inverse_kinematics: prismatic displacements up to 1e6 arm lengths keep their "
          "relative accuracy") {
  duet_test::random_source random(9);
  for (const auto& prismatic :
       {std::vector<std::size_t>{0, 4}, std::vector<std::size_t>{3, 5},
        std::vector<std::size_t>{1, 2}, std::vector<std::size_t>{0, 2, 4}}) {
    for (const double scale : {1e3, 3e4, 1e6}) {
      CAPTURE(scale);
      const chain arm = random_arm({.name = "", .prismatic = prismatic}, random);
      vector theta = configuration(arm, random);
      for (const std::size_t i : prismatic) {
        theta[Eigen::Index(i)] *= scale;
      }
      const auto goal = arm.pose(theta);
      const result found = all_inverse_kinematics(arm, goal);
      CHECK(found.is_complete);
      CHECK(contains(arm, found, theta, 1e-11 * scale));
      const double size = detail::chain_screws(arm, (0 * theta).eval(), -1).size;
      for (const auto& s : found.solutions) {
        double max_displacement = size;
        for (const std::size_t i : prismatic) {
          max_displacement = std::max(max_displacement, std::abs(s.joints[Eigen::Index(i)]));
        }
        const auto error = pose_error_between(arm.pose(s.joints), goal);
        CHECK(s.residual ==
              doctest::Approx(std::max(error.translation / max_displacement, error.rotation))
                  .epsilon(1e-9));
        CHECK(s.residual <= 3e-13);
      }
    }
  }
}

/// In the first order of the joints twelve zeros are so close to each other that round-off
/// displaces each by their distance, and most of them off the unit circle.
TEST_CASE("all_inverse_kinematics: clustered zeros in one order of the joints lose no solutions") {
  struct crowded {
    std::array<std::array<double, 3>, 6> rows; ///< sign of α = ±π/2, a, d
    std::array<double, 6> theta;
  };
  const std::array<crowded, 3> all{
      {{{{{1, 0, 0},
          {-1, 0, 0},
          {-1, 0.23870172511524904, 0},
          {1, 0, -0.72702747444165239},
          {-1, 0.6737838385217606, 0.96967324836472635},
          {1, 0.58712490288770158, 0}}},
        {0.92038917308694546, -0.15328072737865461, -1.4611993191334693, -2.5639107355695572,
         2.7917140439844239, -1.0516473470571315}},
       {{{{-1, 0, 0},
          {-1, 0, 0},
          {-1, 0.13369581294062305, 0},
          {-1, 0, 0},
          {-1, 0.72187684456293333, 0.98294503611161732},
          {-1, 0.52343930791745408, 0.94897265323997826}}},
        {0.2517100054704714, -0.21229930387075607, 1.170077330449417, -2.2870843720317851,
         2.0680585616841229, -2.0420837878967775}},
       {{{{1, 0.37796444529949375, 0},
          {-1, 0, 0},
          {1, 0.10025599699812454, 0},
          {-1, 0, 0.35555860284353819},
          {1, 0.84883989393133585, -0.75104872624246433},
          {-1, 0.80751357280955216, 0.90529683754488999}}},
        {1.1769868211387788, 1.0848331247299454, 2.0190450256464936, -0.30578372955254102,
         -0.33992769020053593, -0.19872331297593632}}}};
  for (const crowded& each : all) {
    std::array<joint<>, 6> joints;
    vector theta(6);
    for (std::size_t i = 0; i < 6; ++i) {
      const auto& [sign, a, d] = each.rows[i];
      joints[i].origin = {quaternion<double>(std::sqrt(.5), sign * std::sqrt(.5), 0, 0),
                          {a, -d, 0}};
      theta[Eigen::Index(i)] = each.theta[i];
    }
    CHECK(check_complete(chain(joints), theta).solutions.size() == 8);
  }
}

TEST_CASE("all_inverse_kinematics: solutions that meet slowly, complex for displaced loops, are "
          "found") {
  // Two solutions are 0.1 apart, with a closure error below 1e-4 between them.
  const double part = pi / 12;
  const std::array<dh_row<>, 6> rows{{{.a = .25, .d = .1, .alpha = part * 12},
                                      {.a = .1, .d = .25, .alpha = part * -6, .theta = part * -7},
                                      {.a = .5, .d = 1, .alpha = part * 6, .theta = part * -8},
                                      {.a = .1, .alpha = part * 6},
                                      {.a = .1, .d = .5, .alpha = part * 6, .theta = part * -10},
                                      {.d = .2, .alpha = part * 6, .theta = part * 2}}};
  const chain arm = from_dh(rows);
  vector theta(6);
  theta << -2.163807244768, 0.034832850718, 2.374786580631, -2.085275319023, 2.143824946693,
      -2.146058028917;
  CHECK(smallest_singular_value(arm, theta) < 1e-3);
  for (int k = 0; k < 60; ++k) { // round-off selects the order of the joints
    CHECK(check_complete(arm, theta).solutions.size() == 6);
    theta[k % 6] += 1e-9 * (k % 7 + 1);
  }
}

/// Arms with right angles in configurations of quarter turns, where many solutions share angles.
TEST_CASE("all_inverse_kinematics: solutions that share angles are all found") {
  constexpr double q = pi / 2;
  const chain a = from_dh(std::array<dh_row<>, 6>{{{.a = .36, .d = .01, .alpha = q},
                                                   {.a = -.36, .d = .42, .alpha = q},
                                                   {.a = -.46, .d = .27, .alpha = -q},
                                                   {.a = .3, .d = .42},
                                                   {.a = .22, .d = -.12, .alpha = -q},
                                                   {.a = .29, .d = -.29, .alpha = -q}}});
  const chain b = from_dh(std::array<dh_row<>, 6>{{{.d = -.42, .alpha = q},
                                                   {.a = .12, .d = .41},
                                                   {.a = -.2, .d = -.41, .alpha = q},
                                                   {.d = -.24, .alpha = q},
                                                   {.a = .41, .d = -.28, .alpha = -q},
                                                   {.a = .11, .d = -.47, .alpha = q}}});
  const auto check = [](const chain& arm, const std::array<double, 6>& at, double unit,
                        std::size_t count) {
    const vector theta = unit * vector(Eigen::Map<const Eigen::Matrix<double, 6, 1>>(at.data()));
    CHECK(check_complete(arm, theta).solutions.size() == count);
  };
  check(a, {1, 2, -1, 2, 2, 1}, q, 10);
  check(b, {2, 1, 1, 2, -1, -1}, q, 6);
  std::array<joint<>, 6> xarm6;
  const std::array<std::array<double, 6>, 6> axes{{{0, 0, 1, 0, 0, 0},
                                                   {0, 1, 0, 0, 0, .267},
                                                   {0, 1, 0, .0535, 0, .2845},
                                                   {0, 0, -1, .0775, 0, -.3425},
                                                   {0, 1, 0, 0, 0, 0},
                                                   {0, 0, -1, .076, 0, -.097}}};
  for (std::size_t i = 0; i < 6; ++i) { // each point relative to the previous one
    const auto& [x, y, z, px, py, pz] = axes[i];
    xarm6[i].axis = {x, y, z};
    xarm6[i].origin = {quaternion<double>(1), {px, py, pz}};
  }
  check(serial_chain<6>(xarm6), {1, 24, -24, -1, 25, 19}, .125, 8);
}

/// At a singular goal a solution is found, or the result is not called complete.
TEST_CASE("all_inverse_kinematics: singular goals are not reported as certainly unreachable") {
  constexpr double q = pi / 2;
  const chain arm = from_dh(std::array<dh_row<>, 6>{{{.d = .4, .alpha = q},
                                                     {.a = .35},
                                                     {.alpha = q},
                                                     {.d = .3, .alpha = -q},
                                                     {.a = .003, .alpha = q},
                                                     {.d = .1}}});
  const auto check = [&](int code) {
    CAPTURE(code);
    vector theta(6);
    for (int i = 0, remaining = code; i < 6; ++i, remaining /= 4) {
      theta[i] = (remaining % 4 - 1) * q;
    }
    const result found = all_inverse_kinematics(arm, arm.pose(theta));
    CHECK_FALSE((found.solutions.empty() && found.is_complete));
    for (const auto& s : found.solutions) {
      CHECK(s.residual <= 1e-12);
    }
  };
  check(3 + 4 * (3 + 4 * (2 + 4 * (2 + 4 * (3 + 4 * 1)))));
  const int step = (4096 / duet_test::sample_count(100)) | 1; // odd: all angles of all joints occur
  for (int k = 0; k < 4096; k += step) {
    check(k);
  }
}

struct dh_task {
  std::array<std::array<double, 3>, 6> rows; ///< a, d, α
  std::array<double, 6> theta;
};
struct arm_at {
  chain arm;
  vector theta;
};
/// \param angle  maps numbers of the task to angles; the round-off of its product matters
arm_at arm_of(const dh_task& task, const auto& angle, const auto& coordinate) {
  std::array<dh_row<>, 6> rows;
  vector theta(6);
  for (std::size_t i = 0; i < 6; ++i) {
    rows[i].a = task.rows[i][0];
    rows[i].d = task.rows[i][1];
    rows[i].alpha = angle(task.rows[i][2]);
    theta[Eigen::Index(i)] = coordinate(task.theta[i]);
  }
  return {from_dh(rows), theta};
}
double twelfths(double x) { return x * pi / 12; }
double halves(double x) { return x * pi / 2; }

TEST_CASE(
    "all_inverse_kinematics: closed forms do not report a singular goal as certainly unreachable") {
  const std::array<dh_task, 3> tasks{
      {{{{{-.48, .47, -6}, {.48, 0, -6}, {-.27, -.43, -6}, {.2}, {-.18, -.2}, {-.28, 0, -6}}},
        {-3, 0, -7, -4, -2, 4}},
       {{{{-.42, .47, -6}, {0, .4, -6}, {0, 0, -6}, {0, .41, -6}, {0, -.5, -6}, {0, .38, 6}}},
        {5, -2, 10, 6, 12, 7}},
       {{{{-.32, -.45, -2}, {.26, .3, -8}, {0, 0, 8}, {0, 0, 10}, {.15, -.11, -2}, {.3, .1, -4}}},
        {12, -6, 0, 12, -6, -6}}}};
  for (const dh_task& task : tasks) {
    const auto [arm, theta] = arm_of(task, twelfths, twelfths);
    const result found = all_inverse_kinematics(arm, arm.pose(theta));
    CHECK_FALSE((found.solutions.empty() && found.is_complete));
    // The equations of the first one vanish identically, so that elimination is used.
    CHECK((&task != tasks.data() || found.method == solution_method::elimination));
  }
}

/// In loops displaced by 1e-5 these pairs of solutions are complex.
TEST_CASE("all_inverse_kinematics: pairs of solutions near a singular one are found") {
  const auto check = [](const arm_at& at, std::size_t count) {
    const result found = all_inverse_kinematics(at.arm, at.arm.pose(at.theta));
    CHECK(found.is_complete);
    CHECK(found.solutions.size() == count);
    CHECK(contains(at.arm, found, at.theta));
  };
  const dh_task crx{{{{0, .245, -1}, {.71, 0, 2}, {0, 0, -1}, {0, .54, 1}, {0, .15, -1}, {0, .16}}},
                    {-20, 9, -21, 25, -7, 0}};
  check(arm_of(crx, halves, [](double x) { return x / 8; }), 8);
  const dh_task folded{
      {{{.29, .27, 1}, {0, 0, 1}, {.42, 0, -1}, {0, -.11, 1}, {.09, 0, 1}, {.31, 0, -1}}},
      {1.542912, .002972, -1.598413, -1.481084, -.002983, -3.051963}};
  const auto at = arm_of(folded, halves, std::identity());
  const vector singular = pi / 2 * (vector(6) << 1, 0, -1, -1, 0, 2).finished();
  const result found = all_inverse_kinematics(at.arm, at.arm.pose(singular));
  CHECK(contains(at.arm, found, singular, 1e-5));
  CHECK(contains(at.arm, found, at.theta, 1e-5));
}

TEST_CASE("wrap_angle: angles are wrapped into half a turn as by std::remainder") {
  const double rotation = 2 * pi;
  for (const double start : {0., .3, -2., pi, 3 * pi, 5 * pi, 1e5}) {
    for (const double x : {start, -start, std::nextafter(start, 0), std::nextafter(start, 1e9)}) {
      const double nearest = std::remainder(x, rotation);
      CHECK(detail::wrap_angle(x) == (nearest <= -pi ? pi : nearest));
    }
  }
}

/// Elimination finds a subset of the solutions of the closed form, without spurious ones.
TEST_CASE("all_inverse_kinematics: closed forms and elimination agree") {
  duet_test::random_source random(11);
  int all = 0, both = 0;
  for (int k = 0; k < 10; ++k) {
    const arm_kind kind = k % 2 == 0 ? arm_kind{.name = "meet", .meeting = 3}
                                     : arm_kind{.name = "parallel", .parallel = 1};
    const chain arm = random_arm(kind, random);
    const vector theta = configuration(arm, random);
    const auto goal = arm.pose(theta);
    const result found = all_inverse_kinematics(arm, goal);
    const detail::branches_of_chain branches(arm, goal);
    for (const auto& x : detail::eliminated(branches.loop()).solutions) {
      CHECK(contains(arm, found, branches(x).joints));
      ++both;
    }
    all += int(found.solutions.size());
  }
  CHECK(both == all);
}

/// The outer joints of a straight wrist have a self-motion.
TEST_CASE("all_inverse_kinematics: a straight wrist yields a singular solution and an incomplete "
          "result") {
  const chain arm = puma;
  vector theta(6);
  theta << .3, .4, -.7, .6, 0, .5;
  const auto goal = arm.pose(theta);
  const result found = all_inverse_kinematics(arm, goal);
  CHECK_FALSE(found.is_complete);
  bool is_met = false;
  for (const auto& s : found.solutions) {
    CHECK(s.residual < 1e-12);
    CHECK(s.smallest_singular_value >= 0);
    is_met = is_met || ((s.joints - theta).head<3>().norm() < 1e-6 &&
                        std::abs(s.joints[3] + s.joints[5] - theta[3] - theta[5]) < 1e-6 &&
                        s.smallest_singular_value < 1e-8);
  }
  CHECK(is_met);
}

/// If two axes nearly coincide, angles that count as one do not determine their rotations
/// separately.
TEST_CASE(
    "all_inverse_kinematics: near singularities a result with missing solutions is not complete") {
  const chain ur5e = robots::ur5e().table();
  duet_test::random_source random(4);
  for (const chain& arm : {ur5e, puma}) {
    for (int k = 0; k < 10; ++k) {
      vector theta = configuration(arm, random);
      for (const int joint : {2, 4}) { // elbow and wrist
        for (const double offset :
             {1e-1, 1e-2, 1e-4, 1e-5, 3e-6, 1e-6, 3e-7, 1e-7, 3e-8, 1e-9, 0.}) {
          CAPTURE(joint);
          CAPTURE(offset);
          vector at = theta;
          at[joint] = offset;
          const result found = all_inverse_kinematics(arm, arm.pose(at));
          CHECK((contains(arm, found, at, 2e-6 + 1e-14 / std::max(offset, 1e-30)) ||
                 !found.is_complete));
          CHECK(found.is_complete == !(joint == 4 && offset == 0));
        }
      }
    }
  }
}

/// General arm in a configuration near a branch point, where the determinant of the Jacobian
/// changes sign.
TEST_CASE("all_inverse_kinematics: solutions at a branch point have multiplicity 2, near it 1") {
  duet_test::random_source random(5);
  for (int k = 0; k < 5; ++k) {
    const chain arm = random_arm({"general"}, random);
    vector theta = configuration(arm, random);
    const auto determinant = [&](double x) {
      vector at = theta;
      at[3] = x;
      return Eigen::Matrix<double, 6, 6>(jacobian(arm, at, frame::spatial)).determinant();
    };
    double low = -pi, high = low;
    while (high < pi && determinant(low) * determinant(high) > 0) {
      high += .1;
    }
    if (high >= pi) {
      continue; // no singularity in this direction
    }
    low = high - .1;
    for (int i = 0; i < 200; ++i) {
      const double middle = (low + high) / 2;
      (determinant(low) * determinant(middle) > 0 ? low : high) = middle;
    }
    for (const double offset : {0., 1e-9, 1e-5, 1e-3}) {
      CAPTURE(k);
      CAPTURE(offset);
      theta[3] = low + offset;
      const auto goal = arm.pose(theta);
      const result found = all_inverse_kinematics(arm, goal);
      CHECK(contains(arm, found, theta, 2e-6));
      int count = 0, nearest = 0;
      for (const auto& s : found.solutions) {
        count += s.multiplicity;
        nearest = joint_distance(arm, s.joints, theta) < 2e-6 ? s.multiplicity : nearest;
      }
      CHECK(count % 2 == 0);
      CHECK(nearest == (offset < 1e-8 ? 2 : 1));
    }
  }
}

TEST_CASE(
    "all_inverse_kinematics: within_limits states whether all joints are within their limits") {
  duet_test::random_source random(8);
  chain arm = random_arm({"general"}, random);
  const vector theta = configuration(arm, random);
  const auto goal = arm.pose(theta);
  arm.set_limits(2, {theta[2] - 1e-3, theta[2] + 1e-3});
  arm.set_limits(3, {theta[3] + 2 * pi - 1, theta[3] + 2 * pi + 1});
  const result found = all_inverse_kinematics(arm, goal);
  int inside = 0;
  for (const auto& s : found.solutions) {
    const bool is_inside = duet_test::is_within_limits(arm, s.joints);
    CHECK(s.within_limits == is_inside);
    inside += is_inside;
  }
  CHECK(inside >= 1);
  CHECK(inside < int(found.solutions.size()));
}

TEST_CASE(
    "all_inverse_kinematics: invalid goals and chains without six algebraic joints are rejected") {
  const auto goal = pose(quaternion<double>(1), Eigen::Vector3d(.1, .2, .3));
  DUET_CHECK_REFUSED("duet: all_inverse_kinematics: the chain has 7 moving joints (expected 6)",
                     all_inverse_kinematics(chain(robots::panda().table()), goal));
  DUET_CHECK_REFUSED("duet: all_inverse_kinematics: the goal is not a unit dual quaternion: "
                     "|p|^2 = 4, p.q = 0 (expected 1 and 0)",
                     all_inverse_kinematics(puma, 2 * goal));
  duet_test::random_source random(1);
  DUET_CHECK_REFUSED(
      "duet: all_inverse_kinematics: the chain has 4 prismatic joints (expected at most 3)",
      all_inverse_kinematics(random_arm({.name = "", .prismatic = {0, 1, 2, 3}}, random), goal));
  std::array<joint<>, 6> joints;
  joints[4].kind = joint_kind::helical;
  DUET_CHECK_REFUSED(
      "duet: all_inverse_kinematics: joint 4 is helical (expected revolute or prismatic)",
      all_inverse_kinematics(chain(serial_chain<6>(joints)), goal));
}

TEST_CASE("all_inverse_kinematics: a goal beyond reach has no solutions, for certain") {
  const chain arm = manseur_doty();
  const result found =
      all_inverse_kinematics(arm, pose(quaternion<double>(1), Eigen::Vector3d(20, 1, 2)));
  CHECK(found.solutions.empty());
  CHECK(found.complex_solutions == 16);
  CHECK(to_text(found.method) == std::string("elimination"));
  CHECK(found.is_complete);
}

} // namespace
} // namespace test_robotics_all_inverse_kinematics
