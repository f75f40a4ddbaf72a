// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/gap.hpp"
#include "support/multiprecision.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>

#include <Eigen/LU>

namespace test_expression_matrices {
namespace {

using namespace duet::expression;
using duet_test::max_abs_difference;
using matrix2 = Eigen::Matrix2d;
using matrix3 = Eigen::Matrix3d;
using matrix4 = Eigen::Matrix4d;
using matrix6 = Eigen::Matrix<double, 6, 6>;
using matrix23 = Eigen::Matrix<double, 2, 3>;

constexpr symbol<"u"> u;
constexpr vector_symbol<"w"> w;
constexpr quaternion_symbol<"q"> q;
constexpr matrix_symbol<"A", 2, 2> A;
constexpr matrix_symbol<"B", 2, 2> B;
constexpr matrix_symbol<"C", 2, 3> C;
constexpr matrix_symbol<"R_1", 3, 3> R;
constexpr matrix_symbol<"x", 4, 1> x;

template <class A, class B>
bool have_same_text(const A& a, const B& b) {
  return to_text(a) == to_text(b);
}

double distance(double a, double b) { return std::abs(a - b); }
template <class A, class B>
double distance(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  return max_abs_difference(a, b);
}

/// A matrix that is as good as any, and regular.
template <int Rows, int Columns>
Eigen::Matrix<double, Rows, Columns> some_matrix(double seed) {
  Eigen::Matrix<double, Rows, Columns> m;
  for (int i = 0; i < Rows; ++i) {
    for (int j = 0; j < Columns; ++j) {
      m(i, j) = std::sin(seed + 3 * i + 7 * j + i * j) + (i == j ? 2 : 0);
    }
  }
  return m;
}

/// The derivative of a formula of u against dual numbers, of one tag for all formulas, so that
/// Eigen's templates are compiled for one kind of dual number.
template <class F>
void check_by_u(const char* label, const F& f, double tolerance = 2e-14) {
  CAPTURE(label);
  const auto expected = duet::derivative<struct by_u>([&](auto t) { return f(u = t); }, 0.7);
  CHECK(distance(f(u = 0.7), expected.value) < tolerance);
  CHECK(distance(derivative(f, u)(u = 0.7), expected.derivative) < tolerance);
}

TEST_CASE("matrix operations: expression derivatives are dual derivatives") {
  const auto M = some_matrix<4, 4>(0.3) + sin(u) * some_matrix<4, 4>(1);
  const auto N = some_matrix<2, 4>(2) * exp(-u);
  const auto v = u * some_matrix<4, 1>(3) - some_matrix<4, 1>(4) / u;
  check_by_u("sums and products", N * (M - (-M * u + transpose(M)) / (1 + u)) * transpose(N));
  check_by_u("rows and columns", v * (transpose(v) * M) + transpose(v) * M * v * (v * row<1>(M)));
  check_by_u("inverse and trace", trace(M) + trace(M * inverse(M * u)) - trace(transpose(M) * u));
  check_by_u("solve", solve(M, v) + column<0>(solve(M, transpose(N))), 1e-13);
  check_by_u("determinant and adjugate", determinant(M) * adjugate(M), 1e-11);
  check_by_u("dot and norm", dot(M, M * u) / norm(M) + norm(v) * dot(v, some_matrix<4, 1>(5)),
             1e-13);
  check_by_u("parts", block<1, 0, 2, 3>(M * M) * entry<2, 1>(M) -
                          matrix<2, 3>(u, sin(u), c<0>, 1.5, entry<3>(v), exp(u)));
  check_by_u("a choice", select(u < c<1>, M, 2.0 * M));

  const auto second = derivative(determinant(M), u);
  const auto expected = duet::derivative<struct by_u>([&](auto t) { return second(u = t); }, 0.7);
  CHECK(distance(derivative(second, u)(u = 0.7), expected.derivative) < 1e-11);
}

TEST_CASE("closed forms") {
  const matrix2 A0 = some_matrix<2, 2>(0.3), B0 = some_matrix<2, 2>(1), inverse0 = A0.inverse();
  const auto path = A + u * B;
  CHECK(max_abs_difference(derivative(inverse(path), u)(u = 0.0, A = A0, B = B0),
                           -inverse0 * B0 * inverse0) < 1e-14);
  CHECK(distance(derivative(determinant(path), u)(u = 0.0, A = A0, B = B0),
                 A0.determinant() * (inverse0 * B0).trace()) < 1e-14);
  const auto along_B = directional_derivative(solve(A, C), along(A, B));
  const matrix23 C0 = some_matrix<2, 3>(2);
  CHECK(max_abs_difference(along_B(A = A0, B = B0, C = C0), -inverse0 * B0 * inverse0 * C0) <
        1e-14);
  CHECK(max_abs_difference(adjugate(A)(A = A0), A0.determinant() * inverse0) < 1e-14);

  // What has no inverse has a determinant, and derivatives of it.
  const matrix2 singular = (matrix2() << 1, 2, 2, 4).finished();
  CHECK(derivative(determinant(path), u)(u = 0.0, A = singular, B = B0) ==
        doctest::Approx(4 * B0(0, 0) + B0(1, 1) - 2 * (B0(0, 1) + B0(1, 0))));
  CHECK_THROWS_AS((void)inverse(A)(A = singular), duet::invalid_input);
  CHECK_THROWS_AS((void)solve(A, C)(A = singular, C = C0), duet::invalid_input);

  const matrix6 large = some_matrix<6, 6>(0.5);
  constexpr matrix_symbol<"L", 6, 6> L;
  CHECK(determinant(L)(L = large) == doctest::Approx(large.determinant()).epsilon(1e-13));
  CHECK(max_abs_difference((L * adjugate(L) / determinant(L))(L = large), matrix6::Identity()) <
        1e-13);
}

TEST_CASE("rotations as matrices") {
  const auto turning = q * exp(u * w) * rotation_about(duet::vector3<double>(0, 0.6, 0.8), u * u);
  const duet::vector3<double> w0(0.3, 0.7, -0.2);
  const auto q0 = duet::exp(duet::vector3<double>(-0.4, 0.1, 0.9));
  const auto at = [&](const auto& f, const auto& t) { return f(u = t, q = q0, w = w0); };
  const auto f = rotation_matrix(turning);
  const auto expected = duet::derivative<struct by_u>([&](auto t) { return at(f, t); }, 0.7);
  CHECK(max_abs_difference(at(derivative(f, u), 0.7), expected.derivative) < 2e-15);
  CHECK(max_abs_difference(at(f * w, 0.7), at(rotate(turning, w), 0.7)) < 1e-15);
  CHECK(max_abs_difference(at(transpose(f) * f, 0.7), matrix3::Identity()) < 1e-15);
  CHECK(max_abs_difference(at(skew(w) * rotate(q, w) + u * w - u * w, 0.7),
                           w0.cross(duet::rotate(q0, w0))) < 1e-16);
}

TEST_CASE("kinds of matrices, and what is known of zeros") {
  static_assert(std::is_same_v<matrix_symbol<"w", 3, 1>, vector_symbol<"w">>);
  static_assert(std::is_same_v<matrix_symbol<"u", 1, 1>, symbol<"u">>);
  static_assert(ScalarTerm<decltype(transpose(x) * x)>);
  static_assert(VectorTerm<decltype(R * w)>);

  CHECK(have_same_text(derivative(A * B * sin(u), u), cos(u) * (A * B)));
  CHECK(have_same_text(derivative(inverse(A), u), A - A));
  CHECK(have_same_text(directional_derivative(A * C, along(A, B)), B * C));
  CHECK(have_same_text(directional_derivative(A * C, along(C, C)), A * C));
  CHECK(have_same_text(transpose(transpose(A)), A));
  CHECK(have_same_text(entry<1, 0>(transpose(C * u)), u * entry<0, 1>(C)));
  CHECK(have_same_text(entry<0, 1>(matrix<2, 2>(u, u * u, 1.0, c<0>)), u * u));
  CHECK(have_same_text(block<0, 1, 1, 1>(block<1, 0, 1, 2>(C)), entry<1, 1>(C)));
}

TEST_CASE("matrices of any scalar, and constants by value") {
  using duet_test::real_50;
  matrix2 kept = some_matrix<2, 2>(1);
  const auto f = determinant(kept * u + A);
  const matrix2 before = kept;
  kept.setZero();
  const Eigen::Matrix2f single = some_matrix<2, 2>(0.3).cast<float>();
  const auto slope = derivative(f, u);
  static_assert(std::is_same_v<decltype(slope(u = 0.5F, A = single)), float>);
  const Eigen::Matrix<real_50, 2, 2> fine = some_matrix<2, 2>(0.3).cast<real_50>();
  const real_50 half = real_50(1) / 2;
  const auto precise =
      duet::derivative<struct by_u>([&](auto t) { return f(u = t, A = fine); }, half);
  CHECK(abs(slope(u = half, A = fine) - precise.derivative) < 1e-48);
  CHECK(f(u = 1.0, A = matrix2::Zero()) == doctest::Approx(before.determinant()).epsilon(1e-15));

  const auto scaled = [](double k) { return matrix2(k * matrix2::Identity()) * A; };
  CHECK_THROWS_AS((void)(scaled(1) + scaled(2)), duet::invalid_input);
}

TEST_CASE("matrices as text and as LaTeX") {
  const auto M = matrix<2, 2>(u, -u, c<0>, sin(u));
  CHECK(to_text(M * inverse(A)) == "[u, -u; 0, sin(u)] * inverse(A)");
  CHECK(to_text(derivative(inverse(M), u)) ==
        "-inverse([u, -u; 0, sin(u)]) * [1, -1; 0, cos(u)] * inverse([u, -u; 0, sin(u)])");
  CHECK(to_text(entry<0, 1>(A) + entry<3>(x)) == "A(0, 1) + x[3]");
  CHECK(to_text(block<0, 1, 2, 2>(C)) == "C(0:1, 1:2)");
  CHECK(to_text(determinant(A + B) * dot(A, B)) == "determinant(A + B) * trace(transpose(A) * B)");
  CHECK(to_text(solve(A, C)) == "solve(A, C)");
  CHECK(to_text(matrix2::Identity() * A) == "[1, 0; 0, 1] * A");

  CHECK(to_latex(M) == R"(\begin{bmatrix}u & -u\\0 & \sin(u)\end{bmatrix})");
  CHECK(to_latex(transpose(x) * x) == R"(\vec{x}^{\top} \vec{x})");
  CHECK(to_latex(transpose(inverse(A)) * solve(A + B, C)) ==
        R"(\left(A^{-1}\right)^{\top} \left(A + B\right)^{-1} C)");
  CHECK(to_latex(entry<0, 1>(R) * entry<2>(x)) == R"({R_{1}}_{1,2} \vec{x}_{3})");
  CHECK(to_latex(derivative(determinant(u * B + A), u)) ==
        R"(\operatorname{tr}\left(\operatorname{adj}(u B + A) B\right))");
  CHECK(to_latex(skew(w)) == R"(\left[\vec{w}\right]_{\times})");
}

} // namespace
} // namespace test_expression_matrices
