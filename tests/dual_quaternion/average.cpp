// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "dual_quaternion/cases.hpp"
#include "support/message.hpp"
#include "support/test.hpp"

#include <duet/comparison/rotations.hpp>
#include <duet/derivative/derivative.hpp>
#include <duet/interop/multiprecision.hpp>
#include <duet/quaternion/average.hpp>
#include <duet/quaternion/exponential.hpp>

// Means of rotations and poses, and their derivatives.

namespace test_dual_quaternion_average {
namespace {

using duet::average, duet::conj, duet_test::max_abs_difference, duet_test::vector;
using rotation = duet::quaternion<double>;
using dual_quaternion = duet::dual_quaternion<double>;

std::vector<dual_quaternion> some_poses(int count, double largest_angle) {
  duet_test::random_source random(11);
  std::vector<dual_quaternion> result;
  for (int i = 0; i < count; ++i) {
    const auto axis = random.direction<3>();
    const double angle = random.uniform(0, largest_angle);
    const double sign = i % 2 == 0 ? 1 : -1;
    result.push_back(
        sign *
        duet::pose(duet::from_rotation_vector(vector(angle * vector(axis[0], axis[1], axis[2]))),
                   vector(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2))));
  }
  return result;
}

template <class T>
std::vector<duet::quaternion<T>> rotations_of(const std::vector<duet::dual_quaternion<T>>& poses) {
  std::vector<duet::quaternion<T>> result;
  for (const auto& a : poses) {
    result.push_back(duet::rotation(a));
  }
  return result;
}

template <class Q>
std::string message(const std::vector<Q>& q, const std::vector<double>& weights) {
  return duet_test::message_of<std::exception>([&] { static_cast<void>(average(q, weights)); });
}

double pose_difference(const dual_quaternion& a, const dual_quaternion& b) {
  return std::min(max_abs_difference(a, b), max_abs_difference(a, -b));
}

TEST_CASE("average: the mean of two poses lies on the screw between them") {
  const auto p = some_poses(2, 1.5);
  CHECK(pose_difference(average(p), slerp(p[0], p[1], 0.5)) < 2e-15);
  CHECK(pose_difference(average(p, {3, 1}), slerp(p[0], p[1], 0.25)) < 2e-15);
  CHECK(average({p[0], p[1]}) == average(p));
  CHECK(average({p[0], p[1]}, {3, 1}) == average(p, {3, 1}));
  CHECK(pose_difference(average(p, {0, 2}), p[1]) < 1e-15);
}

TEST_CASE("average: the sum of logarithms vanishes in rotation and translation") {
  for (const double angle : {1e-8, 0.5, 1.5}) {
    const auto p = some_poses(9, angle);
    const auto mean = average(p);
    CHECK(is_unit(mean, 4e-15));
    duet::dual_vector<double> sum = duet::dual_vector<double>::Zero();
    for (const auto& a : p) {
      const auto relative = conj(mean) * a;
      sum += log(relative.w().value() < 0 ? -relative : relative).vec();
    }
    CHECK(duet::real_part(sum).norm() < 1e-15);
    CHECK(duet::dual_part(sum).norm() < 1e-14);
    CHECK(max_abs_difference(duet::rotation_matrix(duet::rotation(mean)),
                             duet::rotation_matrix(average(rotations_of(p)))) < 1e-15);
  }
}

TEST_CASE("average: minimises the sum of squares within a quarter turn of one rotation") {
  duet_test::random_source random(3);
  const auto rotation_of_angle = [&](double angle) {
    const auto d = random.direction<3>();
    return duet::from_rotation_vector(vector(angle * vector(d[0], d[1], d[2])));
  };
  for (int table = 0; table < 100; ++table) {
    const rotation centre = rotation_of_angle(random.uniform(0, 3));
    std::vector<rotation> q;
    std::vector<double> w;
    for (int k = 0; k < 2 + table % 8; ++k) {
      q.push_back(centre * rotation_of_angle(1.57)); // all at the boundary of the domain
      w.push_back(random.uniform(0.01, 1));
    }
    const auto direction = [&](const rotation& m) {
      vector sum = vector::Zero();
      double weights = 0;
      for (std::size_t k = 0; k < q.size(); ++k) {
        sum += w[k] * duet::rotation_vector(conj(m) * q[k]);
        weights += w[k];
      }
      return vector(sum / weights);
    };
    const auto squares = [&](const rotation& m) {
      double sum = 0;
      for (std::size_t k = 0; k < q.size(); ++k) {
        sum += w[k] * duet::rotation_vector(conj(m) * q[k]).squaredNorm();
      }
      return sum;
    };
    const double sum_at_mean = squares(average(q, w));
    for (rotation m : q) { // gradient descent from each rotation
      for (int i = 0; i < 100; ++i) {
        m = normalized(m * duet::from_rotation_vector(direction(m)));
      }
      CHECK(sum_at_mean <= squares(m) * (1 + 1e-9) + 1e-12);
    }
  }
}

TEST_CASE("average: derivatives to third order agree with differences in 50 digits") {
  const auto p = some_poses(5, 1.2);
  const auto moving = [&]<class T>(const T& t) {
    std::vector<duet::dual_quaternion<T>> q(p.begin(), p.end());
    const duet::vector3<T> r(T(0.4 * t), T(-0.7 * t * t), T(sin(t)));
    q[1] = duet::pose(duet::from_rotation_vector(r), duet::vector3<T>(t, t * t, -t)) * q[1];
    return average(q);
  };
  const auto d = duet::derivatives<3>(moving, 0.3);
  using wide = duet::real_50;
  const wide h("1e-9");
  std::vector<duet::dual_quaternion<wide>> at;
  for (int k = -2; k <= 2; ++k) {
    at.push_back(moving(wide(wide(0.3) + k * h)));
  }
  const auto difference = [&](std::vector<int> weights, const wide& scale) {
    duet::dual_quaternion<wide> sum;
    for (std::size_t k = 0; k < 5; ++k) {
      sum = sum + at[k] * wide(weights[k]);
    }
    return dual_quaternion(sum * wide(1 / scale));
  };
  CHECK(max_abs_difference(d[0], dual_quaternion(at[2])) < 2e-15);
  CHECK(max_abs_difference(d[1], difference({1, -8, 0, 8, -1}, wide(12 * h))) < 1e-14);
  CHECK(max_abs_difference(d[2], difference({-1, 16, -30, 16, -1}, wide(12 * h * h))) < 1e-13);
  CHECK(max_abs_difference(d[3], difference({-1, 2, 0, -2, 1}, wide(2 * h * h * h))) < 1e-12);
}

TEST_CASE("average: rejects empty lists and invalid weights") {
  const std::vector<rotation> q = {rotation(1, 0, 0, 0), rotation(0, 1, 0, 0)};
  CHECK(message(std::vector<rotation>(), {}) == "duet: average: there are no elements");
  CHECK(message(q, {1}) ==
        "duet: average: 1 weights for 2 elements (expected as many weights as elements)");
  CHECK(message(q, {1, -2}) == "duet: average: weight 1 is -2 (expected a finite number >= 0)");
  CHECK(message(q, {1, NAN}) == "duet: average: weight 1 is nan (expected a finite number >= 0)");
  CHECK(message(q, {0, 0}) ==
        "duet: average: all weights are 0 (expected at least one positive weight)");
}

TEST_CASE("average: only ratios of weights matter, however large or small they are") {
  const std::vector<duet::quaternion<double>> q = {
      duet::from_rotation_vector(duet::vector3<double>(0.2, 0, 0)),
      duet::from_rotation_vector(duet::vector3<double>(0, 0.4, 0))};
  const auto expected = duet::average(q, {1, 3});
  for (const double unit : {4e-324, 1e-310, 5e307}) {
    CAPTURE(unit);
    const auto result = duet::average(q, {unit, 3 * unit});
    CHECK(duet::rotation_vector(conj(expected) * result).norm() <= 1e-15);
  }
}

} // namespace
} // namespace test_dual_quaternion_average
