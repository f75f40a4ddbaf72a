// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// A gradient of three numbers.

#include <duet/derivative/gradient.hpp>

Eigen::Vector3d slope(const Eigen::Vector3d& x) {
  using std::cos;
  return duet::gradient([](const auto& p) { return p[0] * p[0] * cos(p[1]) + p[2]; }, x).gradient;
}
