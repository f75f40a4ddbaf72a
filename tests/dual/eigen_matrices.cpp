// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/dual/eigen_traits.hpp>

#include <Eigen/LU>

#include <iomanip>

namespace test_dual_eigen_matrices {
namespace {

using duet::dual, duet::screw_tag, duet::taylor, Eigen::Dynamic;

template <class D, int Rows, int Columns>
using matrix = Eigen::Matrix<D, Rows, Columns>;

/// The slope of every entry.
template <class M>
auto slopes(const M& m) {
  return m.unaryExpr([](const auto& x) { return x.partial(0); }).eval();
}
template <class M>
auto values(const M& m) {
  return m.unaryExpr([](const auto& x) { return x.value(); }).eval();
}

TEST_CASE_TEMPLATE("Eigen over dual: mixed products with double", D, dual<double>,
                   dual<double, 3>) {
  const Eigen::Matrix3d a = (Eigen::Matrix3d() << 1, 2, 3, 4, 5, 6, 7, 8, 10).finished();
  const Eigen::Vector3d u(1, -2, 0.5);
  const auto t = D::variable(2);
  const matrix<D, 3, 1> x(t, t * t, 1);
  const Eigen::Vector3d x_value(2, 4, 1);
  const Eigen::Vector3d x_slope(1, 4, 0);

  const matrix<D, 3, 1> y = a * x;
  CHECK(values(y) == a * x_value);
  CHECK(slopes(y) == a * x_slope);
  CHECK(slopes((x.transpose() * a).eval()) == x_slope.transpose() * a);
  CHECK(slopes((x * u.transpose()).eval()) == x_slope * u.transpose());
  CHECK(slopes((u * x.transpose()).eval()) == u * x_slope.transpose());
  CHECK(slopes((x + u).eval()) == x_slope);
  CHECK(slopes((u - x).eval()) == -x_slope);
  CHECK(slopes((2 * x + x / 2 - x * 0.5F).eval()) == 2 * x_slope);
  CHECK(slopes((t * u).eval()) == u);
  CHECK(slopes((u * t).eval()) == u);
  CHECK(slopes((a * t).eval()) == a);
  CHECK(slopes((u / t).eval()) == -u / 4);
  CHECK(x.dot(u).partial(0) == x_slope.dot(u));
  CHECK(u.dot(x).partial(0) == x_slope.dot(u));
  CHECK(slopes(x.cwiseProduct(u).eval()) == x_slope.cwiseProduct(u));

  matrix<D, 3, 1> z = x;
  z += u;
  z -= x;
  CHECK(values(z) == u);
  CHECK(slopes(z) == Eigen::Vector3d::Zero());
  z.noalias() = a * x;
  z.noalias() += a * x;
  CHECK(slopes(z) == 2 * a * x_slope);
  z *= 2;
  z /= t;
  CHECK(slopes(z) == ((2 * 2 * a * x_slope) * 2 - (2 * 2 * a * x_value)) / 4);
  const Eigen::Vector3d back = values(z);
  CHECK(back == 2 * a * x_value);
}

TEST_CASE("Eigen over dual: mixed products of dynamic size, larger than Eigen's blocks") {
  using D = dual<double>;
  for (const int n : {2, 9, 33}) {
    const Eigen::MatrixXd a = Eigen::MatrixXd::NullaryExpr(
        n, n, [](Eigen::Index i, Eigen::Index j) { return double((3 * i + 5 * j) % 7 - 3); });
    const Eigen::MatrixXd b = a.transpose().array() + 1;
    matrix<D, Dynamic, Dynamic> c(n, n);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        c(i, j) = D(a(i, j), b(i, j));
      }
    }
    CHECK(values((a * c).eval()) == a * a);
    CHECK(slopes((a * c).eval()) == a * b);
    CHECK(slopes((c * a).eval()) == b * a);
    CHECK(slopes((c * c).eval()) == a * b + b * a);
    CHECK(slopes((c * a.col(0)).eval()) == b * a.col(0));
    CHECK(slopes((c.transpose() * c).eval()) == b.transpose() * a + a.transpose() * b);
    CHECK(c.trace().epsilon() == b.trace());
    CHECK(c.squaredNorm().epsilon() == 2 * a.cwiseProduct(b).sum());
  }
}

