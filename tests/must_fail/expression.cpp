// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Mistakes that must not compile, see check.cmake.

#include <duet/expression/elementary_functions.hpp>
#include <duet/expression/functions_of_many.hpp>
#include <duet/expression/gradient.hpp>
#include <duet/expression/jacobian.hpp>
#include <duet/expression/matrix.hpp>
#include <duet/expression/motion.hpp>
#include <duet/expression/rotation.hpp>
#include <duet/expression/special_functions.hpp>
#include <duet/expression/symbol.hpp>
#include <duet/expression/text.hpp>

#include <cmath>
#include <iostream>
#include <string>

using namespace duet::expression;
constexpr symbol<"u"> u;
constexpr vector_symbol<"w"> w;
constexpr matrix_symbol<"A", 2, 4> A;
constexpr matrix_symbol<"B", 4, 2> B;
const Eigen::Vector3d w0(1, 2, 3);
const auto f = sin(u) * norm(w);

//// derivative_by_no_symbol
// expect: duet: (derivative\(f, u\) is by one|wrt\(u, w\) takes|by which) symbol
// within: 2
// forms: 7

int main() {
#if DUET_MUST_FAIL == 1
  std::cout << derivative(f, sin(u))(u = 0.3, w = w0) << "\n";
#elif DUET_MUST_FAIL == 2
  const auto g = derivative(f, 0.3);
#elif DUET_MUST_FAIL == 3
  const auto g = derivative(f);
#elif DUET_MUST_FAIL == 4
  const auto g = gradient(f, wrt(sin(u)));
#elif DUET_MUST_FAIL == 5
  std::cout << gradient(f, u)(u = 0.3, w = w0).gradient << "\n";
#elif DUET_MUST_FAIL == 6
  const auto [y, g, h] = hessian(f, u, w)(u = 0.3, w = w0);
#elif DUET_MUST_FAIL == 7
  const auto j = jacobian(u * w, u);
#else
  std::cout << derivative(f, u)(u = 0.3, w = w0)
            << jacobian(u * w, wrt(u))(u = 0.3, w = w0).jacobian;
#endif
}

//// derivative_by_vector
// expect: duet: derivative\(f, u\) is by a scalar symbol
// within: 2
// forms: 2

int main() {
#if DUET_MUST_FAIL == 1
  static_cast<void>(derivative(f, w));
#elif DUET_MUST_FAIL == 2
  std::cout << derivative(f, w)(u = 0.3, w = w0) << "\n";
#else
  std::cout << derivative(f, u)(u = 0.3, w = w0) << gradient(f, wrt(w))(u = 0.3, w = w0).value;
#endif
}

//// dot_of_sizes
// expect: duet: dot\(A, B\) takes two vectors or matrices of one size

int main() {
#ifdef DUET_MUST_FAIL
  static_cast<void>(dot(A, B));
#else
  static_cast<void>(dot(A, transpose(B)));
#endif
}

//// doubled_argument
// expect: duet: two values are given for one symbol
// within: 2
// forms: 3

int main() {
#if DUET_MUST_FAIL == 1
  static_cast<void>(f(u = 0.3, w = w0, u = 0.4));
#elif DUET_MUST_FAIL == 2
  const double y = f(u = 0.3, w = w0, u = 0.4);
#elif DUET_MUST_FAIL == 3
  const auto [y, g] = gradient(f, wrt(u))(u = 0.3, w = w0, u = 0.4);
#else
  std::cout << f(u = 0.3, w = w0) << gradient(f, wrt(u))(u = 0.3, w = w0).gradient << "\n";
#endif
}

//// entries_missing
// expect: duet: matrix<2, 4>\(...\) takes its 8 entries, row by row

int main() {
#ifdef DUET_MUST_FAIL
  static_cast<void>(matrix<2, 2>(u, u, 1.0));
#else
  static_cast<void>(matrix<2, 2>(u, u, 1.0, 0.5));
#endif
}

//// entry_outside
// expect: duet: an entry or a block that is not in the matrix

