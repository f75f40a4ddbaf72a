// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/derivative/jacobian.hpp>
#include <duet/derivative/symmetric_eigen.hpp>

// A v = λ v: values to the last bit, derivatives against perturbation theory and against the
// equations themselves.

namespace test_derivative_symmetric_eigen {
namespace {

using duet::dual, duet::symmetric_eigen, duet::taylor, Eigen::Dynamic, Eigen::MatrixXd,
    Eigen::VectorXd;

struct outer_tag;

MatrixXd random_symmetric(int n, std::uint64_t seed) {
  duet_test::random_source random(seed + std::uint64_t(n));
  const MatrixXd a = MatrixXd::NullaryExpr(n, n, [&] { return random.uniform(-1, 1); });
  return a + a.transpose();
}

/// value + ε slope in the lower triangle; the entries above it must not be read.
template <class D, int N, class Make>
Eigen::Matrix<D, N, N> lower(const MatrixXd& value, const MatrixXd& slope, Make make) {
  Eigen::Matrix<D, N, N> a(value.rows(), value.rows());
  for (int i = 0; i < value.rows(); ++i) {
    for (int j = 0; j < value.rows(); ++j) {
      a(i, j) =
          i >= j ? make(value(i, j), slope(i, j)) : D(std::numeric_limits<double>::quiet_NaN());
    }
  }
  return a;
}

/// λ_j′ = v_jᵀA′v_j and v_j′ = Σ v_i v_iᵀA′v_j/(λ_j − λ_i)
struct perturbation {
  perturbation(const MatrixXd& a, const MatrixXd& slope) {
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(a);
    values = solver.eigenvalues();
    vectors = solver.eigenvectors();
    const MatrixXd moved = slope.lazyProduct(vectors);
    const MatrixXd b = vectors.transpose().lazyProduct(moved);
    values_slope = b.diagonal();
    max_abs_difference = std::numeric_limits<double>::infinity();
    MatrixXd rotation = MatrixXd::Zero(a.rows(), a.rows());
    for (int i = 0; i < a.rows(); ++i) {
      for (int j = 0; j < a.rows(); ++j) {
        if (i != j) {
          rotation(i, j) = b(i, j) / (values[j] - values[i]);
          max_abs_difference = std::min(max_abs_difference, std::abs(values[j] - values[i]));
        }
      }
    }
    vectors_slope = vectors.lazyProduct(rotation);
  }

