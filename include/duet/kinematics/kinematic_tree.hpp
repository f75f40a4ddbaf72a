// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual_quaternion/displacement.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/kinematics/chain_walk.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/robot_description.hpp>
#include <duet/kinematics/tree_table.hpp>
#include <duet/kinematics/urdf_chain.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// \file
/// Kinematic trees of links and joints, and their forward kinematics.

namespace duet {

/// A frame on a link of a tree relative to an observer frame on another link. `pose`, `jacobian`
/// and the other functions of trees take it instead of a frame.
///
/// Example: `tree.pose(q, relative_frame{tree.link("hand"), tree.link("head")})`
struct relative_frame {
  attached_frame<double> frame;    ///< the observed frame
  attached_frame<double> observer; ///< the frame of the observer, which replaces the root
};

/// A frame argument of a function of a tree: a link number, a frame on a link, or a frame relative
/// to another one.
template <class At>
concept FrameOnTree = std::integral<At> || std::same_as<At, attached_frame<double>> ||
    std::same_as<At, relative_frame>;

namespace detail {

/// Frames of interest of a function of a tree, and the node above both; −1 is the root.
struct tree_view {
  frame_on_node frame;
  frame_on_node observer;
  int top = -1;
  bool is_from_above = true; ///< true if the observer is the frame of the node above
};

} // namespace detail

/// A kinematic tree: a root link, and links of which each is connected to one parent link by
/// one joint.
///
/// Joints have 0 to 6 coordinates: none if fixed; x, y and the angle of a planar joint, which
/// translates perpendicular to its axis n along e_x and e_y, carried by the shortest rotation from
/// e_z to n (a half turn about x to −e_z), then rotates about n; the rotation vector of a spherical
/// joint; x, y, z and the rotation vector of a floating joint, which translates first, then
/// rotates. Coordinates of a joint that mimics another are multiples of a coordinate of that joint
/// and no coordinates of the tree. All others are, in the order of the description, in radians and
/// units of length.
///
/// Links are numbered from 0, as in `links()`. A configuration q is an Eigen vector, `std::array`
/// or `std::vector` over any scalar. Limits are stored, narrowed by those of joints that mimic;
/// they are not enforced. Work on one frame takes time proportional to the number of joints between
/// it and the root (or the observer); the depth of the tree is not limited.
class kinematic_tree {
public:
  using scalar_type = double;
  using own_jacobian = void;

  /// \throws invalid_input (`file_error` with the line if the description is from a file) if two
  /// links or two joints have the same name; a link does not exist, has two parent joints, or is a
  /// second root; joints close a cycle; a number is invalid; a joint mimics a joint that does not
  /// exist, itself, or one with several coordinates; or limits leave no motion
  explicit kinematic_tree(robot_description robot)
      : description_(std::move(robot)), table_(detail::tree_builder(description_).table()) {}

  /// Number of coordinates.
  [[nodiscard]] int size() const { return int(table_.names.size()); }
  /// Names of the coordinates: those of their joints; `name.x`, `name.angle`, `name.rx` … for
  /// joints with several coordinates.
  [[nodiscard]] const std::vector<std::string>& coordinate_names() const { return table_.names; }
  /// The number of a coordinate, by its name.
  ///
  /// \throws invalid_input if no coordinate has that name
  [[nodiscard]] int coordinate(std::string_view name) const {
    const auto found = std::find(table_.names.begin(), table_.names.end(), name);
    if (found == table_.names.end()) {
      detail::unknown_name("kinematic_tree", "coordinate", name, table_.names);
    }
    return int(found - table_.names.begin());
  }
  /// Limits of coordinate i; within them joints that mimic it are within their limits, too.
  [[nodiscard]] const joint_limits<double>& limits(int i) const {
    return table_.limits[std::size_t(i)];
  }
  /// All links, fixed ones included.
  [[nodiscard]] const std::vector<tree_link>& links() const { return description_.links; }
  /// All joints, fixed ones included.
  [[nodiscard]] const std::vector<tree_joint>& joints() const { return description_.joints; }
  /// The description from which the tree was made.
  [[nodiscard]] const robot_description& description() const { return description_; }
  /// The frame of link i.
  ///
  /// \throws invalid_input for i outside `links()`
  [[nodiscard]] attached_frame<double> link(int i) const {
    detail::require(0 <= i && i < int(links().size()), "duet: kinematic_tree: link ", i,
                    " does not exist, the tree has ", links().size(), " links");
    return {i, {}};
  }
  /// The frame of a link, by its name.
  ///
  /// \throws invalid_input if no link has that name
  [[nodiscard]] attached_frame<double> link(std::string_view name) const {
    const auto found = table_.link_numbers.find(std::string(name));
    if (found == table_.link_numbers.end()) {
      detail::unknown_name("kinematic_tree", "link", name, detail::names_of(links()));
    }
    return {found->second, {}};
  }

