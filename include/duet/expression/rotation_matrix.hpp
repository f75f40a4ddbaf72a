// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/matrix/product.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/printed.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Core>

/// \file
/// Rotations as matrices.

namespace duet::expression {

namespace op {

/// [v]×, with [v]× w = v × w.
struct skew : linear_operation {
  static printed print(notation style, const printed& v) {
    if (style == notation::notes) {
      return {"\\widehat{" + v.text + "}"};
    }
    return detail::printed_call(style, {"skew", "\\left[#\\right]_{\\times}"}, {v});
  }
  static constexpr kind kind_of(kind) { return matrix_kind(3, 3); }
  template <class V>
  static auto value(const V& v) {
    using T = typename V::Scalar;
    Eigen::Matrix<T, 3, 3> m;
    m << T(0), -v[2], v[1], v[2], T(0), -v[0], -v[1], v[0], T(0);
    return m;
  }
};

/// The rotation matrix of q.
struct rotation_matrix {
  static constexpr detail::function_name name = {"rotation_matrix", "R"};
  static constexpr kind kind_of(kind) { return matrix_kind(3, 3); }
  /// Ṙ = [ω]× R with ω in spatial axes (N7), for unit q.
  static constexpr auto rate_by_velocity(auto omega, auto q, auto) {
    return apply<skew>(omega) * apply<rotation_matrix>(q);
  }
  static auto value(const auto& q) { return duet::rotation_matrix(q); }
};

} // namespace op

/// [v]×, the matrix of the cross product: [v]× w = v × w.
[[nodiscard]] constexpr auto skew(const VectorTerm auto& v) { return apply<op::skew>(v); }
/// The 3 x 3 matrix R of a rotation, R v = q v q*, with the derivative [ω]× R (N7). q is assumed to
/// have unit norm.
[[nodiscard]] constexpr auto rotation_matrix(const QuaternionTerm auto& q) {
  return apply<op::rotation_matrix>(q);
}

} // namespace duet::expression
