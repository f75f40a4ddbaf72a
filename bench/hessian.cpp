// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Hessians of f_grad with respect to 3, 6 and 12 variables, compared with nested dual numbers. (A
/// nested Jet of Ceres does not accept a double.)

#include "support/contest.hpp"
#include "workloads.hpp"

#include <duet/dual/math.hpp>
#include <duet/dual/second_dual.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>

namespace duet_bench {
namespace {

template <std::size_t N>
using hessian = std::array<double, N * N>;

template <std::size_t N>
hessian<N> by_second_dual(const inputs<double, N>& at) {
  using number = duet::second_order_dual<double, int(N)>;
  inputs<number, N> x;
  for (std::size_t i = 0; i < N; ++i) {
    x[i] = number::variable(at[i], int(i));
  }
  const number y = f_grad(x);
  hessian<N> result;
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < N; ++j) {
      result[N * i + j] = y.second_partial(int(i), int(j));
    }
  }
  return result;
}

struct outer;

template <std::size_t N>
hessian<N> by_nested_duals(const inputs<double, N>& at) {
  using inner = duet::dual<double, int(N)>;
  using number = duet::dual<inner, int(N), duet::derivative_tag<outer>>;
  inputs<number, N> x;
  for (std::size_t i = 0; i < N; ++i) {
    x[i] = number::variable(inner::variable(at[i], int(i)), int(i));
  }
  const number y = f_grad(x);
  hessian<N> result;
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < N; ++j) {
      result[N * i + j] = y.partial(int(i)).partial(int(j));
    }
  }
  return result;
}

template <std::size_t N>
void add() {
  inputs<double, N> at;
  for (std::size_t i = 0; i < N; ++i) {
    at[i] = 0.3 + 0.9 * std::sin(1.0 + double(i));
  }
  const std::string workload = "hessian_" + std::to_string(N);
  const auto expected = by_second_dual(at);
  register_benchmark(workload, "duet", at, by_second_dual<N>);
  expect_agreement(workload, "nested", expected, by_nested_duals(at));
  register_benchmark(workload, "nested", at, by_nested_duals<N>);
}

const bool registered = [] {
  add<3>();
  add<6>();
  add<12>();
  return true;
}();

} // namespace
} // namespace duet_bench
