// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "kinematics/arms.hpp"
#include "support/shared_tag.hpp"

#include <duet/duet.hpp>

namespace test_kinematics_jacobian_rate {
namespace {

using namespace duet;
using duet_test::coordinates;
using duet_test::for_each_frame;
using duet_test::max_abs_difference;

template <int N>
coordinates<N> rates(duet_test::random_source& random) {
  coordinates<N> result;
  for (int i = 0; i < N; ++i) {
    result[i] = random.uniform(-2, 2);
  }
  return result;
}

TEST_CASE("jacobian_with_rate, kinematic_hessian: equal derivatives of the Jacobian") {
  duet_test::random_source random(5);
  duet_test::for_each_arm([&](const auto& arm) {
    constexpr int n = std::decay_t<decltype(arm)>::joints;
    const auto point = arm.link(n - 1).at_point({.3, -.2, .5});
    for (const auto& theta : duet_test::configurations(arm, 5)) {
      const coordinates<n> v = rates<n>(random);
      for_each_frame([&](auto frame) {
        const auto check = [&](const auto&... at) {
          const auto along = [&](const auto& t) {
            using S = std::decay_t<decltype(t)>;
            Eigen::Matrix<S, n, 1> x;
            for (int i = 0; i < n; ++i) {
              x[i] = theta[i] + t * v[i];
            }
            return jacobian(arm, x, frame, at...);
          };
          const auto [m, m_dot] = derivative<duet_test::shared_tag>(along, 0.0);
          const auto closed = jacobian_with_rate(arm, theta, v, frame, at...);
          CHECK(max_abs_difference(closed.jacobian, m) < 1e-13);
          CHECK(max_abs_difference(closed.rate, m_dot) < 1e-13);
          const auto h = kinematic_hessian(arm, theta, frame, at...);
          Eigen::Matrix<double, 6, n> sum = Eigen::Matrix<double, 6, n>::Zero();
          for (int j = 0; j < n; ++j) {
            sum += h[j] * v[j];
          }
          CHECK(max_abs_difference(sum, m_dot) < 1e-13);
        };
        check();
        check(point);
      });
    }
  });
}

TEST_CASE("kinematic_hessian: every matrix equals second derivatives of the pose") {
  const auto arm = duet_test::every_joint();
  for (const auto& theta : duet_test::configurations(arm, 3)) {
    const auto h = kinematic_hessian(arm, theta, frame::hybrid);
    const auto position = [&](const auto& x) {
      return jacobian([&](const auto& y) { return translation(arm.pose(y)); }, x).jacobian;
    };
    for (int j = 0; j < 7; ++j) {
      const auto by_j = derivative<duet_test::shared_tag>(
          [&](const auto& t) {
            using S = std::decay_t<decltype(t)>;
            Eigen::Matrix<S, 7, 1> x = theta.template cast<S>();
            x[j] += t;
            return position(x);
          },
          0.0);
      CHECK(max_abs_difference(h[j].template topRows<3>(), by_j.derivative) < 1e-13);
      for (int k = 0; k < 7; ++k) {
        CHECK(max_abs_difference(h[j].col(k).template head<3>(), h[k].col(j).template head<3>()) <
              1e-14);
      }
    }
  }
}

TEST_CASE("jacobian_rate: the hybrid acceleration is p̈, the spatial and body ones have their known "
          "differences") {
  duet_test::random_source random(8);
  const auto arm = robots::panda().table();
  for (const auto& theta : duet_test::configurations(arm, 10)) {
    const coordinates<7> v = rates<7>(random), a = rates<7>(random);
    const auto at = [&](const auto& t) {
      using S = std::decay_t<decltype(t)>;
      Eigen::Matrix<S, 7, 1> x;
      for (int i = 0; i < 7; ++i) {
        x[i] = theta[i] + t * (v[i] + t * (a[i] / 2));
      }
      return arm.pose(x);
    };
    const auto p = derivatives<2>([&](const auto& t) { return translation(at(t)); }, 0.0);
    const auto acceleration = [&](auto frame) {
      const auto [m, m_dot] = jacobian_with_rate(arm, theta, v, frame);
      return vector6<double>(m * a + m_dot * v);
    };
    const auto classical = acceleration(frame::hybrid);
    const double scale = 1 + p[2].norm();
    CHECK(max_abs_difference(classical.head<3>(), p[2]) < 1e-13 * scale);
    const Eigen::Vector3d omega = (jacobian(arm, theta, frame::hybrid) * v).tail<3>();
    // v^s = ṗ + p × ω and v^b = Rᵀṗ, differentiated.
    const Eigen::Vector3d alpha = classical.tail<3>();
    CHECK(max_abs_difference(acceleration(frame::spatial).head<3>(),
                             p[2] + p[1].cross(omega) + p[0].cross(alpha)) < 1e-13 * scale);
    CHECK(max_abs_difference(acceleration(frame::body).head<3>(),
                             rotate(conj(rotation(arm.pose(theta))),
                                    Eigen::Vector3d(p[2] - omega.cross(p[1])))) < 1e-13 * scale);
  }
}

} // namespace
} // namespace test_kinematics_jacobian_rate
