// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/derivative/implicit_function.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

// Inverses and determinants, and which matrices count as singular.

namespace test_derivative_equilibrated_matrix {
namespace {

template <int N>
using matrix = Eigen::Matrix<double, N, N>;

template <int N>
duet::detail::equilibrated_matrix<N> of(const matrix<N>& entries) {
  duet::detail::equilibrated_matrix<N> result;
  result.compute(entries);
  return result;
}

template <int N>
matrix<N> random_matrix(duet_test::random_source& random) {
  matrix<N> result;
  for (double& x : result.reshaped()) {
    x = random.uniform(-1, 1);
  }
  return result;
}

/// A matrix whose rows and columns have different units, of up to 1e±8.
template <int N>
void check_inverses() {
  duet_test::random_source random(7);
  for (int k = 0; k < 200; ++k) {
    const matrix<N> plain = random_matrix<N>(random);
    Eigen::Matrix<double, N, 1> rows, columns;
    for (int i = 0; i < N; ++i) {
      rows[i] = std::ldexp(1, int(random.uniform(-27, 27)));
      columns[i] = std::ldexp(1, int(random.uniform(-27, 27)));
    }
    const auto m = of<N>(rows.asDiagonal() * plain * columns.asDiagonal());
    const matrix<N> inverse = columns.asDiagonal() * m.inverse() * rows.asDiagonal();
    const double condition = plain.norm() * inverse.norm();
    const double rounding = 8 * std::numeric_limits<double>::epsilon() * N * condition;
    CHECK(m.is_invertible());
    CHECK((plain * inverse - matrix<N>::Identity()).norm() <= rounding);
    CHECK((inverse * plain - matrix<N>::Identity()).norm() <= rounding);
    const auto determinant = double(plain.template cast<long double>().determinant());
    CHECK(std::abs(m.determinant() / (rows.prod() * columns.prod()) - determinant) <=
          rounding * std::abs(determinant));
    const Eigen::Matrix<double, N, 1> x = random_matrix<N>(random).col(0);
    CHECK(m.solve(x) == m.inverse() * x);
  }
}

TEST_CASE("equilibrated_matrix: inverses do not depend on units") {
  check_inverses<1>();
  check_inverses<2>();
  check_inverses<5>();
}

TEST_CASE("equilibrated_matrix: all exchanges of rows and columns give the inverse") {
  std::array<int, 4> order{};
  std::iota(order.begin(), order.end(), 0);
  do {
    matrix<4> entries = matrix<4>::Zero();
    for (int i = 0; i < 4; ++i) {
      entries(i, order[std::size_t(i)]) = 1;
    }
    const auto m = of<4>(entries);
    CHECK(m.inverse() == entries.transpose());
    CHECK(m.determinant() == std::round(entries.determinant()));
    CHECK(m.is_invertible());
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST_CASE("equilibrated_matrix: singular matrices are recognised") {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const auto with = [](double x) {
    matrix<3> result;
    result << 1, 2, 3, 4, 5, 6, 7, 8, x;
    return of<3>(result);
  };
  CHECK(!with(9).is_invertible());
  CHECK(std::abs(with(9).determinant()) < 1e-14);
  CHECK(with(9.000001).is_invertible());
  CHECK(with(9.000001).determinant() == doctest::Approx(-3e-6));
  CHECK(!with(none).is_invertible());
  CHECK(!of<2>(matrix<2>::Zero()).is_invertible());
  CHECK(of<2>(matrix<2>::Zero()).determinant() == 0);
  CHECK(!of<2>(matrix<2>::Zero()).inverse().allFinite());
  // Rows in small units do not make the matrix singular, neither one nor all of them.
  matrix<3> entries = matrix<3>::Identity();
  entries.row(1) *= 1e-200;
  CHECK(of<3>(entries).is_invertible());
  CHECK(of<3>(1e-100 * matrix<3>::Identity()).is_invertible());
}

} // namespace
} // namespace test_derivative_equilibrated_matrix
