// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: to differentiate by rotations, poses or tuples say the frame

#include <duet/derivative/tangent_coordinates.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/rotation.hpp>

int main() {
  const auto f = [](const auto& q) { return duet::rotation_vector(q); };
  const duet::quaternion<double> q(1, 0, 0, 0);
#ifdef DUET_MUST_FAIL
  duet::jacobian(f, q);
#else
  static_cast<void>(duet::jacobian(f, q, duet::frame::body));
#endif
}
