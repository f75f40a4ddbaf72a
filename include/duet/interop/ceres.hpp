// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/derivative/manifold.hpp>
#include <duet/dual/level.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/quaternion_order.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/spline/orientations.hpp>

#include <ceres/cost_function.h>
#include <ceres/jet_fwd.h>
#include <ceres/manifold.h>
#include <ceres/sized_cost_function.h>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

/// \file
/// Ceres Solver: manifolds of rotations and poses, ambient Jacobians, and cost functions by dual
/// numbers.
///
/// Tangents are duet's: rotations and poses move on the right, q exp(δ/2), δ in radians, for poses
/// δ = [v; ω] in body axes. Ambient Jacobians, with respect to the numbers of a parameter block,
/// are those of f(q/|q|): right with any manifold that stays on the unit sphere, Ceres' own among
/// them.

namespace duet {

/// Rejects numbers of Ceres as scalars.
template <class T, int N>
class quaternion<ceres::Jet<T, N>> {
public:
  template <class... X>
  DUET_REFUSED("a quaternion cannot have ceres::Jet as its scalar: duet::cost_function calls the "
               "function with dual numbers instead")
  quaternion(const X&...);
};

namespace detail {
DUET_ABI_BEGIN

/// The 4 × 3 matrix B(q) of columns q (0, e_i), with rows in the order of q's numbers in memory.
/// The rate of q exp(δ/2) is ½ B(q) δ̇.
template <class T>
[[nodiscard]] Eigen::Matrix<T, 4, 3> tangent_basis(const quaternion<T>& q, quaternion_order order) {
  const T &w = q.w(), &x = q.x(), &y = q.y(), &z = q.z();
  Eigen::Matrix<T, 4, 3> b;
  if (order == quaternion_order::wxyz) {
    b << -x, -y, -z, w, -z, y, z, w, -x, -y, x, w;
  } else {
    b << w, -z, y, z, w, -x, -y, x, w, -x, -y, -z;
  }
  return b;
}

/// q/|q|, or q itself if that is a unit quaternion to round-off.
template <class T>
[[nodiscard]] quaternion<T> normalized_in_memory(const quaternion<T>& q) {
  return is_unit_to_rounding(q) ? q : normalized(q);
}

template <class Matrix, int Columns>
using row_major = Eigen::Matrix<typename Matrix::Scalar, Matrix::RowsAtCompileTime, Columns,
                                Columns == 1 ? Eigen::ColMajor : Eigen::RowMajor>;

template <class Derived, int Columns>
concept JacobianOf =
    std::derived_from<Derived, Eigen::MatrixBase<Derived>> && Derived::ColsAtCompileTime == Columns;

DUET_ABI_END
} // namespace detail

/// Jacobian of f(q/|q|) with respect to the four numbers of q, 2 J B(q)ᵀ/|q|², where the columns of
/// B(q) are q (0, e_i).
///
/// \param tangent  J, m × 3: Jacobian with respect to δ of q exp(δ/2)
/// \return m × 4, row by row
template <class Derived, class T>
  requires detail::JacobianOf<Derived, 3>
[[nodiscard]] auto ambient(const Eigen::MatrixBase<Derived>& tangent, const quaternion<T>& q,
                           quaternion_order order) {
  const T factor = 2 / squared_norm(q);
  return detail::row_major<Derived, 4>(tangent *
                                       (factor * detail::tangent_basis(q, order)).transpose());
}

/// Jacobian with respect to the seven numbers [t; q] of a pose, translation and unit quaternion:
/// J_t = J_v Rᵀ, J_q = 2 J_ω B(q)ᵀ.
///
/// \param tangent  [J_v J_ω], m × 6: Jacobian with respect to δ = [v; ω] of A exp(δ/2)
/// \return m × 7, row by row
template <class Derived, class T>
  requires detail::JacobianOf<Derived, 6>
[[nodiscard]] auto ambient(const Eigen::MatrixBase<Derived>& tangent, const dual_quaternion<T>& a,
                           quaternion_order order) {
  const quaternion<T> q = real_part(a);
  detail::row_major<Derived, 7> result(tangent.rows(), 7);
  result.template leftCols<3>() =
      tangent.template leftCols<3>() * rotation_matrix(detail::normalized_in_memory(q)).transpose();
  result.template rightCols<4>() = ambient(tangent.template rightCols<3>(), q, order);
  return result;
}

/// Jacobian of f(A/|A|) with respect to the eight numbers [α; β] of a dual quaternion α + εβ:
/// J_α = 2 J_ω B(α)ᵀ + 2 J_v B(β)ᵀ, J_β = 2 J_v B(α)ᵀ, divided by the dual number |A|².
///
/// \param tangent  [J_v J_ω], m × 6: Jacobian with respect to δ = [v; ω] of A exp(δ/2)
/// \return m × 8, row by row
template <class Derived, class T>
  requires detail::JacobianOf<Derived, 6>
[[nodiscard]] auto ambient_of_dual_quaternion(const Eigen::MatrixBase<Derived>& tangent,
                                              const dual_quaternion<T>& a, quaternion_order order) {
  const quaternion<T> alpha = real_part(a), beta = dual_part(a);
  const T square = squared_norm(alpha), factor = 2 / square;
  const T pitch = 2 * dot(alpha, beta) / square;
  const Eigen::Matrix<T, 3, 4> of_alpha =
      (factor * detail::tangent_basis(alpha, order)).transpose();
  const Eigen::Matrix<T, 3, 4> of_beta =
      (factor * detail::tangent_basis(quaternion<T>(beta - pitch * alpha), order)).transpose();
  const auto j_v = tangent.template leftCols<3>();
  const auto j_omega = tangent.template rightCols<3>();
  detail::row_major<Derived, 8> result(tangent.rows(), 8);
  result.template leftCols<4>() = j_omega * of_alpha + j_v * of_beta;
  result.template rightCols<4>() = j_v * of_alpha;
  return result;
}

/// Parameter block of a number.
class number_block {
public:
  static constexpr int size = 1, dimension = 1; ///< numbers in memory; tangent coordinates
  using value_type = double;                    ///< what the block holds

