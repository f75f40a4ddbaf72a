// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>
#include <iomanip>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

/// \file
/// A reporter that compares duet with the fastest other library of each workload.

namespace duet_bench {

/// Collects the repetitions of runs named "workload/contender"; a cell is the
/// fastest, since a disturbance of the machine only ever adds time.
class ratio_table : public benchmark::BenchmarkReporter {
public:
  /// Rows and columns keep the order of these names; runs come shuffled.
  explicit ratio_table(const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      (void)find(name);
    }
  }

  bool ReportContext(const Context&) override { return true; }

  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration || run.error_occurred) {
        continue;
      }
      contender& c = find(run.run_name.function_name);
      c.nanoseconds.push_back(run.GetAdjustedCPUTime());
      c.allocations += run.counters.at("allocations").value;
    }
  }

  void print() const {
    std::cout << std::left << std::setw(16) << "workload" << std::right << std::setw(10)
              << "duet/best" << std::setw(10) << "duet/hand"
              << "  nanoseconds, fastest of the repetitions\n"
              << std::fixed;
    for (const auto& [name, competitors] : workloads_) {
      const auto was_run = [](const auto& entry) { return !entry.second.nanoseconds.empty(); };
      if (std::any_of(competitors.begin(), competitors.end(), was_run)) {
        print_row(name, competitors);
      }
    }
  }

private:
  struct contender {
    std::vector<double> nanoseconds;
    double allocations = 0;

    [[nodiscard]] double fastest() const {
      return *std::min_element(nanoseconds.begin(), nanoseconds.end());
    }
  };

  template <class Value>
  using named = std::vector<std::pair<std::string, Value>>;

  /// The entry of that name, appended if absent.
  template <class Value>
  static Value& find(named<Value>& entries, const std::string& name) {
    const auto at = std::find_if(entries.begin(), entries.end(),
                                 [&](const auto& entry) { return entry.first == name; });
    return at != entries.end() ? at->second : entries.emplace_back(name, Value{}).second;
  }

  contender& find(const std::string& full_name) {
    const std::size_t slash = full_name.find('/');
    return find(find(workloads_, full_name.substr(0, slash)), full_name.substr(slash + 1));
  }

  static void print_row(const std::string& workload, const named<contender>& competitors) {
    double duet = 0;
    double hand = 0;
    double best = 0;
    for (const auto& [name, c] : competitors) {
      if (c.nanoseconds.empty()) {
        continue;
      }
      const double t = c.fastest();
      if (name == "duet") {
        duet = t;
      } else if (name == "hand") {
        hand = t;
      } else if (name != "value" && name != "adolc_reverse" && (best == 0 || t < best)) {
        best = t;
      }
    }
    std::cout << std::left << std::setw(16) << workload << std::right << std::setprecision(2);
    print_ratio(duet, best);
    print_ratio(duet, hand);
    std::cout << ' ' << std::setprecision(1);
    for (const auto& [name, c] : competitors) {
      if (c.nanoseconds.empty()) {
        continue;
      }
      std::cout << "  " << name << ' ' << c.fastest();
      if (c.allocations > 0) {
        std::cout << " (on the heap)";
      }
    }
    std::cout << '\n';
  }

  static void print_ratio(double a, double b) {
    std::cout << std::setw(10);
    if (a > 0 && b > 0) {
      std::cout << a / b;
    } else {
      std::cout << '-';
    }
  }

  named<named<contender>> workloads_;
};

} // namespace duet_bench
