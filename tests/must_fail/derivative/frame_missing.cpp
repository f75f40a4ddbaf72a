// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: to differentiate with respect to rotations, poses or tuples pass the frame
// within: 5
// forms: 5

#include <duet/duet.hpp>

#include <iostream>

int main() {
  const auto f = [](const auto& q) { return duet::rotation_vector(q); };
  const auto g = [](const auto& q) { return q.w(); };
  const duet::quaternion<double> q(1, 0, 0, 0);
#if DUET_MUST_FAIL == 1
  duet::jacobian(f, q);
#elif DUET_MUST_FAIL == 2
  std::cout << duet::jacobian(f, q).jacobian << "\n";
#elif DUET_MUST_FAIL == 3
  std::cout << duet::gradient(g, q).gradient << "\n";
#elif DUET_MUST_FAIL == 4
  std::cout << duet::hessian(g, q).hessian << "\n";
#elif DUET_MUST_FAIL == 5
  const auto [y, j] = duet::jacobian(f, q);
#else
  std::cout << duet::jacobian(f, q, duet::frame::body).jacobian << "\n"
            << duet::gradient(g, q, duet::frame::body).gradient << "\n"
            << duet::hessian(g, q, duet::frame::body).hessian << "\n";
#endif
}
