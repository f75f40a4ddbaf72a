// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/identical.hpp"
#include "support/multiprecision.hpp"
#include "support/random.hpp"
#include "support/test.hpp"
#include "support/ulp.hpp"

#include <duet/dual/math.hpp>
#include <duet/dual/second_dual.hpp>

namespace test_dual_functions_of_many {
namespace {

using duet::dual, duet_test::identical, duet_test::real_100, duet_test::ulps,
    duet_test::worst_error;
using std::atan2, std::fma, std::fmod, std::hypot, std::lerp, std::pow, std::remainder;

/// f of M arguments: values against <cmath>, partials against `slopes` in 100 digits. One ulp is
/// that of |f_i| + Σ_j |f_ij x_j|. Every argument is also passed as a constant, one at a time.
template <std::size_t M, class F, class Slopes>
void check(const std::string& name, F f, Slopes slopes,
           const std::vector<std::array<double, M>>& inputs, double limit = 16) {
  worst_error worst(name);
  for (const auto& x : inputs) {
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      using D = dual<double, int(M)>;
      const D y = f(D::variable(x[I], int(I))...);
      CHECK_MESSAGE(identical(y.value(), f(x[I]...)), name << " " << x[0] << " " << x[1]);
      std::array<real_100, M> wide{real_100(x[I])...};
      const auto exact = slopes(wide);
      std::array<real_100, M> scales = exact;
      for (auto& s : scales) {
        s = abs(s);
      }
      for (std::size_t j = 0; j < M; ++j) {
        auto low = wide;
        auto high = wide;
        const real_100 h = abs(wide[j]) * 1e-30;
        low[j] -= h;
        high[j] += h;
        if (h == 0) {
          continue;
        }
        const auto a = slopes(low);
        const auto b = slopes(high);
        for (std::size_t i = 0; i < M; ++i) {
          scales[i] += abs(real_100((b[i] - a[i]) / (2 * h) * wide[j]));
        }
      }
      for (std::size_t i = 0; i < M; ++i) {
        worst.add(ulps(y.partial(int(i)), exact[i], scales[i]), i, x[I]...);
        // Again with the other arguments constant, which may use other code.
        const auto alone =
            f(((void)I, I == i ? dual<double>::variable(x[I]) : dual<double>(x[I]))...);
        CHECK(alone.value() == y.value());
        CHECK(alone.epsilon() == doctest::Approx(y.partial(int(i))).epsilon(1e-14));
      }
    }
    (std::make_index_sequence<M>{});
  }
  CHECK_MESSAGE(worst <= limit, worst);
}

template <std::size_t M, class Draw>
std::vector<std::array<double, M>> random_inputs(Draw draw) {
  std::vector<std::array<double, M>> result;
  for (int i = 0; i < 200; ++i) {
    std::array<double, M> x;
    for (std::size_t j = 0; j < M; ++j) {
      x[j] = draw(j);
    }
    result.push_back(x);
  }
  return result;
}

using R = real_100;
template <std::size_t M>
using wide = std::array<R, M>;

TEST_CASE("pow: values and partials of base and exponent") {
  duet_test::random_source random(11);
  auto inputs = random_inputs<2>([&](std::size_t j) {
    return j == 0 ? random.log_uniform(1e-3, 1e3) : random.uniform(-9, 9);
  });
  inputs.insert(inputs.end(), {{1e-160, 1.5},
                               {1e-300, 0.5},
                               {1e300, 0.5},
                               {1e-8, -2},
                               {1e160, -1},
                               {1 + 1e-15, 1e12},
                               {0.5, 1000},
                               {2, 1e-300},
                               {3, 1},
                               {3, 2}});
  check<2>(
      "pow", [](const auto& x, const auto& p) { return pow(x, p); },
      [](const wide<2>& a) -> wide<2> {
        const R y = exp(R(a[1] * log(a[0])));
        return {R(a[1] * y / a[0]), R(y * log(a[0]))};
      },
      inputs);
}

TEST_CASE("atan2: values and partials") {
  duet_test::random_source random(12);
  auto inputs = random_inputs<2>([&](std::size_t) { return random.signed_log_uniform(1e-4, 1e4); });
  inputs.insert(inputs.end(), {{1e-160, 1e-160},
                               {1e-300, -1e-300},
                               {1e160, 3e160},
                               {1e300, 1e-300},
                               {-1e-300, -1},
                               {0.0, -1},
                               {-0.0, -1},
                               {1, 0},
                               {1e-8, 1},
                               {1, -1e-8}});
  check<2>(
      "atan2", [](const auto& y, const auto& x) { return atan2(y, x); },
      [](const wide<2>& a) -> wide<2> {
        const R square = a[0] * a[0] + a[1] * a[1];
        return {R(a[1] / square), R(-a[0] / square)};
      },
      inputs);
}

TEST_CASE("hypot: values and partials of two and three arguments") {
  duet_test::random_source random(13);
  const auto draw = [&](std::size_t) { return random.signed_log_uniform(1e-4, 1e4); };
  auto two = random_inputs<2>(draw);
  two.insert(two.end(), {{1e-160, 1e-160}, {1e-300, -1e-300}, {1e300, 1e300}, {-3, 0}, {0, 5}});
  check<2>(
      "hypot", [](const auto& x, const auto& y) { return hypot(x, y); },
      [](const wide<2>& a) -> wide<2> {
        const R r = sqrt(R(a[0] * a[0] + a[1] * a[1]));
        return {R(a[0] / r), R(a[1] / r)};
      },
      two);
  auto three = random_inputs<3>(draw);
  three.insert(
      three.end(),
      {{1e-160, 1e-160, 2e-160}, {1e-300, -1e-300, 0}, {1e300, 1e300, -1e300}, {0, 0, -7}});
  check<3>(
      "hypot of three", [](const auto& x, const auto& y, const auto& z) { return hypot(x, y, z); },
      [](const wide<3>& a) -> wide<3> {
        const R r = sqrt(R(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]));
        return {R(a[0] / r), R(a[1] / r), R(a[2] / r)};
      },
      three);
}

