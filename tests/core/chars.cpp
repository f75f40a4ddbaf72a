// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Substitutes for std::from_chars and std::to_chars of floating-point numbers, compared with the
// standard library if it has them, and with known results.

#include <duet/core/text/number_text.hpp>

#include <doctest/doctest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <string_view>
#include <system_error>

namespace test_core_chars {

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

struct reading {
  std::errc error;
  std::size_t length;
  double value;
};

reading read(std::string_view text) {
  double value = 42; // text that is not a number leaves it unchanged
  const auto [end, error] =
      duet::detail::from_chars_by_strtod(text.data(), text.data() + text.size(), value);
  return {error, std::size_t(end - text.data()), value};
}

/// Reads with std::from_chars or, if the library lacks it, with the substitute.
reading read_by_library(std::string_view text) {
  double value = 42;
  const auto [end, error] = duet::detail::from_chars(text.data(), text.data() + text.size(), value);
  return {error, std::size_t(end - text.data()), value};
}

bool have_same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) ||
         (std::isnan(a) && std::isnan(b) && std::signbit(a) == std::signbit(b));
}

void check_against_library(std::string_view text) {
  const reading ours = read(text);
  const reading library = read_by_library(text);
  INFO("\"", std::string(text), "\"");
  CHECK(ours.error == library.error);
  CHECK(ours.length == library.length);
  // (Out of range libc++'s sets an infinity or zero, others leave the value alone, as the standard
  // says.)
  if (ours.error != std::errc::result_out_of_range) {
    CHECK(have_same_bits(ours.value, library.value));
  }
}

template <class T>
void check_text(T x) {
  const std::string text = duet::detail::shortest_text_by_printf(x);
  CHECK(text == duet::detail::shortest_text(x));
  CHECK(duet::detail::nearest_to<T>(text) == x);
}

} // namespace

TEST_CASE("from_chars: numbers are read up to the first character that does not belong to them") {
  constexpr auto none = std::errc();
  constexpr auto out_of_range = std::errc::result_out_of_range;
  constexpr auto invalid = std::errc::invalid_argument;
  struct row {
    std::string_view text;
    std::errc error;
    std::size_t length;
    double value;
  };
  const std::string halfway = // between the largest number below 1 and 1
      "0.99999999999999994448884876874217297881841659545898437500000";
  const row table[] = {
      {"0", none, 1, 0.},
      {"-0", none, 2, -0.},
      {"12.5e3", none, 6, 12500},
      {"12.5e", none, 4, 12.5},
      {"12.5e+", none, 4, 12.5},
      {"12.5e-1x", none, 7, 1.25},
      {"1.", none, 2, 1},
      {".5", none, 2, .5},
      {"1.2.3", none, 3, 1.2},
      {"1,5", none, 1, 1},
      {"0x1p3", none, 1, 0},
      {"1E2", none, 3, 100},
      {"-.5e0", none, 5, -.5},
      {"9007199254740993", none, 16, 9007199254740992},
      {"9007199254740993.00000000000000000001", none, 37, 9007199254740994},
      {"1.7976931348623157e308", none, 22, 1.7976931348623157e308},
      {"1.7976931348623158e308", none, 22, 1.7976931348623157e308},
      {"1.7976931348623159e308", out_of_range, 22, 42},
      {"-1e309", out_of_range, 6, 42},
      {"1e99999999999999999999999", out_of_range, 25, 42},
      {"0e99999999999999999999999", none, 25, 0},
      {"5e-324", none, 6, 5e-324},
      {"2.4703282292062328e-324", none, 23, 5e-324},
      {"2.4703282292062327e-324", out_of_range, 23, 42},
      {"1e-99999999999999999999999", out_of_range, 26, 42},
      {"inf", none, 3, inf},
      {"-INFinite", none, 4, -inf},
      {"Infinity", none, 8, inf},
      {"in", invalid, 0, 42},
      {"", invalid, 0, 42},
      {"-", invalid, 0, 42},
      {".", invalid, 0, 42},
      {"-.e5", invalid, 0, 42},
      {"+1", invalid, 0, 42},
      {" 1", invalid, 0, 42},
      {"--1", invalid, 0, 42},
      {"e5", invalid, 0, 42},
      {halfway, none, halfway.size(), 1},
  };
  for (const row& expected : table) {
    INFO("\"", std::string(expected.text), "\"");
    const reading result = read(expected.text);
    CHECK(result.error == expected.error);
    CHECK(result.length == expected.length);
    CHECK(have_same_bits(result.value, expected.value));
    check_against_library(expected.text);
  }
  for (const std::string_view text : {"nan", "-NaN", "nan(a_1)", "nan(", "nan(-)"}) {
    CHECK(std::isnan(read(text).value));
    check_against_library(text);
  }
  CHECK(read("nan(a_1)").length == 8);
  CHECK(read("nan(-)").length == 3);

  // The decimal point may be far from the position that the exponent gives.
  const std::string zeros(400, '0');
  CHECK(read("0." + zeros + "125e403").value == 125);
  CHECK(read("125" + zeros + "e-402").value == 1.25);
}

TEST_CASE("from_chars: random texts are read as by the standard library") {
  std::mt19937_64 random(7);
  constexpr std::string_view letters = "0123456789012345678901234567890...eE+--inafx(),";
  for (int i = 0; i < 20000; ++i) {
    std::string text;
    for (std::uint64_t remaining = random() % 14; remaining > 0; --remaining) {
      text += letters[random() % letters.size()];
    }
    check_against_library(text);
  }
}

TEST_CASE("to_chars: shortest texts equal those of the standard library") {
  for (int exponent = -1074; exponent < 1024; ++exponent) {
    check_text(std::ldexp(1., exponent));
  }
  for (int exponent = -149; exponent < 128; ++exponent) {
    check_text(std::ldexp(1.F, exponent));
  }
  for (int exponent = -25; exponent < 25; ++exponent) {
    check_text(std::pow(10., exponent));
    check_text(-1234567 * std::pow(10., exponent));
    check_text(1234567 * std::pow(10.F, float(exponent)));
  }
  std::mt19937_64 random(8);
  for (int i = 0; i < 2000; ++i) {
    const auto x = std::bit_cast<double>(random());
    if (std::isfinite(x)) {
      check_text(x);
    }
    check_text(double(random() % 100000) / 1000);
    check_text(double(random() >> (random() % 64)));
  }
  CHECK(duet::detail::shortest_text_by_printf(0.) == "0");
  CHECK(duet::detail::shortest_text_by_printf(-0.) == "-0");
  CHECK(duet::detail::shortest_text_by_printf(-inf) == "-inf");
  CHECK(duet::detail::shortest_text_by_printf(std::nan("")) == "nan");
  CHECK(duet::detail::shortest_text_by_printf(.001) == "0.001");
  CHECK(duet::detail::shortest_text_by_printf(.0001) == "1e-04");
  CHECK(duet::detail::shortest_text_by_printf(1e22) == "1e+22");
  CHECK(duet::detail::shortest_text_by_printf(123456789012345683968.) == "123456789012345683968");
}

} // namespace test_core_chars
