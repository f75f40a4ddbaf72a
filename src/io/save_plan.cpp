// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/core/errors.hpp>
#include <duet/core/text/csv.hpp>
#include <duet/core/text/file.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/dual_quaternion/pose_coordinates.hpp>
#include <duet/io/save_plan.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace duet {
namespace {

using detail::require;

/// `,name0 [unit],name1 [unit] …`; with names of joints `,elbow name [unit] …`, without name for
/// the coordinates themselves.
[[nodiscard]] std::string joint_columns(const std::string& name, const std::string& unit,
                                        Eigen::Index count,
                                        const std::vector<std::string>& joint_names) {
  std::string result;
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::string column =
        joint_names.empty() ? name + std::to_string(i)
                            : joint_names[std::size_t(i)] + (name == "theta" ? "" : " " + name);
    result += "," + csv_sanitized(column + " [" + unit + "]");
  }
  return result;
}

void require_names(const char* function, const std::vector<std::string>& names,
                   Eigen::Index count) {
  require(names.empty() || Eigen::Index(names.size()) == count, "duet: ", function, ": ",
          names.size(), " names of joints (expected ", count, ")");
}

void append_components(std::vector<double>& row, const auto& values) {
  row.insert(row.end(), values.begin(), values.end());
}

} // namespace

DUET_ABI_BEGIN

void save_plan(const std::string& path, const motion_plan& plan,
               const std::vector<std::string>& joint_names) {
  require(!plan.joints.empty(), "duet: save_plan: the plan has no waypoints");
  const Eigen::Index n = plan.joints.front().size();
  require_names("save_plan", joint_names, n);
  std::string text = "tau" + joint_columns("theta", "rad or m", n, joint_names) +
                     ",x [m],y [m],z [m],qw,qx,qy,qz,deviation [m],deviation [rad]\n";
  for (std::size_t k = 0; k < plan.joints.size(); ++k) {
    std::vector<double> row{plan.tau[k]};
    append_components(row, plan.joints[k]);
    append_components(row, pose_coordinates(plan.poses[k]));
    row.push_back(plan.deviations[k].translation);
    row.push_back(plan.deviations[k].rotation);
    text += csv_line(row);
  }
  write_file(path, text);
}

void save_trajectory(const std::string& path, const joint_trajectory& trajectory, double step,
                     const std::vector<std::string>& joint_names) {
  require(step > 0, "duet: save_trajectory: the step is ", to_text(step),
          " (expected a positive number)");
  const Eigen::Index n = trajectory(0).value.size();
  require_names("save_trajectory", joint_names, n);
  std::string text = "t [s]" + joint_columns("theta", "rad or m", n, joint_names) +
                     joint_columns("rate", "rad/s or m/s", n, joint_names) +
                     joint_columns("acceleration", "rad/s^2 or m/s^2", n, joint_names) + "\n";
  const double duration = trajectory.duration();
  for (std::size_t k = 0;; ++k) {
    const double t = double(k) * step;
    const bool is_last = t >= duration;
    std::vector<double> row{is_last ? duration : t};
    const auto motion = trajectory(row[0]);
    append_components(row, motion.value);
    append_components(row, motion.velocity);
    append_components(row, motion.acceleration);
    text += csv_line(row);
    if (is_last) {
      break;
    }
  }
  write_file(path, text);
}

DUET_ABI_END
} // namespace duet
