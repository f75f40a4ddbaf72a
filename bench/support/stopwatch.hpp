// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

/// Durations of single calls.
class stopwatch {
public:
  template <class F>
  auto of(const F& f) {
    const auto before = std::chrono::steady_clock::now();
    auto result = f();
    const std::chrono::duration<double, std::milli> time =
        std::chrono::steady_clock::now() - before;
    times_.push_back(time.count());
    return result;
  }
  bool is_empty() const { return times_.empty(); }
  /// In milliseconds.
  double median() {
    const auto middle = times_.begin() + std::ptrdiff_t(times_.size() / 2);
    std::nth_element(times_.begin(), middle, times_.end());
    return *middle;
  }

private:
  std::vector<double> times_;
};
