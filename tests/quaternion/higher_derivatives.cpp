// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "quaternion/truth.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/quaternion/exponential.hpp>

// Derivatives of exp, log and pow along a line, first to fourth, at and near the identity, half and
// full turns: Taylor numbers and nested duals against 100 digits.

namespace test_quaternion_higher_derivatives {
namespace {

using duet::dual, duet::quaternion, duet_test::random_source, duet_test::worst_error;
namespace reference = duet_test::reference;

struct first;
struct second;
struct third;
struct fourth;
using nested = dual<dual<dual<dual<double, 1, first>, 1, second>, 1, third>, 1, fourth>;

/// x + ε₁ + ε₂ + ε₃ + ε₄
nested nested_variable(double x) {
  using d1 = nested::value_type::value_type::value_type;
  using d2 = nested::value_type::value_type;
  using d3 = nested::value_type;
  return {d3(d2(d1(x, 1), d1(1)), d2(d1(1))), d3(d2(d1(1)))};
}

/// The coefficient of ε₁ … ε_k.
template <class T>
double nested_derivative(const T& x, int k) {
  if constexpr (std::is_same_v<T, double>) {
    return x;
  } else {
    constexpr int level = duet::scalar_traits<T>::order;
    return nested_derivative(level <= k ? x.epsilon() : x.value(), k);
  }
}

struct errors {
  std::vector<worst_error> by_taylor;
  std::vector<worst_error> by_nesting;

  explicit errors(const std::string& name) {
    for (int k = 0; k <= 4; ++k) {
      by_taylor.emplace_back(name + ", derivative " + std::to_string(k) + " by taylor");
      by_nesting.emplace_back(name + ", derivative " + std::to_string(k) + " by nested duals");
    }
  }
  void check(const double (&limits)[5]) const {
    for (std::size_t k = 0; k <= 4; ++k) {
      CHECK_MESSAGE(by_taylor[k] <= limits[k], by_taylor[k]);
      CHECK_MESSAGE(by_nesting[k] <= limits[k], by_nesting[k]);
    }
  }
};

/// The derivatives of t ↦ f(q + t d) at t = 0.
struct computed {
  std::array<quaternion<double>, 5> by_taylor;
  quaternion<nested> by_nesting;

  template <class F>
  computed(const F& f, const quaternion<double>& q, const quaternion<double>& d)
      : by_taylor(duet::derivatives<4>([&](const auto& t) { return f(q + t * d); }, 0.0)),
        by_nesting(f(q + nested_variable(0) * d)) {}
};

/// `reach` is the radius of smoothness, `moved` the change by the rounding of q, in units of |q|
/// or, if it is less, of the distance to a singularity.
void measure(errors& e, const computed& both,
             const std::function<reference::four(reference::four)>& exact_f,
             const quaternion<double>& q, const quaternion<double>& d, const reference::real& reach,
             const reference::real& moved) {
  const auto& [by_taylor, by_nesting] = both;
  const reference::four x = reference::wide(q);
  const reference::four dx = reference::wide(d);
  std::array<reference::four, 6> exact;
  for (int k = 0; k <= 5; ++k) {
    exact[std::size_t(k)] = reference::difference(
        [&](const reference::real& t) { return exact_f(reference::sum(x, dx, t)); }, k, reach);
  }
  for (std::size_t k = 0; k <= 4; ++k) {
    const reference::real scale =
        reference::length(exact[k]) + moved * reference::length(exact[k + 1]);
    e.by_taylor[k].add(reference::ulps(by_taylor[k], exact[k], scale), q, d);
    const int order = int(k);
    const quaternion<double> nested_result(
        nested_derivative(by_nesting.w(), order), nested_derivative(by_nesting.x(), order),
        nested_derivative(by_nesting.y(), order), nested_derivative(by_nesting.z(), order));
    e.by_nesting[k].add(reference::ulps(nested_result, exact[k], scale), q, d);
  }
}

/// Half angles at and near 0, a half turn, a full turn, and at the switches of the algorithm.
std::vector<double> half_angles() {
  using std::numbers::pi;
  std::vector<double> result{0, 1e-300, 1e-160, 1e-8, 1e-4, 0.1};
  for (const double middle : {pi / 2, 1.0, 0.5}) {
    for (const double distance : {0.0, 1e-12, -1e-12, 1e-8, -1e-8, 1e-4, -1e-4}) {
      result.push_back(middle + distance);
    }
  }
  for (const double distance : {1e-1, 1e-2, 1e-4, 1e-8}) {
    result.push_back(pi - distance);
  }
  return result;
}

TEST_CASE("exp: derivatives to fourth order agree with 100 digits") {
  random_source random(31);
  errors e("exp");
  auto angles = half_angles();
  angles.insert(angles.end(), {std::sqrt(9.8696), std::sqrt(9.8697), 3.141592653589793, 4.0, 6.0});
  for (const double angle : angles) {
    for (int i = 0; i < 3; ++i) {
      const auto a = random.direction<3>();
      const auto d = random.direction<3>();
      const auto scalar = i == 0 ? 0.0 : random.uniform(-1, 1);
      const quaternion<double> at(0, angle * a[0], angle * a[1], angle * a[2]);
      const quaternion<double> along(scalar, d[0], d[1], d[2]);
      const computed both([](const auto& q) { return exp(q); }, at, along);
      measure(e, both, reference::exp, at, along, 1, angle);
    }
  }
  e.check({16, 16, 16, 16, 16});
}

TEST_CASE("log: derivatives to fourth order agree with 100 digits") {
  random_source random(32);
  errors e("log");
  for (const double angle : half_angles()) {
    for (int i = 0; i < 3; ++i) {
      const auto a = random.direction<3>();
      const auto d = random.direction<4>();
      const double s = std::sin(angle);
      const reference::real reach = angle > 1.6 ? reference::real(s) : reference::real(1);
      const quaternion<double> at(std::cos(angle), s * a[0], s * a[1], s * a[2]);
      const quaternion<double> along(d[0], d[1], d[2], d[3]);
      const computed both([](const auto& q) { return log(q); }, at, along);
      measure(e, both, reference::log, at, along, reach, reach);
    }
  }
  e.check({16, 16, 16, 16, 16});
}

TEST_CASE("pow: derivatives to fourth order agree with 100 digits") {
  random_source random(33);
  errors e("pow");
  for (const double angle : half_angles()) {
    const auto a = random.direction<3>();
    const auto d = random.direction<4>();
    const double s = std::sin(angle);
    const reference::real reach = angle > 1.6 ? reference::real(s) : reference::real(1);
    for (const double rho : {0.5, -1.3}) {
      const quaternion<double> at(std::cos(angle), s * a[0], s * a[1], s * a[2]);
      const quaternion<double> along(d[0], d[1], d[2], d[3]);
      const computed both([=](const auto& q) { return pow(q, rho); }, at, along);
      measure(
          e, both, [=](const reference::four& q) { return reference::pow(q, rho); }, at, along,
          reach, reach);
    }
  }
  e.check({16, 16, 16, 16, 16});
}

} // namespace
} // namespace test_quaternion_higher_derivatives