  /// Value in memory.
  [[nodiscard]] static double load(const double* numbers) { return *numbers; }

  /// For those who extend duet: the value over D, variable number `First`.
  template <class D, int First>
  [[nodiscard]] static D seeded(const double& x) {
    return D::variable(x, First);
  }
  /// For those who extend duet: the ambient from the tangent Jacobian.
  template <class J>
  [[nodiscard]] static const J& ambient_jacobian(const J& tangent, const double*) {
    return tangent;
  }
};

/// Parameter block of an Eigen vector of N numbers.
template <int N>
class vector_block {
public:
  static constexpr int size = N, dimension = N;   ///< numbers in memory; tangent coordinates
  using value_type = Eigen::Matrix<double, N, 1>; ///< what the block holds

  /// Value in memory.
  [[nodiscard]] static value_type load(const double* numbers) { return value_type(numbers); }

  /// For those who extend duet: the value over D, variables from number `First` on.
  template <class D, int First>
  [[nodiscard]] static Eigen::Matrix<D, N, 1> seeded(const value_type& x) {
    Eigen::Matrix<D, N, 1> result;
    detail::unrolled<N>([&](int i)
                            DUET_INLINE_LAMBDA { result[i] = D::variable(x[i], First + i); });
    return result;
  }
  /// For those who extend duet: the ambient from the tangent Jacobian.
  template <class J>
  [[nodiscard]] static const J& ambient_jacobian(const J& tangent, const double*) {
    return tangent;
  }
};

namespace detail {
DUET_ABI_BEGIN

/// Value with partials (a, b, c)/2 from the `First`-th on.
template <class D, int First>
[[nodiscard]] DUET_ALWAYS_INLINE D moving_component(double value, double a, double b, double c) {
  return {value, D::partials_type::generated([&](int i) DUET_INLINE_LAMBDA {
            return i == First ? a / 2 : i == First + 1 ? b / 2 : i == First + 2 ? c / 2 : 0.;
          })};
}

/// q exp(δ/2) to first order.
template <class D, int First>
[[nodiscard]] DUET_ALWAYS_INLINE quaternion<D> moving_rotation(const quaternion<double>& q) {
  const double w = q.w(), x = q.x(), y = q.y(), z = q.z();
  return {moving_component<D, First>(w, -x, -y, -z), moving_component<D, First>(x, w, -z, y),
          moving_component<D, First>(y, z, w, -x), moving_component<D, First>(z, -y, x, w)};
}

/// A exp(δ/2) to first order, δ = [v; ω].
template <class D, int First>
[[nodiscard]] DUET_ALWAYS_INLINE dual_quaternion<D> moving_pose(const dual_quaternion<double>& a) {
  const quaternion<double> alpha = real_part(a), beta = dual_part(a);
  const double w = alpha.w(), x = alpha.x(), y = alpha.y(), z = alpha.z();
  const auto component = [](double value, double v_x, double v_y, double v_z, double omega_x,
                            double omega_y, double omega_z) DUET_INLINE_LAMBDA {
    return D(value, D::partials_type::generated([&](int i) DUET_INLINE_LAMBDA {
               return i == First       ? v_x / 2
                      : i == First + 1 ? v_y / 2
                      : i == First + 2 ? v_z / 2
                      : i == First + 3 ? omega_x / 2
                      : i == First + 4 ? omega_y / 2
                      : i == First + 5 ? omega_z / 2
                                       : 0.;
             }));
  };
  const double e_w = beta.w(), e_x = beta.x(), e_y = beta.y(), e_z = beta.z();
  return make_dual_quaternion(moving_rotation<D, First + 3>(alpha),
                              quaternion<D>(component(e_w, -x, -y, -z, -e_x, -e_y, -e_z),
                                            component(e_x, w, -z, y, e_w, -e_z, e_y),
                                            component(e_y, z, w, -x, e_z, e_w, -e_x),
                                            component(e_z, -y, x, w, -e_y, e_x, e_w)));
}

DUET_ABI_END
} // namespace detail

/// Parameter block of a rotation: four numbers, a unit quaternion. Quaternions of another norm
/// stand for q/|q|.
class rotation_block {
public:
  static constexpr int size = 4, dimension = 3; ///< numbers in memory; tangent coordinates
  using value_type = quaternion<double>;        ///< what the block holds

