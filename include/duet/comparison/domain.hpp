// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/random_source.hpp>
#include <duet/core/text/number_text.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Where the arguments of a compared function come from.

namespace duet {

/// A point as its coordinates, over which it can be simplified and made in any precision.
using coordinates = std::vector<double>;

/// A kind of argument: how many coordinates it has, which of them are in its range, the points that
/// formulas stumble over, and how an argument over T is made of coordinates.
template <class D>
concept InputDomain = requires(const D& domain, random_source& random,
                               std::span<const double> point) {
  { domain.size() } -> std::convertible_to<std::size_t>;
  { domain.contains(point) } -> std::same_as<bool>;
  { domain.special_points() } -> std::same_as<std::vector<coordinates>>;
  { domain.random_point(random) } -> std::same_as<coordinates>;
  { domain.describe(point) } -> std::convertible_to<std::string>;
  domain.template make<double>(point);
};

namespace detail {

/// "(1, 0.5, 0)"
[[nodiscard]] inline std::string tuple_text(std::span<const double> numbers) {
  std::string text = "(";
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    text += (i > 0 ? ", " : "") + to_text(numbers[i]);
  }
  return text + ")";
}

} // namespace detail

/// A real number in [lower, upper]. Special: the ends, the integers and halves of small size in
/// between, and numbers within 1e-8 of zero.
struct real_numbers {
  double lower = -1; ///< the least number
  double upper = 1;  ///< the largest number

  // For those who extend duet: what an `InputDomain` is asked.

  [[nodiscard]] std::size_t size() const { return 1; }
  [[nodiscard]] bool contains(std::span<const double> point) const {
    return point[0] >= lower && point[0] <= upper;
  }
  [[nodiscard]] std::vector<coordinates> special_points() const {
    std::vector<coordinates> points;
    for (const double x : {lower, upper, 0.0, 0.5, -0.5, 1.0, -1.0, 2.0, -2.0, 3.0, 1e-8, -1e-4}) {
      if (contains(std::array{x})) {
        points.push_back({x});
      }
    }
    return points;
  }
  [[nodiscard]] coordinates random_point(random_source& random) const {
    return {random.uniform(lower, upper)};
  }
  [[nodiscard]] std::string describe(std::span<const double> point) const {
    return to_text(point[0]);
  }
  template <class T>
  [[nodiscard]] T make(std::span<const double> point) const {
    return T(point[0]);
  }
};

/// A vector of N components between −bound and bound. Special: zero, vectors along the axes and
/// diagonals, and vectors of length 1e-4 and 1e-8. Every fourth random one is short.
template <int N>
struct vectors {
  double bound = 1; ///< the largest size of a component

  // For those who extend duet: what an `InputDomain` is asked.

  [[nodiscard]] std::size_t size() const { return std::size_t(N); }
  [[nodiscard]] bool contains(std::span<const double> point) const {
    return std::all_of(point.begin(), point.end(),
                       [this](double x) { return std::abs(x) <= bound; });
  }
  [[nodiscard]] std::vector<coordinates> special_points() const {
    std::vector<coordinates> points = {coordinates(std::size_t(N), 0.0),
                                       coordinates(std::size_t(N), bound / 2)};
    for (const double length : {bound, -bound, 1e-4 * bound, 1e-8 * bound}) {
      for (std::size_t axis = 0; axis < std::size_t(N); ++axis) {
        points.emplace_back(std::size_t(N), 0.0);
        points.back()[axis] = length;
      }
    }
    return points;
  }
  [[nodiscard]] coordinates random_point(random_source& random) const {
    const double size = random.integer(0, 3) == 0 ? random.magnitude(1e-8, 1) : 1.0;
    coordinates point;
    for (int i = 0; i < N; ++i) {
      point.push_back(bound * size * random.uniform(-1, 1));
    }
    return point;
  }
  [[nodiscard]] std::string describe(std::span<const double> point) const {
    return detail::tuple_text(point);
  }
  template <class T>
  [[nodiscard]] Eigen::Matrix<T, N, 1> make(std::span<const double> point) const {
    Eigen::Matrix<T, N, 1> result;
    for (int i = 0; i < N; ++i) {
      result[i] = T(point[std::size_t(i)]);
    }
    return result;
  }
};

/// N arguments of one kind, as a `std::array`. Special: all of them the same special point.
template <std::size_t N, class Domain>
struct arrays {
  Domain element; ///< that of each argument

  // For those who extend duet: what an `InputDomain` is asked.

  [[nodiscard]] std::size_t size() const { return N * element.size(); }
  [[nodiscard]] bool contains(std::span<const double> point) const {
    for (std::size_t i = 0; i < N; ++i) {
      if (!element.contains(part(point, i))) {
        return false;
      }
    }
    return true;
  }
  [[nodiscard]] std::vector<coordinates> special_points() const {
    std::vector<coordinates> points;
    for (const coordinates& special : element.special_points()) {
      coordinates point;
      for (std::size_t i = 0; i < N; ++i) {
        point.insert(point.end(), special.begin(), special.end());
      }
      points.push_back(point);
    }
    return points;
  }
  [[nodiscard]] coordinates random_point(random_source& random) const {
    coordinates point;
    for (std::size_t i = 0; i < N; ++i) {
      const coordinates one = element.random_point(random);
      point.insert(point.end(), one.begin(), one.end());
    }
    return point;
  }
  [[nodiscard]] std::string describe(std::span<const double> point) const {
    std::string text = "{";
    for (std::size_t i = 0; i < N; ++i) {
      text += (i > 0 ? ", " : "") + element.describe(part(point, i));
    }
    return text + "}";
  }
  template <class T>
  [[nodiscard]] auto make(std::span<const double> point) const {
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
      return std::array{element.template make<T>(part(point, I))...};
    }
    (std::make_index_sequence<N>{});
  }

private:
  [[nodiscard]] std::span<const double> part(std::span<const double> point, std::size_t i) const {
    return point.subspan(i * element.size(), element.size());
  }
};

} // namespace duet
