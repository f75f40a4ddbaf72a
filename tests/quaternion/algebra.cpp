// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/dual/taylor.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/quaternion.hpp>

// N1, N2 and N3 over every kind of scalar.

namespace test_quaternion_algebra {
namespace {

using duet::dual, duet::quaternion, duet_test::random_source;

struct outer;
using nested = dual<dual<double>, 2, outer>;

/// Small integers, also in the infinitesimal parts: sums and products are exact.
template <class T>
T whole(random_source& random) {
  if constexpr (!duet::Infinitesimal<T>) {
    return T(random.integer(-9, 9));
  } else {
    T x(whole<typename T::value_type>(random));
    if constexpr (requires { x.partials(); }) {
      x.set_partial(0, whole<typename T::value_type>(random));
    } else {
      x.set_coefficient(1, whole<typename T::value_type>(random));
    }
    return x;
  }
}
template <class T>
quaternion<T> integer_quaternion(random_source& random) {
  const T w = whole<T>(random), x = whole<T>(random), y = whole<T>(random), z = whole<T>(random);
  return {w, x, y, z};
}

// Each operation is compiled once per scalar: inlined into every law, they take minutes to compile.
template <class T>
__attribute__((noinline)) quaternion<T> sum(const quaternion<T>& p, const quaternion<T>& q) {
  return p + q;
}
template <class T>
__attribute__((noinline)) quaternion<T> difference(const quaternion<T>& p, const quaternion<T>& q) {
  return p - q;
}
template <class T>
__attribute__((noinline)) quaternion<T> product(const quaternion<T>& p, const quaternion<T>& q) {
  return p * q;
}
template <class T>
__attribute__((noinline)) quaternion<T> scaled(const T& a, const quaternion<T>& q) {
  return a * q;
}

/// True if all infinitesimal parts are equal too.
template <class T>
__attribute__((noinline)) bool same(const T& a, const T& b) {
  return duet::detail::is_structural_zero(T(a - b));
}
template <class T>
bool same(const quaternion<T>& p, const quaternion<T>& q) {
  return same(p.w(), q.w()) && same(p.x(), q.x()) && same(p.y(), q.y()) && same(p.z(), q.z());
}

constexpr quaternion<double> one(1, 0, 0, 0), i(0, 1, 0, 0), j(0, 0, 1, 0), k(0, 0, 0, 1);

// N1 at compile time: Hamilton's product.
static_assert(i * i == -one && j * j == -one && k * k == -one && i * j * k == -one);
static_assert(i * j == k && j * k == i && k * i == j);
static_assert(j * i == -k && k * j == -i && i * k == -j);
static_assert(one * i == i && i * one == i);
static_assert(quaternion<double>(1, 2, 3, 4) * quaternion<double>(5, 6, 7, 8) ==
              quaternion<double>(-60, 12, 30, 24));
// N2, N3
static_assert(conj(quaternion<double>(1, 2, 3, 4)) == quaternion<double>(1, -2, -3, -4));
static_assert(squared_norm(quaternion<double>(1, 2, 3, 4)) == 30);
static_assert(dot(quaternion<double>(1, 2, 3, 4), quaternion<double>(5, 6, 7, 8)) == 70);
// Scalars
static_assert(quaternion<double>(2) == 2 * one && one * 2 == quaternion<double>(2) &&
              one / 2 == quaternion<double>(0.5));
static_assert(quaternion<double>() == quaternion<double>(0, 0, 0, 0));
static_assert(std::is_same_v<decltype(one * quaternion<float>()), quaternion<double>>);
static_assert(std::is_same_v<decltype(one * quaternion<dual<double>>()), quaternion<dual<double>>>);
static_assert(std::is_same_v<decltype(one * dual<double>(2)), quaternion<dual<double>>>);
static_assert(std::is_trivially_copyable_v<quaternion<double>> && sizeof(quaternion<double>) == 32);
// No conversion loses precision implicitly.
static_assert(std::is_convertible_v<quaternion<float>, quaternion<double>>);
static_assert(!std::is_convertible_v<quaternion<double>, quaternion<float>>);
static_assert(std::is_constructible_v<quaternion<float>, quaternion<double>>);
static_assert(std::is_convertible_v<quaternion<double>, quaternion<dual<double>>>);
static_assert(!std::is_convertible_v<quaternion<dual<double>>, quaternion<double>>);
// Constant expressions over duals: (1 + ε i)(1 + ε j) has no εε.
static_assert([] {
  using D = dual<double>;
  constexpr quaternion<D> p(D(1), D(0, 1), D(0), D(0));
  constexpr quaternion<D> q(D(1), D(0), D(0, 1), D(0));
  constexpr auto r = p * q;
  return r.w().epsilon() == 0 && r.x().epsilon() == 1 && r.y().epsilon() == 1 &&
         r.z().epsilon() == 0;
}());

TEST_CASE_TEMPLATE("N1-N3: product, conjugate and norm obey the laws of the algebra", T, float,
                   double, long double, dual<double>, dual<double, 3>, nested,
                   duet::taylor<double, 3>, duet::taylor<dual<float>, 2, outer>,
                   duet_test::real_50) {
  random_source random(51);
  for (int n = 0; n < 20; ++n) {
    const auto p = integer_quaternion<T>(random);
    const auto q = integer_quaternion<T>(random);
    const auto r = integer_quaternion<T>(random);
    const T a = whole<T>(random);
    const auto pq = product(p, q);
    CHECK(same(product(pq, r), product(p, product(q, r))));
    CHECK(same(product(p, sum(q, r)), sum(pq, product(p, r))));
    CHECK(same(product(difference(p, q), r), difference(product(p, r), product(q, r))));
    CHECK(same(conj(pq), product(conj(q), conj(p))));
    const T square = squared_norm(p);
    CHECK(same(product(p, conj(p)), quaternion<T>(square)));
    CHECK(same(T(squared_norm(pq)), T(square * squared_norm(q))));
    CHECK(same(T(dot(p, q)), product(p, conj(q)).w()));
    CHECK(same(scaled(a, p), p * a));
    CHECK(same(product(scaled(a, p), q), scaled(a, pq)));
    CHECK(same(-p, difference(quaternion<T>(), p)));
    CHECK(same(+p, p));
    auto s = p;
    s += q;
    s -= r;
    CHECK(same(s, difference(sum(p, q), r)));
    s *= q;
    CHECK(same(s, product(difference(sum(p, q), r), q)));
    CHECK(same((p * 4) / 4, p));
    CHECK((p == p));
    CHECK_FALSE((p + quaternion<T>(T(1)) == p));
  }
}

TEST_CASE("quaternion: components, assignment operators and text output") {
  const quaternion<double> q(1, 2, 3, 4);
  CHECK(q.vec() == duet::vector3<double>(2, 3, 4));
  CHECK(quaternion<double>(1, duet::vector3<double>(2, 3, 4)) == q);
  std::ostringstream out;
  out << q;
  CHECK(out.str() == "(1, 2, 3, 4)");
}

} // namespace
} // namespace test_quaternion_algebra
