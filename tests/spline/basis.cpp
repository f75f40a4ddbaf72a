// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"
#include "support/identical.hpp"
#include "support/multiprecision.hpp"
#include "support/ulp.hpp"

namespace test_spline_basis {
namespace {

using duet_test::cast;
using duet_test::knot_vectors;
using duet_test::parameters_on;
using duet_test::real_50;
using duet_test::ulps_of_range;
using duet_test::worst_error;

constexpr double tolerance = 1e-13;

template <class F, int... Order>
void for_orders(F&& f, std::integer_sequence<int, Order...>) {
  (f(std::integral_constant<int, Order + 2>{}), ...);
}
/// f(2), … f(7), as constants, with all kinds of knots.
template <class F>
void for_each_case(F&& f) {
  for_orders(
      [&](auto order) {
        for (const duet_test::named_knots& each : knot_vectors(order)) {
          const std::string& name = each.name;
          const std::vector<double>& knots = each.knots;
          CAPTURE(int(order));
          CAPTURE(name);
          f(order, knots);
        }
      },
      std::make_integer_sequence<int, 6>{});
}

TEST_CASE("P1: basis functions agree with their definition, are non-negative, have local support "
          "and sum to 1") {
  for_each_case([](auto order, const std::vector<double>& knots) {
    constexpr int k = order;
    const std::size_t size = knots.size() - std::size_t(k);
    for (const double u : parameters_on(knots, k, 2)) {
      double sum = 0;
      bool proper = true;
      for (std::size_t i = 0; i < size; ++i) {
        const double b = duet::basis_function(knots, i, k, u);
        const double definition = duet_test::b_definition(knots, i, k, u, u, knots[size]);
        CHECK(std::abs(b - definition) <= tolerance);
        sum += b;
        proper = proper && b >= 0;
        const bool in_support = knots[i] <= u && u <= knots[i + std::size_t(k)];
        proper = proper && (in_support || b == 0);
      }
      CHECK(proper);
      CHECK(sum == doctest::Approx(1).epsilon(tolerance));
    }
  });
}

TEST_CASE("P3, P4: closed-form derivatives of the weights agree with Taylor numbers") {
  for_each_case([](auto order, const std::vector<double>& knots) {
    constexpr int k = order;
    const duet::bspline_basis<k> basis(knots);
    double worst = 0;
    for (const double u : parameters_on(knots, k, 2)) {
      const std::size_t span = basis.find_span(u);
      const auto closed = basis.template weights<3>(span, u);
      const auto taylor = duet::derivatives<3>(
          [&](const auto& x) { return basis.template weights<0>(span, x)[0]; }, u);
      for (std::size_t d = 0; d <= 3; ++d) {
        double size = 1e-3;
        for (const double x : closed[d]) {
          size = std::max(size, std::abs(x));
        }
        for (std::size_t j = 0; j < closed[d].size(); ++j) {
          worst = std::max(worst, std::abs(closed[d][j] - taylor[d][j]) / size);
        }
      }
    }
    CHECK(worst <= tolerance + duet_test::if_fused(2 * tolerance));
  });
}

TEST_CASE("bspline_basis: float and long double agree with double") {
  const std::vector<double> knots = knot_vectors(4)[4].knots;
  const duet::bspline_basis<4> basis(knots);
  const duet::bspline_basis<4, float> in_float(duet_test::cast<float>(knots));
  const duet::bspline_basis<4, long double> in_long_double(duet_test::cast<long double>(knots));
  for (const double u : {0.5, 0.9, 1.7, 2.0}) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double expected = basis.weights<0>(0, u)[0][i];
      CHECK(double(in_float.weights<0>(0, float(u))[0][i]) ==
            doctest::Approx(expected).epsilon(1e-6));
      CHECK(double(in_long_double.weights<0>(0, u)[0][i]) ==
            doctest::Approx(expected).epsilon(1e-15));
    }
  }
}

struct exact_value {
  real_50 value;
  real_50 of_absolute_terms;
};

