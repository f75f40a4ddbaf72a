// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Mistakes that must not compile, see check.cmake.

#include <duet/core/parallel_for.hpp>
#include <duet/core/select.hpp>
#include <duet/kinematics/chain_parameters.hpp>

#include <Eigen/Core>

#include <array>

//// error_in_constant
// expect: constant expression|non-.constexpr. function

// An error that throws at run time does not compile in a constant expression.

#ifdef DUET_MUST_FAIL
constexpr auto arm = duet::from_dh(std::array<duet::dh_row<>, 1>{{{.alpha = 90}}}); // degrees
#else
constexpr auto arm = duet::from_dh(std::array<duet::dh_row<>, 1>{{{.alpha = 1.5}}});
#endif

//// progress_of_temporary
// expect: cannot bind non-const lvalue|no viable conversion

const auto proceed = [](const duet::progress&) { return true; };

// The lambda it refers to is destroyed before the run begins.
const duet::execution how{2, [](const duet::progress&) { return true; }}; // wrong
const duet::execution how{2, proceed};                                    // right

int main() { return how.report ? 0 : 1; }

//// select_of_expressions
// expect: duet: a function returns an expression of Eigen

int main() {
  const Eigen::Vector2d a(1, 2);
  const auto minus = [&] { return -a; };                    // wrong
  return duet::select(true, minus, minus)[0] == -1 ? 0 : 1; // mistake
  const auto minus = [&] { return (-a).eval(); };           // right
  return duet::select(true, minus, minus)[0] == -1 ? 0 : 1; // right
}
