// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: only chains of read_urdf have names: with_l
// within: 2
// forms: 2

#include <duet/kinematics/adapted.hpp>
#include <duet/kinematics/robots.hpp>

int main() {
  const auto arm = duet::robots::panda();
#if DUET_MUST_FAIL == 1
  const auto six = with_locked_joint(arm, "elbow", -1.5);
#elif DUET_MUST_FAIL == 2
  const auto seven = with_limits(arm, "elbow", {-2, -1});
#else
  const auto six = with_locked_joint(with_limits(arm, 3, {-2, -1}), 3, -1.5);
#endif
}
