// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "../../examples/fit_trajectory/trajectory.hpp"
#include "fuzz/seeded_loop.hpp"

#include <duet/core/text/csv.hpp>
#include <duet/core/text/file.hpp>
#include <duet/dual_quaternion/pose_coordinates.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

// Recorded motion: rows in order, what is left out named, and read back as it was written.

namespace test_fuzz_trajectories {

using duet_fuzz::require;

std::vector<std::string> seeds() {
  return {
      "# ground truth trajectory\n# file: 'rgbd_dataset_freiburg1_xyz.bag'\n"
      "# timestamp tx ty tz qx qy qz qw\n"
      "1305031098.6659 1.3563 0.6305 1.6380 0.6132 0.5962 -0.3311 -0.3986\n"
      "1305031098.6758 1.3543 0.6306 1.6360 0.6129 0.5966 -0.3316 -0.3980\n",
      "0 1 2 3 0 0 0 1\n2 1 2 3 0 0 0 1\n1 1 2 3 0 0 0.6 0.8\n2 1 2 3 0 0 0 1\n",
      "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
      "q_RS_z [], v_RS_R_x [m s^-1]\n"
      "1403636580838555648,4.688319,-1.786938,0.783338,0.534108,-0.153029,-0.827383,-0.082152,"
      "-0.027876\n",
      "1403636580838555648,4.688319,-1.786938,0.783338,0.534108,-0.153029,-0.827383,-0.082152\n",
      "1403636580838555648.0 4.688319 -1.78693 0.783338 -0.153029 -0.827383 -0.082152 0.534108\n",
      "timestamp,tx,ty,tz,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz,ax,ay,az,alphax,alphay,alphaz\n"
      "0,1,2,3,0,0,0,1,0,0,0,0,0,0,0,0,0,0,0,0\n0.01,1,2,3,0,0,0.6,0.8,1,1,1,1,1,1,1,1,1,1,1,1\n",
      "0, ,2,3,0,0,0,1\n", // a blank cell
      "stamp_us z y x qw qz qy qx\n12000000 1 2 3 -1 0 0 0\n"};
}

void target(const std::string& input) {
  const std::string path = "fuzz_trajectories.txt";
  std::ofstream(path, std::ios::binary) << input;
  fit_trajectory::recording r;
  try {
    r = fit_trajectory::read_recording(path);
  } catch (const duet::file_error& error) {
    duet_fuzz::require_message(error.what(), "duet: " + path + ":");
    std::remove(path.c_str());
    return;
  }
  require(!r.rows.empty() && r.left_out <= r.faults.size(), "rows and faults");
  duet_fuzz::require_message(r.remark, "");
  for (const auto& fault : r.faults) {
    duet_fuzz::require_message(duet::file_error(path, fault.line, fault.reason).what(),
                               "duet: " + path + ":");
  }
  std::string text = "# timestamp [s], tx, ty, tz, qx, qy, qz, qw\n";
  for (std::size_t i = 0; i < r.rows.size(); ++i) {
    const auto& [line, time, pose] = r.rows[i];
    require(line >= 1 && std::isfinite(time), "lines and times");
    require(i == 0 || time > r.rows[i - 1].time, "in order of time");
    require(std::abs(norm(duet::rotation(pose)) - 1) < 1e-15, "units");
    const auto x = duet::pose_coordinates(pose);
    require(x.allFinite(), "finite places");
    text += duet::csv_line({time, x[0], x[1], x[2], x[4], x[5], x[6], x[3]});
  }
  std::ofstream(path, std::ios::binary) << text;
  const auto again = fit_trajectory::read_recording(path);
  require(again.rows.size() == r.rows.size() && again.faults.empty(), "the same rows");
  for (std::size_t i = 0; i < r.rows.size(); ++i) {
    require(again.rows[i].time == r.rows[i].time, "the same times");
    const auto a = duet::pose_coordinates(again.rows[i].pose);
    const auto b = duet::pose_coordinates(r.rows[i].pose);
    require((a - b).stableNorm() <= 1e-14 * b.stableNorm(), "the same poses");
  }
  std::remove(path.c_str());
}

TEST_CASE("recorded motion, mutated") { duet_fuzz::run_seeded(seeds(), target, 2000); }

} // namespace test_fuzz_trajectories
