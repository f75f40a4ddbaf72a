// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/skip.hpp"
#include "support/test.hpp"

#include <duet/core/text/number_text.hpp>

#include <clocale>
#include <cstdlib>
#include <system_error>

namespace test_core_number_text_german {

TEST_CASE("to_text and parse_number: the German C locale has no effect") {
  bool has_locale = false;
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "de_DE"}) {
    has_locale = has_locale || std::setlocale(LC_ALL, name) != nullptr;
  }
  if (!has_locale) {
    duet_test::skip("the locale de_DE.UTF-8 is not installed");
    return;
  }
  REQUIRE(std::strtod("1,5", nullptr) == 1.5); // the locale is in force
  CHECK(duet::to_text(1234.5) == "1234.5");
  CHECK(duet::to_text(0.25F) == "0.25");
  CHECK(duet::to_text(0.25L) == "0.25");
  CHECK(duet::parse_number("1234.5") == 1234.5);
  CHECK_FALSE(duet::parse_number("1234,5").has_value());

  // The substitute for std::from_chars.
  double x = 0;
  CHECK(duet::detail::read_by_strtod("-1234.5e1", x) == std::errc());
  CHECK(x == -12345);
  CHECK(duet::detail::read_by_strtod("1234,5", x) == std::errc::invalid_argument);
  std::setlocale(LC_ALL, "C");
}

} // namespace test_core_number_text_german
