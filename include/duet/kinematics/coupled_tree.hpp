// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/kinematics/centre_of_mass.hpp>
#include <duet/kinematics/jacobian_rate.hpp>
#include <duet/kinematics/kinematic_tree.hpp>
#include <duet/kinematics/tree_jacobian.hpp>

#include <Eigen/Core>

#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Kinematic trees whose coordinates are functions of other variables.

namespace duet {

/// A tree whose coordinates are functions of other variables, usually fewer: q = c(y). All
/// functions of a tree are differentiated through c by dual numbers. (Joints that mimic others only
/// need `kinematic_tree`.)
///
/// Example: `const coupled_tree finger(tree, [](const auto& y) { return std::array{y[0], 2 / 3. *
/// y[0] * y[0]}; });`
///
/// \tparam F  callable, templated over the scalar: takes y, an Eigen vector, `std::array` or
///            `std::vector`, and returns as many coordinates as the tree has, as one of these types
template <class F>
class coupled_tree {
public:
  using own_jacobian = void;

  coupled_tree(kinematic_tree tree, F coupling)
      : tree_(std::move(tree)), coupling_(std::move(coupling)) {}

  /// The tree of the coordinates q.
  [[nodiscard]] const kinematic_tree& tree() const { return tree_; }
  /// The coupling c.
  [[nodiscard]] const F& coupling() const { return coupling_; }

  /// Forward kinematics: the pose at y of a frame as for `kinematic_tree::pose`.
  ///
  /// \throws invalid_input if the number of coordinates of c(y) differs from that of the tree
  template <VectorLike X, FrameOnTree At>
  [[nodiscard]] auto pose(const X& y, const At& at) const {
    return tree_.pose(coupling_(y), at);
  }
  /// Forward kinematics of all links at y, in the order of `tree().links()`.
  ///
  /// \throws invalid_input if the number of coordinates of c(y) differs from that of the tree
  template <VectorLike X>
  [[nodiscard]] auto poses(const X& y) const {
    return tree_.poses(coupling_(y));
  }

private:
  kinematic_tree tree_;
  F coupling_;
};

namespace detail {

/// ∂c/∂y and its time derivative along ẏ.
template <class F, class X, class V>
[[nodiscard]] auto coupling_with_rate(const coupled_tree<F>& tree, const X& y, const V& y_dot) {
  const auto both = directional_derivative(
      [&](const auto& x) { return jacobian(tree.coupling(), x).jacobian; }, y, y_dot);
  return jacobian_and_rate<std::decay_t<decltype(both.value)>>{both.value, both.derivative};
}

/// The coordinate velocities ∂c/∂y ẏ.
template <class J, class V>
[[nodiscard]] auto rates_of_coordinates(const J& m, const V& y_dot) {
  using argument = vector_argument<V>;
  using S = promote_t<typename J::Scalar, typename argument::scalar>;
  Eigen::Matrix<S, Eigen::Dynamic, 1> result(m.rows());
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    result[i] = S(0);
    for (Eigen::Index k = 0; k < m.cols(); ++k) {
      result[i] += S(m(i, k)) * S(argument::get(y_dot, k));
    }
  }
  return result;
}

/// The product of two matrices over any scalars.
template <class A, class B>
[[nodiscard]] auto product_of(const A& a, const B& b) {
  using S = promote_t<typename A::Scalar, typename B::Scalar>;
  return tree_columns<S, A::RowsAtCompileTime>(
      a.template cast<S>().lazyProduct(b.template cast<S>()));
}

/// The unit vectors of y.
template <class X>
[[nodiscard]] Eigen::VectorXd unit_vector(const X& y, Eigen::Index j) {
  return Eigen::VectorXd::Unit(vector_argument<X>::size(y), j);
}

} // namespace detail

/// J ∂c/∂y, the geometric Jacobian of a frame with respect to y: the twist is this matrix times ẏ.
/// Other arguments and errors as `jacobian` of a `kinematic_tree`.
template <class F, VectorLike X, FrameConstant Frame, FrameOnTree At>
[[nodiscard]] auto jacobian(const coupled_tree<F>& tree, const X& y, Frame frame_of_result,
                            const At& at) {
  const auto c = jacobian(tree.coupling(), y);
  return detail::product_of(jacobian(tree.tree(), c.value, frame_of_result, at), c.jacobian);
}

/// Forward kinematics and geometric Jacobian: the pose of a frame at y, and its Jacobian with
/// respect to y. Arguments as `jacobian`.
///
/// \return `value_and_jacobian`
template <class F, VectorLike X, FrameConstant Frame, FrameOnTree At>
[[nodiscard]] auto pose_and_jacobian(const coupled_tree<F>& tree, const X& y, Frame frame_of_result,
                                     const At& at) {
  const auto c = jacobian(tree.coupling(), y);
  const auto both = pose_and_jacobian(tree.tree(), c.value, frame_of_result, at);
  const auto m = detail::product_of(both.jacobian, c.jacobian);
  return value_and_jacobian<std::decay_t<decltype(both.value)>, std::decay_t<decltype(m)>>{
      both.value, m};
}

