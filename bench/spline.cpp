// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// A uniform cubic spline of 100 segments at random parameters: value, and value with angular
/// velocity and acceleration. By hand: one kernel for this one curve, in plain doubles. In
/// addition, the rates by Taylor numbers and the interpolation of 104 orientations.

#include "spline_workload.hpp"
#include "support/contest.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/expression/motion.hpp>
#include <duet/expression/symbol.hpp>
#include <duet/quaternion/euler.hpp>
#include <duet/spline/interpolate.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <vector>

namespace duet_bench {
namespace {

template <class F>
void add(std::string_view workload, std::string_view contender, F evaluate) {
  register_benchmark(workload, contender, random_parameters(),
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

/// Value and rates from Q, Q′, Q″: ω = 2 Q* Q′, ω′ = vec(2 Q* Q″).
numbers taylor_motion(double u) {
  const auto q = duet::derivatives<2>([](const auto& x) { return spline(x); }, u);
  const auto w = conj(q[0]) * q[1], a = conj(q[0]) * q[2];
  return {q[0].w(),  q[0].x(),  q[0].y(),  q[0].z(),  2 * w.x(),
          2 * w.y(), 2 * w.z(), 2 * a.x(), 2 * a.y(), 2 * a.z()};
}

/// Spline as a symbolic formula of one segment.
class formula_spline {
public:
  explicit formula_spline(const std::vector<duet::quaternion<double>>& controls) {
    duet::quaternion<double> previous = controls.front();
    for (duet::quaternion<double> control : controls) {
      if (dot(previous, control) < 0) {
        control = -control;
      }
      const duet::vector3<double> omega = log(conj(previous) * control).vec();
      const double half = omega.norm();
      const duet::vector3<double> axis = half > 0 ? duet::vector3<double>(omega / half) : omega;
      nodes_.push_back({control, axis, 2 * half});
      previous = control;
    }
  }

  [[nodiscard]] numbers motion(double u) const {
    using namespace duet::expression;
    constexpr symbol<"x"> x;
    constexpr quaternion_symbol<"q"> q;
    constexpr vector_symbol<"n1"> n1;
    constexpr vector_symbol<"n2"> n2;
    constexpr vector_symbol<"n3"> n3;
    constexpr symbol<"a1"> a1;
    constexpr symbol<"a2"> a2;
    constexpr symbol<"a3"> a3;
    constexpr auto b1 = (c<5> + c<3> * x - c<3> * x * x + x * x * x) / c<6>;
    constexpr auto b2 = (c<1> + c<3> * x + c<3> * x * x - c<2> * x * x * x) / c<6>;
    constexpr auto b3 = x * x * x / c<6>;
    constexpr auto curve =
        q * rotation_about(n1, a1 * b1) * rotation_about(n2, a2 * b2) * rotation_about(n3, a3 * b3);

    constexpr double r = 1 / knot_distance;
    const auto segment = std::size_t(u * r);
    const node* n = &nodes_[segment];
    const auto [value, w, a] = duet::expression::motion(curve, x, duet::frame::body)(
        x = u * r - double(segment), q = n[0].q, n1 = n[1].axis, n2 = n[2].axis, n3 = n[3].axis,
        a1 = n[1].angle, a2 = n[2].angle, a3 = n[3].angle);
    return {value.w(), value.x(), value.y(),    value.z(),    r * w[0],
            r * w[1],  r * w[2],  r * r * a[0], r * r * a[1], r * r * a[2]};
  }

private:
  struct node {
    duet::quaternion<double> q;
    duet::vector3<double> axis;
    double angle; ///< full rotation angle
  };
  std::vector<node> nodes_;
};

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
  static const formula_spline by_formula(controls());
  const auto formula_motion = [](double u) { return by_formula.motion(u); };
  compare("spline_motion", "formula", hand_motion, formula_motion);
  add("spline_motion", "formula", formula_motion);
  add("spline_motion", "taylor", taylor_motion);

  std::vector<double> parameters;
  std::vector<duet::quaternion<double>> orientations;
  for (int i = 0; i < 104; ++i) {
    parameters.push_back(i * knot_distance);
    orientations.push_back(orientation(i * knot_distance));
  }
  register_benchmark("interpolation", "duet", 0, [=](int) {
    return duet::interpolate<duet::cumulative_bspline<double>>(parameters, orientations,
                                                               duet::natural{});
  });
  return true;
}();

} // namespace
} // namespace duet_bench
