// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/core/select.hpp>
#include <duet/dual/math.hpp>

namespace test_core_select {

using duet::dual, duet::select;

static_assert(select(
                  true, [] { return 1; }, [] { return 2; }) == 1);
static_assert(select(
                  false, [] { return 1; }, [] { return 2; }) == 2);
static_assert(std::is_same_v<decltype(select(
                                 true, [] { return 1; }, [] { return 2.5; })),
                             double>);
static_assert(std::is_same_v<decltype(select(
                                 true, [] { return dual<double>(1); }, [] { return 2.5F; })),
                             dual<double>>);

TEST_CASE("select: only the chosen callable is evaluated") {
  int calls = 0;
  const auto count = [&] { return ++calls; };
  const auto never = [&]() -> int {
    FAIL("evaluated");
    return 0;
  };
  CHECK(select(true, count, never) == 1);
  CHECK(select(false, never, count) == 2);
}

TEST_CASE("select: both results are converted to their common type and keep derivatives") {
  const auto f = [](auto x) {
    return select(
        x < 1, [&] { return x * x; }, [] { return 7; });
  };
  CHECK(f(dual<double>::variable(0.5)).epsilon() == 1);
  CHECK(f(dual<double>::variable(2)).value() == 7);
  CHECK(f(dual<double>::variable(2)).epsilon() == 0);
  CHECK(f(0.5) == 0.25);
}

// A mask of lanes is not a bool: it has a separate overload instead of a conversion.
struct mask {
  operator bool() const { return true; }
};
template <class Condition>
concept Selects = requires(Condition c) {
  select(
      c, [] { return 1; }, [] { return 2; });
};
static_assert(Selects<bool> && !Selects<mask> && !Selects<int> && !Selects<dual<double>>);

} // namespace test_core_select
