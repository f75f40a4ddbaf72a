// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "accuracy/curve_motion.hpp"
#include "accuracy/inputs.hpp"
#include "accuracy/oracles_of_curves.hpp"
#include "accuracy/probe.hpp"

#include <duet/spline/interpolate.hpp>

// Interpolating curves with all end conditions: distance of their motion from that of the curve of
// the definition. Only poses are tested: rotations are their real parts, by the same equations.

namespace duet_test::accuracy {
namespace {

using pose_type = duet::quaternion<pose_scalar>;
using oracle::ends;

struct table {
  std::string where;
  std::vector<double> u;
  std::vector<pose_type> elements;
};

/// Poses with these steps between them; for periodic curves the last equals the first.
table some_table(int n, std::size_t rows, bool closes, random_source& random) {
  const named steps[] = {{"0.5 rad", 0.5}, {"0.003 rad", 0.003}, {"1 rad", 1}};
  const named ratios[] = {{"even", 1}, {"uneven by 1 : 10", 10}};
  const named lengths[] = {{"1", 1}, {"1e4", 1e4}, {"1e-4", 1e-4}};
  const named step = steps[n % 3], ratio = ratios[n / 3 % 2], length = lengths[(n + n / 3) % 3];
  table t{std::string(step.name) + ", " + ratio.name + ", translation " + length.name, {0}, {}};
  const input first = hard_pose(n, random);
  const auto steer = random.direction<3>();
  t.elements.push_back(duet::pose(
      duet::normalized(duet::quaternion<double>(first.x[0], first.x[1], first.x[2], first.x[3])),
      duet::vector3<double>(length.value * steer[0], length.value * steer[1],
                            length.value * steer[2])));
  while (t.u.size() < rows) {
    t.u.push_back(t.u.back() + std::pow(ratio.value, random.uniform(0, 1)));
    const auto about = random.direction<3>();
    const auto along = random.direction<3>();
    duet::vector3<pose_scalar> half;
    for (std::size_t i = 0; i < 3; ++i) {
      half[int(i)] = pose_scalar((about[i] + steer[i]) * step.value / 4,
                                 (along[i] + steer[i]) * length.value * step.value / 4);
    }
    t.elements.push_back(t.elements.back() * duet::exp(half));
  }
  if (closes) {
    t.elements.back() = t.elements.front();
  }
  return t;
}

/// Velocities at both ends, about as large as those of the table: twists [v; ω].
std::vector<duet::vector6<double>> some_rates(const table& t, int count, random_source& random) {
  std::vector<duet::vector6<double>> result;
  const double step_angle = norm(log(conj(rotation(t.elements[0])) * rotation(t.elements[1])));
  const double length = translation(t.elements[0]).norm();
  for (int i = 0; i < count; ++i) {
    const auto v = random.direction<3>();
    const auto w = random.direction<3>();
    duet::vector6<double> rate;
    for (int k = 0; k < 3; ++k) {
      rate[k] = v[std::size_t(k)] * length * step_angle;
      rate[k + 3] = w[std::size_t(k)] * step_angle;
    }
    result.push_back(rate);
  }
  return result;
}

/// Initial guess of the oracle.
template <class Curve>
std::vector<double> start_of(const Curve& s) {
  std::vector<double> result;
  if constexpr (requires { s.pieces(); }) {
    for (const auto& piece : s.pieces()) {
      for (std::size_t m = 1; m < piece.size(); ++m) {
        append_components(result, piece[m]);
      }
    }
  } else {
    for (const auto& q : s.control_points()) {
      append_components(result, q);
    }
  }
  return result;
}

template <class Curve>
constexpr int order_of = Curve::order;
template <>
constexpr int order_of<duet::cumulative_bspline<pose_scalar>> = 0;

/// \param make  makes the end conditions from velocities
template <class Curve, class Make>
row interpolation_row(const std::string& name, ends e, std::size_t rows, int rate_count, int count,
                      const Make& make) {
  row result{name};
  random_source random(101);
  for (int n = 0; n < count; ++n) {
    const table t = some_table(n, rows, e == ends::periodic, random);
    const auto rates = some_rates(t, rate_count, random);
    const Curve s = duet::interpolate<Curve>(t.u, t.elements, make(rates));
    input at{t.where, {}, {}, {}};
    for (const pose_type& q : t.elements) {
      append(at, q);
    }
    for (const auto& rate : rates) {
      for (const int i : {3, 4, 5, 0, 1, 2}) {
        at.x.push_back(rate[i]);
      }
      at.parts.insert(at.parts.end(), 2, 3);
    }
    at.direction.assign(at.x.size(), 0);
    const double first = t.u[0], last = t.u.back();
    numbers parameters{first, t.u[1], first + (last - first) * random.uniform(0, 1), last};
    if (e == ends::natural) { // the acceleration vanishes at the ends
      parameters = {t.u[1], parameters[2], t.u[1] / 2};
    }
    for (const double u : parameters) {
      at.x.push_back(u);
      at.parts.push_back(1);
      at.direction.push_back(1);
    }
    try {
      judge(result, at, {},
            oracle::interpolation(order_of<Curve>, e, oracle::over::poses, t.u, start_of(s)),
            measured_motion(s, parameters));
    } catch (const std::runtime_error& unsolved) {
      throw std::runtime_error(name + ", " + t.where + ": " + unsolved.what());
    }
  }
  return result;
}

template <class Curve>
row clamped_row(const std::string& curve, int count) {
  return interpolation_row<Curve>(curve + ", clamped", ends::clamped, Curve::order == 6 ? 4 : 3, 2,
                                  count, [](const auto& r) {
                                    return duet::clamped{r[0], r[1]};
                                  });
}

template <class Curve>
rows all_ends(const std::string& curve, int count) {
  constexpr bool is_quintic = Curve::order == 6;
  const std::size_t few = is_quintic ? 4 : 3;
  rows result = {interpolation_row<Curve>(curve + ", natural", ends::natural, few, 0, count,
                                          [](const auto&) { return duet::natural{}; }),
                 clamped_row<Curve>(curve, count),
                 interpolation_row<Curve>(curve + ", accelerated", ends::accelerated, few, 2, count,
                                          [](const auto& r) {
                                            return duet::end_acceleration{r[0], r[1]};
                                          }),
                 interpolation_row<Curve>(curve + ", not a knot", ends::not_a_knot,
                                          is_quintic ? 6 : 4, 0, count,
                                          [](const auto&) { return duet::not_a_knot{}; }),
                 interpolation_row<Curve>(curve + ", periodic", ends::periodic, 5, 0, count,
                                          [](const auto&) { return duet::periodic{}; })};
  if constexpr (is_quintic) {
    result.push_back(interpolation_row<Curve>(
        curve + ", fully clamped", ends::fully_clamped, few, 4, count, [](const auto& r) {
          return duet::fully_clamped{duet::clamped{r[0], r[1]}, duet::end_acceleration{r[2], r[3]}};
        }));
  }
  return result;
}

} // namespace

rows interpolation_rows(extent e) {
  static const jet_shape shape = jet_shape::curve();
  jet_shape::current = &shape;
  const int count = e == extent::test ? 1 : 12;
  rows result;
  for (const rows& each :
       {all_ends<duet::cumulative_bspline<pose_scalar>>("through poses, cumulative cubic", count),
        all_ends<duet::rotation_vector_spline<pose_scalar, 4>>(
            "through poses, rotation-vector cubic", count),
        all_ends<duet::rotation_vector_spline<pose_scalar, 6>>(
            "through poses, rotation-vector quintic", count)}) {
    result.insert(result.end(), each.begin(), each.end());
  }
  return result;
}

} // namespace duet_test::accuracy
