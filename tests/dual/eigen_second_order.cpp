// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/eigen_problems.hpp"
#include "support/test.hpp"

#include <Eigen/LU>
#include <Eigen/QR>

// Second derivatives of solutions, by Taylor numbers and by nested duals:
// A x″ = b″ − 2A′x′ − A″x.

namespace test_dual_eigen_second_order {
namespace {

using duet::dual, duet::taylor, duet_test::problems, Eigen::Dynamic;

struct outer_tag;

template <class D, class Seed>
auto seeded_twice(const Eigen::MatrixXd& value, const Eigen::MatrixXd& slope, Seed seed) {
  return Eigen::Matrix<D, Dynamic, Dynamic>::NullaryExpr(
      value.rows(), value.cols(),
      [=](Eigen::Index i, Eigen::Index j) { return seed(value(i, j), slope(i, j)); });
}

TEST_CASE("Eigen over dual: second derivatives of solutions") {
  using series = taylor<double, 2>;
  using nested = dual<dual<double>, 1, outer_tag>;
  for (const int n : {1, 2, 4}) {
    for (const auto& p : problems(n)) {
      CAPTURE(p.name);
      const Eigen::VectorXd x = p.x();
      const Eigen::VectorXd first = p.x_slope();
      const Eigen::VectorXd second = p.a.fullPivLu().solve(-2 * p.a_slope * first);
      const double tolerance = 1e-11 * (1 + x.norm() + first.norm() + second.norm());

      const auto as_series = [](double v, double s) { return series({v, s, 0}); };
      const auto series_a = seeded_twice<series>(p.a, p.a_slope, as_series).eval();
      const auto series_b = seeded_twice<series>(p.b, p.b_slope, as_series).eval();
      const auto lu = series_a.partialPivLu().solve(series_b).eval();
      const auto qr = series_a.householderQr().solve(series_b).eval();

      const auto as_nested = [](double v, double s) {
        return nested(dual<double>(v, s), dual<double>(s));
      };
      const auto nested_a = seeded_twice<nested>(p.a, p.a_slope, as_nested).eval();
      const auto nested_b = seeded_twice<nested>(p.b, p.b_slope, as_nested).eval();
      const auto nested_qr = nested_a.householderQr().solve(nested_b).eval();

      for (int i = 0; i < n; ++i) {
        CHECK(std::abs(lu(i).value() - x(i)) <= tolerance);
        CHECK(std::abs(lu(i).derivative(1) - first(i)) <= tolerance);
        CHECK(std::abs(lu(i).derivative(2) - second(i)) <= tolerance);
        CHECK(std::abs(qr(i).derivative(1) - first(i)) <= tolerance);
        CHECK(std::abs(qr(i).derivative(2) - second(i)) <= tolerance);
        CHECK(std::abs(nested_qr(i).epsilon().value() - first(i)) <= tolerance);
        CHECK(std::abs(nested_qr(i).epsilon().epsilon() - second(i)) <= tolerance);
      }
    }
  }
}

} // namespace
} // namespace test_dual_eigen_second_order
