// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: differentiate with respect to a vector, not to a matrix: x.reshaped\(\)

#include <duet/derivative/gradient.hpp>

int main() {
  const auto f = [](const auto& x) { return x.sum(); };
#ifdef DUET_MUST_FAIL
  const Eigen::Matrix2d x = Eigen::Matrix2d::Ones();
#else
  const Eigen::Vector4d x = Eigen::Vector4d::Ones();
#endif
  return duet::gradient(f, x).value == 4 ? 0 : 1;
}
