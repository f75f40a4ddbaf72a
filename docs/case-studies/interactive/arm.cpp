// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// An arm in the browser: screw motion of the tip to a goal, joint limits, singular values, inverse
// kinematics. Metres, radians, axes of the base; poses are w, x, y, z of the rotation, then the
// position.

#include "live.hpp"

#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/robots.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/robotics/all_inverse_kinematics.hpp>
#include <duet/robotics/inverse_kinematics.hpp>
#include <duet/robotics/plan_screw_motion.hpp>

#include <Eigen/SVD>

#include <algorithm>
#include <cstddef>

namespace {

/// One type for all arms, so that code for it is compiled once.
using arm_chain = duet::bounded_chain<7>;
using joints = duet::detail::joint_vector<double, -7>;
using pose_type = duet::dual_quaternion<double>;
using vector3 = duet::vector3<double>;

arm_chain chain_of(int arm) {
  return arm == 0   ? arm_chain(duet::robots::panda().table())
         : arm == 1 ? arm_chain(duet::robots::ur5e().table())
                    : arm_chain(duet::robots::iiwa14().table());
}

joints joints_from(const arm_chain& chain, const double* theta) {
  return Eigen::Map<const joints>(theta, chain.size());
}

pose_type pose_from(const double* p) {
  return duet::pose(normalized(duet::quaternion<double>(p[0], p[1], p[2], p[3])),
                    vector3(p[4], p[5], p[6]));
}

live::writer& operator<<(live::writer& out, const pose_type& a) {
  const auto q = duet::rotation(a);
  return out << q.w() << q.x() << q.y() << q.z() << vector3(duet::translation(a));
}

} // namespace

/// Joints of the arm.
/// \param arm  0 Panda, 1 UR5e, 2 iiwa 14
/// \param out  lower limits, upper limits and initial coordinates: 3 joints numbers
/// \return number of joints, at most 7
DUET_LIVE int joints_of_arm(int arm, double* out) {
  live::writer to(out);
  const arm_chain chain = chain_of(arm);
  to << duet::lower_limits(chain) << duet::upper_limits(chain);
  constexpr double starts[3][7] = {
      {0, -.7, 0, -2.3, 0, 1.6, .8}, {0, -1.3, 1.9, -2.2, -1.57, 0}, {0, .6, 0, -1.5, 0, 1, 0}};
  for (int i = 0; i < chain.size(); ++i) {
    to << starts[arm][i];
  }
  return chain.size();
}

/// Forward kinematics of all links.
/// \param out  poses of all links from the base to the last, and of the tip: (joints + 2) times 7
///             numbers
DUET_LIVE void links_of_arm(int arm, const double* theta, double* out) {
  live::writer to(out);
  const arm_chain chain = chain_of(arm);
  const joints x = joints_from(chain, theta);
  for (int link = 0; link <= chain.size(); ++link) {
    to << pose_type(chain.pose(x, link));
  }
  to << pose_type(chain.pose(x));
}

/// The singular values of the tip's Jacobian in the hybrid frame, translation in metres.
/// \param out  6 numbers, the largest first
DUET_LIVE void singular_values_of_arm(int arm, const double* theta, double* out) {
  live::writer to(out);
  const arm_chain chain = chain_of(arm);
  const auto J = duet::jacobian(chain, joints_from(chain, theta), duet::frame::hybrid);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd{Eigen::MatrixXd(J)};
  to << svd.singularValues();
}

/// A pose moved and rotated.
/// \param by   displacement of the position (3), and rotation vector in the axes of the pose (3)
/// \param out  a pose
DUET_LIVE void moved_pose(const double* pose, const double* by, double* out) {
  live::writer to(out);
  const pose_type a = pose_from(pose);
  to << duet::pose(duet::rotation(a) * duet::from_rotation_vector(vector3(by[3], by[4], by[5])),
                   vector3(duet::translation(a) + vector3(by[0], by[1], by[2])));
}

/// The screw motion from one pose to another.
/// \param out  the axis's direction (3) and its point nearest to the first pose (3), angle,
///             translation along the axis, 1 if it rotates, else 0; then `count` poses along it,
///             the first and the last included: 9 + 7 count numbers
DUET_LIVE void screw_between(const double* from, const double* goal, int count, double* out) {
  live::writer to(out);
  const pose_type a = pose_from(from);
  const pose_type b = pose_from(goal);
  const auto s = duet::screw_parameters(b * conj(a));
  const vector3 start = duet::translation(a);
  const vector3 foot = s.axis.cross(s.moment);
  to << s.axis << vector3(foot + s.axis * s.axis.dot(start - foot)) << s.angle << s.translation
     << (s.angle > 0 ? 1. : 0.);
  for (int i = 0; i < count; ++i) {
    to << duet::sclerp(a, b, double(i) / (count - 1));
  }
}

/// The plan along the screw motion from the pose of the tip at the start to a goal.
/// \param capacity  maximum number of waypoints that are written
/// \param out       stop reason (0 if the goal is reached), smallest singular value, smallest
///                  margin from a limit; then τ and the coordinates of each waypoint:
///                  3 + (1 + joints) capacity numbers
/// \return number of waypoints, of which the first `capacity` are written
DUET_LIVE int plan_of_arm(int arm, const double* start, const double* goal, int capacity,
                          double* out) {
  live::writer to(out);
  const arm_chain chain = chain_of(arm);
  // A smaller deviation would not be visible and would be slower than the pointer.
  duet::plan_options options;
  options.deviation = 1e-4;
  const auto plan =
      duet::plan_screw_motion(chain, joints_from(chain, start), pose_from(goal), options);
  to << double(plan.reason) << plan.smallest_singular_value << plan.smallest_limit_margin;
  const int count = int(plan.tau.size());
  for (int i = 0; i < std::min(count, capacity); ++i) {
    to << plan.tau[std::size_t(i)] << plan.joints[std::size_t(i)];
  }
  return count;
}

/// Inverse kinematics: all solutions within the limits of an arm of six joints; for seven joints,
/// whose solutions form curves, the one that is found from an initial guess.
/// \param capacity  maximum number of solutions
/// \param out       coordinates of each solution: joints times capacity numbers
/// \return number of solutions
DUET_LIVE int solutions_of_arm(int arm, const double* goal, const double* start, int capacity,
                               double* out) {
  live::writer to(out);
  const arm_chain chain = chain_of(arm);
  if (chain.size() == 6) {
    int count = 0;
    for (const auto& each : duet::all_inverse_kinematics(chain, pose_from(goal)).solutions) {
      if (each.within_limits && count < capacity) {
        to << each.joints;
        ++count;
      }
    }
    return count;
  }
  const auto solution = duet::inverse_kinematics(chain, pose_from(goal), joints_from(chain, start));
  if (solution.reason != duet::stop_reason::reached || capacity < 1) {
    return 0;
  }
  to << solution.joints;
  return 1;
}
