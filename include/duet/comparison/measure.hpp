// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/comparison/domain.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/structure.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual/eigen_traits.hpp>

#include <Eigen/Core>

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
/// Difference of two functions at one point.

namespace duet::detail {

/// Rows and columns of a matrix with more than one of each; otherwise the count of numbers, in one
/// column for a vector of Eigen, in no column for elements or parts of something else.
struct shape {
  Eigen::Index rows = 0;
  Eigen::Index columns = 0;

  [[nodiscard]] bool is_matrix() const { return columns > 1; }
};

/// Makeup of a result: the fewest decimal digits of its numbers, their ε, and its shapes, in the
/// order of its components.
struct makeup {
  int digits = 0;
  double epsilon = 0;
  std::vector<shape> shapes{};

  void append(shape s) {
    if (s.rows == 1 || s.columns == 1) {
      s = {s.rows * std::max<Eigen::Index>(s.columns, 1), s.columns > 0 ? 1 : 0};
    }
    if (!s.is_matrix() && !shapes.empty() && !shapes.back().is_matrix()) {
      shapes.back() = {shapes.back().rows + s.rows, 0};
    } else {
      shapes.push_back(s);
    }
  }
};

/// True if the matrices of both results agree in position and shape. An object that is neither a
/// matrix nor a vector of Eigen fits any shape.
[[nodiscard]] inline bool fit(const makeup& a, const makeup& b) {
  const auto has_any = [](const makeup& m) {
    return m.shapes.empty() || (m.shapes.size() == 1 && m.shapes[0].columns == 0);
  };
  return has_any(a) || has_any(b) ||
         std::equal(a.shapes.begin(), a.shapes.end(), b.shapes.begin(), b.shapes.end(),
                    [](const shape& s, const shape& t) {
                      return s.rows == t.rows && s.is_matrix() == t.is_matrix() &&
                             (!s.is_matrix() || s.columns == t.columns);
                    });
}

/// "3 x 4 and 2 numbers"
[[nodiscard]] inline std::string shapes_text(const makeup& m) {
  std::string text;
  for (const shape& s : m.shapes) {
    text += (text.empty() ? "" : " and ") + std::to_string(s.rows) +
            (s.is_matrix() ? " x " + std::to_string(s.columns) : " numbers");
  }
  return text;
}

template <class T>
[[nodiscard]] makeup makeup_of() {
  return {std::numeric_limits<T>::digits10, static_cast<double>(std::numeric_limits<T>::epsilon())};
}

/// Calls visit(x) for every matrix, and every object that is not a container, in y.
template <class Y, class Visit>
void for_each_shaped(const Y& y, const Visit& visit) {
  if constexpr (!EigenMatrix<Y> && requires { std::tuple_size<Y>::value; }) {
    std::apply([&](const auto&... x) { (for_each_shaped(x, visit), ...); }, y);
  } else if constexpr (requires { y.get_allocator(); }) {
    for (const auto& x : y) {
      for_each_shaped(x, visit);
    }
  } else {
    visit(y);
  }
}

/// The scalars of a result in a row.
///
/// \param makeup_of_result  its makeup, if wanted; fewer digits, if it had them, are kept
template <class T, class Y>
[[nodiscard]] std::vector<T> components_of(const Y& y, makeup* makeup_of_result = nullptr) {
  makeup ignored;
  makeup& properties = makeup_of_result != nullptr ? *makeup_of_result : ignored;
  std::vector<T> components;
  for_each_shaped(y, [&](const auto& x) {
    const std::size_t first = components.size();
    static_cast<void>(map_scalars(
        [&](const auto& s) {
          using scalar = std::decay_t<decltype(s)>;
          static_assert(Real<scalar> || Arithmetic<scalar>,
                        "duet: compare: a compared function must return plain numbers; take the "
                        "derivative out of what the driver returned");
          if constexpr (Real<scalar>) { // integers are exact
            if (std::numeric_limits<scalar>::digits10 < properties.digits) {
              properties.digits = std::numeric_limits<scalar>::digits10;
              properties.epsilon = static_cast<double>(std::numeric_limits<scalar>::epsilon());
            }
          }
          components.push_back(T(s));
          return s;
        },
        x));
    if constexpr (EigenMatrix<std::decay_t<decltype(x)>>) {
      properties.append({x.rows(), x.cols()});
    } else if constexpr (!std::is_same_v<Y, T>) {
      properties.append({Eigen::Index(components.size() - first), 0});
    }
  });
  return components;
}

/// f at the point, in the precision of T.
template <class T, class F, class Inputs>
[[nodiscard]] std::vector<T> evaluate_at(const F& f, const Inputs& inputs,
                                         std::span<const double> point,
                                         makeup* makeup_of_result = nullptr) {
  return components_of<T>(result_of_call(std::apply(f, inputs.template make<T>(point))),
                          makeup_of_result);
}

/// The difference of two results in one precision.
struct difference {
  bool is_finite = true; ///< no component is infinite or NaN in one result only
  double absolute = 0;   ///< over components finite in both, as all that follows
  double relative = 0;
  double ulps = 0; ///< error in units of the last place of the arguments
  /// Number of these units in one unit of the shorter result, and the decimal digits of both.
  double ulps_in_shorter = 1;
  std::array<int, 2> digits{};
  /// Errors of all components if one exceeds the tolerance, and the allowed error.
  std::vector<double> errors{};
  double allowed = 0;

