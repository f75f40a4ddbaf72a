// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/shared_tag.hpp"
#include "support/test.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/quaternion/exponential.hpp>

#include <Eigen/SparseCore>

// derivative, derivatives and directional_derivative of functions with results of every shape.

namespace test_derivative_results {
namespace {

using duet::derivative, duet::derivatives, duet::directional_derivative, duet::quaternion,
    duet_test::shared_tag;

/// sin and its derivatives at x, as numbers.
double sine(int k, double x) { return std::sin(x + k * 1.5707963267948966); }

TEST_CASE("derivative: the result may be a scalar") {
  const auto [y, dy] = derivative([](auto x) { return sin(x) * exp(-x * x); }, 0.3);
  static_assert(std::is_same_v<decltype(y), const double> &&
                std::is_same_v<decltype(dy), const double>);
  CHECK(y == std::sin(0.3) * std::exp(-0.09));
  CHECK(dy ==
        doctest::Approx((std::cos(0.3) - 0.6 * std::sin(0.3)) * std::exp(-0.09)).epsilon(1e-15));
}

TEST_CASE("derivative: the result may be an Eigen vector, matrix or expression") {
  const auto fixed = [](const auto& x) { return duet::make_vector(x * x, sin(x), 1.0); };
  const auto [y, dy] = derivative<shared_tag>(fixed, 2.0);
  static_assert(std::is_same_v<decltype(y), const Eigen::Vector3d>);
  CHECK(y == Eigen::Vector3d(4, std::sin(2.0), 1));
  CHECK(dy == Eigen::Vector3d(4, std::cos(2.0), 0));

  const auto dynamic = [](const auto& x) {
    using T = std::decay_t<decltype(x)>;
    Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic> m(2, 3);
    for (int i = 0; i < 6; ++i) {
      m(i / 3, i % 3) = x * (i + 1);
    }
    return m;
  };
  const auto [m, dm] = derivative<shared_tag>(dynamic, 2.0);
  CHECK(m.rows() == 2);
  CHECK(m(1, 2) == 12);
  CHECK(dm(1, 2) == 6);

  // A lambda may return an expression that refers to its captures.
  const Eigen::Vector2d v(1, 2);
  const auto [e, de] = derivative<shared_tag>(
      [&](const auto& x) {
        using T = std::decay_t<decltype(x)>;
        return Eigen::Matrix<T, 2, 1>(v * x);
      },
      3.0);
  CHECK(e == Eigen::Vector2d(3, 6));
  CHECK(de == v);

  const auto [row, drow] = derivative<shared_tag>(
      [](const auto& x) {
        using T = std::decay_t<decltype(x)>;
        return Eigen::Matrix<T, 1, 2>(x, x * x);
      },
      3.0);
  static_assert(std::is_same_v<decltype(row), const Eigen::Matrix<double, 1, 2>>);
  CHECK(drow == Eigen::RowVector2d(1, 6));
}

TEST_CASE("derivative: the result may be an array, tuple or pair, also nested") {
  const auto f = [](const auto& x) {
    return std::tuple(std::array{x, x * x}, sin(x), std::pair(x * 2, 7), 3.5);
  };
  const auto [y, dy] = derivative<shared_tag>(f, 2.0);
  CHECK(std::get<0>(y) == std::array{2.0, 4.0});
  CHECK(std::get<0>(dy) == std::array{1.0, 4.0});
  CHECK(std::get<1>(dy) == std::cos(2.0));
  CHECK(std::get<2>(dy) == std::pair(2.0, 0));
  CHECK(std::get<3>(y) == 3.5);
  CHECK(std::get<3>(dy) == 0);
}

TEST_CASE("derivative: the result may be a quaternion") {
  const auto f = [](const auto& x) {
    using T = std::decay_t<decltype(x)>;
    return duet::exp(duet::vector3<T>(x, T(0), T(0)));
  };
  const auto [q, q_dot] = derivative<shared_tag>(f, 0.3);
  static_assert(std::is_same_v<decltype(q), const quaternion<double>>);
  CHECK(q.x() == doctest::Approx(std::sin(0.3)).epsilon(1e-15));
  CHECK(q_dot.x() == doctest::Approx(std::cos(0.3)).epsilon(1e-15));
  const auto qs = derivatives<3>(f, 0.3);
  static_assert(std::is_same_v<decltype(qs), const std::array<quaternion<double>, 4>>);
  for (int k = 0; k <= 3; ++k) {
    CHECK(qs[std::size_t(k)].x() == doctest::Approx(sine(k, 0.3)).epsilon(1e-15));
  }
}

TEST_CASE("derivative: a constant result has derivative zero") {
  CHECK(derivative([](auto) { return 4.0; }, 1.0).derivative == 0);
  CHECK(derivative<shared_tag>([](auto) { return Eigen::Vector2d(1, 2); }, 1.0).derivative ==
        Eigen::Vector2d::Zero());
  const auto ys = derivatives<2>([](auto) { return 4; }, 1.0);
  CHECK(ys == std::array{4, 0, 0});
}

TEST_CASE("derivatives: higher derivatives of a scalar and of a vector") {
  const auto ys = derivatives<6>([](auto x) { return sin(x); }, 0.4);
  for (int k = 0; k <= 6; ++k) {
    CHECK(ys[std::size_t(k)] == doctest::Approx(sine(k, 0.4)).epsilon(1e-14));
  }
  const auto vs =
      derivatives<2, shared_tag>([](auto x) { return duet::make_vector(x * x * x, 1 / x); }, 2.0);
  CHECK(vs[1] == Eigen::Vector2d(12, -0.25));
  CHECK(vs[2] == Eigen::Vector2d(12, 0.25));
}

TEST_CASE("derivative: integer and single-precision arguments are accepted") {
  const auto [y, dy] = derivative([](auto x) { return x * x / 2; }, 3);
  static_assert(std::is_same_v<decltype(y), const double>);
  CHECK(y == 4.5);
  CHECK(dy == 3);
  const auto [z, dz] = derivative([](auto x) { return x * x / 2; }, 3.0F);
  static_assert(std::is_same_v<decltype(z), const float>);
  CHECK(dz == 3);
  CHECK(derivatives<2>([](auto x) { return x * x * x; }, 2)[2] == 12);
  CHECK(directional_derivative([](auto x) { return x * x; }, 3, 2).derivative == 12);
}

TEST_CASE("directional_derivative: equals the Jacobian times the direction") {
  const auto f = [](const auto& x) { return duet::make_vector(x[0] * x[1], sin(x[0])); };
  const Eigen::Vector2d x(0.5, 2), v(3, -1);
  const auto [y, dy] = directional_derivative<shared_tag>(f, x, v);
  CHECK(y == Eigen::Vector2d(1, std::sin(0.5)));
  CHECK(dy[0] == 3 * 2 - 0.5);
  CHECK(dy[1] == doctest::Approx(3 * std::cos(0.5)).epsilon(1e-15));
  // The direction may be an expression, the point of another kind.
  CHECK(directional_derivative<shared_tag>(f, x, 2 * v).derivative == 2 * dy);
  CHECK(directional_derivative<shared_tag>(f, std::array{0.5, 2.0}, v).derivative == dy);
  CHECK(directional_derivative([](auto t) { return t * t; }, 3.0, 0.5).derivative == 3);

  const Eigen::VectorXd longer = Eigen::VectorXd::Ones(3);
  DUET_CHECK_REFUSED("duet: directional_derivative: the point has 2 components, the direction 3",
                     directional_derivative<shared_tag>(f, x, longer));
}

TEST_CASE("refers_elsewhere: distinguishes owning types from references and expressions") {
  using duet::detail::refers_elsewhere, Eigen::Vector3d;
  using sparse = Eigen::SparseMatrix<double>;
  static_assert(!refers_elsewhere<sparse> && !refers_elsewhere<Eigen::SparseVector<double>>);
  static_assert(!refers_elsewhere<Eigen::DiagonalMatrix<double, 3>>);
  static_assert(!refers_elsewhere<std::vector<Vector3d>> && !refers_elsewhere<std::string>);
  static_assert(refers_elsewhere<Eigen::Map<Vector3d>> && refers_elsewhere<Eigen::Ref<Vector3d>>);
  static_assert(refers_elsewhere<Eigen::Map<sparse>>);
  using sum = std::remove_const_t<decltype(Vector3d() + Vector3d())>;
  static_assert(refers_elsewhere<sum> && refers_elsewhere<decltype(sparse() + sparse())>);
  static_assert(refers_elsewhere<std::vector<sum>> && refers_elsewhere<std::optional<sum>>);
  static_assert(refers_elsewhere<const std::tuple<sum>> && refers_elsewhere<std::array<sum, 2>>);
  static_assert(refers_elsewhere<std::pair<int, const std::tuple<int, sum>>>);
}

TEST_CASE("structure: scalars are visited from the first to the last") {
  std::string order;
  const auto record = [&](double x) {
    order += std::to_string(int(x));
    return x;
  };
  static_cast<void>(
      duet::map_scalars(record, std::tuple(1.0, std::pair(2.0, quaternion<double>(3, 4, 5, 6)),
                                           std::array{7.0, 8.0}, Eigen::Vector2d(9, 0))));
  CHECK(order == "1234567890");
}

} // namespace
} // namespace test_derivative_results
