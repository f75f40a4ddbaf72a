// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "accuracy/inputs.hpp"

namespace duet_test::accuracy {
namespace {

/// The unit quaternion of a rotation about a unit vector, in 100 digits.
std::array<real, 4> exact_rotation(const std::array<double, 3>& axis, double angle) {
  const real x(axis[0]), y(axis[1]), z(axis[2]), half = real(angle) / 2;
  const real factor = sin(half) / sqrt(x * x + y * y + z * z);
  return {cos(half), x * factor, y * factor, z * factor};
}

} // namespace

std::array<double, 3> some_direction(random_source& random, int kind) {
  if (kind % 5 == 4) {
    std::array<double, 3> d = {0, 0, 0};
    d[std::size_t(kind / 5 % 3)] = 1;
    return d;
  }
  return random.direction<3>();
}

numbers some_rates(random_source& random, const numbers& x, int kind) {
  numbers d;
  for (const double v : x) {
    const double normal = random.normal();
    d.push_back(kind % 3 == 0   ? normal
                : kind % 3 == 1 ? normal * v
                                : (random.uniform(0, 1) < 0.3 ? normal : 0));
  }
  return d;
}

input hard_rotation(int n, random_source& random) {
  const named angle = hard_angles[std::size_t(n) % std::size(hard_angles)];
  input result{angle.name, {}, {}, {1, 3}};
  for (const real& c : exact_rotation(some_direction(random, n), angle.value)) {
    result.x.push_back(double(c));
  }
  result.direction = some_rates(random, result.x, n / 2);
  return result;
}

input hard_pose(int n, random_source& random) {
  const named angle = hard_angles[std::size_t(n) % std::size(hard_angles)];
  const named length = hard_lengths[std::size_t(n) % std::size(hard_lengths)];
  const auto axis = some_direction(random, n);
  const auto along = n % 4 == 3 ? axis : some_direction(random, n / 3);
  const auto a = exact_rotation(axis, angle.value);
  real half[3];
  for (std::size_t i = 0; i < 3; ++i) {
    half[i] = real(along[i]) * length.value / 2;
  }
  input result{std::string(angle.name) + ", " + length.name, {}, {}, {1, 3, 1, 3}};
  for (const real& c : a) {
    result.x.push_back(double(c));
  }
  // ½ t α
  result.x.push_back(double(real(-half[0] * a[1] - half[1] * a[2] - half[2] * a[3])));
  result.x.push_back(double(real(half[0] * a[0] + half[1] * a[3] - half[2] * a[2])));
  result.x.push_back(double(real(half[1] * a[0] + half[2] * a[1] - half[0] * a[3])));
  result.x.push_back(double(real(half[2] * a[0] + half[0] * a[2] - half[1] * a[1])));
  result.direction = some_rates(random, result.x, n / 2);
  return result;
}

input of_constant_norm(input at, std::size_t first) {
  double along = 0, square = 0;
  for (std::size_t i = first; i < first + 4; ++i) {
    along += at.x[i] * at.direction[i];
    square += at.x[i] * at.x[i];
  }
  for (std::size_t i = first; i < first + 4; ++i) {
    at.direction[i] -= along / square * at.x[i];
  }
  return at;
}

input of_constant_dual_norm(input at, std::size_t first) {
  at = of_constant_norm(at, first);
  double along = 0, square = 0; // of ⟨p, q⟩, with p + εq
  for (std::size_t i = first; i < first + 4; ++i) {
    along += at.x[i] * at.direction[i + 4] + at.direction[i] * at.x[i + 4];
    square += at.x[i] * at.x[i];
  }
  for (std::size_t i = first; i < first + 4; ++i) {
    at.direction[i + 4] -= along / square * at.x[i];
  }
  return at;
}

} // namespace duet_test::accuracy
