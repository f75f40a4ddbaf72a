// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/comparison/compare.hpp>

// Text forms of a comparison, for people and for programs.

namespace test_comparison_reports {
namespace {

using duet::comparison, duet::verdict;

comparison sample() {
  comparison c;
  c.label = "P5, \"printed\"";
  c.outcome = verdict::disagrees;
  c.samples = 100;
  c.counts = {60, 0, 8, 2, 30};
  c.tolerance = 100;
  c.errors = {{15, 0.25, 0.5, 4.5e15, "u = 1, w = (0, 2)"}};
  c.simplest = duet::counterexample{
      "u = 1, w = (0, 1)", {0.5, 1e-20, 2}, {1.0 / 3, 0, std::numeric_limits<double>::quiet_NaN()}};
  return c;
}

TEST_CASE(
    "to_text of a comparison: text for people names verdict, samples, errors and counterexample") {
  CHECK(to_text(sample()) ==
        "P5, \"printed\": disagrees at 30, not finite at 2, loses digits at 8, agrees at 60 of 100 "
        "inputs\n"
        "  15 digits: worst error 4.5e+15 ulp, relative 0.5, absolute 0.25, at u = 1, w = (0, 2)\n"
        "  simplest input: u = 1, w = (0, 1)\n"
        "    automatic:   (0.5, 0, 2)\n"
        "    closed form: (0.3333333333, 0, nan)\n");
  comparison good;
  good.label = "good";
  good.samples = 7;
  good.counts[0] = 7;
  good.errors = {{15, 0, 0, 0, ""}};
  CHECK(to_text(good) == "good: agrees at 7 of 7 inputs\n"
                         "  15 digits: worst error 0 ulp, relative 0, absolute 0\n");
}

TEST_CASE("to_text of a comparison: prints as many digits as show the difference of both sides") {
  comparison c = sample();
  c.simplest = duet::counterexample{"x = 1", {0.5, 2}, {0.5, 2 + 0x1p-42}};
  CHECK(to_text(c).ends_with("    automatic:   (0.5, 2)\n"
                             "    closed form: (0.5, 2.0000000000002)\n"));
  c.simplest = duet::counterexample{"x = 1", {1}, {1 + 0x1p-52}};
  CHECK(to_text(c).ends_with("    automatic:   1\n    closed form: 1.0000000000000002\n"));
  CHECK(to_markdown(std::array{c}).ends_with("| x = 1 | 1 | 1.0000000000000002 |\n"));
  // A component negligible beside the largest one at ten digits is printed at more digits.
  c.simplest = duet::counterexample{"x = 1", {1, 0}, {1, 1e-13}};
  CHECK(to_text(c).ends_with("    automatic:   (1, 0)\n    closed form: (1, 1e-13)\n"));
  // Digits that `double` does not have.
  c.simplest = duet::counterexample{"x = 1", {0.5}, {0.5}, 1.25e-30};
  CHECK(to_text(c).ends_with("    automatic:   0.5\n    closed form: 0.5\n"
                             "    difference:  1.25e-30\n"));
  const comparison result = duet::compare<float, double>(
      "in double", [](auto x) { return x; },
      [](auto x) { return decltype(x)(x * (1 + decltype(x)(1e-13))); },
      duet::sampler(duet::real_numbers{1, 3}));
  CHECK(result.outcome == verdict::loses_precision);
  CHECK(to_text(result).ends_with("    automatic:   1\n    closed form: 1.0000000000001\n"));
  CHECK(result.simplest->difference == doctest::Approx(1e-13).epsilon(1e-2));
}

TEST_CASE(
    "to_text of a comparison: names the function that returned fewer digits than its arguments") {
  comparison c = sample();
  c.errors[0].compared_digits = 6;
  c.note = "why";
  CHECK(
      to_text(c).find("  15 digits, compared to 6: worst error 4.5e+15 ulp, relative 0.5, absolute "
                      "0.25, at u = 1, w = (0, 2)\n  note: why\n") != std::string::npos);
  CHECK(to_markdown(std::array{c}).find("| disagrees (why) |") != std::string::npos);
  CHECK(to_csv(std::array{c}).ends_with("\"u = 1, w = (0, 1)\",6\n"));
}

TEST_CASE("to_markdown of comparisons: one row per comparison") {
  comparison good;
  good.label = "good";
  CHECK(to_markdown(std::array{sample(), good}) ==
        "| formula | verdict | simplest input | automatic | closed form |\n"
        "|---|---|---|---|---|\n"
        "| P5, \"printed\" | disagrees | u = 1, w = (0, 1) | (0.5, 0, 2) | (0.3333333333, 0, nan) "
        "|\n"
        "| good | agrees | | | |\n");
}

TEST_CASE("to_csv of comparisons: one line per comparison and scalar") {
  CHECK(to_csv(std::array{sample()}) ==
        "label,verdict,samples,agreeing,tolerance_ulp,digits,worst_ulp,worst_relative,"
        "worst_absolute,worst_input,simplest_input,compared_digits\n"
        "\"P5, \"\"printed\"\"\",disagrees,100,60,100,15,4500000000000000,0.5,0.25,"
        "\"u = 1, w = (0, 2)\",\"u = 1, w = (0, 1)\",15\n");
}

TEST_CASE(
    "compare: reports progress after every input and ends early if the callback returns false") {
  const std::size_t all = duet::sampler(duet::real_numbers{}).points(29, 1).size();
  std::size_t calls = 0, last = all;
  const auto report = [&](const duet::progress& p) {
    CHECK(p.done == ++calls);
    CHECK(p.count == all);
    return p.done < last;
  };
  const auto run = [&] {
    return duet::compare<double>(
        "same", [](auto x) { return x; }, [](auto x) { return x; },
        duet::sampler(duet::real_numbers{}), {.samples = 29, .report = report});
  };
  CHECK(run());
  CHECK(calls == all);
  calls = 0;
  last = 7;
  const std::string message = "duet: cancelled with 7 of " + std::to_string(all) + " elements done";
  CHECK_THROWS_WITH_AS(static_cast<void>(run()), message.c_str(), duet::cancelled);
  CHECK(calls == 7);
}

} // namespace
} // namespace test_comparison_reports
