// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "quaternion/truth.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/rotation.hpp>

// N3, N4, N5, N9 over every kind of scalar, each at its own precision.

namespace test_quaternion_scalars {
namespace {

using duet::dual, duet::quaternion, duet_test::random_source, duet_test::real_50;
namespace reference = duet_test::reference;

struct outer;
using nested = dual<dual<double>, 2, outer>;
using duet_test::real_100;

template <class T>
quaternion<real_100> widened(const quaternion<T>& q) {
  const auto value = duet::detail::innermost_of(q);
  return {real_100(value.w()), real_100(value.x()), real_100(value.y()), real_100(value.z())};
}

/// Distance of the values from the reference, in units of the epsilon of the type.
template <class T>
double distance(const quaternion<T>& q, const reference::four& exact) {
  const real_100 epsilon(std::numeric_limits<duet::real_type_t<T>>::epsilon());
  return double(real_100(reference::length(reference::sum(reference::wide(widened(q)), exact, -1)) /
                         epsilon));
}

TEST_CASE_TEMPLATE("N3, N4, N5, N9: values agree over every scalar to its precision", T, float,
                   double, long double, dual<double>, dual<float, 3>, nested,
                   duet::taylor<double, 2>, real_50) {
  using real = duet::real_type_t<T>;
  random_source random(61);
  const double sizes[] = {1e-30, 1e-8, 1e-4, 0.1, 0.7, 0.99, 1.01, 1.4, 2.1, 2.9, 3.1415};
  for (const double size : sizes) {
    const auto d = random.direction<3>();
    const quaternion<T> v(T(0), T(real(size * d[0])), T(real(size * d[1])), T(real(size * d[2])));
    const auto x = reference::wide(widened(v));
    const auto e = duet::exp(v);
    CHECK(distance(e, reference::exp(x)) <= 2);
    const auto y = reference::wide(widened(e));
    if (size < 3) {
      CHECK(distance(log(e), reference::log(y)) <= 8);
    }
    CHECK(distance(pow(e, real(0.3F)), reference::pow(y, real_100(0.3F))) <= 8);
    CHECK(distance(pow(e, T(2)), reference::product(y, y)) <= 8);
    const quaternion<T> a = normalized(quaternion<T>(T(1), T(real(d[1])), T(real(d[2])), T(2)));
    const auto b = size < 1.5 ? a * e : a * -e;
    CHECK(distance(slerp(a, b, real(0.25F)), reference::slerp(reference::wide(widened(a)),
                                                              reference::wide(widened(b)), 0.25)) <=
          (size < 1.5 || size > 1.7 ? 8 : 1e3));
    CHECK(distance(inverse(e) * e, {1, 0, 0, 0}) <= 4);
    CHECK(distance(quaternion<T>(norm(e)), {reference::length(y), 0, 0, 0}) <= 2);
    const auto matrix = rotation_matrix(e);
    CHECK(distance(duet::from_rotation_matrix(matrix),
                   duet::innermost(dot(e, duet::from_rotation_matrix(matrix))) < 0
                       ? reference::times(y, -1)
                       : y) <= 8);
  }
}

TEST_CASE("log: values and derivatives near a full turn are correct in single precision") {
  for (const float length : {1e-30F, 1e-20F, 1e-10F, 1e-5F, 1e-3F}) {
    using D = dual<float>;
    const quaternion<D> q(D(-1), D(0), D(length, 1.0F), D(0));
    const auto l = log(q);
    CHECK(float(l.y()) == doctest::Approx(3.14159265F - length).epsilon(1e-6));
    CHECK(l.y().epsilon() == doctest::Approx(-1).epsilon(1e-3));
    const auto across = log(quaternion<D>(D(-1), D(0, 1.0F), D(length), D(0)));
    CHECK(across.x().epsilon() == doctest::Approx(3.14159265F / length - 1).epsilon(1e-5));
  }
}

} // namespace
} // namespace test_quaternion_scalars
