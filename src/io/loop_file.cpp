// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/core/text/csv.hpp>
#include <duet/core/text/file_error.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/io/loop_file.hpp>
#include <duet/kinematics/joint.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace duet {

namespace detail {
namespace {

/// One line of a file of loop-closure constraints.
class loop_line {
public:
  loop_line(const std::string& path, std::size_t line, std::string_view text)
      : path_(path), line_(line) {
    for_each_word(text, [&](std::string_view word) { words_.push_back(word); });
  }

  [[nodiscard]] loop_constraint read() {
    loop_constraint result;
    result.line = line_;
    result.kind = kind(word("the type of constraint"));
    result.first = frame();
    result.second = frame();
    if (result.kind == constraint_kind::distance) {
      if (word("\"length\"") != "length") {
        fail("\"length\" expected, not \"" + std::string(words_[next_ - 1]) + "\"");
      }
      result.length = number("length");
      if (!(result.length > 0)) {
        fail("length is " + std::string(words_[next_ - 1]) + " (expected > 0)");
      }
    }
    if (next_ < words_.size()) {
      fail("\"" + std::string(words_[next_]) + "\" is superfluous");
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
    const std::string error = read_cell(path_, line_, name, word(name), result);
    if (!error.empty()) {
      fail(error);
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

  [[nodiscard]] constraint_kind kind(std::string_view name) const {
    // Names of mechanical connections, which files may use as well.
    constexpr std::array<std::string_view, 8> others{"weld",      "hinge", "slider", "cylindrical",
                                                     "universal", "ball",  "planar", "rod"};
    std::vector<std::string> names;
    for (int i = 0; i <= int(constraint_kind::distance); ++i) {
      names.emplace_back(to_text(constraint_kind(i)));
      if (names.back() == name || others[std::size_t(i)] == name) {
        return constraint_kind(i);
      }
      if (names.back() != others[std::size_t(i)]) {
        names.emplace_back(others[std::size_t(i)]);
      }
    }
    fail("unknown type of constraint \"" + std::string(name) + "\": " + closest_names(name, names));
  }

  [[nodiscard]] constraint_frame frame() {
    constraint_frame result{std::string(word("the name of a link")), {}};
    const auto at = numbers("", result.link, {"x", "y", "z"});
    if (has("axis")) {
      const auto n = numbers("axis ", result.link, {"x", "y", "z"});
      if (!(std::hypot(n[0], n[1], n[2]) > 0)) {
        fail("the axis on \"" + result.link + "\" is zero");
      }
      result.offset = frame_with_z_axis(at, n);
    } else if (has("rpy")) {
      const auto rpy = numbers("", result.link, {"roll", "pitch", "yaw"});
      for (const double angle : rpy) {
        if (std::abs(angle) > 1e6) { // larger angles lose digits
          fail("the angle " + to_text(angle) + " on \"" + result.link + "\" exceeds 1e6 radians");
        }
      }
      result.offset = {rotation_about_axis(2, rpy[2]) * rotation_about_axis(1, rpy[1]) *
                           rotation_about_axis(0, rpy[0]),
                       at};
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

} // namespace
} // namespace detail

DUET_ABI_BEGIN

loop_constraints read_loops(const std::string& path) {
  loop_constraints result;
  result.file = path;
  detail::for_each_line(path, [&](std::size_t line, std::string_view text) {
    const std::string_view content = detail::split_line(text).text;
    if (!content.empty()) {
      result.loops.push_back(detail::loop_line(path, line, content).read());
    }
  });
  if (result.loops.empty()) {
    detail::raise(file_error(path, "the file contains no loop-closure constraints"));
  }
  return result;
}

DUET_ABI_END
} // namespace duet