int main() {
#ifdef DUET_MUST_FAIL
  static_cast<void>(entry<2, 0>(A));
#else
  static_cast<void>(entry<1, 3>(A));
#endif
}

//// gradient_of_vector
// expect: duet: a (gradient|Hessian) is that of a scalar formula
// within: 2
// forms: 3

int main() {
#if DUET_MUST_FAIL == 1
  static_cast<void>(gradient(u * w, wrt(u)));
#elif DUET_MUST_FAIL == 2
  std::cout << gradient(u * w, wrt(u))(u = 0.3, w = w0).gradient << "\n";
#elif DUET_MUST_FAIL == 3
  const auto h = hessian(u * w, wrt(u));
#else
  std::cout << f(u = 0.3, w = w0) << gradient(f, wrt(u))(u = 0.3, w = w0).gradient << "\n";
#endif
}

//// inverse_of_rectangle
// expect: duet: trace, determinant, adjugate, inverse and solve take a square matrix

int main() {
#ifdef DUET_MUST_FAIL
  static_cast<void>(inverse(A));
#else
  static_cast<void>(inverse(A * B));
#endif
}

//// jacobian_without_frame
// expect: duet: with rotations and poses say the frame

int main() {
#ifdef DUET_MUST_FAIL
  static_cast<void>(jacobian(exp(u * w), wrt(u)));
#else
  static_cast<void>(jacobian(exp(u * w), wrt(u), duet::frame::body));
#endif
}

//// latex_of_gradient
// expect: duet: gradients, Hessians, Jacobians and motions
// within: 2
// forms: 2

int main() {
#if DUET_MUST_FAIL == 1
  std::cout << to_latex(gradient(f, wrt(w))) << "\n";
#elif DUET_MUST_FAIL == 2
  const std::string text = to_text(hessian(f, wrt(u)));
#else
  std::cout << to_latex(derivative(f, u)) << "\n";
#endif
}

//// matrix_of_unknown_size
// expect: duet: a matrix in a formula has 1 to 6 rows and columns, known to the compiler

int main() {
  const Eigen::Matrix<double, 4, 2> B0 = Eigen::Matrix<double, 4, 2>::Ones();
#ifdef DUET_MUST_FAIL
  static_cast<void>(A * Eigen::MatrixXd(B0));
#else
  static_cast<void>(A * B0);
#endif
}

//// missing_argument
// expect: duet: a symbol of the formula has no value; say f\(u = 0.3, ...\) with all of them
// within: 2
// forms: 6

int main() {
#if DUET_MUST_FAIL == 1
  static_cast<void>(f(u = 0.3));
#elif DUET_MUST_FAIL == 2
  std::cout << f(u = 0.3) << "\n";
#elif DUET_MUST_FAIL == 3
  const double y = f();
#elif DUET_MUST_FAIL == 4
  const auto [y, g] = gradient(f, wrt(u))(u = 0.3);
#elif DUET_MUST_FAIL == 5
  std::cout << hessian(f, wrt(w))(w = w0).hessian << "\n";
#elif DUET_MUST_FAIL == 6
  const Eigen::MatrixXd j = jacobian(u * w, wrt(u))(w = w0).jacobian;
#else
  std::cout << f(u = 0.3, w = w0) << gradient(f, wrt(u))(u = 0.3, w = w0).gradient << "\n";
#endif
}

//// motion_without_frame
// expect: duet: the frame is missing
// within: 2
// forms: 2

int main() {
#if DUET_MUST_FAIL == 1
  const auto m = motion(exp(u * w), u);
#elif DUET_MUST_FAIL == 2
  std::cout << motion(exp(u * w), u)(u = 0.3, w = w0).velocity << "\n";
#else
  std::cout << motion(exp(u * w), u, duet::frame::body)(u = 0.3, w = w0).velocity << "\n";
#endif
}

//// positional_argument
// expect: duet: formulas are called by name
// within: 2
// forms: 3

