// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/dual/math.hpp>

#include <complex>

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

TEST_CASE("dual: algorithms of the standard library keep derivatives") {
  using D = dual<double>;
  D x(1, 10);
  D y(2, 20);
  std::swap(x, y);
  CHECK(x.value() == 2);
  CHECK(x.epsilon() == 20);
  CHECK(y.epsilon() == 10);
  swap(x, y);
  CHECK(x.epsilon() == 10);
  CHECK(std::max(x, y).epsilon() == 20);
  CHECK(std::min(x, y).epsilon() == 10);
  CHECK(std::clamp(D(3, 30), x, y).epsilon() == 20);
  CHECK(std::clamp(D(1.5, 30), x, y).epsilon() == 30);

  std::vector<D> row{D(3, 1), D(1, 2), D(2, 4)};
  const D sum = std::accumulate(row.begin(), row.end(), D(0));
  CHECK(sum.value() == 6);
  CHECK(sum.epsilon() == 7);
  const D square = std::inner_product(row.begin(), row.end(), row.begin(), D(0));
  CHECK(square.value() == 14);
  CHECK(square.epsilon() == 2 * (3 * 1 + 1 * 2 + 2 * 4));
  std::sort(row.begin(), row.end());
  CHECK(row[0].epsilon() == 2);
  CHECK(row[2].epsilon() == 1);
  CHECK(std::midpoint(1.0, 2.0) == 1.5); // only arithmetic types; listed so that nobody wonders

  std::array<dual<double, 7>, 2> packed{dual<double, 7>::variable(1, 3), 2};
  std::swap(packed[0], packed[1]);
  CHECK(packed[1].partial(3) == 1);
  CHECK(packed[0].partial(3) == 0);
}

TEST_CASE("std::complex of dual: multiplication and division") {
  using D = dual<double>;
  using C = std::complex<D>;
  const C z(D(1, 1), D(2, 0)); // (1 + 2i) + ε
  const C square = z * z;      // −3 + 4i, derivative 2z
  CHECK(square.real().value() == -3);
  CHECK(square.imag().value() == 4);
  CHECK(square.real().epsilon() == 2);
  CHECK(square.imag().epsilon() == 4);
  const C one = z / z;
  CHECK(one.real().value() == 1);
  CHECK(one.real().epsilon() == 0);
  CHECK(one.imag().epsilon() == 0);
  CHECK(norm(z).epsilon() == 2);
}

} // namespace
} // namespace test_dual_comparison
