// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/structure.hpp>

#include <Eigen/Core>

#include <array>
#include <concepts>
#include <cstddef>
#include <type_traits>
#include <vector>

/// \file
/// Rejection of rotations, poses and three-vectors of other libraries, with a message that names
/// the conversion. For those who extend duet.

namespace duet::detail {

template <class Derived, int Dim>
void as_foreign_motion(const Eigen::RotationBase<Derived, Dim>&);
template <class T, int Dim, int Mode, int Options>
void as_foreign_motion(const Eigen::Transform<T, Dim, Mode, Options>&);

/// A rotation or pose of Eigen.
template <class X>
concept ForeignMotion = requires(const X& x) {
  as_foreign_motion(x);
};

/// Matches all of Eigen's matrix expressions except columns and matrices of fixed size.
template <class Derived>
  requires(!std::same_as<Derived, typename Derived::PlainObject> ||
           Derived::RowsAtCompileTime <= 1 || Derived::ColsAtCompileTime < 1)
void as_foreign(const Eigen::MatrixBase<Derived>&);
template <class T>
  requires(Scalar<T> || Arithmetic<T>)
void as_foreign(const std::vector<T>&);
template <class T, std::size_t N>
  requires(Scalar<T> || Arithmetic<T>)
void as_foreign(const std::array<T, N>&);

template <class X>
concept Foreign = ForeignMotion<X> || requires(const X& x) {
  as_foreign(x);
};

template <class Derived>
  requires(Derived::RowsAtCompileTime == Derived::ColsAtCompileTime)
void as_foreign_row(const Eigen::MatrixBase<Derived>&);
template <ForeignMotion X>
void as_foreign_row(const X&);

/// Rows of rotations or poses of Eigen, as quaternions, matrices or any other of its types.
template <class Rows>
concept ForeignRows = requires(const typename Rows::value_type& row) {
  as_foreign_row(row);
};

/// X is a Q or converts to it implicitly. (Types of Eigen only seem to convert, as the
/// constructor that rejects them takes them.)
template <class X, class Q>
concept Becomes = std::convertible_to<X, Q> && !ForeignMotion<std::remove_cvref_t<X>>;

} // namespace duet::detail

/// Rejects arguments of other libraries to `function`, which takes rotations, poses or vectors; the
/// remaining arguments are the type of its result.
#define DUET_REFUSES_FOREIGN(function, ...)                                                        \
  template <class... X>                                                                            \
    requires(detail::Foreign<X> || ...)                                                            \
  DUET_REFUSED(#function " takes rotations, poses and vectors of duet: from_eigen(q) of those of " \
                         "Eigen, (a + b).eval() of an expression, vector3<double>(v[0], v[1], "    \
                         "v[2]) of standard vectors")                                              \
  __VA_ARGS__ function(const X&...);

/// Message for rows of Eigen's passed to `function`.
#define DUET_REFUSED_FOREIGN_ROWS(function)                                                        \
  DUET_REFUSED(#function ": rows of rotations and poses are those of duet: from_eigen(q) of each " \
                         "quaternion or Isometry3d, in <duet/interop/eigen.hpp>, "                 \
                         "from_rotation_matrix(R) of each matrix")
