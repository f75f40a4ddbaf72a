// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual_quaternion/displacement.hpp>
#include <duet/kinematics/chain_walk.hpp>
#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/robot_description.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/exponential_jacobian.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

/// \file
/// The table of a kinematic tree: its construction from a description, and the traversal of the
/// tree from the reference frame to the frame of interest. For those who extend duet.

namespace duet {

namespace detail {

/// An elementary joint: one that rotates about an axis, translates along it or both, with one
/// coordinate; or spherical, with a rotation vector. A planar joint is two prismatic nodes and a
/// revolute one, a floating joint three prismatic nodes and a spherical one.
struct tree_node {
  int parent = -1;    ///< number of the parent node; −1: the root of the tree
  int coordinate = 0; ///< number of its first coordinate among those of all joints
  bool is_ball = false;
  joint_step<double> step{}; ///< for a spherical joint only its pose before the motion

  [[nodiscard]] int coordinates() const { return is_ball ? 3 : 1; }
};

/// True if the displacement is the identity.
[[nodiscard]] inline bool is_identity(const placement<double>& a) {
  const auto& [x, y, z] = a.translation;
  return a.rotation == quaternion<double>(1) && x == 0 && y == 0 && z == 0;
}

/// A frame fixed to a node.
struct frame_on_node {
  int node = -1; ///< number of the node; −1: the root of the tree
  placement<double> offset{};
};

/// A joint coordinate as multiplier × a coordinate of the tree + offset.
struct coordinate_source {
  int own = -1;
  double multiplier = 1;
  double offset = 0;
};

/// Mass and first moment of all that is fixed to a node, in its frame.
struct mass_on_node {
  double mass = 0;
  three_vector<double> moment{}; ///< Σ mass × centre
};

struct tree_table {
  std::vector<tree_node> nodes;             ///< nodes, parents first
  std::vector<mass_on_node> masses;         ///< masses of the root, then of each node
  std::vector<frame_on_node> links;         ///< node and offset of each link
  std::vector<coordinate_source> sources;   ///< sources of the coordinates of all joints
  std::vector<std::string> names;           ///< names of the coordinates of the tree
  std::vector<joint_limits<double>> limits; ///< limits of the coordinates of the tree
  std::unordered_map<std::string, int> link_numbers;
};

/// Image of e under the shortest rotation that takes z to n.
[[nodiscard]] inline three_vector<double> in_plane(const three_vector<double>& n,
                                                   const three_vector<double>& e) {
  return cleaned_direction(rotated(rotation_from_z(n), e));
}

/// Appends the nodes of a joint whose frame is at an offset of a node.
inline void add_nodes_of_joint(std::vector<tree_node>& nodes, const joint<double>& motion,
                               int coordinate, const frame_on_node& frame) {
  tree_node node{frame.node, coordinate};
  placement<double> origin = frame.offset;
  const auto add = [&](joint<double> part) {
    node.is_ball = part.kind == joint_kind::spherical;
    node.step = step_of(part, origin);
    nodes.push_back(node);
    origin = {};
    node.parent = int(nodes.size()) - 1;
    ++node.coordinate;
  };
  const auto add_prismatic = [&](const three_vector<double>& along) {
    add({.kind = joint_kind::prismatic, .axis = {along.x, along.y, along.z}});
  };
  if (motion.kind == joint_kind::planar) {
    const auto axis = components(motion.axis);
    const auto n = cleaned_direction(inverse_root_near_one(dot(axis, axis)) * axis);
    add_prismatic(in_plane(n, {1, 0, 0}));
    add_prismatic(in_plane(n, {0, 1, 0}));
    add({.kind = joint_kind::continuous, .axis = motion.axis});
  } else if (motion.kind == joint_kind::floating) {
    add_prismatic({1, 0, 0});
    add_prismatic({0, 1, 0});
    add_prismatic({0, 0, 1});
    add({.kind = joint_kind::spherical});
  } else {
    add(motion);
  }
}

/// Builds a table, in time proportional to the number of links.
class tree_builder {
public:
  /// \throws file_error, or invalid_input if the description is not from a file, if it does not
  /// describe a tree
  explicit tree_builder(const robot_description& robot) : robot_(robot) {
    find_links();
    find_joints();
    find_order();
    add_coordinates();
    follow_leaders();
    add_nodes();
    add_masses();
  }

  [[nodiscard]] tree_table table() && { return std::move(table_); }

private:
  [[nodiscard]] const tree_joint& joint_at(int j) const { return robot_.joints[std::size_t(j)]; }

  void find_links() {
    for (const tree_link& link : robot_.links) {
      require_part(table_.link_numbers.emplace(link.name, int(table_.link_numbers.size())).second,
                   robot_, link, "another link has this name");
    }
    if (robot_.links.empty()) {
      bad_robot(robot_, "the description has no links");
    }
  }

