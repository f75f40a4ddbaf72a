// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Mistakes that must not compile, see check.cmake.

#include <duet/comparison/compare.hpp>
#include <duet/comparison/numeric_derivative.hpp>

#include <iostream>

//// arguments_of_sampler
// expect: duet: compare: (both functions must take|the arguments must come from)
// within: 2
// forms: 4

using namespace duet;

int main() {
  const auto f = [](auto x, auto y) { return x * y; };
  const auto g = [](auto x, auto y) { return y * x; };
  const auto h = [](auto x) { return x; };
#if DUET_MUST_FAIL == 1
  std::cout << to_text(compare("x y", f, g, sampler(real_numbers{0, 1}))) << "\n";
#elif DUET_MUST_FAIL == 2
  const auto c = compare<double>("x y", f, g, sampler(real_numbers{0, 1}));
#elif DUET_MUST_FAIL == 3
  const auto c = compare("x y", f, g, sampler(real_numbers{}, real_numbers{}, real_numbers{}));
#elif DUET_MUST_FAIL == 4
  const auto c = compare("x", h, h, real_numbers{0, 1});
#else
  const auto c = compare("x y", f, g, sampler(real_numbers{0, 1}, real_numbers{0, 1}));
  const auto d = compare<double>("x", h, h, sampler(real_numbers{0, 1}));
  std::cout << to_text(c) << to_text(d) << "\n";
#endif
}

//// expression_returned
// expect: duet: a function returns an expression of Eigen

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