TEST_CASE("Eigen over dual: scalars of different nestings meet in matrices") {
  using derivative_dual = dual<double>;
  using screw = dual<double, 1, screw_tag>;
  const matrix<derivative_dual, 2, 2> a =
      matrix<derivative_dual, 2, 2>::Constant(derivative_dual(2, 1));
  const matrix<screw, 2, 1> b = matrix<screw, 2, 1>::Constant(screw(3, 5));
  const auto c = (a * b).eval();
  static_assert(std::is_same_v<std::remove_const_t<decltype(c)>,
                               matrix<dual<derivative_dual, 1, screw_tag>, 2, 1>>);
  CHECK(c(0).value().value() == 12);
  CHECK(c(0).value().epsilon() == 6);
  CHECK(c(0).epsilon().value() == 20);
  CHECK(c(0).epsilon().epsilon() == 10);
}

TEST_CASE("Eigen over dual: unaryExpr accepts lambdas with two returns and with literals") {
  using D = dual<double>;
  const matrix<D, 2, 1> x(D(3, 1), D(-3, 1));
  const auto squares = x.unaryExpr([](const D& e) { return e > 0 ? e * e : 0.0; }).eval();
  CHECK(squares(0).epsilon() == 6);
  CHECK(squares(1).epsilon() == 0);
  const auto huber = [](const D& e) {
    if (e > 1) {
      return 2 * e - 1;
    }
    return e * e;
  };
  CHECK(slopes(x.unaryExpr(huber).eval()) == Eigen::Vector2d(2, -6));
  CHECK(slopes(x.unaryExpr([](const D& e) { return sin(e); }).eval())(0) == std::cos(3.0));
  const Eigen::Vector2d u(1, 2);
  const auto scaled = x.binaryExpr(u, [](const D& e, double d) { return e * d; }).eval();
  CHECK(slopes(scaled) == Eigen::Vector2d(1, 2));
}

TEST_CASE("Eigen over dual: reductions, norms and coefficient-wise functions") {
  using D = dual<double, 2>;
  const matrix<D, 2, 1> x(D::variable(3, 0), D::variable(4, 1));
  CHECK(x.norm() == 5);
  CHECK(x.norm().partial(0) == doctest::Approx(0.6).epsilon(1e-15));
  CHECK(x.stableNorm().partial(1) == doctest::Approx(0.8));
  CHECK(x.normalized()(0).partial(0) == doctest::Approx(16.0 / 125));
  CHECK(x.normalized()(0).partial(1) == doctest::Approx(-12.0 / 125));
  CHECK(x.maxCoeff().partial(1) == 1);
  CHECK(x.cwiseAbs().sum().partial(0) == 1);
  CHECK((-x).cwiseAbs().sum().partial(0) == 1);
  CHECK(x.prod().partial(0) == 4);
  CHECK(x.array().square().sum().partial(1) == 8);
  CHECK(x.array().sqrt()(1).partial(1) == 0.25);
  CHECK(x.array().exp()(0).partial(0) == std::exp(3.0));
  CHECK(x.array().pow(2)(0).partial(0) == 6);
  CHECK(x.array().inverse()(1).partial(1) == -1.0 / 16);
  CHECK((x.array() > 3).count() == 1);
  const auto larger = (x.array() > 3).select(x.array() * 2, -x.array()).eval();
  CHECK(larger(0).partial(0) == -1);
  CHECK(larger(1).partial(1) == 2);
  CHECK((x.array() > 3).select(x, D(7)).eval()(0) == 7);
  CHECK(x.cwiseMin(matrix<D, 2, 1>::Constant(3.5))(1).partial(1) == 0);
  CHECK(x.allFinite());
  CHECK(x.isApprox(x));
  const Eigen::Matrix<D, 2, 2> m = (Eigen::Matrix<D, 2, 2>() << x(0), 1, 2, x(1)).finished();
  CHECK(m.determinant() == 10);
  CHECK(m.determinant().partial(0) == 4);
  CHECK(m.inverse()(0, 0).partial(0) == doctest::Approx(-16.0 / 100));
}

TEST_CASE("Eigen over dual: matrices are printed in columns") {
  const Eigen::Matrix<dual<double>, 2, 2> m =
      (Eigen::Matrix<dual<double>, 2, 2>() << dual<double>(1, 2), 10, 0.5, dual<double>(3, -1))
          .finished();
  std::ostringstream out;
  out << m;
  CHECK(out.str() == "  1[2]  10[0]\n0.5[0]  3[-1]");
  std::ostringstream series;
  series << Eigen::Matrix<taylor<double, 2>, 1, 2>(taylor<double, 2>::variable(1), 2);
  CHECK(series.str() == "(1 + 1 e + 0 e^2) (2 + 0 e + 0 e^2)");
}

} // namespace
} // namespace test_dual_eigen_matrices
