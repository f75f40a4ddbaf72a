// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "dual_quaternion/cases.hpp"
#include "support/test.hpp"

#include <duet/core/errors.hpp>
#include <duet/dual_quaternion/displacement.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Geometry>

// N17: rigid displacements of points, directions, lines and planes, against Eigen's isometries.

namespace test_dual_quaternion_pose {

using duet::conj, duet::real_part, duet_test::max_abs_difference, duet_test::poses,
    duet_test::vector;

using dual_quaternion = duet::dual_quaternion<double>;

namespace {

Eigen::Isometry3d isometry(const dual_quaternion& a) {
  const auto q = duet::rotation(a);
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()).toRotationMatrix();
  result.translation() = duet::translation(a);
  return result;
}

const vector point(0.7, -1.9, 0.4);
const vector direction(0.6, 0, -0.8);

} // namespace

/// Three-vectors and displacements, used by forward kinematics, are constant expressions.
namespace compiled {

using duet::detail::displacement, duet::detail::partially_constant_quaternion,
    duet::detail::static_number, duet::detail::three_vector;

constexpr bool are_equal(const three_vector<double>& a, const three_vector<double>& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}
constexpr three_vector<double> i{1, 0, 0}, j{0, 1, 0}, k{0, 0, 1}, a{2, -3, 5}, b{7, 11, -13};
static_assert(are_equal(cross(i, j), k) && are_equal(cross(j, k), i) && are_equal(cross(k, i), j));
static_assert(are_equal(cross(a, b), {-16, 61, 43}) && dot(a, cross(a, b)) == 0);
static_assert(are_equal(2 * a - b, {-3, -17, 23}) && dot(a, b) == -84);

// A half turn about y, a third of a turn about x + y + z.
constexpr displacement about_y{duet::quaternion<double>(0, 0, 1, 0), a};
constexpr displacement third{duet::quaternion<double>(.5, .5, .5, .5), b};
static_assert(are_equal(about_y.point(b), {-5, 8, 18}) && are_equal(third.point(a), {12, 13, -16}));
static_assert(are_equal((about_y * third).point(a), about_y.point(third.point(a))));
static_assert(are_equal((third * about_y).point(a), third.point(about_y.point(a))));

// Known zeros are preserved even if the other factor is infinite or NaN.
constexpr static_number<0> o;
constexpr static_number<1> one;
static_assert(std::is_same_v<decltype(o * 2.0), static_number<0>>);
static_assert(std::is_same_v<decltype(one - one), static_number<0>>);
static_assert(one * 3.0 == 3 && -one * 3.0 == -3 && one - 3.0 == -2 && 3.0 - one == 2);
static_assert(o - 3.0 == -3 && 3.0 - o == 3 && 3.0 + -one == 2);
constexpr displacement infinite_translation{
    partially_constant_quaternion{one, o, o, o},
    three_vector{o, o, std::numeric_limits<double>::infinity()}};
static_assert(std::is_same_v<decltype((infinite_translation * infinite_translation).rotation),
                             decltype(partially_constant_quaternion{one, o, o, o})>);
static_assert((infinite_translation * infinite_translation).translation.z ==
              std::numeric_limits<double>::infinity());

} // namespace compiled

TEST_CASE("pose: rotation, translation and coordinates are recovered") {
  for (const auto& a : poses()) {
    const auto again = duet::pose(duet::rotation(a), duet::translation(a));
    CHECK(max_abs_difference(again, a) < 1e-15);
    const dual_quaternion from_matrix = duet::from_transform_matrix(duet::transform_matrix(a));
    CHECK(std::min(max_abs_difference(from_matrix, a), max_abs_difference(from_matrix, -a)) <
          1e-14);
  }
  const auto b = duet::pose(duet::from_rotation_vector(vector(0.1, 0.2, 0.3)), vector(1, -2, 3));
  CHECK(max_abs_difference(duet::translation(b), vector(1, -2, 3)) < 1e-15);
}

TEST_CASE("pose: matrices, points and directions agree with Eigen's isometries") {
  for (const auto& a : poses()) {
    const auto expected = isometry(a);
    CHECK(max_abs_difference(duet::transform_matrix(a), expected.matrix()) < 1e-14);
    CHECK(max_abs_difference(duet::transform_point(a, point), expected * point) < 1e-14);
    CHECK(max_abs_difference(duet::transform_direction(a, direction),
                             expected.linear() * direction) < 1e-14);
  }
}

