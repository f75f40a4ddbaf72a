// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>
#include <duet/expression/graph/is_equal.hpp>
#include <duet/expression/graph/read_formula.hpp>
#include <duet/expression/graph/recorded.hpp>
#include <duet/expression/graph/reverse.hpp>
#include <duet/expression/graph/trace.hpp>

namespace test_expression_is_equal {
namespace {

using namespace duet::expression;
using duet::recorded;
using duet::vector3;

constexpr symbol<"x"> symbol_x;
constexpr symbol<"y"> symbol_y;
constexpr vector_symbol<"v"> v;
constexpr quaternion_symbol<"q"> q;
constexpr quaternion_symbol<"p"> p;

template <class F, class G>
equality verdict(const F& f, const G& g, const assumptions& known) {
  return is_equal(trace(f, symbol_x, symbol_y), trace(g, symbol_x, symbol_y), known).verdict;
}

// Two terms in x and y, then what is assumed.
#define DUET_VERDICT(expected, first, second, ...)                                                 \
  CHECK_MESSAGE(verdict([]([[maybe_unused]] auto x, [[maybe_unused]] auto y) { return first; },    \
                        []([[maybe_unused]] auto x, [[maybe_unused]] auto y) { return second; },   \
                        assumptions{__VA_ARGS__}) == equality::expected,                           \
                #first " and " #second)

TEST_CASE("is_equal proves identities") {
  DUET_VERDICT(proved, x + y, y + x);
  DUET_VERDICT(proved, (x + y) * (x - y), x * x - y * y);
  DUET_VERDICT(proved, x * x * x - 1, (x - 1) * (x * x + x + 1));
  DUET_VERDICT(proved, sin(x) * sin(x) + cos(x) * cos(x), 1 + 0 * x);
  DUET_VERDICT(proved, sin(2 * x), 2 * sin(x) * cos(x));
  DUET_VERDICT(proved, sin(3 * x), 3 * sin(x) - 4 * pow(sin(x), 3));
  DUET_VERDICT(proved, cos(x / 2) * cos(x / 2), (1 + cos(x)) / 2);
  DUET_VERDICT(proved, sin(x + y), sin(x) * cos(y) + cos(x) * sin(y));
  DUET_VERDICT(proved, exp(x + y), exp(x) * exp(y));
  DUET_VERDICT(proved, exp(2 * x) - 1, expm1(x) * (exp(x) + 1));
  DUET_VERDICT(proved, tanh(x), (exp(2 * x) - 1) / (exp(2 * x) + 1));
  DUET_VERDICT(proved, cosh(x) * cosh(x) - sinh(x) * sinh(x), 1 + 0 * x);
  DUET_VERDICT(proved, x / sqrt(1 + x * x), x * sqrt(1 + x * x) / (1 + x * x));
  DUET_VERDICT(proved, (x * cos(x) - sin(x)) / (x * x), cos(x) / x - sin(x) / (x * x));
  DUET_VERDICT(proved, hypot(x, y) * hypot(x, y), x * x + y * y);
  DUET_VERDICT(proved, erfc(-x), 1 + erf(x));
  DUET_VERDICT(proved,
               duet::derivative(
                   [](auto t) {
                     using std::sin;
                     return sin(t * t) / t;
                   },
                   x)
                   .derivative,
               2 * cos(x * x) - sin(x * x) / (x * x));
}

TEST_CASE("is_equal refutes nothing by sines of angles that are round-off") {
  duet_test::random_source random(3);
  for (int k = 0; k < 400; ++k) {
    const std::string c = duet::to_text(random.log_uniform(1e15, 1e25)), name = k % 3 == 0 ? "sin"
                                                                                : k % 3 == 1
                                                                                    ? "cos"
                                                                                    : "stumpff0";
    CHECK(is_equal(read_formula(name + "(" + c + " * (x + y)^2)"),
                   read_formula(name + "(" + c + " * (x^2 + 2*x*y + y^2))"))
              .verdict != equality::refuted);
  }
}

TEST_CASE("is_equal: nested functions of long sums are unknown in little memory") {
  const std::string text = "slerp(slerp(q, p, u), r, t)";
  const formula_graph f = read_formula("rotation q, p, r; " + text);
  CHECK(is_equal(f, read_formula("rotation r, p, q; " + text)).verdict == equality::unknown);
  CHECK(is_equal(f, f).verdict == equality::proved);
  const formula_graph difference = read_formula("scalar x, y; x - y");
  CHECK(is_equal(difference, read_formula("scalar y, x; y - x")).verdict == equality::refuted);
}

TEST_CASE("is_equal proves no equality that does not hold everywhere") {
  DUET_VERDICT(unknown, x / x, 1 + 0 * x);
  DUET_VERDICT(proved, x / x, 1 + 0 * x, .nonzero = {"x"});
  DUET_VERDICT(refuted, sqrt(x * x), x);
  DUET_VERDICT(unknown, sqrt(x) * sqrt(x), x);
  DUET_VERDICT(proved, sqrt(x) * sqrt(x), x, .positive = {"x"});
  DUET_VERDICT(unknown, log(x * y), log(x) + log(y));
  DUET_VERDICT(unknown, x * (1 + 1e-12), x);
  DUET_VERDICT(refuted, x * (1 + 1e-3), x);
  DUET_VERDICT(unknown, tan(x) * cos(x), sin(x));
  DUET_VERDICT(unknown, (x * x - 1) / (x - 1), x + 1);
  DUET_VERDICT(unknown, 1 / (1 / x), x);
  DUET_VERDICT(refuted, x - y, y - x);
  DUET_VERDICT(unknown, exp(log(x)), x);
  DUET_VERDICT(proved, exp(log(x)), x, .positive = {"x"});
  DUET_VERDICT(unknown, exp(log(x) / 2), sqrt(x)); // at 0
  DUET_VERDICT(unknown, exp(-log(x)), 1 / x);
  DUET_VERDICT(unknown, exp((1 + 1e-12) * log(x)), x, .positive = {"x"});
  DUET_VERDICT(proved, sqrt(4 * x * x * y), 2 * x * sqrt(y), .positive = {"x", "y"});
  DUET_VERDICT(refuted, sqrt(4 * x * x * (1 + y * y)), 2 * x * sqrt(1 + y * y));
  DUET_VERDICT(unknown, sqrt(x / y), sqrt(x) / sqrt(y));
  DUET_VERDICT(proved, duet::stumpff<0>(x * x), cos(x));
  DUET_VERDICT(unknown, duet::stumpff<1>(x * x), sin(x) / x);
  DUET_VERDICT(proved, duet::stumpff<1>(x * x), sin(x) / x, .nonzero = {"x"});
  DUET_VERDICT(proved, x * duet::stumpff<3>(x), 1 - duet::stumpff<1>(x));
  DUET_VERDICT(unknown, 1 / duet::stumpff<2>(x), x / (1 - duet::stumpff<0>(x)));
  DUET_VERDICT(unknown, duet::stumpff<2>(x) * (1 + 1e-12), duet::stumpff<2>(x));
  DUET_VERDICT(proved,
               duet::stumpff<1>(x * duet::arc_ratio(x, y) * duet::arc_ratio(x, y)) *
                   duet::arc_ratio(x, y) * sqrt(x + y * y),
               1 + 0 * sqrt(x + y * y) * duet::arc_ratio(x, y), .positive = {"x"});
  DUET_VERDICT(proved, x / x, 1 + 0 * x, .where_both_have_values = true);
  DUET_VERDICT(proved, sqrt(x) * sqrt(x), x, .where_both_have_values = true);
  DUET_VERDICT(refuted, sqrt(x * x), x, .where_both_have_values = true);
  DUET_VERDICT(unknown, log(x * y), log(x) + log(y), .where_both_have_values = true);
  DUET_VERDICT(unknown, 0.1 * x + 0.2 * x, 0.3 * x); // as numbers they differ
}

TEST_CASE("is_equal: round-off refutes nothing") {
  DUET_VERDICT(proved, cosh(10 * x) * cosh(10 * x) - sinh(10 * x) * sinh(10 * x), 1 + 0 * x);
  DUET_VERDICT(proved, (1e9 + x) * (1e9 + x) - 1e18 - 2e9 * x, x * x);
  DUET_VERDICT(unknown, 1e16 * asin(sin(x / 9)) - 1e16 * (x / 9) + x, x); // by no relation
  DUET_VERDICT(refuted, 1e5 * asin(sin(x / 9)) - 1e5 * (x / 9) + x, 2 * x);
}

TEST_CASE("is_equal: choices whose branches are equal where they are taken") {
  DUET_VERDICT(unknown,
               duet::select(
                   x > 5, [&] { return 1 + 0 * x; }, [&] { return x / x; }),
               1 + 0 * x);
  DUET_VERDICT(proved,
               duet::select(
                   x == 0, [&] { return 1 + 0 * x; }, [&] { return x / x; }),
               1 + 0 * x);
  DUET_VERDICT(proved,
               duet::select(
                   x * x > 4, [&] { return x / x; }, [&] { return 1 + 0 * x; }),
               1 + 0 * x);
  // of branches whose divisor is a factor of 0
  DUET_VERDICT(
      refuted,
      duet::select(
          abs(x) - x == 0, [&] { return abs(x) + x; }, [&] { return 0 * x / (abs(x) - x); }),
      0 * x);
  // so are the two forms of the derivative of a Stumpff function
  DUET_VERDICT(proved,
               duet::derivative([](auto t) { return duet::stumpff<1>(t * t); }, x).derivative,
               x * (duet::stumpff<3>(x * x) - duet::stumpff<2>(x * x)));
}

TEST_CASE("is_equal: rotations") {
  const auto norm_of_rotated = trace(
      [](auto a, auto b) {
        const auto r = duet::rotate(a, b);
        return r.dot(r);
      },
      q, v);
  const auto norm = trace([](auto, auto b) { return b.dot(b); }, q, v);
  CHECK(is_equal(norm_of_rotated, norm, {.unit = {"q"}}).verdict == equality::proved);
  CHECK(is_equal(norm_of_rotated, norm).verdict != equality::proved);
  const auto exponential = trace([](auto a) { return squared_norm(duet::exp(a)); }, v);
  CHECK(is_equal(exponential, trace([](auto a) { return 1 + 0 * a[0]; }, v)).verdict ==
        equality::proved);
  // N4 as textbooks have it, which has no value at 0
  const auto by_half_angle = trace(
      [](auto a) {
        const auto length = sqrt(a.dot(a));
        const auto along = sin(length) / length;
        return duet::quaternion<recorded>(cos(length), along * a[0], along * a[1], along * a[2]);
      },
      v);
  const auto exp = trace([](auto a) { return duet::exp(a); }, v);
  CHECK(is_equal(exp, by_half_angle).verdict == equality::unknown);
  CHECK(is_equal(exp, by_half_angle, {.nonzero = {"v"}}).verdict == equality::proved);
  CHECK(is_equal(reverse_gradient(trace([](auto a) { return duet::exp(a).x(); }, v), {"v"}),
                 reverse_gradient(trace(
                                      [](auto a) {
                                        const auto length = sqrt(a.dot(a));
                                        return sin(length) / length * a[0];
                                      },
                                      v),
                                  {"v"}),
                 {.nonzero = {"v"}})
            .verdict == equality::proved);
  const auto log = trace([](auto a) { return vector3<recorded>(duet::log(a).vec()); }, q);
  const auto by_arc = trace(
      [](auto a) {
        const vector3<recorded> w = a.vec();
        const auto length = sqrt(w.dot(w));
        return vector3<recorded>(w * (atan2(length, a.w()) / length));
      },
      q);
  CHECK(is_equal(log, by_arc).verdict == equality::unknown);

  const auto product = trace([](auto a, auto b) { return duet::conj(a * b); }, q, p);
  CHECK(
      is_equal(product, trace([](auto a, auto b) { return duet::conj(b) * duet::conj(a); }, q, p)));
  CHECK(
      is_equal(product, trace([](auto b, auto a) { return duet::conj(b) * duet::conj(a); }, p, q)));
  const equality_result wrong =
      is_equal(product, trace([](auto a, auto b) { return duet::conj(a) * duet::conj(b); }, q, p));
  CHECK(wrong.verdict == equality::refuted);
  CHECK(wrong.witness.size() == 8);
  CHECK(std::abs(wrong.first - wrong.second) > 1e-6);
  const std::string message =
      duet_test::message_of<duet::invalid_input>([&] { (void)is_equal(norm, product); });
  CHECK(message.find("other inputs or outputs") != std::string::npos);
  formula_graph one_vector, two_numbers;
  one_vector.add_output({.name = "x",
                         .kind = duet::expression::shape::matrix,
                         .rows = 2,
                         .nodes = std::vector<int>(2, one_vector.operations().number(1))});
  two_numbers.add_output({.name = "x", .nodes = {two_numbers.operations().number(1)}});
  two_numbers.add_output({.name = "y", .nodes = {two_numbers.operations().number(1)}});
  CHECK_THROWS_AS((void)is_equal(one_vector, two_numbers), duet::invalid_input);
}

#undef DUET_VERDICT

} // namespace
} // namespace test_expression_is_equal
