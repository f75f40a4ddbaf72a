// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/random_source.hpp>
#include <duet/derivative/derivative.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/kinematic_tree.hpp>
#include <duet/kinematics/tree_table.hpp>
#include <duet/robotics/closed_tree.hpp>

#include <Eigen/Core>
#include <Eigen/QR>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

/// \file
/// Closure of the loops of a mechanism by damped least squares, and second derivatives of its
/// equations.

namespace duet::detail {
DUET_ABI_BEGIN

/// Singular value decomposition U S Vᵀ of a matrix with its numerical rank: the dependent rows and
/// columns.
struct rank_revealing_svd {
  /// Relative tolerance of the rank: singular values below this fraction of the largest one count
  /// as zero. Near a singular configuration they are as far from zero as q is from it, and q is
  /// known to half the digits where equations are singular.
  static constexpr double rank_tolerance = 1e-6;

  Eigen::MatrixXd u, v;
  Eigen::VectorXd s; ///< singular values
  Eigen::Index rank = 0;

  explicit rank_revealing_svd(const Eigen::MatrixXd& a)
      : u(Eigen::MatrixXd::Identity(a.rows(), a.rows())),
        v(Eigen::MatrixXd::Identity(a.cols(), a.cols())) {
    if (a.size() > 0) { // Eigen has no singular values of empty matrices
      const Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::FullPivHouseholderQRPreconditioner> svd(
          a, Eigen::ComputeFullU | Eigen::ComputeFullV);
      u = svd.matrixU();
      v = svd.matrixV();
      s = svd.singularValues();
    }
    while (rank < s.size() && s[rank] > rank_tolerance * s[0]) {
      ++rank;
    }
  }

  /// Orthonormal basis of the image (column space), as columns.
  [[nodiscard]] Eigen::MatrixXd image() const { return u.leftCols(rank); }
  /// Orthonormal basis of the orthogonal complement of the image, as columns.
  [[nodiscard]] Eigen::MatrixXd cokernel() const { return u.rightCols(u.cols() - rank); }
  /// Orthonormal basis of the kernel (null space), as columns.
  [[nodiscard]] Eigen::MatrixXd kernel() const { return v.rightCols(v.cols() - rank); }
  /// Minimum-norm least-squares solution of A x = b, where A is taken to have the given rank.
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b, Eigen::Index r) const {
    const Eigen::VectorXd y = u.leftCols(r).transpose() * b;
    return v.leftCols(r) * y.cwiseQuotient(s.head(r));
  }
  /// Damped least-squares solution V (σ / (σ² + λ)) Uᵀ b.
  [[nodiscard]] Eigen::VectorXd damped_solve(const Eigen::VectorXd& b, double lambda) const {
    const Eigen::ArrayXd y = u.leftCols(s.size()).transpose() * b;
    return v.leftCols(s.size()) * (s.array() * y / (s.array().square() + lambda)).matrix();
  }
};

struct periodic_coordinates {
  std::vector<bool> angles; ///< for each coordinate, true if a full turn of it changes no pose
  std::vector<int> vectors; ///< numbers of the first coordinates of rotation vectors

  explicit periodic_coordinates(const closed_chain_mechanism& of)
      : angles(std::size_t(of.size()), false) {
    int i = 0;
    for (const tree_joint& each : of.tree().joints()) {
      if (each.mimic) {
        continue;
      }
      const joint_kind kind = each.motion.kind;
      if (kind == joint_kind::revolute || kind == joint_kind::continuous) {
        angles[std::size_t(i)] = true;
      } else if (kind == joint_kind::planar) {
        angles[std::size_t(i) + 2] = true;
      } else if (kind == joint_kind::spherical || kind == joint_kind::floating) {
        vectors.push_back(kind == joint_kind::floating ? i + 3 : i);
      }
      i += each.motion.coordinates();
    }
    for (const tree_node& node : of.tree().table().nodes) {
      const coordinate_source& source = of.tree().table().sources[std::size_t(node.coordinate)];
      if (!node.is_ball &&
          (node.step.is_translational || source.multiplier != std::round(source.multiplier))) {
        angles[std::size_t(source.own)] = false; // links that mimic the coordinate would move
      }
    }
  }
};

/// The numbers from 0 to n − 1 except for these.
[[nodiscard]] inline std::vector<int> all_but(int n, const std::vector<int>& these) {
  std::vector<int> result;
  for (const int i : these) {
    require(0 <= i && i < n, "duet: closed_chain_mechanism: coordinate ", i,
            " does not exist, the mechanism has ", n);
  }
  for (int i = 0; i < n; ++i) {
    if (std::find(these.begin(), these.end(), i) == these.end()) {
      result.push_back(i);
    }
  }
  return result;
}

/// Constraint Jacobian ∂F/∂q, each column per unit of its coordinate.
[[nodiscard]] inline Eigen::MatrixXd unit_jacobian(const closed_chain_mechanism& of,
                                                   const Eigen::VectorXd& q) {
  return of.constraint_jacobian(q) * of.units().asDiagonal();
}

[[nodiscard]] inline rank_revealing_svd linearised(const closed_chain_mechanism& of,
                                                   const Eigen::VectorXd& q) {
  return rank_revealing_svd(unit_jacobian(of, q));
}

