// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "accuracy/pose_functions.hpp"
#include "accuracy/probe.hpp"
#include "accuracy/rotation_functions.hpp"

// Second derivatives along two directions at once, the mixed ones among them.

namespace duet_test::accuracy {

rows mixed_rows(extent e) {
  rows result;
  auto functions = rotation_functions<plane>();
  for (const auto& f : pose_functions<plane>()) {
    functions.push_back(f);
  }
  for (const auto& f : functions) {
    result.push_back(probe_planes(f, e == extent::test ? 4 : 32));
    result.back().name += ", mixed";
  }
  const auto sequences = euler_functions<plane>();
  for (const auto& [name, six] : {std::pair{"euler, Tait–Bryan, mixed", sequences[0]},
                                  {"euler, proper, mixed", sequences[1]}}) {
    rows each;
    for (const auto& f : six) {
      each.push_back(probe_planes(f, e == extent::test ? 1 : 32));
    }
    result.push_back(worst_of(name, each));
  }
  return result;
}

} // namespace duet_test::accuracy
