// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "../../src/robotics/planning_model.hpp"
#include "../../src/robotics/tip_pose.hpp"
#include "robotics/chains.hpp"
#include "support/allocations.hpp"
#include "support/message.hpp"

#include <duet/duet.hpp>
#include <duet/robotics/inverse_kinematics.hpp>

namespace test_robotics_inverse_kinematics {
namespace {

using namespace duet;
using duet_test::configuration;
using duet_test::is_within_limits;
using duet_test::known_arms;
/// Chain of any number of joints, so that the search is compiled once.
using chain = bounded_chain<16>;
using result = inverse_kinematics_result;
using vector = detail::joint_vector<double, -16>;
using std::numbers::pi;

/// Error of the tip by matrices: for a rotation by φ, |R − 1| = 2√2 |sin φ/2|.
pose_error deviation_by_matrices(const chain& arm, const vector& theta,
                                 const dual_quaternion<double>& goal) {
  const Eigen::Matrix4d max_abs_difference =
      transform_matrix(arm.pose(theta)) - transform_matrix(goal);
  const double chord = max_abs_difference.topLeftCorner<3, 3>().norm() / std::sqrt(8);
  return {max_abs_difference.topRightCorner<3, 1>().norm(), 2 * std::asin(std::min(1.0, chord))};
}

/// True if this is a solution whose reported deviation is correct.
bool is_solution(const chain& arm, const result& found, const dual_quaternion<double>& goal,
                 double tolerance = 1e-6) {
  const pose_error deviation = deviation_by_matrices(arm, found.joints, goal);
  const double rounding = 1e-15 * std::max(10.0, translation(goal).norm());
  return found.reason == stop_reason::reached && is_within_limits(arm, found.joints) &&
         deviation.translation <= tolerance + rounding &&
         deviation.rotation <= tolerance + rounding &&
         std::abs(deviation.translation - found.deviation.translation) < rounding &&
         std::abs(deviation.rotation - found.deviation.rotation) < rounding;
}

/// Slides whose first alone has limits.
chain gantry(double lower, double upper) {
  chain result = duet_test::portal({}, {});
  result.set_limits(0, {lower, upper});
  return result;
}

dual_quaternion<double> at(double x, double y, double z,
                           const Eigen::Vector3d& rotation_part = {0, 0, 0}) {
  return pose(from_rotation_vector(rotation_part), Eigen::Vector3d(x, y, z));
}

TEST_CASE("inverse_kinematics: reachable poses of four arms are found from random starts") {
  const std::uint64_t seed = 31;
  CAPTURE(seed);
  duet_test::random_source random(seed);
  for (const chain& arm : known_arms()) {
    CAPTURE(&arm - known_arms().data());
    int solved = 0;
    for (int k = 0; k < 100; ++k) {
      const auto goal = arm.pose(configuration(arm, random));
      const auto found = inverse_kinematics(arm, goal, configuration(arm, random));
      solved += is_solution(arm, found, goal);
    }
    CHECK(solved == 100);
  }
}

TEST_CASE("inverse_kinematics: goals and starts at singularities and limits") {
  duet_test::random_source random(32);
  for (const chain& arm : known_arms()) {
    const vector lower = lower_limits(arm), upper = upper_limits(arm);
    const vector zero = vector::Zero(arm.size());
    vector folded = zero;
    folded[2] = pi / 2;
    for (const vector& special : {lower, upper, zero, folded}) {
      const vector inside = special.cwiseMax(lower).cwiseMin(upper);
      const auto goal = arm.pose(inside);
      CHECK(is_solution(arm, inverse_kinematics(arm, goal, configuration(arm, random)), goal));
      const auto next = arm.pose(configuration(arm, random));
      CHECK(is_solution(arm, inverse_kinematics(arm, next, special), next));
      // Already there.
      const auto same = inverse_kinematics(arm, goal, inside);
      CHECK(same.iterations == 0);
      CHECK(same.joints == inside);
    }
  }
}

TEST_CASE("inverse_kinematics: independent of the sign of the goal; separate small tolerances") {
  const chain arm = robots::panda().table();
  duet_test::random_source random(33);
  const vector start = configuration(arm, random);
  const auto goal = arm.pose(configuration(arm, random));
  const auto found = inverse_kinematics(arm, goal, start);
  CHECK(found.joints == inverse_kinematics(arm, -goal, start).joints);
  const auto close = inverse_kinematics(arm, goal, start, {.tolerance = 1e-13});
  CHECK(is_solution(arm, close, goal, 1e-13));
  // Separate tolerances of length and angle.
  const auto moved = at(.01, 0, 0) * arm.pose(start);
  CHECK(inverse_kinematics(arm, moved, start, {.tolerance = {.011, 1e-9}}).iterations == 0);
  CHECK(inverse_kinematics(arm, moved, start, {.tolerance = {.009, 1}}).iterations > 0);
  const auto rotated = arm.pose(start) * at(0, 0, 0, {0, .02, 0});
  CHECK(inverse_kinematics(arm, rotated, start, {.tolerance = {1e-9, .021}}).iterations == 0);
  CHECK(inverse_kinematics(arm, rotated, start, {.tolerance = {1, .019}}).iterations > 0);
}

TEST_CASE("inverse_kinematics: all joint types; revolute joints are wrapped into their limits") {
  const chain arm = duet_test::every_joint();
  duet_test::random_source random(34);
  for (int k = 0; k < 20; ++k) {
    const auto goal = arm.pose(configuration(arm, random));
    CHECK(is_solution(arm, inverse_kinematics(arm, goal, configuration(arm, random)), goal));
  }
  const chain far = gantry(-INFINITY, INFINITY);
  const auto goal = at(1000, -2000, .5, {0, 1, 2});
  CHECK(is_solution(far, inverse_kinematics(far, goal, vector::Zero(6).eval(), {.max_restarts = 0}),
                    goal));

  const chain ur5e = robots::ur5e().table();
  vector theta(6);
  theta << 3, -1, 1.5, -2, 1, 6;
  vector rotated = theta;
  rotated[0] += 6 * pi;
  rotated[5] -= 10 * pi;
  const auto same = inverse_kinematics(ur5e, ur5e.pose(theta), rotated);
  CHECK(same.iterations == 0);
  CHECK(is_solution(ur5e, same, ur5e.pose(theta)));
  // Through 2π, which does not limit the motion.
  vector beyond = theta;
  beyond[5] = 6.5;
  CHECK(is_solution(ur5e, inverse_kinematics(ur5e, ur5e.pose(beyond), theta, {.max_restarts = 0}),
                    ur5e.pose(beyond)));
}

TEST_CASE("inverse_kinematics: independent of the unit with prismatic joints and out of reach") {
  // With units whose ratio is a power of two, results are equal to the last bit.
  const auto screw = [](double unit) {
    std::array<joint<>, 6> joints;
    for (std::size_t i = 0; i < 6; ++i) {
      joints[i].kind = i % 2 == 0 ? joint_kind::helical : joint_kind::revolute;
      joints[i].axis = {double(i % 3 == 0), double(i % 3 == 1), double(i % 3 == 2)};
      joints[i].origin.translation = {.3 * unit, 0, .2 * unit};
      joints[i].limits = {-2.5, 2};
      joints[i].pitch = .1 * unit;
    }
    return chain(serial_chain<6>(joints));
  };
  const double unit = 1024;
  const auto compare = [&](const chain& one, const chain& other, bool may_fail) {
    duet_test::random_source random(41);
    int restarts = 0, solved = 0;
    for (int k = 0; k < 40; ++k) {
      vector start(6), theta(6), scaled_start(6), scaled_theta(6);
      for (int i = 0; i < 6; ++i) {
        const auto& limits = one.limits(i);
        const double scale = one.kind(i) == joint_kind::prismatic ? unit : 1;
        CHECK(other.limits(i).upper == scale * limits.upper);
        start[i] = random.uniform(limits.lower, limits.upper);
        theta[i] = random.uniform(limits.lower, limits.upper);
        scaled_start[i] = scale * start[i];
        scaled_theta[i] = scale * theta[i];
      }
      const bool is_far = k % 8 == 7; // out of reach
      const auto goal = is_far ? at(9, -k, 3, {.1, 2, .3}) : one.pose(theta);
      const auto scaled_goal =
          is_far ? at(9 * unit, -k * unit, 3 * unit, {.1, 2, .3}) : other.pose(scaled_theta);
      const auto x = inverse_kinematics(one, goal, start, {.tolerance = {1e-6, 1e-7}});
      const auto y =
          inverse_kinematics(other, scaled_goal, scaled_start, {.tolerance = {1e-6 * unit, 1e-7}});
      CHECK(x.reason == (is_far ? stop_reason::out_of_reach : y.reason));
      CHECK(x.reason == y.reason);
      CHECK(x.iterations == y.iterations);
      CHECK(x.restarts == y.restarts);
      CHECK(y.deviation.translation == unit * x.deviation.translation);
      CHECK(y.deviation.rotation == x.deviation.rotation);
      for (int i = 0; i < 6; ++i) {
        CHECK(y.joints[i] == (one.kind(i) == joint_kind::prismatic ? unit : 1) * x.joints[i]);
      }
      restarts += is_far ? 0 : x.restarts;
      solved += is_far || x.reason == stop_reason::reached;
    }
    CHECK((may_fail || solved == 40));
    return restarts;
  };
  CHECK(compare(duet_test::stanford_arm(1), duet_test::stanford_arm(unit), false) >
        0); // random configurations, too
  compare(duet_test::portal({-1, 2}, {-3, 3}), duet_test::portal({-unit, 2 * unit}, {-3, 3}),
          false);
  compare(screw(1), screw(unit), true);
}

TEST_CASE("inverse_kinematics: unreachable goals report the reason") {
  const chain panda = robots::panda().table();
  const vector centre = (lower_limits(panda) + upper_limits(panda)) / 2;
  const auto far = inverse_kinematics(panda, at(1.3, 0, .3), centre);
  CHECK(far.reason == stop_reason::out_of_reach);
  CHECK(std::string(to_text(far.reason)) == "out_of_reach");
  CHECK(far.restarts == 100);
  CHECK(is_within_limits(panda, far.joints));

  // Three tenths of the distance cannot be reached.
  const chain stretched = gantry(-1, .5);
  const vector zero = vector::Zero(6);
  const auto slid = inverse_kinematics(stretched, at(.8, 0, .3), zero);
  CHECK(slid.reason == stop_reason::joint_limit);
  CHECK(slid.restarts == 100);
  CHECK(slid.joints[0] == .5);
  CHECK(slid.deviation.translation == doctest::Approx(.3).epsilon(1e-6));
  CHECK(is_within_limits(stretched, slid.joints));

  const chain ur5e = robots::ur5e().table();
  // The hand points away from the base, which would require the arm to stretch beyond its reach.
  const auto rotated = inverse_kinematics(ur5e, at(.85, .2, .1, {0, -pi / 2, 0}), zero);
  CHECK(rotated.reason == stop_reason::singular);

  const chain scara = duet_test::scara();
  vector theta(4);
  theta << .3, .9, .1, -2;
  const vector start = vector::Constant(4, .05);
  const auto goal = scara.pose(theta);
  CHECK(is_solution(scara, inverse_kinematics(scara, goal, start), goal));
  const auto tilted = goal * at(0, 0, 0, {.1, 0, 0});
  CHECK(inverse_kinematics(scara, tilted, start).reason == stop_reason::no_progress);

  duet_test::random_source random(35);
  const auto hurried = inverse_kinematics(panda, panda.pose(configuration(panda, random)), centre,
                                          {.max_restarts = 0, .max_iterations = 2});
  CHECK(hurried.reason == stop_reason::iteration_limit);
  CHECK(hurried.iterations == 2);
  CHECK(hurried.restarts == 0);
}

TEST_CASE("inverse_kinematics: a pose within a tolerance, for arms with fewer than six joints") {
  const pose_tolerance tolerance{1e-3, .02};
  duet_test::random_source random(44);
  // Two parallel axes, links of 0.4 and 0.3: beside their plane the nearest pose is that below.
  std::array<joint<>, 2> planar;
  planar[1].origin = frame_with_z_axis({.4, 0, 0}, {0, 0, 1});
  const chain two = with_tool(serial_chain<2>(planar), frame_with_z_axis({.3, 0, 0}, {0, 0, 1}));
  const vector start = Eigen::Vector2d(.5, -.9);
  for (const double beside : {5e-4, 2e-3}) {
    const bool is_close = beside < 1e-3;
    const auto goal = at(0, 0, beside) * two.pose(vector(Eigen::Vector2d(.7, -1.1)));
    const auto nearest = inverse_kinematics(two, goal, start, {.max_restarts = 5});
    CHECK(nearest.reason != stop_reason::reached);
    CHECK(std::abs(nearest.deviation.translation - beside) < 1e-9);
    CHECK(nearest.deviation.rotation < 1e-6);
    CHECK((tolerance.ratio(nearest.deviation) <= 1) == is_close);
    const auto within =
        inverse_kinematics(two, pose_goal(goal, tolerance), start, {.max_restarts = 5});
    CHECK((within.reason == stop_reason::reached) == is_close);
    CHECK((tolerance.ratio(deviation_by_matrices(two, within.joints, goal)) <= 1) == is_close);
  }
  // Five joints of a UR5e, four, and three, beside poses that they reach: more in angle than the
  // nearest pose keeps, which moves the origin instead.
  chain arm = robots::ur5e().table();
  for (const int locked : {5, 3, 1}) {
    arm = with_locked_joint(arm, locked, .3);
    CAPTURE(arm.size());
    for (int k = 0; k < 40; ++k) {
      const vector theta = configuration(arm, random);
      const Eigen::Vector3d axis(random.normal(), random.normal(), random.normal());
      const auto off = at(4e-4, -2e-4, 0, (k == 0 ? 0 : .012) * axis.normalized());
      const auto goal = arm.pose(theta) * off;
      const vector guess = theta + .1 * vector::Ones(arm.size());
      const auto within = inverse_kinematics(arm, pose_goal(goal, tolerance), guess);
      CHECK(within.reason == stop_reason::reached);
      CHECK(is_within_limits(arm, within.joints));
      const pose_error error = deviation_by_matrices(arm, within.joints, goal);
      CHECK(error.translation <= tolerance.translation + 2e-6);
      CHECK(error.rotation <= tolerance.rotation + 2e-6);
    }
  }
  // A whole pose, and invalid tolerances.
  const auto panda = known_arms()[0];
  const auto goal = panda.pose(configuration(panda, random));
  CHECK(is_solution(panda,
                    inverse_kinematics(panda, pose_goal(goal, 0), configuration(panda, random)),
                    goal, 3e-6));
  DUET_CHECK_REFUSED(
      "duet: pose_goal: the tolerance is -1, 0.1 (expected finite numbers, not negative)",
      pose_goal(goal, {-1, .1}));
  CHECK(!duet_test::message_of([&] { (void)pose_goal(goal, {1, std::nan("")}); }).empty());
}

TEST_CASE("inverse_kinematics: out of reach, the result is the nearest pose") {
  // For three prismatic joints the solution is known, with several limits active at once.
  const chain portal = duet_test::portal({-1, 1}, {-1.2, 1.2});
  const auto slid = inverse_kinematics(portal, at(3, .25, -5, {.3, -.2, .4}),
                                       vector::Zero(6).eval(), {.max_restarts = 0});
  CHECK(slid.reason == stop_reason::out_of_reach);
  CHECK(slid.joints[0] == 1);
  CHECK(slid.joints[1] == doctest::Approx(.25).epsilon(1e-12));
  CHECK(slid.joints[2] == -1);
  CHECK(slid.deviation.translation == doctest::Approx(std::hypot(2, 4)).epsilon(1e-14));
  CHECK(slid.deviation.rotation < 1e-11);
  CHECK(slid.restarts == 0);

  // For arms: the gradient by dual numbers vanishes, and no random configuration is nearer.
  duet_test::random_source random(42);
  for (const chain& arm : known_arms()) {
    double scale = detail::length_of(detail::components(arm.tip().offset.translation));
    for (int i = 1; i < arm.size(); ++i) {
      scale += detail::length_of(arm.steps()[std::size_t(i)].offset);
    }
    for (int k = 0; k < 4; ++k) {
      const auto n = random.direction<3>(), t = random.direction<3>();
      const double distance = 1.5 + 2 * k;
      const auto goal = at(distance * n[0], distance * n[1], distance * n[2],
                           Eigen::Vector3d(3 * t[0], 3 * t[1], 3 * t[2]));
      const auto error = [&](const auto& theta) {
        const auto tip = arm.pose(theta);
        const auto displacement = (translation(tip) - translation(goal)).eval();
        const auto rotation_error = rotation_vector(rotation(goal) * conj(rotation(tip)));
        return displacement.squaredNorm() / (scale * scale) + rotation_error.squaredNorm();
      };
      const vector start = configuration(arm, random);
      const auto found = inverse_kinematics(arm, goal, start, {.max_restarts = 50});
      CHECK(found.reason == stop_reason::out_of_reach);
      CHECK(is_within_limits(arm, found.joints));
      const pose_error deviation = deviation_by_matrices(arm, found.joints, goal);
      CHECK(deviation.translation == doctest::Approx(found.deviation.translation).epsilon(1e-12));
      CHECK(deviation.rotation == doctest::Approx(found.deviation.rotation).epsilon(1e-7));
      const auto [value, derivatives] = gradient(error, found.joints);
      for (int i = 0; i < arm.size(); ++i) {
        const bool is_fixed = derivatives[i] > 0 ? found.joints[i] == arm.limits(i).lower
                                                 : found.joints[i] == arm.limits(i).upper;
        CHECK((is_fixed || std::abs(derivatives[i]) < 1e-9 * (1 + value)));
      }
      for (int j = 0; j < 1000; ++j) {
        CHECK(value <= error(configuration(arm, random)));
      }
      const auto other = inverse_kinematics(arm, goal, configuration(arm, random), {.seed = 9});
      CHECK(error(other.joints) == doctest::Approx(value).epsilon(1e-9));
    }
  }
}

TEST_CASE("squared_error_of: gradient and Hessian agree with dual numbers") {
  duet_test::random_source random(43);
  const auto check = [&](const chain& arm, double angle) {
    const detail::planning_model<8> model(arm);
    for (int k = 0; k < 5; ++k) {
      const vector theta = configuration(arm, random);
      const auto t = random.direction<3>();
      const auto goal = at(t[1], 2 * t[2], t[0], {0, 0, 0}) * arm.pose(theta) *
                        at(0, 0, 0, Eigen::Vector3d(angle * t[0], angle * t[1], angle * t[2]));
      const auto state = model.at(model.joints(theta));
      const auto twist = detail::error_twist(state.tip, model.scaled_pose(goal));
      const auto displacement = model.scaled_pose(goal).translation - state.tip.translation;
      const auto found = detail::squared_error_of(
          state.jacobian, detail::small_twist(displacement.x, displacement.y, displacement.z,
                                              twist[3], twist[4], twist[5]));
      const auto half_square = [&](const auto& x) {
        const auto tip = arm.pose(x);
        const auto offset = ((translation(goal) - translation(tip)) / model.length).eval();
        const auto about = rotation_vector(rotation(goal) * conj(rotation(tip)));
        return (offset.squaredNorm() + about.squaredNorm()) / 2;
      };
      const auto expected = hessian(half_square, theta);
      for (int i = 0; i < arm.size(); ++i) {
        CHECK(std::abs(found.gradient[i] - model.unit[i] * expected.gradient[i]) <
              2e-14 * (1 + 4 * angle));
        for (int j = 0; j <= i; ++j) {
          CHECK(std::abs(found.curvature(i, j) -
                         model.unit[i] * model.unit[j] * expected.hessian(i, j)) < 1e-12);
        }
      }
    }
  };
  for (const double angle : {1e-6, 1e-2, 1., 3.}) {
    check(robots::panda().table(), angle);
    check(duet_test::every_joint(), angle);
  }
}

TEST_CASE("inverse_kinematics: invalid goals, starts and options are rejected") {
  const chain arm = robots::panda().table();
  const vector start = (lower_limits(arm) + upper_limits(arm)) / 2;
  const auto goal = arm.pose(start);
  vector broken = start;
  broken[4] = INFINITY;
  struct row {
    dual_quaternion<double> goal;
    vector start;
    inverse_kinematics_options options;
    const char* message;
  };
  const double nan = std::nan("");
  for (const row& each : std::initializer_list<row>{
           {make_dual_quaternion(quaternion<double>(1), quaternion<double>(.5)),
            start,
            {},
            "inverse_kinematics: the goal is not a unit dual quaternion: |p|^2 = 1, p.q = 0.5 "
            "(expected 1 and 0)"},
           {at(.1, nan, .3),
            start,
            {},
            "inverse_kinematics: the translation of the goal is not finite: (nan, nan, nan)"},
           {pose(quaternion<double>(1, 0, nan, 0), vector3<double>(1, 2, 3)),
            start,
            {},
            "inverse_kinematics: the rotation of the goal is not finite: (1, 0, nan, 0)"},
           {goal, vector::Zero(6), {}, "serial_chain: 6 coordinates (expected 7)"},
           {goal,
            broken,
            {},
            "inverse_kinematics: joint 4 of the start is inf (expected a finite number)"},
           {goal,
            start,
            {.tolerance = 0},
            "inverse_kinematics: tolerance.translation is 0 (expected a positive number)"},
           {goal,
            start,
            {.tolerance = {1e-6, -1}},
            "inverse_kinematics: tolerance.rotation is -1 (expected a positive number)"},
           {goal,
            start,
            {.tolerance = nan},
            "inverse_kinematics: tolerance.translation is nan (expected a positive number)"},
           {goal, start, {.max_restarts = -1}, ""},
           {goal, start, {.max_iterations = 0}, ""}}) {
    const std::string message = duet_test::message_of(
        [&] { (void)inverse_kinematics(arm, each.goal, each.start, each.options); });
    CHECK(message.starts_with("duet: " + std::string(each.message)));
  }
  CHECK(inverse_kinematics(arm, at(1e200, 0, 0), start).reason == stop_reason::out_of_reach);
}

TEST_CASE("error_twist: is the twist of the shorter screw motion") {
  duet_test::random_source random(38);
  for (const double angle : {0., 1e-200, 1e-160, 1e-9, 1e-3, 1., 3., pi - 1e-9, pi, 4., 6.}) {
    for (const double sign : {1., -1.}) {
      const auto n = random.direction<3>(), t = random.direction<3>(), u = random.direction<3>();
      const auto relative = exp(vector3<double>(.5 * angle * vector3<double>(n[0], n[1], n[2])));
      const auto rotation = exp(vector3<double>(t[0], t[1], t[2]));
      const detail::tip_pose from{rotation, {u[0], u[1], u[2]}};
      const detail::tip_pose to{sign * (relative * rotation), {t[2], 3 * t[0], t[1]}};
      const auto e = detail::error_twist(from, to);
      const vector3<double> omega(e[3], e[4], e[5]), p(u[0], u[1], u[2]);
      CHECK(omega.norm() <= pi * (1 + 1e-15));
      CHECK(omega.norm() == doctest::Approx(std::min(angle, 2 * pi - angle)));
      const vector3<double> spatial = vector3<double>(e[0], e[1], e[2]) - omega.cross(p);
      const auto moved =
          exp(make_dual_vector(vector3<double>(omega / 2), vector3<double>(spatial / 2))) *
          detail::to_dual_quaternion(from);
      const auto deviation = pose_error_between(moved, detail::to_dual_quaternion(to));
      CHECK(deviation.translation < 1e-14);
      CHECK(deviation.rotation < 1e-14);
    }
  }
}

TEST_CASE("inverse_kinematics: allocates no memory, including restarts") {
  std::array<joint<>, 16> joints;
  for (std::size_t i = 0; i < 16; ++i) {
    joints[i].origin.translation = {.1, 0, .05};
    joints[i].axis = {double(i % 3 == 0), double(i % 3 == 1), double(i % 3 == 2)};
    joints[i].limits = {-.5, 1};
  }
  const chain arm = serial_chain<16>(joints);
  duet_test::random_source random(37);
  const vector theta = configuration(arm, random), start = configuration(arm, random);
  const auto goal = arm.pose(theta), none = at(-1, 0, 0);
  const std::size_t before = duet_test::allocations;
  const auto found = inverse_kinematics(arm, goal, start);
  const auto tried = inverse_kinematics(arm, none, start, {.max_restarts = 5});
  const std::size_t during = duet_test::allocations - before;
  CHECK(during == 0);
  CHECK(is_solution(arm, found, goal));
  CHECK(tried.restarts == 5);
}

} // namespace
} // namespace test_robotics_inverse_kinematics
