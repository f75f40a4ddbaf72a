// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/lanes.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/quaternion/curves.hpp>
#include <duet/quaternion/euler.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/exponential_jacobian.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/rate.hpp>
#include <duet/quaternion/rotation.hpp>

namespace test_quaternion_batch {
namespace {

using duet::batch, duet::dual, duet::quaternion, duet::vector3, duet_test::check_lanes;

/// The lanes' sine and cosine may differ from the C library's in the last place each.
constexpr double limit = 4;

/// In every branch of exp and log: identity, tiny, small, half turns, nearly full turns, extreme
/// norms, random.
template <class T>
std::vector<quaternion<T>> orientations() {
  duet_test::random_source random(3);
  const auto number = [&](double value) {
    if constexpr (duet::Infinitesimal<T>) {
      return T(value, random.uniform(-1, 1));
    } else {
      return value;
    }
  };
  std::vector<quaternion<T>> result;
  const auto add = [&](double w, double x, double y, double z) {
    result.push_back({number(w), number(x), number(y), number(z)});
  };
  add(1, 0, 0, 0);
  add(1, 1e-9, -2e-9, 1e-160);
  add(0, 0.6, 0, 0.8);
  add(-0.9999, 0.01, 0, 0.001);
  add(0.9, 0.3, -0.2, 0.1);
  add(3e200, 1e200, -2e200, 1e190);
  add(2e-200, -1e-200, 0, 1e-210);
  add(1e-17, 0, 1, 0);
  add(-1, 1e-40, 0, 0);
  while (result.size() < 15) {
    add(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  }
  return result;
}

template <class T>
std::vector<vector3<T>> vectors() {
  std::vector<vector3<T>> result;
  for (const auto& q : orientations<T>()) {
    const double factor = std::abs(duet::innermost(q.w())) > 10 ? 1e-200 : 1;
    result.push_back(vector3<T>(q.x() * factor, q.y() * factor, q.z() * factor));
  }
  result[1] = vector3<T>::Zero();
  result[3] *= 1000;
  return result;
}

TEST_CASE_TEMPLATE("batches: exp, log and pow agree with each lane", T, double, dual<double>) {
  const auto q = orientations<T>();
  DUET_CHECK_LANES(duet::exp, limit, vectors<T>());
  DUET_CHECK_LANES(log, limit, q);
  check_lanes<4>([](const auto& a) { return pow(a, 2); }, limit, q);
  check_lanes<4>([](const auto& a) { return pow(a, 0.3); }, limit, q);
  DUET_CHECK_LANES(pow, limit, q, std::vector<T>{T(0.5), T(1), T(0), T(-1.7), T(3)});
}

TEST_CASE_TEMPLATE("batches: norm, normalized and inverse agree with each lane", T, double,
                   dual<double>) {
  const auto q = orientations<T>();
  DUET_CHECK_LANES(norm, limit, q);
  DUET_CHECK_LANES(normalized, limit, q);
  DUET_CHECK_LANES(inverse, limit, q);
  check_lanes<4>([](const auto& a, const auto& b) { return a * normalized(b) - conj(a); }, limit, q,
                 q);
}

TEST_CASE_TEMPLATE("batches: slerp agrees with each lane, on every arc", T, double, dual<double>) {
  std::vector<quaternion<T>> a, b;
  for (const auto& q : orientations<T>()) {
    a.push_back(normalized(q));
  }
  b = a;
  std::swap(b[1], b[4]);
  std::swap(b[6], b[12]);
  b[13] = -b[13];
  for (const auto arc :
       {duet::slerp_arc::shortest, duet::slerp_arc::longest, duet::slerp_arc::as_given}) {
    // The longer arc between equal orientations is undetermined.
    if (arc == duet::slerp_arc::shortest) {
      check_lanes<4>([&](const auto& p, const auto& r) { return slerp(p, r, 0.3, arc); }, limit, a,
                     b);
    } else {
      check_lanes<4>(
          [&](const auto& p) {
            return slerp(quaternion<double>(0.5, 0.5, -0.5, 0.5), p, 0.3, arc);
          },
          limit, a);
    }
  }
  check_lanes<4>(
      [&](const auto& tau) {
        return slerp(quaternion<double>(1), quaternion<double>(0.6, 0, 0.8, 0), tau);
      },
      limit, std::vector<T>{T(0), T(0.4), T(1), T(1e-9)});
}

TEST_CASE_TEMPLATE("batches: rotations and their conversions agree with each lane", T, double,
                   dual<double>) {
  const auto q = orientations<T>();
  std::vector<quaternion<T>> unit;
  std::vector<duet::matrix3<T>> matrices;
  for (const auto& a : q) {
    unit.push_back(normalized(a));
    matrices.push_back(rotation_matrix(unit.back()));
  }
  DUET_CHECK_LANES(rotation_matrix, limit, unit);
  DUET_CHECK_LANES(duet::from_rotation_matrix, limit, matrices);
  DUET_CHECK_LANES(rotation_vector, limit, unit);
  DUET_CHECK_LANES(rotate, limit, unit, vectors<T>());
  DUET_CHECK_LANES(duet::from_rotation_vector, limit, vectors<T>());
  DUET_CHECK_LANES(duet::euler<duet::zyx>, limit, unit);
  DUET_CHECK_LANES(duet::euler<duet::zxz>, limit, unit);
  DUET_CHECK_LANES(duet::from_two_vectors, limit,
                   std::vector<vector3<T>>{vectors<T>()[2], vectors<T>()[4], vectors<T>()[10]},
                   std::vector<vector3<T>>{vectors<T>()[4], vectors<T>()[10], vectors<T>()[10]});
  check_lanes<4>(
      [](const auto& a, const auto& b) { return angular_velocity(a, b, duet::frame::body); }, limit,
      unit, unit);
}

TEST_CASE("batches: scalar functions over nested duals agree with each lane") {
  using D = dual<dual<double, 1, struct outer>, 1, struct inner>;
  std::vector<D> x;
  for (const double value : {0.2, 0.7, 0.9, 1e-5, 0.999, 0.5}) {
    x.push_back(D(dual<double, 1, outer>(value, 0.3), dual<double, 1, outer>(1.5, -2)));
  }
  check_lanes<4>([](const auto& a) { return sin(a) * exp(a) + sqrt(a) / log(a); }, 16, x);
  check_lanes<4>([](const auto& a) { return pow(a, 3) + pow(2, a) + pow(a, a); }, 16, x);
  check_lanes<4>([](const auto& a) { return acos(a) * atan(5 * a) + atan2(a, 1 - a); }, 16, x);
  check_lanes<4>([](const auto& a) { return tgamma(a - 0.6) + erf(a) + abs(a - 0.5); }, 64, x);
  check_lanes<4>([](const auto& a) { return duet::stumpff<3>(20 * a) + duet::stumpff<0>(2 * a); },
                 64, x);
}

TEST_CASE("batches: structural zeros survive infinite slopes in each lane") {
  using D = dual<double, 2>;
  std::vector<D> x{D(0), D::variable(0, 1), D::variable(4, 0), D(1)};
  DUET_CHECK_LANES(sqrt, limit, x);
  check_lanes<4>([](const auto& a) { return 1 / a; }, limit, x);
  check_lanes<4>([](const auto& a) { return pow(a, 0.5); }, limit, x);
}

TEST_CASE("batches: the zero quaternion in one lane is rejected") {
  using B = batch<double, 4>;
  const quaternion<B> q(B::from_lanes([](int i) { return i - 2.0; }), B(0), B(0), B(0));
  CHECK_THROWS_AS(static_cast<void>(normalized(q)), duet::invalid_input);
  CHECK_THROWS_AS(static_cast<void>(log(q)), duet::invalid_input);
}

TEST_CASE("batches: curves, Euler angles, rates and Jacobians of exp agree with each lane") {
  std::vector<quaternion<double>> q;
  for (const auto& a : orientations<double>()) {
    q.push_back(normalized(a));
  }
  auto p = q;
  std::rotate(p.begin(), p.begin() + 4, p.end());
  const std::vector<double> numbers{0, 0.3, 1, 1e-9, 0.8};
  const std::vector<double> angles{0, 0.4, -3.1, 1e-9, 1.5707963267948966, 2};
  auto rotation_vectors = vectors<double>();
  rotation_vectors[3] /= 1000; // the error of J⁻¹ grows with its argument
  const auto left = [&](const auto& a, const auto& b) { return squad_control(a, b, a); };
  check_lanes<4>(left, 2 * limit, q, p);
  check_lanes<4>(
      [](const auto& a, const auto& b, const auto& tau) { return squad(a, b, a * b, a, tau); },
      4 * limit, std::vector(q.begin() + 10, q.end()), std::vector(p.begin() + 9, p.end()),
      numbers);
  check_lanes<4>(
      [](const auto& a, const auto& b, const auto& tau) {
        return duet::bezier(std::array{a, b, a}, tau);
      },
      2 * limit, q, p, numbers);
  check_lanes<4>(
      [](const auto& a, const auto& b) { return duet::from_euler<duet::zyx>(a, b, 0.3); }, limit,
      angles, numbers);
  DUET_CHECK_LANES(duet::euler_rate_matrix<duet::zxz>, limit, angles, numbers);
  DUET_CHECK_LANES(duet::printed_euler_rate_matrix, limit, angles, numbers);
  DUET_CHECK_LANES(duet::from_axis_angle, limit,
                   std::vector<vector3<double>>{{0, 0.6, 0.8}, {1, 0, 0}, {0, 0, -1}}, angles);
  check_lanes<4>([](const auto& a) { return quaternion_rate_matrix(a, duet::frame::body); }, limit,
                 q);
  check_lanes<4>(
      [](const auto& a, const auto& v) { return quaternion_rate(a, v, duet::frame::spatial); },
      limit, q, vectors<double>());
  check_lanes<4>([](const auto& a, const auto& b) { return dot(a, b) + squared_norm(a); }, limit, q,
                 p);
  DUET_CHECK_LANES(duet::left_jacobian, limit, rotation_vectors);
  DUET_CHECK_LANES(duet::right_jacobian, limit, rotation_vectors);
  DUET_CHECK_LANES(duet::left_jacobian_inverse, 2 * limit, rotation_vectors);
  DUET_CHECK_LANES(duet::right_jacobian_inverse, 2 * limit, rotation_vectors);
}

TEST_CASE("batches: eight and sixteen lanes, in several registers, agree with each lane") {
  const auto q = orientations<double>();
  check_lanes<8>([](const auto& v) { return duet::exp(v); }, limit, vectors<double>());
  check_lanes<8>([](const auto& a) { return log(normalized(a)); }, limit, q);
  check_lanes<8>([](const auto& a, const auto& b) { return slerp(a, b, 0.3); }, 2 * limit,
                 std::vector(q.begin() + 9, q.end()), std::vector(q.begin() + 10, q.end()));
  std::vector<quaternion<float>> single;
  std::vector<vector3<float>> half_turns;
  for (const auto& a : q) {
    const quaternion<double> unit = normalized(a);
    single.emplace_back(float(unit.w()), float(unit.x()), float(unit.y()), float(unit.z()));
    half_turns.push_back(log(unit).vec().cast<float>());
  }
  check_lanes<16>([](const auto& v) { return duet::exp(v); }, limit, half_turns);
  check_lanes<16>([](const auto& a) { return log(normalized(a)); }, limit, single);
  check_lanes<16>([](const auto& a) { return rotation_matrix(a); }, limit, single);
  check_lanes<16>([](const auto& a, const auto& b) { return slerp(a, b, 0.25F); }, limit, single,
                  std::vector(single.rbegin(), single.rend()));
}

TEST_CASE("batches: one lane agrees with a number") {
  const auto q = orientations<double>();
  check_lanes<1>([](const auto& a) { return log(a); }, limit, q);
  check_lanes<1>([](const auto& a) { return duet::euler<duet::zyx>(a); }, 2 * limit, q);
  check_lanes<1>(
      [](const auto& a) { return duet::from_rotation_matrix(rotation_matrix(normalized(a))); },
      2 * limit, q);
}

} // namespace
} // namespace test_quaternion_batch
