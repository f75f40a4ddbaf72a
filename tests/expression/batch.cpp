// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/lanes.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>

namespace test_expression_batch {
namespace {

using namespace duet::expression;
using duet::batch;
using duet::dual;
using duet::dual_quaternion;
using duet::quaternion;
using duet::vector3;
using duet_test::check_lanes;

constexpr symbol<"u"> u;
constexpr symbol<"t"> t;
constexpr vector_symbol<"v"> v;
constexpr vector_symbol<"w"> w;
constexpr quaternion_symbol<"q"> q;
constexpr quaternion_symbol<"p"> p;
constexpr pose_symbol<"A"> A;
constexpr pose_symbol<"B"> B;

/// The lanes' sine and cosine may differ from the C library's in the last place each.
constexpr double limit = 4;

/// On both sides of the choices below and at them.
const std::vector<double> numbers{0.3, 1.7, 1, 0.9999, 1e-9, 2.4, 0.5};
const std::vector<double> others{1.2, 0.3, 1, 1.0001, 0.7, 2e-8, 3};

/// Half rotation vectors: none, tiny, small, half a turn, nearly a whole one, random.
std::vector<vector3<double>> vectors() {
  duet_test::random_source random(4);
  std::vector<vector3<double>> result{
      {0, 0, 0}, {1e-9, -2e-9, 0}, {0.1, 0.2, -0.1}, {0, 1.5707963267948966, 0}, {3.1, 0, 0.1}};
  while (result.size() < 9) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
    result.emplace_back(x, y, random.uniform(-1, 1));
  }
  return result;
}

std::vector<quaternion<double>> rotations() {
  std::vector<quaternion<double>> result;
  for (const auto& x : vectors()) {
    result.push_back(duet::exp(x));
  }
  return result;
}

/// In another order, so that branches of the two meet in all combinations.
template <class T>
std::vector<T> turned_about(std::vector<T> x) {
  std::rotate(x.begin(), x.begin() + 4, x.end());
  return x;
}

std::vector<dual_quaternion<double>> poses() {
  std::vector<dual_quaternion<double>> result;
  for (const auto& x : vectors()) {
    result.push_back(duet::pose(duet::exp(x), vector3<double>(x[1] - 1, 2 * x[2], x[0])));
  }
  return result;
}

/// f and ∂f/∂u, of numbers and of dual numbers.
template <class F>
void check_scalar(const F& f) {
  const auto slope = derivative(f, u);
  const auto value = [&](const auto& x, const auto& y) { return f(u = x, t = y); };
  check_lanes<4>(value, limit, numbers, others);
  check_lanes<4>([&](const auto& x, const auto& y) { return slope(u = x, t = y); }, limit, numbers,
                 others);
  std::vector<dual<double>> moving;
  for (const double x : numbers) {
    moving.emplace_back(x, 0.4 - x);
  }
  check_lanes<4>(value, limit, moving, others);
}

TEST_CASE("scalar formulas and their derivatives") {
  check_scalar(u * u - 2.5 / (t + c<1>)+-u * t);
  check_scalar(sin(u) * exp(-u * u) + log(1 + u * u) / sqrt(2 + cos(u * t)) + pi);
  check_scalar(pow(u, 2.5) + pow(u, t) + pow(1.7, u) + pow(u, 3) + pow(u, -1.0));
  check_scalar(atan2(u, t) + hypot(u, t - 2 * u) + lerp(u, t, u * t) + fma(u, u, t));
}

TEST_CASE("choices take each lane from its side") {
  check_scalar(select(u < t, u * u * t, sqrt(u) - t));
  check_scalar(select(u <= t, sin(u), select(u > 1.5, u * t, exp(u))));
  check_scalar(abs(u - t) + max(u, t) * min(u * u, c<1>));
  const auto chosen = select(dot(v, w) < u, cross(v, w), v + u * w);
  check_lanes<4>([&](const auto& a, const auto& b) { return chosen(v = a, w = b, u = 0.1); }, limit,
                 vectors(), turned_about(vectors()));
  const auto turned = select(u < 1, exp(u * v), q);
  check_lanes<4>(
      [&](const auto& x, const auto& a, const auto& b) { return turned(u = x, v = a, q = b); },
      limit, numbers, vectors(), rotations());
}

TEST_CASE("gradient and Hessian") {
  const auto f = sin(u) * t + dot(v, v) * exp(-u) + norm(w + v) * u;
  check_lanes<4>(
      [&](const auto& x, const auto& a) {
        return gradient(f, wrt(u, v))(u = x, t = 0.3, v = a, w = vector3<double>(1, 2, -1))
            .gradient;
      },
      limit, numbers, vectors());
  check_lanes<4>(
      [&](const auto& x, const auto& a) {
        return hessian(f, wrt(u, v))(u = x, t = 0.3, v = a, w = vector3<double>(1, 2, -1)).hessian;
      },
      2 * limit, numbers, vectors());
}

TEST_CASE("rotations over batches") {
  const auto f = q * exp(u * v) * conj(p);
  const auto value = [](const auto& g) {
    return [&](const auto& x, const auto& a, const auto& b, const auto& d) {
      return g(u = x, v = a, q = b, p = d);
    };
  };
  const auto check = [&](const auto& g) {
    const auto all = g + c<0> * (u * (dot(vec(q), v) + dot(vec(p), v)) * g);
    check_lanes<4>(value(all), limit, numbers, vectors(), rotations(), turned_about(rotations()));
    const auto slope = derivative(all, u);
    check_lanes<4>(value(slope), 2 * limit, numbers, vectors(), rotations(),
                   turned_about(rotations()));
  };
  check(f);
  check(pow(q, u) * p);
  check(slerp(q, p * exp(u * v), c<1> / c<3>));
  check(rotate(f, v));
  check(make_vector(u, component<1>(v), norm(rotate(q, v) + make_vector(u, u, u))));
}

TEST_CASE("motions over batches") {
  const auto helix =
      duet::make_dual_vector(vector3<double>(0, 0.6, 0.8), vector3<double>(0.3, 0.2, -0.15));
  const auto value = [](const auto& g) {
    return [&](const auto& x, const auto& a, const auto& b) { return g(u = x, A = a, B = b); };
  };
  const auto check = [&](const auto& g) {
    const auto all = g + c<0> * (u * dot(translation(A), translation(B)) * g);
    const auto slope = derivative(all, u);
    check_lanes<4>(value(all), 2 * limit, numbers, poses(), turned_about(poses()));
    check_lanes<4>(value(slope), 2 * limit, numbers, poses(), turned_about(poses()));
  };
  check(A * screw(helix, u) * conj(B) * translation_along(axis::x, u * u));
  check(sclerp(A, B, u / 3));
  check(exp(u * vec(log(A))) * B);
  check(transform_point(A * screw(axis::y, u) * B, translation(B)));

  const auto moving =
      A * screw(helix, u) * B * screw(axis::x, u * u) * translation_along(axis::y, sin(u));
  const auto check_motion = [&](const auto& frame) {
    const auto m = motion(moving, u, frame);
    const auto j = jacobian(moving, wrt(u, A), frame);
    check_lanes<4>([&](const auto& x, const auto& a,
                       const auto& b) { return m(u = x, A = a, B = b).velocity; },
                   2 * limit, numbers, poses(), turned_about(poses()));
    check_lanes<4>([&](const auto& x, const auto& a,
                       const auto& b) { return m(u = x, A = a, B = b).acceleration; },
                   2 * limit, numbers, poses(), turned_about(poses()));
    check_lanes<4>([&](const auto& x, const auto& a,
                       const auto& b) { return j(u = x, A = a, B = b).jacobian; },
                   2 * limit, numbers, poses(), turned_about(poses()));
  };
  check_motion(duet::frame::spatial);
  check_motion(duet::frame::body);
}

TEST_CASE("batches beside numbers, of other widths and of single precision") {
  const auto f = sin(u) * rotate(exp(v), w) + t * cross(v, w);
  const vector3<double> w0(0.2, 1, -3);
  check_lanes<8>([&](const auto& x, const auto& a) { return f(u = x, t = 0.5, v = a, w = w0); },
                 limit, numbers, vectors());
  using B = batch<float, 4>;
  const auto g = select(u < t, u * sin(u), exp(-u * t));
  const auto x = B::from_lanes([](int i) { return 0.3F * float(i); });
  const B result = g(u = x, t = 0.5F);
  for (int i = 0; i < B::lanes; ++i) {
    CHECK(result[i] == doctest::Approx(g(u = x[i], t = 0.5F)).epsilon(2e-7));
  }
}

} // namespace
} // namespace test_expression_batch
