// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "formulas/expression_route.hpp"
#include "formulas/table.hpp"

#include <duet/expression/condition.hpp>
#include <duet/expression/derivative.hpp>
#include <duet/expression/elementary_functions.hpp>
#include <duet/expression/rotation.hpp>
#include <duet/expression/symbol.hpp>
#include <duet/expression/vector.hpp>

// P5–P7 as expressions.

namespace duet_formulas {
namespace {

using namespace duet::expression;
using std::tuple;

expression_route angles(bool is_derivative) {
  constexpr symbol<"psi"> psi;
  constexpr symbol<"theta"> theta;
  constexpr symbol<"psi1"> psi1; // first derivatives
  constexpr symbol<"theta1"> theta1;
  constexpr symbol<"phi1"> phi1;
  constexpr symbol<"psi2"> psi2; // and second ones
  constexpr symbol<"theta2"> theta2;
  constexpr symbol<"phi2"> phi2;
  const auto delta =
      make_vector(cos(psi) * cos(theta) * phi1 - sin(psi) * theta1,
                  sin(psi) * cos(theta) * phi1 + cos(psi) * theta1, psi1 - sin(theta) * phi1);
  const tuple moves(moving{psi, symbol<"dpsi">{}, 0}, moving{theta, symbol<"dtheta">{}, 1},
                    moving{psi1, symbol<"dpsi1">{}, 3}, moving{theta1, symbol<"dtheta1">{}, 4},
                    moving{phi1, symbol<"dphi1">{}, 5});
  if (!is_derivative) {
    return expression_route("P5", "euler_rate_matrix").part(delta, moves);
  }
  return expression_route("P5", "derivative, euler_rate_matrix")
      .part(directional_derivative(delta, along(psi, psi1), along(theta, theta1), along(psi1, psi2),
                                   along(theta1, theta2), along(phi1, phi2)),
            std::tuple_cat(moves, tuple(moving{psi2, symbol<"dpsi2">{}, 6},
                                        moving{theta2, symbol<"dtheta2">{}, 7},
                                        moving{phi2, symbol<"dphi2">{}, 8})));
}

} // namespace

std::vector<expression_route> experiment_expressions() {
  constexpr vector_symbol<"v"> v;
  constexpr vector_symbol<"w"> w;
  const tuple both(moving{v, vector_symbol<"dv">{}, 0}, moving{w, vector_symbol<"dw">{}, 3});
  const auto p = exp(v / c<2>);
  const auto q = exp(w / c<2>);
  const auto nearer = select(dot(p, q) < c<0>, -q, q);
  return {angles(false), angles(true),
          expression_route("P6", "relative").part(norm(v - w) / norm(v), both),
          expression_route("P7", "rotation_vector")
              .part(c<2> * norm(vec(log(conj(p) * nearer))), both)};
}

} // namespace duet_formulas
