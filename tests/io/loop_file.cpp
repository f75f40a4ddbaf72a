// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "kinematics/loops.hpp"
#include "support/message.hpp"

#include <duet/core/text/file.hpp>
#include <duet/duet.hpp>
#include <duet/io/loop_file.hpp>

#include <filesystem>

namespace test_io_loop_file {
namespace {

using namespace duet;
using duet_test::message_of;

const std::string path = "test_io_loop_file.txt";

loop_constraints read(const std::string& content) {
  write_file(path, content);
  return read_loops(path);
}

/// Error message for the content, without the name of the file.
std::string error_of(const std::string& content) {
  const std::string text = message_of<file_error>([&] { (void)read(content); });
  const std::string begin = "duet: " + path + ":";
  REQUIRE(text.starts_with(begin));
  return text.substr(begin.size());
}

TEST_CASE("read_loops: reads all constraint types, points, axes, angles and comments") {
  const loop_constraints loops = read("\xef\xbb\xbf# closes the frame\n"
                                      "hinge coupler .5 0 0  rocker 0.4 -1e-1 0 # in front\r\n"
                                      "\n"
                                      "\tslider a 1 2 3 rpy 0.1 0.2 0.3 b 0 0 0 axis 0 0 2\n"
                                      "weld a 0 0 0 b 0 0 0\n"
                                      "cylindrical a 0 0 0 axis 1 0 0 b 0 0 0\n"
                                      "universal a 0 0 0 b 0 0 0\n"
                                      "ball a 0 0 0 b 0 0 0\n"
                                      "planar a 0 0 0 b 0 0 0\n"
                                      "rod axis 0 0 0 axis 0 1 0 rpy 0 0 0 length 0.25");
  REQUIRE(loops.loops.size() == 8);
  CHECK(loops.file == path);
  const loop_constraint& hinge = loops.loops[0];
  CHECK(hinge.kind == constraint_kind::revolute);
  CHECK(hinge.line == 2);
  CHECK(hinge.first.link == "coupler");
  CHECK(hinge.first.offset.translation == std::array{.5, 0., 0.});
  CHECK(hinge.second.link == "rocker");
  CHECK(hinge.second.offset.translation == std::array{.4, -.1, 0.});
  const loop_constraint& slider = loops.loops[1];
  CHECK(slider.kind == constraint_kind::prismatic);
  CHECK(slider.line == 4);
  const auto rotated_frame = duet_test::placement_at(0, 0, .3, 0, 0, 0) *
                             duet_test::placement_at(0, .2, 0, 0, 0, 0) *
                             duet_test::placement_at(.1, 0, 0, 1, 2, 3);
  CHECK(distance(slider.first.offset.rotation, rotated_frame.rotation) < 1e-15);
  CHECK(slider.second.offset.rotation == quaternion<double>(1.0));
  CHECK(loops.loops[3].first.offset.rotation == frame_with_z_axis({0, 0, 0}, {1, 0, 0}).rotation);
  const loop_constraint& rod = loops.loops[7]; // the names of the links are words of the format
  CHECK(rod.kind == constraint_kind::distance);
  CHECK(rod.first.link == "axis");
  CHECK(rod.second.link == "rpy");
  CHECK(rod.length == .25);
  const std::array order{constraint_kind::revolute,  constraint_kind::prismatic,
                         constraint_kind::fixed,     constraint_kind::cylindrical,
                         constraint_kind::universal, constraint_kind::spherical,
                         constraint_kind::planar,    constraint_kind::distance};
  for (std::size_t i = 0; i < order.size(); ++i) {
    CHECK(loops.loops[i].kind == order[i]);
  }
}

TEST_CASE("read_loops: accepts the names of constraint types") {
  const std::array words{"fixed",     "revolute",  "prismatic", "cylindrical",
                         "universal", "spherical", "planar",    "distance"};
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string length = i == 7 ? " length 1" : "";
    const loop_constraints loops = read(words[i] + (" a 0 0 0 b 0 0 0" + length));
    CHECK(loops.loops[0].kind == constraint_kind(i));
  }
}

TEST_CASE("read_loops: errors name line and value") {
  CHECK(error_of(" # nothing\n") == " the file contains no loop-closure constraints");
  CHECK(error_of("# a\nhing a 0 0 0 b 0 0 0")
            .starts_with("2: unknown type of constraint \"hing\": there are \"hinge\", "));
  CHECK(error_of("distanc a 0 0 0 b 0 0 0")
            .starts_with("1: unknown type of constraint \"distanc\": there are \"distance\", "));
  CHECK(error_of("hinge") == "1: the name of a link is missing");
  CHECK(error_of("hinge a 0 0") == "1: z on \"a\" is missing");
  CHECK(error_of("hinge a 0 0 b 0 0 0") == "1: z on \"a\" is not a number: 'b'");
  CHECK(error_of("hinge a 0 0,5 0 b 0 0 0") ==
        "1: y on \"a\" is not a number: '0,5' (expected a decimal point, not a comma)");
  CHECK(error_of("hinge a 0 0 0 b 0 inf 0") == "1: y on \"b\" is inf");
  CHECK(error_of("hinge a 0 0 0 b 0 1e999 0") ==
        "1: y on \"b\" is 1e999, beyond the range of a double");
  CHECK(error_of("hinge a 0 0 0 b 0 0 0 axis 0 0 0") == "1: the axis on \"b\" is zero");
  CHECK(error_of("hinge a 0 0 0 axis 0 0 b 0 0 0") == "1: axis z on \"a\" is not a number: 'b'");
  CHECK(error_of("hinge a 0 0 0 rpy 0 0") == "1: yaw on \"a\" is missing");
  CHECK(error_of("hinge a 0 0 0 rpy 0 1e300 0 b 0 0 0") ==
        "1: the angle 1e+300 on \"a\" exceeds 1e6 radians");
  CHECK(error_of("hinge a 0 0 0 b 0 0 0 length 1") == "1: \"length\" is superfluous");
  CHECK(error_of("rod a 0 0 0 b 0 0 0") == "1: \"length\" is missing");
  CHECK(error_of("rod a 0 0 0 b 0 0 0 1") == "1: \"length\" expected, not \"1\"");
  CHECK(error_of("rod a 0 0 0 b 0 0 0 length 0") == "1: length is 0 (expected > 0)");
  CHECK(error_of("rod a 0 0 0 b 0 0 0 length -2") == "1: length is -2 (expected > 0)");
  CHECK(error_of("rod a 0 0 0 b 0 0 0 length nan") == "1: length is nan");
  CHECK(message_of<file_error>([] { (void)read_loops("/nowhere/loops.txt"); }) ==
        "duet: /nowhere/loops.txt: cannot be read");
  std::filesystem::remove(path);
}

} // namespace
} // namespace test_io_loop_file
