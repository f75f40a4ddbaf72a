// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/derivative/nonlinear_least_squares.hpp>
#include <duet/interop/ceres_curves.hpp>

#include <ceres/covariance.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <limits>
#include <tuple>
#include <utility>
#include <vector>

/// \file
/// Calibration of a gyroscope on a known curve of rotations, by Ceres and without it.

namespace gyroscope_calibration {

using curve = duet::cumulative_bspline<double>;
using vector3 = duet::vector3<double>;
using rotation = duet::quaternion<double>;

struct reading {
  double time;   ///< s, by the clock of the sensor
  vector3 omega; ///< rad/s, in axes of the sensor
};

struct calibration {
  double offset = 0;              ///< s, to be added to times of readings
  vector3 bias = vector3::Zero(); ///< rad/s
  rotation sensor = rotation(1.); ///< from axes of the sensor to those of the body
  Eigen::Matrix<double, 7, 7> covariance =
      Eigen::Matrix<double, 7, 7>::Zero(); ///< of offset, bias and rotation (rad)
};

inline calibration by_ceres(const curve& motion, const std::vector<reading>& readings,
                            double max_offset) {
  const duet::curve_blocks<double> controls(motion);
  const duet::rotation_block block(duet::quaternion_order::wxyz);
  double offset = 0, bias[3] = {0, 0, 0}, sensor[4] = {1, 0, 0, 0};
  ceres::Problem problem;
  controls.add_to(problem, true); // constant
  for (const reading& each : readings) {
    const duet::measurement_time when(each.time, max_offset);
    problem.AddResidualBlock(gyroscope_residual(controls, when, each.omega, block), nullptr,
                             controls.blocks(when, {&offset, bias, sensor}));
  }
  problem.SetParameterLowerBound(&offset, 0, -max_offset);
  problem.SetParameterUpperBound(&offset, 0, max_offset);
  problem.SetManifold(sensor, new duet::rotation_manifold(block.order()));
  ceres::Solver::Options options;
  options.function_tolerance = options.parameter_tolerance = options.gradient_tolerance = 1e-15;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  calibration result{offset, vector3(bias), block.load(sensor)};
  const std::vector<const double*> unknown{&offset, bias, sensor};
  ceres::Covariance covariance({});
  if (covariance.Compute(unknown, &problem)) {
    covariance.GetCovarianceMatrixInTangentSpace(unknown, result.covariance.data());
  }
  result.covariance *= 2 * summary.final_cost / (3. * double(readings.size()) - 7);
  return result;
}

inline calibration by_duet(const curve& motion, const std::vector<reading>& readings,
                           double max_offset) {
  const auto residuals = [&]<class S>(const S& offset, const duet::vector3<S>& bias,
                                      const duet::quaternion<S>& sensor) {
    std::vector<duet::vector3<S>> result;
    for (const reading& each : readings) {
      const auto omega = motion.motion(each.time + offset, duet::frame::body).velocity;
      result.push_back(rotate(conj(sensor), omega) + bias - each.omega.cast<S>());
    }
    return result;
  };
  duet::nonlinear_least_squares_options options;
  options.upper = Eigen::VectorXd::Constant(7, std::numeric_limits<double>::infinity());
  options.upper[0] = max_offset;
  options.lower = -options.upper;
  const auto result = duet::nonlinear_least_squares(
      residuals, std::tuple(0., vector3(0, 0, 0), rotation(1.)), options);
  const auto& [offset, bias, sensor] = result.estimate;
  return {offset, bias, sensor, result.covariance};
}

} // namespace gyroscope_calibration
