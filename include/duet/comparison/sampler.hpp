// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/comparison/domain.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/random_source.hpp>

#include <algorithm>
#include <array>
#include <cmath>
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
/// Sampler of the points at which formulas are compared. Many of these are inputs at which formulas
/// tend to fail that are right elsewhere: near special ones, equal and nearly equal arguments,
/// components that are zero or equal.

namespace duet {

namespace detail {

/// An argument and the index of its first coordinate among those of all; an array counts as many as
/// it has elements. The code common to all samplers does not depend on the domain's type, so it is
/// compiled once.
struct sampled_argument {
  const void* kind;                 ///< the same for two that may be equal
  std::size_t first, size;          ///< its coordinates
  std::vector<coordinates> special; ///< special points; inputs are most often near the first
  /// largest absolute value of a coordinate, as far as it is known
  double extent;
  std::function<coordinates(random_source&)> random_point;
  std::function<std::vector<coordinates>(std::span<const double>, random_source&)> related_points;
  std::function<bool(std::span<const double>)> contains;
};

template <class Domain>
inline constexpr char kind_of = 0;

/// Appends the arguments that represent one of this domain.
///
/// \param first  index of its first coordinate
template <class Domain>
void append_arguments(std::vector<sampled_argument>& arguments, const Domain& domain,
                      std::size_t first, random_source& random) {
  sampled_argument made{
      &kind_of<Domain>, first, domain.size(), domain.special_points(), 0, {}, {}, {}};
  made.random_point = [&domain](random_source& r) { return domain.random_point(r); };
  made.contains = [&domain](std::span<const double> point) { return domain.contains(point); };
  if constexpr (requires(const coordinates& c) { domain.related_points(c, random); }) {
    made.related_points = [&domain](std::span<const double> point, random_source& r) {
      return domain.related_points(point, r);
    };
  }
  for (const coordinates& point : made.special) {
    for (const double x : point) {
      made.extent = std::max(made.extent, std::abs(x));
    }
  }
  arguments.push_back(std::move(made));
}
template <std::size_t N, class Domain>
void append_arguments(std::vector<sampled_argument>& arguments, const arrays<N, Domain>& domain,
                      std::size_t first, random_source& random) {
  for (std::size_t i = 0; i < N; ++i) {
    append_arguments(arguments, domain.element, first + i * domain.element.size(), random);
  }
}
/// The sampler stores the excluded points and checks for every point whether it is contained.
template <class Domain>
void append_arguments(std::vector<sampled_argument>& arguments, const restricted<Domain>& domain,
                      std::size_t first, random_source& random) {
  append_arguments(arguments, domain.domain(), first, random);
}

/// Makes structured inputs out of random ones.
class structured_points {
public:
  structured_points(std::vector<sampled_argument> arguments, random_source& random)
      : arguments_(std::move(arguments)), random_(random) {
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      add({&structured_points::put_near_special, {i}});
      add({&structured_points::put_near_special, {i}});
      if (arguments_[i].size > 1) {
        add({&structured_points::put_pattern, {i}});
      }
    }
    std::vector<std::size_t> all, alike;
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      all.push_back(i);
      alike.clear();
      bool is_first = true;
      for (std::size_t j = 0; j < arguments_.size(); ++j) {
        if (arguments_[j].kind == arguments_[i].kind) {
          alike.push_back(j);
          is_first = is_first && j >= i;
          if (j > i) {
            add({&structured_points::put_related, {i, j}});
          }
        }
      }
      if (is_first && alike.size() > 2) {
        add({&structured_points::put_alike, alike});
      }
    }
    if (all.size() > 1) {
      add({&structured_points::put_near_special, all});
    }
  }

  /// Minimum number of structured points: four of each kind.
  [[nodiscard]] std::size_t min_count() const {
    return std::min<std::size_t>(4 * recipes_.size(), 256);
  }

