// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/random_source.hpp>
#include <duet/core/text/file.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/spline/table_rows.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// \file
/// Recorded motion: rows `timestamp tx ty tz qx qy qz qw`, or as a header says.

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
  std::string remark; ///< how the file was understood, where that is not plain
};

namespace detail {

/// How the times of a file become seconds, and what there is to say about that.
struct time_scale {
  double per_second = 1;
  bool is_guessed = false; ///< nanoseconds, which are whole numbers
};

/// Where the columns are, by the header or, without one, by their number.
/// \throws duet::file_error
inline duet::detail::table_layout layout_of(const std::string& path, std::size_t line,
                                            const std::vector<std::string_view>& cells,
                                            bool has_commas,
                                            const std::optional<duet::detail::table_layout>& header,
                                            recording& r, time_scale& scale) {
  using duet::detail::table_column;
  using enum table_column;
  constexpr double least_nanoseconds = 1e17; // 1973; as seconds the age of the universe
  const auto time_of = [&](std::size_t at) {
    return at < cells.size() ? duet::parse_number(cells[at]).value_or(0) : 0.0;
  };
  if (!header) {
    if (cells.size() != 8) {
      throw duet::file_error(path, line,
                             "8 numbers expected (timestamp tx ty tz qx qy qz qw), got " +
                                 std::to_string(cells.size()) +
                                 "; other columns need a header with their names");
    }
    const bool is_scalar_first = has_commas && std::abs(time_of(0)) >= least_nanoseconds;
    if (std::abs(time_of(0)) >= least_nanoseconds) {
      scale = {1e9, true};
      r.remark = std::string("timestamps in nanoseconds: read as ") +
                 (is_scalar_first ? "in EuRoC files, timestamp, x, y, z, qw, qx, qy, qz"
                                  : "timestamp tx ty tz qx qy qz qw");
    }
    return is_scalar_first
               ? duet::detail::table_layout({u, x, y, z, qw, qx, qy, qz},
                                            {"timestamp", "x", "y", "z", "qw", "qx", "qy", "qz"})
               : duet::detail::table_layout(
                     {u, x, y, z, qx, qy, qz, qw},
                     {"timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"});
  }
  const std::string& unit = header->time_unit;
  if (unit.empty()) {
    const bool is_large = std::abs(time_of(header->at[0])) >= least_nanoseconds;
    if (header->is_euroc || is_large) {
      scale = {1e9, true};
      r.remark = header->is_euroc ? "a EuRoC file: timestamps in nanoseconds"
                                  : "timestamps of this size are taken for nanoseconds";
    }
  } else if (unit == "ns" || unit == "us" || unit == "ms") {
    scale.per_second = unit == "ns" ? 1e9 : unit == "us" ? 1e6 : 1e3;
    r.remark = std::string(header->is_euroc ? "a EuRoC file: " : "") + "timestamps in " + unit;
  } else if (unit != "s" && unit != "sec" && unit != "seconds") {
    throw duet::file_error(path, line, "timestamps in '" + unit + "': s, ms, us or ns expected");
  }
  if (const std::string& place = header->place_unit; !place.empty() && place != "m") {
    throw duet::file_error(path, line, "positions in '" + place + "': m expected");
  }
  return *header;
}

/// What is wrong with a row by itself, empty if nothing.
inline std::string fault_of(const duet::quaternion<double>& q) {
  const double length = norm(q);
  if (!(std::abs(length - 1) <= duet::unit_norm_tolerance)) {
    return "the quaternion has norm " + duet::to_text(length) + ", not 1";
  }
  return {};
}

/// Rows in order of time, each time once.
inline void put_in_order(recording& r) {
  const auto is_late = [](const row& a, const row& b) { return !(a.time < b.time); };
  if (std::adjacent_find(r.rows.begin(), r.rows.end(), is_late) == r.rows.end()) {
    return;
  }
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

/// Seconds; of EuRoC files and timestamps from 1e17 on nanoseconds, with a remark.
/// \throws duet::file_error for a file that cannot be read and for a line of another format
inline recording read_recording(const std::string& path) {
  recording result;
  detail::time_scale scale;
  const auto start = [&](std::size_t line, const auto& cells, const auto& header, bool has_commas) {
    return detail::layout_of(path, line, cells, has_commas, header, result, scale);
  };
  duet::detail::for_each_table_row(
      path, true, true, start,
      [&](std::size_t line, const std::array<double, 8>& x, const std::string& fault) {
        const duet::quaternion<double> q(x[4], x[5], x[6], x[7]);
        const std::string reason = fault.empty() ? detail::fault_of(q) : fault;
        if (!reason.empty()) {
          result.faults.push_back({line, reason + ": left out"});
          ++result.left_out;
          return;
        }
        if (scale.is_guessed && x[0] != std::floor(x[0])) {
          throw duet::file_error(path, line,
                                 "timestamp " + duet::to_text(x[0]) +
                                     " is no whole number of nanoseconds: a header with its unit, "
                                     "as in `timestamp [s]`, is needed");
        }
        result.rows.push_back({line, x[0] / scale.per_second,
                               duet::pose(normalized(q), vector3<double>(x[1], x[2], x[3]))});
      });
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
