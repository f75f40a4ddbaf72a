// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "dual_quaternion/cases.hpp"
#include "support/shared_tag.hpp"
#include "support/test.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/derivative/tangent_coordinates.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/dual_quaternion/twist.hpp>

// N18: twists in three frames, Ad and ad, and Jacobians with respect to poses and of poses.

namespace test_dual_quaternion_twist {
namespace {

using duet::Ad, duet::ad, duet::twist, duet::vector6, duet_test::max_abs_difference,
    duet_test::poses, duet_test::vector;
namespace frame = duet::frame;

const vector6<double> v_body = (vector6<double>() << 0.3, -1, 2, 0.5, 0.7, -0.2).finished();
const vector point(0.7, -1.9, 0.4);

duet::matrix3<double> hat(const vector& w) {
  return duet::ad<double>((vector6<double>() << 0, 0, 0, w).finished()).topLeftCorner<3, 3>();
}

TEST_CASE("N18: twist agrees with the motion of rotation and translation in all frames") {
  // A(t): rotation exp(½ w t) q, translation p + u t + ½ a t².
  const auto q = duet::from_rotation_vector(vector(0.2, 0.5, -1));
  const vector w(0.4, -0.3, 0.9), p(1, 2, 3), u(-1, 0.5, 0.25), a(2, 0, 1);
  const auto motion = [&](auto t) {
    return duet::pose(duet::from_rotation_vector((w * t).eval()) * q,
                      (p + u * t + a * (t * t / 2)).eval());
  };
  const double t = 0.6;
  const auto [pose, rate] = duet::derivative<duet_test::shared_tag>(motion, t);
  const vector velocity = u + a * t;
  const vector position = duet::translation(pose);
  const auto R = duet::rotation_matrix(duet::rotation(pose));
  vector6<double> expected;
  expected << velocity + position.cross(w), w;
  CHECK(max_abs_difference(twist(pose, rate, frame::spatial), expected) < 1e-14);
  expected << R.transpose() * velocity, R.transpose() * w;
  CHECK(max_abs_difference(twist(pose, rate, frame::body), expected) < 1e-14);
  expected << velocity, w;
  CHECK(max_abs_difference(twist(pose, rate, frame::hybrid), expected) < 1e-14);
}

TEST_CASE("N18: pose_rate inverts twist, Ad changes the frame") {
  for (const auto& a : poses()) {
    const auto rate = duet::pose_rate(a, v_body, frame::body);
    CHECK(max_abs_difference(twist(a, rate, frame::body), v_body) < 1e-14);
    const vector6<double> v_spatial = twist(a, rate, frame::spatial);
    CHECK(max_abs_difference(v_spatial, Ad(a) * v_body) < 4e-14);
    CHECK(max_abs_difference(duet::pose_rate(a, v_spatial, frame::spatial), rate) < 4e-14);
    CHECK(max_abs_difference(duet::pose_rate(a, twist(a, rate, frame::hybrid), frame::hybrid),
                             rate) < 4e-14);
    // Twists transform as lines: Ad(A) V is A V A*.
    CHECK(max_abs_difference(duet::twist_of(duet::transform_line(a, duet::dual_vector_of(v_body))),
                             v_spatial) < 4e-14);
  }
}

TEST_CASE("Ad is a homomorphism, ad is its derivative and the Lie bracket") {
  const auto all = poses();
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    CHECK(max_abs_difference(Ad(all[i] * all[i + 1]), Ad(all[i]) * Ad(all[i + 1])) < 4e-14);
  }
  const vector6<double> w = (vector6<double>() << 1, 0.4, -0.3, -0.8, 0.1, 0.6).finished();
  const auto moved = [&](auto t) {
    const auto step = exp((duet::dual_vector_of(v_body) * (t / 2)).eval());
    return (Ad(step) * w).eval();
  };
  CHECK(max_abs_difference(duet::derivative<duet_test::shared_tag>(moved, 0).derivative,
                           ad(v_body) * w) < 1e-15);
  CHECK(max_abs_difference(ad(v_body) * w, -(ad(w) * v_body)) < 1e-15);
}

TEST_CASE("Jacobians of poses: spatial and body frames agree with Ad and closed forms") {
  for (const auto& a : poses()) {
    const auto position = [](const auto& x) { return duet::transform_point(x, point); };
    const auto body = duet::jacobian<duet_test::shared_tag>(position, a, frame::body).jacobian;
    const auto R = duet::rotation_matrix(duet::rotation(a));
    Eigen::Matrix<double, 3, 6> expected;
    expected.leftCols<3>() = R;
    for (int j = 0; j < 3; ++j) {
      expected.col(3 + j) = R * vector(vector::Unit(j)).cross(point);
    }
    CHECK(max_abs_difference(body, expected) < 1e-14);
    CHECK(max_abs_difference(
              duet::jacobian<duet_test::shared_tag>(position, a, frame::spatial).jacobian * Ad(a),
              body) < 4e-14);

    const auto inverse = [](const auto& x) { return conj(x); };
    CHECK(
        max_abs_difference(duet::jacobian<duet_test::shared_tag>(inverse, a, frame::body).jacobian,
                           -Ad(a)) < 1e-14);
  }
}

TEST_CASE("Jacobians of poses: the hybrid frame moves origin and rotation independently") {
  for (const auto& a : poses()) {
    const duet::matrix3<double> R = duet::rotation_matrix(duet::rotation(a));
    const vector t = duet::translation(a);
    const auto with_rotation = [](const duet::matrix3<double>& by_v,
                                  const duet::matrix3<double>& by_w) {
      Eigen::Matrix<double, 3, 6> m;
      m << by_v, by_w;
      return m;
    };
    const duet::matrix3<double> one = duet::matrix3<double>::Identity();
    const duet::matrix3<double> zero = duet::matrix3<double>::Zero();

    const auto position = [](const auto& x) { return duet::transform_point(x, point); };
    CHECK(max_abs_difference(
              duet::jacobian<duet_test::shared_tag>(position, a, frame::hybrid).jacobian,
              with_rotation(one, -hat(R * point))) < 1e-14);

    const auto same = [](const auto& x) { return x; };
    const auto [value, J] = duet::jacobian<duet_test::shared_tag>(same, a, frame::hybrid);
    CHECK(value == a);
    CHECK(max_abs_difference(J, duet::matrix6<double>::Identity()) < 4e-14);

    // (R, t) ↦ (Rᵀ, −Rᵀt)
    const auto inverse = [](const auto& x) { return conj(x); };
    const auto of_inverse =
        duet::jacobian<duet_test::shared_tag>(inverse, a, frame::hybrid).jacobian;
    CHECK(max_abs_difference(of_inverse.topRows<3>(),
                             with_rotation(-R.transpose(), -R.transpose() * hat(t))) < 4e-14);
    CHECK(max_abs_difference(of_inverse.bottomRows<3>(), with_rotation(zero, -R.transpose())) <
          1e-14);
  }
}

TEST_CASE("Jacobians: a pose, a rotation and a number together in the hybrid frame") {
  const auto a = poses().front();
  const auto q = duet::from_rotation_vector(vector(0.2, 0.5, -1));
  const auto f = [](const auto& x, const auto& r, const auto& s) {
    return (duet::translation(x) + duet::rotate(r * duet::rotation(x), point) * s).eval();
  };
  const auto J =
      duet::jacobian<duet_test::shared_tag>(f, std::tuple(a, q, 2.0), frame::hybrid).jacobian;
  const vector rotated_point = duet::rotate(q * duet::rotation(a), point);
  CHECK(max_abs_difference(J.leftCols<3>(), duet::matrix3<double>::Identity()) < 1e-15);
  CHECK(max_abs_difference(J.middleCols<3>(3), -2 * hat(rotated_point) * duet::rotation_matrix(q)) <
        4e-14);
  CHECK(max_abs_difference(J.middleCols<3>(6), -2 * hat(rotated_point)) < 4e-14);
  CHECK(max_abs_difference(J.col(9), rotated_point) < 1e-14);
}

TEST_CASE("gradient and hessian: half the squared distance of a point, with respect to a pose") {
  const vector goal(2, -0.5, 1.5);
  const auto f = [&](const auto& x) {
    return ((duet::transform_point(x, point) - goal).squaredNorm() / 2);
  };
  for (const auto& a : poses()) {
    const auto [value, g, H] = duet::hessian(f, a, frame::hybrid);
    const vector r = duet::rotate(duet::rotation(a), point);
    const vector d = duet::translation(a) + r - goal;
    const double scale = 1 + d.squaredNorm();
    vector6<double> slope;
    slope << d, r.cross(d);
    CHECK(max_abs_difference(g, slope) < 1e-14 * scale);
    CHECK(max_abs_difference(duet::gradient<duet_test::shared_tag>(f, a, frame::hybrid).gradient,
                             slope) < 1e-14 * scale);
    // ½|d + v + ω × r + ½ ω × (ω × r)|² to second order
    duet::matrix6<double> expected;
    expected.topLeftCorner<3, 3>().setIdentity();
    expected.topRightCorner<3, 3>() = -hat(r);
    expected.bottomLeftCorner<3, 3>() = hat(r);
    expected.bottomRightCorner<3, 3>() = hat(r).transpose() * hat(r) +
                                         (d * r.transpose() + r * d.transpose()) / 2 -
                                         r.dot(d) * duet::matrix3<double>::Identity();
    CHECK(max_abs_difference(H, expected) < 1e-14 * scale);
    // Along screws the Hessian has one form in both axes.
    const duet::matrix6<double> spatial = duet::hessian(f, a, frame::spatial).hessian;
    CHECK(max_abs_difference(Ad(a).transpose() * spatial * Ad(a),
                             duet::hessian(f, a, frame::body).hessian) < 1e-13 * scale * scale);
  }
}

TEST_CASE("hybrid frame: perturbing a pose far from the origin does not lose accuracy") {
  const auto a =
      duet::pose(duet::from_rotation_vector(vector(0.3, -0.2, 1.1)), vector(1e8, 3e8, -1e8));
  const vector6<double> none = vector6<double>::Zero();
  CHECK(duet::manifold<duet::dual_quaternion<double>>::plus(a, none, frame::hybrid) == a);
  // A large perturbation gives the expected pose.
  const vector6<double> much = (vector6<double>() << 1, 2, 3, 2.5, -0.4, 1.3).finished();
  for (const auto& b : poses()) {
    const auto moved = duet::manifold<duet::dual_quaternion<double>>::plus(b, much, frame::hybrid);
    CHECK(max_abs_difference(duet::translation(moved), duet::translation(b) + vector(1, 2, 3)) <
          4e-15);
    CHECK(max_abs_difference(
              duet::rotation_matrix(duet::rotation(moved)),
              duet::rotation_matrix(duet::from_rotation_vector(vector(2.5, -0.4, 1.3)) *
                                    duet::rotation(b))) < 4e-15);
  }
}

TEST_CASE("twist_between: the inverse of the perturbation, in every frame") {
  using manifold = duet::manifold<duet::dual_quaternion<double>>;
  const vector6<double> delta = (vector6<double>() << 1, 2, -3, 1.5, -0.4, 1.3).finished();
  for (const auto& a : poses()) {
    const auto check = [&](auto frame_of_delta) {
      const auto b = manifold::plus(a, delta, frame_of_delta);
      const double scale = 1 + duet::translation(a).norm();
      CHECK((twist_between(a, b, frame_of_delta) - delta).norm() < 1e-14 * scale);
      CHECK((twist_between(a, -b, frame_of_delta) - delta).norm() < 1e-14 * scale);
      CHECK(twist_between(a, a, frame_of_delta).norm() < 1e-15 * scale);
    };
    check(frame::spatial);
    check(frame::body);
    check(frame::hybrid);
  }
}

TEST_CASE("twist_between: its derivative at equal poses is the tangent") {
  const auto a = poses().front();
  const auto error = [&](const auto& b) { return twist_between(a, b, frame::body); };
  CHECK(
      (duet::jacobian(error, a, frame::body).jacobian - duet::matrix6<double>::Identity()).norm() <
      1e-14);
}

} // namespace
} // namespace test_dual_quaternion_twist