int main() {
#if DUET_MUST_FAIL == 1
  static_cast<void>(f(0.3, w0));
#elif DUET_MUST_FAIL == 2
  std::cout << f(0.3, w0) << "\n";
#elif DUET_MUST_FAIL == 3
  const auto [y, g] = gradient(f, wrt(u))(0.3, w0);
#else
  std::cout << f(u = 0.3, w = w0) << gradient(f, wrt(u))(u = 0.3, w = w0).gradient << "\n";
#endif
}

//// product_of_sizes
// expect: duet: a product of matrices of sizes that do not fit

int main() {
#ifdef DUET_MUST_FAIL
  static_cast<void>(A * A);
#else
  static_cast<void>(A * B);
#endif
}

//// product_of_vectors
// expect: duet: a product is of scalars

int main() {
#ifdef DUET_MUST_FAIL
  static_cast<void>(w * cross(w, w0));
#else
  static_cast<void>(dot(w, cross(w, w0)));
#endif
}

//// standard_function
// expect: duet: std::[a-z_0-9]* does not accept numbers with derivatives or formulas
// within: 2
// forms: 5

int main() {
#if DUET_MUST_FAIL == 1
  const auto g = std::sin(u);
#elif DUET_MUST_FAIL == 2
  std::cout << to_text(std::sin(u) * u) << "\n";
#elif DUET_MUST_FAIL == 3
  std::cout << to_text(std::pow(u, 2)) << "\n";
#elif DUET_MUST_FAIL == 4
  const auto g = std::atan2(u, 2 * u);
#elif DUET_MUST_FAIL == 5
  const auto g = std::cyl_bessel_j(0, u);
#else
  using std::sin;
  std::cout << to_text(sin(u) * pow(u, 2) * atan2(u, 2 * u)) << "\n";
#endif
}

//// sum_of_kinds
// expect: duet: a sum of formulas of different kinds

int main() {
#ifdef DUET_MUST_FAIL
  static_cast<void>(u + w);
#else
  static_cast<void>(u + norm(w));
#endif
}

//// sum_of_sizes
// expect: duet: a sum of formulas of different kinds or sizes

int main() {
#ifdef DUET_MUST_FAIL
  static_cast<void>(A + B);
#else
  static_cast<void>(A + transpose(B));
#endif
}

//// unknown_argument
// expect: duet: a value is given for a symbol that the formula does not have
// within: 2
// forms: 3

int main() {
#if DUET_MUST_FAIL == 1
  static_cast<void>(f(u = 0.3, w = w0, symbol<"x">{} = 1.0));
#elif DUET_MUST_FAIL == 2
  std::cout << sin(u)(u = 0.3, w = w0) << "\n";
#elif DUET_MUST_FAIL == 3
  std::cout << gradient(sin(u), wrt(u))(u = 0.3, w = w0).gradient << "\n";
#else
  std::cout << f(u = 0.3, w = w0) << gradient(f, wrt(u))(u = 0.3, w = w0).gradient << "\n";
#endif
}

//// wrong_kind_of_argument
// expect: duet: a symbol is given a value of another kind
// within: 2
// forms: 2

int main() {
#if DUET_MUST_FAIL == 1
  static_cast<void>(f(u = w0, w = w0));
#elif DUET_MUST_FAIL == 2
  std::cout << f(u = 0.3, w = 0.4) << "\n";
#else
  std::cout << f(u = 0.3, w = w0) << gradient(f, wrt(u))(u = 0.3, w = w0).gradient << "\n";
#endif
}

//// wrong_size_of_argument
// expect: duet: a matrix symbol is given a value of another size

int main() {
  const Eigen::Matrix<double, 2, 4> A0 = Eigen::Matrix<double, 2, 4>::Ones();
  const Eigen::Matrix<double, 4, 2> B0 = A0.transpose();
#ifdef DUET_MUST_FAIL
  static_cast<void>(trace(A * transpose(A))(A = B0));
#else
  static_cast<void>(trace(A * transpose(A))(A = A0));
#endif
}
