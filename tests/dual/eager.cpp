// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/core/select.hpp>
#include <duet/dual/math.hpp>

// Duals are plain values: code that dangles with lazy libraries works.

namespace test_dual_eager {
namespace {

using duet::dual, duet::taylor;

auto square(dual<double> x) { return x * x; }

template <class T>
auto polynomial(const T& x) {
  auto y = x + 1;
  auto z = y * y;
  auto w = z - x;
  return w * 2;
}

TEST_CASE("dual: auto holds values, not dangling references") {
  auto y = square(dual<double>::variable(3));
  static_assert(std::is_same_v<decltype(y), dual<double>>);
  CHECK(y.value() == 9);
  CHECK(y.epsilon() == 6);
  const auto p = polynomial(dual<double>::variable(2));
  CHECK(p.value() == 14);
  CHECK(p.epsilon() == 10);
  CHECK(polynomial(taylor<double, 2>::variable(2)).coefficient(2) == 2);
  std::vector<std::function<dual<double>()>> later;
  for (int i = 0; i < 3; ++i) {
    auto kept = dual<double>::variable(i) * 2 + 1;
    later.emplace_back([kept] { return kept * kept; });
  }
  CHECK(later[2]().epsilon() == 20);
}

TEST_CASE("dual: an operand may be the result") {
  auto x = dual<double, 3>::variable(2, 1);
  const auto& same_x = x;
  x *= same_x;
  CHECK(x.value() == 4);
  CHECK(x.partial(1) == 4);
  x /= same_x;
  CHECK(x.value() == 1);
  CHECK(x.partial(1) == 0);
  x -= same_x;
  CHECK(x.partial(1) == 0);
  auto t = taylor<double, 3>::variable(2);
  const auto& same_t = t;
  t = same_t * t + t;
  CHECK(t.coefficient(1) == 5);
  t /= same_t;
  CHECK(t.coefficient(1) == 0);
}

} // namespace
} // namespace test_dual_eager
