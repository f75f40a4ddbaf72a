// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"

namespace test_spline_basis_domain {
namespace {

using duet::bspline_basis;
using duet::invalid_input;
using duet_test::message_of;

using numbers = std::vector<double>;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// P1 as printed: closed at both ends, u_i ≤ u ≤ u_{i+1}.
double closed_at_both_ends(const numbers& t, std::size_t i, int order, double u) {
  if (order == 1) {
    return t[i] <= u && u <= t[i + 1] ? 1 : 0;
  }
  const auto k = std::size_t(order);
  double sum = 0;
  if (t[i] < t[i + k - 1]) {
    sum += (u - t[i]) / (t[i + k - 1] - t[i]) * closed_at_both_ends(t, i, order - 1, u);
  }
  if (t[i + 1] < t[i + k]) {
    sum += (t[i + k] - u) / (t[i + k] - t[i + 1]) * closed_at_both_ends(t, i + 1, order - 1, u);
  }
  return sum;
}

template <class F>
double sum_of_all(const numbers& t, int order, F&& value) {
  double sum = 0;
  for (std::size_t i = 0; i + std::size_t(order) < t.size(); ++i) {
    sum += value(i);
  }
  return sum;
}

template <int Order>
std::string error_message(const numbers& t) {
  return message_of([&] { (void)bspline_basis<Order>(t); });
}

TEST_CASE("P1 as printed, closed at both ends, breaks the partition of unity at simple knots") {
  const numbers t = {0, 1, 2, 3, 4, 5, 6, 7};
  for (int order = 2; order <= 4; ++order) {
    CAPTURE(order);
    const auto printed = [&](double u) {
      return sum_of_all(t, order,
                        [&](std::size_t i) { return closed_at_both_ends(t, i, order, u); });
    };
    const auto half_open = [&](double u) {
      return sum_of_all(t, order,
                        [&](std::size_t i) { return duet::basis_function(t, i, order, u); });
    };
    CHECK(printed(3.5) == doctest::Approx(1)); // between knots there is no difference
    CHECK(printed(4.0) == doctest::Approx(2)); // two intervals contain a knot
    CHECK(half_open(3.5) == doctest::Approx(1));
    CHECK(half_open(4.0) == doctest::Approx(1));
  }
}

TEST_CASE("bspline_basis: spans are half-open, the last one of the domain is closed") {
  const bspline_basis<3> basis({0, 0, 0, 1, 1, 2, 4, 4, 4});
  CHECK(basis.breaks() == numbers{0, 1, 2, 4});
  CHECK(basis.front() == 0);
  CHECK(basis.back() == 4);
  CHECK(basis.size() == 6);
  CHECK(basis.find_span(0) == 0);
  CHECK(basis.find_span(std::nextafter(1, 0)) == 0);
  CHECK(basis.find_span(1) == 1);
  CHECK(basis.find_span(std::nextafter(2, 0)) == 1);
  CHECK(basis.find_span(2) == 2);
  CHECK(basis.find_span(std::nextafter(4, 0)) == 2);
  CHECK(basis.find_span(4) == 2);
  CHECK(basis.first_function(0) == 0);
  CHECK(basis.first_function(1) == 2); // at a double knot two functions end
  CHECK(basis.first_function(2) == 3);
}

TEST_CASE("bspline_basis: find_span is correct for random uneven and repeated knots") {
  duet_test::random_source random(11);
  for (int repeat = 0; repeat < 50; ++repeat) {
    numbers t;
    double u = random.uniform(-5, 5);
    for (int i = 0; i < 40; ++i) {
      t.push_back(u);
      u += random.integer(0, 4) == 0 ? 0 : random.log_uniform(1e-6, 10);
    }
    if (t[3] == t[36]) {
      continue;
    }
    bspline_basis<4> basis({0, 0, 0, 0, 1, 1, 1, 1});
    try {
      basis = bspline_basis<4>(t);
    } catch (const invalid_input&) {
      continue; // a knot is repeated five times, which the basis rejects
    }
    for (const double at : duet_test::parameters_on(t, 4)) {
      const std::size_t span = basis.find_span(at);
      CHECK(basis.breaks()[span] <= at);
      const bool last = span + 2 == basis.breaks().size();
      CHECK((at < basis.breaks()[span + 1] || (last && at == basis.breaks()[span + 1])));
    }
  }
}

TEST_CASE("bspline_basis: the domain is closed even if knots follow a knot of full multiplicity") {
  const numbers t = {0, 0, 0, 1, 1, 1, 2};
  const bspline_basis<3> basis(t); // domain [0, 1], knots beyond it
  CHECK(basis.size() == 4);
  CHECK(basis.back() == 1);
  CHECK(duet::basis_function(t, 2, 3, 1.0) == 1);
  CHECK(duet::basis_function(t, 3, 3, 1.0) == 0);
  const double sum =
      sum_of_all(t, 3, [&](std::size_t i) { return duet::basis_function(t, i, 3, 1.0); });
  CHECK(sum == 1);
}

TEST_CASE("bspline_basis: errors name invalid knots") {
  CHECK(error_message<4>({0, 1, 2, 3, 4, 5, 6}) ==
        "duet: knots: order 4 needs at least 8 knots, got 7 (clamped_knots(parameters, 4) makes "
        "enough)");
  CHECK(error_message<4>({}).starts_with("duet: knots: order 4 needs at least 8 knots, got 0"));
  CHECK(error_message<2>({0, 1, 0.5, 2}) == "duet: knots: knot 2 = 0.5 is less than knot 1 = 1");
  CHECK(error_message<2>({0, 1, not_a_number, 2}) ==
        "duet: knots: knot 2 is nan (expected a finite number)");
  CHECK(error_message<2>({0, 1, 2, infinity}) ==
        "duet: knots: knot 3 is inf (expected a finite number)");
  CHECK(error_message<2>({0, 1, 1, 1, 2, 3}) ==
        "duet: knots: knot 3 = 1 is repeated more than 2 times");
  CHECK(error_message<3>({0, 0, 1, 1, 2, 2}) == "duet: knots: the domain from 1 to 1 is empty");
  CHECK(error_message<2>({0, 0, 5e-324, 5e-324}) ==
        "duet: knots: knot 1 = 0 and knot 2 = 4.94066e-324 are too close: a derivative overflows");
  CHECK(error_message<2>({-1.7e308, -1.7e308, 1.7e308, 1.7e308}) ==
        "duet: knots: the distance from -1.7e+308 to 1.7e+308 overflows");
}

TEST_CASE("cumulative_bspline: parameters outside the domain throw, with the value") {
  const duet::cumulative_bspline<double, 3> s({0, 1, 2, 3, 4, 5},
                                              duet_test::random_orientations(3, 0.4));
  CHECK_NOTHROW((void)s(2.0));
  CHECK_NOTHROW((void)s(3.0));
  const auto of = [&](double u) { return message_of([&] { (void)s(u); }); };
  CHECK(of(1.5).starts_with("duet: spline evaluated at 1.5, outside its domain [2, 3]; "));
  CHECK(of(4).starts_with("duet: spline evaluated at 4, outside its domain [2, 3]; "));
  CHECK(of(not_a_number) == "duet: spline evaluated at nan, outside its domain [2, 3]");
  CHECK(of(-infinity).starts_with("duet: spline evaluated at -inf, outside its domain [2, 3]; "));
  CHECK_THROWS_AS((void)s.motion(not_a_number, duet::frame::body), invalid_input);
  CHECK_THROWS_AS((void)s.derivatives(5.0), invalid_input);
}

} // namespace
} // namespace test_spline_basis_domain
