// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual_quaternion/displacement.hpp>
#include <duet/mechanism/chain_walk.hpp>
#include <duet/mechanism/jacobian.hpp>
#include <duet/mechanism/joint_step.hpp>
#include <duet/mechanism/tree_table.hpp>
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

template <class S>
[[nodiscard]] link_displacement<S> standing_still() {
  return {quaternion<S>(S(1)), {S(0), S(0), S(0)}};
}

/// Where the frame of a ball stands before its motion.
template <class S>
[[nodiscard]] link_displacement<S> origin_of_ball(const link_displacement<S>& parent,
                                                  const tree_node& node) {
  return {parent.rotation * node.step.a, parent.point(node.step.offset)};
}

/// Where the frame of a node stands after its motion.
///
/// \param visit  called with the number of each coordinate of the node and its screw: twists of all
///               that the node carries, per unit of it, with v at the origin; or `visit_nothing`
template <class S, class X, class Turns, class Visit>
[[nodiscard]] link_displacement<S> after_node(const link_displacement<S>& parent,
                                              const tree_node& node, const X& x, int turn,
                                              const S& theta, const Turns& turns_of,
                                              const Visit& visit) {
  constexpr bool is_visited = !std::same_as<Visit, decltype(visit_nothing)>;
  if (node.is_ball) {
    link_displacement<S> result = origin_of_ball(parent, node);
    const vector3<S> r = ball_coordinates<S>(node, x);
    if constexpr (is_visited) {
      const matrix3<S> j = left_jacobian(r);
      for (int k = 0; k < 3; ++k) {
        const auto omega = rotated(result.rotation, three_vector<S>{j(0, k), j(1, k), j(2, k)});
        visit(node.coordinate + k, twist_column<S>{cross(result.translation, omega), omega});
      }
    }
    result.rotation = result.rotation * duet::exp(vector3<S>(r[0] / 2, r[1] / 2, r[2] / 2));
    return result;
  }
  const auto visit_axis = [&](Eigen::Index, const auto& step, const auto& axis, const auto& point) {
    if constexpr (is_visited) {
      twist_column<S> screw = no_twist<S>();
      if (step.turns()) {
        screw = {cross(point, axis), axis};
      }
      if (step.slides()) {
        screw.v = screw.v + S(step.pitch()) * axis;
      }
      visit(node.coordinate, screw);
    }
  };
  return after_joint<true>(parent, step_in_memory<double>{node.step}, turn, theta, turns_of,
                           visit_axis);
}

/// Calls `after(i, node, turn, θ, turns)` for nodes by their places in a list, whose sines are
/// taken some at a time.
///
/// \param node_at  the number of the node at a place
template <class S, class X, class NodeAt, class After>
void for_each_node(const tree_table& table, const X& x, int count, const NodeAt& node_at,
                   const After& after) {
  constexpr int most = 4;
  for (int first = 0; first < count; first += most) {
    const int some = std::min(most, count - first);
    const auto node = [&](int k) -> const tree_node& {
      return table.nodes[std::size_t(node_at(first + k))];
    };
    std::array<S, most> theta{};
    for (int k = 0; k < some; ++k) {
      if (!node(k).is_ball) {
        theta[std::size_t(k)] = x[node(k).coordinate];
      }
    }
    const half_turns<S, most, std::array<S, most>> turns_of(theta, most, some);
    for (int k = 0; k < some; ++k) {
      after(first + k, node(k), k, theta[std::size_t(k)], turns_of);
    }
  }
}

/// The numbers of the nodes from one `top` down to one below it; a few without heap.
class node_path {
public:
  node_path(const tree_table& table, int node, int top) {
    const auto above = [&](int k) { return table.nodes[std::size_t(k)].parent; };
    for (int k = node; k != top; k = above(k)) {
      ++size_;
    }
    if (std::size_t(size_) > few_.size()) {
      many_.resize(std::size_t(size_));
    }
    int* end = (many_.empty() ? few_.data() : many_.data()) + size_;
    for (int k = node; k != top; k = above(k)) {
      *--end = k;
    }
  }

  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] int operator()(int i) const {
    return many_.empty() ? few_[std::size_t(i)] : many_[std::size_t(i)];
  }

private:
  int size_ = 0;
  std::array<int, 32> few_; // those beyond size_ are not set
  std::vector<int> many_;
};

/// Where the last node of a path stands in the frame of what is above it. \param visit as of
/// `after_node`
template <class S, class X, class Visit>
[[nodiscard]] link_displacement<S> walk_down(const tree_table& table, const X& x,
                                             const node_path& path, const Visit& visit) {
  link_displacement<S> result = standing_still<S>();
  for_each_node<S>(table, x, path.size(), path,
                   [&](int, const tree_node& node, int turn, const S& theta, const auto& turns_of) {
                     result = after_node(result, node, x, turn, theta, turns_of, visit);
                   });
  return result;
}

/// Where all nodes stand.
template <class S, class X>
[[nodiscard]] std::vector<link_displacement<S>> frames_of_all(const tree_table& table, const X& x) {
  const link_displacement<S> root = standing_still<S>();
  std::vector<link_displacement<S>> result;
  result.reserve(table.nodes.size());
  for_each_node<S>(
      table, x, int(table.nodes.size()), [](int i) { return i; },
      [&](int, const tree_node& node, int turn, const S& theta, const auto& turns_of) {
        const auto& parent = node.parent < 0 ? root : result[std::size_t(node.parent)];
        result.push_back(after_node(parent, node, x, turn, theta, turns_of, visit_nothing));
      });
  return result;
}

} // namespace duet::detail
