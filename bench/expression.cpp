// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Expressions compared with the same formulas by hand, at changing inputs: arms of seven and
/// twenty joints with their spatial Jacobians, and a gradient. "library" is the expression with the
/// sine and cosine of the C library, as used by hand.

#include "support/contest.hpp"
#include "workloads.hpp"

#include <duet/expression/gradient.hpp>
#include <duet/expression/jacobian.hpp>
#include <duet/expression/symbol.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <string_view>
#include <utility>

namespace duet_bench {
namespace {

using namespace duet::expression;

/// Arrays of random numbers.
template <std::size_t N>
class random_inputs {
public:
  random_inputs(double lower, double upper) {
    std::mt19937_64 engine(1);
    for (auto& x : values_) {
      for (double& component : x) {
        component = lower + double(engine() >> 11) * 0x1p-53 * (upper - lower);
      }
    }
  }
  const std::array<double, N>& next() { return values_[next_++ % values_.size()]; }

private:
  std::array<std::array<double, N>, 256> values_;
  std::size_t next_ = 0;
};

template <std::size_t N, class F>
void add(std::string_view workload, std::string_view contender, double lower, double upper,
         F evaluate) {
  register_benchmark(workload, contender, random_inputs<N>(lower, upper),
                     [=](random_inputs<N>& inputs) { return evaluate(inputs.next()); });
}

// The arms.

constexpr symbol<"t1"> t1;
constexpr symbol<"t2"> t2;
constexpr symbol<"t3"> t3;
constexpr symbol<"t4"> t4;
constexpr symbol<"t5"> t5;
constexpr symbol<"t6"> t6;
constexpr symbol<"t7"> t7;
constexpr symbol<"t8"> t8;
constexpr symbol<"t9"> t9;
constexpr symbol<"t10"> t10;
constexpr symbol<"t11"> t11;
constexpr symbol<"t12"> t12;
constexpr symbol<"t13"> t13;
constexpr symbol<"t14"> t14;
constexpr symbol<"t15"> t15;
constexpr symbol<"t16"> t16;
constexpr symbol<"t17"> t17;
constexpr symbol<"t18"> t18;
constexpr symbol<"t19"> t19;
constexpr symbol<"t20"> t20;

/// The arm of workloads.hpp.
auto panda() {
  return translation_along(axis::z, .333) * screw(axis::z, t1) * screw(axis::y, t2) *
         translation_along(axis::z, .316) * screw(axis::z, t3) * translation_along(axis::x, .0825) *
         screw(axis::y, -t4) * translation_along(axis::x, -.0825) *
         translation_along(axis::z, .384) * screw(axis::z, t5) * screw(axis::y, -t6) *
         translation_along(axis::x, .088) * screw(axis::z, -t7) * translation_along(axis::z, -.107);
}

template <class Jacobian>
auto call_panda(const Jacobian& jacobian, const std::array<double, 7>& x) {
  return jacobian(t1 = x[0], t2 = x[1], t3 = x[2], t4 = x[3], t5 = x[4], t6 = x[5], t7 = x[6]);
}

void add_arm() {
  using angles = std::array<double, 7>;
  const auto joints = wrt(t1, t2, t3, t4, t5, t6, t7);
  const auto formula = jacobian(panda(), joints, duet::frame::spatial);
  const auto library = jacobian(with_std_sincos(panda()), joints, duet::frame::spatial);
  const auto by_hand = [](const angles& x) {
    pose_jacobian jacobian;
    const pose<double> a = fk7_by_hand(x, jacobian);
    return std::pair(a, jacobian);
  };
  const angles at = {0.3, -0.7, 1.1, -1.9, 0.4, 1.6, -0.8};
  const auto t = duet::translation(call_panda(formula, at).value);
  expect_agreement("formula_arm", "duet", by_hand(at).first.position,
                   std::array<double, 3>{t[0], t[1], t[2]});
  add<7>("formula_arm", "duet", -2.8, 2.8, [=](const angles& x) { return call_panda(formula, x); });
  add<7>("formula_arm", "library", -2.8, 2.8,
         [=](const angles& x) { return call_panda(library, x); });
  add<7>("formula_arm", "hand", -2.8, 2.8, by_hand);
}

/// The arm of twenty joints: from the eighth on upside down, from the fifteenth on upright again.
auto twenty_joints() {
  return panda() * translation_along(axis::z, -.333) * screw(axis::z, -t8) * screw(axis::y, -t9) *
         translation_along(axis::z, -.316) * screw(axis::z, -t10) *
         translation_along(axis::x, .0825) * screw(axis::y, t11) *
         translation_along(axis::x, -.0825) * translation_along(axis::z, -.384) *
         screw(axis::z, -t12) * screw(axis::y, t13) * translation_along(axis::x, .088) *
         screw(axis::z, t14) * translation_along(axis::z, .107) * translation_along(axis::z, .333) *
         screw(axis::z, t15) * screw(axis::y, t16) * translation_along(axis::z, .316) *
         screw(axis::z, t17) * translation_along(axis::x, .0825) * screw(axis::y, -t18) *
         translation_along(axis::x, -.0825) * translation_along(axis::z, .384) *
         screw(axis::z, t19) * screw(axis::y, -t20);
}

template <class Jacobian>
auto call_twenty(const Jacobian& jacobian, const std::array<double, 20>& x) {
  return jacobian(t1 = x[0], t2 = x[1], t3 = x[2], t4 = x[3], t5 = x[4], t6 = x[5], t7 = x[6],
                  t8 = x[7], t9 = x[8], t10 = x[9], t11 = x[10], t12 = x[11], t13 = x[12],
                  t14 = x[13], t15 = x[14], t16 = x[15], t17 = x[16], t18 = x[17], t19 = x[18],
                  t20 = x[19]);
}

void add_long_arm() {
  using angles = std::array<double, 20>;
  const auto joints = wrt(t1, t2, t3, t4, t5, t6, t7, t8, t9, t10, t11, t12, t13, t14, t15, t16,
                          t17, t18, t19, t20);
  const auto formula = jacobian(twenty_joints(), joints, duet::frame::spatial);
  const auto library = jacobian(with_std_sincos(twenty_joints()), joints, duet::frame::spatial);
  const auto by_hand = [](const angles& x) {
    long_pose_jacobian<20> jacobian;
    const pose<double> a = long_arm_by_hand(x, jacobian);
    return std::pair(a, jacobian);
  };
  angles at;
  for (std::size_t i = 0; i < at.size(); ++i) {
    at[i] = std::sin(double(3 * i + 1));
  }
  const auto t = duet::translation(call_twenty(formula, at).value);
  expect_agreement("formula_arm_20", "duet", by_hand(at).first.position,
                   std::array<double, 3>{t[0], t[1], t[2]});
  add<20>("formula_arm_20", "duet", -2.8, 2.8,
          [=](const angles& x) { return call_twenty(formula, x); });
  add<20>("formula_arm_20", "library", -2.8, 2.8,
          [=](const angles& x) { return call_twenty(library, x); });
  add<20>("formula_arm_20", "hand", -2.8, 2.8, by_hand);
}

// A gradient of twenty operations in six variables.

constexpr symbol<"u0"> u0;
constexpr symbol<"u1"> u1;
constexpr symbol<"u2"> u2;
constexpr symbol<"u3"> u3;
constexpr symbol<"u4"> u4;
constexpr symbol<"u5"> u5;

using six = std::array<double, 6>;

auto twenty_operations() {
  return sin(u0 * u1) * exp(u2 - u3) + u4 * u4 / (1.0 + u5 * u5) +
         sqrt(1.0 + u0 * u0 * u3) * cos(u4 + u5) - log(2.0 + u1 * u1) * u2;
}

std::array<double, 7> gradient_by_hand(const six& u) {
  const double s = std::sin(u[0] * u[1]), c = std::cos(u[0] * u[1]);
  const double growth = std::exp(u[2] - u[3]);
  const double inverse = 1 / (1 + u[5] * u[5]), ratio = u[4] * u[4] * inverse;
  const double root = std::sqrt(1 + u[0] * u[0] * u[3]);
  const double sine = std::sin(u[4] + u[5]), cosine = std::cos(u[4] + u[5]);
  const double argument = 2 + u[1] * u[1], logarithm = std::log(argument);
  const double half = cosine / (2 * root);
  return {s * growth + ratio + root * cosine - logarithm * u[2],
          c * u[1] * growth + half * 2 * u[0] * u[3],
          c * u[0] * growth - 2 * u[1] / argument * u[2],
          s * growth - logarithm,
          -s * growth + half * u[0] * u[0],
          2 * u[4] * inverse - root * sine,
          -2 * ratio * u[5] * inverse - root * sine};
}

template <class Gradient>
std::array<double, 7> call_gradient(const Gradient& gradient, const six& u) {
  const auto [y, g] = gradient(u0 = u[0], u1 = u[1], u2 = u[2], u3 = u[3], u4 = u[4], u5 = u[5]);
  return {y, g[0], g[1], g[2], g[3], g[4], g[5]};
}

void add_gradient() {
  const auto variables = wrt(u0, u1, u2, u3, u4, u5);
  const auto formula = gradient(twenty_operations(), variables);
  const auto library = gradient(with_std_sincos(twenty_operations()), variables);
  const six at = {.1, .7, .3, .4, .5, .9};
  expect_agreement("formula_gradient", "duet", gradient_by_hand(at), call_gradient(formula, at));
  add<6>("formula_gradient", "duet", 0, 1, [=](const six& u) { return call_gradient(formula, u); });
  add<6>("formula_gradient", "library", 0, 1,
         [=](const six& u) { return call_gradient(library, u); });
  add<6>("formula_gradient", "hand", 0, 1, gradient_by_hand);
}

const bool registered = [] {
  add_arm();
  add_long_arm();
  add_gradient();
  return true;
}();

} // namespace
} // namespace duet_bench
