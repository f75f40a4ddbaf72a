// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Splines over poses and of rotation vectors (spline.cpp has the cumulative one over rotations),
/// and interpolation of 1000 samples with steps of 0.003 rad.

#include "support/contest.hpp"

#include <duet/dual_quaternion/pose.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/spline/interpolate.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <string_view>
#include <vector>

namespace duet_bench {
namespace {

using screw = duet::dual<double, 1, duet::screw_tag>;

constexpr int samples = 1000;
constexpr double step = 0.01; // of the parameter; the rotation angle is 0.3 of it

/// Rotation by 0.3 rad per unit about a moving axis.
duet::quaternion<double> orientation(double u) {
  return duet::from_rotation_vector(
      duet::vector3<double>(0.15 * std::sin(u), 0.15 * std::cos(u), 0.26 * u));
}
duet::dual_quaternion<double> to_dual_quaternion(double u) {
  return duet::pose(orientation(u), duet::vector3<double>(std::sin(u), u, std::cos(2 * u)));
}

std::vector<double> parameters() {
  std::vector<double> u;
  for (int i = 0; i < samples; ++i) {
    u.push_back(i * step);
  }
  return u;
}
template <class F>
auto through(const F& f) {
  std::vector<decltype(f(0.0))> result;
  for (const double u : parameters()) {
    result.push_back(f(u));
  }
  return result;
}

/// Parameters in random order, one after the other.
class parameter_sequence {
public:
  parameter_sequence() {
    std::mt19937_64 engine(2);
    for (double& u : values_) {
      u = double(engine() >> 11) * 0x1p-53 * (samples - 1) * step;
    }
  }
  double next() { return values_[next_++ % values_.size()]; }

private:
  std::array<double, 1024> values_;
  std::size_t next_ = 0;
};

template <class Spline>
void add(std::string_view value, std::string_view motion, std::string_view contender,
         const Spline& s) {
  register_benchmark(value, contender, parameter_sequence(),
                     [=](parameter_sequence& u) { return s(u.next()); });
  register_benchmark(motion, contender, parameter_sequence(),
                     [=](parameter_sequence& u) { return s.motion(u.next(), duet::frame::body); });
}

const bool registered = [] {
  using cumulative = duet::cumulative_bspline<double>;
  using cubic = duet::rotation_vector_spline<double>;
  using quintic = duet::rotation_vector_spline<double, 6>;
  const auto u = parameters();
  const auto rotations = through(orientation);
  const auto poses = through(to_dual_quaternion);
  const duet::not_a_knot ends;
  const auto of_rotations = duet::interpolate<cumulative>(u, rotations, ends);
  const auto of_vectors = duet::interpolate<cubic>(u, rotations, ends);

  add("pose_spline", "pose_spline_motion", "duet",
      duet::interpolate<duet::cumulative_bspline<screw>>(u, poses, ends));
  add("pose_spline", "pose_spline_motion", "rotations only", of_rotations);
  add("vector_spline", "vector_spline_motion", "duet", of_vectors);
  add("vector_spline", "vector_spline_motion", "cumulative", of_rotations);
  add("quintic", "quintic_motion", "duet", duet::interpolate<quintic>(u, rotations, ends));
  add("quintic", "quintic_motion", "cumulative", of_rotations);

  register_benchmark("fit_1000", "duet", 0,
                     [=](int) { return duet::interpolate<cubic>(u, rotations, ends); });
  register_benchmark("fit_1000", "cumulative", 0,
                     [=](int) { return duet::interpolate<cumulative>(u, rotations, ends); });
  register_benchmark("fit_1000", "quintic", 0,
                     [=](int) { return duet::interpolate<quintic>(u, rotations, ends); });
  return true;
}();

} // namespace
} // namespace duet_bench
