// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "kinematics/arms.hpp"
#include "support/message.hpp"
#include "support/skip.hpp"

#include <duet/duet.hpp>
#include <duet/io/urdf.hpp>

#include <filesystem>
#include <fstream>

namespace test_io_urdf {
namespace {

using namespace duet;
using duet_test::max_abs_difference;

const std::string path = "test_io_urdf.urdf";

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

TEST_CASE("read_urdf: origins, axes and limits follow the format") {
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
  // Roll, pitch and yaw are rotations about fixed axes.
  const auto expected =
      pose(from_euler<zyx>(.3, .2, .1), Eigen::Vector3d(.1, .2, .8)) *
      pose(from_axis_angle(Eigen::Vector3d(0, 1, 0), .7), Eigen::Vector3d(0, 0, 0));
  CHECK(max_abs_difference(transform_matrix(chain.pose(theta)), transform_matrix(expected)) <
        1e-15);
  CHECK(max_abs_difference(translation(chain.pose(theta, chain.link("b"))),
                           Eigen::Vector3d(0, 0, .5)) == 0);
  CHECK_THROWS_WITH_AS((void)chain.link("x"),
                       "duet: urdf_chain: no link \"x\": there are \"a\", \"b\", \"c\"",
                       invalid_input);
  // The default axis is x.
  write(links + first + joint_to_c(""));
  const auto along_x = read_urdf(path, "b", "c");
  const Eigen::Matrix<double, 1, 1> angle(.4);
  CHECK(max_abs_difference(rotation_vector(rotation(along_x.pose(angle))),
                           Eigen::Vector3d(.4, 0, 0)) < 1e-15);
  CHECK(read_urdf(path, "c", "c").size() == 0);
}

TEST_CASE("read_urdf: errors name file, line and element") {
  const std::string file = "duet: " + path + ":";
  const std::string q = file + "5: <joint name=\"q\">";
  const auto check_error = [&](const std::string& joint, const std::string& expected) {
    write(links + first + joint);
    CHECK(message() == expected);
  };
  const std::string origins = ": there are \"a\", \"b\", \"c\"";
  check_error(joint_to_c("<mimic joint=\"p\"/>"), q + ": it mimics \"p\" (use a kinematic_tree)");
  check_error(joint_to_c("<axis xyz=\"0 0 2\"/>"),
              q + " <axis>: the axis has length 2 (expected 1)");
  check_error(joint_to_c("<axis xyz=\"0 0 0\"/>"),
              q + " <axis>: the axis has length 0 (expected 1)");
  check_error(joint_to_c("\n<axis xyz=\"0 0 x\"/>"),
              file + "6: <joint name=\"q\"> <axis>: xyz=\"x\" is not a number up to 1e6");
  check_error(joint_to_c("<axis xyz=\"0 0\"/>"), q + " <axis>: xyz=\"0 0\" is not three numbers");
  check_error(joint_to_c("<origin xyz=\"1 2 3 4\"/>"),
              q + " <origin>: xyz=\"1 2 3 4\" is not three numbers");
  check_error(joint_to_c("<origin rpy=\"nan 0 0\"/>"),
              q + " <origin>: rpy=\"nan\" is not a number up to 1e6");
  check_error(joint_to_c("<origin xyz=\"0 0 1e16\"/>"),
              q + " <origin>: xyz=\"1e16\" is not a number up to 1e6");
  check_error(joint_to_c("", "revolute"),
              q + ": no element <limit> (required for a revolute joint)");
  check_error(joint_to_c("<limit lower=\"2\" upper=\"1\"/>", "revolute"),
              q + " <limit>: lower 2 is above upper 1");
  check_error(joint_to_c("<limit velocity=\"-1\"/>", "revolute"),
              q + " <limit>: velocity=\"-1\" is negative");
  check_error(joint_to_c("<limit upper=\"1,5\"/>", "revolute"),
              q + " <limit>: upper=\"1,5\" is not a number up to 1e6");
  check_error(joint_to_c("", "floating"), q + ": it has 6 coordinates (use a kinematic_tree)");
  check_error(joint_to_c("", "spherical"), q + ": unknown type \"spherical\" (expected revolute, "
                                               "continuous, prismatic, fixed, planar or floating)");
  check_error("<joint name=\"q\" type=\"fixed\"><child link=\"c\"/></joint>",
              q + ": no element <parent>");
  check_error("<joint name=\"q\" type=\"fixed\"><parent link=\"b\"/><child/></joint>",
              q + " <child>: no attribute \"link\"");
  check_error("<joint type=\"fixed\"/>", file + "5: <joint>: no attribute \"name\"");
  check_error("<joint name=\"q\"><parent link=\"b\"/><child link=\"c\"/></joint>",
              q + ": no attribute \"type\"");
  check_error("", "duet: " + path +
                      ": no joints connect the links \"a\" and \"c\": \"c\" has no parent joint");
  check_error("<joint name=\"q\" type=\"fixed\"><parent link=\"z\"/><child link=\"c\"/></joint>",
              q + " <parent>: no link \"z\"" + origins);
  // A joint with unknown links outside the chain is no error.
  check_error(
      joint_to_c("") +
          "<joint name=\"r\" type=\"fixed\"><parent link=\"y\"/><child link=\"z\"/></joint>",
      "");
  write(links + first + joint_to_c("<axis xyz=\"0 0 1\"/>"));
  const std::string missing = "duet: " + path + ": no link \"z\"" + origins;
  CHECK(message("a", "z") == missing);
  CHECK(message("z", "c") == missing);
  // The chain in the opposite direction.
  const auto back = read_urdf(path, "c", "a");
  CHECK(back.joint_names() == std::vector<std::string>{"q", "p"});
  const Eigen::Vector2d theta(.5, .7);
  CHECK(max_abs_difference(transform_matrix(back.pose(Eigen::Vector2d(.7, .5)) *
                                            read_urdf(path, "a", "c").pose(theta)),
                           Eigen::Matrix4d::Identity()) < 1e-15);
  CHECK_THROWS_WITH_AS(
      (void)read_urdf<1>(path, "a", "c"),
      ("duet: " + path + ": 2 moving joints from \"a\" to \"c\": use read_urdf<2>").c_str(),
      invalid_input);
}

TEST_CASE("read_urdf: unknown attributes are rejected, unknown elements are listed") {
  const std::string file = "duet: " + path + ":";
  const auto check_error = [&](const std::string& joint, const std::string& expected) {
    write(links + first + joint);
    CHECK(message("a", "a") == expected); // anywhere in the file
  };
  const std::string q = file + "5: <joint name=\"q\">";
  const std::string unknown = ": unknown attribute ";
  check_error(joint_to_c("<limit lowr=\"-1\" upper=\"1\"/>"),
              q + " <limit>" + unknown +
                  "\"lowr\": there are \"lower\", \"upper\", \"jerk\", \"effort\", \"velocity\", "
                  "\"acceleration\" and 1 more");
  check_error(joint_to_c("<axis xzy=\"1 0 0\"/>"),
              q + " <axis>" + unknown + "\"xzy\": there are \"xyz\"");
  check_error(joint_to_c("<origin xyz=\"1 0 0\" rpY=\"0 0 0\"/>"),
              q + " <origin>" + unknown + "\"rpY\": there are \"rpy\", \"xyz\"");
  check_error(joint_to_c("<parent link=\"b\"/>"), q + " <parent>: it is repeated, first in line 5");
  check_error(joint_to_c("<axis/>\n<limit/><axis/>"),
              file + "6: <joint name=\"q\"> <axis>: it is repeated, first in line 5");
  check_error(joint_to_c("<safety_controller soft_lower=\"1\"/>"),
              q + " <safety_controller>" + unknown +
                  "\"soft_lower\": there are \"soft_lower_limit\", \"soft_upper_limit\", "
                  "\"k_velocity\", \"k_position\"");
  check_error("<joint name=\"q\" typ=\"fixed\"/>",
              q + unknown + "\"typ\": there are \"type\", \"name\"");
  check_error("<link nam=\"q\"/>",
              file + "5: <link>" + unknown + "\"nam\": there are \"name\", \"type\"");
  // Repeated names.
  check_error("<link name=\"b\"/>", file + "5: <link name=\"b\">: it is repeated, first in line 3");
  check_error(joint_to_c("") + "<link name=\"d\"/>\n<joint name=\"q\" type=\"fixed\"><parent "
                               "link=\"a\"/><child link=\"d\"/></joint>",
              file + "7: <joint name=\"q\">: it is repeated, first in line 5");
  check_error(
      joint_to_c("") +
          "<joint name=\"r\" type=\"fixed\"><parent link=\"a\"/><child link=\"c\"/></joint>",
      file + "6: <joint name=\"r\">: the link \"c\" already has the parent joint \"q\" of line 5");
  // Attributes and elements of other programs.
  check_error(joint_to_c("<axis xyz=\"0 0 1\" rpy=\"0 0 0\"/><limit command_effort=\"1\"/>"), "");
  check_error(joint_to_c("<dynamics D=\"1\" mu_coulomb=\"0\"/><calibration rising=\"0\"/>"), "");
  check_error("<link name=\"x\" xmlns:v=\"w\" v:y=\"1\"><visual any=\"1\"/></link>"
              "<gazebo any=\"1\"/><transmission><joint name=\"q\" any=\"1\"/></transmission>",
              "");
  CHECK(read_urdf_summary(path).unknown.empty());
  CHECK(to_text(read_urdf_summary(path)).find("unknown") == std::string::npos);
  // Unknown elements.
  write(links + first + joint_to_c("<orgin xyz=\"1 0 0\"/>\n<Axis/>") +
        "<v:tool/>\n<link name=\"x\"><contact/></link>");
  const auto names = read_urdf_summary(path);
  CHECK(to_text(names) == "links:\n  a\n  b\n  c\n  x\njoints:\n  p: prismatic, a -> b\n"
                          "  q: continuous, b -> c\nunknown elements:\n"
                          "  line 5: <orgin> in <joint name=\"q\">\n"
                          "  line 6: <Axis> in <joint name=\"q\">\n"
                          "  line 7: <v:tool> in <robot name=\"r\">\n"
                          "  line 8: <contact> in <link name=\"x\">\n");
  CHECK(read_urdf(path, "a", "c").unknown().size() == 4);
  CHECK(read_urdf(path, "a", "c").unknown()[0].name == "orgin");
}

TEST_CASE("read_urdf: soft limits narrow, and bounds beyond 1e6 are infinite") {
  const auto limits_of = [&](const std::string& inside, const std::string& type = "revolute") {
    write(links + first + joint_to_c(inside, type));
    return read_urdf(path, "b", "c").limits(0);
  };
  for (const std::string none : {"1e16", "1.0e+16", "inf", "1000001"}) {
    const auto all = limits_of("<limit lower=\"-" + (none[0] == '+' ? none.substr(1) : none) +
                               "\" upper=\"" + none + "\" velocity=\"" + none + "\"/>");
    CHECK(all.lower == -INFINITY);
    CHECK(all.upper == INFINITY);
    CHECK(all.velocity == INFINITY);
  }
  CHECK(limits_of("<limit lower=\"-1e6\" upper=\"1e6\"/>").lower == -1e6);
  CHECK(limits_of("<limit lower=\"-1e16\" upper=\"1\"/>").upper == 1);
  const std::string hard = "<limit lower=\"-2\" upper=\"3\" velocity=\"4\"/>";
  const auto soft = limits_of(
      hard +
      "<safety_controller soft_lower_limit=\"-1\" soft_upper_limit=\"2.5\" k_velocity=\"1\"/>");
  CHECK(soft.lower == -1);
  CHECK(soft.upper == 2.5);
  CHECK(soft.velocity == 4);
  const auto wide =
      limits_of("<safety_controller soft_lower_limit=\"-9\" soft_upper_limit=\"9\"/>" + hard);
  CHECK(wide.lower == -2);
  CHECK(wide.upper == 3);
  const auto half = limits_of(hard + "<safety_controller soft_upper_limit=\"1\"/>");
  CHECK(half.lower == -2);
  CHECK(half.upper == 1);
  CHECK(limits_of(hard + "<safety_controller k_velocity=\"1\"/>").lower == -2);
  CHECK(limits_of(hard + "<safety_controller soft_upper_limit=\"1\"/>", "continuous").upper ==
        INFINITY);
  const std::string q = "duet: " + path + ":5: <joint name=\"q\">";
  const auto error_of = [&](const std::string& inside) {
    write(links + first + joint_to_c(inside, "revolute"));
    return message();
  };
  CHECK(error_of("<limit lower=\"1e16\" upper=\"1e17\"/>") ==
        q + " <limit>: lower=\"1e16\" is not a number up to 1e6");
  CHECK(error_of("<limit lower=\"-2\" upper=\"-1e16\"/>") ==
        q + " <limit>: upper=\"-1e16\" is not a number up to 1e6");
  CHECK(error_of("<limit lower=\"nan\"/>") ==
        q + " <limit>: lower=\"nan\" is not a number up to 1e6");
  CHECK(error_of(hard + "<safety_controller soft_lower_limit=\"4\"/>") ==
        q + " <safety_controller>: the soft limits contain no coordinate within those of <limit>");
  std::filesystem::remove(path);
}

TEST_CASE("read_urdf: cycles, broken and missing files are rejected") {
  const std::string file = "duet: " + path + ":";
  write(links + "<joint name=\"q\" type=\"fixed\"><parent link=\"b\"/><child link=\"c\"/></joint>\n"
                "<joint name=\"r\" type=\"fixed\"><parent link=\"c\"/><child link=\"b\"/></joint>");
  CHECK(message() == file + "5: <joint name=\"r\">: it closes a cycle at the link \"c\"");
  CHECK(message("c", "a") == file + "5: <joint name=\"r\">: it closes a cycle at the link \"c\"");
  std::ofstream(path) << "<robot>\n<link name=\"a\">\n</robot>\n";
  CHECK(message() == file + "3: mismatched tag, in <link> of line 2");
  std::ofstream(path) << "<?xml version=\"1.0\"?>\n<sdf/>\n";
  CHECK(message() == file + "2: the root is <sdf> (expected <robot>)");
  std::filesystem::remove(path);
  CHECK(message() == "duet: " + path + ": cannot be read");
}

TEST_CASE("read_urdf: malformed XML is rejected with line and element") {
  const std::string file = "duet: " + path + ":";
  const auto error_of = [&](const std::string& text) {
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
  CHECK(error_of(nested(99, "<x>", "</x>")).empty());
  const std::string deep = file + "1: elements are nested more than 100 deep, in <x> of line 1";
  CHECK(error_of(nested(100, "<x>", "</x>")) == deep);
  CHECK(error_of(nested(200000, "<x>", "</x>")) == deep);
  // Text that only looks like tags.
  CHECK(error_of(
            nested(1, "<!--<x><x>--><?p <x>?><y z='&lt;x>' w = \"&lt;x>\" /><![CDATA[<x>]]>", ""))
            .empty());
  const std::string in_a = ", in <link> of line 2";
  const std::string invalid = "not well-formed (invalid token)";
  CHECK(error_of("<robot>\n<link name=\"a\"></robot>\n</link>") ==
        file + "2: mismatched tag" + in_a);
  CHECK(error_of("<robot>\n<link name=\"a\">\n</link>\n") ==
        file + "4: no element found, in <robot> of line 1");
  CHECK(error_of("<robot/>\n</robot>") == file + "2: " + invalid);
  CHECK(error_of("<robot><link name=\"a\"/></robot>\n\ntext") ==
        file + "3: junk after document element");
  CHECK(error_of("<robot><link name=\"a\"/></robot>\n<robot/>") ==
        file + "2: junk after document element");
  CHECK(error_of("<robot>\n<!-- </robot>") == file + "2: unclosed token, in <robot> of line 1");
  CHECK(error_of("<robot>\n<link name=\"a\" name=\"b\"/></robot>") ==
        file + "2: duplicate attribute, in <robot> of line 1");
  CHECK(error_of("<robot>\n<link name=\"&a;\"/></robot>") ==
        file + "2: undefined entity, in <robot> of line 1");
  CHECK(error_of("<robot>\n<link name=\"a\">&nbsp;</link></robot>") ==
        file + "2: undefined entity" + in_a);
  for (const char* broken : {"<robot a=>", "<robot a>", "<robot a='<'/>", "<robot / >", "< robot>",
                             "<robot &#0;/>", "<robot a='\xff'/>"}) {
    CHECK(error_of(broken) == file + "1: " + invalid);
  }
  CHECK(error_of("<robot a=\"b>") == file + "1: unclosed token");
  CHECK(error_of(std::string("<robot>\n\0</robot>", 18)) ==
        file + "2: " + invalid + ", in <robot> of line 1");
  CHECK(error_of("<robot a='&#0;'/>") == file + "1: reference to invalid character number");
  CHECK(error_of("<!DOCTYPE robot [<!ENTITY a \"&b;&b;\">]><robot>&a;</robot>") ==
        file + "1: document types, <!DOCTYPE, are not supported");
  CHECK(error_of("<!DOCTYPE robot SYSTEM \"x.dtd\"><robot/>") ==
        file + "1: document types, <!DOCTYPE, are not supported");
  CHECK(error_of("") == file + "1: no element found");
  CHECK(error_of("\xef\xbb\xbf<robot><link name=\"a\"/></robot>").empty()); // a byte order mark
  CHECK(error_of(
            "<?xml version='1.0' encoding='ISO-8859-1'?><robot><link name='a'/><link name='\xe4'/>"
            "</robot>")
            .empty());
  CHECK(read_urdf_summary(path).links[1] == "\xc3\xa4");
  CHECK(error_of("<?xml version='1.0' encoding='none'?><robot/>") == file + "1: unknown encoding");
  CHECK(error_of(std::string((1U << 24U) + 1, ' ')) == "duet: " + path + ": has more than 16 MB");
  std::filesystem::remove(path);
  std::filesystem::create_directory(path);
  CHECK(message() == "duet: " + path + ": is a folder, not a file");
  std::filesystem::remove(path);
}

TEST_CASE("read_urdf: fixed joints do not count towards the capacity") {
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

TEST_CASE("read_urdf: link frames and Jacobians of a chain with joints counted at run time") {
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

TEST_CASE("read_urdf_summary: lists names, and an unknown link suggests similar ones") {
  write(links + first + joint_to_c("<axis xyz=\"0 0 1\"/>"));
  const auto names = duet::read_urdf_summary(path);
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

TEST_CASE("read_urdf: control characters in names are escaped in errors") {
  write("<link name=\"a\"/><link name=\"\xc2\x9b"
        "2J\"/>"
        "<joint name=\"\xc2\x9b\"><parent link=\"a\"/><child link=\"\xc2\x9b"
        "2J\"/></joint>");
  CHECK(message() == "duet: " + path + ":3: <joint name=\"\\xc2\\x9b\">: no attribute \"type\"");
  write("<link name=\"a\"/><link name=\"\xc2\x9b"
        "2J\"/>");
  CHECK(message("a", "\n") ==
        "duet: " + path + ": no link \"\\n\": there are \"a\", \"\\xc2\\x9b2J\"");
  CHECK(message("a", "\x1b[2J") ==
        "duet: " + path + ": no link \"\\x1b[2J\": there are \"\\xc2\\x9b2J\", \"a\"");
  write("<link name=\"\x1b[2J\"/>"); // a character that XML does not permit
  CHECK(message() == "duet: " + path + ":3: not well-formed (invalid token), in <robot> of line 2");
  std::filesystem::remove(path);
}

TEST_CASE("read_urdf: files of real robots agree with the built-in arms") {
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
    CHECK(max_abs_difference(transform_matrix(panda.pose(theta)),
                             transform_matrix(known.pose(theta))) < 4e-15);
    CHECK(max_abs_difference(jacobian(panda, theta, frame::body),
                             jacobian(known, theta, frame::body)) < 4e-15);
    CHECK(max_abs_difference(transform_matrix(panda.pose(theta, panda.link("panda_link4"))),
                             transform_matrix(known.pose(theta, 4))) < 4e-15);
  }
  // Fingers: the second one mimics the first.
  CHECK(read_urdf(folder + "panda.urdf", "panda_link0", "panda_leftfinger").size() == 8);
  CHECK_THROWS_AS((void)read_urdf(folder + "panda.urdf", "panda_link0", "panda_rightfinger"),
                  invalid_input);
  const auto tiago = read_urdf(folder + "tiago_no_hand.urdf", "base_link", "arm_7_link");
  CHECK(tiago.size() == 8);
  CHECK(tiago.kind(0) == joint_kind::prismatic);
  // The soft limits of the arm apply.
  CHECK(tiago.limits(1).upper == 2.67889357189);
  CHECK(read_urdf(folder + "double_pendulum.urdf", "base_link", "link2").size() == 2);
  CHECK(read_urdf(folder + "ur5_robot.urdf", "base_link", "tool0").size() == 6);
}

} // namespace
} // namespace test_io_urdf
