// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "fuzz/seeded_loop.hpp"

#include <duet/core/text/file_error.hpp>
#include <duet/dual_quaternion/pose_coordinates.hpp>
#include <duet/io/recording.hpp>

// Recorded motion: rows are in order, omitted rows are listed, and rows are read back as written.

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
      "t,x,y,z,qx,qy,qz,qw\n0, ,2,3,0,0,0,1\n", // a blank cell
      "1 0 0 4 0 1 0 5 0 0 1 6\n1 0 0 4 0 1 0 5 0 0 -1 6\n0.8 -0.6 0 1 0.6 0.8 0 2 0 0 1 3\n",
      "stamp_us z y x qw qz qy qx\n12000000 1 2 3 -1 0 0 0\n"};
}

void target(const std::string& input) {
  using T = duet::screw_dual<double>;
  const std::string path = "fuzz_trajectories.txt";
  std::ofstream(path, std::ios::binary) << input;
  duet::recording<T> r;
  try {
    r = duet::load_recording<T>(path);
  } catch (const duet::file_error& error) {
    duet_fuzz::require_message(error.what(), "duet: " + path + ":");
    std::remove(path.c_str());
    return;
  }
  const auto& [times, poses] = r.table;
  require(!times.empty() && r.left_out <= r.faults.size(), "rows and faults");
  require(times.size() == poses.size() && times.size() == r.lines.size(), "a line for each row");
  require(std::isfinite(r.start) && times.front() == 0, "times begin at 0");
  duet_fuzz::require_message(r.remark, "");
  for (const auto& issue : r.faults) {
    require(issue.line >= 1, "lines of faults");
    duet_fuzz::require_message(issue.reason, "");
  }
  for (std::size_t i = 0; i < times.size(); ++i) {
    require(r.lines[i] >= 1 && std::isfinite(times[i]), "lines and times");
    require(i == 0 || times[i] > times[i - 1], "in order of time");
    require(std::abs(norm(duet::rotation(poses[i])) - 1) < 1e-15, "units");
    require(duet::translation(poses[i]).allFinite(), "finite places");
  }
  duet::save_table(path, r.table, duet::table_format::tum);
  const auto again = duet::load_recording<T>(path);
  require(again.table.parameters == times && again.faults.empty(), "the same times");
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto a = duet::pose_coordinates(again.table.elements[i]);
    const auto b = duet::pose_coordinates(poses[i]);
    require((a - b).stableNorm() <= 1e-14 * b.stableNorm(), "the same poses");
  }
  std::remove(path.c_str());
}

TEST_CASE("recordings: mutated ones are read correctly or rejected with a message") {
  duet_fuzz::run_seeded(seeds(), target, 2000);
}

} // namespace test_fuzz_trajectories
