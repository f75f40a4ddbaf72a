// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>
#include <duet/expression/graph/reverse.hpp>
#include <duet/expression/graph/trace.hpp>

#include <Eigen/Core>

namespace test_expression_trace {
namespace {

using namespace duet::expression;
using duet::quaternion;
using duet::recorded;
using duet::vector3;

constexpr symbol<"u"> u;
constexpr symbol<"t"> t;
constexpr vector_symbol<"v"> v;
constexpr vector_symbol<"w"> w;
constexpr quaternion_symbol<"q"> q;
constexpr quaternion_symbol<"p"> p;
constexpr pose_symbol<"A"> A;
constexpr pose_symbol<"B"> B;

const vector3<double> v0(0.3, -0.2, 0.7), w0(-1.1, 0.4, 0.2);
const std::vector<double> angles{0, 1e-9, 0.3, 1.4, 3.1, 3.5};

/// The largest difference between the numbers of two objects.
template <class X>
double difference(const X& a, const X& b) {
  std::vector<double> x, y;
  detail::for_each_number(a, [&](double s) { x.push_back(s); });
  detail::for_each_number(b, [&](double s) { y.push_back(s); });
  REQUIRE(x.size() == y.size());
  double result = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    result = std::max(result, std::abs(x[i] - y[i]));
  }
  return result;
}

TEST_CASE("trace: scalars, vectors, rotations and poses have the values of the function") {
  const auto scalar = [](auto x, auto a) {
    using std::exp;
    using std::sin;
    return exp(-x) * sin(a[0] * x * x) + x / (1 + a[1] * a[1]) - pow(x + 2, -3);
  };
  const auto curve = [](auto x, auto a, auto from, auto to) {
    using T = decltype(x);
    return duet::slerp(from, to, x) * duet::exp(vector3<T>(x * a));
  };
  const auto motion = [](auto x, auto from, auto to) { return duet::sclerp(from, to, x); };
  const auto scalar_formula = trace(scalar, u, v);
  const auto curve_formula = trace(curve, u, v, q, p);
  const auto motion_formula = trace(motion, u, A, B);
  for (const double x : angles) {
    CAPTURE(x);
    CHECK(std::abs(scalar_formula(u = x, v = v0) - scalar(x, v0)) < 1e-15);
    const quaternion<double> q0 = duet::exp(vector3<double>(x * w0)), p0 = duet::exp(v0);
    CHECK(difference(curve_formula(q = q0, u = 0.3, v = v0, p = p0), curve(0.3, v0, q0, p0)) <
          1e-15);
    const auto A0 = duet::pose(q0, v0), B0 = duet::pose(p0, w0);
    CHECK(difference(motion_formula(A = A0, B = B0, u = 0.3), motion(0.3, A0, B0)) < 1e-15);
  }
  // the results of a function that returns several
  const auto both = trace(
      [](auto x) {
        return std::pair{sin(x), vector3<decltype(x)>(x, 1, x * x)};
      },
      u);
  REQUIRE(both.outputs().size() == 2);
  CHECK(both.outputs()[1].rows == 3);
  CHECK(std::get<1>(both(u = 2.0)) == vector3<double>(2, 1, 4));
}

TEST_CASE("trace: dual numbers through a traced function, and a trace of dual numbers") {
  const auto f = [](auto x) {
    using std::sin;
    using std::sqrt;
    return sin(x * x) / sqrt(1 + x);
  };
  const auto traced = trace(f, u);
  const auto derived = trace([&](auto x) { return duet::derivative(f, x).derivative; }, u);
  for (const double x : angles) {
    const double expected = duet::derivative(f, x).derivative;
    const double inside = duet::derivative([&](auto y) { return traced(u = y); }, x).derivative;
    CHECK(std::abs(inside - expected) < 1e-14);
    CHECK(std::abs(derived(u = x) - expected) < 1e-14);
  }
}

TEST_CASE("trace: a branch on a recorded value is an error that names it") {
  const auto branch = [](auto x) { return x < 0.5 ? x : x * x; };
  const std::string message =
      duet_test::message_of<duet::invalid_input>([&] { (void)trace(branch, u); });
  CHECK(message.find("branches on u < 0.5") != std::string::npos);
  const std::string needs = duet_test::message_of<duet::invalid_input>(
      [&] { (void)trace([](auto x) { return x * int(x + 1); }, u); });
  CHECK(needs.find("needs the number u + 1") != std::string::npos);
  const auto choice = trace(
      [](auto x) {
        return duet::select(
            x < 0.5 && x > -1, [&] { return x; }, [&] { return x * x; });
      },
      u);
  CHECK(choice(u = 0.25) == 0.25);
  CHECK(choice(u = 3.0) == 9);
  CHECK(choice(u = -2.0) == 4);
}

TEST_CASE("graphs: what is written alike is one node, and simplified exactly alone") {
  const auto count = [](const auto& f) { return count_operations(trace(f, u, t)).total(); };
  CHECK(count([](auto x, auto y) { return x * y + y * x; }) == 2); // 2 (x y)
  CHECK(count([](auto x, auto y) { return 0 * x + 1 * y; }) == 0);
  CHECK(count([](auto x, auto y) { return -(-x) - (-y); }) == 1);
  CHECK(count([](auto x, auto y) { return sin(x - y) + sin(y - x); }) == 3); // s - s
  CHECK(count([](auto x, auto) { return sin(x) * cos(-x); }) == 2);          // one pair of sines
  CHECK(count([](auto x, auto) { return 0.1 * (0.3 * x); }) == 2); // 0.1 · 0.3 is rounded
  CHECK(count([](auto x, auto) { return 2 * (0.3 * x); }) == 1);
  // nothing overflows or vanishes that does not as it is written
  const auto product = trace([](auto x, auto y) { return y * x * x; }, u, t);
  CHECK(product(u = 1e-200, t = 1e300) == doctest::Approx(1e-100));
  const auto half = trace([](auto x, auto y) { return 0.5 * x * y; }, u, t);
  CHECK(half(u = 1.5e308, t = 2.0) == 1.5e308);
}

TEST_CASE("trace: bits of the function, also where it overflows or vanishes") {
  const auto check = [](const auto& f) {
    const auto traced = trace(f, u, t);
    for (const double size : {1e-310, 1e-200, 1e-8, 1.0, 1e8, 1e160, 1e200, 1.7e308}) {
      for (const double x : {1.1, -0.3, 0.7}) {
        for (const double y : {1.0, 1e-150, 3e300}) {
          const double written = f(x * size, y), recorded = traced(u = x * size, t = y);
          CAPTURE(x * size);
          CAPTURE(y);
          CHECK((recorded == written || (recorded != recorded && written != written)));
        }
      }
    }
  };
  check([](auto x, auto y) { return (x * 1e200) * 1e-200 + y; });
  check([](auto x, auto y) { return 1e-200 * (1e200 * x) / y; });
  check([](auto x, auto y) { return 0x1p-600 * (0x1p-600 * x) * y; });
  check([](auto x, auto y) { return 0.1 * (0.3 * x) - y * 0.1; });
  check([](auto x, auto y) { return (x + y) - x; });
  check([](auto x, auto y) { return x * x / (y * y); });
  check([](auto x, auto y) { return (x / y) * y / 3; });
  check([](auto x, auto y) { return x * y * x - x * (y * x); });
  check([](auto x, auto y) { return sqrt(x * x + y * y) - hypot(x, y); });
  check([](auto x, auto y) { return x - 0.7 - (y + 0.3 - x); });
  check([](auto x, auto y) { return -(x - y) * -3 / -(y * 0.1); });
}

TEST_CASE("trace: whole powers and their slopes within 4 ulp") {
  using moving = duet::dual<double>;
  duet_test::random_source random(4);
  for (int n = -16; n <= 16; ++n) {
    const auto power = trace(
        [n](auto x) {
          using std::pow;
          return pow(x, decltype(x)(n));
        },
        u);
    const auto gradient = reverse_gradient(power, {"u"});
    for (int k = 0; k < 300; ++k) {
      const double x = k % 2 == 0 ? random.uniform(0.5, 2) : -1 - random.uniform(0, 1e-7);
      const long double y = std::pow(static_cast<long double>(x), n);
      const long double slope = n * std::pow(static_cast<long double>(x), n - 1);
      const auto ulps = [](double computed, long double exact) {
        return exact == 0 ? double(computed != 0)
                          : double(std::abs((computed - exact) / exact) / 0x1p-53L);
      };
      CAPTURE(n);
      CAPTURE(x);
      CHECK(ulps(power(u = x), y) < 4);
      CHECK(ulps(power(u = moving(x, 1.0)).epsilon(), slope) < 4);
      CHECK(ulps(evaluate(gradient, std::vector<double>{x})[1], slope) < 4);
    }
  }
}

TEST_CASE("graph_of: formulas with their derivatives") {
  const auto f = exp(-u) * rotate(exp(u * v) * q, w);
  const auto J = jacobian(f, wrt(u, q), duet::frame::body);
  const formula_graph g = graph_of(J);
  REQUIRE(g.inputs().size() == 4);
  REQUIRE(g.outputs().size() == 2);
  CHECK(g.outputs()[1].name == "jacobian");
  CHECK(g.outputs()[1].columns == 4);
  const quaternion<double> q0 = duet::exp(w0);
  const auto expected = J(u = 0.3, v = v0, q = q0, w = w0);
  std::vector<double> inputs;
  for (const named_value& x : g.inputs()) {
    const std::vector<double> numbers = x.name == "u"   ? std::vector{0.3}
                                        : x.name == "v" ? std::vector{v0[0], v0[1], v0[2]}
                                        : x.name == "w"
                                            ? std::vector{w0[0], w0[1], w0[2]}
                                            : std::vector{q0.w(), q0.x(), q0.y(), q0.z()};
    inputs.insert(inputs.end(), numbers.begin(), numbers.end());
  }
  const std::vector<double> values = evaluate(g, inputs);
  REQUIRE(values.size() == 15);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(std::abs(values[i] - expected.value[Eigen::Index(i)]) < 1e-15);
  }
  for (std::size_t i = 0; i < 12; ++i) {
    CHECK(std::abs(values[3 + i] - expected.jacobian.data()[i]) < 1e-14);
  }
  const auto arm = screw(axis::z, u) * translation_along(axis::x, 0.5) * screw(axis::y, t);
  CHECK(graph_of(motion(arm, u, duet::frame::spatial)).outputs().size() == 3);
}

