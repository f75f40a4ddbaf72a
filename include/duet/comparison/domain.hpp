// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/constants.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/random_source.hpp>
#include <duet/core/text/number_text.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Domains of the arguments of a compared function, also with excluded points.

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

/// A kind of argument: its number of coordinates, its range, its special points, at which formulas
/// tend to fail (inputs near these follow; the first gets the most of them), and the construction
/// of an argument over T from coordinates. A domain may have `related_points(point, random)`,
/// second arguments that are special in relation to a first one.
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

/// A real number in [lower, upper]. Special: zero, the ends, integers and halves of small size, and
/// multiples of π/2 up to a full turn. Related to x: −x, π − x, and numbers a half or full turn
/// away.
struct real_numbers {
  double lower = -1; ///< lower bound
  double upper = 1;  ///< upper bound

  /// Excludes the number x and all numbers within `radius` of it.
  [[nodiscard]] auto without(double x, double radius = 0) const {
    return restricted(*this).without(coordinates{x}, radius);
  }
  /// Excludes the numbers for which `keeps` is false.
  template <class Predicate>
  [[nodiscard]] auto where(Predicate keeps) const {
    return restricted(*this).where(std::move(keeps));
  }

  // For those who extend duet: the members that `InputDomain` requires.

  [[nodiscard]] std::size_t size() const { return 1; }
  [[nodiscard]] bool contains(std::span<const double> point) const {
    return point[0] >= lower && point[0] <= upper;
  }
  [[nodiscard]] std::vector<coordinates> special_points() const {
    const double pi = constant::pi<double>();
    std::vector<coordinates> points;
    for (const double x : {0.0, lower, upper, 0.5, -0.5, 1.0, -1.0, 2.0, -2.0, 3.0, 1e-8, -1e-4,
                           pi / 2, -pi / 2, pi, -pi, 2 * pi, -2 * pi}) {
      if (contains(std::array{x}) &&
          std::find(points.begin(), points.end(), coordinates{x}) == points.end()) {
        points.push_back({x});
      }
    }
    return points;
  }
  [[nodiscard]] std::vector<coordinates> related_points(std::span<const double> point,
                                                        random_source&) const {
    const double x = point[0], pi = constant::pi<double>();
    return {{-x}, {pi - x}, {x + pi}, {x - pi}, {x + 2 * pi}, {x - 2 * pi}};
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

/// A vector of N components between −bound and bound. Special: zero, a corner, vectors along the
/// axes and the diagonal, of length 1e-4 and 1e-8 times the bound, and, of three components, of
/// length 1, π and 2π. Related to v: −v, vectors parallel and perpendicular to it, and of its
/// length. Every fourth random one is short.
template <int N>
struct vectors {
  double bound = 1; ///< maximum absolute value of a component

  /// Excludes the point with these coordinates and all points within `radius` of it.
  [[nodiscard]] auto without(const coordinates& point, double radius = 0) const {
    return restricted(*this).without(point, radius);
  }
  /// Excludes the arguments, over `double`, for which `keeps` is false.
  template <class Predicate>
  [[nodiscard]] auto where(Predicate keeps) const {
    return restricted(*this).where(std::move(keeps));
  }

  // For those who extend duet: the members that `InputDomain` requires.

  [[nodiscard]] std::size_t size() const { return std::size_t(N); }
  [[nodiscard]] bool contains(std::span<const double> point) const {
    return std::all_of(point.begin(), point.end(),
                       [this](double x) { return std::abs(x) <= bound; });
  }
  [[nodiscard]] std::vector<coordinates> special_points() const {
    std::vector<coordinates> points = {coordinates(std::size_t(N), 0.0),
                                       coordinates(std::size_t(N), bound / 2),
                                       coordinates(std::size_t(N), bound)};
    for (const double length : {bound, -bound, 1e-4 * bound, 1e-8 * bound}) {
      for (std::size_t axis = 0; axis < std::size_t(N); ++axis) {
        points.emplace_back(std::size_t(N), 0.0);
        points.back()[axis] = length;
      }
    }
    if constexpr (N == 3) {
      const double pi = constant::pi<double>();
      for (const coordinates& point :
           {coordinates{0.48, 0.6, 0.64}, coordinates{pi, 0, 0}, coordinates{0, 2 * pi, 0},
            coordinates{0.48 * pi, 0.6 * pi, 0.64 * pi}}) {
        if (contains(point)) {
          points.push_back(point);
        }
      }
    }
    return points;
  }
  [[nodiscard]] std::vector<coordinates> related_points(std::span<const double> point,
                                                        random_source& random) const {
    const auto other = random.direction<N>();
    double square = 0, product = 0;
    for (std::size_t i = 0; i < std::size_t(N); ++i) {
      square += point[i] * point[i];
      product += point[i] * other[i];
    }
    const double size = std::sqrt(square), factor = random.uniform(-2, 2);
    std::vector<coordinates> points(4);
    for (std::size_t i = 0; i < std::size_t(N); ++i) {
      points[0].push_back(-point[i]);
      points[1].push_back(factor * point[i]);
      points[2].push_back(square > 0 ? size * other[i] - product / size * point[i] : other[i]);
      points[3].push_back(size * other[i]);
    }
    return points;
  }
  [[nodiscard]] coordinates random_point(random_source& random) const {
    const double size = random.integer(0, 3) == 0 ? random.log_uniform(1e-8, 1) : 1.0;
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

/// N arguments of one kind, as a `std::array`. Special: all of them the same special point; two,
/// and all, related as two special arguments of that domain.
template <std::size_t N, class Domain>
struct arrays {
  Domain element; ///< domain of each argument

  /// Excludes the point with these coordinates and all points within `radius` of it.
  [[nodiscard]] auto without(const coordinates& point, double radius = 0) const {
    return restricted(*this).without(point, radius);
  }
  /// Excludes the arguments, over `double`, for which `keeps` is false.
  template <class Predicate>
  [[nodiscard]] auto where(Predicate keeps) const {
    return restricted(*this).where(std::move(keeps));
  }

  // For those who extend duet: the members that `InputDomain` requires.

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
