// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/dual_quaternion/twist.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <type_traits>

/// \file
/// Joint steps for small twists of the tip, by the Jacobian: of least norm within joint limits
/// (damped least squares), in its null space, out of singular configurations, and to the pose
/// nearest to a goal out of reach.

namespace duet::detail {
DUET_ABI_BEGIN

/// Singular value below which steps are damped.
inline constexpr double damping_threshold = 1e-3;
/// Singular value below which steps fail, except those that reorient joints rapidly at a
/// singularity.
inline constexpr double undamped_threshold = 1e-6;
/// Singular value below which round-off of J Jᵀ would determine the steps.
inline constexpr double undamped_threshold_near_singularity = 1e-7;

/// Coordinates of up to `Capacity` joints; those beyond the joints of a chain are 0, which is
/// faster than vectors of its size.
template <int Capacity>
using small_vector = Eigen::Matrix<double, Capacity, 1>;
/// Jacobian J with a column for each joint of a chain.
template <int Capacity>
using small_jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, Capacity>;
/// Twist [v; ω].
using small_twist = vector6<double>;
using gram_matrix = Eigen::Matrix<double, 6, 6>;

/// J Jᵀ.
template <class J>
[[nodiscard]] gram_matrix gram_of(const J& jacobian) {
  gram_matrix result = gram_matrix::Zero();
  for (Eigen::Index i = 0; i < jacobian.cols(); ++i) {
    result += jacobian.col(i) * jacobian.col(i).transpose();
  }
  return result;
}

/// Damping of J Jᵀ: by λ, and if the smallest singular value σ is below a threshold by (threshold −
/// σ)².
struct damping {
  double threshold = damping_threshold;
  double lambda = 0;
};

/// Cholesky factors L Lᵀ of J Jᵀ with the damping that a small singular value of J requires (damped
/// least squares); Eigen's take four times as long. An unknown whose pivot is not positive is left
/// out: it is 0 in solutions.
class damped_gram {
public:
  explicit damped_gram(const gram_matrix& gram, const damping& settings = {}) {
    factorise(gram, settings.lambda);
    if (settings.threshold == 0) {
      return;
    }
    // Smallest eigenvalue, from above: Rayleigh quotient after two inverse iterations.
    if (is_positive_) {
      const small_twist once = solve(small_twist::Ones()), twice = solve(once);
      smallest_ = std::sqrt(std::max(0.0, once.dot(twice) / twice.squaredNorm()));
    }
    if (smallest_ < settings.threshold) {
      const double shift = settings.threshold - smallest_;
      factorise(gram, shift * shift);
    }
  }

  /// Smallest singular value of J, from above; 0 if it was not computed.
  [[nodiscard]] double smallest() const { return smallest_; }
  [[nodiscard]] bool is_positive() const { return is_positive_; }
  [[nodiscard]] small_twist solve(small_twist x) const {
    for (int i = 0; i < 6; ++i) {
      for (int k = 0; k < i; ++k) {
        x[i] -= l_(i, k) * x[k];
      }
      x[i] *= l_(i, i);
    }
    for (int i = 6; i-- > 0;) {
      for (int k = i + 1; k < 6; ++k) {
        x[i] -= l_(k, i) * x[k];
      }
      x[i] *= l_(i, i);
    }
    return x;
  }

private:
  void factorise(const gram_matrix& gram, double lambda) {
    l_ = gram;
    l_.diagonal().array() += lambda;
    is_positive_ = true;
    for (int j = 0; j < 6; ++j) {
      for (int i = j; i < 6; ++i) {
        double rest = l_(i, j);
        for (int k = 0; k < j; ++k) {
          rest -= l_(i, k) * l_(j, k);
        }
        if (i > j) {
          l_(i, j) = rest * l_(j, j);
        } else {
          l_(i, i) = rest > 0 ? 1 / std::sqrt(rest) : 0;
          is_positive_ = is_positive_ && rest > 0;
        }
      }
    }
  }

