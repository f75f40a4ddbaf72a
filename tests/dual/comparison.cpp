// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/dual/math.hpp>

// Numbers are compared, classified and limited by their values.

namespace test_dual_comparison {
namespace {

using duet::dual, duet::taylor;

struct outer_tag;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

static_assert(dual<double>(1, 2) == dual<double>(1, 3));
static_assert(dual<double>(1, 2) == 1 && 1.0F == dual<double>(1, 2));
static_assert(dual<double>(1, 2) != 2 && 0 != dual<double>(1, 2));
static_assert(dual<double>(1, 9) < dual<double>(2, 1) && 1 < dual<double>(2, 1));
static_assert(dual<double>(2, 0) > 1.5 && dual<double>(2, 0) >= 2 && dual<double>(2, 0) <= 2);
static_assert(!(dual<double>(not_a_number, 0) == not_a_number) &&
              dual<double>(not_a_number, 0) != not_a_number);
static_assert(!(dual<double>(not_a_number, 0) < 1) && !(dual<double>(not_a_number, 0) >= 1));
static_assert(dual<dual<double>, 1, outer_tag>(3) == dual<double>(3, 7));
static_assert(taylor<double, 3>::variable(1) < 1.25 && 1 <= taylor<double, 3>::variable(1));
static_assert(dual<float>(0.1F, 0) != 0.1); // as 0.1F != 0.1

TEST_CASE_TEMPLATE("dual: classification depends on the value alone", D, dual<double>,
                   dual<double, 5>, taylor<double, 3>, dual<dual<double>, 1, outer_tag>) {
  for (const double x :
       {0.0, -0.0, 1.5, -1.5, 5e-324, 1e-310, infinity, -infinity, not_a_number, -not_a_number}) {
    CAPTURE(x);
    const D y(x);
    CHECK(isnan(y) == std::isnan(x));
    CHECK(isinf(y) == std::isinf(x));
    CHECK(isfinite(y) == std::isfinite(x));
    CHECK(isnormal(y) == std::isnormal(x));
    CHECK(signbit(y) == std::signbit(x));
    CHECK(fpclassify(y) == std::fpclassify(x));
    for (const double z : {0.0, 2.0, infinity, not_a_number}) {
      CHECK(isgreater(y, D(z)) == std::isgreater(x, z));
      CHECK(isgreaterequal(y, z) == std::isgreaterequal(x, z));
      CHECK(isless(x, D(z)) == std::isless(x, z));
      CHECK(islessequal(y, D(z)) == std::islessequal(x, z));
      CHECK(islessgreater(y, D(z)) == std::islessgreater(x, z));
      CHECK(isunordered(y, z) == std::isunordered(x, z));
    }
  }
}

TEST_CASE_TEMPLATE("dual: numeric limits are those of the underlying real number", D, dual<double>,
                   dual<double, 7>, taylor<double, 2>, dual<taylor<double, 2>, 1, outer_tag>,
                   const dual<double>) {
  using limits = std::numeric_limits<D>;
  using real = std::numeric_limits<double>;
  static_assert(limits::is_specialized && limits::has_infinity && limits::has_quiet_NaN);
  static_assert(!limits::is_integer && limits::is_signed && !limits::is_exact);
  static_assert(limits::digits == 53 && limits::digits10 == 15 && limits::max_digits10 == 17);
  static_assert(limits::radix == 2 && limits::max_exponent == 1024 && limits::is_iec559);
  static_assert(limits::epsilon() == real::epsilon() && limits::min() == real::min());
  static_assert(limits::max() == real::max() && limits::lowest() == real::lowest());
  static_assert(limits::infinity() == real::infinity() && limits::round_error() == 0.5);
  static_assert(limits::denorm_min() == real::denorm_min());
  CHECK(isnan(limits::quiet_NaN()));
  CHECK(limits::max().all_of([](const auto& part) { return part == 0 || part == real::max(); }));
}

TEST_CASE("dual: numeric limits follow the precision") {
  CHECK(std::numeric_limits<dual<float>>::digits == 24);
  CHECK(std::numeric_limits<dual<float>>::epsilon().value() == 0x1p-23F);
  CHECK(std::numeric_limits<dual<long double, 2>>::digits ==
        std::numeric_limits<long double>::digits);
}

} // namespace
} // namespace test_dual_comparison
