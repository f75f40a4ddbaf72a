// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/gap.hpp"
#include "support/message.hpp"
#include "support/skip.hpp"
#include "support/test.hpp"

#include <duet/dual_quaternion/pose.hpp>
#include <duet/io/urdf.hpp>
#include <duet/kinematics/tree_jacobian.hpp>

#include <Eigen/Core>

#include <filesystem>
#include <fstream>

namespace test_io_urdf_tree {
namespace {

using namespace duet;
using duet_test::max_abs_difference;

const std::string path = "test_io_urdf_tree.urdf";

void write(const std::string& inside) {
  std::ofstream(path) << "<?xml version=\"1.0\"?>\n<robot name=\"r\">\n" << inside << "</robot>\n";
}
std::string message() {
  return duet_test::message_of<file_error>([] { (void)read_urdf_tree(path); });
}
std::string joint_of(const std::string& name, const std::string& type, const std::string& parent,
                     const std::string& child, const std::string& inside = "") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent +
         "\"/><child link=\"" + child + "\"/>" + inside + "</joint>\n";
}

const std::string links = "<link name=\"a\"/><link name=\"b\"/><link name=\"c\"/>\n";

TEST_CASE("read_urdf_tree: joint types, mimic joints, masses and lines of a complete file") {
  write(
      "<link name=\"tip\"/>\n"
      "<link name=\"base\"><inertial><mass value=\"2\"/></inertial></link>\n"
      "<link name=\"arm\"><inertial><origin xyz=\"0 0 .5\" rpy=\".1 0 0\"/><mass value=\"3\"/>"
      "<inertia ixx=\"1e7\" ixy=\".1\" ixz=\".2\" iyx=\".1\" iyy=\"2e7\" iyz=\".3\" "
      "izx=\".2\" izy=\".3\" izz=\"3e9\"/></inertial></link>\n"
      "<link name=\"finger\"/><link name=\"thumb\"/><link name=\"cart\"/>\n" +
      joint_of("thumbs", "prismatic", "tip", "thumb",
               "<axis xyz=\"0 1 0\"/><limit lower=\"-1\" upper=\".5\" velocity=\"2\"/>"
               "<mimic joint=\"fingers\" multiplier=\"-2\" offset=\".1\"/>") +
      joint_of("fingers", "prismatic", "tip", "finger",
               "<axis xyz=\"0 1 0\"/><limit lower=\"-1\" upper=\"1\" velocity=\"3\"/>") +
      joint_of("free", "floating", "base", "arm", "<origin xyz=\"1 0 0\"/>") +
      joint_of("weld", "fixed", "arm", "tip", "<origin xyz=\"0 0 1\"/><mimic joint=\"nobody\"/>") +
      joint_of("drive", "planar", "base", "cart", "<axis xyz=\"0 0 1\"/><limit/>") + "<tool/>\n");
  const kinematic_tree tree = read_urdf_tree(path);
  CHECK(tree.coordinate_names() == std::vector<std::string>{"fingers", "free.x", "free.y", "free.z",
                                                            "free.rx", "free.ry", "free.rz",
                                                            "drive.x", "drive.y", "drive.angle"});
  CHECK(tree.limits(0).lower == -.2);
  CHECK(tree.limits(0).upper == .55);
  CHECK(tree.limits(0).velocity == 1);
  CHECK(tree.limits(1).upper == INFINITY);
  CHECK(tree.links()[2].line == 5);
  CHECK(tree.joints()[1].line == 8);
  CHECK(tree.description().unknown.size() == 1);
  const auto& inertia = *tree.links()[2].inertia;
  CHECK(inertia.mass == 3);
  CHECK(inertia.moments == std::array<double, 6>{1e7, .1, .2, 2e7, .3, 3e9});
  CHECK(max_abs_difference(rotation_vector(inertia.frame.rotation), Eigen::Vector3d(.1, 0, 0)) <
        1e-16);
  CHECK(!tree.links()[0].inertia);
  Eigen::VectorXd q(10);
  q << .2, .1, .2, .3, 0, 0, 1.5707963267948966, 4, 5, .6;
  CHECK(max_abs_difference(translation(tree.pose(q, tree.link("thumb"))),
                           Eigen::Vector3d(1.4, .2, 1.3)) < 1e-15);
  CHECK(max_abs_difference(translation(tree.pose(q, tree.link("cart"))), Eigen::Vector3d(4, 5, 0)) <
        2e-15);
  CHECK(max_abs_difference(centre_of_mass(tree, q), Eigen::Vector3d(.66, .12, .48)) < 1e-15);
  // A chain may start behind a floating joint.
  CHECK(tree.chain("arm", "finger").size() == 1);
  CHECK(message().empty());
}

TEST_CASE("read_urdf_tree: errors name file, line and element") {
  const std::string file = "duet: " + path + ":";
  const auto check_error = [&](const std::string& inside, const std::string& expected) {
    write(inside);
    CHECK(message() == expected);
  };
  const std::string limit = "<limit lower=\"-1\" upper=\"1\"/>";
  const std::string p = joint_of("p", "revolute", "a", "b", limit);
  const auto follows = [&](const std::string& mimic, const std::string& type = "revolute") {
    return links + p + joint_of("q", type, "b", "c", limit + "<mimic " + mimic + "/>");
  };
  const std::string q = file + "5: <joint name=\"q\">";
  check_error(follows("joint=\"p\""), "");
  check_error(follows("joint=\"x\""), q + ": it mimics no joint \"x\": there are \"p\", \"q\"");
  check_error(follows("joint=\"q\""), q + ": it mimics itself");
  check_error(follows("joint=\"p\"", "planar"),
              q + ": it mimics \"p\", but \"q\" has 3 coordinates (expected 1)");
  check_error(follows("multiplier=\"2\""), q + " <mimic>: no attribute \"joint\"");
  check_error(follows("joint=\"p\" multiplier=\"x\""),
              q + " <mimic>: multiplier=\"x\" is not a number up to 1e6");
  check_error(follows("joint=\"p\" offset=\"3\""),
              q + ": no coordinate of \"p\" satisfies its limits -1 to 1");
  check_error(links + joint_of("p", "revolute", "a", "b", limit + "<mimic joint=\"q\"/>") +
                  joint_of("q", "revolute", "b", "c", limit + "<mimic joint=\"p\"/>"),
              file + "4: <joint name=\"p\">: it mimics itself");
  check_error(links + p, file + "3: <link name=\"c\">: it is a second root, the first is \"a\"");
  check_error(links + joint_of("q", "fixed", "b", "c") + joint_of("r", "fixed", "c", "b"),
              file + "5: <joint name=\"r\">: it closes a cycle at the link \"b\"");
  check_error(links + p + joint_of("q", "fixed", "z", "c"),
              q + ": no link \"z\": there are \"a\", \"b\", \"c\"");
  check_error("", "duet: " + path + ": the description has no links");
  const auto weighs = [&](const std::string& inside) {
    return "<link name=\"a\">\n<inertial>" + inside + "</inertial></link>";
  };
  const std::string a = file + "4: <link name=\"a\"> ";
  check_error(weighs(""), a + "<inertial>: no element <mass>");
  check_error(weighs("<mass/>"), a + "<mass>: no attribute \"value\"");
  check_error(weighs("<mass value=\"-1\"/>"), a + "<mass>: value=\"-1\" is negative");
  check_error(weighs("<mass value=\"1\" unit=\"kg\"/>"),
              a + "<mass>: unknown attribute \"unit\": there are \"value\"");
  check_error(weighs("<mass value=\"1\"/><mass value=\"1\"/>"),
              a + "<mass>: it is repeated, first in line 4");
  const auto moments = [&](const std::string& more) {
    return weighs(
        "<mass value=\"1\"/><inertia ixx=\"1\" ixy=\".1\" ixz=\".2\" iyy=\"2\" iyz=\".3\" "
        "izz=\"3\" " +
        more + "/>");
  };
  check_error(moments("iyx=\".1\" izx=\".2\" izy=\"-.3\""),
              a + "<inertia>: izy=\"-.3\" differs from iyz=\".3\" (expected a symmetric matrix)");
  check_error(moments("iyx=\"x\""), a + "<inertia>: iyx=\"x\" is not a finite number");
  check_error(weighs("<mass value=\"1e9\"/>"), "");
  check_error(weighs("<mass value=\"1e400\"/>"),
              a + "<mass>: value=\"1e400\" is not a finite number");
  check_error(weighs("<mass value=\"1\"/><inertia ixx=\"1\"/>"),
              a + "<inertia>: no attribute \"ixy\"");
  check_error(weighs("<mass value=\"1\"/><origin xyz=\"1 2\"/>"),
              a + "<origin>: xyz=\"1 2\" is not three numbers");
  check_error(weighs("<mass value=\"1\"/><colour/>"), "");
  CHECK(to_text(read_urdf_summary(path))
            .ends_with("unknown elements:\n  line 4: <colour> in <link name=\"a\"> <inertial>\n"));
  std::filesystem::remove(path);
}

TEST_CASE("read_urdf_tree: reads a chain of 20000 links") {
  constexpr int count = 20000;
  std::string inside;
  for (int i = count; i >= 0; --i) {
    const std::string name = std::to_string(i);
    inside += "<link name=\"" + name + "\"/>\n";
    if (i > 0) {
      inside += joint_of(name, i % 100 == 0 ? "continuous" : "fixed", std::to_string(i - 1), name,
                         "<origin xyz=\"0 0 .5\"/><axis xyz=\"0 0 1\"/>");
    }
  }
  write(inside);
  const kinematic_tree tree = read_urdf_tree(path);
  CHECK(tree.size() == 200);
  CHECK(tree.coordinate_names()[0] == "20000"); // as in the file
  const Eigen::VectorXd q = Eigen::VectorXd::Constant(200, .01);
  CHECK(max_abs_difference(translation(tree.pose(q, tree.link("20000"))),
                           Eigen::Vector3d(0, 0, 10000)) < 1e-9);
  CHECK(tree.chain<200>("0", "20000").size() == 200);
  std::filesystem::remove(path);
}

TEST_CASE("read_urdf_tree: chains of every robot file equal those of read_urdf") {
  const auto data = duet_test::outside_data("urdf");
  if (!data) {
    return;
  }
  int chains = 0;
  for (const auto& each : std::filesystem::recursive_directory_iterator(*data)) {
    if (each.path().extension() != ".urdf") {
      continue;
    }
    CAPTURE(each.path());
    const kinematic_tree tree = read_urdf_tree(each.path().string());
    const Eigen::VectorXd q = Eigen::VectorXd::LinSpaced(tree.size(), -1, 2);
    const auto poses = tree.poses(q);
    const std::string root = [&] {
      std::string link = tree.links()[0].name;
      for (std::size_t j = 0; j < tree.joints().size(); ++j) {
        if (tree.joints()[j].child == link) {
          link = tree.joints()[j].parent;
          j = std::size_t(-1);
        }
      }
      return link;
    }();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const std::string& tip = tree.links()[i].name;
      if (tip == "panda_rightfinger") {
        continue;
      }
      const auto arm = read_urdf<32>(each.path().string(), root, tip);
      Eigen::VectorXd theta(arm.size());
      for (int k = 0; k < arm.size(); ++k) {
        theta[k] = q[tree.coordinate(arm.joint_names()[std::size_t(k)])];
      }
      CHECK(max_abs_difference(transform_matrix(poses[i]), transform_matrix(arm.pose(theta))) <
            4e-15);
      const auto m = jacobian(tree, q, frame::body, int(i));
      const auto columns = jacobian(arm, theta, frame::body);
      for (int k = 0; k < arm.size(); ++k) {
        CHECK(max_abs_difference(m.col(tree.coordinate(arm.joint_names()[std::size_t(k)])),
                                 columns.col(k)) < 4e-15);
      }
      ++chains;
    }
  }
  CHECK(chains >= 60);
}

} // namespace
} // namespace test_io_urdf_tree
