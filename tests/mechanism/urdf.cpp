// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "mechanism/arms.hpp"
#include "support/message.hpp"
#include "support/skip.hpp"

#include <duet/derivative/tangent_coordinates.hpp>
#include <duet/mechanism/jacobian.hpp>
#include <duet/mechanism/urdf.hpp>
#include <duet/quaternion/euler.hpp>

#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

namespace test_mechanism_urdf {
namespace {

using namespace duet;
using duet_test::gap;

const std::string path = "test_mechanism_urdf.urdf";

void write(const std::string& inside) {
  std::ofstream(path) << "<?xml version=\"1.0\"?>\n<robot name=\"r\">\n" << inside << "</robot>\n";
}

std::string message(const std::string& base = "a", const std::string& tip = "c") {
  return duet_test::message_of([&] { (void)read_urdf(path, base, tip); });
}

const std::string links = "<link name=\"a\"/><link name=\"b\"/><link name=\"c\"/>\n";
const std::string first = "<joint name=\"p\" type=\"prismatic\"><parent link=\"a\"/>"
                          "<child link=\"b\"/><axis xyz=\"0 0 1\"/>"
                          "<limit lower=\"-1\" upper=\"2\" velocity=\"3\"/></joint>\n";

std::string joint_to_c(const std::string& inside, const std::string& type = "continuous") {
  return "<joint name=\"q\" type=\"" + type + "\"><parent link=\"b\"/><child link=\"c\"/>" +
         inside + "</joint>\n";
}

} // namespace

TEST_CASE("origins, axes and limits as the format says") {
  write(links + first +
        joint_to_c("<origin xyz=\" .1 2e-1\t+0.3 \" rpy=\"0.1 0.2 0.3\"/><axis xyz=\"0 1 0\"/>"));
  const auto chain = read_urdf(path, "a", "c");
  CHECK(chain.size() == 2);
  CHECK(chain.joint_names() == std::vector<std::string>{"p", "q"});
  CHECK(chain.limits(0).lower == -1);
  CHECK(chain.limits(0).upper == 2);
  CHECK(chain.limits(0).velocity == 3);
  CHECK(chain.kind(1) == joint_kind::continuous);
  CHECK(chain.limits(1).upper == INFINITY);
  const Eigen::Vector2d theta(.5, .7);
  // Roll, pitch and yaw are turns about fixed axes.
  const auto expected =
      pose(from_euler<zyx>(.3, .2, .1), Eigen::Vector3d(.1, .2, .8)) *
      pose(from_axis_angle(Eigen::Vector3d(0, 1, 0), .7), Eigen::Vector3d(0, 0, 0));
  CHECK(gap(transform_matrix(chain.pose(theta)), transform_matrix(expected)) < 1e-15);
  CHECK(gap(translation(chain.pose(theta, chain.link("b"))), Eigen::Vector3d(0, 0, .5)) == 0);
  CHECK_THROWS_WITH_AS((void)chain.link("x"),
                       "duet: no link \"x\" in the chain: there are \"a\", \"b\", \"c\"",
                       invalid_input);
  // Where nothing is said the axis is x.
  write(links + first + joint_to_c(""));
  const auto along_x = read_urdf(path, "b", "c");
  const Eigen::Matrix<double, 1, 1> angle(.4);
  CHECK(gap(rotation_vector(rotation(along_x.pose(angle))), Eigen::Vector3d(.4, 0, 0)) < 1e-15);
  CHECK(read_urdf(path, "c", "c").size() == 0);
}

TEST_CASE("what is wrong is said with file and element") {
  const std::string file = "duet: " + path + ": ";
  const std::string q = file + "<joint name=\"q\">";
  const auto says = [&](const std::string& joint, const std::string& expected) {
    write(links + first + joint);
    CHECK(message() == expected);
  };
  says(joint_to_c("<mimic joint=\"p\"/>"),
       q + " <mimic>: joints that follow others are not supported in a chain");
  says(joint_to_c("<axis xyz=\"0 0 2\"/>"), q + " <axis>: length 2, not 1");
  says(joint_to_c("<axis xyz=\"0 0 0\"/>"), q + " <axis>: length 0, not 1");
  says(joint_to_c("<axis xyz=\"0 0 x\"/>"), q + " <axis>: xyz=\"x\" is no number up to 1e6");
  says(joint_to_c("<axis xyz=\"0 0\"/>"), q + " <axis>: xyz=\"0 0\" is not three numbers");
  says(joint_to_c("<origin xyz=\"1 2 3 4\"/>"),
       q + " <origin>: xyz=\"1 2 3 4\" is not three numbers");
  says(joint_to_c("<origin rpy=\"nan 0 0\"/>"),
       q + " <origin>: rpy=\"nan\" is no number up to 1e6");
  says(joint_to_c("", "revolute"), q + ": no element <limit>, which a revolute joint must have");
  says(joint_to_c("<limit lower=\"2\" upper=\"1\"/>", "revolute"),
       q + " <limit>: lower is above upper");
  says(joint_to_c("<limit velocity=\"-1\"/>", "revolute"), q + " <limit>: velocity is negative");
  says(joint_to_c("<limit upper=\"1,5\"/>", "revolute"),
       q + " <limit>: upper=\"1,5\" is no number up to 1e6");
  says(joint_to_c("", "floating"),
       q + ": type \"floating\" is none of revolute, continuous, prismatic and fixed");
  says("<joint name=\"q\" type=\"fixed\"><child link=\"c\"/></joint>", q + ": no element <parent>");
  says("<joint name=\"q\" type=\"fixed\"><parent link=\"b\"/><child/></joint>",
       q + " <child>: no attribute \"link\"");
  says("<joint type=\"fixed\"/>", file + "<joint>: no attribute \"name\"");
  says("<joint name=\"q\"><parent link=\"b\"/><child link=\"c\"/></joint>",
       q + ": no attribute \"type\"");
  says("", file + "the link \"c\" does not hang on \"a\": above \"c\" there is no joint");
  says("<joint name=\"q\" type=\"fixed\"><parent link=\"z\"/><child link=\"c\"/></joint>",
       q + " <parent>: no link \"z\": there are \"a\", \"b\", \"c\"");
  says(joint_to_c("") + joint_to_c(""), q + ": the link \"c\" has a joint above it already");
  write(links + first + joint_to_c("<axis xyz=\"0 0 1\"/>"));
  CHECK(message("a", "z") == file + "no link \"z\": there are \"a\", \"b\", \"c\"");
  CHECK(message("z", "c") == file + "no link \"z\": there are \"a\", \"b\", \"c\"");
  CHECK(message("c", "a") ==
        file + "the tip \"a\" is an ancestor of the base \"c\": exchange them");
  CHECK_THROWS_WITH_AS((void)read_urdf<1>(path, "a", "c"),
                       (file + "2 moving joints from \"a\" to \"c\": use read_urdf<2>").c_str(),
                       invalid_input);
}

TEST_CASE("cycles, broken and missing files") {
  const std::string file = "duet: " + path + ": ";
  write(links + "<joint name=\"q\" type=\"fixed\"><parent link=\"b\"/><child link=\"c\"/></joint>"
                "<joint name=\"r\" type=\"fixed\"><parent link=\"c\"/><child link=\"b\"/></joint>");
  CHECK(message() == file + "<joint name=\"r\">: closes a cycle at the link \"c\"");
  std::ofstream(path) << "<robot>\n<link name=\"a\">\n</robot>\n";
  CHECK(message().find(file + "line ") == 0);
  std::ofstream(path) << "<sdf/>\n";
  CHECK(message() == file + "no element <robot>");
  std::filesystem::remove(path);
  CHECK(message() == file + "cannot be read");
}

TEST_CASE("nesting, and what a parser makes of it") {
  const std::string file = "duet: " + path + ": ";
  const auto says = [&](const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
    return message("a", "a");
  };
  const auto nested = [](std::size_t depth, const std::string& open, const std::string& close) {
    std::string text = "<robot><link name=\"a\"/>";
    for (std::size_t i = 0; i < depth; ++i) {
      text += open;
    }
    for (std::size_t i = 0; i < depth; ++i) {
      text += close;
    }
    return text + "</robot>\n";
  };
  CHECK(says(nested(99, "<x>", "</x>")).empty());
  const std::string deep = file + "line 1: elements are nested more than 100 deep";
  CHECK(says(nested(100, "<x>", "</x>")) == deep);
  CHECK(says(nested(200000, "<x>", "</x>")) == deep);
  // End tags that are none.
  for (const std::string none :
       {"<!--</x>-->", "<![CDATA[</x>]]>", "<?p </x>?>", "<y z='</x>'/>", "<y z=\"/></x>\"/>"}) {
    CHECK(says(nested(101, "<x>" + none, "</x>")) == deep);
    CHECK(says(nested(50, "<x>" + none, "</x>")).empty());
  }
  // Tags that are none.
  CHECK(says(nested(1, "<!--<x><x>--><?p <x>?><y z='<x>' w = \"<x>\" /><![CDATA[<x>]]>", ""))
            .empty());
  CHECK(says("<robot>\n<link name=\"a\"></robot>\n</link>") ==
        file + "line 2: </robot> where </link> is expected");
  CHECK(says("<robot/>\n</robot>") == file + "line 2: </robot> where nothing is open");
  CHECK(says("<robot>\n<link name=\"a\">\n</link>\n") == file + "line 4: no </robot>");
  CHECK(says("<robot>\n<!-- </robot>") == file + "line 2: no -->");
  CHECK(says("<robot a=>") == file + "line 1: no quote before an attribute's value");
  CHECK(says("<robot a>") == file + "line 1: no = after an attribute's name");
  CHECK(says("<robot a=\"b>") == file + "line 1: no \"");
  CHECK(says("<robot / >") == file + "line 1: no > after <robot");
  CHECK(says("< robot>") == file + "line 1: no name after <");
  CHECK(says(std::string("<robot>\n\0</robot>", 18)) == file + "line 2: holds a byte 0");
  CHECK(says("<!DOCTYPE robot [<!ENTITY a \"&b;&b;\">]><robot>&a;</robot>") ==
        file + "line 1: declarations, as <!DOCTYPE, are not supported");
  CHECK(says("") == file + "no element <robot>");
  CHECK(says("\xef\xbb\xbf<robot><link name=\"a\"/></robot>").empty()); // a byte order mark
  CHECK(says(std::string((1U << 24U) + 1, ' ')) == file + "has more than 16 MB");
  std::filesystem::remove(path);
  std::filesystem::create_directory(path);
  CHECK(message() == file + "is a folder, not a file");
  std::filesystem::remove(path);
}

TEST_CASE("links that are fixed to one another do not count as joints") {
  constexpr int count = 300;
  std::string inside = "<link name=\"l0\"/>";
  for (int i = 1; i <= count; ++i) {
    const std::string link = "l" + std::to_string(i);
    inside += "<link name=\"" + link + "\"/><joint type=\"fixed\" name=\"" + link +
              "\"><parent link=\"l" + std::to_string(i - 1) + "\"/><child link=\"" + link +
              "\"/></joint>";
  }
  write(inside);
  CHECK(read_urdf(path, "l0", "l" + std::to_string(count)).links().size() == count + 1);
  std::filesystem::remove(path);
}

TEST_CASE("links by name and frame; the Jacobian by duals of joints of run-time number") {
  write(links + first + joint_to_c("<axis xyz=\"0 0 1\"/>"));
  const auto arm = read_urdf(path, "a", "c");
  REQUIRE(arm.links().size() == 3);
  const duet::urdf_link& last = arm.links()[2];
  CHECK(last.name == "c");
  const std::vector<double> theta{.3, -.7};
  const Eigen::VectorXd column = Eigen::Vector2d(.3, -.7);
  CHECK(arm.pose(theta, last.frame) == arm.pose(theta));
  const auto tip = [&](const auto& x) { return arm.pose(x); };
  const auto check = [&](auto frame) {
    const auto expected = duet::jacobian(arm, theta, frame);
    REQUIRE(duet::jacobian(tip, theta, frame).jacobian.cols() == 2);
    CHECK((duet::jacobian(tip, theta, frame).jacobian - expected).norm() < 1e-14);
    CHECK((duet::jacobian(tip, column, frame).jacobian - expected).norm() < 1e-14);
    CHECK(duet::jacobian(tip, column, frame).value == arm.pose(theta));
  };
  check(duet::frame::spatial);
  check(duet::frame::body);
  check(duet::frame::hybrid);
  std::filesystem::remove(path);
}

TEST_CASE("names of links and joints, and those that are like one that is not there") {
  write(links + first + joint_to_c("<axis xyz=\"0 0 1\"/>"));
  const auto names = duet::read_urdf_names(path);
  CHECK(names.links == std::vector<std::string>{"a", "b", "c"});
  REQUIRE(names.joints.size() == 2);
  CHECK(names.joints[0].parent == "a");
  CHECK(to_text(names) == "links:\n  a\n  b\n  c\njoints:\n  p: prismatic, a -> b\n"
                          "  q: continuous, b -> c\n");
  std::string arm;
  for (const char* link :
       {"base", "shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3", "tool0"}) {
    arm += std::string("<link name=\"") + link + "\"/>";
  }
  write(arm);
  CHECK(message("base", "wrist3") ==
        "duet: " + path +
            ": no link \"wrist3\": there are \"wrist_3\", \"wrist_1\", \"wrist_2\", \"base\", "
            "\"forearm\", \"tool0\" and 2 more");
  std::filesystem::remove(path);
}

TEST_CASE("what a terminal would obey is not repeated") {
  write("<link name=\"a\"/><link name=\"\x1b[2J\"/>"
        "<joint name=\"&#27;]0;x&#7;\"><parent link=\"a\"/><child link=\"\x1b[2J\"/></joint>");
  CHECK(message("a", "\x1b[2J") ==
        "duet: " + path + ": <joint name=\"\\x1b]0;x\\x07\">: no attribute \"type\"");
  CHECK(message("a", "\n") == "duet: " + path + ": no link \"\\n\": there are \"a\", \"\\x1b[2J\"");
  std::filesystem::remove(path);
}

TEST_CASE("real robots") {
  const auto data = duet_test::outside_data("urdf");
  if (!data) {
    return;
  }
  const std::string folder = data->string() + "/";
  const auto panda = read_urdf(folder + "panda.urdf", "panda_link0", "panda_link8");
  const auto known = robots::panda();
  CHECK(panda.size() == 7);
  for (int i = 0; i < 7; ++i) {
    CHECK(panda.limits(i).lower == known.limits(i).lower);
    CHECK(panda.limits(i).upper == known.limits(i).upper);
  }
  for (const auto& theta : duet_test::configurations(known.table(), 20)) {
    CHECK(gap(transform_matrix(panda.pose(theta)), transform_matrix(known.pose(theta))) < 4e-15);
    CHECK(gap(jacobian(panda, theta, frame::body), jacobian(known, theta, frame::body)) < 4e-15);
    CHECK(gap(transform_matrix(panda.pose(theta, panda.link("panda_link4"))),
              transform_matrix(known.pose(theta, 4))) < 4e-15);
  }
  // Fingers: the second one follows the first.
  CHECK(read_urdf(folder + "panda.urdf", "panda_link0", "panda_leftfinger").size() == 8);
  CHECK_THROWS_AS((void)read_urdf(folder + "panda.urdf", "panda_link0", "panda_rightfinger"),
                  invalid_input);
  const auto tiago = read_urdf(folder + "tiago_no_hand.urdf", "base_link", "arm_7_link");
  CHECK(tiago.size() == 8);
  CHECK(tiago.kind(0) == joint_kind::prismatic);
  CHECK(read_urdf(folder + "double_pendulum.urdf", "base_link", "link2").size() == 2);
  CHECK(read_urdf(folder + "ur5_robot.urdf", "base_link", "tool0").size() == 6);
}

} // namespace test_mechanism_urdf
