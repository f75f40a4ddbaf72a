// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "branches/self_motion_set.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>

namespace duet::detail {
DUET_ABI_BEGIN

seven_coordinates self_motion_set::difference(const seven_coordinates& b,
                                              const seven_coordinates& a) const {
  seven_coordinates d = b - a;
  for (int i = 0; i < 7; ++i) {
    d[i] = arm_.is_revolute[std::size_t(i)] ? wrap_angle(d[i]) : d[i] / arm_.size;
  }
  return d;
}

seven_coordinates self_motion_set::moved(seven_coordinates x, const seven_coordinates& d) const {
  for (int i = 0; i < 7; ++i) {
    x[i] += arm_.is_revolute[std::size_t(i)] ? d[i] : arm_.size * d[i];
  }
  return x;
}

double self_motion_set::error(const seven_coordinates& x) const {
  seven_columns j;
  return arm_.tip_error(x, j).norm();
}

std::optional<seven_coordinates> self_motion_set::projected(const seven_coordinates& from,
                                                            double max_distance) const {
  constexpr int iterations = 60;
  constexpr double rounding = 1e-15;
  constexpr double enough = 2e-15; // near a double point half of the digits are lost
  seven_coordinates x = from, best = from;
  double min_error = std::numeric_limits<double>::infinity();
  int since = 0; // steps since the error last fell
  for (int k = 0; k < iterations && since < (min_error < self_motion_tolerance::on_set ? 2 : 8);
       ++k) {
    seven_columns j;
    const six_coordinates e = arm_.tip_error(x, j);
    const double size = e.norm();
    ++since;
    if (size < .9 * min_error) {
      since = 0;
    }
    if (size < min_error) {
      min_error = size;
      best = x;
    }
    if (size < enough) {
      break;
    }
    Eigen::Matrix<double, 6, 6> gram = j * j.transpose();
    gram.diagonal().array() += std::min(.02 * size * size, .08) + rounding;
    x = moved(x, j.transpose() * gram.llt().solve(e));
    if (!(difference(x, from).norm() < max_distance)) {
      return {};
    }
  }
  return min_error < self_motion_tolerance::on_set ? std::optional(best) : std::nullopt;
}

self_motion_set::null_space self_motion_set::kernel(const seven_coordinates& x) const {
  seven_columns j;
  static_cast<void>(arm_.tip_error(x, j));
  // The product of the singular values gives a bound on the smallest: the mean square of the
  // others is not below their geometric mean. If it is far from 0 normal equations suffice.
  constexpr double regular = 1e-3;
  const Eigen::LLT<Eigen::Matrix<double, 6, 6>> gram(j * j.transpose());
  const double product = gram.matrixLLT().diagonal().prod(), squares = j.squaredNorm();
  if (gram.info() == Eigen::Success &&
      product > regular * std::sqrt(squares) * std::pow(squares / 5, 2.5)) {
    const square projector = square::Identity() - j.transpose() * gram.solve(j);
    Eigen::Index largest = 0;
    projector.diagonal().maxCoeff(&largest);
    const seven_coordinates column = projector.col(largest);
    return (column - j.transpose() * gram.solve(j * column)).normalized();
  }
  square rows = square::Zero();
  rows.topRows<6>() = j;
  const decomposition svd(rows, Eigen::ComputeFullV);
  const auto& sizes = svd.singularValues();
  Eigen::Index rank = 0;
  while (rank < 6 && sizes[rank] > self_motion_tolerance::singular * sizes[0]) {
    ++rank;
  }
  return svd.matrixV().rightCols(7 - rank);
}

seven_coordinates self_motion_set::any_direction(const null_space& kernel, splitmix64& random) {
  seven_coordinates result;
  do {
    result.setZero();
    for (Eigen::Index k = 0; k < kernel.cols(); ++k) {
      result += (2 * random() - 1) * kernel.col(k);
    }
  } while (!(result.norm() > .1));
  return result.normalized();
}

int self_motion_set::dimension(const seven_coordinates& x, double step, splitmix64& random) const {
  const null_space basis = kernel(x);
  if (basis.cols() == 1) {
    return 1;
  }
  constexpr double min_fraction = .01; // fraction of the mean square; curvature contributes step²
  square spread = square::Zero();
  const int count = 4 * int(basis.cols());
  for (int k = 0; k < count; ++k) {
    const auto point = neighbour(x, step, basis, random);
    if (point) {
      const seven_coordinates d = difference(*point, x) / step;
      spread += d * d.transpose() / count;
    }
  }
  const auto sizes = decomposition(spread).singularValues();
  return int((sizes.array() > min_fraction).count());
}

std::optional<seven_coordinates> self_motion_set::neighbour(const seven_coordinates& x, double step,
                                                            const null_space& basis,
                                                            splitmix64& random) const {
  return projected(moved(x, step * any_direction(basis, random)), 3 * step);
}

std::optional<seven_coordinates> self_motion_set::any_point(splitmix64& random) const {
  seven_coordinates x;
  for (int i = 0; i < 7; ++i) {
    const double part = 2 * random() - 1;
    x[i] = part * (arm_.is_revolute[std::size_t(i)] ? std::numbers::pi : arm_.size);
  }
  return projected(x, std::numeric_limits<double>::infinity());
}

DUET_ABI_END
} // namespace duet::detail
