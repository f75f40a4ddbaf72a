// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/file.hpp>
#include <duet/core/text/nearest_names.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/core/text/text_rows.hpp>
#include <duet/mechanism/joint.hpp>
#include <duet/mechanism/tree_loop.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// \file
/// Loops out of files: what a robot description, which is a tree, cannot say.

namespace duet {

namespace detail {

/// One line of a file of loops.
class loop_line {
public:
  loop_line(const std::string& path, std::size_t line, std::string_view text)
      : path_(path), line_(line) {
    for_each_word(text, [&](std::string_view word) { words_.push_back(word); });
  }

  [[nodiscard]] tree_loop read() {
    tree_loop result;
    result.line = line_;
    result.kind = kind(word("a kind of loop"));
    result.first = frame();
    result.second = frame();
    if (result.kind == loop_kind::rod) {
      if (word("\"length\" of the rod") != "length") {
        fail("\"length\" of the rod expected, not \"" + std::string(words_[next_ - 1]) + "\"");
      }
      result.length = number("length");
      if (!(result.length > 0)) {
        fail("length is " + std::string(words_[next_ - 1]));
      }
    }
    if (next_ < words_.size()) {
      fail("\"" + std::string(words_[next_]) + "\" is too much");
    }
    return result;
  }

private:
  [[noreturn]] void fail(const std::string& what) const { raise(file_error(path_, line_, what)); }

  [[nodiscard]] std::string_view word(const std::string& what) {
    if (next_ == words_.size()) {
      fail(what + " is missing");
    }
    return words_[next_++];
  }
  [[nodiscard]] bool has(std::string_view option) {
    const bool is_next = next_ < words_.size() && words_[next_] == option;
    next_ += is_next ? 1 : 0;
    return is_next;
  }

  [[nodiscard]] double number(const std::string& name) {
    double result = 0;
    const std::string fault = read_cell(path_, line_, name, word(name), result);
    if (!fault.empty()) {
      fail(fault);
    }
    return result;
  }
  [[nodiscard]] std::array<double, 3> numbers(std::string_view of, const std::string& link,
                                              const std::array<const char*, 3>& names) {
    std::array<double, 3> result{};
    for (std::size_t i = 0; i < 3; ++i) {
      result[i] = number(std::string(of) + names[i] + " on \"" + link + "\"");
    }
    return result;
  }

  [[nodiscard]] loop_kind kind(std::string_view name) const {
    std::vector<std::string> names;
    for (int i = 0; i <= int(loop_kind::rod); ++i) {
      names.emplace_back(to_text(loop_kind(i)));
      if (names.back() == name) {
        return loop_kind(i);
      }
    }
    fail("no kind of loop is \"" + std::string(name) + "\": " + nearest_names(name, names));
  }

  [[nodiscard]] loop_frame frame() {
    loop_frame result{std::string(word("a link")), {}};
    const auto at = numbers("", result.link, {"x", "y", "z"});
    if (has("axis")) {
      const auto n = numbers("axis ", result.link, {"x", "y", "z"});
      if (!(std::hypot(n[0], n[1], n[2]) > 0)) {
        fail("axis on \"" + result.link + "\" has no direction");
      }
      result.offset = along_axis(at, n);
    } else if (has("rpy")) {
      const auto rpy = numbers("", result.link, {"roll", "pitch", "yaw"});
      for (const double angle : rpy) {
        if (std::abs(angle) > 1e6) { // its digits are needed for whole turns
          fail("the angle " + to_text(angle) + " on \"" + result.link + "\" is beyond 1e6 radians");
        }
      }
      result.offset = {turn_about(2, rpy[2]) * turn_about(1, rpy[1]) * turn_about(0, rpy[0]), at};
    } else {
      result.offset = {quaternion<double>(1.0), at};
    }
    return result;
  }

  const std::string& path_;
  std::size_t line_;
  std::vector<std::string_view> words_;
  std::size_t next_ = 0;
};

} // namespace detail

/// The loops in a text file, which stands beside a robot description: one a line, as
/// `hinge coupler 0.5 0 0 rocker 0.4 0 0` or `rod base 1 0 0 plate 0.1 0 0 length 0.8`: a kind of
/// `loop_kind`, two frames, and of a rod its length. A frame is a link, a point x y z in its frame,
/// and, if its axes are not the link's, `axis x y z`, along which its z points as by `along_axis`,
/// or `rpy roll pitch yaw` as in URDF. Metres and radians; names without blanks; what follows a
/// number sign on a line is a comment.
///
/// \throws file_error with line and value for what cannot be read, unknown kinds, missing and
/// superfluous words, what is no finite number, axes and rods without length
[[nodiscard]] inline loop_description read_loops(const std::string& path) {
  loop_description result;
  result.file = path;
  detail::for_each_line(path, [&](std::size_t line, std::string_view text) {
    const std::string_view content = detail::split_line(text).text;
    if (!content.empty()) {
      result.loops.push_back(detail::loop_line(path, line, content).read());
    }
  });
  if (result.loops.empty()) {
    detail::raise(file_error(path, "no loops"));
  }
  return result;
}

} // namespace duet
