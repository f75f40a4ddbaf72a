// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"

#include <duet/dual_quaternion/pose.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/spline/adaptive_table.hpp>
#include <duet/spline/look_up_table.hpp>
#include <duet/spline/table_file.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

namespace test_spline_look_up_table {
namespace {

using duet::vector3;
using rotation = duet::quaternion<double>;
using screw = duet::dual<double, 1, duet::screw_tag>;
using pose_type = duet::dual_quaternion<double>;
using rotation_curve = duet::cumulative_bspline<double>;
using pose_curve = duet::cumulative_bspline<screw>;

/// Slow turning with a fast piece around u = 1.
rotation turning(double u) {
  return duet::from_rotation_vector(
      vector3<double>(0.3 * u, 0.2 * std::sin(u), 0.1 * std::tanh(20 * (u - 1))));
}
pose_type moving(double u) {
  return duet::pose(turning(u), vector3<double>(std::cos(u), std::sin(2 * u), 0.1 * u));
}

template <class Spline, class F>
double largest_error(const Spline& s, const F& f) {
  double largest = 0;
  for (int i = 0; i <= 20'000; ++i) {
    const double u = 3.0 * i / 20'000;
    largest = std::max(largest, duet::detail::miss(s(u), f(u), 1.0));
  }
  return largest;
}

template <class T, class F>
duet::look_up_table<T> uniform_table(const F& f, int rows) {
  duet::look_up_table<T> table;
  for (int i = 0; i <= rows; ++i) {
    table.parameters.push_back(3.0 * i / rows);
    table.elements.push_back(f(table.parameters.back()));
  }
  return table;
}

} // namespace

TEST_CASE("a table is as dense as its error bound asks for") {
  for (const double tolerance : {1e-3, 1e-5, 1e-6}) {
    const auto result = duet::adaptive_table<rotation_curve>(turning, 0.0, 3.0, tolerance);
    CHECK(result.error <= tolerance);
    CHECK(largest_error(result.curve, turning) <= 1.1 * tolerance);
  }
  const auto result = duet::adaptive_table<rotation_curve>(turning, 0.0, 3.0, 1e-6);
  const auto rows = int(result.table.parameters.size());
  const auto uniform = uniform_table<double>(turning, rows - 1);
  const auto s =
      duet::interpolate<rotation_curve>(uniform.parameters, uniform.elements, duet::not_a_knot{});
  CHECK(largest_error(s, turning) > 20e-6); // as many rows, evenly spread
  CHECK(result.table.parameters.front() == 0.0);
  CHECK(result.table.parameters.back() == 3.0);
}

TEST_CASE("a table of poses weighs shifts by the length") {
  const auto near = duet::adaptive_table<pose_curve>(moving, 0.0, 3.0, 1e-5);
  CHECK(largest_error(near.curve, moving) <= 1.1e-5);
  const auto coarse = duet::adaptive_table<pose_curve>(moving, 0.0, 3.0, 1e-5, duet::not_a_knot{},
                                                       {.length = 1e-3});
  CHECK(coarse.table.parameters.size() != near.table.parameters.size());
}

TEST_CASE("the error of a table is estimated from the table alone") {
  for (const int rows : {400, 401, 800}) {
    const auto table = uniform_table<double>(turning, rows);
    const auto errors = duet::estimated_errors<rotation_curve>(table);
    CHECK(errors.size() == table.parameters.size() - 2);
    const auto s =
        duet::interpolate<rotation_curve>(table.parameters, table.elements, duet::not_a_knot{});
    const double estimate = *std::max_element(errors.begin(), errors.end());
    const double truth = largest_error(s, turning);
    CHECK(estimate > truth / 3);
    CHECK(estimate < truth * 3);
    // Largest where the motion is fast.
    const auto worst = std::max_element(errors.begin(), errors.end()) - errors.begin() + 1;
    CHECK(std::abs(table.parameters[std::size_t(worst)] - 1) < 0.15);
  }
}

TEST_CASE("tables are saved and loaded with all digits") {
  const auto path = std::string("look_up_table_test.csv");
  const auto rotations = uniform_table<double>(turning, 50);
  duet::save_table(path, rotations);
  const auto same = duet::load_table<double>(path);
  CHECK(same.parameters == rotations.parameters);
  for (std::size_t i = 0; i < same.elements.size(); ++i) {
    CHECK(same.elements[i] == rotations.elements[i]);
  }
  const auto poses = uniform_table<screw>(moving, 50);
  duet::save_table(path, poses);
  const auto again = duet::load_table<screw>(path);
  CHECK(again.parameters == poses.parameters);
  for (std::size_t i = 0; i < again.elements.size(); ++i) {
    CHECK(duet::detail::miss(again.elements[i], poses.elements[i], 1.0) <= 1e-15);
  }
  std::remove(path.c_str());
}

TEST_CASE("the names in a header tell the columns; doubt is an error") {
  const auto path = std::string("look_up_table_names.csv");
  const auto write = [&](const std::string& text) { std::ofstream(path) << text; };
  const rotation q(.1, .3, .9, .3);
  const auto loaded = [&](const std::string& text) {
    write(text);
    return duet::load_table<double>(path).elements.at(0);
  };
  CHECK(loaded("t,qx,qy,qz,qw\n0,.3,.9,.3,.1\n") == normalized(q));
  CHECK(loaded("# timestamp tx ty tz qx qy qz qw\n0 1 2 3 .3 .9 .3 .1\n") == normalized(q));
  CHECK(loaded("\xef\xbb\xbfQ_Z , q.w (), Time [s], qy [],speed,Qx\r\n.3,.1,0,.9,a,.3\r\n") ==
        normalized(q));
  CHECK(loaded("#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], "
               "q_RS_y [], q_RS_z []\n7,1,2,3,.1,.3,.9,.3\n") == normalized(q));
  CHECK(
      loaded(
          "# columns: t qx qy qz qw\n# t in hours, by hand\n# qw is the cosine\n0 .3 .9 .3 .1\n") ==
      normalized(q));
  write("stamp,orientation_w,orientation_x,orientation_y,orientation_z,position_z,position_y,"
        "position_x\n0,.1,.3,.9,.3,3,2,1\n");
  const auto a = duet::load_table<screw>(path).elements.at(0);
  CHECK(duet::rotation(a) == normalized(q));
  CHECK((duet::translation(a) - vector3<double>(1, 2, 3)).norm() < 1e-15);
  write("t_s,t_x,t_y,t_z,q_w,q_x,q_y,q_z\n0,1,2,3,.1,.3,.9,.3\n");
  CHECK(duet::load_table<screw>(path).elements.at(0) == a);

  const auto complaint = [&](const std::string& text) {
    write(text);
    return duet_test::message_of<duet::file_error>(
        [&] { static_cast<void>(duet::load_table<double>(path)); });
  };
  const auto is_told = [](const std::string& message) {
    return message.ends_with(duet::detail::known_columns);
  };
  // A table without names, and that of a recording without its comment: w last or first?
  for (const char* unnamed :
       {"0,.3,.9,.3,.1\n", "1305031098.6659,1.3563,0.6305,1.6380,0.6132,0.5962,"
                           "-0.3311,-0.3986\n"}) {
    const std::string message = complaint(unnamed);
    CHECK(message.starts_with("duet: " + path +
                              ":1: no header before the first row says which column is "));
    CHECK(is_told(message));
  }
  CHECK(complaint("t,q0,q1,q2,q3\n0,.1,.3,.9,.3\n")
            .starts_with("duet: " + path + ":1: the header names no column qw: known are u "));
  CHECK(is_told(complaint("u,w,x,y,z\n0,.1,.3,.9,.3\n")));
  CHECK(is_told(complaint("# t q0 q1 q2 q3\n0 .1 .3 .9 .3\n")));
  CHECK(complaint("qw,qx,qy,qz\n.1,.3,.9,.3\n")
            .starts_with("duet: " + path + ":1: the header names no column u"));
  CHECK(complaint("t,u,qw,qx,qy,qz\n0,0,.1,.3,.9,.3\n") ==
        "duet: " + path + ":1: the header has both 't' and 'u'");
  CHECK(complaint("# t qx qy qz qw norm\n0 .3 .9 .3 .1\n") ==
        "duet: " + path + ":1: the comment names 6 columns, the rows have 5");
  std::remove(path.c_str());
}

TEST_CASE("bad tables and bounds are named") {
  const auto path = std::string("look_up_table_bad.csv");
  const auto loading = [&](const std::string& text) {
    std::ofstream(path) << text;
    try {
      static_cast<void>(duet::load_table<double>(path));
    } catch (const duet::file_error& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  const std::string header = "u,qw,qx,qy,qz\n";
  CHECK(loading(header + "0,1,0,0\n") == "duet: " + path + ":2: 5 columns expected, got 4");
  CHECK(loading(header + "0,1,0,0,0\n1,2,0,0,0\n") ==
        "duet: " + path +
            ":3: the quaternion has norm 2, not 1: are its columns what the header says?");
  CHECK(loading(header + "0,1,0,0,0\n\n0,1,0,0,0\n") ==
        "duet: " + path + ":4: parameter 0 does not increase, the row before has 0");
  CHECK(loading(header + "0,1,0,0,nan\n") == "duet: " + path + ":2: qz is nan");
  CHECK(loading(header + "1e400,1,0,0,0\n") ==
        "duet: " + path + ":2: u is 1e400, beyond the range of a double");
  CHECK(loading(header + "1e-400,1,0,0,0\n") ==
        "duet: " + path + ":2: u is 1e-400, beyond the range of a double");
  CHECK(loading(header + "0,1,0,o,0\n") == "duet: " + path + ":2: qy is not a number: 'o'");
  CHECK(loading(header) == "duet: " + path + ": holds no rows");
  std::remove(path.c_str());

  const auto message = [](double first, double last, double tolerance, std::size_t most) {
    try {
      static_cast<void>(duet::adaptive_table<rotation_curve>(
          turning, first, last, tolerance, duet::not_a_knot{}, {.most_rows = most}));
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  CHECK(message(1, 1, 1e-3, 100) ==
        "duet: adaptive_table: from 1 to 1 with tolerance 0.001: the range must not be empty, the "
        "tolerance positive");
  CHECK(message(0, 1, 0, 100).find("tolerance 0:") != std::string::npos);
  CHECK(message(0, 3, 1e-9, 100).find("more than 100 are not allowed") != std::string::npos);
  CHECK_THROWS_AS(
      static_cast<void>(duet::estimated_errors<rotation_curve>(uniform_table<double>(turning, 7))),
      duet::invalid_input);
}

} // namespace test_spline_look_up_table
