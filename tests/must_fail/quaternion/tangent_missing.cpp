// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: this type has no tangent coordinates
// flags: -Wall -Wno-ignored-attributes

// Needs few headers only, so separate flags keep the precompiled header out.

#include <duet/derivative/derivative.hpp>
#include <duet/derivative/tangent_coordinates.hpp>
#include <duet/quaternion/quaternion.hpp>

#ifndef DUET_MUST_FAIL
#include <duet/quaternion/exponential.hpp>
#endif

int main() {
  using duet::quaternion;
  const auto curve = [](auto t) { return quaternion<decltype(t)>(t, t, t, t); };
  const auto [q, q_dot] = duet::derivative(curve, 1.0); // with this, quaternion.hpp alone will do
  static_cast<void>(duet::jacobian([](const auto& p) { return conj(p); }, q, duet::frame::body));
  return q_dot.w() == 1 ? 0 : 1;
}
