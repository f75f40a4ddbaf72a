// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/differences.hpp"
#include "support/test.hpp"

#include <duet/dual/eigen_traits.hpp>

#include <Eigen/Geometry>

// Eigen's Geometry module over duals: a frame that rotates about n at unit rate has Ṙ = [n]× R.

namespace test_dual_eigen_geometry {
namespace {

using D = duet::dual<double>;
using Eigen::Matrix3d, Eigen::Vector3d;
using DVector = Eigen::Matrix<D, 3, 1>;
using DMatrix = Eigen::Matrix<D, 3, 3>;

template <class M>
auto slopes(const M& m) {
  return m.unaryExpr([](const D& x) { return x.epsilon(); }).eval();
}
template <class M>
auto values(const M& m) {
  return m.unaryExpr([](const D& x) { return x.value(); }).eval();
}

Matrix3d skew(const Vector3d& v) {
  return (Matrix3d() << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0).finished();
}

const Vector3d axis = Vector3d(1, 2, -2) / 3;
const D angle = D(0.7, 1);
const Matrix3d rotation = Eigen::AngleAxisd(0.7, axis).toRotationMatrix();
const Matrix3d rate = skew(axis) * rotation;

bool near(const auto& a, const auto& b) { return (a - b).norm() <= 1e-14 * (1 + b.norm()); }

TEST_CASE("Eigen geometry over dual: AngleAxis") {
  const Eigen::AngleAxis<D> angle_axis(angle, axis.cast<D>());
  const DMatrix r = angle_axis.toRotationMatrix();
  CHECK(near(values(r), rotation));
  CHECK(near(slopes(r), rate));
  CHECK(values(r) == rotation);
  CHECK(near(slopes((angle_axis * angle_axis).toRotationMatrix()),
             rate * rotation + rotation * rate));
  CHECK(near(slopes((angle_axis * angle_axis.inverse()).toRotationMatrix()),
             Matrix3d::Zero().eval()));
  CHECK(slopes((angle_axis * DVector(1, 2, 3)).eval()).isApprox(rate * Vector3d(1, 2, 3)));
  CHECK(angle_axis.cast<double>().angle() == 0.7);
  CHECK(Eigen::AngleAxis<D>(Eigen::AngleAxisd(rotation)).isApprox(angle_axis));
  CHECK(slopes((Eigen::Quaternion<D>::Identity() * angle_axis).toRotationMatrix()).isApprox(rate));
  CHECK(Eigen::AngleAxis<D>::Identity().toRotationMatrix() == DMatrix::Identity());
}

TEST_CASE("Eigen geometry over dual: Quaternion") {
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
             (skew(axis) * Eigen::AngleAxisd(0.35, axis).toRotationMatrix() / 2).eval()));
  const Eigen::Quaterniond plain(rotation);
  CHECK(near(slopes(plain.cast<D>().toRotationMatrix()), Matrix3d::Zero().eval()));
}

TEST_CASE("Eigen geometry over dual: Transform") {
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

// Members that the page "With Eigen" lists as right: zeros, equal values, identity, half turns.
/// Members of Eigen at structured inputs that move with t.
template <class T>
Eigen::Matrix<T, Eigen::Dynamic, 1> at_structured_points(const T& t) {
  using vector2 = Eigen::Matrix<T, 2, 1>;
  using vector3 = Eigen::Matrix<T, 3, 1>;
  using vector4 = Eigen::Matrix<T, 4, 1>;
  using quaternion = Eigen::Quaternion<T>;
  const T zero(0), one(1);
  const quaternion moving = quaternion(Eigen::AngleAxis<T>(t, vector3::UnitX())) *
                            quaternion(Eigen::AngleAxis<T>(T(2 * t + t * t), vector3::UnitZ()));
  Eigen::Matrix<T, Eigen::Dynamic, 1> all(0);
  const auto add = [&](const auto& x) {
    const auto size = all.size();
    all.conservativeResize(size + x.size());
    all.tail(x.size()) = x.reshaped();
  };
  for (const auto& q : {moving, quaternion(quaternion(zero, one, zero, zero) * moving),
                        quaternion(quaternion(zero, zero, one, zero) * moving),
                        quaternion(quaternion(zero, zero, zero, one) * moving)}) {
    add(quaternion(q.toRotationMatrix()).coeffs());
    add(q.inverse().coeffs());
    add(q.normalized().coeffs());
    Eigen::Transform<T, 3, Eigen::Affine> a;
    a.setIdentity();
    a.linear() = q.toRotationMatrix();
    a.linear()(0, 1) += t;
    a.translation() = vector3(t, zero, one);
    add(a.inverse().matrix().eval());
    add(a.inverse(Eigen::Isometry).matrix().eval());
    const Eigen::Transform<T, 3, Eigen::Projective> projective(a.matrix());
    add(projective.inverse().matrix().eval());
  }
  add(vector3(one, t, T(2 * t)).unitOrthogonal());
  add(vector4(t, T(3 * t), one, t).unitOrthogonal());
  add(vector3(t, zero, one).cross(vector3(zero, zero, T(1 + t))));
  add(vector4(t, zero, one, zero).cross3(vector4(zero, one, T(1 + t), zero)));
  add(vector3(t, zero, T(1 + t)).normalized());
  add(vector3(t, zero, T(1 + t)).stableNormalized());
  add(vector3(t, zero, T(1 + t)).hnormalized().eval());
  const auto line =
      Eigen::ParametrizedLine<T, 3>::Through(vector3(one, t, T(3)), vector3(one, zero, T(4)));
  const Eigen::Hyperplane<T, 3> plane(vector3(zero, t, one).normalized(), vector3(t, zero, zero));
  add(line.intersectionPoint(plane));
  add(line.projection(vector3(one, zero, zero)));
  add(plane.projection(vector3(one, T(2), zero)));
  const auto first = Eigen::Hyperplane<T, 2>::Through(vector2(zero, t), vector2(one, T(2 * t)));
  const auto second = Eigen::Hyperplane<T, 2>::Through(vector2(t, zero), vector2(T(3 * t), one));
  add(first.coeffs());
  add(first.intersection(second));
  Eigen::Rotation2D<T> a(t), b(T(7 - t)), c;
  c.fromRotationMatrix(a.toRotationMatrix());
  add(vector4(c.angle(), b.smallestAngle(), b.smallestPositiveAngle(), a.slerp(t, b).angle()));
  return all;
}

TEST_CASE("Eigen geometry over dual: members are right to third order at structured points") {
  CHECK(duet_test::error_to_third_order([](const auto& t) { return at_structured_points(t); }) <=
        1e-13);
}

} // namespace
} // namespace test_dual_eigen_geometry
