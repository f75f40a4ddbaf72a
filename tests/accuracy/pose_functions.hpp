// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "accuracy/inputs.hpp"
#include "accuracy/oracles.hpp"
#include "accuracy/probe.hpp"

#include <duet/dual_quaternion/exponential_jacobian.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/dual_quaternion/twist.hpp>

/// \file
/// Functions of dual quaternions as functions of lists of numbers. A pose has eight numbers, real
/// part first, a twist [v; ω] six.

namespace duet_test::accuracy {

template <class T>
[[nodiscard]] duet::dual_quaternion<T> pose_at(const std::vector<T>& x, std::size_t first = 0) {
  const auto dual = [&](std::size_t i) {
    return duet::screw_dual<T>(x[first + i], x[first + i + 4]);
  };
  return {dual(0), dual(1), dual(2), dual(3)};
}
template <class T>
[[nodiscard]] duet::vector3<T> vector_at(const std::vector<T>& x, std::size_t first) {
  return {x[first], x[first + 1], x[first + 2]};
}
/// The exponential of a dual vector: of unit norm for every direction of differentiation.
template <class T>
[[nodiscard]] duet::dual_quaternion<T> moved(const std::vector<T>& x) {
  return duet::exp(duet::make_dual_vector(vector_at(x, 0), vector_at(x, 3)));
}
template <class T>
[[nodiscard]] duet::vector6<T> twist_at(const std::vector<T>& x) {
  duet::vector6<T> result;
  for (int i = 0; i < 6; ++i) {
    result[i] = x[std::size_t(i)];
  }
  return result;
}
template <class T>
[[nodiscard]] std::vector<T> list_of(const duet::dual_quaternion<T>& a) {
  return {a.w().value(),   a.x().value(),   a.y().value(),   a.z().value(),
          a.w().epsilon(), a.x().epsilon(), a.y().epsilon(), a.z().epsilon()};
}
template <class T, int R, int C>
[[nodiscard]] std::vector<T> list_of(const Eigen::Matrix<T, R, C>& m) {
  return {m.data(), m.data() + m.size()};
}
/// The blocks of [A B; 0 A] that are not zero.
template <class T>
[[nodiscard]] std::vector<T> blocks_of(const duet::matrix6<T>& m) {
  std::vector<T> result;
  for (const auto& [row, column] : {std::pair{0, 0}, {0, 3}, {3, 3}}) {
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) {
        result.push_back(m(row + i, column + j));
      }
    }
  }
  return result;
}

[[nodiscard]] inline input pose_input(int n, random_source& random) { return hard_pose(n, random); }

/// A pose and a number, inside or outside of [0, 1], constant or not.
[[nodiscard]] inline input pose_and_number(int n, random_source& random) {
  return joined(hard_pose(n, random), random.uniform(-0.5, 1.5), n % 2 == 0 ? random.normal() : 0);
}

/// Two poses, sometimes equal or near each other, and a number.
[[nodiscard]] inline input two_poses(int n, random_source& random) {
  input a = hard_pose(n, random);
  input b = hard_pose(n * 5 + 3, random);
  if (n % 4 == 1) {
    const double separation = n % 8 == 1 ? 0 : 1e-9;
    b.where = separation == 0 ? "equal poses" : "poses 1e-9 apart";
    for (std::size_t i = 0; i < 8; ++i) {
      b.x[i] = a.x[i] * (1 + separation * random.normal());
    }
  }
  return joined(joined(a, b), random.uniform(0, 1), n % 2 == 0 ? 1 : 0);
}

[[nodiscard]] inline input two_unit_poses(int n, random_source& random) {
  return of_constant_dual_norm(of_constant_dual_norm(two_poses(n, random), 0), 8);
}

