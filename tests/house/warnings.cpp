// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Typical small programs, compiled with more warnings than the project uses.

#include <duet/derivative/sparse.hpp>
#include <duet/duet.hpp>
#include <duet/io/urdf.hpp>
#include <duet/kinematics/sweep.hpp>
#include <duet/robotics/inverse_kinematics.hpp>
#include <duet/robotics/plan_screw_motion.hpp>
#include <duet/robotics/time_parametrised.hpp>
#include <duet/spline/fit.hpp>

#include <cstddef>
#include <iostream>
#include <tuple>
#include <vector>

int main() {
  using namespace duet;
  const auto f = [](const auto& x) { return x[0] * sin(x[1]) * x[1]; };
  std::cout << to_text(hessian(f, Eigen::Vector2d(1, 2)));
  std::cout << to_text(gradient(f, std::vector<double>{1, 2}));
  const auto scaled = [](const auto& x, const auto& k) { return (k * x).eval(); };
  std::cout << to_text(jacobian(scaled, std::tuple(Eigen::Vector2d(1, 2), 3.0)));
  Eigen::SparseMatrix<double> structure(2, 2);
  structure.setIdentity();
  std::cout << to_text(sparse_hessian([](const auto& x) { return x[0] * x[0] + x[1]; },
                                      Eigen::Vector2d(1, 2), structure));

  const auto arm = robots::panda();
  Eigen::Matrix<double, 7, 1> start;
  start << 0.1, -0.3, 0.2, -1.8, 0.1, 1.6, 0.4;
  auto end = start;
  end[3] = -1.5;
  std::cout << to_text(inverse_kinematics(arm, arm.pose(end), start));
  std::cout << to_text(plan_screw_motion(arm, start, arm.pose(end)));
  std::cout << to_text(pose_and_jacobian(arm, start, frame::body));

  // A chain whose number of joints is known at run time.
  const auto read = read_urdf("three.urdf", "base", "hand");
  const std::vector<double> theta{.3, .4, .1};
  std::cout << to_text(read.pose(theta, read.link("hand")));
  std::cout << to_text(jacobian(read, theta, frame::hybrid, read.link("hand")));
  std::cout << upper_limits(with_limits(read, 0, {.upper = 1})).transpose();
  std::cout << to_text(inverse_kinematics(read, read.pose(theta), theta));

  const std::vector<Eigen::VectorXd> configurations(10, Eigen::VectorXd::Zero(3));
  std::vector<dual_quaternion<double>> tips(configurations.size());
  std::vector<Eigen::MatrixXd> hybrid_jacobians(configurations.size());
  poses(read, configurations, tips, all_cores);
  jacobians(read, configurations, frame::hybrid, hybrid_jacobians, all_cores);

  const auto bars = [](const auto& x, const auto& crank) {
    return make_vector(.2 * cos(crank) + .5 * cos(x[0]) - .55 - .4 * cos(x[1]),
                       .2 * sin(crank) + .5 * sin(x[0]) - .4 * sin(x[1]));
  };
  const constrained_mechanism loop(bars, Eigen::Vector2d(.9, 1.7), 0);
  std::cout << derivatives<2>(loop, 2.0)[2] << implicit_function<2>(bars, loop.position(), 0.0)[1];

  const std::vector<double> times{0, 1, 2, 3, 4};
  std::vector<quaternion<double>> rows;
  for (const double t : times) {
    rows.push_back(from_euler<zyx>(t, 0.1 * t, 0));
  }
  std::cout << to_text(
      interpolate<rotation_vector_spline<double>>(times, rows, natural{}).motion(1.2, frame::body));
  const auto knots = clamped_knots(std::vector<double>{0, 2, 4}, 4);
  std::cout << to_text(fit<cumulative_bspline<double, 4>>(times, rows, knots));

  // Some fields by name, the others as they are.
  const auto weighted =
      fit<cumulative_bspline<double, 4>>(times, rows, knots, {.outlier_threshold = 0});
  std::cout << weighted.rms << weighted.outlier_threshold;
  [[maybe_unused]] const std::tuple some{fit_options{.characteristic_length = 2},
                                         fit_options{.max_iterations = 3},
                                         adaptive_table_options{.characteristic_length = 2},
                                         adaptive_table_options{.max_samples = 100},
                                         plan_options{.tolerance = 1e-9},
                                         plan_options{.max_iterations = 100},
                                         inverse_kinematics_options{.tolerance = 1e-9},
                                         inverse_kinematics_options{.seed = 2},
                                         time_parametrisation_options{.min_intervals = 10},
                                         newton_options{.max_iterations = 3},
                                         constrained_mechanism_options{.largest_step = .1},
                                         comparison_options{.samples = 3},
                                         comparison_options{.tolerance = 3},
                                         real_numbers{.lower = 0},
                                         real_numbers{.upper = 0},
                                         joint_limits<>{.lower = 0},
                                         joint_limits<>{.velocity = 1},
                                         joint<>{.kind = joint_kind::prismatic},
                                         joint<>{.pitch = 1},
                                         dh_row<>{.d = 1},
                                         scene{.margin = .01},
                                         scene{.obstacles = {}}};

  const expression::symbol<"t"> t;
  std::cout << to_latex(expression::derivative(exp(-t * t), t)) << "\n";
}
