// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/multiprecision.hpp"
#include "support/test.hpp"

#include <duet/dual/math.hpp>

#include <iomanip>
#include <locale>

namespace test_dual_stream {
namespace {

using duet::dual, duet::taylor;

struct outer_tag;

template <class D>
std::string printed(const D& x) {
  std::ostringstream out;
  out << x;
  return out.str();
}

struct decimal_comma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
};

TEST_CASE("output stream: numbers are printed with their derivatives") {
  CHECK(printed(dual<double>(1.5, -2)) == "1.5[-2]");
  CHECK(printed(dual<double, 3>::variable(1.5, 1)) == "1.5[0, 1, 0]");
  CHECK(printed(taylor<double, 2>::variable(3)) == "(3 + 1 e + 0 e^2)");
  const dual<dual<float>, 1, outer_tag> nested(dual<float>(1, 2), dual<float>(3, 4));
  CHECK(printed(nested) == "1[2][3[4]]");
  CHECK(printed(dual<duet_test::real_50>(0.5, 3)) == "0.5[3]");
}

TEST_CASE("output stream: format, width and fill apply to the complete number") {
  std::ostringstream out;
  const dual<double> x(0.1, 2);
  out << std::setprecision(3) << std::fixed << std::setw(16) << std::setfill('.') << x << "|" << x;
  CHECK(out.str() == "....0.100[2.000]|0.100[2.000]");
  out.str("");
  out << std::left << std::setw(16) << x << "|" << std::showpos << x;
  CHECK(out.str() == "0.100[2.000]....|+0.100[+2.000]");
  std::ostringstream comma;
  comma.imbue(std::locale(std::locale::classic(), new decimal_comma));
  comma << dual<double>(0.5, 2);
  CHECK(comma.str() == "0,5[2]");
}

TEST_CASE("output stream: wide characters") {
  std::wostringstream out;
  out << std::setw(9) << dual<double>(1.5, 2) << taylor<double, 1>(2);
  CHECK(out.str() == L"   1.5[2](2 + 0 e)");
}

TEST_CASE("input stream: a number that is read is a constant") {
  std::istringstream in("2.5 -1e-3 x");
  dual<double, 3> x = dual<double, 3>::variable(7, 2);
  taylor<double, 2> y = taylor<double, 2>::variable(7);
  in >> x >> y;
  CHECK(bool(in));
  CHECK(x.value() == 2.5);
  CHECK(x.partial(2) == 0);
  CHECK(y.value() == -1e-3);
  CHECK(y.coefficient(1) == 0);
  in >> x;
  CHECK(in.fail());
  CHECK(x.value() == 2.5); // untouched
  std::istringstream nested_in("4");
  dual<dual<double>, 1, outer_tag> nested;
  nested_in >> nested;
  CHECK(nested == 4);
}

} // namespace
} // namespace test_dual_stream
