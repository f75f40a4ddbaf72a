// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// \file
/// Suggestions for an unknown name.

namespace duet::detail {

/// Number of letters to insert, delete or change (Levenshtein distance).
[[nodiscard]] inline std::size_t edit_distance(std::string_view a, std::string_view b) {
  // distance of the letters of a so far to each prefix of b
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t(0));
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t change = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({change, diagonal + 1, row[j] + 1});
    }
  }
  return row.back();
}

/// `there are "a", "b" … and 7 more`, the most similar names first.
[[nodiscard]] inline std::string closest_names(std::string_view name,
                                               const std::vector<std::string>& names) {
  constexpr std::size_t max_shown = 6;
  if (names.empty()) {
    return "there are none";
  }
  std::vector<std::pair<std::size_t, std::size_t>> order; // distance and index
  for (std::size_t i = 0; i < names.size(); ++i) {
    order.emplace_back(edit_distance(name, names[i]), i);
  }
  std::sort(order.begin(), order.end());
  std::string text = "there are ";
  for (std::size_t i = 0; i < std::min(max_shown, names.size()); ++i) {
    text += (i > 0 ? ", \"" : "\"") + names[order[i].second] + "\"";
  }
  return names.size() > max_shown
             ? text + " and " + std::to_string(names.size() - max_shown) + " more"
             : text;
}

} // namespace duet::detail
