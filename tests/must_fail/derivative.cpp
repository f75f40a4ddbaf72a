// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Mistakes that must not compile, see check.cmake.

#include <duet/derivative/derivative.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/derivative/implicit_function.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/derivative/linear_solve.hpp>
#include <duet/derivative/nonlinear_least_squares.hpp>
#include <duet/derivative/sparse.hpp>
#include <duet/derivative/tangent_coordinates.hpp>
#include <duet/derivative/with_derivative.hpp>
#include <duet/expression/arithmetic.hpp>
#include <duet/expression/derivative.hpp>
#include <duet/expression/symbol.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <concepts>
#include <iostream>
#include <list>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

//// expression_returned
// expect: duet: a function returns an expression of Eigen

// Every driver rejects functions that return expressions: they refer to variables that are gone.

namespace {

const duet::quaternion<double> q(1);
const duet::vector3<double> t(1, 2, 3);
const duet::vector3<double> x(4, 5, 6);

// Each has a number, because compilers report an error for a type only once.
template <int>
struct of_scalar {
  auto operator()(const auto& s) const { return t * s; }
};
template <int>
struct moved {
  auto operator()(const auto& y) const { return duet::rotate(q, y) + t; }
};
template <int>
struct square {
  auto operator()(const auto& y) const { return y.transpose() * y; }
  auto operator()(const auto& y, const auto& z) const { return y.transpose() * z; }
};
template <int>
struct rotated {
  auto operator()(const auto& r) const { return duet::rotate(r, t) + t; }
};
template <int>
struct size {
  auto operator()(const auto& r) const { return t.transpose() * duet::rotate(r, t); }
};
template <int>
struct equations {
  auto operator()(const auto& y, const auto& p) const { return y * p - y; }
};

} // namespace

int main() {
  using namespace duet;
  vector3<double> g;
  matrix3<double> m;
  static_cast<void>(derivative(of_scalar<0>(), 1.0));                  // mistake
  static_cast<void>(derivatives<2>(of_scalar<1>(), 1.0));              // mistake
  static_cast<void>(directional_derivative(moved<0>(), x, t));         // mistake
  static_cast<void>(directional_derivative(of_scalar<2>(), 1.0, 2.0)); // mistake
  static_cast<void>(jacobian(moved<1>(), x));                          // mistake
  static_cast<void>(jacobian_into(moved<2>(), x, m));                  // mistake
  static_cast<void>(jacobian(rotated<0>(), q, frame::body));           // mistake
  static_cast<void>(gradient(square<0>(), x));                         // mistake
  static_cast<void>(gradient_into(square<1>(), x, g));                 // mistake
  static_cast<void>(gradient(size<0>(), q, frame::body));              // mistake
  static_cast<void>(hessian(square<2>(), x));                          // mistake
  static_cast<void>(hessian(size<1>(), q, frame::body));               // mistake
  static_cast<void>(hessian_vector_product(square<3>(), x, t));        // mistake
  static_cast<void>(mixed_hessian(square<4>(), x, t));                 // mistake
  static_cast<void>(implicit_solution(equations<0>(), x, 1.0));        // mistake
  static_cast<void>(implicit_function<1>(equations<1>(), x, 1.0));     // mistake
  // Parts of vectors, arrays, expressions inside containers, and tied references.
  static_cast<void>(jacobian([](const auto& y) { return y.template head<2>(); }, x)); // mistake
  static_cast<void>(jacobian([](const auto& y) { return (y + y).array(); }, x));      // mistake
  static_cast<void>(derivative([](auto s) { return std::tuple(s, t * s); }, 1.0));    // mistake
  static_cast<void>(derivative([](auto s) { return std::array{t * s}; }, 1.0));       // mistake
  static_cast<void>(derivative([](auto s) { return std::pair(t * s, s); }, 1.0));     // mistake
  static_cast<void>(derivative([](auto s) { return std::optional(t * s); }, 1.0));    // mistake
  static_cast<void>(derivative([](auto s) { return std::vector{t * s}; }, 1.0));      // mistake
  static_cast<void>(derivative(                                                       // mistake
      [](auto s) { return std::pair<const std::tuple<decltype(t * s)>, int>(t * s, 1); }, 1.0));
  static_cast<void>(derivative([](const auto& s) { return std::tie(s, s); }, 1.0));       // mistake
  const auto moved = [](const auto& y) { return (rotate(q, y) + t).eval(); };             // right
  const auto square = [](const auto& y) { return y.dot(y); };                             // right
  const auto equations = [](const auto& y, const auto& p) { return (y * p - y).eval(); }; // right
  m = jacobian(moved, x).jacobian;                                                        // right
  g = gradient(square, x).gradient;                                                       // right
  static_cast<void>(directional_derivative(moved, x, t));                                 // right
  static_cast<void>(implicit_solution(equations, x, 1.0));                                // right
}

