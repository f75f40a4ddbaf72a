// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/comparison/domain.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/structure.hpp>
#include <duet/derivative/function.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

/// \file
/// How far two functions differ at one point.

namespace duet::detail {

/// The least decimal digits of some numbers, and the ε of those.
struct precision {
  int digits = 0;
  double epsilon = 0;
};

template <class T>
[[nodiscard]] precision precision_of() {
  return {std::numeric_limits<T>::digits10, static_cast<double>(std::numeric_limits<T>::epsilon())};
}

/// The scalars of a result in a row.
/// \param coarsest  becomes that of the result's real numbers where it is less
template <class T, class Y>
[[nodiscard]] std::vector<T> components_of(const Y& y, precision& coarsest) {
  std::vector<T> components;
  static_cast<void>(map_scalars(
      [&](const auto& s) {
        using scalar = std::decay_t<decltype(s)>;
        static_assert(Real<scalar> || Arithmetic<scalar>,
                      "duet: compare: a compared function must return plain numbers; take the "
                      "derivative out of what the driver returned");
        if constexpr (Real<scalar>) { // whole numbers are exact
          if (std::numeric_limits<scalar>::digits10 < coarsest.digits) {
            coarsest = precision_of<scalar>();
          }
        }
        components.push_back(T(s));
        return s;
      },
      y));
  return components;
}

template <class T, class Y>
[[nodiscard]] std::vector<T> components_of(const Y& y) {
  precision ignored;
  return components_of<T>(y, ignored);
}

/// f at the point, in the precision of T.
template <class T, class F, class Inputs>
[[nodiscard]] std::vector<T> evaluate_at(const F& f, const Inputs& inputs,
                                         std::span<const double> point, precision& coarsest) {
  return components_of<T>(result_of_call(std::apply(f, inputs.template make<T>(point))), coarsest);
}
template <class T, class F, class Inputs>
[[nodiscard]] std::vector<T> evaluate_at(const F& f, const Inputs& inputs,
                                         std::span<const double> point) {
  precision ignored;
  return evaluate_at<T>(f, inputs, point, ignored);
}

/// The difference of two results in one precision.
struct difference {
  bool is_finite = true; ///< no component is infinite or NaN in one result only
  double absolute = 0;
  double relative = 0;
  double ulps = 0; ///< of the arguments' scalar
  /// How many of them are one of the shorter result, and the decimal digits of both.
  double ulps_in_shorter = 1;
  std::array<int, 2> digits{};

  /// What counts: the error in units that both results have.
  [[nodiscard]] double common_ulps() const { return ulps / ulps_in_shorter; }
};

template <class T>
[[nodiscard]] T largest(const std::vector<T>& components) {
  using std::abs;
  T result(0);
  for (const T& x : components) {
    if (abs(x) > result) {
      result = abs(x);
    }
  }
  return result;
}

/// max |a − b|, or −1 where exactly one of two components is finite. What is not finite in both
/// does not count.
template <class T>
[[nodiscard]] T distance(const std::vector<T>& a, const std::vector<T>& b) {
  using std::abs;
  using std::isfinite;
  T result(0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (isfinite(a[i]) != isfinite(b[i])) {
      return T(-1);
    }
    if (isfinite(a[i]) && abs(T(a[i] - b[i])) > result) {
      result = abs(T(a[i] - b[i]));
    }
  }
  return result;
}

/// ‖f′‖‖x‖: how much f changes, per relative change of its arguments. The smaller of both one-sided
/// differences, so that a jump or a kink does not excuse an error beside it.
template <class T, class F, class Inputs>
[[nodiscard]] T sensitivity(const F& f, const Inputs& inputs, std::span<const double> point,
                            const std::vector<T>& value) {
  constexpr double step = 0x1p-20;
  double size = 0;
  for (const double x : point) {
    size = std::max(size, std::abs(x));
  }
  T sum(0);
  for (std::size_t i = 0; i < point.size() && size > 0; ++i) {
    T change(-1);
    for (const double h : {step * size, -step * size}) {
      coordinates moved(point.begin(), point.end());
      moved[i] += h;
      if (inputs.contains(moved)) {
        const T d = distance(evaluate_at<T>(f, inputs, moved), value);
        change = change < 0 || (d >= 0 && d < change) ? d : change;
      }
    }
    if (change > 0) {
      sum += change / T(step);
    }
  }
  return sum;
}

/// The difference of `automatic` and `closed_form` at a point, over T.
template <class T, class F, class G, class Inputs>
[[nodiscard]] difference measure(const std::string& label, const F& automatic, const G& closed_form,
                                 const Inputs& inputs, std::span<const double> point,
                                 double tolerance) {
  std::array precisions = {precision_of<T>(), precision_of<T>()};
  const std::vector<T> a = evaluate_at<T>(automatic, inputs, point, precisions[0]);
  const std::vector<T> b = evaluate_at<T>(closed_form, inputs, point, precisions[1]);
  require(a.size() == b.size(), "duet: compare \"", label, "\": the automatic result has ",
          a.size(), " components, the closed form ", b.size());
  difference result;
  result.digits = {precisions[0].digits, precisions[1].digits};
  result.ulps_in_shorter =
      std::max(precisions[0].epsilon, precisions[1].epsilon) / precision_of<T>().epsilon;
  const T d = distance(a, b);
  if (d < 0) {
    result.is_finite = false;
    return result;
  }
  const T half_epsilon = std::numeric_limits<T>::epsilon() / 2;
  T scale = largest(a);
  const auto ratio = [](const T& x, const T& y) {
    return x > 0 ? (y > 0 ? static_cast<double>(T(x / y)) : std::numeric_limits<double>::infinity())
                 : 0.0;
  };
  result.absolute = static_cast<double>(d);
  result.relative = ratio(d, scale);
  result.ulps = ratio(d, T(half_epsilon * scale));
  if (result.ulps > tolerance) {
    scale += sensitivity(automatic, inputs, point, a);
    result.ulps = ratio(d, T(half_epsilon * scale));
  }
  return result;
}

} // namespace duet::detail
