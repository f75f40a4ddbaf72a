// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "accuracy/curve_motion.hpp"
#include "accuracy/inputs.hpp"
#include "accuracy/oracles_of_curves.hpp"
#include "accuracy/probe.hpp"

#include <duet/spline/fit.hpp>

// Fitted curves: distance of their motion from that of the curve with the smallest sum of squares.

namespace duet_test::accuracy {
namespace {

/// A rotation by the angle `size`; for poses also a translation by `length`.
template <class T>
duet::quaternion<T> random_displacement(double size, double length, random_source& random) {
  const auto about = random.direction<3>();
  const auto along = random.direction<3>();
  duet::vector3<T> half;
  for (std::size_t i = 0; i < 3; ++i) {
    if constexpr (is_pose<T>) {
      half[int(i)] = T(about[i] * size / 2, along[i] * length / 2);
    } else {
      half[int(i)] = about[i] * size / 2;
    }
  }
  return duet::exp(half);
}

template <class T>
row fit_row(const std::string& name, int count) {
  using spline = duet::cumulative_bspline<T>;
  const named noises[] = {{"noise 0.01", 0.01}, {"noise 0.1", 0.1}, {"noise 1e-6", 1e-6}};
  const double lengths[] = {1, 1000};
  row result{name};
  random_source random(101);
  for (int n = 0; n < count; ++n) {
    const named noise = noises[n % 3];
    const double length = lengths[n % 2];
    const std::vector<double> knots = duet::clamped_knots(std::vector<double>{0, 1, 2, 3}, 4);
    std::vector<duet::quaternion<T>> controls{random_displacement<T>(1, length, random)};
    while (controls.size() < 6) {
      controls.push_back(controls.back() * random_displacement<T>(0.5, 0.5 * length, random));
    }
    const spline reference(typename spline::basis_type(knots), controls);
    std::vector<double> u;
    std::vector<duet::quaternion<T>> rows;
    input at{noise.name, {}, {}, {}};
    for (int i = 0; i < 12; ++i) {
      u.push_back(i == 0 ? 0 : i == 11 ? 3 : (i + random.uniform(-0.3, 0.3)) * 3 / 11);
      rows.push_back(normalized(reference(u.back()) *
                                random_displacement<T>(noise.value, noise.value * length, random)));
      append(at, rows.back());
    }
    const spline s = duet::fit<spline>(u, rows, knots, {.characteristic_length = length}).curve;
    at.direction.assign(at.x.size(), 0);
    const numbers parameters{0, random.uniform(0, 1), random.uniform(1, 3)};
    for (const double each : parameters) {
      at.x.push_back(each);
      at.parts.push_back(1);
      at.direction.push_back(1);
    }
    numbers start;
    for (const auto& q : s.control_points()) {
      append_components(start, q);
    }
    const auto what = is_pose<T> ? oracle::over::poses : oracle::over::rotations;
    try {
      judge(result, at, {}, oracle::least_squares_fit(what, knots, u, length, start),
            measured_motion(s, parameters));
    } catch (const std::runtime_error& unsolved) {
      throw std::runtime_error(name + ", " + at.where + ": " + unsolved.what());
    }
  }
  return result;
}

} // namespace

rows fit_rows(extent e) {
  static const jet_shape shape = jet_shape::curve();
  jet_shape::current = &shape;
  const int count = e == extent::test ? 1 : 3;
  return {fit_row<double>("fit to rotations", count), fit_row<pose_scalar>("fit to poses", count)};
}

} // namespace duet_test::accuracy
