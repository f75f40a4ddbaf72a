// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"
#include "support/lanes.hpp"

#include <duet/spline/fit.hpp>

// Sums of steps may end a few ulp beyond the domain: such parameters count as its end.

namespace test_spline_ends_by_rounding {
namespace {

using duet::out_of_domain;
using duet_test::message_of;
using cumulative = duet::cumulative_bspline<double>;
using quintic = duet::rotation_vector_spline<double, 6>;

constexpr double infinity = std::numeric_limits<double>::infinity();

template <class Spline>
Spline curve_over(double first, double last) {
  const std::vector<double> u{first, first + (last - first) / 3, last};
  const auto q = duet_test::random_orientations(5, 0.7);
  if constexpr (std::is_same_v<Spline, quintic>) {
    const Eigen::Vector3d still = Eigen::Vector3d::Zero();
    return {u,
            {q[0], q[1], q[2]},
            {{q[1].vec(), q[0].vec()}, {q[2].vec(), q[1].vec()}, {still, still}}};
  } else {
    return {duet::clamped_knots(u, 4), q};
  }
}

/// Number that is k ulp beyond an end.
double beyond(double end, double ulp, int k, bool is_last) {
  return is_last ? end + k * ulp : end - k * ulp;
}

TEST_CASE_TEMPLATE(
    "curve: parameters up to 8 ulp of the larger end beyond the domain count as its end", Spline,
    cumulative, quintic) {
  const std::array<std::array<double, 2>, 6> domains{
      {{0, 4}, {-4, 0}, {-0.3, 0.7}, {1e9, 1e9 + 1}, {-1e-3, 1e-7}, {2, 1e12}}};
  for (const auto& [first, last] : domains) {
    auto s = curve_over<Spline>(first, last);
    const double size = std::max(std::abs(first), std::abs(last));
    const double ulp = std::nextafter(size, infinity) - size;
    for (const bool is_last : {false, true}) {
      const double end = is_last ? last : first;
      const auto at_end = s.motion(end, duet::frame::body);
      const auto derivative = s(duet::dual<double>(end, 1));
      for (const int k : {1, 2, 5, 8}) {
        const double u = beyond(end, ulp, k, is_last);
        for (const auto behaviour :
             {out_of_domain::error, out_of_domain::clamp, out_of_domain::extrapolate}) {
          s.set_out_of_domain(behaviour);
          CHECK(s(u) == s(end));
          duet::span_hint hint{7};
          const auto m = s.motion(u, duet::frame::body, hint);
          CHECK(m.value == at_end.value);
          CHECK(m.velocity == at_end.velocity);
          CHECK(m.jerk == at_end.jerk);
          CHECK(s.derivatives(u)[2] == s.derivatives(end)[2]);
          CHECK(s(duet::dual<double>(u, 1)) == derivative); // one-sided, of the last segment
          duet::batch<double, 4> some(end);
          some.set(2, u);
          CHECK(duet::lane(s(some), 2) == duet::lane(s(duet::batch<double, 4>(end)), 2));
        }
        s.set_out_of_domain(out_of_domain::error);
        std::vector<double> column(9, end);
        column[5] = u;
        std::vector<decltype(s(end))> out(9);
        duet::evaluate(s, column, out);
        CHECK(out[5] == out[4]);
      }
      const double u = beyond(end, ulp, 9, is_last);
      CHECK(message_of([&] { (void)s(u); }) ==
            "duet: spline evaluated at " + duet::to_text(u) + ", outside its domain [" +
                duet::to_text(first) + ", " + duet::to_text(last) +
                "]; set_out_of_domain(out_of_domain::clamp) makes a curve stay at its end");
      s.set_out_of_domain(out_of_domain::clamp);
      CHECK(s.motion(u, duet::frame::body).velocity.isZero(0));
      s.set_out_of_domain(out_of_domain::extrapolate);
      CHECK_NOTHROW((void)s(u));
    }
  }
}

TEST_CASE_TEMPLATE("curve: usual loops over the domain do not throw because of round-off", Spline,
                   cumulative, quintic) {
  int beyond_the_end = 0;
  for (const double last : {0.7, 1.1, 4.0, 1e9 / 3, 12.566370614359172}) {
    const auto s = curve_over<Spline>(0, last);
    const double ulp = std::nextafter(last, infinity) - last;
    for (int n = 1; n <= 60; ++n) {
      const double h = last / n;
      for (int i = 0; i <= n; ++i) {
        CHECK_NOTHROW((void)s(last * i / n));
        CHECK_NOTHROW((void)s(i * h));
        beyond_the_end += i * h > last;
      }
      double u = 0;
      for (int i = 0; i < n; ++i) {
        u += h;
      }
      beyond_the_end += u > last;
      if (u <= last + 8 * ulp) {
        CHECK_NOTHROW((void)s.motion(u, duet::frame::spatial));
      } else {
        CHECK_THROWS_AS((void)s.motion(u, duet::frame::spatial), duet::invalid_input);
      }
    }
  }
  CHECK(beyond_the_end > 50); // otherwise the loops would not test the case
}

TEST_CASE(
    "curve, float basis, printed formulas and fit accept parameters beyond the end by round-off") {
  const auto s = curve_over<cumulative>(0, 4);
  CHECK(s(4 * (1 + 3e-16)) == s(4));
  CHECK(duet::printed_derivative(s, 4 * (1 + 3e-16)).commuting_second ==
        duet::printed_derivative(s, 4.0).commuting_second);
  CHECK_THROWS_AS((void)duet::printed_derivative(s, 4 * (1 + 3e-15)), duet::invalid_input);

  const duet::bspline_basis<2, float> basis({0, 0, 3, 3});
  CHECK(basis.find_span(std::nextafter(3.f, 4.f)) == 0);
  CHECK_THROWS_WITH_AS((void)basis.find_span(3.00001f),
                       doctest::Contains("evaluated at 3.00001, outside its domain [0, 3]"),
                       duet::invalid_input);

  std::vector<double> u;
  std::vector<duet::quaternion<double>> samples;
  for (int i = 0; i <= 12; ++i) {
    u.push_back(i / 3.0);
    samples.push_back(s(u.back()));
  }
  u.back() = std::nextafter(4.0, 5.0);
  const auto fitted = duet::fit<cumulative>(u, samples, s.basis().knots());
  CHECK(fitted.rms < 1e-12);
}

} // namespace
} // namespace test_spline_ends_by_rounding
