// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/eigen_problems.hpp"
#include "support/test.hpp"

#include <Eigen/QR>

namespace test_dual_eigen_reflectors {
namespace {

using duet::dual, duet_test::check_solution, duet_test::problems, duet_test::seeded, Eigen::Dynamic,
    Eigen::MatrixXd;

using dual_matrix = Eigen::Matrix<dual<double>, Dynamic, Dynamic>;

MatrixXd values(const dual_matrix& m) {
  return m.unaryExpr([](const auto& x) { return x.value(); });
}
MatrixXd slopes(const dual_matrix& m) {
  return m.unaryExpr([](const auto& x) { return x.epsilon(); });
}

template <class QR>
void check_factors(const QR& qr, const dual_matrix& a) {
  const dual_matrix q = qr.householderQ();
  const dual_matrix r = qr.matrixQR().template triangularView<Eigen::Upper>();
  const dual_matrix product = q * r;
  const dual_matrix identity = q.transpose() * q;
  const double tolerance = 1e-13 * (1 + values(a).norm() + slopes(a).norm());
  CHECK((values(product) - values(a)).norm() <= tolerance);
  CHECK((slopes(product) - slopes(a)).norm() <= tolerance);
  CHECK((values(identity) - MatrixXd::Identity(a.rows(), a.rows())).norm() <= tolerance);
  CHECK(slopes(identity).norm() <= tolerance);
}

// Among them matrices whose columns are zero below the diagonal, but their derivatives are not; and
// one larger than the blocks that Eigen puts reflectors together in.
TEST_CASE("Eigen over dual: Q R = A and QᵀQ = 1 hold with their derivatives") {
  for (const int n : {2, 3, 12}) {
    for (const auto& p : problems(n)) {
      CAPTURE(p.name);
      const auto a = seeded<dual<double>, Dynamic, Dynamic>(p.a, p.a_slope);
      check_factors(Eigen::HouseholderQR<dual_matrix>(a), a);
      const Eigen::ColPivHouseholderQR<dual_matrix> pivoting(a);
      check_factors(pivoting, a * pivoting.colsPermutation());
    }
  }
  const auto p = duet_test::random_problem(50, false);
  const auto large = seeded<dual<double>, Dynamic, Dynamic>(
      MatrixXd(p.a.triangularView<Eigen::Upper>()), p.a_slope);
  check_factors(Eigen::HouseholderQR<dual_matrix>(large), large);
}

TEST_CASE("Eigen over dual: R has the closed form if a column's tail is zero but its derivatives "
          "are not") {
  using column = Eigen::Matrix<dual<double>, 3, 1>;
  using D = dual<double>;
  const column u(D(2, 0.5), D(0, 3), D(0, -1));
  const column v(D(1, 0.25), D(4, 1), D(0.5, 2));
  for (const double scale : {1.0, -1.0, 1e-160, -1e160}) {
    Eigen::Matrix<D, 3, 2> a;
    a << scale * u, v;
    // r₀₀ = −scale ‖u‖, r₀₁ = scale u·v / r₀₀
    const auto r = a.householderQr().matrixQR();
    CHECK(r(0, 0).value() == -scale * 2);
    CHECK(r(0, 0).epsilon() == -scale * 0.5);
    CHECK(-r(0, 1).value() == doctest::Approx(1).epsilon(1e-15));
    // (u'·v + u·v') / ‖u‖ − u·v ‖u‖' / ‖u‖²
    CHECK(-r(0, 1).epsilon() ==
          doctest::Approx((0.5 + 12 - 0.5 + 0.5) / 2 - 2 * 0.5 / 4).epsilon(1e-15));
  }
}

TEST_CASE("Eigen over dual: HouseholderQR has the values that it has over double") {
  for (const int n : {2, 3, 12}) {
    const auto p = duet_test::random_problem(n, false);
    const auto a = seeded<dual<double>, Dynamic, Dynamic>(p.a, p.a_slope);
    const MatrixXd expected = p.a.householderQr().matrixQR();
    CHECK((values(a.householderQr().matrixQR()) - expected).norm() <= 1e-14 * expected.norm());
    // A matrix that stays triangular needs no reflectors.
    const MatrixXd upper = p.a.triangularView<Eigen::Upper>();
    const auto dual_upper = seeded<dual<double>, Dynamic, Dynamic>(upper, MatrixXd::Zero(n, n));
    CHECK(values(dual_upper.householderQr().matrixQR()) == upper);
    CHECK(dual_upper.householderQr().hCoeffs().isZero(0));
  }
}

TEST_CASE("Eigen over dual: QR of fixed sizes with several partials and right-hand sides") {
  for (const auto& p : problems(2)) {
    CAPTURE(p.name);
    const auto a = seeded<dual<double, 3>, 2, 2>(p.a, p.a_slope, 3);
    const auto b = seeded<dual<double, 3>, 2, 1>(p.b, p.b_slope, 3);
    const Eigen::Matrix<dual<double, 3>, 2, 2> columns = b.replicate(1, 2);
    check_solution(a.householderQr().solve(columns).col(1).eval(), p, 3);
  }
}

} // namespace
} // namespace test_dual_eigen_reflectors
