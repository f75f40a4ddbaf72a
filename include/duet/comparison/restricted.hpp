// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/random_source.hpp>
#include <duet/core/text/number_text.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Domains of arguments with excluded points.

namespace duet {

/// A point as its coordinates, in which it can be simplified and constructed in any precision.
using coordinates = std::vector<double>;

namespace detail {

/// "(1, 0.5, 0)"
[[nodiscard]] inline std::string tuple_text(std::span<const double> numbers) {
  std::string text = "(";
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    text += (i > 0 ? ", " : "") + to_text(numbers[i]);
  }
  return text + ")";
}

/// Predicate that is true for all points except those within `radius` of this one.
///
/// \throws invalid_input if `centre` does not have `size` coordinates or the radius is negative or
///   NaN
[[nodiscard]] inline std::function<bool(std::span<const double>)>
beyond(coordinates centre, double radius, std::size_t size) {
  require(centre.size() == size, "duet: sampler: the point has ", centre.size(),
          " coordinates, but the arguments have ", size);
  require(radius >= 0, "duet: sampler: the radius is not a number >= 0: ", radius);
  return [centre = std::move(centre), radius](std::span<const double> point) {
    double distance = 0;
    for (std::size_t i = 0; i < centre.size(); ++i) {
      distance = std::hypot(distance, point[i] - centre[i]);
    }
    return distance > radius;
  };
}

/// A random point that is kept.
///
/// \throws invalid_input if a thousand points in a row are rejected
template <class Make, class Keeps, class Describe>
[[nodiscard]] coordinates kept_point(const Make& make, const Keeps& keeps,
                                     const Describe& describe) {
  constexpr int tries = 1000;
  coordinates point = make();
  for (int i = 1; !keeps(point); ++i) {
    if (i == tries) {
      raise(invalid_input(message("duet: sampler: ", tries,
                                  " random inputs in a row are excluded, the last ",
                                  describe(point))));
    }
    point = make();
  }
  return point;
}

} // namespace detail

/// A domain with excluded points: the result of `without` and `where` of every domain.
template <class Domain>
class restricted {
public:
  explicit restricted(Domain domain) : domain_(std::move(domain)) {}

  /// Excludes the point with these coordinates and all points within `radius` of it.
  ///
  /// \throws invalid_input if their number is wrong, or the radius negative
  [[nodiscard]] restricted without(const coordinates& point, double radius = 0) const {
    return and_kept(detail::beyond(point, radius, size()));
  }
  /// Excludes the number x and all numbers within `radius` of it.
  [[nodiscard]] restricted without(double x, double radius = 0) const {
    return without(coordinates{x}, radius);
  }
  /// Excludes the arguments, over `double`, for which `keeps` is false.
  template <class Predicate>
  [[nodiscard]] restricted where(Predicate keeps) const {
    static_assert(
        std::is_invocable_r_v<bool, const Predicate&,
                              decltype(domain_.template make<double>(std::span<const double>()))>,
        "duet: where takes a function of the argument, over double, that returns a bool");
    return and_kept([keeps = std::move(keeps), domain = domain_](std::span<const double> point) {
      return static_cast<bool>(keeps(domain.template make<double>(point)));
    });
  }

  // For those who extend duet: the members that `InputDomain` requires.

  /// The domain that is restricted.
  [[nodiscard]] const Domain& domain() const { return domain_; }
  [[nodiscard]] std::size_t size() const { return domain_.size(); }
  [[nodiscard]] bool contains(std::span<const double> point) const {
    return domain_.contains(point) &&
           std::all_of(keeps_.begin(), keeps_.end(), [&](const auto& k) { return k(point); });
  }
  [[nodiscard]] std::vector<coordinates> special_points() const {
    std::vector<coordinates> points = domain_.special_points();
    std::erase_if(points, [this](const coordinates& point) { return !contains(point); });
    return points;
  }
  /// \throws invalid_input if nothing is left
  [[nodiscard]] coordinates random_point(random_source& random) const {
    return detail::kept_point([&] { return domain_.random_point(random); },
                              [&](const coordinates& point) { return contains(point); },
                              [&](const coordinates& point) { return describe(point); });
  }
  [[nodiscard]] std::string describe(std::span<const double> point) const {
    return domain_.describe(point);
  }
  template <class T>
  [[nodiscard]] auto make(std::span<const double> point) const {
    return domain_.template make<T>(point);
  }

private:
  [[nodiscard]] restricted and_kept(std::function<bool(std::span<const double>)> keeps) const {
    restricted result = *this;
    result.keeps_.push_back(std::move(keeps));
    return result;
  }

  Domain domain_;
  std::vector<std::function<bool(std::span<const double>)>> keeps_;
};

} // namespace duet
