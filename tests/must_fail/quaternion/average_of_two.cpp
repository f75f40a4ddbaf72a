// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: average(: rows| takes a (list or )?vector)
// within: 2
// forms: 3

#include <duet/quaternion/average.hpp>

#include <Eigen/Geometry>

#include <array>
#include <iostream>
#include <vector>

int main() {
  const duet::quaternion<double> q(1), p(1);
#if DUET_MUST_FAIL == 1
  std::cout << average(p, q) << "\n";
#elif DUET_MUST_FAIL == 2
  std::cout << average(std::array{p, q}) << "\n";
#elif DUET_MUST_FAIL == 3
  std::cout << duet::average(std::vector<Eigen::Quaterniond>(3)) << "\n";
#else
  std::cout << average(std::vector{p, q}) << duet::average({p, q}) << "\n";
#endif
}
