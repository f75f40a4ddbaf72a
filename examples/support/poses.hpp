// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "numbers.hpp"

#include <duet/core/errors.hpp>
#include <duet/core/text/csv.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/quaternion/norm.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

/// \file
/// Poses of command lines and files.

namespace example {

/// The pose of `x, y, z, qw, qx, qy, qz` or of a matrix [R t; 0 1], row by row, 12 or 16 numbers.
/// \throws duet::invalid_input with a message that names neither option nor file
inline duet::dual_quaternion<double> parse_pose(const std::vector<double>& x) {
  const std::string count = std::to_string(x.size());
  if (x.size() == 7) {
    const duet::quaternion<double> q(x[3], x[4], x[5], x[6]);
    const double length = norm(q);
    if (!(std::abs(length - 1) <= duet::unit_norm_tolerance)) {
      throw duet::invalid_input("the quaternion has norm " + duet::to_text(length) + ", not 1");
    }
    return duet::pose(normalized(q), duet::vector3<double>(x[0], x[1], x[2]));
  }
  if (x.size() != 12 && x.size() != 16) {
    throw duet::invalid_input("7 numbers (x, y, z, qw, qx, qy, qz) or 12 or 16 (a matrix, row by "
                              "row) expected, got " +
                              count);
  }
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  for (std::size_t i = 0; i < x.size(); ++i) {
    m(Eigen::Index(i / 4), Eigen::Index(i % 4)) = x[i];
  }
  return duet::from_transform_matrix(m);
}

/// \throws std::runtime_error with the option's name
inline duet::dual_quaternion<double> parse_pose(const std::string& option,
                                                const std::string& text) {
  const std::vector<double> numbers = parse_numbers(option, text);
  try {
    return parse_pose(numbers);
  } catch (const duet::invalid_input& error) {
    throw std::runtime_error(option + ": " + error.what());
  }
}

/// A message of the library without its leading name.
inline std::string without_name(const std::string& message) {
  const std::string name = "duet: ";
  return message.starts_with(name) ? message.substr(name.size()) : message;
}

struct pose_row {
  std::size_t line;
  duet::dual_quaternion<double> pose;
};

/// The columns of x, y, z, qw, qx, qy, qz in a header.
/// \throws duet::file_error if one is missing
inline std::vector<std::size_t>
pose_columns(const std::string& path, const std::vector<std::string>& header, std::size_t line) {
  std::vector<std::size_t> result;
  for (const char* name : {"x", "y", "z", "qw", "qx", "qy", "qz"}) {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found == header.end()) {
      throw duet::file_error(path, line, std::string("the header names no column ") + name);
    }
    result.push_back(std::size_t(found - header.begin()));
  }
  return result;
}

/// A pose on each line of a file, as `parse_pose` has it. A header must name `x,y,z,qw,qx,qy,qz`,
/// in the order of the rows.
/// \throws duet::file_error
inline std::vector<pose_row> read_poses(const std::string& path) {
  const duet::csv_file file(path);
  const std::vector<std::string>& header = file.header();
  std::vector<std::size_t> columns;
  if (!header.empty()) {
    columns = pose_columns(path, header, file.header_line());
  }
  std::vector<pose_row> result;
  for (const duet::csv_row& row : file.rows()) {
    std::vector<double> numbers = row.numbers;
    if (!header.empty()) {
      if (numbers.size() != header.size()) {
        throw duet::file_error(path, row.line,
                               std::to_string(header.size()) + " numbers expected, got " +
                                   std::to_string(numbers.size()));
      }
      numbers.clear();
      for (const std::size_t column : columns) {
        numbers.push_back(row.numbers[column]);
      }
    }
    try {
      result.push_back({row.line, parse_pose(numbers)});
    } catch (const duet::invalid_input& error) {
      throw duet::file_error(path, row.line, without_name(error.what()));
    }
  }
  return result;
}

} // namespace example
