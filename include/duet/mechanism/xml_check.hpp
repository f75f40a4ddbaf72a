// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// \file
/// What a parser of XML that calls itself for every element, and does not look at the names of end
/// tags, must not be given.

namespace duet::detail {

struct xml_fault {
  std::size_t line;
  std::string reason;
};

/// Goes through tags, comments, CDATA and processing instructions once, in the grammar of Boost's
/// parser, without a call per element.
class xml_check {
public:
  static constexpr std::size_t most_depth = 100;

  explicit xml_check(std::string_view text) : text_(text) {}

  /// Why the text is refused: elements nested too deep or closed by another's name, declarations
  /// (`<!DOCTYPE`, and with it entities), bytes 0, tags that are none.
  [[nodiscard]] std::optional<xml_fault> fault() {
    if (const auto zero = text_.find('\0'); zero != std::string_view::npos) {
      at_ = zero;
      complain("holds a byte 0");
    }
    while (reason_.empty() && (at_ = std::min(text_.find('<', at_), text_.size())) < text_.size()) {
      if (skip_if("<!--")) {
        skip_beyond("-->");
      } else if (skip_if("<![CDATA[")) {
        skip_beyond("]]>");
      } else if (skip_if("<?")) {
        skip_beyond("?>");
      } else if (skip_if("<!")) {
        complain("declarations, as <!DOCTYPE, are not supported");
      } else if (skip_if("</")) {
        close_element();
      } else {
        open_element();
      }
    }
    if (!open_.empty()) {
      complain("no </" + std::string(open_.back()) + ">");
    }
    if (reason_.empty()) {
      return std::nullopt;
    }
    const auto lines = std::count(text_.begin(), text_.begin() + std::ptrdiff_t(at_), '\n');
    return xml_fault{std::size_t(lines) + 1, reason_};
  }

private:
  static constexpr std::string_view blanks = " \t\r\n";

  /// Only the first complaint counts.
  void complain(const std::string& reason) {
    if (reason_.empty()) {
      reason_ = reason;
    }
  }
  [[nodiscard]] bool skip_if(std::string_view beginning) {
    const bool is_there = text_.substr(at_, beginning.size()) == beginning;
    at_ += is_there ? beginning.size() : 0;
    return is_there;
  }
  void skip_beyond(std::string_view end) {
    const auto place = text_.find(end, at_);
    if (place == std::string_view::npos) {
      complain("no " + std::string(end));
    } else {
      at_ = place + end.size();
    }
  }
  [[nodiscard]] std::string_view take_until(std::string_view stops) {
    const auto end = std::min(text_.find_first_of(stops, at_), text_.size());
    const auto taken = text_.substr(at_, end - at_);
    at_ = end;
    return taken;
  }
  void skip_blanks() { at_ = std::min(text_.find_first_not_of(blanks, at_), text_.size()); }

  void open_element() {
    ++at_;
    const auto name = take_until(" \t\r\n/>?");
    if (name.empty()) {
      complain("no name after <");
    }
    skip_blanks();
    while (reason_.empty() && !take_until(" \t\r\n/<>=?!").empty()) {
      skip_attribute_value();
    }
    if (skip_if("/>")) {
      return;
    }
    if (!skip_if(">")) {
      complain("no > after <" + std::string(name));
    }
    open_.push_back(name);
    if (open_.size() > most_depth) {
      complain("elements are nested more than " + std::to_string(most_depth) + " deep");
    }
  }

  void skip_attribute_value() {
    skip_blanks();
    if (!skip_if("=")) {
      return complain("no = after an attribute's name");
    }
    skip_blanks();
    const std::string_view quote = text_.substr(at_, 1);
    if (quote != "\"" && quote != "'") {
      return complain("no quote before an attribute's value");
    }
    ++at_;
    skip_beyond(quote);
    skip_blanks();
  }

  void close_element() {
    const auto name = take_until(" \t\r\n/>?");
    skip_blanks();
    if (open_.empty() || open_.back() != name || !skip_if(">")) {
      return complain(
          "</" + std::string(name) + "> where " +
          (open_.empty() ? "nothing is open" : "</" + std::string(open_.back()) + "> is expected"));
    }
    open_.pop_back();
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<std::string_view> open_;
  std::string reason_;
};

} // namespace duet::detail