const auto rosenbrock = [](const auto& x) {
  using T = typename std::decay_t<decltype(x)>::Scalar;
  T sum(0);
  for (Eigen::Index i = 0; i + 1 < x.size(); ++i) {
    const T a = x[i + 1] - x[i] * x[i], b = 1 - x[i];
    sum = sum + 100 * (a * a) + b * b;
  }
  return sum;
};
const auto product_of_sines = [](const auto& x) {
  using std::sin;
  using T = typename std::decay_t<decltype(x)>::Scalar;
  T product(1);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    product = product * sin(x[i]);
  }
  return product;
};

TEST_CASE_TEMPLATE("reverse_gradient: as forward, at most three times the value's operations", Size,
                   std::integral_constant<int, 2>, std::integral_constant<int, 6>,
                   std::integral_constant<int, 40>) {
  static constexpr int n = Size::value;
  const auto check = [](const auto& f) {
    const formula_graph g = duet::expression::trace(f, n);
    Eigen::Matrix<double, n, 1> x0;
    for (int i = 0; i < n; ++i) {
      x0[i] = 0.4 + 0.1 * i;
    }
    const formula_graph derived = reverse_gradient(g, {"x"});
    CHECK(count_operations(derived).total() <= 3 * count_operations(g).total());
    const std::vector<double> values =
        evaluate(derived, std::vector<double>(x0.data(), x0.data() + n));
    const auto expected = duet::gradient(f, x0);
    for (int i = 0; i < n; ++i) {
      CHECK(std::abs(values[std::size_t(1 + i)] - expected.gradient[i]) <=
            1e-14 * (1 + std::abs(expected.gradient[i])));
    }
  };
  check(rosenbrock);
  check(product_of_sines);
}

