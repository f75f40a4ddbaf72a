// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/identical.hpp"
#include "support/test.hpp"

#include <duet/dual/math.hpp>

#include <ranges>
#include <set>
#include <valarray>

// Code for double works with dual and Taylor numbers: literals of every arithmetic type,
// the conditional operator, algorithms and containers. (std::complex: complex_of_dual.cpp.)

namespace test_dual_standard_library {
namespace {

using duet::dual, duet::taylor;

struct outer_tag;

using three = dual<double, 3>;
using series = taylor<double, 3>;
using nested = dual<dual<double>, 1, outer_tag>;

template <class D>
D variable(duet::real_type_t<D> x) {
  if constexpr (std::is_same_v<D, three>) {
    return D::variable(x, 1);
  } else {
    return D::variable(x);
  }
}

template <class D>
duet::real_type_t<D> slope(const D& y) {
  if constexpr (std::is_same_v<D, three>) {
    return y.partial(1);
  } else if constexpr (requires { y.epsilon(); }) {
    return duet::innermost(y.epsilon());
  } else {
    return duet::innermost(y.coefficient(1));
  }
}

/// Exactly this value and this derivative.
template <class D>
bool is(const D& y, double value, double derivative) {
  return duet::innermost(y) == value && slope(y) == derivative;
}

/// x, x² − 3 and 1/x at x = 2: values 2, 1, ½ and slopes 1, 4, −¼.
template <class D>
std::vector<D> three_numbers() {
  const D x = variable<D>(2);
  return {x, x * x - 3, 1 / x};
}

#define DUET_EVERY_NUMBER dual<double>, three, series, nested, dual<float>

TEST_CASE_TEMPLATE("standard library: numbers are regular, ordered and swappable", D,
                   DUET_EVERY_NUMBER) {
  static_assert(std::regular<D>);
  static_assert(std::totally_ordered<D>);
  static_assert(std::totally_ordered_with<D, double>);
  static_assert(std::swappable<D>);
  static_assert(std::is_nothrow_move_constructible_v<D>);
  static_assert(std::common_with<D, double>);
  static_assert(std::numeric_limits<D>::is_specialized);
  CHECK(is(D(), 0, 0));
  CHECK(is(D{}, 0, 0));
}

TEST_CASE_TEMPLATE("standard library: max, min and clamp of a number and a constant", D,
                   DUET_EVERY_NUMBER) {
  const D x = variable<D>(2);
  CHECK(is(std::max(x * x, 3.0), 4, 4));
  CHECK(is(std::max(5, x * x), 5, 0));
  CHECK(is(std::max(x, 2), 2, 1)); // of equal numbers the first
  CHECK(is(std::max(2, x), 2, 0));
  CHECK(is(std::min(x, 2), 2, 1));
  CHECK(is(std::min(2, x), 2, 0));
  CHECK(is(std::min(x * x, 5), 4, 4));
  CHECK(is(std::clamp(x, 0, 3.0), 2, 1));
  CHECK(is(std::clamp(x, 2, 2), 2, 1));
  CHECK(is(std::clamp(x, 3, 4), 3, 0));
  CHECK(is(std::clamp(x, 0, 1), 1, 0));
  CHECK(is(std::clamp(3, x, x * x), 3, 0));
  CHECK(is(std::clamp(5, 0, x * x), 4, 4));
  CHECK(is(std::max(x, x * x), 4, 4));
}

TEST_CASE_TEMPLATE("standard library: literals of every arithmetic type", D, DUET_EVERY_NUMBER) {
  const D x = variable<D>(2);
  CHECK(is(3 * x + 1, 7, 3));
  CHECK(is(x * 3U - 1U, 5, 3)); // not 2³² − 1
  CHECK(is(3L * x, 6, 3));
  CHECK(is(x / 4LL, 0.5, 0.25));
  CHECK(is(4ULL - x, 2, -1));
  CHECK(is(0.5F * x, 1, 0.5));
  CHECK(is(x - 0.5, 1.5, 1));
  CHECK(is(2 / x, 1, -0.5));
  CHECK(is(x + 1.5L, 3.5, 1));
  CHECK(is(x * short(2), 4, 2));
  CHECK(is(x * true, 2, 1));
  const int n = 3;
  const std::size_t size = 4;
  CHECK(is(n * x / size, 1.5, 0.75));
  D y = 1;
  CHECK(is(y, 1, 0));
  y = 2.5F;
  CHECK(is(y, 2.5, 0));
  y = x;
  y += 1;
  y -= 2.5;
  y *= 4U;
  y /= 2L;
  CHECK(is(y, 1, 2));
  CHECK(is(y++, 1, 2));
  CHECK(is(--y, 1, 2));
  CHECK(is(+x, 2, 1));
  CHECK(x > 1);
  CHECK(2U == x);
  CHECK(x != 2.5F);
  CHECK(3L >= x);
  CHECK((x && !(x - 2)));
  CHECK(static_cast<double>(x) == 2);
  CHECK(static_cast<int>(x * 1.25) == 2);
}

TEST_CASE_TEMPLATE("standard library: conditional operator and several return statements", D,
                   DUET_EVERY_NUMBER) {
  const D x = variable<D>(2);
  const auto ramp = [](auto a) { return a > 0 ? a * a : 0.0; };
  CHECK(is(ramp(x), 4, 4));
  CHECK(is(ramp(-x), 0, 0));
  const auto one_or_square = [](auto a) { return a > 0 ? 1 : a * a; };
  CHECK(is(one_or_square(x), 1, 0));
  CHECK(is(one_or_square(-x), 4, 4));
  const auto by_reference = [](const auto& a) { return a > 1 ? a * a : a; };
  CHECK(is(by_reference(x), 4, 4));
  CHECK(is(by_reference(x / 4), 0.5, 0.25));
  const auto two_returns = [](auto a) {
    if (a > 1) {
      return a * a;
    }
    return a;
  };
  CHECK(is(two_returns(x), 4, 4));
  CHECK(is(two_returns(x / 4), 0.5, 0.25));
  const auto declared = [](auto a) -> decltype(a) {
    if (a < 0) {
      return 0;
    }
    if (a < 1) {
      return a * a / 2;
    }
    return a - 0.5;
  };
  CHECK(is(declared(-x), 0, 0));
  CHECK(is(declared(x / 4), 0.125, 0.125));
  CHECK(is(declared(x), 1.5, 1));
  const std::function<D(D)> stored = [](D a) { return a > 1 ? a * a : D(0); };
  CHECK(is(stored(x), 4, 4));
  CHECK(is(stored(0.5), 0, 0));
}

TEST_CASE_TEMPLATE("standard library: fmax, fmin and swap", D, DUET_EVERY_NUMBER) {
  using std::max, std::min;
  D x = variable<D>(2);
  D y = x * x;
  CHECK(is(max(x, y), 4, 4));
  CHECK(is(min(x, y), 2, 1));
  CHECK(is(std::max<D>(x, 3.0), 3, 0));
  CHECK(is(std::min({y, x, D(3)}), 2, 1));
  CHECK(is(std::max({y, x, D(3)}), 4, 4));
  CHECK(is(std::minmax(x, y).second, 4, 4));
  CHECK(is(std::clamp(x, D(0), D(3)), 2, 1));
  CHECK(is(std::clamp(x, D(0), D(1)), 1, 0));
  CHECK(is(std::clamp<D>(x, 3, 4), 3, 0));
  std::swap(x, y);
  CHECK(is(x, 4, 4));
  CHECK(is(y, 2, 1));
  std::ranges::swap(x, y);
  CHECK(is(x, 2, 1));
  CHECK(is(std::exchange(x, 5), 2, 1));
  CHECK(is(x, 5, 0));
}

TEST_CASE_TEMPLATE("standard library: lerp and midpoint", D, DUET_EVERY_NUMBER) {
  using std::lerp, std::midpoint;
  const D x = variable<D>(2);
  CHECK(is(lerp(x, x * x, 0.5), 3, 2.5));
  CHECK(is(lerp(0, 4, x), 8, 4));
  CHECK(is(midpoint(x, x * x), 3, 2.5));
  CHECK(is(midpoint(x, 4), 3, 0.5));
  CHECK(is(midpoint(4.0F, x), 3, 0.5));
  CHECK(is(midpoint(x, x), 2, 1));
  CHECK(is(midpoint(D(1), D(2)), 1.5, 0));
}

TEST_CASE("standard library: midpoints equal those of <numeric> bit by bit") {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double inputs[] = {0,      -0.0,  1,       -1,       0.1,      3e-17,     5e-324,
                           1e-310, 1e308, 1.5e308, -1.5e308, infinity, -infinity, std::nan("")};
  for (const double a : inputs) {
    for (const double b : inputs) {
      CAPTURE(a);
      CAPTURE(b);
      const double exact = std::midpoint(a, b);
      using pair = dual<double, 2>;
      const pair y = midpoint(pair::variable(a, 0), pair::variable(b, 1));
      CHECK(duet_test::identical(y.value(), exact));
      CHECK(y.partial(0) == 0.5);
      CHECK(y.partial(1) == 0.5);
      const series z = midpoint(series::variable(a), series(b));
      CHECK(duet_test::identical(z.value(), exact));
      CHECK(z.coefficient(1) == 0.5);
      CHECK(z.coefficient(2) == 0);
      CHECK(duet_test::identical(midpoint(nested(a), nested(b)).value().value(), exact));
      CHECK(midpoint(pair(a), pair(b)).partial(1) == 0);
    }
  }
}

TEST_CASE_TEMPLATE("standard library: sums and products of ranges", D, DUET_EVERY_NUMBER) {
  const std::vector<D> v = three_numbers<D>();
  const auto first = v.begin();
  const auto last = v.end();
  CHECK(is(std::accumulate(first, last, D(0)), 3.5, 4.75));
  CHECK(is(std::accumulate(first, last, 0.0 * v[0]), 3.5, 4.75));
  CHECK(is(std::accumulate(first, last, D(1), std::multiplies<>()), 1, 4));
  CHECK(is(std::reduce(first, last), 3.5, 4.75));
  CHECK(is(std::reduce(first, last, D(1)), 4.5, 4.75));
  CHECK(is(std::inner_product(first, last, first, D(0)), 5.25, 11.75));
  const std::vector<double> weights{1, 2, 4};
  CHECK(is(std::inner_product(first, last, weights.begin(), D(0)), 6, 8));
  CHECK(is(std::transform_reduce(first, last, first, D(0)), 5.25, 11.75));
  const auto square = [](const D& a) { return a * a; };
  CHECK(is(std::transform_reduce(first, last, D(0), std::plus<>(), square), 5.25, 11.75));
  std::vector<D> sums;
  std::partial_sum(first, last, std::back_inserter(sums));
  CHECK(is(sums[1], 3, 5));
  CHECK(is(sums[2], 3.5, 4.75));
  std::vector<D> differences;
  std::adjacent_difference(sums.begin(), sums.end(), std::back_inserter(differences));
  CHECK(is(differences[0], 2, 1));
  CHECK(is(differences[2], 0.5, -0.25));
  std::vector<D> scanned(3);
  std::inclusive_scan(first, last, scanned.begin());
  CHECK(is(scanned[2], 3.5, 4.75));
  std::exclusive_scan(first, last, scanned.begin(), D(0));
  CHECK(is(scanned[2], 3, 5));
  std::iota(scanned.begin(), scanned.end(), v[0]);
  CHECK(is(scanned[2], 4, 1));
}

TEST_CASE_TEMPLATE("standard library: order statistics carry derivatives", D, DUET_EVERY_NUMBER) {
  const std::vector<D> unsorted = three_numbers<D>();
  auto v = unsorted;
  std::sort(v.begin(), v.end());
  CHECK(is(v[0], 0.5, -0.25));
  CHECK(is(v[1], 1, 4));
  CHECK(is(v[2], 2, 1));
  std::ranges::sort(v, std::greater<>());
  CHECK(is(v[0], 2, 1));
  CHECK(is(v[2], 0.5, -0.25));
  v = unsorted;
  std::ranges::stable_sort(v);
  CHECK(is(v[0], 0.5, -0.25));
  CHECK(std::ranges::binary_search(v, D(1)));
  CHECK(is(*std::lower_bound(v.begin(), v.end(), 0.75), 1, 4));
  v = unsorted;
  std::nth_element(v.begin(), v.begin() + 1, v.end());
  CHECK(is(v[1], 1, 4));
  const auto [smallest, largest] = std::minmax_element(unsorted.begin(), unsorted.end());
  CHECK(is(*smallest, 0.5, -0.25));
  CHECK(is(*largest, 2, 1));
  CHECK(is(*std::ranges::max_element(unsorted), 2, 1));
  CHECK(is(std::ranges::min(unsorted), 0.5, -0.25));
  CHECK(is(std::ranges::minmax(unsorted).max, 2, 1));
  CHECK(std::count(unsorted.begin(), unsorted.end(), 1) == 1);
  CHECK(std::find(unsorted.begin(), unsorted.end(), 0.5) == unsorted.end() - 1);
}

// clang before 16 cannot compile the views of libstdc++.
#if !defined(__clang__) || __clang_major__ >= 16
TEST_CASE_TEMPLATE("standard library: views", D, DUET_EVERY_NUMBER) {
  const std::vector<D> v = three_numbers<D>();
  auto squares_above = v | std::views::transform([](const D& a) { return a * a; }) |
                       std::views::filter([](const D& a) { return a >= 1; });
  D sum = 0;
  for (const D& a : squares_above) {
    sum += a;
  }
  CHECK(is(sum, 5, 12));
  CHECK(is((v | std::views::reverse).front(), 0.5, -0.25));
  CHECK(is(std::ranges::max(v | std::views::take(2)), 2, 1));
}
#endif

TEST_CASE_TEMPLATE("standard library: containers", D, DUET_EVERY_NUMBER) {
  const std::vector<D> v = three_numbers<D>();
  const D x = v[0];
  std::map<int, D> by_name;
  by_name[3] += x;
  by_name[3] += 1;
  CHECK(is(by_name[3], 3, 1));
  CHECK(is(by_name[4], 0, 0));
  const std::set<D> ordered(v.begin(), v.end());
  CHECK(is(*ordered.begin(), 0.5, -0.25));
  CHECK(is(*ordered.rbegin(), 2, 1));
  std::map<D, int> by_value{{x, 7}};
  CHECK(by_value.at(2) == 7);
  const std::tuple<D, int> pair(x, 1);
  CHECK(is(std::get<0>(pair), 2, 1));
  CHECK(pair < std::tuple<D, int>(x, 2));
  CHECK(std::array<D, 2>{x, 1} < std::array<D, 2>{x, 1.5});
  CHECK(is(std::optional<D>().value_or(x), 2, 1));
  CHECK(is(std::plus<>()(x, 2.0), 4, 1));
  CHECK(is(std::multiplies<D>()(x, 2.0), 4, 2));
  CHECK(std::less<>()(x, 3));
}

TEST_CASE_TEMPLATE("standard library: valarrays", D, DUET_EVERY_NUMBER) {
  const std::vector<D> v = three_numbers<D>();
  const std::valarray<D> a(v.data(), v.size());
  CHECK(is(a.sum(), 3.5, 4.75));
  CHECK(is(a.max(), 2, 1));
  CHECK(is(a.min(), 0.5, -0.25));
  const std::valarray<D> squares = a * a;
  CHECK(is(squares[1], 1, 8));
  CHECK(is((a * D(2) - squares).sum(), 1.75, -2.25));
  const std::valarray<D> roots = sqrt(squares);
  CHECK(is(roots[0], 2, 1));
  CHECK(is(std::valarray<D>(a[a > D(0.75)])[1], 1, 4));
  CHECK(is(a.apply([](const D& b) { return b * b; })[2], 0.25, -0.25));
  CHECK(is(std::valarray<D>(a[std::slice(0, 2, 2)])[1], 0.5, -0.25));
}

} // namespace
} // namespace test_dual_standard_library
