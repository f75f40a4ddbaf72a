// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/batch.hpp>
#include <duet/core/config.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/exponential_jacobian.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/spline/matrix_rows.hpp>
#include <duet/spline/orientations.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <type_traits>

/// \file
/// Jacobians of products of exponentials and of their rates with respect to the control points, in
/// closed form: the recursion behind `motion_jacobian`. Over dual numbers of rigid motion the
/// formulas of rotations are those of poses.
///
/// S = q_0 E_1 … E_n, E_j = exp(b_j ω_j), φ_j = 2ω_j = 2 log(q_{j−1}* q_j). Behind factor j stands
/// the tail T_j = E_{j+1} … E_n; P_j = Ad(T_j)⁻¹ takes vectors of its axes to those of S.
///
/// If all control points from q_j on are moved by the same d, q_i exp(d/2), the factors behind j do
/// not change in their own axes. The Jacobian of this motion, C_j, therefore needs factor j alone,
/// and that of one control point is C_j − C_{j+1}, with C_0 = I and C_{n+1} = 0.

namespace duet::detail {
DUET_ABI_BEGIN

/// Stumpff functions c_0(s) … c_3(s); those of a dual number from one sequence of its value by
/// c_n′ = (n c_{n+2} − c_{n+1})/2.
template <class D>
[[nodiscard]] DUET_ALWAYS_INLINE std::array<D, 4> four_stumpff_functions(const D& s) {
  using V = real_type_t<D>;
  if constexpr (std::is_same_v<D, screw_dual<V>>) {
    const auto c = stumpff_sequence<5>(s.value());
    const V half = s.epsilon() * V(0.5);
    return {D(c[0], V(-half * c[1])), D(c[1], V(half * (c[3] - c[2]))),
            D(c[2], V(half * (2 * c[4] - c[3]))), D(c[3], V(half * (3 * c[5] - c[4])))};
  } else {
    return stumpff_sequence<3>(s);
  }
}

/// Functions of one factor: those of ω̂ as a I + b ω̂ + c ω ωᵀ. D may have lanes, one a factor.
template <class D>
struct factor_functions {
  D u0, u1;                    ///< E = u0 + u1 ω
  D n_scalar, n_skew, n_outer; ///< N − I
  D e_scalar, e_skew, e_outer; ///< Ad(E)⁻¹ = e^{−bφ̂}
  D d_scalar, d_skew, d_outer; ///< J_r⁻¹(φ) Ad(E)⁻¹

  factor_functions() = default;

  /// Uses universal functions U_n(x) = xⁿ c_n(x² s), s = ω·ω, of b, 1 and 1 − b: regular at s = 0,
  /// singular at |φ| = 2π alone.
  ///
  /// N = b J_r(bφ) J_r⁻¹(φ) = (I − e^{−bφ̂})/(I − e^{−φ̂}), with the derivative J_r⁻¹(φ) e^{−bφ̂}
  /// with respect to b.
  template <class B>
  DUET_ALWAYS_INLINE factor_functions(const B& b, const D& s) {
    const B square = b * b;
    const auto at_b = four_stumpff_functions(D(square * s));
    const auto at_1 = four_stumpff_functions(s);
    u0 = at_b[0];
    u1 = b * at_b[1];
    const D u2 = square * at_b[2];
    const D u3 = B(square * b) * at_b[3];
    const D per_u1 = 1 / at_1[1];
    // of 1 − b
    const D r0 = at_1[0] * u0 + s * (at_1[1] * u1);
    const D r1 = at_1[1] * u0 - at_1[0] * u1;
    const D r2 = at_1[2] + at_1[0] * u2 - at_1[1] * u1;
    const D q1 = r1 * per_u1;
    n_scalar = -(q1 * u0);
    n_skew = q1 * u1;
    n_outer = (u3 - b * at_1[3] + u1 * r2) * per_u1;
    const D twice = u1 + u1;
    e_outer = twice * u1;
    e_skew = -(twice * u0);
    e_scalar = 1 - s * e_outer;
    d_scalar = (r0 * u0 + s * (r1 * u1)) * per_u1;
    d_skew = (r1 * u0 - r0 * u1) * per_u1;
    d_outer = (u2 - at_1[3] + u0 * r2 - u1 * r1) * per_u1;
  }
};

DUET_ABI_END
} // namespace duet::detail

