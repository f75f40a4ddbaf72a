// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "fuzz/seeded_loop.hpp"

#include <duet/core/errors.hpp>
#include <duet/expression/graph/evaluate.hpp>
#include <duet/expression/graph/formula_text.hpp>
#include <duet/expression/graph/read_formula.hpp>

// Formulas: what is read can be evaluated, and its text is the same formula; errors are messages of
// one line with a column.

namespace test_fuzz_formulas {

std::vector<std::string> seeds() {
  return {"exp(-u)*sin(omega*u^2) + 2x - 3(x + 1)**-2 / 4e-3",
          "vector v, w; rotation q; scalar t; rotate(q*exp(t*v), cross(v, w)) + 2[1, t, v[0]]",
          "rotation q, p; a = slerp(q, p, t); value = log(a), slope = vec(conj(a)) / 2",
          "select(x < 1 && !(y >= 2) || x == y, max(x, y), abs(-x)) - hypot(x, y, 3)",
          "θ₁ = 2; sin(θ₁*x)^2^x + atan2(x, pi) + fma(x, 2, 3) - stumpff2(x) * inf",
          "2 / -x^2 - (-3 / x) * y + (-3) / 10 - -(2/x/y)",
          "((((x))))^-(-(-(x))) + normalized([x, y, 0.1])[1]"};
}

void target(const std::string& input) {
  for (const bool exact : {false, true}) {
    try {
      using namespace duet::expression;
      const formula_graph f = read_formula(input, {.exact_constants = exact, .max_nodes = 10'000});
      const std::string text = to_text(f, exact);
      if (text.size() > std::size_t(64) * 1024) {
        continue;
      }
      const formula_graph g = read_formula(text, {.exact_constants = exact});
      duet_fuzz::require(to_text(g, exact) == text,
                         "the text of a formula is the formula: " + text);
      std::vector<double> inputs(std::size_t(f.input_size()));
      for (std::size_t i = 0; i < inputs.size(); ++i) {
        inputs[i] = 0.3 + 0.1 * double(i);
      }
      const std::vector<double> a = evaluate(f, inputs), b = evaluate(g, inputs);
      for (std::size_t i = 0; i < a.size(); ++i) {
        duet_fuzz::require(a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i])),
                           "the text of a formula has its values: " + text);
      }
    } catch (const duet::invalid_input& error) {
      duet_fuzz::require_message(error.what(), "duet: read_formula: ");
    }
  }
}

TEST_CASE("formulas: mutated texts are read correctly or rejected with a message") {
  duet_fuzz::run_seeded(seeds(), target, 2000);
}

} // namespace test_fuzz_formulas
