// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "formulas/arms_as_expressions.hpp"
#include "formulas/expression_route.hpp"
#include "formulas/parts.hpp"
#include "formulas/table.hpp"

#include <duet/dual_quaternion/twist.hpp>
#include <duet/expression/condition.hpp>
#include <duet/expression/derivative.hpp>
#include <duet/expression/jacobian.hpp>
#include <duet/expression/motion.hpp>
#include <duet/expression/rotation.hpp>
#include <duet/expression/screw.hpp>
#include <duet/expression/symbol.hpp>

#include <cstddef>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

// P2 and the four arms as expressions.

namespace duet_formulas {
namespace {

using namespace duet::expression;

/// P2 on a span of the uniform cubic, from its control rotations.
expression_route cumulative_curve() {
  constexpr symbol<"u"> u;
  constexpr vector_symbol<"r0"> r0;
  constexpr vector_symbol<"r1"> r1;
  constexpr vector_symbol<"r2"> r2;
  constexpr vector_symbol<"r3"> r3;
  const auto curve = [](const auto& q, const auto& b1, const auto& w1, const auto& b2,
                        const auto& w2, const auto& b3,
                        const auto& w3) { return q * exp(b1 * w1) * exp(b2 * w2) * exp(b3 * w3); };
  const auto nearer = [](const auto& p, const auto& q) { return select(dot(p, q) < c<0>, -q, q); };
  const auto increment = [](const auto& p, const auto& q) { return vec(log(conj(p) * q)); };
  const auto b1 = c<1> - pow(c<1> - u, c<3>) / c<6>;
  const auto b2 = (c<1> + c<3> * u * (c<1> + u * (c<1> - u)) + pow(u, c<3>)) / c<6>;
  const auto b3 = pow(u, c<3>) / c<6>;
  const auto q0 = exp(r0 / c<2>);
  const auto q1 = nearer(q0, exp(r1 / c<2>));
  const auto q2 = nearer(q1, exp(r2 / c<2>));
  const auto q3 = nearer(q2, exp(r3 / c<2>));
  const auto q = curve(q0, b1, increment(q0, q1), b2, increment(q1, q2), b3, increment(q2, q3));

  const auto rate = derivative(q, u);
  const auto moving_q = motion(q, u, duet::frame::body);
  const auto text = [](const auto& f) { return "`" + to_text(f) + "`"; };
  return expression_route(
      "P2", "cumulative_bspline",
      text(curve(quaternion_symbol<"q0">{}, symbol<"b1">{}, vector_symbol<"w1">{}, symbol<"b2">{},
                 vector_symbol<"w2">{}, symbol<"b3">{}, vector_symbol<"w3">{})) +
          ", with w1 = " + text(increment(quaternion_symbol<"q0">{}, quaternion_symbol<"q1">{})) +
          ", b1 = " + text(b1) + ", b2 = " + text(b2) + ", b3 = " + text(b3),
      "`derivative`, `motion`", [=](const numbers<double>& x, const numbers<double>& d) {
        const auto at_x = [&](const auto& f) {
          return f(r0 = v_of(x, 0), r1 = v_of(x, 3), r2 = v_of(x, 6), r3 = v_of(x, 9), u = x[12]);
        };
        const auto m = at_x(moving_q);
        return all<double>(m.value, m.velocity, at_x(rate) * d[12],
                           duet::vector3<double>(m.acceleration * d[12]));
      });
}

/// A by its spatial Jacobian, t by its derivative along the joints' rates.
template <class Arm, class... Joint, class... Rate>
expression_route arm(const char* label, const char* function, const Arm& f,
                     const std::tuple<Joint...>&, const std::tuple<Rate...>&) {
  const auto by_joints = jacobian(f, wrt(Joint{}...), duet::frame::spatial);
  const auto t = translation(f);
  const auto t_rate = directional_derivative(t, along(Joint{}, Rate{})...);
  return expression_route(
      label, function,
      "product of the table's `screw(axis::z, theta)`, `slide(axis::z, d)`, `slide(axis::x, a)`, "
      "`screw(axis::x, alpha)`; `translation` of it",
      "`jacobian`, `directional_derivative`",
      [=](const numbers<double>& x, const numbers<double>& d) {
        const auto call = [&]<std::size_t... I>(std::index_sequence<I...>) {
          const auto [a, J] = by_joints((Joint{} = x[I])...);
          const duet::vector6<double> twist =
              J * Eigen::Map<const Eigen::Matrix<double, int(sizeof...(I)), 1>>(d.data());
          return all<double>(a, t((Joint{} = x[I])...),
                             duet::pose_rate(a, twist, duet::frame::spatial),
                             t_rate((Joint{} = x[I])..., (Rate{} = d[I])...));
        };
        return call(std::index_sequence_for<Joint...>{});
      });
}

} // namespace

std::vector<expression_route> motion_expressions() {
  const auto joint = [](const auto& theta) { return screw(axis::z, theta); };
  const std::tuple six(theta1, theta2, theta3, theta4, theta5, theta6);
  const std::tuple six_rates(dtheta1, dtheta2, dtheta3, dtheta4, dtheta5, dtheta6);
  const auto seven = std::tuple_cat(six, std::tuple(theta7));
  const auto seven_rates = std::tuple_cat(six_rates, std::tuple(dtheta7));
  const auto iiwa14 = joint(theta1) * slide(axis::z, .36_c) * down * joint(theta2) * up *
                      joint(theta3) * slide(axis::z, .42_c) * up * joint(theta4) * down *
                      joint(theta5) * slide(axis::z, .4_c) * down * joint(theta6) * up *
                      joint(theta7) * slide(axis::z, .126_c);
  const auto ur5e = joint(theta1) * slide(axis::z, .1625_c) * up * joint(theta2) *
                    slide(axis::x, -.425_c) * joint(theta3) * slide(axis::x, -.3922_c) *
                    joint(theta4) * slide(axis::z, .1333_c) * up * joint(theta5) *
                    slide(axis::z, .0997_c) * down * joint(theta6) * slide(axis::z, .0996_c);
  const auto baxter = joint(theta1) * slide(axis::z, .27035_c) * slide(axis::x, .069_c) * down *
                      joint(theta2 + quarter_turn) * up * joint(theta3) * slide(axis::z, .36442_c) *
                      slide(axis::x, .069_c) * down * joint(theta4) * up * joint(theta5) *
                      slide(axis::z, .37429_c) * slide(axis::x, .01_c) * down * joint(theta6) * up *
                      joint(theta7) * slide(axis::z, .229525_c);
  return {cumulative_curve(),
          arm("Panda", "robots::panda", std::get<7>(panda_frames()), seven, seven_rates),
          arm("iiwa 14", "robots::iiwa14", iiwa14, seven, seven_rates),
          arm("UR5e", "robots::ur5e", ur5e, six, six_rates),
          arm("Baxter", "robots::baxter_left", baxter, seven, seven_rates)};
}

} // namespace duet_formulas
