// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>
#include <duet/io.hpp>

#include <cstdio>
#include <fstream>

namespace test_io_recording {
namespace {

using rotation = duet::quaternion<double>;
using screw = duet::screw_dual<double>;

const std::string path = "test_io_recording.txt";

void write(const std::string& text, const std::string& to = path) {
  std::ofstream(to, std::ios::binary) << text;
}

/// Rows that were left out or moved, one a line.
std::string issues_of(const duet::recording<screw>& r) {
  std::string text;
  for (const duet::recording_issue& each : r.faults) {
    text += std::to_string(each.line) + ": " + each.reason + "\n";
  }
  return text;
}

TEST_CASE("load_recording: a file without invalid rows gives its table, with times from 0 on") {
  write("# timestamp tx ty tz qx qy qz qw\n-2 1 2 3 0 0 0 1\n-0.5 1 2 3 0 0 0.6 0.8\n");
  const auto r = duet::load_recording<screw>(path);
  const auto table = duet::load_table<screw>(path);
  CHECK(r.start == -2);
  CHECK(table.parameters == std::vector<double>{-2, -0.5});
  CHECK(r.table.parameters == std::vector<double>{0, 1.5});
  CHECK(r.table.elements == table.elements);
  CHECK(r.lines == std::vector<std::size_t>{2, 3});
  CHECK(r.faults.empty());
  CHECK(r.left_out == 0);
  CHECK(r.remark.empty());
  CHECK(duet::load_recording<double>(path).table.elements ==
        duet::load_table<double>(path).elements);
  std::remove(path.c_str());
}

TEST_CASE("load_recording: times of rostopic have a resolution of nanoseconds") {
  write("%time,field.header.stamp,field.pose.orientation.x,field.pose.orientation.y,"
        "field.pose.orientation.z,field.pose.orientation.w\n"
        "0,1403636580838555648,0,0,0,1\n0,1403636580843555649,0,0,0.6,0.8\n");
  const auto r = duet::load_recording<double>(path);
  CHECK(std::abs(r.table.parameters[1] - 0.005000001) < 1e-16);
  CHECK(r.remark == "field.header.stamp as rostopic writes it, in nanoseconds");
  std::remove(path.c_str());
}

TEST_CASE(
    "load_recording: invalid rows are left out, unordered ones sorted in, and all are listed") {
  write("3 1 2 3 0 0 0 1\n" // 1
        "1 1 2 3 0 0 0.6 0.8\n"
        "2 1 nan 3 0 0 0 1\n"
        "2 1 2 3 0 0 0 0.9\n"
        "4 1 2 3 0 0 0 1\n" // 5
        "3 0 0 0 0 0 0 1\n"
        "2.5 1 2 3 0 0 0 1\n"
        "1e400 1 2 3 0 0 0 1\n");
  const auto r = duet::load_recording<screw>(path);
  CHECK(r.start == 1);
  CHECK(r.table.parameters == std::vector<double>{0, 1.5, 2, 3});
  CHECK(r.lines == std::vector<std::size_t>{2, 7, 1, 5});
  CHECK(duet::rotation(r.table.elements[0]) == rotation(0.8, 0, 0, 0.6));
  CHECK((duet::translation(r.table.elements[2]) - duet::vector3<double>(1, 2, 3)).norm() < 1e-15);
  CHECK(r.left_out == 4);
  CHECK(issues_of(r) == "2: timestamp 1 is out of order: sorted in\n"
                        "3: ty is nan: left out\n"
                        "4: the quaternion of qw, qx, qy, qz has norm 0.9, not 1: left out\n"
                        "6: timestamp 3 repeats line 1: left out\n"
                        "7: timestamp 2.5 is out of order: sorted in\n"
                        "8: timestamp is 1e400, beyond the range of a double: left out\n");
  std::remove(path.c_str());
}

TEST_CASE("load_recording: differences of nanoseconds since 1970 have all digits") {
  std::string text = "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],"
                     "q_RS_y [],q_RS_z []\n";
  for (int i = 0; i < 1000; ++i) { // steps of 1 ns, far below the 238 ns of a double in seconds
    text += std::to_string(1'403'636'580'838'555'648 + i) + ",1,2,3,1,0,0,0\n";
  }
  write(text);
  const auto r = duet::load_recording<screw>(path);
  REQUIRE(r.table.parameters.size() == 1000);
  double largest = 0;
  for (int i = 0; i < 1000; ++i) {
    largest = std::max(largest, std::abs(r.table.parameters[std::size_t(i)] - 1e-9 * i));
  }
  CHECK(largest < 1.2e-16);
  CHECK(r.start == 1403636580.838555648);
  CHECK(r.remark == "a EuRoC file: timestamps in ns");
  CHECK(duet_test::message_of([] { (void)duet::load_table<screw>(path); }) ==
        "duet: " + path +
            ":3: parameter 1403636580.8385556 does not increase, the row before has "
            "1403636580.8385556");
  std::remove(path.c_str());
}

TEST_CASE("load_recording: times have all digits with exponents and in a separate file") {
  const std::string times = "test_spline_recording_epoch.txt";
  for (const bool is_kitti : {false, true}) {
    for (const char* unit : {"", "milliseconds", "microseconds", "nanoseconds"}) {
      std::string text, column;
      const std::string u = unit;
      for (int i = 0; i < 200; ++i) { // steps of 5 ms; a double of seconds holds 5.000114
        const int ms = 1000 + 5 * i;
        // 1.403636581000e+09 and so on: the digits are the same in every unit.
        const std::string cell = "1.40363658" + std::to_string(ms) +
                                 (u.empty()             ? "e+09"
                                  : u == "milliseconds" ? "e+12"
                                  : u == "microseconds" ? "e+15"
                                                        : "e+18");
        column += cell + "\n";
        text += is_kitti ? "1 0 0 0 0 1 0 0 0 0 1 0\n" : cell + " 0 0 0 0 0 0 1\n";
      }
      write(text);
      std::ofstream(times) << column;
      CAPTURE(unit);
      CAPTURE(is_kitti);
      const auto r = duet::load_recording<screw>(path, is_kitti ? times : "");
      double largest = 0;
      for (int i = 0; i < 200; ++i) {
        largest = std::max(largest, std::abs(r.table.parameters[std::size_t(i)] - .005 * i));
      }
      CHECK_LT(largest, 1.2e-16);
      CHECK((r.remark.find(unit) != std::string::npos || u.empty()));
    }
  }
  std::remove(times.c_str());
  std::remove(path.c_str());
}

TEST_CASE(
    "load_recording, KITTI: the other rows have their indices and times if a row is left out") {
  const std::string times = "test_spline_recording_times.txt";
  write("1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 -1 0\n1 0 0 5 0 1 0 0 0 0 1 0\n");
  write("10\n11\n12.5\n", times);
  const std::string issue = "2: the matrix is a reflection: det R = -1: left out\n";
  const auto numbered = duet::load_recording<screw>(path);
  CHECK(numbered.table.parameters == std::vector<double>{0, 2});
  CHECK(issues_of(numbered) == issue);
  CHECK(numbered.remark == "12 columns: read as in KITTI files, the matrix [R t] row by row");
  const auto timed = duet::load_recording<screw>(path, times);
  CHECK(timed.start == 10);
  CHECK(timed.table.parameters == std::vector<double>{0, 2.5});
  CHECK(issues_of(timed) == issue);
  std::remove(path.c_str());
  std::remove(times.c_str());
}

TEST_CASE("load_recording: errors for files without valid rows and for ragged rows") {
  const auto error_message = [](const std::string& text) {
    write(text);
    return duet_test::message_of<duet::file_error>([] { (void)duet::load_recording<screw>(path); });
  };
  CHECK(error_message("") == "duet: " + path + ": holds no usable rows");
  CHECK(error_message("0 1 2 3 0 0 0 0\n") == "duet: " + path + ": holds no usable rows");
  CHECK(error_message("0 1 2 3 0 0 0 1\n1 one 2 3 0 0 0 1\n") ==
        "duet: " + path + ":2: tx is not a number: 'one'");
  CHECK(error_message("0 1 2 3 0 0 0 1\n1 2 3 0 0 0 1\n") ==
        "duet: " + path + ":2: 8 columns expected, got 7");
  CHECK(error_message("t [s],x,y,z,qw,qx,qy,qz\n1e308,1,2,3,1,0,0,0\n-1e308,1,2,3,1,0,0,0\n") ==
        "duet: " + path +
            ":2: the difference of timestamp 1e+308 from -1e+308 in line 3 overflows");
  std::remove(path.c_str());
}

} // namespace
} // namespace test_io_recording
