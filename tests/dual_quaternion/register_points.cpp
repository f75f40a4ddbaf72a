// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/differences.hpp"
#include "support/message.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/derivative/jacobian.hpp>
#include <duet/dual_quaternion/register_points.hpp>

// Registration of points: derivatives against differences in 100 digits, poses against those that
// made the points.

namespace test_dual_quaternion_register_points {
namespace {

using duet::register_points, duet::register_points_with_scale, duet_test::error_to_third_order,
    Eigen::Matrix3d, Eigen::MatrixXd, Eigen::Vector3d;
using points = Eigen::Matrix<double, 3, 4>;

const points tetrahedron{{0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
const points square{{1, 0, -1, 0}, {0, 1, 0, -1}, {0, 0, 0, 0}};

/// Registration of `from` with its image under a half turn about x that moves on with t, times
/// `size`; with `noise`, single points of both sets move as well.
template <class T>
Eigen::Matrix<T, 3, 4> target(const points& from, const T& t, double size, bool noise) {
  const auto q = duet::from_rotation_vector(duet::vector3<T>(T(t + t * t), T(2 * t), T(-t)));
  Eigen::Matrix<T, 3, 4> to = duet::rotation_matrix(q) * from.cast<T>();
  to.bottomRows(2) *= T(-1);
  to *= T(size + t);
  to.colwise() += Eigen::Matrix<T, 3, 1>(T(3), T(t), T(-2));
  if (noise) {
    to(0, 1) += t + .25;
    to(2, 2) -= t * t;
  }
  return to;
}

TEST_CASE("register_points: derivatives to third order for exact, noisy, planar, mirrored sets") {
  for (const points& from : {tetrahedron, square}) {
    for (const bool noise : {false, true}) {
      CHECK(error_to_third_order([&](const auto& t) {
              using T = std::decay_t<decltype(t)>;
              Eigen::Matrix<T, 3, 4> moved = from.template cast<T>();
              moved(1, 1) += t;
              const auto to = target(from, t, 2.5, noise);
              const auto scaled = register_points_with_scale(moved, to, {1, 2, 3, 4});
              Eigen::Matrix<T, 8, 4> all;
              all << duet::transform_matrix(scaled.pose),
                  duet::transform_matrix(register_points(moved, to));
              all(3, 0) = scaled.scale;
              return all;
            }) <= 1e-12);
    }
  }
  points reflected = tetrahedron;
  reflected.row(0) *= -3;
  const auto reflection = [&](const auto& t) {
    return duet::rotation_matrix(
        rotation(register_points(reflected, target(tetrahedron, t, 1, false))));
  };
  CHECK(error_to_third_order(reflection) <= 1e-12);
}

TEST_CASE("register_points_with_scale: recovers pose and scale at any size and distance") {
  duet_test::random_source random(1);
  for (const double size : {1e-200, 1e-3, 1.0, 1e200}) {
    for (const int count : {3, 4, 50}) {
      MatrixXd p(3, count);
      for (Eigen::Index i = 0; i < p.size(); ++i) {
        p(i) = size * random.uniform(-1, 1);
      }
      const auto d = random.direction<4>();
      const duet::quaternion<double> rotation(d[0], d[1], d[2], d[3]);
      const Matrix3d r = duet::rotation_matrix(rotation);
      const Vector3d t = size * Vector3d(1, -20, 3);
      const MatrixXd q = (.25 * r * p).colwise() + t;
      const auto result = register_points_with_scale(p, q);
      CHECK(result.scale == doctest::Approx(.25).epsilon(1e-12));
      const Eigen::Matrix4d m = duet::transform_matrix(result.pose);
      CHECK((m.topLeftCorner<3, 3>() - r).norm() <= 1e-12);
      CHECK((m.topRightCorner<3, 1>() / size - t / size).norm() <= 1e-11);
      const Eigen::Matrix4d rigid =
          duet::transform_matrix(register_points(p, MatrixXd((r * p).colwise() + t)));
      CHECK((rigid.topLeftCorner<3, 3>() - r).norm() <= 1e-12);
      CHECK((rigid.topRightCorner<3, 1>() / size - t / size).norm() <= 1e-11);
    }
  }
}

TEST_CASE("register_points: weight 0 omits a point, weight 2 counts it twice") {
  points p = tetrahedron, q = tetrahedron;
  q(0, 3) = 7;
  MatrixXd without = p.leftCols(3), twice(3, 5);
  twice << q, q.col(1);
  MatrixXd p_twice(3, 5);
  p_twice << p, p.col(1);
  const auto equal = [](const auto& a, const auto& b) {
    return norm(rotation(a) - rotation(b)) + (translation(a) - translation(b)).norm() <= 1e-15;
  };
  CHECK(equal(register_points(p, q, {1, 1, 1, 0}), register_points(without, without)));
  CHECK(equal(register_points(p, q, {1, 2, 1, 1}), register_points(p_twice, twice)));
  CHECK(equal(register_points(p, q, {1e308, 1e308, 1e308, 1e308}), register_points(p, q)));
}

TEST_CASE("register_points: rejects sets that determine no rotation") {
  const auto message = [](const MatrixXd& p, const MatrixXd& q, const std::vector<double>& w = {}) {
    return duet_test::message_of([&] { static_cast<void>(register_points(p, q, w)); });
  };
  const std::string undetermined = "duet: register_points: the points do not determine a rotation";
  duet_test::random_source random(2);
  for (int k = 0; k < 100; ++k) { // on a line, except for the rounding of coordinates
    const auto d = random.direction<3>();
    const Vector3d direction(d[0], d[1], d[2]), start = 100 * Vector3d(d[2], d[0], d[1]);
    MatrixXd line(3, 6), others(3, 6);
    for (int i = 0; i < 6; ++i) {
      line.col(i) = start + random.uniform(-1, 1) * direction;
      others.col(i) = Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    }
    CHECK(message(line, line).find(undetermined) == 0);
    CHECK(message(line, others).find(undetermined) == 0);
    CHECK(message(others, line).find(undetermined) == 0);
  }
  CHECK(message(square.leftCols(2), square.leftCols(2)).find(undetermined) == 0);
  CHECK(message(MatrixXd::Constant(3, 5, .1), MatrixXd::Random(3, 5)).find(undetermined) == 0);
  const MatrixXd octahedron{{1, -1, 0, 0, 0, 0}, {0, 0, 1, -1, 0, 0}, {0, 0, 0, 0, 1, -1}};
  CHECK(message(octahedron, -octahedron).find(undetermined) == 0);
  CHECK(message(octahedron, octahedron, {1, 1, 0, 0, 0, 0}).find(undetermined) == 0);
  CHECK(message(MatrixXd(3, 0), MatrixXd(3, 0)) == "duet: register_points: there are no elements");
  CHECK(message(octahedron, square) ==
        "duet: register_points: the sets have 6 and 4 points (expected equal numbers)");
  CHECK(message(MatrixXd(2, 4), square) == "duet: register_points: the matrices have 2 and 3 rows "
                                           "(expected 3 rows: points are columns)");
  CHECK(message(octahedron, octahedron, {1}) ==
        "duet: register_points: 1 weights for 6 elements (expected as many weights as elements)");
  MatrixXd infinite = square;
  infinite(1, 2) = std::numeric_limits<double>::infinity();
  CHECK(message(square, infinite) == "duet: register_points: entry (1, 2) of A is not finite");
}

} // namespace
} // namespace test_dual_quaternion_register_points
