// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "../../examples/support/progress_line.hpp"
#include "support/test.hpp"

#include <duet/core/parallel_for.hpp>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

namespace test_examples_progress_line {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// Output of a run of three steps.
std::string said(bool is_terminal, double interval) {
  std::FILE* const file = std::tmpfile();
  {
    example::progress_line line("things", {file, is_terminal, interval});
    for (std::size_t i = 1; i <= 3; ++i) {
      line({i, 3});
    }
  }
  std::rewind(file);
  std::string text;
  for (int c = 0; (c = std::fgetc(file)) != EOF;) {
    text += char(c);
  }
  std::fclose(file);
  return text;
}

TEST_CASE(
    "progress_line: one line on a terminal, several lines elsewhere, nothing for a short run") {
  CHECK(said(false, 0) ==
        "progress: 1 of 3 things\nprogress: 2 of 3 things\nprogress: 3 of 3 things\n");
  CHECK(said(true, 0) ==
        "\rprogress: 1 of 3 things\rprogress: 2 of 3 things\rprogress: 3 of 3 things\n");
  CHECK(said(false, never).empty());
  CHECK(said(true, never).empty());
}

TEST_CASE("progress_display: default-initialization sets every field") {
  alignas(example::progress_display) unsigned char memory[sizeof(example::progress_display)];
  std::memset(memory, 0xA7, sizeof memory);
  const auto* const display = new (memory) example::progress_display;
  CHECK(display->stream == stderr);
  CHECK(!display->is_terminal);
  CHECK(display->interval == 10);
}

TEST_CASE("progress_line: the environment variable sets the interval") {
  const auto interval = [](const char* text) {
    setenv("DUET_PROGRESS_INTERVAL", text, 1);
    return example::progress_display::standard().interval;
  };
  const char* const before = std::getenv("DUET_PROGRESS_INTERVAL");
  const std::string kept = before == nullptr ? "" : before;
  const bool is_terminal = example::progress_display::standard().is_terminal;
  const double otherwise = is_terminal ? 1 : 10;
  CHECK(interval("0") == 0);
  CHECK(interval("2.5") == 2.5);
  CHECK(interval("inf") == never);
  for (const char* const text : {"", "often", "-1", "nan"}) {
    CHECK(interval(text) == otherwise);
  }
  if (before == nullptr) {
    unsetenv("DUET_PROGRESS_INTERVAL");
  } else {
    setenv("DUET_PROGRESS_INTERVAL", kept.c_str(), 1);
  }
}

TEST_CASE("progress_line: serves as progress callback of a run") {
  std::FILE* const file = std::tmpfile();
  example::progress_line line("calls", {file, false, 0});
  duet::parallel_for_blocks(
      4, [](std::size_t, std::size_t) {}, {.threads = 1, .report = line}, 2);
  CHECK(std::ftell(file) == 2 * long(std::string("progress: 2 of 4 calls\n").size()));
  std::fclose(file);
}

} // namespace
} // namespace test_examples_progress_line