  /// \param order  order of the numbers in memory
  explicit constexpr rotation_block(quaternion_order order) : order_(order) {}

  /// Order of the numbers in memory.
  [[nodiscard]] constexpr quaternion_order order() const { return order_; }

  /// Rotation in memory.
  ///
  /// \throws invalid_input for the zero quaternion
  [[nodiscard]] quaternion<double> load(const double* numbers) const {
    return detail::normalized_in_memory(load_quaternion(numbers, order_));
  }
  /// Writes a rotation to memory.
  void store(const quaternion<double>& q, double* numbers) const {
    store_quaternion(q, numbers, order_);
  }

  /// q exp(δ/2)
  ///
  /// \throws invalid_input for the zero quaternion
  void plus(const double* x, const double* delta, double* sum) const {
    store(in_memory(x) * duet::exp(vector3<double>(delta[0] / 2, delta[1] / 2, delta[2] / 2)), sum);
  }
  /// δ of y = x exp(δ/2), up to a full turn: x and −x are a full turn apart.
  void minus(const double* y, const double* x, double* delta) const {
    Eigen::Map<vector3<double>> result(delta);
    result = 2 * detail::log_vector(detail::relative_rotation(load_quaternion(x, order_),
                                                              load_quaternion(y, order_)),
                                    "rotation_block");
  }
  /// Derivative of `plus` with respect to δ at δ = 0, 4 × 3: ½ B(q).
  ///
  /// \throws invalid_input for the zero quaternion
  [[nodiscard]] Eigen::Matrix<double, 4, 3, Eigen::RowMajor> plus_jacobian(const double* x) const {
    return 0.5 * detail::tangent_basis(in_memory(x), order_);
  }

