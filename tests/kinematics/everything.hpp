// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/duet.hpp>

/// \file
/// Sum of all functions of a chain, as one number.

namespace duet_test {

template <class Chain, class X>
[[nodiscard]] double everything(const Chain& chain, const X& theta) {
  using namespace duet;
  double sum = chain.pose(theta).w().value() + chain.pose(theta, 3).x().value();
  sum += jacobian(chain, theta, frame::spatial).sum();
  sum += jacobian(chain, theta, frame::body, chain.link(4)).sum();
  sum += jacobian_rate(chain, theta, theta, frame::hybrid).sum();
  sum += kinematic_hessian(chain, theta, frame::body)[2].sum();
  sum += pose_coordinates_jacobian(chain, theta).sum();
  sum += euler_jacobian<zyx>(chain, theta).sum();
  sum += joint_efforts(chain, theta, vector6<double>(vector6<double>::Ones()), frame::body).sum();
  return sum;
}

} // namespace duet_test
