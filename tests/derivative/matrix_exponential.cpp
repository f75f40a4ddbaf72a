// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/differences.hpp"
#include "support/message.hpp"
#include "support/test.hpp"

#include <duet/core/batch/batch.hpp>
#include <duet/derivative/matrix_exponential.hpp>
#include <duet/dual/complex.hpp>
#include <duet/interop/multiprecision.hpp>

#include <complex>

// exp A: values and derivatives against the series in 100 digits and closed forms.

namespace test_derivative_matrix_exponential {
namespace {

using duet::dual, duet::matrix_exponential, duet_test::real_100, Eigen::Matrix2d, Eigen::Matrix3d,
    Eigen::MatrixXd;

/// exp A = (1 + B + … + B³⁰/30!)^(2⁶⁰), B = A/2⁶⁰; over Taylor numbers duet's.
template <class T>
Eigen::Matrix<T, 3, 3> exponential(const Eigen::Matrix<T, 3, 3>& a) {
  if constexpr (std::is_same_v<T, real_100>) {
    const Eigen::Matrix<T, 3, 3> b = a / ldexp(real_100(1), 60);
    Eigen::Matrix<T, 3, 3> e = Eigen::Matrix<T, 3, 3>::Identity();
    for (int k = 12; k > 0; --k) {
      e = (Eigen::Matrix<T, 3, 3>::Identity() + b.lazyProduct(e) / T(k)).eval();
    }
    for (int k = 0; k < 60; ++k) {
      e = e.lazyProduct(e).eval();
    }
    return e;
  } else {
    return matrix_exponential(a);
  }
}

double error_at(const Matrix3d& value, double size) {
  const Matrix3d rate{{1, 2, -1}, {3, 0, 2}, {-.5, -3, -2}};
  return duet_test::error_to_third_order([&](const auto& t) {
    using T = std::decay_t<decltype(t)>;
    Eigen::Matrix<T, 3, 3> a;
    for (int i = 0; i < 9; ++i) {
      a(i) = value(i) + rate(i) * t + rate(8 - i) * t * t;
    }
    return Eigen::Matrix<T, 3, 3>(exponential(a) / T(size));
  });
}

template <class A>
std::string message(const A& a) {
  return duet_test::message_of([&] { static_cast<void>(matrix_exponential(a)); });
}

TEST_CASE(
    "matrix_exponential: derivatives to third order at 0, nilpotent, diagonal and dense matrices") {
  const Matrix3d zero = Matrix3d::Zero(), one = Matrix3d::Identity();
  const Matrix3d nilpotent{{0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
  const Matrix3d diagonal = Eigen::Vector3d(3, 1, 2).asDiagonal();
  const Matrix3d dense{{4, 1, .5}, {-.5, 3, .25}, {.75, .5, 2}};
  CHECK(error_at(zero, 1) <= 1e-14);
  CHECK(error_at(one, 1) <= 2e-14);
  CHECK(error_at(diagonal, 20) <= 1e-14);
  CHECK(error_at(one + nilpotent, 1) <= 2e-14);
  CHECK(error_at(nilpotent, 1) <= 1e-14);
  CHECK(error_at(dense, 50) <= 2e-14);
  CHECK(error_at(-40 * one, std::exp(-40)) <= 1e-13);
}

TEST_CASE("matrix_exponential: large norms and matrices far from normal keep their digits") {
  const Matrix3d cross{{0, -30, 20}, {30, 0, -10}, {-20, 10, 0}};
  CHECK(error_at(cross, 1) <= 1e-13);
  const Matrix3d triangular{{1, 1e6, 0}, {0, -1, 3}, {0, 0, .5}};
  CHECK(error_at(triangular, 1e6) <= 1e-13);
  const Matrix2d a = matrix_exponential(Matrix2d{{1, 1e9}, {0, -1}});
  CHECK(a(0, 0) == doctest::Approx(std::exp(1.)).epsilon(1e-14));
  CHECK(a(0, 1) == doctest::Approx(1e9 * std::sinh(1.)).epsilon(1e-14));
  CHECK(a(1, 1) == doctest::Approx(std::exp(-1.)).epsilon(1e-14));
  CHECK(matrix_exponential(Matrix2d{{0, 1e300}, {0, 0}}) == Matrix2d{{1, 1e300}, {0, 1}});
  CHECK(matrix_exponential(Matrix2d{{0, 0}, {5e-324, 0}}) == Matrix2d{{1, 0}, {5e-324, 1}});
  CHECK(matrix_exponential(Matrix2d{{-1e9, 0}, {0, 0}}) == Matrix2d{{0, 0}, {0, 1}});
}

TEST_CASE("matrix_exponential: nested duals, complex numbers, batches, 50 digits and integers") {
  struct outer;
  using D = dual<dual<double>, 1, outer>;
  Eigen::Matrix<D, 2, 2> a = Eigen::Matrix<D, 2, 2>::Zero();
  a(0, 1) = D(dual<double>(0), dual<double>(1));
  a(1, 0) = D(dual<double>(0, 1), dual<double>(0));
  // exp [[0, x], [y, 0]]: cosh √(xy) = 1 + xy/2 + …, x (1 + xy/6 + …)
  CHECK(matrix_exponential(a)(0, 0).epsilon().epsilon() == .5);
  CHECK(matrix_exponential(a)(0, 1).epsilon().value() == 1);
  CHECK(matrix_exponential(a)(0, 1).epsilon().epsilon() == 0);
  using C = dual<std::complex<double>>;
  Eigen::Matrix<C, 2, 2> c = Eigen::Matrix<C, 2, 2>::Zero();
  c(0, 0) = C(std::complex<double>(0, 1), 1);
  CHECK(std::abs(matrix_exponential(c)(0, 0).value() - std::exp(std::complex<double>(0, 1))) <=
        1e-15);
  CHECK(std::abs(matrix_exponential(c)(0, 0).epsilon() - std::exp(std::complex<double>(0, 1))) <=
        1e-15);
  using batch = duet::batch<double, 2>;
  Eigen::Matrix<dual<batch>, 1, 1> b;
  b(0, 0) = dual<batch>(batch::from_lanes([](int i) { return i == 0 ? 1. : 3.; }),
                        batch::from_lanes([](int i) { return i == 0 ? 2. : 5.; }));
  const auto e = matrix_exponential(b)(0, 0);
  CHECK(e.epsilon()[0] == doctest::Approx(2 * std::exp(1.)).epsilon(1e-15));
  CHECK(e.epsilon()[1] == doctest::Approx(5 * std::exp(3.)).epsilon(1e-15));
  using R = duet::real_50;
  const Eigen::Matrix<R, 1, 1> x(R(3));
  CHECK(abs(R(matrix_exponential(x)(0, 0) - exp(R(3)))) <= R(1e-48));
  CHECK(matrix_exponential(Eigen::Matrix2i{{0, 1}, {0, 0}}) == Matrix2d{{1, 1}, {0, 1}});
}

TEST_CASE("matrix_exponential: invalid matrices and overflow throw invalid_input") {
  CHECK(message(MatrixXd(2, 3)) == "duet: matrix_exponential: A is 2 x 3, but must be square");
  CHECK(message(MatrixXd(0, 0)) == "duet: matrix_exponential: A is empty");
  CHECK(message(Matrix2d{{800, 0}, {0, 1}}) == "duet: matrix_exponential: exp(A) overflows");
  CHECK(message(Matrix2d{{-1e20, 0}, {0, -1}}) ==
        "duet: matrix_exponential: entries of A up to 1e+20 leave no digit of exp(A)");
  CHECK(message(Matrix2d{{0, 0}, {0, std::numeric_limits<double>::infinity()}}) ==
        "duet: matrix_exponential: entry (1, 1) of A is not finite");
}

} // namespace
} // namespace test_derivative_matrix_exponential