  gram_matrix l_;
  bool is_positive_ = true;
  double smallest_ = 0;
};

template <int N>
struct bounded_step_result {
  small_vector<N> step;
  double smallest_singular_value; ///< that of the Jacobian of all joints, 0 without a threshold
  bool is_bounded;                ///< true if a limit was active
};

/// Least-norm Δ with J Δ = e and lower ≤ Δ ≤ upper, by damped least squares Jᵀ(J Jᵀ + λ)⁻¹ e.
/// Joints that would go beyond a bound are fixed at it, the worst one first, and the others
/// compensate for them as far as they can.
template <int N>
[[nodiscard]] bounded_step_result<N>
bounded_step(const small_jacobian<N>& jacobian, const small_twist& e,
             const std::type_identity_t<small_vector<N>>& lower,
             const std::type_identity_t<small_vector<N>>& upper, const damping& settings = {}) {
  const Eigen::Index n = jacobian.cols();
  std::array<bool, std::size_t(N)> is_fixed{};
  bounded_step_result<N> result{small_vector<N>::Zero(), 0, false};
  for (Eigen::Index round = 0; round <= n; ++round) {
    gram_matrix gram = gram_matrix::Zero();
    small_twist rest = e;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (is_fixed[std::size_t(i)]) {
        rest -= result.step[i] * jacobian.col(i);
      } else {
        gram += jacobian.col(i) * jacobian.col(i).transpose();
      }
    }
    const damped_gram factors(gram, settings);
    if (round == 0) {
      result.smallest_singular_value = factors.smallest();
    }
    const small_twist force = factors.solve(rest);
    Eigen::Index worst = -1;
    double max_violation = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (!is_fixed[std::size_t(i)]) {
        double& step = result.step[i];
        step = jacobian.col(i).dot(force);
        const double violation = std::max(step - upper[i], lower[i] - step);
        if (violation > max_violation) {
          max_violation = violation;
          worst = i;
        }
      }
    }
    if (worst < 0) {
      break;
    }
    is_fixed[std::size_t(worst)] = true;
    result.is_bounded = true;
    result.step[worst] = std::clamp(result.step[worst], lower[worst], upper[worst]);
  }
  return result;
}

/// Singular value that counts as zero.
inline constexpr double singularity_threshold = 1e-5;

/// Null space of the Jacobian: joint motion with the tip fixed. Keeps a reference to the Jacobian.
template <int Capacity>
class self_motion_space {
public:
  using vector = small_vector<Capacity>;

  /// \param none  singular values up to this count as zero
  explicit self_motion_space(const small_jacobian<Capacity>& jacobian,
                             double none = singularity_threshold)
      : jacobian_(jacobian), gram_(gram_of(jacobian), {0, none * none}) {}

  /// Projection of a step onto the null space, where the tip is fixed: λ (JᵀJ + λ)⁻¹ times the
  /// step, λ the square of the singular value that counts as zero.
  [[nodiscard]] vector projection_of(vector step) const {
    auto own = step.head(jacobian_.cols());
    own -= jacobian_.transpose() * gram_.solve(jacobian_ * own);
    return step;
  }
  /// Unit direction of the null space nearest to `desired`; zero if none is near it.
  [[nodiscard]] vector direction(vector desired) const {
    for (int round = 0; round < 2; ++round) { // the second time for round-off
      desired = projection_of(desired);
      const double length = desired.norm();
      if (!(length > .3)) {
        return vector::Zero();
      }
      desired /= length;
    }
    return desired;
  }
  /// Any unit direction of the null space; zero if it has dimension zero.
  [[nodiscard]] vector any_direction() const {
    vector best = vector::Zero();
    double largest = 0;
    for (Eigen::Index i = 0; i < jacobian_.cols(); ++i) {
      const vector d = direction(vector::Unit(i));
      if (std::abs(d[i]) > largest) { // d[i] is the component of the unit vector in d
        largest = std::abs(d[i]);
        best = d;
      }
    }
    return best;
  }

private:
  const small_jacobian<Capacity>& jacobian_;
  damped_gram gram_;
};

