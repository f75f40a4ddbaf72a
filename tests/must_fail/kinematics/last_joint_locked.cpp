// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: with_locked_joint: the only moving joint cannot be locked

#include <duet/kinematics/adapted.hpp>

#include <array>

#ifdef DUET_MUST_FAIL
using joints = std::array<duet::joint<>, 1>;
#else
using joints = std::array<duet::joint<>, 2>;
#endif

const auto locked = with_locked_joint(duet::serial_chain(joints{}), 0, .5);
