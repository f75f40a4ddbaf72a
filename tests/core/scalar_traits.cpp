// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/multiprecision.hpp"
#include "support/test.hpp"
#include "support/ulp.hpp"

#include <duet/core/constants.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/version.hpp>

#include <concepts>

namespace test_core_scalar_traits {

using duet_test::real_100, duet_test::real_50, duet_test::real_50_et, duet_test::worst_error;

static_assert(duet::Real<float> && duet::Real<double> && duet::Real<long double>);
static_assert(duet::Real<real_50> && duet::Real<real_50_et>);
static_assert(!duet::Real<int> && !duet::Real<bool> && !duet::Real<std::string>);
static_assert(!duet::Real<duet_test::mp::cpp_int>);
static_assert(duet::Scalar<double> && !duet::Scalar<int> && !duet::Infinitesimal<double>);
static_assert(duet::Arithmetic<int> && duet::Arithmetic<bool> && !duet::Arithmetic<real_50>);
static_assert(std::is_same_v<duet::real_type_t<double>, double>);
static_assert(duet::scalar_traits<double>::order == 0);
static_assert(duet::innermost(1.5) == 1.5);

static_assert(DUET_VERSION ==
              DUET_VERSION_MAJOR * 10000 + DUET_VERSION_MINOR * 100 + DUET_VERSION_PATCH);

TEST_CASE("innermost: a plain number is its own innermost real") {
  double x = 1;
  CHECK(&duet::innermost(x) == &x);
  CHECK(DUET_VERSION_STRING == std::to_string(DUET_VERSION_MAJOR) + "." +
                                   std::to_string(DUET_VERSION_MINOR) + "." +
                                   std::to_string(DUET_VERSION_PATCH));
}

// Digits from tables, not from the formulas of the library.
TEST_CASE_TEMPLATE("constant: accurate to an ulp in every precision", T, float, double, long double,
                   real_50, real_50_et) {
  const real_100 pi("3.14159265358979323846264338327950288419716939937510582097494459230781640629");
  const real_100 ln2(
      "0.69314718055994530941723212145817656807550013436025525412068000949339362197");
  const real_100 ln10(
      "2.30258509299404568401799145468436420760110148862877297603332790096757260967");
  const real_100 erf_slope(
      "1.12837916709551257389615890312154517168810125865799771368817144342128493688");
  worst_error worst("constants");
  namespace constant = duet::constant;
  worst.add(duet_test::ulps(constant::pi<T>(), pi, pi), "pi");
  worst.add(duet_test::ulps(constant::ln2<T>(), ln2, ln2), "ln 2");
  worst.add(duet_test::ulps(constant::ln10<T>(), ln10, ln10), "ln 10");
  worst.add(duet_test::ulps(constant::two_over_sqrt_pi<T>(), erf_slope, erf_slope), "2/sqrt pi");
  CHECK_MESSAGE(worst <= (std::floating_point<T> ? 1 : 4), worst); // Boost's log is within 4
}

} // namespace test_core_scalar_traits
