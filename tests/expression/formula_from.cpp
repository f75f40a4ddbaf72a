// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/expression/derivative.hpp>
#include <duet/expression/graph/formula_from.hpp>
#include <duet/expression/text.hpp>

namespace test_expression_formula_from {
namespace {

using namespace duet::expression;

constexpr symbol<"u"> u;
constexpr symbol<"omega"> omega;
constexpr vector_symbol<"w"> w;
constexpr quaternion_symbol<"q"> q;

template <class A, class B>
constexpr bool are_same(const A&, const B&) {
  return std::is_same_v<A, B>;
}
template <name Text>
constexpr auto error_column = detail::formula_reading<Text>::error_column;

TEST_CASE("formula_from: a text has the type of the formula in C++") {
  static_assert(
      are_same(formula_from<"exp(-u)*sin(omega*u^2)">, exp(-u) * sin(omega * pow(u, c<2>))));
  static_assert(are_same(formula_from<"2u + 0.5/omega - pi">, 2_c * u + 0.5_c / omega - pi));
  static_assert(are_same(formula_from<"-u^2 * 1.5e-3">, -pow(u, c<2>) * 1.5e-3_c));
  static_assert(are_same(formula_from<"a = u^2; sin(a) + a">, sin(pow(u, c<2>)) + pow(u, c<2>)));
  static_assert(are_same(formula_from<"select(u < 1, max(u, omega), abs(u))">,
                         select(u < c<1>, max(u, omega), abs(u))));
  static_assert(
      are_same(formula_from<"vector w; rotation q; rotate(exp(u*w)*q, cross(w, [u, 1, 2]))">,
               rotate(exp(u * w) * q, cross(w, make_vector(u, c<1>, c<2>)))));
  static_assert(are_same(formula_from<"vector w; norm(w) + w[2]">, norm(w) + component<2>(w)));
  CHECK(to_text(formula_from<"ln(θ₁) + hypot(u, 3)">) == "log(θ₁) + hypot(u, 3)");
  CHECK(to_text(derivative(formula_from<"u*ln(u)">, u)) == to_text(derivative(u * log(u), u)));
}

TEST_CASE("formula_from: errors have the columns of read_formula") {
  static_assert(error_column<"sin(u)"> == 0);
  static_assert(error_column<"sin(u))"> == 7);
  static_assert(error_column<"u +"> == 4);
  static_assert(error_column<"θ₁ $"> == 4);
  static_assert(error_column<"(u"> == 3);
  static_assert(error_column<"vector w w"> == 10);
  static_assert(error_column<"1/2u"> == 4);
  static_assert(error_column<""> == 1);
  CHECK(error_column<"u; u"> == 2);
}

} // namespace
} // namespace test_expression_formula_from
