// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/nearest_rotation.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/quaternion/average.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <vector>

/// \file
/// Rigid registration of point sets (Kabsch, Umeyama), with or without a scale.

namespace duet {

/// A similarity x ↦ s R x + t; the default is the identity.
template <class T>
struct scaled_pose {
  dual_quaternion<T> pose{dual<T, 1, screw_tag>(T(1))}; ///< rotation R and translation t
  T scale = T(1);                                       ///< s > 0

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("pose", pose);
    f("scale", scale);
  }
};

namespace detail {

/// Centres, rotation and scale of a registration.
template <class T>
struct registration {
  using R = real_type_t<T>;
  vector3<T> from_centre, to_centre;
  matrix3<T> rotation;
  T scale;

  static_assert(!std::is_same_v<T, no_promotion>,
                "duet: register_points: the scalars of both sets have no common type");

  template <class P, class Q>
  registration(const P& from, const Q& to, const std::vector<double>& weights) {
    static_assert(can_be_same(P::RowsAtCompileTime, 3) && can_be_same(Q::RowsAtCompileTime, 3),
                  "duet: register_points: points are columns of matrices with three rows");
    static_assert(can_be_same(P::ColsAtCompileTime, Q::ColsAtCompileTime),
                  "duet: register_points: both sets must have the same number of points");
    require(from.rows() == 3 && to.rows() == 3, "duet: register_points: the matrices have ",
            from.rows(), " and ", to.rows(), " rows (expected 3 rows: points are columns)");
    require(from.cols() == to.cols(), "duet: register_points: the sets have ", from.cols(), " and ",
            to.cols(), " points (expected equal numbers)");
    require_weights("register_points", std::size_t(from.cols()), weights);
    require_finite("register_points", real_values<R>(from));
    require_finite("register_points", real_values<R>(to));
    const R p_scale = scale_of<R>(real_values<R>(from)), q_scale = scale_of<R>(real_values<R>(to));
    const double largest = weights.empty() ? 1 : *std::max_element(weights.begin(), weights.end());
    const auto weight = [&](Eigen::Index i) {
      return weights.empty() ? R(1) : R(weights[std::size_t(i)] / largest);
    };
    const auto p = [&](Eigen::Index i) {
      return vector3<T>(T(from(0, i) * p_scale), T(from(1, i) * p_scale), T(from(2, i) * p_scale));
    };
    const auto q = [&](Eigen::Index i) {
      return vector3<T>(T(to(0, i) * q_scale), T(to(1, i) * q_scale), T(to(2, i) * q_scale));
    };
    R sum(0);
    from_centre = to_centre = vector3<T>::Zero();
    for (Eigen::Index i = 0; i < from.cols(); ++i) {
      sum += weight(i);
      from_centre += weight(i) * p(i);
      to_centre += weight(i) * q(i);
    }
    from_centre /= sum;
    to_centre /= sum;
    matrix3<T> covariance = matrix3<T>::Zero();
    T variance(0);
    R rounding(0);
    for (Eigen::Index i = 0; i < from.cols(); ++i) {
      const vector3<T> x = p(i) - from_centre, y = q(i) - to_centre;
      covariance += weight(i) * y * x.transpose();
      variance += weight(i) * x.squaredNorm();
      // Coordinates are rounded, so that collinear points are not exactly collinear.
      rounding +=
          weight(i) * R(largest_of(p(i)) * largest_of(y) + largest_of(x) * largest_of(q(i)));
    }
    rounding = R(16 * std::numeric_limits<R>::epsilon() * rounding);
    const polar_decomposition<R, 3> polar("register_points", real_values<R>(covariance));
    require(polar.gap > std::max(polar.rounding, rounding),
            "duet: register_points: the points do not determine a rotation: they are collinear, or "
            "mirror images with a symmetry (signed singular values of the scaled covariance: ",
            polar.lambda[0], ", ", polar.lambda[1], ", ", polar.lambda[2], ")");
    rotation = rotation_of<T>(polar, covariance);
    scale = (rotation.transpose() * covariance).trace() / variance * (p_scale / q_scale);
    from_centre /= p_scale;
    to_centre /= q_scale;
  }

private:
  static R largest_of(const vector3<T>& x) { return real_values<R>(x).cwiseAbs().maxCoeff(); }
};

} // namespace detail

/// Pose that takes points pᵢ to points qᵢ with the smallest Σ wᵢ |R pᵢ + t − qᵢ|².
///
/// \param from     pᵢ, the columns of a matrix with three rows
/// \param to       qᵢ, as many
/// \param weights  wᵢ ≥ 0, up to a common factor; empty (the default) for equal weights
///
/// With the weighted centres p̄, q̄, R = `nearest_rotation(Σ wᵢ (qᵢ − q̄)(pᵢ − p̄)ᵀ)` and
/// t = q̄ − R p̄ (W. Kabsch, Acta Cryst. A32 (1976) 922–923; S. Umeyama, IEEE Trans. PAMI 13 (1991)
/// 376–380). Derivatives of every order with respect to both sets follow from the equation of R:
/// they exist if R is unique, also for planar and symmetric sets and for exact data.
///
/// \throws invalid_input if the sets differ in size or are not finite, if weights are not valid for
///   `average`, and if R is not unique: the points of a set are collinear, or one set is the mirror
///   image of the other and has too much symmetry
template <class P, class Q>
[[nodiscard]] auto register_points(const Eigen::MatrixBase<P>& from, const Eigen::MatrixBase<Q>& to,
                                   const std::vector<double>& weights = {}) {
  using T = detail::common_scalar_t<P, Q>;
  const detail::registration<T> r(from.eval(), to.eval(), weights);
  return pose(from_rotation_matrix(r.rotation),
              vector3<T>(r.to_centre - r.rotation * r.from_centre));
}

/// Similarity with the smallest Σ wᵢ |s R pᵢ + t − qᵢ|².
///
/// R is that of `register_points`, s = tr(RᵀC)/Σ wᵢ |pᵢ − p̄|² with C = Σ wᵢ (qᵢ − q̄)(pᵢ − p̄)ᵀ,
/// and t = q̄ − s R p̄. Parameters, domain and errors are those of `register_points`.
///
/// \return `scaled_pose`: `transform_point(pose, scale * p)` is the image of p
template <class P, class Q>
[[nodiscard]] auto register_points_with_scale(const Eigen::MatrixBase<P>& from,
                                              const Eigen::MatrixBase<Q>& to,
                                              const std::vector<double>& weights = {}) {
  using T = detail::common_scalar_t<P, Q>;
  const detail::registration<T> r(from.eval(), to.eval(), weights);
  return scaled_pose<T>{pose(from_rotation_matrix(r.rotation),
                             vector3<T>(r.to_centre - r.scale * (r.rotation * r.from_centre))),
                        r.scale};
}

} // namespace duet
