// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Mistakes that must not compile, see check.cmake.

#include <duet/dual/dual.hpp>
#include <duet/kinematics/adapted.hpp>
#include <duet/kinematics/chain_parameters.hpp>
#include <duet/kinematics/constrained_mechanism.hpp>
#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/manipulability.hpp>
#include <duet/kinematics/robots.hpp>
#include <duet/kinematics/serial_chain.hpp>

#include <Eigen/Core>

#include <array>
#include <iostream>

//// closed_loop_of_run_time_size
// expect: duet: constrained_mechanism: positions and parameters need a size known at compile time

const auto f = [](const auto& x, const auto& u) {
  return duet::make_vector(x[0] * x[1] - u, x[0] - x[1]);
};
const Eigen::VectorXd start = Eigen::Vector2d(1, 1); // wrong
const Eigen::Vector2d start(1, 1);                   // right
const duet::constrained_mechanism loop(f, start, 1.0);
return loop.position()[0] > .5 ? 0 : 1;

//// dh_row_by_position
// expect: duet: dh_row: name the parameters

constexpr std::array<duet::dh_row<>, 2> rows{{{0, .333, 0}, {.1, 0, 1}}};           // wrong
constexpr std::array<duet::dh_row<>, 2> rows{{{.d = .333}, {.a = .1, .alpha = 1}}}; // right
constexpr auto chain = duet::from_dh(rows);

int main() { return chain.size() == 2 ? 0 : 1; }

//// expression_returned
// expect: duet: a function returns an expression of Eigen

int main() {
  const Eigen::Vector2d start(1, 1);
  const auto closure = [](const auto& x, const auto& u) { return x * u - x; };          // wrong
  const duet::constrained_mechanism loop(closure, start, 2.0);                          // mistake
  const auto closure = [](const auto& x, const auto& u) { return (x * u - x).eval(); }; // right
  const duet::constrained_mechanism loop(closure, start, 2.0);                          // right
  return loop(2.0)[0] == 0 ? 0 : 1;
}

//// jacobian_without_frame
// expect: duet: a chain has three Jacobians, name the frame
// within: 5

int main() {
  const Eigen::Matrix<double, 6, 1> theta = Eigen::Matrix<double, 6, 1>::Zero();
  duet::jacobian(duet::robots::ur5e(), theta);                                         // wrong
  std::cout << duet::jacobian(duet::robots::ur5e(), theta) << "\n";                    // wrong
  static_cast<void>(duet::jacobian(duet::robots::ur5e(), theta, duet::frame::hybrid)); // right
}

//// joint_without_name
// expect: duet: only chains of read_urdf have names: with_l
// within: 2

const auto arm = duet::robots::panda();
const auto six = with_locked_joint(arm, "elbow", -1.5);                     // wrong
const auto seven = with_limits(arm, "elbow", {-2, -1});                     // wrong
const auto six = with_locked_joint(with_limits(arm, 3, {-2, -1}), 3, -1.5); // right

//// last_joint_locked
// expect: duet: with_locked_joint: the only moving joint cannot be locked

using joints = std::array<duet::joint<>, 1>; // wrong
using joints = std::array<duet::joint<>, 2>; // right

const auto locked = with_locked_joint(duet::serial_chain(joints{}), 0, .5);

//// matrix_of_configurations
// expect: duet: [a-z_]* takes the coordinates of one configuration
// within: 2

#include <duet/robotics/inverse_kinematics.hpp>
#include <duet/robotics/plan_screw_motion.hpp>

using namespace duet;

int main() {
  const auto arm = robots::panda();
  const Eigen::MatrixXd thetas = Eigen::MatrixXd::Zero(7, 5);
  const dual_quaternion<double> goal(screw_dual<double>(1));
  std::cout << arm.pose(thetas) << "\n";                             // wrong
  std::cout << jacobian(arm, thetas, frame::hybrid) << "\n";         // wrong
  const double w = manipulability(arm, thetas);                      // wrong
  std::cout << inverse_kinematics(arm, goal, thetas).joints << "\n"; // wrong
  const auto plan = plan_screw_motion(arm, thetas, goal);            // wrong
  std::cout << arm.pose(thetas.col(1)) << jacobian(arm, thetas.col(1), frame::hybrid)
            << manipulability(arm, thetas.col(1))
            << inverse_kinematics(arm, goal, thetas.col(1)).joints << "\n"; // right
}

//// place_on_chain
// expect: FrameOnChain

int main() {
  const auto arm = duet::robots::panda();
  const Eigen::Matrix<double, 7, 1> theta = Eigen::Matrix<double, 7, 1>::Zero();
  static_cast<void>(arm.pose(theta, 3, 4));                              // mistake
  static_cast<void>(arm.pose(theta, 3.5));                               // mistake
  static_cast<void>(jacobian(arm, theta, duet::frame::body, theta));     // mistake
  static_cast<void>(arm.pose(theta, 3));                                 // right
  static_cast<void>(jacobian(arm, theta, duet::frame::body, arm.tip())); // right
}

//// table_of_duals
// expect: duet: serial_chain: the table is real

using number = duet::dual<double>; // wrong
using number = double;             // right
const duet::serial_chain<1, number> chain{std::array<duet::joint<number>, 1>{}};

int main() { return chain.size() == 1 ? 0 : 1; }

//// too_few_coordinates
// expect: duet: a chain takes as many coordinates as it has moving joints

using coordinates = Eigen::Matrix<double, 6, 1>; // wrong
using coordinates = Eigen::Matrix<double, 7, 1>; // right

auto tip(const coordinates& theta) { return duet::robots::panda().pose(theta); }
