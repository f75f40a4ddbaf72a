// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <ostream>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>

/// \file
/// Errors in units of the last place, normwise: |error| / (2⁻⁵³ (‖f‖ + ‖f′‖‖x‖)).
///
/// Rounding the input alone costs ‖f′‖‖x‖ ulps, so no algorithm can do better than a few of these.
/// For sums take the sum of the absolute terms as ‖f‖; a dual part is measured on its own scale.
///
/// Use: compute `exact`, `df` in a wider type (support/multiprecision.hpp), then
/// ```
/// worst_error worst("sin");
/// worst.add(ulps(y, exact, scale(exact, df, x)), x);
/// CHECK_MESSAGE(worst <= 16, worst);
/// ```

namespace duet_test {

/// ‖f‖ + ‖f′‖‖x‖, all absolute values or norms.
template <class Wide>
[[nodiscard]] Wide scale(const Wide& f, const Wide& df, const Wide& x) {
  using std::abs;
  return Wide(abs(f) + abs(Wide(df * x)));
}

/// ‖a − b‖ / (unit roundoff of Real · scale), for an error norm computed in the wider type.
///
/// One unit is never smaller than the least denormal: below it nothing can be represented.
template <class Real = double, class Wide>
[[nodiscard]] double ulps_of_error(const Wide& error, const Wide& scale) {
  using std::abs, std::max;
  const Wide roundoff = Wide(std::numeric_limits<Real>::epsilon()) / 2;
  const Wide least = Wide(std::numeric_limits<Real>::denorm_min());
  const Wide unit = max(Wide(roundoff * abs(scale)), least);
  return error == 0 ? 0 : static_cast<double>(Wide(abs(error) / unit));
}

/// Error of one number. What overflows in Real must be that infinity; NaN counts as infinitely
/// wrong.
template <class Real, class Wide>
[[nodiscard]] double ulps(const Real& computed, const Wide& exact, const Wide& scale) {
  static_assert(!std::is_same_v<Real, Wide>, "the truth must be computed in a wider type");
  using std::abs;
  const auto infinite = std::numeric_limits<double>::infinity();
  if (!(computed == computed) || !(exact == exact)) {
    return infinite;
  }
  const Wide largest = Wide((std::numeric_limits<Real>::max)());
  if (abs(computed) > (std::numeric_limits<Real>::max)()) {
    const bool overflows = abs(exact) > largest * (1 - Wide(std::numeric_limits<Real>::epsilon()));
    return overflows && (computed > 0) == (exact > 0) ? 0 : infinite;
  }
  return ulps_of_error<Real>(Wide(Wide(computed) - exact), scale);
}

/// Error of a vector of any kind, by its Euclidean norm; `scale` as for a number.
template <class Real, class Computed, class Exact, class Wide>
[[nodiscard]] double ulps_of_range(const Computed& computed, const Exact& exact,
                                   const Wide& scale) {
  using std::sqrt;
  Wide sum(0);
  auto e = std::begin(exact);
  for (const auto& c : computed) {
    const Wide difference = Wide(c) - Wide(*e++);
    sum += difference * difference;
  }
  return ulps_of_error<Real>(Wide(sqrt(sum)), scale);
}

/// The worst error of many, and where it was.
class worst_error {
public:
  explicit worst_error(std::string label) : label_(std::move(label)) {}

  template <class... Inputs>
  void add(double error, const Inputs&... inputs) {
    ++count_;
    if (!(error <= worst_)) { // NaN too
      std::ostringstream text;
      text.precision(17);
      ((text << " " << inputs), ...);
      worst_ = error == error ? error : std::numeric_limits<double>::infinity();
      where_ = text.str();
    }
  }

  [[nodiscard]] double value() const { return worst_; }
  [[nodiscard]] long count() const { return count_; }

  /// False where nothing was measured, so that an empty loop cannot pass.
  friend bool operator<=(const worst_error& w, double limit) {
    return w.count_ > 0 && w.worst_ <= limit;
  }
  friend std::ostream& operator<<(std::ostream& out, const worst_error& w) {
    return out << w.label_ << ": " << w.worst_ << " ulp of " << w.count_ << " at" << w.where_;
  }

private:
  std::string label_;
  std::string where_;
  double worst_ = 0;
  long count_ = 0;
};

} // namespace duet_test