/// The columns of a matrix at these indices.
[[nodiscard]] inline Eigen::MatrixXd columns(const Eigen::MatrixXd& of,
                                             const std::vector<int>& these) {
  return of(Eigen::seqN(0, of.rows()), these);
}

/// Damped least squares (Levenberg–Marquardt method) for F(q) = 0.
class loop_closure_solver {
public:
  /// \param free  numbers of the coordinates that may move
  loop_closure_solver(const closed_chain_mechanism& of, const Eigen::VectorXd& guess,
                      const std::vector<int>& free, int max_steps = 200)
      : of_(of), free_(free), q_(guess), f_(of.residuals(guess)), norm_(f_.norm()) {
    for (int i = 0; i < max_steps && norm_ > 0 && step(); ++i) {
    }
  }

  [[nodiscard]] bool has_closed() const {
    return norm_ <= 1e-12 * std::max(1.0, q_.cwiseQuotient(of_.units()).norm());
  }
  [[nodiscard]] double residual() const { return norm_; }
  [[nodiscard]] const Eigen::VectorXd& coordinates() const { return q_; }

private:
  /// Makes a step that reduces the residual; false if no step reduces it.
  [[nodiscard]] bool step() {
    const Eigen::MatrixXd j = columns(unit_jacobian(of_, q_), free_);
    const rank_revealing_svd svd(j);
    for (int i = 0; i < 25; ++i) {
      Eigen::VectorXd dx = -svd.damped_solve(f_, damping_ * norm_);
      const double length = dx.norm();
      if (!(length > 1e-16)) {
        return false;
      }
      dx *= std::min(1.0, max_norm / length);
      Eigen::VectorXd next = q_;
      next(free_) += dx.cwiseProduct(of_.units()(free_));
      const Eigen::VectorXd f = of_.residuals(next);
      const double norm = f.norm();
      if (norm < norm_) {
        const double foreseen = norm_ * norm_ - (f_ + j * dx).squaredNorm();
        const double gain = (norm_ * norm_ - norm * norm) / foreseen;
        damping_ = std::max(1e-8, damping_ * (gain > .75 ? .1 : gain < .25 ? 4 : 1));
        const bool goes_on = norm < (1 - 1e-5) * norm_;
        q_ = next;
        f_ = f;
        norm_ = norm;
        return goes_on;
      }
      if (norm_ < 1e-14) {
        return false; // round-off
      }
      damping_ *= 10;
    }
    return false;
  }

  static constexpr double max_norm = 1; ///< maximum norm of a step
  const closed_chain_mechanism& of_;
  std::vector<int> free_;
  Eigen::VectorXd q_, f_;
  double norm_;
  double damping_ = 1e-2;
};

/// The quadratic forms wᵀ ∂²F(K v, K v) in v, a symmetric matrix for each column w, from the
/// derivatives of ∂F/∂q along the columns of K.
///
/// \param columns  K, each row per unit of its coordinate
[[nodiscard]] inline std::vector<Eigen::MatrixXd> quadratic_forms(const closed_chain_mechanism& of,
                                                                  const Eigen::VectorXd& q,
                                                                  const Eigen::MatrixXd& w,
                                                                  const Eigen::MatrixXd& columns) {
  const Eigen::MatrixXd directions = of.units().asDiagonal() * columns;
  std::vector<Eigen::MatrixXd> result(std::size_t(w.cols()),
                                      Eigen::MatrixXd(columns.cols(), columns.cols()));
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    const auto along = [&]<class T>(const T& t) {
      return of.constraint_jacobian((q.cast<T>() + t * directions.col(j).cast<T>()).eval());
    };
    const Eigen::MatrixXd rates = w.transpose() * derivative(along, 0.).derivative * directions;
    for (std::size_t k = 0; k < result.size(); ++k) {
      result[k].col(j) = rates.row(Eigen::Index(k)).transpose();
    }
  }
  return result;
}

/// A uniformly distributed unit vector.
[[nodiscard]] inline Eigen::VectorXd random_direction(random_source& random, Eigen::Index n) {
  Eigen::VectorXd result(n);
  do {
    for (double& x : result) {
      x = random.normal();
    }
  } while (result.norm() < 1e-3);
  return result.normalized();
}

/// A unit vector v for which all forms vanish, by Newton's method from an initial guess; empty if
/// it does not converge.
[[nodiscard]] inline std::optional<Eigen::VectorXd>
common_zero(const std::vector<Eigen::MatrixXd>& forms, Eigen::VectorXd v, double rounding) {
  const auto count = Eigen::Index(forms.size());
  Eigen::VectorXd f(count + 1);
  Eigen::MatrixXd j(count + 1, v.size());
  for (int i = 0; i < 40; ++i) {
    for (Eigen::Index k = 0; k < count; ++k) {
      j.row(k) = 2 * (forms[std::size_t(k)] * v).transpose();
    }
    j.row(count) = v.transpose();
    f << j.topRows(count) * v / 2, (v.squaredNorm() - 1) / 2;
    if (f.norm() < rounding) {
      return v;
    }
    const rank_revealing_svd svd(j);
    v -= svd.solve(f, svd.rank);
  }
  return std::nullopt;
}

DUET_ABI_END
} // namespace duet::detail
