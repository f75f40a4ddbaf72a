// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: (a sum or product of|accumulate, reduce)

#include <duet/dual/dual.hpp>
#include <duet/dual/math.hpp>

#include <numeric>
#include <vector>

// A sum whose type is double would lose the derivatives of what it adds up.
int main() {
  const duet::dual<double> x(1, 2);
  const std::vector<duet::dual<double>> v{x, x};
#ifdef DUET_MUST_FAIL
  double s = 0;
  s += x;                                                                // mistake
  s -= x;                                                                // mistake
  s *= x;                                                                // mistake
  s /= x;                                                                // mistake
  const auto a = std::accumulate(v.begin(), v.end(), 0.0);               // mistake
  const auto b = std::accumulate(v.begin(), v.end(), 0, std::plus<>());  // mistake
  const auto c = std::reduce(v.begin(), v.end(), 0.0);                   // mistake
  const auto d = std::inner_product(v.begin(), v.end(), v.begin(), 0.0); // mistake
#else
  duet::dual<double> s = 0;
  s += x;
  const auto a = std::accumulate(v.begin(), v.end(), duet::dual<double>(0));
  const auto b = std::reduce(v.begin(), v.end(), duet::dual<double>(0));
  const auto c = std::inner_product(v.begin(), v.end(), v.begin(), duet::dual<double>(0));
  return a == b && a == c && s == 1 ? 1 : 0;
#endif
}
