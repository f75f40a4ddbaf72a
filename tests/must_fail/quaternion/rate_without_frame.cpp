// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: in which axes

#include <duet/quaternion/rate.hpp>

int main() {
  const duet::quaternion<double> q(1), q_dot;
#ifdef DUET_MUST_FAIL
  angular_velocity(q, q_dot);
#else
  static_cast<void>(angular_velocity(q, q_dot, duet::frame::body));
#endif
}
