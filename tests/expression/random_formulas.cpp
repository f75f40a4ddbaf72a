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

// Random formulas of three variables: the rules of textbooks against dual numbers, and proofs that
// forward and reverse gradients are equal.

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
  const std::function<recorded()> all[] = {
      [&] { return a + b; },
      [&] { return a - b; },
      [&] { return a * b; },
      [&] { return a / (2 + b * b); },
      [&] { return sin(a); },
      [&] { return cos(a); },
      [&] { return exp(-a * a); },
      [&] { return sqrt(1 + a * a); },
      [&] { return log(1.5 + cos(a)); },
      [&] { return atan2(a, 1 + b * b); },
      [&] { return pow(1.2 + sin(a), b); },
      [&] { return pow(a, 3); },
      [&] { return tanh(a); },
      [&] { return number * a; },
      [&] { return hypot(a, 1 + b); },
      [&] { return duet::stumpff<1>(recorded(a * a)); },
      [&] { return duet::arc_ratio(recorded(0.1 + a * a), b); },
      [&] {
        return select(
            a < b, [&] { return 2 * a; }, [&] { return b * b; });
      },
      [&] { return erf(a); },
      [&] { return -a; }};
  return all[which]();
}

formula_graph random_formula(duet_test::random_source& random) {
  formula_graph f;
  std::vector<recorded> values = add_variables(f);
  const int size = random.integer(4, 17);
  for (int k = 0; k < size; ++k) {
    const auto any = [&] { return values[std::size_t(random.integer(0, int(values.size()) - 1))]; };
    const recorded a = any(), b = any();
    const recorded y = operation_on(random.integer(0, 19), a, b, random.uniform(-2, 2));
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

using gradient_dual = duet::dual<double, 3>;

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

TEST_CASE("random formulas: derivatives by textbook rules, and proofs that two routes are equal") {
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
    const gradient_dual forward = evaluate(f, moving)[0];
    const formula_graph read = read_formula(text);
    CHECK(agree(evaluate(derivative(read, "x"), at)[0], forward.partial(0), 1e-11));
    if (k % 4 == 0) {
      const auto verdict = is_equal(reverse_gradient(f, names), forward_gradient(f)).verdict;
      CHECK(verdict != equality::refuted);
      proved += verdict == equality::proved;
    }
  }
  CHECK(proved > count / 4 / 2); // others have functions of equal arguments in other forms
}

} // namespace
} // namespace test_expression_random_formulas
