// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/twist.hpp>
#include <duet/planning/bounded_step.hpp>
#include <duet/planning/least_distance.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

/// \file
/// The step of the joints for a small twist of the tip under linear inequalities.

namespace duet::detail {

/// Takes from steps of the joints what moves the tip.
template <class V>
class self_motion {
public:
  template <class J>
  explicit self_motion(const J& jacobian) {
    for (Eigen::Index i = 0; i < 6; ++i) {
      const V row = jacobian.row(i).transpose();
      const V rest = (*this)(row);
      const double length = rest.norm();
      if (length > 1e-9 * row.norm()) {
        rows_[count_++] = rest / length;
      }
    }
  }

  [[nodiscard]] V operator()(V step) const {
    for (int twice = 0; twice < 2; ++twice) { // for the rounding of the first time
      for (std::size_t i = 0; i < count_; ++i) {
        step -= rows_[i].dot(step) * rows_[i];
      }
    }
    return step;
  }

private:
  std::array<V, 6> rows_; ///< of J, made orthonormal
  std::size_t count_ = 0;
};

template <class V>
struct constrained_step_result {
  std::optional<V> step;          ///< nothing where there is none
  double smallest_singular_value; ///< of the Jacobian, from above
};

/// The Δ nearest to `preferred` with lower ≤ Δ ≤ upper and the inequalities, and with J Δ = e, or
/// what damping near singularities leaves of that.
template <class J, class V>
[[nodiscard]] constrained_step_result<V>
constrained_step(const J& jacobian, const vector6<double>& e, const V& preferred, const V& lower,
                 const V& upper, const std::vector<inequality<V>>& inequalities) {
  const Eigen::Index n = jacobian.cols();
  const damped_gram gram(gram_matrix(jacobian));
  const vector6<double> force = gram.solve(e);
  const self_motion<V> without_tip(jacobian);
  V wanted = without_tip(preferred);
  for (Eigen::Index i = 0; i < n; ++i) {
    wanted[i] += jacobian.col(i).dot(force);
  }
  std::vector<inequality<V>> left;
  left.reserve(inequalities.size() + 2 * std::size_t(n));
  for (const inequality<V>& given : inequalities) {
    left.push_back({without_tip(given.normal), given.bound - given.normal.dot(wanted)});
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const V normal = without_tip(V::Unit(n, i));
    left.push_back({normal, lower[i] - wanted[i]});
    left.push_back({-normal, wanted[i] - upper[i]});
  }
  const std::optional<V> correction = least_distance(left, n);
  return {correction ? std::optional<V>(wanted + *correction) : std::nullopt, gram.smallest()};
}

} // namespace duet::detail
