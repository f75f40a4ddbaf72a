// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/multiprecision.hpp"
#include "support/random.hpp"

#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/mechanism/denavit_hartenberg.hpp>
#include <duet/mechanism/jacobian.hpp>
#include <duet/mechanism/serial_chain.hpp>
#include <duet/planning/all_inverse_kinematics.hpp>

#include <doctest/doctest.h>

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

namespace test_planning_beside_singularities {
namespace {

using namespace duet;
using duet_test::real_50;
using std::numbers::pi;
using chain = serial_chain<6>;
using joints = Eigen::Matrix<double, 6, 1>;
using wide_joints = Eigen::Matrix<real_50, 6, 1>;
using result = all_inverse_kinematics_result<6>;

constexpr std::array distances{1e-3,  3e-4,  1e-4,  1e-5,  1e-6,  3e-7,  1e-7,  1e-8, 1e-9,
                               1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15, 1e-16, 0.};

/// A shoulder whose axes do not meet, an elbow, and a wrist whose axes meet: the outer ones are one
/// where the coordinate of the middle one is 0.
chain with_wrist(duet_test::random_source& random, double tilt) {
  const auto length = [&] { return random.uniform(.1, 1); };
  return from_dh(std::array<dh_row<>, 6>{{{.a = length(), .d = length(), .alpha = pi / 2},
                                          {.a = length(), .d = length()},
                                          {.a = length(), .alpha = -pi / 2},
                                          {.d = length(), .alpha = tilt},
                                          {.alpha = -tilt},
                                          {.d = length()}}});
}

/// Three parallel axes; the sixth is parallel to them where the coordinate of the fifth is 0.
chain with_parallel_axes(duet_test::random_source& random, bool is_apart) {
  const auto length = [&] { return random.uniform(.1, 1); };
  return from_dh(
      std::array<dh_row<>, 6>{{{.d = length(), .alpha = pi / 2},
                               {.a = length()},
                               {.a = length()},
                               {.d = length(), .alpha = pi / 2},
                               {.a = is_apart ? length() : 0., .d = length(), .alpha = -pi / 2},
                               {.d = length()}}});
}

/// A shoulder whose axes meet, and a forearm as long as the upper arm: folded by a quarter turn of
/// the third joint, the wrist is in the shoulder, whatever the first two do.
chain with_folding_elbow(duet_test::random_source& random, double shoulder, double wrist) {
  const double length = random.uniform(.2, 1);
  return from_dh(std::array<dh_row<>, 6>{{{.d = random.uniform(.1, 1), .alpha = shoulder},
                                          {.a = length},
                                          {.alpha = pi / 2},
                                          {.d = length, .alpha = -wrist},
                                          {.alpha = wrist},
                                          {.d = random.uniform(.1, 1)}}});
}

/// The same with axes 2 and 3 not parallel, and offsets of all lengths.
struct skew_elbow {
  std::array<dh_row<>, 6> rows;
  double fold; ///< the third coordinate that brings the wrist into the shoulder
};
/// \param miss  by which it comes no nearer than that
skew_elbow with_skew_elbow(duet_test::random_source& random, double miss) {
  const auto angle = [&] { return random.uniform(.6, 1.5); };
  const double a2 = random.uniform(.2, 1), d2 = random.uniform(-.5, .5), alpha2 = angle(),
               alpha3 = angle(), across = d2 * std::sin(alpha2), wrist = angle();
  // From the third axis the shoulder is as far as the wrist, and at the same height.
  const double distance = std::hypot(a2, across), a3 = random.uniform(-.9, .9) * distance,
               beside = std::sqrt(distance * distance - a3 * a3), d4 = beside / std::sin(alpha3),
               d3 = -d2 * std::cos(alpha2) - d4 * std::cos(alpha3);
  return {{{{.d = random.uniform(.1, 1), .alpha = angle()},
            {.a = a2, .d = d2, .alpha = alpha2},
            {.a = a3, .d = d3 + miss, .alpha = alpha3},
            {.d = d4, .alpha = -wrist},
            {.alpha = wrist},
            {.d = random.uniform(.1, 1)}}},
          std::atan2(-across, -a2) - std::atan2(-beside, a3)};
}

/// The arm from its tip to its base: coordinates are in the other order, times −1.
std::array<dh_row<>, 6> mirrored(const std::array<dh_row<>, 6>& rows) {
  std::array<dh_row<>, 6> result;
  for (std::size_t i = 0; i < 6; ++i) {
    const dh_row<> before = i < 5 ? rows[4 - i] : dh_row<>{};
    result[i] = {.a = -before.a, .d = -rows[5 - i].d, .alpha = -before.alpha};
  }
  return result;
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

/// The rotation vector and the way to a goal, to first order.
wide_joints way_to(const dual_quaternion<real_50>& goal, const dual_quaternion<real_50>& tip) {
  const auto turn = rotation(goal) * conj(rotation(tip));
  const Eigen::Matrix<real_50, 3, 1> way = translation(goal) - translation(tip);
  wide_joints twist;
  const real_50 twice = turn.w() < 0 ? -2 : 2;
  twist << way[0], way[1], way[2], twice * turn.x(), twice * turn.y(), twice * turn.z();
  return twist;
}

/// The solution in 50 digits that θ is near to, by the Jacobian at θ.
wide_joints exact_solution(const chain& arm, const dual_quaternion<real_50>& goal,
                           const joints& theta) {
  const Eigen::PartialPivLU<Eigen::Matrix<double, 6, 6>> lu(jacobian(arm, theta, frame::hybrid));
  wide_joints exact = theta.cast<real_50>();
  for (int k = 0; k < 60; ++k) {
    const wide_joints way = way_to(goal, arm.pose(exact));
    const double size = double(way.norm());
    if (size < 1e-40) {
      break;
    }
    const joints step = lu.solve((way / size).cast<double>());
    exact += real_50(size) * step.cast<real_50>();
  }
  return exact;
}

/// \param joint  whose coordinate is how far θ is from a singularity
void check_beside(const chain& arm, joints theta, int joint, branch_method method,
                  std::span<const double> how_far = distances) {
  const double singular = theta[joint];
  for (const double side : {1., -1.}) {
    theta[joint] = singular + side * 2e-3;
    const int count = count_of(all_inverse_kinematics(arm, arm.pose(theta)));
    for (const double away : how_far) {
      CAPTURE(side);
      CAPTURE(away);
      theta[joint] = singular + side * away;
      const result found = all_inverse_kinematics(arm, arm.pose(theta));
      CHECK(found.method == method);
      CHECK_FALSE(found.solutions.empty());
      for (const auto& s : found.solutions) {
        CHECK(s.residual <= 1e-12);
      }
      const bool is_certain = away >= 1e-12;
      CHECK(found.is_complete == is_certain);
      if (!is_certain) { // the joints move with the tip in place
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
        CHECK(double(way_to(goal, arm.pose(exact)).norm()) < 1e-35);
        CHECK(distance(exact.cast<double>(), s.joints) < rounding);
        met += distance(theta, s.joints) < rounding;
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

/// With one coordinate singular, beside which nothing else is.
joints configuration(const chain& arm, duet_test::random_source& random, int joint,
                     double singular = 0) {
  constexpr double beside = 2e-3;
  joints theta;
  do {
    for (double& x : theta) {
      x = random.uniform(-pi, pi);
    }
    theta[joint] = singular + beside;
  } while (smallest_singular_value(arm, theta) < .02 * beside);
  theta[joint] = singular;
  return theta;
}

TEST_CASE("beside the singularity of a wrist") {
  duet_test::random_source random(1);
  for (int k = 0; k < 5; ++k) {
    CAPTURE(k);
    const chain arm = with_wrist(random, k < 3 ? pi / 2 : random.uniform(.5, 1.2));
    check_beside(arm, configuration(arm, random, 4), 4, branch_method::spherical_wrist);
  }
}

TEST_CASE("beside the singularity of a wrist after three parallel axes") {
  duet_test::random_source random(2);
  for (int k = 0; k < 5; ++k) {
    CAPTURE(k);
    const chain arm = with_parallel_axes(random, k >= 3);
    check_beside(arm, configuration(arm, random, 4), 4, branch_method::parallel_axes);
  }
}

TEST_CASE("beside an elbow that is folded onto the shoulder") {
  duet_test::random_source random(4);
  const std::span<const double> down_to_1e_10 = std::span(distances).first(10);
  for (int k = 0; k < 10; ++k) {
    CAPTURE(k);
    const double shoulder = k < 3 ? pi / 2 : random.uniform(.6, 1.5),
                 wrist = k % 2 == 0 ? pi / 2 : random.uniform(.6, 1.5);
    const chain arm = with_folding_elbow(random, shoulder, wrist);
    joints theta = configuration(arm, random, 2, -pi / 2);
    check_beside(arm, theta, 2, branch_method::spherical_wrist, down_to_1e_10);
    for (const double away : {1e-13, 1e-14, 1e-16, 0.}) { // the joints move with the tip in place
      theta[2] = -pi / 2 + away;
      const result found = all_inverse_kinematics(arm, arm.pose(theta));
      CHECK_FALSE(found.is_complete);
      for (const auto& s : found.solutions) {
        CHECK(s.residual <= 1e-12);
      }
      // Wrists at right angles make every turn, and so that which is left by any of the first two.
      CHECK((k % 2 != 0 || !found.solutions.empty()));
    }
  }
}

TEST_CASE("beside an elbow that is folded, with axes 2 and 3 not parallel") {
  duet_test::random_source random(5);
  for (int k = 0; k < 10; ++k) {
    CAPTURE(k);
    const double miss = k < 6 ? 0 : 1e-5;
    auto [rows, fold] = with_skew_elbow(random, miss);
    const int joint = k % 2 == 0 ? 2 : 3;
    if (joint == 3) {
      rows = mirrored(rows);
      fold = -fold;
    }
    const chain arm = from_dh(rows);
    joints theta = configuration(arm, random, joint, fold);
    check_beside(arm, theta, joint, branch_method::spherical_wrist,
                 std::span<const double>(distances).first(miss == 0 ? 10 : 3));
    if (miss > 0) {
      continue;
    }
    for (const double away : {1e-11, 1e-12, 1e-13, 1e-14, 1e-16, 0.}) {
      CAPTURE(away);
      theta[joint] = fold + away;
      const result found = all_inverse_kinematics(arm, arm.pose(theta));
      CHECK_FALSE(found.is_complete);
      for (const auto& s : found.solutions) {
        CHECK(s.residual <= 1e-12);
      }
    }
  }
}

/// Whatever else is nearly singular.
TEST_CASE("in the singularity of a wrist") {
  duet_test::random_source random(3);
  for (int k = 0; k < 200; ++k) {
    CAPTURE(k);
    const chain arm =
        k % 2 == 0 ? with_wrist(random, pi / 2) : with_parallel_axes(random, k % 4 == 1);
    joints theta;
    for (double& x : theta) {
      x = random.uniform(-pi, pi);
    }
    for (const double away : {0., 1e-16, 1e-14}) {
      theta[4] = away;
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
} // namespace test_planning_beside_singularities
