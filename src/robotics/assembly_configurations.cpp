// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "loops/loop_closure_solver.hpp"
#include "loops/periodic_coordinates.hpp"

#include <duet/core/errors.hpp>
#include <duet/core/random_source.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/robotics/closed_tree.hpp>
#include <duet/robotics/loop_positions.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace duet::detail {
namespace {

class assembly_search {
public:
  assembly_search(const closed_chain_mechanism& of, const Eigen::VectorXd& at,
                  const std::vector<int>& fixed)
      : of_(of), at_(at), free_(all_but(of.size(), fixed)), periodic_(of) {}

  [[nodiscard]] assembly_search_result run(const assembly_search_options& options) {
    assembly_search_result result;
    random_source random(options.seed);
    const auto is_enough = [&] {
      const double chance = result.missing_probability() + 1. / std::max(1, result.converged);
      return result.starts >= options.random_starts &&
             (result.starts >= options.max_starts || chance <= options.missing_probability);
    };
    for (; !is_enough(); ++result.starts) {
      const loop_closure_solver solver(of_, guess(random), free_, 100);
      if (solver.has_closed()) {
        ++result.converged;
        add(result, wrapped(solver.coordinates()));
      }
    }
    std::sort(result.positions.begin(), result.positions.end(), &comes_first);
    return result;
  }

private:
  [[nodiscard]] Eigen::VectorXd guess(random_source& random) const {
    Eigen::VectorXd q = at_;
    for (const int i : free_) {
      const joint_limits<double>& limits = of_.tree().limits(i);
      const double reach = std::numbers::pi * of_.units()[i];
      const bool has_limits = std::isfinite(limits.lower) && std::isfinite(limits.upper);
      q[i] =
          has_limits ? random.uniform(limits.lower, limits.upper) : random.uniform(-reach, reach);
    }
    return q;
  }

  /// The coordinates without full turns.
  [[nodiscard]] Eigen::VectorXd wrapped(Eigen::VectorXd q) const {
    constexpr double full_turn = 2 * std::numbers::pi;
    for (const int i : free_) {
      if (periodic_.angles[std::size_t(i)]) {
        const double x = std::remainder(q[i], full_turn);
        q[i] = x <= -std::numbers::pi ? std::numbers::pi : x;
      }
    }
    for (const int i : periodic_.vectors) {
      if (std::find(free_.begin(), free_.end(), i) != free_.end()) {
        const double angle = q.segment<3>(i).norm();
        if (angle > std::numbers::pi) {
          q.segment<3>(i) *= std::remainder(angle, full_turn) / angle;
        }
      }
    }
    return q;
  }

  /// Poses of all links: two configurations are the same if all links have the same poses.
  [[nodiscard]] std::vector<Eigen::Matrix<double, 7, 1>>
  link_poses(const Eigen::VectorXd& q) const {
    std::vector<Eigen::Matrix<double, 7, 1>> result;
    for (const dual_quaternion<double>& a : of_.tree().poses(q)) {
      const quaternion<double> r = rotation(a);
      const vector3<double> t = translation(a) / of_.length();
      result.push_back({r.w(), r.x(), r.y(), r.z(), t[0], t[1], t[2]});
    }
    return result;
  }
  [[nodiscard]] static bool are_same(const std::vector<Eigen::Matrix<double, 7, 1>>& a,
                                     const std::vector<Eigen::Matrix<double, 7, 1>>& b) {
    constexpr double rounding = 1e-6; // singular configurations are known to half the digits
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double rotation_error = std::min((a[i].head<4>() - b[i].head<4>()).norm(),
                                             (a[i].head<4>() + b[i].head<4>()).norm());
      if (rotation_error > rounding || (a[i].tail<3>() - b[i].tail<3>()).norm() > rounding) {
        return false;
      }
    }
    return true;
  }

  void add(assembly_search_result& result, const Eigen::VectorXd& q) {
    const auto poses = link_poses(q);
    for (std::size_t i = 0; i < known_poses_.size(); ++i) {
      if (are_same(poses, known_poses_[i])) {
        ++result.positions[i].hits;
        return;
      }
    }
    known_poses_.push_back(poses);
    assembly_configuration configuration{q, 0, 1, true};
    const Eigen::MatrixXd j = columns(unit_jacobian(of_, q), free_);
    const Eigen::VectorXd s = rank_revealing_svd(j).singular_values();
    configuration.smallest_singular_value =
        s.size() == 0 || s.size() < j.cols() ? 0 : s[s.size() - 1];
    for (int i = 0; i < of_.size(); ++i) {
      const joint_limits<double>& limits = of_.tree().limits(i);
      configuration.within_limits &= limits.lower <= q[i] && q[i] <= limits.upper;
    }
    result.positions.push_back(configuration);
  }

  [[nodiscard]] static bool comes_first(const assembly_configuration& a,
                                        const assembly_configuration& b) {
    for (Eigen::Index i = 0; i < a.coordinates.size(); ++i) {
      if (std::abs(a.coordinates[i] - b.coordinates[i]) > 1e-6) {
        return a.coordinates[i] < b.coordinates[i];
      }
    }
    return false;
  }

  const closed_chain_mechanism& of_;
  Eigen::VectorXd at_;
  std::vector<int> free_;
  periodic_coordinates periodic_;
  std::vector<std::vector<Eigen::Matrix<double, 7, 1>>> known_poses_;
};

} // namespace
} // namespace duet::detail

namespace duet {
DUET_ABI_BEGIN

assembly_search_result find_assembly_configurations(const closed_chain_mechanism& mechanism,
                                                    const std::vector<int>& fixed,
                                                    const Eigen::VectorXd& at,
                                                    const assembly_search_options& options) {
  detail::require(Eigen::Index(fixed.size()) == at.size(),
                  "duet: find_assembly_configurations: ", at.size(), " values for ", fixed.size(),
                  " fixed coordinates");
  detail::require(at.allFinite(),
                  "duet: find_assembly_configurations: the fixed coordinates are not finite");
  Eigen::VectorXd q = Eigen::VectorXd::Zero(mechanism.size());
  static_cast<void>(detail::all_but(mechanism.size(), fixed));
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    q[fixed[i]] = at[Eigen::Index(i)];
  }
  return detail::assembly_search(mechanism, q, fixed).run(options);
}
DUET_ABI_END
} // namespace duet
