// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/identical.hpp"
#include "support/test.hpp"

#include <duet/core/errors.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/derivative/jacobian.hpp>

#include <Eigen/Core>

// Gradients and Jacobians with respect to many variables, into memory of the caller.

namespace test_derivative_chunked {
namespace {

using duet::gradient_into, duet::jacobian_into;

/// Σ xᵢ² xᵢ₊₁: every component has its own derivative.
const auto chain = [](const auto& x) {
  using T = std::decay_t<decltype(x[0])>;
  T sum = 0.0;
  const auto n = std::size_t(x.size());
  for (std::size_t i = 0; i < n; ++i) {
    sum += x[i] * x[i] * x[(i + 1) % n];
  }
  return sum;
};

template <class X>
double slope_of_chain(const X& x, std::size_t i) {
  const auto n = std::size_t(x.size());
  const double before = x[(i + n - 1) % n];
  return 2 * x[i] * x[(i + 1) % n] + before * before;
}

Eigen::VectorXd point(Eigen::Index n) {
  Eigen::VectorXd x(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    x[i] = std::sin(double(i)) + 0.25;
  }
  return x;
}

template <int Chunk>
void check_gradient(Eigen::Index n) {
  const Eigen::VectorXd x = point(n);
  Eigen::VectorXd g(n);
  int evaluations = 0;
  const auto counted = [&](const auto& v) {
    ++evaluations;
    return chain(v);
  };
  CHECK(std::abs(gradient_into<Chunk>(counted, x, g) - chain(x)) <= duet_test::if_fused(1e-12));
  if constexpr (Chunk > 0) {
    CHECK(evaluations == (n + Chunk - 1) / Chunk);
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    CHECK(std::abs(g[i] - slope_of_chain(x, std::size_t(i))) <= 1e-15 * 8);
  }
}

TEST_CASE("gradient_into: any chunk gives the same gradient in the expected number of passes") {
  check_gradient<0>(1000);
  check_gradient<1>(37);
  check_gradient<4>(1000);
  check_gradient<7>(100);
  check_gradient<16>(1000);
  check_gradient<32>(33);
  check_gradient<64>(63);
}

TEST_CASE("gradient_into: a size known at compile time is divided into passes of equal size") {
  const Eigen::Matrix<double, 100, 1> x = point(100);
  Eigen::VectorXd g(100);
  int evaluations = 0;
  const auto counted = [&](const auto& v) {
    using D = typename std::decay_t<decltype(v)>::value_type;
    CHECK(D().size() == 50);
    ++evaluations;
    return chain(v);
  };
  CHECK(std::abs(gradient_into(counted, x, g) - chain(x)) <= duet_test::if_fused(1e-13));
  CHECK(evaluations == 2);
  CHECK(g == duet::gradient(chain, Eigen::VectorXd(x)).gradient);
  for (Eigen::Index i = 0; i < 100; ++i) {
    CHECK(std::abs(g[i] - slope_of_chain(x, std::size_t(i))) <= 1e-15 * 8);
  }
}

TEST_CASE("gradient_into: accepts fixed sizes, arrays and parts of a larger vector") {
  const Eigen::Matrix<double, 50, 1> x = point(50);
  Eigen::VectorXd results = Eigen::VectorXd::Constant(60, -1);
  static_cast<void>(gradient_into<8>(chain, x, results.segment(5, 50)));
  CHECK(results.head(5) == Eigen::VectorXd::Constant(5, -1));
  CHECK(results.tail(5) == Eigen::VectorXd::Constant(5, -1));
  CHECK((results.segment(5, 50) - duet::gradient(chain, x).gradient).norm() < 1e-14);

  const std::array<double, 3> a = {1, 2, 3};
  Eigen::Vector3d g;
  CHECK(gradient_into(chain, a, g) == 1 * 2 + 4 * 3 + 9 * 1);
  CHECK(g == Eigen::Vector3d(4 + 9, 12 + 1, 6 + 4));
}

TEST_CASE("jacobian_into: many variables give the same Jacobian in passes") {
  const Eigen::VectorXd x = point(45);
  const auto f = [](const auto& v) {
    using T = std::decay_t<decltype(v[0])>;
    Eigen::Matrix<T, Eigen::Dynamic, 1> y(v.size() - 1);
    for (Eigen::Index i = 0; i + 1 < v.size(); ++i) {
      y[i] = v[i] * v[i + 1];
    }
    return y;
  };
  Eigen::MatrixXd J(44, 45);
  const Eigen::VectorXd y = jacobian_into<16>(f, x, J);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(44, 45);
  for (Eigen::Index i = 0; i < 44; ++i) {
    CHECK(y[i] == x[i] * x[i + 1]);
    expected(i, i) = x[i + 1];
    expected(i, i + 1) = x[i];
  }
  CHECK(J == expected);
  CHECK(duet::jacobian(f, x).jacobian == expected);
}

TEST_CASE("gradient_into and jacobian_into: sizes that do not match throw invalid_input") {
  const Eigen::VectorXd x = point(10);
  Eigen::VectorXd g(9);
  DUET_CHECK_REFUSED("duet: gradient_into: the result needs size 10, but has 9",
                     gradient_into(chain, x, g));
  const auto twice = [](const auto& v) { return (2 * v).eval(); };
  Eigen::MatrixXd J(10, 9);
  DUET_CHECK_REFUSED("duet: jacobian_into: the result needs size 10 x 10, but has 10 x 9",
                     jacobian_into(twice, x, J));
  const Eigen::VectorXd nothing;
  CHECK_THROWS_AS(static_cast<void>(gradient_into(chain, nothing, g)), duet::invalid_input);
}

} // namespace
} // namespace test_derivative_chunked
