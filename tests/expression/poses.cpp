// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>

#include <algorithm>

namespace test_expression_poses {
namespace {

using namespace duet::expression;
using duet::dual_quaternion;
using duet::vector3;

constexpr symbol<"u"> u;
constexpr vector_symbol<"v"> v;
constexpr pose_symbol<"A"> A;
constexpr pose_symbol<"B"> B;

double length(const dual_quaternion<double>& a) {
  return std::sqrt(squared_norm(duet::real_part(a)) + squared_norm(duet::dual_part(a)));
}
double length(const vector3<double>& x) { return x.norm(); }

const auto a0 = duet::pose(duet::exp(vector3<double>(.3, -.2, .6)), vector3<double>(.4, 1, -.5));
const auto b0 = duet::pose(duet::exp(vector3<double>(-.1, .5, .2)), vector3<double>(-.3, .2, .8));
const vector3<double> v0(0.2, -0.6, 0.4);

template <class F>
void check_formula(const char* label, const F& f) {
  CAPTURE(label);
  const auto all = [&](const auto& g, const auto& t) { return g(u = t, A = a0, B = b0, v = v0); };
  const auto first = derivative(f, u);
  for (const double at : {0.4, 0.0, -1.1}) {
    const auto expected = duet::derivative([&](auto t) { return all(f, t); }, at);
    const double scale = 1 + length(expected.derivative);
    CHECK(length(all(f, at) - expected.value) < 1e-14 * scale);
    CHECK(length(all(first, at) - expected.derivative) < 1e-14 * scale);
  }
}

template <class F>
auto with_all(const F& f) {
  return f + c<0> * (u * dot(v, translation(A) + translation(B)) * f);
}

template <class F, class G>
bool have_same_text(const F& a, const G& b) {
  return to_text(a) == to_text(b);
}

/// A line with a pitch of 0.2 per radian.
const auto helix = duet::make_dual_vector(
    vector3<double>(0, 0.6, 0.8),
    vector3<double>(vector3<double>(.1, .2, -.3).cross(vector3<double>(0, 0.6, 0.8)) +
                    0.2 * vector3<double>(0, 0.6, 0.8)));

TEST_CASE("N14-N19: derivatives of rigid motions are those of numbers") {
  const auto line = line_through({.1, .2, .3}, {0, .6, .8});
  check_formula("N14, N15", with_all(A * conj(screw(line, sin(u))) * B *
                                     translation_along(vector3<double>(1, 0, 0), u * u)));
  check_formula("helical", with_all(screw(helix, u) * A));
  check_formula("N17", with_all(pose(rotation_about(vector3<double>(0, 0, 1), u), u * v)));
  check_formula("N17 back", with_all(translation(A * screw(helix, u) * B)));
  check_formula("N19", with_all(sclerp(A, B, u)));
  check_formula("points", with_all(transform_point(A * screw(line, u) * B, v)));
}

TEST_CASE("N10-N16: parts and conjugates of what is made of dual numbers") {
  constexpr dual_vector_symbol<"l"> l;
  CHECK(have_same_text(dual_conj(dual_conj(A)), A));
  CHECK(have_same_text(dual_part(axis::x), v - v));
  const auto l0 = duet::rotate(a0, helix);
  // The product of two lines: the cosine of their angle, and minus their distance times its sine.
  const auto product = dot(rotate(A, l), line_through({0, 0, 0}, {1, 0, 0}));
  const auto expected = (duet::rotate(b0, l0))[0];
  CHECK(real_part(product)(A = b0, l = l0) == expected.value());
  CHECK(dual_part(product)(A = b0, l = l0) == expected.epsilon());
  CHECK(dual_conj(product)(A = b0, l = l0).epsilon() == -expected.epsilon());
  // Real numbers have no dual part.
  CHECK(real_part(u)(u = 3) == 3);
  CHECK(dual_part(u)(u = 3) == 0);
  CHECK(dual_conj(u)(u = 3) == 3);
  CHECK(to_text(point_conj(A)) == "dual_conj(conj(A))");
  CHECK(to_latex(dual_conj(A)) == "\\overline{A}");
  CHECK(norm(A)(A = a0) == norm(a0));
  CHECK(dot(A, B)(A = a0, B = b0) == dot(a0, b0));
}

TEST_CASE("a Jacobian by the coordinates of a screw") {
  constexpr dual_vector_symbol<"l"> l;
  const auto f = A * screw(l, u) * B;
  const auto J = jacobian(f, wrt(l), duet::frame::body)(A = a0, B = b0, u = 0.7, l = helix);
  const auto expected = duet::jacobian(
      [&](const auto& x) {
        using T = std::decay_t<decltype(x[0])>;
        return f(A = a0, B = b0, u = 0.7, l = duet::dual_vector_of(duet::vector6<T>(x)));
      },
      duet::vector6<double>(duet::twist_of(helix)), duet::frame::body);
  CHECK((J.jacobian - expected.jacobian).norm() < 1e-14);
}

TEST_CASE("a screw is the exponential of its line") {
  CHECK(length(screw(helix, u)(u = 0.7) - exp(u / c<2> * helix)(u = 0.7)) < 1e-15);
  const auto moved = translation_along(axis::x, u)(u = 0.7);
  CHECK(length(moved - duet::pose(duet::quaternion<double>(1), vector3<double>(0.7, 0, 0))) == 0);
}

TEST_CASE("N18: twists and their rates, in all frames") {
  const auto f =
      A * screw(helix, u) * B * screw(axis::x, u * u) * translation_along(axis::y, sin(u));
  const auto rate = derivative(f, u);
  const auto check = [&](auto frame) {
    const auto twist = [&](const auto& t) {
      return duet::twist(f(u = t, A = a0, B = b0), rate(u = t, A = a0, B = b0), frame);
    };
    const auto m = motion(f, u, frame)(u = 0.6, A = a0, B = b0);
    CHECK((m.velocity - twist(0.6)).norm() < 2e-15);
    CHECK((m.acceleration - duet::derivative(twist, 0.6).derivative).norm() < 2e-14);
  };
  check(duet::frame::spatial);
  check(duet::frame::body);
  check(duet::frame::hybrid);
}

TEST_CASE("Jacobians by scalars, vectors, rotations and poses") {
  constexpr quaternion_symbol<"q"> q;
  const auto check = [&](const auto& f, auto frame) {
    // No turn, half a turn, and more than one.
    for (const vector3<double>& half :
         {vector3<double>(.5, .1, -.4), vector3<double>(0, 0, 0),
          vector3<double>(0, duet::constant::pi<double>() / 2, 0), vector3<double>(4, 0, 0)}) {
      const auto q0 = duet::exp(half);
      for (const double u0 : {0.3, 0.0, duet::constant::pi<double>(), 7.0}) {
        CAPTURE(half.transpose());
        CAPTURE(u0);
        const auto [value, J] = jacobian(f, wrt(u, v, A, q), frame)(u = u0, v = v0, A = a0, q = q0);
        const auto expected = duet::jacobian(
            [&](const auto& x) {
              return f(u = std::get<0>(x), v = std::get<1>(x), A = std::get<2>(x),
                       q = std::get<3>(x));
            },
            std::make_tuple(u0, v0, a0, q0), frame);
        CHECK(length(value - expected.value) < 1e-14);
        CHECK((J - expected.jacobian).norm() < 1e-14 * std::max(1., J.norm()));
      }
    }
  };
  const auto f = translation_along(axis::z, u) * A * pose(q, v) * screw(helix, u);
  check(f, duet::frame::spatial);
  check(f, duet::frame::body);
  check(f, duet::frame::hybrid);
  check(f * c<1>, duet::frame::spatial);
  check(-conj(f) * screw(axis::x, u), duet::frame::spatial);
  check(-conj(f) * screw(axis::x, u), duet::frame::body);
}

TEST_CASE("gradients with respect to rotations and poses") {
  constexpr quaternion_symbol<"q"> q;
  const auto f = rotate(q * rotation(A), v) + u * translation(A);
  const auto q0 = duet::exp(vector3<double>(.5, .1, -.4));
  const auto check = [&](auto frame) {
    const auto J = jacobian(f, wrt(A, u, q), frame)(A = a0, v = v0, u = 0.3, q = q0).jacobian;
    const auto g = gradient(dot(f, v), wrt(A, u, q), frame)(A = a0, v = v0, u = 0.3, q = q0);
    CHECK((g.gradient - J.transpose() * v0).norm() < 1e-14);
  };
  check(duet::frame::spatial);
  check(duet::frame::body);
  check(duet::frame::hybrid);
}

constexpr symbol<"t1"> t1;
constexpr symbol<"t2"> t2;
constexpr symbol<"t3"> t3;
constexpr symbol<"t4"> t4;
constexpr symbol<"t5"> t5;
constexpr symbol<"t6"> t6;
constexpr symbol<"t7"> t7;

constexpr auto all_joints = wrt(t1, t2, t3, t4, t5, t6, t7);

TEST_CASE("an arm of turns about coordinate axes, whose Jacobian is written in place") {
  const auto arm = translation_along(axis::z, .333) * screw(axis::z, t1) * screw(axis::y, t2) *
                   translation_along(axis::z, .316) * screw(axis::z, t3) *
                   translation_along(axis::x, .0825) * screw(axis::y, -t4) *
                   translation_along(axis::x, -.0825) * translation_along(axis::z, .384) *
                   screw(axis::z, t5) * screw(axis::y, -t6) * translation_along(axis::x, .088) *
                   screw(axis::z, -t7) * screw(axis::x, pi) * translation_along(axis::z, .107);
  const auto panda = duet::robots::panda();
  Eigen::Matrix<double, 7, 1> x;
  x << 0.3, -0.7, 1.1, -1.9, 0.4, 1.6, -0.8;
  const auto at = [&](const auto& f) {
    return f(t1 = x[0], t2 = x[1], t3 = x[2], t4 = x[3], t5 = x[4], t6 = x[5], t7 = x[6]);
  };
  const auto [a, J] = at(jacobian(arm, all_joints, duet::frame::spatial));
  const auto expected = panda.pose(x);
  CHECK(std::min(length(a - expected), length(a + expected)) < 1e-15);
  CHECK((J - duet::jacobian(panda, x, duet::frame::spatial)).norm() < 4e-15);
  CHECK(length(at(arm) - a) < 1e-15);
  const auto plain = at(jacobian(with_std_sincos(arm), all_joints, duet::frame::spatial));
  CHECK((plain.jacobian - J).norm() < 2e-15);

  // One coordinate in several joints, one in none, sliding joints and a line at run time.
  const auto coupled = screw(axis::x, t1) * translation_along(axis::y, t1 * t2) *
                           screw(helix, t1 - t2) * screw(axis::z, c<2> * t1) *
                           translation_along(vector3<double>(0, 0, 1), t2) *
                           (A * screw(axis::y, t2)) +
                       c<0> * t3 * A;
  const auto J2 =
      jacobian(coupled, wrt(t1, t2, t3), duet::frame::spatial)(t1 = 0.4, t2 = 0.9, t3 = 1, A = a0);
  const auto by_duals = duet::jacobian(
      [&](const auto& y) { return coupled(t1 = y[0], t2 = y[1], t3 = y[2], A = a0); },
      Eigen::Vector3d(0.4, 0.9, 1), duet::frame::spatial);
  CHECK(length(J2.value - by_duals.value) < 1e-15);
  CHECK((J2.jacobian - by_duals.jacobian).norm() < 4e-15);
}

} // namespace
} // namespace test_expression_poses
