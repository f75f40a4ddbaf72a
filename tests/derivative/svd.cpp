// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/differences.hpp"
#include "support/message.hpp"
#include "support/test.hpp"

#include <duet/derivative/gradient.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/derivative/nearest_rotation.hpp>
#include <duet/derivative/svd.hpp>

// Singular values and vectors, and the nearest rotation: derivatives against differences in 100
// digits, where singular values are equal or zero, too.

namespace test_derivative_svd {
namespace {

using duet::dual, duet::nearest_rotation, duet::singular_values, duet::svd,
    duet_test::error_to_third_order, Eigen::Dynamic, Eigen::Matrix3d, Eigen::MatrixXd,
    Eigen::Vector3d;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A matrix of the size of `value` that moves through it, every entry at its own rate.
template <int Rows, int Columns, class T>
Eigen::Matrix<T, Rows, Columns> moving(const MatrixXd& value, const T& t) {
  Eigen::Matrix<T, Rows, Columns> a(value.rows(), value.cols());
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      const double rate = double((5 * i + 3 * j) % 7) - 3;
      a(i, j) = value(i, j) + rate * t + (rate + 1) * t * t / 4;
    }
  }
  return a;
}

Matrix3d diagonal(double x, double y, double z) { return Vector3d(x, y, z).asDiagonal(); }

Matrix3d dense() { return Matrix3d{{4, 1, .5}, {-.5, 3, .25}, {.75, .5, 2}}; }

Matrix3d quarter_turn() { return Matrix3d{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}; }

/// σ, u vᵀ and the squares of u and v, which do not depend on signs.
template <class T>
Eigen::Matrix<T, Dynamic, Dynamic> without_signs(const auto& s, const T&) {
  const auto m = s.u.rows(), n = s.v.rows(), k = s.values.size();
  Eigen::Matrix<T, Dynamic, Dynamic> all(m * n + m + n + 1, k);
  for (Eigen::Index i = 0; i < k; ++i) {
    const Eigen::Matrix<T, Dynamic, 1> u = s.u.col(i), v = s.v.col(i);
    all.col(i) << u.lazyProduct(v.transpose()).reshaped(), u.cwiseAbs2(), v.cwiseAbs2(),
        s.values[i];
  }
  return all;
}

template <class A>
std::string message(const A& a) {
  return duet_test::message_of([&] { static_cast<void>(svd(a)); });
}
template <class A>
std::string message_of_nearest(const A& a) {
  return duet_test::message_of([&] { static_cast<void>(nearest_rotation(a)); });
}

TEST_CASE("svd: derivatives to third order at dense, diagonal and reflected matrices") {
  for (const Matrix3d& a : {dense(), diagonal(3, 1, 2), diagonal(3, 2, -1), diagonal(-1, -5, -2),
                            Matrix3d(quarter_turn() * diagonal(2, 3, 1))}) {
    CHECK(error_to_third_order(
              [&](const auto& t) { return without_signs(svd(moving<3, 3>(a, t)), t); }) <= 2e-13);
  }
}

TEST_CASE("svd: tall and wide matrices, sizes known at compile time or not") {
  const MatrixXd tall{{1, 0}, {0, 2}, {0, 0}, {0, 0}};
  for (const MatrixXd& a : {tall, MatrixXd(tall.transpose()), MatrixXd{{3, 0, 0}}}) {
    CHECK(error_to_third_order([&](const auto& t) {
            return without_signs(svd(moving<Dynamic, Dynamic>(a, t)), t);
          }) <= 2e-13);
  }
  using D = dual<double>;
  Eigen::Matrix<D, 4, 2> known = tall.cast<D>();
  known(3, 0) = D(0, 2);
  known(1, 1) = D(2, 3);
  const auto s = svd(known);
  static_assert(std::is_same_v<std::decay_t<decltype(s.u)>, Eigen::Matrix<D, 4, 2>>);
  CHECK(s.values[0].epsilon() == 3);
  CHECK((s.u(3, 1) * s.v(0, 1)).epsilon() == 2);
}

TEST_CASE("svd: values equal Eigen's and reproduce the matrix") {
  for (const MatrixXd& a : {MatrixXd(dense()), MatrixXd(MatrixXd::Identity(5, 2)),
                            MatrixXd(MatrixXd::Zero(2, 3)), MatrixXd(1e300 * dense())}) {
    const auto s = svd(a);
    CHECK((s.u * s.values.asDiagonal() * s.v.transpose() - a).norm() <= 1e-15 * a.norm());
    CHECK(singular_values(a) == s.values);
    CHECK((s.u.transpose() * s.u).isIdentity(1e-15));
    CHECK((s.v.transpose() * s.v).isIdentity(1e-15));
  }
}

TEST_CASE("singular_values: simple ones have derivatives, others NaN") {
  using D = dual<double, 2>;
  Eigen::Matrix<D, 3, 3> a = diagonal(5, 2, 2).cast<D>();
  a(0, 0) = D::variable(5, 0);
  a(0, 1) = D(0);
  a(1, 1).set_partial(0, 1);
  const auto s = singular_values(a);
  CHECK(s[0].partial(0) == 1);
  CHECK(s[0].partial(1) == 0);
  CHECK(std::isnan(s[1].partial(0)));
  CHECK(s[1].partial(1) == 0); // nothing depends on it
  CHECK(std::isnan(s[2].partial(0)));
  const auto norm = [](const auto& x) {
    using T = std::decay_t<decltype(x[0])>;
    Eigen::Matrix<T, 2, 3> m;
    m << x[0], x[1], T(0), x[2], T(0), x[3];
    return singular_values(m)[0];
  };
  // σ₁ beside σ₂ = 0
  const Eigen::Vector4d slopes = duet::gradient(norm, Eigen::Vector4d(3, 4, 0, 0)).gradient;
  CHECK((slopes - Eigen::Vector4d(.6, .8, 0, 0)).norm() <= 1e-15);
}

