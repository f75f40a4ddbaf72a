// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: the frame is missing
// within: 2
// forms: 2

#include <duet/expression/motion.hpp>
#include <duet/expression/rotation.hpp>
#include <duet/expression/symbol.hpp>

#include <iostream>

int main() {
  using namespace duet::expression;
  constexpr symbol<"u"> u;
  constexpr vector_symbol<"w"> w;
  const Eigen::Vector3d w0(1, 2, 3);
#if DUET_MUST_FAIL == 1
  const auto m = motion(exp(u * w), u);
#elif DUET_MUST_FAIL == 2
  std::cout << motion(exp(u * w), u)(u = 0.3, w = w0).velocity << "\n";
#else
  std::cout << motion(exp(u * w), u, duet::frame::body)(u = 0.3, w = w0).velocity << "\n";
#endif
}