//// frame_missing
// expect: duet: to differentiate with respect to rotations, poses or tuples pass the frame
// within: 5

#include <duet/duet.hpp>

const auto f = [](const auto& q) { return duet::rotation_vector(q); };
const auto g = [](const auto& q) { return q.w(); };
const duet::quaternion<double> q(1, 0, 0, 0);
duet::jacobian(f, q);                               // wrong
std::cout << duet::jacobian(f, q).jacobian << "\n"; // wrong
std::cout << duet::gradient(g, q).gradient << "\n"; // wrong
std::cout << duet::hessian(g, q).hessian << "\n";   // wrong
const auto [y, j] = duet::jacobian(f, q);           // wrong
std::cout << duet::jacobian(f, q, duet::frame::body).jacobian << "\n"
          << duet::gradient(g, q, duet::frame::body).gradient << "\n"
          << duet::hessian(g, q, duet::frame::body).hessian << "\n"; // right

//// function_of_double
// expect: duet: [a-z_]*: the function must take any scalar
// within: 5

double cube(double x) { return x * x * x; }

int main() {
  const Eigen::Vector3d x(1, 2, 3);
  const auto square = [](double a) { return a * a; }; // wrong
  const auto slope = duet::derivative(square, 2.0);   // wrong, too
  std::cout << duet::derivative([](double a) { return a * a; }, 2.0).derivative << "\n"; // wrong
  std::cout << duet::derivatives<2>(cube, 2.0)[1] << "\n";                               // wrong
  std::cout << duet::gradient([](const Eigen::Vector3d& a) { return a[0]; }, x).gradient
            << "\n";                                                           // wrong
  std::cout << duet::gradient([](double a) { return a; }, x).gradient << "\n"; // wrong
  const auto scaled = [](const Eigen::Vector3d& a) mutable {
    return Eigen::Vector3d(2 * a);
  };                                                                         // wrong
  std::cout << duet::jacobian(scaled, x).jacobian << "\n";                   // wrong, too
  const auto sum = [](const std::vector<double>& a) { return a[0] + a[1]; }; // wrong
  std::cout << duet::hessian(sum, std::vector{1., 2.}).hessian << "\n";      // wrong, too
  const auto rotated = [](const duet::quaternion<double>& q) { return q; };  // wrong
  std::cout << duet::jacobian(rotated, duet::quaternion<double>(1), duet::frame::body)
                   .jacobian;                                                    // wrong, too
  const auto [y, slope] = duet::derivative([](double a) { return a * a; }, 2.0); // wrong
  const auto [y, slopes] =
      duet::gradient([](const Eigen::Vector3d& a) { return a[0]; }, x); // wrong
  const Eigen::Vector3d slopes =
      duet::jacobian([](const Eigen::Vector3d& a) { return a; }, x).jacobian.col(0);        // wrong
  std::cout << duet::nonlinear_least_squares([](double a) { return a - 1; }, 2.0).estimate; // wrong
  const auto square = [](auto a) { return a * a; };                                         // right
  const auto scaled = [](const auto& a) { return (2 * a).eval(); };                         // right
  std::cout << duet::derivative(square, 2.0).derivative << duet::derivatives<2>(square, 2.)[1]
            << duet::jacobian(scaled, x).jacobian << "\n"; // right
}

