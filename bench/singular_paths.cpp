// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Screws through singularities and from them, of five arms of six joints and three of seven: how
/// many of 500 problems each are planned, and how many a plain tracker by Newton's method follows
/// from one end or the other, in 300, 1000 or 1001 equal steps; reasons of the rest. With
/// DUET_BENCH_MISSED set it tells what a tracker solves and the planner does not. Arguments: the
/// number of problems of each of five families (100), the seed (1).
/// build/bench/bench/duet_singular_paths_bench

#include <duet/core/random_source.hpp>
#include <duet/mechanism/denavit_hartenberg.hpp>
#include <duet/mechanism/jacobian.hpp>
#include <duet/mechanism/robots.hpp>
#include <duet/planning/plan_screw_motion.hpp>

#include <Eigen/SVD>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace duet;
using std::numbers::pi;
using goal_pose = dual_quaternion<double>;

template <int N>
using joints_of = Eigen::Matrix<double, N, 1>;

template <int N>
struct arm {
  const char* name;
  serial_chain<N> chain;
};

joint_limits<> degrees(double lower, double upper) { return {lower * pi / 180, upper * pi / 180}; }

/// Five arms of six joints, from their makers' dimensions, in metres.
std::vector<arm<6>> six_joints() {
  const double quarter = pi / 2;
  const std::array<dh_row<>, 6> puma{
      {{.alpha = quarter, .limits = degrees(-160, 160)},
       {.a = .4318, .limits = degrees(-225, 45)},
       {.a = .0203, .d = .15005, .alpha = -quarter, .limits = degrees(-225, 45)},
       {.d = .4318, .alpha = quarter, .limits = degrees(-110, 170)},
       {.alpha = -quarter, .limits = degrees(-100, 100)},
       {.d = .1, .limits = degrees(-266, 266)}}};
  const std::array<dh_row<>, 6> irb{{{.d = .29, .alpha = -quarter, .limits = degrees(-165, 165)},
                                     {.a = .27, .theta = -quarter, .limits = degrees(-110, 110)},
                                     {.a = .07, .alpha = -quarter, .limits = degrees(-110, 70)},
                                     {.d = .302, .alpha = quarter, .limits = degrees(-160, 160)},
                                     {.alpha = -quarter, .limits = degrees(-120, 120)},
                                     {.d = .072, .theta = pi, .limits = degrees(-400, 400)}}};
  const std::array<dh_row<>, 6> kr{
      {{.a = .025, .d = .4, .alpha = -quarter, .limits = degrees(-170, 170)},
       {.a = .455, .limits = degrees(-190, 45)},
       {.a = .035, .alpha = -quarter, .theta = -quarter, .limits = degrees(-120, 156)},
       {.d = .42, .alpha = quarter, .limits = degrees(-185, 185)},
       {.alpha = -quarter, .limits = degrees(-120, 120)},
       {.d = .08, .limits = degrees(-350, 350)}}};
  const std::array<dh_row<>, 6> mate{
      {{.a = .05, .d = .33, .alpha = -quarter, .limits = degrees(-170, 170)},
       {.a = .33, .theta = -quarter, .limits = degrees(-100, 145)},
       {.a = .035, .alpha = -quarter, .limits = degrees(-140, 213)},
       {.d = .335, .alpha = quarter, .limits = degrees(-190, 190)},
       {.alpha = -quarter, .limits = degrees(-125, 125)},
       {.d = .08, .limits = degrees(-360, 360)}}};
  return {{"UR5e", robots::ur5e().table()},
          {"PUMA 560", from_dh(puma)},
          {"IRB 120", from_dh(irb)},
          {"KR 6 R900", from_dh(kr)},
          {"LR Mate 200iD", from_dh(mate)}};
}

std::vector<arm<7>> seven_joints() {
  return {{"Panda", robots::panda().table()},
          {"iiwa 14", robots::iiwa14().table()},
          {"Baxter", robots::baxter_left().table()}};
}

enum class family { across, beside, past, from_elbow, from_wrist };
constexpr std::array families{"across the wrist", "across, all joints", "beside the wrist",
                              "from a stretched elbow", "from the wrist"};

template <int N>
struct problem {
  joints_of<N> start, end;
};

/// The coordinate of the elbow at which the wrist is farthest from the shoulder: the square of that
/// distance is A + B cos θ + C sin θ.
template <int N>
double stretched(const serial_chain<N>& chain, joints_of<N> theta, int elbow) {
  const auto square = [&](double x) {
    theta[elbow] = x;
    const auto shoulder = chain.pose(theta, N == 6 ? 1 : 2);
    const Eigen::Vector3d way =
        translation(chain.pose(theta, N == 6 ? 4 : 5)) - translation(shoulder);
    const Eigen::Vector3d axis = rotate(rotation(shoulder), Eigen::Vector3d(0, 0, 1));
    return N == 6 ? (way - axis.dot(way) * axis).squaredNorm() : way.squaredNorm();
  };
  const double middle = (square(0) + square(pi)) / 2;
  return std::atan2(square(pi / 2) - middle, square(0) - middle);
}

