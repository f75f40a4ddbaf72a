// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/comparison/domain.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/structure.hpp>
#include <duet/derivative/function.hpp>

#include <algorithm>
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

/// The scalars of a result in a row.
template <class T, class Y>
[[nodiscard]] std::vector<T> components_of(const Y& y) {
  std::vector<T> components;
  static_cast<void>(map_scalars(
      [&](const auto& s) {
        static_assert(Real<std::decay_t<decltype(s)>> || Arithmetic<std::decay_t<decltype(s)>>,
                      "duet: compare: a compared function must return plain numbers; take the "
                      "derivative out of what the driver returned");
        components.push_back(T(s));
        return s;
      },
      y));
  return components;
}

/// f at the point, in the precision of T.
template <class T, class F, class Inputs>
[[nodiscard]] std::vector<T> evaluate_at(const F& f, const Inputs& inputs,
                                         std::span<const double> point) {
  return components_of<T>(result_of_call(std::apply(f, inputs.template make<T>(point))));
}

/// The difference of two results in one precision.
struct difference {
  bool is_finite = true; ///< no component is infinite or NaN in one result only
  double absolute = 0;
  double relative = 0;
  double ulps = 0;
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
  const std::vector<T> a = evaluate_at<T>(automatic, inputs, point);
  const std::vector<T> b = evaluate_at<T>(closed_form, inputs, point);
  require(a.size() == b.size(), "duet: compare \"", label, "\": the automatic result has ",
          a.size(), " components, the closed form ", b.size());
  const T d = distance(a, b);
  if (d < 0) {
    return {.is_finite = false};
  }
  difference result;
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
