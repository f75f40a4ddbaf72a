// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/comparison/comparison.hpp>
#include <duet/comparison/domain.hpp>
#include <duet/comparison/judgement.hpp>
#include <duet/comparison/measure.hpp>
#include <duet/comparison/sampler.hpp>
#include <duet/core/compiled.hpp>
#include <duet/core/compiler/refused.hpp>
#include <duet/core/progress.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/derivative/function.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// The judge: is my closed form right?

namespace duet::detail {

/// How much there is to read in a point: nothing for a zero, 1 for a 1, else digits and sign.
[[nodiscard]] inline std::size_t complexity(double x) { return x == 0 ? 0 : to_text(x).size(); }

/// x with so many significant decimal digits.
[[nodiscard]] inline double rounded_to_digits(double x, int digits) {
  if (x == 0 || !std::isfinite(x)) {
    return x;
  }
  // Through a power of ten that is exact, on whichever side of 1.
  const int shift = digits - 1 - int(std::floor(std::log10(std::abs(x))));
  const double power = std::pow(10.0, std::abs(shift));
  return shift >= 0 ? std::round(x * power) / power : std::round(x / power) * power;
}

/// Replaces coordinates by simpler numbers, one after the other, while `fails(point)` stays true.
///
/// Every replacement takes something away that there is to read, so this ends; points are tried in
/// a fixed order, so it ends at the same one every time.
template <class Contains, class Fails>
[[nodiscard]] coordinates simplified(coordinates point, const Contains& contains,
                                     const Fails& fails) {
  bool changed = true;
  while (changed) {
    changed = false;
    for (std::size_t i = 0; i < point.size(); ++i) {
      const double old = point[i];
      for (const double candidate :
           {0.0, 1.0, 2.0, -1.0, 0.5, std::round(old), std::abs(rounded_to_digits(old, 1)),
            rounded_to_digits(old, 1), rounded_to_digits(old, 2), rounded_to_digits(old, 4)}) {
        if (complexity(candidate) >= complexity(old)) {
          continue;
        }
        point[i] = candidate;
        if (contains(point) && fails(point)) {
          changed = true;
          break;
        }
        point[i] = old;
      }
    }
  }
  return point;
}

} // namespace duet::detail

