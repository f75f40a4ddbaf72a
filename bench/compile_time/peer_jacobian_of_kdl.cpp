// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// What jacobian_of_arm.cpp does, by Orocos KDL, whose solvers are compiled already.

#include <kdl/chain.hpp>
#include <kdl/chainjnttojacsolver.hpp>

Eigen::Matrix<double, 6, 7> twists(const KDL::Chain& arm,
                                   const Eigen::Matrix<double, 7, 1>& theta) {
  KDL::JntArray joints(7);
  joints.data = theta;
  KDL::Jacobian result(7);
  KDL::ChainJntToJacSolver(arm).JntToJac(joints, result);
  return result.data;
}
