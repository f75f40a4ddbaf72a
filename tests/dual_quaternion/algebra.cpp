// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "dual_quaternion/cases.hpp"
#include "support/test.hpp"

#include <duet/core/errors.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/quaternion/norm.hpp>

// N10–N16: dual numbers, vectors and quaternions.

namespace test_dual_quaternion_algebra {

using duet::conj, duet::dual_conj, duet::dual_part, duet::make_dual_quaternion,
    duet::make_dual_vector, duet::point_conj, duet::real_part, duet_test::max_abs_difference,
    duet_test::vector;

using number = duet::screw_dual<double>;
using quaternion = duet::quaternion<double>;
using dual_quaternion = duet::dual_quaternion<double>;

TEST_CASE("N10, N11: products, conjugates and inverses of dual numbers") {
  const number a(2, 3);
  const number b(-4, 5);
  CHECK((a * b).value() == -8);
  CHECK((a * b).epsilon() == 2 * 5 + 3 * -4);
  CHECK((a + b).epsilon() == 8);
  CHECK(dual_conj(a).value() == 2);
  CHECK(dual_conj(a).epsilon() == -3);
  CHECK((a * dual_conj(a)).value() == 4);
  CHECK((a * dual_conj(a)).epsilon() == 0);
  const number inverse = 1 / a;
  CHECK(inverse.value() == 0.5);
  CHECK(inverse.epsilon() == -0.75); // (1/a)(1 − ε b/a)
  // εb divides zero and has no inverse.
  const number divisor(0, 3);
  CHECK(((divisor * divisor) == 0 && (divisor * divisor).epsilon() == 0));
  CHECK(!std::isfinite((1 / divisor).value()));
}

TEST_CASE("N12: dot and cross products of dual vectors agree in both readings") {
  const vector a(1, 2, 3), b(4, -5, 6), c(0.5, 0.25, -2), d(-1, 3, 2);
  const auto u = make_dual_vector(a, b);
  const auto v = make_dual_vector(c, d);
  CHECK(real_part(u) == a);
  CHECK(dual_part(u) == b);
  const number dot = u.dot(v);
  CHECK(dot.value() == a.dot(c));
  CHECK(dot.epsilon() == a.dot(d) + b.dot(c));
  const duet::dual_vector<double> cross = u.cross(v);
  CHECK(real_part(cross) == a.cross(c));
  CHECK(dual_part(cross) == vector(a.cross(d) + b.cross(c)));
  const duet::dual_vector<double> scaled = u * number(2, 3);
  CHECK(real_part(scaled) == vector(2 * a));
  CHECK(dual_part(scaled) == vector(2 * b + 3 * a));
}

TEST_CASE("N13, N14: products of dual quaternions agree in both readings") {
  const quaternion p(1, 2, -3, 4), q(0.5, -1, 2, 3), u(2, 0.25, 1, -1), v(-3, 1, 0.5, 2);
  const dual_quaternion a = make_dual_quaternion(p, q);
  const dual_quaternion b = make_dual_quaternion(u, v);
  CHECK(real_part(a) == p);
  CHECK(dual_part(a) == q);
  CHECK(real_part(a * b) == p * u);
  CHECK(dual_part(a * b) == q * u + p * v);
  // (D₀E₀ − D·E, D₀E + E₀D + D × E)
  const duet::dual_vector<double> d = a.vec(), e = b.vec();
  const duet::dual_vector<double> vec = a.w() * e + b.w() * d + d.cross(e);
  const number scalar = a.w() * b.w() - d.dot(e);
  CHECK((a * b).w().value() == scalar.value());
  CHECK((a * b).w().epsilon() == scalar.epsilon());
  CHECK(max_abs_difference(real_part(duet::dual_vector<double>((a * b).vec())), real_part(vec)) ==
        0);
  CHECK(max_abs_difference(dual_part(duet::dual_vector<double>((a * b).vec())), dual_part(vec)) ==
        0);
}

TEST_CASE("N15: the three conjugates have their signs and product rules") {
  const quaternion p(1, 2, -3, 4), q(0.5, -1, 2, 3), u(2, 0.25, 1, -1), v(-3, 1, 0.5, 2);
  const dual_quaternion a = make_dual_quaternion(p, q);
  const dual_quaternion b = make_dual_quaternion(u, v);
  CHECK(max_abs_difference(conj(a), make_dual_quaternion(conj(p), conj(q))) == 0);
  CHECK(max_abs_difference(dual_conj(a), make_dual_quaternion(p, -q)) == 0);
  CHECK(max_abs_difference(point_conj(a), make_dual_quaternion(conj(p), -conj(q))) == 0);
  CHECK(max_abs_difference(conj(a * b), conj(b) * conj(a)) == 0);
  CHECK(max_abs_difference(dual_conj(a * b), dual_conj(a) * dual_conj(b)) == 0);
  CHECK(max_abs_difference(point_conj(a * b), point_conj(b) * point_conj(a)) == 0);
}

TEST_CASE("N16: is_unit checks both conditions, normalized restores them") {
  for (const auto& a : duet_test::poses()) {
    CHECK(duet::is_unit(a));
    CHECK(max_abs_difference(a * conj(a), dual_quaternion(number(1))) < 1e-15 * 8);
    CHECK(max_abs_difference(duet::inverse(a), conj(a)) < 1e-15 * 8);
  }
  const dual_quaternion b = make_dual_quaternion(quaternion(1, 2, -3, 4), quaternion(1, 0, 2, 2));
  CHECK(!duet::is_unit(b));
  const dual_quaternion n = duet::normalized(b);
  CHECK(duet::is_unit(n, 1e-15));
  CHECK(max_abs_difference(duet::normalized(n), n) < 1e-15);
  CHECK(max_abs_difference(duet::inverse(b) * b, dual_quaternion(number(1))) < 1e-15);
  // Only p counts: a unit p with p·q ≠ 0 is not unit.
  CHECK(!duet::is_unit(make_dual_quaternion(quaternion(1, 0, 0, 0), quaternion(0.1, 0, 0, 1))));
}

TEST_CASE("zero divisors: inverse and normalized reject them") {
  const dual_quaternion divisor =
      make_dual_quaternion(quaternion(0, 0, 0, 0), quaternion(1, 2, 3, 4));
  DUET_CHECK_REFUSED("duet: inverse: the quaternion is zero", duet::inverse(divisor));
  CHECK_THROWS_AS(static_cast<void>(duet::normalized(divisor)), duet::invalid_input);
}

} // namespace test_dual_quaternion_algebra