/// Eleven scalars.
template <class D>
struct duet::structure<duet::detail::factor_functions<D>> {
  using scalar = D;
  template <class F, class... Rest>
  [[nodiscard]] DUET_ALWAYS_INLINE static auto
  map(F&& f, const duet::detail::factor_functions<D>& x, const Rest&... rest) {
    duet::detail::factor_functions<std::decay_t<decltype(f(x.u0, rest.u0...))>> result;
    result.u0 = f(x.u0, rest.u0...);
    result.u1 = f(x.u1, rest.u1...);
    result.n_scalar = f(x.n_scalar, rest.n_scalar...);
    result.n_skew = f(x.n_skew, rest.n_skew...);
    result.n_outer = f(x.n_outer, rest.n_outer...);
    result.e_scalar = f(x.e_scalar, rest.e_scalar...);
    result.e_skew = f(x.e_skew, rest.e_skew...);
    result.e_outer = f(x.e_outer, rest.e_outer...);
    result.d_scalar = f(x.d_scalar, rest.d_scalar...);
    result.d_skew = f(x.d_skew, rest.d_skew...);
    result.d_outer = f(x.d_outer, rest.d_outer...);
    return result;
  }
};

namespace duet::detail {
DUET_ABI_BEGIN

/// Functions of all factors: in the lanes of batches for plain numbers and their screws.
template <class T, std::size_t Factors>
class functions_of_factors {
  using R = real_type_t<T>;

public:
  static constexpr bool in_lanes =
      LaneReal<R> && (std::is_same_v<T, R> || std::is_same_v<T, screw_dual<R>>)&&(Factors > 1);
  static constexpr std::size_t count = in_lanes ? std::bit_ceil(Factors) : Factors;

  /// \param b  weights of the factors
  template <class B>
  DUET_OUT_OF_LINE functions_of_factors(const std::array<B, Factors>& b, const vector3<T>* omega) {
    const auto square = [&](std::size_t j) DUET_INLINE_LAMBDA {
      const three_vector<T> v = components(omega[j]);
      return T(dot(v, v));
    };
    if constexpr (in_lanes) {
      const auto at = [](std::size_t lane)
                          DUET_INLINE_LAMBDA { return std::min(lane, Factors - 1); };
      const auto weights =
          from_lanes<count>([&](std::size_t i) DUET_INLINE_LAMBDA { return b[at(i)]; });
      const auto squares =
          from_lanes<count>([&](std::size_t i) DUET_INLINE_LAMBDA { return square(at(i)); });
      const factor_functions functions(weights, squares);
      for (std::size_t j = 0; j < Factors; ++j) {
        functions_[j] = lane(functions, int(j));
      }
    } else {
      for (std::size_t j = 0; j < Factors; ++j) {
        functions_[j] = factor_functions(b[j], square(j));
      }
    }
  }
  [[nodiscard]] DUET_ALWAYS_INLINE const factor_functions<T>& operator[](std::size_t j) const {
    return functions_[j];
  }

private:
  std::array<factor_functions<T>, Factors> functions_;
};

/// Element [d][i]: Jacobian of the value (d = 0) or the d-th rate with respect to control point i.
template <int Rates, class T>
using block_pointers = std::array<matrix_rows<T>*, std::size_t(Rates) + 1>;

/// atan(√x)/√x of x ≤ tan²(π/8), by its series.
template <class D, int K = 0>
[[nodiscard]] DUET_ALWAYS_INLINE D arctangent_ratio(const D& x) {
  using R = lane_type_t<real_type_t<D>>;
  constexpr R coefficient = R(K % 2 == 0 ? 1 : -1) / R(2 * K + 1);
  if constexpr (K == 20) {
    return D(coefficient);
  } else {
    return coefficient + x * arctangent_ratio<D, K + 1>(x);
  }
}

/// Increments ω_j = log(q_{j−1}* q_j) of control points less than a full turn apart, all in lanes
/// for plain numbers and their screws. With the vector part v and the scalar part w of the relative
/// rotation, ω = 4 atan(z/(1 + √(1 + z²))) v/|v|, z = |v|/(|q| + w): no branch, regular at v = 0.
template <class T, std::size_t Factors>
[[nodiscard]] DUET_ALWAYS_INLINE std::array<vector3<T>, Factors>
increments_between(const quaternion<T>* controls, const char* function) {
  std::array<vector3<T>, Factors> result;
  if constexpr (functions_of_factors<T, Factors>::in_lanes) {
    using std::sqrt;
    constexpr std::size_t count = functions_of_factors<T, Factors>::count;
    const auto from = [&](std::size_t offset) DUET_INLINE_LAMBDA {
      return from_lanes<count>([&](std::size_t i) DUET_INLINE_LAMBDA -> const quaternion<T>& {
        return controls[std::min(i, Factors - 1) + offset];
      });
    };
    const auto q = relative_rotation(from(0), from(1));
    using D = typename std::decay_t<decltype(q)>::scalar_type;
    const D s = q.x() * q.x() + q.y() * q.y() + q.z() * q.z();
    const D per_sum = 1 / D(sqrt(D(s + q.w() * q.w())) + q.w());
    const D square = s * per_sum * per_sum; // z²
    const D per_root = 1 / D(1 + D(sqrt(D(1 + square))));
    const D ratio = 4 * per_sum * per_root * arctangent_ratio<D>(square * per_root * per_root);
    const vector3<D> omega(q.x() * ratio, q.y() * ratio, q.z() * ratio);
    for (std::size_t j = 0; j < Factors; ++j) {
      result[j] = {lane(omega[0], int(j)), lane(omega[1], int(j)), lane(omega[2], int(j))};
    }
  } else {
    for (std::size_t j = 0; j < Factors; ++j) {
      result[j] = log_vector(relative_rotation(controls[j], controls[j + 1]), function);
    }
  }
  return result;
}

/// Vectors of the tails, in axes of S, from the last factor to the first.
template <class T, std::size_t Factors>
struct tail_vectors {
  using vector = three_vector<T>;
  quaternion<T> value;                                 ///< S
  std::array<vector, Factors> omega;                   ///< P_j ω_j = ½Φ_j
  std::array<std::array<vector, 3>, Factors> velocity; ///< v_j, v_j′, v_j″ of tail T_j
  std::array<vector, 4> rates; ///< w = v_0, a = v_0′, j = v_0″ and v_0‴

