// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/core/errors.hpp>
#include <duet/dual/dynamic_dual.hpp>
#include <duet/dual/eigen_traits.hpp>
#include <duet/dual/math.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

// A run-time number of partials: the same numbers as with a fixed one.

namespace test_dual_dynamic {
namespace {

using duet::dual, duet::dynamic_dual;

/// Every kind of operation: sums, products, quotients, functions of one, two and three arguments.
template <class D>
D everything(const std::vector<D>& x) {
  D sum = 0.0;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    const D& a = x[i];
    const D& b = x[i + 1];
    sum += sin(a) * exp(-b) / (2 + a * a) - 3 * sqrt(1 + b * b) + 1 / (b + 3);
    sum -= hypot(a, b, 1) + pow(abs(a) + 1, b) + atan2(a, b) + fma(a, b, sum) / 7;
  }
  return sum;
}

template <class T, int N, int Capacity>
void check_against_fixed() {
  std::vector<dual<T, N>> fixed;
  std::vector<dynamic_dual<T, Capacity>> dynamic;
  for (int i = 0; i < N; ++i) {
    const T value = T(0.3) * T(i % 5) - T(0.7);
    fixed.push_back(dual<T, N>::variable(value, i));
    dynamic.push_back(dynamic_dual<T, Capacity>::variable(value, i, N));
  }
  const auto expected = everything(fixed);
  const auto y = everything(dynamic);
  CHECK(y.value() == expected.value());
  CHECK(y.size() == N);
  T scale(0);
  for (int i = 0; i < N; ++i) {
    scale = std::max(scale, std::abs(expected.partial(i)));
  }
  for (int i = 0; i < N; ++i) {
    CHECK(std::abs(y.partial(i) - expected.partial(i)) <=
          8 * std::numeric_limits<T>::epsilon() * scale);
  }
}

TEST_CASE("dynamic_dual: derivatives equal those with a fixed number of partials") {
  check_against_fixed<double, 2, 8>();
  check_against_fixed<double, 3, 3>();
  check_against_fixed<double, 7, 16>();
  check_against_fixed<double, 17, 40>();
  check_against_fixed<float, 5, 12>();
  check_against_fixed<long double, 6, 9>();
}

TEST_CASE("dynamic_dual: missing partials count as zero if the numbers of partials differ") {
  using D = dynamic_dual<double, 12>;
  const D constant = 2;
  CHECK(constant.size() == 0);
  CHECK(constant.partial(5) == 0);
  const D x = D::variable(3, 1, 2);
  const D y = D::variable(5, 8, 9);
  const D z = x * y + constant;
  CHECK(z == 17);
  CHECK(z.size() == 9);
  CHECK(z.partial(1) == 5);
  CHECK(z.partial(8) == 3);
  CHECK(z.partial(0) == 0);
  CHECK(z.partial(11) == 0);
  CHECK((constant * x).partial(1) == 2);
  CHECK((x - y).partial(8) == -1);
  CHECK((x - y).partial(1) == 1);
}

TEST_CASE("dynamic_dual: the padding of the last packet is never visible") {
  using D = dynamic_dual<double, 16>;
  const double infinity = std::numeric_limits<double>::infinity();
  // Multiplying by infinity leaves NaN beside the two partials.
  D x = D::variable(1, 0, 1) * infinity;
  x.set_partial(2, 4);
  CHECK(x.partial(0) == infinity);
  CHECK(x.partial(1) == 0);
  CHECK(x.partial(2) == 4);
  const D y = D::variable(1, 0, 1) * infinity + D::variable(1, 5, 6);
  CHECK(y.partial(1) == 0);
  CHECK(y.partial(3) == 0);
  CHECK(y.partial(5) == 1);
}

TEST_CASE("dynamic_dual: structural zeros survive") {
  using D = dynamic_dual<double, 6>;
  const D constant = 0;
  CHECK(sqrt(constant).size() == 0);
  const D x = D::variable(4, 1, 3);
  const D root = sqrt(x * 0.0 + constant);
  CHECK(root == 0);
  CHECK(root.partial(0) == 0);
  CHECK(pow(D::variable(0, 0, 2), 0).partial(0) == 0);
  CHECK(std::isinf(sqrt(D::variable(0, 0, 2)).partial(0)));
  CHECK(sqrt(D::variable(0, 0, 2)).partial(1) == 0);
  CHECK((D::variable(1, 0, 2) / D(0)).partial(1) == 0);
}

TEST_CASE("dynamic_dual: exceeding the capacity throws invalid_input") {
  using D = dynamic_dual<double, 4>;
  CHECK(D::variable(1, 3, 4).partial(3) == 1);
  DUET_CHECK_REFUSED("duet: dynamic_dual: 5 partials, but the capacity is 4", D::variable(1, 0, 5));
  D x = 1;
  CHECK_THROWS_AS(x.set_partial(4, 1.0), duet::invalid_input);
}

TEST_CASE("dynamic_dual: works nested, in Eigen and in streams") {
  using inner = dual<double>;
  using D = dynamic_dual<inner, 5, duet::derivative_tag<struct outer>>;
  const D x = D::variable(inner::variable(0.4), 2, 3);
  const D y = sin(x);
  CHECK(y.partial(2).value() == std::cos(0.4));
  CHECK(y.partial(2).epsilon() == -std::sin(0.4));

  using number = dynamic_dual<double, 8>;
  Eigen::Matrix<number, 2, 2> a;
  a << number::variable(4, 0, 4), number::variable(1, 1, 4), number::variable(2, 2, 4),
      number::variable(3, 3, 4);
  const number determinant = a.determinant();
  CHECK(determinant == 10);
  CHECK(determinant.partial(0) == 3);
  CHECK(determinant.partial(1) == -2);
  CHECK((a * Eigen::Vector2d(1, 2)).sum().partial(3) == 2);

  std::ostringstream text;
  text << number::variable(1.5, 1, 2) << " " << number(2);
  CHECK(text.str() == "1.5[0, 1] 2[]");
}

} // namespace
} // namespace test_dual_dynamic