//// function_of_floating_point
// expect: duet: derivative: the function must take any scalar

const auto square = [](std::floating_point auto x) { return x * x; }; // wrong
const auto square = [](auto x) { return x * x; };                     // right
return duet::derivative(square, 2.0).derivative == 4 ? 0 : 1;

//// matrix_argument
// expect: duet: differentiate with respect to a vector, .*f, x.reshaped\(\)
// within: 5

const auto f = [](const auto& x) { return x.sum(); };
const Eigen::Matrix2d x = Eigen::Matrix2d::Ones();
return duet::gradient(f, x).value == 4 ? 0 : 1;                                       // wrong
std::cout << duet::gradient(f, Eigen::MatrixXd(x)).gradient << "\n";                  // wrong
const auto [y, h] = duet::jacobian(f, x);                                             // wrong
std::cout << duet::hessian(f, 2 * x).hessian << "\n";                                 // wrong
Eigen::VectorXd g(4);                                                                 // wrong
return duet::gradient_into(f, x, g) == 4 ? 0 : 1;                                     // wrong, too
Eigen::MatrixXd j(1, 4);                                                              // wrong
std::cout << duet::jacobian_into<2>(f, x, j);                                         // wrong, too
const auto [y, dy] = duet::directional_derivative(f, x, x);                           // wrong
std::cout << duet::hessian_vector_product(f, x, x).value;                             // wrong
std::cout << duet::sparse_jacobian(f, x, Eigen::SparseMatrix<double>(1, 4)).jacobian; // wrong
std::cout << duet::sparse_hessian(f, x, Eigen::SparseMatrix<double>(4, 4)).hessian;   // wrong
std::cout << duet::gradient(f, x.reshaped()).gradient
          << duet::hessian(f, x.reshaped()).hessian; // right

//// one_number
// expect: duet: .* with respect to (one number|a vector)
// within: 2

const auto f = [](const auto& x) { return x[0] * x[1]; };
const auto g = [](const auto& x) { return x * x; };
const Eigen::Vector3d v(1, 2, 3);
std::cout << duet::derivative(f, v).value << "\n";                                    // wrong
std::cout << duet::gradient(g, 2.0).gradient << "\n";                                 // wrong
const auto [y, j] = duet::jacobian(g, 2);                                             // wrong
std::cout << duet::hessian(g, 2.0).hessian << "\n";                                   // wrong
std::cout << duet::gradient(f, v).gradient << duet::derivative(g, 2.0).value << "\n"; // right

//// parameters_of_estimation
// expect: must be a double|must return a scalar|several parameters as a tuple
// within: 5

const auto r = duet::nonlinear_least_squares([](const auto& a) { return a - 1; }, 2); // wrong
const auto r = duet::nonlinear_least_squares([](const auto& a) { return a[0] - 1; },
                                             Eigen::Vector2i(1, 2)); // wrong
const auto r =
    duet::nonlinear_least_squares([](const auto& q) { return q; }, duet::quaternion(1.)); // wrong
const auto r = duet::nonlinear_least_squares([](const auto& a, const auto& b) { return a - b; }, 1.,
                                             2.); // wrong
const auto r =
    duet::nonlinear_least_squares([](const auto&) { return Eigen::MatrixXd(2, 2); }, 1.); // wrong
const auto r = duet::nonlinear_least_squares([](const auto& a, const auto& b) { return a - b; },
                                             std::tuple(1., 2.)); // right
static_cast<void>(r);

//// recursion
// expect: inside another one with the same tag.*give it a separate tag: derivative<struct my_tag>

