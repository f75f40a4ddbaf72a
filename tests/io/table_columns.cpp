// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>
#include <duet/io.hpp>

#include <cstdio>
#include <fstream>

namespace test_io_table_columns {
namespace {

using duet::table_columns;
using duet::vector3;
using rotation = duet::quaternion<double>;
using screw = duet::screw_dual<double>;

const std::string path = "test_io_table_columns.txt";

/// Table over T from a file of this text.
template <class T>
duet::lookup_table<T> loaded(const std::string& text, const table_columns& columns = {}) {
  std::ofstream(path, std::ios::binary) << text;
  const auto table = duet::load_table<T>(path, columns);
  std::remove(path.c_str());
  return table;
}

/// Error of `load_table` without the name of the file.
template <class T = screw>
std::string error_message(const std::string& text, const table_columns& columns = {}) {
  const std::string message =
      duet_test::message_of<duet::file_error>([&] { (void)loaded<T>(text, columns); });
  std::remove(path.c_str());
  const std::string begin = "duet: " + path + ":";
  REQUIRE(message.starts_with(begin));
  CHECK(message.find('\n') == message.npos);
  return message.substr(begin.size());
}

/// Row `0.5 1 2 3` with a rotation, and that pose.
const rotation q(0.1, 0.3, 0.9, 0.3);
void check_pose(const duet::lookup_table<screw>& table, double time = 0.5) {
  REQUIRE(table.parameters.size() == 1);
  CHECK(table.parameters[0] == time);
  CHECK(duet::rotation(table.elements[0]) == normalized(q));
  CHECK((duet::translation(table.elements[0]) - vector3<double>(1, 2, 3)).norm() < 1e-15);
}

TEST_CASE("load_table with a stated header: every order of the columns, with other columns") {
  const std::array<std::string, 9> names{"t", "x", "y", "z", "qw", "qx", "qy", "qz", "speed"};
  const std::array<std::string, 9> cells{"0.5", "1", "2", "3", ".1", ".3", ".9", ".3", "7"};
  std::array<std::size_t, 9> order{};
  std::iota(order.begin(), order.end(), std::size_t(0));
  duet_test::random_source random(3);
  for (int i = 0; i < 200; ++i) {
    for (std::size_t k = order.size() - 1; k > 0; --k) {
      const double part = random.uniform(0, double(k + 1));
      std::swap(order[k], order[std::min(std::size_t(part), k)]);
    }
    std::string header, row;
    for (const std::size_t k : order) {
      header += (header.empty() ? "" : ", ") + names[k];
      row += (row.empty() ? "" : i % 2 == 0 ? " " : ",") + cells[k];
    }
    CAPTURE(header);
    check_pose(loaded<screw>(row + "\n", {.header = header}));
    check_pose(loaded<screw>("# " + header + "\n" + row + "\n", {.header = header}));
    check_pose(loaded<screw>(header + "\n" + row + "\n", {.header = header}));
  }
  // Four numbers that a file calls q0 to q3, and eight numbers with commas.
  check_pose(loaded<screw>("t,x,y,z,q0,q1,q2,q3\n0.5,1,2,3,.1,.3,.9,.3\n",
                           {.header = "t x y z qw qx qy qz"}));
  check_pose(loaded<screw>("0.5,1,2,3,.3,.9,.3,.1\n", {.header = "t,x,y,z,qx,qy,qz,qw"}));
  check_pose(loaded<screw>("500,1,2,3,.3,.9,.3,.1\n", {.header = "t [ms],x,y,z,qx,qy,qz,qw"}));
  // Euler angles, in a recording.
  const duet::euler_columns angles(duet::zyx, {"yaw", "pitch", "roll"}, duet::angle_unit::degree);
  std::ofstream(path) << "0 0 0 90\n1 0 nan 90\n2 0 0 90\n";
  const auto recorded =
      duet::load_recording<double>(path, {.header = "t roll pitch yaw", .angles = angles});
  CHECK(recorded.table.parameters == std::vector<double>{0, 2});
  CHECK(recorded.faults.at(0).reason == "pitch is nan: left out");
  const double quarter = std::acos(0.0);
  CHECK(norm(recorded.table.elements[0] - duet::from_euler<duet::zyx>(quarter, 0.0, 0.0)) < 4e-16);
}

TEST_CASE("load_table with a stated header: errors name what does not fit") {
  const std::string row = "0.5,1,2,3,.1,.3,.9,.3\n";
  CHECK(error_message(row, {.header = "t x y z qw qx qy"})
            .starts_with(" stated columns: the header names no column qz: known columns are "));
  CHECK(error_message(row, {.header = "t x y z qw qx qy qz qz"}) ==
        " stated columns: the header has both 'qz' and 'qz'");
  CHECK(error_message(row, {.header = "t x y z qw qx qy qz speed"}) ==
        "1: 9 columns expected, got 8");
  CHECK(error_message("t,x,y,z,qx,qy,qz,qw\n" + row, {.header = "t x y z qw qx qy qz"}) ==
        "1: the file names column 5 'qx', but the stated header has 'qx' in column 6");
  CHECK(error_message("# t x y z qx qy qz qw\n" + row, {.header = "t x y z qw qx qy qz"}) ==
        "1: the file names column 5 'qx', but the stated header has 'qx' in column 6");
  CHECK(error_message(row + "1,1,2,3,.1,one,.9,.3\n", {.header = "t x y z qw qx qy qz"}) ==
        "2: qx is not a number: 'one'");
  CHECK(error_message("0.5,1,2,3,1,.3,.9,.3\n", {.header = "t x y z qw qx qy qz"})
            .starts_with("1: the quaternion of qw, qx, qy, qz has norm 1.41"));
}

TEST_CASE("load_recording: seconds and nanoseconds of two columns are exact to the nanosecond") {
  using names = std::pair<std::string, std::string>;
  for (const names& each :
       {names("sec", "nanosec"), names("secs", "nsecs"), names("stamp_sec", "stamp_nsec"),
        names("header.stamp.sec", "header.stamp.nanosec"),
        names("/imu/header/stamp/sec", "/imu/header/stamp/nanosec"),
        names("field.header.stamp.secs", "field.header.stamp.nsecs")}) {
    const auto& seconds = each.first;
    const auto& nanoseconds = each.second;
    CAPTURE(seconds);
    std::string text = "qx,qy,qz,qw," + nanoseconds + "," + seconds + "\n";
    const std::int64_t first = 1'403'636'580'999'999'950; // the second changes after 50 rows
    for (std::int64_t i = 0; i < 100; ++i) {
      const std::int64_t time = first + i;
      text += "0,0,0,1," + std::to_string(time % 1'000'000'000) + "," +
              std::to_string(time / 1'000'000'000) + "\n";
    }
    std::ofstream(path) << text;
    const auto r = duet::load_recording<double>(path);
    std::remove(path.c_str());
    CHECK(r.start == 1403636580.99999995);
    CHECK(r.faults.empty());
    REQUIRE(r.table.parameters.size() == 100);
    for (std::size_t i = 0; i < 100; ++i) {
      CHECK(std::abs(r.table.parameters[i] - 1e-9 * double(i)) < 1.2e-16);
    }
  }
  // Random times of either sign: the nearest double.
  duet_test::random_source random(5);
  for (int i = 0; i < 200; ++i) {
    const auto time = std::int64_t(random.uniform(-9e18, 9e18));
    const std::int64_t rest = ((time % 1'000'000'000) + 1'000'000'000) % 1'000'000'000;
    const std::string text = "sec nanosec qw qx qy qz\n" +
                             std::to_string((time - rest) / 1'000'000'000) + " " +
                             std::to_string(rest) + " 1 0 0 0\n";
    const double read = loaded<double>(text).parameters[0];
    CHECK(
        read ==
        loaded<double>("t [ns],qw,qx,qy,qz\n" + std::to_string(time) + ",1,0,0,0\n").parameters[0]);
  }
  // As other programs write whole numbers; the time of arrival is ignored in either order.
  CHECK(loaded<double>("sec,nanosec,qw,qx,qy,qz\n-1,5.0e8,1,0,0,0\n").parameters[0] == -0.5);
  CHECK(loaded<double>("1.0,500000000.0,1,0,0,0\n", {.header = "secs nsecs qw qx qy qz"})
            .parameters[0] == 1.5);
  for (const char* times : {"%time,header.stamp.nsecs,header.stamp.secs\n9,5,7",
                            "header.stamp.secs,header.stamp.nsecs,__time\n7,5,9",
                            "__time,header.stamp.secs,header.stamp.nsecs\n9,7,5"}) {
    std::string text = times;
    text.replace(text.find('\n'), 1, ",qw,qx,qy,qz\n");
    CHECK(loaded<double>(text + ",1,0,0,0\n").parameters[0] == 7.000000005);
  }
}

TEST_CASE("load_table: errors in seconds and nanoseconds name the line, the column and the value") {
  const auto of_row = [](const std::string& row) {
    return error_message<double>("sec,nanosec,qw,qx,qy,qz\n0,0,1,0,0,0\n" + row + ",1,0,0,0\n");
  };
  CHECK(of_row("1,1000000000") ==
        "3: nanosec is 1000000000 (expected an integer from 0 to 999999999)");
  CHECK(of_row("1,-1") == "3: nanosec is -1 (expected an integer from 0 to 999999999)");
  CHECK(of_row("1.5,0") == "3: sec is 1.5 (expected an integer from -9e+09 to 9e+09)");
  CHECK(of_row("1403636580868555648,0") ==
        "3: sec is 1403636580868555648 (expected an integer from -9e+09 to 9e+09)");
  CHECK(of_row("1,nan") == "3: nanosec is nan");
  CHECK(of_row("1,soon") == "3: nanosec is not a number: 'soon'");
  CHECK(of_row("0,0") == "3: parameter 0 does not increase, the row before has 0");
  CHECK(error_message<double>("sec,qw,qx,qy,qz\n1,1,0,0,0\n") ==
        "1: the header has 'sec', but names no column nanosec");
  CHECK(error_message<double>("nsecs,qw,qx,qy,qz\n1,1,0,0,0\n") ==
        "1: the header has 'nsecs', but names no column sec");
  CHECK(error_message<double>("t,nsecs,qw,qx,qy,qz\n1,1,1,0,0,0\n") ==
        "1: the header has 'nsecs', but names no column sec");
  CHECK(error_message<double>("t,sec,nanosec,qw,qx,qy,qz\n1,1,1,1,0,0,0\n") ==
        "1: the header has both 't' and 'sec'");
  // In recordings such rows are left out.
  std::ofstream(path) << "sec nanosec qw qx qy qz\n0 0 1 0 0 0\n0 1e9 1 0 0 0\n1 0 1 0 0 0\n";
  const auto r = duet::load_recording<double>(path);
  std::remove(path.c_str());
  CHECK(r.table.parameters == std::vector<double>{0, 1});
  CHECK(r.faults.at(0).reason ==
        "nanosec is 1e9 (expected an integer from 0 to 999999999): left out");
}

TEST_CASE("load_table: names with a prefix, detected or stated") {
  const std::string row = "\n0.5,1,2,3,.1,.3,.9,.3\n";
  for (const char* header :
       {"t,pose.position.x,pose.position.y,pose.position.z,pose.orientation.w,"
        "pose.orientation.x,pose.orientation.y,pose.orientation.z",
        "__time,/imu/position/x,/imu/position/y,/imu/position/z,/imu/orientation/w,"
        "/imu/orientation/x,/imu/orientation/y,/imu/orientation/z",
        "\"mocap.t\",\"mocap.x\",\"mocap.y\",\"mocap.z\",\"mocap.qw\",\"mocap.qx\",\"mocap.qy\","
        "\"mocap.qz\"",
        "time,arm/tip_x,arm/tip_y,arm/tip_z,arm/tip_qw,arm/tip_qx,arm/tip_qy,arm/tip_qz",
        "# a.b.time,a.b.x,a.b.y,a.b.z,a.b.qw,a.b.qx,a.b.qy,a.b.qz"}) {
    CAPTURE(header);
    check_pose(loaded<screw>(header + row));
  }
  std::ofstream(path) << "robot.t,robot.qw,robot.qx,robot.qy,robot.qz\n0,1,0,0,0\n";
  CHECK(duet::load_recording<double>(path).remark == "columns of 'robot.'");

  // Two poses in a file, with one time or one each.
  const std::string two = "\n0.25,7,8,9,1,0,0,0,0.5,1,2,3,.1,.3,.9,.3\n";
  const std::string parts = "t,position.x,position.y,position.z,orientation.w,orientation.x,"
                            "orientation.y,orientation.z";
  const auto below = [&](std::string prefix) {
    std::string names = prefix + parts;
    for (std::size_t at = 0; (at = names.find(',', at)) != names.npos; ++at) {
      names.insert(at + 1, prefix);
    }
    return names;
  };
  const std::string both = below("left.pose.") + "," + below("right.pose.");
  for (const char* prefix : {"right.pose", "right.pose."}) {
    CAPTURE(prefix);
    check_pose(loaded<screw>(both + two, {.prefix = prefix}));
  }
  CHECK(loaded<screw>(both + two, {.prefix = "left.pose"}).parameters[0] == 0.25);
  std::string shared = both;
  shared.replace(shared.find("left.pose.t"), 11, "time");
  shared.replace(shared.find("right.pose.t"), 12, "note");
  check_pose(loaded<screw>(shared + two, {.prefix = "right"}), 0.25);
  CHECK(loaded<screw>(shared + two, {.prefix = "left"}).parameters[0] == 0.25);
  check_pose(loaded<screw>(two.substr(1), {.header = both, .prefix = "right.pose"}));
  const duet::euler_columns angles(duet::zyx, {"yaw", "pitch", "roll"}, duet::angle_unit::radian);
  CHECK(loaded<double>("t,b/roll,b/pitch,b/yaw,a/roll,a/pitch,a/yaw\n0,1,2,3,0,0,0\n",
                       {.prefix = "a", .angles = angles})
            .elements[0] == rotation(1));

  CHECK(error_message(both + two) ==
        "1: the header has the columns of 'left.pose.' and of 'right.pose.' "
        "(expected one of them as `table_columns::prefix`)");
  CHECK(error_message("t,a.qw,a.qx,a.qy,a.qz,b.qw,b.qx,b.qy,b.qz\n0,1,0,0,0,1,0,0,0\n", {})
            .starts_with("1: the header names no column x: "));
  CHECK(error_message<double>("t,a.qw,a.qx,a.qy,a.qz,b.qw,b.qx,b.qy,b.qz\n0,1,0,0,0,1,0,0,0\n")
            .starts_with("1: the header has the columns of 'a.' and of 'b.' "));
  CHECK(error_message(both + two, {.prefix = "middle"})
            .starts_with("1: the header names no column u"));
  CHECK(error_message(both + "\n0.25,7,8,9,1,0,0,0,0.5,1,2,3,.1,.3,.9,up\n",
                      {.prefix = "right.pose"}) ==
        "2: right.pose.orientation.z is not a number: 'up'");
}

} // namespace
} // namespace test_io_table_columns
