// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/lanes.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/derivative/linear_solve.hpp>
#include <duet/dual/taylor.hpp>

namespace test_derivative_batch {
namespace {

using duet::batch, duet::dual, duet_test::check_lanes;

using matrix = Eigen::Matrix3d;
using vector = Eigen::Vector3d;

/// Matrices that are reduced with pivots in all orders, zeros among the entries; some of them
/// badly scaled, none badly conditioned.
std::vector<matrix> matrices() {
  std::vector<matrix> result(6, matrix::Zero());
  const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (std::size_t k = 0; k < 6; ++k) {
    for (int i = 0; i < 3; ++i) {
      result[k](orders[k][i], i) = k % 2 == 0 ? 2 : -0.5;
    }
  }
  duet_test::random_source random(3);
  for (int k = 0; k < 5; ++k) {
    matrix m = result[std::size_t(k)];
    for (int i = 0; i < 9; ++i) {
      m(i / 3, i % 3) += random.uniform(-0.3, 0.3);
    }
    result.push_back(k == 2 ? matrix(1e200 * m) : m);
  }
  return result;
}

std::vector<vector> right_sides() {
  std::vector<vector> result{{1, 2, -3}, {0, 0, 0}, {0, 1e-9, 0}};
  duet_test::random_source random(8);
  for (int k = 0; k < 4; ++k) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
    result.emplace_back(x, y, random.uniform(-1, 1));
  }
  return result;
}

template <class D, class V>
auto moving(const std::vector<V>& values) {
  duet_test::random_source random(5);
  using M = Eigen::Matrix<D, V::RowsAtCompileTime, V::ColsAtCompileTime>;
  std::vector<M> result;
  for (const V& x : values) {
    const double size = x.norm();
    M m;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      m(i) = D(x(i));
      if constexpr (duet::scalar_traits<D>::order == 1) {
        m(i) = D(x(i), size * random.uniform(-1, 1));
      } else {
        m(i).set_coefficient(1, size * random.uniform(-1, 1));
      }
    }
    result.push_back(m);
  }
  return result;
}

std::string message_of(const Eigen::Matrix<batch<double, 4>, 2, 2>& a) {
  try {
    static_cast<void>(solve(a, Eigen::Matrix<batch<double, 4>, 2, 1>::Ones().eval()));
  } catch (const duet::invalid_input& error) {
    return error.what();
  }
  return "";
}

TEST_CASE("solve over batches: lanes with pivots in different rows are solved independently") {
  const auto solved = [](const auto& a, const auto& b) { return duet::solve(a, b); };
  check_lanes<4>(solved, 8, matrices(), right_sides());
  check_lanes<8>(solved, 8, matrices(), right_sides());
  check_lanes<4>([](const auto& a, const auto& b) { return duet::solve(b, a); }, 8,
                 std::vector<Eigen::Matrix<double, 3, 2>>(1, Eigen::Matrix<double, 3, 2>::Ones()),
                 matrices());
  check_lanes<4>(solved, 32, moving<dual<double>>(matrices()), moving<dual<double>>(right_sides()));
  check_lanes<4>(solved, 32, matrices(), moving<dual<double>>(right_sides()));
  check_lanes<4>(solved, 64, moving<duet::taylor<double, 3>>(matrices()),
                 moving<duet::taylor<double, 3>>(right_sides()));
  const Eigen::MatrixXd dynamic = matrices().back();
  check_lanes<4>(solved, 8, std::vector<Eigen::MatrixXd>{dynamic, dynamic.transpose()},
                 std::vector<Eigen::VectorXd>{right_sides()[0], right_sides()[4]});
}

TEST_CASE("solve over batches: one singular or not finite lane throws invalid_input") {
  using B = batch<double, 4>;
  const auto with = [](double x) {
    Eigen::Matrix<B, 2, 2> a;
    a << B(1), B(2), B(2), B(3);
    a(1, 1).set(2, x);
    return a;
  };
  CHECK(message_of(with(5)) == "");
  CHECK(message_of(with(4)).find("A is singular: pivot 2 of 2") != std::string::npos);
  CHECK(message_of(with(std::numeric_limits<double>::infinity())).find("is not finite") !=
        std::string::npos);
}

TEST_CASE("drivers over batches: derivatives, gradients, Hessians and Jacobians equal those of the "
          "lanes") {
  const std::vector<vector> points = right_sides();
  const auto f = [](const auto& x) {
    using std::exp, std::sin;
    const auto smallest = duet::select(
        duet::innermost(x[0]) < duet::innermost(x[1]), [&] { return x[0]; }, [&] { return x[1]; });
    return typename std::decay_t<decltype(x)>::Scalar(sin(x[0]) * exp(x[1]) * smallest +
                                                      x[2] * x[2] * x[0]);
  };
  const auto g = [](const auto& x) {
    using std::sin;
    return std::decay_t<decltype(x)>(x[0] * x[1], sin(x[2]), x[2] * x[2] - x[0]);
  };
  check_lanes<4>([&](const auto& x) { return duet::gradient(f, x).gradient; }, 4, points);
  check_lanes<4>([&](const auto& x) { return duet::hessian(f, x).hessian; }, 8, points);
  check_lanes<4>([&](const auto& x) { return duet::jacobian(g, x).jacobian; }, 4, points);
  check_lanes<4>(
      [](const auto& x) {
        return duet::derivative([](const auto& t) { return t * t * t; }, x).derivative;
      },
      4, std::vector<double>{0, 1, -2, 1e-9, 3});
}

} // namespace
} // namespace test_derivative_batch