// The n-th derivative of x³ by recursion through one function type: the levels cannot be
// distinguished.
struct slope {
  template <class T>
  auto operator()(const T& x) const {
    if constexpr (duet::scalar_traits<T>::order == 2) {
      return x * x * x;
    } else {
      return duet::derivative(*this, x).derivative;
    }
  }
}; // wrong
template <int N>
struct level; // right
struct slope {
  template <class T>
  auto operator()(const T& x) const {
    if constexpr (duet::scalar_traits<T>::order == 2) {
      return x * x * x;
    } else {
      return duet::derivative<level<duet::scalar_traits<T>::order>>(*this, x).derivative;
    }
  }
}; // right

int main() { return slope()(2.0) == 12 ? 0 : 1; }

//// result_without_structure
// expect: duet: a function must return a scalar, an Eigen vector or matrix, a rotation

const auto f = [](auto x) { return std::list{x, x}; };  // wrong
const auto f = [](auto x) { return std::array{x, x}; }; // right
return duet::derivative(f, 2.0).derivative[0] == 1 ? 0 : 1;

//// results_in_parts
// expect: duet: (derivative|gradient|jacobian|hessian) returns value

int main() {
  const auto f = [](const auto& x) { return x[0] * x[1]; };
  const auto g = [](const auto& x) { return x; };
  const Eigen::Vector2d x(1, 2);
  const double slope = duet::derivative(g, 1.0);                                 // mistake
  const Eigen::VectorXd gradient = duet::gradient(f, x);                         // mistake
  const Eigen::MatrixXd jacobian = duet::jacobian(g, x);                         // mistake
  const Eigen::Matrix2d hessian = duet::hessian(f, x);                           // mistake
  const auto [y, slope] = duet::derivative(g, 1.0);                              // right
  const Eigen::VectorXd gradient = duet::gradient(f, x).gradient;                // right
  const Eigen::MatrixXd jacobian = duet::jacobian(g, x).jacobian;                // right
  const auto [z, same_gradient, hessian] = duet::hessian(f, x);                  // right
  return y == slope && gradient == same_gradient && jacobian == hessian ? 1 : 0; // right
}

//// scalar_valued_jacobian
// expect: duet: jacobian needs a function that returns a vector

const auto f = [](const auto& x) { return x[0] * x[1]; };                          // wrong
const auto f = [](const auto& x) { return duet::make_vector(x[0] * x[1], x[1]); }; // right
return duet::jacobian(f, Eigen::Vector2d(1, 2)).value[0] == 2 ? 0 : 1;

//// several_arguments
// expect: duet: .*std::tuple\(a, b\)
// within: 2

const auto f = [](const auto& a, const auto& b) { return a * b; };
const auto g = [](const auto& a, const auto& b) { return a[0] * b; };
const Eigen::Vector3d v(1, 2, 3);
std::cout << duet::gradient(f, 1.0, 2.0).gradient << "\n";     // wrong
std::cout << duet::gradient(g, v, 2.0).gradient << "\n";       // wrong
const auto [y, j] = duet::jacobian(g, v, 2.0);                 // wrong
std::cout << duet::hessian(f, 1.0, 2.0).hessian << "\n";       // wrong
const double slope = duet::derivative(f, 1.0, 2.0).derivative; // wrong
std::cout << duet::gradient(f, std::tuple(1.0, 2.0)).gradient
          << duet::gradient(g, std::tuple(v, 2.0)).gradient
          << duet::hessian(f, std::tuple(1.0, 2.0)).hessian << "\n"; // right

//// solve_not_square
// expect: duet: the matrix A must be square

const Eigen::Matrix<double, 2, 3> a = Eigen::Matrix<double, 2, 3>::Identity(); // wrong
const Eigen::Matrix<double, 2, 2> a = Eigen::Matrix<double, 2, 2>::Identity(); // right
return duet::solve(a, Eigen::Vector2d(1, 1))[0] == 1 ? 0 : 1;

//// standard_function
// expect: duet: std::[a-z0-9]* does not accept numbers with derivatives
// within: 5

