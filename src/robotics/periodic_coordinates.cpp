// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "loops/periodic_coordinates.hpp"

#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/robot_description.hpp>
#include <duet/kinematics/tree_table.hpp>

#include <cmath>
#include <cstddef>

namespace duet::detail {
DUET_ABI_BEGIN

periodic_coordinates::periodic_coordinates(const closed_chain_mechanism& of)
    : angles(std::size_t(of.size()), false) {
  int i = 0;
  for (const tree_joint& each : of.tree().joints()) {
    if (each.mimic) {
      continue;
    }
    const joint_kind kind = each.motion.kind;
    if (kind == joint_kind::revolute || kind == joint_kind::continuous) {
      angles[std::size_t(i)] = true;
    } else if (kind == joint_kind::planar) {
      angles[std::size_t(i) + 2] = true;
    } else if (kind == joint_kind::spherical || kind == joint_kind::floating) {
      vectors.push_back(kind == joint_kind::floating ? i + 3 : i);
    }
    i += each.motion.coordinates();
  }
  for (const tree_node& node : of.tree().table().nodes) {
    const coordinate_source& source = of.tree().table().sources[std::size_t(node.coordinate)];
    if (!node.is_ball &&
        (node.step.is_translational || source.multiplier != std::round(source.multiplier))) {
      angles[std::size_t(source.own)] = false; // links that mimic the coordinate would move
    }
  }
}
DUET_ABI_END
} // namespace duet::detail
