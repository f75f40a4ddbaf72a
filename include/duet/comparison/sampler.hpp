// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/comparison/domain.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/random_source.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

/// \file
/// The points at which formulas are compared.

namespace duet {

/// The arguments of a function, each from a domain of its own. Points are special ones in all
/// combinations (or, where those are too many, each with random company), points of the caller,
/// random points.
///
/// Example: `sampler(vectors<3>{3.0}, real_numbers{0, 1}).named("w", "t").including({0, 0, 1,
/// 0.5})`
template <InputDomain... Domains>
class sampler {
public:
  explicit sampler(Domains... domains) : domains_(std::move(domains)...) {
    for (std::size_t i = 0; i < sizeof...(Domains); ++i) {
      names_[i] = sizeof...(Domains) == 1 ? "x" : "x" + std::to_string(i + 1);
    }
  }

  /// What the arguments are called in reports.
  template <std::convertible_to<std::string>... Names>
    requires(sizeof...(Names) == sizeof...(Domains))
  [[nodiscard]] sampler named(Names... names) const {
    sampler result = *this;
    result.names_ = {std::string(names)...};
    return result;
  }

  /// Adds a point: the coordinates of all arguments in a row.
  /// \throws invalid_input where their number is wrong or one is out of range
  [[nodiscard]] sampler including(const coordinates& point) const {
    detail::require(point.size() == size(), "duet: sampler: a point of ", point.size(),
                    " coordinates, but the arguments have ", size());
    detail::require(contains(point), "duet: sampler: the point ", detail::tuple_text(point),
                    " is outside the domain of the arguments");
    sampler result = *this;
    result.own_points_.push_back(point);
    return result;
  }

  /// Number of coordinates of all arguments together.
  [[nodiscard]] std::size_t size() const {
    return std::apply([](const auto&... d) { return (d.size() + ...); }, domains_);
  }

  /// Is a point, the coordinates of all arguments in a row, in their domains?
  [[nodiscard]] bool contains(std::span<const double> point) const {
    bool result = true;
    for_each_part(point, [&](const auto& domain, std::span<const double> part, std::size_t) {
      result = result && domain.contains(part);
    });
    return result;
  }

  /// "w = (0, 0, 1), t = 0.5"
  [[nodiscard]] std::string describe(std::span<const double> point) const {
    std::string text;
    for_each_part(point, [&](const auto& domain, std::span<const double> part, std::size_t i) {
      text += (i > 0 ? ", " : "") + names_[i] + " = " + domain.describe(part);
    });
    return text;
  }

  /// The points of the caller, the special ones, and then `count` random ones.
  [[nodiscard]] std::vector<coordinates> points(std::size_t count, std::uint64_t seed) const {
    random_source random(seed);
    std::vector<coordinates> result = own_points_;
    append_special_points(result, random);
    const std::size_t all = result.size() + count;
    while (result.size() < all) {
      result.push_back(joined([&](const auto& domain) { return domain.random_point(random); }));
    }
    return result;
  }

  /// The arguments over T, as a tuple.
  template <class T>
  [[nodiscard]] auto make(std::span<const double> point) const {
    return make_each<T>(point, std::index_sequence_for<Domains...>{});
  }

private:
  static constexpr std::size_t max_combinations = 512;

  /// visit(domain, its coordinates, index) for every argument.
  template <class Visit>
  void for_each_part(std::span<const double> point, Visit&& visit) const {
    std::size_t first = 0;
    std::size_t index = 0;
    std::apply(
        [&](const auto&... domain) {
          ((visit(domain, point.subspan(first, domain.size()), index), first += domain.size(),
            ++index),
           ...);
        },
        domains_);
  }

  /// The coordinates part(domain) of every argument in a row.
  template <class Part>
  [[nodiscard]] coordinates joined(Part&& part) const {
    coordinates point;
    const auto append = [&](const auto& domain) {
      const coordinates more = part(domain);
      point.insert(point.end(), more.begin(), more.end());
    };
    std::apply([&](const auto&... domain) { (append(domain), ...); }, domains_);
    return point;
  }

  void append_special_points(std::vector<coordinates>& result, random_source& random) const {
    const std::array<std::vector<coordinates>, sizeof...(Domains)> special = std::apply(
        [](const auto&... domain) { return std::array{domain.special_points()...}; }, domains_);
    std::size_t combinations = 1;
    for (const auto& points : special) {
      combinations =
          std::min(max_combinations + 1, combinations * std::max<std::size_t>(1, points.size()));
    }
    if (combinations <= max_combinations) {
      for (std::size_t c = 0; c < combinations; ++c) {
        std::size_t rest = c;
        std::size_t index = 0;
        result.push_back(joined([&](const auto& domain) {
          const auto& points = special[index++];
          if (points.empty()) {
            return domain.random_point(random);
          }
          const std::size_t choice = rest % points.size();
          rest /= points.size();
          return points[choice];
        }));
      }
      return;
    }
    for (std::size_t chosen = 0; chosen < special.size(); ++chosen) {
      for (const coordinates& point : special[chosen]) {
        std::size_t index = 0;
        result.push_back(joined([&](const auto& domain) {
          return index++ == chosen ? point : domain.random_point(random);
        }));
      }
    }
  }

  template <class T, std::size_t... I>
  [[nodiscard]] auto make_each(std::span<const double> point, std::index_sequence<I...>) const {
    std::array<std::size_t, sizeof...(Domains) + 1> first{};
    ((first[I + 1] = first[I] + std::get<I>(domains_).size()), ...);
    return std::make_tuple(std::get<I>(domains_).template make<T>(
        point.subspan(first[I], std::get<I>(domains_).size()))...);
  }

  std::tuple<Domains...> domains_;
  std::array<std::string, sizeof...(Domains)> names_;
  std::vector<coordinates> own_points_;
};

} // namespace duet
