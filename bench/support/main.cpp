// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Runs all benchmarks, repeated and shuffled, and prints the table of ratios.

#include "contest.hpp"
#include "ratio_table.hpp"

#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdlib>
#include <new>
#include <string>
#include <vector>

namespace {
std::size_t allocation_count = 0;
} // namespace

void* operator new(std::size_t size) {
  ++allocation_count;
  if (void* block = std::malloc(size)) {
    return block;
  }
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocation_count;
  const std::size_t unit = std::size_t(alignment);
  if (void* block = std::aligned_alloc(unit, (size + unit - 1) / unit * unit)) {
    return block;
  }
  throw std::bad_alloc();
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
void operator delete(void* block, std::align_val_t) noexcept { std::free(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { std::free(block); }

namespace duet_bench {
std::size_t allocations() { return allocation_count; }

std::vector<std::string>& benchmark_names() {
  static std::vector<std::string> names;
  return names;
}
} // namespace duet_bench

int main(int argc, char** argv) {
  // Shuffled repetitions, so that a disturbance of the machine affects all contenders. Arguments of
  // the command line come later and take precedence.
  char repetitions[] = "--benchmark_repetitions=30";
  char shuffled[] = "--benchmark_enable_random_interleaving=true";
  char time[] = "--benchmark_min_time=0.005";
  std::vector<char*> arguments = {argv[0], repetitions, shuffled, time};
  arguments.insert(arguments.end(), argv + 1, argv + argc);
  int count = int(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) {
    return 1;
  }
  duet_bench::ratio_table table(duet_bench::benchmark_names());
  benchmark::RunSpecifiedBenchmarks(&table);
  table.print();
}
