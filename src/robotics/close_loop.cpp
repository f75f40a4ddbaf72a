// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "branches/loop_equation.hpp"
#include "branches/orthonormalise.hpp"

#include <algorithm>
#include <cmath>

namespace duet::detail {
DUET_ABI_BEGIN

bool close_loop(const loop_equation& loop, six_coordinates& theta, double size_of_angles) {
  constexpr double rounding = 2e-15, good = 1e-13, hopeful = 1e-6, singular = 1e-7;
  double before = HUGE_VAL;
  six_coordinates last = six_coordinates::Zero(), measured = theta;
  for (int k = 0; k < 60; ++k) {
    const closure_error closure(loop, theta);
    const double to_angle = closure.size / std::min(closure.size, size_of_angles);
    const double residual = std::sqrt(closure.twist.head<3>().squaredNorm() +
                                      to_angle * to_angle * closure.twist.tail<3>().squaredNorm()) /
                            closure.size;
    if (residual <= rounding || (residual <= good && residual >= before / 2)) {
      return true;
    }
    if ((k >= 20 && !(residual < .1)) || (k >= 40 && !(residual < hopeful))) {
      return false;
    }
    before = residual;
    measured = theta;
    six_coordinates step = least_solution(closure.jacobian, closure.twist);
    if (residual <= good && !(step.norm() < singular)) {
      return true; // the residual is round-off, which a step would amplify
    }
    // Steps of this length close an error of fourth order.
    const double max_step = std::min(.5, 2 * closure.size * std::sqrt(std::sqrt(residual)));
    if (!(step.norm() < max_step)) { // damped least squares: min |J x − e|² + |e|² |x|²
      Eigen::Matrix<double, 6, 12> damped;
      damped << closure.jacobian, residual * six_columns::Identity();
      step = least_solution(damped, closure.twist).head<6>();
      step *= std::min(1.0, max_step / step.norm());
      if (!step.allFinite()) {
        return false;
      }
    }
    // At a singularity step lengths decrease by a factor q: 1 + q + q² + … of
    // them are taken at once.
    const double lengths = last.norm() * step.norm(), q = step.norm() / last.norm();
    if (k % 3 == 2 && q < .95 && last.dot(step) > .9 * lengths) {
      theta += q / (1 - q) * step;
    }
    theta += step;
    last = step;
  }
  theta = measured;
  return before <= 5 * good; // round-off limits the accuracy where many solutions coincide
}

DUET_ABI_END
} // namespace duet::detail
