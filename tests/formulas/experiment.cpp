// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "../../examples/wheel_carrier/error_measure.hpp"
#include "formulas/by_hand.hpp"
#include "formulas/parts.hpp"
#include "formulas/table.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/quaternion/euler.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Core>

// P5–P7: measures of the experiment with the wheel carrier.

namespace by_hand {
namespace {

template <class T>
using m33 = std::array<v3<T>, 3>;
template <class T>
v3<T> times(const m33<T>& a, const v3<T>& v) {
  return {dot(a[0], v), dot(a[1], v), dot(a[2], v)};
}

/// A_K(ψ, θ) with the columns of [ψ′, θ′, φ′], its derivative A′ along (ψ′, θ′), and A″, the
/// derivative of A′ along (dψ, dθ) and (dψ′, dθ′), all entry by entry.
template <class T>
struct euler_rates {
  m33<T> a, da, dda;

  euler_rates(const T& psi, const T& theta, const T& p, const T& t, const T& dpsi = T(0),
              const T& dtheta = T(0), const T& dp = T(0), const T& dt = T(0)) {
    using std::cos, std::sin;
    const T c = cos(psi), s = sin(psi), k = cos(theta), z = sin(theta), none(0), one(1);
    a = {v3<T>{none, T(-s), T(c * k)}, {none, c, T(s * k)}, {one, none, T(-z)}};
    da = {v3<T>{none, T(-c * p), T(-s * k * p - c * z * t)},
          {none, T(-s * p), T(c * k * p - s * z * t)},
          {none, none, T(-k * t)}};
    dda = {v3<T>{none, T(s * p * dpsi - c * dp),
                 T(-c * k * p * dpsi + s * z * p * dtheta - s * k * dp + s * z * t * dpsi -
                   c * k * t * dtheta - c * z * dt)},
           {none, T(-c * p * dpsi - s * dp),
            T(-s * k * p * dpsi - c * z * p * dtheta + c * k * dp - c * z * t * dpsi -
              s * k * t * dtheta - s * z * dt)},
           {none, none, T(z * t * dtheta - k * dt)}};
  }
};

} // namespace
} // namespace by_hand

namespace duet_formulas {
namespace {

constexpr auto vector = argument::vector;

/// True if the square of the length of the vector is a normal number.
bool has_length(const numbers<double>& x, std::size_t i) {
  const double length = v_of(x, i).norm();
  return length > 1e-9 && length < 1e9;
}

} // namespace

std::vector<formula> experiment_formulas() {
  return {
      make_formula(
          "P5", R"(\delta = A_K\,[\psi', \theta', \phi']^\top)", "euler_rate_matrix",
          "quaternion/euler.hpp", {vector, vector},
          []<class T>(const numbers<T>& x) {
            return all<T>(
                duet::vector3<T>(duet::euler_rate_matrix<duet::zyx>(x[0], x[1]) * v_of(x, 3)));
          },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            using namespace by_hand;
            const euler_rates<T> k(x[0], x[1], d[0], d[1]);
            const v3<T> rates = part<3>(x, 3);
            return row<T>(times(k.a, rates), plus(times(k.da, rates), times(k.a, part<3>(d, 3))));
          }),
      make_formula(
          "P5",
          R"(\tfrac{\partial\delta}{\partial u} = A_K'\,[\psi', \theta', \phi']^\top + A_K\,[\psi'', \theta'', \phi'']^\top)",
          "derivative, euler_rate_matrix", "quaternion/euler.hpp", {vector, vector, vector},
          []<class T>(const numbers<T>& x) {
            const auto delta = [&](const auto& u) {
              const auto a = duet::euler_rate_matrix<duet::zyx>(x[0] + u * x[3], x[1] + u * x[4]);
              using S = typename decltype(a)::Scalar;
              return duet::vector3<S>(
                  a * duet::vector3<S>(x[3] + u * x[6], x[4] + u * x[7], x[5] + u * x[8]));
            };
            return all<T>(duet::vector3<T>(duet::derivative(delta, T(0)).derivative));
          },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            using namespace by_hand;
            const euler_rates<T> k(x[0], x[1], x[3], x[4], d[0], d[1], d[3], d[4]);
            const euler_rates<T> along(x[0], x[1], d[0], d[1]);
            const v3<T> rates = part<3>(x, 3), second = part<3>(x, 6);
            return row<T>(plus(times(k.da, rates), times(k.a, second)),
                          plus(plus(times(k.dda, rates), times(k.da, part<3>(d, 3))),
                               plus(times(along.da, second), times(k.a, part<3>(d, 6)))));
          }),
      make_formula(
          "P6", R"(\delta_E = \lVert\delta - \delta_{\text{int}}\rVert\,/\,\lVert\delta\rVert)",
          "relative", "examples/wheel_carrier/error_measure.hpp", {vector, vector},
          []<class T>(const numbers<T>& x) {
            return numbers<T>{wheel_carrier::relative(v_of(x, 3), v_of(x, 0))};
          },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            using namespace by_hand;
            using std::sqrt;
            const auto length = [](const v3<T>& v, const v3<T>& dv) {
              const T l = sqrt(dot(v, v));
              return std::pair(l, T(dot(v, dv) / l));
            };
            const T minus(-1);
            const auto [e, de] = length(plus(part<3>(x, 0), times(minus, part<3>(x, 3))),
                                        plus(part<3>(d, 0), times(minus, part<3>(d, 3))));
            const auto [l, dl] = length(part<3>(x, 0), part<3>(d, 0));
            return numbers<T>{T(e / l), T(de / l - e * dl / (l * l))};
          },
          {},
          [](const numbers<double>& x) {
            // If δ_int is small compared with δ, both lengths change equally and their derivatives
            // cancel.
            return has_length(x, 0) && has_length({x[0] - x[3], x[1] - x[4], x[2] - x[5]}, 0) &&
                   v_of(x, 3).norm() > .1 * v_of(x, 0).norm();
          }),
      make_formula(
          "P7", R"(\vartheta = 2\,\lVert\log(q_i^* q_{i+1})\rVert)", "rotation_vector",
          "quaternion/rotation.hpp", {argument::rotation, argument::rotation},
          []<class T>(const numbers<T>& x) {
            const auto p = duet::from_rotation_vector(v_of(x, 0));
            const auto q = duet::from_rotation_vector(v_of(x, 3));
            return numbers<T>{duet::rotation_vector(duet::quaternion<T>(conj(p) * q)).norm()};
          },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            using namespace by_hand;
            using std::atan2, std::sqrt;
            const unit<T> p(part<3>(x, 0), part<3>(d, 0)), q(part<3>(x, 3), part<3>(d, 3));
            const q4<T> relative = product(conj(p.q), q.q);
            const q4<T> drelative = plus(product(conj(p.dq), q.q), product(conj(p.q), q.dq));
            const T sign(relative[0] < 0 ? -1 : 1);
            const T length = sqrt(dot(vec(relative), vec(relative)));
            const T dlength = dot(vec(relative), vec(drelative)) / length;
            return numbers<T>{T(2 * atan2(length, T(sign * relative[0]))),
                              T(2 * sign * (relative[0] * dlength - length * drelative[0]))};
          },
          {16, 16},
          [](const numbers<double>& x) {
            const auto relative = conj(duet::from_rotation_vector(v_of(x, 0))) *
                                  duet::from_rotation_vector(v_of(x, 3));
            return relative.vec().norm() > 1e-3 && std::abs(relative.w()) > 1e-3;
          })};
}

} // namespace duet_formulas
