// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "robotics/chains.hpp"
#include "support/message.hpp"
#include "support/multiprecision.hpp"

#include <duet/robotics.hpp>

namespace test_robotics_goals {
namespace {

using namespace duet;
using chain = duet_test::any_chain;
using vector = duet_test::any_joints;
using duet_test::configuration;
using duet_test::is_within_limits;
using duet_test::real_50;
using wide_vector = vector3<real_50>;
using wide_matrix = Eigen::Matrix<real_50, 3, 3>;
using std::numbers::pi;

/// Ten joints with axes in all directions.
chain snake() {
  std::array<joint<>, 10> joints;
  for (std::size_t i = 0; i < 10; ++i) {
    joints[i].origin.translation = {.1, .05, .08};
    joints[i].axis = {double(i % 3 == 0), double(i % 3 == 1), double(i % 3 == 2)};
    joints[i].limits = {-1.5, 1.2};
  }
  return serial_chain<10>(joints, {quaternion<double>(1), {.1, 0, 0}});
}

vector3<double> direction(duet_test::random_source& random) {
  const auto n = random.direction<3>();
  return {n[0], n[1], n[2]};
}

dual_quaternion<double> anywhere(duet_test::random_source& random) {
  const auto q = random.direction<4>();
  const auto x = [&] { return random.uniform(-1, 1); };
  return pose(quaternion<double>(q[0], q[1], q[2], q[3]), vector3<double>(x(), x(), x()));
}

/// Reference by matrices in 50 digits: position of the tip in the frame of a region, tilt of its
/// axis, and rotation angle about the axis once the tilt is removed.
struct region_coordinates {
  wide_vector at;
  real_50 tilt, angle;

