// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: serial_chain: the table is real

#include <duet/dual/dual.hpp>
#include <duet/kinematics/serial_chain.hpp>

#include <array>

#ifdef DUET_MUST_FAIL
using number = duet::dual<double>;
#else
using number = double;
#endif
const duet::serial_chain<1, number> chain{std::array<duet::joint<number>, 1>{}};

int main() { return chain.size() == 1 ? 0 : 1; }
