// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Mistakes that must not compile, see check.cmake.

#include <duet/derivative/matrix_exponential.hpp>
#include <duet/derivative/nearest_rotation.hpp>
#include <duet/derivative/svd.hpp>
#include <duet/derivative/symmetric_eigen.hpp>
#include <duet/dual/complex.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/taylor.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <numeric>
#include <vector>

//// arcsine_of_many_digits
// expect: asin of a complex number needs float, double or long double

#include <boost/multiprecision/cpp_bin_float.hpp>

using real_50 = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>,
                                              boost::multiprecision::et_off>;
using number = duet::dual<real_50>;

// The standard library's arcsine uses π of 36 digits.
auto arcsine(const std::complex<number>& z) { return std::asin(z); } // wrong
auto arcsine(const std::complex<number>& z) { return std::sqrt(z); } // right

//// arguments_without_derivative
// expect: duet: [a-z_0-9]+ has no derivative with respect to its (order|modulus|characteristic)

#include <duet/interop/special_functions.hpp>

using D = duet::dual<double>;

void special_functions(const D& x) {
  cyl_bessel_j(x, D(2));                                                          // mistake
  cyl_neumann(x, D(2));                                                           // mistake
  cyl_bessel_i(x, 2.0);                                                           // mistake
  cyl_bessel_k(x, D(2));                                                          // mistake
  ellint_1(x, D(2));                                                              // mistake
  ellint_2(x, 2.0);                                                               // mistake
  ellint_3(x, 0.25, D(2));                                                        // mistake
  ellint_3(0.5, x, D(2));                                                         // mistake
  comp_ellint_3(x, 0.25);                                                         // mistake
  comp_ellint_3(0.5, x);                                                          // mistake
  static_cast<void>(cyl_bessel_j(1, x) + cyl_neumann(1, x) + cyl_bessel_i(1, x)); // right
  static_cast<void>(cyl_bessel_k(1, x) + ellint_1(0.5, x) + ellint_2(0.5, x));    // right
  static_cast<void>(ellint_3(0.5, 0.25, x));                                      // right
}

//// complex_of_complex
// expect: those of complex numbers, as dual<std::complex<double>>, are complex themselves

std::complex<duet::dual<std::complex<double>>> z; // mistake
std::complex<duet::dual<double>> z;               // right

//// derivative_from_screw
// expect: epsilon_of_a_rigid_motion_is_not_that_of_a_derivative|deleted function

using screw = duet::dual<double, 1, duet::screw_tag>;

const screw x(1, 2);
const auto y = static_cast<duet::dual<double>>(x);                                 // wrong
const auto y = static_cast<duet::dual<duet::dual<double>, 1, duet::screw_tag>>(x); // right

int main() { return y == 1 ? 0 : 1; }

//// eigen_decompositions
// expect: duet: Eigen's SelfAdjointEigenSolver loses derivatives over dual numbers: symmetric_eigen

using D = duet::dual<double>;
using series = duet::taylor<double, 3>;
template <class T>
using matrix = Eigen::Matrix<T, 3, 3>;

void decompose(const matrix<D>& a, const matrix<series>& b, const matrix<std::complex<D>>& c) {
  const Eigen::SelfAdjointEigenSolver<matrix<D>> d(a);               // mistake
  const Eigen::SelfAdjointEigenSolver<matrix<series>> e(b);          // mistake
  Eigen::SelfAdjointEigenSolver<matrix<D>> f;                        // mistake
  const Eigen::GeneralizedSelfAdjointEigenSolver<matrix<D>> g(a, a); // mistake
  const Eigen::EigenSolver<matrix<D>> h(a);                          // mistake
  const Eigen::ComplexEigenSolver<matrix<std::complex<D>>> i(c);     // mistake
  const Eigen::GeneralizedEigenSolver<matrix<D>> j(a, a);            // mistake
  const Eigen::RealSchur<matrix<D>> k(a);                            // mistake
  const Eigen::ComplexSchur<matrix<std::complex<D>>> l(c);           // mistake
  const Eigen::RealQZ<matrix<D>> m(a, a);                            // mistake
  const Eigen::HessenbergDecomposition<matrix<D>> n(a);              // mistake
  const Eigen::Tridiagonalization<matrix<D>> o(a);                   // mistake
  const Eigen::JacobiSVD<matrix<D>> p(a);                            // mistake
  const Eigen::BDCSVD<Eigen::Matrix<D, -1, -1>> q(a);                // mistake
}
auto decompose(const matrix<D>& a) {
  const Eigen::SelfAdjointEigenSolver<matrix<double>> plain(matrix<double>::Identity());
  return duet::make_vector(duet::symmetric_eigen(a).values[0], duet::svd(a).values[0],
                           plain.eigenvalues()[0]);
} // right