/// Starts in the inner 80 % of the joints' ranges. Across: joint 5 (of seven joints 6; of the Panda
/// 2) from x to −x, the others as they were, or up to 0.5
/// rad away, or next to nothing: 1e-6 to 1e-2 rad. From a stretched elbow, from joint 5 at 0: all
/// joints up to 0.5 and 1 rad away.
template <int N>
problem<N> make(const arm<N>& a, family kind, random_source& random) {
  const int wrist = N == 6 ? 4 : std::string(a.name) == "Panda" ? 1 : 5, elbow = N == 6 ? 2 : 3;
  problem<N> p;
  for (int i = 0; i < N; ++i) {
    const double lower = a.chain.limits(i).lower, upper = a.chain.limits(i).upper;
    p.start[i] = (lower + upper) / 2 + .4 * (upper - lower) * random.uniform(-1, 1);
  }
  if (kind == family::from_elbow) {
    p.start[elbow] = std::clamp(stretched(a.chain, p.start, elbow), a.chain.limits(elbow).lower,
                                a.chain.limits(elbow).upper);
  } else {
    const double most = .8 * std::min(-a.chain.limits(wrist).lower, a.chain.limits(wrist).upper);
    p.start[wrist] = kind == family::from_wrist ? 0 : random.sign() * random.uniform(.1, most);
  }
  p.end = p.start;
  const double near = kind == family::across       ? 0
                      : kind == family::past       ? random.magnitude(1e-6, 1e-2)
                      : kind == family::from_wrist ? 1
                                                   : .5;
  for (int i = 0; i < N; ++i) {
    p.end[i] = std::clamp(p.end[i] + near * random.uniform(-1, 1), a.chain.limits(i).lower,
                          a.chain.limits(i).upper);
  }
  if (kind != family::from_elbow && kind != family::from_wrist) {
    p.end[wrist] = -p.start[wrist];
  }
  return p;
}

/// The shorter screw from pose to pose.
struct screw {
  goal_pose first, last;
  goal_pose operator()(double u) const { return sclerp(first, last, u); }
};

template <int N>
bool is_within(const serial_chain<N>& chain, const joints_of<N>& theta) {
  for (int i = 0; i < N; ++i) {
    if (!(theta[i] >= chain.limits(i).lower - 1e-12 && theta[i] <= chain.limits(i).upper + 1e-12)) {
      return false;
    }
  }
  return true;
}

double apart(const goal_pose& a, const goal_pose& b) {
  const auto d = deviation_between(a, b);
  return std::max(d.length, d.angle);
}

/// Newton's method to a pose by least steps; singular values below 1e-7 are left out.
template <int N>
std::optional<joints_of<N>> newton(const serial_chain<N>& chain, joints_of<N> theta,
                                   const goal_pose& goal) {
  for (int k = 0; k < 12; ++k) {
    const auto here = detail::place_of(chain.pose(theta));
    const auto e = detail::error_twist(here, detail::place_of(goal));
    const Eigen::Matrix<double, 6, 1> twist =
        Eigen::Map<const Eigen::Matrix<double, 6, 1>>(&e.values[0]);
    if (apart(chain.pose(theta), goal) < 1e-7) {
      return theta;
    }
    Eigen::JacobiSVD<Eigen::Matrix<double, 6, N>> svd(jacobian(chain, theta, frame::hybrid),
                                                      Eigen::ComputeFullU | Eigen::ComputeFullV);
    svd.setThreshold(1e-7);
    const joints_of<N> step = svd.solve(twist);
    if (!(step.norm() < .3)) {
      return {};
    }
    theta += step;
  }
  return {};
}

/// Follows a path of poses in `steps` equal steps; nothing where it leaves the limits or, half way
/// between two of them, is 1e-5 off the path.
template <int N, class Path>
std::optional<joints_of<N>> tracked(const serial_chain<N>& chain, joints_of<N> theta,
                                    const Path& path, int steps) {
  for (int k = 1; k <= steps; ++k) {
    const auto next = newton(chain, theta, path(double(k) / steps));
    if (!next || !is_within(chain, *next) ||
        apart(chain.pose(joints_of<N>((theta + *next) / 2)), path((k - .5) / steps)) > 1e-5) {
      return {};
    }
    theta = *next;
  }
  return theta;
}

