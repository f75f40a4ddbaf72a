// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/jacobian_rate.hpp>
#include <duet/kinematics/tree_motion.hpp>
#include <duet/kinematics/tree_table.hpp>
#include <duet/kinematics/tree_walk.hpp>
#include <duet/quaternion/exponential_jacobian.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <cstddef>
#include <vector>

/// \file
/// Time derivatives of the screws of a kinematic tree. For those who extend duet.

namespace duet::detail {

/// Time derivative of `left_jacobian(r)` along ṙ: with cₙ the Stumpff functions of s = r·r, whose
/// derivatives are cₙ′ = (n cₙ₊₂ − cₙ₊₁)/2,
/// r·ṙ ((c₃ − c₂) I + (2 c₄ − c₃) r̂ + (3 c₅ − c₄) r rᵀ) + c₂ ṙ̂ + c₃ (ṙ rᵀ + r ṙᵀ).
template <class S>
[[nodiscard]] matrix3<S> left_jacobian_rate(const vector3<S>& r, const vector3<S>& r_dot) {
  const auto c = stumpff_sequence<5>(S(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]));
  const S p = r[0] * r_dot[0] + r[1] * r_dot[1] + r[2] * r_dot[2];
  matrix3<S> result =
      axial_matrix<S>(p * (c[3] - c[2]), p * (2 * c[4] - c[3]), p * (3 * c[5] - c[4]), r) +
      axial_matrix<S>(S(0), c[2], S(0), r_dot);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      result(i, j) += c[3] * (r_dot[i] * r[j] + r[i] * r_dot[j]);
    }
  }
  return result;
}

template <class S>
[[nodiscard]] twist_column<S> sum(const twist_column<S>& a, const twist_column<S>& b) {
  return {a.v + b.v, a.omega + b.omega};
}
template <class S, class F>
[[nodiscard]] twist_column<S> multiple(const F& factor, const twist_column<S>& a) {
  return {factor * a.v, factor * a.omega};
}

/// Time derivatives of the screws of a motion, and the twists of its nodes.
template <class S>
struct tree_rates {
  std::vector<twist_column<S>> screws; ///< ṡ of each screw s
  std::vector<twist_column<S>> nodes;  ///< twist of each node

  /// Twist of the node at an index; zero for −1, the frame above the first node.
  [[nodiscard]] twist_column<S> node(int i) const {
    return i < 0 ? no_twist<S>() : nodes[std::size_t(i)];
  }
};

/// A screw is carried by the parent node of its joint, ad(V) s; the screws of a spherical joint
/// also change with its own coordinates.
template <class S, class X, class V>
[[nodiscard]] tree_rates<S> rates_of(const tree_table& table, const tree_motion<S>& motion,
                                     const X& x, const V& x_dot) {
  tree_rates<S> result;
  result.screws.reserve(motion.screws.size());
  result.nodes.reserve(motion.nodes.size());
  auto screw = motion.screws.begin();
  for (std::size_t i = 0; i < motion.nodes.size(); ++i) {
    const tree_node& node = table.nodes[std::size_t(motion.nodes[i])];
    const twist_column<S> before = result.node(motion.before[i]);
    twist_column<S> after = before;
    matrix3<S> j_rate;
    link_displacement<S> origin;
    if (node.is_ball) {
      origin = origin_of_ball(motion.frame(motion.before[i]), node);
      j_rate =
          left_jacobian_rate<S>(ball_coordinates<S>(node, x), ball_coordinates<S>(node, x_dot));
    }
    for (int k = 0; k < node.coordinates(); ++k, ++screw) {
      const twist_column<S>& twist = screw->twist;
      twist_column<S> rate = bracket(before, twist);
      if (node.is_ball) {
        const three_vector<S> omega =
            rotated(origin.rotation, three_vector<S>{j_rate(0, k), j_rate(1, k), j_rate(2, k)});
        rate = sum(rate, {cross(origin.translation, omega), omega});
      }
      result.screws.push_back(rate);
      after = sum(after, multiple(S(x_dot[screw->coordinate]), twist));
    }
    result.nodes.push_back(after);
  }
  return result;
}

} // namespace duet::detail
