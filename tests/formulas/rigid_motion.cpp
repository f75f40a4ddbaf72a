// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "formulas/by_hand.hpp"
#include "formulas/parts.hpp"
#include "formulas/table.hpp"

#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/pose_coordinates.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/rate.hpp>
#include <duet/quaternion/rotation.hpp>

// N17–N21: rigid motion.

namespace duet_formulas {
namespace {

constexpr auto vector = argument::vector;
constexpr auto rotation_vector = argument::rotation;

template <class T>
duet::quaternion<T> unit_of(const numbers<T>& x, std::size_t i) {
  return duet::exp(duet::vector3<T>(x[i] / 2, x[i + 1] / 2, x[i + 2] / 2));
}

/// Poses are constant, only τ varies: the screw motion from the textbook's axis, angle and pitch.
formula screw_interpolation() {
  formula f = make_formula(
      "N19", R"(A(\tau) = A_1(A_1^*A_2)^\tau)", "sclerp", "dual_quaternion/screw.hpp",
      {rotation_vector, vector, rotation_vector, vector, argument::fraction},
      []<class T>(const numbers<T>& x) {
        using R = duet::real_type_t<T>;
        const auto still = [&](std::size_t i) {
          numbers<R> y;
          for (std::size_t k = i; k < i + 6; ++k) {
            y.push_back(duet::innermost(x[k]));
          }
          return duet::pose(unit_of(y, 0), v_of(y, 3));
        };
        return all<T>(sclerp(still(0), still(6), x[12]));
      },
      []<class T>(const numbers<T>& x, const numbers<T>& d) {
        using namespace by_hand;
        const v3<T> none{};
        const screw_displacement<T> c(unit<T>(part<3>(x, 0), none).q, part<3>(x, 3),
                                      unit<T>(part<3>(x, 6), none).q, part<3>(x, 9), x[12], d[12]);
        const q4<T> beta = times(T(0.5), product(pure(c.position), c.alpha));
        const q4<T> dbeta = times(
            T(0.5), plus(product(pure(c.dposition), c.alpha), product(pure(c.position), c.dalpha)));
        return row<T>(c.alpha, beta, c.dalpha, dbeta);
      },
      {16, 16},
      [](const numbers<double>& x) {
        const duet::vector3<double> a(x[0], x[1], x[2]), b(x[6], x[7], x[8]);
        return std::abs(dot(duet::from_rotation_vector(a), duet::from_rotation_vector(b))) > 1e-3;
      });
  f.only_last_moves = true;
  return f;
}

} // namespace

std::vector<formula> rigid_motion_formulas() {
  return {
      make_formula(
          "N17", R"(A = \alpha + \varepsilon\tfrac12t\alpha,\; t = 2\beta\alpha^*)",
          "pose, translation", "dual_quaternion/pose.hpp", {rotation_vector, vector},
          []<class T>(const numbers<T>& x) {
            const auto a = duet::pose(unit_of(x, 0), v_of(x, 3));
            return all<T>(a, translation(a));
          },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            using namespace by_hand;
            const unit<T> u(part<3>(x, 0), part<3>(d, 0));
            const q4<T> half = times(T(0.5), pure(part<3>(x, 3)));
            const q4<T> dhalf = times(T(0.5), pure(part<3>(d, 3)));
            return row<T>(u.q, product(half, u.q), part<3>(x, 3), u.dq,
                          plus(product(dhalf, u.q), product(half, u.dq)), part<3>(d, 3));
          },
          {16, 16}),
      make_formula(
          "N18",
          R"(\dot A = \tfrac12V^sA = \tfrac12AV^b,\; v^s = \dot t + t\times\omega^s,\; v^b = R^\top\dot t)",
          "twist", "dual_quaternion/twist.hpp", {rotation_vector, vector, vector, vector},
          []<class T>(const numbers<T>& x) {
            const auto alpha = unit_of(x, 0);
            const auto omega = v_of(x, 6);
            const auto a = duet::pose(alpha, v_of(x, 3));
            const auto alpha_dot = quaternion_rate(alpha, omega, duet::frame::spatial);
            const duet::quaternion<T> t(T(0), v_of(x, 3)), t_dot(T(0), v_of(x, 9));
            const auto a_dot =
                duet::make_dual_quaternion(alpha_dot, (t_dot * alpha + t * alpha_dot) * T(0.5));
            const duet::vector6<T> s = duet::twist(a, a_dot, duet::frame::spatial);
            const duet::vector6<T> b = duet::twist(a, a_dot, duet::frame::body);
            return all<T>(
                duet::vector3<T>(s.template head<3>()), duet::vector3<T>(s.template tail<3>()),
                duet::vector3<T>(b.template head<3>()), duet::vector3<T>(b.template tail<3>()));
          },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            using namespace by_hand;
            const unit<T> u(part<3>(x, 0), part<3>(d, 0));
            const v3<T> t = part<3>(x, 3), w = part<3>(x, 6), v = part<3>(x, 9);
            const v3<T> dt = part<3>(d, 3), dw = part<3>(d, 6), dv = part<3>(d, 9);
            const q4<T> back = conj(u.q), dback = conj(u.dq);
            const auto back_rotated = [&](const v3<T>& y) {
              return vec(product(product(back, pure(y)), u.q));
            };
            const auto rate = [&](const v3<T>& y, const v3<T>& dy) {
              return plus(back_rotated(dy), vec(plus(product(product(dback, pure(y)), u.q),
                                                     product(product(back, pure(y)), u.dq))));
            };
            return row<T>(plus(v, cross(t, w)), w, back_rotated(v), back_rotated(w),
                          plus(dv, plus(cross(dt, w), cross(t, dw))), dw, rate(v, dv), rate(w, dw));
          },
          {16, 16}),
      screw_interpolation(),
      make_formula(
          "N20", R"(\omega^s = 2E(\alpha)\dot\alpha,\; v^s = \dot t + [t]_\times\omega^s)",
          "quaternion_rate_matrix, pose_coordinates_rate", "dual_quaternion/pose_coordinates.hpp",
          {rotation_vector, vector, vector, vector},
          []<class T>(const numbers<T>& x) {
            // From the twist to [ṫ; α̇].
            duet::vector6<T> v;
            v << v_of(x, 6), v_of(x, 9);
            const duet::vector7<T> rate =
                duet::pose_coordinates_rate(duet::pose(unit_of(x, 0), v_of(x, 3)), v);
            return numbers<T>(rate.data(), rate.data() + 7);
          },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            using namespace by_hand;
            const unit<T> u(part<3>(x, 0), part<3>(d, 0));
            const v3<T> t = part<3>(x, 3), v = part<3>(x, 6), w = part<3>(x, 9);
            const v3<T> dt = part<3>(d, 3), dv = part<3>(d, 6), dw = part<3>(d, 9);
            const q4<T> half = times(T(0.5), pure(w)), dhalf = times(T(0.5), pure(dw));
            return row<T>(plus(v, cross(w, t)), product(half, u.q),
                          plus(dv, plus(cross(dw, t), cross(w, dt))),
                          plus(product(dhalf, u.q), product(half, u.dq)));
          },
          {16, 16}),
      make_formula(
          "N21",
          R"([v^s; \omega^s] = J_2\dot\gamma,\; J_2 = \begin{pmatrix}I & 2[t]_\times E\\ 0 & 2E\end{pmatrix})",
          "pose_rate_matrix", "dual_quaternion/pose_coordinates.hpp",
          {rotation_vector, vector, vector, argument::quaternion},
          []<class T>(const numbers<T>& x) {
            duet::vector7<T> rate;
            rate << v_of(x, 6), x[9], x[10], x[11], x[12];
            const duet::vector6<T> v =
                duet::pose_rate_matrix(duet::pose(unit_of(x, 0), v_of(x, 3))) * rate;
            return numbers<T>(v.data(), v.data() + 6);
          },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            using namespace by_hand;
            const unit<T> u(part<3>(x, 0), part<3>(d, 0));
            const v3<T> t = part<3>(x, 3), v = part<3>(x, 6), dt = part<3>(d, 3),
                        dv = part<3>(d, 6);
            const q4<T> p = part<4>(x, 9), dp = part<4>(d, 9);
            const v3<T> w = times(T(2), vec(product(p, conj(u.q))));
            const v3<T> dw = times(T(2), vec(plus(product(dp, conj(u.q)), product(p, conj(u.dq)))));
            return row<T>(plus(v, cross(t, w)), w, plus(dv, plus(cross(dt, w), cross(t, dw))), dw);
          },
          {16, 16})};
}

} // namespace duet_formulas