/// Sign of the determinant of J with a direction of self-motion below it for one degree of
/// redundancy, else 1. It is constant along a self-motion curve, and changes beyond a crossing of
/// curves, and on the curve beyond a near crossing.
template <int Capacity>
[[nodiscard]] double orientation(const small_jacobian<Capacity>& jacobian,
                                 const std::type_identity_t<small_vector<Capacity>>& direction) {
  if (jacobian.cols() != 7) {
    return 1;
  }
  Eigen::Matrix<double, 7, 7> m;
  m << jacobian, direction.template head<7>().transpose();
  return m.determinant() < 0 ? -1 : 1;
}

/// Left singular twist: left singular vector w of J for its smallest singular value; wᵀJ = 0 in a
/// singular configuration.
template <class J>
[[nodiscard]] small_twist left_singular_twist(const J& jacobian) {
  constexpr double none = 1e-6;
  const damped_gram gram(gram_of(jacobian), {0, none * none});
  small_twist w(1, .7, -.4, .9, -.6, .5);
  for (int k = 0; k < 3; ++k) {
    w = gram.solve(w).normalized();
  }
  return w;
}

/// Singular configuration to second order: w, `left_singular_twist`, and H, the second derivatives
/// of the tip's displacement along w,
///
/// H_jk = w · [ω_j × v_k; ½ ω_j × ω_k], j ≤ k, of the columns [v; ω] of J in `frame::hybrid`.
template <int Capacity>
class singular_point {
public:
  using vector = small_vector<Capacity>;

  explicit singular_point(const small_jacobian<Capacity>& jacobian)
      : jacobian_(jacobian), w_(left_singular_twist(jacobian)),
        h_(Eigen::Matrix<double, Capacity, Capacity>::Zero()) {
    for (Eigen::Index k = 0; k < jacobian.cols(); ++k) {
      const auto v = jacobian.col(k).template head<3>(), omega = jacobian.col(k).template tail<3>();
      for (Eigen::Index j = 0; j <= k; ++j) {
        const auto axis = jacobian.col(j).template tail<3>();
        h_(j, k) = h_(k, j) =
            w_.head<3>().dot(axis.cross(v)) + .5 * w_.tail<3>().dot(axis.cross(omega));
      }
    }
  }

  /// Escape direction, of unit length, in which the singularity is left fastest; its opposite is as
  /// good. Joint velocities n of the null space move the tip at θ + s d by s wᵀHd·n: d is the unit
  /// vector that maximises this over all n of length 1.
  [[nodiscard]] vector escape_direction() const {
    vector d = vector::LinSpaced(1, 1 + .1 * (Capacity - 1));
    d.tail(Capacity - jacobian_.cols()).setZero();
    const self_motion_space still(jacobian_);
    for (int k = 0; k < 8; ++k) {
      d = h_ * still.projection_of(h_ * d);
      const double length = d.norm();
      if (!(length > 1e-12)) {
        return vector::Zero();
      }
      d /= length;
    }
    return d;
  }

  /// Two steps s n, n the direction of least motion of the tip, that move it along w as a small
  /// twist does: wᵀJn s + ½ s² nᵀHn = w·e. Zero if there are none.
  [[nodiscard]] std::array<vector, 2> steps_for(const small_twist& e) const {
    const vector n = self_motion_space(jacobian_, damping_threshold).any_direction();
    const double linear = w_.dot(jacobian_ * n.head(jacobian_.cols())), quadratic = n.dot(h_ * n);
    const double root = std::sqrt(linear * linear + 2 * quadratic * w_.dot(e));
    std::array<vector, 2> result{vector::Zero(), vector::Zero()};
    for (std::size_t k = 0; k < 2; ++k) {
      const double s = ((k == 0 ? root : -root) - linear) / quadratic;
      if (std::abs(s) < 1) { // not NaN either
        result[k] = s * n;
      }
    }
    return result;
  }

private:
  const small_jacobian<Capacity>& jacobian_;
  small_twist w_;
  Eigen::Matrix<double, Capacity, Capacity> h_;
};

