// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/structure.hpp>
#include <duet/kinematics/jacobian.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Core>

#include <concepts>

/// \file
/// Derivatives of the Jacobian of a chain: its time derivative along a motion, and its derivatives
/// with respect to each coordinate (the kinematic Hessian).

namespace duet {

namespace detail {

/// ad(a) b = [ω_a × v_b + v_a × ω_b; ω_a × ω_b], the Lie bracket.
template <class S>
[[nodiscard]] twist_column<S> bracket(const twist_column<S>& a, const twist_column<S>& b) {
  return {cross(a.omega, b.v) + cross(a.v, b.omega), cross(a.omega, b.omega)};
}

/// ∂J_k/∂θ_j in terms of the columns of J.
///
/// Spatial: the screw of joint k is carried by the joints before it, ad(J_j) J_k, j < k. Body: it
/// is carried in the opposite sense by those after it, ad(J_k) J_j, j > k. Hybrid: axes rotate with
/// the joints before, ω_j × ω_k, and the tip moves with all, u the velocity of its origin: ω_j ×
/// u_k for j ≤ k, ω_k × u_j for j > k.
template <class Frame, class S>
[[nodiscard]] twist_column<S> column_by_joint(const twist_column<S>& k, const twist_column<S>& j,
                                              bool j_is_before_k) {
  const three_vector<S> zero{S(0), S(0), S(0)};
  if constexpr (std::same_as<Frame, spatial_frame>) {
    return j_is_before_k ? bracket(j, k) : twist_column<S>{zero, zero};
  } else if constexpr (std::same_as<Frame, body_frame>) {
    return j_is_before_k ? twist_column<S>{zero, zero} : bracket(k, j);
  } else {
    return j_is_before_k ? twist_column<S>{cross(j.omega, k.v), cross(j.omega, k.omega)}
                         : twist_column<S>{cross(k.omega, j.v), zero};
  }
}

} // namespace detail

/// Kinematic Hessian of a frame on a chain, the second derivatives of its pose: n matrices ∂J/∂θ_j
/// of 6 rows, side by side in one matrix.
template <class S, int N>
class chain_hessian {
  static constexpr int columns = N > 0 ? N* N : Eigen::Dynamic;

public:
  explicit chain_hessian(Eigen::Index n) : size_(n), values_(6, n * n) {}

  /// n, the number of joints.
  [[nodiscard]] Eigen::Index size() const { return size_; }
  /// ∂J/∂θ_j.
  [[nodiscard]] detail::joint_columns<S, 6, N> operator[](Eigen::Index j) const {
    return values_.template middleCols<(N > 0 ? N : Eigen::Dynamic)>(j * size_, size_);
  }
  /// ∂J_ik/∂θ_j.
  [[nodiscard]] const S& operator()(Eigen::Index i, Eigen::Index k, Eigen::Index j) const {
    return values_(i, j * size_ + k);
  }
  [[nodiscard]] S& operator()(Eigen::Index i, Eigen::Index k, Eigen::Index j) {
    return values_(i, j * size_ + k);
  }

private:
  Eigen::Index size_;
  Eigen::Matrix<S, 6, columns, Eigen::ColMajor, 6, N * N> values_;
};

/// Kinematic Hessian ∂J/∂θ_j for all j: `h[j]` has 6 rows and one column per joint; its column k is
/// ∂²/∂θ_j∂θ_k as a twist.
///
/// Only in `frame::hybrid` the linear part is ∂²p/∂θ_j∂θ_k of the frame's origin p, symmetric in j
/// and k. Arguments as `jacobian`.
///
/// \return `chain_hessian<S, N>`
template <SerialChain C, VectorLike X, FrameConstant Frame, FrameOnChain<C> At = tip_of_chain>
[[nodiscard]] auto kinematic_hessian(const C& chain, const X& theta, Frame frame_of_result,
                                     const At& at = {}) {
  const auto m = jacobian(chain, theta, frame_of_result, at);
  using S = detail::chain_scalar<C, X>;
  const Eigen::Index n = chain.size();
  chain_hessian<S, C::joints> h(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto column_j = detail::column_of(m, j);
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto column = detail::column_by_joint<Frame>(detail::column_of(m, k), column_j, j <= k);
      detail::set_column(h, column, k, j);
    }
  }
  return h;
}