  [[nodiscard]] std::size_t link_of(const tree_joint& joint, const std::string& name) const {
    const auto found = table_.link_numbers.find(name);
    if (found == table_.link_numbers.end()) {
      bad_part(robot_, joint, "no link \"", name,
               "\": ", closest_names(name, names_of(robot_.links)));
    }
    return std::size_t(found->second);
  }

  void find_joints() {
    above_.assign(robot_.links.size(), -1);
    below_.resize(robot_.links.size());
    for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
      const tree_joint& joint = robot_.joints[j];
      require_part(joint_numbers_.emplace(joint.name, int(j)).second, robot_, joint,
                   "another joint has this name");
      require_joint(joint.motion, j, "kinematic_tree", joint.name);
      below_[link_of(joint, joint.parent)].push_back(int(j));
      int& above = above_[link_of(joint, joint.child)];
      if (above >= 0) {
        bad_part(robot_, joint, "the link \"", joint.child, "\" already has the parent joint \"",
                 joint_at(above).name, "\"");
      }
      above = int(j);
    }
  }

  /// Order of the joints from the root on, parents first.
  void find_order() {
    std::vector<std::size_t> links; // links reached so far
    for (std::size_t i = 0; i < above_.size(); ++i) {
      if (above_[i] < 0) {
        links.push_back(i);
        require_part(links.size() == 1, robot_, robot_.links[i],
                     "it is a second root, the first is \"", robot_.links[links[0]].name, "\"");
      }
    }
    for (std::size_t i = 0; i < links.size(); ++i) {
      for (const int j : below_[links[i]]) {
        order_.push_back(j);
        links.push_back(std::size_t(table_.link_numbers.at(joint_at(j).child)));
      }
    }
    if (links.size() < robot_.links.size()) {
      std::vector<char> is_reached(robot_.links.size(), 0);
      for (const std::size_t i : links) {
        is_reached[i] = 1;
      }
      auto i = std::size_t(std::find(is_reached.begin(), is_reached.end(), 0) - is_reached.begin());
      while (is_reached[i] == 0) { // up until the cycle is closed
        is_reached[i] = 1;
        i = std::size_t(table_.link_numbers.at(joint_at(above_[i]).parent));
      }
      bad_part(robot_, joint_at(above_[i]), "it closes a cycle at the link \"",
               robot_.links[i].name, "\"");
    }
  }

  /// Numbers of the joint coordinates, and those of the tree for joints that mimic none.
  void add_coordinates() {
    constexpr std::array<const char*, 6> free = {".x", ".y", ".z", ".rx", ".ry", ".rz"};
    constexpr std::array<const char*, 3> in_plane = {".x", ".y", ".angle"};
    for (const tree_joint& joint : robot_.joints) {
      const int count = joint.motion.coordinates();
      first_.push_back(int(table_.sources.size()));
      for (int k = 0; k < count; ++k) {
        if (joint.mimic) {
          table_.sources.push_back({});
          continue;
        }
        const auto at = std::size_t(k);
        table_.sources.push_back({int(table_.names.size())});
        table_.names.push_back(joint.name + (count == 1 ? ""
                                             : joint.motion.kind == joint_kind::planar
                                                 ? in_plane[at]
                                                 : free[count == 3 ? at + 3 : at]));
        table_.limits.push_back(count == 1 ? joint.motion.effective_limits()
                                           : joint_limits<double>{});
      }
    }
  }

  /// Expresses each joint that mimics another, possibly one that mimics a third, by a coordinate of
  /// the tree.
  void follow_leaders() {
    std::vector<char> is_open(robot_.joints.size(), 0);
    std::vector<int> open;
    for (std::size_t start = 0; start < robot_.joints.size(); ++start) {
      auto j = int(start);
      while (joint_at(j).mimic && joint_at(j).motion.kind != joint_kind::fixed &&
             source_of(j).own < 0) {
        require_part(is_open[std::size_t(j)] == 0, robot_, joint_at(j), "it mimics itself");
        is_open[std::size_t(j)] = 1;
        open.push_back(j);
        j = leader_of(j);
      }
      for (; !open.empty(); open.pop_back()) {
        follow(open.back(), source_of(j));
        j = open.back();
      }
    }
  }
  [[nodiscard]] coordinate_source& source_of(int j) {
    return table_.sources[std::size_t(first_[std::size_t(j)])];
  }
  [[nodiscard]] int leader_of(int j) const {
    const tree_joint& joint = joint_at(j);
    const auto found = joint_numbers_.find(joint.mimic->joint);
    if (found == joint_numbers_.end()) {
      bad_part(robot_, joint, "it mimics no joint \"", joint.mimic->joint,
               "\": ", closest_names(joint.mimic->joint, names_of(robot_.joints)));
    }
    for (const tree_joint* each : {&joint, &joint_at(found->second)}) {
      require_part(each->motion.coordinates() == 1, robot_, joint, "it mimics \"",
                   joint.mimic->joint, "\", but \"", each->name, "\" has ",
                   each->motion.coordinates(), " coordinates (expected 1)");
    }
    require_part(std::isfinite(joint.mimic->multiplier) && std::isfinite(joint.mimic->offset),
                 robot_, joint, "the multiplier or the offset of its mimic is not finite");
    return found->second;
  }
  void follow(int j, const coordinate_source& leader) {
    const tree_joint& joint = joint_at(j);
    const joint_mimic& by = *joint.mimic;
    const coordinate_source source{leader.own, by.multiplier * leader.multiplier,
                                   by.multiplier * leader.offset + by.offset};
    source_of(j) = source;
    const joint_limits<double> range = joint.motion.effective_limits();
    joint_limits<double>& limits = table_.limits[std::size_t(source.own)];
    bool is_possible = range.lower <= source.offset && source.offset <= range.upper;
    if (source.multiplier != 0) {
      const double a = (range.lower - source.offset) / source.multiplier;
      const double b = (range.upper - source.offset) / source.multiplier;
      limits.lower = std::max(limits.lower, std::min(a, b));
      limits.upper = std::min(limits.upper, std::max(a, b));
      limits.velocity = std::min(limits.velocity, range.velocity / std::abs(source.multiplier));
      is_possible = limits.lower <= limits.upper;
    }
    if (!is_possible) {
      bad_part(robot_, joint, "no coordinate of \"", by.joint, "\" satisfies its limits ",
               to_text(range.lower), " to ", to_text(range.upper));
    }
  }

