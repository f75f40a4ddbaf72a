// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/mechanism/jacobian.hpp>
#include <duet/mechanism/jacobian_rate.hpp>

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <type_traits>

/// \file
/// How far a chain is from a singularity, after Yoshikawa.

namespace duet {

namespace detail {

/// Jᵀ of a chain with at least six joints, or J of one with fewer: never wider than it is high.
template <class C, class X, class... At>
[[nodiscard]] auto tall_jacobian(const C& chain, const X& theta, const At&... at) {
  using S = chain_scalar<C, X>;
  constexpr int n = C::joints;
  if constexpr (n >= 6) {
    return Eigen::Matrix<S, n, 6>(jacobian(chain, theta, frame::hybrid, at...).transpose());
  } else if constexpr (n > 0) {
    return jacobian(chain, theta, frame::hybrid, at...);
  } else {
    using matrix = Eigen::Matrix<S, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor,
                                 std::max(-n, 6), std::max(-n, 6)>;
    const auto m = jacobian(chain, theta, frame::hybrid, at...);
    return chain.size() >= 6 ? matrix(m.transpose()) : matrix(m);
  }
}

/// |det R| of M = QR, without the squares of what is small in det(MᵀM).
template <class QR>
[[nodiscard]] auto volume(const QR& qr) {
  using std::abs;
  using S = typename QR::MatrixType::Scalar;
  S product(1);
  for (Eigen::Index i = 0; i < qr.cols(); ++i) {
    product *= qr.matrixQR()(i, i);
  }
  return S(abs(product));
}

} // namespace detail

/// w = √det(J Jᵀ), the product of the singular values of the Jacobian of a frame on a chain; for
/// fewer than six joints √det(JᵀJ) of the hybrid one. Zero where J loses rank.
///
/// With six joints or more it does not depend on the frame of J, but on the unit of length.
/// Arguments as `jacobian`.
template <SerialChain C, VectorLike X, class... At>
[[nodiscard]] auto manipulability(const C& chain, const X& theta, const At&... at) {
  const auto m = detail::tall_jacobian(chain, theta, at...);
  return detail::volume(Eigen::ColPivHouseholderQR<std::remove_cv_t<decltype(m)>>(m));
}

/// w and ∇w, ∂w/∂θ_j = w tr(J⁺ ∂J/∂θ_j). Arguments as `jacobian`.
/// \throws invalid_input where J loses rank: w has a kink there
template <SerialChain C, VectorLike X, class... At>
[[nodiscard]] auto manipulability_gradient(const C& chain, const X& theta, const At&... at) {
  using S = detail::chain_scalar<C, X>;
  using vector = detail::joint_vector<S, C::joints>;
  const auto m = detail::tall_jacobian(chain, theta, at...);
  using matrix = std::remove_cv_t<decltype(m)>;
  const Eigen::ColPivHouseholderQR<matrix> qr(m);
  value_and_gradient<S, vector> result{detail::volume(qr), vector(chain.size())};
  if (innermost(result.value) == 0) {
    throw invalid_input("duet: manipulability_gradient: the Jacobian loses rank here");
  }
  using square =
      Eigen::Matrix<S, matrix::RowsAtCompileTime, matrix::RowsAtCompileTime, Eigen::ColMajor,
                    matrix::MaxRowsAtCompileTime, matrix::MaxRowsAtCompileTime>;
  const auto inverse = qr.solve(square::Identity(m.rows(), m.rows())).eval(); // M⁺
  const auto h = kinematic_hessian(chain, theta, frame::hybrid, at...);
  for (Eigen::Index j = 0; j < chain.size(); ++j) {
    const auto by_j = h[j];
    S trace(0);
    for (Eigen::Index i = 0; i < inverse.rows(); ++i) {
      for (Eigen::Index k = 0; k < inverse.cols(); ++k) {
        trace += inverse(i, k) * (chain.size() >= 6 ? by_j(i, k) : by_j(k, i));
      }
    }
    result.gradient[j] = result.value * trace;
  }
  return result;
}

} // namespace duet
