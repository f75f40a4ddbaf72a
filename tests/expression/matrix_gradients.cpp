// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/gap.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>

#include <Eigen/LU>

namespace test_expression_matrix_gradients {
namespace {

using namespace duet::expression;
using duet_test::max_abs_difference;
using matrix2 = Eigen::Matrix2d;
using matrix3 = Eigen::Matrix3d;

constexpr matrix_symbol<"A", 3, 3> A;
constexpr matrix_symbol<"B", 2, 2> B;
constexpr matrix_symbol<"C", 2, 3> C;
constexpr matrix_symbol<"x", 4, 1> x;
constexpr vector_symbol<"w"> w;
constexpr quaternion_symbol<"q"> q;

const matrix3 A0 = (matrix3() << 2, -1, 0.5, 0.3, 1, 4, -2, 0.7, 1.1).finished();
const matrix2 B0 = (matrix2() << 0.4, -1.2, 2, 0.9).finished();
const Eigen::Vector3d w0(0.3, -0.8, 1.7);

/// b ⊗ a, of which (b ⊗ a) vec X = vec(a X bᵀ).
template <class P, class Q>
Eigen::MatrixXd kronecker(const P& b, const Q& a) {
  Eigen::MatrixXd result(b.rows() * a.rows(), b.cols() * a.cols());
  for (Eigen::Index i = 0; i < b.rows(); ++i) {
    for (Eigen::Index j = 0; j < b.cols(); ++j) {
      result.block(i * a.rows(), j * a.cols(), a.rows(), a.cols()) = b(i, j) * a;
    }
  }
  return result;
}

TEST_CASE("gradients and Hessians by vectors and by the entries of a matrix, column by column") {
  const Eigen::Matrix4d M = Eigen::Vector4d(1, 2, 3, 4) * Eigen::RowVector4d(0.5, -1, 0, 2);
  const Eigen::Vector4d x0(0.1, -0.7, 1.3, 0.4);
  const auto form = hessian(transpose(x) * M * x, wrt(x))(x = x0);
  CHECK(form.value == doctest::Approx(x0.dot(M * x0)));
  CHECK(max_abs_difference(form.gradient, (M + M.transpose()) * x0) < 1e-14);
  CHECK(max_abs_difference(form.hessian, M + M.transpose()) == 0);

  const auto by_A = gradient(transpose(w) * A * w, wrt(w, A))(A = A0, w = w0).gradient;
  CHECK(max_abs_difference(by_A.head<3>(), (A0 + A0.transpose()) * w0) < 1e-15);
  CHECK(max_abs_difference(by_A.tail<9>(), matrix3(w0 * w0.transpose()).reshaped()) < 1e-15);

  // det A by duals, and its gradient by cofactors.
  const auto det = hessian(determinant(A), wrt(A))(A = A0);
  const auto expected = duet::hessian([](const auto& a) { return a.reshaped(3, 3).determinant(); },
                                      Eigen::Matrix<double, 9, 1>(A0.reshaped()));
  CHECK(det.value == doctest::Approx(expected.value).epsilon(1e-15));
  CHECK(max_abs_difference(det.gradient, expected.gradient) < 1e-14);
  CHECK(max_abs_difference(det.hessian, expected.hessian) < 1e-14);
  const matrix3 cofactors = A0.determinant() * A0.inverse().transpose();
  CHECK(max_abs_difference(det.gradient, cofactors.reshaped()) < 1e-14);
}

TEST_CASE("Jacobians by the entries of a matrix") {
  const matrix3 one = matrix3::Identity();
  const auto [y, J] = jacobian(A * w, wrt(A, w))(A = A0, w = w0);
  CHECK(max_abs_difference(y, A0 * w0) < 1e-15);
  CHECK(max_abs_difference(J.leftCols<9>(), kronecker(w0.transpose(), one)) == 0);
  CHECK(max_abs_difference(J.rightCols<3>(), A0) == 0);

  const matrix3 inverse0 = A0.inverse();
  CHECK(max_abs_difference(jacobian(inverse(A), wrt(A))(A = A0).jacobian,
                           -kronecker(inverse0.transpose(), inverse0)) < 1e-14);
  const auto [z, S] = jacobian(solve(A, w), wrt(A, w))(A = A0, w = w0);
  CHECK(max_abs_difference(S.leftCols<9>(), -kronecker(z.transpose(), inverse0)) < 1e-14);
  CHECK(max_abs_difference(S.rightCols<3>(), inverse0) < 1e-15);

  const Eigen::Matrix<double, 2, 3> C0 = A0.topRows<2>();
  const auto K = jacobian(B * C * A, wrt(B, C))(A = A0, B = B0, C = C0).jacobian;
  CHECK(max_abs_difference(K.leftCols<4>(),
                           kronecker((C0 * A0).transpose(), matrix2(matrix2::Identity()))) < 1e-15);
  CHECK(max_abs_difference(K.rightCols<6>(), kronecker(A0.transpose(), B0)) < 1e-15);
  const auto by_entry = jacobian(row<1>(C * A) / entry<0, 1>(B), wrt(B))(A = A0, B = B0, C = C0);
  CHECK(max_abs_difference(by_entry.jacobian.col(2), -by_entry.value.transpose() / B0(0, 1)) <
        1e-15);

  const Eigen::Matrix<double, 2, 3> last_rows = one.bottomRows<2>();
  const auto rows = jacobian(block<1, 0, 2, 3>(A * A0), wrt(A))(A = A0).jacobian;
  CHECK(max_abs_difference(rows, kronecker(A0.transpose(), last_rows)) == 0);
  const auto columns = jacobian(block<0, 1, 3, 2>(A0 * transpose(A)), wrt(A))(A = A0).jacobian;
  for (int k = 0; k < 9; ++k) { // of A0 times the transposed unit matrix
    matrix3 unit = matrix3::Zero();
    unit.data()[k] = 1;
    const Eigen::Matrix<double, 3, 2> expected = (A0 * unit.transpose()).rightCols<2>();
    CHECK(max_abs_difference(columns.col(k), expected.reshaped()) == 0);
  }

  const auto q0 = duet::exp(duet::vector3<double>(-0.4, 0.1, 0.9));
  const auto R = jacobian(rotation_matrix(q), wrt(q), duet::frame::spatial)(q = q0);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = one.col(i);
    for (int j = 0; j < 3; ++j) {
      CHECK(max_abs_difference(R.jacobian.block<3, 1>(3 * j, i), axis.cross(R.value.col(j))) <
            1e-15);
    }
  }
}

TEST_CASE("what a matrix does not depend on leaves no infinities times zero") {
  const double infinity = std::numeric_limits<double>::infinity();
  constexpr symbol<"k"> k;
  const Eigen::Vector2d e(1, 1);
  const auto J = jacobian(k * (B * e), wrt(B))(B = B0, k = infinity).jacobian;
  CHECK(J(0, 0) == infinity);
  CHECK(J(1, 0) == 0);
}

} // namespace
} // namespace test_expression_matrix_gradients
