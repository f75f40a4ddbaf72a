// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// All solutions of random arms of every kind for goals of random configurations, and of
/// right-angled and public arms for goals of configurations with round numbers: whether these
/// configurations and the solutions of a nearby goal are among the solutions, the number of
/// solutions, and the processor time per goal. Arguments: number of goals of each kind (1000), seed
/// (1).

#include "../src/robotics/branches/chain_loop.hpp"
#include "../src/robotics/branches/singular_value.hpp"

#include <duet/core/random_source.hpp>
#include <duet/kinematics/chain_parameters.hpp>
#include <duet/kinematics/robots.hpp>
#include <duet/robotics/all_inverse_kinematics.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

namespace {

using namespace duet;
using std::numbers::pi;
using joints_of_arm = std::array<joint<>, 6>;

/// Joints with random axes and points in a cube of side 2.
joints_of_arm anywhere(random_source& random) {
  joints_of_arm joints;
  for (auto& j : joints) {
    const auto q = random.direction<4>();
    const auto at = [&] { return random.uniform(-1, 1); };
    j.origin = {quaternion<double>(q[0], q[1], q[2], q[3]), {at(), at(), at()}};
  }
  return joints;
}

void meet(joints_of_arm& joints, std::size_t i) { joints[i + 1].origin.translation = {0, 0, 0}; }
void align(joints_of_arm& joints, std::size_t i) {
  joints[i + 1].origin.rotation = quaternion<double>(1);
}

struct kind {
  const char* name;
  std::function<void(joints_of_arm&, random_source&)> specialise;
};

/// Denavit–Hartenberg parameters with right angles and half of the lengths 0.
void by_halves(joints_of_arm& joints, random_source& random) {
  for (auto& j : joints) {
    const auto length = [&] { return random.integer(0, 1) * random.uniform(.1, 1); };
    const double sine = random.sign() * std::sqrt(.5), a = length(), d = length();
    j.origin = {quaternion<double>(std::sqrt(.5), sine, 0, 0),
                {a, 2 * sine * std::sqrt(.5) * d, 0}};
  }
}

double distance(const serial_chain<6>& arm, const Eigen::Matrix<double, 6, 1>& a,
                const Eigen::Matrix<double, 6, 1>& b) {
  double largest = 0;
  for (int i = 0; i < 6; ++i) {
    const double d = a[i] - b[i];
    largest = std::max(
        largest, std::abs(arm.kind(i) == joint_kind::prismatic ? d : std::remainder(d, 2 * pi)));
  }
  return largest;
}

/// An arm, the configuration of a goal, and the solutions.
struct task {
  serial_chain<6> arm;
  Eigen::Matrix<double, 6, 1> theta;
  dual_quaternion<double> goal;
  all_inverse_kinematics_result all{};
};

task random_task(const serial_chain<6>& arm, random_source& random) {
  Eigen::Matrix<double, 6, 1> theta;
  for (int i = 0; i < 6; ++i) {
    const double largest = arm.kind(i) == joint_kind::prismatic ? 1 : pi;
    theta[i] = random.uniform(-largest, largest);
  }
  return {arm, theta, arm.pose(theta)};
}

/// Quarter turns, multiples of 15 degrees, of 1/8 rad, or of these and zeros.
task structured_task(const serial_chain<6>& arm, random_source& random) {
  const int kind = random.integer(0, 3);
  Eigen::Matrix<double, 6, 1> theta;
  for (int i = 0; i < 6; ++i) {
    const bool is_prismatic = arm.kind(i) == joint_kind::prismatic;
    theta[i] = is_prismatic                             ? random.integer(-8, 8) / 8.
               : kind == 0                              ? random.integer(-1, 2) * pi / 2
               : kind == 1                              ? random.integer(-11, 12) * pi / 12
               : kind == 3 && random.integer(0, 1) == 0 ? 0
                                                        : random.integer(-25, 25) / 8.;
  }
  return {arm, theta, arm.pose(theta)};
}

/// Rows of Denavit and Hartenberg: a, d, α.
using table = std::array<std::array<double, 3>, 6>;

serial_chain<6> arm_of(const table& rows, int prismatic = -1) {
  std::array<dh_row<>, 6> all;
  for (std::size_t i = 0; i < 6; ++i) {
    all[i].a = rows[i][0];
    all[i].d = rows[i][1];
    all[i].alpha = rows[i][2];
    all[i].kind = int(i) == prismatic ? joint_kind::prismatic : joint_kind::revolute;
  }
  return from_dh(all);
}

/// Public arms without spherical wrist, and difficult ones.
serial_chain<6> known_arm(random_source& random) {
  constexpr double q = pi / 2;
  constexpr std::array<table, 10> tables{
      {{{{.36, .01, q},
         {-.36, .42, q},
         {-.46, .27, -q},
         {.3, .42},
         {.22, -.12, -q},
         {.29, -.29, -q}}},
       {{{0, -.42, q}, {.12, .41}, {-.2, -.41, q}, {0, -.24, q}, {.41, -.28, -q}, {.11, -.47, q}}},
       {{{0, .4, q}, {.35}, {0, 0, q}, {0, .3, -q}, {.003, 0, q}, {0, .1}}},
       {{{0, .267, -q},
         {.28949},
         {.0775, 0, -q},
         {0, .3425, q},
         {.076, 0, -q},
         {0, .097}}},                                                                    // xArm6
       {{{0, .245, -q}, {.71, 0, pi}, {0, 0, -q}, {0, .54, q}, {0, .15, -q}, {0, .16}}}, // CRX-10iA
       {{{0, .2755, q},
         {.41, 0, pi},
         {0, -.0098, q},
         {0, -.2502, pi / 3},
         {0, -.0858, pi / 3},
         {0, -.2116, pi}}}, // Jaco
       {{{0, .2433, q},
         {.28, .03, pi},
         {0, .02, q},
         {0, .245, q},
         {0, .057, q},
         {0, .235}}}, // Gen3 lite
       {{{.3, 0, q},
         {1, 0, pi / 180},
         {0, .2, q},
         {1.5, 0, pi / 180},
         {0, 0, q},
         {0, 0, pi / 180}}},
       {{{.15, .45, -q}, {.614, 0, pi}, {.2, 0, -q}, {0, -.64, q}, {.03, 0, -q}, {0, -.2}}},
       {{{0, .5, -q}, {.7}, {0, 0, q}, {0, .6, pi / 3}, {0, .1, -pi / 3}, {0, .1}}}}};
  return arm_of(tables[std::size_t(random.integer(0, int(tables.size()) - 1))]);
}

/// Arm with angles that are multiples of π / `parts`, and lengths of 1/100; one in `zeros` is 0.
serial_chain<6> round_arm(random_source& random, int parts, int zeros, bool is_prismatic = false) {
  table rows;
  for (auto& row : rows) {
    const auto length = [&] {
      return random.integer(1, zeros) == 1 ? 0 : random.sign() * random.integer(1, 50) / 100.;
    };
    const double a = length(), d = length();
    const int angle = parts == 2
                          ? (random.integer(1, 2 * zeros) == 1 ? 0 : random.integer(0, 1) * 2 - 1)
                          : random.integer(1 - parts, parts);
    row = {a, d, angle * pi / parts};
  }
  return arm_of(rows, is_prismatic ? random.integer(0, 5) : -1);
}

/// Number of regular solutions near those of a nearby goal that are missing.
int lost_near_goal(const task& t, random_source& random) {
  const auto rotation = random.direction<3>(), direction = random.direction<3>();
  constexpr double size = 1e-6;
  const auto moved =
      pose(exp(vector3<double>(size * rotation[0], size * rotation[1], size * rotation[2])),
           Eigen::Vector3d(size * direction[0], size * direction[1], size * direction[2]));
  int lost = 0;
  const detail::branches_of_chain branches(t.arm, t.goal);
  const detail::branches_of_chain nearby(t.arm, moved * t.goal);
  for (auto x : detail::solutions_of(nearby.loop()).solutions) {
    if (detail::close_loop(branches.loop(), x.theta)) {
      const auto solution = branches(x);
      const bool is_regular =
          detail::smallest_singular_value(jacobian(t.arm, solution.joints, frame::hybrid)) > 1e-4;
      lost += is_regular && solution.residual < 1e-12 &&
              std::none_of(t.all.solutions.begin(), t.all.solutions.end(), [&](const auto& s) {
                return distance(t.arm, s.joints, solution.joints) < 1e-6;
              });
    }
  }
  return lost;
}

using make_task = std::function<task(random_source&)>;

void report(const char* name, int count, random_source& random, bool is_structured,
            const make_task& make) {
  constexpr int together = 100; // because reading the clock takes time
  constexpr double singular = 1e-6;
  int regular = 0, missed = 0, unseen = 0, uncertain = 0, singular_count = 0, solutions = 0,
      max_solutions = 0, complex = 0;
  double worst = 0, seconds = 0;
  std::vector<task> tasks;
  for (int done = 0; done < count; done += int(tasks.size())) {
    tasks.clear();
    for (int k = 0; k < std::min(together, count - done); ++k) {
      tasks.push_back(make(random));
    }
    const std::clock_t start = std::clock();
    for (task& t : tasks) {
      t.all = all_inverse_kinematics(t.arm, t.goal);
    }
    seconds += double(std::clock() - start) / CLOCKS_PER_SEC;
    for (const task& t : tasks) {
      const auto& all = t.all.solutions;
      const bool is_reached = std::any_of(all.begin(), all.end(), [&](const auto& s) {
        return distance(t.arm, s.joints, t.theta) < 1e-6;
      });
      int lost = is_structured ? lost_near_goal(t, random) : 0;
      if (detail::smallest_singular_value(jacobian(t.arm, t.theta, frame::hybrid)) >= singular) {
        lost = std::max(lost, is_reached ? 0 : 1);
      } else {
        unseen += all.empty() && t.all.is_complete;
        if (!is_structured) {
          continue;
        }
      }
      ++regular;
      missed += lost;
      unseen += t.all.is_complete ? lost : 0;
      const bool is_singular = std::any_of(all.begin(), all.end(), [&](const auto& s) {
        return s.smallest_singular_value < singular;
      });
      singular_count += !t.all.is_complete && is_singular;
      uncertain += !t.all.is_complete && !is_singular;
      solutions += int(all.size());
      max_solutions = std::max(max_solutions, int(all.size()));
      complex += t.all.complex_solutions;
      for (const auto& s : all) {
        worst = std::max(worst, s.residual);
      }
    }
  }
  std::printf("| %s | %d | %d | %d | %d | %d | %.2f | %d | %.2f | %.1e | %.1f |\n", name, regular,
              missed, unseen, uncertain, singular_count, double(solutions) / regular, max_solutions,
              double(complex) / regular, worst, 1e6 * seconds / count);
  std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 1000;
  const auto seed = std::uint64_t(argc > 2 ? std::atoi(argv[2]) : 1);
  const std::vector<kind> kinds{
      {"general", [](auto&, auto&) {}},
      {"axes 2 and 3 parallel", [](auto& j, auto&) { align(j, 1); }},
      {"axes 4 and 5 meet", [](auto& j, auto&) { meet(j, 3); }},
      {"1 and 2 meet, 2 and 3 parallel, 4 and 5 meet",
       [](auto& j, auto&) {
         meet(j, 0);
         align(j, 1);
         meet(j, 3);
       }},
      {"right angles, half of all lengths 0", by_halves},
      {"one prismatic joint",
       [](auto& j, auto& random) {
         j[std::size_t(random.integer(0, 5))].kind = joint_kind::prismatic;
       }},
      {"two adjacent prismatic joints",
       [](auto& j, auto& random) {
         const auto i = std::size_t(random.integer(0, 4));
         j[i].kind = j[i + 1].kind = joint_kind::prismatic;
       }},
      {"spherical wrist",
       [](auto& j, auto&) {
         meet(j, 3);
         meet(j, 4);
       }},
      {"spherical wrist, 2 and 3 parallel, 1 and 2 meet",
       [](auto& j, auto&) {
         meet(j, 0);
         align(j, 1);
         meet(j, 3);
         meet(j, 4);
       }},
      {"axes 2, 3 and 4 parallel",
       [](auto& j, auto&) {
         align(j, 1);
         align(j, 2);
       }},
      {"two separate prismatic joints",
       [](auto& j, auto& random) {
         const auto i = std::size_t(random.integer(0, 3));
         const auto other = std::size_t(random.integer(int(i) + 2, 5));
         j[i].kind = j[other].kind = joint_kind::prismatic;
       }},
      {"right angles, half of all lengths 0, two prismatic joints",
       [](auto& j, auto& random) {
         by_halves(j, random);
         const auto i = std::size_t(random.integer(0, 4));
         j[i].kind = j[std::size_t(random.integer(int(i) + 1, 5))].kind = joint_kind::prismatic;
       }},
      {"three prismatic joints", [](auto& j, auto& random) {
         std::array<std::size_t, 6> order{0, 1, 2, 3, 4, 5};
         for (std::size_t i = 5; i > 0; --i) {
           std::swap(order[i], order[std::size_t(random.integer(0, int(i)))]);
         }
         for (std::size_t i = 0; i < 3; ++i) {
           j[order[i]].kind = joint_kind::prismatic;
         }
       }}};
  std::printf(
      "| arms, seed %llu | goals | missed | though complete | not certain | singular | solutions | "
      "most | complex | worst residual | µs |\n|---|---|---|---|---|---|---|---|---|---|---|\n",
      static_cast<unsigned long long>(seed));
  for (const kind& k : kinds) {
    random_source random(seed);
    report(k.name, count, random, false, [&](random_source& r) {
      auto joints = anywhere(r);
      k.specialise(joints, r);
      return random_task(serial_chain<6>(joints), r);
    });
  }
  random_source random(seed);
  report("UR5e", count, random, false,
         [](random_source& r) { return random_task(robots::ur5e().table(), r); });
  const auto structured = [&](const char* name, auto make_arm) {
    report(name, count, random, true,
           [&](random_source& r) { return structured_task(make_arm(r), r); });
  };
  structured("known arms, round goals", known_arm);
  structured("right angles, round goals", [](auto& r) { return round_arm(r, 2, 1000); });
  structured("right and no angles, zeros, round goals", [](auto& r) { return round_arm(r, 2, 3); });
  structured("multiples of 30 degrees, zeros, round goals",
             [](auto& r) { return round_arm(r, 6, 3); });
  structured("right angles, zeros, one prismatic joint, round goals",
             [](auto& r) { return round_arm(r, 2, 3, true); });
}
