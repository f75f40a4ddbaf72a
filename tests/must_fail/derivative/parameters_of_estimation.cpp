// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: must be a double|must return a scalar|several parameters as a tuple
// within: 5
// forms: 5

#include <duet/derivative/nonlinear_least_squares.hpp>
#include <duet/quaternion/exponential.hpp>

#include <Eigen/Core>

#include <tuple>

int main() {
#if DUET_MUST_FAIL == 1
  const auto r = duet::nonlinear_least_squares([](const auto& a) { return a - 1; }, 2);
#elif DUET_MUST_FAIL == 2
  const auto r =
      duet::nonlinear_least_squares([](const auto& a) { return a[0] - 1; }, Eigen::Vector2i(1, 2));
#elif DUET_MUST_FAIL == 3
  const auto r =
      duet::nonlinear_least_squares([](const auto& q) { return q; }, duet::quaternion(1.));
#elif DUET_MUST_FAIL == 4
  const auto r =
      duet::nonlinear_least_squares([](const auto& a, const auto& b) { return a - b; }, 1., 2.);
#elif DUET_MUST_FAIL == 5
  const auto r =
      duet::nonlinear_least_squares([](const auto&) { return Eigen::MatrixXd(2, 2); }, 1.);
#else
  const auto r = duet::nonlinear_least_squares([](const auto& a, const auto& b) { return a - b; },
                                               std::tuple(1., 2.));
#endif
  static_cast<void>(r);
}
