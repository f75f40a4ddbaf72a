// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// A position that three equations define, and its rate.

#include <duet/derivative/implicit_function.hpp>

#include <Eigen/Core>

#include <type_traits>

Eigen::Vector3d rate(double parameter) {
  const auto equations = [](const auto& x, const auto& p) {
    return Eigen::Vector3<std::decay_t<decltype(x[0] * p)>>(x[0] * x[0] + x[1] - p, x[1] * x[2] - p,
                                                            x[0] + x[2] - 1.);
  };
  return duet::implicit_function<1>(equations, Eigen::Vector3d(1, 1, 1), parameter)[1];
}
