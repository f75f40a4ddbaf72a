// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "accuracy/curve_motion.hpp"
#include "accuracy/inputs.hpp"
#include "accuracy/oracles_of_curves.hpp"
#include "accuracy/probe.hpp"

#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/rotation_vector_spline.hpp>

// Curves with known coefficients, a control element and increments or a polynomial segment: values,
// derivatives, and velocity, acceleration and jerk in all frames.

namespace duet_test::accuracy {
namespace {

constexpr double increment_sizes[] = {0.5, 1e-8, 3, 0.003, 1e-200, 1.5, 0};
constexpr double translations[] = {1, 1e8, 0, 1e-8, 30};

/// Knots around one span.
struct hard_knots {
  const char* name;
  std::vector<double> values;
};
hard_knots some_knots(int n, std::size_t order, random_source& random) {
  const char* const names[] = {"even knots",   "uneven knots", "Bézier's knots",
                               "knots at 1e6", "a short span", "knots in pairs"};
  const int kind = n % int(std::size(names));
  hard_knots knots{names[kind], {}};
  double u = kind == 3 ? 1e6 : -0.5;
  for (std::size_t i = 0; i < 2 * order; ++i) {
    knots.values.push_back(u);
    const bool is_span = i + 1 == order;
    u += kind == 0   ? 1
         : kind == 1 ? random.log_uniform(1e-3, 1e3)
         : kind == 2 ? (is_span ? 0.7 : 0)
         : kind == 3 ? 1e-3
         : kind == 4 ? (is_span ? 1e-6 : 1)
                     : (is_span || (i + order) % 2 == 1 ? 0.4 : 0);
  }
  return knots;
}
double somewhere(int n, double first, double last, random_source& random) {
  switch (n % 4) {
  case 1:
    return first;
  case 2:
    return std::nextafter(last, first);
  case 3:
    return first + (last - first) / 2;
  default:
    return first + (last - first) * random.uniform(0, 0.999);
  }
}

/// A half-angle vector; for poses also half a translation.
template <class T>
duet::vector3<T> some_increment(double size, double length, random_source& random) {
  const auto v = random.direction<3>();
  const auto t = random.direction<3>();
  duet::vector3<T> result;
  for (int i = 0; i < 3; ++i) {
    const double angular = v[std::size_t(i)] * size / 2;
    if constexpr (is_pose<T>) {
      result[i] = T(angular, t[std::size_t(i)] * length / 2);
    } else {
      static_cast<void>(length);
      result[i] = angular;
    }
  }
  return result;
}
template <class T>
duet::quaternion<T> some_element(int n, random_source& random) {
  const input at = hard_pose(n, random);
  duet::quaternion<T> q;
  if constexpr (is_pose<T>) {
    q = {T(at.x[0], at.x[4]), T(at.x[1], at.x[5]), T(at.x[2], at.x[6]), T(at.x[3], at.x[7])};
  } else {
    q = {at.x[0], at.x[1], at.x[2], at.x[3]};
  }
  return normalized(q);
}

/// One input: the parameter, the initial element of the curve, and vectors.
template <class T>
input input_of(std::string where, double u, const duet::quaternion<T>& first,
               const std::vector<duet::vector3<T>>& vectors) {
  input at{std::move(where), {u}, {}, {1}};
  append(at, first);
  for (const auto& v : vectors) {
    append(at, v);
  }
  at.direction.assign(at.x.size(), 0);
  at.direction[0] = 1;
  return at;
}

template <class T, int Order>
row cumulative_row(const std::string& name, int count) {
  row result{name};
  random_source random(101);
  const auto what = is_pose<T> ? oracle::over::poses : oracle::over::rotations;
  for (int n = 0; n < count; ++n) {
    const auto [knots_name, knots] = some_knots(n, Order, random);
    const double u = somewhere(n / 3, knots[Order - 1], knots[Order], random);
    const double size = increment_sizes[std::size_t(n) % std::size(increment_sizes)];
    const double length = translations[std::size_t(n) % std::size(translations)];
    std::vector<duet::quaternion<T>> controls{some_element<T>(n, random)};
    std::vector<duet::vector3<T>> increments{duet::vector3<T>::Constant(T(0.0))}; // ω_0
    while (controls.size() < std::size_t(Order)) {
      increments.push_back(some_increment<T>(size * random.uniform(0.2, 1), length, random));
      controls.push_back(controls.back() * duet::exp(increments.back()));
    }
    using spline = duet::cumulative_bspline<T, Order>;
    const spline s(typename spline::basis_type(knots), controls, increments);
    increments.erase(increments.begin());
    const input at = input_of(std::string(knots_name) + ", " + short_text(size) + " rad", u,
                              s.control_points()[0], increments);
    judge(result, at, {}, oracle::cumulative_motion(knots, what), measured_motion(s, {u}));
  }
  return result;
}

template <class T, int Order>
row piece_row(const std::string& name, int count) {
  row result{name};
  random_source random(101);
  const auto what = is_pose<T> ? oracle::over::poses : oracle::over::rotations;
  const double starts[] = {0, 1e6, -3};
  const double lengths[] = {1, 1e-3, 1e3, 1e-6};
  for (int n = 0; n < count; ++n) {
    const double from = starts[std::size_t(n) % 3], h = lengths[std::size_t(n) % 4];
    const std::vector<double> knots{from, from + h};
    const double u = somewhere(n / 3, knots[0], knots[1], random);
    const double size = increment_sizes[std::size_t(n) % std::size(increment_sizes)];
    const double length = translations[std::size_t(n) % std::size(translations)];
    std::array<duet::vector3<T>, std::size_t(Order)> x;
    x[0] = duet::vector3<T>::Constant(T(0.0));
    std::vector<duet::vector3<T>> coefficients;
    auto sum = x[0];
    for (std::size_t m = 1; m < std::size_t(Order); ++m) {
      const double scale = std::pow(h, double(m));
      const auto part = some_increment<T>(size * random.uniform(0.2, 1), length, random);
      for (int i = 0; i < 3; ++i) {
        x[m][i] = part[i] / scale;
        sum[i] += x[m][i] * std::pow(knots[1] - knots[0], double(m));
      }
      coefficients.push_back(x[m]);
    }
    const auto first = some_element<T>(n, random);
    const auto s = duet::rotation_vector_spline<T, Order>::from_pieces(
        knots, {first, first * duet::exp(sum)}, {x});
    const input at = input_of("length " + short_text(h) + ", " + short_text(size) + " rad", u,
                              s.elements()[0], coefficients);
    judge(result, at, {}, oracle::piece_motion(from, what), measured_motion(s, {u}));
  }
  return result;
}

} // namespace

rows curve_rows(extent e) {
  const int count = e == extent::test ? 2 : 48;
  static const jet_shape shape = jet_shape::curve();
  jet_shape::current = &shape;
  return {cumulative_row<double, 2>("cumulative B-spline, degree 1", count),
          cumulative_row<double, 3>("cumulative B-spline, degree 2", count),
          cumulative_row<double, 4>("cumulative B-spline, degree 3", count),
          cumulative_row<double, 5>("cumulative B-spline, degree 4", count),
          cumulative_row<double, 6>("cumulative B-spline, degree 5", count),
          cumulative_row<pose_scalar, 4>("cumulative B-spline of poses, degree 3", count),
          cumulative_row<pose_scalar, 6>("cumulative B-spline of poses, degree 5", count),
          piece_row<double, 4>("rotation-vector spline, degree 3", count),
          piece_row<double, 6>("rotation-vector spline, degree 5", count),
          piece_row<pose_scalar, 4>("rotation-vector spline of poses, degree 3", count),
          piece_row<pose_scalar, 6>("rotation-vector spline of poses, degree 5", count)};
}

} // namespace duet_test::accuracy
