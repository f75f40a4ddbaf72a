// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// The same seven-joint arm as a chain of duet: known to the compiler, and as a table in memory.

#include "support/contest.hpp"
#include "workloads.hpp"

#include <duet/mechanism/jacobian.hpp>
#include <duet/mechanism/robots.hpp>

#include <array>
#include <cstddef>
#include <utility>

namespace duet_bench {
namespace {

using joint_angles = inputs<double, joints>;

std::array<double, 7> numbers(const duet::dual_quaternion<double>& a) {
  const auto t = duet::translation(a);
  const auto q = duet::rotation(a);
  return {t[0], t[1], t[2], q.w(), q.x(), q.y(), q.z()};
}
std::array<double, 7> numbers(const pose<double>& a) {
  return {a.position[0], a.position[1], a.position[2], a.rotation[0],
          a.rotation[1], a.rotation[2], a.rotation[3]};
}

constexpr auto known = duet::robots::panda();

const bool registered = [] {
  const joint_angles angles = {0.3, -0.7, 1.1, -1.9, 0.4, 1.6, -0.8};
  const auto table = known.table();
  const auto by_hand = [](const joint_angles& x) {
    pose_jacobian jacobian;
    const pose<double> a = fk7_by_hand(x, jacobian);
    return std::pair(a, jacobian);
  };

  expect_agreement("arm_pose", "duet", numbers(fk7(angles)), numbers(known.pose(angles)));
  expect_agreement("arm_pose_of_table", "duet", numbers(fk7(angles)), numbers(table.pose(angles)));
  contest("arm_pose", "duet", angles, [](const joint_angles& x) { return known.pose(x); });
  contest("arm_pose", "hand", angles, [](const joint_angles& x) { return fk7(x); });
  contest("arm_pose_of_table", "duet", angles,
          [table](const joint_angles& x) { return table.pose(x); });
  contest("arm_pose_of_table", "hand", angles, [](const joint_angles& x) { return fk7(x); });

  const auto [a, jacobian] = by_hand(angles);
  const auto j = duet::pose_and_jacobian(known, angles, duet::frame::hybrid).jacobian;
  for (std::size_t i = 0; i < 3; ++i) {
    std::array<double, joints> row;
    for (std::size_t k = 0; k < joints; ++k) {
      row[k] = j(Eigen::Index(i), Eigen::Index(k));
    }
    expect_agreement("arm_jacobian", "duet", jacobian[i], row);
  }
  contest("arm_jacobian", "duet", angles, [](const joint_angles& x) {
    return duet::pose_and_jacobian(known, x, duet::frame::hybrid);
  });
  contest("arm_jacobian", "hand", angles, by_hand);
  contest("arm_jacobian_of_table", "duet", angles, [table](const joint_angles& x) {
    return duet::pose_and_jacobian(table, x, duet::frame::hybrid);
  });
  contest("arm_jacobian_of_table", "hand", angles, by_hand);
  contest("arm_spatial_jacobian", "duet", angles,
          [](const joint_angles& x) { return duet::jacobian(known, x, duet::frame::spatial); });
  contest("arm_spatial_jacobian", "hand", angles, by_hand);
  return true;
}();

} // namespace
} // namespace duet_bench
