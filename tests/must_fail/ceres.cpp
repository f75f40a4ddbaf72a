// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Mistakes that must not compile, see check.cmake.

#include <duet/interop/ceres_curves.hpp>

#include <ceres/jet.h>

#include <memory>
#include <vector>

//// jet
// expect: duet: a quaternion cannot have ceres::Jet as its scalar: duet::cost_function

int main() {
#ifdef DUET_MUST_FAIL
  using number = ceres::Jet<double, 4>;
#else
  using number = double;
#endif
  const duet::quaternion<number> q(number(1.));
  static_cast<void>(q);
}

//// real_function
// expect: duet: cost_function: the function must take any scalar

int main() {
#ifdef DUET_MUST_FAIL
  const auto f = [](double x) { return x; };
#else
  const auto f = [](const auto& x) { return x; };
#endif
  const std::unique_ptr<ceres::CostFunction> cost(duet::cost_function(f, duet::number_block()));
}

//// unknown_size
// expect: duet: cost_function: the function must return a number, or a vector or std::array

int main() {
  const auto f = [](const auto& x) {
#ifdef DUET_MUST_FAIL
    return std::vector{x, x};
#else
    return std::array{x, x};
#endif
  };
  const std::unique_ptr<ceres::CostFunction> cost(duet::cost_function(f, duet::number_block()));
}

//// position_of_rotations
// expect: duet: a residual of positions needs a curve of poses or a split curve

int main() {
  const duet::bspline_basis<4> basis(std::vector<double>{0, 0, 0, 0, 1, 1, 1, 1});
  const std::vector<duet::quaternion<double>> rotations(4, duet::quaternion<double>(1.));
#ifdef DUET_MUST_FAIL
  const duet::curve_blocks<double> curve(duet::cumulative_bspline<double>(basis, rotations));
#else
  const std::vector<duet::vector3<double>> positions(4, duet::vector3<double>(0, 0, 0));
  const duet::split_curve_blocks<4> curve(duet::split_bspline<double>(basis, rotations, positions));
#endif
  const std::unique_ptr<ceres::CostFunction> cost(
      position_residual(curve, .5, duet::vector3<double>(0, 0, 0)));
}
