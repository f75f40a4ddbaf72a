// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/serial_chain.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <array>
#include <cstddef>
#include <limits>

/// \file
/// Chains as products of exponentials of joint screws.

namespace duet {

/// The axis of a joint as a screw l + ε(m + pitch l) in the base frame at θ = 0: unit direction l,
/// moment m = point × l. A prismatic joint along n has l = 0 and n instead of m.
template <class T = double>
struct joint_screw {
  std::array<T, 3> direction;  ///< l, a unit vector, or zero for a prismatic joint
  std::array<T, 3> moment;     ///< m + pitch l, in units of length
  joint_limits<T> limits = {}; ///< limits of the coordinate

  constexpr joint_screw(const std::array<T, 3>& l, const std::array<T, 3>& m,
                        const joint_limits<T>& given_limits = {})
      : direction(l), moment(m), limits(given_limits) {}
  joint_screw(const dual_vector<T>& s, const joint_limits<T>& given_limits = {})
      : direction{s[0].value(), s[1].value(), s[2].value()}, moment{s[0].epsilon(), s[1].epsilon(),
                                                                    s[2].epsilon()},
        limits(given_limits) {}
};

/// The chain with forward kinematics by the product of exponentials, exp(½θ_1 S_1) … exp(½θ_n S_n)
/// M, with the joint screws S_i and the pose M of the tip at θ = 0. Link frames coincide with the
/// base frame at θ = 0.
///
/// \throws invalid_input as `serial_chain`
template <class T, std::size_t N>
[[nodiscard]] constexpr serial_chain<int(N), T>
from_screws(const std::array<joint_screw<T>, N>& screws, const placement<T>& tip = {}) {
  std::array<joint<T>, N> joints{};
  std::array<placement<T>, N> link_frames{};
  detail::three_vector<T> before{};
  for (std::size_t i = 0; i < N; ++i) {
    const auto l = detail::components(screws[i].direction);
    const auto m = detail::components(screws[i].moment);
    // The joint's frame: axes of the base at the point l × m, the point of the axis nearest to the
    // origin of the base.
    detail::three_vector<T> point{};
    if (dot(l, l) == 0) {
      joints[i].kind = joint_kind::prismatic;
      joints[i].axis = m;
    } else {
      joints[i].axis = l;
      point = cross(l, m);
      joints[i].pitch = dot(l, m);
      // Round-off of a moment is not a pitch.
      const T noise = 64 * std::numeric_limits<T>::epsilon();
      if (joints[i].pitch * joints[i].pitch > noise * noise * (1 + dot(m, m))) {
        joints[i].kind = joint_kind::helical;
      }
    }
    joints[i].origin.translation = point - before;
    joints[i].limits = screws[i].limits;
    link_frames[i].translation = T(-1) * point;
    before = point;
  }
  return serial_chain<int(N), T>(joints, link_frames[N - 1] * tip, link_frames);
}

} // namespace duet
