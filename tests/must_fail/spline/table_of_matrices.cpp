// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: adaptive_table: the function must return a rotation

#include <duet/interop/eigen.hpp>
#include <duet/spline/adaptive_table.hpp>
#include <duet/spline/cumulative_bspline.hpp>

int main() {
  using namespace duet;
  const auto matrix_at = [](double u) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(u, Eigen::Vector3d::UnitX()));
  };
#ifdef DUET_MUST_FAIL
  static_cast<void>(adaptive_table<cumulative_bspline<double, 4>>(matrix_at, 0, 1, 1e-3));
#else
  const auto rotation = [&](double u) { return from_eigen(matrix_at(u)); };
  static_cast<void>(adaptive_table<cumulative_bspline<double, 4>>(rotation, 0, 1, 1e-3));
#endif
}