  /// For those who extend duet: the value over D, its tangent coordinates variables from number
  /// `First` on.
  template <class D, int First>
  [[nodiscard]] static quaternion<D> seeded(const quaternion<double>& q) {
    return detail::moving_rotation<D, First>(q);
  }
  /// For those who extend duet: the ambient from the tangent Jacobian.
  template <class J>
  [[nodiscard]] auto ambient_jacobian(const J& tangent, const double* x) const {
    return ambient(tangent, load_quaternion(x, order_), order_);
  }

private:
  [[nodiscard]] quaternion<double> in_memory(const double* numbers) const {
    const quaternion<double> q = load_quaternion(numbers, order_);
    detail::require_not_zero(q, "rotation_block");
    return q;
  }

  quaternion_order order_;
};

/// Parameter block of a pose: seven numbers [t; q], translation and unit quaternion. Quaternions of
/// another norm stand for q/|q|.
class pose_block {
public:
  static constexpr int size = 7, dimension = 6; ///< numbers in memory; tangent coordinates
  using value_type = dual_quaternion<double>;   ///< what the block holds

  /// \param order  order of the numbers of the quaternion in memory
  explicit constexpr pose_block(quaternion_order order) : rotation_(order) {}

  /// Order of the numbers of the quaternion in memory.
  [[nodiscard]] constexpr quaternion_order order() const { return rotation_.order(); }

  /// Pose in memory.
  ///
  /// \throws invalid_input for the zero quaternion
  [[nodiscard]] dual_quaternion<double> load(const double* numbers) const {
    return detail::pose_of_unit(rotation_.load(numbers + 3), vector3<double>(numbers));
  }
  /// Writes a pose to memory.
  void store(const dual_quaternion<double>& a, double* numbers) const {
    Eigen::Map<vector3<double>> t(numbers);
    t = translation(a);
    rotation_.store(rotation(a), numbers + 3);
  }

  /// A exp(δ/2), δ = [v; ω]
  ///
  /// \throws invalid_input for the zero quaternion
  void plus(const double* x, const double* delta, double* sum) const {
    const auto step =
        duet::exp(dual_vector<double>(dual_vector_of(vector6<double>(vector6<double>(delta) / 2))));
    const quaternion<double> q = rotation_.load(x + 3);
    Eigen::Map<vector3<double>> t(sum);
    t = vector3<double>(x) + rotate(q, translation(step));
    rotation_.store(load_quaternion(x + 3, order()) * rotation(step), sum + 3);
  }
  /// δ of y = x exp(δ/2), up to a full turn, where there may be none: then not finite.
  void minus(const double* y, const double* x, double* delta) const {
    const quaternion<double> q = rotation_.load(x + 3);
    const vector3<double> difference = vector3<double>(y) - vector3<double>(x);
    const auto step = detail::pose_of_unit(detail::relative_rotation(q, rotation_.load(y + 3)),
                                           rotate(quaternion<double>(conj(q)), difference));
    Eigen::Map<vector6<double>> result(delta);
    result = 2 * twist_of(detail::log_vector(step, "pose_block"));
  }
  /// Derivative of `plus` with respect to δ at δ = 0, 7 × 6: [R 0; 0 ½ B(q)].
  ///
  /// \throws invalid_input for the zero quaternion
  [[nodiscard]] Eigen::Matrix<double, 7, 6, Eigen::RowMajor> plus_jacobian(const double* x) const {
    Eigen::Matrix<double, 7, 6, Eigen::RowMajor> result =
        Eigen::Matrix<double, 7, 6, Eigen::RowMajor>::Zero();
    result.topLeftCorner<3, 3>() = rotation_matrix(rotation_.load(x + 3));
    result.bottomRightCorner<4, 3>() = rotation_.plus_jacobian(x + 3);
    return result;
  }

