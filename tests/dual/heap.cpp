// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Eigen asserts where it allocates; operator new is counted here.
#define EIGEN_RUNTIME_NO_MALLOC

#include "support/allocations.hpp"

#include <duet/dual/eigen_traits.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <doctest/doctest.h>

using duet::dual, duet::taylor;

namespace {

struct outer_tag;

template <class D>
D functions(const D& x) {
  using vector = Eigen::Matrix<D, 3, 1>;
  const Eigen::Matrix<D, 3, 3> r = Eigen::AngleAxis<D>(x, vector(0, 0, 1)).toRotationMatrix();
  const vector b = r * vector(x, 1, sin(x)) + Eigen::Vector3d(4, 5, 6);
  const D sum = b.normalized().cross(b).norm() + r.inverse().trace() + b.dot(b);
  return pow(sum, 1.5) + atan2(sum, x) + hypot(sum, x, 2) + tgamma(x);
}

template <class D>
D solutions(const D& x) {
  Eigen::Matrix<D, 3, 3> a = Eigen::Matrix3d::Identity() * x;
  a(0, 1) = a(1, 0) = x / 4;
  const Eigen::Matrix<D, 3, 1> b(x, 1, sin(x));
  return a.llt().solve(b).squaredNorm() + a.partialPivLu().solve(b).norm() +
         a.householderQr().solve(b).dot(b) + a.determinant();
}

/// Allocations of f(x), which must be finite.
template <class F, class D>
std::size_t allocations_of(F f, const D& x) {
  const std::size_t before = duet_test::allocations;
  Eigen::internal::set_is_malloc_allowed(false);
  const D y = f(x);
  Eigen::internal::set_is_malloc_allowed(true);
  const std::size_t after = duet_test::allocations;
  CHECK(isfinite(y));
  return after - before;
}

} // namespace

TEST_CASE_TEMPLATE("functions of fixed size: no heap allocation", D, dual<double>, dual<double, 7>,
                   taylor<double, 3>, dual<dual<double>, 1, outer_tag>) {
  CHECK(allocations_of([](const D& x) { return functions(x); }, D::variable(0.5)) == 0);
}

TEST_CASE("solvers of fixed size: no heap allocation") {
  using D = dual<double, 7>;
  CHECK(allocations_of([](const D& x) { return solutions(x); }, D::variable(0.5)) == 0);
}

TEST_CASE("allocation counter: counts an allocation") {
  const std::size_t before = duet_test::allocations;
  ::operator delete(::operator new(8)); // a new-expression may be optimised away
  CHECK(duet_test::allocations == before + 1);
}
