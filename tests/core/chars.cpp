// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// The substitute for std::from_chars of floating-point numbers, compared with the standard library
// if it has it, and with known results; shortest texts.

#include "support/test.hpp"

#include <duet/core/text/number_text.hpp>

#include <bit>
#include <charconv>
#include <concepts>
#include <cstdlib>
#include <random>
#include <string_view>
#include <system_error>

namespace test_core_chars {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

struct reading {
  std::errc error;
  double value;
};

reading read(std::string_view text) {
  double value = 42; // text that is not a number leaves it unchanged
  const std::errc error = duet::detail::read_by_strtod(text, value);
  return {error, value};
}

bool have_same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) ||
         (std::isnan(a) && std::isnan(b) && std::signbit(a) == std::signbit(b));
}

template <std::same_as<double> T>
void check_against_library(std::string_view text, T library) {
  if constexpr (duet::detail::HasFromChars<T>) {
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), library);
    const std::errc error =
        end == text.data() + text.size() ? problem : std::errc::invalid_argument;
    const reading ours = read(text);
    INFO("\"", std::string(text), "\"");
    CHECK(ours.error == error);
    // (Out of range libc++'s sets an infinity or zero, others leave the value alone, as the
    // standard says.)
    if (error == std::errc()) {
      CHECK(have_same_bits(ours.value, library));
    }
  }
}

template <class T>
void check_text(T x) {
  const std::string text = duet::to_text(x);
  if constexpr (std::same_as<T, double>) {
    CHECK(duet::parse_number(text) == x);
  }
  CHECK(T(std::strtold(text.c_str(), nullptr)) == x);
}

TEST_CASE("read_by_strtod: a text is a number as a whole, or invalid") {
  constexpr auto none = std::errc();
  constexpr auto out_of_range = std::errc::result_out_of_range;
  constexpr auto invalid = std::errc::invalid_argument;
  struct row {
    std::string_view text;
    std::errc error;
    double value;
  };
  const std::string halfway = // between the largest number below 1 and 1
      "0.99999999999999994448884876874217297881841659545898437500000";
  const row table[] = {
      {"0", none, 0.},
      {"-0", none, -0.},
      {"12.5e3", none, 12500},
      {"12.5e", invalid, 42},
      {"12.5e+", invalid, 42},
      {"12.5e-1x", invalid, 42},
      {"1.", none, 1},
      {".5", none, .5},
      {"1.2.3", invalid, 42},
      {"1,5", invalid, 42},
      {"0x1p3", invalid, 42},
      {"1E2", none, 100},
      {"-.5e0", none, -.5},
      {"9007199254740993", none, 9007199254740992},
      {"9007199254740993.00000000000000000001", none, 9007199254740994},
      {"1.7976931348623157e308", none, 1.7976931348623157e308},
      {"1.7976931348623158e308", none, 1.7976931348623157e308},
      {"1.7976931348623159e308", out_of_range, 42},
      {"-1e309", out_of_range, 42},
      {"1e99999999999999999999999", out_of_range, 42},
      {"0e99999999999999999999999", none, 0},
      {"5e-324", none, 5e-324},
      {"2.4703282292062328e-324", none, 5e-324},
      {"2.4703282292062327e-324", out_of_range, 42},
      {"1e-99999999999999999999999", out_of_range, 42},
      {"inf", none, inf},
      {"-INFinite", invalid, 42},
      {"Infinity", none, inf},
      {"in", invalid, 42},
      {"", invalid, 42},
      {"-", invalid, 42},
      {".", invalid, 42},
      {"-.e5", invalid, 42},
      {"+1", invalid, 42},
      {" 1", invalid, 42},
      {"--1", invalid, 42},
      {"e5", invalid, 42},
      {halfway, none, 1},
  };
  for (const row& expected : table) {
    INFO("\"", std::string(expected.text), "\"");
    const reading result = read(expected.text);
    CHECK(result.error == expected.error);
    CHECK(have_same_bits(result.value, expected.value));
    check_against_library(expected.text, 42.0);
  }
  for (const std::string_view text : {"nan", "-NaN", "nan(a_1)"}) {
    CHECK(std::isnan(read(text).value));
    check_against_library(text, 42.0);
  }
  for (const std::string_view text : {"nan(", "nan(-)", "nan(a.1)", "1e+-5", "1e5.", "-+1"}) {
    CHECK(read(text).error == invalid);
    check_against_library(text, 42.0);
  }

  // The decimal point may be far from the position that the exponent gives.
  const std::string zeros(400, '0');
  CHECK(read("0." + zeros + "125e403").value == 125);
  CHECK(read("125" + zeros + "e-402").value == 1.25);
}

TEST_CASE("read_by_strtod: random texts are read as by the standard library") {
  std::mt19937_64 random(7);
  constexpr std::string_view letters = "0123456789012345678901234567890...eE+--inafx(),";
  for (int i = 0; i < 20000; ++i) {
    std::string text;
    for (std::uint64_t remaining = random() % 14; remaining > 0; --remaining) {
      text += letters[random() % letters.size()];
    }
    check_against_library(text, 42.0);
  }
}

TEST_CASE("to_text: every text reads back as the same number") {
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
  CHECK(duet::to_text(0.) == "0");
  CHECK(duet::to_text(-0.) == "-0");
  CHECK(duet::to_text(-inf) == "-inf");
  CHECK(duet::to_text(std::nan("")) == "nan");
  CHECK(duet::to_text(.001) == "0.001");
  CHECK(duet::to_text(.0001) == "1e-04");
  CHECK(duet::to_text(1e22) == "1e+22");
  CHECK(duet::to_text(123456789012345683968.) == "123456789012345683968");
}

} // namespace
} // namespace test_core_chars
