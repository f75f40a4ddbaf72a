// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/dual/dual.hpp>
#include <duet/dual/stumpff.hpp>
#include <duet/expression/graph/evaluate.hpp>
#include <duet/expression/graph/formula_derivative.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/formula_text.hpp>
#include <duet/expression/graph/is_equal.hpp>
#include <duet/expression/graph/read_formula.hpp>
#include <duet/expression/graph/recorded.hpp>
#include <duet/expression/graph/reverse.hpp>

// Random formulas of three variables by independent routes: dual numbers forward, reverse
// accumulation, the rules of textbooks, and text that is read again.

namespace test_expression_random_formulas {
namespace {

using namespace duet::expression;
using duet::recorded;

const std::vector<std::string> names{"x", "y", "z"};

std::vector<recorded> add_variables(formula_graph& f) {
  std::vector<recorded> result;
  for (const std::string& name : names) {
    const int node = f.add_input({.name = name}).nodes[0];
    result.emplace_back(f.operations(), node);
  }
  return result;
}

/// An operation on two numbers, all of which have a value everywhere.
recorded operation_on(int which, const recorded& a, const recorded& b, double number) {
  switch (which) {
  case 0:
    return a + b;
  case 1:
    return a - b;
  case 2:
  case 3:
    return a * b;
  case 4:
    return a / (2 + b * b);
  case 5:
    return sin(a);
  case 6:
    return cos(a);
  case 7:
    return exp(-a * a);
  case 8:
    return sqrt(1 + a * a);
  case 9:
    return log(1.5 + cos(a));
  case 10:
    return atan2(a, 1 + b * b);
  case 11:
    return pow(1.2 + sin(a), b);
  case 12:
    return pow(a, 3);
  case 13:
    return tanh(a);
  case 14:
    return number * a;
  case 15:
    return hypot(a, 1 + b);
  case 16:
    return duet::stumpff<1>(recorded(a * a));
  case 17:
    return duet::arc_ratio(recorded(0.1 + a * a), b);
  case 18:
    return select(
        a < b, [&] { return 2 * a; }, [&] { return b * b; });
  case 19:
    return erf(a);
  default:
    return -a;
  }
}

formula_graph random_formula(duet_test::random_source& random) {
  formula_graph f;
  std::vector<recorded> values = add_variables(f);
  const int size = random.integer(4, 17);
  for (int k = 0; k < size; ++k) {
    const auto any = [&] { return values[std::size_t(random.integer(0, int(values.size()) - 1))]; };
    const recorded a = any(), b = any();
    const recorded y = operation_on(random.integer(0, 20), a, b, random.uniform(-2, 2));
    if (!y.is_constant()) {
      values.push_back(y);
    }
  }
  f.add_output({.name = "value", .nodes = {values.back().node_in(f.operations())}});
  return f;
}

bool agree(double a, double b, double tolerance) {
  return std::abs(a - b) <= tolerance * std::max({1.0, std::abs(a), std::abs(b)}) ||
         (a != a && b != b);
}

struct inner_tag;
struct outer_tag;
using gradient_dual = duet::dual<double, 3>;
using twice_dual = duet::dual<duet::dual<double, 1, inner_tag>, 1, outer_tag>;

/// The gradient by dual numbers, recorded.
formula_graph forward_gradient(const formula_graph& f) {
  using moving = duet::dual<recorded, 3>;
  formula_graph result;
  std::vector<moving> inputs;
  for (const recorded& x : add_variables(result)) {
    inputs.push_back(moving::variable(x, int(inputs.size())));
  }
  const moving y = evaluate(f, inputs)[0];
  named_value gradient{.name = "gradient", .kind = shape::matrix, .rows = 3};
  for (int i = 0; i < 3; ++i) {
    gradient.nodes.push_back(y.partial(i).node_in(result.operations()));
  }
  result.add_output({.name = "value", .nodes = {y.value().node_in(result.operations())}});
  result.add_output(std::move(gradient));
  return result;
}

} // namespace

TEST_CASE("random formulas: derivatives by four routes, and text that is read again") {
  duet_test::random_source random(11);
  int proved = 0;
  constexpr int count = 400;
  for (int k = 0; k < count; ++k) {
    const formula_graph f = random_formula(random);
    const std::string text = to_text(f);
    CAPTURE(text);
    std::vector<double> at;
    std::vector<gradient_dual> moving;
    for (int i = 0; i < 3; ++i) {
      at.push_back(random.uniform(-1.5, 1.5));
      moving.push_back(gradient_dual::variable(at.back(), i));
    }
    const double value = evaluate(f, at)[0];
    const gradient_dual forward = evaluate(f, moving)[0];
    const std::vector<double> reverse = evaluate(reverse_hessian(f, names), at);
    CHECK(agree(reverse[0], value, 1e-14));
    for (int i = 0; i < 3; ++i) {
      CHECK(agree(reverse[std::size_t(1 + i)], forward.partial(i), 1e-13));
      for (int j = 0; j <= i; ++j) {
        std::vector<twice_dual> twice;
        for (int n = 0; n < 3; ++n) {
          using inner = duet::dual<double, 1, inner_tag>;
          twice.emplace_back(inner(at[std::size_t(n)], n == i ? 1 : 0), inner(n == j ? 1 : 0, 0));
        }
        const double second = evaluate(f, twice)[0].epsilon().epsilon();
        CHECK(agree(reverse[std::size_t(4 + i + 3 * j)], second, 1e-11));
      }
    }
    const formula_graph read = read_formula(text);
    const double again = evaluate(read, at)[0];
    CHECK((again == value || (again != again && value != value)));
    CHECK(agree(evaluate(derivative(read, "x"), at)[0], forward.partial(0), 1e-11));
    if (k % 4 == 0) {
      const auto verdict = is_equal(reverse_gradient(f, names), forward_gradient(f)).verdict;
      CHECK(verdict != equality::refuted);
      proved += verdict == equality::proved;
    }
  }
  CHECK(proved > count / 4 / 2); // others have functions of equal arguments in other forms
}

} // namespace test_expression_random_formulas
