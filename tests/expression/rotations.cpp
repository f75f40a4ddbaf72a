// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>

namespace test_expression_rotations {
namespace {

using namespace duet::expression;
using duet::quaternion;
using duet::vector3;

constexpr symbol<"u"> u;
constexpr vector_symbol<"w"> w;
constexpr vector_symbol<"v"> v;
constexpr quaternion_symbol<"q"> q;
constexpr quaternion_symbol<"p"> p;

double length(double x) { return std::abs(x); }
double length(const vector3<double>& x) { return x.norm(); }
double length(const quaternion<double>& x) { return std::sqrt(squared_norm(x)); }

/// Value and derivative by u against dual numbers, at easy and awkward inputs.
template <class F>
void check_formula(const char* label, const F& f, double tolerance = 2e-14) {
  CAPTURE(label);
  duet_test::random_source random(7);
  const vector3<double> vectors[] = {{0.3, -0.5, 0.8}, {0, 0, 1}, {1e-8, 2e-8, 0}, {1, 1.2, -1.1}};
  const auto first = derivative(f, u);
  for (const double at : {0.3, 1.0, 1e-9, -0.7}) {
    for (const auto& v0 : vectors) {
      const vector3<double> w0(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      const auto q0 = duet::exp(v0), p0 = duet::exp(w0);
      const auto at_u = [&](const auto& g, const auto& t) {
        return g(u = t, w = w0, v = v0, q = q0, p = p0);
      };
      const auto expected = duet::derivative([&](auto t) { return at_u(f, t); }, at);
      const double scale = 1 + length(expected.derivative);
      CAPTURE(at);
      CAPTURE(v0.transpose());
      CHECK(length(at_u(f, at) - expected.value) < 1e-14 * scale);
      CHECK(length(at_u(first, at) - expected.derivative) < tolerance * scale);
    }
  }
}

/// With everything that the formulas below need, so that they are all called alike.
template <class F>
auto with_all(const F& f) {
  return f + c<0> * (u * (dot(w, v) + dot(vec(q), vec(p))) * f);
}

TEST_CASE("N1-N9: derivatives of formulas are those of numbers") {
  const auto turning = exp(u * w);               // N4
  const auto wobbling = exp(u * w + sin(u) * v); // no axis stands still
  check_formula("N1, N6", with_all(q * turning * p * wobbling));
  check_formula("N2", with_all(conj(turning * q)));
  check_formula("N4 log", with_all(log(exp(u * v) * p)), 1e-13);
  check_formula("N5 of a fixed one", with_all(pow(q, u)));
  check_formula("N5 of a moving one", with_all(pow(q * turning, 1.5 + u * u)), 1e-13);
  check_formula("N9 moving ends", with_all(slerp(turning * q, wobbling * q, u)), 1e-13);
  check_formula("rotated", with_all(rotate(q * turning * p * wobbling, v + u * w)));
  check_formula("turns",
                with_all(rotate(rotation_about(vector3<double>(0, 0.6, 0.8), u * u) * q, v)));
  check_formula("vectors", with_all(cross(rotate(turning, v), u * w) / (2 + dot(w, w) * u)));
  check_formula("N3", with_all(conj(turning + p) / dot(turning + p, turning + p)));
  check_formula("lengths", norm(turning + wobbling * p) * dot(q, wobbling));
  check_formula("column", with_all(make_vector(u, sin(u), norm(w + u * v + rotate(q, w)))));
  check_formula("scalar", dot(rotate(turning, v), w) * component<1>(rotate(conj(q) * wobbling, v)) +
                              c<0> * dot(vec(q), vec(p)));
}

TEST_CASE("second derivatives") {
  const auto check = [](const char* label, const auto& f) {
    // What has no closed form is differentiated by nested duals.
    check_formula(label, derivative(f, u), 1e-13);
  };
  check("exp", with_all(exp(u * w + sin(u) * v)));
  check("slerp", with_all(slerp(q, q * exp(c<1> / c<2> * w), u * u)));
  check("rotated", with_all(rotate(q * exp(u * w) * p, v)));
}

TEST_CASE("N7: velocities and accelerations of a rotation, in both frames") {
  const auto f = q * exp(u * w) * conj(p * exp(u * u * v)) * rotation_about(v / norm(v), sin(u));
  const auto rate = derivative(f, u);
  const vector3<double> w0(0.3, 0.7, -0.2), v0(-0.4, 0.1, 0.9);
  const auto q0 = duet::exp(v0), p0 = duet::exp(w0);
  const auto check = [&](auto frame) {
    const auto omega = [&](const auto& t) {
      return duet::angular_velocity(f(u = t, w = w0, v = v0, q = q0, p = p0),
                                    rate(u = t, w = w0, v = v0, q = q0, p = p0), frame);
    };
    const auto m = motion(f, u, frame)(u = 0.6, w = w0, v = v0, q = q0, p = p0);
    CHECK(length(m.value - f(u = 0.6, w = w0, v = v0, q = q0, p = p0)) == 0);
    CHECK((m.velocity - omega(0.6)).norm() < 2e-15);
    CHECK((m.acceleration - duet::derivative(omega, 0.6).derivative).norm() < 1e-14);
  };
  check(duet::frame::spatial);
  check(duet::frame::body);
}

TEST_CASE("directional derivatives by vectors and rotations") {
  const auto f = rotate(q, v);
  const vector3<double> v0(0.3, 0.7, -0.2), w0(-0.4, 0.1, 0.9);
  const auto q0 = duet::exp(v0), q_dot = duet::quaternion_rate(q0, w0, duet::frame::spatial);
  const auto by_q = directional_derivative(f, along(q, p), along(v, w));
  const vector3<double> expected = w0.cross(duet::rotate(q0, v0)) + duet::rotate(q0, w0);
  CHECK((by_q(q = q0, v = v0, p = q_dot, w = w0) - expected).norm() < 1e-15);
}

template <class A, class B>
bool have_same_text(const A& a, const B& b) {
  return to_text(a) == to_text(b);
}

TEST_CASE("simplification of rotations") {
  CHECK(have_same_text(conj(conj(q)), q));
  CHECK(have_same_text(vec(pure(v)), v));
  CHECK(have_same_text(cross(v, v), v - v));
  CHECK(have_same_text(q * c<2>, c<2> * q));
  CHECK(have_same_text(rotate(q, c<2> * v), c<2> * rotate(q, v)));
  CHECK(cross(v, v)(v = vector3<double>(1, 2, 3)) == vector3<double>(0, 0, 0));
}

} // namespace
} // namespace test_expression_rotations
