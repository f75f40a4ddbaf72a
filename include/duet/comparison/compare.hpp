// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/comparison/domain.hpp>
#include <duet/comparison/measure.hpp>
#include <duet/comparison/sampler.hpp>
#include <duet/core/config.hpp>
#include <duet/core/function_reference.hpp>
#include <duet/core/progress.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/derivative/argument.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Checks a closed-form formula against its automatic derivative: verdict, worst errors and the
/// simplest input at which both differ, and their text forms.

namespace duet {

/// Settings of `compare`.
struct comparison_options {
  /// Number of random points, half of them unrestricted and half near special ones, in addition to
  /// the special points and the caller's.
  std::size_t samples = 1000;
  std::uint64_t seed = 1;        ///< seed of the random points; the same seed gives the same result
  double tolerance = 100;        ///< allowed error, in units of the last place
  progress_callback report = {}; ///< callback after every input; may end the run
};

/// Verdict of `compare` on two formulas, from best to worst.
enum class verdict {
  agrees,          ///< everywhere, within the tolerance
  inconclusive,    ///< the reference, extrapolated differences, has a larger error than that seen
  loses_precision, ///< the same formula, but spoilt by round-off (or a constant of few digits)
  not_finite,      ///< somewhere one of them is infinite or NaN and the other is not
  disagrees        ///< the formulas differ
};

/// A verdict in words, as in reports.
[[nodiscard]] inline std::string_view to_text(verdict v) {
  constexpr std::array words = {"agrees", "inconclusive", "loses digits", "not finite",
                                "disagrees"};
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
  std::array<std::size_t, 5> counts{};    ///< number of samples of every verdict
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

/// The numbers of inputs with each verdict of a comparison or judgement.
template <class Result>
void write_counts(std::ostream& out, const Result& r) {
  out << r.label << ": ";
  for (const verdict v :
       {verdict::disagrees, verdict::not_finite, verdict::loses_precision, verdict::inconclusive}) {
    if (const std::size_t count = r.counts[std::size_t(v)]; count > 0) {
      out << to_text(v) << " at " << count << ", ";
    }
  }
  out << "agrees at " << r.counts[0] << " of " << r.samples << " inputs\n";
}

/// Text of the components; those negligible beside the largest component are printed as 0.
[[nodiscard]] inline std::string components_text(std::span<const double> numbers, int digits) {
  auto out = plain_stream(digits);
  const double nothing = largest(numbers) * std::pow(10.0, -digits - 2);
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
  detail::write_counts(out, c);
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

namespace detail {

/// Length of numbers as text: their digits, points and signs, without the zero before a point and
/// without zeros. Among those of equal length the simplest are nearest to 1 in size, as a ratio,
/// and then positive: 0, 1, 2, 3 … 9, −1, ½, −2, …
struct complexity {
  std::size_t characters = 0;
  double ratios = 0;
  std::size_t negative = 0;

  explicit complexity(const coordinates& point) {
    for (const double x : point) {
      if (x != 0) {
        const std::size_t all = to_text(x).size();
        characters += std::abs(x) < 1 && std::abs(x) >= 1e-3 ? all - 1 : all;
        ratios += std::abs(std::log(std::abs(x)));
        negative += x < 0 ? 1U : 0U;
      }
    }
  }

  [[nodiscard]] auto operator<=>(const complexity&) const = default;
};

/// x rounded to a number of significant decimal digits.
///
/// \param round  to an integer: to the nearest one, or towards zero
[[nodiscard]] inline double rounded_to_digits(double x, int digits,
                                              double (*round)(double) = std::round) {
  if (x == 0 || !std::isfinite(x)) {
    return x;
  }
  // Uses an exact power of ten, on either side of 1.
  const int shift = digits - 1 - int(std::floor(std::log10(std::abs(x))));
  const double power = std::pow(10.0, std::abs(shift));
  return shift >= 0 ? round(x * power) / power : round(x / power) * power;
}

/// Replaces coordinates by simpler numbers while `fails(point)` stays true: one after the other, or
/// all that are equal, or all that are nearly equal, which keep their differences.
///
/// Every replacement shortens the text, so this ends; points are tried in a fixed order, so it ends
/// at the same one every time.
template <class Contains, class Fails>
[[nodiscard]] coordinates simplified(coordinates point, const Contains& contains,
                                     const Fails& fails) {
  const auto is_simpler = [&](const coordinates& other) {
    return complexity(other) < complexity(point) && contains(other) && fails(other);
  };
  const auto simplify_from = [&](std::size_t i) {
    const double old = point[i];
    const double shorter = rounded_to_digits(old, 1, std::trunc);
    for (const double candidate :
         {0.0, 1.0, 2.0, 3.0, -1.0, 0.5, -0.5, std::round(old), std::abs(rounded_to_digits(old, 1)),
          rounded_to_digits(old, 1), std::abs(shorter), shorter, rounded_to_digits(old, 2),
          rounded_to_digits(old, 2, std::trunc), rounded_to_digits(old, 4)}) {
      for (const double nearness : {-1.0, 0.0, 1e-2}) {
        coordinates other = point;
        std::size_t changed = 0;
        for (std::size_t j = 0; j < point.size(); ++j) {
          if (j == i || std::abs(point[j] - old) <= nearness * std::abs(old)) {
            other[j] = j == i || point[j] == old ? candidate : candidate + (point[j] - old);
            ++changed;
          }
        }
        if ((nearness < 0 || changed > 1) && is_simpler(other)) {
          point = other;
          return true;
        }
      }
    }
    return false;
  };
  bool changed = true;
  while (changed) {
    changed = false;
    for (std::size_t i = 0; i < point.size(); ++i) {
      changed = simplify_from(i) || changed;
    }
  }
  return point;
}

/// The error of a component that may be a slip.
struct suspect {
  std::size_t component = 0;
  double error = 0;             ///< error in the last precision
  double allowed = 0;           ///< allowed error there
  bool is_short = false;        ///< a function has fewer digits than that: round-off stays, too
  bool may_be_rounding = false; ///< the error leaves half of those digits
};

/// The component, if any, that is wrong in every precision, by an error that is the same in the
/// first and the last of them; the one with the largest error if there are several.
[[nodiscard]] inline std::optional<suspect> suspected(std::span<const difference> differences) {
  const difference& last = differences.back();
  std::optional<suspect> result;
  for (std::size_t i = 0; i < last.errors.size(); ++i) {
    const double error = last.errors[i];
    const bool fails =
        std::all_of(differences.begin(), differences.end(), [&](const difference& d) {
          return i < d.errors.size() && d.errors[i] > d.allowed;
        });
    if (fails && error >= differences.front().errors[i] / 2 && (!result || error > result->error)) {
      result = {i, error, last.allowed, differences.size() > 1 && last.ulps_in_shorter > 1};
    }
  }
  if (result && result->is_short) {
    result->may_be_rounding =
        last.common_ulps() < std::pow(10.0, std::min(last.digits[0], last.digits[1]) / 2.0);
  }
  return result;
}

/// True if all components are finite in both results or in neither, in every precision.
[[nodiscard]] inline bool all_finite(std::span<const difference> differences) {
  return std::all_of(differences.begin(), differences.end(),
                     [](const difference& d) { return d.is_finite; });
}

/// Verdict on the finite components, from the differences in several precisions, the least precise
/// first.
///
/// Round-off shrinks with ε. A slip is visible in every scalar, and stays constant.
[[nodiscard]] inline verdict judged(std::span<const difference> differences, double tolerance) {
  return suspected(differences) ? verdict::disagrees
         : std::any_of(differences.begin(), differences.end(),
                       [&](const difference& d) { return d.common_ulps() > tolerance; })
             ? verdict::loses_precision
             : verdict::agrees;
}

/// True if the error of a component at a point is a slip. It may be round-off that leaves no digit
/// in any precision, as that of 1 − cos x at 1e-12, or that is by chance the same in two.
///
/// Towards another point, at distances that grow from 2e-16 on, errors are the same in the first
/// and the last precision for a while. If the error is round-off, the last precision then begins to
/// have digits, and its error shrinks gradually. That of a slip vanishes at once, or stays to the
/// end.
///
/// \param pair  a formula_pair of several precisions
template <class Pair>
[[nodiscard]] bool is_slip(const Pair& pair, const coordinates& point, const suspect& at_point,
                           const coordinates& other) {
  double error = at_point.error, inside = 0, outside = 0x1p-52;
  const auto at = [&](double s) {
    coordinates between = point;
    for (std::size_t i = 0; i < point.size(); ++i) {
      between[i] += s * (other[i] - point[i]);
    }
    // Excluded points carry no information.
    return pair.contains(between) ? pair.errors_at(between, at_point.component)
                                  : std::array{error, error};
  };
  const auto stays = [&](double s) {
    const auto [first, last] = at(s);
    const bool same = first > 0 && last >= first / 2;
    error = same ? last : error;
    return same;
  };
  for (; outside < 1 && stays(outside); outside *= 8) {
    inside = outside;
  }
  if (outside >= 1) {
    return !at_point.may_be_rounding;
  }
  for (int i = 0; i < 5 && inside > 0; ++i) {
    const double middle = std::sqrt(inside * outside);
    (stays(middle) ? inside : outside) = middle;
  }
  double beyond = 0;
  for (int i = 0; i < 12; ++i) {
    beyond = std::max(beyond, at(std::min(1.0, outside * (1 + i / 11.0)))[1]);
    if (at_point.is_short) { // its round-off does not shrink, but occasionally vanishes
      beyond = std::max(beyond, at(std::min(1.0, outside * std::exp2(i / 2.0)))[1]);
    }
  }
  // An error at one point alone may be chance, unless the formula is right near it.
  return beyond < error / 8 && (inside > 0 || beyond <= 8 * at_point.allowed);
}

[[nodiscard]] inline std::string scalar_name(int digits) {
  return digits == std::numeric_limits<float>::digits10    ? "float"
         : digits == std::numeric_limits<double>::digits10 ? "double"
         : digits == std::numeric_limits<long double>::digits10
             ? "long double"
             : "numbers of " + std::to_string(digits) + " digits";
}

/// Names the function that returned fewer digits than its arguments have, and the remedy.
[[nodiscard]] inline std::string precision_note(int digits, const difference& d) {
  const bool first = d.digits[0] < digits, second = d.digits[1] < digits;
  return std::string(first && second ? "both functions"
                     : first         ? "the first function"
                                     : "the second function") +
         " returned " + scalar_name(std::min(d.digits[0], d.digits[1])) + " where " +
         (first && second ? "their" : "its") + " arguments were " + scalar_name(digits) +
         ": a constant made it so, as the 0.0 of derivative(f, 0.0): write T(0)";
}

/// Records in c that fewer digits were decisive, and counts errors in those.
///
/// \param shorter  for every precision, as measured for the points at which it was decisive;
///   unchanged if there are none
inline void count_in_shorter(comparison& c, std::span<const difference> shorter) {
  for (std::size_t k = 0; k < shorter.size(); ++k) {
    if (shorter[k].ulps_in_shorter > 1) {
      c.errors[k].ulps /= shorter[k].ulps_in_shorter;
      c.errors[k].compared_digits = std::min(shorter[k].digits[0], shorter[k].digits[1]);
      c.note = precision_note(c.errors[k].digits, shorter[k]);
    }
  }
}

/// Result type of a function of the inputs.
template <class T, class F, class Inputs>
using result_type = decltype(result_of_call(
    std::apply(std::declval<const F&>(),
               std::declval<const Inputs&>().template make<T>(std::span<const double>()))));

/// True if F takes the arguments that inputs make over the first of the scalars T.
template <class F, class Arguments>
inline constexpr bool takes = false;
template <class F, class... X>
inline constexpr bool takes<F, std::tuple<X...>> = std::is_invocable_v<const F&, X...>;
template <class F, class Inputs, class T, class... More>
inline constexpr bool takes_inputs =
    takes<F, decltype(std::declval<const Inputs&>().template make<T>(std::span<const double>()))>;

/// Two formulas and their inputs. The code common to all comparisons does not depend on their
/// types, so that it is compiled once.
struct formula_pair {
  function_reference<bool(const coordinates& point)> contains;
  function_reference<std::string(const coordinates& point)> describe;
  /// Differences at a point in every precision.
  function_reference<void(const coordinates& point, std::span<difference>)> measure_at;
  /// Errors of a component, in the first and the last precision; NaN if one result is not finite.
  function_reference<std::array<double, 2>(const coordinates& point, std::size_t)> errors_at;
  function_reference<counterexample(const coordinates& point)> values_at;
};

/// Error of a component of the result over T.
template <class T, class F, class G, class Inputs>
[[nodiscard]] double error_at(const F& automatic, const G& closed_form, const Inputs& inputs,
                              const coordinates& point, std::size_t component) {
  const auto errors = errors_of(evaluate_at<T>(automatic, inputs, point),
                                evaluate_at<T>(closed_form, inputs, point));
  return component < errors.size() ? static_cast<double>(errors[component]) : 0.0;
}

/// \param errors  of every precision, with only their digits filled in
/// \tparam Pair   formula_pair
template <class Pair>
[[nodiscard]] comparison
compared(const std::string& label, const Pair& pair, const std::vector<coordinates>& points,
         std::vector<worst_errors> errors, const comparison_options& options) {
  struct sample {
    std::size_t point;
    double ulps;
    suspect error;
  };
  std::vector<difference> differences(errors.size());
  comparison result;
  result.label = label;
  result.samples = points.size();
  result.tolerance = options.tolerance;
  result.errors = std::move(errors);
  std::array<sample, 5> worst{}; // worst sample of every verdict
  std::vector<sample> suspects;
  bool rounds = false; // by more than is allowed, in the first precision
  std::vector<difference> shorter(differences.size()); // measured with fewer digits, if decisive
  const auto count = [&](verdict judgement, const sample& s) {
    sample& w = worst[std::size_t(judgement)];
    w = ++result.counts[std::size_t(judgement)] == 1 || s.ulps > w.ulps ? s : w;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    pair.measure_at(points[i], differences);
    sample current{i, 0, {}};
    for (std::size_t k = 0; k < differences.size(); ++k) {
      worst_errors& largest = result.errors[k];
      largest.absolute = std::max(largest.absolute, differences[k].absolute);
      largest.relative = std::max(largest.relative, differences[k].relative);
      if (differences[k].ulps > largest.ulps) {
        largest.ulps = differences[k].ulps;
        largest.input = pair.describe(points[i]);
      }
      current.ulps = std::max(current.ulps, differences[k].common_ulps());
      if (differences[k].ulps_in_shorter > 1 && differences[k].ulps > options.tolerance) {
        shorter[k] = differences[k];
      }
    }
    const verdict judgement = judged(differences, options.tolerance);
    if (judgement == verdict::disagrees) {
      current.error = *suspected(differences);
      suspects.push_back(current);
    }
    rounds = rounds || (judgement == verdict::loses_precision &&
                        differences.front().common_ulps() > options.tolerance);
    if (!all_finite(differences)) {
      count(verdict::not_finite, current);
    } else if (judgement != verdict::disagrees) {
      count(judgement, current);
    }
    const progress now{i + 1, points.size()};
    if (options.report && !options.report(now) && now.done < now.count) {
      raise(cancelled(now));
    }
  }
  const auto is_slip_at = [&](const coordinates& point, const suspect& s) {
    return differences.size() < 2 || is_slip(pair, point, s, points.back());
  };
  // The largest first, until one is a slip: then all are that cannot be round-off.
  std::sort(suspects.begin(), suspects.end(), [](const sample& a, const sample& b) {
    return a.ulps == b.ulps ? a.point < b.point : a.ulps > b.ulps;
  });
  bool has_slip = false;
  for (const sample& s : suspects) {
    const bool is_slip = has_slip ? !s.error.may_be_rounding : is_slip_at(points[s.point], s.error);
    has_slip = has_slip || is_slip;
    rounds = rounds || !is_slip;
    count(is_slip ? verdict::disagrees : verdict::loses_precision, s);
  }
  count_in_shorter(result, shorter);
  for (const verdict v : {verdict::loses_precision, verdict::not_finite, verdict::disagrees}) {
    result.outcome = result.counts[std::size_t(v)] > 0 ? v : result.outcome;
  }
  if (result.outcome != verdict::agrees) {
    const coordinates simplest = simplified(
        points[worst[std::size_t(result.outcome)].point],
        [&](const coordinates& point) { return pair.contains(point); },
        [&](const coordinates& point) {
          pair.measure_at(point, differences);
          const std::optional<suspect> s = suspected(differences);
          return result.outcome == verdict::not_finite  ? !all_finite(differences)
                 : result.outcome == verdict::disagrees ? s && (!rounds || is_slip_at(point, *s))
                 : s                                    ? !is_slip_at(point, *s)
                     : judged(differences, options.tolerance) == result.outcome;
        });
    result.simplest = pair.values_at(simplest);
    pair.measure_at(simplest, differences);
    result.simplest->difference = std::max_element(differences.begin(), differences.end(),
                                                   [](const difference& a, const difference& b) {
                                                     return a.common_ulps() < b.common_ulps();
                                                   })
                                      ->absolute;
  }
  return result;
}

} // namespace detail

/// Compares two functions over special and random inputs, in several precisions.
///
/// A failing input is simplified, coordinate by coordinate, to the simplest one that still gets the
/// same verdict. Deterministic for a given seed.
///
/// \tparam T  the scalars, the least precise first; `double` and `long double` by default. A scalar
///   of many digits (`real_50` of interop/multiprecision.hpp) separates errors of a formula from
///   round-off best.
/// \param label        name of the comparison in the report
/// \param automatic    the reference: usually a function of duet's drivers
/// \param closed_form  the function under test; both are templates over the scalar of their
///   arguments and return the same number of components
/// \param inputs       a `sampler` of their arguments
/// \throws invalid_input if the two return different numbers of components
/// \throws cancelled if `options.report` returned `false`
///
/// Example: `compare("d sin", [](auto x) { return derivative([](auto t) { return sin(t); }, x)
/// .derivative; }, [](auto x) { return cos(x); }, sampler(real_numbers{-3, 3}))`
template <class... T, class F, class G, class Inputs>
[[nodiscard]] comparison compare(const std::string& label, const F& automatic, const G& closed_form,
                                 const Inputs& inputs, const comparison_options& options = {}) {
  if constexpr (sizeof...(T) == 0) {
    return compare<double, long double>(label, automatic, closed_form, inputs, options);
  } else {
    using results [[maybe_unused]] = // checked first, so that compilers name the caller's line
        std::tuple<detail::result_type<T, F, Inputs>..., detail::result_type<T, G, Inputs>...>;
    using scalars = std::tuple<T...>;
    using first = std::tuple_element_t<0, scalars>;
    using last = std::tuple_element_t<sizeof...(T) - 1, scalars>;
    const auto contains = [&](const coordinates& point) { return inputs.contains(point); };
    const auto describe = [&](const coordinates& point) { return inputs.describe(point); };
    const auto measure_at = [&](const coordinates& point, std::span<detail::difference> out) {
      std::size_t k = 0;
      ((out[k++] =
            detail::measure<T>(label, automatic, closed_form, inputs, point, options.tolerance)),
       ...);
    };
    const auto errors_at = [&](const coordinates& point, std::size_t component) {
      return std::array{detail::error_at<first>(automatic, closed_form, inputs, point, component),
                        detail::error_at<last>(automatic, closed_form, inputs, point, component)};
    };
    const auto values_at = [&](const coordinates& point) {
      return counterexample{describe(point), detail::evaluate_at<double>(automatic, inputs, point),
                            detail::evaluate_at<double>(closed_form, inputs, point)};
    };
    return detail::compared<detail::formula_pair>(
        label, {contains, describe, measure_at, errors_at, values_at},
        inputs.points(options.samples, options.seed),
        {worst_errors{.digits = std::numeric_limits<T>::digits10}...}, options);
  }
}

template <class... T, class F, class G, InputDomain Inputs>
DUET_REFUSED(
    "compare: the arguments must come from a sampler: compare(label, f, g, sampler(real_numbers{0, "
    "1}))")
comparison
    compare(const std::string&, const F&, const G&, const Inputs&, const comparison_options& = {});
template <class... T, class F, class G, class... Domains>
  requires(!detail::takes_inputs<F, sampler<Domains...>, T..., double> ||
           !detail::takes_inputs<G, sampler<Domains...>, T..., double>)
DUET_REFUSED("compare: both functions must take one argument of each domain of the sampler: "
             "f(v, t) with sampler(vectors<3>{1.0}, real_numbers{0, 1})")
comparison compare(const std::string&, const F&, const G&, const sampler<Domains...>&,
                   const comparison_options& = {});

} // namespace duet