  region_coordinates(const dual_quaternion<real_50>& tip, const task_space_region& region) {
    const auto frame = transform_matrix(dual_quaternion<real_50>(region.frame));
    const auto tip_matrix = transform_matrix(tip);
    const wide_matrix axes = frame.topLeftCorner<3, 3>();
    at = axes.transpose() * (tip_matrix.topRightCorner<3, 1>() - frame.topRightCorner<3, 1>());
    const wide_matrix r = axes.transpose() * tip_matrix.topLeftCorner<3, 3>();
    const wide_vector n(region.axis[0], region.axis[1], region.axis[2]);
    const wide_vector tilted = r * n;
    const wide_vector across = n.cross(tilted);
    tilt = atan2(across.norm(), n.dot(tilted));
    // Rodrigues' formula: the smallest rotation that takes n to its tilted direction.
    wide_matrix k;
    k << 0, -across[2], across[1], across[2], 0, -across[0], -across[1], across[0], 0;
    const wide_matrix tilting = wide_matrix::Identity() + k + k * k / real_50(1 + n.dot(tilted));
    const wide_matrix twist = tilting.transpose() * r;
    int smallest = 0;
    n.cwiseAbs().minCoeff(&smallest);
    const wide_vector p = n.cross(wide_vector::Unit(smallest));
    const wide_vector q = twist * p;
    angle = atan2(n.dot(p.cross(q)), p.dot(q));
  }
};

/// Violation of a region by a tip, in length and angle.
pose_error outside(const chain& arm, const vector& theta, const task_space_region& region) {
  const Eigen::Matrix<real_50, Eigen::Dynamic, 1> exact = theta.cast<real_50>();
  const region_coordinates coordinates(arm.pose(exact), region);
  pose_error result;
  for (int i = 0; i < 3; ++i) {
    const auto k = std::size_t(i);
    result.translation =
        std::max({result.translation, double(real_50(region.lower[k]) - coordinates.at[i]),
                  double(coordinates.at[i] - real_50(region.upper[k]))});
  }
  result.rotation = std::max(0., double(coordinates.tilt - real_50(region.max_tilt)));
  const double angle(coordinates.angle),
      centre = (region.rotation_lower + region.rotation_upper) / 2;
  const double half = (region.rotation_upper - region.rotation_lower) / 2;
  const double from_centre = std::abs(std::remainder(angle - centre, 2 * pi));
  result.rotation = std::max(result.rotation, from_centre - half);
  return result;
}

struct made_goal {
  const char* name;
  task_space_region region;
};

/// Goals that a pose of the tip fulfils.
std::vector<made_goal> goals_at(const dual_quaternion<double>& tip,
                                duet_test::random_source& random) {
  const vector3<double> n = direction(random), p = translation(tip);
  const vector3<double> d = rotate(rotation(tip), n);
  const auto up_to = [&](double maximum) { return random.uniform(0, maximum); };
  // A region whose frame is tilted and rotated relative to the tip, which still is within it.
  const vector3<double> axis = direction(random);
  const vector3<double> across = axis.cross(direction(random)).normalized();
  const double tilt = up_to(.3), angle = random.uniform(-3, 3);
  const auto tilting = exp(vector3<double>(tilt / 2 * across));
  const auto twist = exp(vector3<double>(angle / 2 * axis));
  const quaternion<double> frame = rotation(tip) * conj(tilting * twist);
  const vector3<double> shift(up_to(.1), -up_to(.1), up_to(.02));
  const task_space_region region{.frame = pose(frame, vector3<double>(p - rotate(frame, shift))),
                                 .lower = {shift[0] - up_to(.01), shift[1] - up_to(.02), shift[2]},
                                 .upper = {shift[0] + up_to(.05), shift[1], shift[2] + up_to(.05)},
                                 .axis = {axis[0], axis[1], axis[2]},
                                 .max_tilt = tilt + up_to(.1),
                                 .rotation_lower = angle - up_to(.2),
                                 .rotation_upper = angle + up_to(.2)};
  auto line = position_goal(p);
  line.upper[2] = std::numeric_limits<double>::infinity();
  return {{"position", position_goal(p)},
          {"pointing", pointing_goal(n, d)},
          {"position and pointing", position_and_pointing_goal(p, n, d)},
          {"free axis", free_axis_goal(tip, n)},
          {"cone", position_and_pointing_goal(p, n, (d + .1 * direction(random)).normalized(), .2)},
          {"half a line", line},
          {"whole pose", {.frame = tip, .axis = {n[0], n[1], n[2]}}},
          {"region", region}};
}

TEST_CASE("inverse_kinematics: partial goals of known configurations are reached, six arms") {
  const std::uint64_t seed = 71;
  CAPTURE(seed);
  duet_test::random_source random(seed);
  auto all = duet_test::known_arms();
  all.push_back(duet_test::every_joint());
  all.push_back(snake());
  for (const chain& arm : all) {
    CAPTURE(&arm - all.data());
    std::array<int, 8> solved{};
    for (int k = 0; k < 40; ++k) {
      const auto tip = arm.pose(configuration(arm, random));
      const vector start = configuration(arm, random);
      const auto goals = goals_at(tip, random);
      for (std::size_t g = 0; g < goals.size(); ++g) {
        const auto& region = goals[g].region;
        const auto found = inverse_kinematics(arm, region, start, {.tolerance = 1e-9});
        const auto deviation = outside(arm, found.joints, region);
        const bool is_true =
            deviation.translation <= 1e-9 + 1e-14 && deviation.rotation <= 1e-9 + 1e-13;
        solved[g] +=
            found.reason == stop_reason::reached && is_true && is_within_limits(arm, found.joints);
      }
    }
    for (const int count : solved) {
      CHECK(count == 40);
    }
  }
}

TEST_CASE("task_space_region: rows of the constraint are derivatives of the errors") {
  duet_test::random_source random(72);
  for (int k = 0; k < 100; ++k) {
    const auto frame = anywhere(random);
    const vector3<double> n = direction(random);
    const task_space_region range{.frame = frame,
                                  .lower = {-1, -2, -3},
                                  .upper = {3, 2, 1},
                                  .axis = {n[0], n[1], n[2]},
                                  .max_tilt = .3,
                                  .rotation_lower = -.4,
                                  .rotation_upper = .2};
    task_space_region exact = range;
    exact.lower = exact.upper = {0, 0, 0};
    exact.max_tilt = exact.rotation_lower = exact.rotation_upper = 0;
    for (const bool is_exact : {false, true}) {
      const task_space_region& region = is_exact ? exact : range;
      const auto tip = is_exact ? frame : anywhere(random); // equations hold at the solution
      const auto rows = region.constraint(tip).matrix;
      for (int j = 0; j < 6; ++j) {
        const double h = 1e-6;
        const auto moved = [&](double displacement) {
          vector3<double> t = translation(tip), half(0, 0, 0);
          (j < 3 ? t[j] : half[j - 3]) += (j < 3 ? displacement : displacement / 2);
          return region.constraint(pose(exp(half) * rotation(tip), t));
        };
        const auto after = moved(h), before = moved(-h);
        for (int i = 0; i < 6; ++i) {
          const double lower_rate = (before.lower[i] - after.lower[i]) / (2 * h);
          const double upper_rate = (before.upper[i] - after.upper[i]) / (2 * h);
          if (after.lower[i] > -std::numeric_limits<double>::infinity()) {
            CHECK(std::abs(rows(i, j) - lower_rate) < 1e-7 * (1 + std::abs(lower_rate)));
          }
          CHECK(std::abs(rows(i, j) - upper_rate) < 1e-7 * (1 + std::abs(upper_rate)));
        }
      }
    }
  }
}

TEST_CASE("task_space_region: constraints at bounds and for opposite axes") {
  const quaternion<double> one(1);
  const vector3<double> x(1, 0, 0), z(0, 0, 1), zero(0, 0, 0);
  // The axis is opposite to its goal: every direction of rotation is equivalent, one is chosen.
  const auto opposite = pointing_goal(z, -z).constraint(pose(one, zero));
  CHECK(opposite.lower.norm() == doctest::Approx(pi));
  CHECK(opposite.matrix.allFinite());
  const auto aligned = pointing_goal(z, z).constraint(pose(one, zero));
  CHECK(aligned.lower.norm() < 1e-15);
  // Only three lengths are constrained, along the axes of the region.
  const auto position = position_goal(x).constraint(pose(one, zero));
  CHECK(position.lower.head<3>() == x);
  CHECK(position.matrix.topLeftCorner<3, 3>() == Eigen::Matrix3d::Identity());
  CHECK(position.matrix.bottomRows<3>().isZero(0));
  // Turns are counted to the nearer edge.
  task_space_region angle_region{
      .frame = pose(one, zero), .max_tilt = pi, .rotation_lower = 3, .rotation_upper = 3.2};
  const auto at = [&](double angle) {
    return angle_region.constraint(pose(exp(vector3<double>(0, 0, angle / 2)), zero));
  };
  CHECK(at(2.9).lower[5] == doctest::Approx(.1));
  CHECK(at(-2.9).upper[5] == doctest::Approx(-(2 * pi - 2.9 - 3.2)));
  CHECK(at(3.1).lower[5] < 0);
  CHECK(at(3.1).upper[5] > 0);
  // How far from a point.
  task_space_region box = position_goal(vector3<double>(1, 2, 3));
  box.upper = {1, 1, 1};
  CHECK(box.distance_from(zero) == doctest::Approx(std::sqrt(14)));
  CHECK(box.distance_from(vector3<double>(1.5, 2.5, 3.5)) == 0);
  CHECK(box.distance_from(vector3<double>(4, 2.5, 3.5)) == doctest::Approx(2));
}

TEST_CASE("equation_goal: a tip on a sphere that points to its centre is found") {
  const vector3<double> centre(.4, .1, .3);
  const equation_goal goal{[&](const auto& tip) {
    using S = std::decay_t<decltype(translation(tip)[0])>;
    const vector3<S> from = translation(tip) - centre.cast<S>();
    const auto length = from.norm();
    const vector3<S> axis = rotate(rotation(tip), vector3<S>(S(0), S(0), S(1)));
    const vector3<S> across = axis.cross(vector3<S>(-from / length));
    return std::array<S, 6>{length - .2, S(0), S(0), across[0], across[1], across[2]};
  }};
  static_assert(TipGoal<decltype(goal)>);
  duet_test::random_source random(73);
  for (const chain& arm : {chain(robots::panda().table()), chain(robots::ur5e().table())}) {
    int solved = 0;
    for (int k = 0; k < 20; ++k) {
      const auto found =
          inverse_kinematics(arm, goal, configuration(arm, random), {.tolerance = 1e-10});
      const auto tip = arm.pose(found.joints);
      const vector3<double> from = translation(tip) - centre;
      const vector3<double> across =
          rotate(rotation(tip), vector3<double>(0, 0, 1)).cross(from.normalized());
      solved += found.reason == stop_reason::reached && std::abs(from.norm() - .2) < 2e-10 &&
                across.norm() < 2e-10 && is_within_limits(arm, found.joints);
    }
    CHECK(solved == 20);
  }
}

TEST_CASE("inverse_kinematics: unreachable partial goals report the reason") {
  const chain panda = robots::panda().table();
  const vector centre = (lower_limits(panda) + upper_limits(panda)) / 2;
  const auto far =
      inverse_kinematics(panda, position_goal({1.4, 0, .3}), centre, {.max_restarts = 3});
  CHECK(far.reason == stop_reason::out_of_reach);
  CHECK(far.restarts == 3);
  // A box of which only a corner is near enough.
  auto box = position_goal({.5, .5, .3});
  box.upper = {3, 3, 3};
  CHECK(inverse_kinematics(panda, box, centre).reason == stop_reason::reached);
  box.lower = {2.5, 2.5, 0};
  CHECK(inverse_kinematics(panda, box, centre).reason == stop_reason::out_of_reach);

  // A prismatic joint whose range is too short for the height.
  const chain scara = duet_test::scara();
  const vector start = vector::Constant(4, .05);
  CHECK(inverse_kinematics(scara, position_goal({.4, .2, .1}), start).reason ==
        stop_reason::reached);
  const auto high = inverse_kinematics(scara, position_goal({.4, .2, .3}), start);
  CHECK(high.reason == stop_reason::joint_limit);
  CHECK(high.deviation.translation == doctest::Approx(.1).epsilon(1e-6));
  // Its axis always points down: nothing that joints could do about it.
  const auto tilted =
      inverse_kinematics(scara, pointing_goal({0, 0, 1}, {0, std::sin(.3), -std::cos(.3)}), start);
  CHECK(tilted.reason != stop_reason::reached);
  CHECK(tilted.deviation.rotation == doctest::Approx(.3));
  CHECK(inverse_kinematics(scara, pointing_goal({0, 0, 1}, {0, std::sin(.3), -std::cos(.3)}, .31),
                           start)
            .reason == stop_reason::reached);
  // Within the circle that a stretched arm leaves out: it is folded.
  const std::array<dh_row<>, 2> two{{{.a = .5}, {.a = .3}}};
  const chain planar = from_dh(two);
  const auto inner = position_goal({.1, 0, 0});
  const auto folded = inverse_kinematics(planar, inner, vector::Constant(2, .3));
  CHECK(folded.reason == stop_reason::no_progress);
  CHECK(folded.deviation.translation >= .1 - 1e-12);
  CHECK(folded.deviation.translation < .12);
}

TEST_CASE("task_space_region: regions without a pose are rejected") {
  const chain arm = robots::panda().table();
  const vector start = vector::Zero(7).cwiseMin(upper_limits(arm));
  const double infinity = std::numeric_limits<double>::infinity();
  struct row {
    std::string message; ///< the beginning
    std::function<void(task_space_region&)> change;
  };
  for (const row& each : std::initializer_list<row>{
           {"", [](auto&) {}},
           {"the region goes from 0 to -1 along axis 1 of its frame (expected lower <= upper)",
            [](auto& region) { region.upper[1] = -1; }},
           {"the axis of the region (0, 1, 1) is not a unit vector",
            [](auto& region) {
              region.axis = {0, 1, 1};
            }},
           {"max_tilt of the region is -0.1 (expected a non-negative number)",
            [](auto& region) { region.max_tilt = -.1; }},
           {"the rotation angle of the region goes from 4 to 3.14",
            [](auto& region) { region.rotation_lower = 4; }},
           {"the frame of the region is not a unit dual quaternion",
            [](auto& region) { region.frame = 2 * region.frame; }},
           {"the region goes from nan", [](auto& region) { region.lower[2] = std::nan(""); }},
           {"the region goes from inf to inf along axis 0 of its frame (expected lower <= upper)",
            [&](auto& region) { region.lower[0] = region.upper[0] = infinity; }},
           {"the rotation angle of the region goes from -inf to -inf (expected lower <= upper)",
            [&](auto& region) { region.rotation_lower = region.rotation_upper = -infinity; }},
           {"", [&](auto& region) { // that is any
              region.rotation_lower = -infinity;
              region.rotation_upper = infinity;
            }}}) {
    CAPTURE(each.message);
    task_space_region region = position_goal({.5, 0, .5});
    each.change(region);
    const std::string message =
        duet_test::message_of([&] { (void)inverse_kinematics(arm, region, start); });
    CAPTURE(message);
    CHECK((each.message.empty()
               ? message.empty()
               : message.starts_with("duet: inverse_kinematics: " + each.message)));
  }
}

TEST_CASE("pointing goals: vectors that are not unit vectors are rejected") {
  const vector3<double> z(0, 0, 1), p(.5, 0, .5);
  for (const vector3<double>& none :
       {vector3<double>(0, 0, 0), vector3<double>(0, .3, .4), vector3<double>(0, 0, -2),
        vector3<double>(0, std::nan(""), 1)}) {
    CHECK_THROWS_AS((void)pointing_goal(z, none), invalid_input);
    CHECK_THROWS_AS((void)pointing_goal(none, z), invalid_input);
    CHECK_THROWS_AS((void)position_and_pointing_goal(p, z, none), invalid_input);
    CHECK_THROWS_AS((void)position_and_pointing_goal(p, none, z), invalid_input);
  }
  DUET_CHECK_REFUSED("duet: pointing_goal: the direction (0, 0.3, 0.4) is not a unit vector",
                     pointing_goal(z, {0, .3, .4}));
  DUET_CHECK_REFUSED("duet: position_and_pointing_goal: the axis (0, 0, 2) is not a unit vector",
                     position_and_pointing_goal(p, {0, 0, 2}, z));
}

} // namespace
} // namespace test_robotics_goals
