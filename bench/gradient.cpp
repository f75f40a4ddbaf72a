// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Gradients of f_grad by 4, 7, 12 and 32 variables.

#include "support/contenders.hpp"
#include "support/contest.hpp"
#include "workloads.hpp"

#include <array>
#include <cstddef>
#include <string>

namespace duet_bench {
namespace {

/// The value, then the gradient.
template <class Library, std::size_t N>
std::array<double, N + 1> gradient_by(const inputs<double, N>& at) {
  using number = typename Library::template number<int(N)>;
  const number y = f_grad(seeded<Library, number>(at));
  std::array<double, N + 1> result;
  result[0] = Library::value(y);
  Library::template write_partials<int(N)>(y, &result[1]);
  return result;
}

template <std::size_t N>
void add() {
  inputs<double, N> at;
  for (std::size_t i = 0; i < N; ++i) {
    at[i] = 0.3 + 0.9 * std::sin(1.0 + double(i));
  }
  const std::string workload = "gradient_" + std::to_string(N);
  const auto expected = gradient_by<duet_contender>(at);
  contest(workload, "value", at, [](const auto& x) { return f_grad(x); });
  for_each_contender([&](auto contender) {
    using library = decltype(contender);
    expect_agreement(workload, library::name, expected, gradient_by<library>(at));
    contest(workload, library::name, at, [](const auto& x) { return gradient_by<library>(x); });
  });
}

const bool registered = [] {
  add<4>();
  add<7>();
  add<12>();
  add<32>();
  return true;
}();

} // namespace
} // namespace duet_bench