//// eigen_geometry
// expect: duet: the axis and angle of a rotation lose derivatives at the identity: rotation_vector

#include <duet/interop/eigen.hpp>

using D = duet::dual<double>;
using matrix = Eigen::Matrix<D, 3, 3>;
using points = Eigen::Matrix<D, 3, 5>;

D angle(const Eigen::Quaternion<D>& q) {
  Eigen::AngleAxis<D> a(q);                    // mistake
  Eigen::AngleAxis<D> b(q.toRotationMatrix()); // mistake
  a = q;                                       // mistake
  a = q.toRotationMatrix();                    // mistake
  b.fromRotationMatrix(q.toRotationMatrix());  // mistake
  const points p = points::Zero();
  static_cast<void>(Eigen::umeyama(p, p));        // mistake
  static_cast<void>(Eigen::umeyama(p, p, false)); // mistake
  return a.angle();
}
D angle(const Eigen::Quaternion<D>& q) {
  const Eigen::AngleAxisd plain(Eigen::Quaterniond(1, 0, 0, 0));
  const Eigen::AngleAxis<D> a(plain.angle(), plain.axis().cast<D>());
  return duet::rotation_vector(duet::from_eigen(q)).norm() + a.angle();
} // right

//// eigen_matrix_functions
// expect: duet: Eigen's (exp|sqrt|log|pow|sin, cos, sinh or cosh) of a matrix loses

#include <unsupported/Eigen/MatrixFunctions>

using matrix = Eigen::Matrix<duet::dual<double>, 3, 3>;

matrix f(const matrix& a) { return a.exp(); }                                               // wrong
matrix f(const matrix& a) { return a.sqrt(); }                                              // wrong
matrix f(const matrix& a) { return a.log(); }                                               // wrong
matrix f(const matrix& a) { return a.pow(duet::dual<double>(0.5)); }                        // wrong
matrix f(const matrix& a) { return a.cos(); }                                               // wrong
matrix f(const matrix& a) { return duet::matrix_exponential(a) + matrix(a.array().exp()); } // right

//// eigen_members
// expect: duet: Eigen's (JacobiSVD|SelfAdjointEigenSolver|EigenSolver) loses derivatives over dual

using D = duet::dual<double>;
using matrix = Eigen::Matrix<D, 3, 3>;

// Members of Eigen that use rejected decompositions.
auto f(const Eigen::Transform<D, 3, Eigen::Affine>& t) { return matrix(t.rotation()); } // wrong
void f(const Eigen::Transform<D, 3, Eigen::Affine>& t, matrix& r, matrix& s) {
  t.computeRotationScaling(&r, &s);
} // wrong
auto f(const matrix& a) { return a.operatorNorm(); } // wrong
auto f(const matrix& a) { return a.eigenvalues(); }  // wrong
auto f(const matrix& a) { return a.jacobiSvd(); }    // wrong
auto f(const Eigen::Transform<D, 3, Eigen::Affine>& t) {
  const Eigen::Transform<D, 3, Eigen::Isometry> isometry(duet::nearest_rotation(t.linear()));
  return matrix(isometry.rotation());
} // right

//// fraction_of_rationals
// expect: no match for .operator\*|invalid operands to binary expression

#include <duet/interop/boost_rational.hpp>

using rational = boost::rational<long long>;

