// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// The pose of a seven-joint arm and its derivatives with respect to the joint angles.

#include "support/contenders.hpp"
#include "support/contest.hpp"
#include "workloads.hpp"

#include <array>
#include <cstddef>

namespace duet_bench {
namespace {

using joint_angles = inputs<double, joints>;

/// Seven numbers of the pose, then their derivatives row by row.
using pose_and_jacobian = std::array<double, 7 + 7 * joints>;

pose_and_jacobian by_hand(const joint_angles& angles) {
  pose_jacobian jacobian;
  const auto [position, rotation] = fk7_by_hand(angles, jacobian);
  pose_and_jacobian result;
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = position[i];
  }
  for (std::size_t i = 0; i < 4; ++i) {
    result[3 + i] = rotation[i];
  }
  for (std::size_t i = 0; i < 7; ++i) {
    for (std::size_t j = 0; j < joints; ++j) {
      result[7 + joints * i + j] = jacobian[i][j];
    }
  }
  return result;
}

template <class Library>
pose_and_jacobian by_differentiation(const joint_angles& angles) {
  using number = typename Library::template number<joints>;
  const pose<number> y = fk7(seeded<Library, number>(angles));
  pose_and_jacobian result;
  const auto write = [&](std::size_t i, const number& part) {
    result[i] = Library::value(part);
    Library::template write_partials<joints>(part, &result[7 + joints * i]);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    write(i, y.position[i]);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    write(3 + i, y.rotation[i]);
  }
  return result;
}

const bool registered = [] {
  const joint_angles angles = {0.3, -0.7, 1.1, -1.9, 0.4, 1.6, -0.8};
  const auto expected = by_hand(angles);
  register_benchmark("fk7", "value", angles, [](const joint_angles& x) { return fk7(x); });
  register_benchmark("fk7", "hand", angles, by_hand);
  for_each_contender([&](auto contender) {
    using library = decltype(contender);
    expect_agreement("fk7", library::name, expected, by_differentiation<library>(angles));
    register_benchmark("fk7", library::name, angles, by_differentiation<library>);
  });
  return true;
}();

} // namespace
} // namespace duet_bench
