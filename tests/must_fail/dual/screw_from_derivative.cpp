// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: epsilon_of_a_rigid_motion_is_not_that_of_a_derivative|deleted function

#include <duet/dual/math.hpp>

// The ε of a screw is not the ε of a derivative: together they nest, but neither becomes the other.
using screw = duet::dual<double, 1, duet::screw_tag>;
using derivative = duet::dual<double>;

const derivative x = derivative::variable(2);
#ifdef DUET_MUST_FAIL
const screw y = x;
#else
const duet::dual<derivative, 1, duet::screw_tag> y = x;
#endif

int main() { return y == 2 ? 0 : 1; }
