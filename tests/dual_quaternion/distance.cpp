// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "dual_quaternion/cases.hpp"
#include "support/shared_tag.hpp"
#include "support/test.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/dual_quaternion/distance.hpp>
#include <duet/dual_quaternion/nearest.hpp>
#include <duet/dual_quaternion/pose_coordinates.hpp>

// Distances of poses and of screw motions; poses as seven coordinates (N20, N21).

namespace test_dual_quaternion_distance {

using duet::screw_parameters, duet_test::max_abs_difference, duet_test::poses, duet_test::vector;
using dual_quaternion = duet::dual_quaternion<double>;

TEST_CASE("distance: a metric, independent of the fixed frame") {
  const auto all = poses();
  const double characteristic_length = 0.5;
  for (std::size_t i = 0; i + 7 < all.size(); ++i) {
    const auto& a = all[i];
    const auto& b = all[i + 4];
    const auto& c = all[i + 7];
    const double ab = distance(a, b, characteristic_length);
    CHECK(distance(a, a, characteristic_length) < 1e-15);
    CHECK(distance(b, a, characteristic_length) == doctest::Approx(ab).epsilon(1e-13));
    CHECK(distance(a, -b, characteristic_length) == ab);
    CHECK(distance(c * a, c * b, characteristic_length) ==
          doctest::Approx(ab).epsilon(1e-12).scale(0.01));
    CHECK(distance(a, c, characteristic_length) <=
          ab + distance(b, c, characteristic_length) + 1e-14);
  }
  const auto a = duet::pose(duet::from_axis_angle(vector(0, 0, 1), 0.3), vector(1, 2, 3));
  const auto b = duet::pose(duet::from_axis_angle(vector(0, 0, 1), 1.1), vector(1, 2, 4));
  CHECK(distance(a, b, 10.0) == doctest::Approx(std::sqrt(1 + 64)).epsilon(1e-15));
  CHECK(distance(a, b, 0.0) == doctest::Approx(1).epsilon(1e-15));
  DUET_CHECK_REFUSED("duet: distance: characteristic_length is -1 (expected a finite number >= 0)",
                     distance(a, b, -1));
}

TEST_CASE("distance and nearest_on_screw: correct if squares overflow or underflow") {
  const auto at = [](double x) {
    return duet::pose(duet::quaternion<double>(1.0), vector(x, 0, 0));
  };
  for (const double size : {1e-320, 1e-200, 1e-160, 1e160, 1e300}) {
    CAPTURE(size);
    CHECK(distance(at(0), at(size), 1e-300) == doctest::Approx(size).epsilon(1e-15));
    const auto result = duet::derivative<duet_test::shared_tag>(
        [&](const auto& x) {
          using S = std::decay_t<decltype(x)>;
          return distance(
              duet::dual_quaternion<S>(at(0)),
              duet::pose(duet::quaternion<S>(S(1.0)), duet::vector3<S>(x, S(0.0), S(0.0))), 0);
        },
        size);
    CHECK(result.derivative == doctest::Approx(1).epsilon(1e-15));
  }
  for (const double size : {1e-200, 1e200}) {
    CAPTURE(size);
    auto motion = screw_parameters(at(1));
    motion.translation = size;
    CHECK(nearest_on_screw(at(0), motion, at(0.3 * size), size).tau ==
          doctest::Approx(0.3).epsilon(1e-14));
  }
}

TEST_CASE("nearest_on_screw: over several full turns no sampled pose is nearer") {
  const auto start = duet::pose(duet::from_rotation_vector(vector(0.2, -1, 0.4)), vector(1, 0, 2));
  const double full_turn = 6.283185307179586;
  for (const double revolutions : {-2.5, 0.5, 1.0, 1.5, 2.0, 3.25, 5.0, 1e6}) {
    for (const double pitch : {0.3, -0.01, 1e-6}) {
      const duet::screw_motion<double> motion = {vector(0, 0.6, 0.8), vector(0.5, 0, 0),
                                                 revolutions * full_turn, revolutions * pitch,
                                                 duet::screw_kind::screw};
      const auto at = [&](double tau) {
        return start * duet::from_screw(motion.axis, motion.moment, motion.angle * tau,
                                        motion.translation * tau);
      };
      for (const double tau : {0.0, 0.01, 0.25, 0.37, 0.5, 0.732, 0.99, 1.0}) {
        CAPTURE(revolutions);
        CAPTURE(pitch);
        CAPTURE(tau);
        for (const double characteristic_length : {0.0, 0.3, 3.0}) {
          const auto result = nearest_on_screw(start, motion, at(tau), characteristic_length);
          CHECK_LT(std::abs(result.tau - tau), revolutions == 1e6 ? 1e-7 : 1e-9);
          CHECK_LT(result.squared_distance, revolutions == 1e6 ? 1e-15 : 1e-24);
        }
        if (revolutions == 1e6) {
          continue;
        }
        // For poses far from the motion, rotated by nearly a half turn, two minima lie next to a
        // kink.
        for (const double angle : {1.0, 3.14}) {
          const auto p = at(tau) * duet::pose(duet::from_rotation_vector(vector(0, -angle, 0)),
                                              vector(0.3, 0.2, 0));
          const double minimum = nearest_on_screw(start, motion, p, 0.2).squared_distance;
          double min_sampled = 1e300;
          for (int i = 0; i <= 500; ++i) {
            min_sampled = std::min(min_sampled, squared_distance(at(i / 500.), p, 0.2));
          }
          CHECK_LE(minimum, min_sampled + 1e-15);
        }
      }
    }
  }
}

TEST_CASE("nearest_on_screw: finds a minimum next to the kink at a rotation angle of a half turn") {
  duet_test::random_source random(5);
  for (int k = 0; k < 960; ++k) {
    const auto n = random.direction<3>();
    const vector axis(n[0], n[1], n[2]);
    const vector point(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const double revolutions = random.uniform(.2, 3), pitch = random.uniform(-.3, .3);
    const duet::screw_motion<double> motion = {axis, point.cross(axis),
                                               revolutions * 6.283185307179586, revolutions * pitch,
                                               duet::screw_kind::screw};
    const auto d = random.direction<3>();
    const double angle =
        random.integer(0, 1) == 1 ? 3.14159 - random.log_uniform(1e-6, 1) : random.uniform(0, 3.14);
    const double tau = random.uniform(0, 1);
    const vector moved(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const double characteristic_length = random.log_uniform(1e-3, 3);
    if (k != 169 && k != 959) {
      continue; // cases 169 and 959 have a global minimum next to a kink
    }
    const auto at = [&](double x) {
      return duet::from_screw(motion.axis, motion.moment, motion.angle * x, motion.translation * x);
    };
    const auto p =
        at(tau) *
        duet::pose(duet::from_rotation_vector(vector(angle * d[0], angle * d[1], angle * d[2])),
                   moved);
    const auto start = duet::pose(duet::quaternion<double>(1.0), vector(0, 0, 0));
    double min_sampled = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= 20000; ++i) {
      min_sampled =
          std::min(min_sampled, squared_distance(at(i / 20000.), p, characteristic_length));
    }
    CHECK_LE(nearest_on_screw(start, motion, p, characteristic_length).squared_distance,
             min_sampled + 1e-15);
  }
}

TEST_CASE("nearest_on_screw: beyond the motion an end is nearest") {
  const auto start = duet::pose(duet::quaternion<double>(1.0), vector(0, 0, 0));
  const auto goal = duet::pose(duet::quaternion<double>(1.0), vector(2, 0, 0));
  const auto motion = screw_parameters(conj(start) * goal);
  const auto at = [&](double x) {
    return nearest_on_screw(start, motion,
                            duet::pose(duet::quaternion<double>(1.0), vector(x, 1, 0)), 1.0)
        .tau;
  };
  CHECK(at(-1) == 0);
  CHECK(at(0.5) == doctest::Approx(0.25).epsilon(1e-14));
  CHECK(at(3) == 1);
  // Rotation about the origin: without a weight of angles all poses of the motion are equally far.
  const duet::screw_motion<double> pure_rotation = {vector(0, 0, 1), vector(0, 0, 0), 1, 0,
                                                    duet::screw_kind::rotation};
  const auto raised = duet::pose(duet::quaternion<double>(1.0), vector(0, 0, 2));
  const auto any = nearest_on_screw(start, pure_rotation, raised, 0.0);
  CHECK(any.squared_distance == 4);
  CHECK((any.tau >= 0 && any.tau <= 1));
  // Beyond a half turn the distance is not convex: an end may still be nearest.
  const auto rotated_back =
      duet::pose(duet::from_axis_angle(vector(0, 0, 1), -2.0), vector(0, 0, 0));
  CHECK(nearest_on_screw(start, pure_rotation, rotated_back, 1.0).tau == 0);
}

TEST_CASE("nearest_on_screw: the derivative of tau agrees with differences") {
  const auto start = duet::pose(duet::from_rotation_vector(vector(0.2, -1, 0.4)), vector(1, 0, 2));
  const auto goal = duet::pose(duet::from_rotation_vector(vector(1.2, 0.3, 0)), vector(0, 1, 4));
  const auto motion = screw_parameters(conj(start) * goal);
  const auto tau = [&](const auto& t) {
    using T = std::decay_t<decltype(t)>;
    const duet::screw_motion<T> m = {motion.axis.cast<T>(), motion.moment.cast<T>(),
                                     T(motion.angle), T(motion.translation), motion.kind};
    const auto p =
        duet::pose(duet::quaternion<T>(duet::rotation(goal)), duet::vector3<T>(t, t * t, T(3)));
    return nearest_on_screw(duet::dual_quaternion<T>(start), m, p, 0.7).tau;
  };
  const double h = 1e-3;
  const auto difference = [&](double step) {
    return (tau(0.4 + step) - tau(0.4 - step)) / (2 * step);
  };
  CHECK(duet::derivative<duet_test::shared_tag>(tau, 0.4).derivative ==
        doctest::Approx((4 * difference(h) - difference(2 * h)) / 3).epsilon(1e-8));
}

TEST_CASE("N21: J2 maps the rate of [t; α] to the spatial twist, and back") {
  for (const auto& a : poses()) {
    duet::vector6<double> v;
    v << 0.3, -1, 0.4, 0.7, 0.2, -0.5;
    const auto gamma = duet::pose_coordinates(a);
    CHECK(max_abs_difference(duet::from_pose_coordinates(gamma), a) < 2e-15);
    const auto rate = duet::pose_coordinates_rate(a, v);
    CHECK(max_abs_difference(duet::pose_rate_matrix(a) * rate, v) < 1e-14);
    // The rate by AD along exp(½Vt) A, V in spatial axes.
    const auto by_ad = duet::derivative<duet_test::shared_tag>(
        [&](auto t) {
          using S = decltype(t);
          const duet::dual_vector<S> half = duet::dual_vector_of<S>(v.cast<S>() * S(t / 2));
          return duet::pose_coordinates(duet::exp(half) * duet::dual_quaternion<S>(a));
        },
        0.0);
    CHECK(max_abs_difference(by_ad.derivative, rate) < 1e-14);
  }
}

} // namespace test_dual_quaternion_distance
