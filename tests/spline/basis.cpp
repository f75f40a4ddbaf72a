// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"
#include "support/identical.hpp"

#include <duet/duet.hpp>

namespace test_spline_basis {

using duet_test::cumulative_definition;
using duet_test::knot_vectors;
using duet_test::parameters_on;

namespace {

constexpr double tolerance = 1e-13;

/// Cumulative function i of a basis, 0 and 1 outside its support included.
template <int Order>
double cumulative(const duet::bspline_basis<Order>& basis, std::size_t i, double u) {
  const std::size_t span = basis.find_span(u);
  const std::size_t first = basis.first_function(span);
  if (i <= first) {
    return 1;
  }
  return i >= first + std::size_t(Order) ? 0 : basis.template weights<0>(span, u)[0][i - first - 1];
}

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

} // namespace

TEST_CASE("P1: the recurrence, its definition and the stored polynomials agree") {
  for_each_case([](auto order, const std::vector<double>& knots) {
    constexpr int k = order;
    const duet::bspline_basis<k> basis(knots);
    REQUIRE(basis.size() == knots.size() - std::size_t(k));
    double worst = 0;
    for (const double u : parameters_on(knots, k)) {
      for (std::size_t i = 0; i < basis.size(); ++i) {
        const double stored = cumulative(basis, i, u) - cumulative(basis, i + 1, u);
        worst = std::max(worst, std::abs(stored - duet::basis_function(knots, i, k, u)));
        const double definition = duet_test::b_definition(knots, i, k, u, u, knots[basis.size()]);
        worst = std::max(worst, std::abs(stored - definition));
      }
    }
    CHECK(worst <= tolerance + duet_test::if_fused(2 * tolerance));
  });
}

TEST_CASE("P1: basis functions are non-negative, have local support and sum to 1") {
  for_each_case([](auto order, const std::vector<double>& knots) {
    constexpr int k = order;
    const std::size_t size = knots.size() - std::size_t(k);
    for (const double u : parameters_on(knots, k)) {
      double sum = 0;
      bool proper = true;
      for (std::size_t i = 0; i < size; ++i) {
        const double b = duet::basis_function(knots, i, k, u);
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

TEST_CASE("P2: cumulative functions are the sums of basis functions") {
  for_each_case([](auto order, const std::vector<double>& knots) {
    constexpr int k = order;
    const duet::bspline_basis<k> basis(knots);
    double worst = 0;
    for (const double u : parameters_on(knots, k, 2)) {
      for (std::size_t i = 0; i < basis.size(); ++i) {
        const double sum = cumulative_definition(knots, i, k, u, u);
        worst = std::max(worst, std::abs(cumulative(basis, i, u) - sum));
      }
    }
    CHECK(worst <= tolerance + duet_test::if_fused(2 * tolerance));
  });
}

TEST_CASE("P3, P4: closed-form derivatives of the weights agree with Taylor and dual numbers") {
  for_each_case([](auto order, const std::vector<double>& knots) {
    constexpr int k = order;
    constexpr std::size_t count = std::size_t(k) - 1;
    const duet::bspline_basis<k> basis(knots);
    double worst = 0;
    double worst_of_definition = 0;
    for (const double u : parameters_on(knots, k, 2)) {
      const std::size_t span = basis.find_span(u);
      const auto closed = basis.template weights<3>(span, u);
      const auto weights = [&](const auto& x) { return basis.template weights<0>(span, x)[0]; };
      const auto taylor = duet::derivatives<3>(weights, u);
      const auto dual = duet::derivative(weights, u);
      const auto nested = duet::derivative(
          [&](const auto& x) {
            return duet::derivative([&](const auto& y) { return weights(y); }, x).derivative;
          },
          u);
      // The definition as a polynomial, through Taylor numbers.
      const std::size_t first = basis.first_function(span);
      std::array<double, 4> size{};
      for (std::size_t d = 0; d <= 3; ++d) {
        for (const double x : closed[d]) {
          size[d] = std::max(size[d], std::abs(x));
        }
      }
      for (std::size_t j = 0; j < count; ++j) {
        const auto definition = duet::derivatives<3>(
            [&](const auto& x) { return cumulative_definition(knots, first + 1 + j, k, x, u); }, u);
        for (std::size_t d = 0; d <= 3; ++d) {
          const double scale = size[d] + 1e-3;
          worst = std::max(worst, std::abs(closed[d][j] - taylor[d][j]) / scale);
          worst_of_definition =
              std::max(worst_of_definition, std::abs(closed[d][j] - definition[d]) / scale);
        }
        worst = std::max(worst, std::abs(closed[1][j] - dual.derivative[j]) / (size[1] + 1e-3));
        worst = std::max(worst, std::abs(closed[2][j] - nested.derivative[j]) / (size[2] + 1e-3));
      }
    }
    CHECK(worst <= tolerance + duet_test::if_fused(2 * tolerance));
    CHECK(worst_of_definition <= 100 * tolerance); // the recurrence itself has cancellation
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

} // namespace test_spline_basis
