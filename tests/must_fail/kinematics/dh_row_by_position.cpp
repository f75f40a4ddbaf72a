// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: dh_row: name the parameters

#include <duet/kinematics/chain_parameters.hpp>

#include <array>

#ifdef DUET_MUST_FAIL
constexpr std::array<duet::dh_row<>, 2> rows{{{0, .333, 0}, {.1, 0, 1}}};
#else
constexpr std::array<duet::dh_row<>, 2> rows{{{.d = .333}, {.a = .1, .alpha = 1}}};
#endif
constexpr auto chain = duet::from_dh(rows);

int main() { return chain.size() == 2 ? 0 : 1; }
