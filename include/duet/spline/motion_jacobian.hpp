// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/derivative/manifold.hpp>
#include <duet/dual_quaternion/exponential_jacobian.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/spline/matrix_rows.hpp>
#include <duet/spline/motion.hpp>
#include <duet/spline/product_jacobian.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <type_traits>

/// \file
/// Jacobians of the value and the rates of a curve with respect to its control points and its
/// parameter.

namespace duet {

/// Jacobian of one quantity of a curve with respect to each active control point.
///
/// \tparam T         scalar of the curve
/// \tparam Count     number of control points
/// \tparam IsHybrid  true for rates of poses in `frame::hybrid`
template <class T, int Count, bool IsHybrid = false>
class tangent_blocks {
  using element = manifold<quaternion<T>>;
  static constexpr bool is_pose = element::dimension == 6;

public:
  using scalar = typename element::scalar;
  static constexpr int dimension = element::dimension;
  using block_type = Eigen::Matrix<scalar, dimension, dimension>;

  /// Number of active control points.
  [[nodiscard]] static constexpr int size() { return Count; }

  /// Derivative with respect to the i-th active control point: tangent from tangent, 3 × 3 in
  /// radians for rotations, 6 × 6 from and to [v; ω] for poses.
  [[nodiscard]] block_type block(int i) const {
    const auto m = detail::matrix_of(linear[std::size_t(i)]);
    if constexpr (!is_pose) {
      return m;
    } else {
      block_type result = detail::unfolded(m);
      if constexpr (IsHybrid) {
        result.template bottomRightCorner<3, 3>() = detail::matrix_of(angular[std::size_t(i)]);
      }
      return result;
    }
  }
  /// All blocks side by side.
  [[nodiscard]] Eigen::Matrix<scalar, dimension, dimension * Count> matrix() const {
    Eigen::Matrix<scalar, dimension, dimension * Count> result;
    for (int i = 0; i < Count; ++i) {
      result.template middleCols<dimension>(i * dimension) = block(i);
    }
    return result;
  }

  /// For those who extend duet.
  void set_zero() {
    linear.fill(detail::diagonal_rows<T>(T(0)));
    if constexpr (IsHybrid) {
      angular.fill(detail::diagonal_rows<scalar>(scalar(0)));
    }
  }

  // For those who extend duet: rows of the blocks, of poses dual A + εB for [A B; 0 A], in
  // `frame::hybrid` with another matrix for the lower right corner.

  struct none {
    none& operator[](std::size_t) { return *this; }
  };
  std::array<detail::matrix_rows<T>, std::size_t(Count)> linear = {};
  DUET_NO_UNIQUE_ADDRESS
  std::conditional_t<IsHybrid, std::array<detail::matrix_rows<scalar>, std::size_t(Count)>, none>
      angular = {};
};

/// A rate that was not requested.
struct not_computed {};

/// Motion of a curve at a parameter, with the Jacobians of the value and of `Rates` rates.
///
/// Let control points move as q exp(δ/2), or exp(δ/2) q with `perturbation::left`; then the value
/// moves as S exp(σ/2), or exp(σ/2) S. `value.block(i)` is ∂σ/∂δ with respect to control point
/// first + i; `velocity.block(i)` and the others are derivatives of the rates in `motion`. Tangents
/// of poses are [v; ω].
template <class T, int Count, int Rates, class Frame = body_frame>
struct curve_jacobian {
  static constexpr int value_dimension = manifold<quaternion<T>>::dimension;
  static constexpr bool is_pose = value_dimension == 6;
  static constexpr bool is_hybrid = is_pose && std::is_same_v<Frame, hybrid_frame>;
  using rate_type = typename duet::motion<T>::rate_type;
  template <int Order>
  using blocks_of_rate =
      std::conditional_t<(Rates >= Order), tangent_blocks<T, Count, is_hybrid>, not_computed>;

  duet::motion<T> motion;         ///< value and all rates in the frame
  std::size_t first = 0;          ///< number of the first active control point
  perturbation side = {};         ///< side on which control points and value move
  tangent_blocks<T, Count> value; ///< of the value
  blocks_of_rate<1> velocity;     ///< of the velocity
  blocks_of_rate<2> acceleration; ///< of the acceleration
  blocks_of_rate<3> jerk;         ///< of the jerk

  /// Derivatives with respect to u. Those of the highest rate are one-sided at knots.
  struct by_parameter {
    rate_type value = detail::zero_initialized<rate_type>(); ///< of the value: ω in body axes, for
                                                             ///< `perturbation::left` spatial axes
    rate_type velocity = value;                              ///< of the velocity: the acceleration
    rate_type acceleration = value;                          ///< of the acceleration: the jerk
    rate_type jerk = value;                                  ///< of the jerk
  };
  by_parameter parameter_derivative; ///< with respect to u, for offsets in time