  /// Changes a random point into the next structured point.
  ///
  /// \param point  the coordinates of all arguments in a row
  void put_into(coordinates& point) {
    recipe& next = recipes_[count_++ % recipes_.size()];
    (this->*next.put)(point, next);
    ++next.used;
  }

private:
  struct recipe {
    void (structured_points::*put)(coordinates&, const recipe&);
    std::vector<std::size_t> of; ///< indices of the arguments
    std::size_t used = 0;
    double phase = 0;
  };

  void add(recipe r) {
    r.phase = random_.unit();
    recipes_.push_back(std::move(r));
  }

  /// Log-uniform up to `largest`, down to 1e-12 times the smaller of `largest` and 1.
  ///
  /// \param u  in [0, 1)
  [[nodiscard]] static double distance(double u, double largest) {
    const double smallest = 1e-12 * std::min(largest, 1.0);
    return smallest * std::pow(largest / smallest, u);
  }
  /// Spread evenly over [0, 1), for the first few k as for many, and each i.
  [[nodiscard]] static double even(const recipe& r, std::size_t k, std::size_t i = 0) {
    const double u = r.phase + double(k) * 0.6180339887498949 + double(i) * 0.7548776662466927;
    return u - std::floor(u);
  }

  /// A direction of n coordinates: any, along an axis, or of components that are zero or equal.
  [[nodiscard]] coordinates direction(std::size_t n) {
    coordinates result(n, 0.0);
    const int kind = random_.integer(0, 3);
    if (n == 1 || kind == 0) {
      result[std::size_t(random_.integer(0, int(n) - 1))] = random_.sign();
      return result;
    }
    double square = 0;
    for (double& x : result) {
      x = random_.normal();
    }
    if (kind == 1) {
      shape(result);
    }
    for (const double x : result) {
      square += x * x;
    }
    for (double& x : result) {
      x /= std::sqrt(square > 0 ? square : 1);
    }
    return result;
  }

  /// Makes a coordinate zero, or two, or all, the same or opposite.
  void shape(std::span<double> x) {
    const auto any = [&] { return std::size_t(random_.integer(0, int(x.size()) - 1)); };
    const std::size_t from = any(), to = any();
    switch (random_.integer(0, 3)) {
    case 0:
      x[to] = 0;
      break;
    case 1:
      x[to] = x[from];
      break;
    case 2:
      x[to] = to == from ? x[to] : -x[from];
      break;
    default:
      std::fill(x.begin(), x.end(), x[from]);
    }
  }

  [[nodiscard]] static std::span<double> part(coordinates& point, const sampled_argument& a) {
    return std::span(point).subspan(a.first, a.size);
  }

  /// \return true if it is in the domain; only then it is written
  static bool put(coordinates& point, const sampled_argument& a, std::span<const double> values) {
    const bool contained = a.contains(values);
    if (contained) {
      std::copy(values.begin(), values.end(), part(point, a).begin());
    }
    return contained;
  }

  /// Writes a point at that distance from `centre`, or nearer if that is out of the domain.
  bool put_near(coordinates& point, const sampled_argument& a, std::span<const double> centre,
                double distance) {
    const coordinates towards = direction(a.size);
    for (int i = 0; i < 40; ++i, distance *= i % 2 == 0 ? -0.25 : -1) {
      coordinates values(centre.begin(), centre.end());
      for (std::size_t k = 0; k < a.size; ++k) {
        values[k] += distance * towards[k];
      }
      if (put(point, a, values)) {
        return true;
      }
    }
    return put(point, a, centre);
  }

  /// Every other time near the first special point, else near the others in turn.
  void put_near_special(coordinates& point, const recipe& r) {
    for (const std::size_t i : r.of) {
      const sampled_argument& a = arguments_[i];
      if (!a.special.empty()) {
        const std::size_t k = r.used / 2, n = a.special.size();
        const bool first = r.used % 2 == 0;
        put_near(point, a, a.special[first ? 0 : k % n],
                 distance(first ? even(r, k) : even(r, k / n, k % n), a.extent > 0 ? a.extent : 1));
      }
    }
  }

