// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"
#include "support/multiprecision.hpp"

#include <duet/duet.hpp>

// Infinitesimal parts through the solve: poses are compared with 50 digits.

namespace test_spline_rotation_vector_poses {

using duet::interpolate;
using duet_test::real_50;

template <class R>
using pose_t = duet::dual_quaternion<R>;
template <class R>
using screw = duet::screw_dual<R>;

namespace {

const std::vector<double> knots{0, 0.3, 0.5, 1.1, 1.3, 1.9, 2, 2.4};

template <class R>
std::vector<pose_t<R>> poses() {
  duet_test::random_source random(5);
  std::vector<pose_t<R>> result;
  for (const auto& q : duet_test::random_orientations(knots.size(), 1.4, 6)) {
    const auto t = random.direction<3>();
    const duet::quaternion<R> exact(R(q.w()), R(q.x()), R(q.y()), R(q.z()));
    result.push_back(
        duet::pose(normalized(exact), duet::vector3<R>(R(3 * t[0]), R(3 * t[1]), R(3 * t[2]))));
  }
  return result;
}

template <class R>
double difference(const pose_t<R>& a, const pose_t<real_50>& b) {
  double worst = 0;
  const auto take = [&](const screw<R>& x, const screw<real_50>& y) {
    worst = std::max(worst, std::abs(double(x.value() - y.value())));
    worst = std::max(worst, std::abs(double(x.epsilon() - y.epsilon())));
  };
  take(a.w(), b.w());
  take(a.x(), b.x());
  take(a.y(), b.y());
  take(a.z(), b.z());
  return worst;
}

template <class R>
duet::vector6<R> twist(double size) {
  duet::vector6<R> v;
  for (int i = 0; i < 6; ++i) {
    v[i] = R(size) * R(i % 2 == 0 ? 1 : -1) / R(i + 2);
  }
  return v;
}

/// Poses at six parameters, for three kinds of end conditions one after the other.
template <class R>
std::vector<pose_t<R>> curves_through_poses() {
  std::vector<pose_t<R>> result;
  using spline = duet::rotation_vector_spline<screw<R>>;
  const std::vector<R> u(knots.begin(), knots.end());
  const auto add = [&](const auto& ends) {
    const spline s = interpolate<spline>(u, poses<R>(), ends);
    for (const double at : {0.0, 0.1, 0.4, 1.2, 1.25, 2.4}) {
      result.push_back(s(R(at)));
    }
  };
  add(duet::clamped{twist<R>(1), twist<R>(-2)});
  add(duet::end_acceleration{twist<R>(3), twist<R>(1)});
  add(duet::not_a_knot{});
  return result;
}

} // namespace

TEST_CASE("interpolate, rotation vectors over poses: values agree with 50 digits") {
  const auto computed = curves_through_poses<double>();
  const auto exact = curves_through_poses<real_50>();
  CHECK(computed.size() == 18);
  for (std::size_t i = 0; i < computed.size(); ++i) {
    CAPTURE(i);
    CHECK(difference(computed[i], exact[i]) < 1e-13);
  }
}

TEST_CASE("interpolate, quintic over poses: passes through the data with the given end twists, "
          "smooth inside") {
  using spline = duet::rotation_vector_spline<screw<double>, 6>;
  const auto data = poses<double>();
  const duet::clamped velocity{twist<double>(1), twist<double>(-2)};
  const duet::end_acceleration acceleration{twist<double>(3), twist<double>(1)};
  const spline s = interpolate<spline>(knots, data, duet::fully_clamped{velocity, acceleration});
  for (std::size_t i = 0; i < data.size(); ++i) {
    const auto at = s(knots[i]);
    const double sign = innermost(dot(at, data[i])) < 0 ? -1 : 1;
    CHECK(norm(real_part(at) * sign - real_part(data[i])) < 1e-14);
    CHECK((translation(at) - translation(data[i])).norm() < 1e-13);
    if (i > 0 && i + 1 < data.size()) {
      const auto after = s.motion(knots[i], duet::frame::body);
      const auto before = s.motion(std::nextafter(knots[i], -1.0), duet::frame::body);
      CHECK((after.velocity - before.velocity).norm() < 1e-10);
      CHECK((after.acceleration - before.acceleration).norm() < 1e-9);
      CHECK((after.jerk - before.jerk).norm() < 1e-8);
    }
  }
  const auto start = s.motion(0.0, duet::frame::spatial);
  const auto end = s.motion(2.4, duet::frame::spatial);
  CHECK((start.velocity - velocity.start).norm() < 1e-11);
  CHECK((end.velocity - velocity.end).norm() < 1e-11);
  CHECK((start.acceleration - acceleration.start).norm() < 1e-10);
  CHECK((end.acceleration - acceleration.end).norm() < 1e-10);
}

TEST_CASE(
    "interpolate, quintic over poses: given end velocities are reproduced far from the origin") {
  duet_test::random_source random(1);
  const duet::vector6<double> none = duet::vector6<double>::Zero();
  double sum = 0;
  constexpr int tables = 40;
  for (int n = 0; n < tables; ++n) {
    const auto about = random.direction<3>();
    const auto along = random.direction<3>();
    std::vector<pose_t<double>> samples;
    for (int i = 0; i < 4; ++i) {
      const duet::vector3<double> half(0.003 * i * about[0], 0.003 * i * about[1],
                                       0.001 * i * i * about[2]);
      samples.push_back(
          duet::pose(duet::exp(half), duet::vector3<double>(1e4 * along[0] + 30 * i, 1e4 * along[1],
                                                            1e4 * along[2] - 7 * i * i)));
    }
    const auto direction = random.direction<6>();
    duet::vector6<double> velocity;
    for (int i = 0; i < 6; ++i) {
      velocity[i] = direction[std::size_t(i)] * (i < 3 ? 60 : 0.006);
    }
    const auto s = interpolate<duet::rotation_vector_spline<screw<double>, 6>>(
        {0, 1, 2, 3}, samples,
        duet::fully_clamped{duet::clamped{velocity, none}, duet::end_acceleration{none, none}});
    const auto start = s.motion(0.0, duet::frame::spatial);
    const duet::vector6<double> error = start.velocity - velocity;
    sum += error.head<3>().squaredNorm() / velocity.head<3>().squaredNorm();
  }
  CHECK(std::sqrt(sum / tables) < 16 * std::ldexp(1.0, -53)); // 27 with one solve only
}

} // namespace test_spline_rotation_vector_poses