  /// For those who extend duet: the value over D, its tangent coordinates variables from number
  /// `First` on.
  template <class D, int First>
  [[nodiscard]] static dual_quaternion<D> seeded(const dual_quaternion<double>& a) {
    return detail::moving_pose<D, First>(a);
  }
  /// For those who extend duet: the ambient from the tangent Jacobian.
  template <class J>
  [[nodiscard]] auto ambient_jacobian(const J& tangent, const double* x) const {
    const auto q = load_quaternion(x + 3, order());
    return ambient(tangent, dual_quaternion<double>(make_dual_quaternion(q, quaternion<double>())),
                   order());
  }

private:
  rotation_block rotation_;
};

/// Parameter block of a pose: eight numbers [α; β] of the dual quaternion α + εβ. Dual quaternions
/// of another norm stand for A/|A|.
class dual_quaternion_block {
public:
  static constexpr int size = 8, dimension = 6; ///< numbers in memory; tangent coordinates
  using value_type = dual_quaternion<double>;   ///< what the block holds

  /// \param order  order of the numbers of both quaternions in memory
  explicit constexpr dual_quaternion_block(quaternion_order order) : order_(order) {}

  /// Order of the numbers of both quaternions in memory.
  [[nodiscard]] constexpr quaternion_order order() const { return order_; }

  /// Pose in memory.
  ///
  /// \throws invalid_input for α = 0
  [[nodiscard]] dual_quaternion<double> load(const double* numbers) const {
    return detail::normalized_in_memory(in_memory(numbers));
  }
  /// Writes a pose to memory.
  void store(const dual_quaternion<double>& a, double* numbers) const {
    store_quaternion(real_part(a), numbers, order_);
    store_quaternion(dual_part(a), numbers + 4, order_);
  }

  /// A exp(δ/2), δ = [v; ω]
  ///
  /// \throws invalid_input for α = 0
  void plus(const double* x, const double* delta, double* sum) const {
    store(in_memory(x) * duet::exp(dual_vector<double>(
                             dual_vector_of(vector6<double>(vector6<double>(delta) / 2)))),
          sum);
  }
  /// δ of y = x exp(δ/2), up to a full turn, where there may be none: then not finite.
  void minus(const double* y, const double* x, double* delta) const {
    Eigen::Map<vector6<double>> result(delta);
    result = 2 * twist_of(detail::log_vector(detail::relative_rotation(load(x), load(y)),
                                             "dual_quaternion_block"));
  }
  /// Derivative of `plus` with respect to δ at δ = 0, 8 × 6: [0 ½ B(α); ½ B(α) ½ B(β)].
  ///
  /// \throws invalid_input for α = 0
  [[nodiscard]] Eigen::Matrix<double, 8, 6, Eigen::RowMajor> plus_jacobian(const double* x) const {
    const auto a = in_memory(x);
    const Eigen::Matrix<double, 4, 3> half = 0.5 * detail::tangent_basis(real_part(a), order_);
    Eigen::Matrix<double, 8, 6, Eigen::RowMajor> result;
    result << Eigen::Matrix<double, 4, 3>::Zero(), half, half,
        0.5 * detail::tangent_basis(dual_part(a), order_);
    return result;
  }

  /// For those who extend duet: the value over D, its tangent coordinates variables from number
  /// `First` on.
  template <class D, int First>
  [[nodiscard]] static dual_quaternion<D> seeded(const dual_quaternion<double>& a) {
    return detail::moving_pose<D, First>(a);
  }
  /// For those who extend duet: the ambient from the tangent Jacobian.
  template <class J>
  [[nodiscard]] auto ambient_jacobian(const J& tangent, const double* x) const {
    return ambient_of_dual_quaternion(tangent, in_memory(x), order_);
  }

private:
  [[nodiscard]] dual_quaternion<double> in_memory(const double* numbers) const {
    const quaternion<double> alpha = load_quaternion(numbers, order_);
    detail::require_not_zero(alpha, "dual_quaternion_block");
    return make_dual_quaternion(alpha, load_quaternion(numbers + 4, order_));
  }