  /// The decisive measure: the error in units that both results have.
  [[nodiscard]] double common_ulps() const { return ulps / ulps_in_shorter; }
};

/// Largest absolute value of a finite component.
template <class Numbers>
[[nodiscard]] auto largest(const Numbers& components) {
  using std::abs;
  using std::isfinite;
  using T = typename Numbers::value_type;
  T result(0);
  for (const T& x : components) {
    if (isfinite(x) && abs(x) > result) {
      result = abs(x);
    }
  }
  return result;
}

/// |a − b| of every component; 0 if neither is finite, NaN if one is.
template <class T>
[[nodiscard]] std::vector<T> errors_of(const std::vector<T>& a, const std::vector<T>& b) {
  using std::abs;
  using std::isfinite;
  std::vector<T> errors;
  errors.reserve(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    errors.push_back(isfinite(a[i]) != isfinite(b[i]) ? std::numeric_limits<T>::quiet_NaN()
                     : isfinite(a[i])                 ? T(abs(T(a[i] - b[i])))
                                                      : T(0));
  }
  return errors;
}

/// ‖f′‖‖x‖: the change of f per relative change of its arguments. The smaller of both one-sided
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
        const T d = largest(errors_of(evaluate_at<T>(f, inputs, moved), value));
        change = change < 0 || d < change ? d : change;
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
  std::array properties = {makeup_of<T>(), makeup_of<T>()};
  const std::vector<T> a = evaluate_at<T>(automatic, inputs, point, &properties[0]);
  const std::vector<T> b = evaluate_at<T>(closed_form, inputs, point, &properties[1]);
  require(a.size() == b.size(), "duet: compare \"", label, "\": the automatic result has ",
          a.size(), " components, the closed form ", b.size());
  if (!fit(properties[0], properties[1])) {
    raise(invalid_input(message("duet: compare \"", label, "\": the automatic result is ",
                                shapes_text(properties[0]), ", the closed form ",
                                shapes_text(properties[1]))));
  }
  difference result;
  result.digits = {properties[0].digits, properties[1].digits};
  result.ulps_in_shorter =
      std::max(properties[0].epsilon, properties[1].epsilon) / makeup_of<T>().epsilon;
  const std::vector<T> errors = errors_of(a, b);
  result.is_finite = std::all_of(errors.begin(), errors.end(), [](const T& e) { return e >= 0; });
  const T d = largest(errors);
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
    result.allowed =
        tolerance * result.ulps_in_shorter * static_cast<double>(T(half_epsilon * scale));
    for (const T& e : errors) {
      result.errors.push_back(static_cast<double>(e));
    }
  }
  return result;
}

} // namespace duet::detail