TEST_CASE("pose: products compose displacements, the conjugate is the inverse") {
  const auto all = poses();
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    const auto& a = all[i];
    const auto& b = all[i + 1];
    CHECK(max_abs_difference(duet::transform_matrix(a * b), (isometry(a) * isometry(b)).matrix()) <
          2e-14);
    CHECK(max_abs_difference(duet::transform_point(conj(a), duet::transform_point(a, point)),
                             point) < 1e-14);
  }
}

TEST_CASE("N15: point_conj transforms points, A (1 + εx) A^(3) = 1 + ε(Rx + t)") {
  for (const auto& a : poses()) {
    const auto x = duet::make_dual_quaternion(duet::quaternion<double>(1.0),
                                              duet::quaternion<double>(0.0, point));
    const auto moved = a * x * duet::point_conj(a);
    CHECK(max_abs_difference(duet::dual_part(moved).vec(), duet::transform_point(a, point)) <
          1e-14);
    CHECK(std::abs(duet::dual_part(moved).w()) < 1e-15);
  }
}

TEST_CASE("transform_line and transform_plane: agree with transformed points") {
  for (const auto& a : poses()) {
    const auto line = duet::make_dual_vector(direction, vector(point.cross(direction)));
    const auto moved = duet::transform_line(a, line);
    const vector moved_point = duet::transform_point(a, point);
    const vector moved_direction = duet::transform_direction(a, direction);
    CHECK(max_abs_difference(real_part(moved), moved_direction) < 1e-14);
    CHECK(max_abs_difference(duet::dual_part(moved), moved_point.cross(moved_direction)) < 4e-14);

    const duet::plane<double> plane{direction, direction.dot(point)};
    const auto moved_plane = duet::transform_plane(a, plane);
    CHECK(std::abs(moved_plane.normal.dot(moved_point) - moved_plane.offset) < 2e-14);
  }
}

TEST_CASE("from_transform_matrix: rejects matrices that are not rigid") {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m(3, 0) = 0.5;
  DUET_CHECK_REFUSED("duet: from_transform_matrix: the last row is 0.5 0 0 1 (expected 0 0 0 1)",
                     duet::from_transform_matrix(m));
  m(3, 0) = 0;
  m(0, 0) = 2;
  CHECK_THROWS_AS(static_cast<void>(duet::from_transform_matrix(m)), duet::invalid_input);
}

TEST_CASE("pose: accepts a rotation matrix and a translation") {
  const duet::quaternion<double> q = duet::from_rotation_vector(Eigen::Vector3d(.1, -.2, 3));
  const Eigen::Vector3d t(1, -2, 3);
  const auto a = duet::pose(duet::rotation_matrix(q), t);
  CHECK(duet::transform_matrix(a).isApprox(duet::transform_matrix(duet::pose(q, t)), 1e-15));
  CHECK(duet::translation(a).isApprox(t, 1e-15));
  DUET_CHECK_REFUSED(doctest::Contains("rotation"),
                     duet::pose(Eigen::Matrix3d(2 * duet::rotation_matrix(q)), t));
}

TEST_CASE("pose: rejects a rotation that is not a unit quaternion") {
  const vector t(1, 2, 3);
  DUET_CHECK_REFUSED(
      "duet: pose: the rotation (2, 0, 0, 0) is not a unit quaternion (use normalized(q))",
      duet::pose(duet::quaternion<double>(2), t));
  CHECK_THROWS_AS(static_cast<void>(duet::pose(duet::quaternion<double>(), t)),
                  duet::invalid_input);
  CHECK_THROWS_AS(static_cast<void>(duet::pose(duet::quaternion<double>(.707, .707, 0, 0), t)),
                  duet::invalid_input);
  const auto rounded = duet::pose(duet::quaternion<double>(.7071068, .7071068, 0, 0), t);
  CHECK(max_abs_difference(duet::translation(rounded), t) < 1e-6);
  CHECK(std::isnan(duet::pose(duet::quaternion<double>(NAN), t).w().value()));
}

} // namespace test_dual_quaternion_pose
