// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/gap.hpp"
#include "support/message.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/derivative/tangent_coordinates.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/euler.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/rate.hpp>
#include <duet/quaternion/rotation.hpp>

// Jacobians, gradients and Hessians of functions of rotations, against closed forms.

namespace test_derivative_tangent_coordinates {
namespace {

using duet::gradient, duet::hessian, duet::jacobian, duet::rotation_matrix, duet::frame::body,
    duet::frame::spatial, duet_test::max_abs_difference;

using quaternion = duet::quaternion<double>;
using vector = Eigen::Vector3d;
using matrix = Eigen::Matrix3d;

const quaternion q = duet::from_rotation_vector(vector(0.3, -1.2, 0.7));
const quaternion r = duet::from_rotation_vector(vector(-2.1, 0.4, 1.3));
const vector v(0.7, 1.9, -0.4);

matrix hat(const vector& w) {
  matrix m;
  m << 0, -w[2], w[1], w[2], 0, -w[0], -w[1], w[0], 0;
  return m;
}

TEST_CASE("jacobian in a frame: of a vector rotated by the variable") {
  const auto rotated = [](const auto& x) { return duet::rotate(x, v); };
  const matrix R = rotation_matrix(q);
  const auto [y, J] = jacobian(rotated, q, spatial);
  static_assert(decltype(J)::RowsAtCompileTime == 3 && decltype(J)::ColsAtCompileTime == 3);
  CHECK(max_abs_difference(y, R * v) < 1e-15);
  CHECK(max_abs_difference(J, -hat(R * v)) < 1e-15);
  CHECK(max_abs_difference(jacobian(rotated, q, body).jacobian, -R * hat(v)) < 1e-15);
  CHECK(jacobian(rotated, q, duet::frame::hybrid).jacobian == J);
}

TEST_CASE("jacobian in a frame: from rotations to rotations") {
  const matrix R = rotation_matrix(q);
  const matrix S = rotation_matrix(r);
  const auto inverse = [](const auto& x) { return conj(x); };
  CHECK(max_abs_difference(jacobian(inverse, q, body).jacobian, -R) < 1e-15);
  CHECK(max_abs_difference(jacobian(inverse, q, spatial).jacobian, -R.transpose()) < 1e-15);

  const auto product = [](const auto& both) { return std::get<0>(both) * std::get<1>(both); };
  const auto at = std::tuple(q, r);
  Eigen::Matrix<double, 3, 6> expected;
  expected << matrix::Identity(), R;
  CHECK(max_abs_difference(jacobian(product, at, spatial).jacobian, expected) < 1e-15);
  expected << S.transpose(), matrix::Identity();
  CHECK(max_abs_difference(jacobian(product, at, body).jacobian, expected) < 1e-15);
}

TEST_CASE("jacobian in a frame: vectors to rotations, Euler rates and exponential's Jacobian") {
  const auto angles = [](const auto& a) { return duet::from_euler<duet::zyx>(a[0], a[1], a[2]); };
  const vector a(0.4, -0.9, 2.2);
  CHECK(max_abs_difference(jacobian(angles, a, spatial).jacobian,
                           duet::euler_rate_matrix<duet::zyx>(a[0], a[1])) < 1e-15);

  const auto exponential = [](const auto& w) { return duet::from_rotation_vector(w); };
  const vector w(0.8, -0.3, 1.1);
  const double t = w.norm();
  const matrix left_jacobian = matrix::Identity() + (1 - std::cos(t)) / (t * t) * hat(w) +
                               (t - std::sin(t)) / (t * t * t) * hat(w) * hat(w);
  CHECK(max_abs_difference(jacobian(exponential, w, spatial).jacobian, left_jacobian) < 1e-15);
  CHECK(max_abs_difference(jacobian(exponential, w, body).jacobian, left_jacobian.transpose()) <
        1e-15);
  CHECK(max_abs_difference(jacobian(exponential, vector(0, 0, 0), body).jacobian,
                           matrix::Identity()) == 0);
  // The Jacobian of the logarithm is the inverse.
  const auto logarithm = [](const auto& x) { return duet::rotation_vector(x); };
  CHECK(max_abs_difference(jacobian(logarithm, duet::from_rotation_vector(w), spatial).jacobian,
                           left_jacobian.inverse()) < 1e-14);
}

TEST_CASE("jacobian in a frame: scalars, arrays and tuples as arguments and results") {
  const auto slerp = [](const auto& x) {
    const auto& [t, ends] = x;
    return std::tuple(duet::slerp(ends[0], ends[1], t), t * t);
  };
  const auto at = std::tuple(0.3, std::array{q, r});
  const auto [y, J] = jacobian(slerp, at, spatial);
  static_assert(decltype(J)::RowsAtCompileTime == 4 && decltype(J)::ColsAtCompileTime == 7);
  CHECK(std::get<1>(y) == 0.3 * 0.3);
  const vector rate = duet::rotate(q, duet::rotation_vector(conj(q) * r));
  CHECK(max_abs_difference(J.col(0).head(3), rate) < 1e-14);
  CHECK(J(3, 0) == 0.6);
  CHECK(J.row(3).tail(6).isZero(0));
  // Moving both ends by one rotation moves the curve by it.
  CHECK(max_abs_difference(J.block(0, 1, 3, 3) + J.block(0, 4, 3, 3), matrix::Identity()) < 1e-14);
}

TEST_CASE("jacobian in a frame: a result may have a size known only at run time") {
  const auto all = [](const auto& x) {
    using T = typename std::decay_t<decltype(x)>::scalar_type;
    Eigen::Matrix<T, Eigen::Dynamic, 1> y(6);
    y << duet::rotate(x, v), duet::rotate(conj(x), v);
    return y;
  };
  const auto J = jacobian(all, q, spatial).jacobian;
  CHECK(J.rows() == 6);
  CHECK(J.cols() == 3);
  CHECK(max_abs_difference(J.topRows(3), -hat(rotation_matrix(q) * v)) < 1e-15);
}

TEST_CASE("jacobian in a frame: more coordinates than one pass takes") {
  std::array<quaternion, 12> many;
  for (int i = 0; i < 12; ++i) {
    many[std::size_t(i)] = duet::from_rotation_vector(vector(0.1 * i, 0.5, -0.2 * i));
  }
  const auto sum = [](const auto& x) {
    auto y = duet::rotate(x[0], v);
    for (std::size_t i = 1; i < x.size(); ++i) {
      y += duet::rotate(x[i], v);
    }
    return y;
  };
  const auto J = jacobian(sum, many, spatial).jacobian;
  CHECK(J.cols() == 36);
  for (int i = 0; i < 12; ++i) {
    CHECK(max_abs_difference(J.middleCols<3>(3 * i), -hat(duet::rotate(many[std::size_t(i)], v))) <
          1e-15);
  }
}

TEST_CASE("jacobian in a frame: a vector of run-time size takes several passes") {
  const auto rotated = [](const auto& x) {
    using T = std::decay_t<decltype(x[0] * 1.)>;
    T sum(0);
    for (int i = 0; i < 40; ++i) {
      sum += (i + 1) * x[i] * x[i] / 100;
    }
    return duet::from_rotation_vector(duet::vector3<T>(T(0), T(0), sum));
  };
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(40, -1, 1);
  const auto J = jacobian(rotated, x, body).jacobian;
  REQUIRE(J.cols() == 40);
  for (int i = 0; i < 40; ++i) {
    CHECK(max_abs_difference(J.col(i), vector(0, 0, .02 * (i + 1) * x[i])) < 1e-14);
  }
  const auto product = [](const auto& at) { return at[0] * at[1] * at[1]; };
  const Eigen::VectorXd two = Eigen::Vector2d(2, 3);
  CHECK(gradient(product, two, body).gradient == Eigen::Vector2d(9, 12));
  CHECK(hessian(product, two, body).hessian == (Eigen::Matrix2d() << 0, 6, 6, 4).finished());
  CHECK_THROWS_AS((void)jacobian(rotated, Eigen::VectorXd(), body), duet::invalid_input);
}

TEST_CASE("jacobian in a frame: std::vectors of rotations and poses as arrays of known size") {
  using pose = duet::dual_quaternion<double>;
  duet_test::random_source random(11);
  const auto vector_of = [&]() -> vector {
    return {random.normal(), random.normal(), random.normal()};
  };
  // A closed polygon of poses: every result depends on two neighbours.
  const auto steps = [](const auto& x) {
    using element = std::decay_t<decltype(conj(x[0]) * x[1])>;
    std::vector<element> y;
    for (std::size_t i = 0; i < x.size(); ++i) {
      y.push_back(conj(x[i]) * x[(i + 1) % x.size()]);
    }
    return y;
  };
  const auto check = [&](const auto& known) {
    const std::vector<typename std::decay_t<decltype(known)>::value_type> x(known.begin(),
                                                                            known.end());
    const auto check_frame = [&](auto frame) {
      const auto [y, J] = jacobian(steps, x, frame);
      const auto array_of_steps = [&](const auto& at) {
        auto z = at;
        for (std::size_t i = 0; i < at.size(); ++i) {
          z[i] = conj(at[i]) * at[(i + 1) % at.size()];
        }
        return z;
      };
      const auto [z, K] = jacobian(array_of_steps, known, frame);
      CHECK(std::equal(y.begin(), y.end(), z.begin(), z.end()));
      REQUIRE(J.rows() == K.rows());
      REQUIRE(J.cols() == K.cols());
      CHECK(max_abs_difference(J, K) < 1e-14);
      // A function of three rotations.
      const auto scalar = [&](const auto& at) {
        const auto step = conj(at[0]) * at[1];
        return step.x() * step.x() + step.w() + at[2].w() * at[0].x();
      };
      if constexpr (std::is_same_v<std::decay_t<decltype(x[0])>, quaternion>) {
        CHECK(max_abs_difference(gradient(scalar, x, frame).gradient,
                                 gradient(scalar, known, frame).gradient) < 1e-14);
        CHECK(max_abs_difference(hessian(scalar, x, frame).hessian,
                                 hessian(scalar, known, frame).hessian) < 1e-14);
      }
    };
    check_frame(spatial);
    check_frame(body);
    check_frame(duet::frame::hybrid);
  };
  std::array<quaternion, 7> rotations{quaternion(1), quaternion(0, 1, 0, 0)};
  std::array<pose, 7> poses{pose(1)};
  for (std::size_t i = 2; i < 7; ++i) {
    rotations[i] = duet::from_rotation_vector(vector_of());
    poses[i] = duet::pose(rotations[i], vector_of());
  }
  poses[1] = duet::pose(quaternion(0, 0, 1, 0), vector(0, 0, 0));
  check(rotations);
  check(poses);
  // Closed form in body axes: ∂ (a⁻¹ b) / ∂a = −Ad((a⁻¹ b)⁻¹), ∂ / ∂b = 1.
  const auto J = jacobian(steps, std::vector<pose>{poses[2], poses[3]}, body).jacobian;
  CHECK(max_abs_difference(J.block<6, 6>(0, 0), -duet::Ad(conj(poses[3]) * poses[2])) < 1e-14);
  CHECK(max_abs_difference(J.block<6, 6>(0, 6), Eigen::Matrix<double, 6, 6>::Identity()) < 1e-15);
  // One element, and none.
  const auto first = [](const auto& x) { return x[0]; };
  CHECK(max_abs_difference(jacobian(first, std::vector{q}, body).jacobian, matrix::Identity()) <
        1e-15);
  CHECK(duet_test::message_of([&] { (void)jacobian(steps, std::vector<pose>(), body); }) ==
        "duet: jacobian: the function has no variables");
  CHECK(duet_test::message_of([&] {
          (void)hessian([](const auto& x) { return x[0].w(); }, std::vector<quaternion>(), body);
        }) == "duet: hessian: the function has no variables");
}

TEST_CASE("jacobian in a frame: tuples of rotations and vectors of run-time size") {
  // f(R, l, a) = (R Σ l_i a_i, R): blocks of R in its 3 columns, then of l, then of a.
  const auto f = [](const auto& x, const auto& lengths, const auto& directions) {
    auto sum = (lengths[0] * directions[0]).eval();
    for (std::size_t i = 1; i < directions.size(); ++i) {
      sum += lengths[Eigen::Index(i)] * directions[i];
    }
    return std::tuple(duet::rotate(x, sum), x);
  };
  for (const int n : {1, 2, 9}) {
    Eigen::VectorXd lengths(n);
    std::vector<vector> directions;
    vector sum(0, 0, 0);
    for (int i = 0; i < n; ++i) {
      lengths[i] = 0.5 * i - 1;
      directions.emplace_back(i, 1 - i, i * i);
      sum += lengths[i] * directions.back();
    }
    for (const quaternion& at : {q, quaternion(1), quaternion(0, 0, 0, 1)}) {
      const auto J = jacobian(f, std::tuple(at, lengths, directions), body).jacobian;
      const matrix R = rotation_matrix(at);
      REQUIRE(J.rows() == 6);
      REQUIRE(J.cols() == 3 + 4 * n);
      CHECK(max_abs_difference(J.topLeftCorner(3, 3), -R * hat(sum)) < 2e-14 * (1 + sum.norm()));
      CHECK(max_abs_difference(J.bottomLeftCorner(3, 3), matrix::Identity()) < 1e-15);
      CHECK(J.bottomRightCorner(3, 4 * n).isZero(0));
      for (int i = 0; i < n; ++i) {
        const auto k = std::size_t(i);
        CHECK(max_abs_difference(J.block(0, 3 + i, 3, 1), R * directions[k]) < 1e-13);
        CHECK(max_abs_difference(J.block(0, 3 + n + 3 * i, 3, 3), lengths[i] * R) < 1e-14);
      }
    }
  }
  // Two vectors of run-time size, one of integers, inside another differentiation.
  const auto product = [](const auto& x, const auto& y) { return x[0] * y[0] * y[1]; };
  const auto slope = [&](const auto& t) {
    using T = std::decay_t<decltype(t)>;
    Eigen::VectorX<T> x(1);
    x[0] = t * t;
    return gradient(product, std::tuple(x, std::vector<int>{3, 5}), body).gradient;
  };
  const auto [g, rate] = duet::derivative(slope, 2.0);
  CHECK(g == vector(15, 20, 12));
  CHECK(rate == vector(0, 20, 12));
  const auto H = hessian(product,
                         std::tuple(Eigen::VectorXd(Eigen::VectorXd::Constant(1, 4)),
                                    std::vector<double>{3, 5}),
                         spatial)
                     .hessian;
  CHECK(H == (matrix() << 0, 5, 3, 5, 0, 4, 3, 4, 0).finished());
}

TEST_CASE("gradient and hessian in a frame: squared distance of rotations") {
  // ½ θ² with θ the angle of q r*. Its gradient is the rotation vector from r to q; at q = r its
  // Hessian is the identity.
  const auto distance = [](const auto& x) {
    const auto w = duet::rotation_vector(x * conj(r));
    return w.squaredNorm() / 2;
  };
  const vector w = duet::rotation_vector(q * conj(r));
  const auto [y, g] = gradient(distance, q, spatial);
  CHECK(y == doctest::Approx(w.squaredNorm() / 2).epsilon(1e-14));
  CHECK(max_abs_difference(g, w) < 1e-14);
  CHECK(max_abs_difference(gradient(distance, q, body).gradient,
                           rotation_matrix(q).transpose() * w) < 1e-14);

  const auto at_r = hessian(distance, r, spatial);
  CHECK(at_r.value == 0);
  CHECK(at_r.gradient.norm() == 0);
  CHECK(max_abs_difference(at_r.hessian, matrix::Identity()) < 1e-15);

  // Elsewhere (θ/2) cot(θ/2) (I − ŵŵᵀ) + ŵŵᵀ.
  const auto [value, slope, H] = hessian(distance, q, spatial);
  const double t = w.norm();
  const matrix along = w * w.transpose() / (t * t);
  const matrix expected = t / 2 / std::tan(t / 2) * (matrix::Identity() - along) + along;
  CHECK(value == doctest::Approx(y).epsilon(1e-14));
  CHECK(max_abs_difference(slope, w) < 1e-14);
  CHECK(max_abs_difference(H, expected) < 1e-13);
  const matrix R = rotation_matrix(q);
  CHECK(max_abs_difference(hessian(distance, q, body).hessian, R.transpose() * H * R) < 1e-13);
}

TEST_CASE("jacobian in a frame: works inside another differentiation") {
  const auto trace = [](auto t) {
    const auto rotated = [t](const auto& x) {
      return (duet::rotate(x, vector(0, 0, 1)) * t).eval();
    };
    return jacobian(rotated, duet::from_rotation_vector(vector(0, 0, 1)), spatial).jacobian(0, 1);
  };
  CHECK(duet::derivative(trace, 2.0).value == doctest::Approx(2).epsilon(1e-15));
  CHECK(duet::derivative(trace, 2.0).derivative == doctest::Approx(1).epsilon(1e-15));
}

} // namespace
} // namespace test_derivative_tangent_coordinates
