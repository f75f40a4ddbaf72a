// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "options.hpp"
#include "samples.hpp"
#include "toleranced_carrier.hpp"

#include <duet/core/text/csv.hpp>
#include <duet/core/text/file.hpp>
#include <duet/core/text/number_text.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

/// \file
/// Samples in blocks, each a file that is written atomically.

namespace tolerance_study {

inline constexpr double degrees = 180 / std::numbers::pi;

/// Blocks do not depend on the process that computes them, nor does the study.
class block_store {
public:
  block_store(const options& settings, const hardpoints& points)
      : folder_(settings.out + "/samples"), samples_(std::size_t(settings.samples)),
        seed_(settings.seed), deviation_(settings.deviation),
        settings_(settings_of(settings, points)) {}

  [[nodiscard]] std::size_t count() const { return (samples_ + size - 1) / size; }
  [[nodiscard]] const std::string& folder() const { return folder_; }

  /// The blocks without a file.
  /// \throws duet::file_error if a file was written with other settings
  [[nodiscard]] std::vector<std::size_t> missing() const {
    std::vector<std::size_t> result;
    for (std::size_t block = 0; block < count(); ++block) {
      if (std::filesystem::exists(path(block))) {
        require_same_settings(path(block));
      } else {
        result.push_back(block);
      }
    }
    return result;
  }

  /// Computes a block and writes its file.
  void compute(const toleranced_carrier& mechanism, std::size_t block) const {
    std::string text = "# ";
    for (const std::string& setting : settings_) {
      text += setting + "; ";
    }
    text += "toe-in and camber in degrees at every height\n";
    for (std::size_t sample = first(block); sample < first(block + 1); ++sample) {
      const errors e = sample_errors(seed_, sample, deviation_);
      std::vector<double> row{double(sample)};
      for (std::size_t i = 0; i < mechanism.rows(); ++i) {
        const vector2 angles = angles_of_sample(mechanism, i, sample, e) * degrees;
        row.insert(row.end(), {angles[0], angles[1]});
      }
      text += duet::csv_line(row);
    }
    duet::write_file(path(block), text);
  }

  /// All samples in order, by columns: toe-in and camber at the first height, then at the others.
  [[nodiscard]] std::vector<std::vector<double>> columns(std::size_t heights) const {
    std::vector<std::vector<double>> result(2 * heights);
    for (std::size_t block = 0; block < count(); ++block) {
      const auto rows = duet::csv_file(path(block), 1 + 2 * heights).rows();
      std::size_t sample = first(block);
      for (const duet::csv_row& row : rows) {
        if (row.numbers[0] != double(sample++)) {
          throw duet::file_error(path(block), row.line,
                                 "sample " + std::to_string(sample - 1) + " expected");
        }
        for (std::size_t i = 0; i < result.size(); ++i) {
          result[i].push_back(row.numbers[1 + i]);
        }
      }
      if (sample != first(block + 1)) {
        throw duet::file_error(path(block),
                               "contains " + std::to_string(rows.size()) + " samples (expected " +
                                   std::to_string(first(block + 1) - first(block)) + ")");
      }
    }
    return result;
  }

private:
  static constexpr std::size_t size = 256;

  [[nodiscard]] std::size_t first(std::size_t block) const {
    return std::min(block * size, samples_);
  }

  [[nodiscard]] std::string path(std::size_t block) const {
    char name[32];
    std::snprintf(name, sizeof name, "/%05zu.csv", block);
    return folder_ + name;
  }

  [[nodiscard]] static vector2 angles_of_sample(const toleranced_carrier& mechanism,
                                                std::size_t row, std::size_t sample,
                                                const errors& e) {
    try {
      return mechanism.angles(row, e);
    } catch (const duet::loop_closure_failure&) {
      throw std::runtime_error("the rods of sample " + std::to_string(sample) +
                               " cannot close at u = " + duet::to_text(mechanism.height(row)) +
                               " m: the standard deviation is too large");
    }
  }

  [[nodiscard]] static std::vector<std::string> settings_of(const options& settings,
                                                            const hardpoints& points) {
    const auto vector = [](const vector3& x) {
      return " " + duet::to_text(x[0]) + " " + duet::to_text(x[1]) + " " + duet::to_text(x[2]);
    };
    std::vector<std::string> result{std::to_string(settings.samples) + " samples",
                                    "standard deviation " + duet::to_text(settings.deviation),
                                    "seed " + std::to_string(settings.seed),
                                    "travel " + duet::to_text(settings.lowest) + " to " +
                                        duet::to_text(settings.highest),
                                    std::to_string(settings.heights) + " heights",
                                    "wheel centre" + vector(points.wheel_centre)};
    for (const rod& r : points.rods) {
      result.push_back("rod" + vector(r.chassis) + vector(r.carrier));
    }
    return result;
  }

  void require_same_settings(const std::string& file) const {
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    std::size_t at = 2;
    for (const std::string& setting : settings_) {
      const std::size_t end = line.find("; ", at);
      if (end == std::string::npos) {
        throw duet::file_error(file, 1, "has no first line with the settings of the study");
      }
      const std::string stored = line.substr(at, end - at);
      if (stored != setting) {
        throw duet::file_error(file, 1,
                               "made with " + stored + ", not " + setting +
                                   " (remove the file or choose another folder)");
      }
      at = end + 2;
    }
  }

  std::string folder_;
  std::size_t samples_;
  std::uint64_t seed_;
  double deviation_;
  std::vector<std::string> settings_;
};

/// Ascending numbers as text, with runs as ranges: 1, 4-7.
[[nodiscard]] inline std::string runs(const std::vector<std::size_t>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) {
      ++last;
    }
    text += (text.empty() ? "" : ", ") + std::to_string(numbers[i]);
    if (last > i) {
      text += "-" + std::to_string(numbers[last]);
    }
    i = last + 1;
  }
  return text;
}

} // namespace tolerance_study
