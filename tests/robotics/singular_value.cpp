// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "../../src/robotics/branches/singular_value.hpp"
#include "support/multiprecision.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/core/batch/math.hpp>

#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/QR>

namespace test_robotics_singular_value {
namespace {

using duet::detail::smallest_singular_value;
using duet_test::real_50;
using matrix = Eigen::Matrix<double, 6, 6>;
using vector = Eigen::Matrix<double, 6, 1>;
using eight = duet::batch<double, 8>;

matrix random_matrix(duet_test::random_source& random) {
  matrix result;
  for (double& x : result.reshaped()) {
    x = random.uniform(-1, 1);
  }
  return result;
}

matrix rotation(duet_test::random_source& random) {
  return Eigen::HouseholderQR<matrix>(random_matrix(random)).householderQ();
}

/// Matrices with rows of very different lengths, close singular values, nearly equal columns, and
/// zero off-diagonal entries.
std::vector<matrix> ill_conditioned_matrices(duet_test::random_source& random) {
  std::vector<matrix> result;
  for (const double unit : {1., 1e3, 1e-6}) {
    matrix a = random_matrix(random);
    a.topRows<3>() *= unit;
    result.push_back(a);
  }
  const auto add = [&](const std::array<double, 6>& values) {
    const vector s = Eigen::Map<const vector>(values.data());
    result.push_back(rotation(random) * s.asDiagonal() * rotation(random));
  };
  add({1, 1, 1, 1, 1, 1});
  add({3, 2, 1, 1, 1, 1});
  add({3, 2, 1 + 1e-4, 1 + 2e-9, 1 + 1e-9, 1});
  add({1, .7, .5, .3, 1e-8 * (1 + 1e-3), 1e-8});
  add({1, .9, .8, .7, .6, 1e-13});
  matrix twins = random_matrix(random);
  twins.col(4) = twins.col(1) + 1e-9 * twins.col(4);
  result.push_back(twins);
  vector lengths;
  lengths << 3, -2, 1, .5, .5, 4;
  const matrix diagonal = lengths.asDiagonal();
  result.push_back(diagonal);
  result.push_back(diagonal.rowwise().reverse());
  result.push_back(diagonal + 1e-200 * random_matrix(random));
  return result;
}

/// Number of singular values smaller than s: negative pivots of J Jᵀ − s² (Sylvester's law of
/// inertia).
int count_below(const matrix& j, const real_50& s) {
  real_50 a[6][6];
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) {
      a[i][k] = i == k ? real_50(-s * s) : real_50(0);
      for (int c = 0; c < 6; ++c) {
        a[i][k] += real_50(j(i, c)) * real_50(j(k, c));
      }
    }
  }
  int result = 0;
  for (int p = 0; p < 6; ++p) {
    result += a[p][p] < 0;
    for (int i = p + 1; i < 6; ++i) {
      const real_50 factor = a[i][p] / a[p][p];
      for (int k = p; k < 6; ++k) {
        a[i][k] -= factor * a[p][k];
      }
    }
  }
  return result;
}

/// Condition number of a matrix with its rows scaled to length 1.
double condition(matrix j) {
  j.rowwise().normalize();
  return j.norm() * j.inverse().norm();
}

eight values_of(const std::vector<matrix>& all, std::size_t first) {
  Eigen::Matrix<eight, 6, 6> lanes;
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) {
      lanes(i, k) = eight::from_lanes(
          [&](int lane) { return all[(first + std::size_t(lane)) % all.size()](i, k); });
    }
  }
  return smallest_singular_value(lanes);
}

TEST_CASE("smallest_singular_value: the result agrees with 50 digits") {
  duet_test::random_source random(2);
  for (int round = 0; round < 8; ++round) {
    const auto all = ill_conditioned_matrices(random);
    for (std::size_t i = 0; i < all.size(); ++i) {
      CAPTURE(round);
      CAPTURE(i);
      const double error = 4 * std::numeric_limits<double>::epsilon() * condition(all[i]);
      REQUIRE(error < .1);
      for (const double x : {smallest_singular_value(all[i]), values_of(all, i)[0]}) {
        CHECK(count_below(all[i], real_50(x) * (1 - real_50(error))) == 0);
        CHECK(count_below(all[i], real_50(x) * (1 + real_50(error))) > 0);
      }
    }
  }
}

TEST_CASE("smallest_singular_value: it is zero for a singular matrix, independently of other SIMD "
          "lanes") {
  duet_test::random_source random(3);
  std::vector<matrix> all;
  for (int i = 0; i < 8; ++i) {
    all.push_back(random_matrix(random));
  }
  const eight before = values_of(all, 0);
  all[1].row(2).setZero();
  all[3].row(4) = all[3].row(0);
  all[4].setZero();
  all[6].row(3) = 1e3 * (all[6].row(1) - all[6].row(5));
  const eight after = values_of(all, 0);
  for (const int i : {1, 4}) {
    CHECK(after[i] == 0);
    CHECK(smallest_singular_value(all[std::size_t(i)]) == 0);
  }
  for (const int i : {3, 6}) { // zero except for round-off
    CHECK(after[i] >= 0);
    CHECK(after[i] < 1e-14);
  }
  for (const int i : {0, 2, 5, 7}) {
    CHECK(before[i] > 1e-3);
    CHECK(after[i] == doctest::Approx(before[i]).epsilon(1e-12));
  }
}

} // namespace
} // namespace test_robotics_singular_value
