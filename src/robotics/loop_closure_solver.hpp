// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/random_source.hpp>
#include <duet/dual/taylor.hpp>
#include <duet/robotics/closed_tree.hpp>

#include <Eigen/Core>

#include <optional>
#include <vector>

/// \file
/// Closure of the loops of a mechanism by damped least squares, and second derivatives of its
/// equations. For those who extend duet.

namespace duet::detail {
DUET_ABI_BEGIN

/// Singular value decomposition of a matrix with its numerical rank: the dependent
/// rows and columns.
class rank_revealing_svd {
public:
  explicit rank_revealing_svd(const Eigen::MatrixXd& a);

  /// Relative tolerance of the rank: singular values below this fraction of the largest one count
  /// as zero. Near a singular configuration they are as far from zero as q is from it, and q is
  /// known to half the digits where equations are singular.
  static constexpr double rank_tolerance = 1e-6;

  [[nodiscard]] Eigen::Index rank() const { return rank_; }
  [[nodiscard]] const Eigen::VectorXd& singular_values() const { return s_; }
  /// U and V of the decomposition U S Vᵀ.
  [[nodiscard]] const Eigen::MatrixXd& left() const { return u_; }
  [[nodiscard]] const Eigen::MatrixXd& right() const { return v_; }
  /// Orthonormal basis of the image (column space), as columns.
  [[nodiscard]] Eigen::MatrixXd image() const { return u_.leftCols(rank_); }
  /// Orthonormal basis of the orthogonal complement of the image, as columns.
  [[nodiscard]] Eigen::MatrixXd cokernel() const { return u_.rightCols(u_.cols() - rank_); }
  /// Orthonormal basis of the kernel (null space), as columns.
  [[nodiscard]] Eigen::MatrixXd kernel() const { return v_.rightCols(v_.cols() - rank_); }
  /// Minimum-norm least-squares solution of A x = b, where A is taken to have a given rank.
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b, Eigen::Index rank) const;
  /// Damped least-squares solution V (σ / (σ² + λ)) Uᵀ b.
  [[nodiscard]] Eigen::VectorXd damped_solve(const Eigen::VectorXd& b, double lambda) const;

private:
  Eigen::MatrixXd u_, v_;
  Eigen::VectorXd s_;
  Eigen::Index rank_ = 0;
};

struct periodic_coordinates {
  std::vector<bool> angles; ///< for each coordinate, true if a full turn of it changes no pose
  std::vector<int> vectors; ///< numbers of the first coordinates of rotation vectors

  explicit periodic_coordinates(const closed_chain_mechanism& of);
};

/// The numbers from 0 to n − 1 except for these.
[[nodiscard]] std::vector<int> all_but(int n, const std::vector<int>& these);

/// Constraint Jacobian ∂F/∂q, each column per unit of its coordinate.
[[nodiscard]] Eigen::MatrixXd unit_jacobian(const closed_chain_mechanism& of,
                                            const Eigen::VectorXd& q);
[[nodiscard]] rank_revealing_svd linearised(const closed_chain_mechanism& of,
                                            const Eigen::VectorXd& q);

/// The columns of a matrix at these indices.
[[nodiscard]] Eigen::MatrixXd columns(const Eigen::MatrixXd& of, const std::vector<int>& these);

/// Damped least squares (Levenberg–Marquardt method) for F(q) = 0.
class loop_closure_solver {
public:
  /// \param free  numbers of the coordinates that may move
  loop_closure_solver(const closed_chain_mechanism& of, const Eigen::VectorXd& guess,
                      const std::vector<int>& free, int max_steps = 200);

  [[nodiscard]] bool has_closed() const;
  [[nodiscard]] double residual() const { return norm_; }
  [[nodiscard]] const Eigen::VectorXd& coordinates() const { return q_; }

private:
  /// Makes a step that reduces the residual; false if no step reduces it.
  [[nodiscard]] bool step();

  static constexpr double max_norm = 1; ///< maximum norm of a step
  const closed_chain_mechanism& of_;
  std::vector<int> free_;
  Eigen::VectorXd q_, f_;
  double norm_;
  double damping_ = 1e-2;
};

/// Scalar for second derivatives of the equations.
using along_line = taylor<double, 2, derivative_tag<closed_chain_mechanism>>;

/// The quadratic forms wᵀ ∂²F(K v, K v) in v, a symmetric matrix for each column w, from F along
/// the lines of single columns of K and of sums of two: 2 b(u, v) = b(u + v, u + v) − b(u, u) −
/// b(v, v).
///
/// \param columns  K, each row per unit of its coordinate
[[nodiscard]] std::vector<Eigen::MatrixXd> quadratic_forms(const closed_chain_mechanism& of,
                                                           const Eigen::VectorXd& q,
                                                           const Eigen::MatrixXd& w,
                                                           const Eigen::MatrixXd& columns);

/// A uniformly distributed unit vector.
[[nodiscard]] Eigen::VectorXd random_direction(random_source& random, Eigen::Index n);

/// A unit vector v for which all forms vanish, by Newton's method from an initial guess; empty if
/// it does not converge.
[[nodiscard]] std::optional<Eigen::VectorXd> common_zero(const std::vector<Eigen::MatrixXd>& forms,
                                                         Eigen::VectorXd v, double rounding);

DUET_ABI_END
} // namespace duet::detail
