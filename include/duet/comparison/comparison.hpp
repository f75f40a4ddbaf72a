// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

/// \file
/// Results of comparing two formulas, and their text forms.

namespace duet {

/// Verdict of `compare` on two formulas, from best to worst.
enum class verdict {
  agrees,          ///< everywhere, within the tolerance
  loses_precision, ///< the same formula, but spoilt by round-off (or a constant of few digits)
  not_finite,      ///< somewhere one of them is infinite or NaN and the other is not
  disagrees        ///< the formulas differ
};

/// A verdict in words, as in reports.
[[nodiscard]] inline std::string_view to_text(verdict v) {
  constexpr std::array words = {"agrees", "loses digits", "not finite", "disagrees"};
  return words[std::size_t(v)];
}

/// Largest differences of two results in one precision. The norm is the largest component; `ulps`
/// counts units of the last place, |difference| / (ε/2 · (‖f‖ + ‖f′‖‖x‖)), where the second term is
/// computed only if the first does not suffice.
struct worst_errors {
  int digits = 0;      ///< decimal digits of the scalar
  double absolute = 0; ///< largest |difference|
  double relative = 0; ///< largest |difference| / ‖f‖
  double ulps = 0;     ///< largest difference in units of the last place
  std::string input{}; ///< input with the largest `ulps`
  /// number of digits compared if a function returned fewer digits than the scalar has and these
  /// were decisive: the last place is then that of the function. Otherwise 0.
  int compared_digits = 0;
};

/// An input at which two formulas differ, and their results there in double precision.
struct counterexample {
  std::string input;               ///< the arguments, as text
  std::vector<double> automatic;   ///< components of the result of the automatic derivative
  std::vector<double> closed_form; ///< components of the result of the closed form
  double difference = 0; ///< largest |difference| there, in the precision that shows most of it
};

/// Result of `compare`.
struct comparison {
  std::string label;                      ///< label passed to `compare`
  verdict outcome = verdict::agrees;      ///< worst verdict of all samples
  std::size_t samples = 0;                ///< number of inputs tried
  std::array<std::size_t, 4> counts{};    ///< number of samples of every verdict
  double tolerance = 0;                   ///< allowed error, in units of the last place
  std::vector<worst_errors> errors;       ///< one for every scalar type
  std::optional<counterexample> simplest; ///< simplest input with the worst verdict
  /// names the function that returned fewer digits than its arguments have, so that fewer were
  /// compared; empty if that changed nothing
  std::string note{};

  /// True if the formulas agree.
  [[nodiscard]] explicit operator bool() const { return outcome == verdict::agrees; }
};

namespace detail {

/// A separate stream, independent of the locale and the caller's format.
[[nodiscard]] inline std::ostringstream plain_stream(int digits) {
  std::ostringstream stream;
  stream.imbue(std::locale::classic()); // declared by <ios>
  stream.precision(digits);
  return stream;
}

/// Text of the components; those negligible beside the largest component are printed as 0.
[[nodiscard]] inline std::string components_text(std::span<const double> numbers, int digits) {
  double largest = 0;
  for (const double x : numbers) {
    largest = std::max(largest, std::isfinite(x) ? std::abs(x) : 0.0);
  }
  auto out = plain_stream(digits);
  const double nothing = largest * std::pow(10.0, -digits - 2);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double x = numbers[i];
    out << (i > 0 ? ", " : "");
    if (std::isnan(x)) {
      out << "nan"; // whatever its sign
    } else {
      out << (std::abs(x) < nothing ? 0.0 : x);
    }
  }
  return numbers.size() == 1 ? out.str() : "(" + out.str() + ")";
}

/// Results of both sides: ten digits, or as many as show the difference.
[[nodiscard]] inline std::array<std::string, 2> sides_text(const counterexample& c) {
  for (int digits = 10;; ++digits) {
    std::array sides = {components_text(c.automatic, digits),
                        components_text(c.closed_form, digits)};
    if (sides[0] != sides[1] || digits == std::numeric_limits<double>::max_digits10) {
      return sides;
    }
  }
}

/// A field of a CSV file, quoted if necessary.
[[nodiscard]] inline std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) {
    return text;
  }
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c == '"' ? "\"\"" : std::string(1, c);
  }
  return quoted + "\"";
}

} // namespace detail

/// A paragraph for people.
[[nodiscard]] inline std::string to_text(const comparison& c) {
  auto out = detail::plain_stream(3);
  out << c.label << ": ";
  for (const verdict v : {verdict::disagrees, verdict::not_finite, verdict::loses_precision}) {
    if (const std::size_t count = c.counts[std::size_t(v)]; count > 0) {
      out << to_text(v) << " at " << count << ", ";
    }
  }
  out << "agrees at " << c.counts[0] << " of " << c.samples << " inputs\n";
  for (const worst_errors& e : c.errors) {
    out << "  " << e.digits << " digits";
    if (e.compared_digits > 0) {
      out << ", compared to " << e.compared_digits;
    }
    out << ": worst error " << e.ulps << " ulp, relative " << e.relative << ", absolute "
        << e.absolute;
    if (!e.input.empty()) {
      out << ", at " << e.input;
    }
    out << "\n";
  }
  if (!c.note.empty()) {
    out << "  note: " << c.note << "\n";
  }
  if (c.simplest) {
    const auto [automatic, closed_form] = detail::sides_text(*c.simplest);
    out << "  simplest input: " << c.simplest->input << "\n    automatic:   " << automatic
        << "\n    closed form: " << closed_form << "\n";
    if (automatic == closed_form) { // more digits than `double` has would show it
      out << "    difference:  " << c.simplest->difference << "\n";
    }
  }
  return out.str();
}

/// A table for documents, one row per comparison.
[[nodiscard]] inline std::string to_markdown(std::span<const comparison> comparisons) {
  std::string text = "| formula | verdict | simplest input | automatic | closed form |\n"
                     "|---|---|---|---|---|\n";
  for (const comparison& c : comparisons) {
    text += "| " + c.label + " | " + std::string(to_text(c.outcome)) +
            (c.note.empty() ? "" : " (" + c.note + ")");
    if (c.simplest) {
      const auto [automatic, closed_form] = detail::sides_text(*c.simplest);
      text += " | " + c.simplest->input + " | " + automatic + " | " + closed_form + " |\n";
    } else {
      text += " | | | |\n";
    }
  }
  return text;
}

/// A table for programs, one line per comparison and scalar.
[[nodiscard]] inline std::string to_csv(std::span<const comparison> comparisons) {
  auto out = detail::plain_stream(17);
  out << "label,verdict,samples,agreeing,tolerance_ulp,digits,worst_ulp,worst_relative,"
         "worst_absolute,worst_input,simplest_input,compared_digits\n";
  for (const comparison& c : comparisons) {
    for (const worst_errors& e : c.errors) {
      out << detail::csv_field(c.label) << "," << to_text(c.outcome) << "," << c.samples << ","
          << c.counts[0] << "," << c.tolerance << "," << e.digits << "," << e.ulps << ","
          << e.relative << "," << e.absolute << "," << detail::csv_field(e.input) << ","
          << detail::csv_field(c.simplest ? c.simplest->input : "") << ","
          << (e.compared_digits > 0 ? e.compared_digits : e.digits) << "\n";
    }
  }
  return out.str();
}

} // namespace duet
