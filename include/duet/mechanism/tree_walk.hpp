// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual/rules/lift.hpp>
#include <duet/dual_quaternion/displacement.hpp>
#include <duet/mechanism/chain_walk.hpp>
#include <duet/mechanism/jacobian.hpp>
#include <duet/mechanism/tree_table.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/exponential_jacobian.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <vector>

/// \file
/// Along a tree, from what stands still to what is asked for. For those who extend duet.

namespace duet::detail {

/// The scalar of a tree's results at coordinates X.
template <class X>
using tree_scalar = promote_t<double, typename vector_argument<X>::scalar>;

template <class X>
void require_size(const tree_table& table, const X& q) {
  const auto size = Eigen::Index(table.names.size());
  require(vector_argument<X>::size(q) == size, "duet: a tree of ", size, " coordinates, but ",
          vector_argument<X>::size(q), " are given");
}

/// Coordinates of the joints, by those of the tree.
template <class S, class X>
class joint_coordinates {
public:
  joint_coordinates(const tree_table& table, const X& q) : table_(table), q_(q) {
    require_size(table, q);
  }
  [[nodiscard]] S operator[](int k) const {
    const coordinate_source& s = table_.sources[std::size_t(k)];
    return S(S(vector_argument<X>::get(q_, s.own)) * s.multiplier + s.offset);
  }

private:
  const tree_table& table_;
  const X& q_;
};

/// Rates of the coordinates of the joints.
template <class S, class V>
class joint_velocities {
public:
  joint_velocities(const tree_table& table, const V& v) : table_(table), v_(v) {
    require_size(table, v);
  }
  [[nodiscard]] S operator[](int k) const {
    const coordinate_source& s = table_.sources[std::size_t(k)];
    return S(S(vector_argument<V>::get(v_, s.own)) * s.multiplier);
  }

private:
  const tree_table& table_;
  const V& v_;
};
/// The rate of one coordinate of the tree is 1, those of the others are 0.
class unit_velocities {
public:
  unit_velocities(const tree_table& table, Eigen::Index own) : table_(table), own_(own) {}
  [[nodiscard]] double operator[](int k) const {
    const coordinate_source& s = table_.sources[std::size_t(k)];
    return s.own == own_ ? s.multiplier : 0;
  }

private:
  const tree_table& table_;
  Eigen::Index own_;
};

/// The rotation vector of a ball.
template <class S, class X>
[[nodiscard]] vector3<S> ball_coordinates(const tree_node& node, const X& x) {
  return {S(x[node.coordinate]), S(x[node.coordinate + 1]), S(x[node.coordinate + 2])};
}

/// Where the frame of a node stands after its motion.
template <class S, class X>
[[nodiscard]] link_displacement<S> moved(link_displacement<S> origin, const tree_node& node,
                                         const X& x) {
  if (node.is_ball) {
    const vector3<S> r = ball_coordinates<S>(node, x);
    origin.rotation = origin.rotation * duet::exp(vector3<S>(r[0] / 2, r[1] / 2, r[2] / 2));
    return origin;
  }
  const S theta = x[node.coordinate];
  const three_vector<double>& n = node.axis;
  if (node.slides) {
    const S way = theta * node.pitch;
    origin.translation = origin.point(three_vector<S>{way * n.x, way * n.y, way * n.z});
  }
  if (node.turns) {
    const sine_cosine<S> half = sine_and_cosine_of(S(theta / 2));
    origin.rotation = origin.rotation *
                      quaternion<S>(half.cosine, half.sine * n.x, half.sine * n.y, half.sine * n.z);
  }
  return origin;
}

template <class S>
[[nodiscard]] link_displacement<S> standing_still(const placement<double>& at = {}) {
  const auto& t = at.translation;
  return {quaternion<S>(at.rotation), {S(t[0]), S(t[1]), S(t[2])}};
}

/// Where a place stands in the frame of a node `top` above it.
template <class S, class X>
[[nodiscard]] link_displacement<S> displacement_below(const tree_table& table, const X& x,
                                                      const place_on_node& place, int top) {
  link_displacement<S> result = standing_still<S>(place.offset);
  for (int k = place.node; k != top;) {
    const tree_node& node = table.nodes[std::size_t(k)];
    result = moved<S>(standing_still<S>(node.origin), node, x) * result;
    k = node.parent;
  }
  return result;
}

/// The screw of a coordinate of a joint: twists of all that the joint carries, per unit of it.
template <class S>
struct tree_screw {
  int at;         ///< of which of the nodes walked over
  int coordinate; ///< of the joints
  twist_column<S> twist;
};

/// Some nodes of a tree, parents first, where they stand in the frame of what is above the first of
/// them, and the screws of their coordinates: with v at the origin of that frame.
template <class S>
struct tree_motion {
  std::vector<int> nodes;
  std::vector<int> before; ///< what each hangs on, by its place here; −1: on what is above
  std::vector<link_displacement<S>> origins; ///< before the motion of each node
  std::vector<link_displacement<S>> frames;  ///< after it
  std::vector<tree_screw<S>> screws;

  template <class X>
  void follow(const tree_table& table, const X& x) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const tree_node& node = table.nodes[std::size_t(nodes[i])];
      origins.push_back(before[i] < 0 ? standing_still<S>(node.origin)
                                      : attached(frames[std::size_t(before[i])], node.origin));
      const link_displacement<S>& origin = origins.back();
      frames.push_back(moved<S>(origin, node, x));
      if (node.is_ball) {
        const matrix3<S> j = left_jacobian(ball_coordinates<S>(node, x));
        for (int k = 0; k < 3; ++k) {
          const auto omega = rotated(origin.rotation, three_vector<S>{j(0, k), j(1, k), j(2, k)});
          screws.push_back(
              {int(i), node.coordinate + k, {cross(origin.translation, omega), omega}});
        }
      } else {
        const three_vector<S> axis = rotated(origin.rotation, node.axis);
        twist_column<S> twist = no_twist<S>();
        if (node.turns) {
          twist = {cross(origin.translation, axis), axis};
        }
        if (node.slides) {
          twist.v = twist.v + S(node.pitch) * axis;
        }
        screws.push_back({int(i), node.coordinate, twist});
      }
    }
  }
};

/// From a node `top` down to a node below it.
template <class S, class X>
[[nodiscard]] tree_motion<S> motion_to(const tree_table& table, const X& x, int node, int top) {
  tree_motion<S> result;
  for (int k = node; k != top; k = table.nodes[std::size_t(k)].parent) {
    result.nodes.push_back(k);
    result.before.push_back(int(result.before.size()) - 1);
  }
  std::reverse(result.nodes.begin(), result.nodes.end());
  result.follow(table, x);
  return result;
}

/// Of the whole tree.
template <class S, class X>
[[nodiscard]] tree_motion<S> motion_of_all(const tree_table& table, const X& x) {
  tree_motion<S> result;
  for (std::size_t k = 0; k < table.nodes.size(); ++k) {
    result.nodes.push_back(int(k));
    result.before.push_back(table.nodes[k].parent);
  }
  result.follow(table, x);
  return result;
}

} // namespace duet::detail
