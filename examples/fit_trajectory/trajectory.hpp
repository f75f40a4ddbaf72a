// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/csv.hpp>

#include <duet/comparison/random_source.hpp>
#include <duet/core/number_text.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/spline/orientations.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Recorded motion: rows `timestamp tx ty tz qx qy qz qw`.

namespace fit_trajectory {

using pose_type = duet::dual_quaternion<double>;
using duet::vector3;

struct row {
  std::size_t line;
  double time;
  pose_type pose;
};

/// A row that was put elsewhere or left out, and why.
struct fault {
  std::size_t line;
  std::string reason;
};

struct recording {
  std::vector<row> rows; ///< in order of time
  std::vector<fault> faults;
  std::size_t left_out = 0;
};

namespace detail {

/// The eight numbers of a line, NaN among them, none for a comment.
/// \throws duet::file_error
inline std::vector<double> numbers_of(const std::string& path, std::size_t line, std::string text) {
  text = text.substr(0, text.find('#'));
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream words(text);
  std::vector<double> numbers;
  for (std::string word; words >> word;) {
    const auto number = duet::parse_number(word);
    if (!number) {
      throw duet::file_error(path, line, "'" + word + "' is not a number");
    }
    numbers.push_back(*number);
  }
  if (!numbers.empty() && numbers.size() != 8) {
    throw duet::file_error(path, line,
                           "8 numbers expected (timestamp tx ty tz qx qy qz qw), got " +
                               std::to_string(numbers.size()));
  }
  return numbers;
}

/// What is wrong with a row by itself, empty if nothing.
inline std::string fault_of(const std::vector<double>& x) {
  static constexpr std::array names{"timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"};
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i])) {
      return std::string(names[i]) + " is " + duet::to_text(x[i]);
    }
  }
  const double length = norm(duet::quaternion<double>(x[7], x[4], x[5], x[6]));
  if (!(std::abs(length - 1) <= duet::unit_norm_tolerance)) {
    return "the quaternion has norm " + duet::to_text(length) + ", not 1";
  }
  return {};
}

/// Rows in order of time, each time once.
inline void put_in_order(recording& r) {
  std::stable_sort(r.rows.begin(), r.rows.end(),
                   [](const row& a, const row& b) { return a.time < b.time; });
  std::vector<row> once;
  for (const row& each : r.rows) {
    if (!once.empty() && once.back().time == each.time) {
      r.faults.push_back({each.line, "timestamp " + duet::to_text(each.time) + " repeats line " +
                                         std::to_string(once.back().line) + ": left out"});
      ++r.left_out;
    } else {
      once.push_back(each);
    }
  }
  r.rows = std::move(once);
  std::size_t earliest = r.rows.back().line; // of the rows later in time
  for (auto each = r.rows.rbegin(); each != r.rows.rend(); ++each) {
    if (each->line > earliest) {
      r.faults.push_back(
          {each->line, "timestamp " + duet::to_text(each->time) + " is out of order: sorted in"});
    }
    earliest = std::min(earliest, each->line);
  }
  std::sort(r.faults.begin(), r.faults.end(),
            [](const fault& a, const fault& b) { return a.line < b.line; });
}

} // namespace detail

/// \throws duet::file_error for a file that cannot be read and for a line of another format
inline recording read_recording(const std::string& path) {
  std::ifstream in(path);
  if (!in) {
    throw duet::file_error(path, "cannot be read");
  }
  recording result;
  std::string text;
  for (std::size_t line = 1; std::getline(in, text); ++line) {
    const std::vector<double> x = detail::numbers_of(path, line, text);
    if (x.empty()) {
      continue;
    }
    if (const std::string fault = detail::fault_of(x); !fault.empty()) {
      result.faults.push_back({line, fault + ": left out"});
      ++result.left_out;
      continue;
    }
    const duet::quaternion<double> q(x[7], x[4], x[5], x[6]);
    result.rows.push_back(
        {line, x[0], duet::pose(normalized(q), vector3<double>(x[1], x[2], x[3]))});
  }
  if (result.rows.empty()) {
    throw duet::file_error(path, "holds no usable rows");
  }
  detail::put_in_order(result);
  return result;
}

/// A hand-held figure of eight over 12 s, seen 100 times a second with 1 mm and 2 mrad of noise,
/// two rows in a hundred far off.
inline recording made_up_recording() {
  duet::random_source random(2026);
  recording result;
  const auto shaken = [&](double size) -> vector3<double> {
    return size * vector3<double>{random.normal(), random.normal(), random.normal()};
  };
  for (std::size_t i = 0; i <= 1200; ++i) {
    const double t = double(i) / 100;
    const vector3<double> place(0.5 * std::sin(t), 0.3 * std::sin(2 * t),
                                1 + 0.1 * std::cos(3 * t));
    const vector3<double> turn(0.4 * std::sin(1.3 * t), 0.5 * std::cos(0.9 * t), 0.8 * std::sin(t));
    const bool is_far_off = random.unit() < 0.02;
    const auto noise = duet::pose(duet::from_rotation_vector(shaken(is_far_off ? 0.2 : 0.002)),
                                  shaken(is_far_off ? 0.1 : 0.001));
    result.rows.push_back({i + 1, t, duet::pose(duet::from_rotation_vector(turn), place) * noise});
  }
  return result;
}

} // namespace fit_trajectory