  DUET_OUT_OF_LINE tail_vectors(const quaternion<T>& start, const vector3<T>* increments,
                                const functions_of_factors<T, Factors>& functions) {
    quaternion<T> tail(T(1));
    for (std::size_t j = Factors; j-- > 0;) {
      const auto& f = functions[j];
      const vector own = components(increments[j]);
      const bool is_last = j + 1 == Factors;
      omega[j] = is_last ? own : vector(rotated(conj(tail), own));
      const vector u1_omega = f.u1 * own;
      const quaternion<T> e(f.u0, u1_omega.x, u1_omega.y, u1_omega.z);
      tail = is_last ? e : quaternion<T>(e * tail);
    }
    value = start * tail;
  }

  /// Velocities of the tails, v_{j−1} = v_j + b_j′Φ_j, and their derivatives, with Φ_j = P_j φ_j
  /// and Φ_j′ = Φ_j × v_j.
  ///
  /// \param b  element [d][j] is the d-th derivative of the weight of factor j, d ≤ 4
  template <class Weights>
  DUET_OUT_OF_LINE void add_rates(const Weights& b) {
    const real_type_t<T> two(2), three(3);
    const T zero(0);
    const vector none{zero, zero, zero};
    vector v = none, v_1 = none, v_2 = none, v_3 = none;
    for (std::size_t j = Factors; j-- > 0;) {
      velocity[j] = {v, v_1, v_2};
      const vector phi = two * omega[j];
      if (j + 1 == Factors) {
        v = b[1][j] * phi;
        v_1 = b[2][j] * phi;
        v_2 = b[3][j] * phi;
        v_3 = b[4][j] * phi;
      } else {
        const vector phi_1 = cross(phi, v);
        const vector phi_2 = cross(phi_1, v) + cross(phi, v_1);
        const vector phi_3 = cross(phi_2, v) + two * cross(phi_1, v_1) + cross(phi, v_2);
        v_3 = v_3 + b[4][j] * phi + (three * b[3][j]) * phi_1 + (three * b[2][j]) * phi_2 +
              b[1][j] * phi_3;
        v_2 = v_2 + b[3][j] * phi + (two * b[2][j]) * phi_1 + b[1][j] * phi_2;
        v_1 = v_1 + b[2][j] * phi + b[1][j] * phi_1;
        v = v + b[1][j] * phi;
      }
    }
    rates = {v, v_1, v_2, v_3};
  }
};

/// Fills the Jacobians of a product of exponentials and its rates in body axes, for right
/// perturbations: q_i exp(d_i/2) moves S as S exp(σ/2), σ = Σ block_i d_i.
///
/// With y_j = w − v_j, Q_j = P_{j−1} J_r⁻¹(φ_j), H_j = P_j (N_j − I) and C_j = I + H_j:
///   Q′ = −v_{j−1} × Q,   Q″ = −v_{j−1}′ × Q − v_{j−1} × Q′,
///   H′ = b′Q − v_j × H,   H″ = b″Q + b′Q′ − v_j′ × H − v_j × H′,
///   F^w = b′Q + y × H,   F^a = dF^w/du,   F^j = dF^a/du,
/// and for rates C_j is F_j + ŵ, F_j + â or F_j + ĵ, as dw = σ′ + w × σ and its derivatives give.
/// All matrices are products with numbers and skew matrices from the left: P ω̂ = (Pω)^ P.
///
/// \param b  element [d][j] is the d-th derivative of the weight of factor j
template <int Rates, class T, std::size_t Factors, class Weights>
DUET_OUT_OF_LINE void fill_product_jacobian(const tail_vectors<T, Factors>& tails,
                                            const functions_of_factors<T, Factors>& functions,
                                            const vector3<T>* increments, const Weights& b,
                                            const block_pointers<Rates, T>& blocks) {
  using matrix = matrix_rows<T>;
  [[maybe_unused]] const real_type_t<T> two(2);
  std::array<matrix, std::size_t(Rates) + 1> behind; // F_{j+1}, at first −I, −ŵ, −â, −ĵ
  behind[0] = negated(diagonal_rows<T>(T(1)));
  for (std::size_t d = 1; d <= std::size_t(Rates); ++d) {
    behind[d] = negated(skew_rows(tails.rates[d - 1]));
  }
  matrix p = diagonal_rows<T>(T(1));
  matrix p_skew = skew_rows(tails.omega[Factors - 1]);
  for (std::size_t j = Factors; j-- > 0;) {
    const auto& f = functions[j];
    const matrix p_outer = outer_product(tails.omega[j], row_of(components(increments[j])));
    const auto combined = [&](const T& scalar, const T& skew, const T& outer) DUET_INLINE_LAMBDA {
      return scaled(scalar, p) + scaled(skew, p_skew) + scaled(outer, p_outer);
    };
    std::array<matrix, std::size_t(Rates) + 1> sums; // F_j
    const matrix h = combined(f.n_scalar, f.n_skew, f.n_outer);
    sums[0] = h;
    if constexpr (Rates >= 1) {
      const auto& v = tails.velocity[j];
      const auto y = [&](std::size_t d)
                         DUET_INLINE_LAMBDA { return three_vector<T>(tails.rates[d] - v[d]); };
      const matrix q = combined(f.d_scalar, f.d_skew, f.d_outer);
      const matrix first = scaled(b[1][j], q);
      sums[1] = first + cross(y(0), h);
      if constexpr (Rates >= 2) {
        const three_vector<T>* before = j > 0 ? &tails.velocity[j - 1][0] : &tails.rates[0];
        const matrix q_1 = minus_cross(before[0], q);
        const matrix h_1 = first + minus_cross(v[0], h);
        const matrix second = scaled(b[2][j], q) + scaled(b[1][j], q_1);
        sums[2] = second + cross(y(1), h) + cross(y(0), h_1);
        if constexpr (Rates >= 3) {
          const matrix q_2 = minus_cross(before[1], q) + minus_cross(before[0], q_1);
          const matrix h_2 = second + minus_cross(v[1], h) + minus_cross(v[0], h_1);
          const auto twice = two * b[2][j];
          sums[3] = scaled(b[3][j], q) + scaled(twice, q_1) + scaled(b[1][j], q_2) +
                    cross(y(2), h) + scaled(two, cross(y(1), h_1)) + cross(y(0), h_2);
        }
      }
    }
    for (std::size_t d = 0; d <= std::size_t(Rates); ++d) {
      blocks[d][j + 1] = sums[d] - behind[d];
      behind[d] = sums[d];
    }
    if (j > 0) {
      p = combined(f.e_scalar, f.e_skew, f.e_outer);
      p_skew = cross(tails.omega[j - 1], p);
    }
  }
  for (std::size_t d = 0; d <= std::size_t(Rates); ++d) {
    blocks[d][0] = negated(behind[d]);
  }
}

/// Value of a product of exponentials, and its Jacobians: the above without rates.
///
/// \param b  weights of the factors
template <class T, class R, std::size_t Factors>
[[nodiscard]] DUET_ALWAYS_INLINE quaternion<T>
value_of_product(const quaternion<T>& start, const vector3<T>* increments,
                 const std::array<R, Factors>& b, std::array<matrix_rows<T>, Factors + 1>& blocks) {
  const std::array<std::array<R, Factors>, 1> weights{b};
  const functions_of_factors<T, Factors> functions(b, increments);
  const tail_vectors<T, Factors> tails(start, increments, functions);
  fill_product_jacobian<0, T, Factors>(tails, functions, increments, weights, {blocks.data()});
  return tails.value;
}

DUET_ABI_END
} // namespace duet::detail
