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
/// Registration of benchmarks, named "workload/contender". The table of ratios compares the
/// contenders of a workload: "duet", the hand-written code "hand", and other libraries.

namespace duet_bench {

/// Calls of operator new so far, in the whole program.
[[nodiscard]] std::size_t allocations();

/// Names of the registered benchmarks, in order of registration.
[[nodiscard]] std::vector<std::string>& benchmark_names();

/// Calls a function without inlining, so that all contenders return their results in the same way.
template <class F, class Input>
[[gnu::noinline]] auto called(F& evaluate, Input& input) {
  return evaluate(input);
}

/// Registers the timing of `evaluate(input)`. The input is hidden from the optimiser in every
/// iteration, and the result counts as used.
template <class Input, class F>
void register_benchmark(std::string_view workload, std::string_view contender, Input input,
                        F evaluate) {
  const std::string name = std::string(workload) + '/' + std::string(contender);
  benchmark_names().push_back(name);
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

/// Ends the program with a message if two contenders disagree.
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
