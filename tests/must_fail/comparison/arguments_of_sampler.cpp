// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: compare: (both functions must take|the arguments must come from)
// within: 2
// forms: 4

#include <duet/comparison/compare.hpp>

#include <iostream>

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
