// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "formulas/arms_as_expressions.hpp"
#include "formulas/expression_route.hpp"
#include "formulas/parts.hpp"
#include "formulas/table.hpp"

#include <duet/dual_quaternion/twist.hpp>
#include <duet/expression/condition.hpp>
#include <duet/expression/derivative.hpp>
#include <duet/expression/jacobian.hpp>
#include <duet/expression/matrix.hpp>
#include <duet/expression/motion.hpp>
#include <duet/expression/rotation.hpp>
#include <duet/expression/screw.hpp>
#include <duet/expression/symbol.hpp>

// P1–P4 and the four arms as expressions.

namespace duet_formulas {
namespace {

using namespace duet::expression;

constexpr symbol<"u"> u;

/// P1: the recurrence, on the span from knot 3 to knot 4.
template <std::size_t I, std::size_t K>
auto basis_function() {
  constexpr std::tuple knots(-3_c, -1.5_c, -1_c, c<0>, c<1>, 1.25_c, 3_c, 4_c);
  if constexpr (K == 1) {
    return c < I == 3 ? 1 : 0 > ;
  } else {
    constexpr auto left = std::get<I>(knots);
    constexpr auto right = std::get<I + K>(knots);
    return (u - left) / (std::get<I + K - 1>(knots) - left) * basis_function<I, K - 1>() +
           (right - u) / (right - std::get<I + 1>(knots)) * basis_function<I + 1, K - 1>();
  }
}

expression_route basis_functions() {
  const auto values = matrix<4, 1>(basis_function<0, 4>(), basis_function<1, 4>(),
                                   basis_function<2, 4>(), basis_function<3, 4>());
  const auto slopes = derivative(values, u);
  return expression_route("P1", "bspline_basis",
                          "`(u - u0) / (u3 - u0) * b0 + (u4 - u) / (u4 - u1) * b1`, `b0` and `b1` "
                          "by the same recurrence at order 3",
                          "`derivative`", [=](const numbers<double>& x, const numbers<double>& d) {
                            const auto y = values(u = x[0]);
                            const auto dy = slopes(u = x[0]);
                            return numbers<double>{y[0],         y[1],         y[2],
                                                   y[3],         dy[0] * d[0], dy[1] * d[0],
                                                   dy[2] * d[0], dy[3] * d[0]};
                          });
}

const auto b1 = c<1> - pow(c<1> - u, c<3>) / c<6>;
const auto b2 = (c<1> + c<3> * u * (c<1> + u * (c<1> - u)) + pow(u, c<3>)) / c<6>;
const auto b3 = pow(u, c<3>) / c<6>;

template <class Q, class B1, class W1, class B2, class W2, class B3, class W3>
auto curve(const Q& q, const B1& f1, const W1& w1, const B2& f2, const W2& w2, const B3& f3,
           const W3& w3) {
  return q * exp(f1 * w1) * exp(f2 * w2) * exp(f3 * w3);
}

/// P2 on a span of the uniform cubic, from its control rotations.
expression_route cumulative_curve() {
  constexpr vector_symbol<"r0"> r0;
  constexpr vector_symbol<"r1"> r1;
  constexpr vector_symbol<"r2"> r2;
  constexpr vector_symbol<"r3"> r3;
  const auto nearer = [](const auto& p, const auto& q) { return select(dot(p, q) < c<0>, -q, q); };
  const auto increment = [](const auto& p, const auto& q) { return vec(log(conj(p) * q)); };
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

/// P3 and P4: derivatives of P2 by u, from the first control rotation and the increments.
expression_route rate_of_curve(std::size_t order) {
  constexpr quaternion_symbol<"q0"> q0;
  constexpr vector_symbol<"w1"> w1;
  constexpr vector_symbol<"w2"> w2;
  constexpr vector_symbol<"w3"> w3;
  const auto first = derivative(curve(q0, b1, w1, b2, w2, b3, w3), u);
  const auto second = derivative(first, u);
  const auto third = derivative(second, u);
  const std::string name = order == 1 ? "Q" : "derivative(Q, u)";
  return expression_route(order == 1 ? "P3" : "P4", "cumulative_bspline::derivatives",
                          "`derivative(" + name + ", u)`, Q that of P2", "`derivative`",
                          [=](const numbers<double>& x, const numbers<double>& d) {
                            std::array<duet::quaternion<double>, 4> q;
                            std::array<duet::vector3<double>, 3> w;
                            for (std::size_t i = 0; i < 4; ++i) {
                              q[i] = duet::exp(duet::vector3<double>(v_of(x, 3 * i) / 2));
                              if (i > 0) {
                                q[i] = dot(q[i - 1], q[i]) < 0 ? -q[i] : q[i];
                                w[i - 1] = log(conj(q[i - 1]) * q[i]).vec();
                              }
                            }
                            const auto at_x = [&](const auto& f) {
                              return duet::quaternion<double>(
                                  f(u = x[12], q0 = q[0], w1 = w[0], w2 = w[1], w3 = w[2]));
                            };
                            return order == 1 ? all<double>(at_x(first), at_x(second) * d[12])
                                              : all<double>(at_x(second), at_x(third) * d[12]);
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
      label, function, "`A`, `translation(A)`, A the product of the arm's joints",
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
  const auto iiwa14 = joint(theta1) * translation_along(axis::z, .36_c) * down * joint(theta2) *
                      up * joint(theta3) * translation_along(axis::z, .42_c) * up * joint(theta4) *
                      down * joint(theta5) * translation_along(axis::z, .4_c) * down *
                      joint(theta6) * up * joint(theta7) * translation_along(axis::z, .126_c);
  const auto ur5e = joint(theta1) * translation_along(axis::z, .1625_c) * up * joint(theta2) *
                    translation_along(axis::x, -.425_c) * joint(theta3) *
                    translation_along(axis::x, -.3922_c) * joint(theta4) *
                    translation_along(axis::z, .1333_c) * up * joint(theta5) *
                    translation_along(axis::z, .0997_c) * down * joint(theta6) *
                    translation_along(axis::z, .0996_c);
  const auto baxter = joint(theta1) * translation_along(axis::z, .27035_c) *
                      translation_along(axis::x, .069_c) * down * joint(theta2 + quarter_turn) *
                      up * joint(theta3) * translation_along(axis::z, .36442_c) *
                      translation_along(axis::x, .069_c) * down * joint(theta4) * up *
                      joint(theta5) * translation_along(axis::z, .37429_c) *
                      translation_along(axis::x, .01_c) * down * joint(theta6) * up *
                      joint(theta7) * translation_along(axis::z, .229525_c);
  return {basis_functions(),
          cumulative_curve(),
          rate_of_curve(1),
          rate_of_curve(2),
          arm("Panda", "robots::panda", std::get<7>(panda_frames()), seven, seven_rates),
          arm("iiwa 14", "robots::iiwa14", iiwa14, seven, seven_rates),
          arm("UR5e", "robots::ur5e", ur5e, six, six_rates),
          arm("Baxter", "robots::baxter_left", baxter, seven, seven_rates)};
}

} // namespace duet_formulas