TEST_CASE("fma and lerp: values and partials") {
  duet_test::random_source random(14);
  auto inputs = random_inputs<3>([&](std::size_t) { return random.signed_log_uniform(1e-3, 1e3); });
  inputs.insert(inputs.end(), {{1 + 0x1p-52, 1 - 0x1p-52, -1},
                               {3, 5, 0},
                               {3, 5, 1},
                               {0.1, 0.3, 1},
                               {-4, 4, 0.5},
                               {1e-300, 1e300, 0.25},
                               {2, 2, 0.7}});
  check<3>(
      "fma", [](const auto& x, const auto& y, const auto& z) { return fma(x, y, z); },
      [](const wide<3>& a) -> wide<3> {
        return {a[1], a[0], R(1)};
      },
      inputs, 0);
  check<3>(
      "lerp", [](const auto& a, const auto& b, const auto& t) { return lerp(a, b, t); },
      [](const wide<3>& a) -> wide<3> {
        return {R(1 - a[2]), a[2], R(a[1] - a[0])};
      },
      inputs, 4);
}

TEST_CASE("fmod, remainder and remquo: values and partials") {
  duet_test::random_source random(15);
  auto inputs = random_inputs<2>([&](std::size_t j) {
    return random.signed_log_uniform(j == 0 ? 1e-3 : 1e-2, j == 0 ? 1e6 : 1e1);
  });
  inputs.insert(inputs.end(), {{7, 2}, {-7, 2}, {7, -2}, {0.3, 0.1}, {1e15, 3}, {5, 1e300}});
  check<2>(
      "fmod", [](const auto& x, const auto& y) { return fmod(x, y); },
      [](const wide<2>& a) -> wide<2> {
        return {R(1), R(-trunc(R(a[0] / a[1])))};
      },
      inputs, 1);
  inputs.insert(inputs.end(), {{5, 2}, {3, 2}}); // ties to even
  const auto nearest_even = [](const R& q) -> R {
    const R nearest = round(q);
    const bool tie = abs(R(q - trunc(q))) == 0.5;
    return tie ? R(2 * round(R(q / 2))) : nearest;
  };
  const auto slopes = [&](const wide<2>& a) -> wide<2> {
    return {R(1), R(-nearest_even(R(a[0] / a[1])))};
  };
  check<2>(
      "remainder", [](const auto& x, const auto& y) { return remainder(x, y); }, slopes, inputs, 1);
  for (const auto& [x, y] : inputs) {
    int expected = 0;
    int quotient = 0;
    const double value = std::remquo(x, y, &expected);
    const auto r = remquo(dual<double>::variable(x), y, &quotient);
    CHECK(quotient == expected);
    CHECK(identical(r.value(), value));
    CHECK(r.epsilon() == 1);
  }
}

/// Checks the derivatives along the first argument at y, `exact[k]` up to order 4.
template <class F>
void add_series(worst_error& worst, F f, double x, const std::array<R, 5>& exact) {
  const auto series = f(duet::taylor<double, 4>::variable(x));
  for (std::size_t k = 1; k <= 4; ++k) {
    worst.add(ulps(series.derivative(int(k)), exact[k], exact[k]), k, x);
  }
}