TEST_CASE("svd: a repeated or zero singular value throws unless A is constant") {
  using D = dual<double>;
  Eigen::Matrix<D, 3, 3> a = diagonal(2, 5, 2).cast<D>();
  CHECK(message(a) == "");
  a(2, 0) = D(0, 1);
  CHECK(message(a) == "duet: svd: singular value 1, 2, has no derivatives, as it is 0 or equal to "
                      "another and A is not constant");
  a(2, 2) = D(0);
  CHECK(message(a) == "duet: svd: singular value 2, 0, has no derivatives, as it is 0 or equal to "
                      "another and A is not constant");
  CHECK(message(MatrixXd(0, 3)) == "duet: svd: A is empty");
  CHECK(message(MatrixXd::Constant(1, 1, nan)) == "duet: svd: entry (0, 0) of A is not finite");
}

TEST_CASE("nearest_rotation: derivatives to third order, also at equal and zero singular values") {
  const Matrix3d identity = Matrix3d::Identity();
  for (const Matrix3d& a :
       {identity, dense(), Matrix3d(-dense()), quarter_turn(), diagonal(1, -1, -1),
        diagonal(2, 2, 5), diagonal(3, 2, -1), diagonal(2, 2, -1), diagonal(3, 0, 1),
        diagonal(-3, 0, -3), Matrix3d(1e-9 * dense()), Matrix3d(7e9 * quarter_turn())}) {
    CAPTURE(a);
    const double size = a.norm();
    CHECK(error_to_third_order([&](const auto& t) {
            using T = std::decay_t<decltype(t)>;
            return nearest_rotation(moving<3, 3>(a, T(t * size / 8)));
          }) <= 2e-14);
  }
}

TEST_CASE("nearest_rotation: closed form of two rows, skew part at the identity of four") {
  using series = duet::taylor<double, 3>;
  for (const MatrixXd& value : {MatrixXd{{0, 2}, {-2, 0}}, MatrixXd{{1, 2}, {4, 5}}}) {
    const auto a = moving<Dynamic, Dynamic>(value, series::variable(0));
    const series angle = atan2(a(1, 0) - a(0, 1), a(0, 0) + a(1, 1));
    const auto r = nearest_rotation(a);
    for (int k = 0; k <= 3; ++k) {
      CHECK(std::abs((r(0, 0) - cos(angle)).derivative(k)) <= 1e-13);
      CHECK(std::abs((r(1, 0) - sin(angle)).derivative(k)) <= 1e-13);
    }
  }
  const auto a = moving<Dynamic, Dynamic>(MatrixXd::Identity(4, 4), series::variable(0));
  const auto r = nearest_rotation(a);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      CHECK(r(i, j).derivative(1) == (a(i, j) - a(j, i)).derivative(1) / 2);
    }
  }
}

TEST_CASE(
    "nearest_rotation: recovers the rotation of a rotation times a symmetric matrix at any scale") {
  for (const double size : {1e-300, 1.0, 1e300}) {
    for (const Matrix3d& a : {dense(), diagonal(3, 2, -1), diagonal(4, 0, 2)}) {
      const Matrix3d r = nearest_rotation(Matrix3d(size * a));
      CHECK((r.transpose() * r).isIdentity(2e-15));
      CHECK(r.determinant() == doctest::Approx(1).epsilon(1e-15));
      const Matrix3d s = r.transpose() * a;
      CHECK((s - s.transpose()).norm() <= 1e-14);
    }
  }
  CHECK(nearest_rotation(Eigen::Matrix3i::Identity().eval()) == Matrix3d::Identity());
  CHECK(nearest_rotation(Eigen::Matrix<double, 1, 1>(-2)) == MatrixXd::Identity(1, 1));
}

TEST_CASE("nearest_rotation: throws if the nearest rotation is not unique") {
  const std::string several =
      "duet: nearest_rotation: the nearest rotation is not unique: the smallest two singular "
      "values, the last with the sign of det A, add up to ";
  for (const Matrix3d& a : {Matrix3d(Matrix3d::Zero()), Matrix3d(-Matrix3d::Identity()),
                            diagonal(3, 0, 0), diagonal(3, 2, -2)}) {
    CHECK(message_of_nearest(a) == several + "0");
  }
  const Vector3d line(.1, .2, .3);
  CHECK(message_of_nearest(Matrix3d(line * Vector3d(.3, .7, .9).transpose())).find(several) == 0);
  CHECK(message_of_nearest(MatrixXd(2, 3)) ==
        "duet: nearest_rotation: A is 2 x 3, but must be square");
  CHECK(message_of_nearest(MatrixXd(0, 0)) == "duet: nearest_rotation: A is empty");
}

} // namespace
} // namespace test_derivative_svd
