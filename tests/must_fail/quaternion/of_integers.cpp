// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: a quaternion<T> needs
// within: 5
// forms: 4

#include <duet/quaternion/rotation.hpp>

#include <iostream>

int main() {
#if DUET_MUST_FAIL == 1
  const duet::quaternion<int> q(1, 0, 0, 0);
#elif DUET_MUST_FAIL == 2
  std::cout << duet::quaternion<int>(1, 0, 0, 0) << "\n";
#elif DUET_MUST_FAIL == 3
  std::cout << duet::quaternion(1, 0, 0, 0) << "\n";
#elif DUET_MUST_FAIL == 4
  std::cout << rotate(duet::quaternion<int>(1), duet::vector3<double>(1, 2, 3)) << "\n";
#else
  std::cout << duet::quaternion<double>(1, 0, 0, 0) << duet::quaternion(1., 0., 0., 0.) << "\n";
#endif
}
