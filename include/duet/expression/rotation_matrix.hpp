// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/matrix/product.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/function.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/printed.hpp>
#include <duet/expression/velocity.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Core>

/// \file
/// Rotations as matrices.

namespace duet::expression {

namespace op {

/// [v]×, of which [v]× w = v × w.
struct cross_matrix {
  static constexpr kind kind_of(kind) { return matrix_kind(3, 3); }
  template <class V>
  static constexpr auto simplified(V) {
    if constexpr (is_zero<V>) {
      return zero_of<matrix_kind(3, 3)>();
    } else {
      return applied_node<cross_matrix, V>{};
    }
  }
  template <class V>
  static auto value(const V& v) {
    using T = typename V::Scalar;
    Eigen::Matrix<T, 3, 3> m;
    m << T(0), -v[2], v[1], v[2], T(0), -v[0], -v[1], v[0], T(0);
    return m;
  }
  template <class V, class DV>
  static constexpr auto differential(V, DV dv) {
    return apply<cross_matrix>(dv);
  }
  static printed print(notation style, const printed& v) {
    return style == notation::latex ? printed{"\\left[" + v.text + "\\right]_{\\times}"}
                                    : printed{"cross_matrix(" + v.text + ")"};
  }
};

/// The matrix of q; its derivative is told by velocities.
struct rotation_matrix {
  static constexpr kind kind_of(kind) { return matrix_kind(3, 3); }
  template <class Q>
  static auto value(const Q& q) {
    return duet::rotation_matrix(q);
  }
  static printed print(notation style, const printed& q) {
    return detail::printed_call(style, {"rotation_matrix", "R"}, q.text);
  }
};

} // namespace op

namespace detail {

/// Ṙ = [ω]× R with ω in spatial axes (N7), for unit q.
template <class Q, class Motion>
struct rate<applied_node<op::rotation_matrix, Q>, Motion> {
  static constexpr auto make() {
    return apply<op::cross_matrix>(velocity_of<spatial_frame, Q, Motion>()) *
           applied_node<op::rotation_matrix, Q>{};
  }
  using type = decltype(make());
};

} // namespace detail

/// [v]×, the matrix of the cross product: [v]× w = v × w.
template <VectorTerm V>
[[nodiscard]] constexpr auto cross_matrix(const V& v) {
  return apply<op::cross_matrix>(v);
}
/// The 3 x 3 matrix R of a rotation, R v = q v q*, with the derivative [ω]× R (N7). q is taken as
/// unit.
template <QuaternionTerm Q>
[[nodiscard]] constexpr auto rotation_matrix(const Q& q) {
  return apply<op::rotation_matrix>(q);
}

} // namespace duet::expression
