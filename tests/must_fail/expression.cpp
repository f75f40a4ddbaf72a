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
constexpr quaternion_symbol<"q"> q;
constexpr matrix_symbol<"A", 2, 4> A;
constexpr matrix_symbol<"B", 4, 2> B;
const Eigen::Vector3d w0(1, 2, 3);
const auto f = sin(u) * norm(w);

//// derivative_by_no_symbol
// expect: duet: (derivative\(f, u\) is by one|wrt\(u, w\) takes|by which) symbol
// within: 2

std::cout << derivative(f, sin(u))(u = 0.3, w = w0) << "\n";   // wrong
const auto g = derivative(f, 0.3);                             // wrong
const auto g = derivative(f);                                  // wrong
const auto g = gradient(f, wrt(sin(u)));                       // wrong
std::cout << gradient(f, u)(u = 0.3, w = w0).gradient << "\n"; // wrong
const auto [y, g, h] = hessian(f, u, w)(u = 0.3, w = w0);      // wrong
const auto j = jacobian(u * w, u);                             // wrong
std::cout << derivative(f, u)(u = 0.3, w = w0)
          << jacobian(u * w, wrt(u))(u = 0.3, w = w0).jacobian; // right

//// derivative_by_vector
// expect: duet: derivative\(f, u\) is by a scalar symbol
// within: 2

static_cast<void>(derivative(f, w));                    // wrong
std::cout << derivative(f, w)(u = 0.3, w = w0) << "\n"; // wrong
std::cout << derivative(f, u)(u = 0.3, w = w0)
          << gradient(f, wrt(w))(u = 0.3, w = w0).value; // right

//// dot_of_sizes
// expect: duet: dot\(A, B\) takes two vectors or matrices of one size

static_cast<void>(dot(A, B));            // wrong
static_cast<void>(dot(A, transpose(B))); // right

//// doubled_argument
// expect: duet: two values are given for one symbol
// within: 2

static_cast<void>(f(u = 0.3, w = w0, u = 0.4));                                           // wrong
const double y = f(u = 0.3, w = w0, u = 0.4);                                             // wrong
const auto [y, g] = gradient(f, wrt(u))(u = 0.3, w = w0, u = 0.4);                        // wrong
std::cout << f(u = 0.3, w = w0) << gradient(f, wrt(u))(u = 0.3, w = w0).gradient << "\n"; // right

//// entries_missing
// expect: duet: matrix<2, 4>\(...\) takes its 8 entries, row by row

static_cast<void>(matrix<2, 2>(u, u, 1.0));      // wrong
static_cast<void>(matrix<2, 2>(u, u, 1.0, 0.5)); // right

//// entry_outside
// expect: duet: an entry or a block that is not in the matrix

static_cast<void>(entry<2, 0>(A)); // wrong
static_cast<void>(entry<1, 3>(A)); // right

//// gradient_of_vector
// expect: duet: a (gradient|Hessian) is that of a scalar formula
// within: 2

static_cast<void>(gradient(u* w, wrt(u)));                                                // wrong
std::cout << gradient(u * w, wrt(u))(u = 0.3, w = w0).gradient << "\n";                   // wrong
const auto h = hessian(u * w, wrt(u));                                                    // wrong
std::cout << f(u = 0.3, w = w0) << gradient(f, wrt(u))(u = 0.3, w = w0).gradient << "\n"; // right

//// gradient_without_frame
// expect: duet: with rotations and poses say the frame: gradient\(f, wrt\(q\), frame::body\)

static_cast<void>(gradient(norm(rotate(q, w)), wrt(q)));                    // wrong
static_cast<void>(gradient(norm(rotate(q, w)), wrt(q), duet::frame::body)); // right

//// hessian_of_rotation
// expect: duet: a Hessian of a formula is with respect to scalars, vectors and matrices

static_cast<void>(hessian(norm(rotate(q, w)), wrt(q))); // wrong
static_cast<void>(hessian(norm(rotate(q, w)), wrt(w))); // right

//// inverse_of_rectangle
// expect: duet: trace, determinant, adjugate, inverse and solve take a square matrix

static_cast<void>(inverse(A));    // wrong
static_cast<void>(inverse(A* B)); // right

//// jacobian_without_frame
// expect: duet: with rotations and poses say the frame

static_cast<void>(jacobian(exp(u* w), wrt(u)));                    // wrong
static_cast<void>(jacobian(exp(u* w), wrt(u), duet::frame::body)); // right

//// latex_of_gradient
// expect: duet: gradients, Hessians, Jacobians and motions
// within: 2

std::cout << to_latex(gradient(f, wrt(w))) << "\n";   // wrong
const std::string text = to_text(hessian(f, wrt(u))); // wrong
std::cout << to_latex(derivative(f, u)) << "\n";      // right

