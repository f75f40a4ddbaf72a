// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// All solutions of random arms of every kind, for goals made from random joint coordinates:
/// whether these are among the solutions, how many solutions there are, and the processor's time
/// for a goal. Arguments: the number of arms of each kind (1000), the seed (1).

#include <duet/core/random_source.hpp>
#include <duet/mechanism/robots.hpp>
#include <duet/planning/all_inverse_kinematics.hpp>

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

/// Joints in random places: any axes, points in a cube of side 2.
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

/// Parameters of Denavit and Hartenberg, half of which are 0, angles right ones.
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

/// An arm, the coordinates that a goal is made of, and what was found.
struct task {
  serial_chain<6> arm;
  Eigen::Matrix<double, 6, 1> theta;
  dual_quaternion<double> goal;
  all_inverse_kinematics_result<6> all{};
};

task random_task(const serial_chain<6>& arm, random_source& random) {
  Eigen::Matrix<double, 6, 1> theta;
  for (int i = 0; i < 6; ++i) {
    const double largest = arm.kind(i) == joint_kind::prismatic ? 1 : pi;
    theta[i] = random.uniform(-largest, largest);
  }
  return {arm, theta, arm.pose(theta)};
}

void report(const char* name, int count, random_source& random,
            const std::function<serial_chain<6>(random_source&)>& make) {
  constexpr int together = 100; // as asking for the time takes some itself
  int found = 0, singular = 0, complete = 0, solutions = 0, most = 0, complex = 0;
  double worst = 0, seconds = 0;
  std::vector<task> tasks;
  for (int done = 0; done < count; done += int(tasks.size())) {
    tasks.clear();
    for (int k = 0; k < std::min(together, count - done); ++k) {
      tasks.push_back(random_task(make(random), random));
    }
    const std::clock_t start = std::clock();
    for (task& t : tasks) {
      t.all = all_inverse_kinematics(t.arm, t.goal);
    }
    seconds += double(std::clock() - start) / CLOCKS_PER_SEC;
    for (const task& t : tasks) {
      if (detail::smallest_singular_value(jacobian(t.arm, t.theta, frame::hybrid)) < 1e-6) {
        ++singular;
        continue;
      }
      const auto& all = t.all.solutions;
      found += std::any_of(all.begin(), all.end(), [&](const auto& s) {
        return distance(t.arm, s.joints, t.theta) < 1e-6;
      });
      complete += t.all.is_complete;
      solutions += int(all.size());
      most = std::max(most, int(all.size()));
      complex += t.all.complex_solutions;
      for (const auto& s : all) {
        worst = std::max(worst, s.residual);
      }
    }
  }
  const int regular = count - singular;
  std::printf("| %s | %d | %d | %d | %.2f | %d | %.2f | %.1e | %.1f |\n", name, regular,
              regular - found, regular - complete, double(solutions) / regular, most,
              double(complex) / regular, worst, 1e6 * seconds / count);
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
      {"one joint slides",
       [](auto& j, auto& random) {
         j[std::size_t(random.integer(0, 5))].kind = joint_kind::prismatic;
       }},
      {"two neighbours slide",
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
      {"two that are no neighbours slide",
       [](auto& j, auto& random) {
         const auto i = std::size_t(random.integer(0, 3));
         const auto other = std::size_t(random.integer(int(i) + 2, 5));
         j[i].kind = j[other].kind = joint_kind::prismatic;
       }},
      {"right angles, half of all lengths 0, two slide",
       [](auto& j, auto& random) {
         by_halves(j, random);
         const auto i = std::size_t(random.integer(0, 4));
         j[i].kind = j[std::size_t(random.integer(int(i) + 1, 5))].kind = joint_kind::prismatic;
       }},
      {"three joints slide", [](auto& j, auto& random) {
         std::array<std::size_t, 6> order{0, 1, 2, 3, 4, 5};
         for (std::size_t i = 5; i > 0; --i) {
           std::swap(order[i], order[std::size_t(random.integer(0, int(i)))]);
         }
         for (std::size_t i = 0; i < 3; ++i) {
           j[order[i]].kind = joint_kind::prismatic;
         }
       }}};
  std::printf(
      "| arms, seed %llu | goals | missed | not certain | solutions | most | complex | worst "
      "residual | µs |\n|---|---|---|---|---|---|---|---|---|\n",
      static_cast<unsigned long long>(seed));
  for (const kind& k : kinds) {
    random_source random(seed);
    report(k.name, count, random, [&](random_source& r) {
      auto joints = anywhere(r);
      k.specialise(joints, r);
      return serial_chain<6>(joints);
    });
  }
  random_source random(seed);
  report("UR5e", count, random, [](random_source&) { return robots::ur5e().table(); });
}
