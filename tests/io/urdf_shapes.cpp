// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/skip.hpp"
#include "support/test.hpp"

#include <duet/io.hpp>

#include <filesystem>
#include <fstream>
#include <variant>

namespace test_io_urdf_shapes {
namespace {

using namespace duet;

const std::string path = "test_io_urdf_shapes.xml";

void write(const std::string& inside) {
  std::ofstream(path) << "<?xml version=\"1.0\"?>\n<robot name=\"r\">\n" << inside << "</robot>\n";
}
std::string robot_with(const std::string& inside) {
  return "<link name=\"a\">\n" + inside +
         "</link>\n<link name=\"b\"/>\n<joint name=\"j\" type=\"continuous\"><parent link=\"a\"/>"
         "<child link=\"b\"/></joint>\n";
}

/// Error message for a tree and a chain, without the name of the file.
std::string error_of(const std::string& inside) {
  write(robot_with(inside));
  const std::string tree = duet_test::message_of<file_error>([] { (void)read_urdf_tree(path); });
  CHECK(tree == duet_test::message_of<file_error>([] { (void)read_urdf(path, "a", "b"); }));
  const std::string begin = "duet: " + path + ":";
  return tree.starts_with(begin) ? tree.substr(begin.size()) : tree;
}
std::string error_of_shape(const std::string& shape) {
  return error_of("<collision>\n<geometry>\n" + shape + "</geometry></collision>\n");
}
std::string error_of_srdf(const std::string& inside) {
  write(inside);
  const std::string message =
      duet_test::message_of<file_error>([] { (void)read_disabled_collisions(path); });
  const std::string begin = "duet: " + path + ":";
  return message.starts_with(begin) ? message.substr(begin.size()) : message;
}

TEST_CASE("read_urdf, read_urdf_tree: collision shapes of links") {
  write(robot_with(
      "<collision name=\"first\"><origin xyz=\"1 2 3\" rpy=\"0 0 1\"/><geometry>"
      "<box size=\".1 .2 .3\" scale=\"1 1 1\"/></geometry></collision>\n"
      "<collision><geometry><cylinder radius=\".5\" length=\"2\"/></geometry></collision>"
      "<collision group=\"x\"><geometry><sphere radius=\".25\"/></geometry></collision>"
      "<collision><geometry><capsule radius=\".5\" length=\"3\"/></geometry></collision>"
      "<collision><geometry><mesh filename=\"package://p/x.stl\" scale=\"1 -2 .001\"/>"
      "</geometry></collision>\n"
      "<collision><geometry><mesh filename=\"y.obj\"/></geometry></collision>"));
  const auto tree = read_urdf_tree(path);
  const auto chain = read_urdf(path, "a", "b");
  const auto back = tree.chain("b", "a");
  for (const auto* shapes :
       {&tree.links()[0].collision, &chain.links()[0].collision, &back.links()[1].collision}) {
    REQUIRE(shapes->size() == 6);
    const auto& box = (*shapes)[0];
    CHECK(box.line == 4);
    CHECK(box.frame.translation == std::array<double, 3>{1, 2, 3});
    CHECK(box.frame.rotation.z() == doctest::Approx(std::sin(.5)));
    CHECK(std::get<collision_box>(box.geometry).size == std::array<double, 3>{.1, .2, .3});
    CHECK(std::get<collision_cylinder>((*shapes)[1].geometry).radius == .5);
    CHECK(std::get<collision_cylinder>((*shapes)[1].geometry).length == 2);
    CHECK((*shapes)[1].frame.translation == std::array<double, 3>{0, 0, 0});
    CHECK(std::get<collision_sphere>((*shapes)[2].geometry).radius == .25);
    CHECK(std::get<collision_capsule>((*shapes)[3].geometry).length == 3);
    const auto& mesh = std::get<collision_mesh>((*shapes)[4].geometry);
    CHECK(mesh.file == "package://p/x.stl");
    CHECK(mesh.scale == std::array<double, 3>{1, -2, .001});
    CHECK(std::get<collision_mesh>((*shapes)[5].geometry).scale == std::array<double, 3>{1, 1, 1});
  }
  CHECK(tree.links()[1].collision.empty());
  CHECK(tree.description().unknown.empty());
}

TEST_CASE("read_urdf, read_urdf_tree: errors of shapes name line, element and value") {
  const std::string in = ": <link name=\"a\"> ";
  CHECK(error_of("<collision/>\n") == "4" + in + "<collision>: no element <geometry>");
  CHECK(error_of("<collision><geometry/></collision>\n") ==
        "4" + in + "<geometry>: it has 0 shapes (expected 1)");
  CHECK(error_of_shape("<sphere radius=\"1\"/><box size=\"1 1 1\"/>") ==
        "5" + in + "<geometry>: it has 2 shapes (expected 1)");
  CHECK(error_of_shape("<sphere radius=\"1\"/><sphere radius=\"1\"/>") ==
        "6" + in + "<sphere>: it is repeated, first in line 6");
  CHECK(error_of_shape("<cone radius=\"1\"/>") ==
        "6" + in +
            "<cone>: the shape is unknown (expected box, cylinder, capsule, sphere or mesh)");
  CHECK(error_of_shape("<sphere radious=\"1\"/>") ==
        "6" + in + "<sphere>: unknown attribute \"radious\": there are \"radius\"");
  CHECK(error_of_shape("<sphere/>") == "6" + in + "<sphere>: no attribute \"radius\"");
  CHECK(error_of_shape("<sphere radius=\"-1\"/>") ==
        "6" + in + "<sphere>: radius=\"-1\" is negative");
  CHECK(error_of_shape("<cylinder radius=\"1\" length=\"x\"/>") ==
        "6" + in + "<cylinder>: length=\"x\" is not a number up to 1e6");
  CHECK(error_of_shape("<box size=\"1 1\"/>") ==
        "6" + in + "<box>: size=\"1 1\" is not three numbers");
  CHECK(error_of_shape("<box/>") == "6" + in + "<box>: no attribute \"size\"");
  CHECK(error_of_shape("<box size=\"1 1 -1\"/>") ==
        "6" + in + "<box>: size=\"1 1 -1\" is negative");
  CHECK(error_of_shape("<box size=\"1 1 1\" scale=\"1 1 2\"/>") ==
        "6" + in + "<box>: scale is valid for meshes only");
  CHECK(error_of_shape("<mesh scale=\"1 1 1\"/>") ==
        "6" + in + "<mesh>: no attribute \"filename\"");
  CHECK(error_of("<collision><origin xyz=\"1 2\"/><geometry><sphere radius=\"1\"/></geometry>"
                 "</collision>\n") == "4" + in + "<origin>: xyz=\"1 2\" is not three numbers");
}

TEST_CASE("read_disabled_collisions: reads pairs, and errors name line and value") {
  write("<group name=\"arm\"><link name=\"a\"/></group>\n"
        "<disable_collisions link1=\"a\" link2=\"b\" reason=\"Adjacent\"/>\n"
        "<disable_collisions link1=\"b\" link2=\"c\"/>\n");
  const auto pairs = read_disabled_collisions(path);
  REQUIRE(pairs.size() == 2);
  CHECK(pairs[0].first == "a");
  CHECK(pairs[0].second == "b");
  CHECK(pairs[1].second == "c");
  CHECK(error_of_srdf("<disable_collisions link1=\"a\"/>") ==
        "3: <disable_collisions>: no attribute \"link2\"");
  CHECK(error_of_srdf("\n<disable_collisions link1=\"a\" linc2=\"b\"/>") ==
        "4: <disable_collisions>: unknown attribute \"linc2\": there are \"link1\", \"link2\" and "
        "\"reason\"");
  CHECK(error_of_srdf("<disable_collisions link1=\"\" link2=\"b\"/>") ==
        "3: <disable_collisions>: link1=\"\" is empty");
  CHECK(error_of_srdf("<disable_collisions link1=\"a\" link2=\"\"/>") ==
        "3: <disable_collisions>: link2=\"\" is empty");
  CHECK(error_of_srdf("\n<disable_collisions link1=\"a\" link2=\"a\" reason=\"Never\"/>") ==
        "4: <disable_collisions>: link1 and link2 are both \"a\"");
  CHECK(error_of_srdf("<enable_collisions link1=\"a\" link2=\"b\"/>") ==
        "3: <enable_collisions> is not supported");
  std::ofstream(path) << "<sdf/>";
  CHECK(duet_test::message_of<file_error>([] { (void)read_disabled_collisions(path); }) ==
        "duet: " + path + ":1: the root is <sdf> (expected <robot>)");
}

TEST_CASE("read_urdf_tree: files of real robots have their number of shapes") {
  if (const auto folder = duet_test::outside_data("urdf")) {
    const auto count = [&](const char* name) {
      std::size_t result = 0;
      for (const tree_link& each : read_urdf_tree((*folder / name).string()).links()) {
        result += each.collision.size();
      }
      return result;
    };
    CHECK(count("double_pendulum.urdf") == 3);
    CHECK(count("kinova.urdf") == 11);
    CHECK(count("panda.urdf") == 17);
    CHECK(count("ur5_robot.urdf") == 8);
  }
}

} // namespace
} // namespace test_io_urdf_shapes
