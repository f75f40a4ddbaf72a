// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "formulas/expression_route.hpp"
#include "formulas/table.hpp"

#include <duet/expression/condition.hpp>
#include <duet/expression/derivative.hpp>
#include <duet/expression/rotation.hpp>
#include <duet/expression/screw.hpp>
#include <duet/expression/symbol.hpp>
#include <duet/expression/vector.hpp>

// N10–N21 as expressions.

namespace duet_formulas {
namespace {

using namespace duet::expression;
using std::tuple;

constexpr pose_symbol<"A"> A;
constexpr pose_symbol<"B"> B;
constexpr pose_symbol<"dA"> dA;
constexpr pose_symbol<"dB"> dB;
constexpr vector_symbol<"r"> r;
constexpr vector_symbol<"dr"> dr;
constexpr vector_symbol<"t"> t;
constexpr vector_symbol<"dt"> dt;
constexpr vector_symbol<"v"> v;
constexpr vector_symbol<"dv"> dv;
constexpr vector_symbol<"w"> w;
constexpr vector_symbol<"dw"> dw;

/// N10, N11: symbols of scalars take dual numbers.
constexpr symbol<"D"> D;
constexpr symbol<"E"> E;
constexpr symbol<"dD"> dD;
constexpr symbol<"dE"> dE;

expression_route dual_vectors() {
  constexpr dual_vector_symbol<"x"> x;
  constexpr dual_vector_symbol<"y"> y;
  const tuple inputs(moving{x, dual_vector_symbol<"dx">{}, 0},
                     moving{y, dual_vector_symbol<"dy">{}, 6});
  return expression_route("N12", "dual_vector").part(dot(x, y), inputs).part(cross(x, y), inputs);
}

/// N15: a point 1 + εv, and the line v through the origin.
expression_route conjugates() {
  const auto point = pose(duet::quaternion<double>(1), c<2> * v);
  const auto along = [](int i) {
    return duet::dual_quaternion<double>(duet::quaternion<double>(0, i == 0, i == 1, i == 2));
  };
  const auto line =
      component<0>(v) * along(0) + component<1>(v) * along(1) + component<2>(v) * along(2);
  const tuple a(moving{A, dA, 0});
  const tuple a_and_v(moving{A, dA, 0}, moving{v, dv, 8});
  return expression_route("N15", "point_conj, conj, dual_conj")
      .part(A * point * point_conj(A), a_and_v)
      .part(A * line * conj(A), a_and_v)
      .part(dual_conj(A), a);
}

/// N18: the twists of a pose that moves with h from (r, t) on at the rates (w, v), at h = 0.
expression_route twists() {
  constexpr symbol<"h"> h;
  const auto a = pose(exp(h * (w / c<2>)) * exp(r / c<2>), t + h * v);
  const auto rate = derivative(a, h);
  const auto spatial = c<2> * vec(rate * conj(a));
  const auto body = c<2> * vec(conj(a) * rate);
  const tuple inputs(moving{r, dr, 0}, moving{t, dt, 3}, moving{w, dw, 6}, moving{v, dv, 9});
  const tuple start(still{h, zero{}});
  auto route = expression_route("N18", "twist")
                   .part(dual_part(spatial), inputs, start)
                   .part(real_part(spatial), inputs, start)
                   .part(dual_part(body), inputs, start)
                   .part(real_part(body), inputs, start);
  route.text = "real and dual parts of `2 * vec(dA * conj(A))`, `2 * vec(conj(A) * dA)`, `dA = "
               "derivative(A, h)` of `A = " +
               to_text(a) + "`";
  return route;
}

/// N19; the exponent moves.
expression_route screw_interpolation() {
  constexpr vector_symbol<"s"> s;
  constexpr symbol<"tau"> tau;
  const auto a = pose(exp(r / c<2>), t);
  const auto b = pose(exp(w / c<2>), s);
  const auto nearer = select(dot(rotation(a), rotation(b)) < c<0>, -b, b);
  return expression_route("N19", "sclerp")
      .part(a * pow(conj(a) * nearer, tau), tuple(moving{tau, symbol<"dtau">{}, 12}),
            tuple(still{r, 0}, still{t, 3}, still{w, 6}, still{s, 9}));
}

/// N21: p is the rate of the quaternion.
expression_route twist_of_coordinates() {
  constexpr quaternion_symbol<"p"> p;
  constexpr quaternion_symbol<"dp"> dp;
  const auto omega = c<2> * vec(p * conj(exp(r / c<2>)));
  return expression_route("N21", "pose_rate_matrix")
      .part(v + cross(t, omega),
            tuple(moving{r, dr, 0}, moving{t, dt, 3}, moving{v, dv, 6}, moving{p, dp, 9}))
      .part(omega, tuple(moving{r, dr, 0}, moving{p, dp, 9}));
}

} // namespace

std::vector<expression_route> dual_quaternion_expressions() {
  const tuple one(moving{A, dA, 0});
  const tuple two(moving{A, dA, 0}, moving{B, dB, 8});
  const tuple place(moving{r, dr, 0}, moving{t, dt, 3});
  const auto placed = pose(exp(r / c<2>), t);
  return {expression_route("N10", "dual, dual_conj")
              .part(D * dual_conj(E), tuple(moving{D, dD, dual_at{0}}, moving{E, dE, dual_at{2}})),
          expression_route("N11", "operator/").part(1 / D, tuple(moving{D, dD, dual_at{0}})),
          dual_vectors(),
          expression_route("N13", "dual_quaternion, real_part, dual_part")
              .part(real_part(A), one)
              .part(dual_part(A), one),
          expression_route("N14", "operator*").part(A * B, two),
          conjugates(),
          expression_route("N16", "norm, is_unit, normalized").part(norm(A), one),
          expression_route("N17", "pose, translation")
              .part(placed, place)
              .part(translation(placed), place),
          twists(),
          screw_interpolation(),
          expression_route("N20", "quaternion_rate_matrix, pose_coordinates_rate")
              .part(v + cross(w, t), tuple(moving{t, dt, 3}, moving{v, dv, 6}, moving{w, dw, 9}))
              .part(pure(w) * exp(r / c<2>) / c<2>, tuple(moving{r, dr, 0}, moving{w, dw, 9})),
          twist_of_coordinates()};
}

} // namespace duet_formulas
