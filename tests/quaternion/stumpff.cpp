// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/identical.hpp"
#include "support/multiprecision.hpp"
#include "support/test.hpp"
#include "support/ulp.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/dual/stumpff.hpp>

// Stumpff functions and their derivatives against 100 digits: errors at most 6e-16 on the scale
// 1/(m+1), the bound of the m-th derivative of sin(x)/x; absolute for derivatives with respect to
// √s.

namespace test_quaternion_stumpff {
namespace {

using duet::stumpff, duet_test::real_100, duet_test::worst_error;

/// 0 to 40, and both sides of the switches of the algorithm.
std::vector<double> inputs() {
  std::vector<double> result{0, 1e-300, 1e-30, 1e-16, 1e-8, 1e-4};
  for (double s = 0.0625; s <= 40; s += 0.1875) {
    result.push_back(s);
  }
  for (const double middle : {1.0, 4.0, 9.8696, 9.869604401089358, 39.47841760435743}) {
    for (const double distance : {0.0, 1e-15, -1e-15, 1e-9, -1e-9, 1e-3, -1e-3}) {
      result.push_back(middle * (1 + distance));
    }
  }
  return result;
}

constexpr int last_power = 70; // 40^70/140! < 1e-128

/// The coefficients of the m-th derivative of c_n: its series differentiated term by term, from
/// s^0.
std::vector<real_100> coefficients(int n, int m) {
  std::vector<real_100> result;
  for (int k = m; k <= last_power; ++k) {
    real_100 term = k % 2 == 0 ? 1 : -1;
    for (int i = 2; i <= 2 * k + n; ++i) {
      term /= i;
    }
    for (int i = k; i > k - m; --i) {
      term *= i;
    }
    result.push_back(term);
  }
  return result;
}

real_100 polynomial(const std::vector<real_100>& c, const real_100& s) {
  real_100 sum = 0;
  for (auto i = c.rbegin(); i != c.rend(); ++i) {
    sum = sum * s + *i;
  }
  return sum;
}

template <int N>
void check_derivatives() {
  std::vector<worst_error> worst(5, worst_error("c")), of_root(5, worst_error("c of x²"));
  std::vector<real_100> series[5];
  for (int m = 0; m <= 4; ++m) {
    series[m] = coefficients(N, m);
  }
  for (const double s : inputs()) {
    const auto y = duet::derivatives<4>([](const auto& t) { return stumpff<N>(t); }, s);
    const double x = static_cast<float>(std::sqrt(s)); // its square is exact
    const auto z = duet::derivatives<4>([](const auto& t) { return stumpff<N>(t * t); }, x);
    const real_100 wide_s(s);
    const real_100 wide_x(x);
    real_100 e[5];
    real_100 f[5];
    for (int m = 0; m <= 4; ++m) {
      e[m] = polynomial(series[m], wide_s);
      f[m] = polynomial(series[m], real_100(wide_x * wide_x));
    }
    // With respect to x = √s: Faà di Bruno for x².
    const real_100 g[5] = {f[0], 2 * wide_x * f[1], 4 * wide_x * wide_x * f[2] + 2 * f[1],
                           8 * pow(wide_x, 3) * f[3] + 12 * wide_x * f[2],
                           16 * pow(wide_x, 4) * f[4] + 48 * wide_x * wide_x * f[3] + 12 * f[2]};
    for (std::size_t m = 0; m <= 4; ++m) {
      const double scale = 1 / (double(m) + 1);
      worst[m].add(double(abs(real_100(y[m] - e[m]))) / scale, s);
      of_root[m].add(double(abs(real_100(z[m] - g[m]))), x);
    }
  }
  for (std::size_t m = 0; m <= 4; ++m) {
    CAPTURE(N);
    CAPTURE(m);
    CHECK_MESSAGE(worst[m] <= 6e-16, worst[m]);
    CHECK_MESSAGE(of_root[m] <= 6e-16 + duet_test::if_fused(1e-16), of_root[m]);
  }
}

TEST_CASE("stumpff: derivatives to fourth order agree with 100 digits") {
  check_derivatives<0>();
  check_derivatives<1>();
  check_derivatives<2>();
  check_derivatives<3>();
}

} // namespace
} // namespace test_quaternion_stumpff
