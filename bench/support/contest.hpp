// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <iostream>
#include <string>
#include <string_view>
#include <vector>

/// \file
/// Registering one workload of one contender, named "workload/contender". The table of ratios
/// compares what shares a workload: "duet", the hand-written code "hand" and, all else, peers.

namespace duet_bench {

/// Calls of operator new so far, in the whole program.
[[nodiscard]] std::size_t allocations();

/// Names of the registered contests, in that order.
[[nodiscard]] std::vector<std::string>& contests();

/// A function call, so that all contenders hand their results over in the same way.
template <class F, class Input>
[[gnu::noinline]] auto called(F& evaluate, Input& input) {
  return evaluate(input);
}

/// Times `evaluate(input)`. The input is hidden from the optimiser in every turn, and the result
/// counts as used.
template <class Input, class F>
void comparison_table(std::string_view workload, std::string_view contender, Input input,
                      F evaluate) {
  const std::string name = std::string(workload) + '/' + std::string(contender);
  contests().push_back(name);
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) mutable {
    benchmark::DoNotOptimize(called(evaluate, input));
    const std::size_t before = allocations();
    for (auto _ : state) {
      benchmark::DoNotOptimize(input);
      auto result = called(evaluate, input);
      benchmark::DoNotOptimize(result);
    }
    state.counters["allocations"] = double(allocations() - before);
  });
}

/// Contenders that do not agree are not worth timing.
template <class Numbers>
void expect_agreement(std::string_view workload, std::string_view contender,
                      const Numbers& expected, const Numbers& actual) {
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (!(std::abs(expected[i] - actual[i]) <= 1e-12 * (1.0 + std::abs(expected[i])))) {
      std::cerr << workload << '/' << contender << ": number " << i << " is " << actual[i]
                << ", expected " << expected[i] << '\n';
      std::exit(1);
    }
  }
}

} // namespace duet_bench