/// Do the joints get from one configuration of a pose to another with the tip in place, each
/// step as straight as may be?
template <int N>
bool are_connected(const serial_chain<N>& chain, joints_of<N> from, const joints_of<N>& to) {
  const goal_pose place = chain.pose(to);
  for (int k = 0; k < 1000; ++k) {
    const joints_of<N> way = to - from;
    if (way.norm() < .1 && apart(chain.pose(joints_of<N>(from + way / 2)), place) < 1e-5) {
      return true;
    }
    const Eigen::JacobiSVD<Eigen::Matrix<double, 6, N>> svd(
        jacobian(chain, from, frame::hybrid), Eigen::ComputeFullU | Eigen::ComputeFullV);
    joints_of<N> along = joints_of<N>::Zero();
    for (int i = 0; i < N; ++i) {
      if (i >= 6 || svd.singularValues()[i] < 1e-3) {
        along += svd.matrixV().col(i).dot(way) * svd.matrixV().col(i);
      }
    }
    if (!(along.norm() > 1e-4)) {
      return false;
    }
    const auto next =
        newton(chain, joints_of<N>(from + along * std::min(1., .02 / along.norm())), place);
    if (!next || !is_within(chain, *next)) {
      return false;
    }
    from = *next;
  }
  return false;
}

template <int N>
bool is_good(const serial_chain<N>& chain, const problem<N>& p, const motion_plan<N>& plan,
             const screw& path) {
  if (plan.joints.front() != p.start || plan.tau.back() != 1) {
    return false;
  }
  for (std::size_t k = 1; k < plan.joints.size(); ++k) {
    for (int part = 1; part <= 10; ++part) {
      const double x = part / 10.;
      const joints_of<N> theta = (1 - x) * plan.joints[k - 1] + x * plan.joints[k];
      if (plan.tau[k] < plan.tau[k - 1] || !is_within(chain, theta) ||
          apart(chain.pose(theta), path((1 - x) * plan.tau[k - 1] + x * plan.tau[k])) > 1.1e-5) {
        return false;
      }
    }
  }
  return true;
}

struct score {
  int planned = 0, forward = 0, either = 0, missed = 0, bad = 0;
  double seconds = 0, slowest = 0;
  std::map<std::string, int> reasons;
};

template <int N>
score solve(const arm<N>& a, family kind, int count, unsigned seed) {
  random_source random(seed);
  score result;
  for (int k = 0; k < count; ++k) {
    const auto p = make(a, kind, random);
    const screw path{a.chain.pose(p.start), a.chain.pose(p.end)};
    const std::clock_t begin = std::clock();
    const auto plan = plan_screw_motion(a.chain, p.start, path.last);
    const double took = double(std::clock() - begin) / CLOCKS_PER_SEC;
    result.seconds += took;
    result.slowest = std::max(result.slowest, took);
    const bool is_planned = plan.reason == stop_reason::reached;
    const bool is_bad = is_planned && !is_good(a.chain, p, plan, path);
    bool is_forward = false, is_either = false;
    for (const int steps : {300, 1000, 1001}) {
      is_forward = is_forward || tracked(a.chain, p.start, path, steps);
      if (is_forward || is_either) {
        is_either = true;
        continue;
      }
      const auto back = tracked(
          a.chain, p.end, [&](double u) { return path(1 - u); }, steps);
      is_either = back && are_connected(a.chain, *back, p.start);
    }
    result.planned += is_planned && !is_bad;
    result.bad += is_bad;
    result.forward += is_forward;
    result.either += is_either;
    const bool is_missed = is_either && (!is_planned || is_bad);
    result.missed += is_missed;
    if (!is_planned) {
      ++result.reasons[to_text(plan.reason)];
    }
    if (is_missed && std::getenv("DUET_BENCH_MISSED") != nullptr) {
      std::printf("  missed %d: %s at %.9g after %d, sigma %.2g%s\n", k, to_text(plan.reason),
                  plan.tau.back(), plan.iterations, plan.smallest_singular_value,
                  is_bad ? ", bad" : "");
    }
  }
  return result;
}

template <int N>
void table_of(const std::vector<arm<N>>& arms, int count, unsigned seed) {
  for (const arm<N>& a : arms) {
    score sum;
    for (std::size_t k = 0; k < families.size(); ++k) {
      const score s = solve(a, family(k), count, seed);
      std::printf("%-14s %-22s %4d %4d %4d %4d %4d %7.2f", a.name, families[k], s.forward, s.either,
                  s.planned, s.missed, s.bad, 1e3 * s.seconds / count);
      for (const auto& [name, n] : s.reasons) {
        std::printf("  %s %d", name.c_str(), n);
      }
      std::printf("\n");
      sum.forward += s.forward;
      sum.either += s.either;
      sum.planned += s.planned;
      sum.missed += s.missed;
      sum.bad += s.bad;
    }
    std::printf("%-14s %-22s %4d %4d %4d %4d %4d\n", a.name, "all", sum.forward, sum.either,
                sum.planned, sum.missed, sum.bad);
    std::fflush(stdout);
  }
}

} // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 100;
  const unsigned seed = argc > 2 ? unsigned(std::atoi(argv[2])) : 1;
  std::printf("%-14s %-22s %4s %4s %4s %4s %4s %7s\n", "arm", "from", "on", "both", "plan", "less",
              "bad", "ms");
  table_of(six_joints(), count, seed);
  table_of(seven_joints(), count, seed);
}