namespace duet {

/// Settings of `compare`.
struct comparison_options {
  std::size_t samples = 1000;    ///< random points; the special ones and the caller's come on top
  std::uint64_t seed = 1;        ///< of the random points; the same seed gives the same result
  double tolerance = 100;        ///< in units of the last place
  progress_callback report = {}; ///< told after every input, may end the run: see `progress_line`
};

namespace detail {

/// What a function makes of the inputs.
template <class T, class F, class Inputs>
using result_type = decltype(result_of_call(
    std::apply(std::declval<const F&>(),
               std::declval<const Inputs&>().template make<T>(std::span<const double>()))));

/// Does F take the arguments that inputs make over the first of the scalars T?
template <class F, class Arguments>
inline constexpr bool takes = false;
template <class F, class... X>
inline constexpr bool takes<F, std::tuple<X...>> = std::is_invocable_v<const F&, X...>;
template <class F, class Inputs, class T, class... More>
inline constexpr bool takes_inputs =
    takes<F, decltype(std::declval<const Inputs&>().template make<T>(std::span<const double>()))>;

/// Two formulas and their inputs, of whose types what is common to all comparisons knows nothing,
/// so that compilers make it once.
class formula_pair {
public:
  virtual ~formula_pair() = default;
  [[nodiscard]] virtual std::vector<coordinates> points(const comparison_options&) const = 0;
  [[nodiscard]] virtual bool contains(const coordinates& point) const = 0;
  [[nodiscard]] virtual std::string describe(const coordinates& point) const = 0;
  /// In every precision.
  virtual void measure_at(const coordinates& point, std::span<difference> out) const = 0;
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
  [[nodiscard]] counterexample values_at(const coordinates& point) const override {
    return {describe(point), evaluate_at<double>(automatic_, inputs_, point),
            evaluate_at<double>(closed_form_, inputs_, point)};
  }

private:
  const std::string& label_;
  const F& automatic_;
  const G& closed_form_;
  const Inputs& inputs_;
  double tolerance_;
};

/// \param errors  of every precision, nothing being known but their digits
/// \tparam Pair   formula_pair
template <class Pair>
[[nodiscard]] comparison compared(const std::string& label, const Pair& pair,
                                  std::vector<worst_errors> errors,
                                  const comparison_options& options) {
  std::vector<difference> differences(errors.size());
  const std::vector<coordinates> points = pair.points(options);
  comparison result;
  result.label = label;
  result.samples = points.size();
  result.tolerance = options.tolerance;
  result.errors = std::move(errors);
  coordinates worst_point;
  double worst_ulps = -1;
  std::vector<difference> shorter(differences.size()); // where fewer digits were what counted
  for (std::size_t i = 0; i < points.size(); ++i) {
    pair.measure_at(points[i], differences);
    const verdict found = judged(differences, options.tolerance);
    double ulps = 0;
    for (std::size_t k = 0; k < differences.size(); ++k) {
      worst_errors& worst = result.errors[k];
      worst.absolute = std::max(worst.absolute, differences[k].absolute);
      worst.relative = std::max(worst.relative, differences[k].relative);
      if (differences[k].ulps > worst.ulps) {
        worst.ulps = differences[k].ulps;
        worst.input = pair.describe(points[i]);
      }
      ulps = std::max(ulps, differences[k].common_ulps());
      if (differences[k].ulps_in_shorter > 1 && differences[k].ulps > options.tolerance) {
        shorter[k] = differences[k];
      }
    }
    ++result.counts[std::size_t(found)];
    const progress now{i + 1, points.size()};
    if (options.report && !options.report(now) && now.done < now.count) {
      raise(cancelled(now));
    }
    if (found == verdict::agrees) {
      continue;
    }
    if (found > result.outcome || (found == result.outcome && ulps > worst_ulps)) {
      result.outcome = found;
      worst_ulps = ulps;
      worst_point = points[i];
    }
  }
  count_in_shorter(result, shorter);
  if (result.outcome != verdict::agrees) {
    const coordinates simplest = simplified(
        worst_point, [&](const coordinates& point) { return pair.contains(point); },
        [&](const coordinates& point) {
          pair.measure_at(point, differences);
          return judged(differences, options.tolerance) == result.outcome;
        });
    result.simplest = pair.values_at(simplest);
    pair.measure_at(simplest, differences);
    result.simplest->difference =
        std::max_element(differences.begin(), differences.end(), by_common_ulps)->absolute;
  }
  return result;
}

#ifdef DUET_COMPILED
DUET_COMPILED_TEMPLATE comparison compared(const std::string&, const formula_pair&,
                                           std::vector<worst_errors>, const comparison_options&);
#endif

} // namespace detail

/// Compares two functions over special and random inputs, in several precisions.
///
/// \tparam T  the scalars, the least precise first; `double` and `long double` where none is given.
///            A scalar of many digits (`real_50` of interop/multiprecision.hpp) separates best what
///            is wrong from what is merely rounded.
/// \param label        what the report calls the comparison
/// \param automatic    what is taken as right: as a rule a function of duet's drivers
/// \param closed_form  what is judged; both are templates over the scalar of their arguments and
///                     return the same number of components
/// \param inputs       a `sampler` of their arguments
///
/// A failing input is simplified, coordinate by coordinate, to the simplest one that still gets the
/// same verdict. Deterministic for a given seed.
/// \throws invalid_input where the two return different numbers of components; cancelled where
/// `options.report` returned `false`
///
/// Example: `compare("d sin", [](auto x) { return derivative([](auto t) { return sin(t); }, x)
/// .derivative; }, [](auto x) { return cos(x); }, sampler(real_numbers{-3, 3}))`
template <class... T, class F, class G, class Inputs>
[[nodiscard]] comparison compare(const std::string& label, const F& automatic, const G& closed_form,
                                 const Inputs& inputs, const comparison_options& options = {}) {
  if constexpr (sizeof...(T) == 0) {
    return compare<double, long double>(label, automatic, closed_form, inputs, options);
  } else {
    // Asked here, so that compilers name the caller's line: what is virtual they make elsewhere.
    using results [[maybe_unused]] =
        std::tuple<detail::result_type<T, F, Inputs>..., detail::result_type<T, G, Inputs>...>;
    const detail::formula_pair_of<F, G, Inputs, T...> pair(label, automatic, closed_form, inputs,
                                                           options.tolerance);
    return detail::compared<detail::formula_pair>(
        label, pair, {worst_errors{.digits = std::numeric_limits<T>::digits10}...}, options);
  }
}

template <class... T, class F, class G, InputDomain Inputs>
DUET_REFUSED("compare: arguments come from a sampler: compare(label, f, g, sampler(real_numbers{0, "
             "1}))")
comparison
    compare(const std::string&, const F&, const G&, const Inputs&, const comparison_options& = {});
template <class... T, class F, class G, class... Domains>
  requires(!detail::takes_inputs<F, sampler<Domains...>, T..., double> ||
           !detail::takes_inputs<G, sampler<Domains...>, T..., double>)
DUET_REFUSED("compare: both functions take what the sampler gives, an argument of each domain: "
             "f(v, t) with sampler(vectors<3>{1.0}, real_numbers{0, 1})")
comparison compare(const std::string&, const F&, const G&, const sampler<Domains...>&,
                   const comparison_options& = {});

} // namespace duet
