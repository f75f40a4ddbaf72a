// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// What inverse_kinematics.cpp does, by Orocos KDL, whose solvers are compiled already.

#include <kdl/chain.hpp>
#include <kdl/chainiksolverpos_lma.hpp>

Eigen::Matrix<double, 7, 1> joints(const KDL::Chain& arm, const KDL::Frame& goal,
                                   const Eigen::Matrix<double, 7, 1>& start) {
  KDL::JntArray from(7), to(7);
  from.data = start;
  KDL::ChainIkSolverPos_LMA(arm).CartToJnt(from, goal, to);
  return to.data;
}
