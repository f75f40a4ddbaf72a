// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// expect: constant expression|non-.constexpr. function

// An error that throws at run time does not compile in a constant expression.

#include <duet/kinematics/chain_parameters.hpp>

#include <array>

#ifdef DUET_MUST_FAIL
constexpr auto arm = duet::from_dh(std::array<duet::dh_row<>, 1>{{{.alpha = 90}}}); // degrees
#else
constexpr auto arm = duet::from_dh(std::array<duet::dh_row<>, 1>{{{.alpha = 1.5}}});
#endif
