// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "accuracy/probe.hpp"
#include "accuracy/rotation_functions.hpp"

// Quaternions: exponential, logarithm, powers, interpolation, rotations in all their forms, Euler
// angles, Jacobians and angular velocities, with derivatives to the fourth order.

namespace duet_test::accuracy {

rows rotation_rows(extent e) {
  rows result;
  for (const auto& f : rotation_functions<line>()) {
    result.push_back(probe_lines(f, e == extent::test ? 4 : 32));
  }
  const auto sequences = euler_functions<line>();
  for (const auto& [name, six] :
       {std::pair{"euler, Tait–Bryan", sequences[0]}, {"euler, proper", sequences[1]}}) {
    rows each;
    for (const auto& f : six) {
      each.push_back(probe_lines(f, e == extent::test ? 1 : 32));
    }
    result.push_back(worst_of(name, each));
  }
  return result;
}

} // namespace duet_test::accuracy
