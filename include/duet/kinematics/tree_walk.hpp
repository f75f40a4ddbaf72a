// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual_quaternion/displacement.hpp>
#include <duet/kinematics/chain_walk.hpp>
#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/joint_step.hpp>
#include <duet/kinematics/tree_table.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/exponential_jacobian.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <vector>

/// \file
/// Traversal of a kinematic tree from the reference frame to the frame of interest. For those who
/// extend duet.

namespace duet::detail {

/// The scalar of a tree's results at a configuration of type X.
template <class X>
using tree_scalar = promote_t<double, typename vector_argument<X>::scalar>;

template <class X>
void require_size(const tree_table& table, const X& q) {
  const auto size = Eigen::Index(table.names.size());
  require(vector_argument<X>::size(q) == size,
          "duet: kinematic_tree: ", vector_argument<X>::size(q), " coordinates (expected ", size,
          ")");
}

/// Joint coordinates as functions of those of the tree.
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

/// Velocities of the joint coordinates.
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
/// Velocities of the joint coordinates if one coordinate of the tree has velocity 1 and the others
/// are at rest.
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

/// Rotation vector of a spherical joint.
template <class S, class X>
[[nodiscard]] vector3<S> ball_coordinates(const tree_node& node, const X& x) {
  return {S(x[node.coordinate]), S(x[node.coordinate + 1]), S(x[node.coordinate + 2])};
}

template <class S>
[[nodiscard]] link_displacement<S> identity_displacement() {
  return {quaternion<S>(S(1)), {S(0), S(0), S(0)}};
}

/// Frame of a spherical joint before its motion.
template <class S>
[[nodiscard]] link_displacement<S> origin_of_ball(const link_displacement<S>& parent,
                                                  const tree_node& node) {
  return {parent.rotation * node.step.a, parent.point(node.step.offset)};
}

/// Frame of a spherical joint after its motion.
///
/// \param visit  as for `for_each_node`
template <class S, class X, class Visit>
[[nodiscard]] link_displacement<S> after_ball(const link_displacement<S>& parent,
                                              const tree_node& node, const X& x,
                                              const Visit& visit) {
  link_displacement<S> result = origin_of_ball(parent, node);
  const vector3<S> r = ball_coordinates<S>(node, x);
  if constexpr (!std::same_as<Visit, decltype(visit_nothing)>) {
    const matrix3<S> j = left_jacobian(r);
    for (int k = 0; k < 3; ++k) {
      const auto omega = rotated(result.rotation, three_vector<S>{j(0, k), j(1, k), j(2, k)});
      visit(node.coordinate + k, twist_column<S>{cross(result.translation, omega), omega});
    }
  }
  result.rotation = result.rotation * duet::exp(vector3<S>(r[0] / 2, r[1] / 2, r[2] / 2));
  return result;
}

/// Calls `after(node, move)` for the nodes of a list, where `move(A)` returns the frame of the node
/// for the frame A of its parent. Sines are evaluated several at once.
///
/// \param node_at  returns the number of the node at an index of the list
/// \param visit    called with the number of each coordinate and its screw, the twist of all that
///                 the node carries per unit of the coordinate, with v at the origin; or
///                 `visit_nothing`
template <class S, class X, class NodeAt, class Visit, class After>
DUET_ALWAYS_INLINE void for_each_node(const tree_table& table, const X& x, int count,
                                      const NodeAt& node_at, const Visit& visit,
                                      const After& after) {
  const auto node = [&](int i) DUET_INLINE_LAMBDA -> const tree_node& {
    return table.nodes[std::size_t(node_at(i))];
  };
  constexpr int max_count = 16;
  for (int i = 0; i < count;) {
    // All nodes up to the next spherical joint: with a branch for these inside the loop, one in
    // five took longer.
    std::array<S, max_count> theta;
    int some = 0;
    for (; some < max_count && i + some < count && !node(i + some).is_ball; ++some) {
      theta[std::size_t(some)] = x[node(i + some).coordinate];
    }
    const half_angle_sincos<S, -max_count, std::array<S, max_count>> half_angles(theta, some, some);
    for (int k = 0; k < some; ++k, ++i) {
      const int coordinate = node(i).coordinate;
      const auto put_screw = [&](Eigen::Index, const auto& step, const auto& axis,
                                 const auto& point) DUET_INLINE_LAMBDA {
        if constexpr (!std::same_as<Visit, decltype(visit_nothing)>) {
          twist_column<S> screw = no_twist<S>();
          if (step.is_rotational()) {
            screw = {cross(point, axis), axis};
          }
          if (step.is_translational()) {
            screw.v = screw.v + step.pitch() * axis;
          }
          visit(coordinate, screw);
        }
      };
      after(node(i), [&](const link_displacement<S>& parent) DUET_INLINE_LAMBDA {
        return link_displacement<S>(after_joint<true>(parent, step_in_memory<double>{node(i).step},
                                                      k, theta[std::size_t(k)], half_angles,
                                                      put_screw));
      });
    }
    if (i < count && node(i).is_ball) {
      after(node(i), [&](link_displacement<S> parent)
                         DUET_INLINE_LAMBDA { return after_ball(parent, node(i), x, visit); });
      ++i;
    }
  }
}

/// Numbers of the nodes from one below `top` down to a node; short paths use no heap memory.
class node_path {
public:
  node_path(const tree_table& table, int node, int top) {
    const auto above = [&](int k) { return table.nodes[std::size_t(k)].parent; };
    int* first = few_.data() + few_.size();
    for (; node != top && first != few_.data(); node = above(node)) {
      *--first = node;
    }
    begin_ = first;
    size_ = int(few_.data() + few_.size() - first);
    if (node != top) {
      many_.assign(few_.rbegin(), few_.rend());
      for (; node != top; node = above(node)) {
        many_.push_back(node);
      }
      std::reverse(many_.begin(), many_.end());
      begin_ = many_.data();
      size_ = int(many_.size());
    }
  }
  node_path(const node_path&) = delete;
  node_path& operator=(const node_path&) = delete;

  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] const int* begin() const { return begin_; }
  [[nodiscard]] const int* end() const { return begin_ + size_; }

private:
  int size_;
  const int* begin_;
  std::array<int, 32> few_; // its last elements are set
  std::vector<int> many_;
};

/// Frame of the last node of a path relative to the frame above it.
///
/// \param visit  as for `for_each_node`
template <class S, class X, class Visit>
[[nodiscard]] DUET_ALWAYS_INLINE link_displacement<S>
walk_down(const tree_table& table, const X& x, const node_path& path, const Visit& visit) {
  link_displacement<S> result = identity_displacement<S>();
  const int* nodes = path.begin();
  for_each_node<S>(
      table, x, path.size(), [&](int i) { return nodes[i]; }, visit,
      [&](const tree_node&, const auto& move) DUET_INLINE_LAMBDA { result = move(result); });
  return result;
}

/// Frames of all nodes.
template <class S, class X>
[[nodiscard]] std::vector<link_displacement<S>> frames_of_all(const tree_table& table, const X& x) {
  const link_displacement<S> root = identity_displacement<S>();
  std::vector<link_displacement<S>> result;
  result.reserve(table.nodes.size());
  for_each_node<S>(
      table, x, int(table.nodes.size()), [](int i) { return i; }, visit_nothing,
      [&](const tree_node& node, const auto& move) DUET_INLINE_LAMBDA {
        result.push_back(move(node.parent < 0 ? root : result[std::size_t(node.parent)]));
      });
  return result;
}

} // namespace duet::detail
