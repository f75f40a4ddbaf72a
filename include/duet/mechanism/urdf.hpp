// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/text/nearest_names.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/mechanism/joint.hpp>
#include <duet/mechanism/serial_chain.hpp>
#include <duet/mechanism/urdf_contents.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#ifndef DUET_COMPILED
#include <duet/mechanism/urdf_library.hpp>
#endif

/// \file
/// Chains out of robot descriptions in URDF, the XML of the robot operating system.

namespace duet {

/// A chain that was read, with the names of its joints and links.
///
/// \tparam Capacity  how many moving joints there may be
template <int Capacity>
class urdf_chain : public serial_chain<-Capacity> {
public:
  urdf_chain(const serial_chain<-Capacity>& chain, std::vector<std::string> joint_names,
             std::vector<urdf_link> links, std::vector<urdf_unknown_element> unknown = {})
      : serial_chain<-Capacity>(chain), joint_names_(std::move(joint_names)),
        links_(std::move(links)), unknown_(std::move(unknown)) {}

  /// For those who extend duet: another chain without joint i, whose link stays at `held`.
  urdf_chain(const urdf_chain& other, int i, const placement<double>& held)
      : serial_chain<-Capacity>(other, i, held), joint_names_(other.joint_names_),
        links_(other.links_), unknown_(other.unknown_) {
    joint_names_.erase(joint_names_.begin() + i);
    for (urdf_link& each : links_) {
      if (each.frame.link == i + 1) {
        each.frame.offset = held * each.frame.offset;
      }
      each.frame.link -= each.frame.link > i ? 1 : 0;
    }
  }

  using serial_chain<-Capacity>::link;
  /// The frame of a link by its name, those that are fixed to another one included.
  /// \throws invalid_input where the chain has none of that name
  [[nodiscard]] attached_frame<double> link(std::string_view name) const {
    const auto found = std::find_if(links_.begin(), links_.end(),
                                    [&](const urdf_link& each) { return each.name == name; });
    if (found == links_.end()) {
      std::vector<std::string> names;
      for (const urdf_link& each : links_) {
        names.push_back(each.name);
      }
      detail::raise(
          invalid_input(printable("duet: no link \"" + std::string(name) +
                                  "\" in the chain: " + detail::nearest_names(name, names))));
    }
    return found->frame;
  }
  /// Names of the joints that move, in order.
  [[nodiscard]] const std::vector<std::string>& joint_names() const { return joint_names_; }
  /// All links from the base to the tip, each with its name and frame.
  [[nodiscard]] const std::vector<urdf_link>& links() const { return links_; }
  /// Elements of the whole file that were not read, as URDF has them not.
  [[nodiscard]] const std::vector<urdf_unknown_element>& unknown() const { return unknown_; }

  // For those who extend duet.

  /// Displaces all that follows link i, and what is fixed to it.
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

/// The chain from one link of a robot description to another, both by their names; metres and
/// radians. Joint limits are those of `limit`, narrowed by the soft ones of `safety_controller`; a
/// number beyond ±1e6 stands for none. XML is read by expat: programs link it, or duet::compiled.
///
/// \tparam Capacity  how many moving joints there may be; their number is known at run time
/// \throws file_error with line and element for what is wrong anywhere in the file: XML that is not
/// well formed, nested more than 100 deep or has a document type; attributes of links and joints
/// that URDF has not; missing elements and attributes, and repeated ones; names that are there
/// twice; links with two joints above them; and in the chain for links that are not there, bad
/// numbers, axes that are no unit vectors, cycles, joints that mimic others or are of other kinds
/// than revolute, continuous, prismatic and fixed; and for too many joints
template <int Capacity = 16>
[[nodiscard]] urdf_chain<Capacity> read_urdf(const std::string& path, const std::string& base,
                                             const std::string& tip) {
  auto read = detail::read_urdf_contents<detail::xml_library>(path, base, tip, Capacity);
  return {serial_chain<-Capacity>(std::span<const joint<double>>(read.joints)),
          std::move(read.joint_names), std::move(read.links), std::move(read.unknown)};
}

/// The links and joints of a robot description, to choose a base and a tip from.
///
/// Example: `std::cout << to_text(read_urdf_names("robot.urdf"));`
/// \throws file_error for what cannot be read, as `read_urdf`
[[nodiscard]] inline urdf_names read_urdf_names(const std::string& path) {
  return detail::read_names_in_urdf<detail::xml_library>(path);
}

#ifdef DUET_COMPILED
DUET_COMPILED_TEMPLATE urdf_names
detail::read_names_in_urdf<detail::xml_library>(const std::string&);
DUET_COMPILED_TEMPLATE detail::urdf_contents
detail::read_urdf_contents<detail::xml_library>(const std::string&, const std::string&,
                                                const std::string&, std::size_t);
#endif

} // namespace duet
