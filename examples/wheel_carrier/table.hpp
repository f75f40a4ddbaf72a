// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "carrier.hpp"

#include <duet/core/text/csv.hpp>
#include <duet/spline/interpolate.hpp>
#include <duet/spline/table_rows.hpp>

#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/toms748_solve.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// \file
/// The look-up table: orientations over u, made from the mechanism or read from a file.

namespace wheel_carrier {

using duet::file_error;

struct table {
  std::vector<double> u;
  std::vector<rotation> q;
};

/// The range the wheel travels over (P7), metres.
inline constexpr double lowest = -0.19;
inline constexpr double highest = 0.20;

/// The angle between neighbouring rows of the paper's table, rad (P7).
inline constexpr double paper_angle = 0.003;

/// Arc length of the orientation from `lowest` on: s(u) = ∫ |ω| du, tabulated once so that it can
/// be inverted quickly.
class arc_length {
public:
  explicit arc_length(const carrier& mechanism) : mechanism_(mechanism), sums_{0} {
    for (int i = 0; i < pieces; ++i) {
      sums_.push_back(sums_.back() + integral(node(i), node(i + 1)));
    }
  }

  [[nodiscard]] double total() const { return sums_.back(); }

  /// The u with s(u) = arc.
  [[nodiscard]] double inverse(double arc) const {
    if (arc <= 0) {
      return lowest;
    }
    if (arc >= total()) {
      return highest;
    }
    const auto i = int(std::upper_bound(sums_.begin(), sums_.end(), arc) - sums_.begin()) - 1;
    const auto missing = [&](double u) {
      return sums_[std::size_t(i)] + (u > node(i) ? integral(node(i), u) : 0.0) - arc;
    };
    std::uintmax_t iterations = 100;
    const auto [below, above] = boost::math::tools::toms748_solve(
        missing, node(i), node(i + 1), boost::math::tools::eps_tolerance<double>(46), iterations);
    return (below + above) / 2;
  }

private:
  static constexpr int pieces = 40;

  [[nodiscard]] static double node(int i) { return lowest + (highest - lowest) * i / pieces; }
  [[nodiscard]] double integral(double from, double to) const {
    const auto speed = [this](double u) { return mechanism_.at(u).omega().norm(); };
    return boost::math::quadrature::gauss<double, 7>::integrate(speed, from, to);
  }

  const carrier& mechanism_;
  std::vector<double> sums_;
};

/// Rows at equal arcs over the whole range; their u values are not uniform.
inline table equal_arc_table(const carrier& mechanism, const arc_length& arcs, int rows) {
  table result;
  for (int i = 0; i < rows; ++i) {
    const double fraction = double(i) / (rows - 1); // exactly 1 in the last row
    const double u = arcs.inverse(arcs.total() * fraction);
    result.u.push_back(u);
    result.q.push_back(mechanism.at(u).q);
  }
  return result;
}

/// Reads u, qw, qx, qy, qz, in the order that a header gives. Rows a curve cannot go through are
/// reported here, where their line is known. \throws file_error
inline table read_table(const std::string& path) {
  using duet::detail::table_column;
  table result;
  std::vector<std::size_t> lines;
  const auto start = [&](std::size_t line, const auto& cells, const auto& header, bool) {
    if (!header && cells.size() != 5) {
      throw file_error(path, line, "5 numbers expected, got " + std::to_string(cells.size()));
    }
    return header.value_or(duet::detail::table_layout(
        {table_column::u, table_column::qw, table_column::qx, table_column::qy, table_column::qz},
        {"u", "qw", "qx", "qy", "qz"}));
  };
  duet::detail::for_each_table_row(
      path, true, false, start,
      [&](std::size_t line, const std::array<double, 8>& x, const std::string& fault) {
        if (!fault.empty()) {
          throw file_error(path, line, fault);
        }
        lines.push_back(line);
        result.u.push_back(x[0]);
        result.q.emplace_back(x[4], x[5], x[6], x[7]);
      });
  if (result.u.size() < 2) {
    throw file_error(path, result.u.empty() ? "holds no rows" : "needs two rows or more");
  }
  try {
    duet::detail::check_rows(result.u, result.q.size(), 2);
    result.q = duet::aligned_orientations(result.q);
  } catch (const duet::invalid_row& error) {
    throw file_error(path, lines[error.row()], error.reason());
  }
  return result;
}

} // namespace wheel_carrier