/// B̃_i, B̃′_i (P3), B̃″_i (P4 and the corrections to it).
std::array<exact_value, 3> closed_forms(const std::vector<real_50>& knots, std::size_t i, int order,
                                        const real_50& u) {
  const auto k = std::size_t(order);
  const real_50 end = knots[knots.size() - k];
  const auto b_over = [&](std::size_t j, int lower_order, const real_50& width) {
    return width > 0 ? real_50(duet_test::b_definition(knots, j, lower_order, u, u, end) / width)
                     : real_50(0);
  };
  const real_50 width = knots[i + k - 1] - knots[i];
  const real_50 value = duet_test::cumulative_definition(knots, i, order, u, u);
  const real_50 first = (order - 1) * b_over(i, order - 1, width);
  std::array<exact_value, 3> result = {{{value, value}, {first, first}, {0, 0}}};
  if (order >= 3) {
    const real_50 factor = (order - 1) * (order - 2) / width;
    const real_50 a = factor * b_over(i, order - 2, knots[i + k - 2] - knots[i]);
    const real_50 b = factor * b_over(i + 1, order - 2, knots[i + k - 1] - knots[i + 1]);
    result[2] = {a - b, a + b};
  }
  return result;
}

/// Squared norms of B̃, B̃′, B̃″, B̃‴ as vectors of all B̃_i that are not zero on a span, B̃_first ≡ 1
/// included.
using squared_norms = std::array<real_50, 4>;

template <int Order>
void check_order() {
  constexpr auto k = std::size_t(Order);
  const std::string of_order = ", order " + std::to_string(Order);
  std::array<worst_error, 3> worst = {worst_error("P1" + of_order), worst_error("P3" + of_order),
                                      worst_error("P4" + of_order)};
  for (const duet_test::named_knots& each : duet_test::knot_vectors(Order)) {
    const std::string& name = each.name;
    const std::vector<double>& knots = each.knots;
    const duet::bspline_basis<Order> basis(knots);
    const auto wide = cast<real_50>(knots);
    std::vector<real_50> largest_second(basis.breaks().size(), 0);
    const auto measure = [&](double u, auto&& use) {
      const std::size_t span = basis.find_span(u);
      const auto computed = basis.template weights<3>(span, u);
      std::array<std::array<real_50, k - 1>, 3> exact;
      squared_norms squares = {1, 0, 0, 0};
      for (std::size_t j = 0; j + 1 < k; ++j) {
        const auto forms =
            closed_forms(wide, basis.first_function(span) + 1 + j, Order, real_50(u));
        for (std::size_t d = 0; d < 3; ++d) {
          exact[d][j] = forms[d].value;
          squares[d] += forms[d].of_absolute_terms * forms[d].of_absolute_terms;
        }
        squares[3] += real_50(computed[3][j]) * computed[3][j]; // only for the scale
      }
      use(span, computed, exact, squares);
    };
    const auto parameters = parameters_on(knots, Order, 2);
    for (const double u : parameters) {
      measure(u, [&](std::size_t span, const auto&, const auto&, const squared_norms& squares) {
        largest_second[span] = std::max(largest_second[span], real_50(sqrt(squares[2])));
      });
    }
    for (const double u : parameters) {
      measure(u, [&](std::size_t span, const auto& computed, const auto& exact,
                     const squared_norms& squares) {
        for (std::size_t d = 0; d < 3; ++d) {
          // A polynomial of high degree may touch zero near large values. One representation on the
          // entire span is accurate relative to its largest value only.
          const bool of_span = d == 2 && Order >= 5;
          const real_50 size = of_span ? largest_second[span] : real_50(sqrt(squares[d]));
          const real_50 scale = size + sqrt(squares[d + 1]) * abs(u);
          worst[d].add(ulps_of_range<double>(computed[d], exact[d], scale), name, u);
        }
      });
    }
  }
  for (const worst_error& w : worst) {
    CHECK_MESSAGE(w <= 4, w);
  }
}

TEST_CASE("P1, P3, P4: the cumulative basis and its derivatives are within 4 ulp of 50 digits") {
  check_order<2>();
  check_order<3>();
  check_order<4>();
  check_order<5>();
  check_order<6>();
  check_order<7>();
}

} // namespace
} // namespace test_spline_basis