/// J and its time derivative J̇ = Σ_j ∂J/∂θ_j θ̇_j.
template <class J>
struct jacobian_and_rate {
  J jacobian = detail::zero_initialized<J>(); ///< J, 6 rows and a column for each joint
  J rate = detail::zero_initialized<J>();     ///< J̇, of the same size, per unit of time

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("jacobian", jacobian);
    f("rate", rate);
  }
};

/// J and J̇ along the joint velocities θ̇, so that J θ̈ + J̇ θ̇ is the derivative of the twist J
/// θ̇. In `frame::hybrid` its linear part is the classical acceleration of the frame's origin, p̈;
/// in the other frames it is not (see docs/reference/jacobians_and_frames.md). Arguments as
/// `jacobian`.
///
/// \return `jacobian_and_rate`
template <SerialChain C, VectorLike X, VectorLike V, FrameConstant Frame,
          FrameOnChain<C> At = tip_of_chain>
[[nodiscard]] auto jacobian_with_rate(const C& chain, const X& theta, const V& theta_dot,
                                      Frame frame_of_result, const At& at = {}) {
  detail::require_size(chain, theta_dot);
  using velocities = detail::vector_argument<V>;
  using S = promote_t<detail::chain_scalar<C, X>, typename velocities::scalar>;
  using matrix = detail::joint_columns<S, 6, C::joints>;
  jacobian_and_rate<matrix> result{jacobian(chain, theta, frame_of_result, at).template cast<S>(),
                                   {}};
  const matrix& m = result.jacobian;
  const Eigen::Index n = chain.size();
  result.rate.resize(6, n);
  // Sums of the twists of those joints that contribute.
  const auto add = [&](detail::twist_column<S>& sum, Eigen::Index i) {
    const auto column = detail::column_of(m, i);
    const S rate(velocities::get(theta_dot, i));
    sum = {sum.v + rate * column.v, sum.omega + rate * column.omega};
  };
  constexpr bool is_hybrid = std::same_as<Frame, hybrid_frame>;
  if constexpr (!std::same_as<Frame, body_frame>) {
    auto before = detail::no_twist<S>();
    for (Eigen::Index k = 0; k < n; ++k) {
      if constexpr (is_hybrid) {
        add(before, k);
      }
      const auto rate = detail::column_by_joint<Frame>(detail::column_of(m, k), before, true);
      detail::set_column(result.rate, rate, k);
      if constexpr (!is_hybrid) {
        add(before, k);
      }
    }
  }
  if constexpr (!std::same_as<Frame, spatial_frame>) {
    auto after = detail::no_twist<S>();
    for (Eigen::Index k = n - 1; k >= 0; --k) {
      auto rate = detail::column_by_joint<Frame>(detail::column_of(m, k), after, false);
      if constexpr (is_hybrid) {
        const auto by_before = detail::column_of(result.rate, k);
        rate = {by_before.v + rate.v, by_before.omega};
      }
      detail::set_column(result.rate, rate, k);
      add(after, k);
    }
  }
  return result;
}

/// J̇ of `jacobian_with_rate`, the time derivative of the Jacobian.
///
/// \return a matrix of 6 rows and a column for each joint
template <SerialChain C, VectorLike X, VectorLike V, FrameConstant Frame,
          FrameOnChain<C> At = tip_of_chain>
[[nodiscard]] auto jacobian_rate(const C& chain, const X& theta, const V& theta_dot,
                                 Frame frame_of_result, const At& at = {}) {
  return jacobian_with_rate(chain, theta, theta_dot, frame_of_result, at).rate;
}

} // namespace duet
