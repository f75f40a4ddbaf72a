// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/comparison/comparison.hpp>
#include <duet/comparison/domain.hpp>
#include <duet/comparison/judgement.hpp>
#include <duet/comparison/measure.hpp>
#include <duet/comparison/sampler.hpp>
#include <duet/comparison/simplified.hpp>
#include <duet/core/config.hpp>
#include <duet/core/progress.hpp>
#include <duet/derivative/argument.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Checks a closed-form formula against its automatic derivative.

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

namespace detail {

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
class formula_pair {
public:
  virtual ~formula_pair() = default;
  [[nodiscard]] virtual std::vector<coordinates> points(const comparison_options&) const = 0;
  [[nodiscard]] virtual bool contains(const coordinates& point) const = 0;
  [[nodiscard]] virtual std::string describe(const coordinates& point) const = 0;
  /// Differences at a point in every precision.
  virtual void measure_at(const coordinates& point, std::span<difference> out) const = 0;
  /// Errors of a component, in the first and the last precision; NaN if one result is not finite.
  [[nodiscard]] virtual std::array<double, 2> errors_at(const coordinates& point,
                                                        std::size_t component) const = 0;
  [[nodiscard]] virtual counterexample values_at(const coordinates& point) const = 0;
};

/// \tparam T  the scalars
template <class F, class G, class Inputs, class... T>
class formula_pair_of final : public formula_pair {
public:
  formula_pair_of(const std::string& label, const F& automatic, const G& closed_form,
                  const Inputs& inputs, double tolerance)
      : label_(label), automatic_(automatic), closed_form_(closed_form), inputs_(inputs),
        tolerance_(tolerance) {}

  [[nodiscard]] std::vector<coordinates> points(const comparison_options& options) const override {
    return inputs_.points(options.samples, options.seed);
  }
  [[nodiscard]] bool contains(const coordinates& point) const override {
    return inputs_.contains(point);
  }
  [[nodiscard]] std::string describe(const coordinates& point) const override {
    return inputs_.describe(point);
  }
  void measure_at(const coordinates& point, std::span<difference> out) const override {
    std::size_t k = 0;
    ((out[k++] = measure<T>(label_, automatic_, closed_form_, inputs_, point, tolerance_)), ...);
  }
  [[nodiscard]] std::array<double, 2> errors_at(const coordinates& point,
                                                std::size_t component) const override {
    using scalars = std::tuple<T...>;
    return {error_at<std::tuple_element_t<0, scalars>>(point, component),
            error_at<std::tuple_element_t<sizeof...(T) - 1, scalars>>(point, component)};
  }
  [[nodiscard]] counterexample values_at(const coordinates& point) const override {
    return {describe(point), evaluate_at<double>(automatic_, inputs_, point),
            evaluate_at<double>(closed_form_, inputs_, point)};
  }

private:
  template <class S>
  [[nodiscard]] double error_at(const coordinates& point, std::size_t component) const {
    const auto errors = errors_of(evaluate_at<S>(automatic_, inputs_, point),
                                  evaluate_at<S>(closed_form_, inputs_, point));
    return component < errors.size() ? static_cast<double>(errors[component]) : 0.0;
  }

  const std::string& label_;
  const F& automatic_;
  const G& closed_form_;
  const Inputs& inputs_;
  double tolerance_;
};

/// \param errors  of every precision, with only their digits filled in
/// \tparam Pair   formula_pair
template <class Pair>
[[nodiscard]] comparison compared(const std::string& label, const Pair& pair,
                                  std::vector<worst_errors> errors,
                                  const comparison_options& options) {
  struct sample {
    std::size_t point;
    double ulps;
    suspect error;
  };
  std::vector<difference> differences(errors.size());
  const std::vector<coordinates> points = pair.points(options);
  comparison result;
  result.label = label;
  result.samples = points.size();
  result.tolerance = options.tolerance;
  result.errors = std::move(errors);
  std::array<sample, 4> worst{}; // worst sample of every verdict
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
  std::stable_sort(suspects.begin(), suspects.end(),
                   [](const sample& a, const sample& b) { return a.ulps > b.ulps; });
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
    result.simplest->difference =
        std::max_element(differences.begin(), differences.end(), by_common_ulps)->absolute;
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
    // Checked here, so that compilers name the caller's line: virtual functions are compiled
    // elsewhere.
    using results [[maybe_unused]] =
        std::tuple<detail::result_type<T, F, Inputs>..., detail::result_type<T, G, Inputs>...>;
    const detail::formula_pair_of<F, G, Inputs, T...> pair(label, automatic, closed_form, inputs,
                                                           options.tolerance);
    return detail::compared<detail::formula_pair>(
        label, pair, {worst_errors{.digits = std::numeric_limits<T>::digits10}...}, options);
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
