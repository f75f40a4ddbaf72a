// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "formulas/by_hand.hpp"
#include "formulas/parts.hpp"
#include "formulas/table.hpp"

#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rate.hpp>
#include <duet/quaternion/rotation.hpp>

// N1–N9: quaternions.

namespace duet_formulas {
namespace {

constexpr auto quaternion = argument::quaternion;
constexpr auto vector = argument::vector;

/// True if q is away from the negative real numbers, where the axis is undetermined.
bool has_axis(const numbers<double>& x) {
  return x[0] > 0 || std::hypot(x[1], x[2], x[3]) > 1e-3 * std::abs(x[0]);
}

formula interpolation() {
  formula f = make_formula(
      "N9", R"(q(\tau) = q_1(q_1^*q_2)^\tau)", "slerp", "quaternion/exponential.hpp",
      {argument::rotation, argument::rotation, argument::fraction},
      []<class T>(const numbers<T>& x) {
        // The poses are constant, only τ varies.
        const auto still = [](const duet::vector3<T>& v) {
          using R = duet::real_type_t<T>;
          return duet::quaternion<T>(duet::from_rotation_vector(duet::vector3<R>(
              duet::innermost(v[0]), duet::innermost(v[1]), duet::innermost(v[2]))));
        };
        return all<T>(slerp(still(v_of(x, 0)), still(v_of(x, 3)), x[6]));
      },
      []<class T>(const numbers<T>& x, const numbers<T>& d) {
        using namespace by_hand;
        using std::atan2, std::cos, std::sin, std::sqrt;
        const v3<T> zero{};
        const q4<T> a = unit<T>(part<3>(x, 0), zero).q;
        q4<T> b = unit<T>(part<3>(x, 3), zero).q;
        if (dot(a, b) < 0) {
          b = times(T(-1), b);
        }
        const T tau = x[6];
        const q4<T> difference = plus(b, times(T(-1), a)), sum = plus(a, b);
        const T angle = 2 * atan2(T(sqrt(dot(difference, difference))), T(sqrt(dot(sum, sum))));
        if (angle == 0) {
          return row<T>(plus(a, times(tau, difference)), times(d[6], difference));
        }
        const T whole = sin(angle), left = angle * (1 - tau), right = angle * tau;
        const T speed = d[6] * angle / whole;
        return row<T>(plus(times(T(sin(left) / whole), a), times(T(sin(right) / whole), b)),
                      plus(times(T(-speed * cos(left)), a), times(T(speed * cos(right)), b)));
      },
      {16, 16},
      [](const numbers<double>& x) {
        const duet::vector3<double> a(x[0], x[1], x[2]), b(x[3], x[4], x[5]);
        return std::abs(dot(duet::from_rotation_vector(a), duet::from_rotation_vector(b))) > 1e-3;
      });
  f.only_last_moves = true;
  return f;
}

} // namespace

std::vector<formula> quaternion_formulas() {
  return {
      make_formula(
          "N1",
          R"(pq = (p_0q_0 - \vec p\cdot\vec q,\; p_0\vec q + q_0\vec p + \vec p\times\vec q))",
          "operator*", "quaternion/quaternion.hpp", {quaternion, quaternion},
          []<class T>(const numbers<T>& x) { return all<T>(q_of(x, 0) * q_of(x, 4)); },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            using namespace by_hand;
            const q4<T> p = part<4>(x, 0), q = part<4>(x, 4), dp = part<4>(d, 0),
                        dq = part<4>(d, 4);
            return row<T>(product(p, q), plus(product(dp, q), product(p, dq)));
          }),
      make_formula(
          "N2", R"((pq)^* = q^*p^*)", "conj", "quaternion/quaternion.hpp", {quaternion, quaternion},
          []<class T>(const numbers<T>& x) { return all<T>(conj(q_of(x, 0) * q_of(x, 4))); },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            using namespace by_hand;
            const q4<T> p = conj(part<4>(x, 0)), q = conj(part<4>(x, 4));
            const q4<T> dp = conj(part<4>(d, 0)), dq = conj(part<4>(d, 4));
            return row<T>(product(q, p), plus(product(dq, p), product(q, dp)));
          }),
      make_formula(
          "N3", R"(q^{-1} = q^*/\lvert q\rvert^2)", "inverse", "quaternion/norm.hpp", {quaternion},
          []<class T>(const numbers<T>& x) { return all<T>(inverse(q_of(x, 0))); },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            using namespace by_hand;
            const q4<T> q = part<4>(x, 0), dq = part<4>(d, 0);
            const q4<T> result = times(T(1 / dot(q, q)), conj(q));
            return row<T>(result, times(T(-1), product(product(result, dq), result)));
          }),
      make_formula(
          "N4", R"(e^{\hat u\theta} = \cos\theta + \hat u\sin\theta)", "exp",
          "quaternion/exponential.hpp", {argument::rotation},
          []<class T>(const numbers<T>& x) {
            return all<T>(duet::exp(duet::vector3<T>(x[0] / 2, x[1] / 2, x[2] / 2)));
          },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            const by_hand::unit<T> u(by_hand::part<3>(x, 0), by_hand::part<3>(d, 0));
            return by_hand::row<T>(u.q, u.dq);
          },
          {16, 16}),
      make_formula(
          "N4", R"(\log q = \log\lvert q\rvert + \hat u\theta)", "log",
          "quaternion/exponential.hpp", {quaternion},
          []<class T>(const numbers<T>& x) { return all<T>(log(q_of(x, 0))); },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            using namespace by_hand;
            using std::log;
            const polar<T> p(part<4>(x, 0), part<4>(d, 0));
            v3<T> rate = plus(times(p.dangle, p.axis), times(p.angle, p.daxis));
            if (p.length == 0) {
              rate = times(T(1 / x[0]), part<3>(d, 1));
            }
            const v3<T> v = times(p.angle, p.axis);
            return row<T>(std::array<T, 1>{T(log(p.size))}, v,
                          std::array<T, 1>{T(p.dsize / p.size)}, rate);
          },
          {16, 16}, has_axis),
      make_formula(
          "N5", R"(q^\rho = \lvert q\rvert^\rho(\cos\rho\theta + \hat u\sin\rho\theta))", "pow",
          "quaternion/exponential.hpp", {quaternion, argument::number},
          []<class T>(const numbers<T>& x) { return all<T>(pow(q_of(x, 0), x[4])); },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            using namespace by_hand;
            using std::cos, std::log, std::pow, std::sin;
            const polar<T> p(part<4>(x, 0), part<4>(d, 0));
            const T rho = x[4];
            const T size = pow(p.size, rho);
            const T dsize = size * (d[4] * log(p.size) + rho * p.dsize / p.size);
            const T c = cos(T(rho * p.angle)), s = sin(T(rho * p.angle));
            const T dangle = d[4] * p.angle + rho * p.dangle;
            v3<T> rate =
                plus(times(T(dsize * s + size * c * dangle), p.axis), times(T(size * s), p.daxis));
            if (p.length == 0) {
              rate = times(T(size * rho / x[0]), part<3>(d, 1));
            }
            return row<T>(std::array<T, 1>{T(size * c)}, times(T(size * s), p.axis),
                          std::array<T, 1>{T(dsize * c - size * s * dangle)}, rate);
          },
          {16, 16}, has_axis),
      make_formula(
          "N6", R"(\tfrac{d}{dt}(pqr) = \dot pqr + p\dot qr + pq\dot r)", "operator*",
          "quaternion/quaternion.hpp", {quaternion, quaternion, quaternion},
          []<class T>(const numbers<T>& x) { return all<T>(q_of(x, 0) * q_of(x, 4) * q_of(x, 8)); },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            using namespace by_hand;
            const q4<T> p = part<4>(x, 0), q = part<4>(x, 4), r = part<4>(x, 8);
            const q4<T> dp = part<4>(d, 0), dq = part<4>(d, 4), dr = part<4>(d, 8);
            return row<T>(product(product(p, q), r),
                          plus(plus(product(product(dp, q), r), product(product(p, dq), r)),
                               product(product(p, q), dr)));
          }),
      make_formula(
          "N7", R"(\dot q = \tfrac12\omega^sq = \tfrac12q\omega^b)", "quaternion_rate",
          "quaternion/rate.hpp", {quaternion, vector},
          []<class T>(const numbers<T>& x) {
            return all<T>(quaternion_rate(q_of(x, 0), v_of(x, 4), duet::frame::spatial),
                          quaternion_rate(q_of(x, 0), v_of(x, 4), duet::frame::body));
          },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            using namespace by_hand;
            const q4<T> q = part<4>(x, 0), dq = part<4>(d, 0);
            const q4<T> w = times(T(0.5), pure(part<3>(x, 4))),
                        dw = times(T(0.5), pure(part<3>(d, 4)));
            return row<T>(product(w, q), product(q, w), plus(product(dw, q), product(w, dq)),
                          plus(product(dq, w), product(q, dw)));
          }),
      make_formula(
          "N7", R"(\omega^s = 2\dot qq^*,\; \omega^b = 2q^*\dot q)", "angular_velocity",
          "quaternion/rate.hpp", {quaternion, quaternion},
          []<class T>(const numbers<T>& x) {
            return all<T>(angular_velocity(q_of(x, 0), q_of(x, 4), duet::frame::spatial),
                          angular_velocity(q_of(x, 0), q_of(x, 4), duet::frame::body));
          },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            using namespace by_hand;
            const q4<T> q = conj(part<4>(x, 0)), dq = conj(part<4>(d, 0));
            const q4<T> p = times(T(2), part<4>(x, 4)), dp = times(T(2), part<4>(d, 4));
            return row<T>(vec(product(p, q)), vec(product(q, p)),
                          vec(plus(product(dp, q), product(p, dq))),
                          vec(plus(product(dq, p), product(q, dp))));
          }),
      make_formula(
          "N8", R"(\omega^s = 2E(q)\dot q,\; \omega^b = 2G(q)\dot q)", "quaternion_rate_matrix",
          "quaternion/rate.hpp", {quaternion, quaternion},
          []<class T>(const numbers<T>& x) {
            const Eigen::Matrix<T, 4, 1> p(x[4], x[5], x[6], x[7]);
            const duet::vector3<T> s = quaternion_rate_matrix(q_of(x, 0), duet::frame::spatial) * p;
            const duet::vector3<T> b = quaternion_rate_matrix(q_of(x, 0), duet::frame::body) * p;
            return all<T>(duet::vector3<T>(s * T(2)), duet::vector3<T>(b * T(2)));
          },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            using namespace by_hand;
            // Row by row.
            const auto e = [](const q4<T>& q, const q4<T>& p) {
              return v3<T>{T(2 * (-q[1] * p[0] + q[0] * p[1] - q[3] * p[2] + q[2] * p[3])),
                           T(2 * (-q[2] * p[0] + q[3] * p[1] + q[0] * p[2] - q[1] * p[3])),
                           T(2 * (-q[3] * p[0] - q[2] * p[1] + q[1] * p[2] + q[0] * p[3]))};
            };
            const auto g = [](const q4<T>& q, const q4<T>& p) {
              return v3<T>{T(2 * (-q[1] * p[0] + q[0] * p[1] + q[3] * p[2] - q[2] * p[3])),
                           T(2 * (-q[2] * p[0] - q[3] * p[1] + q[0] * p[2] + q[1] * p[3])),
                           T(2 * (-q[3] * p[0] + q[2] * p[1] - q[1] * p[2] + q[0] * p[3]))};
            };
            const q4<T> q = part<4>(x, 0), p = part<4>(x, 4), dq = part<4>(d, 0),
                        dp = part<4>(d, 4);
            return row<T>(e(q, p), g(q, p), plus(e(dq, p), e(q, dp)), plus(g(dq, p), g(q, dp)));
          }),
      interpolation()};
}

} // namespace duet_formulas
