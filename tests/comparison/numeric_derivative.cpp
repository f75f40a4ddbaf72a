// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/comparison/numeric_derivative.hpp>
#include <duet/derivative/derivative.hpp>
#include <duet/interop/multiprecision.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Core>

#include <complex>

// Complex steps and central differences, against dual numbers.

namespace test_comparison_numeric_derivative {
namespace {

using duet::central_difference_derivative, duet::complex_step_derivative, duet::derivative;

const auto wave = [](const auto& x) {
  using std::exp, std::log, std::sin;
  return sin(x * x) * exp(-x) + log(2.0 + x) / x;
};

TEST_CASE("complex_step_derivative: exact to round-off") {
  for (const double x : {0.1, 0.7, 2.0, 9.0}) {
    const double reference = derivative(wave, x).derivative;
    CHECK(std::abs(complex_step_derivative(wave, x) - reference) <=
          8e-16 * (std::abs(reference) + 1));
  }
  CHECK(complex_step_derivative([](const auto& x) { return x * x * x; }, 2.0L) == 12.0L);
  const auto curve = [](const auto& x) {
    using std::cos, std::sin;
    return Eigen::Matrix<std::decay_t<decltype(x)>, 2, 1>(cos(x), sin(x));
  };
  CHECK((complex_step_derivative(curve, 0.4) - Eigen::Vector2d(-std::sin(0.4), std::cos(0.4)))
            .norm() < 3e-16);
  const auto pair = [](const auto& x) { return std::array{x, x * x}; };
  CHECK(complex_step_derivative(pair, 3.0) == std::array{1.0, 6.0});
}

TEST_CASE("central_difference_derivative: the estimated error bounds the actual error") {
  for (const double x : {0.5, 0.7, 2.0}) {
    const double reference = derivative(wave, x).derivative;
    const auto [slope, error] = central_difference_derivative(wave, x);
    CHECK(std::abs(slope - reference) <= 1e-11);
    CHECK(std::abs(slope - reference) <= 10 * error + 1e-13);
  }
  const auto [slope, error] = central_difference_derivative(wave, duet::real_50(0.7));
  const duet::real_50 reference = derivative(wave, duet::real_50(0.7)).derivative;
  CHECK(abs(duet::real_50(slope - reference)) < 1e-18);
  CHECK(error < 1e-17);
}

TEST_CASE("central_difference_derivative: the estimated error includes round-off of f and of x") {
  const auto is_honest = [](const auto& f, auto x, auto step) {
    const double reference = double(derivative(f, duet::real_50(x)).derivative);
    const auto [slope, error] = central_difference_derivative(f, x, step);
    CAPTURE(x);
    CHECK(std::abs(double(slope) - reference) <= 10 * error);
    return error;
  };
  const auto offset = [](const auto& x) {
    using std::sin;
    return std::decay_t<decltype(x)>(sin(x) + 1e6);
  };
  const auto cubic = [](const auto& x) { return std::decay_t<decltype(x)>(x * x * x); };
  for (int i = -300; i <= 300; ++i) {
    CHECK(is_honest(offset, i / 100.0, 0.1) < 1e-7);
    is_honest(offset, i / 100.0, 1e-9);
    is_honest(cubic, float(i) / 100, 0.1F);
    is_honest(cubic, i / 100.0, 0.1);
    is_honest(cubic, i * 1e12 + 0.3, 0.1); // near 1e14 numbers are 1/64 apart
    is_honest(offset, i * 1e12 + 0.3, 0.1);
  }
  const auto at_equal_numbers = central_difference_derivative(offset, 1e20);
  CHECK(std::isinf(at_equal_numbers.error));
}

TEST_CASE("central_difference_derivative: results of any shape are differentiated") {
  const auto rotation_at = [](const auto& t) {
    using T = std::decay_t<decltype(t)>;
    return duet::exp(duet::vector3<T>(t, t * t, T(0.3)));
  };
  const auto reference = derivative(rotation_at, 0.4).derivative;
  const auto numeric = central_difference_derivative(rotation_at, 0.4);
  CHECK(norm(numeric.derivative - reference) < 1e-11);
}

TEST_CASE("central_difference_derivative: the step shrinks away from a kink; the estimate shows "
          "one too near") {
  const auto kink = [](double x) { return std::abs(x - 0.5) + x; };
  const auto [slope, error] = central_difference_derivative(kink, 0.5 + 3e-2);
  CHECK(std::abs(slope - 2) <= 1e-9);
  CHECK(error < 1e-9);
  CHECK(central_difference_derivative(kink, 0.5 + 3e-3).error > 1e-3);
  const auto at_pole = central_difference_derivative([](double x) { return 1 / (x - x); }, 1.0);
  CHECK(std::isinf(at_pole.error));
}

} // namespace
} // namespace test_comparison_numeric_derivative
