// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: a function returns an expression of Eigen

#include <duet/comparison/compare.hpp>
#include <duet/comparison/numeric_derivative.hpp>

int main() {
  using namespace duet;
  const sampler inputs(real_numbers{-1, 1});
  const auto right = [](auto x) { return Eigen::Vector2<decltype(x)>(x, x); };
#ifdef DUET_MUST_FAIL
  const auto wrong = [&](auto x) { return right(x) + right(x); };
  static_cast<void>(compare("first", wrong, right, inputs));    // mistake
  static_cast<void>(complex_step_derivative(wrong, 1.0));       // mistake
  static_cast<void>(central_difference_derivative(wrong, 1.0)); // mistake
  const auto other = [&](auto x) { return right(x) - right(x); };
  static_cast<void>(compare("second", right, other, inputs)); // mistake
#else
  static_cast<void>(compare("both", right, right, inputs));
  static_cast<void>(complex_step_derivative(right, 1.0));
#endif
}