/// Smallest singular value of a Jacobian, from above.
template <class J>
[[nodiscard]] double smallest_singular_value_of(const J& jacobian) {
  return damped_gram(gram_of(jacobian)).smallest();
}

/// Squared error ½|e|², e = [displacement of the origin; 2 log r] from the tip to a goal.
template <int Capacity>
struct squared_error {
  small_vector<Capacity> gradient; ///< gradient
  /// Second derivatives (Hessian), the lower half.
  Eigen::Matrix<double, Capacity, Capacity> curvature;
};

/// Squared error to second order. With [v_k; ω_k] the columns of J in `frame::hybrid` and e = [w;
/// φ], the gradient is −Jᵀe, and the second derivatives are for j ≤ k
///
/// v_j·v_k − w·(ω_j × v_k) + ω_j·ω_k + c (φ × ω_j)·(ω_k × φ) − [j < k] ½ φ·(ω_j × ω_k),
///
/// as ∂v_k/∂θ_j = ω_j × v_k, ∂ω_k/∂θ_j = ω_j × ω_k, and −∂φ/∂θ_j = ω_j + ½ φ × ω_j +
/// c φ × (φ × ω_j), c = (1 − ½|φ| cot ½|φ|)/|φ|².
template <int Capacity>
[[nodiscard]] squared_error<Capacity> squared_error_of(const small_jacobian<Capacity>& jacobian,
                                                       const small_twist& e) {
  const Eigen::Vector3d w = e.head<3>(), phi = e.tail<3>();
  const double angle = phi.norm(), half = angle / 2;
  // The error of the constant moves the solution less than round-off of the gradient does.
  const double c = angle > 1e-3 ? (1 - half / std::tan(half)) / (angle * angle) : 1. / 12;
  squared_error<Capacity> result{small_vector<Capacity>::Zero(), {}};
  result.curvature.setZero();
  for (Eigen::Index k = 0; k < jacobian.cols(); ++k) {
    const auto v_k = jacobian.col(k).template head<3>(),
               omega_k = jacobian.col(k).template tail<3>();
    result.gradient[k] = -e.dot(jacobian.col(k));
    for (Eigen::Index j = 0; j <= k; ++j) {
      const auto omega_j = jacobian.col(j).template tail<3>();
      result.curvature(k, j) = jacobian.col(j).dot(jacobian.col(k)) - w.dot(omega_j.cross(v_k)) -
                               c * phi.cross(omega_j).dot(phi.cross(omega_k)) -
                               .5 * phi.dot(omega_j.cross(omega_k));
    }
  }
  return result;
}

/// Newton step to the minimum of ½|e|² in the first n coordinates, those that are fixed excepted;
/// nothing if the curvature and λ together are not positive definite.
template <int Capacity>
[[nodiscard]] std::optional<small_vector<Capacity>>
newton_step(const squared_error<Capacity>& error,
            const std::array<bool, std::size_t(Capacity)>& is_fixed, Eigen::Index n,
            double lambda) {
  Eigen::MatrixXd matrix = error.curvature.topLeftCorner(n, n);
  small_vector<Capacity> step = -error.gradient;
  matrix.diagonal().array() += lambda;
  for (Eigen::Index j = 0; j < n; ++j) {
    if (is_fixed[std::size_t(j)]) {
      matrix.row(j).setZero();
      matrix.col(j).setZero();
      matrix(j, j) = 1;
      step[j] = 0;
    }
  }
  const Eigen::LLT<Eigen::MatrixXd> factors(matrix);
  if (factors.info() != Eigen::Success) {
    return std::nullopt;
  }
  step.head(n) = factors.solve(step.head(n));
  return step;
}

DUET_ABI_END
} // namespace duet::detail
