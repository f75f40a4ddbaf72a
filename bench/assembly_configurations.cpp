// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/core/random_source.hpp>
#include <duet/kinematics/kinematic_tree.hpp>
#include <duet/robotics/closed_tree.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <vector>

// Assembly configurations of planar four-bars, one, two or four of them on one crank, by
// `find_assembly_configurations`, compared with Freudenstein's equation in long double: random
// lengths, and structured ones (parallelograms, kites, rhombi, integers, cranks at multiples
// of 15°).

namespace {

constexpr double pi = std::numbers::pi;

struct four_bar {
  double crank, coupler, rocker, ground;
};

duet::placement<double> at_point(double x, double y = 0) {
  duet::placement<double> p;
  p.translation = {x, y, 0};
  return p;
}

duet::tree_joint hinge(const std::string& name, const std::string& parent, double x) {
  return {name, parent, name, {duet::joint_kind::continuous, at_point(x)}};
}

/// Four-bars with the same crank.
duet::closed_chain_mechanism mechanism_of(const std::vector<four_bar>& bars) {
  duet::robot_description robot;
  robot.links = {{"ground"}, {"crank"}};
  robot.joints = {hinge("crank", "ground", 0)};
  std::vector<duet::loop_constraint> loops;
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const std::string coupler = "coupler" + std::to_string(i),
                      rocker = "rocker" + std::to_string(i);
    robot.links.push_back({coupler});
    robot.links.push_back({rocker});
    robot.joints.push_back(hinge(coupler, "crank", bars[i].crank));
    robot.joints.push_back(hinge(rocker, "ground", bars[i].ground));
    loops.push_back({duet::constraint_kind::revolute,
                     {coupler, at_point(bars[i].coupler)},
                     {rocker, at_point(bars[i].rocker)}});
  }
  return duet::closed_chain_mechanism(duet::kinematic_tree(robot), {loops});
}

/// Number of assembly configurations of a four-bar, and whether it is regular: neither flat nor
/// with a continuum of solutions.
struct expected {
  int count;
  bool is_regular;
};
expected expected_of(const four_bar& bar, double theta) {
  const long double a = bar.crank, b = bar.coupler, c = bar.rocker, d = bar.ground;
  const long double k = a * std::cos(static_cast<long double>(theta)) - d,
                    s = a * std::sin(static_cast<long double>(theta));
  const long double diagonal = std::hypot(k, s);
  if (diagonal < 1e-9L) {
    return {0, false};
  }
  const long double cosine = (c * c + diagonal * diagonal - b * b) / (2 * c * diagonal);
  return {std::abs(cosine) < 1 ? 2 : 0, std::abs(std::abs(cosine) - 1) > 1e-9L};
}

} // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 500;
  duet::random_source random(1);
  const auto pick = [&](const auto& values) {
    return values[std::size_t(random.unit() * double(values.size()))];
  };
  const std::array<double, 5> integers{1, 1, 2, 3, 4};
  for (const bool is_structured : {false, true}) {
    for (const int loops : {1, 2, 4}) {
      int regular = 0, exist = 0, missing = 0, unflagged = 0, spurious = 0, singular = 0;
      for (int n = 0; n < count; ++n) {
        std::vector<four_bar> bars;
        const double shared = is_structured ? pick(integers) : .2 + random.unit();
        for (int i = 0; i < loops; ++i) {
          four_bar bar{shared, .2 + random.unit(), .2 + random.unit(), .2 + random.unit()};
          if (is_structured) {
            const double other = pick(integers);
            const int kind = int(4 * random.unit());
            bar = kind == 0   ? four_bar{shared, other, shared, other} // a parallelogram
                  : kind == 1 ? four_bar{shared, shared, other, other} // a kite
                  : kind == 2 ? four_bar{shared, shared, shared, shared}
                              : four_bar{shared, other, pick(integers), pick(integers)};
          }
          bars.push_back(bar);
        }
        const double theta =
            is_structured ? int(24 * random.unit()) * pi / 12 - pi : 2 * pi * random.unit() - pi;
        int expects = 1;
        bool is_regular = true;
        for (const four_bar& bar : bars) {
          const expected each = expected_of(bar, theta);
          expects *= each.count;
          is_regular = is_regular && each.is_regular;
        }
        if (!is_regular) {
          ++singular;
          continue;
        }
        const auto result = find_assembly_configurations(mechanism_of(bars), {0},
                                                         Eigen::VectorXd::Constant(1, theta));
        ++regular;
        exist += expects;
        const int missed = std::max(0, expects - int(result.positions.size()));
        missing += missed;
        unflagged += result.missing_probability() == 0 ? missed : 0;
        spurious += std::max(0, int(result.positions.size()) - expects);
      }
      std::printf(
          "%s, %d loop(s): %d regular, %d positions, %d missing (%d of them with a chance of "
          "more of 0), %d too many; %d singular ones left out\n",
          is_structured ? "structured" : "random", loops, regular, exist, missing, unflagged,
          spurious, singular);
    }
  }
}
