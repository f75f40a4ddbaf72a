// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: a chain has three Jacobians, say which

#include <duet/mechanism/jacobian.hpp>
#include <duet/mechanism/robots.hpp>

void use() {
  const Eigen::Matrix<double, 6, 1> theta = Eigen::Matrix<double, 6, 1>::Zero();
#ifdef DUET_MUST_FAIL
  duet::jacobian(duet::robots::ur5e(), theta);
#else
  static_cast<void>(duet::jacobian(duet::robots::ur5e(), theta, duet::frame::hybrid));
#endif
}
