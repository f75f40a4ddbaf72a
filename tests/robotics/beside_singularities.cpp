// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "../../src/robotics/branches/chain_loop.hpp"
#include "../../src/robotics/branches/singular_value.hpp"
#include "../../src/robotics/branches/subproblems.hpp"
#include "support/multiprecision.hpp"
#include "support/random.hpp"
#include "support/samples.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>
#include <duet/robotics/all_inverse_kinematics.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <span>

namespace test_robotics_beside_singularities {
namespace {

using namespace duet;
using duet_test::real_50;
using std::numbers::pi;
using chain = serial_chain<6>;
using joints = Eigen::Matrix<double, 6, 1>;
using wide_joints = Eigen::Matrix<real_50, 6, 1>;
using result = all_inverse_kinematics_result;

constexpr std::array distances{1e-3,  3e-4,  1e-4,  1e-5,  1e-6,  3e-7,  1e-7,  1e-8, 1e-9,
                               1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15, 1e-16, 0.};

/// A shoulder whose axes do not meet, an elbow, and a spherical wrist, whose outer axes coincide if
/// the coordinate of the middle joint is 0.
chain with_wrist(duet_test::random_source& random, double tilt) {
  const auto length = [&] { return random.uniform(.1, 1); };
  return from_dh(std::array<dh_row<>, 6>{{{.a = length(), .d = length(), .alpha = pi / 2},
                                          {.a = length(), .d = length()},
                                          {.a = length(), .alpha = -pi / 2},
                                          {.d = length(), .alpha = tilt},
                                          {.alpha = -tilt},
                                          {.d = length()}}});
}

/// Three parallel axes; the sixth is parallel to them if the coordinate of the fifth joint is 0.
chain with_parallel_axes(duet_test::random_source& random, bool has_offset) {
  const auto length = [&] { return random.uniform(.1, 1); };
  return from_dh(
      std::array<dh_row<>, 6>{{{.d = length(), .alpha = pi / 2},
                               {.a = length()},
                               {.a = length()},
                               {.d = length(), .alpha = pi / 2},
                               {.a = has_offset ? length() : 0., .d = length(), .alpha = -pi / 2},
                               {.d = length()}}});
}

/// A shoulder whose axes meet, and a forearm as long as the upper arm. Folded by a quarter turn of
/// the third joint, the wrist is in the shoulder for all angles of the first two joints.
chain with_folding_elbow(duet_test::random_source& random, double shoulder, double wrist) {
  const double length = random.uniform(.2, 1);
  return from_dh(std::array<dh_row<>, 6>{{{.d = random.uniform(.1, 1), .alpha = shoulder},
                                          {.a = length},
                                          {.alpha = pi / 2},
                                          {.d = length, .alpha = -wrist},
                                          {.alpha = wrist},
                                          {.d = random.uniform(.1, 1)}}});
}

/// As above with axes 2 and 3 not parallel, and with offsets.
struct skew_elbow {
  std::array<dh_row<>, 6> rows;
  double fold; ///< the third coordinate that brings the wrist into the shoulder
};
/// \param miss  smallest distance of the wrist from the shoulder
/// \param separation  distance between the axes of the shoulder
skew_elbow with_skew_elbow(duet_test::random_source& random, double miss, double separation = 0) {
  const auto angle = [&] { return random.uniform(.6, 1.5); };
  const double a2 = random.uniform(.2, 1), d2 = random.uniform(-.5, .5), alpha2 = angle(),
               alpha3 = angle(), across = d2 * std::sin(alpha2), wrist = angle();
  // Shoulder and wrist are at the same distance from the third axis, and at the same height.
  const double distance = std::hypot(a2, across), a3 = random.uniform(-.9, .9) * distance,
               normal = std::sqrt(distance * distance - a3 * a3), d4 = normal / std::sin(alpha3),
               d3 = -d2 * std::cos(alpha2) - d4 * std::cos(alpha3);
  return {{{{.a = separation, .d = random.uniform(.1, 1), .alpha = angle()},
            {.a = a2, .d = d2, .alpha = alpha2},
            {.a = a3, .d = d3 + miss, .alpha = alpha3},
            {.d = d4, .alpha = -wrist},
            {.alpha = wrist},
            {.d = random.uniform(.1, 1)}}},
          std::atan2(-across, -a2) - std::atan2(-normal, a3)};
}

/// The arm from its tip to its base: coordinates are in reverse order, with opposite signs.
std::array<dh_row<>, 6> mirrored(const std::array<dh_row<>, 6>& rows) {
  std::array<dh_row<>, 6> mirror;
  for (std::size_t i = 0; i < 6; ++i) {
    const dh_row<> before = i < 5 ? rows[4 - i] : dh_row<>{};
    mirror[i] = {.a = -before.a, .d = -rows[5 - i].d, .alpha = -before.alpha};
  }
  return mirror;
}

int count_of(const result& found) {
  int count = 0;
  for (const auto& s : found.solutions) {
    count += s.multiplicity;
  }
  return count;
}

double distance(const joints& a, const joints& b) {
  double largest = 0;
  for (int i = 0; i < 6; ++i) {
    largest = std::max(largest, std::abs(std::remainder(a[i] - b[i], 2 * pi)));
  }
  return largest;
}

/// Error twist to a goal: translation and rotation vector, to first order.
wide_joints error_twist_to(const dual_quaternion<real_50>& goal,
                           const dual_quaternion<real_50>& tip) {
  const auto relative = rotation(goal) * conj(rotation(tip));
  const Eigen::Matrix<real_50, 3, 1> error = translation(goal) - translation(tip);
  wide_joints twist;
  const real_50 twice = relative.w() < 0 ? -2 : 2;
  twist << error[0], error[1], error[2], twice * relative.x(), twice * relative.y(),
      twice * relative.z();
  return twist;
}

/// Distance of the fifth axis from the tip along the z axis of the tip, which is the sixth axis.
double wrist_of(const chain& arm) {
  const detail::chain_screws axes(arm, joints::Zero().eval(), -1);
  const auto to_wrist = axes.size * detail::nearest_point(axes.joints[5], axes.joints[4]) +
                        axes.centre - axes.tip.translation;
  return dot(axes.joints[5].axis, to_wrist);
}

/// Solution near θ with 50 digits, by Newton's method for the position of the wrist: the position
/// of the tip depends on rotations of the wrist, whose second-order terms exceed the fold.
wide_joints exact_solution(const chain& arm, const dual_quaternion<real_50>& goal,
                           const joints& theta) {
  const auto to_wrist = pose(quaternion<real_50>(real_50(1)),
                             vector3<real_50>(real_50(0), real_50(0), real_50(wrist_of(arm))));
  wide_joints exact = theta.cast<real_50>();
  for (int k = 0; k < 12; ++k) {
    const auto tip = arm.pose(exact);
    const wide_joints error = error_twist_to(goal * to_wrist, tip * to_wrist);
    if (error.norm() < 1e-40) {
      break;
    }
    const Eigen::Matrix<real_50, 3, 1> lever = translation(tip * to_wrist) - translation(tip);
    Eigen::Matrix<real_50, 6, 6> all = jacobian(arm, exact, frame::hybrid);
    for (int i = 0; i < 6; ++i) {
      all.col(i).head<3>() += all.col(i).tail<3>().cross(lever);
    }
    exact += all.partialPivLu().solve(error);
  }
  return exact;
}

/// \param joint  joint whose coordinate is the distance of θ from a singularity
/// \param certain  smallest distance at which the result has to be complete
void check_near(const chain& arm, joints theta, int joint, solution_method method,
                double certain = 1e-12, std::span<const double> offsets = distances) {
  const double singular = theta[joint];
  for (const double side : {1., -1.}) {
    theta[joint] = singular + side * 2e-3;
    const int count = count_of(all_inverse_kinematics(arm, arm.pose(theta)));
    for (const double offset : offsets) {
      CAPTURE(side);
      CAPTURE(offset);
      theta[joint] = singular + side * offset;
      const result found = all_inverse_kinematics(arm, arm.pose(theta));
      CHECK(found.method == method);
      CHECK_FALSE(found.solutions.empty());
      for (const auto& s : found.solutions) {
        CHECK(s.residual <= 1e-12);
      }
      const bool is_certain = offset >= 1e-12;
      CHECK((found.is_complete == is_certain || (is_certain && offset < certain)));
      if (!is_certain) { // the joints have a self-motion
        continue;
      }
      CHECK(count_of(found) == count);
      CHECK(found.complex_solutions == 8 - count);
      const auto goal = arm.pose(wide_joints(theta.cast<real_50>()));
      int met = 0;
      for (const auto& s : found.solutions) {
        CHECK(s.multiplicity == 1);
        const double rounding = (1e-14 + 2 * s.residual) / s.smallest_singular_value;
        const wide_joints exact = exact_solution(arm, goal, s.joints);
        CHECK(double(error_twist_to(goal, arm.pose(exact)).norm()) < 1e-35);
        CHECK(distance(exact.cast<double>(), s.joints) < rounding);
        met += distance(theta, s.joints) < std::min(rounding, .05); // others differ by more than .1
        for (const auto& other : found.solutions) {
          CHECK((&s == &other || distance(s.joints, other.joints) > .1));
        }
      }
      CHECK(met == 1);
    }
  }
}

double smallest_singular_value(const chain& arm, const joints& theta) {
  return detail::smallest_singular_value(jacobian(arm, theta, frame::hybrid));
}

/// Random configuration with one singular coordinate, and no other singularity nearby.
joints configuration(const chain& arm, duet_test::random_source& random, int joint,
                     double singular = 0) {
  constexpr double offset = 2e-3;
  joints theta;
  do {
    for (double& x : theta) {
      x = random.uniform(-pi, pi);
    }
    theta[joint] = singular + offset;
  } while (smallest_singular_value(arm, theta) < .02 * offset);
  theta[joint] = singular;
  return theta;
}

TEST_CASE("all_inverse_kinematics: near a wrist singularity all solutions are accurate") {
  duet_test::random_source random(1);
  for (int k = 0; k < 5; ++k) {
    CAPTURE(k);
    const chain arm = with_wrist(random, k < 3 ? pi / 2 : random.uniform(.5, 1.2));
    check_near(arm, configuration(arm, random, 4), 4, solution_method::spherical_wrist);
  }
}

TEST_CASE("all_inverse_kinematics: near a wrist singularity of an arm with three parallel axes "
          "all solutions are accurate") {
  duet_test::random_source random(2);
  for (int k = 0; k < 5; ++k) {
    CAPTURE(k);
    const chain arm = with_parallel_axes(random, k >= 3);
    check_near(arm, configuration(arm, random, 4), 4, solution_method::parallel_axes);
  }
}

void check_near_fold(const chain& arm, int elbow, double fold, duet_test::random_source& random) {
  const std::span<const double> down_to_1e_12 = std::span(distances).first(12);
  joints theta = configuration(arm, random, elbow, fold);
  check_near(arm, theta, elbow, solution_method::spherical_wrist, 1e-8, down_to_1e_12);
  for (const double offset : {1e-14, 1e-16, 0.}) { // the joints have a self-motion
    CAPTURE(offset);
    theta[elbow] = fold + offset;
    const result found = all_inverse_kinematics(arm, arm.pose(theta));
    CHECK_FALSE(found.is_complete);
    CHECK_FALSE(found.solutions.empty());
    for (const auto& s : found.solutions) {
      CHECK(s.residual <= 1e-12);
    }
  }
}

TEST_CASE(
    "all_inverse_kinematics: near an elbow folded onto the shoulder all solutions are accurate") {
  duet_test::random_source random(4);
  for (int k = 0; k < duet_test::sample_count(10); ++k) {
    CAPTURE(k);
    const double shoulder = k % 3 == 0 ? pi / 2 : random.uniform(.6, 1.5),
                 wrist = k % 2 == 0 ? pi / 2 : random.uniform(.6, 1.5);
    check_near_fold(with_folding_elbow(random, shoulder, wrist), 2, -pi / 2, random);
  }
}

TEST_CASE("all_inverse_kinematics: near a folded elbow with skew axes 2 and 3 all solutions are "
          "accurate") {
  duet_test::random_source random(5);
  for (int k = 0; k < duet_test::sample_count(10); ++k) {
    CAPTURE(k);
    const auto [rows, fold] = with_skew_elbow(random, 0);
    check_near_fold(from_dh(rows), 2, fold, random);
  }
}

TEST_CASE("all_inverse_kinematics: near an elbow that folds a wrist of two axes onto a spherical "
          "shoulder all solutions are accurate") {
  duet_test::random_source random(6);
  for (int k = 0; k < duet_test::sample_count(10); ++k) {
    CAPTURE(k);
    const auto [rows, fold] = with_skew_elbow(random, 0);
    check_near_fold(from_dh(mirrored(rows)), 3, -fold, random);
  }
}

TEST_CASE("all_inverse_kinematics: near a fold that misses the shoulder by 1e-5 all solutions are "
          "accurate") {
  duet_test::random_source random(10);
  for (int k = 0; k < duet_test::sample_count(10); ++k) {
    CAPTURE(k);
    const auto [rows, fold] = with_skew_elbow(random, 1e-5);
    const bool is_shoulder = k % 2 == 0;
    const chain arm = from_dh(is_shoulder ? rows : mirrored(rows));
    const int elbow = is_shoulder ? 2 : 3;
    joints theta = configuration(arm, random, elbow, is_shoulder ? fold : -fold);
    for (const double offset : {1e-3, -3e-4, 1e-4, -3e-5}) {
      CAPTURE(offset);
      theta[elbow] = (is_shoulder ? fold : -fold) + offset;
      const result found = all_inverse_kinematics(arm, arm.pose(theta));
      CHECK(found.is_complete);
      CHECK(count_of(found) % 2 == 0);
      const auto goal = arm.pose(wide_joints(theta.cast<real_50>()));
      int met = 0;
      for (const auto& s : found.solutions) {
        const double rounding = (1e-14 + 2 * s.residual) / s.smallest_singular_value;
        const wide_joints exact = exact_solution(arm, goal, s.joints);
        CHECK(distance(exact.cast<double>(), s.joints) < rounding);
        met += distance(theta, s.joints) < rounding;
      }
      CHECK(met == 1);
    }
  }
}

/// The equations lose digits as the separation of the axes decreases.
TEST_CASE("all_inverse_kinematics: near a fold onto a shoulder with separated axes the solution is "
          "found") {
  duet_test::random_source random(7);
  for (const double separation : {1e-2, 1e-3}) {
    const int count = duet_test::sample_count(50);
    int met = 0, certain = 0;
    for (int k = 0; k < count; ++k) {
      const auto [rows, fold] = with_skew_elbow(random, 0, separation);
      const chain arm = from_dh(rows);
      joints theta = configuration(arm, random, 2, fold);
      theta[2] += k % 2 == 0 ? 1e-8 : -1e-8;
      const result found = all_inverse_kinematics(arm, arm.pose(theta));
      met += std::any_of(found.solutions.begin(), found.solutions.end(), [&](const auto& s) {
        return distance(s.joints, theta) < (1e-14 + 2 * s.residual) / s.smallest_singular_value;
      });
      certain += found.is_complete;
    }
    CHECK(met == count);
    CHECK(certain >= count - count / 25);
  }
}

TEST_CASE("all_inverse_kinematics: near a fold onto a shoulder with nearly intersecting axes the "
          "result is not complete") {
  duet_test::random_source random(8);
  for (const double separation : {1e-4, 1e-6, 1e-8}) {
    for (int k = 0; k < duet_test::sample_count(20); ++k) {
      const auto [rows, fold] = with_skew_elbow(random, 0, separation);
      const chain arm = from_dh(rows);
      joints theta = configuration(arm, random, 2, fold);
      theta[2] += .1 * separation;
      CHECK_FALSE(all_inverse_kinematics(arm, arm.pose(theta)).is_complete);
    }
  }
}

/// Against 50 digits.
TEST_CASE("subproblem3: angles at which a rotating vector has a small length are accurate") {
  duet_test::random_source random(9);
  const auto any = [&] {
    const auto x = random.direction<3>();
    return detail::vector3d{x[0], x[1], x[2]};
  };
  for (int k = 0; k < duet_test::sample_count(20); ++k) {
    const detail::vector3d n = any(), v = any();
    const detail::rotating_vector fixed(n, v), moved(n, v, -1 * fixed.at(.4));
    for (const double length : {1e-2, 1e-5, 1e-8, 1e-11}) {
      // Displaced by .6 of the length along n: .8² + .6² = 1.
      const detail::rotating_vector perpendicular(n, v, .6 * length * n - fixed.at(.4));
      const auto found = detail::subproblem3(k % 2 == 0 ? moved : perpendicular, length);
      REQUIRE(found.size() == 2);
      for (const auto& [theta, multiplicity] : found) {
        CHECK(multiplicity == 1);
        // |v(θ) − v(.4)| = 2 |n × v| |sin ½(θ − .4)|
        const real_50 across = length_of(cross(n, v)),
                      error = 2 * across * abs(sin((real_50(theta) - real_50(.4)) / 2));
        CHECK(double(abs(error - (k % 2 == 0 ? 1 : .8) * length)) < 2e-15);
      }
      CHECK(found[0].theta < .4);
      CHECK(found[1].theta > .4);
    }
    const auto one = detail::subproblem3(moved, 0);
    REQUIRE(one.size() == 1);
    CHECK(one[0].multiplicity == 2);
    CHECK(one[0].theta == doctest::Approx(.4).epsilon(1e-13));
  }
}

/// Random configurations, which may be near other singularities, too.
TEST_CASE("all_inverse_kinematics: in a wrist singularity a singular solution is found and the "
          "result is not complete") {
  duet_test::random_source random(3);
  for (int k = 0; k < duet_test::sample_count(200); ++k) {
    CAPTURE(k);
    const chain arm =
        k % 2 == 0 ? with_wrist(random, pi / 2) : with_parallel_axes(random, k % 4 == 1);
    joints theta;
    for (double& x : theta) {
      x = random.uniform(-pi, pi);
    }
    for (const double offset : {0., 1e-16, 1e-14}) {
      theta[4] = offset;
      const result found = all_inverse_kinematics(arm, arm.pose(theta));
      CHECK_FALSE(found.is_complete);
      bool is_met = false;
      for (const auto& s : found.solutions) {
        CHECK(s.residual <= 1e-12);
        is_met = is_met || s.smallest_singular_value < 1e-10;
      }
      CHECK(is_met);
    }
  }
}

} // namespace
} // namespace test_robotics_beside_singularities
