// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Gradients of f_grad with respect to 1 to 32 variables in one pass, and to 100 and 1000.

#include "gradient_by_hand.hpp"
#include "support/contenders.hpp"
#include "support/contest.hpp"
#include "workloads.hpp"

#include <duet/derivative/gradient.hpp>
#include <duet/expression/graph/evaluate.hpp>
#include <duet/expression/graph/reverse.hpp>
#include <duet/expression/graph/trace.hpp>

#if DUET_BENCH_ADOLC
#include <adolc/adolc.h>
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace duet_bench {
namespace {

template <std::size_t N>
[[nodiscard]] inputs<double, N> point() {
  inputs<double, N> at;
  for (std::size_t i = 0; i < N; ++i) {
    at[i] = 0.3 + 0.9 * std::sin(1.0 + double(i));
  }
  return at;
}

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

/// Reverse mode of a formula that is recorded once.
template <std::size_t N>
void add_recorded(const std::string& workload, const std::array<double, N + 1>& expected) {
  using namespace duet::expression;
  const auto f = [](const auto& x) { return f_grad(x); };
  const auto evaluate = std::make_shared<evaluator<double>>(
      reverse_gradient(duet::expression::trace(f, int(N)), {"x"}));
  const auto recorded = [evaluate](const inputs<double, N>& at) {
    std::array<double, N + 1> result;
    const auto& numbers = (*evaluate)(std::vector<double>(at.begin(), at.end()));
    std::copy(numbers.begin(), numbers.end(), result.begin());
    return result;
  };
  expect_agreement(workload, "recorded", expected, recorded(point<N>()));
  register_benchmark(workload, "recorded", point<N>(), recorded);
}

#if DUET_BENCH_ADOLC
/// Reverse mode on a tape that is recorded once; only the gradient is timed.
template <std::size_t N>
void add_reverse_mode(const std::string& workload, const std::array<double, N + 1>& expected) {
  inputs<double, N> at = point<N>();
  constexpr short tape = short(N);
  trace_on(tape);
  std::vector<adouble> x(N);
  for (std::size_t i = 0; i < N; ++i) {
    x[i] <<= at[i];
  }
  double value;
  f_grad(x) >>= value;
  trace_off();
  const auto reverse = [](const inputs<double, N>& here) {
    std::array<double, N + 1> result;
    ::gradient(tape, int(N), here.data(), &result[1]);
    return result;
  };
  auto actual = reverse(at);
  actual[0] = value;
  expect_agreement(workload, "adolc_reverse", expected, actual);
  register_benchmark(workload, "adolc_reverse", at, reverse);
}
#endif

template <std::size_t N>
void add() {
  const inputs<double, N> at = point<N>();
  const std::string workload = "gradient_" + std::to_string(N);
  const auto expected = gradient_by<duet_contender>(at);
  register_benchmark(workload, "value", at, [](const auto& x) { return f_grad(x); });
  expect_agreement(workload, "hand", expected, gradient_by_hand(at));
  register_benchmark(workload, "hand", at, [](const auto& x) { return gradient_by_hand(x); });
  for_each_contender([&](auto contender) {
    using library = decltype(contender);
    expect_agreement(workload, library::name, expected, gradient_by<library>(at));
    register_benchmark(workload, library::name, at,
                       [](const auto& x) { return gradient_by<library>(x); });
  });
  add_recorded<N>(workload, expected);
#if DUET_BENCH_ADOLC
  add_reverse_mode<N>(workload, expected);
#endif
}

/// All variables at once in numbers on the heap: N partials each are too many for the stack.
template <class Library, std::size_t N>
std::array<double, N + 1> wide_gradient_by(const inputs<double, N>& at) {
  using number = typename Library::template number<int(N)>;
  std::vector<number> x;
  x.reserve(N);
  for (std::size_t i = 0; i < N; ++i) {
    x.push_back(Library::template variable<int(N)>(at[i], int(i)));
  }
  const number y = f_grad(x);
  std::array<double, N + 1> result;
  result[0] = Library::value(y);
  Library::template write_partials<int(N)>(y, &result[1]);
  return result;
}

template <std::size_t N>
void add_wide() {
  const inputs<double, N> at = point<N>();
  const std::string workload = "gradient_" + std::to_string(N);
  const auto in_passes = [](const inputs<double, N>& x) {
    std::array<double, N + 1> result;
    Eigen::Map<Eigen::Matrix<double, int(N), 1>> gradient(&result[1]);
    result[0] = duet::gradient_into([](const auto& v) { return f_grad(v); }, x, gradient);
    return result;
  };
  const auto expected = in_passes(at);
  register_benchmark(workload, "value", at, [](const auto& x) { return f_grad(x); });
  register_benchmark(workload, "duet", at, in_passes);
  for_each_contender([&](auto contender) {
    using library = decltype(contender);
    if constexpr (!std::is_same_v<library, duet_contender>) {
      expect_agreement(workload, library::name, expected, wide_gradient_by<library, N>(at));
      register_benchmark(workload, library::name, at,
                         [](const auto& x) { return wide_gradient_by<library, N>(x); });
    }
  });
  add_recorded<N>(workload, expected);
#if DUET_BENCH_ADOLC
  add_reverse_mode<N>(workload, expected);
#endif
}

const bool registered = [] {
  add<1>();
  add<4>();
  add<6>();
  add<7>();
  add<12>();
  add<16>();
  add<32>();
  add_wide<100>();
  add_wide<1000>();
  return true;
}();

} // namespace
} // namespace duet_bench
