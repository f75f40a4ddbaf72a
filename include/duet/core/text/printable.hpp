// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// \file
/// Untrusted text in a form that a message may show, and suggestions for an unknown name.

namespace duet {

namespace detail {

/// Number of bytes of the UTF-8 character that a text begins with; 0 if it begins with no such
/// character, or if it controls a terminal: a control character, a line separator, a change of the
/// writing direction.
[[nodiscard]] inline std::size_t escaped_bytes(std::string_view text) {
  const auto byte = [text](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  const unsigned first = byte(0);
  if (first < 0x80) {
    return first >= 0x20 && first != 0x7f ? 1 : 0;
  }
  const std::size_t count = first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
  if (first < 0xc2 || first > 0xf4) {
    return 0;
  }
  unsigned code = first & (0x7fU >> count);
  for (std::size_t i = 1; i < count; ++i) {
    if ((byte(i) & 0xc0U) != 0x80) {
      return 0;
    }
    code = (code << 6U) | (byte(i) & 0x3fU);
  }
  const bool is_character = count == 2   ? code >= 0x80
                            : count == 3 ? code >= 0x800 && (code < 0xd800 || code > 0xdfff)
                                         : code >= 0x10000 && code <= 0x10ffff;
  const bool is_control = code < 0xa0 || code == 0x61c || code == 0x200e || code == 0x200f ||
                          (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
  return is_character && !is_control ? count : 0;
}

} // namespace detail

/// Untrusted text (a file's name, its cells, an argument) as a message may show it: on one line,
/// and without terminal commands. Control characters and invalid UTF-8 bytes become `\n`, `\t`,
/// `\r` or `\x1b`; of more than 1000 bytes the middle is omitted.
[[nodiscard]] inline std::string printable(std::string_view text) {
  constexpr std::size_t max_size = 1000;
  if (text.size() > max_size) {
    return printable(text.substr(0, max_size / 2)) + " ... " +
           printable(text.substr(text.size() - max_size / 2));
  }
  constexpr std::string_view digits = "0123456789abcdef";
  std::string result;
  while (!text.empty()) {
    std::size_t count = detail::escaped_bytes(text);
    if (count > 0) {
      result += text.substr(0, count);
    } else {
      count = 1;
      const auto byte = static_cast<unsigned char>(text[0]);
      if (byte == '\n' || byte == '\t' || byte == '\r') {
        result += byte == '\n' ? "\\n" : byte == '\t' ? "\\t" : "\\r";
      } else {
        result += {'\\', 'x', digits[byte / 16U], digits[byte % 16U]};
      }
    }
    text.remove_prefix(count);
  }
  return result;
}

} // namespace duet

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

/// Refuses an unknown name.
///
/// \param function  the function of the message
/// \param what      the kind of thing that has the name, as "joint"
/// \param names     all known names
/// \throws invalid_input with the most similar names
[[noreturn]] inline void unknown_name(const char* function, const char* what, std::string_view name,
                                      const std::vector<std::string>& names) {
  raise(invalid_input(printable(message("duet: ", function, ": no ", what, " \"", name,
                                        "\": ", closest_names(name, names)))));
}

} // namespace duet::detail
