// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/progress.hpp>
#include <duet/core/text/number_text.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <utility>

#if __has_include(<unistd.h>)
#include <unistd.h>
#endif

/// \file
/// Progress display for people.

namespace example {

/// Settings of a progress display.
struct progress_display {
  std::FILE* stream = stderr; ///< stream to write to
  bool is_terminal = false;   ///< true: one line, overwritten repeatedly, instead of many
  double interval = 10;       ///< seconds between lines, and before the first

  /// Settings for standard error: every second if it is a terminal, else every ten. The environment
  /// variable `DUET_PROGRESS_INTERVAL` sets other seconds; 0 shows everything, `inf` nothing.
  [[nodiscard]] static progress_display standard() {
#if __has_include(<unistd.h>)
    const bool is_terminal = isatty(STDERR_FILENO) == 1;
#else
    const bool is_terminal = false;
#endif
    const char* const text = std::getenv("DUET_PROGRESS_INTERVAL");
    const double wanted = duet::parse_number(text == nullptr ? "" : text)
                              .value_or(std::numeric_limits<double>::quiet_NaN());
    return {stderr, is_terminal, wanted >= 0 ? wanted : is_terminal ? 1.0 : 10.0};
  }
};

/// Shows the progress of a long run, `progress: 3 of 40 blocks`, and nothing for a short one: a
/// report for `duet::execution` or `duet::comparison_options`.
///
/// Example:
/// `progress_line line("blocks"); duet::parallel_for(n, body, {.threads = 0, .report = line});`
class progress_line {
public:
  explicit progress_line(std::string things,
                         const progress_display& display = progress_display::standard())
      : things_(std::move(things)), display_(display) {}
  progress_line(const progress_line&) = delete;
  progress_line& operator=(const progress_line&) = delete;
  ~progress_line() {
    if (has_spoken_ && display_.is_terminal) {
      std::fputs("\n", display_.stream);
    }
  }

  /// Shows the number of completed elements, if a line is due.
  void operator()(const duet::progress& p) {
    say(std::to_string(p.done) + " of " + std::to_string(p.count) + " " + things_,
        p.done == p.count && has_spoken_);
  }

  /// Prints a text if a line is due.
  void say(const std::string& text, bool is_last = false) {
    const std::chrono::duration<double> silence = std::chrono::steady_clock::now() - spoke_;
    if (silence.count() >= display_.interval || is_last) {
      const std::string line = "progress: " + text;
      std::fputs((display_.is_terminal ? "\r" + line : line + "\n").c_str(), display_.stream);
      std::fflush(display_.stream);
      has_spoken_ = true;
      spoke_ = std::chrono::steady_clock::now();
    }
  }

private:
  std::string things_;
  progress_display display_;
  bool has_spoken_ = false;
  std::chrono::steady_clock::time_point spoke_ = std::chrono::steady_clock::now();
};

} // namespace example
