// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Prints results of all code that uses vectors: compiled in plain C++20, the digits must be equal.

#include <duet/duet.hpp>

#include <Eigen/Core>

#include <cmath>
#include <cstdio>
#include <limits>

namespace {

int count = 0;

void print(double x) {
  ++count;
  if (x == x) { // the sign of NaN means nothing
    std::printf("%a\n", x);
  } else {
    std::printf("nan\n");
  }
}

/// Numbers that are unknown at compile time.
double unknown(double x) {
  volatile double y = x;
  return y;
}
double input(int i) { return unknown(std::sin(1.7 * i + 0.3) * (i % 5 + 0.5)); }

template <class T, int N>
void print_duals() {
  using dual = duet::dual<T, N>;
  for (int i = 0; i < 4; ++i) {
    dual x(static_cast<T>(input(i) + 3)), y(static_cast<T>(input(i + 7)));
    for (int k = 0; k < N; ++k) {
      x.set_partial(k, static_cast<T>(input(i + k)));
      y.set_partial(k, k % 3 == 0 ? T(0) : static_cast<T>(input(i - k)));
    }
    // With zeros beside infinite slopes, and with signs of zeros.
    const dual zero = y - y, edge = dual(static_cast<T>(unknown(0)));
    for (const dual& z : {x * y, x / y, -y * x, sqrt(x), exp(y), sin(x) * cos(y), pow(x, y), log(x),
                          sqrt(edge) * y, sqrt(edge) + x, zero * x, x / edge, atan2(y, x)}) {
      print(double(z.value()));
      for (int k = 0; k < N; ++k) {
        print(double(z.partial(k)));
      }
    }
  }
}

template <class T, int W>
void print_batches() {
  using batch = duet::batch<T, W>;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double scale : {1e-9, 0.3, 1.0, 50.0, 1e5, 1e8, infinity}) {
    const auto x = batch::from_lanes([&](int i) { return static_cast<T>(scale * input(i)); });
    const auto y = batch::from_lanes([](int i) { return static_cast<T>(input(i + 9)); });
    const auto chosen = select(
        x < y, [&] { return x * y; }, [&] { return x / y; });
    for (const batch& z :
         {x + y, x - y, -x, chosen, sin(x), cos(x), sqrt(abs(x)), max(x, y), exp(y),
          blended(!(x <= y) || y == y, x, y), blended(x != x, y, -x), blended(x <= x, x, y)}) {
      for (int i = 0; i < W; ++i) {
        print(double(z[i]));
      }
    }
    print(any(x < y) + 2 * all(x < y));
  }
}

void print_arms() {
  const auto print_all = [](const auto& pose, const auto& columns) {
    for (const double x : {pose.w().value(), pose.x().value(), pose.y().epsilon()}) {
      print(x);
    }
    for (const double x : columns.reshaped()) {
      print(x);
    }
  };
  Eigen::Matrix<double, 7, 1> theta;
  for (int i = 0; i < 7; ++i) {
    theta[i] = input(i);
  }
  const auto known = duet::robots::panda();
  print_all(known.pose(theta), jacobian(known, theta, duet::frame::spatial));
  const auto in_memory = duet::robots::panda_arm::chain;
  print_all(in_memory.pose(theta), jacobian(in_memory, theta, duet::frame::body));

  using namespace duet::expression;
  constexpr symbol<"theta1"> theta1;
  constexpr symbol<"theta2"> theta2;
  const auto formula = screw(axis::z, theta1) * translation_along(axis::x, 0.5) *
                       screw(axis::y, theta2) * translation_along(axis::x, 0.3);
  const auto [tip, columns] = jacobian(formula, wrt(theta1, theta2),
                                       duet::frame::spatial)(theta1 = theta[0], theta2 = theta[1]);
  print_all(tip, columns);
}

} // namespace

int main() {
  print_duals<double, 1>();
  print_duals<double, 2>();
  print_duals<double, 3>();
  print_duals<double, 8>();
  print_duals<double, 21>();
  print_duals<double, 70>();
  print_duals<float, 5>();
  print_batches<double, 2>();
  print_batches<double, 8>();
  print_batches<float, 8>();

  print_arms();
  std::printf("%d numbers\n", count);
}