  quaternion_order order_;
};

namespace detail {
DUET_ABI_BEGIN

/// Evaluates `body`, which returns whether it succeeds; false if it throws.
template <class Body>
[[nodiscard]] bool succeeds(const Body& body) {
  bool result = false;
  catching<void>([&] { result = body(); }, [] {});
  return result;
}

/// A parameter block: what its numbers in memory are.
template <class B>
concept ParameterBlock = requires(const B& block, const double* x) {
  { B::size } -> std::convertible_to<int>;
  { B::dimension } -> std::convertible_to<int>;
  { block.load(x) } -> std::convertible_to<typename B::value_type>;
};

DUET_ABI_END
} // namespace detail

/// Manifold of rotations or poses for Ceres, with duet's tangent: q exp(δ/2). Its functions return
/// false for the zero quaternion.
///
/// \tparam Block  `rotation_block`, `pose_block` or `dual_quaternion_block`
///
/// Example: `problem.SetManifold(q, new duet::rotation_manifold(quaternion_order::xyzw))`.
template <class Block>
class block_manifold final : public ceres::Manifold {
public:
  /// \param order  order of the numbers of quaternions in memory
  explicit block_manifold(quaternion_order order) : block_(order) {}

  /// Numbers in memory.
  [[nodiscard]] int AmbientSize() const override { return Block::size; }
  /// Tangent coordinates.
  [[nodiscard]] int TangentSize() const override { return Block::dimension; }
  /// x exp(δ/2); false if it is not finite.
  bool Plus(const double* x, const double* delta, double* sum) const override {
    return writes(sum, Block::size, [&] { block_.plus(x, delta, sum); });
  }
  /// Derivative of `Plus` with respect to δ at δ = 0, row by row.
  bool PlusJacobian(const double* x, double* jacobian) const override {
    return writes(jacobian, Block::size * Block::dimension, [&] {
      Eigen::Map<Eigen::Matrix<double, Block::size, Block::dimension, Eigen::RowMajor>> result(
          jacobian);
      result = block_.plus_jacobian(x);
    });
  }
  /// δ of y = x exp(δ/2); false if there is no such δ.
  bool Minus(const double* y, const double* x, double* delta) const override {
    return writes(delta, Block::dimension, [&] { block_.minus(y, x, delta); });
  }
  /// Derivative of `Minus` with respect to y at y = x, row by row.
  bool MinusJacobian(const double* x, double* jacobian) const override {
    return writes(jacobian, Block::size * Block::dimension, [&] {
      using identity = Eigen::Matrix<double, Block::dimension, Block::dimension>;
      Eigen::Map<Eigen::Matrix<double, Block::dimension, Block::size, Eigen::RowMajor>> result(
          jacobian);
      result = block_.ambient_jacobian(identity(identity::Identity()), x);
    });
  }

private:
  /// True if `body` does not throw and writes finite numbers.
  template <class Body>
  static bool writes(const double* numbers, int size, const Body& body) {
    return detail::succeeds([&] {
      body();
      return std::all_of(numbers, numbers + size, [](double x) { return std::isfinite(x); });
    });
  }

