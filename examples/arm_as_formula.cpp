// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// A seven-joint arm, Franka Emika's Panda, written as the product of its joints: its formula, its
// pose, and its spatial Jacobian, which the compiler derives and which is compared with that of the
// chain in a table.

#include "support/program.hpp"

#include <duet/duet.hpp>

#include <algorithm>
#include <cstdio>
#include <iostream>

namespace {

using namespace duet::expression;

constexpr symbol<"theta1"> theta1;
constexpr symbol<"theta2"> theta2;
constexpr symbol<"theta3"> theta3;
constexpr symbol<"theta4"> theta4;
constexpr symbol<"theta5"> theta5;
constexpr symbol<"theta6"> theta6;
constexpr symbol<"theta7"> theta7;

/// From the base to the flange, in metres; at θ = 0 the arm stands upright.
auto panda() {
  const auto shoulder = translation_along(axis::z, .333) * screw(axis::z, theta1) *
                        screw(axis::y, theta2) * translation_along(axis::z, .316);
  const auto elbow = screw(axis::z, theta3) * translation_along(axis::x, .0825) *
                     screw(axis::y, -theta4) * translation_along(axis::x, -.0825) *
                     translation_along(axis::z, .384);
  const auto wrist = screw(axis::z, theta5) * screw(axis::y, -theta6) *
                     translation_along(axis::x, .088) * screw(axis::z, -theta7) *
                     screw(axis::x, pi) * translation_along(axis::z, .107);
  return shoulder * elbow * wrist;
}

int run() {
  const auto arm = panda();
  std::cout << "A = " << to_text(arm) << "\n\n" << to_latex(arm) << "\n\n";

  const auto joints = wrt(theta1, theta2, theta3, theta4, theta5, theta6, theta7);
  const auto [tip, J] = jacobian(arm, joints, duet::frame::spatial)(
      theta1 = 0.3, theta2 = -0.7, theta3 = 1.1, theta4 = -1.9, theta5 = 0.4, theta6 = 1.6,
      theta7 = -0.8);
  const auto t = duet::translation(tip);
  std::printf("tip at %.6f %.6f %.6f\nspatial Jacobian\n", t[0], t[1], t[2]);
  for (Eigen::Index i = 0; i < 6; ++i) {
    for (Eigen::Index k = 0; k < 7; ++k) {
      std::printf(" %9.6f", J(i, k) == 0 ? 0.0 : J(i, k));
    }
    std::printf("\n");
  }

  const Eigen::Matrix<double, 7, 1> theta(0.3, -0.7, 1.1, -1.9, 0.4, 1.6, -0.8);
  const auto chain = duet::robots::panda();
  const double of_jacobian =
      (duet::jacobian(chain, theta, duet::frame::spatial) - J).cwiseAbs().maxCoeff();
  const double of_tip = (duet::translation(chain.pose(theta)) - t).norm();
  std::printf("difference from the chain below 1e-14: %s\n",
              std::max(of_jacobian, of_tip) < 1e-14 ? "yes" : "no");
  return 0;
}

} // namespace

int main() { return example::run_program("arm_as_formula", run); }
