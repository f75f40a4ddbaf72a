// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/robot_contents.hpp>
#include <duet/kinematics/serial_chain.hpp>

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// \file
/// Serial chains with names of joints and links.

namespace duet {

/// A chain from a robot description, with the names of its joints and links.
///
/// \tparam Capacity  maximum number of moving joints
template <int Capacity>
class urdf_chain : public serial_chain<-Capacity> {
public:
  urdf_chain(const serial_chain<-Capacity>& chain, std::vector<std::string> joint_names,
             std::vector<urdf_link> links, std::vector<urdf_unknown_element> unknown = {})
      : serial_chain<-Capacity>(chain), joint_names_(std::move(joint_names)),
        links_(std::move(links)), unknown_(std::move(unknown)) {}

  /// For those who extend duet: the chain of the contents of a file.
  explicit urdf_chain(detail::urdf_contents read)
      : urdf_chain(serial_chain<-Capacity>(std::span<const joint<double>>(read.joints)),
                   std::move(read.joint_names), std::move(read.links), std::move(read.unknown)) {}
  /// For those who extend duet: another chain without joint i, whose link stays at `locked`.
  urdf_chain(const urdf_chain& other, int i, const placement<double>& locked)
      : serial_chain<-Capacity>(other, i, locked), joint_names_(other.joint_names_),
        links_(other.links_), unknown_(other.unknown_) {
    joint_names_.erase(joint_names_.begin() + i);
    for (urdf_link& each : links_) {
      if (each.frame.link == i + 1) {
        each.frame.offset = locked * each.frame.offset;
      }
      each.frame.link -= each.frame.link > i ? 1 : 0;
    }
  }

  using serial_chain<-Capacity>::link;
  /// The frame of a link by its name, including links that are fixed to another one.
  ///
  /// \throws invalid_input if the chain has no link of that name
  [[nodiscard]] attached_frame<double> link(std::string_view name) const {
    const auto found = std::find_if(links_.begin(), links_.end(),
                                    [&](const urdf_link& each) { return each.name == name; });
    if (found == links_.end()) {
      std::vector<std::string> names;
      for (const urdf_link& each : links_) {
        names.push_back(each.name);
      }
      detail::raise(invalid_input(printable("duet: urdf_chain: no link \"" + std::string(name) +
                                            "\": " + detail::closest_names(name, names))));
    }
    return found->frame;
  }
  /// Names of the moving joints, in order.
  [[nodiscard]] const std::vector<std::string>& joint_names() const { return joint_names_; }
  /// All links from the base to the tip, each with its name and frame.
  [[nodiscard]] const std::vector<urdf_link>& links() const { return links_; }
  /// Unknown elements of the whole file, which are not part of URDF and were not read.
  [[nodiscard]] const std::vector<urdf_unknown_element>& unknown() const { return unknown_; }

  // For those who extend duet.

  /// Displaces all frames after link i, including links fixed to it.
  void displace(int i, const placement<double>& by) {
    serial_chain<-Capacity>::displace(i, by);
    for (urdf_link& each : links_) {
      if (each.frame.link == i) {
        each.frame.offset = by * each.frame.offset;
      }
    }
  }

private:
  std::vector<std::string> joint_names_;
  std::vector<urdf_link> links_;
  std::vector<urdf_unknown_element> unknown_;
};

} // namespace duet
