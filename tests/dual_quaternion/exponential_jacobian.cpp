// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "dual_quaternion/cases.hpp"
#include "support/identical.hpp"
#include "support/shared_tag.hpp"
#include "support/test.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/dual_quaternion/exponential_jacobian.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/interop/multiprecision.hpp>
#include <duet/quaternion/exponential.hpp>

// The Jacobians of the exponential in closed form, against AD and 50 digits.

namespace test_dual_quaternion_exponential_jacobian {
namespace {

using duet::vector6, duet_test::max_abs_difference, duet_test::vector;
using twist = vector6<double>;

twist make_twist(const vector& v, const vector& w) {
  twist x;
  x << v, w;
  return x;
}

/// Zero, tiny, translations, half turn, both sides of the switch of series, near a full turn.
std::vector<twist> twists() {
  std::vector<twist> result;
  const vector zero = vector::Zero();
  for (const vector& w : {zero, vector(1e-160, 0, 0), vector(1e-8, 2e-8, 0), vector(1e-4, 0, -1e-4),
                          vector(0, 1.2, 1.59), vector(0, 1.2, 1.61),
                          vector(3.141592653589793, 0, 0), vector(2, -3, 1), vector(3.6, 0, 4.8)}) {
    for (const vector& v : {zero, vector(0, 0, 1), vector(-3, 1, 0.5)}) {
      result.push_back(make_twist(v, w));
    }
  }
  return result;
}

template <class T>
auto pose_of(const vector6<T>& x) {
  return duet::exp(duet::dual_vector<T>(duet::dual_vector_of(x) * 0.5));
}

TEST_CASE("left_jacobian and right_jacobian: agree with rates of poses by AD") {
  for (const twist& x : twists()) {
    CAPTURE(x.transpose());
    const twist x_dot = make_twist(vector(0.7, -0.4, 0.2), vector(-0.3, 0.5, 0.9));
    const auto [a, a_dot] = duet::derivative<duet_test::shared_tag>(
        [&](auto t) {
          using S = decltype(t);
          return pose_of<S>(x.cast<S>() + t * x_dot.cast<S>());
        },
        0.0);
    const double size = 1 + x.head<3>().norm();
    CHECK(max_abs_difference(duet::left_jacobian(x) * x_dot,
                             duet::twist(a, a_dot, duet::frame::spatial)) < 2e-15 * size * size);
    CHECK(max_abs_difference(duet::right_jacobian(x) * x_dot,
                             duet::twist(a, a_dot, duet::frame::body)) < 2e-15 * size * size);
    CHECK(max_abs_difference(duet::left_jacobian(x), duet::Ad(a) * duet::right_jacobian(x)) <
          4e-15 * size * size);
  }
}

TEST_CASE("left_jacobian_inverse and right_jacobian_inverse: inverse except at a full turn") {
  for (const twist& x : twists()) {
    CAPTURE(x.transpose());
    const duet::matrix6<double> one = duet::matrix6<double>::Identity();
    CHECK(max_abs_difference(duet::left_jacobian_inverse(x) * duet::left_jacobian(x), one) < 1e-13);
    CHECK(max_abs_difference(duet::right_jacobian(x) * duet::right_jacobian_inverse(x), one) <
          1e-13);
    const vector r = x.tail<3>();
    CHECK(max_abs_difference(duet::left_jacobian_inverse(r),
                             duet::left_jacobian_inverse(x).bottomRightCorner<3, 3>()) <=
          duet_test::if_fused(1e-15));
    CHECK(max_abs_difference(duet::right_jacobian(r), duet::left_jacobian(r).transpose()) == 0);
    CHECK(max_abs_difference(duet::right_jacobian_inverse(r),
                             duet::left_jacobian_inverse(r).transpose()) == 0);
  }
  // At a full turn the inverse does not exist.
  const auto at_full_turn = duet::left_jacobian_inverse(vector(0, 0, 2 * M_PI));
  CHECK(std::abs(at_full_turn(0, 0)) > 1e14);
}

TEST_CASE("Jacobians of exp: within 8 ulp, except for cancellation near a full turn") {
  using wide = duet::real_50;
  for (const twist& x : twists()) {
    CAPTURE(x.transpose());
    const vector6<wide> exact_x = x.cast<wide>();
    const auto worst = [](const auto& computed, const auto& exact) {
      wide error = 0;
      wide size = 0;
      for (int i = 0; i < 36; ++i) {
        error = std::max<wide>(error, abs(wide(computed(i) - exact(i))));
        size = std::max<wide>(size, abs(exact(i)));
      }
      return double(wide(error / size));
    };
    CHECK(worst(duet::left_jacobian(x), duet::left_jacobian(exact_x)) < 8 * 0x1p-53);
    const double to_full_turn = 2 * M_PI - x.tail<3>().norm();
    CHECK(worst(duet::left_jacobian_inverse(x), duet::left_jacobian_inverse(exact_x)) <
          8 * 0x1p-53 * std::max(1.0, 2 * M_PI / to_full_turn));
  }
}

TEST_CASE("coAd and coad: power is independent of the frame, coad is the rate of coAd") {
  for (const auto& a : duet_test::poses()) {
    const twist v = make_twist(vector(0.7, -0.4, 0.2), vector(-0.3, 0.5, 0.9));
    const twist f = make_twist(vector(-2, 1, 0.5), vector(0.1, 3, -1));
    const twist moved = duet::coAd(a) * f;
    CHECK(moved.dot(duet::Ad(a) * v) == doctest::Approx(f.dot(v)).epsilon(1e-14));
    // The force is rotated, and t × f is added to its moment about the origin.
    const vector force = duet::rotate(duet::rotation(a), vector(f.head<3>()));
    CHECK(max_abs_difference(moved.head<3>(), force) < 1e-14);
    const vector moment = duet::rotate(duet::rotation(a), vector(f.tail<3>()));
    CHECK(max_abs_difference(moved.tail<3>(), moment + duet::translation(a).cross(force)) < 4e-14);
  }
  const twist v = make_twist(vector(0.7, -0.4, 0.2), vector(-0.3, 0.5, 0.9));
  const auto rate = duet::derivative<duet_test::shared_tag>(
      [&](auto t) {
        using S = decltype(t);
        return duet::coAd(pose_of<S>(v.cast<S>() * t));
      },
      0.0);
  CHECK(max_abs_difference(rate.derivative, duet::coad(v)) < 1e-15);
}

} // namespace
} // namespace test_dual_quaternion_exponential_jacobian
