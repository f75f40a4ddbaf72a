// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/mechanism/joint.hpp>
#include <duet/mechanism/serial_chain.hpp>
#include <duet/mechanism/urdf_reader.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// \file
/// Chains out of robot descriptions in URDF, the XML of the robot operating system.

namespace duet {

/// A chain that was read, with the names of its joints and links.
///
/// \tparam Capacity  how many moving joints there may be
template <int Capacity>
class urdf_chain : public serial_chain<-Capacity> {
public:
  struct named_link {
    std::string name;
    attached_frame<double> frame;
  };

  urdf_chain(const serial_chain<-Capacity>& chain, std::vector<std::string> joint_names,
             std::vector<named_link> links)
      : serial_chain<-Capacity>(chain), joint_names_(std::move(joint_names)),
        links_(std::move(links)) {}

  using serial_chain<-Capacity>::link;
  /// The frame of a link by its name, those that are fixed to another one included.
  /// \throws invalid_input where the chain has none of that name
  [[nodiscard]] attached_frame<double> link(std::string_view name) const {
    const auto found = std::find_if(links_.begin(), links_.end(),
                                    [&](const named_link& each) { return each.name == name; });
    if (found == links_.end()) {
      throw invalid_input(printable("duet: no link \"" + std::string(name) + "\" in the chain"));
    }
    return found->frame;
  }
  /// Names of the joints that move, in order.
  [[nodiscard]] const std::vector<std::string>& joint_names() const { return joint_names_; }
  /// All links from the base to the tip.
  [[nodiscard]] const std::vector<named_link>& links() const { return links_; }

private:
  std::vector<std::string> joint_names_;
  std::vector<named_link> links_;
};

/// The chain from one link of a robot description to another, both by their names; metres and
/// radians. Joint limits are those of the `limit` elements.
///
/// \tparam Capacity  how many moving joints there may be; their number is known at run time
/// \throws invalid_input with file and element for what cannot be read: XML that is not well
/// formed, nested more than 100 deep or has a document type, missing elements and
/// attributes, bad numbers, axes that are no unit vectors, unknown links, cycles, links with two
/// joints above them, joints that mimic others or are of other kinds than revolute, continuous,
/// prismatic and fixed; and for too many joints
template <int Capacity = 16>
[[nodiscard]] urdf_chain<Capacity> read_urdf(const std::string& path, const std::string& base,
                                             const std::string& tip) {
  detail::urdf_reader<boost::property_tree::ptree> reader(path);
  std::vector<joint<double>> joints;
  std::vector<std::string> names;
  using named_link = typename urdf_chain<Capacity>::named_link;
  std::vector<named_link> links{{base, {}}};
  placement<double> since_joint; // fixed joints since the last one that moves
  for (const auto* element : reader.path(base, tip)) {
    joints.push_back(reader.read(*element));
    if (joints.back().kind == joint_kind::fixed) {
      since_joint = since_joint * joints.back().origin;
    } else {
      since_joint = {};
      names.push_back(reader.name(*element));
    }
    links.push_back({reader.child(*element), {int(names.size()), since_joint}});
  }
  if (names.size() > std::size_t(Capacity)) {
    reader.fail("", std::to_string(names.size()) + " moving joints from \"" + base + "\" to \"" +
                        tip + "\": use read_urdf<" + std::to_string(names.size()) + ">");
  }
  return {serial_chain<-Capacity>(std::span<const joint<double>>(joints)), std::move(names),
          std::move(links)};
}

} // namespace duet
