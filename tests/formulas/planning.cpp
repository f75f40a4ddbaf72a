// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "formulas/arm_by_hand.hpp"
#include "formulas/by_hand.hpp"
#include "formulas/parts.hpp"
#include "formulas/table.hpp"

#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/kinematics/robots.hpp>
#include <duet/motion/resolved_motion.hpp>
#include <duet/quaternion/exponential.hpp>

#include <Eigen/Core>

// N22–N25: motion planning, with the table of a Panda.

namespace by_hand {
namespace {

constexpr std::size_t joints = 7;
template <class T>
using joint_vector = std::array<T, joints>;
template <class T>
using panda = arm<T, joints>;

/// Solution x of M x = b by Gaussian elimination.
template <class T>
six<T> solved(std::array<six<T>, 6> m, six<T> b) {
  using std::abs;
  for (std::size_t k = 0; k < 6; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < 6; ++i) {
      pivot = abs(m[i][k]) > abs(m[pivot][k]) ? i : pivot;
    }
    std::swap(m[k], m[pivot]);
    std::swap(b[k], b[pivot]);
    for (std::size_t i = k + 1; i < 6; ++i) {
      const T factor = m[i][k] / m[k][k];
      for (std::size_t j = k; j < 6; ++j) {
        m[i][j] -= factor * m[k][j];
      }
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = 6; k-- > 0;) {
    for (std::size_t j = k + 1; j < 6; ++j) {
      b[k] -= m[k][j] * b[j];
    }
    b[k] /= m[k][k];
  }
  return b;
}

/// N22 at γ̇ = [u; p], and its derivative.
template <class T>
std::pair<joint_vector<T>, joint_vector<T>>
resolved(const panda<T>& a, const v3<T>& u, const q4<T>& p, const v3<T>& du, const q4<T>& dp) {
  const v3<T> w = times(T(2), vec(product(p, conj(a.alpha))));
  const v3<T> dw = times(T(2), vec(plus(product(dp, conj(a.alpha)), product(p, conj(a.dalpha)))));
  const v3<T> v = plus(u, cross(a.t, w));
  const v3<T> dv = plus(du, plus(cross(a.dt, w), cross(a.t, dw)));
  const auto gram = a.gram(a.columns, a.columns);
  const auto half = a.gram(a.dcolumns, a.columns);
  const six<T> y = solved(gram, six<T>{v[0], v[1], v[2], w[0], w[1], w[2]});
  six<T> right{dv[0], dv[1], dv[2], dw[0], dw[1], dw[2]};
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      right[i] -= (half[i][j] + half[j][i]) * y[j];
    }
  }
  const six<T> dy = solved(gram, right);
  std::pair<joint_vector<T>, joint_vector<T>> result;
  for (std::size_t k = 0; k < joints; ++k) {
    result.first[k] = dot(a.columns[k], y);
    result.second[k] = dot(a.dcolumns[k], y) + dot(a.columns[k], dy);
  }
  return result;
}

/// N23 towards the displacement (α, t), and its derivative.
template <class T>
std::pair<joint_vector<T>, joint_vector<T>>
stepped(const joint_vector<T>& theta, const joint_vector<T>& dtheta, const unit<T>& goal,
        const v3<T>& t, const v3<T>& dt, const T& beta) {
  const panda<T> a(panda_table, theta, dtheta);
  const T sign(dot(goal.q, a.alpha) < 0 ? -1 : 1), minus(-1);
  const auto [y, dy] =
      resolved(a, plus(t, times(minus, a.t)), plus(times(sign, goal.q), times(minus, a.alpha)),
               plus(dt, times(minus, a.dt)), plus(times(sign, goal.dq), times(minus, a.dalpha)));
  return {plus(theta, times(beta, y)), plus(dtheta, times(beta, dy))};
}

} // namespace
} // namespace by_hand

