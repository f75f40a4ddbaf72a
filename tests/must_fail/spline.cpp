// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Mistakes that must not compile, see check.cmake.

#include <duet/spline/adaptive_table.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/fit.hpp>
#include <duet/spline/interpolate.hpp>
#include <duet/spline/rotation_vector_spline.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <iostream>
#include <vector>

//// curves
// expect: duet: interpolate makes cumulative_bspline<T>, a cubic, and rotation_vector_spline

const std::vector<double> u{0, 1, 2, 3};
const std::vector<duet::quaternion<double>> q(4, duet::quaternion<double>(1.0));
static_cast<void>(duet::interpolate<duet::cumulative_bspline<double, 6>>(u, q)); // wrong
static_cast<void>(duet::interpolate<duet::cumulative_bspline<double>>(u, q));    // right

//// ends
// expect: duet: (interpolate: the end conditions are natural|rates at the ends are vectors)

const std::vector<double> u{0, 1, 2, 3};
const std::vector<duet::quaternion<double>> q(4, duet::quaternion<double>(1.0));
const duet::vector3<double> none = duet::vector3<double>::Zero();
const duet::fully_clamped both{duet::clamped{none, none}, duet::end_acceleration{none, none}};
static_cast<void>(duet::interpolate<duet::cumulative_bspline<double>>(u, q, none)); // wrong
static_cast<void>(duet::clamped{0.0, 0.0});                                         // wrong
static_cast<void>(duet::end_acceleration{0.0, 1.0});                                // wrong
static_cast<void>(duet::interpolate<duet::cumulative_bspline<double>>(u, q,
                                                                      duet::clamped{}));   // right
static_cast<void>(duet::interpolate<duet::cumulative_bspline<double>>(u, q));              // right
static_cast<void>(duet::interpolate<duet::rotation_vector_spline<double, 6>>(u, q, both)); // right

//// hermite_without_frame
// expect: duet: the frame is missing
// within: 5

const std::vector<duet::quaternion<double>> rows(2, duet::quaternion<double>(1));
const std::vector<duet::vector3<double>> velocities(2, duet::vector3<double>::Zero());
const auto s = duet::hermite_spline({0, 1}, rows, velocities);            // wrong
std::cout << duet::hermite_spline({0, 1}, rows, velocities)(0.5) << "\n"; // wrong
std::cout << duet::hermite_spline({0, 1}, rows, velocities, duet::frame::body)(0.5)
          << "\n"; // right

//// motion_without_frame
// expect: duet: the frame is missing
// within: 2

using namespace duet;

int main() {
  const std::vector<double> u{0, 1, 2};
  const std::vector<quaternion<double>> rows(3, quaternion<double>(1));
  const auto s = interpolate<cumulative_bspline<double>>(u, rows);
  std::cout << s.motion(0.5).velocity << "\n";              // wrong
  const auto m = s.motion(0.5);                             // wrong
  std::cout << s.motion(0.5, frame::body).velocity << "\n"; // right
}

//// rows_of_eigen
// expect: duet: [a-z]*: rows of rotations and poses are those of duet
// within: 2

#include <duet/interop/eigen.hpp>

using namespace duet;

int main() {
  using curve = cumulative_bspline<double>;
  const std::vector<double> u{0, 1, 2};
  const auto s = interpolate<curve>(u, std::vector<Eigen::Quaterniond>(3));         // wrong
  std::cout << interpolate<curve>(u, std::vector<Eigen::Matrix3d>(3))(0.5) << "\n"; // wrong
  std::cout << interpolate<curve>(u, std::vector<Eigen::Isometry3d>(3), natural{})(0.5)
            << "\n";                                                             // wrong
  std::cout << fit<curve>(u, std::vector<Eigen::Quaterniond>(3), u).rms << "\n"; // wrong
  const auto near = fit<curve>(u, std::vector<Eigen::Matrix3d>(3), u);           // wrong
  std::vector<quaternion<double>> rows;                                          // right
  for (const auto& q : std::vector<Eigen::Quaterniond>(3)) {
    rows.push_back(from_eigen(q));
  }                                                                                    // right
  std::cout << interpolate<curve>(u, rows)(0.5) << fit<curve>(u, rows, u).rms << "\n"; // right
}

