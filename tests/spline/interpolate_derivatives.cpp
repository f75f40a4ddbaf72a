// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"
#include "support/multiprecision.hpp"

// Derivatives through the solve are compared with central differences of 50-digit solutions, whose
// error is far below the round-off of doubles.

namespace test_spline_interpolate_derivatives {
namespace {

using duet::dual;
using duet::quaternion;
using duet_test::real_50;
using vector = duet::vector3<double>;
template <class T>
using curve = duet::cumulative_bspline<T>;

const std::vector<double> u = {0, 0.7, 1.1, 2, 2.6, 3.5};
const std::vector<double> between = {0, 0.3, 0.7, 0.9, 1.7, 2.3, 3.1, 3.5};

const std::vector<quaternion<double>> data = [] {
  auto q = duet_test::random_orientations(u.size(), 1.6);
  q.back() = q.front(); // as periodic ends require
  return q;
}();
/// Direction in which each sample is moved, a half-angle vector, equal for the first and the last.
const std::vector<vector> directions = [] {
  duet_test::random_source random(9);
  std::vector<vector> result;
  for (std::size_t i = 0; i < u.size(); ++i) {
    result.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
  }
  result.back() = result.front();
  return result;
}();

/// Samples exp(h · direction) q over the scalar of h.
template <class T>
std::vector<quaternion<T>> moved(const T& h) {
  std::vector<quaternion<T>> result;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const duet::vector3<T> d(h * directions[i][0], h * directions[i][1], h * directions[i][2]);
    const auto q = duet_test::cast<T>({data[i]})[0];
    result.push_back(duet::exp(d) * normalized(q));
  }
  return result;
}

const real_50 step("1e-16");

/// Derivative dS/dh at h = 0 by a central difference.
template <class Ends>
std::vector<quaternion<real_50>> differences(const Ends& ahead, const Ends& behind) {
  const std::vector<real_50> knots = duet_test::cast<real_50>(u);
  const auto a = duet::interpolate<curve<real_50>>(knots, moved(step), ahead);
  const auto b = duet::interpolate<curve<real_50>>(knots, moved(real_50(-step)), behind);
  std::vector<quaternion<real_50>> result;
  for (const double x : between) {
    result.push_back((a(real_50(x)) - b(real_50(x))) / real_50(2 * step));
  }
  return result;
}

template <class T, class Part>
void check(const curve<T>& s, const std::vector<quaternion<real_50>>& expected, Part part) {
  for (std::size_t i = 0; i < between.size(); ++i) {
    const quaternion<T> q = s(between[i]);
    CHECK(duet_test::max_abs_difference(
              quaternion<double>(part(q.w()), part(q.x()), part(q.y()), part(q.z())), expected[i]) <
          1e-14);
  }
}

template <class Ends>
void check_both(const Ends& ends) {
  const auto expected = differences(ends, ends);
  check(duet::interpolate<curve<dual<double>>>(u, moved(dual<double>::variable(0)), ends), expected,
        [](const auto& x) { return x.epsilon(); });
}

/// Compares with the dual part of poses whose translations move the data in the same directions.
template <class Ends>
void check_as_poses(const Ends& ends, const std::vector<quaternion<real_50>>& expected) {
  using number = duet::screw_dual<double>;
  check(duet::interpolate<curve<number>>(u, moved(number(0, 1)), ends), expected,
        [](const auto& x) { return x.epsilon(); });
}

TEST_CASE("interpolate, natural ends: derivatives with respect to the data and dual parts agree "
          "with 50-digit differences") {
  check_both(duet::natural{});
  check_as_poses(duet::natural{}, differences(duet::natural{}, duet::natural{}));
}

TEST_CASE("interpolate, not-a-knot and periodic ends: derivatives with respect to the data agree "
          "with 50-digit differences") {
  check_both(duet::not_a_knot{});
  check_both(duet::periodic{});
}

TEST_CASE("interpolate, clamped ends: derivatives with respect to end rates and twists at the ends "
          "of poses agree with 50-digit differences") {
  using vector_50 = duet::vector3<real_50>;
  const vector start(0.3, -0.2, 0.5), start_slope(1, 0.4, -0.3), end(-1, 0, 0.4);
  const auto rates = [&](const real_50& h) {
    return duet::clamped{vector_50(start.cast<real_50>() + h * start_slope.cast<real_50>()),
                         vector_50(end.cast<real_50>())};
  };
  const auto expected = differences(rates(step), rates(real_50(-step)));

  using D = dual<double>;
  const duet::vector3<D> variable = start.cast<D>() + D::variable(0) * start_slope.cast<D>();
  check(duet::interpolate<curve<D>>(u, moved(D::variable(0)),
                                    duet::clamped{variable, duet::vector3<D>(end.cast<D>())}),
        expected, [](const D& x) { return x.epsilon(); });

  duet::vector6<double> start_twist, end_twist;
  start_twist << start_slope, start;
  end_twist << vector::Zero(), end;
  check_as_poses(duet::clamped{start_twist, end_twist}, expected);
}

TEST_CASE_TEMPLATE("interpolate, rotation vectors: derivatives with respect to the data agree with "
                   "differences",
                   order, std::integral_constant<int, 4>, std::integral_constant<int, 6>) {
  const auto at = [](const auto& h) {
    using spline = duet::rotation_vector_spline<std::decay_t<decltype(h)>, order::value>;
    return duet::interpolate<spline>(u, moved(h), duet::not_a_knot{})(0.9);
  };
  const double h = 1e-5;
  const auto slope = at(dual<double>::variable(0));
  const auto difference = (at(h) - at(-h)) / (2 * h);
  CHECK(norm(difference) > 1e-3);
  CHECK(std::abs(slope.w().epsilon() - difference.w()) < 1e-8);
  CHECK(std::abs(slope.x().epsilon() - difference.x()) < 1e-8);
  CHECK(std::abs(slope.y().epsilon() - difference.y()) < 1e-8);
  CHECK(std::abs(slope.z().epsilon() - difference.z()) < 1e-8);
}

TEST_CASE("interpolate: second derivatives with respect to the data and derivatives of poses agree "
          "with differences") {
  // The derivative of the dual part is compared with the difference of two curves of poses, the
  // second derivative of a rotation with the difference of two first derivatives.
  using D = dual<double>;
  const double h = 1e-6;
  const auto check_second = [&](auto variable, auto at) {
    using T = decltype(variable);
    using S = decltype(at(0.0));
    const auto s = duet::interpolate<curve<T>>(u, moved(variable), duet::natural{});
    const auto a = duet::interpolate<curve<S>>(u, moved(at(h)), duet::natural{});
    const auto b = duet::interpolate<curve<S>>(u, moved(at(-h)), duet::natural{});
    for (const double x : between) {
      const auto q = s(x);
      const auto difference = (a(x) - b(x)) / (2 * h);
      CHECK(std::abs(q.w().epsilon().epsilon() - difference.w().epsilon()) < 1e-8);
      CHECK(std::abs(q.y().epsilon().epsilon() - difference.y().epsilon()) < 1e-8);
    }
  };
  struct second;
  using nested = dual<D, 1, duet::derivative_tag<second>>;
  check_second(nested(D::variable(0), D(1)), [](double x) { return D(x, 1); });
  check_second(duet::screw_dual<D>(D::variable(0), D(1)),
               [](double x) { return duet::screw_dual<double>(x, 1); });
}

} // namespace
} // namespace test_spline_interpolate_derivatives
