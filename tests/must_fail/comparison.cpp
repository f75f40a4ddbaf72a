// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Mistakes that must not compile, see check.cmake.

#include <duet/comparison/compare.hpp>
#include <duet/comparison/numeric_derivative.hpp>

#include <iostream>

//// arguments_of_sampler
// expect: duet: compare: (both functions must take|the arguments must come from)
// within: 2

using namespace duet;

int main() {
  const auto f = [](auto x, auto y) { return x * y; };
  const auto g = [](auto x, auto y) { return y * x; };
  const auto h = [](auto x) { return x; };
  std::cout << to_text(compare("x y", f, g, sampler(real_numbers{0, 1}))) << "\n"; // wrong
  const auto c = compare<double>("x y", f, g, sampler(real_numbers{0, 1}));        // wrong
  const auto c =
      compare("x y", f, g, sampler(real_numbers{}, real_numbers{}, real_numbers{}));    // wrong
  const auto c = compare("x", h, h, real_numbers{0, 1});                                // wrong
  const auto c = compare("x y", f, g, sampler(real_numbers{0, 1}, real_numbers{0, 1})); // right
  const auto d = compare<double>("x", h, h, sampler(real_numbers{0, 1}));               // right
  std::cout << to_text(c) << to_text(d) << "\n";                                        // right
}

//// expression_returned
// expect: duet: a function returns an expression of Eigen

int main() {
  using namespace duet;
  const sampler inputs(real_numbers{-1, 1});
  const auto right = [](auto x) { return Eigen::Vector2<decltype(x)>(x, x); };
  const auto wrong = [&](auto x) { return right(x) + right(x); }; // wrong, too
  static_cast<void>(compare("first", wrong, right, inputs));      // mistake
  static_cast<void>(complex_step_derivative(wrong, 1.0));         // mistake
  static_cast<void>(central_difference_derivative(wrong, 1.0));   // mistake
  const auto other = [&](auto x) { return right(x) - right(x); }; // wrong, too
  static_cast<void>(compare("second", right, other, inputs));     // mistake
  static_cast<void>(compare("both", right, right, inputs));       // right
  static_cast<void>(complex_step_derivative(right, 1.0));         // right
}
