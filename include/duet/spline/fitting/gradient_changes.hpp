// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <utility>
#include <vector>

/// \file
/// Limited-memory BFGS corrections from the last steps of a descent.

namespace duet::detail {

/// Corrects Gauss–Newton steps by limited-memory BFGS (two-loop recursion). The Gauss–Newton matrix
/// lacks the second derivatives of the residuals and would need hundreds of steps if residuals are
/// large.
template <Real R>
class gradient_changes {
  using vector = Eigen::Matrix<R, Eigen::Dynamic, 1>;

public:
  [[nodiscard]] bool empty() const { return changes_.empty(); }
  void clear() { changes_.clear(); }

  /// Records the step to the next point, and the gradient before the step.
  void step(vector taken, const vector& gradient) {
    step_ = std::move(taken);
    gradient_ = gradient;
  }
  /// Records the gradient after the step. The change counts if the cost is convex along the step.
  void arrive(const vector& gradient) {
    if (step_.size() != gradient.size()) {
      return;
    }
    change c{step_, gradient - gradient_, R(0)};
    c.product = c.step.dot(c.gradient);
    if (c.product > 0) {
      if (changes_.size() == 8) {
        changes_.erase(changes_.begin());
      }
      changes_.push_back(std::move(c));
    }
  }

  /// Replaces x by H⁻¹ x, where H is the factorised matrix with the corrections.
  template <class Factors>
  void solve(const Factors& factors, vector& x) const {
    std::vector<R> along(changes_.size());
    for (std::size_t k = changes_.size(); k-- > 0;) {
      along[k] = changes_[k].step.dot(x) / changes_[k].product;
      x -= along[k] * changes_[k].gradient;
    }
    factors.solve(x);
    for (std::size_t k = 0; k < changes_.size(); ++k) {
      x += (along[k] - changes_[k].gradient.dot(x) / changes_[k].product) * changes_[k].step;
    }
  }

private:
  struct change {
    vector step, gradient;
    R product;
  };

  vector step_, gradient_;
  std::vector<change> changes_;
};

} // namespace duet::detail