  /// For those who extend duet: f(blocks, order) of the rates that were computed.
  template <class F>
  DUET_ALWAYS_INLINE void for_each_rate(const F& f) {
    if constexpr (Rates >= 1) {
      f(velocity, 1);
    }
    if constexpr (Rates >= 2) {
      f(acceleration, 2);
    }
    if constexpr (Rates >= 3) {
      f(jerk, 3);
    }
  }
  /// For those who extend duet: sets all rates, their blocks and derivatives to zero.
  void set_at_rest() {
    motion.velocity.setZero();
    motion.acceleration = motion.jerk = motion.velocity;
    parameter_derivative = {motion.velocity, motion.velocity, motion.velocity, motion.velocity};
    for_each_rate([](auto& blocks, std::size_t) { blocks.set_zero(); });
  }
};

namespace detail {

/// ω + εv, or ω, as a tangent.
template <class T>
[[nodiscard]] typename motion<T>::rate_type tangent_of(const three_vector<T>& v) {
  if constexpr (contains_tag<T, screw_tag>()) {
    return twist_of(v.eigen());
  } else {
    return v.eigen();
  }
}

/// ω and v of ω + εv.
template <class T>
[[nodiscard]] auto angular_part(const three_vector<T>& twist) {
  return three_vector{twist.x.value(), twist.y.value(), twist.z.value()};
}
template <class T>
[[nodiscard]] auto linear_part(const three_vector<T>& twist) {
  return three_vector{twist.x.epsilon(), twist.y.epsilon(), twist.z.epsilon()};
}
/// The rows of [A B; 0 A] that give angular parts: A alone, and as linear rows [0 A].
template <class S>
[[nodiscard]] matrix_rows<S> angular_part(const matrix_rows<screw_dual<S>>& m) {
  return {value_of(m.x), value_of(m.y), value_of(m.z)};
}
template <class S>
[[nodiscard]] matrix_rows<screw_dual<S>> angular_rows(const matrix_rows<screw_dual<S>>& m) {
  return {value_to_epsilon(m.x), value_to_epsilon(m.y), value_to_epsilon(m.z)};
}

/// Derivative of the jerk in the frame, from rates w, a, j, s in body axes.
template <class T, class Frame>
[[nodiscard]] typename motion<T>::rate_type snap_in(Frame, const quaternion<T>& value,
                                                    const std::array<three_vector<T>, 4>& rates) {
  const auto& [w, a, j, s] = rates;
  const real_type_t<T> two(2), three(3);
  constexpr bool is_pose = contains_tag<T, screw_tag>();
  const auto of_spatial_axes = [&](const auto& of_w, const auto& of_a, const auto& of_j,
                                   const auto& of_s) {
    return of_s + two * cross(of_w, of_j) + cross(of_w, cross(of_w, of_a));
  };
  if constexpr (std::is_same_v<Frame, body_frame>) {
    return tangent_of(s);
  } else if constexpr (is_pose && std::is_same_v<Frame, hybrid_frame>) {
    const auto omega = angular_part(w), alpha = angular_part(a), jerk = angular_part(j);
    const auto v = linear_part(w), v_1 = linear_part(a), v_2 = linear_part(j), v_3 = linear_part(s);
    // the acceleration in body axes x, and ẋ, with ẗ = R x
    const auto across = cross(omega, v);
    const auto third = v_2 + cross(alpha, v) + two * cross(omega, v_1) + cross(omega, across);
    const auto fourth = v_3 + cross(jerk, v) + three * cross(alpha, v_1) + two * cross(omega, v_2) +
                        cross(alpha, across) + cross(omega, cross(alpha, v) + cross(omega, v_1));
    const rotation_of_many to_fixed_axes(rotation(value));
    typename motion<T>::rate_type result;
    result << to_fixed_axes(fourth + cross(omega, third)).eigen(),
        to_fixed_axes(of_spatial_axes(omega, alpha, jerk, angular_part(s))).eigen();
    return result;
  } else {
    return tangent_of(three_vector<T>(rotated(value, of_spatial_axes(w, a, j, s))));
  }
}

/// Blocks of one control point in body axes, of the value and the rates.
template <int Rates, class T>
using blocks_in_body_axes = std::array<matrix_rows<T>, std::size_t(Rates) + 1>;

/// Blocks in spatial axes: w^s = Ad(S) w moves by Ad(S)(δw + σ × w), a^s likewise, and j^s by the
/// derivative of Ad(S)(j + w × a).
template <int Rates, class T>
void rotate_to_spatial_axes(blocks_in_body_axes<Rates, T>& d, const matrix_rows<T>& adjoint,
                            const std::array<three_vector<T>, 4>& rates) {
  const auto& [w, a, j, s] = rates;
  if constexpr (Rates >= 3) {
    const three_vector<T> along = j + cross(w, a);
    d[3] = rows_product(adjoint,
                        d[3] + minus_cross(a, d[1]) + cross(w, d[2]) + minus_cross(along, d[0]));
  }
  if constexpr (Rates >= 2) {
    d[2] = rows_product(adjoint, d[2] + minus_cross(a, d[0]));
  }
  if constexpr (Rates >= 1) {
    d[1] = rows_product(adjoint, d[1] + minus_cross(w, d[0]));
  }
}

/// Linear rows in `frame::hybrid`: derivatives of the origin are R x_k, with x_k in body axes as in
/// `follow_origin`, and move by R(δx_k + σ_ω × x_k).
template <int Rates, class S>
void rotate_linear_rows(blocks_in_body_axes<Rates, screw_dual<S>>& d,
                        const matrix_rows<S>& rotation,
                        const std::array<three_vector<screw_dual<S>>, 4>& rates) {
  const real_type_t<S> two(2);
  const auto omega = angular_part(rates[0]), alpha = angular_part(rates[1]);
  const auto v = linear_part(rates[0]), v_1 = linear_part(rates[1]), v_2 = linear_part(rates[2]);
  const auto across = cross(omega, v);
  const auto sigma = angular_rows(d[0]), d_omega = angular_rows(d[1]);
  if constexpr (Rates >= 3) {
    const auto x = v_2 + cross(alpha, v) + two * cross(omega, v_1) + cross(omega, across);
    const auto moved = d[3] + minus_cross(v, angular_rows(d[2])) + cross(alpha, d[1]) +
                       scaled(two, minus_cross(v_1, d_omega) + cross(omega, d[2])) +
                       minus_cross(across, d_omega) +
                       cross(omega, minus_cross(v, d_omega) + cross(omega, d[1]));
    d[3] = rows_product(rotation, moved + minus_cross(x, sigma));
  }
  if constexpr (Rates >= 2) {
    const auto moved = d[2] + minus_cross(v, d_omega) + cross(omega, d[1]);
    d[2] = rows_product(rotation, moved + minus_cross(v_1 + across, sigma));
  }
  d[1] = rows_product(rotation, d[1] + minus_cross(v, sigma));
}

/// Blocks of a Jacobian as arrays: of the value, then of the rates.
template <class T, int Count, int Rates, class Frame>
[[nodiscard]] block_pointers<Rates, T>
pointers_to_blocks(curve_jacobian<T, Count, Rates, Frame>& m) {
  block_pointers<Rates, T> blocks;
  blocks[0] = m.value.linear.data();
  m.for_each_rate([&](auto& of_rate, std::size_t k)
                      DUET_INLINE_LAMBDA { blocks[k] = of_rate.linear.data(); });
  return blocks;
}

/// Sets the motion, and converts blocks in body axes, for right perturbations, to the frame and the
/// side.
///
/// \param rates            w, a, j and the derivative of j in body axes
/// \param left_of_control  of i: Ad(q_i)⁻¹, which takes a left perturbation of control point i to
///                         the right one
template <class T, int Count, int Rates, class Frame, class LeftOfControl>
DUET_ALWAYS_INLINE void
set_frame(curve_jacobian<T, Count, Rates, Frame>& m, perturbation side, const quaternion<T>& value,
          const std::array<three_vector<T>, 4>& rates, const LeftOfControl& left_of_control) {
  constexpr bool is_body = std::is_same_v<Frame, body_frame>;
  using result_type = curve_jacobian<T, Count, Rates, Frame>;
  const auto& [w, a, j, s] = rates;
  const real_type_t<T> half(0.5);
  const bool is_right = side == perturbation::right;
  m.side = side;
  m.motion = motion_of(half_motion<T>{value, half * w, half * a, half * j}, Frame{});
  m.parameter_derivative = {tangent_of(is_right ? w : three_vector<T>(rotated(value, w))),
                            m.motion.acceleration, m.motion.jerk, snap_in(Frame{}, value, rates)};
  if (is_body && is_right) {
    return;
  }
  const block_pointers<Rates, T> blocks = pointers_to_blocks(m);
  const matrix_rows<T> adjoint = adjoint_rows(value);
  for (std::size_t i = 0; i < std::size_t(Count); ++i) {
    blocks_in_body_axes<Rates, T> d;
    for (std::size_t k = 0; k <= std::size_t(Rates); ++k) {
      d[k] = blocks[k][i];
    }
    const matrix_rows<T> of_control =
        is_right ? diagonal_rows<T>(T(1)) : matrix_rows<T>(left_of_control(i));
    if constexpr (result_type::is_hybrid && Rates >= 1) {
      using S = typename T::value_type;
      std::array<three_vector<S>, 4> angular_rates;
      blocks_in_body_axes<Rates, S> angular;
      for (std::size_t k = 0; k < 4; ++k) {
        angular_rates[k] = angular_part(rates[k]);
      }
      for (std::size_t k = 0; k <= std::size_t(Rates); ++k) {
        angular[k] = angular_part(d[k]);
      }
      const auto rotation_rows = adjoint_rows(rotation(value));
      rotate_to_spatial_axes<Rates>(angular, rotation_rows, angular_rates);
      m.for_each_rate([&](auto& of_rate, std::size_t k) {
        of_rate.angular[i] =
            is_right ? angular[k] : rows_product(angular[k], angular_part(of_control));
      });
      rotate_linear_rows<Rates>(d, rotation_rows, rates);
    } else if constexpr (!is_body) {
      rotate_to_spatial_axes<Rates>(d, adjoint, rates);
    }
    if (!is_right) {
      d[0] = rows_product(adjoint, d[0]);
    }
    for (std::size_t k = 0; k <= std::size_t(Rates); ++k) {
      blocks[k][i] = is_right ? d[k] : rows_product(d[k], of_control);
    }
  }
}

/// Jacobian of a product of exponentials as that of a curve, in any frame, for either perturbation.
///
/// \param controls  active control points
template <int Rates, class T, std::size_t Factors, class Weights, class Frame>
[[nodiscard]] DUET_OUT_OF_LINE curve_jacobian<T, int(Factors) + 1, Rates, Frame>
jacobian_of_product(const quaternion<T>* controls, const vector3<T>* increments,
                    const Weights& weights, Frame, perturbation side) {
  curve_jacobian<T, int(Factors) + 1, Rates, Frame> result;
  const functions_of_factors<T, Factors> functions(weights[0], increments);
  tail_vectors<T, Factors> tails(controls[0], increments, functions);
  tails.add_rates(weights);
  fill_product_jacobian<Rates>(tails, functions, increments, weights, pointers_to_blocks(result));
  set_frame(result, side, tails.value, tails.rates,
            [&](std::size_t i) DUET_INLINE_LAMBDA { return adjoint_rows(conj(controls[i])); });
  return result;
}

} // namespace detail

/// Point S(u) p of a moving body, with its Jacobian.
template <class T, int Count>
struct point_jacobian_result {
  using scalar = typename manifold<quaternion<T>>::scalar;
  static constexpr int dimension = manifold<quaternion<T>>::dimension;
  vector3<scalar> value = detail::zero_initialized<vector3<scalar>>(); ///< point in fixed axes
  /// Derivatives with respect to the active control points, side by side: 3 × 3 for each rotation,
  /// 3 × 6 for each pose.
  Eigen::Matrix<scalar, 3, dimension* Count> jacobian =
      Eigen::Matrix<scalar, 3, dimension * Count>::Zero();
  vector3<scalar> parameter_derivative = value; ///< velocity of the point, with respect to u