  /// Forward kinematics: the pose at the configuration q of a link number, an `attached_frame` such
  /// as an end-effector frame, or a `relative_frame`, in the frame of the root or of the observer.
  ///
  /// \throws invalid_input if the number of coordinates differs from `size()`, or the link
  /// does not exist
  template <VectorLike X, FrameOnTree At>
  [[nodiscard]] auto pose(const X& q, const At& at) const {
    using S = detail::tree_scalar<X>;
    const detail::tree_view view = this->view(at);
    const detail::joint_coordinates<S, X> x(table_, q);
    const auto displacement_of = [&](const detail::frame_on_node& frame) {
      const detail::node_path path(table_, frame.node, view.top);
      return detail::attached(detail::walk_down<S>(table_, x, path, detail::visit_nothing),
                              frame.offset);
    };
    const detail::link_displacement<S> frame = displacement_of(view.frame);
    if constexpr (std::same_as<At, relative_frame>) {
      return detail::relative_frames<S>{frame, displacement_of(view.observer)}.pose();
    } else {
      return detail::pose_of_unit(frame.rotation, frame.translation.eigen());
    }
  }

  /// Forward kinematics of all links at the configuration q, in the order of
  /// `links()`, in one pass.
  ///
  /// \return a `std::vector` of poses
  /// \throws invalid_input if the number of coordinates differs from `size()`
  template <VectorLike X>
  [[nodiscard]] auto poses(const X& q) const {
    using S = detail::tree_scalar<X>;
    const detail::joint_coordinates<S, X> x(table_, q);
    const auto root = detail::identity_displacement<S>();
    const auto frames = detail::frames_of_all<S>(table_, x);
    std::vector<dual_quaternion<S>> result;
    result.reserve(table_.links.size());
    for (const detail::frame_on_node& link : table_.links) {
      const auto& node = link.node < 0 ? root : frames[std::size_t(link.node)];
      const auto at = detail::is_identity(link.offset) ? node : detail::attached(node, link.offset);
      result.push_back(detail::pose_of_unit(at.rotation, at.translation.eigen()));
    }
    return result;
  }
  template <class... X>
    requires(detail::is_matrix_argument<X> || ...)
  DUET_REFUSED("pose takes the coordinates of one configuration: tree.pose(qs.col(i), link)")
  dual_quaternion<double> pose(const X&...) const;

  /// The serial chain from one link to another, both by their names, with the joint limits of the
  /// description. Joints that lead up, from the base to the lowest common ancestor, rotate about or
  /// translate along the opposite of their axes, so that coordinates keep their meaning.
  ///
  /// \tparam Capacity  maximum number of moving joints
  /// \throws invalid_input for links that do not exist, too many joints, and joints between the two
  /// links that have several coordinates or mimic others
  template <int Capacity = 16>
  [[nodiscard]] urdf_chain<Capacity> chain(const std::string& base, const std::string& tip) const {
    (void)link(base);
    (void)link(tip);
    return urdf_chain<Capacity>(
        detail::chain_contents(description_, base, tip, std::size_t(Capacity)));
  }

  // For those who extend duet.

  /// The table used for evaluation.
  [[nodiscard]] const detail::tree_table& table() const { return table_; }
  /// Replaces the limits of coordinate i, without checks. A `continuous` joint that gets a bound
  /// becomes `revolute`.
  void set_limits(int i, const joint_limits<double>& limits) {
    table_.limits[std::size_t(i)] = limits;
    for (tree_joint& joint : description_.joints) {
      const int count = joint.mimic ? 0 : joint.motion.coordinates();
      if (i == 0 && count == 1) {
        joint.motion.kind = detail::kind_within(joint.motion.kind, limits);
        joint.motion.limits = limits;
      }
      i -= count;
    }
  }
  /// The node and offset of a frame.
  [[nodiscard]] detail::frame_on_node node_frame(const attached_frame<double>& at) const {
    detail::frame_on_node result = table_.links[std::size_t(link(at.link).link)];
    if (!detail::is_identity(at.offset)) {
      result.offset = result.offset * at.offset;
    }
    return result;
  }
  /// The link path between a frame and its observer.
  template <FrameOnTree At>
  [[nodiscard]] detail::tree_view view(const At& at) const {
    if constexpr (std::integral<At>) {
      return {table_.links[std::size_t(link(int(at)).link)], {}};
    } else if constexpr (std::same_as<At, attached_frame<double>>) {
      return {node_frame(at), {}};
    } else {
      const detail::tree_view result{node_frame(at.frame), node_frame(at.observer), -1, false};
      int a = result.frame.node;
      int b = result.observer.node;
      while (a != b) { // parents have lower numbers
        int& lower = a > b ? a : b;
        lower = table_.nodes[std::size_t(lower)].parent;
      }
      return {result.frame, result.observer, a, false};
    }
  }

private:
  robot_description description_;
  detail::tree_table table_;
};

} // namespace duet
