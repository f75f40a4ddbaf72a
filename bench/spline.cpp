// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// A uniform cubic spline of 100 segments at random parameters: value, and value with angular
/// velocity and acceleration. By hand: one kernel for this one curve, in plain doubles. Beside
/// them, the same rates by Taylor numbers, and the fitting of 104 orientations.

#include "spline_workload.hpp"
#include "support/contest.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/spline/interpolate.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <string_view>
#include <vector>

namespace duet_bench {
namespace {

/// Parameters in random order, one after the other.
class random_parameters {
public:
  random_parameters() {
    std::mt19937_64 engine(1);
    for (double& u : values_) {
      u = double(engine() >> 11) * 0x1p-53 * segments * knot_distance;
    }
  }
  double next() { return values_[next_++ % values_.size()]; }

private:
  std::array<double, 1024> values_;
  std::size_t next_ = 0;
};

template <class F>
void add(std::string_view workload, std::string_view contender, F evaluate) {
  contest(workload, contender, random_parameters(),
          [=](random_parameters& u) { return evaluate(u.next()); });
}

template <class Expected, class Actual>
void compare(std::string_view workload, std::string_view contender, Expected expected,
             Actual actual) {
  random_parameters u;
  for (int i = 0; i < 1000; ++i) {
    const double at = u.next();
    expect_agreement(workload, contender, expected(at), actual(at));
  }
}

const auto spline = make_spline();
const hand_written_spline by_hand(controls());

std::array<double, 4> duet_value(double u) {
  const auto q = spline(u);
  return {q.w(), q.x(), q.y(), q.z()};
}

numbers duet_motion(double u) {
  const auto m = spline.motion(u, duet::frame::body);
  return {m.value.w(),   m.value.x(),   m.value.y(),       m.value.z(),       m.velocity[0],
          m.velocity[1], m.velocity[2], m.acceleration[0], m.acceleration[1], m.acceleration[2]};
}

/// The same from Q, Q′, Q″: ω = 2 Q* Q′, ω′ = vec(2 Q* Q″).
numbers taylor_motion(double u) {
  const auto q = duet::derivatives<2>([](const auto& x) { return spline(x); }, u);
  const auto w = conj(q[0]) * q[1], a = conj(q[0]) * q[2];
  return {q[0].w(),  q[0].x(),  q[0].y(),  q[0].z(),  2 * w.x(),
          2 * w.y(), 2 * w.z(), 2 * a.x(), 2 * a.y(), 2 * a.z()};
}

const bool registered = [] {
  const auto hand_value = [](double u) { return by_hand.value(u); };
  compare("spline", "duet", hand_value, duet_value);
  add("spline", "duet", duet_value);
  add("spline", "hand", hand_value);

  const auto hand_motion = [](double u) { return by_hand.motion(u); };
  compare("spline_motion", "duet", hand_motion, duet_motion);
  compare("spline_motion", "taylor", hand_motion, taylor_motion);
  add("spline_motion", "duet", duet_motion);
  add("spline_motion", "hand", hand_motion);
  add("spline_motion", "taylor", taylor_motion);

  std::vector<double> parameters;
  std::vector<duet::quaternion<double>> orientations;
  for (int i = 0; i < 104; ++i) {
    parameters.push_back(i * knot_distance);
    orientations.push_back(orientation(i * knot_distance));
  }
  contest("interpolation", "duet", 0, [=](int) {
    return duet::interpolate<duet::cumulative_bspline<double>>(parameters, orientations,
                                                               duet::natural{});
  });
  return true;
}();

} // namespace
} // namespace duet_bench
