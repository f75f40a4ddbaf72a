// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: load_(table|recording)<double> reads rotations, .*<screw_dual<double>> poses
// within: 5
// forms: 4

#include <duet/io/recording.hpp>
#include <duet/io/table_file.hpp>

#include <cstddef>

int main() {
#if DUET_MUST_FAIL == 1
  return int(duet::load_table<float>("poses.txt").elements.size());
#elif DUET_MUST_FAIL == 2
  return int(duet::load_table("poses.txt").elements.size());
#elif DUET_MUST_FAIL == 3
  return int(duet::load_recording<Eigen::Quaterniond>("poses.txt").table.elements.size());
#elif DUET_MUST_FAIL == 4
  const duet::euler_columns angles(duet::zyx, {"a", "b", "c"}, duet::angle_unit::degree);
  return int(duet::load_recording<int>("poses.txt", angles).left_out);
#else
  const std::size_t rows = duet::load_table<duet::dual_quaternion<double>>("a").elements.size() +
                           duet::load_recording<duet::quaternion<double>>("a").left_out;
  return int(rows);
#endif
}
