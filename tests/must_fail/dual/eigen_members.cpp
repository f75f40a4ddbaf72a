// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: Eigen's (JacobiSVD|SelfAdjointEigenSolver|EigenSolver) loses derivatives over dual
// forms: 5

#include <duet/derivative/nearest_rotation.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

using D = duet::dual<double>;
using matrix = Eigen::Matrix<D, 3, 3>;

// Members of Eigen that use rejected decompositions.
#if DUET_MUST_FAIL == 1
auto f(const Eigen::Transform<D, 3, Eigen::Affine>& t) { return matrix(t.rotation()); }
#elif DUET_MUST_FAIL == 2
void f(const Eigen::Transform<D, 3, Eigen::Affine>& t, matrix& r, matrix& s) {
  t.computeRotationScaling(&r, &s);
}
#elif DUET_MUST_FAIL == 3
auto f(const matrix& a) { return a.operatorNorm(); }
#elif DUET_MUST_FAIL == 4
auto f(const matrix& a) { return a.eigenvalues(); }
#elif DUET_MUST_FAIL == 5
auto f(const matrix& a) { return a.jacobiSvd(); }
#else
auto f(const Eigen::Transform<D, 3, Eigen::Affine>& t) {
  const Eigen::Transform<D, 3, Eigen::Isometry> isometry(duet::nearest_rotation(t.linear()));
  return matrix(isometry.rotation());
}
#endif