  VectorXd values, values_slope;
  MatrixXd vectors, vectors_slope;
  double max_abs_difference;
};

template <int N>
void check(const MatrixXd& value, const MatrixXd& slope) {
  CAPTURE(value.rows());
  using D = dual<double, 2>;
  const auto make = [](double v, double s) {
    D d(v);
    d.set_partial(0, s);
    d.set_partial(1, -2 * s);
    return d;
  };
  const auto e = symmetric_eigen(lower<D, N>(value, slope, make));
  static_assert(std::is_same_v<std::decay_t<decltype(e.values)>, Eigen::Matrix<D, N, 1>>);
  static_assert(std::is_same_v<std::decay_t<decltype(e.vectors)>, Eigen::Matrix<D, N, N>>);
  const Eigen::Matrix<double, N, N> real = value;
  const auto plain = symmetric_eigen(real);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> solver(real);
  CHECK((plain.values == solver.eigenvalues()));
  CHECK((plain.vectors == solver.eigenvectors()));
  const perturbation exact(value, slope);
  const double tolerance = 2e-14 * (1 + slope.norm()) *
                           std::max(1.0, value.norm() / exact.max_abs_difference) /
                           std::min(1.0, exact.max_abs_difference);
  for (int j = 0; j < value.rows(); ++j) {
    CHECK(e.values[j].value() == plain.values[j]);
    CHECK(std::abs(e.values[j].partial(0) - exact.values_slope[j]) <= tolerance);
    CHECK(std::abs(e.values[j].partial(1) + 2 * exact.values_slope[j]) <= 2 * tolerance);
    const double sign = plain.vectors.col(j).dot(exact.vectors.col(j)) < 0 ? -1 : 1;
    for (int i = 0; i < value.rows(); ++i) {
      CHECK(e.vectors(i, j).value() == plain.vectors(i, j));
      CHECK(std::abs(e.vectors(i, j).partial(0) - sign * exact.vectors_slope(i, j)) <= tolerance);
      CHECK(std::abs(e.vectors(i, j).partial(1) + 2 * sign * exact.vectors_slope(i, j)) <=
            2 * tolerance);
    }
  }
}

/// The largest part, up to order `order`, of the residuals A v − λ v and VᵀV − 1.
template <class A, class E>
double worst_part(const A& a, const E& e) {
  using S = typename A::Scalar;
  const Eigen::Matrix<S, Dynamic, Dynamic> full = a.template selfadjointView<Eigen::Lower>();
  const Eigen::Matrix<S, Dynamic, Dynamic> residual =
      full.lazyProduct(e.vectors) - e.vectors.lazyProduct(e.values.asDiagonal().toDenseMatrix());
  const Eigen::Matrix<S, Dynamic, Dynamic> gram = e.vectors.transpose().lazyProduct(e.vectors);
  double worst = 0;
  const auto read = [&](double x) {
    worst = std::max(worst, std::abs(x));
    return x;
  };
  for (int i = 0; i < a.rows(); ++i) {
    for (int j = 0; j < a.rows(); ++j) {
      static_cast<void>(duet::detail::map_reals(residual(i, j), read));
      static_cast<void>(duet::detail::map_reals(S(gram(i, j) - (i == j ? 1 : 0)), read));
    }
  }
  return worst;
}

template <class A>
std::string message(const A& a) {
  return duet_test::message_of([&] { static_cast<void>(symmetric_eigen(a)); });
}

// All fixed sizes here are 3: each size that Eigen decomposes takes seconds to compile.
TEST_CASE("symmetric_eigen: any size gives Eigen's values, derivatives of perturbation theory") {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    check<3>(random_symmetric(3, 10 * seed), random_symmetric(3, 10 * seed + 5));
  }
  // Diagonal, in any order: rotations skip these zeros, and the derivatives of them.
  const MatrixXd slope = random_symmetric(3, 77);
  check<3>(VectorXd::LinSpaced(3, 1, 3).asDiagonal(), slope);
  check<3>(VectorXd::LinSpaced(3, 3, -1).asDiagonal(), slope);
  for (int n = 1; n <= 12; ++n) {
    check<Dynamic>(random_symmetric(n, 1), random_symmetric(n, 2));
    check<Dynamic>(VectorXd::LinSpaced(n, 0, 3).asDiagonal(), random_symmetric(n, 3));
    check<Dynamic>(VectorXd::LinSpaced(n, n, -1).asDiagonal(), random_symmetric(n, 4));
  }
}

// A = R(t) diag(1 + t, 4, 9) R(t)ᵀ with R a rotation by t about the third axis: two vectors
// rotate with unit speed.
TEST_CASE("symmetric_eigen: agrees with a closed form to third order") {
  using series = taylor<double, 3>;
  const series t = series::variable(0.3);
  const series c = cos(t);
  const series s = sin(t);
  Eigen::Matrix<series, 3, 3> a = 9 * Eigen::Matrix<series, 3, 3>::Identity();
  a(0, 0) = (1 + t) * c * c + 4 * s * s;
  a(1, 0) = (1 + t - 4) * c * s;
  a(1, 1) = (1 + t) * s * s + 4 * c * c;
  const auto e = symmetric_eigen(a);
  const double sign_0 = e.vectors(0, 0).value() > 0 ? 1 : -1;
  const double sign_1 = e.vectors(1, 1).value() > 0 ? 1 : -1;
  for (int k = 0; k <= 3; ++k) {
    CHECK(std::abs(e.values[0].derivative(k) - series(1 + t).derivative(k)) <= 1e-14);
    CHECK(std::abs(e.values[1].derivative(k) - (k == 0 ? 4 : 0)) <= 1e-14);
    CHECK(std::abs(sign_0 * e.vectors(0, 0).derivative(k) - c.derivative(k)) <= 1e-14);
    CHECK(std::abs(sign_0 * e.vectors(1, 0).derivative(k) - s.derivative(k)) <= 1e-14);
    CHECK(std::abs(sign_1 * e.vectors(0, 1).derivative(k) + s.derivative(k)) <= 1e-14);
    CHECK(std::abs(sign_1 * e.vectors(1, 1).derivative(k) - c.derivative(k)) <= 1e-14);
  }
}

TEST_CASE("symmetric_eigen: all parts of Taylor numbers and nested duals satisfy the equations") {
  using series = taylor<double, 3>;
  using nested = dual<dual<double, 2>, 2, outer_tag>;
  for (const int n : {1, 2, 3, 7}) {
    for (const bool diagonal : {false, true}) {
      const MatrixXd value =
          diagonal ? MatrixXd(VectorXd::LinSpaced(n, 3, 1).asDiagonal()) : random_symmetric(n, 4);
      const MatrixXd slope = random_symmetric(n, 6);
      const auto a = lower<series, Dynamic>(value, slope, [](double v, double s) {
        return series({v, s, 0.5 * s * s, s - 1});
      });
      CHECK(worst_part(a, symmetric_eigen(a)) <= 1e-10);
      const auto b = lower<nested, Dynamic>(value, slope, [](double v, double s) {
        using D = dual<double, 2>;
        const nested x(D::variable(v, 0));
        return nested(x + s * nested::variable(D(0), 0) +
                      s * s * nested::variable(D::variable(0, 1), 1));
      });
      CHECK(worst_part(b, symmetric_eigen(b)) <= 1e-10);
    }
  }
}

TEST_CASE("symmetric_eigen: partials of variables without influence are zero") {
  using D = dual<double, 2>;
  Eigen::Matrix<D, 3, 3> a = random_symmetric(3, 1).cast<D>();
  const auto constant = symmetric_eigen(a);
  a(2, 1) = D::variable(a(2, 1).value(), 1);
  const auto one = symmetric_eigen(a);
  for (int i = 0; i < 3; ++i) {
    CHECK(constant.values[i].partial(1) == 0);
    CHECK(one.values[i].partial(0) == 0);
    CHECK(one.values[i].partial(1) != 0);
    for (int j = 0; j < 3; ++j) {
      CHECK(constant.vectors(i, j).partial(1) == 0);
      CHECK(one.vectors(i, j).partial(0) == 0);
    }
  }
}

TEST_CASE("symmetric_eigen: repeated eigenvalues throw unless A is constant") {
  using D = dual<double>;
  Eigen::Matrix<D, 3, 3> a = Eigen::Vector3d(5, 2, 5).asDiagonal().toDenseMatrix().cast<D>();
  CHECK(symmetric_eigen(a).values[2].epsilon() == 0);
  a(0, 1) = D(0, 1); // above the diagonal, not read
  CHECK(message(a) == "");
  a(2, 0) = D(0, 1);
  CHECK(message(a) == "duet: symmetric_eigen: eigenvalues 1 and 2, both 5 with a gap of 0, have no "
                      "derivatives, as A is not constant");
  CHECK(message(a.cast<dual<D, 1, outer_tag>>()) == message(a));
  a.setConstant(D(0, 1));
  CHECK(message(a) == "duet: symmetric_eigen: eigenvalues 0 and 1, both 0 with a gap of 0, have no "
                      "derivatives, as A is not constant");
  // A small gap of 64 ε suffices; the vectors rotate at the rate 1/gap.
  constexpr double max_abs_difference = 64 * std::numeric_limits<double>::epsilon();
  a = Eigen::Vector3d(1, 1 + max_abs_difference, -1).asDiagonal().toDenseMatrix().cast<D>();
  a(1, 0) = D(0, 1);
  const auto v = symmetric_eigen(a).vectors.col(1).eval();
  CHECK(v[1].epsilon() * v[0].value() == doctest::Approx(-1 / max_abs_difference));
  // Round-off separates two eigenvalues of a full matrix, but too little to count as distinct.
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    duet_test::random_source random(seed);
    const int n = random.integer(2, 12);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> other(random_symmetric(n, seed));
    const MatrixXd& q = other.eigenvectors();
    VectorXd values = VectorXd::NullaryExpr(n, [&] { return random.uniform(-1, 1); });
    values[1] = values[0];
    const MatrixXd scaled = q * values.asDiagonal();
    const MatrixXd full = scaled.lazyProduct(q.transpose());
    CHECK(message(full.unaryExpr([](double x) { return D(x, 1); })) != "");
  }
}

