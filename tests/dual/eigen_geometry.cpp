// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/dual/eigen_traits.hpp>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include <cmath>

// Eigen's Geometry module over duals: a frame that turns about n at unit rate has Ṙ = [n]× R.

namespace test_dual_eigen_geometry {

using D = duet::dual<double>;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using DVector = Eigen::Matrix<D, 3, 1>;
using DMatrix = Eigen::Matrix<D, 3, 3>;

namespace {

template <class M>
auto slopes(const M& m) {
  return m.unaryExpr([](const D& x) { return x.epsilon(); }).eval();
}
template <class M>
auto values(const M& m) {
  return m.unaryExpr([](const D& x) { return x.value(); }).eval();
}

Matrix3d cross_matrix(const Vector3d& v) {
  return (Matrix3d() << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0).finished();
}

const Vector3d axis = Vector3d(1, 2, -2) / 3;
const D angle = D(0.7, 1);
const Matrix3d rotation = Eigen::AngleAxisd(0.7, axis).toRotationMatrix();
const Matrix3d rate = cross_matrix(axis) * rotation;

bool near(const auto& a, const auto& b) { return (a - b).norm() <= 1e-14 * (1 + b.norm()); }

} // namespace

TEST_CASE("angle and axis") {
  const Eigen::AngleAxis<D> turn(angle, axis.cast<D>());
  const DMatrix r = turn.toRotationMatrix();
  CHECK(near(values(r), rotation));
  CHECK(near(slopes(r), rate));
  const Eigen::AngleAxis<D> back(r);
  CHECK(back.angle().value() == doctest::Approx(0.7));
  CHECK(back.angle().epsilon() == doctest::Approx(1));
  CHECK(slopes(back.axis()).norm() <= 1e-14);
}

TEST_CASE("quaternions") {
  const Eigen::Quaternion<D> q(Eigen::AngleAxis<D>(angle, axis.cast<D>()));
  CHECK(q.w().epsilon() == doctest::Approx(-std::sin(0.35) / 2));
  CHECK(near(slopes(q.toRotationMatrix()), rate));
  const DVector v(1, 2, 3);
  CHECK(near(slopes((q * v).eval()), rate * Vector3d(1, 2, 3)));
  const DMatrix still = (q * q.conjugate()).toRotationMatrix();
  CHECK(slopes(still).norm() <= 1e-15);
  CHECK(near(slopes((q * q).toRotationMatrix()), rate * rotation + rotation * rate));
  CHECK(slopes(q.normalized().coeffs().squaredNorm() * DVector::Ones().eval()).norm() <= 1e-15);
  CHECK(q.norm().epsilon() == doctest::Approx(0));
  CHECK(near(slopes(q.inverse().toRotationMatrix()), rate.transpose().eval()));
  const Eigen::Quaternion<D> from_matrix(q.toRotationMatrix());
  CHECK(near(slopes(from_matrix.coeffs()), slopes(q.coeffs())));
  // Halfway between identity and q the rate is half.
  const auto half = Eigen::Quaternion<D>::Identity().slerp(0.5, q);
  CHECK(near(slopes(half.toRotationMatrix()),
             (cross_matrix(axis) * Eigen::AngleAxisd(0.35, axis).toRotationMatrix() / 2).eval()));
  const Eigen::Quaterniond plain(rotation);
  CHECK(near(slopes(plain.cast<D>().toRotationMatrix()), Matrix3d::Zero().eval()));
}

TEST_CASE("transforms") {
  Eigen::Transform<D, 3, Eigen::Isometry> t = Eigen::Transform<D, 3, Eigen::Isometry>::Identity();
  t.translate(DVector(D(1, 2), 0, 0));
  t.rotate(Eigen::AngleAxis<D>(angle, axis.cast<D>()));
  const DVector p(1, 2, 3);
  CHECK(near(slopes((t * p).eval()), (rate * Vector3d(1, 2, 3) + Vector3d(2, 0, 0)).eval()));
  CHECK(near(slopes((t.inverse() * (t * p)).eval()), Vector3d::Zero().eval()));
  CHECK(near(slopes((t * t).linear().eval()), (rate * rotation + rotation * rate).eval()));
  const Eigen::Transform<D, 3, Eigen::Affine> affine(t);
  CHECK(near(slopes((affine.inverse() * (affine * p)).eval()), Vector3d::Zero().eval()));
  CHECK(near(slopes(affine.matrix().topLeftCorner<3, 3>().eval()), rate));
}

TEST_CASE("products of vectors") {
  const DVector a(D(1, 1), 2, 3);
  const DVector b(4, D(5, -1), 6);
  const Vector3d x(1, 2, 3);
  const Vector3d y(4, 5, 6);
  const Vector3d dx(1, 0, 0);
  const Vector3d dy(0, -1, 0);
  CHECK(slopes(a.cross(b).eval()) == dx.cross(y) + x.cross(dy));
  CHECK(a.dot(b).epsilon() == dx.dot(y) + x.dot(dy));
  const Vector3d unit = x.normalized();
  CHECK(near(slopes(a.normalized()), ((dx - unit * unit.dot(dx)) / x.norm()).eval()));
  CHECK(a.unitOrthogonal().dot(a).epsilon() == doctest::Approx(0).epsilon(1e-15));
  const DMatrix r = Eigen::Quaternion<D>::FromTwoVectors(a, b).toRotationMatrix();
  CHECK(slopes((r * a.normalized() - b.normalized()).eval()).norm() <= 1e-13);
}

} // namespace test_dual_eigen_geometry