namespace duet_formulas {
namespace {

constexpr auto vector = argument::vector;
constexpr auto number = argument::number;
constexpr auto rotation_vector = argument::rotation;
/// Bounds for condition numbers of J up to about 20.
constexpr bounds of_least_rates{8, 16, 32};

constexpr auto robot = duet::robots::panda().table();

template <class T>
Eigen::Matrix<T, 7, 1> joints_of(const numbers<T>& x) {
  return Eigen::Map<const Eigen::Matrix<T, 7, 1>>(x.data());
}
template <class T>
duet::quaternion<T> unit_of(const numbers<T>& x, std::size_t i) {
  return duet::exp(duet::vector3<T>(x[i] / 2, x[i + 1] / 2, x[i + 2] / 2));
}
template <class V>
auto as_numbers(const V& v) {
  return numbers<typename V::Scalar>(v.data(), v.data() + v.size());
}

/// True if Σ 1/σ² < 100 for the singular values of the Jacobian, so that all exceed 0.1: (J Jᵀ)⁻¹
/// amplifies errors by 1/σ².
bool is_regular(const numbers<double>& x) {
  by_hand::joint_vector<double> none{};
  const by_hand::panda<double> a(by_hand::panda_table, by_hand::part<7>(x, 0), none);
  double sum = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    by_hand::six<double> unit{};
    unit[i] = 1;
    sum += by_hand::solved(a.gram(a.columns, a.columns), unit)[i];
  }
  return sum > 0 && sum < 100 && joints_of(x).cwiseAbs().maxCoeff() < 7;
}

formula planning_step() {
  auto f = make_formula(
      "N24",
      R"(\Theta \mapsto \Theta + B\,(\gamma(A\,(A^*A_g)^\tau) - \gamma(A)),\; A = A(\Theta))",
      "sclerp, resolved_step", "motion/resolved_motion.hpp",
      {vector, vector, number, rotation_vector, vector, argument::fraction},
      []<class T>(const numbers<T>& x) {
        numbers<duet::real_type_t<T>> still; // all arguments except τ
        for (const T& each : x) {
          still.push_back(duet::innermost(each));
        }
        const auto theta = joints_of(still);
        const auto goal = duet::pose(unit_of(still, 7), v_of(still, 10));
        return as_numbers(
            duet::resolved_step(robot, theta, sclerp(robot.pose(theta), goal, x[13]), 1));
      },
      []<class T>(const numbers<T>& x, const numbers<T>& d) {
        using namespace by_hand;
        const v3<T> none{};
        const T minus(-1);
        const panda<T> a(panda_table, part<7>(x, 0), part<7>(d, 0));
        const screw_displacement<T> c(a.alpha, a.t, unit<T>(part<3>(x, 7), none).q, part<3>(x, 10),
                                      x[13], d[13]);
        const auto [y, dy] = resolved(a, plus(c.position, times(minus, a.t)),
                                      plus(c.alpha, times(minus, a.alpha)), c.dposition, c.dalpha);
        return row<T>(plus(part<7>(x, 0), y), dy);
      },
      of_least_rates,
      [](const numbers<double>& x) {
        return is_regular(x) &&
               std::abs(dot(unit_of(x, 7), duet::rotation(robot.pose(joints_of(x))))) > 1e-3;
      });
  f.only_last_moves = true;
  return f;
}

} // namespace

std::vector<formula> planning_formulas() {
  return {
      make_formula(
          "N22", R"(\dot\Theta = B\dot\gamma,\; B = J^\top(JJ^\top)^{-1}J_2)",
          "resolved_rate_matrix", "motion/resolved_motion.hpp",
          {vector, vector, number, vector, argument::quaternion},
          []<class T>(const numbers<T>& x) {
            duet::vector7<T> rate;
            rate << v_of(x, 7), x[10], x[11], x[12], x[13];
            const Eigen::Matrix<T, 7, 1> y = duet::resolved_rate_matrix(robot, joints_of(x)) * rate;
            return as_numbers(y);
          },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            using namespace by_hand;
            const panda<T> a(panda_table, part<7>(x, 0), part<7>(d, 0));
            const auto [y, dy] =
                resolved(a, part<3>(x, 7), part<4>(x, 10), part<3>(d, 7), part<4>(d, 10));
            return row<T>(y, dy);
          },
          of_least_rates, is_regular),
      make_formula(
          "N23", R"(\Theta(t+h) = \Theta(t) + \beta B\,(\gamma(t+h) - \gamma(t)))", "resolved_step",
          "motion/resolved_motion.hpp", {vector, vector, number, rotation_vector, vector},
          []<class T>(const numbers<T>& x) {
            return as_numbers(duet::resolved_step(robot, joints_of(x),
                                                  duet::pose(unit_of(x, 7), v_of(x, 10)), .5));
          },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            using namespace by_hand;
            const auto [y, dy] =
                stepped(part<7>(x, 0), part<7>(d, 0), unit<T>(part<3>(x, 7), part<3>(d, 7)),
                        part<3>(x, 10), part<3>(d, 10), T(0.5));
            return row<T>(y, dy);
          },
          of_least_rates,
          [](const numbers<double>& x) {
            return is_regular(x) &&
                   std::abs(dot(unit_of(x, 7), duet::rotation(robot.pose(joints_of(x))))) > 1e-3;
          }),
      planning_step(), // Note 1 of N25: two poses of a path.
      make_formula(
          "N25",
          R"(\Theta_{k+1} = \Theta_k + \beta B\,(\gamma_{k+1} - \gamma(A(\Theta_k))),\; k = 0, 1)",
          "resolved_step", "motion/resolved_motion.hpp",
          {vector, vector, number, rotation_vector, vector, rotation_vector, vector},
          []<class T>(const numbers<T>& x) {
            const auto midway = duet::resolved_step(robot, joints_of(x),
                                                    duet::pose(unit_of(x, 7), v_of(x, 10)), .25);
            return as_numbers(
                duet::resolved_step(robot, midway, duet::pose(unit_of(x, 13), v_of(x, 16)), .25));
          },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            using namespace by_hand;
            std::pair theta(part<7>(x, 0), part<7>(d, 0));
            for (const std::size_t i : {7, 13}) {
              theta = stepped(theta.first, theta.second, unit<T>(part<3>(x, i), part<3>(d, i)),
                              part<3>(x, i + 3), part<3>(d, i + 3), T(0.25));
            }
            return row<T>(theta.first, theta.second);
          },
          of_least_rates,
          [](const numbers<double>& x) {
            const auto is_clear = [&](const numbers<double>& theta, std::size_t i) {
              return is_regular(theta) &&
                     std::abs(dot(unit_of(x, i), duet::rotation(robot.pose(joints_of(theta))))) >
                         1e-3;
            };
            return is_clear(x, 7) &&
                   is_clear(as_numbers(duet::resolved_step(
                                robot, joints_of(x), duet::pose(unit_of(x, 7), v_of(x, 10)), .25)),
                            13);
          })};
}

} // namespace duet_formulas
