// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "formulas/expression_route.hpp"
#include "formulas/table.hpp"

#include <duet/expression/condition.hpp>
#include <duet/expression/derivative.hpp>
#include <duet/expression/rotation.hpp>
#include <duet/expression/screw.hpp>
#include <duet/expression/symbol.hpp>
#include <duet/expression/vector.hpp>

// N1–N9 as expressions.

namespace duet_formulas {
namespace {

using namespace duet::expression;
using std::tuple;

constexpr quaternion_symbol<"p"> p;
constexpr quaternion_symbol<"q"> q;
constexpr quaternion_symbol<"r"> r;
constexpr quaternion_symbol<"dp"> dp;
constexpr quaternion_symbol<"dq"> dq;
constexpr quaternion_symbol<"dr"> dr;
constexpr vector_symbol<"v"> v;
constexpr vector_symbol<"w"> w;
constexpr vector_symbol<"dv"> dv;
constexpr symbol<"rho"> rho;
constexpr symbol<"drho"> drho;

/// N8: E and G row by row.
expression_route rate_matrices() {
  constexpr symbol<"q0"> q0;
  constexpr symbol<"q1"> q1;
  constexpr symbol<"q2"> q2;
  constexpr symbol<"q3"> q3;
  constexpr symbol<"p0"> p0;
  constexpr symbol<"p1"> p1;
  constexpr symbol<"p2"> p2;
  constexpr symbol<"p3"> p3;
  const tuple inputs(moving{q0, symbol<"dq0">{}, 0}, moving{q1, symbol<"dq1">{}, 1},
                     moving{q2, symbol<"dq2">{}, 2}, moving{q3, symbol<"dq3">{}, 3},
                     moving{p0, symbol<"dp0">{}, 4}, moving{p1, symbol<"dp1">{}, 5},
                     moving{p2, symbol<"dp2">{}, 6}, moving{p3, symbol<"dp3">{}, 7});
  const auto e =
      make_vector(-q1 * p0 + q0 * p1 - q3 * p2 + q2 * p3, -q2 * p0 + q3 * p1 + q0 * p2 - q1 * p3,
                  -q3 * p0 - q2 * p1 + q1 * p2 + q0 * p3);
  const auto g =
      make_vector(-q1 * p0 + q0 * p1 + q3 * p2 - q2 * p3, -q2 * p0 - q3 * p1 + q0 * p2 + q1 * p3,
                  -q3 * p0 + q2 * p1 - q1 * p2 + q0 * p3);
  return expression_route("N8", "quaternion_rate_matrix")
      .part(c<2> * e, inputs)
      .part(c<2> * g, inputs);
}

/// N9; the exponent moves.
expression_route interpolation() {
  const auto a = exp(v / c<2>);
  const auto b = exp(w / c<2>);
  const auto nearer = select(dot(a, b) < c<0>, -b, b);
  return expression_route("N9", "slerp")
      .part(a * pow(conj(a) * nearer, rho), tuple(moving{rho, drho, 6}),
            tuple(still{v, 0}, still{w, 3}));
}

} // namespace

std::vector<expression_route> quaternion_expressions() {
  const tuple one(moving{q, dq, 0});
  const tuple two(moving{p, dp, 0}, moving{q, dq, 4});
  const tuple three(moving{p, dp, 0}, moving{q, dq, 4}, moving{r, dr, 8});
  const tuple rate(moving{q, dq, 0}, moving{v, dv, 4});
  const tuple rates(moving{q, dq, 0}, moving{p, dp, 4});
  return {expression_route("N1", "operator*").part(p * q, two),
          expression_route("N2", "conj").part(conj(p * q), two),
          expression_route("N3", "inverse").part(conj(q) / dot(q, q), one),
          expression_route("N4", "exp").part(exp(v / c<2>), tuple(moving{v, dv, 0})),
          expression_route("N4", "log").part(log(q), one),
          expression_route("N5", "pow")
              .part(pow(q, rho), tuple(moving{q, dq, 0}, moving{rho, drho, 4})),
          expression_route("N6", "operator*").part(p * q * r, three),
          expression_route("N7", "quaternion_rate")
              .part(pure(v) * q / c<2>, rate)
              .part(q * pure(v) / c<2>, rate),
          expression_route("N7", "angular_velocity")
              .part(c<2> * vec(p * conj(q)), rates)
              .part(c<2> * vec(conj(q) * p), rates),
          rate_matrices(),
          interpolation()};
}

} // namespace duet_formulas