TEST_CASE("symmetric_eigen: matrices that are not square, empty or not finite throw") {
  CHECK(message(MatrixXd(3, 2)) == "duet: symmetric_eigen: A is 3 x 2, but must be square");
  CHECK(message(MatrixXd(0, 0)) == "duet: symmetric_eigen: A is empty");
  MatrixXd a = MatrixXd::Identity(2, 2);
  a(1, 0) = std::numeric_limits<double>::infinity();
  CHECK(message(a) == "duet: symmetric_eigen: entry (1, 0) of A is not finite");
}

TEST_CASE("symmetric_eigen: float, long double and integers are accepted") {
  const Eigen::Matrix3i swap{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}};
  CHECK(symmetric_eigen(swap).values[2] == doctest::Approx(1));
  CHECK(symmetric_eigen(swap.cast<float>()).values[0] == doctest::Approx(-1));
  using L = dual<long double>;
  Eigen::Matrix<L, 3, 3> a = Eigen::Matrix<L, 3, 3>::Identity();
  a(1, 0) = L(0, 1);
  a(1, 1) = L(3);
  a(2, 2) = L(4);
  const auto e = symmetric_eigen(a);
  CHECK(std::abs(e.vectors(0, 0).value() * e.vectors(1, 0).epsilon() + 0.5L) <= 1e-18L);
}

} // namespace
} // namespace test_derivative_symmetric_eigen