/// Half a rotation vector and half a translation along and across it: six numbers, angular first.
[[nodiscard]] inline input screw_input(int n, random_source& random, double factor) {
  const named angle = hard_angles[std::size_t(n) % std::size(hard_angles)];
  const named length = hard_lengths[std::size_t(n) % std::size(hard_lengths)];
  input result{std::string(angle.name) + ", " + length.name, {}, {}, {3, 3}};
  const auto axis = some_direction(random, n);
  const auto along = n % 4 == 3 ? axis : some_direction(random, n / 3);
  for (const double c : axis) {
    result.x.push_back(c * angle.value * factor);
  }
  for (const double c : along) {
    result.x.push_back(c * length.value * factor);
  }
  result.direction = some_rates(random, result.x, n / 2);
  return result;
}
[[nodiscard]] inline input half_screw(int n, random_source& random) {
  return screw_input(n, random, 0.5);
}
/// [v; ω]
[[nodiscard]] inline input twist_input(int n, random_source& random) {
  input result = screw_input(n, random, 1);
  std::rotate(result.x.begin(), result.x.begin() + 3, result.x.end());
  result.direction = some_rates(random, result.x, n / 2);
  return result;
}
/// A pose and its rate.
[[nodiscard]] inline input moving_pose(int n, random_source& random) {
  input a = hard_pose(n, random);
  input rate{"", some_rates(random, a.x, n / 3), {}, a.parts};
  rate.direction = some_rates(random, rate.x, n / 5);
  a = joined(a, rate);
  a.where.resize(a.where.size() - 2);
  return a;
}
/// A screw motion and a pose at any distance.
[[nodiscard]] inline input motion_and_point(int n, random_source& random) {
  const double far = random.log_uniform(1e-8, 1e8);
  input point{"a point", {}, {}, {3}};
  for (const double c : some_direction(random, n)) {
    point.x.push_back(c * far);
  }
  point.direction = some_rates(random, point.x, n);
  return joined(half_screw(n, random), point);
}
/// Poses with a determined screw axis: angles not too small to locate it, and not half turns.
[[nodiscard]] inline input pose_of_a_screw(int n, random_source& random) {
  for (;; ++n) {
    input result = hard_pose(n, random);
    const double vector = std::hypot(result.x[1], result.x[2], result.x[3]);
    if (vector > 1e-8 && std::abs(result.x[0]) > 1e-3) {
      return result;
    }
  }
}
/// Screw parameters: axis, moment, angle, translation.
[[nodiscard]] inline input screw_coordinates(int n, random_source& random) {
  const named angle = hard_angles[std::size_t(n) % std::size(hard_angles)];
  const named length = hard_lengths[std::size_t(n) % std::size(hard_lengths)];
  input result{std::string(angle.name) + ", " + length.name, {}, {}, {3, 3, 1, 1}};
  for (const double c : some_direction(random, n)) {
    result.x.push_back(c);
  }
  const double far = random.log_uniform(1e-3, 1e3);
  for (const double c : some_direction(random, n / 3)) {
    result.x.push_back(c * far);
  }
  result.x.push_back(angle.value);
  result.x.push_back(length.value);
  result.direction = some_rates(random, result.x, n / 2);
  return result;
}

template <class T>
[[nodiscard]] std::vector<probed<T>> pose_functions() {
  using list = std::vector<T>;
  using duet::frame::body, duet::frame::spatial;
  return {
      {"exp of a dual vector",
       {4, 4},
       [](const list& x) { return list_of(moved(x)); },
       oracle::dual_exp,
       half_screw},
      {"log of a dual quaternion",
       {4, 4},
       [](const list& x) { return list_of(log(pose_at(x))); },
       oracle::dual_log,
       pose_input},
      {"pow of a dual quaternion",
       {4, 4},
       [](const list& x) { return list_of(pow(pose_at(x), x[8])); },
       oracle::dual_pow,
       pose_and_number},
      {"sclerp",
       {4, 4},
       [](const list& x) {
         return list_of(sclerp(pose_at(x), pose_at(x, 8), x[16], duet::slerp_arc::as_given));
       },
       oracle::sclerp,
       two_unit_poses},
      {"sclerp, norms that change",
       {4, 4},
       [](const list& x) {
         return list_of(sclerp(pose_at(x), pose_at(x, 8), x[16], duet::slerp_arc::as_given));
       },
       oracle::sclerp,
       two_poses},
      {"screw_parameters",
       {3, 3, 1, 1},
       [](const list& x) {
         const auto s = screw_parameters(pose_at(x));
         return std::vector{s.axis[0],   s.axis[1],   s.axis[2], s.moment[0],
                            s.moment[1], s.moment[2], s.angle,   s.translation};
       },
       oracle::screw_parameters,
       pose_of_a_screw},
      {"from_screw",
       {4, 4},
       [](const list& x) {
         return list_of(duet::from_screw(vector_at(x, 0), vector_at(x, 3), x[6], x[7]));
       },
       oracle::from_screw,
       screw_coordinates},
      {"translation",
       {3},
       [](const list& x) { return list_of(translation(pose_at(x))); },
       oracle::translation,
       pose_input},
      {"transform_point by exp",
       {3},
       [](const list& x) { return list_of(transform_point(moved(x), vector_at(x, 6))); },
       oracle::transform_point,
       motion_and_point},
      {"Ad of exp",
       {9, 9, 9},
       [](const list& x) { return blocks_of(Ad(moved(x))); },
       oracle::adjoint,
       half_screw},
      {"twist, spatial",
       {3, 3},
       [](const list& x) { return list_of(twist(pose_at(x), pose_at(x, 8), spatial)); },
       oracle::spatial_twist,
       moving_pose},
      {"twist, body",
       {3, 3},
       [](const list& x) { return list_of(twist(pose_at(x), pose_at(x, 8), body)); },
       oracle::body_twist,
       moving_pose},
      {"left_jacobian of a twist",
       {9, 9, 9},
       [](const list& x) { return blocks_of(duet::left_jacobian(twist_at(x))); },
       oracle::pose_jacobian,
       twist_input},
      {"left_jacobian_inverse of a twist",
       {9, 9, 9},
       [](const list& x) { return blocks_of(duet::left_jacobian_inverse(twist_at(x))); },
       oracle::pose_jacobian_inverse,
       twist_input},
  };
}

} // namespace duet_test::accuracy
