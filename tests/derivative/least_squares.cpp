// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/eigen_problems.hpp"
#include "support/identical.hpp"
#include "support/message.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/derivative/least_squares.hpp>

// x that minimises ‖A x − b‖: values to the last bit, derivatives against the normal equations and
// QR over duals.

namespace test_derivative_least_squares {
namespace {

using duet::dual, duet::least_squares, duet::taylor, duet_test::check_solution,
    duet_test::linear_problem, duet_test::seeded, Eigen::Dynamic, Eigen::MatrixXd, Eigen::VectorXd;

struct outer_tag;

struct fit {
  MatrixXd a, a_slope, b, b_slope;

  /// AᵀA x = Aᵀb
  [[nodiscard]] linear_problem normal() const {
    linear_problem p{"normal equations", true, {}, {}, {}, {}};
    p.a = transposed_times(a, a);
    p.a_slope = transposed_times(a_slope, a) + transposed_times(a, a_slope);
    p.b = transposed_times(a, b);
    p.b_slope = transposed_times(a_slope, b) + transposed_times(a, b_slope);
    return p;
  }

  static MatrixXd transposed_times(const MatrixXd& x, const MatrixXd& y) {
    return x.transpose() * y;
  }
};

fit random_fit(int m, int n, std::uint64_t seed = 1) {
  duet_test::random_source random(seed + std::uint64_t(100 * m + n));
  const auto draw = [&](int rows, int columns) -> MatrixXd {
    return MatrixXd::NullaryExpr(rows, columns, [&] { return random.uniform(-1, 1); });
  };
  fit f{draw(m, n), draw(m, n), draw(m, 1), draw(m, 1)};
  f.a.topRows(n) += 2 * MatrixXd::Identity(n, n);
  return f;
}

/// Eigen 3.4's bits, unless products and sums are fused. Later Eigens take the reflections
/// together.
constexpr bool has_eigens_bits =
    !duet_test::may_fuse && EIGEN_WORLD_VERSION == 3 && EIGEN_MAJOR_VERSION == 4;

/// True if x and y are the same least-squares solution up to round-off: by QR each solves a
/// problem whose A and b are off by mnε ‖A‖ and mnε ‖b‖, so x is by up to mnε κ (2‖x‖ + (κ + 1)
/// ‖r‖ / ‖A‖), κ = ‖A‖‖A⁺‖ (Higham, Accuracy and Stability, theorems 20.1 and 20.3).
bool are_same(const VectorXd& x, const VectorXd& y, const fit& f) {
  if (has_eigens_bits) {
    return x == y;
  }
  const linear_problem p = f.normal();
  double square = 0; // of ‖A⁺‖, the trace of (AᵀA)⁻¹
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    square += p.solved(VectorXd::Unit(x.size(), i))[i];
  }
  const double size = f.a.norm();
  const double condition = size * std::sqrt(square);
  const double residual = (f.b - f.a * x).norm();
  const double unit = double(f.a.size()) * std::numeric_limits<double>::epsilon();
  return (x - y).norm() <=
         2 * unit * condition * (2 * x.norm() + (condition + 1) * residual / size);
}

template <int M, int N>
void check(const fit& f) {
  CAPTURE(f.a.rows());
  CAPTURE(f.a.cols());
  using D = dual<double, 3>;
  const auto x =
      least_squares(seeded<D, M, N>(f.a, f.a_slope, 3), seeded<D, M, 1>(f.b, f.b_slope, 3));
  static_assert(std::is_same_v<decltype(x), const Eigen::Matrix<D, N, 1>>);
  check_solution(x, f.normal(), 3);
  const Eigen::Matrix<double, M, N> real_a = f.a;
  const Eigen::Matrix<double, M, 1> real_b = f.b;
  const auto real_x = real_a.colPivHouseholderQr().solve(real_b).eval();
  CHECK(are_same(least_squares(real_a, real_b), real_x, f));
  CHECK(are_same(x.unaryExpr([](const D& d) { return d.value(); }), real_x, f));
}

template <class A, class B>
std::string message(const A& a, const B& b) {
  return duet_test::message_of([&] { static_cast<void>(least_squares(a, b)); });
}

// All fixed sizes here are 4 x 3: each size that Eigen factorises takes seconds to compile.
TEST_CASE(
    "least_squares: fixed and dynamic sizes give Eigen's values and normal-equation derivatives") {
  check<4, 3>(random_fit(4, 3));
  for (int n = 1; n <= 12; ++n) {
    for (const int m : {n, n + 1, 3 * n}) {
      check<Dynamic, Dynamic>(random_fit(m, n));
    }
  }
  // Reflections one by one: of fewer than 48 columns several right-hand sides have Eigen's values
  // too, of more a single one.
  const auto equals_eigen = [](fit f, const auto& b) {
    const MatrixXd x = least_squares(f.a, b), y = f.a.colPivHouseholderQr().solve(b);
    bool same = true;
    for (Eigen::Index j = 0; j < b.cols(); ++j) {
      f.b = b.col(j);
      same = same && are_same(x.col(j), y.col(j), f);
    }
    return same;
  };
  const fit few = random_fit(60, 47), many = random_fit(70, 60);
  CHECK(equals_eigen(few, MatrixXd(few.a_slope.leftCols(3))));
  CHECK(equals_eigen(many, Eigen::VectorXd(many.b)));
}

TEST_CASE("least_squares: derivatives satisfy the normal equations at zeros in A and b") {
  for (int zeros = 0; zeros < 4; ++zeros) {
    fit f = random_fit(7, 3);
    if (zeros == 1) {
      f.a = MatrixXd(f.a.triangularView<Eigen::Upper>());
    } else if (zeros == 2) {
      f.b.setZero();
    } else if (zeros == 3) {
      f.a = MatrixXd::Identity(7, 3);
      f.b.bottomRows(6).setZero();
    }
    const auto a = seeded<dual<double>, Dynamic, Dynamic>(f.a, f.a_slope);
    const auto b = seeded<dual<double>, Dynamic, 1>(f.b, f.b_slope);
    check_solution(least_squares(a, b), f.normal());
  }
}

// With N = AᵀA and c = Aᵀb as polynomials of t: N x‴ = c‴ − 3N′x″ − 3N″x′ − N‴x.
TEST_CASE("least_squares: higher orders by Taylor numbers and nested duals") {
  using series = taylor<double, 3>;
  using nested = dual<dual<double>, 1, outer_tag>;
  for (const auto [m, n] : {std::array{3, 1}, {4, 4}, {9, 4}, {20, 12}}) {
    const fit f = random_fit(m, n);
    const linear_problem p = f.normal();
    const MatrixXd a_second = 2 * fit::transposed_times(f.a_slope, f.a_slope);
    const VectorXd b_second = 2 * fit::transposed_times(f.a_slope, f.b_slope);
    VectorXd exact[] = {p.x(), p.x_slope(), {}, {}};
    exact[2] = p.solved(b_second - 2 * VectorXd(p.a_slope * exact[1]) - a_second * exact[0]);
    exact[3] = -3 * p.solved(VectorXd(p.a_slope * exact[2]) + a_second * exact[1]);
    const auto as_series = [](double v, double s) { return series({v, s, 0, 0}); };
    const auto as_nested = [](double v, double s) { return nested({v, s}, dual<double>(s)); };
    const auto x =
        least_squares(f.a.binaryExpr(f.a_slope, as_series), f.b.binaryExpr(f.b_slope, as_series));
    const auto y =
        least_squares(f.a.binaryExpr(f.a_slope, as_nested), f.b.binaryExpr(f.b_slope, as_nested));
    for (int i = 0; i < n; ++i) {
      double size = 1;
      for (int k = 0; k <= 3; ++k) {
        size += exact[k].norm();
        CHECK(std::abs(x(i, 0).derivative(k) - exact[k][i]) <= 1e-13 * size);
      }
      CHECK(y(i, 0).value().value() == x(i, 0).value());
      CHECK(std::abs(y(i, 0).value().epsilon() - exact[1][i]) <= 1e-13 * size);
      CHECK(std::abs(y(i, 0).epsilon().value() - exact[1][i]) <= 1e-13 * size);
      CHECK(std::abs(y(i, 0).epsilon().epsilon() - exact[2][i]) <= 1e-13 * size);
    }
  }
}

TEST_CASE("least_squares: scalars and shapes of A and b may differ") {
  const fit f = random_fit(4, 3);
  fit only_a = f;
  only_a.b_slope.setZero();
  fit only_b = f;
  only_b.a_slope.setZero();
  const auto a = seeded<dual<double>, 4, 3>(f.a, f.a_slope);
  const auto b = seeded<dual<double>, Dynamic, 1>(f.b, f.b_slope);
  check_solution(least_squares(a, Eigen::Vector4d(f.b)), only_a.normal());
  const auto x = least_squares(Eigen::Matrix<double, 4, 3>(f.a), b);
  static_assert(std::is_same_v<decltype(x), const Eigen::Matrix<dual<double>, 3, 1>>);
  check_solution(x, only_b.normal());
  const auto dynamic_a = seeded<dual<double>, Dynamic, Dynamic>(f.a, f.a_slope);
  check_solution(least_squares(dynamic_a, b.replicate(1, 3)).col(2), f.normal());

  const Eigen::MatrixXi ones = Eigen::MatrixXi::Ones(2, 1);
  const Eigen::VectorXi right = Eigen::Vector2i(1, 2);
  CHECK(least_squares(ones, right)[0] == doctest::Approx(1.5).epsilon(1e-15));
  CHECK(least_squares(ones.cast<float>(), right.cast<float>())[0] ==
        doctest::Approx(1.5).epsilon(1e-6));
  // Row by row, AᵀA = diag(2, 4), b − A x = (−1, 0, 1).
  using D = dual<long double>;
  const Eigen::Matrix<D, 3, 2, Eigen::RowMajor> by_rows{{1, D(0, 1)}, {0, 2}, {1, 0}};
  const auto l = least_squares(by_rows, Eigen::Vector3i(1, 2, 3));
  const long double exact[] = {2, 1}, exact_slope[] = {-0.5L, -0.25L};
  for (int i = 0; i < 2; ++i) {
    CHECK(std::abs(l[i].value() - exact[i]) <= 1e-18L);
    CHECK(std::abs(l[i].epsilon() - exact_slope[i]) <= 1e-18L);
  }
}

TEST_CASE("least_squares: partials of variables without influence are zero") {
  using D = dual<double, 3>;
  const fit f = random_fit(4, 3);
  const MatrixXd none = MatrixXd::Zero(4, 3);
  const auto b = seeded<D, 4, 1>(f.b, none.col(0));
  auto a = seeded<D, 4, 3>(f.a, none);
  const auto constant = least_squares(a, b);
  a(3, 2) = D::variable(f.a(3, 2), 1);
  const auto one = least_squares(a, b);
  for (int i = 0; i < 3; ++i) {
    CHECK(constant[i].partial(0) == 0);
    CHECK(constant[i].partial(1) == 0);
    CHECK(one[i].partial(0) == 0);
    CHECK(one[i].partial(1) != 0);
  }
}

TEST_CASE("least_squares: entries whose squares overflow or underflow are scaled") {
  const fit f = random_fit(7, 3);
  const auto b = seeded<dual<double>, Dynamic, 1>(f.b, f.b_slope);
  const auto x = least_squares(seeded<dual<double>, Dynamic, Dynamic>(f.a, f.a_slope), b);
  for (const int e : {-1000, -530, 530, 1000}) { // by a power of two every bit stays
    const double factor = std::ldexp(1, e);
    const auto a = seeded<dual<double>, Dynamic, Dynamic>(f.a * factor, f.a_slope * factor);
    const auto y = least_squares(a, b);
    const VectorXd values = least_squares(MatrixXd(f.a * factor), VectorXd(f.b));
    for (int i = 0; i < 3; ++i) {
      CHECK(y[i].value() * factor == x[i].value());
      CHECK(y[i].epsilon() * factor == x[i].epsilon());
      CHECK(values[i] == y[i].value());
    }
  }
  // The largest and the smallest that there are.
  const VectorXd largest = VectorXd::Constant(3, 4e307);
  CHECK(least_squares(MatrixXd(largest), largest)[0] == doctest::Approx(1).epsilon(1e-15));
  const VectorXd smallest = VectorXd::Constant(3, 5e-324);
  const VectorXd right = VectorXd::Constant(3, 0x1p-1000); // 5e-324 = 2^-1074
  CHECK(least_squares(MatrixXd(smallest), right)[0] == doctest::Approx(0x1p74).epsilon(1e-15));
}

TEST_CASE("least_squares: a problem without a unique solution throws invalid_input") {
  const VectorXd b = VectorXd::Ones(3);
  CHECK(message(MatrixXd(2, 3), b) ==
        "duet: least_squares: A is 2 x 3: fewer equations than unknowns");
  CHECK(message(MatrixXd(2, 0), b) == "duet: least_squares: A is empty");
  CHECK(message(MatrixXd(4, 2), b) == "duet: least_squares: A has 4 rows, but b 3");
  MatrixXd a{{1, 2}, {2, 4}, {3, 6}};
  CHECK(message(a, b) == "duet: least_squares: A has rank 1, less than its 2 columns");
  CHECK(message(a.cast<dual<double>>(), b) ==
        "duet: least_squares: A has rank 1, less than its 2 columns");
  a.setZero();
  CHECK(message(a, b) == "duet: least_squares: A has rank 0, less than its 2 columns");
  a(1, 0) = std::numeric_limits<double>::infinity();
  CHECK(message(a, b) == "duet: least_squares: entry (1, 0) of A is not finite");
}

TEST_CASE("null_space_step: the projection of a step, and its derivative") {
  const Eigen::Matrix<double, 2, 3> j{{1, 2, 3}, {-1, 0.5, 2}};
  const Eigen::Vector3d z(0.3, -1, 2);
  const Eigen::Vector3d step = duet::null_space_step(j, z);
  CHECK((j * step).norm() < 1e-15);
  CHECK((duet::null_space_step(j, step) - step).norm() < 1e-15);
  CHECK(std::abs(step.dot(z - step)) < 1e-15);
  const auto of = [&](const auto& t) {
    using T = std::decay_t<decltype(t)>;
    Eigen::Matrix<T, 2, 3> moving = j.cast<T>();
    moving(0, 1) += t;
    return duet::null_space_step(moving, z);
  };
  const double h = 1e-6;
  const Eigen::Vector3d difference = (of(h) - of(-h)) / (2 * h);
  CHECK((duet::derivative(of, 0.0).derivative - difference).norm() < 1e-9);
  const MatrixXd singular{{1, 2, 3}, {2, 4, 6}};
  CHECK_THROWS_AS(static_cast<void>(duet::null_space_step(singular, z)), duet::invalid_input);
  CHECK_THROWS_AS(static_cast<void>(duet::null_space_step(j, Eigen::VectorXd::Ones(2))),
                  duet::invalid_input);
}

} // namespace
} // namespace test_derivative_least_squares
