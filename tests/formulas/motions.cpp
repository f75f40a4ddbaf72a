// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "formulas/arm_by_hand.hpp"
#include "formulas/by_hand.hpp"
#include "formulas/parts.hpp"
#include "formulas/table.hpp"

#include <duet/dual_quaternion/pose.hpp>
#include <duet/mechanism/robots.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/spline/cumulative_bspline.hpp>

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

// P2, and the four arms.

namespace by_hand {
namespace {

/// log of a unit quaternion.
template <class T>
v3<T> half_rotation_vector(const q4<T>& q) {
  using std::atan2;
  using std::sqrt;
  const T length = sqrt(dot(vec(q), vec(q)));
  return times(length > 0 ? T(atan2(length, q[0]) / length) : T(1), vec(q));
}

/// P2 on a span of the uniform cubic, with its velocity in body axes, and their rates.
template <class T>
struct cubic {
  q4<T> q, dq;
  v3<T> omega, domega;

  cubic(const std::array<v3<T>, 4>& rotations, const T& u) {
    const v3<T> none{};
    const T left = 1 - u;
    const T weights[] = {T(1 - left * left * left / 6),
                         T((1 + 3 * u * (1 + u * left) + u * u * u) / 6), T(u * u * u / 6)};
    const T rates[] = {T(left * left / 2), T(0.5) + u * left, T(u * u / 2)};
    const T second[] = {T(-left), T(1 - 2 * u), u};
    q4<T> before = unit<T>(rotations[0], none).q;
    q = before;
    v3<T> w = none, a = none;
    for (std::size_t i = 0; i < 3; ++i) {
      q4<T> next = unit<T>(rotations[i + 1], none).q;
      next = times(T(dot(before, next) < 0 ? -1 : 1), next);
      const v3<T> increment = half_rotation_vector(product(conj(before), next));
      const q4<T> e = unit<T>(times(T(2 * weights[i]), increment), none).q;
      const auto carried = [&](const v3<T>& v) {
        return vec(product(product(conj(e), pure(v)), e));
      };
      const v3<T> part = times(rates[i], increment);
      w = plus(carried(w), part);
      a = plus(carried(a), plus(times(second[i], increment), times(T(2), cross(w, part))));
      q = product(q, e);
      before = next;
    }
    dq = product(q, pure(w));
    omega = times(T(2), w);
    domega = times(T(2), a);
  }
};

} // namespace
} // namespace by_hand

namespace duet_formulas {
namespace {

constexpr auto rotation_vector = argument::rotation;

template <class T>
std::vector<duet::quaternion<duet::real_type_t<T>>> still_rotations(const numbers<T>& x) {
  using R = duet::real_type_t<T>;
  std::vector<duet::quaternion<R>> result;
  for (std::size_t i = 0; i < 12; i += 3) {
    result.push_back(duet::from_rotation_vector(duet::vector3<R>(
        duet::innermost(x[i]), duet::innermost(x[i + 1]), duet::innermost(x[i + 2]))));
  }
  return result;
}

/// Control rotations stand still, only u moves.
formula cumulative_curve() {
  auto f = make_formula(
      "P2", R"(Q(u) = q_0\prod_i \exp(\omega_i\tilde B_i(u)),\; \omega^b(u))", "cumulative_bspline",
      "spline/cumulative_bspline.hpp",
      {rotation_vector, rotation_vector, rotation_vector, rotation_vector, argument::fraction},
      []<class T>(const numbers<T>& x) {
        const duet::cumulative_bspline<double> curve({-3, -2, -1, 0, 1, 2, 3, 4},
                                                     still_rotations(x));
        const auto m = curve.motion(x[12], duet::frame::body);
        return all<T>(m.value, duet::vector3<T>(m.velocity));
      },
      []<class T>(const numbers<T>& x, const numbers<T>& d) {
        using namespace by_hand;
        const cubic<T> c({part<3>(x, 0), part<3>(x, 3), part<3>(x, 6), part<3>(x, 9)}, x[12]);
        return row<T>(c.q, c.omega, times(d[12], c.dq), times(d[12], c.domega));
      },
      {16, 16},
      [](const numbers<double>& x) {
        const auto q = still_rotations(x);
        bool is_valid = true;
        for (std::size_t i = 1; i < q.size(); ++i) {
          is_valid = is_valid && std::abs(dot(q[i - 1], q[i])) > 1e-3;
        }
        return is_valid;
      });
  f.only_last_moves = true;
  return f;
}

template <std::size_t N, class Chain>
formula arm(std::string label, std::string function, const Chain& chain,
            const by_hand::arm_table<N>& table) {
  std::vector<argument> joints{rotation_vector, rotation_vector};
  if (N == 7) {
    joints.push_back(argument::number);
  }
  return make_formula(
      std::move(label), R"(A(\Theta),\; t(\Theta))", std::move(function), "mechanism/robots.hpp",
      std::move(joints),
      [&chain]<class T>(const numbers<T>& x) {
        const auto a = chain.pose(Eigen::Map<const Eigen::Matrix<T, int(N), 1>>(x.data()));
        return all<T>(a, translation(a));
      },
      [table]<class T>(const numbers<T>& x, const numbers<T>& d) {
        using namespace by_hand;
        const by_hand::arm<T, N> a(table, part<N>(x, 0), part<N>(d, 0));
        const T half(0.5);
        return row<T>(a.alpha, times(half, product(pure(a.t), a.alpha)), a.t, a.dalpha,
                      times(half, plus(product(pure(a.dt), a.alpha), product(pure(a.t), a.dalpha))),
                      a.dt);
      },
      {16, 16});
}

} // namespace

std::vector<formula> motion_formulas() {
  return {cumulative_curve(),
          arm("Panda", "robots::panda", duet::robots::panda().table(), by_hand::panda_table),
          arm("iiwa 14", "robots::iiwa14", duet::robots::iiwa14().table(), by_hand::iiwa14_table),
          arm("UR5e", "robots::ur5e", duet::robots::ur5e().table(), by_hand::ur5e_table),
          arm("Baxter", "robots::baxter_left", duet::robots::baxter_left().table(),
              by_hand::baxter_left_table)};
}

} // namespace duet_formulas