//// rows_of_poses
// expect: duet: [a-z]*: the scalar of the curve differs from that of the samples
// within: 5

using namespace duet;

int main() {
  const std::vector<double> u{0, 1, 2};
  const std::vector<dual_quaternion<double>> poses(3);
  using of_rotations = cumulative_bspline<double>;
  using of_poses = cumulative_bspline<screw_dual<double>>;
  const auto s = interpolate<of_rotations>({0, 1, 2}, poses);                       // wrong
  std::cout << interpolate<of_rotations>(u, poses).control_points().size() << "\n"; // wrong
  std::cout << interpolate<of_poses>(u, std::vector<quaternion<double>>(3))
                   .control_points()
                   .size();                                // wrong
  std::cout << fit<of_rotations>(u, poses, u).rms << "\n"; // wrong
  std::cout
      << interpolate<of_poses>({0, 1, 2}, poses).control_points().size() << "\n"
      << interpolate<of_rotations>(u, std::vector<quaternion<double>>(3)).control_points().size()
      << fit<of_poses>(u, poses, u).rms << "\n"; // right
}

//// rows_without_times
// expect: duet: (interpolate|fit)(: | takes standard vectors)

using namespace duet;

int main() {
  using curve = cumulative_bspline<double>;
  const std::vector<double> u{0, 1, 2};
  const std::vector<quaternion<double>> rows(3, quaternion<double>(1));
  const auto s = interpolate<curve>(rows);                                       // wrong
  std::cout << interpolate<curve>(rows, u)(0.5) << "\n";                         // wrong
  std::cout << interpolate(u, rows)(0.5) << "\n";                                // wrong
  std::cout << interpolate<cumulative_bspline>(u, rows)(0.5) << "\n";            // wrong
  std::cout << interpolate<curve>(u, std::array{rows[0], rows[1]})(0.5) << "\n"; // wrong
  std::cout << interpolate<curve>(Eigen::VectorXd(3), rows)(0.5) << "\n";        // wrong
  std::cout << fit<curve>(rows, u, u).rms << "\n";                               // wrong
  std::cout << fit(u, rows, u).rms << "\n";                                      // wrong
  std::cout << fit<curve>(u, rows).rms << "\n";                                  // wrong
  std::cout << fit<curve>(u, rows, fit_options{}).rms << "\n";                   // wrong
  std::cout << interpolate<curve>(u, rows)(0.5) << fit<curve>(u, rows, u, fit_options{}).rms
            << "\n"; // right
}

//// table_of_matrices
// expect: duet: adaptive_table: the function must return a rotation

#include <duet/interop/eigen.hpp>

using namespace duet;
const auto matrix_at = [](double u) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(u, Eigen::Vector3d::UnitX()));
};
static_cast<void>(adaptive_table<cumulative_bspline<double, 4>>(matrix_at, 0, 1, 1e-3)); // wrong
const auto rotation = [&](double u) { return from_eigen(matrix_at(u)); };                // right
static_cast<void>(adaptive_table<cumulative_bspline<double, 4>>(rotation, 0, 1, 1e-3));  // right

//// table_of_what
// expect: duet: load_(table|recording)<double> reads rotations, .*<screw_dual<double>> poses
// within: 5

#include <duet/io/recording.hpp>
#include <duet/io/table_file.hpp>

return int(duet::load_table<float>("poses.txt").elements.size());                        // wrong
return int(duet::load_table("poses.txt").elements.size());                               // wrong
return int(duet::load_recording<Eigen::Quaterniond>("poses.txt").table.elements.size()); // wrong
const duet::euler_columns angles(duet::zyx, {"a", "b", "c"}, duet::angle_unit::degree);  // wrong
return int(duet::load_recording<int>("poses.txt", angles).left_out); // wrong, too
const std::size_t rows = duet::load_table<duet::dual_quaternion<double>>("a").elements.size() +
                         duet::load_recording<duet::quaternion<double>>("a").left_out; // right
return int(rows);                                                                      // right
