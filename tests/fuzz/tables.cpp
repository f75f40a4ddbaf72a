// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "fuzz/seeded_loop.hpp"

#include <duet/core/text/file_error.hpp>
#include <duet/dual_quaternion/pose_coordinates.hpp>
#include <duet/io/table_file.hpp>
#include <duet/spline/orientations.hpp>

// Tables: loaded samples can be interpolated and are read back as written, in every format.

namespace test_fuzz_tables {
namespace {

using duet_fuzz::require;

const std::string copy = "copy_of_fuzz_tables.csv", times = "times_of_fuzz_tables.csv";

bool are_near(const duet::vector3<double>& a, const duet::vector3<double>& b) {
  return (a - b).stableNorm() <= 1e-14 * b.stableNorm() + 1e-300;
}

void require_copies(const duet::lookup_table<double>& table) {
  duet::save_table(copy, table);
  const auto again = duet::load_table<double>(copy);
  require(again.parameters == table.parameters, "the same parameters");
  require(again.elements == table.elements, "the same rotations");
  std::remove(copy.c_str());
}
void require_copies(const duet::lookup_table<duet::screw_dual<double>>& table) {
  using enum duet::table_format;
  for (const auto format : {csv, tum, euroc, kitti}) {
    const std::string file_of_times = format == kitti ? times : "";
    try {
      duet::save_table(copy, table, format, file_of_times);
    } catch (const duet::invalid_input& error) {
      duet_fuzz::require_message(error.what(), "duet: save_table: ");
      require(format == euroc, "only whole nanoseconds may not do");
      continue;
    }
    const auto again = duet::load_table<duet::screw_dual<double>>(copy, file_of_times);
    require(again.elements.size() == table.elements.size(), "as many rows");
    for (std::size_t i = 0; i < table.elements.size(); ++i) {
      const double u = table.parameters[i];
      require(again.parameters[i] == u ||
                  (format == euroc && std::abs(u) < 0x1p23 &&
                   std::abs(again.parameters[i] - u) < 0.5001e-9 + 1e-16 * std::abs(u)),
              "the same parameters");
      const auto a = duet::rotation(again.elements[i]), b = duet::rotation(table.elements[i]);
      require(a == b || (format == kitti && std::min(norm(a - b), norm(a + b)) < 1e-15),
              "the same rotations");
      require(are_near(duet::translation(again.elements[i]), duet::translation(table.elements[i])),
              "the same places");
    }
  }
  std::remove(copy.c_str());
  std::remove(times.c_str());
}

template <class T>
void try_loading(const std::string& path) {
  duet::lookup_table<T> table;
  try {
    table = duet::load_table<T>(path);
  } catch (const duet::file_error& error) {
    duet_fuzz::require_message(error.what(), "duet: " + path + ":");
    return;
  }
  require(!table.elements.empty() && table.elements.size() == table.parameters.size(), "rows");
  for (std::size_t i = 0; i < table.elements.size(); ++i) {
    require(std::isfinite(table.parameters[i]) &&
                (i == 0 || table.parameters[i] > table.parameters[i - 1]),
            "increasing parameters");
    const auto& q = table.elements[i];
    if constexpr (std::is_same_v<T, double>) {
      require(std::abs(norm(q) - 1) < 1e-15, "units");
    } else {
      require(std::abs(norm(duet::rotation(q)) - 1) < 1e-15, "units");
      require(duet::translation(q).allFinite(), "finite places");
    }
  }
  require_copies(table);
}

} // namespace

std::vector<std::string> seeds() {
  return {
      "u,qw,qx,qy,qz\n0,1,0,0,0\n0.5,0.8,0.6,0,0\n1,0.6,0.8,0,0\n2.5,0.28,0.96,0,0\n",
      "u,x,y,z,qw,qx,qy,qz\n-1e-3,0.25,-1.5,1e300,0.5,0.5,-0.5,0.5\n"
      "0,4e-320,-0,17,0.7071067811865476,0,0.7071067811865476,0\n"
      "0.1,1,2,3,-1,0,0,0\n",
      "# ground truth trajectory\n# timestamp tx ty tz qx qy qz qw\n"
      "1305031098.6659 1.3563 0.6305 1.6380 0.6132 0.5962 -0.3311 -0.3986\n"
      "1305031098.6758 1.3543 0.6306 1.6360 0.6129 0.5966 -0.3316 -0.3980\n",
      "\xef\xbb\xbf#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], "
      "q_RS_y [], q_RS_z [], v_RS_R_x [m s^-1]\r\n"
      "/a/header/stamp/sec,/a/header/stamp/nanosec,/a/orientation/x,/a/orientation/y,"
      "/a/orientation/z,/a/orientation/w\n1403636580,838555648,0,0,0,1\n1403636581,0,0,0.6,0,0.8\n",
      "1403636580838555648,4.688319,-1.786938,0.783338,0.534108,-0.153029,-0.827383,-0.082152,"
      "-0.027876\r\n"
      "1403636580843555328,4.688177,-1.786770,0.787350,0.534640,-0.152990,-0.826976,-0.082863,"
      "0.033272\r\n",
      "t [s] , q.x , q.y , q.z , q.w\n0, 0, 0, 0, 1 # the first\n\n1, 0.6, 0, 0, 0.8,\n",
      "1403636580838555648,4.688319,-1.786938,0.783338,0.534108,-0.153029,-0.827383,-0.082152\n",
      "1403636580838555648.0 4.688319 -1.786938 0.783338 -0.153029 -0.827383 -0.082152 0.534108\n",
      "1.000000e+00 9.043680e-12 2.326809e-11 5.551115e-17 9.043683e-12 1.000000e+00 "
      "2.392370e-10 3.330669e-16 2.326810e-11 2.392370e-10 9.999999e-01 -4.440892e-16\n"
      "9.999978e-01 5.272628e-04 -2.066935e-03 -4.690294e-02 -5.296506e-04 9.999992e-01 "
      "-1.154865e-03 -2.839928e-02 2.066324e-03 1.155958e-03 9.999971e-01 8.586941e-01\n"};
}

void target(const std::string& input) {
  const std::string path = "fuzz_tables.csv";
  std::ofstream(path, std::ios::binary) << input;
  try_loading<double>(path);
  try_loading<duet::screw_dual<double>>(path);
  std::remove(path.c_str());
}

TEST_CASE("table files: mutated ones are read correctly or rejected with a message") {
  duet_fuzz::run_seeded(seeds(), target, 2000);
}

} // namespace test_fuzz_tables
