// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "accuracy/inputs.hpp"
#include "accuracy/oracles.hpp"
#include "accuracy/probe.hpp"

#include <duet/quaternion/euler.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/exponential_jacobian.hpp>
#include <duet/quaternion/rate.hpp>
#include <duet/quaternion/rotation.hpp>

/// \file
/// Functions of quaternions as functions of lists of numbers, four for a quaternion.

namespace duet_test::accuracy {

template <class T>
[[nodiscard]] duet::quaternion<T> rotation_at(const std::vector<T>& x, std::size_t first = 0) {
  return {x[first], x[first + 1], x[first + 2], x[first + 3]};
}
template <class T>
[[nodiscard]] duet::vector3<T> axis_at(const std::vector<T>& x, std::size_t first = 0) {
  return {x[first], x[first + 1], x[first + 2]};
}
template <class T>
[[nodiscard]] std::vector<T> numbers_of(const duet::quaternion<T>& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}
template <class T, int C>
[[nodiscard]] std::vector<T> numbers_of(const Eigen::Matrix<T, 3, C>& m) {
  return {m.data(), m.data() + m.size()};
}

[[nodiscard]] inline input rotation_and_number(int n, random_source& random) {
  return joined(hard_rotation(n, random), random.uniform(-1.5, 1.5),
                n % 2 == 0 ? random.normal() : 0);
}
/// Two rotations, sometimes equal or near each other, and a number.
[[nodiscard]] inline input two_rotations(int n, random_source& random) {
  const input a = hard_rotation(n, random);
  input b = hard_rotation(n * 5 + 3, random);
  if (n % 4 == 1) {
    const double separation = n % 8 == 1 ? 0 : 1e-9;
    b.where = separation == 0 ? "equal" : "1e-9 apart";
    for (std::size_t i = 0; i < 4; ++i) {
      b.x[i] = a.x[i] * (1 + separation * random.normal());
    }
  }
  return joined(joined(a, b), random.uniform(0, 1), n % 2 == 0 ? 1 : 0);
}
[[nodiscard]] inline input two_unit_rotations(int n, random_source& random) {
  return of_constant_norm(of_constant_norm(two_rotations(n, random), 0), 4);
}
[[nodiscard]] inline input moving_rotation(int n, random_source& random) {
  const input a = hard_rotation(n, random);
  input rate{"", some_rates(random, a.x, n / 3), {}, a.parts};
  rate.direction = some_rates(random, rate.x, n / 5);
  input result = joined(a, rate);
  result.where = a.where;
  return result;
}
/// An angle times a direction.
[[nodiscard]] inline input rotation_vector_input(int n, random_source& random) {
  const named angle = hard_angles[std::size_t(n) % std::size(hard_angles)];
  input result{angle.name, {}, {}, {3}};
  for (const double c : some_direction(random, n)) {
    result.x.push_back(c * angle.value);
  }
  result.direction = some_rates(random, result.x, n / 2);
  return result;
}
[[nodiscard]] inline input vector_of_length(double length, int n, random_source& random) {
  input result{"a vector", {}, {}, {3}};
  for (const double c : some_direction(random, n)) {
    result.x.push_back(c * length);
  }
  result.direction = some_rates(random, result.x, n);
  return result;
}
[[nodiscard]] inline input rotation_and_vector(int n, random_source& random) {
  return joined(rotation_vector_input(n, random),
                vector_of_length(random.log_uniform(1e-8, 1e8), n / 2, random));
}
[[nodiscard]] inline input axis_and_angle(int n, random_source& random) {
  const named angle = hard_angles[std::size_t(n) % std::size(hard_angles)];
  input result = joined(vector_of_length(random.log_uniform(1e-8, 1e8), n, random), angle.value,
                        n % 2 == 0 ? random.normal() : angle.value);
  result.where = angle.name;
  return result;
}
/// Two vectors, sometimes nearly parallel, never opposite.
[[nodiscard]] inline input two_vectors(int n, random_source& random) {
  const input a = vector_of_length(random.log_uniform(1e-4, 1e4), n, random);
  input b = vector_of_length(random.log_uniform(1e-4, 1e4), n / 2, random);
  const double separation = n % 3 == 0 ? 1e-9 : n % 3 == 1 ? 1e-3 : 1;
  b.where = separation < 1 ? "nearly parallel" : "another";
  for (std::size_t i = 0; i < 3; ++i) {
    b.x[i] = a.x[i] + separation * b.x[i];
  }
  return joined(a, b);
}
/// Rotations away from gimbal lock and from jumps of an angle by 2π.
template <duet::euler_sequence Sequence>
[[nodiscard]] input attitude(int n, random_source& random) {
  for (;; ++n) {
    const input result = hard_rotation(n, random);
    const auto a = duet::euler<Sequence>(rotation_at(result.x));
    const double lock = Sequence.is_proper() ? std::sin(a[1]) : std::cos(a[1]);
    if (lock > 0.05 && std::abs(a[0]) < 3.1 && std::abs(a[2]) < 3.1) {
      return result;
    }
  }
}
[[nodiscard]] inline input two_angles(int n, random_source& random) {
  const double sizes[] = {1, 1e-8, 1.5707963267948966, 1e-300, 2.5};
  return {"two angles",
          {sizes[n % 5], sizes[n / 5 % 5] * random.uniform(-1, 1)},
          {random.normal(), random.normal()},
          {1, 1}};
}

template <class T, duet::euler_sequence Sequence>
[[nodiscard]] probed<T> euler_in(const char* name) {
  return {name,
          {1, 1, 1},
          [](const std::vector<T>& x) {
            const auto a = duet::euler<Sequence>(rotation_at(x));
            return std::vector<T>{a[0], a[1], a[2]};
          },
          [](const jets& x) {
            return oracle::euler(x, {std::size_t(Sequence.first), std::size_t(Sequence.second),
                                     std::size_t(Sequence.third)});
          },
          attitude<Sequence>};
}
/// All sequences: first those with three axes, then those with two.
template <class T>
[[nodiscard]] std::array<std::vector<probed<T>>, 2> euler_functions() {
  return {{{euler_in<T, duet::xyz>("xyz"), euler_in<T, duet::yzx>("yzx"),
            euler_in<T, duet::zxy>("zxy"), euler_in<T, duet::xzy>("xzy"),
            euler_in<T, duet::yxz>("yxz"), euler_in<T, duet::zyx>("zyx")},
           {euler_in<T, duet::xyx>("xyx"), euler_in<T, duet::yzy>("yzy"),
            euler_in<T, duet::zxz>("zxz"), euler_in<T, duet::xzx>("xzx"),
            euler_in<T, duet::yxy>("yxy"), euler_in<T, duet::zyz>("zyz")}}};
}

template <class T>
[[nodiscard]] std::vector<probed<T>> rotation_functions() {
  using list = std::vector<T>;
  using duet::frame::body, duet::frame::spatial;
  return {
      {"exp of a vector",
       {4},
       [](const list& x) { return numbers_of(duet::exp(axis_at(x))); },
       oracle::vector_exp,
       rotation_vector_input},
      {"log of a quaternion",
       {1, 3},
       [](const list& x) { return numbers_of(log(rotation_at(x))); },
       oracle::log,
       hard_rotation},
      {"pow of a quaternion",
       {4},
       [](const list& x) { return numbers_of(pow(rotation_at(x), x[4])); },
       oracle::pow,
       rotation_and_number},
      {"slerp",
       {4},
       [](const list& x) {
         return numbers_of(
             slerp(rotation_at(x), rotation_at(x, 4), x[8], duet::slerp_arc::as_given));
       },
       oracle::slerp,
       two_unit_rotations},
      {"slerp, norms that change",
       {4},
       [](const list& x) {
         return numbers_of(
             slerp(rotation_at(x), rotation_at(x, 4), x[8], duet::slerp_arc::as_given));
       },
       oracle::slerp,
       two_rotations},
      {"rotation_vector",
       {3},
       [](const list& x) { return numbers_of(rotation_vector(rotation_at(x))); },
       oracle::rotation_vector,
       hard_rotation},
      {"from_axis_angle",
       {4},
       [](const list& x) { return numbers_of(duet::from_axis_angle(axis_at(x), x[3])); },
       oracle::from_axis_angle,
       axis_and_angle},
      {"from_two_vectors",
       {1, 3},
       [](const list& x) { return numbers_of(duet::from_two_vectors(axis_at(x), axis_at(x, 3))); },
       oracle::from_two_vectors,
       two_vectors},
      {"rotate by exp",
       {3},
       [](const list& x) { return numbers_of(rotate(duet::exp(axis_at(x)), axis_at(x, 3))); },
       oracle::rotate,
       rotation_and_vector},
      {"rotation_matrix of exp",
       {9},
       [](const list& x) { return numbers_of(rotation_matrix(duet::exp(axis_at(x)))); },
       oracle::rotation_matrix,
       rotation_vector_input},
      {"left_jacobian",
       {9},
       [](const list& x) { return numbers_of(duet::left_jacobian(axis_at(x))); },
       oracle::jacobian,
       rotation_vector_input},
      {"left_jacobian_inverse",
       {9},
       [](const list& x) { return numbers_of(duet::left_jacobian_inverse(axis_at(x))); },
       oracle::jacobian_inverse,
       rotation_vector_input},
      {"angular_velocity, spatial",
       {3},
       [](const list& x) {
         return numbers_of(angular_velocity(rotation_at(x), rotation_at(x, 4), spatial));
       },
       oracle::spatial_velocity,
       moving_rotation},
      {"angular_velocity, body",
       {3},
       [](const list& x) {
         return numbers_of(angular_velocity(rotation_at(x), rotation_at(x, 4), body));
       },
       oracle::body_velocity,
       moving_rotation},
      {"euler_rate_matrix, zyx",
       {9},
       [](const list& x) { return numbers_of(duet::euler_rate_matrix<duet::zyx>(x[0], x[1])); },
       oracle::euler_rate_zyx,
       two_angles},
  };
}

} // namespace duet_test::accuracy
