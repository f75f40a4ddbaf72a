// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/core/text/number_text.hpp>

#include <bit>
#include <cstdlib>
#include <locale>

namespace test_core_number_text {
namespace {

using duet::parse_number, duet::to_text;

struct german : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

/// The global locale for as long as a test runs.
class global_locale {
public:
  explicit global_locale(const std::locale& locale) : before_(std::locale::global(locale)) {}
  global_locale(const global_locale&) = delete;
  global_locale& operator=(const global_locale&) = delete;
  ~global_locale() { std::locale::global(before_); }

private:
  std::locale before_;
};

TEST_CASE("to_text of a number: gives the shortest text that reads back") {
  CHECK(to_text(0.1) == "0.1");
  CHECK(to_text(0.1F) == "0.1");
  CHECK(to_text(1e300) == "1e+300");
  CHECK(to_text(-1234567.5) == "-1234567.5");
  CHECK(to_text(1.0 / 3) == "0.3333333333333333");
  CHECK(to_text(-0.0) == "-0");
  CHECK(to_text(5e-324) == "5e-324");
  CHECK(to_text(std::numeric_limits<double>::infinity()) == "inf");
  CHECK(to_text(std::numeric_limits<double>::quiet_NaN()) == "nan");
  CHECK(to_text(0.5L) == "0.5");
}

TEST_CASE("to_text of a number: parse_number restores every bit") {
  duet_test::random_source random(1);
  for (int i = 0; i < 2000; ++i) {
    const double x = random.signed_log_uniform(1e-307, 1e307);
    const auto back = parse_number(to_text(x));
    REQUIRE(back.has_value());
    CHECK(std::bit_cast<std::uint64_t>(*back) == std::bit_cast<std::uint64_t>(x));
  }
  CHECK(std::signbit(parse_number(to_text(-0.0)).value()));
  CHECK(parse_number(to_text(5e-324)) == 5e-324);
}

TEST_CASE("parse_number: rejects text with anything but one number") {
  CHECK(parse_number("1.5") == 1.5);
  CHECK(parse_number("  -1.5e-3\t\r\n") == -1.5e-3);
  CHECK(parse_number("+2") == 2);
  CHECK(parse_number(".5") == 0.5);
  CHECK(parse_number("5.") == 5);
  CHECK(parse_number("1E5") == 1e5);
  CHECK(parse_number("inf") == std::numeric_limits<double>::infinity());
  CHECK(parse_number("-INF") == -std::numeric_limits<double>::infinity());
  CHECK(parse_number("+infinity") == std::numeric_limits<double>::infinity());
  CHECK(std::isnan(parse_number("nan").value()));
  CHECK(std::isnan(parse_number("NaN").value()));
  for (const char* text :
       {"",    " ",   "+",   "-",    ".",  "e5",    "1,5",    "1.5x", "1.5 2", "1 000", "++1",
        "+-1", "-+1", "+ 1", "0x10", "1e", "1e999", "-1e999", "one",  "1.5.2", "--1"}) {
    CAPTURE(std::string(text));
    CHECK_FALSE(parse_number(text).has_value());
  }
}

TEST_CASE("to_text and parse_number: a decimal comma in the global locale has no effect") {
  const global_locale guard(std::locale(std::locale::classic(), new german));
  std::ostringstream stream;
  stream << 1234.5;
  REQUIRE(stream.str() == "1.234,5"); // the locale is in force
  CHECK(to_text(1234.5) == "1234.5");
  CHECK(to_text(0.25F) == "0.25");
  CHECK(to_text(0.25L) == "0.25");
  CHECK(parse_number("1234.5") == 1234.5);
  CHECK_FALSE(parse_number("1234,5").has_value());
}

} // namespace
} // namespace test_core_number_text
