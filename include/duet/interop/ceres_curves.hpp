// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual/level.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/interop/ceres.hpp>
#include <duet/interop/ceres_curve_blocks.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>

#include <ceres/cost_function.h>

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Residuals of cumulative B-splines for Ceres: Jacobians are those of `motion_jacobian` in closed
/// form, times that of the measurement by dual numbers.

namespace duet {
namespace detail {
DUET_ABI_BEGIN

/// Residual f(motion, values of further blocks …), times a whitening matrix.
template <class Evaluator, int Rates, bool IsRotationOnly, int Residuals, class F, class... Blocks>
class curve_cost final : public ceres::CostFunction {
  using tag = tag_for<void, F>;
  static constexpr int channels = channel_count<Rates, IsRotationOnly>;
  static constexpr int number_of_partials = channels + (Blocks::dimension + ... + 0);
  using number = dual<double, number_of_partials, tag>;
  using indices = std::index_sequence_for<Blocks...>;

public:
  using whitening_type = Eigen::Matrix<double, Residuals, Residuals>;

  curve_cost(const Evaluator& evaluator, const measurement_time& when, F f,
             const whitening_type& whitening, const Blocks&... blocks)
      : evaluator_(evaluator), when_(when), f_(std::move(f)), blocks_(blocks...),
        is_weighted_(whitening != whitening_type::Identity()), whitening_(whitening) {
    set_num_residuals(Residuals);
    std::vector<std::int32_t>& sizes = *mutable_parameter_block_sizes();
    for (std::size_t i = 0; i < evaluator_.block_count(); ++i) {
      sizes.push_back(evaluator_.block_size(i));
    }
    if (when.has_offset()) {
      sizes.push_back(1);
    }
    (sizes.push_back(Blocks::size), ...);
  }

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    return succeeds([&] { return evaluate(indices{}, x, residuals, jacobians); });
  }

private:
  static constexpr auto offsets = offsets_of<Blocks::dimension...>(channels);

  template <std::size_t... I>
  bool evaluate(std::index_sequence<I...>, double const* const* x, double* residuals,
                double** jacobians) const {
    const std::size_t count = evaluator_.block_count();
    const double offset = when_.has_offset() ? *x[count] : 0;
    const double u = when_.time() + offset;
    const auto& breaks = evaluator_.basis().breaks();
    typename Evaluator::active active;
    if (!(std::abs(offset) <= when_.max_offset() && u >= breaks.front() && u <= breaks.back()) ||
        !evaluator_.load(u, x, active)) {
      return false;
    }
    const std::size_t first = count + (when_.has_offset() ? 1 : 0);
    [[maybe_unused]] const std::tuple<typename Blocks::value_type...> values(
        std::get<I>(blocks_).load(x[first + I])...);
    Eigen::Map<Eigen::Matrix<double, Residuals, 1>> r(residuals);
    if (jacobians == nullptr) {
      const auto y =
          f_(evaluator_.template motion<Rates, IsRotationOnly>(u, active), std::get<I>(values)...);
      for (int i = 0; i < Residuals; ++i) {
        r[i] = double(residual_component(y, i));
      }
      if (is_weighted_) {
        r = (whitening_ * r).eval();
      }
      return true;
    }
    const auto m = evaluator_.template motion_jacobian<Rates>(u, active);
    const auto y =
        f_(Evaluator::template moving<Rates, IsRotationOnly, number>(m),
           std::get<I>(blocks_).template seeded<number, offsets[I]>(std::get<I>(values))...);
    row_major<Eigen::Matrix<double, Residuals, 1>, number_of_partials> partials;
    for (int i = 0; i < Residuals; ++i) {
      r[i] = double(part<tag>(residual_component(y, i), 0));
      for (int k = 0; k < number_of_partials; ++k) {
        partials(i, k) = part<tag>(residual_component(y, i), k + 1);
      }
    }
    if (is_weighted_) {
      r = (whitening_ * r).eval();
      partials = (whitening_ * partials).eval();
    }
    const Eigen::Matrix<double, Residuals, 1> by_offset =
        evaluator_.template chain<Rates, IsRotationOnly>(
            m, active, partials.template leftCols<channels>().eval(), x, jacobians);
    if (when_.has_offset() && jacobians[count] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, Residuals, 1>> out(jacobians[count]);
      out = by_offset;
    }
    (write(std::get<I>(blocks_), x[first + I],
           partials.template middleCols<Blocks::dimension>(offsets[I]), jacobians[first + I]),
     ...);
    return true;
  }

  template <class Block, class Tangent>
  static void write(const Block& block, const double* x, const Tangent& tangent, double* jacobian) {
    if (jacobian != nullptr) {
      Eigen::Map<row_major<Eigen::Matrix<double, Residuals, 1>, Block::size>> out(jacobian);
      out = block.ambient_jacobian(tangent, x);
    }
  }