  void add_nodes() {
    table_.links.resize(robot_.links.size());
    for (const int j : order_) {
      const tree_joint& joint = joint_at(j);
      const auto number = [&](const std::string& name) {
        return std::size_t(table_.link_numbers.at(name));
      };
      frame_on_node frame = table_.links[number(joint.parent)];
      frame.offset = frame.offset * joint.motion.origin;
      if (joint.motion.kind != joint_kind::fixed) {
        add_nodes_of_joint(table_.nodes, joint.motion, first_[std::size_t(j)], frame);
        frame = {int(table_.nodes.size()) - 1, {}};
      }
      table_.links[number(joint.child)] = frame;
    }
  }
  void add_masses() {
    table_.masses.resize(table_.nodes.size() + 1);
    for (std::size_t i = 0; i < robot_.links.size(); ++i) {
      if (const auto& inertia = robot_.links[i].inertia) {
        if (!(inertia->mass >= 0 && std::isfinite(inertia->mass))) {
          bad_part(robot_, robot_.links[i], "the mass is ", to_text(inertia->mass),
                   " (expected >= 0)");
        }
        const frame_on_node& frame = table_.links[i];
        mass_on_node& sum = table_.masses[std::size_t(frame.node + 1)];
        const auto centre = (frame.offset * inertia->frame).translation;
        sum.mass += inertia->mass;
        sum.moment = sum.moment + inertia->mass * components(centre);
      }
    }
  }

  const robot_description& robot_;
  tree_table table_;
  std::unordered_map<std::string_view, int> joint_numbers_;
  std::vector<int> above_;              ///< the joint above each link; −1: none
  std::vector<std::vector<int>> below_; ///< the joints below each link
  std::vector<int> order_;              ///< joint numbers, parents first
  std::vector<int> first_;              ///< number of the first coordinate of each joint
};

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

/// Joint coordinates as functions of those of the tree, or their velocities.
template <class S, class X, bool HasOffsets>
class joint_values {
public:
  joint_values(const tree_table& table, const X& q) : table_(table), q_(q) {
    require_size(table, q);
  }
  [[nodiscard]] S operator[](int k) const {
    const coordinate_source& s = table_.sources[std::size_t(k)];
    const S value(S(vector_argument<X>::get(q_, s.own)) * s.multiplier);
    return HasOffsets ? S(value + s.offset) : value;
  }

private:
  const tree_table& table_;
  const X& q_;
};
template <class S, class X>
using joint_coordinates = joint_values<S, X, true>;
template <class S, class V>
using joint_velocities = joint_values<S, V, false>;

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
          visit(coordinate, screw_of(step, axis, point));
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

/// A frame of a tree and its observer, relative to the node above both.
template <class S>
struct relative_frames {
  link_displacement<S> frame, observer;

  /// Pose of the frame relative to the observer.
  [[nodiscard]] dual_quaternion<S> pose() const {
    const quaternion<S> back = conj(observer.rotation);
    return pose_of_unit(back * frame.rotation,
                        rotated(back, frame.translation - observer.translation).eigen());
  }
  /// The frame whose axes the columns for `Frame` use.
  template <class Frame>
  [[nodiscard]] const link_displacement<S>& axes() const {
    return std::same_as<Frame, body_frame> ? frame : observer;
  }
  /// The origin at which the columns for `Frame` have their v.
  template <class Frame>
  [[nodiscard]] const link_displacement<S>& origin() const {
    return std::same_as<Frame, spatial_frame> ? observer : frame;
  }
};

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

} // namespace detail
} // namespace duet
