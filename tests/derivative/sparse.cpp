// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/derivative/gradient.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/derivative/sparse.hpp>

#include <Eigen/SparseCore>

// sparse_jacobian and sparse_hessian against the dense ones, over several kinds of patterns.

namespace test_derivative_sparse {
namespace {

using duet::sparse_hessian, duet::sparse_jacobian;
using matrix = Eigen::SparseMatrix<double>;

/// Pairs of n variables that occur in a common term.
struct pairs {
  int count;
  std::vector<std::pair<int, int>> met;
};

pairs band(int n) {
  pairs result{n, {}};
  for (int i = 0; i + 1 < n; ++i) {
    result.met.emplace_back(i, i + 1);
  }
  return result;
}
/// All with the first: one full row and column.
pairs arrow(int n) {
  pairs result{n, {}};
  for (int i = 1; i < n; ++i) {
    result.met.emplace_back(0, i);
  }
  return result;
}
pairs grid(int side) {
  pairs result{side * side, {}};
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      if (i + 1 < side) {
        result.met.emplace_back(i * side + j, (i + 1) * side + j);
      }
      if (j + 1 < side) {
        result.met.emplace_back(i * side + j, i * side + j + 1);
      }
    }
  }
  return result;
}

Eigen::VectorXd point(int n) {
  Eigen::VectorXd x(n);
  for (int i = 0; i < n; ++i) {
    x[i] = 0.3 + 0.17 * (i % 11);
  }
  return x;
}

/// Σ exp(x_i / 2) x_j sin x_j over the pairs: nothing of its Hessian there vanishes.
struct sum_over_pairs {
  const pairs* of;

  template <class X>
  auto operator()(const X& x) const {
    using std::exp, std::sin;
    auto sum = 0.0 * x[0];
    for (const auto& [i, j] : of->met) {
      sum += exp(x[std::size_t(i)] / 2) * x[std::size_t(j)] * sin(x[std::size_t(j)]);
    }
    return sum;
  }
};

/// Both triangles where `is_full`, else the lower one.
matrix structure_of(const pairs& p, bool is_full) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < p.count; ++i) {
    entries.emplace_back(i, i, 0.0);
  }
  for (const auto& [i, j] : p.met) {
    entries.emplace_back(j, i, 0.0);
    if (is_full) {
      entries.emplace_back(i, j, 0.0);
    }
  }
  matrix result(p.count, p.count);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

void check_hessian(const pairs& p) {
  const Eigen::VectorXd x = point(p.count);
  const sum_over_pairs f{&p};
  const auto dense = duet::hessian(f, x);
  for (const bool is_full : {false, true}) {
    const auto sparse = sparse_hessian(f, x, structure_of(p, is_full));
    CHECK(sparse.value == doctest::Approx(dense.value).epsilon(1e-15));
    CHECK((sparse.gradient - dense.gradient).norm() <= 1e-15 * dense.gradient.norm());
    CHECK((Eigen::MatrixXd(sparse.hessian) - dense.hessian).norm() <= 1e-14 * dense.hessian.norm());
    CHECK(sparse.hessian.nonZeros() == Eigen::Index(p.count + 2 * int(p.met.size())));
  }
}

/// y_i = x_i x_{i+1} sin x_{i+2}, n − 2 rows.
struct neighbours {
  template <class T>
  auto operator()(const std::vector<T>& x) const {
    using std::sin;
    std::vector<T> y;
    for (std::size_t i = 0; i + 2 < x.size(); ++i) {
      y.push_back(x[i] * x[i + 1] * sin(x[i + 2]));
    }
    return y;
  }
};

matrix band_of_rows(int n, int width) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i + 2 < n; ++i) {
    for (int j = i; j < i + width; ++j) {
      entries.emplace_back(i, j, 1.0);
    }
  }
  matrix result(n - 2, n);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

TEST_CASE("sparse_hessian: bands, arrows and grids equal the dense Hessian") {
  for (const int n : {1, 2, 3, 8, 9, 40}) {
    check_hessian(band(n));
    check_hessian(arrow(n));
  }
  check_hessian(grid(3));
  check_hessian(grid(6));
}

