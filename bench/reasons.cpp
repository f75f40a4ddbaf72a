// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Are the reasons true that plans give which do not reach their goals? A complete search by all
/// solutions of six joints, or by all curves of self-motion of seven, says of each whether there
/// was a way, how far one leads, and what ends it. Arguments: the number of problems of each of
/// six families (100), the seed (1), and anything to list what is not as it should be.
/// build/bench/bench/duet_reasons_bench

#include "robotics/complete_search.hpp"
#include "robotics/layered_search.hpp"
#include "robotics/singular_problems.hpp"

#include <duet/robotics/plan_screw_motion.hpp>

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace {

using namespace singular_problems;

struct score {
  int failed = 0;       ///< plans that do not reach their goals
  int given_up = 0;     ///< although the path has a continuation
  int before_end = 0;   ///< although the path continues by more than 1e-4 of the path
  int other_reason = 0; ///< than the one that ends the path
  int both = 0;         ///< singular, limits being in the way within 1e-4 of the path before that
  int unknown = 0;      ///< the search could not tell
};

template <int N>
score check(const arm<N>& a, family kind, int count, unsigned seed, bool is_listed) {
  random_source random(seed);
  score result;
  for (int k = 0; k < count; ++k) {
    const auto p = make(a, kind, random);
    const screw path{a.chain.pose(p.start), a.chain.pose(p.end)};
    const auto plan = plan_screw_motion(a.chain, p.start, path.last);
    if (plan.reason == stop_reason::reached) {
      continue;
    }
    ++result.failed;
    const auto verdict = duet_test::complete_path_verdict(a.chain, path, plan);
    const bool is_open = verdict.why == stop_reason::reached;
    const bool is_short = !is_open && verdict.end > plan.tau.back() + 1e-4;
    const bool is_unknown = verdict.why == stop_reason::no_progress;
    const bool is_both = verdict.is_both && plan.reason == stop_reason::singular;
    const bool is_false = !is_open && !is_short && !is_unknown && plan.reason != verdict.why &&
                          !is_both && plan.reason != stop_reason::out_of_reach;
    result.given_up += is_open;
    result.before_end += is_short;
    result.unknown += is_unknown;
    result.other_reason += is_false;
    result.both += !is_open && !is_short && is_both;
    if (is_listed &&
        (is_open || is_short || is_unknown || is_false || plan.tau.back() > verdict.end + 1e-4)) {
      std::printf("  %d: %s at %.9g, sigma %.2g; there is %s at %.9g\n", k, to_text(plan.reason),
                  plan.tau.back(), plan.smallest_singular_value, to_text(verdict.why), verdict.end);
    }
  }
  return result;
}

template <int N>
void table_of(const std::vector<arm<N>>& arms, int count, unsigned seed, bool is_listed) {
  for (const arm<N>& a : arms) {
    for (std::size_t k = 0; k < families.size(); ++k) {
      const score s = check(a, family(k), count, seed, is_listed);
      std::printf("%-14s %-22s %6d %4d %6d %6d %4d %7d\n", a.name, families[k], s.failed,
                  s.given_up, s.before_end, s.other_reason, s.both, s.unknown);
      std::fflush(stdout);
    }
  }
}

} // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 100;
  const unsigned seed = argc > 2 ? unsigned(std::atoi(argv[2])) : 1;
  std::printf("%-14s %-22s %6s %4s %6s %6s %4s %7s\n", "arm", "from", "failed", "way", "before",
              "false", "both", "unknown");
  table_of(six_joints(), count, seed, argc > 3);
  table_of(redundant_arm(), count, seed, argc > 3);
}
