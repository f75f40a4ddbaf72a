// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Splines through a thousand to a million orientations, 0.003 rad apart: the time per row,
/// which should be constant. A separate program: build/bench/bench/duet_interpolation_bench

#include <duet/quaternion/rotation.hpp>
#include <duet/spline/interpolate.hpp>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace {

constexpr double step = 0.01; // step of the parameter; the rotation angle is 0.3 of it

/// A rotation by 0.3 rad per unit about a moving axis.
duet::quaternion<double> orientation(double u) {
  return duet::from_rotation_vector(
      duet::vector3<double>(0.15 * std::sin(u), 0.15 * std::cos(u), 0.26 * u));
}

template <class Spline>
void interpolate(benchmark::State& state) {
  const auto rows = std::size_t(state.range(0));
  std::vector<double> u(rows);
  std::vector<duet::quaternion<double>> rotations(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    u[i] = double(i) * step;
    rotations[i] = orientation(u[i]);
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(duet::interpolate<Spline>(u, rotations, duet::not_a_knot()));
  }
  state.counters["per_row"] = benchmark::Counter(
      double(rows), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

double minimum(const std::vector<double>& times) {
  return *std::min_element(times.begin(), times.end());
}

void rows(benchmark::internal::Benchmark* benchmark) {
  benchmark->RangeMultiplier(10)->Range(1000, 1000000)->Unit(benchmark::kMillisecond);
  benchmark->Repetitions(9)->ReportAggregatesOnly()->ComputeStatistics("min", minimum);
}

BENCHMARK_TEMPLATE(interpolate, duet::cumulative_bspline<double>)->Apply(rows);
BENCHMARK_TEMPLATE(interpolate, duet::rotation_vector_spline<double>)->Apply(rows);
BENCHMARK_TEMPLATE(interpolate, duet::rotation_vector_spline<double, 6>)->Apply(rows);

} // namespace

BENCHMARK_MAIN();
