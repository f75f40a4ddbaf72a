// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/number_text.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string>
#include <string_view>

/// \file
/// Times in files, whose digits exceed a double in seconds.

namespace duet::detail {

/// Time in seconds. Adjacent doubles for seconds since 1970 differ by 2.4e-7 s, so the integer and
/// the fractional part are stored as well: differences of times have all digits of the file.
class file_time {
public:
  explicit file_time(double seconds = 0)
      : seconds_(seconds), integral_(std::trunc(seconds)), fraction_(seconds - integral_) {}

  /// Time in a cell that holds a finite number, decimal or with an exponent, in units of 10^−digits
  /// s. The decimal point is moved in the text, because divisions round.
  file_time(std::string_view cell, std::size_t digits) {
    cell = trimmed(cell);
    const double sign = cell.starts_with('-') ? -1 : 1;
    if (cell.starts_with('-') || cell.starts_with('+')) {
      cell.remove_prefix(1);
    }
    const std::size_t e = std::min(cell.find_first_of("eE"), cell.size());
    // With exponents beyond this bound a finite number is 0.
    const double max_shift = double(cell.size() + digits) + 400;
    const double exponent = number_of(cell.substr(std::min(e + 1, cell.size())));
    const auto shift = int(std::clamp(exponent, -max_shift, max_shift)) - int(digits);
    cell = cell.substr(0, e);
    const std::size_t point = std::min(cell.find('.'), cell.size());
    std::string before(cell.substr(0, point));
    std::string after(cell.substr(std::min(point + 1, cell.size())));
    if (const auto count = std::size_t(std::abs(shift)); shift < 0) {
      before.insert(0, count, '0');
      after.insert(0, before, before.size() - count, count);
      before.resize(before.size() - count);
    } else {
      after.resize(std::max(after.size(), count), '0');
      before.append(after, 0, count);
      after.erase(0, count);
    }
    before = "0" + before;
    after = "." + after + "0";
    seconds_ = sign * number_of(before + after);
    integral_ = sign * number_of(before);
    fraction_ = sign * number_of("0" + after);
  }

  /// Nearest double, in seconds.
  [[nodiscard]] double seconds() const { return seconds_; }
  /// Seconds since another time, to 1e-16 s and round-off; since 0 the nearest double.
  [[nodiscard]] double since(const file_time& start) const {
    return start.seconds_ == 0 ? seconds_
                               : (integral_ - start.integral_) + (fraction_ - start.fraction_);
  }
  [[nodiscard]] bool operator<(const file_time& other) const {
    return integral_ < other.integral_ ||
           (integral_ == other.integral_ && fraction_ < other.fraction_);
  }

private:
  /// Value of a number; 0 if the text is empty or the number nearer to 0 than any double.
  [[nodiscard]] static double number_of(std::string_view text) {
    double number = 0;
    static_cast<void>(read_number(text, number));
    return number;
  }

  double seconds_ = 0, integral_ = 0, fraction_ = 0;
};

} // namespace duet::detail