  Evaluator evaluator_;
  measurement_time when_;
  F f_;
  std::tuple<Blocks...> blocks_;
  bool is_weighted_;
  whitening_type whitening_;
};

template <class X>
inline constexpr bool is_curve_blocks = false;
template <class T, int Order>
inline constexpr bool is_curve_blocks<curve_blocks<T, Order>> = true;
template <int Order>
inline constexpr bool is_curve_blocks<split_curve_blocks<Order>> = true;

/// `curve_blocks` or `split_curve_blocks`.
template <class X>
concept CurveBlocks = is_curve_blocks<X>;

template <int Rates, bool IsRotationOnly, int Residuals, class Curve, class F, class... Blocks>
[[nodiscard]] ceres::CostFunction*
make_curve_cost(const Curve& curve, const measurement_time& when, F f,
                const Eigen::Matrix<double, Residuals, Residuals>& whitening,
                const Blocks&... blocks) {
  static_assert(IsRotationOnly || Curve::has_positions,
                "duet: a residual of positions needs a curve of poses or a split curve");
  using evaluator = decltype(curve.evaluator(when));
  return new curve_cost<evaluator, Rates, IsRotationOnly, Residuals, F, Blocks...>(
      curve.evaluator(when), when, std::move(f), whitening, blocks...);
}

/// Tangent of the shorter motion b* a, [v; ω]: positions are subtracted first, so that nothing
/// cancels far from the origin.
template <class S>
[[nodiscard]] vector6<S> pose_difference(const body_motion<S>& a, const quaternion<double>& q,
                                         const vector3<double>& t) {
  const quaternion<S> relative = conj(q) * a.rotation;
  const quaternion<S> shorter = innermost(relative.w()) < 0 ? quaternion<S>(-relative) : relative;
  const vector3<S> difference = a.position - t.template cast<S>();
  const auto step = pose_of_unit(shorter, rotate(quaternion<double>(conj(q)), difference));
  return 2 * twist_of(log_vector(step, "pose_residual"));
}

/// Rotation of a sensor from its block: a rotation, or a pose.
template <class T>
[[nodiscard]] const quaternion<T>& rotation_of_sensor(const quaternion<T>& q) {
  return q;
}
template <class T>
[[nodiscard]] quaternion<T> rotation_of_sensor(const dual_quaternion<T>& a) {
  return rotation(a);
}

DUET_ABI_END
} // namespace detail

/// Residual of Ceres that is any function of the motion of a curve.
///
/// \tparam Rates  highest rate that f reads: 0 none, 1 velocities, 2 accelerations
/// \param f       residuals: takes a `body_motion<S>` and the values of the blocks over S, any
///   scalar, and returns a number, or a vector or array of fixed size
/// \param blocks  what further parameter blocks hold, as for `cost_function`
/// \return a new object, which the problem that it is added to owns. Its parameter blocks are those
///   of `curve.blocks(when)`, the offset if `when` has one, then the further ones
///
/// Evaluations return false where |offset| > max_offset, outside the domain, for signs that are not
/// aligned (after a step; `curve_blocks` checks them at the start), and where f throws. No heap
/// memory is used unless f does, and several threads may evaluate at the same time.
///
/// \throws invalid_input for a time outside the domain
template <int Rates, detail::CurveBlocks Curve, class F, detail::ParameterBlock... Blocks>
[[nodiscard]] ceres::CostFunction* curve_residual(const Curve& curve, const measurement_time& when,
                                                  F f, const Blocks&... blocks) {
  static_assert(Rates >= 0 && Rates <= 2, "duet: curve_residual<Rates> takes 0 to 2 rates");
  using result = std::decay_t<decltype(detail::result_of_call(
      std::declval<const F&>()(std::declval<const body_motion<double>&>(),
                               std::declval<const typename Blocks::value_type&>()...)))>;
  constexpr int count = detail::residual_count<result>();
  static_assert(count > 0, "duet: curve_residual: the function must return a number, or a vector "
                           "or std::array of fixed size");
  return detail::make_curve_cost<Rates, !Curve::has_positions, count>(
      curve, when, std::move(f), Eigen::Matrix<double, count, count>::Identity().eval(), blocks...);
}

/// Residual of a measured orientation: rotation vector of measured* q (rad, body axes), of the
/// shorter arc whatever the sign of the measurement.
///
/// \param whitening  matrix W that multiplies the residual, W Wᵀ the inverse covariance
/// \return as `curve_residual`; blocks: control points, offset if any
template <detail::CurveBlocks Curve>
[[nodiscard]] ceres::CostFunction*
orientation_residual(const Curve& curve, const measurement_time& when,
                     const quaternion<double>& measured,
                     const matrix3<double>& whitening = matrix3<double>::Identity()) {
  return detail::make_curve_cost<0, true, 3>(
      curve, when,
      [measured](const auto& m) { return rotation_vector(conj(measured) * m.rotation); },
      whitening);
}

