// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Inverse kinematics of four arms, 10 000 reachable poses each, and the solvers of Orocos KDL
/// beside it: what share is solved to 1e-6 within the limits, and the mean time of a pose.

#include <duet/core/random_source.hpp>
#include <duet/kinematics/robots.hpp>
#include <duet/robotics/inverse_kinematics.hpp>

#include <benchmark/benchmark.h>

#if DUET_BENCH_KDL
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <kdl/chainiksolverpos_nr_jl.hpp>
#include <kdl/chainiksolvervel_pinv.hpp>
#endif

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace {

using namespace duet;

template <int N>
struct problem {
  dual_quaternion<double> goal;
  Eigen::Matrix<double, N, 1> start;
};

enum class start { centre, anywhere };

/// Configurations, and starts if not in the middle, are uniform within the limits.
template <class C>
std::vector<problem<C::joints>> problems(const C& chain, start from) {
  const auto lower = lower_limits(chain), upper = upper_limits(chain);
  random_source random(7);
  const auto configuration = [&] {
    auto theta = lower;
    for (int i = 0; i < chain.size(); ++i) {
      theta[i] = random.uniform(lower[i], upper[i]);
    }
    return theta;
  };
  std::vector<problem<C::joints>> result(10000);
  for (auto& p : result) {
    p.goal = chain.pose(configuration());
    p.start = configuration();
    if (from == start::centre) {
      p.start = (lower + upper) / 2;
    }
  }
  return result;
}

/// True if the tip is at the goal and the joints are within limits.
template <class C, class X>
bool is_solution(const C& chain, const X& theta, const dual_quaternion<double>& goal) {
  const pose_error deviation = pose_error_between(chain.pose(theta), goal);
  const bool is_inside = (theta - lower_limits(chain)).minCoeff() >= 0 &&
                         (upper_limits(chain) - theta).minCoeff() >= 0;
  return is_inside && std::max(deviation.translation, deviation.rotation) <= 1e-6 * (1 + 1e-9);
}

/// `solve(problem)` returns joints.
template <class C, class Solve>
void add(const std::string& name, const C& chain, start from, Solve solve) {
  const std::string where = from == start::centre ? "/middle/" : "/anywhere/";
  const auto all = std::make_shared<const std::vector<problem<C::joints>>>(problems(chain, from));
  const auto slash = name.find('/');
  benchmark::RegisterBenchmark((name.substr(0, slash) + where + name.substr(slash + 1)).c_str(),
                               [=](benchmark::State& state) mutable {
                                 std::size_t solved = 0, count = 0;
                                 for (auto _ : state) {
                                   for (const auto& p : *all) {
                                     solved += is_solution(chain, solve(p), p.goal);
                                     ++count;
                                   }
                                 }
                                 state.counters["solved_%"] = 100 * double(solved) / double(count);
                                 state.counters["mean_time"] = benchmark::Counter(
                                     double(count),
                                     benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
                               })
      ->Unit(benchmark::kMillisecond)
      ->Iterations(1);
}

#if DUET_BENCH_KDL

template <class C>
KDL::Chain kdl_chain(const C& chain) {
  const auto kdl_rotation = [](const quaternion<double>& q) {
    return KDL::Rotation::Quaternion(q.x(), q.y(), q.z(), q.w());
  };
  KDL::Chain result;
  for (int i = 0; i < chain.size(); ++i) {
    const auto& step = chain.steps()[std::size_t(i)];
    const KDL::Vector origin(step.offset.x, step.offset.y, step.offset.z);
    const KDL::Vector axis(step.axis.x, step.axis.y, step.axis.z);
    result.addSegment(KDL::Segment(KDL::Joint(origin, axis, KDL::Joint::RotAxis),
                                   KDL::Frame(kdl_rotation(step.a), origin)));
  }
  const auto& tool = chain.tip().offset;
  result.addSegment(KDL::Segment(
      KDL::Joint(KDL::Joint::None),
      KDL::Frame(kdl_rotation(tool.rotation),
                 KDL::Vector(tool.translation[0], tool.translation[1], tool.translation[2]))));
  return result;
}

KDL::Frame kdl_frame(const dual_quaternion<double>& a) {
  const auto t = translation(a);
  const auto q = rotation(a);
  return {KDL::Rotation::Quaternion(q.x(), q.y(), q.z(), q.w()), KDL::Vector(t[0], t[1], t[2])};
}

template <class X>
KDL::JntArray kdl_joints(const X& theta) {
  KDL::JntArray result(unsigned(theta.size()));
  result.data = theta;
  return result;
}

/// Levenberg and Marquardt's method, which knows no limits: as it is, and begun anew until the
/// joints are within them.
template <class C>
void add_lma(const std::string& robot, const C& chain, start from, int restarts) {
  struct solver {
    explicit solver(const C& c)
        : chain(kdl_chain(c)), lma(chain, Eigen::Matrix<double, 6, 1>::Ones().eval(), 1e-6) {}
    KDL::Chain chain;
    KDL::ChainIkSolverPos_LMA lma;
  };
  const auto kdl = std::make_shared<solver>(chain);
  add(robot + (restarts > 0 ? "/kdl_lma_restarts" : "/kdl_lma"), chain, from, [=](const auto& p) {
    const auto lower = lower_limits(chain), upper = upper_limits(chain);
    auto theta = p.start;
    KDL::JntArray solution(unsigned(theta.size()));
    random_source random(1);
    for (int k = 0;; ++k) {
      kdl->lma.CartToJnt(kdl_joints(theta), kdl_frame(p.goal), solution);
      theta = solution.data;
      if (k == restarts || is_solution(chain, theta, p.goal)) {
        return theta;
      }
      for (int i = 0; i < chain.size(); ++i) {
        theta[i] = random.uniform(lower[i], upper[i]);
      }
    }
  });
}

/// Newton's method, clamped to the limits.
template <class C>
void add_newton(const std::string& robot, const C& chain, start from) {
  struct solver {
    explicit solver(const C& c)
        : chain(kdl_chain(c)), pose(chain), velocity(chain),
          newton(chain, kdl_joints(lower_limits(c)), kdl_joints(upper_limits(c)), pose, velocity) {}
    KDL::Chain chain;
    KDL::ChainFkSolverPos_recursive pose;
    KDL::ChainIkSolverVel_pinv velocity;
    KDL::ChainIkSolverPos_NR_JL newton;
  };
  const auto kdl = std::make_shared<solver>(chain);
  add(robot + "/kdl_nr_jl", chain, from, [=](const auto& p) {
    auto theta = p.start;
    KDL::JntArray solution(unsigned(theta.size()));
    kdl->newton.CartToJnt(kdl_joints(theta), kdl_frame(p.goal), solution);
    theta = solution.data;
    return theta;
  });
}

#endif

template <class C>
void add_all(const std::string& robot, const C& chain) {
  for (const start from : {start::centre, start::anywhere}) {
    add(robot + "/duet", chain, from,
        [=](const auto& p) { return inverse_kinematics(chain, p.goal, p.start).joints; });
#if DUET_BENCH_KDL
    add_lma(robot, chain, from, 0);
    add_lma(robot, chain, from, 100);
    add_newton(robot, chain, from);
#endif
  }
}

} // namespace

int main(int argc, char** argv) {
  add_all("panda", robots::panda());
  add_all("iiwa14", robots::iiwa14());
  add_all("ur5e", robots::ur5e());
  add_all("baxter_left", robots::baxter_left());
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return 1;
  }
  benchmark::RunSpecifiedBenchmarks();
}
