// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>

namespace test_spline_hermite {
namespace {

using duet::vector3;
using duet::vector6;
using rotation = duet::quaternion<double>;
using pose_type = duet::dual_quaternion<double>;

const auto moving = [](const auto& u) {
  using std::cos;
  using std::sin;
  using S = std::decay_t<decltype(u)>;
  const vector3<S> angles(S(0.8 * sin(1.3 * u)), S(0.5 * u), S(0.6 * cos(0.7 * u)));
  return duet::pose(duet::from_rotation_vector(angles), vector3<S>(S(sin(u)), S(u), S(cos(2 * u))));
};

template <class Frame>
struct samples {
  std::vector<double> u;
  std::vector<pose_type> poses;
  std::vector<vector6<double>> twists;

  samples(int count, Frame frame) {
    for (int i = 0; i <= count; ++i) {
      u.push_back(4.0 * i / count + 0.1 * std::sin(8.0 * i / count)); // uneven
      const auto [a, a_dot] = duet::derivative(moving, u.back());
      poses.push_back(a);
      twists.push_back(duet::twist(a, a_dot, frame));
    }
  }
};

double largest_error(int count) {
  const samples r(count, duet::frame::body);
  const auto s = duet::hermite_spline(r.u, r.poses, r.twists, duet::frame::body);
  double largest = 0;
  for (int i = 0; i <= 1000; ++i) {
    const double u = r.u.back() * i / 1000;
    largest = std::max(largest, duet::distance(pose_type(s(u)), pose_type(moving(u)), 1.0));
  }
  return largest;
}

template <class Frame>
void check_samples(Frame frame) {
  const samples r(12, frame);
  auto flipped = r.poses;
  flipped[3] = -flipped[3];
  const auto s = duet::hermite_spline(r.u, flipped, r.twists, frame);
  for (std::size_t i = 0; i < r.u.size(); ++i) {
    for (const double side : {-1e-13, 0.0, 1e-13}) {
      const double u = std::clamp(r.u[i] + side, r.u.front(), r.u.back());
      const auto m = s.motion(u, frame);
      CHECK(duet::distance(m.value, r.poses[i], 1.0) <= 1e-12);
      CHECK((m.velocity - r.twists[i]).norm() <= 1e-11);
    }
  }
}

TEST_CASE("hermite_spline: the curve passes through its samples with the given velocities") {
  check_samples(duet::frame::body);
  check_samples(duet::frame::spatial);
}

TEST_CASE("hermite_spline: the error decreases with the fourth power of the step") {
  const double order = std::log2(largest_error(32) / largest_error(64));
  CHECK(order > 3.8);
  CHECK(order < 4.2);
}

TEST_CASE("hermite_spline: curves of rotations are the rotations of curves of poses") {
  const samples r(10, duet::frame::spatial);
  std::vector<rotation> rotations;
  std::vector<vector3<double>> omegas;
  for (std::size_t i = 0; i < r.u.size(); ++i) {
    rotations.push_back(duet::rotation(r.poses[i]));
    omegas.push_back(r.twists[i].tail<3>());
  }
  const auto s = duet::hermite_spline(r.u, rotations, omegas, duet::frame::spatial);
  const auto of_poses = duet::hermite_spline(r.u, r.poses, r.twists, duet::frame::spatial);
  for (const double u : {0.1, 1.23, 3.9}) {
    CHECK(norm(s(u) - duet::rotation(of_poses(u))) <= 1e-15);
  }
}

TEST_CASE("hermite_spline: errors name invalid samples") {
  samples r(5, duet::frame::body);
  const auto message = [&](const std::vector<vector6<double>>& twists) {
    return duet_test::message_of(
        [&] { (void)duet::hermite_spline(r.u, r.poses, twists, duet::frame::body); });
  };
  auto twists = r.twists;
  twists[2][4] = std::numeric_limits<double>::quiet_NaN();
  CHECK(message(twists) == "duet: sample 2: the velocity is not finite");
  twists.pop_back();
  CHECK(message(twists) == "duet: hermite_spline: 6 samples, but 5 velocities");
  r.u.pop_back();
  CHECK(message(r.twists) == "duet: hermite_spline: 5 parameters, but 6 samples");
  r.u.push_back(9);
  r.u[3] = r.u[2];
  CHECK(message(r.twists).starts_with("duet: sample 3: parameter "));
}

} // namespace
} // namespace test_spline_hermite
