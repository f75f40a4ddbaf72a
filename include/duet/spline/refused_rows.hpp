// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/refused.hpp>
#include <duet/quaternion/foreign.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/equations/curve_equations.hpp>

#include <vector>

/// \file
/// Compile-time rejection of wrong or missing samples of a curve.

namespace duet::detail {

template <class X>
using itself = X;

template <class X>
inline constexpr bool is_standard_vector = false;
template <class X, class Allocator>
inline constexpr bool is_standard_vector<std::vector<X, Allocator>> = true;

} // namespace duet::detail

/// Declares rejected overloads of `function<Spline>` for arguments other than those shown;
/// `result<Spline>` is the type of its result.
#define DUET_REFUSES_ROWS(function, result, arguments)                                             \
  template <CurveType Spline, class U, detail::ForeignRows Rows, class... More>                    \
  DUET_REFUSED_FOREIGN_ROWS(function)                                                              \
  result<Spline> function(const U&, const Rows&, const More&...);                                  \
  template <CurveType Spline, class U, class Rows, class... More>                                  \
    requires(!detail::ForeignRows<Rows> &&                                                         \
             (!detail::is_standard_vector<U> || !detail::is_standard_vector<Rows>))                \
  DUET_REFUSED(#function " takes standard vectors: std::vector<double> of parameters, "            \
                         "std::vector<quaternion<double>> of samples")                             \
  result<Spline> function(const U&, const Rows&, const More&...);                                  \
  template <CurveType Spline, class T>                                                             \
  DUET_REFUSED(#function ": the parameters are missing: " #function "<Curve>" arguments)           \
  result<Spline> function(const std::vector<quaternion<T>>&);                                      \
  template <CurveType Spline, class T, class Other, class... More>                                 \
  DUET_REFUSED(#function ": the parameters come first: " #function "<Curve>" arguments)            \
  result<Spline> function(const std::vector<quaternion<T>>&, const Other&, const More&...);        \
  template <class U, class T, class... More>                                                       \
    requires(!CurveType<U>)                                                                        \
  DUET_REFUSED(#function ": the type of the curve is missing: " #function                          \
                         "<cumulative_bspline<double>>" arguments)                                 \
  result<cumulative_bspline<T>> function(const U&, const std::vector<quaternion<T>>&,              \
                                         const More&...);                                          \
  template <template <class, int> class Spline, class... X>                                        \
  DUET_REFUSED(#function ": the scalar of the curve is missing: " #function                        \
                         "<cumulative_bspline<double>>" arguments)                                 \
  result<cumulative_bspline<double>>                                                               \
  function(const X&...);