/// Residual of a measured position of the body's origin, p − measured in fixed axes.
///
/// \param whitening  matrix that multiplies the residual
/// \return as `curve_residual`; blocks: control points, offset if any
template <detail::CurveBlocks Curve>
[[nodiscard]] ceres::CostFunction*
position_residual(const Curve& curve, const measurement_time& when, const vector3<double>& measured,
                  const matrix3<double>& whitening = matrix3<double>::Identity()) {
  return detail::make_curve_cost<0, false, 3>(
      curve, when,
      [measured]<class S>(const body_motion<S>& m) -> vector3<S> {
        return m.position - measured.template cast<S>();
      },
      whitening);
}

/// Residual of a measured pose: tangent [v; ω] of the shorter screw motion measured* A, in body
/// axes.
///
/// \param whitening  matrix that multiplies the residual
/// \return as `curve_residual`; blocks: control points, offset if any
template <detail::CurveBlocks Curve>
[[nodiscard]] ceres::CostFunction*
pose_residual(const Curve& curve, const measurement_time& when,
              const dual_quaternion<double>& measured,
              const matrix6<double>& whitening = matrix6<double>::Identity()) {
  return detail::make_curve_cost<0, false, 6>(
      curve, when,
      [q = rotation(measured), t = translation(measured)](const auto& m) {
        return detail::pose_difference(m, q, t);
      },
      whitening);
}

/// Residual of a measured position of a point of the body, R x + p − measured in fixed axes; of
/// curves of rotations of a direction, R x − measured.
///
/// \param whitening  matrix that multiplies the residual
/// \return as `curve_residual`; blocks: control points, offset if any, three numbers of the point x
///   in body axes
template <detail::CurveBlocks Curve>
[[nodiscard]] ceres::CostFunction*
point_residual(const Curve& curve, const measurement_time& when, const vector3<double>& measured,
               const matrix3<double>& whitening = matrix3<double>::Identity()) {
  return detail::make_curve_cost<0, !Curve::has_positions, 3>(
      curve, when,
      [measured]<class S>(const body_motion<S>& m, const vector3<S>& x) -> vector3<S> {
        return rotate(m.rotation, x) + (m.position - measured.template cast<S>());
      },
      whitening, vector_block<3>());
}

/// Residual of a gyroscope: Cᵀ ω + b − measured in axes of the sensor, with the rotation C from
/// sensor to body axes and the bias b.
///
/// \param sensor     what the block of C holds: `rotation_block`, or `pose_block`, whose position
///   has no effect
/// \param whitening  matrix that multiplies the residual
/// \return as `curve_residual`; blocks: control points, offset if any, three numbers of b, C
template <detail::CurveBlocks Curve, detail::ParameterBlock Sensor>
[[nodiscard]] ceres::CostFunction*
gyroscope_residual(const Curve& curve, const measurement_time& when,
                   const vector3<double>& measured, const Sensor& sensor,
                   const matrix3<double>& whitening = matrix3<double>::Identity()) {
  return detail::make_curve_cost<1, true, 3>(
      curve, when,
      [measured]<class S>(const body_motion<S>& m, const vector3<S>& bias,
                          const auto& pose) -> vector3<S> {
        const quaternion<S> to_body = detail::rotation_of_sensor(pose);
        return rotate(conj(to_body), m.angular_velocity) + (bias - measured.template cast<S>());
      },
      whitening, vector_block<3>(), sensor);
}

/// Residual of an accelerometer: Cᵀ (Rᵀ (p̈ − g) + α × l + ω × (ω × l)) + b − measured in axes of
/// the sensor, with its pose on the body, rotation C and position l, the bias b and the gravity g
/// in fixed axes. At rest it measures −g.
///
/// \param sensor     what the block of the sensor's pose holds: `pose_block` or
///   `dual_quaternion_block`
/// \param whitening  matrix that multiplies the residual
/// \return as `curve_residual`; blocks: control points, offset if any, three numbers of b, the pose
///   of the sensor, three numbers of g
template <detail::CurveBlocks Curve, detail::ParameterBlock Sensor>
  requires(Sensor::dimension == 6)
[[nodiscard]] ceres::CostFunction*
accelerometer_residual(const Curve& curve, const measurement_time& when,
                       const vector3<double>& measured, const Sensor& sensor,
                       const matrix3<double>& whitening = matrix3<double>::Identity()) {
  return detail::make_curve_cost<2, false, 3>(
      curve, when,
      [measured]<class S>(const body_motion<S>& m, const vector3<S>& bias,
                          const dual_quaternion<S>& pose, const vector3<S>& g) -> vector3<S> {
        const vector3<S> arm = translation(pose);
        const vector3<S>&omega = m.angular_velocity, &alpha = m.angular_acceleration;
        const vector3<S> across = alpha.cross(arm) + omega.cross(omega.cross(arm));
        const vector3<S> force = m.acceleration - rotate(conj(m.rotation), g) + across;
        return rotate(conj(rotation(pose)), force) + (bias - measured.template cast<S>());
      },
      whitening, vector_block<3>(), sensor, vector_block<3>());
}

} // namespace duet
