// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Derivatives of f_scalar: the first, and all up to the second, third, fifth and tenth.

#include "support/contenders.hpp"
#include "support/contest.hpp"
#include "workloads.hpp"

#if DUET_BENCH_BOOST
#include <boost/math/differentiation/autodiff.hpp>
#endif

#include <array>
#include <string_view>

namespace duet_bench {
namespace {

constexpr double point = 0.7;

template <std::size_t Count, class F>
void add(std::string_view workload, std::string_view contender,
         const std::array<double, Count>& expected, F derivatives) {
  expect_agreement(workload, contender, expected, derivatives(point));
  register_benchmark(workload, contender, point, derivatives);
}

std::array<double, 2> hand(double x) {
  const auto [value, slope] = f_scalar_by_hand(x);
  return {value, slope};
}

template <int K>
std::array<double, K + 1> by_taylor(double x) {
  const auto y = f_scalar(duet::taylor<double, K>::variable(x));
  std::array<double, K + 1> result;
  for (int k = 0; k <= K; ++k) {
    result[std::size_t(k)] = y.derivative(k);
  }
  return result;
}

struct outer;
struct middle;

std::array<double, 3> by_nested_dual_2(double x) {
  using inner_number = duet::dual<double>;
  using number = duet::dual<inner_number, 1, duet::derivative_tag<outer>>;
  const number y = f_scalar(number::variable(inner_number::variable(x)));
  return {y.value().value(), y.value().epsilon(), y.epsilon().epsilon()};
}

std::array<double, 4> by_nested_dual_3(double x) {
  using inner_number = duet::dual<double>;
  using middle_number = duet::dual<inner_number, 1, duet::derivative_tag<middle>>;
  using number = duet::dual<middle_number, 1, duet::derivative_tag<outer>>;
  const number y = f_scalar(number::variable(middle_number::variable(inner_number::variable(x))));
  return {y.value().value().value(), y.value().value().epsilon(), y.value().epsilon().epsilon(),
          y.epsilon().epsilon().epsilon()};
}

#if DUET_BENCH_BOOST
template <int K>
std::array<double, K + 1> by_boost(double x) {
  const auto y = f_scalar(boost::math::differentiation::make_fvar<double, K>(x));
  std::array<double, K + 1> result;
  for (int k = 0; k <= K; ++k) {
    result[std::size_t(k)] = y.derivative(std::size_t(k));
  }
  return result;
}
#endif

const bool registered = [] {
  constexpr std::string_view first = "scalar_1";
  const auto one = hand(point);
  add(first, "hand", one, hand);
  for_each_contender([&](auto contender) {
    using library = decltype(contender);
    add(first, library::name, one, [](double x) {
      const typename library::template number<1> y = f_scalar(library::template variable<1>(x, 0));
      std::array<double, 2> result;
      result[0] = library::value(y);
      library::template write_partials<1>(y, &result[1]);
      return result;
    });
  });
  const auto two = by_nested_dual_2(point);
  const auto three = by_nested_dual_3(point);
  add("scalar_2", "duet", two, by_taylor<2>);
  add("scalar_2", "nested", two, by_nested_dual_2);
  add("scalar_3", "duet", three, by_taylor<3>);
  add("scalar_3", "nested", three, by_nested_dual_3);
  add("scalar_5", "duet", by_taylor<5>(point), by_taylor<5>);
  add("scalar_10", "duet", by_taylor<10>(point), by_taylor<10>);
#if DUET_BENCH_BOOST
  add(first, "boost", one, by_boost<1>);
  add("scalar_2", "boost", two, by_boost<2>);
  add("scalar_3", "boost", three, by_boost<3>);
  add("scalar_5", "boost", by_taylor<5>(point), by_boost<5>);
  add("scalar_10", "boost", by_taylor<10>(point), by_boost<10>);
#endif
  return true;
}();

} // namespace
} // namespace duet_bench