//// matrix_of_unknown_size
// expect: duet: a matrix in a formula has 1 to 6 rows and columns, known to the compiler

const Eigen::Matrix<double, 4, 2> B0 = Eigen::Matrix<double, 4, 2>::Ones();
static_cast<void>(A* Eigen::MatrixXd(B0)); // wrong
static_cast<void>(A* B0);                  // right

//// missing_argument
// expect: duet: a symbol of the formula has no value; say f\(u = 0.3, ...\) with all of them
// within: 2

static_cast<void>(f(u = 0.3));                                                            // wrong
std::cout << f(u = 0.3) << "\n";                                                          // wrong
const double y = f();                                                                     // wrong
const auto [y, g] = gradient(f, wrt(u))(u = 0.3);                                         // wrong
std::cout << hessian(f, wrt(w))(w = w0).hessian << "\n";                                  // wrong
const Eigen::MatrixXd j = jacobian(u * w, wrt(u))(w = w0).jacobian;                       // wrong
std::cout << f(u = 0.3, w = w0) << gradient(f, wrt(u))(u = 0.3, w = w0).gradient << "\n"; // right

//// motion_without_frame
// expect: duet: the frame is missing
// within: 2

const auto m = motion(exp(u * w), u);                                                    // wrong
std::cout << motion(exp(u * w), u)(u = 0.3, w = w0).velocity << "\n";                    // wrong
std::cout << motion(exp(u * w), u, duet::frame::body)(u = 0.3, w = w0).velocity << "\n"; // right

//// positional_argument
// expect: duet: formulas are called by name
// within: 2

static_cast<void>(f(0.3, w0));                                                            // wrong
std::cout << f(0.3, w0) << "\n";                                                          // wrong
const auto [y, g] = gradient(f, wrt(u))(0.3, w0);                                         // wrong
std::cout << f(u = 0.3, w = w0) << gradient(f, wrt(u))(u = 0.3, w = w0).gradient << "\n"; // right

//// product_of_sizes
// expect: duet: a product of matrices of sizes that do not fit

static_cast<void>(A* A); // wrong
static_cast<void>(A* B); // right

//// product_of_vectors
// expect: duet: a product is of scalars

static_cast<void>(w* cross(w, w0));      // wrong
static_cast<void>(dot(w, cross(w, w0))); // right

//// standard_function
// expect: duet: std::[a-z_0-9]* does not accept numbers with derivatives or formulas
// within: 2

const auto g = std::sin(u);                                         // wrong
std::cout << to_text(std::sin(u) * u) << "\n";                      // wrong
std::cout << to_text(std::pow(u, 2)) << "\n";                       // wrong
const auto g = std::atan2(u, 2 * u);                                // wrong
const auto g = std::cyl_bessel_j(0, u);                             // wrong
using std::sin;                                                     // right
std::cout << to_text(sin(u) * pow(u, 2) * atan2(u, 2 * u)) << "\n"; // right

//// sum_of_kinds
// expect: duet: a sum of formulas of different kinds

static_cast<void>(u + w);       // wrong
static_cast<void>(u + norm(w)); // right

//// sum_of_sizes
// expect: duet: a sum of formulas of different kinds or sizes

static_cast<void>(A + B);            // wrong
static_cast<void>(A + transpose(B)); // right

//// unknown_argument
// expect: duet: a value is given for a symbol that the formula does not have
// within: 2

static_cast<void>(f(u = 0.3, w = w0, symbol<"x">{} = 1.0));                               // wrong
std::cout << sin(u)(u = 0.3, w = w0) << "\n";                                             // wrong
std::cout << gradient(sin(u), wrt(u))(u = 0.3, w = w0).gradient << "\n";                  // wrong
std::cout << f(u = 0.3, w = w0) << gradient(f, wrt(u))(u = 0.3, w = w0).gradient << "\n"; // right

//// wrong_kind_of_argument
// expect: duet: a symbol is given a value of another kind
// within: 2

static_cast<void>(f(u = w0, w = w0));                                                     // wrong
std::cout << f(u = 0.3, w = 0.4) << "\n";                                                 // wrong
std::cout << f(u = 0.3, w = w0) << gradient(f, wrt(u))(u = 0.3, w = w0).gradient << "\n"; // right

//// wrong_size_of_argument
// expect: duet: a matrix symbol is given a value of another size

const Eigen::Matrix<double, 2, 4> A0 = Eigen::Matrix<double, 2, 4>::Ones();
const Eigen::Matrix<double, 4, 2> B0 = A0.transpose();
static_cast<void>(trace(A* transpose(A))(A = B0)); // wrong
static_cast<void>(trace(A* transpose(A))(A = A0)); // right
