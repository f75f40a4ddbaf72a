// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/recorded.hpp>
#include <duet/expression/graph/trace.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/piecewise_curve.hpp>

#include <cstddef>

/// \file
/// One span of a curve as a formula of its parameter.

namespace duet {

/// The motion on one span of a curve as a formula: input `u`; outputs `value`, a quaternion or dual
/// quaternion, `velocity`, `acceleration` and `jerk` with respect to u in the frame, as
/// `curve.motion(u, frame)` for u from `curve.breaks()[span]` to `curve.breaks()[span + 1]`.
///
/// \throws invalid_input for a span that the curve does not have
template <class Curve, class R, FrameConstant F>
[[nodiscard]] expression::formula_graph formula_of(const piecewise_curve<Curve, R>& curve,
                                                   std::size_t span, F frame) {
  detail::require(span < curve.breaks().size() - 1, "duet: formula_of: span ", span,
                  " does not exist, the curve has ", curve.breaks().size() - 1, " spans");
  expression::formula_graph f;
  const int u = f.add_input({.name = "u"}).nodes[0];
  span_hint hint{span};
  expression::detail::add_outputs(f, "", curve.motion(recorded(f.operations(), u), frame, hint));
  return f;
}

} // namespace duet
