// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>
#include <duet/io.hpp>

#include <clocale>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <locale>

namespace test_io_table_file {
namespace {

using duet::table_format;
using duet::vector3;
using rotation = duet::quaternion<double>;
using screw = duet::screw_dual<double>;
using rotations = duet::lookup_table<double>;
using poses = duet::lookup_table<screw>;

/// What messages about headers end with.
const std::string known_columns =
    "known columns are u (tau, t, time, timestamp; sec and nanosec), x y z (tx, px, p_x, p_RS_R_x "
    "...) and qw qx qy qz (q_w, q_RS_w ...), with units as in `t [s]`; Euler angles need "
    "`euler_columns`";

/// Temporary file that is removed at the end.
class scratch_file {
public:
  explicit scratch_file(const char* name) : path(std::string("test_spline_table_file_") + name) {}
  scratch_file(const char* name, const std::string& text) : scratch_file(name) { write(text); }
  ~scratch_file() { std::remove(path.c_str()); }
  void write(const std::string& text) const { std::ofstream(path, std::ios::binary) << text; }
  [[nodiscard]] std::string text() const {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  const std::string path;
};

/// Table over T that is read from a file with this text.
template <class T>
duet::lookup_table<T> loaded(const std::string& text) {
  const scratch_file file("loaded.txt", text);
  return duet::load_table<T>(file.path);
}

poses random_poses(std::size_t count, double first, double step) {
  duet_test::random_source random(7);
  const auto vector = [&](double size) -> vector3<double> {
    return size * vector3<double>(random.normal(), random.normal(), random.normal());
  };
  poses table;
  for (std::size_t i = 0; i < count; ++i) {
    table.parameters.push_back(first + double(i) * step);
    table.elements.push_back(duet::pose(duet::from_rotation_vector(vector(2)), vector(10)));
  }
  return table;
}

/// Largest difference of positions. Checks that the quaternions have the same bits.
double difference_of_positions(const poses& a, const poses& b) {
  REQUIRE(a.elements.size() == b.elements.size());
  double largest = 0;
  for (std::size_t i = 0; i < a.elements.size(); ++i) {
    CHECK(duet::rotation(a.elements[i]) == duet::rotation(b.elements[i]));
    const vector3<double> between =
        duet::translation(a.elements[i]) - duet::translation(b.elements[i]);
    largest = std::max(largest, between.norm());
  }
  return largest;
}

const std::string header_of_euroc =
    "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
    "q_RS_z []\n";

TEST_CASE("save_table, load_table: rotations have the same bits when read back") {
  const scratch_file file("rotations.csv");
  rotations table;
  const poses source = random_poses(50, -1.5, 0.1);
  table.parameters = source.parameters;
  for (const auto& pose : source.elements) {
    table.elements.push_back(duet::rotation(pose));
  }
  table.elements[3] = rotation(-0.0, 0.6, -0.0, -0.8);
  duet::save_table(file.path, table);
  const rotations again = duet::load_table<double>(file.path);
  CHECK(again.parameters == table.parameters);
  CHECK(again.elements == table.elements);
  CHECK(std::signbit(again.elements[3].w()));
  CHECK(std::signbit(again.elements[3].y()));
  CHECK(file.text().starts_with("u,qw,qx,qy,qz\n-1.5,"));
  CHECK(duet::load_table<rotation>(file.path).elements == table.elements);

  duet::save_table(file.path, table, table_format::csv_seconds);
  CHECK(file.text().starts_with("t [s],qw,qx,qy,qz\n-1.5,"));
  const rotations timed = duet::load_table<double>(file.path);
  CHECK(timed.parameters == table.parameters);
  CHECK(timed.elements == table.elements);
}

TEST_CASE("save_table, load_table: poses in every format have the same parameters and rotations "
          "when read back") {
  const scratch_file file("poses.txt"), times("times.txt");
  for (const double first : {0.0, -3.25, 1403636580.8385556}) {
    const poses table = random_poses(100, first, 0.005);
    for (const table_format format :
         {table_format::csv, table_format::csv_seconds, table_format::tum}) {
      duet::save_table(file.path, table, format);
      CHECK(file.text().starts_with("t [s],x,y,z,") == (format == table_format::csv_seconds));
      const poses again = duet::load_table<screw>(file.path);
      CHECK(again.parameters == table.parameters);
      CHECK(difference_of_positions(again, table) < 2e-14);
      CHECK(duet::load_table<duet::dual_quaternion<double>>(file.path).elements == again.elements);
    }
  }
  // Nearest doubles to integer nanoseconds, and any doubles from 2^23 s on.
  poses table = random_poses(100, 0, 0);
  for (const double first : {-1.0, 0.0, 12345.0, 8388608.0, 1403636580.8385556, 9.19e9}) {
    for (std::size_t i = 0; i < table.parameters.size(); ++i) {
      table.parameters[i] =
          first < 8388608
              ? double(std::ptrdiff_t(1e9 * first) + 5'000'001 * std::ptrdiff_t(i)) / 1e9
              : first + 0.005 * double(i);
    }
    duet::save_table(file.path, table, table_format::euroc);
    const poses again = duet::load_table<screw>(file.path);
    CHECK(again.parameters == table.parameters);
    CHECK(difference_of_positions(again, table) < 2e-14);
  }
  duet::save_table(file.path, table, table_format::kitti, times.path);
  const poses again = duet::load_table<screw>(file.path, times.path);
  CHECK(again.parameters == table.parameters);
  REQUIRE(again.elements.size() == table.elements.size());
  for (std::size_t i = 0; i < table.elements.size(); ++i) {
    const rotation a = duet::rotation(again.elements[i]), b = duet::rotation(table.elements[i]);
    CHECK(std::min(norm(a - b), norm(a + b)) < 1e-15);
    CHECK((duet::translation(again.elements[i]) - duet::translation(table.elements[i])).norm() <
          2e-14);
  }
  CHECK(duet::load_table<screw>(file.path).parameters[99] == 99);

  for (const double first : {99999999999., 1e11, 1e14, 1.7e18, 1.5e20, -2e17}) {
    for (std::size_t i = 0; i < table.parameters.size(); ++i) { // as of other units than seconds
      table.parameters[i] = first + 1e6 * double(i);
    }
    duet::save_table(file.path, table, table_format::kitti, times.path);
    CHECK(duet::load_table<screw>(file.path, times.path).parameters == table.parameters);
  }
}

TEST_CASE("save_table: the files of every format, character by character") {
  const scratch_file file("letter.txt"), times("letter_times.txt");
  poses table;
  table.parameters = {-0.5, 1403636580.25};
  table.elements = {duet::pose(rotation(1), vector3<double>(1, -2, 0.5)),
                    duet::pose(rotation(0.6, 0, 0, 0.8), vector3<double>(0, 0, 0))};
  duet::save_table(file.path, table);
  CHECK(file.text() == "u,x,y,z,qw,qx,qy,qz\n-0.5,1,-2,0.5,1,0,0,0\n"
                       "1403636580.25,0,0,0,0.6,0,0,0.8\n");
  duet::save_table(file.path, table, table_format::tum);
  CHECK(file.text() == "# timestamp [s] tx [m] ty [m] tz [m] qx qy qz qw\n"
                       "-0.5 1 -2 0.5 0 0 0 1\n1403636580.25 0 0 0 0 0 0.8 0.6\n");
  duet::save_table(file.path, table, table_format::euroc);
  CHECK(file.text() == header_of_euroc + "-500000000,1,-2,0.5,1,0,0,0\n"
                                         "1403636580250000000,0,0,0,0.6,0,0,0.8\n");
  table.elements[1] = duet::pose(rotation(0, 0, 0, 1), vector3<double>(4, 5, 6));
  duet::save_table(file.path, table, table_format::kitti, times.path);
  CHECK(file.text() == "1 0 0 1 0 1 0 -2 0 0 1 0.5\n-1 0 0 4 0 -1 0 5 0 0 1 6\n");
  CHECK(times.text() == "-0.5\n1403636580.25\n");
}

TEST_CASE("save_table: errors name the reason, and no file is written") {
  const scratch_file file("unsaved.txt");
  const auto error_message = [&](const auto& table, table_format format, const char* times = "") {
    return duet_test::message_of([&] { duet::save_table(file.path, table, format, times); });
  };
  poses table = random_poses(3, 0, 1);
  CHECK(error_message(rotations{{0}, {rotation(1)}}, table_format::tum) ==
        "duet: save_table: TUM, EuRoC and KITTI files hold poses, not rotations alone");
  CHECK(error_message(table, table_format::kitti, "no/times.txt") ==
        "duet: no/times.txt: cannot be written: No such file or directory");
  CHECK(error_message(table, table_format::kitti, file.path.c_str()) ==
        "duet: " + file.path + ": is the same file as " + file.path);
  CHECK(error_message(table, table_format::kitti, ("./" + file.path).c_str()) ==
        "duet: " + file.path + ": is the same file as ./" + file.path);
  CHECK(error_message(table, table_format::tum, "times.txt") ==
        "duet: save_table: only KITTI files have times in a separate file");
  table.parameters = {0, 1e-3, 1.0000002e-3};
  CHECK(error_message(table, table_format::euroc) ==
        "duet: save_table: sample 2 at 0.0010000002 s is less than a nanosecond after the sample "
        "before");
  table.parameters[2] = 1e10;
  CHECK(error_message(table, table_format::euroc) ==
        "duet: save_table: the time 1e+10 s is beyond 9.2e18 nanoseconds");
  table.parameters[2] = std::nan("");
  CHECK(error_message(table, table_format::euroc) ==
        "duet: save_table: the time nan s is beyond 9.2e18 nanoseconds");
  table.parameters.pop_back();
  CHECK(error_message(table, table_format::csv) == "duet: save_table: 2 parameters for 3 elements");
  CHECK(file.text().empty());
}

TEST_CASE("save_table: poses and times need separate files, and times remain if poses cannot be "
          "written") {
  const scratch_file file("poses.txt"), times("times.txt"), link("link.txt");
  const poses table = random_poses(3, 0, 1);
  const auto error_message = [&](const std::string& path, const std::string& path_of_times) {
    return duet_test::message_of<duet::file_error>(
        [&] { duet::save_table(path, table, table_format::kitti, path_of_times); });
  };
  CHECK(error_message(file.path, times.path).empty());
  const std::string before = file.text(), column = times.text();
  std::filesystem::create_symlink(file.path, link.path);
  CHECK(error_message(link.path, file.path) ==
        "duet: " + link.path + ": is the same file as " + file.path);
  CHECK(error_message(file.path, link.path) ==
        "duet: " + file.path + ": is the same file as " + link.path);
  CHECK(file.text() == before);

  times.write("before\n");
  CHECK(error_message(file.path, "no/times.txt") ==
        "duet: no/times.txt: cannot be written: No such file or directory");
  CHECK(file.text() == before);
  CHECK(error_message("no/poses.txt", times.path) ==
        "duet: no/poses.txt: cannot be written: No such file or directory");
  CHECK(times.text() == column);
  if (std::filesystem::is_character_file("/dev/full") &&
      std::filesystem::is_character_file("/dev/null")) {
    CHECK(error_message(file.path, "/dev/full") ==
          "duet: /dev/full: cannot be written: No space left on device");
    CHECK(file.text() == before);
    CHECK(error_message("/dev/full", times.path) ==
          "duet: /dev/full: cannot be written: No space left on device");
    CHECK(error_message("/dev/null", "/dev/null").empty());
  }
}

TEST_CASE("load_table: files of other programs with blanks, line ends, byte order marks, comments "
          "and trailing commas") {
  // A file of TUM's. (Decimal commas are rejected, see below.)
  const std::string tum =
      "# ground truth trajectory\r\n# timestamp tx ty tz qx qy qz qw\r\n"
      "  1305031098.6659 1.3563 0.6305\t1.6380 0.6132 0.5962 -0.3311 -0.3986 \r\n"
      "\r\n1305031098.6758 1.3543 +0.6306 1.6360 0.6129 0.5966 -0.3316 -0.3980";
  const poses a = loaded<screw>(tum);
  CHECK(a.parameters == std::vector<double>{1305031098.6659, 1305031098.6758});
  CHECK(duet::rotation(a.elements[0]) == normalized(rotation(-0.3986, 0.6132, 0.5962, -0.3311)));
  CHECK((duet::translation(a.elements[1]) - vector3<double>(1.3543, 0.6306, 1.6360)).norm() <
        1e-15);
  const auto bare = tum.substr(tum.find("  1305"));
  CHECK(loaded<screw>("\xef\xbb\xbf" + bare).elements == a.elements);
  CHECK(loaded<double>(bare).elements[1] == duet::rotation(a.elements[1]));

  // EuRoC's, with the further columns of its ground truth, and the format that ORB-SLAM writes.
  const poses b = loaded<screw>(
      "\xef\xbb\xbf#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], "
      "q_RS_y [], q_RS_z [], v_RS_R_x [m s^-1]\r\n"
      "1403636580868555648,4.688319,-1.786938,0.783338,0.534108,-0.153029,-0.827383,-0.082152,-0."
      "02,"
      "\r\n");
  CHECK(b.parameters == std::vector<double>{1403636580.868555648});
  CHECK(duet::rotation(b.elements[0]) ==
        normalized(rotation(0.534108, -0.153029, -0.827383, -0.082152)));
  const poses commas = loaded<screw>(
      "1403636580868555648,4.688319,-1.786938,0.783338,0.534108,-0.153029,-0.827383,-0.082152,\n");
  const poses blanks = loaded<screw>("1403636580868555648.000000 4.688319 -1.786938 0.783338 "
                                     "-0.153029 -0.827383 -0.082152 0.534108\n");
  for (const poses& same : {commas, blanks}) {
    CHECK(same.parameters == b.parameters);
    CHECK(same.elements == b.elements);
  }

  // KITTI's, with seven digits.
  const std::string kitti =
      "1.000000e+00 9.043680e-12 2.326809e-11 5.551115e-17 9.043683e-12 1.000000e+00 2.392370e-10 "
      "3.330669e-16 2.326810e-11 2.392370e-10 9.999999e-01 -4.440892e-16\n"
      "9.999978e-01 5.272628e-04 -2.066935e-03 -4.690294e-02 -5.296506e-04 9.999992e-01 "
      "-1.154865e-03 -2.839928e-02 2.066324e-03 1.155958e-03 9.999971e-01 8.586941e-01\n";
  const poses c = loaded<screw>(kitti);
  CHECK(c.parameters == std::vector<double>{0, 1});
  CHECK((duet::translation(c.elements[1]) -
         vector3<double>(-4.690294e-02, -2.839928e-02, 8.586941e-01))
            .norm() < 1e-15);
  duet::matrix3<double> r;
  r << 9.999978e-01, 5.272628e-04, -2.066935e-03, -5.296506e-04, 9.999992e-01, -1.154865e-03,
      2.066324e-03, 1.155958e-03, 9.999971e-01;
  const rotation q = duet::rotation(c.elements[1]);
  CHECK(std::abs(norm(q) - 1) < 4e-16);
  CHECK((duet::rotation_matrix(q) - r).cwiseAbs().maxCoeff() < 1e-7);
  CHECK(loaded<double>(kitti).elements[1] == q);
  const scratch_file file("kitti.txt", kitti),
      times("kitti_times.txt", "0.000000e+00\r\n1.037359e-01\r\n");
  CHECK(duet::load_table<screw>(file.path, times.path).parameters ==
        std::vector<double>{0, 0.1037359});
}

TEST_CASE("load_table: columns separated by semicolons") {
  const auto expected = loaded<screw>("u,x,y,z,qw,qx,qy,qz\n0.5,1,2,3,0.6,0,0,0.8\n");
  for (const char* text :
       {"u;x;y;z;qw;qx;qy;qz\r\n0.5;1;2;3;0.6;0;0;0.8\r\n",
        "\"u\"; \"x\" ;\"y\";\"z\";\"qw\";\"qx\";\"qy\";\"qz\";\n0.5; 1;2 ;3;0.6;0;0;0.8;\n",
        "# u; x [m]; y [m]; z [m]; qw; qx; qy; qz\n0.5;1;2;3;0.6;0;0;0.8\n",
        "note;u;z;y;x;qw;qx;qy;qz\nby hand, twice;0.5;3;2;1;0.6;0;0;0.8\n"}) {
    const poses table = loaded<screw>(text);
    CHECK(table.parameters == expected.parameters);
    CHECK(table.elements == expected.elements);
  }
  const poses euroc = loaded<screw>("1403636580868555648;1;2;3;0.6;0;0;0.8\n");
  CHECK(euroc.parameters == std::vector<double>{1403636580.868555648});
  CHECK(euroc.elements == expected.elements);
}

TEST_CASE("load_table with euler_columns: Euler angles of every sequence and unit; errors name the "
          "column") {
  using duet::angle_unit, duet::euler_columns;
  const double degree = std::acos(-1.0) / 180;
  const scratch_file file("angles.csv");
  const auto read = [&](const std::string& text, const euler_columns& angles) {
    file.write(text);
    return duet::load_table<double>(file.path, angles);
  };
  const euler_columns aircraft(duet::zyx, {"yaw", "pitch", "roll"}, angle_unit::degree);
  const auto max_abs_difference = [](const rotation& a, const rotation& b) { return norm(a - b); };
  const rotation expected = duet::from_euler<duet::zyx>(30 * degree, -20 * degree, 10 * degree);
  for (const char* text : {"t,roll,pitch,yaw\n0.5,10,-20,30\n",
                           "Yaw [deg];Roll [degrees];Pitch [\u00b0];t\n30;10;-20;0.5\n",
                           "# t roll pitch yaw\n0.5 10 -20 30\n",
                           "# turns, by hand\n# t roll pitch yaw\n# degrees\n0.5 10 -20 30\n",
                           "t,qw,qx,qy,qz,roll,pitch,yaw\n0.5,1,0,0,0,10,-20,30\n"}) {
    const rotations table = read(text, aircraft);
    CHECK(table.parameters == std::vector<double>{0.5});
    CHECK(max_abs_difference(table.elements[0], expected) < 4e-16);
  }
  // Every sequence, in radians; full turns determine the sign of the quaternion.
  const std::string text = "t,a,b,c\n0,0.3,-1.2,7\n";
  const auto of = [&](duet::euler_sequence s) {
    return read(text, euler_columns(s, {"a", "b", "c"}, angle_unit::radian)).elements[0];
  };
  CHECK(max_abs_difference(of(duet::xyz), duet::from_euler<duet::xyz>(0.3, -1.2, 7.0)) < 4e-16);
  CHECK(max_abs_difference(of(duet::zxz), duet::from_euler<duet::zxz>(0.3, -1.2, 7.0)) < 4e-16);
  CHECK(max_abs_difference(of(duet::yzx), duet::from_euler<duet::yzx>(0.3, -1.2, 7.0)) < 4e-16);
  // Poses, in a recording with an omitted row.
  file.write("time [ms],x,y,z,roll,pitch,yaw\n0,1,2,3,0,0,90\n5,1,2,3,0,nan,90\n");
  const auto recorded = duet::load_recording<screw>(file.path, aircraft);
  CHECK(recorded.left_out == 1);
  CHECK(recorded.faults.at(0).reason == "pitch is nan: left out");
  const auto& pose = recorded.table.elements.at(0);
  CHECK(max_abs_difference(duet::rotation(pose),
                           duet::from_euler<duet::zyx>(90 * degree, 0.0, 0.0)) < 4e-16);
  CHECK((duet::translation(pose) - vector3<double>(1, 2, 3)).norm() < 1e-15);

  const auto error_message = [&](const std::string& content, const euler_columns& angles) {
    const std::string message =
        duet_test::message_of<duet::file_error>([&] { (void)read(content, angles); });
    const std::string begin = "duet: " + file.path + ":";
    REQUIRE(message.starts_with(begin));
    return message.substr(begin.size());
  };
  CHECK(error_message("t,roll,pitch\n0,1,2\n", aircraft) ==
        "1: the header names no column yaw: " + known_columns);
  CHECK(error_message("t,roll,pitch,yaw [rad]\n0,1,2,3\n", aircraft) ==
        "1: the header has the column yaw [rad], but euler_columns expects degrees");
  CHECK(error_message("t,a,b [deg],c\n0,1,2,3\n",
                      euler_columns(duet::zyx, {"a", "b", "c"}, angle_unit::radian)) ==
        "1: the header has the column b [deg], but euler_columns expects radians");
  CHECK(error_message("t,roll,pitch,yaw,Yaw\n0,1,2,3,3\n", aircraft) ==
        "1: the header has both 'yaw' and 'Yaw'");
  CHECK(error_message("0 1 2 3 0 0 0 1\n", aircraft) ==
        "1: there is no header before the first row (expected names of the columns of angles)");
  CHECK(error_message("1 0 0 0 0 1 0 0 0 0 1 0\n", aircraft) ==
        "1: there is no header before the first row (expected names of the columns of angles)");
  CHECK(error_message("t,roll,pitch,yaw\n0,1,2,north\n", aircraft) ==
        "2: yaw is not a number: 'north'");
  // Without `euler_columns` Euler angles are rejected.
  file.write("t,roll,pitch,yaw\n0,1,2,3\n");
  const std::string message =
      duet_test::message_of<duet::file_error>([&] { (void)duet::load_table<double>(file.path); });
  CHECK(message.find("names no column qw") != message.npos);
  CHECK(message.ends_with("Euler angles need `euler_columns`"));

  const auto rejection = [](duet::euler_sequence s, const char* third) {
    return duet_test::message_of<duet::invalid_input>([&] {
      (void)euler_columns(s, {"a", "b", third}, angle_unit::radian);
    });
  };
  CHECK(rejection({0, 0, 1}, "c") ==
        "duet: euler_columns: the axes are 0, 0, 1 (expected 0, 1 or 2 each, neighbours "
        "different)");
  CHECK(!rejection({0, 1, 3}, "c").empty());
  CHECK(!rejection({0, 1, 1}, "c").empty());
  CHECK(rejection(duet::zyx, "a") ==
        "duet: euler_columns: the columns of two angles are 'a' and 'a' (expected three different "
        "names)");
  CHECK(!rejection(duet::zyx, "").empty());
}

TEST_CASE(
    "load_table: files of rostopic echo -p for PoseStamped, Pose, Odometry and TransformStamped") {
  const std::string pose = "field.pose.position.x,field.pose.position.y,field.pose.position.z,"
                           "field.pose.orientation.x,field.pose.orientation.y,"
                           "field.pose.orientation.z,field.pose.orientation.w\n";
  const std::string header =
      "%time,field.header.seq,field.header.stamp,field.header.frame_id," + pose;
  // PoseStamped: the time in the header of the message, of any size, with all digits of the file.
  const poses a = loaded<screw>(header + "1403636580900000000,7,1403636580868555648,world,1,2,3,"
                                         "0,0,0.8,0.6\n1403636580900000001,8,1403636580873555648,"
                                         "world,1,2,4,0,0,0.8,0.6\n");
  CHECK(a.parameters == std::vector<double>{1403636580.868555648, 1403636580.873555648});
  CHECK(duet::rotation(a.elements[1]) == rotation(0.6, 0, 0, 0.8));
  CHECK((duet::translation(a.elements[1]) - vector3<double>(1, 2, 4)).norm() < 1e-15);
  const poses simulated = loaded<screw>(header + "12500000000,7,12000000000,,1,2,3,0,0,0.8,0.6\n"
                                                 "12700000000,8,12000000001,,1,2,3,0,0,0.8,0.6\n");
  CHECK(simulated.parameters == std::vector<double>{12, 12.000000001});
  // Pose: the time of arrival, in nanoseconds from a bag, otherwise in seconds.
  const std::string bare = "%time,field.position.x,field.position.y,field.position.z,"
                           "field.orientation.x,field.orientation.y,field.orientation.z,"
                           "field.orientation.w\n";
  CHECK(loaded<screw>(bare + "1500000000,1,2,3,0,0,0.8,0.6\n").parameters[0] == 1.5);
  CHECK(loaded<screw>(bare + "1403636580.87,1,2,3,0,0,0.8,0.6\n").parameters[0] == 1403636580.87);
  // Odometry and TransformStamped.
  CHECK(loaded<screw>("%time,field.child_frame_id,field.pose.pose.position.x,"
                      "field.pose.pose.position.y,field.pose.pose.position.z,"
                      "field.pose.pose.orientation.x,field.pose.pose.orientation.y,"
                      "field.pose.pose.orientation.z,field.pose.pose.orientation.w,"
                      "field.pose.covariance0,field.twist.twist.linear.x,"
                      "field.twist.twist.angular.x\n1,base,1,2,3,0,0,0.8,0.6,9,9,9\n")
            .elements[0] == loaded<screw>(bare + "1,1,2,3,0,0,0.8,0.6\n").elements[0]);
  CHECK(loaded<double>("%time,field.header.stamp,field.transform.rotation.x,"
                       "field.transform.rotation.y,field.transform.rotation.z,"
                       "field.transform.rotation.w\n5,1000000000,0,0,0.8,0.6\n")
            .parameters == std::vector<double>{1});
  const scratch_file file("ros.csv", header + "5,1,5,world,1,2,3,0,0,0.8,0.6\n"
                                              "6,1,0.5,world,1,2,3,0,0,0.8,0.6\n");
  const auto error_message = [&] {
    return duet_test::message_of<duet::file_error>(
        [&] { (void)duet::load_table<screw>(file.path); });
  };
  CHECK(
      error_message().find(":3: field.header.stamp 0.5 is not an integer number of nanoseconds") !=
      std::string::npos);
  file.write("%time,stamp," + pose);
  CHECK(error_message().ends_with(":1: the header has both '%time' and 'stamp'"));
  file.write("time,field.header.stamp," + pose);
  CHECK(error_message().ends_with(":1: the header has both 'time' and 'field.header.stamp'"));
}

TEST_CASE("load_table: the rotation nearest to a matrix of few digits") {
  // It is the nearest if every small rotation increases the distance.
  const rotation q = normalized(rotation(0.3, -0.5, 0.7, 0.2));
  duet::matrix3<double> m = duet::rotation_matrix(q);
  m(0, 1) += 2e-4;
  m(2, 0) -= 3e-4;
  std::string row;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      row += duet::to_text(m(i, k)) + " ";
    }
    row += "0 ";
  }
  const rotation nearest = loaded<double>(row + "\n").elements.at(0);
  CHECK(norm(nearest - q) > 2e-5);
  const auto distance = [&](const rotation& p) {
    return (duet::rotation_matrix(p) - m).squaredNorm();
  };
  for (int axis = 0; axis < 3; ++axis) {
    const vector3<double> step = 1e-4 * vector3<double>::Unit(axis);
    const double forward = distance(duet::from_rotation_vector(step) * nearest);
    const double backward = distance(duet::from_rotation_vector(vector3<double>(-step)) * nearest);
    CHECK(std::abs(forward - backward) < 1e-14); // the derivative along the step is zero
    CHECK(std::min(forward, backward) > distance(nearest));
  }
}

TEST_CASE("load_table: times have all digits of the file in every unit") {
  const auto time_of = [](const std::string& cell, const std::string& unit) {
    return loaded<double>("t [" + unit + "],qw,qx,qy,qz\n" + cell + ",1,0,0,0\n").parameters.at(0);
  };
  // Division by 1e9 would give a double other than the nearest one.
  CHECK(time_of("1403636580868555648", "ns") == 1403636580.868555648);
  CHECK(time_of("1403636580868555648", "ns") != 1403636580868555648.0 / 1e9);
  CHECK(time_of("-1403636580868555648", "ns") == -1403636580.868555648);
  CHECK(time_of("+1403636580868555648.75", "ns") == 1403636580.86855564875);
  CHECK(time_of("7", "ns") == 7e-9);
  CHECK(time_of("1234567", "us") == 1.234567);
  CHECK(time_of("1234.5", "ms") == 1.2345);
  CHECK(time_of(".5", "ms") == 0.0005);
  CHECK(time_of("1.5e3", "ms") == 1.5);
  CHECK(time_of("1.403636580868555648e+18", "ns") == 1403636580.868555648);
  CHECK(time_of("-140363658086855564.8E1", "ns") == -1403636580.868555648);
  CHECK(time_of("14036365808685556480e-10", "s") == 1403636580.868555648);
  CHECK(time_of("0e999999999", "ns") == 0);
  CHECK(time_of("0." + std::string(500, '0') + "7e500", "s") == 0.7);
  CHECK(time_of("7" + std::string(500, '0') + "e-500", "s") == 7);
  CHECK(time_of("4e-321", "s") == 4e-321);
  CHECK(time_of("1.5e300", "s") == 1.5e300);
  CHECK(time_of("1403636580.868555648", "s") == 1403636580.868555648);
  CHECK(time_of("12.e0", "s") == 12);
  CHECK(time_of("0." + std::string(320, '0') + "4", "s") == 4e-321);
  CHECK(time_of("0." + std::string(320, '0') + "4", "ns") == 0);
  CHECK(std::signbit(time_of("-0", "ns")));
  // Columns named u or tau are not times, whatever their size and unit.
  CHECK(loaded<double>("u [ns],qw,qx,qy,qz\n1403636580868555648,1,0,0,0\n").parameters.at(0) ==
        1403636580868555648.0);
  CHECK(loaded<double>("tau,qw,qx,qy,qz\n2.5,1,0,0,0\n").parameters.at(0) == 2.5);
  CHECK(loaded<double>("time,qw,qx,qy,qz\n1403636580868555648,1,0,0,0\n").parameters.at(0) ==
        1403636580.868555648);

  // Integers too large for seconds, and those just below the bound.
  const auto taken = [](const std::string& cell) {
    return loaded<double>("time,qw,qx,qy,qz\n" + cell + ",1,0,0,0\n").parameters.at(0);
  };
  CHECK(taken("1403636580868") == 1403636580.868);
  CHECK(taken("1.403636580868555e15") == 1403636580.868555);
  CHECK(taken("-1403636580868555") == -1403636580.868555);
  CHECK(taken("99999999999") == 99999999999);
  CHECK(taken("100000000000") == 1e8);
  CHECK(taken("1403636580868.5") == 1403636580868.5);

  // Differences of times have all digits, too, and the order of rows does not matter.
  const auto since = [](const std::string& unit, const std::string& start,
                        const std::string& cell) {
    const scratch_file file("times.csv", "t [" + unit + "],qw,qx,qy,qz\n" + cell + ",1,0,0,0\n" +
                                             start + ",1,0,0,0\n");
    return duet::load_recording<double>(file.path).table.parameters.at(1);
  };
  for (const char* cell : {"1.4036365808435553280e+09", "14036365808.43555328e-1",
                           "0.000014036365808435553280E14", "+1.403636580843555328e9"}) {
    CHECK(std::abs(since("s", "1403636580.838555648", cell) - 4999680e-9) < 1.2e-16);
  }
  CHECK(std::abs(since("ns", "1403636580838555648", "1403636580843555328") - 4999680e-9) < 1e-16);
  CHECK(since("s", "-3.5", "-1.75") == 1.75);
  CHECK(since("s", "0", "20.825545") == 20.825545); // not 20 + 0.825545
}

TEST_CASE("load_table: columns are identified by the names in a header; ambiguous ones throw") {
  const auto path = std::string("test_spline_table_file_names.csv");
  const auto write = [&](const std::string& text) { std::ofstream(path) << text; };
  const rotation q(.1, .3, .9, .3);
  const auto rotation_of = [&](const std::string& text) {
    write(text);
    return duet::load_table<double>(path).elements.at(0);
  };
  CHECK(rotation_of("t,qx,qy,qz,qw\n0,.3,.9,.3,.1\n") == normalized(q));
  CHECK(rotation_of("# timestamp tx ty tz qx qy qz qw\n0 1 2 3 .3 .9 .3 .1\n") == normalized(q));
  CHECK(rotation_of("\xef\xbb\xbfQ_Z , q.w (), Time [s], qy [],speed,Qx\r\n.3,.1,0,.9,a,.3\r\n") ==
        normalized(q));
  CHECK(rotation_of(
            "#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], "
            "q_RS_y [], q_RS_z []\n7,1,2,3,.1,.3,.9,.3\n") == normalized(q));
  CHECK(
      rotation_of(
          "# columns: t qx qy qz qw\n# t in hours, by hand\n# qw is the cosine\n0 .3 .9 .3 .1\n") ==
      normalized(q));
  write("stamp,orientation_w,orientation_x,orientation_y,orientation_z,position_z,position_y,"
        "position_x\n0,.1,.3,.9,.3,3,2,1\n");
  const auto a = duet::load_table<screw>(path).elements.at(0);
  CHECK(duet::rotation(a) == normalized(q));
  CHECK((duet::translation(a) - vector3<double>(1, 2, 3)).norm() < 1e-15);
  write("t_s,t_x,t_y,t_z,q_w,q_x,q_y,q_z\n0,1,2,3,.1,.3,.9,.3\n");
  CHECK(duet::load_table<screw>(path).elements.at(0) == a);
  write("\"t\",\"tx\",\"ty\",\"tz\",\"qw\",\"qx\",\"qy\",\"qz\"\n0,1,2,3,.1,.3,.9,.3\n");
  CHECK(duet::load_table<screw>(path).elements.at(0) == a);

  const auto error_message = [&](const std::string& text) {
    write(text);
    return duet_test::message_of<duet::file_error>([&] { (void)duet::load_table<double>(path); });
  };
  const auto names_known_columns = [](const std::string& message) {
    return message.ends_with(known_columns);
  };
  // Without names, w may be first or last.
  for (const char* unnamed :
       {"0,.3,.9,.3,.1\n", "1305031098.6659,1.3563,0.6305,1.6380,0.6132,0.5962,"
                           "-0.3311,-0.3986\n"}) {
    const std::string message = error_message(unnamed);
    CHECK(message.find(" columns without a header before the first row") != message.npos);
    CHECK(names_known_columns(message));
  }
  CHECK(error_message("t,q0,q1,q2,q3\n0,.1,.3,.9,.3\n")
            .starts_with("duet: " + path +
                         ":1: the header names no column qw: known columns are u "));
  CHECK(names_known_columns(error_message("u,w,x,y,z\n0,.1,.3,.9,.3\n")));
  CHECK(names_known_columns(error_message("# t q0 q1 q2 q3\n0 .1 .3 .9 .3\n")));
  CHECK(error_message("qw,qx,qy,qz\n.1,.3,.9,.3\n")
            .starts_with("duet: " + path + ":1: the header names no column u"));
  CHECK(error_message("t,u,qw,qx,qy,qz\n0,0,.1,.3,.9,.3\n") ==
        "duet: " + path + ":1: the header has both 't' and 'u'");
  CHECK(error_message("# t qx qy qz qw norm\n0 .3 .9 .3 .1\n") ==
        "duet: " + path + ":1: the comment names 6 columns, but the rows have 5");
  // TUM's rows need no header: a comment whose names do not fit them is ignored.
  for (const char* comment :
       {"# timestamp tx ty tz qx qy qz qw norm\n", "# time a b c d e f g\n",
        "# timestamp px py pz rx ry rz rw\n", "# time of day is UTC in whole seconds\n",
        "# t [s] and more\n", "# timestamp tx ty tz qx qy qz\n"}) {
    CAPTURE(comment);
    CHECK(rotation_of(std::string(comment) + "0 1 2 3 .3 .9 .3 .1\n") == normalized(q));
  }
  for (const char* comment :
       {"# t p0 p1 p2 q0 q1 q2 q3\n", "# t rw rx ry rz px py pz\n", "# t w a b c d e f\n",
        "# time a b c x y z d\n", "# timestamp qw qx qy qz tx ty tz norm\n",
        "# timestamp tx ty tz qw qx qy qz norm\n"}) {
    CAPTURE(comment);
    CHECK(error_message(std::string(comment) + "0 1 2 3 .3 .9 .3 .1\n")
              .starts_with("duet: " + path + ":1: the "));
  }
  CHECK(error_message("# t qx qy qz qw\n1 0 0 0 0 1 0 0 0 0 1 0\n") ==
        "duet: " + path + ":1: the comment names 5 columns, but the rows have 12");
  std::remove(path.c_str());
}

TEST_CASE("load_table: errors name the line, the column and the value") {
  const scratch_file file("bad.txt");
  const auto error_message = [&](const std::string& text) {
    file.write(text);
    const std::string message = duet_test::message_of<duet::invalid_input>(
        [&] { (void)duet::load_table<screw>(file.path); });
    const std::string begin = "duet: " + file.path + ":";
    REQUIRE(message.starts_with(begin));
    return message.substr(begin.size());
  };
  const std::string row = "0 1 2 3 0 0 0 1\n";
  CHECK(error_message("") == " holds no rows");
  CHECK(error_message("# nothing\n\n") == " holds no rows");
  CHECK(error_message("u,x,y,z,qw,qx,qy,qz\n") == " holds no rows");
  CHECK(error_message("\xff\xfeu") == " is UTF-16 (expected UTF-8)");
  CHECK(error_message(row + "1 nan 2 3 0 0 0 1\n") == "2: tx is nan");
  CHECK(error_message(row + "1 1 2 inf 0 0 0 1\n") == "2: tz is inf");
  CHECK(error_message(row + "1 1 2 3 0 0 1e-400 1\n") ==
        "2: qz is 1e-400, beyond the range of a double");
  CHECK(error_message(row + "1e400 1 2 3 0 0 0 1\n") ==
        "2: timestamp is 1e400, beyond the range of a double");
  CHECK(error_message(row + "1 one 2 3 0 0 0 1\n") == "2: tx is not a number: 'one'");
  CHECK(error_message(row + "1 1 2 3 0 0 0\n") == "2: 8 columns expected, got 7");
  CHECK(error_message(row + "1 1 2 3 0 0 0 0.9\n") ==
        "2: the quaternion of qw, qx, qy, qz has norm 0.9, not 1");
  CHECK(error_message(row + "0 1 2 3 0 0 0 1\n") ==
        "2: parameter 0 does not increase, the row before has 0");
  CHECK(error_message(row + "-1 1 2 3 0 0 0 1\n") ==
        "2: parameter -1 does not increase, the row before has 0");
  CHECK(error_message("u,x,y,z,qw,qx,qy,qz\n0,1,,3,1,0,0,0\n") == "2: y is not a number: ''");
  CHECK(error_message("u,x,y,z,qw,qx,qy\n0,1,2,3,1,0,0\n") ==
        "1: the header names no column qz: " + known_columns);
  CHECK(error_message("u,x,y,qw,qx,qy,qz\n0,1,2,1,0,0,0\n") ==
        "1: the header names no column z: " + known_columns);
  CHECK(error_message("t [h],x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n") ==
        "2: the unit of timestamps is 'h' (expected s, ms, us or ns)");
  CHECK(error_message("t,x [m],y [m],z [mm],qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n") ==
        "2: the unit of positions is 'mm' (expected m)");
  CHECK(error_message(header_of_euroc + "0.5,0,0,0,1,0,0,0\n") ==
        "2: timestamp 0.5 is not an integer number of nanoseconds (other units need a header, as "
        "in `timestamp [s]`)");
  // Decimal commas.
  CHECK(error_message("0,5 1,0 2 3 0 0 0 1\n")
            .starts_with("1: 3 columns without a header before the "));
  CHECK(error_message(header_of_euroc + "1,1,2,3,0,5,0,0,1\n") ==
        "1: the comment names 8 columns, but the rows have 9");
  CHECK(error_message("u;x;y;z;qw;qx;qy;qz\n0;1;2,5;3;1;0;0;0\n") ==
        "2: y is not a number: '2,5' (expected a decimal point, not a comma)");
  CHECK(error_message("0,5;1,0;2,5;3,5;1,0;0,0;0,0;0,0\n").find(" 8 columns without a header") !=
        std::string::npos);

  const std::string identity = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  CHECK(error_message(identity + "1 0 0 0 0 1 0 0 0 0 -1 0\n") ==
        "2: the matrix is a reflection: det R = -1");
  CHECK(error_message(identity + "1 0 0 0 0 1.5 0 0 0 0 1 0\n") ==
        "2: the matrix is not a rotation: |R R^T - 1| = 1.25");
  CHECK(error_message(identity + "0 0 0 0 0 0 0 0 0 0 0 0\n") ==
        "2: the matrix is not a rotation: |R R^T - 1| = 1");
  CHECK(error_message(identity + "1e200 1e200 0 0 1e200 -1e200 0 0 0 0 1 0\n") ==
        "2: the matrix is not a rotation: |R R^T - 1| = inf");
  CHECK(error_message(identity + "1 0 0 nan 0 1 0 0 0 0 1 0\n") == "2: column 4 is nan");
  CHECK(error_message(identity + "1 0 0 0 0 1 0 0 0 0 1 0,\n") == "2: 12 columns expected, got 1");

  CHECK(duet_test::message_of([] { (void)duet::load_table<screw>("."); }) ==
        "duet: .: is a folder, not a file");
  CHECK(duet_test::message_of([] { (void)duet::load_table<screw>("no/file.txt"); }) ==
        "duet: no/file.txt: cannot be read");
}

TEST_CASE("load_table, KITTI: errors for a file of times that does not match the rows") {
  const std::string identity = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  const scratch_file file("rows.txt", "# poses\n" + identity + identity), times("rows_times.txt");
  const auto error_message = [&](const std::string& text) {
    times.write(text);
    return duet_test::message_of<duet::file_error>(
        [&] { (void)duet::load_table<screw>(file.path, times.path); });
  };
  CHECK(error_message("0\n") ==
        "duet: " + file.path + ":3: more rows than the 1 times of " + times.path);
  CHECK(error_message("0\n1\n\n2\n") ==
        "duet: " + times.path + ":4: more times than the 2 rows of " + file.path);
  CHECK(error_message("0\n0\n") ==
        "duet: " + file.path + ":3: parameter 0 does not increase, the row before has 0");
  CHECK(error_message("0 1\n") == "duet: " + times.path + ":1: 1 numbers expected, got 2");
  CHECK(error_message("0\nnan\n") == "duet: " + times.path + ":2: column 1 is nan");
  CHECK(error_message("1403636580838\n1403636580838.5\n") ==
        "duet: " + times.path +
            ":2: time 1403636580838.5 is not an integer number of milliseconds (other units need a "
            "header, as in `timestamp [s]`)");
  CHECK(error_message("t [h]\n0\n1\n") ==
        "duet: " + times.path + ":1: the unit of timestamps is 'h' (expected s, ms, us or ns)");
  times.write("t [ms]\n1500\n2500.5\n");
  CHECK(duet::load_table<screw>(file.path, times.path).parameters == std::vector{1.5, 2.5005});
  CHECK(error_message("") == "duet: " + times.path + ": holds no rows");
  file.write("0 1 2 3 0 0 0 1\n");
  CHECK(error_message("0\n") ==
        "duet: " + file.path + ":1: the rows have times, and so does " + times.path);
}

TEST_CASE("save_table, load_table: a locale with decimal commas has no effect") {
  struct commas : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new commas));
  std::ostringstream stream;
  stream << 1.5;
  REQUIRE(stream.str() == "1,5"); // the locale is in force
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "de_DE"}) {
    if (std::setlocale(LC_ALL, name) != nullptr) {
      break; // if it is installed
    }
  }
  const scratch_file file("german.txt"), times("german_times.txt");
  const poses table = random_poses(5, 1403636580.25, 1000.5);
  for (const table_format format :
       {table_format::csv, table_format::tum, table_format::euroc, table_format::kitti}) {
    const bool is_kitti = format == table_format::kitti;
    duet::save_table(file.path, table, format, is_kitti ? times.path : "");
    CHECK(duet::load_table<screw>(file.path, is_kitti ? times.path : "").parameters ==
          table.parameters);
  }
  std::setlocale(LC_ALL, "C");
  std::locale::global(before);
}

} // namespace
} // namespace test_io_table_file