  void put_pattern(coordinates& point, const recipe& r) {
    const sampled_argument& a = arguments_[r.of[0]];
    const auto old = part(point, a);
    coordinates values(old.begin(), old.end());
    shape(values);
    put(point, a, values);
  }

  /// A value of both: a random one of either, or a special one.
  [[nodiscard]] coordinates common_value(const sampled_argument& a, const sampled_argument& b) {
    for (int i = 0; i < 20; ++i) {
      const sampled_argument& of = i % 2 == 0 ? a : b;
      const coordinates value =
          random_.integer(0, 3) == 0 && !of.special.empty()
              ? of.special[std::size_t(random_.integer(0, int(of.special.size()) - 1))]
              : of.random_point(random_);
      if (a.contains(value) && b.contains(value)) {
        return value;
      }
    }
    return {};
  }

  /// Equal or, every other time, in another special relation; exactly, or nearly.
  void put_related(coordinates& point, const recipe& r) {
    const sampled_argument &a = arguments_[r.of[0]], &b = arguments_[r.of[1]];
    const coordinates value = common_value(a, b);
    if (value.empty()) {
      return;
    }
    put(point, a, value);
    const std::size_t k = r.used / 2;
    if (r.used % 2 == 0 || !b.related_points) {
      put_near(point, b, value, k % 3 == 0 ? 0 : distance(even(r, k), 1));
      return;
    }
    const std::vector<coordinates> related = b.related_points(value, random_);
    const std::size_t n = related.size();
    put_near(point, b, related[k % n], k / n % 3 == 0 ? 0 : distance(even(r, k / n, k % n), 1));
  }

  /// All equal, exactly or, two of three times, nearly.
  void put_alike(coordinates& point, const recipe& r) {
    const coordinates value = common_value(arguments_[r.of[0]], arguments_[r.of[1]]);
    for (std::size_t k = 0; k < r.of.size() && !value.empty(); ++k) {
      put_near(point, arguments_[r.of[k]], value,
               k == 0 || r.used % 3 == 0 ? 0 : distance(even(r, r.used), 1));
    }
  }

  std::vector<sampled_argument> arguments_;
  random_source& random_;
  std::vector<recipe> recipes_;
  std::size_t count_ = 0;
};

} // namespace detail

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

  /// The names of the arguments.
  [[nodiscard]] std::span<const std::string> names() const { return names_; }

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
    std::size_t first = 0;
    return std::apply(
        [&](const auto&... domain) { // braces, so that arguments are made in order
          return std::tuple<decltype(domain.template make<T>(point))...>{domain.template make<T>(
              point.subspan(std::exchange(first, first + domain.size()), domain.size()))...};
        },
        domains_);
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
    // Adds a point: of each argument the special one number choose(argument, count), or a random
    // one if that is not below their count.
    const auto add = [&](auto&& choose) {
      std::size_t index = 0;
      result.push_back(joined([&](const auto& domain) {
        const auto& points = special[index];
        const std::size_t choice = choose(index++, points.size());
        return choice < points.size() ? points[choice] : domain.random_point(random);
      }));
    };
    if (combinations <= max_combinations) {
      for (std::size_t c = 0; c < combinations; ++c) {
        add([rest = c](std::size_t, std::size_t count) mutable {
          const std::size_t choice = count > 0 ? rest % count : 0;
          rest /= std::max<std::size_t>(count, 1);
          return choice;
        });
      }
      return;
    }
    for (std::size_t c = 0; c < some_combinations; ++c) {
      add([&](std::size_t, std::size_t count) {
        return c > 0 && count > 0 ? std::size_t(random.integer(0, int(count) - 1)) : 0;
      });
    }
    for (std::size_t chosen = 0; chosen < special.size(); ++chosen) {
      for (std::size_t k = 0; k < special[chosen].size(); ++k) {
        add([&](std::size_t index, std::size_t count) { return index == chosen ? k : count; });
      }
    }
  }

  std::tuple<Domains...> domains_;
  std::array<std::string, sizeof...(Domains)> names_;
  std::vector<coordinates> own_points_;
  std::vector<keeps_point> keeps_;
};

} // namespace duet
