// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// expect: the objective is not a function of the joint coordinates that returns a number

#include <duet/kinematics/robots.hpp>
#include <duet/robotics/inverse_kinematics.hpp>

using namespace duet;

struct gradient_alone {
  template <class X>
  X gradient(const X& theta) const {
    return theta;
  }
};

struct with_value : gradient_alone {
  template <class X>
  auto operator()(const X& theta) const {
    return theta[0] * theta[0];
  }
};

inverse_kinematics_result solve(const dual_quaternion<double>& goal) {
#ifdef DUET_MUST_FAIL
  const gradient_alone objective;
#else
  const with_value objective;
#endif
  const Eigen::Matrix<double, 7, 1> start = Eigen::Matrix<double, 7, 1>::Zero();
  return inverse_kinematics(robots::panda(), goal, start, {}, objective);
}