const Eigen::Vector3d x(1, 2, 3);
using duet::derivative;
const auto sine = [](auto a) { return std::sin(a); };                                // wrong
const auto slope = derivative(sine, 0.3);                                            // wrong, too
std::cout << derivative([](auto a) { return std::sin(a); }, 0.3).derivative << "\n"; // wrong
std::cout << derivative([](auto a) { return std::pow(a, 3) * std::exp(a); }, 0.3).value
          << "\n";                                                                      // wrong
std::cout << duet::derivatives<3>([](auto a) { return std::sqrt(a); }, 0.3)[1] << "\n"; // wrong
std::cout
    << duet::gradient([](const auto& a) { return std::hypot(a[0], a[1]); }, x).gradient; // wrong
const auto angles = [](const auto& a) { return std::array{std::atan2(a[0], a[1])}; };    // wrong
std::cout << duet::jacobian(angles, x).jacobian << "\n"; // wrong, too
using std::sin;                                          // right
std::cout
    << derivative([](auto a) { return sin(a) + exp(a) * std::exp(2); }, 0.3).derivative;  // right
std::cout << duet::gradient([](const auto& a) { return hypot(a[0], a[1]); }, x).gradient; // right

//// standard_special_function
// expect: duet: std::[a-z_0-9]* does not accept numbers with derivatives or formulas
// within: 5

#include <duet/interop/special_functions.hpp>

std::cout
    << duet::derivative([](auto x) { return std::cyl_bessel_j(0, x); }, 0.3).derivative; // wrong
const auto [y, dy] = duet::derivative([](auto x) { return std::beta(x, x); }, 0.3);      // wrong
using std::beta;                                                                         // right
std::cout
    << duet::derivative([](auto x) { return cyl_bessel_j(0, x) + beta(x, x); }, 0.3).value; // right

//// too_few_residuals
// expect: duet: implicit_function: F must return as many residuals as the unknown has coordinates

const auto f = [](const auto& x, const auto& p) {
  return duet::make_vector(x[0] * x[1] - p);
}; // wrong
const auto f = [](const auto& x, const auto& p) {
  return duet::make_vector(x[0] * x[1] - p, x[0] - x[1]);
}; // right
return duet::implicit_solution(f, Eigen::Vector2d(1, 1), 4.0)[0] > 1.5 ? 0 : 1;

//// vector_valued_gradient
// expect: duet: gradient needs a function that returns a scalar

const auto f = [](const auto& x) { return duet::make_vector(x[0], x[1]); }; // wrong
const auto f = [](const auto& x) { return x[0] * x[1]; };                   // right
return duet::gradient(f, Eigen::Vector2d(1, 2)).value == 2 ? 0 : 1;

//// with_derivative_of_captures_in_formula
// expect: duet: with_derivative: in a formula the function and its derivatives must be lambdas

constexpr duet::expression::symbol<"u"> u;
const double scale = 2;                                 // wrong
const auto f = [scale](double x) { return scale * x; }; // wrong, too
const auto f = [](double x) { return 2 * x; };          // right
const auto g = duet::with_derivative(f, [](double) { return 2.0; });
return derivative(g(u), u)(u = 1.0) == 2 ? 0 : 1;

//// with_derivative_of_number_beside_formula
// expect: duet: with_derivative: beside formulas, numbers are written as c<2> or are symbols

using duet::expression::c;
constexpr duet::expression::symbol<"u"> u;
const auto slope = [](double, double) { return 1.0; };
const auto f = duet::with_derivative([](double x, double y) { return x + y; }, slope, slope);
return f(u, 2.0)(u = 1.0) == 3 ? 0 : 1;  // wrong
return f(u, c<2>)(u = 1.0) == 3 ? 0 : 1; // right

//// with_derivative_of_first_order
// expect: duet: with_derivative: derivatives of this order need a derivative that takes any scalar

double reciprocal(double x) { return 1 / x; }

int main() {
  const auto slope = [](double x) { return -1 / (x * x); };      // wrong
  const auto slope = [](const auto& x) { return -1 / (x * x); }; // right
  return duet::derivatives<2>(duet::with_derivative(reciprocal, slope), 1.0)[2] == 2 ? 0 : 1;
}
