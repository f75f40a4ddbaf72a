// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// SIMD batches: the arm of `fk7` in 64 configurations, into an array of poses and Jacobians and
/// into batches; the spline of `spline` at 64 parameters. By hand: the scalar kernels in a loop.

#include "spline_workload.hpp"
#include "support/contest.hpp"
#include "workloads.hpp"

#include <duet/kinematics/robots.hpp>
#include <duet/kinematics/sweep.hpp>
#include <duet/spline/evaluate.hpp>

#include <array>
#include <cstddef>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace duet_bench {
namespace {

constexpr std::size_t count = 64;
using lanes = duet::batch<double>;
constexpr std::size_t batches = count / std::size_t(lanes::lanes);

using angles = inputs<double, joints>;
template <class S>
using arm_result = duet::value_and_jacobian<duet::dual_quaternion<S>, Eigen::Matrix<S, 6, joints>>;

constexpr auto known = duet::robots::panda();

double uniform(std::mt19937_64& engine) { return double(engine() >> 11) * 0x1p-53; }

/// Data that the contenders read and write.
struct arm_work {
  std::array<angles, count> theta;
  std::array<std::array<lanes, joints>, batches> theta_in_lanes;
  std::array<arm_result<double>, count> results;
  std::array<arm_result<lanes>, batches> results_in_lanes;
  std::array<std::pair<pose<double>, pose_jacobian>, count> results_by_hand;

  arm_work() {
    std::mt19937_64 engine(1);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < joints; ++j) {
        theta[i][j] = 6 * uniform(engine) - 3;
        theta_in_lanes[i / lanes::lanes][j].set(int(i % lanes::lanes), theta[i][j]);
      }
    }
  }
};

struct spline_work {
  std::vector<double> u = std::vector<double>(count);
  std::array<lanes, batches> u_in_lanes;
  std::vector<duet::motion<double>> results = std::vector<duet::motion<double>>(count);
  std::array<duet::motion<lanes>, batches> results_in_lanes;
  std::array<numbers_with_jerk, count> results_by_hand;

  spline_work() {
    std::mt19937_64 engine(1);
    for (std::size_t i = 0; i < count; ++i) {
      u[i] = uniform(engine) * segments * knot_distance;
      u_in_lanes[i / lanes::lanes].set(int(i % lanes::lanes), u[i]);
    }
  }
};

/// Contenders work in place and return no copies.
template <class Work, class F>
void add(std::string_view workload, std::string_view contender, const F& work_on) {
  register_benchmark(workload, contender, Work(), [=](Work& work) {
    work_on(work);
    benchmark::ClobberMemory();
    return 0;
  });
}

const bool registered = [] {
  const auto arm_by_hand = [](arm_work& w) {
    for (std::size_t i = 0; i < count; ++i) {
      w.results_by_hand[i].first = fk7_by_hand(w.theta[i], w.results_by_hand[i].second);
    }
  };
  const auto arm_sweep = [](arm_work& w) {
    duet::poses_and_jacobians(known, w.theta, duet::frame::hybrid, w.results);
  };
  const auto table = known.table();
  const auto table_sweep = [table](arm_work& w) {
    duet::poses_and_jacobians(table, w.theta, duet::frame::hybrid, w.results);
  };
  const auto arm_lanes = [](arm_work& w) {
    for (std::size_t i = 0; i < batches; ++i) {
      w.results_in_lanes[i] =
          duet::pose_and_jacobian(known, w.theta_in_lanes[i], duet::frame::hybrid);
    }
  };
  arm_work w;
  arm_by_hand(w);
  arm_sweep(w);
  arm_lanes(w);
  for (std::size_t i = 0; i < count; ++i) {
    const auto& in_lanes = w.results_in_lanes[i / lanes::lanes].jacobian;
    for (std::size_t row = 0; row < 3; ++row) {
      std::array<double, joints> sweep_row, lanes_row;
      for (std::size_t j = 0; j < joints; ++j) {
        sweep_row[j] = w.results[i].jacobian(Eigen::Index(row), Eigen::Index(j));
        lanes_row[j] = in_lanes(Eigen::Index(row), Eigen::Index(j))[int(i % lanes::lanes)];
      }
      expect_agreement("arm_sweep", "duet", w.results_by_hand[i].second[row], sweep_row);
      expect_agreement("arm_lanes", "duet", w.results_by_hand[i].second[row], lanes_row);
    }
  }
  add<arm_work>("arm_sweep", "duet", arm_sweep);
  add<arm_work>("arm_sweep", "hand", arm_by_hand);
  add<arm_work>("arm_sweep_of_table", "duet", table_sweep);
  add<arm_work>("arm_sweep_of_table", "hand", arm_by_hand);
  add<arm_work>("arm_lanes", "duet", arm_lanes);
  add<arm_work>("arm_lanes", "hand", arm_by_hand);

  const auto spline = make_spline();
  const hand_written_spline kernel(controls());
  const auto spline_by_hand = [=](spline_work& s) {
    for (std::size_t i = 0; i < count; ++i) {
      s.results_by_hand[i] = kernel.motion_with_jerk(s.u[i]);
    }
  };
  const auto spline_sweep = [=](spline_work& s) {
    duet::evaluate_motion(spline, s.u, duet::frame::body, s.results);
  };
  const auto spline_lanes = [=](spline_work& s) {
    for (std::size_t i = 0; i < batches; ++i) {
      s.results_in_lanes[i] = spline.motion(s.u_in_lanes[i], duet::frame::body);
    }
  };
  spline_work s;
  spline_by_hand(s);
  spline_sweep(s);
  for (std::size_t i = 0; i < count; ++i) {
    const auto& m = s.results[i];
    const numbers_with_jerk actual = {
        m.value.w(),   m.value.x(),   m.value.y(),       m.value.z(),       m.velocity[0],
        m.velocity[1], m.velocity[2], m.acceleration[0], m.acceleration[1], m.acceleration[2],
        m.jerk[0],     m.jerk[1],     m.jerk[2]};
    expect_agreement("spline_sweep", "duet", s.results_by_hand[i], actual);
  }
  add<spline_work>("spline_sweep", "duet", spline_sweep);
  add<spline_work>("spline_sweep", "hand", spline_by_hand);
  add<spline_work>("spline_lanes", "duet", spline_lanes);
  add<spline_work>("spline_lanes", "hand", spline_by_hand);
  return true;
}();

} // namespace
} // namespace duet_bench
