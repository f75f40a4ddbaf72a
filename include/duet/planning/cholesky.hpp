// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <Eigen/Core>

#include <cmath>

/// \file
/// Symmetric systems of a few equations in doubles. Eigen's factorisations take the compiler as
/// long as all the rest of a planner.

namespace duet::detail {

/// The factors L Lᵀ of a symmetric positive semidefinite matrix. An unknown whose pivot is not
/// above zero is left out: it is 0 in solutions.
template <class M>
class cholesky {
public:
  /// \param a  its lower half counts
  explicit cholesky(const M& a) : l_(a) {
    for (Eigen::Index j = 0; j < l_.cols(); ++j) {
      for (Eigen::Index i = j; i < l_.rows(); ++i) {
        double rest = l_(i, j);
        for (Eigen::Index k = 0; k < j; ++k) {
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

  [[nodiscard]] bool is_positive() const { return is_positive_; }

  /// Solves L Lᵀ x = b.
  template <class V>
  [[nodiscard]] V solve(V x) const {
    const Eigen::Index n = l_.rows();
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index k = 0; k < i; ++k) {
        x[i] -= l_(i, k) * x[k];
      }
      x[i] *= l_(i, i);
    }
    for (Eigen::Index i = n; i-- > 0;) {
      for (Eigen::Index k = i + 1; k < n; ++k) {
        x[i] -= l_(k, i) * x[k];
      }
      x[i] *= l_(i, i);
    }
    return x;
  }

private:
  M l_; ///< in the lower half, with 1 / Lᵢᵢ on the diagonal
  bool is_positive_ = true;
};

} // namespace duet::detail
