// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// A seven-joint arm as a chain of duet, static and as a table in memory, compared with Orocos KDL,
/// whose chain is in memory as if read from a robot description.

#include "support/contest.hpp"
#include "workloads.hpp"

#include <duet/derivative/jacobian.hpp>
#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/jacobian_rate.hpp>
#include <duet/kinematics/robots.hpp>

#if DUET_BENCH_KDL
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacdotsolver.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#endif

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>

namespace duet_bench {
namespace {

using joint_angles = inputs<double, joints>;

std::array<double, 7> numbers(const duet::dual_quaternion<double>& a) {
  const auto t = duet::translation(a);
  const auto q = duet::rotation(a);
  return {t[0], t[1], t[2], q.w(), q.x(), q.y(), q.z()};
}
std::array<double, 7> numbers(const pose<double>& a) {
  return {a.position[0], a.position[1], a.position[2], a.rotation[0],
          a.rotation[1], a.rotation[2], a.rotation[3]};
}

constexpr auto known = duet::robots::panda();

/// The three rows of a Jacobian that belong to the position, concatenated.
template <class J>
std::array<double, 3 * joints> upper_rows(const J& j) {
  std::array<double, 3 * joints> result;
  for (std::size_t k = 0; k < result.size(); ++k) {
    result[k] = j(Eigen::Index(k) / joints, Eigen::Index(k) % joints);
  }
  return result;
}

#if DUET_BENCH_KDL
/// The arm in KDL, with its solvers and their workspace.
struct kdl_arm {
  KDL::Chain chain = [] {
    KDL::Chain result;
    for (const arm_row& row : arm) {
      const KDL::Frame origin =
          KDL::Frame(KDL::Rotation::RotX(2 * std::atan2(row.half_sin, row.half_cos))) *
          KDL::Frame(KDL::Vector(row.a, 0, row.d));
      const KDL::Joint joint(origin.p, origin.M * KDL::Vector(0, 0, 1), KDL::Joint::RotAxis);
      result.addSegment(KDL::Segment(joint, origin));
    }
    return result;
  }();
  KDL::ChainFkSolverPos_recursive forward{chain};
  KDL::ChainJntToJacSolver jacobian{chain};
  KDL::ChainJntToJacDotSolver rate{chain};
  KDL::JntArrayVel theta{joints};
  KDL::Frame tip;
  KDL::Jacobian columns{joints};

  void set(const joint_angles& x) {
    for (std::size_t i = 0; i < joints; ++i) {
      theta.q(unsigned(i)) = theta.qdot(unsigned(i)) = x[i];
    }
  }
};
#endif

/// Orocos KDL on the workloads of the arm in memory.
void register_kdl([[maybe_unused]] const joint_angles& angles) {
#if DUET_BENCH_KDL
  const auto kdl = std::make_shared<kdl_arm>();
  const auto pose_of = [kdl](const joint_angles& x) {
    kdl->set(x);
    (void)kdl->forward.JntToCart(kdl->theta.q, kdl->tip);
    return kdl->tip;
  };
  const auto jacobian_of = [kdl](const joint_angles& x) {
    kdl->set(x);
    (void)kdl->jacobian.JntToJac(kdl->theta.q, kdl->columns);
    return &kdl->columns;
  };
  const auto rate_of = [kdl](const joint_angles& x) {
    kdl->set(x);
    (void)kdl->rate.JntToJacDot(kdl->theta, kdl->columns);
    return &kdl->columns;
  };
  const auto table = known.table();
  expect_agreement("arm_jacobian_of_table", "kdl",
                   upper_rows(duet::jacobian(table, angles, duet::frame::hybrid)),
                   upper_rows(jacobian_of(angles)->data));
  expect_agreement("arm_rate_of_table", "kdl",
                   upper_rows(duet::jacobian_rate(table, angles, angles, duet::frame::hybrid)),
                   upper_rows(rate_of(angles)->data));
  register_benchmark("arm_pose_of_table", "kdl", angles, pose_of);
  register_benchmark("arm_jacobian_of_table", "kdl", angles, jacobian_of);
  register_benchmark("arm_rate_of_table", "kdl", angles, rate_of);
#endif
}

const bool registered = [] {
  const joint_angles angles = {0.3, -0.7, 1.1, -1.9, 0.4, 1.6, -0.8};
  const auto table = known.table();
  const auto by_hand = [](const joint_angles& x) {
    pose_jacobian jacobian;
    const pose<double> a = fk7_by_hand(x, jacobian);
    return std::pair(a, jacobian);
  };

  expect_agreement("arm_pose", "duet", numbers(fk7(angles)), numbers(known.pose(angles)));
  expect_agreement("arm_pose_of_table", "duet", numbers(fk7(angles)), numbers(table.pose(angles)));
  register_benchmark("arm_pose", "duet", angles,
                     [](const joint_angles& x) { return known.pose(x); });
  register_benchmark("arm_pose", "hand", angles, [](const joint_angles& x) { return fk7(x); });
  register_benchmark("arm_pose_of_table", "duet", angles,
                     [table](const joint_angles& x) { return table.pose(x); });
  register_benchmark("arm_pose_of_table", "hand", angles,
                     [](const joint_angles& x) { return fk7(x); });

  const auto [a, jacobian] = by_hand(angles);
  const auto j = duet::pose_and_jacobian(known, angles, duet::frame::hybrid).jacobian;
  std::array<double, 3 * joints> rows;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    rows[k] = jacobian[k / joints][k % joints];
  }
  expect_agreement("arm_jacobian", "duet", rows, upper_rows(j));
  register_benchmark("arm_jacobian", "duet", angles, [](const joint_angles& x) {
    return duet::pose_and_jacobian(known, x, duet::frame::hybrid);
  });
  register_benchmark("arm_jacobian", "hand", angles, by_hand);
  register_benchmark("arm_jacobian_of_table", "duet", angles, [table](const joint_angles& x) {
    return duet::pose_and_jacobian(table, x, duet::frame::hybrid);
  });
  register_benchmark("arm_jacobian_of_table", "hand", angles, by_hand);
  register_benchmark("arm_spatial_jacobian", "duet", angles, [](const joint_angles& x) {
    return duet::jacobian(known, x, duet::frame::spatial);
  });
  register_benchmark("arm_spatial_jacobian", "hand", angles, by_hand);
  register_benchmark("arm_rate_of_table", "duet", angles, [table](const joint_angles& x) {
    return duet::jacobian_rate(table, x, x, duet::frame::hybrid);
  });
  const auto by_duals = [](const joint_angles& x) {
    return duet::jacobian([](const auto& y) { return known.pose(y); }, x, duet::frame::hybrid);
  };
  expect_agreement("arm_by_duals", "duet", upper_rows(j), upper_rows(by_duals(angles).jacobian));
  register_benchmark("arm_by_duals", "duet", angles, by_duals);
  register_benchmark("arm_by_duals", "closed_form", angles, [](const joint_angles& x) {
    return duet::pose_and_jacobian(known, x, duet::frame::hybrid);
  });
  register_kdl(angles);
  return true;
}();

} // namespace
} // namespace duet_bench