TEST_CASE("evaluator: as evaluate, call after call") {
  evaluator<double> both(reverse_gradient(duet::expression::trace(rosenbrock, 6), {"x"}));
  for (const double first : {0.3, -1.5, 0.3}) {
    const std::vector<double> x{first, 0.2, 0.7, -0.4, 1, 2};
    const auto expected =
        duet::gradient(rosenbrock, Eigen::Map<const Eigen::VectorXd>(x.data(), 6));
    const std::vector<double>& numbers = both(x);
    REQUIRE(numbers.size() == 7);
    CHECK(numbers == evaluate(reverse_gradient(duet::expression::trace(rosenbrock, 6), {"x"}), x));
    CHECK(numbers[0] == expected.value);
    CHECK(std::abs(numbers[1] - expected.gradient[0]) <= 1e-13 * std::abs(numbers[1]));
  }
  CHECK_THROWS_WITH_AS(static_cast<void>(both({1, 2})),
                       "duet: evaluate: the formula has 6 input numbers, not 2",
                       duet::invalid_input);
}

TEST_CASE("trace: functions of columns of any size") {
  const formula_graph g = duet::expression::trace(
      [](const auto& x) { return std::pair(x[0] * x[49], (2 * x.tail(2)).eval()); }, 50);
  REQUIRE(g.inputs().size() == 1);
  CHECK(g.inputs()[0].name == "x");
  CHECK(g.inputs()[0].rows == 50);
  REQUIRE(g.outputs().size() == 2);
  CHECK(g.outputs()[1].rows == 2);
  std::vector<double> x(50, 3);
  x[49] = 5;
  CHECK(evaluate(g, x) == std::vector<double>{15, 6, 10});
  CHECK_THROWS_WITH_AS(static_cast<void>(duet::expression::trace(rosenbrock, 0)),
                       "duet: trace: the column has 0 numbers (expected at least 1)",
                       duet::invalid_input);
}