  Block block_;
};

/// Manifold of unit quaternions, q exp(δ/2).
using rotation_manifold = block_manifold<rotation_block>;
/// Manifold of poses as seven numbers [t; q], A exp(δ/2), δ = [v; ω].
using pose_manifold = block_manifold<pose_block>;
/// Manifold of poses as unit dual quaternions of eight numbers [α; β], A exp(δ/2), δ = [v; ω].
using dual_quaternion_manifold = block_manifold<dual_quaternion_block>;

namespace detail {
DUET_ABI_BEGIN

/// Number of components of a fixed-size result of residuals.
template <class Y>
[[nodiscard]] constexpr int residual_count() {
  if constexpr (Scalar<Y> || Arithmetic<Y>) {
    return 1;
  } else if constexpr (requires { vector_argument<Y>::size_at_compile_time; }) {
    return vector_argument<Y>::size_at_compile_time;
  } else {
    return Eigen::Dynamic;
  }
}

template <class Y>
[[nodiscard]] DUET_ALWAYS_INLINE const auto& residual_component(const Y& y, int i) {
  if constexpr (Scalar<Y> || Arithmetic<Y>) {
    return y;
  } else {
    return component(y, i);
  }
}

/// Writes the ambient Jacobian of one block from the partials of residuals from `first` on.
template <int Residuals, class Tag, class Y, class Block>
DUET_ALWAYS_INLINE void write_block(const Block& block, const double* x, const Y& y, int first,
                                    double* jacobian) {
  if (jacobian == nullptr) {
    return;
  }
  row_major<Eigen::Matrix<double, Residuals, 1>, Block::dimension> tangent;
  for (int i = 0; i < Residuals; ++i) {
    for (int k = 0; k < Block::dimension; ++k) {
      tangent(i, k) = part<Tag>(residual_component(y, i), first + k + 1);
    }
  }
  Eigen::Map<row_major<decltype(tangent), Block::size>>(jacobian, Residuals, Block::size) =
      block.ambient_jacobian(tangent, x);
}

/// Running sums of sizes: `first`, then with each size added.
template <int... Sizes>
[[nodiscard]] constexpr std::array<int, sizeof...(Sizes) + 1> offsets_of(int first) {
  std::array<int, sizeof...(Sizes) + 1> result{first};
  std::size_t i = 0;
  ((result[i + 1] = result[i] + Sizes, ++i), ...);
  return result;
}

/// Residuals as a function of the values of parameter blocks.
template <int Residuals, class F, class... Blocks>
class function_of_blocks final : public ceres::SizedCostFunction<Residuals, Blocks::size...> {
  using tag = tag_for<void, F>;
  using number = dual<double, (Blocks::dimension + ...), tag>;

public:
  function_of_blocks(F f, const Blocks&... blocks) : f_(std::move(f)), blocks_(blocks...) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    return succeeds([&] {
      return evaluate(std::index_sequence_for<Blocks...>{}, parameters, residuals, jacobians);
    });
  }

private:
  static constexpr auto offsets = offsets_of<Blocks::dimension...>(0);

  template <std::size_t... I>
  bool evaluate(std::index_sequence<I...>, double const* const* parameters, double* residuals,
                double** jacobians) const {
    const std::tuple<typename Blocks::value_type...> x(std::get<I>(blocks_).load(parameters[I])...);
    if (jacobians == nullptr) {
      const auto y = f_(std::get<I>(x)...);
      for (int i = 0; i < Residuals; ++i) {
        residuals[i] = double(residual_component(y, i));
      }
      return true;
    }
    const auto y = f_(std::get<I>(blocks_).template seeded<number, offsets[I]>(std::get<I>(x))...);
    for (int i = 0; i < Residuals; ++i) {
      residuals[i] = double(part<tag>(residual_component(y, i), 0));
    }
    (write_block<Residuals, tag>(std::get<I>(blocks_), parameters[I], y, offsets[I], jacobians[I]),
     ...);
    return true;
  }

  F f_;
  std::tuple<Blocks...> blocks_;
};

/// Residuals as a function of pointers to the numbers of parameter blocks.
template <int Residuals, class F, int... Sizes>
class function_of_pointers final : public ceres::SizedCostFunction<Residuals, Sizes...> {
  static constexpr int size = (Sizes + ...);
  using number = dual<double, size, tag_for<void, F>>;

public:
  explicit function_of_pointers(F f) : f_(std::move(f)) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    return succeeds([&] {
      constexpr auto blocks = std::make_index_sequence<sizeof...(Sizes)>{};
      if (jacobians == nullptr) {
        return call(blocks, parameters, residuals);
      }
      return evaluate(blocks, parameters, residuals, jacobians);
    });
  }

private:
  static constexpr std::array<int, sizeof...(Sizes)> sizes{Sizes...};
  static constexpr auto offsets = offsets_of<Sizes...>(0);

  template <std::size_t... I, class Pointers, class T>
  bool call(std::index_sequence<I...>, const Pointers& parameters, T* residuals) const {
    if constexpr (std::is_void_v<decltype(f_(parameters[I]..., residuals))>) {
      f_(parameters[I]..., residuals);
      return true;
    } else {
      return f_(parameters[I]..., residuals);
    }
  }

