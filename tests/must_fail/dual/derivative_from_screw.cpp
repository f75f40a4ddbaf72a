// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: epsilon_of_a_rigid_motion_is_not_that_of_a_derivative|deleted function

#include <duet/dual/math.hpp>

using screw = duet::dual<double, 1, duet::screw_tag>;

const screw x(1, 2);
#ifdef DUET_MUST_FAIL
const auto y = static_cast<duet::dual<double>>(x);
#else
const auto y = static_cast<duet::dual<duet::dual<double>, 1, duet::screw_tag>>(x);
#endif

int main() { return y == 1 ? 0 : 1; }
