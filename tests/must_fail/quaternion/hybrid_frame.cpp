// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: an angular velocity is expressed in frame::spatial or frame::body

#include <duet/quaternion/rate.hpp>

int main() {
  const duet::quaternion<double> q(1), q_dot;
#ifdef DUET_MUST_FAIL
  const auto omega = angular_velocity(q, q_dot, duet::frame::hybrid);
#else
  const auto omega = angular_velocity(q, q_dot, duet::frame::body);
#endif
  return omega[0] == 0 ? 0 : 1;
}