auto half(const duet::dual<rational>& x) { return x * 0.5; }            // wrong
auto half(const duet::dual<rational>& x) { return x * rational(1, 2); } // right

//// lost_derivatives
// expect: no viable conversion|cannot convert

// A dual does not convert to a double implicitly: derivatives would be lost unnoticed.
const duet::dual<double> x(1, 2);
const double y = x;                      // wrong
const double y = static_cast<double>(x); // right

int main() { return y == 1 ? 0 : 1; }

//// modulus_of_complex
// expect: no matching function for call to .abs

// |z| has no complex derivative; along a real parameter it has one.
auto modulus(const duet::dual<std::complex<double>>& z) { return abs(z); } // wrong
auto modulus(const std::complex<duet::dual<double>>& z) { return abs(z); } // right

//// of_integers
// expect: duet: dual<T> needs a real number

duet::dual<int> x;    // wrong
duet::dual<double> x; // right

//// order_of_complex
// expect: no match for .operator<|invalid operands to binary expression

bool is_less(const duet::dual<std::complex<double>>& x) { return x < 1; }  // wrong
bool is_less(const duet::dual<std::complex<double>>& x) { return x == 1; } // right

//// partial_counts_mixed
// expect: use of deleted function .*different_numbers_of_partials|selected deleted operator '\*'

// Partials of a function of two variables and of one of three have no common meaning.
const duet::dual<double, 2> x = duet::dual<double, 2>::variable(1, 1);
const duet::dual<double, 3> y = 2; // wrong
const duet::dual<double, 2> y = 2; // right
const auto z = x * y;

int main() { return z == 2 ? 0 : 1; }

//// reused_tag
// expect: happens inside another one with the same tag.*derivative<struct my_tag>

struct outer;
struct inner;

duet::dual<duet::dual<double, 1, outer>, 1, outer> x; // wrong
duet::dual<duet::dual<double, 1, outer>, 1, inner> x; // right

int main() { return x == 0 ? 0 : 1; }

//// reused_taylor_tag
// expect: happens inside another one with the same tag.*derivatives<K, struct my_tag>

struct inner;

duet::taylor<duet::dual<double>, 2> x;        // wrong
duet::taylor<duet::dual<double>, 2, inner> x; // right

int main() { return x == 0 ? 0 : 1; }

//// screw_from_derivative
// expect: epsilon_of_a_rigid_motion_is_not_that_of_a_derivative|deleted function

// The ε of a screw is not the ε of a derivative: together they nest, but neither becomes the other.
using screw = duet::dual<double, 1, duet::screw_tag>;
using derivative = duet::dual<double>;

const derivative x = derivative::variable(2);
const screw y = x;                                      // wrong
const duet::dual<derivative, 1, duet::screw_tag> y = x; // right

int main() { return y == 2 ? 0 : 1; }

//// sum_of_constants
// expect: duet: (a sum or product of|accumulate, reduce)

// A sum whose type is double would lose the derivatives of what it adds up.
int main() {
  const duet::dual<double> x(1, 2);
  const std::vector<duet::dual<double>> v{x, x};
  double s = 0;                                                              // wrong, too
  s += x;                                                                    // mistake
  s -= x;                                                                    // mistake
  s *= x;                                                                    // mistake
  s /= x;                                                                    // mistake
  const auto a = std::accumulate(v.begin(), v.end(), 0.0);                   // mistake
  const auto b = std::accumulate(v.begin(), v.end(), 0, std::plus<>());      // mistake
  const auto c = std::reduce(v.begin(), v.end(), 0.0);                       // mistake
  const auto d = std::inner_product(v.begin(), v.end(), v.begin(), 0.0);     // mistake
  duet::dual<double> s = 0;                                                  // right
  s += x;                                                                    // right
  const auto a = std::accumulate(v.begin(), v.end(), duet::dual<double>(0)); // right
  const auto b = std::reduce(v.begin(), v.end(), duet::dual<double>(0));     // right
  const auto c = std::inner_product(v.begin(), v.end(), v.begin(), duet::dual<double>(0)); // right
  return a == b && a == c && s == 1 ? 1 : 0;                                               // right
}
