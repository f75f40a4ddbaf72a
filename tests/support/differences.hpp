// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "support/multiprecision.hpp"

#include <duet/dual/eigen_traits.hpp>
#include <duet/dual/taylor.hpp>

#include <algorithm>
#include <cmath>

/// \file
/// Derivatives of functions with matrices as results, against differences in 100 digits.

namespace duet_test {

/// How far f(t), f′(t), f″(t), f‴(t) at t = 0, a matrix of `taylor<double, 3>`, are from central
/// differences of f over 100 digits: the largest error of an entry, relative where it exceeds 1.
template <class F>
[[nodiscard]] double error_to_third_order(const F& f) {
  const auto series = f(duet::taylor<double, 3>::variable(0.0));
  double worst = 0;
  for (int k = 0; k <= 3; ++k) {
    const real_100 h = pow(real_100(10), -90 / (k + 2));
    auto sum = f(real_100(h * (real_100(k) / 2)));
    real_100 binomial = 1;
    for (int i = 1; i <= k; ++i) {
      binomial = binomial * (k - i + 1) / i;
      sum += (i % 2 == 0 ? binomial : real_100(-binomial)) * f(real_100(h * (real_100(k) / 2 - i)));
    }
    for (Eigen::Index j = 0; j < sum.cols(); ++j) {
      for (Eigen::Index i = 0; i < sum.rows(); ++i) {
        const double exact = double(real_100(sum(i, j) / pow(h, k)));
        const double error =
            std::abs(series(i, j).derivative(k) - exact) / std::max(1.0, std::abs(exact));
        worst = error <= worst ? worst : error; // NaN counts
      }
    }
  }
  return worst;
}

} // namespace duet_test