TEST_CASE("sparse_jacobian: equals the dense Jacobian with the expected number of calls") {
  for (const int n : {3, 4, 17, 100}) {
    const Eigen::VectorXd at = point(n);
    const std::vector<double> x(at.begin(), at.end());
    int calls = 0;
    const auto counted = [&calls](const auto& v) {
      ++calls;
      return neighbours{}(v);
    };
    const auto sparse = sparse_jacobian(counted, x, band_of_rows(n, 3));
    CHECK(calls == 1); // three groups of columns, and the sum that is checked
    const auto dense = duet::jacobian(neighbours{}, x);
    CHECK(sparse.value == dense.value);
    CHECK(Eigen::MatrixXd(sparse.jacobian) == dense.jacobian);
    CHECK(sparse.jacobian.nonZeros() == 3 * (n - 2));
  }
}

TEST_CASE("sparse_jacobian: a full row takes as many passes as a dense Jacobian") {
  const int n = 40;
  const auto f = [](const auto& x) {
    return Eigen::Matrix<typename std::decay_t<decltype(x)>::Scalar, 1, 1>(x.squaredNorm());
  };
  const Eigen::VectorXd x = point(n);
  const matrix full = Eigen::MatrixXd::Ones(1, n).sparseView();
  CHECK(Eigen::MatrixXd(sparse_jacobian(f, x, full).jacobian) == duet::jacobian(f, x).jacobian);
}

TEST_CASE("sparse_jacobian and sparse_hessian: entries outside the pattern throw invalid_input") {
  const std::vector<double> x{0.3, 0.5, 0.7, 0.9, 1.1};
  DUET_CHECK_REFUSED("duet: sparse_jacobian: row 0 has entries outside the sparsity pattern",
                     sparse_jacobian(neighbours{}, x, band_of_rows(5, 2)));
  const pairs p = grid(3);
  matrix without = structure_of(p, true);
  without.prune([](int i, int j, double) { return !(i == 4 && j == 5) && !(i == 5 && j == 4); });
  DUET_CHECK_REFUSED("duet: sparse_hessian: row 4 has entries outside the sparsity pattern",
                     sparse_hessian(sum_over_pairs{&p}, point(9), without));
}

TEST_CASE("sparse_jacobian and sparse_hessian: a pattern of another size throws invalid_input") {
  const std::vector<double> x{0.3, 0.5, 0.7, 0.9, 1.1};
  DUET_CHECK_REFUSED("duet: sparse_jacobian: the structure has 6 columns for 5 variables",
                     sparse_jacobian(neighbours{}, x, band_of_rows(6, 3)));
  DUET_CHECK_REFUSED("duet: sparse_jacobian: the structure has 4 rows, the function 3 components",
                     sparse_jacobian(neighbours{}, x, matrix(4, 5)));
  const pairs p = band(3);
  DUET_CHECK_REFUSED("duet: sparse_hessian: the structure is 3 x 4 for 3 variables",
                     sparse_hessian(sum_over_pairs{&p}, point(3), matrix(3, 4)));
}

TEST_CASE("sparse_jacobian: several arguments, and derivatives of the Jacobian") {
  const auto f = [](const auto& x, const auto& scale) {
    using T = std::decay_t<decltype(scale * x[0])>;
    return Eigen::Matrix<T, 3, 1>(scale * x[0] * x[0], scale * x[1] * x[1], scale * x[2] * x[2]);
  };
  matrix structure(3, 4);
  for (int i = 0; i < 3; ++i) {
    structure.insert(i, i) = 1;
    structure.insert(i, 3) = 1;
  }
  const std::tuple at(Eigen::Vector3d(1, 2, 3), 0.5);
  CHECK(Eigen::MatrixXd(sparse_jacobian(f, at, structure).jacobian) ==
        (Eigen::MatrixXd(3, 4) << 1, 0, 0, 1, 0, 2, 0, 4, 0, 0, 3, 9).finished());

  const auto entry = [&](const auto& s) {
    const auto x = std::tuple(Eigen::Vector3d(1, 2, 3), s);
    return sparse_jacobian(f, x, structure).jacobian.coeff(2, 2);
  };
  CHECK(duet::derivative(entry, 0.5).derivative == 6);
}

} // namespace
} // namespace test_derivative_sparse