  /// Derivative with respect to the i-th active control point.
  [[nodiscard]] Eigen::Matrix<scalar, 3, dimension> block(int i) const {
    return jacobian.template middleCols<dimension>(i * dimension);
  }
};

/// Jacobian of the point S(u) p with respect to the control points and u, from that of the curve:
/// δ(S p) = R (σ_v + σ_ω × p) in body axes, σ_v + σ_ω × S p in spatial axes.
///
/// \param p  point in body axes
template <class T, int Count, int Rates, class Frame>
[[nodiscard]] point_jacobian_result<T, Count>
point_jacobian(const curve_jacobian<T, Count, Rates, Frame>& m,
               const vector3<typename manifold<quaternion<T>>::scalar>& p) {
  using S = typename manifold<quaternion<T>>::scalar;
  constexpr bool is_pose = curve_jacobian<T, Count, Rates, Frame>::is_pose;
  const bool is_right = m.side == perturbation::right;
  matrix3<S> r;
  point_jacobian_result<T, Count> result;
  if constexpr (is_pose) {
    r = rotation_matrix(rotation(m.motion.value));
    result.value = r * p + translation(m.motion.value);
  } else {
    r = rotation_matrix(m.motion.value);
    result.value = r * p;
  }
  const matrix3<S> axes = is_right ? r : matrix3<S>(matrix3<S>::Identity());
  const vector3<S> arm = is_right ? p : result.value;
  const auto arm_skew = detail::matrix_of(detail::skew_rows(detail::components(arm)));
  Eigen::Matrix<S, 3, curve_jacobian<T, Count, Rates, Frame>::value_dimension> by_value;
  if constexpr (is_pose) {
    by_value.template leftCols<3>() = axes;
  }
  by_value.template rightCols<3>() = -(axes * arm_skew);
  result.jacobian = by_value * m.value.matrix();
  result.parameter_derivative = by_value * m.parameter_derivative.value;
  return result;
}

} // namespace duet