/// The Jacobian of a frame with respect to y and its time derivative along ẏ, J̇ ∂c/∂y + J d/dt
/// ∂c/∂y. Arguments as `jacobian`.
///
/// \return `jacobian_and_rate`
template <class F, VectorLike X, VectorLike V, FrameConstant Frame, FrameOnTree At>
[[nodiscard]] auto jacobian_with_rate(const coupled_tree<F>& tree, const X& y, const V& y_dot,
                                      Frame frame_of_result, const At& at) {
  const auto c = detail::coupling_with_rate(tree, y, y_dot);
  const auto m =
      jacobian_with_rate(tree.tree(), tree.coupling()(y),
                         detail::rates_of_coordinates(c.jacobian, y_dot), frame_of_result, at);
  const auto rate = detail::product_of(m.rate, c.jacobian);
  using matrix = std::decay_t<decltype(rate)>;
  return jacobian_and_rate<matrix>{detail::product_of(m.jacobian, c.jacobian),
                                   rate + detail::product_of(m.jacobian, c.rate)};
}

/// J̇ of `jacobian_with_rate`, the time derivative of the Jacobian of a frame with respect to y.
///
/// \return a matrix of 6 rows and a column for each component of y
template <class F, VectorLike X, VectorLike V, FrameConstant Frame, FrameOnTree At>
[[nodiscard]] auto jacobian_rate(const coupled_tree<F>& tree, const X& y, const V& y_dot,
                                 Frame frame_of_result, const At& at) {
  return jacobian_with_rate(tree, y, y_dot, frame_of_result, at).rate;
}

/// Kinematic Hessian with respect to y: the derivatives of the Jacobian of a frame, a matrix for
/// each component of y. Arguments as `jacobian`.
///
/// \return a `std::vector` of matrices
template <class F, VectorLike X, FrameConstant Frame, FrameOnTree At>
[[nodiscard]] auto kinematic_hessian(const coupled_tree<F>& tree, const X& y, Frame frame_of_result,
                                     const At& at) {
  const Eigen::Index n = detail::vector_argument<X>::size(y);
  std::vector<decltype(jacobian_rate(tree, y, detail::unit_vector(y, 0), frame_of_result, at))>
      result;
  for (Eigen::Index j = 0; j < n; ++j) {
    result.push_back(jacobian_rate(tree, y, detail::unit_vector(y, j), frame_of_result, at));
  }
  return result;
}

/// The centre of mass at y, in the frame of the root.
///
/// \throws invalid_input for a tree without mass
template <class F, VectorLike X>
[[nodiscard]] auto centre_of_mass(const coupled_tree<F>& tree, const X& y) {
  return centre_of_mass(tree.tree(), tree.coupling()(y));
}

/// The Jacobian of the centre of mass with respect to y. Arguments as `centre_of_mass`.
///
/// \return a matrix of 3 rows and a column for each component of y
template <class F, VectorLike X>
[[nodiscard]] auto centre_of_mass_jacobian(const coupled_tree<F>& tree, const X& y) {
  const auto c = jacobian(tree.coupling(), y);
  return detail::product_of(centre_of_mass_jacobian(tree.tree(), c.value), c.jacobian);
}

/// The time derivative along ẏ of `centre_of_mass_jacobian` with respect to y.
///
/// \return a matrix of 3 rows and a column for each component of y
template <class F, VectorLike X, VectorLike V>
[[nodiscard]] auto centre_of_mass_jacobian_rate(const coupled_tree<F>& tree, const X& y,
                                                const V& y_dot) {
  const auto c = detail::coupling_with_rate(tree, y, y_dot);
  const auto q = tree.coupling()(y);
  const auto rate = detail::product_of(
      centre_of_mass_jacobian_rate(tree.tree(), q, detail::rates_of_coordinates(c.jacobian, y_dot)),
      c.jacobian);
  using matrix = std::decay_t<decltype(rate)>;
  return matrix(rate + detail::product_of(centre_of_mass_jacobian(tree.tree(), q), c.rate));
}

/// The second derivatives of the centre of mass with respect to y, a matrix for each
/// component of y.
///
/// \return a `std::vector` of matrices
template <class F, VectorLike X>
[[nodiscard]] auto centre_of_mass_hessian(const coupled_tree<F>& tree, const X& y) {
  const Eigen::Index n = detail::vector_argument<X>::size(y);
  std::vector<decltype(centre_of_mass_jacobian_rate(tree, y, detail::unit_vector(y, 0)))> result;
  for (Eigen::Index j = 0; j < n; ++j) {
    result.push_back(centre_of_mass_jacobian_rate(tree, y, detail::unit_vector(y, j)));
  }
  return result;
}

} // namespace duet