TEST_CASE("reverse_gradient of a function at values") {
  const auto at = [](int n) {
    Eigen::VectorXd x(n);
    for (int i = 0; i < n; ++i) {
      x[i] = 0.4 + 0.1 * i;
    }
    return x;
  };
  const auto [y, g] = reverse_gradient(rosenbrock, at(30));
  const auto expected = duet::gradient(rosenbrock, at(30));
  CHECK(y == expected.value);
  CHECK((g - expected.gradient).cwiseAbs().maxCoeff() <
        1e-13 * expected.gradient.cwiseAbs().maxCoeff());
}

TEST_CASE("reverse_gradient: zeros, equal arguments and axes have the slopes of dual numbers") {
  const std::vector<double> numbers{-2, -1, 0, 0.5, 1, 3};
  const auto check = [&](const char* name, const auto& f) {
    CAPTURE(name);
    const formula_graph derived = reverse_gradient(trace(f, u, t), {"u", "t"});
    for (const double a : numbers) {
      for (const double b : numbers) {
        const auto expected =
            duet::gradient([&](const auto& x) { return f(x[0], x[1]); }, Eigen::Vector2d(a, b));
        const std::vector<double> values = evaluate(derived, std::vector<double>{a, b});
        CAPTURE(a);
        CAPTURE(b);
        for (std::size_t i = 0; i < 2; ++i) {
          const double slope = expected.gradient[Eigen::Index(i)];
          CHECK((std::abs(values[1 + i] - slope) <= 1e-14 * (1 + std::abs(slope)) ||
                 (values[1 + i] != values[1 + i] && slope != slope)));
        }
      }
    }
  };
  using std::atan2, std::hypot, std::pow;
  check("pow", [](const auto& x, const auto& y) { return pow(x * x, y + 3); });
  check("hypot", [](const auto& x, const auto& y) { return hypot(x, y + 4) + hypot(x, x + 7); });
  check("atan2", [](const auto& x, const auto& y) { return atan2(x, y + 0.25) * y; });
  check("whole powers",
        [](const auto& x, const auto& y) { return pow(x, 2) * pow(y, 3) + pow(x, 1) + pow(x, 0); });
}

TEST_CASE("graph_of: inputs are in the order in which symbols appear, with every compiler") {
  constexpr symbol<"first"> first;
  constexpr symbol<"second"> second;
  constexpr symbol<"third"> third;
  const formula_graph g = graph_of(exp(-third * first) * sin(second * first) + third);
  std::string names;
  for (const named_value& x : g.inputs()) {
    names += x.name + " ";
  }
  CHECK(names == "third first second ");
}

} // namespace
} // namespace test_expression_trace
