// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/lanes.hpp"
#include "support/test.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/dual/level.hpp>
#include <duet/dual/second_dual.hpp>
#include <duet/dual/taylor.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/quaternion/exponential.hpp>

// exp(b v) by the universal functions of b and |v|² against the exponential of the product, whose
// own tests are against many digits. The two share no formula for derivatives with respect to b.

namespace test_quaternion_exponential_of_multiple {
namespace {

using namespace duet;
using duet::detail::exp_of_multiple;

/// Largest absolute value of all real numbers in x − y.
template <class T>
double difference(const T& x, const T& y) {
  double result = 0;
  static_cast<void>(duet::detail::map_reals(T(x - y), [&](const auto& part) {
    result = std::max(result, part == part ? std::abs(double(part)) : 1e300);
    return part;
  }));
  return result;
}

template <class S, class T>
void check(const S& b, const vector3<T>& v, double tolerance) {
  using D = promote_t<S, T>;
  const auto q = exp_of_multiple(b, v);
  const auto expected = duet::exp(vector3<D>(D(b) * D(v[0]), D(b) * D(v[1]), D(b) * D(v[2])));
  CHECK(difference(q.w(), expected.w()) <= tolerance);
  CHECK(difference(q.x(), expected.x()) <= tolerance);
  CHECK(difference(q.y(), expected.y()) <= tolerance);
  CHECK(difference(q.z(), expected.z()) <= tolerance);
}

/// |v| = 0, tiny, small, and both sides of the switches of the algorithm: |bv| = 1 and 2 at b = ½.
const std::vector<double> lengths{0, 1e-200, 1e-9, 0.01, 0.7, 1.999, 2.001, 3.999, 4.001, 9};

vector3<double> vector_of(double length) { return vector3<double>(2, -1, 2) * (length / 3); }

template <class F>
void for_all(const F& f) {
  for (const double length : lengths) {
    for (const double b : {0.0, 0.5, 1.0, -0.3}) {
      CAPTURE(length);
      CAPTURE(b);
      f(b, vector_of(length), std::pow(1 + length, 4));
    }
  }
}

TEST_CASE("exp_of_multiple: derivatives with respect to the factor agree with exp of the product") {
  for_all([](double b, const vector3<double>& v, double scale) {
    check(b, v, 1e-15);
    check(dual<double, 2>(b, dual<double, 2>::partials_type::unit(1)), v, 1e-15 * scale);
    taylor<double, 4> series = taylor<double, 4>::variable(b);
    series.set_coefficient(2, 0.7);
    series.set_coefficient(4, -0.2);
    check(series, v, 4e-15 * scale);
    check(second_order_dual<double, 1>::variable(b) * second_order_dual<double, 1>::variable(b), v,
          2e-15 * scale);
  });
}

TEST_CASE("exp_of_multiple: over screws, derivatives with respect to both arguments agree") {
  struct of_data;
  using moving = dual<double, 1, of_data>;
  for_all([](double b, const vector3<double>& v, double scale) {
    const dual_vector<double> line = make_dual_vector(v, vector3<double>(0.3, 1, -0.5));
    check(b, line, 2e-15 * scale);
    check(taylor<double, 3>::variable(b), line, 4e-15 * scale);
    check(second_order_dual<double, 1>::variable(b), line, 4e-15 * scale);
    const vector3<moving> varied(moving(v[0], 1), moving(v[1], -0.4), moving(v[2], 0));
    check(b, varied, 2e-15 * scale);
    check(moving(b, 0.6), varied, 2e-15 * scale);
    const vector3<screw_dual<moving>> both(screw_dual<moving>(varied[0], moving(0.3)),
                                           screw_dual<moving>(varied[1], moving(1, 0.2)),
                                           screw_dual<moving>(varied[2], moving(-0.5)));
    check(b, both, 4e-15 * scale);
    check(taylor<double, 2>::variable(b), both, 8e-15 * scale);
  });
}

TEST_CASE("exp_of_multiple: at zero rotation the derivative is that of a translation") {
  const auto q =
      exp_of_multiple(taylor<double, 2>::variable(0.25),
                      make_dual_vector(vector3<double>::Zero().eval(), vector3<double>(1, 2, 3)));
  CHECK(q.y().value().coefficient(1) == 0);
  CHECK(q.y().epsilon().coefficient(0) == 0.5);
  CHECK(q.y().epsilon().coefficient(1) == 2);
  CHECK(q.y().epsilon().coefficient(2) == 0);
}

TEST_CASE("exp_of_multiple: batches with lanes on both sides of a switch agree") {
  const auto value = [](const auto& b) {
    return exp_of_multiple(b, vector3<double>(vector_of(4)));
  };
  const auto pose = [](const auto& b) {
    return exp_of_multiple(b, make_dual_vector(vector_of(4), vector3<double>(0.3, 1, -0.5)));
  };
  const std::vector<double> at{0.1, 0.249, 0.251, 0.49, 0.51, 1, 0};
  duet_test::check_lanes<4>(value, 4, at);
  duet_test::check_lanes<4>(pose, 4, at);
}

} // namespace
} // namespace test_quaternion_exponential_of_multiple
