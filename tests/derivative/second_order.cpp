// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/core/errors.hpp>
#include <duet/derivative/derivative.hpp>
#include <duet/derivative/gradient.hpp>

#include <Eigen/Core>

// Parts of Hessians, against the complete Hessian and closed forms.

namespace test_derivative_second_order {
namespace {

using duet::hessian, duet::hessian_vector_product, duet::mixed_hessian;

/// x₀ sin(x₁ x₂) + exp(−x·x)
const auto wavy = [](const auto& x) {
  auto square = x[0] * x[0];
  for (std::size_t i = 1; i < std::size_t(x.size()); ++i) {
    square = square + x[i] * x[i];
  }
  using std::exp, std::sin;
  return x[0] * sin(x[1] * x[2]) + exp(-square);
};

TEST_CASE("hessian_vector_product: equals the Hessian times the vector") {
  const Eigen::Vector3d x(0.4, -1.1, 0.7);
  const Eigen::Vector3d v(2, -1, 0.5);
  const auto all = hessian(wavy, x);
  const auto [y, g, p] = hessian_vector_product(wavy, x, v);
  CHECK(y == all.value);
  CHECK((g - all.gradient).norm() < 1e-15);
  CHECK((p - all.hessian * v).norm() < 1e-15);
  const std::array<double, 3> a = {0.4, -1.1, 0.7};
  CHECK((hessian_vector_product(wavy, a, v).product - p).norm() == 0);
}

TEST_CASE("hessian_vector_product: works for many variables") {
  // f = Σ xᵢ² xᵢ₊₁: row i of H holds 2xᵢ₊₁ and, beside the diagonal, 2xᵢ and 2xᵢ₋₁.
  const auto chain = [](const auto& x) {
    using T = std::decay_t<decltype(x[0])>;
    T sum = 0.0;
    for (Eigen::Index i = 0; i + 1 < x.size(); ++i) {
      sum += x[i] * x[i] * x[i + 1];
    }
    return sum;
  };
  const Eigen::Index n = 100;
  Eigen::VectorXd x(n);
  Eigen::VectorXd v(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    x[i] = std::sin(double(i));
    v[i] = std::cos(3.0 * double(i));
  }
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    expected[i] += 2 * x[i + 1] * v[i] + 2 * x[i] * v[i + 1];
    expected[i + 1] += 2 * x[i] * v[i];
  }
  CHECK((hessian_vector_product(chain, x, v).product - expected).norm() < 1e-13);
}

TEST_CASE("mixed_hessian: equals the block of the Hessian") {
  const auto f = [](const auto& x, const auto& y) {
    return sin(x[0] * y[0]) + x[1] * y[1] * y[2] + exp(x[0]) + y[2] * y[2];
  };
  const Eigen::Vector2d x(0.3, -0.8);
  const Eigen::Vector3d y(1.2, 0.5, -2);
  const auto [value, block] = mixed_hessian(f, x, y);
  static_assert(decltype(block)::RowsAtCompileTime == 2 && decltype(block)::ColsAtCompileTime == 3);
  CHECK(value == doctest::Approx(std::sin(0.36) + 0.8 + std::exp(0.3) + 4).epsilon(1e-15));
  Eigen::Matrix<double, 2, 3> expected;
  expected << std::cos(0.36) - 0.36 * std::sin(0.36), 0, 0, 0, y[2], y[1];
  CHECK((block - expected).norm() < 1e-15);
}

TEST_CASE("hessian_vector_product and mixed_hessian: work inside another differentiation") {
  const auto slope = [](auto t) {
    const auto f = [t](const auto& x) { return t * t * x[0] * x[0] * x[1]; };
    return hessian_vector_product(f, Eigen::Vector2d(1, 2), Eigen::Vector2d(1, 0)).product[0];
  };
  CHECK(duet::derivative(slope, 3.0).value == 9 * 4);
  CHECK(duet::derivative(slope, 3.0).derivative == 6 * 4);
  const auto mixed = [](auto t) {
    const auto f = [t](const auto& x, const auto& y) { return t * t * x[0] * y[0] * y[0]; };
    return mixed_hessian(f, std::array{1.0}, std::array{2.0}).mixed(0, 0);
  };
  CHECK(duet::derivative(mixed, 3.0).value == 9 * 4);
  CHECK(duet::derivative(mixed, 3.0).derivative == 6 * 4);
}

TEST_CASE("hessian_vector_product: sizes that differ throw invalid_input") {
  DUET_CHECK_REFUSED("duet: hessian_vector_product: the point has 3 components, the vector 2",
                     hessian_vector_product(wavy, Eigen::Vector3d(1, 2, 3), Eigen::Vector2d(1, 2)));
}

} // namespace
} // namespace test_derivative_second_order