// By closed forms: differences would need more than 100 digits to resolve x²/r³ beside 1/r.
TEST_CASE("hypot and atan2: arguments decades apart keep their digits to the fourth derivative") {
  worst_error worst_hypot("hypot");
  worst_error worst_hypot_3("hypot of three");
  worst_error worst_atan2("atan2");
  worst_error worst_mixed("mixed derivatives");
  duet_test::random_source random(15);
  for (int i = 0; i < 400; ++i) {
    const double a = random.signed_log_uniform(1e-12, 1e12);
    const double b = a * random.signed_log_uniform(1e3, 1e20);
    const auto [x, y] = i % 2 == 0 ? std::array{a, b} : std::array{b, a};
    const R wide_x(x), wide_y(y);
    const R s = wide_x * wide_x, t = wide_y * wide_y, square = s + t, r = sqrt(square);
    const std::array<R, 5> length{r, R(wide_x / r), R(t / (r * square)),
                                  R(-3 * wide_x * t / (r * square * square)),
                                  R(3 * t * (4 * s - t) / (r * square * square * square))};
    add_series(
        worst_hypot, [y = y](const auto& u) { return hypot(u, y); }, x, length);
    add_series(
        worst_hypot_3, [y = y](const auto& u) { return hypot(y * 0.6, u, y * 0.8); }, x,
        [&, y = y] {
          const R z = wide_y * wide_y * (R(0.6 * y) * R(0.6 * y) + R(0.8 * y) * R(0.8 * y)) / t;
          const R q = s + z, n = sqrt(q);
          return std::array<R, 5>{n, R(wide_x / n), R(z / (n * q)),
                                  R(-3 * wide_x * z / (n * q * q)),
                                  R(3 * z * (4 * s - z) / (n * q * q * q))};
        }());
    const R cube = square * square * square;
    const std::array<R, 5> angle{
        R(0), R(wide_y / square), R(-2 * wide_x * wide_y / (square * square)),
        R(2 * wide_y * (3 * s - t) / cube), R(24 * wide_x * wide_y * (t - s) / (cube * square))};
    add_series(
        worst_atan2, [y = y](const auto& u) { return atan2(u, y); }, x, angle);

    using D = duet::second_order_dual<double, 2>;
    const auto u = D::variable(x, 0), v = D::variable(y, 1);
    const D h = hypot(u, v), theta = atan2(u, v);
    const R hypot_xy = -wide_x * wide_y / (r * square), atan2_xy = (s - t) / (square * square);
    worst_mixed.add(ulps(h.second_partial(0, 1), hypot_xy, hypot_xy), "hypot", x, y);
    worst_mixed.add(ulps(h.second_partial(0, 0), length[2], length[2]), "hypot", x, y);
    worst_mixed.add(ulps(theta.second_partial(0, 1), atan2_xy, atan2_xy), "atan2", x, y);
    worst_mixed.add(ulps(theta.second_partial(0, 0), angle[2], angle[2]), "atan2", x, y);
  }
  CHECK_MESSAGE(worst_hypot <= 16, worst_hypot);
  CHECK_MESSAGE(worst_hypot_3 <= 16, worst_hypot_3);
  CHECK_MESSAGE(worst_atan2 <= 16, worst_atan2);
  CHECK_MESSAGE(worst_mixed <= 16, worst_mixed);
}

TEST_CASE("pow: constant exponent to the fifth derivative") {
  worst_error worst("pow");
  duet_test::random_source random(16);
  const auto add = [&](double x, double p) {
    const auto series = pow(duet::taylor<double, 5>::variable(x), p);
    R exact = exp(R(p * log(R(x))));
    for (int k = 1; k <= 5; ++k) {
      exact *= (R(p) - (k - 1)) / R(x); // one ulp by p does not count: p is exact
      if (abs(exact) < R(1e300) && abs(exact) > R(1e-290)) {
        worst.add(ulps(series.derivative(k), exact, R(abs(exact) * (1 + abs(R(p) - k)))), k, x, p);
      }
    }
  };
  for (int i = 0; i < 600; ++i) {
    const double x = i % 3 == 0 ? random.log_uniform(0.1, 10) : random.log_uniform(1e-60, 1e60);
    add(x, i % 2 == 0 ? random.uniform(-6, 6) : random.signed_log_uniform(1e-9, 1));
  }
  for (const double x : {5e-324, 1e-300, 1e-155, 1e155, 1e300}) {
    for (const double p : {1e-300, 1e-17, 1e-9, 0.001, 0.3, 1.0 / 3, -0.1, -1e-5, 0.49999, 0.7}) {
      add(x, p);
    }
  }
  CHECK_MESSAGE(worst <= 8, worst);
}

} // namespace
} // namespace test_dual_functions_of_many
