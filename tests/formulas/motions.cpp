// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "formulas/arm_by_hand.hpp"
#include "formulas/by_hand.hpp"
#include "formulas/parts.hpp"
#include "formulas/table.hpp"

#include <duet/dual_quaternion/pose.hpp>
#include <duet/kinematics/robots.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/spline/cumulative_bspline.hpp>

#include <Eigen/Core>

// P1–P4, and the four arms.

namespace by_hand {
namespace {

/// log of a unit quaternion.
template <class T>
v3<T> half_rotation_vector(const q4<T>& q) {
  using std::atan2, std::sqrt;
  const T length = sqrt(dot(vec(q), vec(q)));
  return times(length > 0 ? T(atan2(length, q[0]) / length) : T(1), vec(q));
}

/// P2 on a span of the uniform cubic, with its velocity in body axes, and its rates: Q′ = Q w (P3),
/// Q″ = Q (w² + w′) (P4) and Q‴ = Q (w³ + 2 w w′ + w′ w + w″).
template <class T>
struct cubic {
  q4<T> q, dq, ddq, dddq;
  v3<T> omega, domega;

  cubic(const std::array<v3<T>, 4>& rotations, const T& u) {
    const v3<T> none{};
    const T left = 1 - u;
    const T weights[] = {T(1 - left * left * left / 6),
                         T((1 + 3 * u * (1 + u * left) + u * u * u) / 6), T(u * u * u / 6)};
    const T rates[] = {T(left * left / 2), T(0.5) + u * left, T(u * u / 2)};
    const T second[] = {T(-left), T(1 - 2 * u), u};
    const T third[] = {T(1), T(-2), T(1)};
    q4<T> before = unit<T>(rotations[0], none).q;
    q = before;
    v3<T> w = none, a = none, j = none;
    for (std::size_t i = 0; i < 3; ++i) {
      q4<T> next = unit<T>(rotations[i + 1], none).q;
      next = times(T(dot(before, next) < 0 ? -1 : 1), next);
      const v3<T> increment = half_rotation_vector(product(conj(before), next));
      const q4<T> e = unit<T>(times(T(2 * weights[i]), increment), none).q;
      const auto carried = [&](const v3<T>& v) {
        return vec(product(product(conj(e), pure(v)), e));
      };
      const v3<T> part = times(rates[i], increment), dpart = times(second[i], increment);
      const v3<T> old_w = carried(w), old_a = carried(a);
      w = plus(old_w, part);
      a = plus(old_a, plus(dpart, times(T(2), cross(w, part))));
      j = plus(plus(carried(j), times(third[i], increment)),
               plus(times(T(4), cross(plus(old_a, cross(old_w, part)), part)),
                    times(T(2), cross(old_w, dpart))));
      q = product(q, e);
      before = next;
    }
    const auto of = [](const v3<T>& x, const v3<T>& y) { return product(pure(x), pure(y)); };
    const q4<T> square = plus(of(w, w), pure(a));
    dq = product(q, pure(w));
    ddq = product(q, square);
    dddq = product(q, plus(plus(product(pure(w), plus(square, pure(a))), of(a, w)), pure(j)));
    omega = times(T(2), w);
    domega = times(T(2), a);
  }
};

/// P1, and its derivative: 1 on the span from knot 3 to knot 4, and the recurrence.
template <class T>
std::pair<T, T> de_boor_cox(const double* knots, std::size_t i, std::size_t order, const T& u) {
  if (order == 1) {
    return {T(i == 3 ? 1 : 0), T(0)};
  }
  const T rise(T(knots[i + order - 1]) - T(knots[i]));
  const T fall(T(knots[i + order]) - T(knots[i + 1]));
  const auto [b, db] = de_boor_cox(knots, i, order - 1, u);
  const auto [c, dc] = de_boor_cox(knots, i + 1, order - 1, u);
  const T up = (u - knots[i]) / rise, down = (knots[i + order] - u) / fall;
  return {T(up * b + down * c), T(b / rise + up * db - c / fall + down * dc)};
}

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

/// Uneven knots with one span, from 0 to 1, in the domain.
constexpr double knots[] = {-3, -1.5, -1, 0, 1, 1.25, 3, 4};

/// The four basis functions of the span.
formula basis_functions() {
  return make_formula(
      "P1",
      R"(B_i^k = \frac{u-u_i}{u_{i+k-1}-u_i}B_i^{k-1} + \frac{u_{i+k}-u}{u_{i+k}-u_{i+1}}B_{i+1}^{k-1})",
      "bspline_basis", "spline/basis.hpp", {argument::fraction},
      []<class T>(const numbers<T>& x) {
        const duet::bspline_basis<4> basis(std::vector<double>(std::begin(knots), std::end(knots)));
        const auto [w] = basis.weights<0>(0, x[0]);
        return numbers<T>{T(1 - w[0]), T(w[0] - w[1]), T(w[1] - w[2]), w[2]};
      },
      []<class T>(const numbers<T>& x, const numbers<T>& d) {
        numbers<T> values, slopes;
        for (std::size_t i = 0; i < 4; ++i) {
          const auto [b, db] = by_hand::de_boor_cox(knots, i, 4, x[0]);
          values.push_back(b);
          slopes.push_back(db * d[0]);
        }
        values.insert(values.end(), slopes.begin(), slopes.end());
        return values;
      },
      {8, 16}); // differences of cumulative functions
}

/// True if the shorter arc from each rotation to the next is unambiguous.
bool arcs_are_short(const numbers<double>& x) {
  const auto q = still_rotations(x);
  bool is_valid = true;
  for (std::size_t i = 1; i < q.size(); ++i) {
    is_valid = is_valid && std::abs(dot(q[i - 1], q[i])) > 1e-3;
  }
  return is_valid;
}

template <class T>
by_hand::cubic<T> cubic_of(const numbers<T>& x) {
  using by_hand::part;
  return {{part<3>(x, 0), part<3>(x, 3), part<3>(x, 6), part<3>(x, 9)}, x[12]};
}

duet::cumulative_bspline<double> curve_through(const std::vector<duet::quaternion<double>>& q) {
  return {{-3, -2, -1, 0, 1, 2, 3, 4}, q};
}

/// Control rotations are constant, only u varies.
formula cumulative_curve() {
  auto f = make_formula(
      "P2", R"(Q(u) = q_0\prod_i \exp(\omega_i\tilde B_i(u)),\; \omega^b(u))", "cumulative_bspline",
      "spline/cumulative_bspline.hpp",
      {rotation_vector, rotation_vector, rotation_vector, rotation_vector, argument::fraction},
      []<class T>(const numbers<T>& x) {
        const auto m = curve_through(still_rotations(x)).motion(x[12], duet::frame::body);
        return all<T>(m.value, duet::vector3<T>(m.velocity));
      },
      []<class T>(const numbers<T>& x, const numbers<T>& d) {
        using namespace by_hand;
        const cubic<T> c = cubic_of(x);
        return row<T>(c.q, c.omega, times(d[12], c.dq), times(d[12], c.domega));
      },
      {16, 16}, arcs_are_short);
  f.only_last_moves = true;
  return f;
}

/// P3 and P4: Q′ or Q″.
formula rate_of_curve(std::size_t order) {
  auto f = make_formula(
      order == 1 ? "P3" : "P4",
      order == 1
          ? R"(Q' = Q\,w,\; w \leftarrow e_j^*we_j + \tilde B_j'\omega_j)"
          : R"(Q'' = Q\,(a + w^2),\; a \leftarrow e_j^*ae_j + \tilde B_j''\omega_j + 2\,e_j^*we_j\times\tilde B_j'\omega_j)",
      "cumulative_bspline::derivatives", "spline/piecewise_curve.hpp",
      {rotation_vector, rotation_vector, rotation_vector, rotation_vector, argument::fraction},
      [order]<class T>(const numbers<T>& x) {
        return all<T>(curve_through(still_rotations(x)).derivatives(x[12])[order]);
      },
      [order]<class T>(const numbers<T>& x, const numbers<T>& d) {
        const by_hand::cubic<T> c = cubic_of(x);
        return order == 1 ? by_hand::row<T>(c.dq, by_hand::times(d[12], c.ddq))
                          : by_hand::row<T>(c.ddq, by_hand::times(d[12], c.dddq));
      },
      {16, 16}, arcs_are_short);
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
      std::move(label), R"(A(\Theta),\; t(\Theta))", std::move(function), "kinematics/robots.hpp",
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
  return {basis_functions(),
          cumulative_curve(),
          rate_of_curve(1),
          rate_of_curve(2),
          arm("Panda", "robots::panda", duet::robots::panda().table(), by_hand::panda_table),
          arm("iiwa 14", "robots::iiwa14", duet::robots::iiwa14().table(), by_hand::iiwa14_table),
          arm("UR5e", "robots::ur5e", duet::robots::ur5e().table(), by_hand::ur5e_table),
          arm("Baxter", "robots::baxter_left", duet::robots::baxter_left().table(),
              by_hand::baxter_left_table)};
}

} // namespace duet_formulas
