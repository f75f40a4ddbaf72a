// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"

namespace test_spline_printed {
namespace {

using duet::cumulative_bspline;
using duet::printed_derivative;
using duet_test::b_definition;
using duet_test::knot_vectors;
using duet_test::max_abs_difference;
using duet_test::parameters_on;

using quaternion = duet::quaternion<double>;
using vector = duet::vector3<double>;

double size(const quaternion& q) { return std::sqrt(squared_norm(q)); }
double relative(const quaternion& reference, const quaternion& q) {
  return size(reference - q) / size(reference);
}

/// Control quaternions about one axis: all ω_i are parallel.
std::vector<quaternion> about_one_axis(std::size_t count) {
  std::vector<quaternion> result;
  for (std::size_t i = 0; i < count; ++i) {
    result.push_back(
        duet::from_axis_angle(vector(1, 2, -2), 0.4 * double(i * i % 7) + 0.1 * double(i)));
  }
  return result;
}

/// Derivatives B̃′_i and B̃″_i as printed in P3 and P4; i counts from the first control point.
std::array<double, 2> as_printed(const std::vector<double>& knots, std::size_t i, int order,
                                 double u) {
  const auto k = std::size_t(order);
  const double end = knots[knots.size() - k];
  const double width = knots[i + k - 1] - knots[i];
  const double shorter = knots[i + k - 2] - knots[i];
  if (width == 0) {
    return {0, 0};
  }
  return {(order - 1) / width * b_definition(knots, i, order - 1, u, u, end),
          shorter > 0 ? (order - 1) * (order - 2) / (width * shorter) *
                            b_definition(knots, i, order - 2, u, u, end)
                      : 0};
}

TEST_CASE("P3, P4 as printed: printed_derivative agrees with the literal formulas") {
  const auto check = [](auto order) {
    constexpr int k = order;
    for (const duet_test::named_knots& each : knot_vectors(k)) {
      const std::string& name = each.name;
      const std::vector<double>& knots = each.knots;
      CAPTURE(k);
      CAPTURE(name);
      const std::size_t count = knots.size() - std::size_t(k);
      const cumulative_bspline<double, k> s(knots, duet_test::random_orientations(count, 1));
      for (const double u : parameters_on(knots, k, 2)) {
        // The sums contain vectors and, for i = 0 of the paper, a single scalar.
        vector sum = vector::Zero(), sum_of_second = vector::Zero();
        for (std::size_t i = 2; i < count; ++i) {
          const auto b = as_printed(knots, i, k, u);
          sum += s.increments()[i] * b[0];
          sum_of_second += s.increments()[i] * b[1];
        }
        const auto lone = as_printed(knots, 1, k, u);
        const quaternion first(lone[0], sum);
        const quaternion first_in_p4(lone[1], sum); // the print has B̃″_0 twice
        const quaternion second(lone[1], sum_of_second);
        const quaternion q = s(u);
        const auto printed = printed_derivative(s, u);
        const quaternion literal_second = q * first * first_in_p4 + q * second;
        CHECK(max_abs_difference(printed.literal_first, q * first) <= 1e-13 * (1 + size(first)));
        CHECK(max_abs_difference(printed.literal_second, literal_second) <=
              1e-13 * (1 + size(first) * size(first_in_p4) + size(second)));
        // With functions from B_0 the first control point is q_0: the sums are over all control
        // points after it, and B̃′_0 = B̃″_0 = 0 on the domain.
        const auto zero = as_printed(knots, 0, k, u);
        CHECK(zero[0] == 0);
        CHECK(zero[1] == 0);
        const quaternion all(0, sum + s.increments()[1] * lone[0]);
        const quaternion all_of_second(0, sum_of_second + s.increments()[1] * lone[1]);
        CHECK(max_abs_difference(printed.from_zero_first, q * all) <= 1e-13 * (1 + size(all)));
        CHECK(max_abs_difference(printed.from_zero_second, q * all * all + q * all_of_second) <=
              1e-13 * (1 + size(all) * size(all) + size(all_of_second)));
        CHECK(max_abs_difference(printed.from_zero_first, printed.commuting_first) <=
              1e-13 * (1 + size(all)));
      }
    }
  };
  check(std::integral_constant<int, 3>{});
  check(std::integral_constant<int, 4>{});
  check(std::integral_constant<int, 5>{});
}

TEST_CASE("P3, P4: for parallel ω_i the commuting sums equal the derivatives on every span") {
  for (const duet_test::named_knots& each : knot_vectors(4)) {
    const std::string& name = each.name;
    const std::vector<double>& knots = each.knots;
    CAPTURE(name);
    const cumulative_bspline<double> s(knots, about_one_axis(knots.size() - 4));
    double worst = 0;
    for (const double u : parameters_on(knots, 4)) {
      const auto reference = s.derivatives(u);
      const auto printed = printed_derivative(s, u);
      worst = std::max(worst, max_abs_difference(printed.commuting_first, reference[1]) /
                                  (1 + size(reference[1])));
      worst = std::max(worst, max_abs_difference(printed.commuting_second, reference[2]) /
                                  (1 + size(reference[2])));
    }
    CHECK(worst < 1e-13);
  }
}

TEST_CASE("P3 as printed is correct only for parallel ω_i and on spans with B̃′_0 = 0") {
  const auto knots = knot_vectors(4)[1].knots;
  const cumulative_bspline<double> parallel(knots, about_one_axis(knots.size() - 4));
  const cumulative_bspline<double> general(knots,
                                           duet_test::random_orientations(knots.size() - 4, 1));
  int in_first_span = 0, beyond = 0;
  for (const double u : parameters_on(knots, 4)) {
    const double lone = as_printed(knots, 1, 4, u)[0];
    const double error =
        relative(parallel.derivatives(u)[1], printed_derivative(parallel, u).literal_first);
    CAPTURE(u);
    if (parallel.basis().find_span(u) == 0) {
      if (lone < 1e-3) {
        continue;
      } // B̃′_0 vanishes at the ends of the span
      CHECK(error > 1e-4);
      ++in_first_span;
    } else {
      CHECK(lone < 1e-15);
      CHECK(error < 1e-12);
      CHECK(relative(general.derivatives(u)[1], printed_derivative(general, u).literal_first) >
            1e-4);
      ++beyond;
    }
  }
  CHECK(in_first_span >= 5);
  CHECK(beyond > 10);
}

TEST_CASE("P4 as printed is wrong even for parallel ω_i, because B̃″_i lacks a term") {
  const auto knots = knot_vectors(4)[1].knots;
  const cumulative_bspline<double> s(knots, about_one_axis(knots.size() - 4));
  int count = 0;
  for (const double u : parameters_on(knots, 4)) {
    if (s.basis().find_span(u) > 0 && u != s.basis().back()) {
      CAPTURE(u);
      CHECK(relative(s.derivatives(u)[2], printed_derivative(s, u).literal_second) > 1e-3);
      ++count;
    }
  }
  CHECK(count > 10);
}

TEST_CASE("P3, P4: for random ω_i the commuting sums differ from the derivatives") {
  const auto knots = knot_vectors(4)[1].knots;
  const cumulative_bspline<double> s(knots, duet_test::random_orientations(knots.size() - 4, 1));
  for (const double u : parameters_on(knots, 4)) {
    const auto reference = s.derivatives(u);
    const auto printed = printed_derivative(s, u);
    CHECK(relative(reference[1], printed.commuting_first) > 1e-3);
    CHECK(relative(reference[2], printed.commuting_second) > 1e-3);
    CHECK(relative(reference[2], printed.from_zero_second) > 1e-3);
  }
}

TEST_CASE("P3, P4: relative errors of the commuting sums are proportional to the step of the "
          "control points") {
  // With control points `step` apart, Q′ is proportional to step, its error to step² (commutators).
  const auto knots = knot_vectors(4)[0].knots;
  const double u = 0.6;
  const auto errors = [&](double step) {
    const cumulative_bspline<double> s(knots,
                                       duet_test::random_orientations(knots.size() - 4, step));
    const auto printed = printed_derivative(s, u);
    return std::array{relative(s.derivatives(u)[1], printed.commuting_first),
                      relative(s.derivatives(u)[2], printed.commuting_second)};
  };
  const auto coarse = errors(0.02), fine = errors(0.01);
  CHECK(coarse[0] / fine[0] == doctest::Approx(2).epsilon(0.05));
  CHECK(coarse[1] / fine[1] == doctest::Approx(2).epsilon(0.05));
}

TEST_CASE("printed_derivative: parameters outside the domain throw") {
  const cumulative_bspline<double> s({0, 0, 0, 0, 1, 1, 1, 1},
                                     duet_test::random_orientations(4, 1));
  CHECK_THROWS_AS((void)printed_derivative(s, 1.5), duet::invalid_input);
}

} // namespace
} // namespace test_spline_printed