  template <std::size_t... I>
  bool evaluate(std::index_sequence<I...> blocks, double const* const* parameters,
                double* residuals, double** jacobians) const {
    std::array<number, std::size_t(size)> x;
    std::array<const number*, sizeof...(Sizes)> pointers{(x.data() + offsets[I])...};
    std::array<number, std::size_t(Residuals)> y;
    unrolled_blocks(blocks, [&](std::size_t b) {
      for (int k = 0; k < sizes[b]; ++k) {
        x[std::size_t(offsets[b] + k)] = number::variable(parameters[b][k], offsets[b] + k);
      }
    });
    if (!call(blocks, pointers, y.data())) {
      return false;
    }
    for (int i = 0; i < Residuals; ++i) {
      residuals[i] = y[std::size_t(i)].value();
    }
    unrolled_blocks(blocks, [&](std::size_t b) {
      if (double* out = jacobians[b]) {
        for (int i = 0; i < Residuals; ++i) {
          for (int k = 0; k < sizes[b]; ++k) {
            out[i * sizes[b] + k] = y[std::size_t(i)].partial(offsets[b] + k);
          }
        }
      }
    });
    return true;
  }

  template <std::size_t... I, class Visit>
  static void unrolled_blocks(std::index_sequence<I...>, const Visit& visit) {
    (visit(I), ...);
  }

  F f_;
};

DUET_ABI_END
} // namespace detail

/// Cost function of Ceres from a function of rotations, poses, vectors and numbers over any scalar,
/// by dual numbers with a partial for each tangent coordinate.
///
/// \param f       residuals: f takes the values of the blocks and returns a number, or a vector or
///   array of fixed size
/// \param blocks  what the parameter blocks hold: `rotation_block`, `pose_block`,
///   `dual_quaternion_block`, `vector_block<N>`, `number_block`
/// \return a new object, which the problem that it is added to owns
///
/// Evaluations return false, as Ceres demands instead of exceptions, where f throws or a quaternion
/// is zero. No heap memory is used unless f does.
///
/// Example: `cost_function([](const auto& a, const auto& b) { return rotation_vector(conj(a) * b);
/// }, rotation_block(order), rotation_block(order))`.
template <detail::FunctionOfAny F, detail::ParameterBlock... Blocks>
  requires(sizeof...(Blocks) > 0)
[[nodiscard]] ceres::CostFunction* cost_function(F f, const Blocks&... blocks) {
  using result = std::decay_t<decltype(detail::result_of_call(
      std::declval<const F&>()(std::declval<const typename Blocks::value_type&>()...)))>;
  constexpr int count = detail::residual_count<result>();
  static_assert(count > 0, "duet: cost_function: the function must return a number, or a vector or "
                           "std::array of fixed size");
  return new detail::function_of_blocks<count, F, Blocks...>(std::move(f), blocks...);
}

/// Cost function of Ceres from a functor as `ceres::AutoDiffCostFunction` takes it,
/// f(const T* block …, T* residuals), by dual numbers with a partial for each number.
///
/// \tparam Residuals  number of residuals
/// \tparam Sizes      size of each parameter block
/// \param f  may return false where there is no value
/// \return a new object, which the problem that it is added to owns
///
/// Evaluations return false, as Ceres demands instead of exceptions, where f throws. No heap memory
/// is used unless f does.
///
/// Example: `cost_function<2, 9, 3>(reprojection_error{u, v})`.
template <int Residuals, int... Sizes, class F>
  requires(sizeof...(Sizes) > 0)
[[nodiscard]] ceres::CostFunction* cost_function(F f) {
  return new detail::function_of_pointers<Residuals, F, Sizes...>(std::move(f));
}

template <detail::FunctionOfReals F, class... Blocks>
DUET_REFUSED_FUNCTION(cost_function)
ceres::CostFunction* cost_function(const F&, const Blocks&...);

} // namespace duet
