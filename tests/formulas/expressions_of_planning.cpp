// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "formulas/arms_as_expressions.hpp"
#include "formulas/expression_route.hpp"
#include "formulas/parts.hpp"
#include "formulas/table.hpp"

#include <duet/dual_quaternion/twist.hpp>
#include <duet/expression/condition.hpp>
#include <duet/expression/derivative.hpp>
#include <duet/expression/gradient.hpp>
#include <duet/expression/jacobian.hpp>
#include <duet/expression/rotation.hpp>
#include <duet/expression/screw.hpp>
#include <duet/expression/symbol.hpp>
#include <duet/expression/text.hpp>
#include <duet/expression/vector.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>

// N22–N25 as expressions. The system of six equations in B is solved by numbers, its derivative by
// the equations: x = Jᵀy with J x = V gives ẋ = J̇ᵀy + Jᵀẏ, J ẋ = V̇ − J̇x.

namespace duet_formulas {
namespace {

using namespace duet::expression;

using joint_column = Eigen::Matrix<double, 7, 1>;
using twist_column = duet::vector6<double>;

constexpr vector_symbol<"y"> y; // a wrench: force
constexpr vector_symbol<"m"> m; // and moment
constexpr symbol<"x1"> x1;      // rates of the joints
constexpr symbol<"x2"> x2;
constexpr symbol<"x3"> x3;
constexpr symbol<"x4"> x4;
constexpr symbol<"x5"> x5;
constexpr symbol<"x6"> x6;
constexpr symbol<"x7"> x7;
constexpr vector_symbol<"s"> s; // of γ̇ = [s; p], or of the goal
constexpr vector_symbol<"ds"> ds;
constexpr vector_symbol<"r"> r;
constexpr vector_symbol<"dr"> dr;
constexpr quaternion_symbol<"p"> p;
constexpr quaternion_symbol<"dp"> dp;
constexpr symbol<"tau"> tau;

/// The power of a wrench against the twist J2 γ̇ (N21) at the pose a.
template <class A, class S, class P>
auto power(const A& a, const S& place_rate, const P& rotation_rate) {
  const auto omega = c<2> * vec(rotation_rate * conj(rotation(a)));
  return dot(y, place_rate + cross(translation(a), omega)) + dot(m, omega);
}
/// And against a twist ω + εv.
template <class V>
auto power(const V& twist) {
  return dot(y, dual_part(twist)) + dot(m, real_part(twist));
}

template <class F>
auto with_joints(const F& f, const numbers<double>& x, const auto&... others) {
  return f(theta1 = x[0], theta2 = x[1], theta3 = x[2], theta4 = x[3], theta5 = x[4], theta6 = x[5],
           theta7 = x[6], others...);
}
template <class F>
auto with_rates(const F& f, const numbers<double>& x, const numbers<double>& d,
                const auto&... others) {
  return with_joints(f, x, dtheta1 = d[0], dtheta2 = d[1], dtheta3 = d[2], dtheta4 = d[3],
                     dtheta5 = d[4], dtheta6 = d[5], dtheta7 = d[6], others...);
}

/// The derivative of a formula along the rates of the joints and others.
template <class F>
auto along_joints(const F& f, const auto&... others) {
  return directional_derivative(f, along(theta1, dtheta1), along(theta2, dtheta2),
                                along(theta3, dtheta3), along(theta4, dtheta4),
                                along(theta5, dtheta5), along(theta6, dtheta6),
                                along(theta7, dtheta7), others...);
}

/// The joints' Jacobian and, at rates x and a wrench, the derivatives J̇ᵀ(y, m) and J̇ x.
auto jacobian_of_joints() {
  return jacobian(std::get<7>(panda_frames()),
                  wrt(theta1, theta2, theta3, theta4, theta5, theta6, theta7),
                  duet::frame::spatial);
}
auto jacobian_rate() {
  const auto [a1, a2, a3, a4, a5, a6, a7, tip] = panda_frames();
  const auto line = [](const auto& a) { return rotate(a, axis::z); };
  const auto twist = x1 * line(a1) + x2 * line(a2) + x3 * line(a3) + x4 * line(a4) + x5 * line(a5) +
                     x6 * line(a6) + x7 * line(a7);
  const auto f = power(twist) + c<0> * theta7;
  return gradient(along_joints(f), wrt(x1, x2, x3, x4, x5, x6, x7, y, m));
}

/// The least rates of the joints at a twist, and their derivative where θ and the twist move.
std::pair<joint_column, joint_column> least_rates(const numbers<double>& x,
                                                  const numbers<double>& d, const twist_column& v,
                                                  const twist_column& dv) {
  const Eigen::Matrix<double, 6, 7> J = with_joints(jacobian_of_joints(), x).jacobian;
  const Eigen::LLT<Eigen::Matrix<double, 6, 6>> gram(J * J.transpose());
  const twist_column wrench = gram.solve(v);
  const joint_column rates = J.transpose() * wrench;
  const Eigen::Matrix<double, 13, 1> moved =
      with_rates(jacobian_rate(), x, d, y = duet::vector3<double>(wrench.head<3>()),
                 m = duet::vector3<double>(wrench.tail<3>()), x1 = rates[0], x2 = rates[1],
                 x3 = rates[2], x4 = rates[3], x5 = rates[4], x6 = rates[5], x7 = rates[6])
          .gradient;
  const joint_column carried = moved.head<7>();
  return {rates, carried + J.transpose() * gram.solve(dv - moved.tail<6>() - J * carried)};
}

numbers<double> joined(const joint_column& a, const joint_column& b) {
  numbers<double> result(a.data(), a.data() + 7);
  result.insert(result.end(), b.data(), b.data() + 7);
  return result;
}
joint_column joints_of(const numbers<double>& x) {
  return Eigen::Map<const joint_column>(x.data());
}

constexpr const char* by = "`jacobian`, `gradient`, and Eigen's Cholesky decomposition";

/// The expression is that of the power, linear in the wrench, of which the twist is the gradient.
std::string text_of_power(const std::string& place_rate, const std::string& rotation_rate) {
  return "`dot(y, " + place_rate + " + cross(translation(A), w)) + dot(m, w)`, `w = 2 * vec(" +
         rotation_rate + " * conj(rotation(A)))`, and for each joint " + "`" +
         to_text(power(rotate(pose_symbol<"A">{}, axis::z))) + "`";
}

expression_route rates_of_joints() {
  const auto f = power(std::get<7>(panda_frames()), s, p);
  const auto twist = gradient(f, wrt(y, m));
  const auto twist_rate = gradient(along_joints(f, along(s, ds), along(p, dp)), wrt(y, m));
  return expression_route(
      "N22", "resolved_rate_matrix", text_of_power("s", "p"), by,
      [=](const numbers<double>& x, const numbers<double>& d) {
        const duet::vector3<double> none(0, 0, 0);
        const auto v = with_joints(twist, x, s = v_of(x, 7), p = q_of(x, 10), y = none, m = none);
        const auto dv = with_rates(twist_rate, x, d, s = v_of(x, 7), p = q_of(x, 10),
                                   ds = v_of(d, 7), dp = q_of(d, 10), y = none, m = none);
        const auto [rates, slopes] = least_rates(x, d, v.gradient, dv.gradient);
        return joined(rates, slopes);
      });
}

/// N23 from joints towards the pose that stands behind them.
auto step_of_joints(double beta) {
  const auto step = [](const auto& a) {
    const auto goal = exp(r / c<2>);
    const auto nearer = select(dot(goal, rotation(a)) < c<0>, -goal, goal);
    return power(a, s - translation(a), nearer - rotation(a));
  };
  const auto f = step(std::get<7>(panda_frames()));
  const auto twist = gradient(f, wrt(y, m));
  const auto twist_rate = gradient(along_joints(f, along(s, ds), along(r, dr)), wrt(y, m));
  return [=](const numbers<double>& x, const numbers<double>& d) {
    const duet::vector3<double> none(0, 0, 0);
    const auto v = with_joints(twist, x, r = v_of(x, 7), s = v_of(x, 10), y = none, m = none);
    const auto dv = with_rates(twist_rate, x, d, r = v_of(x, 7), s = v_of(x, 10), dr = v_of(d, 7),
                               ds = v_of(d, 10), y = none, m = none);
    const auto [rates, slopes] = least_rates(x, d, v.gradient, dv.gradient);
    return joined(joints_of(x) + beta * rates, joints_of(d) + beta * slopes);
  };
}

std::string text_of_step() {
  return text_of_power("s - translation(A)", "(q - rotation(A))") +
         ", `q = exp(r / 2)` with the sign nearer to A";
}

expression_route joint_step() {
  return expression_route("N23", "resolved_step", text_of_step(), by, step_of_joints(.5));
}

/// Twice N23, the second from where the first ends.
expression_route steps_along_path() {
  const auto step = step_of_joints(.25);
  return expression_route("N25", "resolved_step", "that of N23 in two successive steps, k = 0, 1",
                          by, [=](const numbers<double>& x, const numbers<double>& d) {
                            const numbers<double> end = step(x, d);
                            numbers<double> next(end.begin(), end.begin() + 7),
                                dnext(end.begin() + 7, end.end());
                            next.insert(next.end(), x.begin() + 13, x.end());
                            dnext.insert(dnext.end(), d.begin() + 13, d.end());
                            return step(next, dnext);
                          });
}

/// Only τ moves.
expression_route planning_step() {
  const auto step = [](const auto& a) {
    const auto goal = pose(exp(r / c<2>), s);
    const auto nearer = select(dot(rotation(goal), rotation(a)) < c<0>, -goal, goal);
    const auto next = a * pow(conj(a) * nearer, tau);
    return power(a, translation(next) - translation(a), rotation(next) - rotation(a));
  };
  const auto f = step(std::get<7>(panda_frames()));
  const auto twist = gradient(f, wrt(y, m));
  const auto twist_rate = gradient(derivative(f, tau), wrt(y, m));
  return expression_route(
      "N24", "sclerp, resolved_step",
      text_of_power("translation(C) - translation(A)", "(rotation(C) - rotation(A))") +
          ", `C = A * (conj(A) * G)^tau`, `G` with the sign nearer to A",
      by, [=](const numbers<double>& x, const numbers<double>& d) {
        const duet::vector3<double> none(0, 0, 0);
        const auto at_x = [&](const auto& g) {
          return with_joints(g, x, r = v_of(x, 7), s = v_of(x, 10), tau = x[13], y = none,
                             m = none);
        };
        const auto [rates, slopes] =
            least_rates(x, d, at_x(twist).gradient, at_x(twist_rate).gradient * d[13]);
        return joined(joints_of(x) + rates, slopes);
      });
}

} // namespace

std::vector<expression_route> planning_expressions() {
  return {rates_of_joints(), joint_step(), planning_step(), steps_along_path()};
}

} // namespace duet_formulas
