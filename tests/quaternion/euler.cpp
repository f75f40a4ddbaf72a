// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/multiprecision.hpp"
#include "support/random.hpp"
#include "support/shared_tag.hpp"
#include "support/test.hpp"
#include "support/ulp.hpp"

#include <duet/core/constants.hpp>
#include <duet/core/errors.hpp>
#include <duet/derivative/derivative.hpp>
#include <duet/quaternion/euler.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/rate.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/LU>

// All twelve sequences of Euler angles.

namespace test_quaternion_euler {
namespace {

using duet::euler_sequence, duet::quaternion, duet_test::random_source, duet_test::real_50,
    duet_test::worst_error;

using std::numbers::pi;

template <class F>
void for_each_sequence(const F& f) {
  using namespace duet;
  f.template operator()<xyz>();
  f.template operator()<yzx>();
  f.template operator()<zxy>();
  f.template operator()<xzy>();
  f.template operator()<yxz>();
  f.template operator()<zyx>();
  f.template operator()<xyx>();
  f.template operator()<yzy>();
  f.template operator()<zxz>();
  f.template operator()<xzx>();
  f.template operator()<yxy>();
  f.template operator()<zyz>();
}

/// The matrix of a rotation about a coordinate axis, entry by entry.
Eigen::Matrix3d elementary(int axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  Eigen::Matrix3d m;
  if (axis == 0) {
    m << 1, 0, 0, 0, c, -s, 0, s, c;
  } else if (axis == 1) {
    m << c, 0, s, 0, 1, 0, -s, 0, c;
  } else {
    m << c, -s, 0, s, c, 0, 0, 0, 1;
  }
  return m;
}

template <euler_sequence S>
Eigen::Matrix3d product_of_elementary(double a, double b, double c) {
  return elementary(S.first, a) * elementary(S.second, b) * elementary(S.third, c);
}

/// Checks that the angles reproduce q and lie in their ranges.
template <euler_sequence S>
double defect(const quaternion<double>& q) {
  const auto [a, b, c] = duet::euler<S>(q);
  const bool in_range = std::abs(a) <= pi && std::abs(c) <= pi &&
                        (S.is_proper() ? b >= 0 && b <= pi : std::abs(b) <= pi / 2);
  CHECK(in_range);
  return (product_of_elementary<S>(a, b, c) - rotation_matrix(normalized(q))).norm();
}

TEST_CASE("from_euler: equals the product of elementary rotations in the order of the letters") {
  for_each_sequence([]<euler_sequence S>() {
    random_source random(81);
    for (int i = 0; i < 30; ++i) {
      const double a = random.uniform(-7, 7), b = random.uniform(-7, 7), c = random.uniform(-7, 7);
      CHECK((rotation_matrix(duet::from_euler<S>(a, b, c)) - product_of_elementary<S>(a, b, c))
                .norm() <= 3e-15);
    }
  });
  // Yaw, pitch, roll of a vehicle, x forward, z up: pitching by 90 degrees takes x to −z.
  const auto pitched = duet::from_euler<duet::zyx>(0.0, pi / 2, 0.0);
  CHECK(
      (rotate(pitched, duet::vector3<double>(1, 0, 0)) - duet::vector3<double>(0, 0, -1)).norm() <=
      1e-15);
  CHECK((duet::from_euler<duet::zyx>(1, 0, 2) == duet::from_euler<duet::zyx>(1.0, 0.0, 2.0)));
}

TEST_CASE("euler: angles of any rotation lie in their ranges, also in and near gimbal lock") {
  for_each_sequence([]<euler_sequence S>() {
    random_source random(83);
    for (int i = 0; i < 50; ++i) {
      const auto d = random.direction<4>();
      CHECK(defect<S>({d[0], d[1], d[2], d[3]}) <= 4e-15);
    }
    for (const double distance : {0.0, 1e-300, 1e-16, 1e-12, 1e-8, 1e-4}) {
      for (const double end : {0.0, pi}) {
        const double b = end - (S.is_proper() ? 0 : pi / 2) + (end == 0.0 ? distance : -distance);
        const auto q = duet::from_euler<S>(random.uniform(-pi, pi), b, random.uniform(-pi, pi));
        CHECK(defect<S>(q) <= 4e-15);
        CHECK(defect<S>(-q) <= 4e-15);
      }
    }
    for (int i = 0; i < 4; ++i) { // the identity and half turns about the axes
      const quaternion<double> q(i == 0, i == 1, i == 2, i == 3);
      CHECK(defect<S>(q) <= 1e-15);
      CHECK(defect<S>(-q) <= 1e-15);
    }
  });
}

template <class T, euler_sequence S>
std::array<T, 3> angles_along(const T& t, double b) {
  using std::sin;
  return {T(0.4 + 0.9 * t), T(b + 0.3 * sin(t)), T(-1.1 + t * t - 0.5 * t)};
}

TEST_CASE("euler: derivatives agree with the inverse of euler_rate_matrix") {
  for_each_sequence([]<euler_sequence S>() {
    for (const double b : {0.2, 0.8, 1.3}) {
      const auto curve = [=](const auto& t) {
        const auto [x, y, z] = angles_along<std::decay_t<decltype(t)>, S>(t, b);
        return duet::from_euler<S>(x, y, z);
      };
      const double t = 0.1;
      const auto expected = duet::derivative<duet_test::shared_tag>(
          [=](const auto& u) { return angles_along<std::decay_t<decltype(u)>, S>(u, b); }, t);
      const auto recovered = duet::derivative<duet_test::shared_tag>(
          [&](const auto& u) { return duet::euler<S>(curve(u)); }, t);
      const auto [q, q_dot] = duet::derivative<duet_test::shared_tag>(curve, t);
      const duet::vector3<double> omega = angular_velocity(q, q_dot, duet::frame::spatial);
      const duet::matrix3<double> A =
          duet::euler_rate_matrix<S>(expected.value[0], expected.value[1]);
      const duet::vector3<double> by_matrix = A.inverse() * omega;
      for (std::size_t i = 0; i < 3; ++i) {
        CHECK(std::abs(recovered.value[i] - expected.value[i]) <= 1e-14);
        CHECK(std::abs(recovered.derivative[i] - expected.derivative[i]) <= 1e-13);
        CHECK(std::abs(by_matrix[int(i)] - expected.derivative[i]) <= 1e-13);
      }
    }
  });
}

/// The angles by the entries of the rotation matrix, in 100 digits; NaN if
/// undetermined.
template <euler_sequence S, class T>
std::array<duet_test::real_100, 3> exact_angles(const quaternion<T>& q) {
  using real = duet_test::real_100;
  const real w(q.w()), v[3] = {real(q.x()), real(q.y()), real(q.z())};
  const auto entry = [&](int row, int column) { // times |q|²
    const real square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    if (row == column) {
      return real(w * w + 2 * v[row] * v[row] - square);
    }
    const int sign = (column - row + 3) % 3 == 1 ? -1 : 1;
    return real(2 * (v[row] * v[column] + sign * w * v[3 - row - column]));
  };
  constexpr int i = S.first, j = S.second, o = S.other();
  const real sign = S.sign();
  const auto angle = [](const real& y, const real& x) {
    return y == 0 && x == 0 ? std::numeric_limits<real>::quiet_NaN() : real(atan2(y, x));
  };
  const auto root = [](const real& a, const real& b) { return real(sqrt(a * a + b * b)); };
  if (S.is_proper()) {
    return {angle(entry(j, i), -sign * entry(o, i)),
            angle(root(entry(j, i), entry(o, i)), entry(i, i)),
            angle(entry(i, j), sign * entry(i, o))};
  }
  return {angle(-sign * entry(j, o), entry(o, o)),
          angle(sign * entry(i, o), root(entry(j, o), entry(o, o))),
          angle(-sign * entry(i, j), entry(i, i))};
}

/// Quaternions of every norm, among them those near which angles vanish only by cancellation.
template <euler_sequence S>
std::vector<quaternion<double>> hard_attitudes() {
  random_source random(84);
  const double sizes[] = {0, 1e-300, 1e-20, 1e-10, 1e-5, 0.4, 1.2};
  std::vector<quaternion<double>> result;
  for (const double a : sizes) {
    for (const double b : sizes) {
      for (const double c : sizes) {
        if (random.uniform(0, 1) > 0.06) {
          continue; // keep about 6 % of the 343 triples
        }
        const auto varied = [&](double angle) { // sometimes near a half turn, sometimes negative
          const double result = random.uniform(0, 1) < 0.2 ? pi - angle : angle;
          return random.uniform(0, 1) < 0.5 ? -result : result;
        };
        result.push_back(duet::from_euler<S>(varied(a), varied(b), varied(c)));
        const double size = random.log_uniform(1e-150, 1e150);
        result.push_back(duet::from_euler<S>(varied(a), varied(b - pi / 2), varied(c)) * size);
      }
    }
  }
  for (int k = 0; k < 20; ++k) {
    const auto d = random.direction<4>();
    const double small[] = {random.log_uniform(1e-300, 1), random.log_uniform(1e-20, 1),
                            random.log_uniform(1e-3, 1), 1};
    result.push_back({d[0] * small[k % 4], d[1] * small[k / 2 % 4], d[2] * small[k / 3 % 4],
                      d[3] * small[k / 5 % 4]});
  }
  return result;
}

/// The errors of angles over T in ulps of themselves.
template <class T, euler_sequence S>
void add_errors(duet_test::worst_error& worst, const quaternion<double>& input) {
  using real = duet_test::real_100;
  const quaternion<T> q(T(input.w()), T(input.x()), T(input.y()), T(input.z()));
  const auto exact = exact_angles<S>(q);
  const auto angles = duet::euler<S>(q);
  for (std::size_t i = 0; i < 3; ++i) {
    if (exact[i] == exact[i]) {
      real error = abs(real(real(angles[i]) - exact[i]));
      if (error > 6) { // π and −π are the same angle
        error = abs(real(error - 2 * duet::constant::pi<real>()));
      }
      worst.add(duet_test::ulps_of_error<T>(error, exact[i]), i, input, S.first, S.second, S.third);
    }
  }
}

TEST_CASE("euler: each angle is accurate to 8 ulp of itself in every sequence") {
  duet_test::worst_error in_double("euler"), in_float("float"), in_long_double("long double"),
      in_50_digits("50 digits");
  for_each_sequence([&]<euler_sequence S>() {
    const auto inputs = hard_attitudes<S>();
    for (std::size_t n = 0; n < inputs.size(); ++n) {
      const auto& q = inputs[n];
      add_errors<double, S>(in_double, q);
      if (n % 5 == 0 && std::max(std::abs(q.w()), std::abs(q.x())) > 1e-30) {
        add_errors<long double, S>(in_long_double, q);
        add_errors<float, S>(in_float, normalized(q));
      }
    }
  });
  add_errors<duet_test::real_50, duet::zyx>(in_50_digits, {1, 0.3, 1e-30, 1e-30});
  add_errors<duet_test::real_50, duet::zyx>(in_50_digits, {0.3, 0.1, 0.2, -0.6});
  add_errors<duet_test::real_50, duet::zxz>(in_50_digits, {0.3, 0.1, 0.2, -0.6});
  CHECK_MESSAGE(in_double <= 8, in_double);
  CHECK_MESSAGE(in_float <= 8, in_float);
  CHECK_MESSAGE(in_long_double <= 8, in_long_double);
  CHECK_MESSAGE(in_50_digits <= 8, in_50_digits);
}

TEST_CASE("euler: the derivative of a tiny second angle is accurate") {
  using D = duet::dual<double>;
  for (const double size : {1e-5, 1e-20, 1e-300}) {
    const auto pitch =
        duet::euler<duet::zyx>(quaternion<D>(D(1), D(0), D(size, 3 * size), D(0)))[1];
    CHECK(pitch.value() == doctest::Approx(2 * size).epsilon(1e-9).scale(0));
    CHECK(pitch.epsilon() == doctest::Approx(6 * size).epsilon(1e-9).scale(0));
  }
}

TEST_CASE("euler: derivatives do not depend on the norm from 1e-300 to 1e300") {
  using D = duet::dual<double>;
  for_each_sequence([]<euler_sequence S>() {
    const auto rates = [](double norm) {
      const auto part = [=](double value, double slope) { return D(value * norm, slope * norm); };
      const auto angles = duet::euler<S>(
          quaternion<D>(part(0.8, 0.3), part(0.4, -0.2), part(-0.3, 0.7), part(0.2, 0.5)));
      return std::array<double, 3>{angles[0].epsilon(), angles[1].epsilon(), angles[2].epsilon()};
    };
    const auto at_one = rates(1);
    for (const double norm : {1e-300, 1e-170, 1e160, 1e300}) {
      const auto scaled = rates(norm);
      for (std::size_t i = 0; i < 3; ++i) {
        CHECK(scaled[i] == doctest::Approx(at_one[i]).epsilon(1e-13));
      }
    }
  });
}

TEST_CASE("euler: the zero quaternion is rejected") {
  DUET_CHECK_REFUSED("duet: euler: the quaternion is zero",
                     duet::euler<duet::zyx>(quaternion<double>()));
  DUET_CHECK_REFUSED("duet: euler: the quaternion is zero",
                     duet::euler<duet::zxz>(quaternion<duet::dual<double>>()));
}

// In gimbal lock the value is correct; derivatives do not exist.
TEST_CASE("euler: in gimbal lock values give the rotation and derivatives are NaN") {
  const auto q = duet::from_euler<duet::zyx>(0.3, pi / 2, 0.1);
  CHECK(defect<duet::zyx>(q) <= 1e-15);
  const auto [value, slope] = duet::derivative<duet_test::shared_tag>(
      [](const auto& t) {
        using T = std::decay_t<decltype(t)>;
        return duet::euler<duet::zxz>(quaternion<T>(T(1), t, T(0), T(0)));
      },
      0.0);
  CHECK(value[1] == 0);
  CHECK(std::isnan(slope[0]));
}

// P5: angular velocity from the rates of yaw ψ, pitch θ and roll φ, R = Rz(ψ) Ry(θ) Rx(φ).

/// The matrix by hand, columns φ′, θ′, ψ′ as in the paper.
template <class T>
duet::matrix3<T> by_hand(const T& psi, const T& theta) {
  using std::cos, std::sin;
  duet::matrix3<T> a;
  a << cos(psi) * cos(theta), -sin(psi), T(0), //
      sin(psi) * cos(theta), cos(psi), T(0),   //
      -sin(theta), T(0), T(1);
  return a;
}

/// The library's columns are in the order of the letters z, y, x.
template <class M>
M in_paper_order(const M& letters) {
  M m;
  m << letters.col(2), letters.col(1), letters.col(0);
  return m;
}

/// ω of angles and their rates, by AD of the quaternion alone.
duet::vector3<double> automatic(double psi, double theta, double phi, double psi_rate,
                                double theta_rate, double phi_rate) {
  const auto [q, q_dot] = duet::derivative<duet_test::shared_tag>(
      [=](const auto& t) {
        return duet::from_euler<duet::zyx>(psi + psi_rate * t, theta + theta_rate * t,
                                           phi + phi_rate * t);
      },
      0.0);
  return angular_velocity(q, q_dot, duet::frame::spatial);
}

TEST_CASE("P5: euler_rate_matrix agrees with the hand-written matrix, AD and 50 digits") {
  random_source random(91);
  worst_error library("euler_rate_matrix<zyx>");
  const double quarter = 1.5707963267948966; // its cosine is 6e-17
  for (int i = 0; i < 100; ++i) {
    const double psi = i % 10 == 0 ? quarter : i % 10 == 1 ? 1e-20 : random.uniform(-3, 3);
    const double theta = i % 7 == 0 ? -quarter : i % 7 == 1 ? 1e-9 : random.uniform(-1.5, 1.5);
    const double phi = random.uniform(-3, 3);
    const duet::vector3<double> rates(random.normal(), random.normal(), random.normal());
    const duet::matrix3<double> a = in_paper_order(duet::euler_rate_matrix<duet::zyx>(psi, theta));
    CHECK((a * rates - automatic(psi, theta, phi, rates[2], rates[1], rates[0])).norm() <= 1e-14);
    const auto exact = by_hand(real_50(psi), real_50(theta));
    for (int k = 0; k < 9; ++k) {
      library.add(duet_test::ulps(a(k), exact(k), exact(k)), k, psi,
                  theta); // relative to the element itself
    }
  }
  CHECK_MESSAGE(library <= 4, library);
}

TEST_CASE("P5: the printed matrix has -sin psi at (3, 1) and a wrong angular velocity") {
  random_source random(92);
  for (int i = 0; i < 100; ++i) {
    const double psi = random.uniform(-3, 3), theta = random.uniform(-1.5, 1.5);
    const duet::matrix3<double> printed = duet::printed_euler_rate_matrix(psi, theta);
    const duet::matrix3<double> difference = printed - by_hand(psi, theta);
    CHECK(difference(2, 0) == std::sin(theta) - std::sin(psi));
    CHECK(difference.cwiseAbs().sum() == std::abs(difference(2, 0)));
  }
  // If yaw and pitch are equal, the error of the print has no effect.
  CHECK(duet::printed_euler_rate_matrix(0.4, 0.4) == by_hand(0.4, 0.4));

  const double psi = 0.1, theta = -0.7, phi = 0.3;
  const duet::vector3<double> rates(1, 2, 3); // φ′, θ′, ψ′
  const auto reference = automatic(psi, theta, phi, rates[2], rates[1], rates[0]);
  const duet::vector3<double> printed = duet::printed_euler_rate_matrix(psi, theta) * rates;
  CHECK((printed - reference).norm() ==
        doctest::Approx(std::abs(std::sin(theta) - std::sin(psi)) * rates[0]));
}

} // namespace
} // namespace test_quaternion_euler
