// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "fuzz/seeded_loop.hpp"

#include <duet/io/urdf.hpp>

#include <Eigen/Core>

// Robot descriptions: the result is a valid chain and tree, errors are messages of one line.

namespace test_fuzz_urdf {

/// The first, an excerpt of the Panda's description, is complete.
std::vector<std::string> seeds() {
  const std::string links = "<link name=\"a\"/><link name=\"b\"/><link name=\"c\"/>";
  const std::string joint = "<joint name=\"q\" type=\"prismatic\"><parent link=\"b\"/>"
                            "<child link=\"c\"/><limit lower=\"-1\" upper=\"2\"/></joint>";
  return {
      R"(<?xml version="1.0" ?>
<!-- arm -->
<robot name="panda" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <link name="a">
    <visual><geometry><mesh filename="package://visual/link0.dae"/></geometry></visual>
  </link>
  <link name="b"/>
  <joint name="panda_joint1" type="revolute">
    <safety_controller k_position="100.0" soft_lower_limit="-2.8973" soft_upper_limit="2.8973"/>
    <origin rpy="0 -1.57079632679 0" xyz="0 0 0.333"/>
    <parent link="a"/>
    <child link="b"/>
    <axis xyz="0 0 1"/>
    <limit effort="87" lower="-2.8973" upper="2.8973" velocity="2.1750"/>
  </joint>
  <link name="c"/>
  <joint name="hand" type="fixed"><parent link="b"/><child link="c"/></joint>
</robot>
)",
      "<robot>" + links + joint +
          "<joint name=\"p\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/>"
          "<axis xyz=\"0 0.6 0.8\"/></joint></robot>",
      "<robot>" + links + joint + "</robot>",
      "<robot>" + links + joint +
          "<joint name=\"m\" type=\"revolute\"><parent link=\"c\"/><child link=\"b\"/>"
          "<mimic joint=\"q\"/></joint></robot>",
      "<robot>" + links +
          "<joint name=\"f\" type=\"floating\"><parent link=\"a\"/><child link=\"b\"/></joint>"
          "<joint name=\"p\" type=\"planar\"><parent link=\"a\"/><child link=\"c\"/>"
          "<axis xyz=\"0 0 -1\"/></joint></robot>"};
}

/// Requires rotations of unit norm and finite positions.
void require_pose(const duet::dual_quaternion<double>& a) {
  duet_fuzz::require(std::abs(norm(duet::rotation(a)) - 1) < 1e-12, "rotations");
  duet_fuzz::require(duet::translation(a).allFinite(), "finite positions");
}

/// \param names  of its coordinates
template <class Robot>
Eigen::VectorXd coordinates_of(const Robot& robot, const std::vector<std::string>& names) {
  const int n = robot.size();
  duet_fuzz::require(int(names.size()) == n, "as many names as coordinates");
  Eigen::VectorXd q(n);
  for (int i = 0; i < n; ++i) {
    const auto& limits = robot.limits(i);
    duet_fuzz::require(limits.lower <= limits.upper && limits.velocity >= 0, "limits in order");
    q[i] = i / 7.0;
  }
  return q;
}

/// Calls `read`, which may throw invalid_input with a valid message.
template <class Read>
void require_result_or_message(const Read& read) {
  try {
    read();
  } catch (const duet::invalid_input& error) {
    duet_fuzz::require_message(error.what(), "duet: ");
  }
}

void target(const std::string& input) {
  const std::string path = "fuzz_urdf.urdf";
  std::ofstream(path, std::ios::binary) << input;
  require_result_or_message([&] {
    const auto chain = duet::read_urdf(path, "a", "c");
    require_pose(chain.pose(coordinates_of(chain, chain.joint_names())));
  });
  require_result_or_message([&] {
    const auto tree = duet::read_urdf_tree(path);
    const auto poses = tree.poses(coordinates_of(tree, tree.coordinate_names()));
    duet_fuzz::require(poses.size() == tree.links().size(), "as many poses as links");
    for (const auto& pose : poses) {
      require_pose(pose);
    }
  });
  std::remove(path.c_str());
}

TEST_CASE("URDF files: mutated ones are read correctly or rejected with a message") {
  duet_fuzz::run_seeded(seeds(), target, 2000);
}

} // namespace test_fuzz_urdf
