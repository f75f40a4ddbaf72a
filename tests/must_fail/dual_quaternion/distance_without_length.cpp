// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: the characteristic length is missing

#include <duet/dual_quaternion/distance.hpp>

int main() {
  const duet::dual_quaternion<double> a(1);
#ifdef DUET_MUST_FAIL
  const double length = distance(a, a);         // mistake
  const double square = squared_distance(a, a); // mistake
#else
  const double length = distance(a, a, 0.5);
  const double square = squared_distance(a, a, 0.5);
#endif
  return length == 0 && square == 0 ? 0 : 1;
}
