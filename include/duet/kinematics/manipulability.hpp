// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/batch.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/dual/eigen_traits.hpp>
#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/jacobian_rate.hpp>

#include <Eigen/Core>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>

/// \file
/// Yoshikawa's manipulability, a measure of the distance of a chain from a singularity.

namespace duet {

namespace detail {

/// One type for chains of up to 16 joints, as compilers take a second for each type that
/// Eigen factorises.
template <class S, int Joints>
using tall_matrix = Eigen::Matrix<S, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor,
                                  std::max({Joints, -Joints, 16}), 6>;

/// Jᵀ of a chain with at least six joints, J of one with fewer: never wider than high.
template <class C, class X, FrameOnChain<C> At = tip_of_chain>
[[nodiscard]] auto tall_jacobian(const C& chain, const X& theta, const At& at = {}) {
  using matrix = tall_matrix<chain_scalar<C, X>, C::joints>;
  const auto m = jacobian(chain, theta, frame::hybrid, at);
  return chain.size() >= 6 ? matrix(m.transpose()) : matrix(m);
}

template <class M>
struct volume_and_gradient {
  typename M::Scalar
      volume; ///< w = |det R| of M = QR, without squares of small numbers as in det(MᵀM)
  M gradient; ///< w (M⁺)ᵀ = ∂w/∂M, if `WithGradient`
};

/// w and its derivative by QR with column pivoting, one lane of a batch after the other. The last
/// pivot is the smallest. However small it is, the derivative is not: w (M⁺)ᵀ = Q |r₀ r₁ …|
/// (|r_last| R⁻ᵀ).
template <bool WithGradient, class M>
[[nodiscard]] volume_and_gradient<M> volume_of(const M& m) {
  using std::abs;
  using S = typename M::Scalar;
  volume_and_gradient<M> result{S(1), {}};
  if constexpr (Batched<S>) {
    result.volume = by_lane([](const auto& x) { return volume_of<false>(x).volume; }, m);
    if constexpr (WithGradient) {
      result.gradient = by_lane([](const auto& x) { return volume_of<true>(x).gradient; }, m);
    }
  } else if (m.cols() > 0) { // a determinant of no columns is 1
    const Eigen::ColPivHouseholderQR<M> qr(m);
    const auto& r = qr.matrixQR();
    const Eigen::Index n = m.cols();
    S others(1);
    for (Eigen::Index i = 0; i < n - 1; ++i) {
      others *= abs(r(i, i));
    }
    const S smallest = abs(r(n - 1, n - 1));
    result.volume = others * smallest;
    if constexpr (WithGradient) { // qr.solve would omit entries divided by a small pivot
      result.gradient = M::Zero(m.rows(), n);
      for (Eigen::Index j = 0; j < n; ++j) { // column j of |r_last| R⁻ᵀ, then Q times it
        auto column = result.gradient.col(qr.colsPermutation().indices()[j]);
        for (Eigen::Index i = j; i < n; ++i) {
          S sum = i == j ? smallest : S(0);
          for (Eigen::Index k = j; k < i; ++k) {
            sum -= r(k, i) * column[k];
          }
          column[i] = sum / r(i, i);
        }
        for (Eigen::Index k = n - 1; k >= 0; --k) { // reflections (1 − h v vᵀ), v = (1, r below)
          S along = column[k];
          for (Eigen::Index i = k + 1; i < m.rows(); ++i) {
            along += r(i, k) * column[i];
          }
          along *= qr.hCoeffs()[k];
          column[k] -= along;
          for (Eigen::Index i = k + 1; i < m.rows(); ++i) {
            column[i] -= along * r(i, k);
          }
        }
        column *= others;
      }
    }
  }
  return result;
}

} // namespace detail

/// Yoshikawa's manipulability w = √det(J Jᵀ), the product of the singular values of the Jacobian of
/// a frame on a chain; for fewer than six joints √det(JᵀJ) of the hybrid Jacobian. Zero at a
/// singularity, where J loses rank.
///
/// With six joints or more it does not depend on the frame of J, but on the unit of length.
/// Arguments as `jacobian`.
template <SerialChain C, VectorLike X, FrameOnChain<C> At = tip_of_chain>
[[nodiscard]] auto manipulability(const C& chain, const X& theta, const At& at = {}) {
  return detail::volume_of<false>(detail::tall_jacobian(chain, theta, at)).volume;
}

/// Manipulability w and its gradient ∇w, ∂w/∂θ_j = w tr(J⁺ ∂J/∂θ_j). Arguments as `jacobian`.
///
/// Within round-off of a singularity they are those of the rounded J, which may be on the other
/// side of it.
///
/// \return `value_and_gradient`
/// \throws invalid_input if J loses rank: w has a kink there
template <SerialChain C, VectorLike X, FrameOnChain<C> At = tip_of_chain>
[[nodiscard]] auto manipulability_gradient(const C& chain, const X& theta, const At& at = {}) {
  using S = detail::chain_scalar<C, X>;
  using vector = detail::joint_vector<S, C::joints>;
  const auto [w, by_entries] = detail::volume_of<true>(detail::tall_jacobian(chain, theta, at));
  if (detail::surely_any(innermost(w) == 0)) {
    detail::raise(invalid_input(
        "duet: manipulability_gradient: the Jacobian is singular at this configuration"));
  }
  value_and_gradient<S, vector> result{w, vector(chain.size())};
  const auto h = kinematic_hessian(chain, theta, frame::hybrid, at);
  for (Eigen::Index j = 0; j < chain.size(); ++j) {
    S trace(0);
    for (Eigen::Index i = 0; i < by_entries.rows(); ++i) {
      for (Eigen::Index k = 0; k < by_entries.cols(); ++k) {
        trace += by_entries(i, k) * (chain.size() >= 6 ? h(k, i, j) : h(i, k, j));
      }
    }
    result.gradient[j] = trace;
  }
  return result;
}

/// Singularity-avoidance objective −w log √det(J Jᵀ), which planners minimise with weight w to keep
/// away from singularities.
template <class C>
struct manipulability_objective {
  C chain;           ///< the arm
  double weight = 1; ///< weight w, default 1

  /// Value of the objective at the configuration θ.
  template <class X>
  [[nodiscard]] auto operator()(const X& theta) const {
    using std::log;
    return -weight * log(manipulability(chain, theta));
  }
  /// Gradient of the objective at the configuration θ.
  template <class X>
  [[nodiscard]] auto gradient(const X& theta) const {
    auto [w, result] = manipulability_gradient(chain, theta);
    result *= -weight / w;
    return result;
  }
};
template <class C, class... W>
manipulability_objective(C, W...) -> manipulability_objective<C>;

DUET_ASKS_FOR_ONE_CONFIGURATION(manipulability, double)
DUET_ASKS_FOR_ONE_CONFIGURATION(manipulability_gradient,
                                value_and_gradient<double, Eigen::VectorXd>)

} // namespace duet
