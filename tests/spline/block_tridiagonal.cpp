// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/identical.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>

namespace test_spline_block_tridiagonal {
namespace {

using duet::detail::block_row;
using duet::detail::block_tridiagonal;
using duet::detail::corners;

std::vector<block_row<double>> random_rows(std::size_t n, duet_test::random_source& random) {
  std::vector<block_row<double>> rows(n);
  for (auto& row : rows) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        row.lower(i, j) = random.uniform(-1, 1);
        row.diagonal(i, j) = random.uniform(-1, 1) + (i == j ? 6 : 0);
        row.upper(i, j) = random.uniform(-1, 1);
      }
    }
  }
  return rows;
}

Eigen::MatrixXd dense(const std::vector<block_row<double>>& rows, const corners& at) {
  const auto n = Eigen::Index(rows.size());
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& row = rows[std::size_t(i)];
    a.block<3, 3>(3 * i, 3 * (i == 0 ? Eigen::Index(at.first) : i - 1)) += row.lower;
    a.block<3, 3>(3 * i, 3 * i) += row.diagonal;
    a.block<3, 3>(3 * i, 3 * (i == n - 1 ? Eigen::Index(at.last) : i + 1)) += row.upper;
  }
  return a;
}

void check(std::size_t n, const corners& at) {
  CAPTURE(n);
  CAPTURE(at.first);
  CAPTURE(at.last);
  duet_test::random_source random(n);
  const auto rows = random_rows(n, random);
  std::vector<duet::vector3<double>> x(n);
  Eigen::VectorXd right(3 * Eigen::Index(n));
  for (std::size_t i = 0; i < n; ++i) {
    for (int j = 0; j < 3; ++j) {
      right[3 * Eigen::Index(i) + j] = x[i][j] = random.uniform(-1, 1);
    }
  }
  block_tridiagonal<double> solver;
  solver.rows() = rows;
  REQUIRE(solver.factorise(at));
  solver.solve(x);
  const Eigen::VectorXd expected = dense(rows, at).partialPivLu().solve(right);
  for (std::size_t i = 0; i < n; ++i) {
    CHECK((x[i] - expected.segment<3>(3 * Eigen::Index(i))).norm() < 1e-14);
  }
}

TEST_CASE("block_tridiagonal: cyclic systems of two and more rows agree with a dense solution") {
  for (const std::size_t n : {2, 3, 4, 5, 20}) {
    check(n, {n - 1, 0});
  }
}

TEST_CASE("block_tridiagonal: systems of three and more rows with a wider band at the ends agree "
          "with a dense solution") {
  for (const std::size_t n : {3, 4, 5, 6, 20}) {
    check(n, {2, n - 3});
  }
}

TEST_CASE(
    "block_tridiagonal: a factorisation over double solves for right sides over dual numbers") {
  duet_test::random_source random(1);
  const auto rows = random_rows(7, random);
  block_tridiagonal<double> solver;
  solver.rows() = rows;
  REQUIRE(solver.factorise({6, 0}));
  std::vector<duet::vector3<double>> value(7), part(7);
  std::vector<duet::vector3<duet::dual<double>>> both(7);
  for (std::size_t i = 0; i < 7; ++i) {
    for (int j = 0; j < 3; ++j) {
      value[i][j] = random.uniform(-1, 1);
      part[i][j] = random.uniform(-1, 1);
      both[i][j] = {value[i][j], part[i][j]};
    }
  }
  solver.solve(value);
  solver.solve(part);
  solver.solve(both);
  for (std::size_t i = 0; i < 7; ++i) {
    for (int j = 0; j < 3; ++j) {
      CHECK(std::abs(both[i][j].value() - value[i][j]) <= duet_test::if_fused(1e-15));
      CHECK(std::abs(both[i][j].epsilon() - part[i][j]) <= duet_test::if_fused(1e-15));
    }
  }
}

TEST_CASE("block_tridiagonal: factorise returns false for a singular pivot") {
  duet_test::random_source random(1);
  auto rows = random_rows(4, random);
  rows[0].diagonal.setZero();
  block_tridiagonal<double> solver;
  solver.rows() = rows;
  CHECK(!solver.factorise({2, 1}));
}

} // namespace
} // namespace test_spline_block_tridiagonal
