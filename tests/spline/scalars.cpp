// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"
#include "support/multiprecision.hpp"

namespace test_spline_scalars {
namespace {

using duet::cumulative_bspline;
using duet::dual;
using duet::quaternion;
using duet::taylor;
using duet_test::cast;
using duet_test::max_abs_difference;

const std::vector<double> knots = duet_test::knot_vectors(4)[1].knots;
const std::vector<quaternion<double>> controls =
    duet_test::random_orientations(knots.size() - 4, 1);
const cumulative_bspline<double> reference(knots, controls);
const std::vector<double> parameters = duet_test::parameters_on(knots, 4, 2);

template <class T>
void check_real(double tolerance) {
  const cumulative_bspline<T> s(cast<T>(knots), cast<T>(controls));
  for (const double parameter : parameters) {
    // Rounded to float, a parameter next to a knot may leave its span, or the domain.
    const double u = std::is_same_v<T, float> ? double(float(parameter)) : parameter;
    if (u < knots[3] || u > knots[knots.size() - 4]) {
      continue;
    }
    const auto expected = reference.motion(u, duet::frame::spatial);
    const auto m = s.motion(T(u), duet::frame::spatial);
    CHECK(max_abs_difference(m.value, expected.value) < tolerance);
    for (int j = 0; j < 3; ++j) {
      CHECK(std::abs(double(m.velocity[j]) - expected.velocity[j]) < 50 * tolerance);
      CHECK(std::abs(double(m.acceleration[j]) - expected.acceleration[j]) < 1000 * tolerance);
    }
    CHECK(max_abs_difference(s.derivatives(T(u))[1], reference.derivatives(u)[1]) < 50 * tolerance);
  }
}

TEST_CASE("cumulative_bspline: float, long double and 50 digits agree with double") {
  check_real<float>(1e-6);
  check_real<long double>(1e-15);
  check_real<duet_test::real_50>(1e-15);
}

TEST_CASE("cumulative_bspline: parameters of any number type give values of the promoted type") {
  static_assert(std::is_same_v<decltype(reference(1.0f)), quaternion<double>>);
  static_assert(std::is_same_v<decltype(reference(dual<double>(1))), quaternion<dual<double>>>);
  static_assert(
      std::is_same_v<decltype(reference(taylor<double, 2>(1))), quaternion<taylor<double, 2>>>);
  const std::vector<double> round = {0, 0, 0, 0, 1, 2, 3, 3, 3, 3};
  const cumulative_bspline<double> s(round, duet_test::random_orientations(6, 1));
  CHECK(s(1) == s(1.0));
  CHECK(s(0.5f) == s(0.5));
  CHECK(s.motion(2, duet::frame::body).velocity == s.motion(2.0, duet::frame::body).velocity);
  // The parameter has more digits than the numbers of the curve.
  const duet_test::real_50 fine = s(duet_test::real_50(1.5)).w();
  CHECK(double(fine) == doctest::Approx(s(1.5).w()).epsilon(1e-15));
}

TEST_CASE("cumulative_bspline: dual and Taylor parameters give the derivatives on the span of the "
          "value") {
  for (const double u : parameters) {
    const auto expected = reference.derivatives(u);
    const auto by_dual = reference(dual<double>::variable(u));
    const auto by_taylor = reference(taylor<double, 2>::variable(u));
    const double size = 1 + std::sqrt(squared_norm(expected[2]));
    CHECK(by_dual.x().value() == doctest::Approx(expected[0].x()).epsilon(1e-15));
    CHECK(std::abs(by_dual.y().epsilon() - expected[1].y()) < 1e-14 * size);
    CHECK(std::abs(by_taylor.z().derivative(1) - expected[1].z()) < 1e-14 * size);
    CHECK(std::abs(by_taylor.w().derivative(2) - expected[2].w()) < 1e-13 * size);
  }
}

TEST_CASE(
    "cumulative_bspline: derivatives with respect to a control quaternion agree with differences") {
  using number = dual<double, 3>;
  constexpr std::size_t moved = 4;
  std::vector<quaternion<number>> variable = cast<number>(controls);
  const duet::vector3<number> delta(number::variable(0, 0), number::variable(0, 1),
                                    number::variable(0, 2));
  variable[moved] = duet::manifold<quaternion<double>>::plus(controls[moved], delta);
  const cumulative_bspline<number> s(knots, variable);

  constexpr double h = 1e-6;
  for (int axis = 0; axis < 3; ++axis) {
    const auto shifted = [&](double by) {
      std::vector<quaternion<double>> c = controls;
      duet::vector3<double> d = duet::vector3<double>::Zero();
      d[axis] = by;
      c[moved] = duet::manifold<quaternion<double>>::plus(c[moved], d);
      return cumulative_bspline<double>(knots, c);
    };
    const auto ahead = shifted(h), behind = shifted(-h);
    for (const double u : parameters) {
      const auto m = s.motion(u, duet::frame::body);
      const auto a = ahead.motion(u, duet::frame::body), b = behind.motion(u, duet::frame::body);
      const double size = 1 + reference.motion(u, duet::frame::body).acceleration.norm();
      CHECK(std::abs(m.value.x().partial(axis) - (a.value.x() - b.value.x()) / (2 * h)) < 1e-8);
      for (int j = 0; j < 3; ++j) {
        const double difference = (a.acceleration[j] - b.acceleration[j]) / (2 * h);
        CHECK(std::abs(m.acceleration[j].partial(axis) - difference) < 1e-7 * size);
      }
    }
  }
}

} // namespace
} // namespace test_spline_scalars
