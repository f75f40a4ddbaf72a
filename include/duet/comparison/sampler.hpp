// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/comparison/domain.hpp>
#include <duet/comparison/restricted.hpp>
#include <duet/comparison/structured_points.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/random_source.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Sampler of the points at which formulas are compared.

namespace duet {

/// Sampler of the arguments of a function, each from a separate domain. Points are those of the
/// caller, special ones in all combinations (or, if those are too many, each with random others,
/// and some combinations), and random ones. One half of the random points is unrestricted. The
/// other half is near special points, at distances that are log-uniform from 1e-12 on; or has
/// arguments of one domain that are equal, nearly equal or otherwise related, or components that
/// are zero or equal.
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

  /// Names of the arguments in reports.
  template <std::convertible_to<std::string>... Names>
    requires(sizeof...(Names) == sizeof...(Domains))
  [[nodiscard]] sampler named(Names... names) const {
    sampler result = *this;
    result.names_ = {std::string(names)...};
    return result;
  }

  /// Adds a point: the coordinates of all arguments in a row.
  ///
  /// \throws invalid_input if their number is wrong or one is out of range
  [[nodiscard]] sampler including(const coordinates& point) const {
    detail::require(point.size() == size(), "duet: sampler: the point has ", point.size(),
                    " coordinates, but the arguments have ", size());
    detail::require(contains(point), "duet: sampler: the point ", detail::tuple_text(point),
                    " is outside the domain of the arguments");
    sampler result = *this;
    result.own_points_.push_back(point);
    return result;
  }

  /// Excludes one point, the coordinates of all arguments in a row, and all points within `radius`
  /// of it.
  ///
  /// \throws invalid_input if their number is wrong, or the radius negative
  [[nodiscard]] sampler without(const coordinates& point, double radius = 0) const {
    return and_kept([keeps = detail::beyond(point, radius, size())](
                        const sampler&, std::span<const double> p) { return keeps(p); });
  }

  /// Excludes the points for which `keeps`, a function of all arguments over `double`, is false.
  ///
  /// Example: `sampler(rotations{}, rotations{}).where([](const auto& a, const auto& b) { return
  /// abs(dot(a, b)) > 1e-3; })`
  template <class Predicate>
  [[nodiscard]] sampler where(Predicate keeps) const {
    static_assert(
        takes_arguments<Predicate>,
        "duet: where takes a function of all arguments, over double, that returns a bool");
    return and_kept([keeps = std::move(keeps)](const sampler& s, std::span<const double> point) {
      return static_cast<bool>(std::apply(keeps, s.template make<double>(point)));
    });
  }

  /// Number of coordinates of all arguments together.
  [[nodiscard]] std::size_t size() const {
    return std::apply([](const auto&... d) { return (d.size() + ...); }, domains_);
  }

  /// True if a point, the coordinates of all arguments in a row, is in their domains.
  [[nodiscard]] bool contains(std::span<const double> point) const {
    bool result = true;
    for_each_part(point, [&](const auto& domain, std::span<const double> part, std::size_t) {
      result = result && domain.contains(part);
    });
    return result && std::all_of(keeps_.begin(), keeps_.end(),
                                 [&](const auto& keeps) { return keeps(*this, point); });
  }

  /// "w = (0, 0, 1), t = 0.5"
  [[nodiscard]] std::string describe(std::span<const double> point) const {
    std::string text;
    for_each_part(point, [&](const auto& domain, std::span<const double> part, std::size_t i) {
      text += (i > 0 ? ", " : "") + names_[i] + " = " + domain.describe(part);
    });
    return text;
  }

  /// The points of the caller, the special ones, and then `count` random ones; more if the half
  /// that is not unrestricted would have fewer than four of a kind.
  ///
  /// \throws invalid_input if nothing is left of the domains
  [[nodiscard]] std::vector<coordinates> points(std::size_t count, std::uint64_t seed) const {
    random_source random(seed);
    std::vector<coordinates> result = own_points_;
    append_special_points(result, random);
    const auto is_excluded = [this](const coordinates& point) { return !contains(point); };
    std::erase_if(result, is_excluded);
    detail::structured_points structured(arguments(random), random);
    const std::size_t structured_count = std::max((count + 1) / 2, structured.min_count());
    for (std::size_t k = 0; k < structured_count; ++k) {
      coordinates point = random_point(random);
      structured.put_into(point);
      result.push_back(is_excluded(point) ? random_point(random) : std::move(point));
    }
    for (std::size_t k = 0; k < count / 2; ++k) {
      result.push_back(random_point(random));
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
  static constexpr std::size_t some_combinations = 64; // used if there are more

  using keeps_point = std::function<bool(const sampler&, std::span<const double>)>;

  template <class Predicate>
  static constexpr bool takes_arguments =
      std::is_invocable_r_v<bool, const Predicate&,
                            decltype(std::declval<const Domains&>().template make<double>(
                                std::declval<std::span<const double>>()))...>;

  [[nodiscard]] sampler and_kept(keeps_point keeps) const {
    sampler result = *this;
    result.keeps_.push_back(std::move(keeps));
    return result;
  }

  [[nodiscard]] coordinates random_point(random_source& random) const {
    return detail::kept_point(
        [&] { return joined([&](const auto& domain) { return domain.random_point(random); }); },
        [&](const coordinates& point) { return contains(point); },
        [&](const coordinates& point) { return describe(point); });
  }

  [[nodiscard]] std::vector<detail::sampled_argument> arguments(random_source& random) const {
    std::vector<detail::sampled_argument> result;
    std::size_t first = 0;
    std::apply(
        [&](const auto&... domain) {
          ((detail::append_arguments(result, domain, first, random), first += domain.size()), ...);
        },
        domains_);
    return result;
  }

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
    for (std::size_t c = 0; c < some_combinations; ++c) {
      std::size_t index = 0;
      result.push_back(joined([&](const auto& domain) {
        const auto& points = special[index++];
        return points.empty() ? domain.random_point(random)
               : c == 0       ? points[0]
                              : points[std::size_t(random.integer(0, int(points.size()) - 1))];
      }));
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
  std::vector<keeps_point> keeps_;
};

} // namespace duet
