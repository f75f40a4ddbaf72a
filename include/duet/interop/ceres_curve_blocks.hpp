// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/derivative/manifold.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/interop/ceres.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/quaternion_order.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/motion.hpp>
#include <duet/spline/motion_jacobian.hpp>
#include <duet/spline/orientations.hpp>
#include <duet/spline/product_jacobian.hpp>
#include <duet/spline/split_bspline.hpp>

#include <ceres/problem.h>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Control points of curves in parameter blocks of Ceres, times of measurements with an offset, and
/// the motion that models of measurements take.

namespace duet {

/// Time of a measurement on a curve.
///
/// With a positive `max_offset` the curve is evaluated at time + offset, where the offset is a
/// parameter block of one number. A residual then takes the control points of all spans within
/// ± max_offset of the time; the derivatives with respect to those that are not active are zero.
/// Where |offset| > max_offset, and outside the domain of the curve, evaluations return false, and
/// the solver rejects the step.
class measurement_time {
public:
  measurement_time(double time, double max_offset = 0) : time_(time), max_offset_(max_offset) {}

  /// Time, in the unit of the knots.
  [[nodiscard]] double time() const { return time_; }
  /// Largest permitted |offset|; 0 without a parameter block of the offset.
  [[nodiscard]] double max_offset() const { return max_offset_; }
  /// True with a parameter block of the offset.
  [[nodiscard]] bool has_offset() const { return max_offset_ > 0; }

private:
  double time_, max_offset_;
};

/// Motion of a body at one time, as functions for `curve_residual` take it. Rates are with respect
/// to the parameter of the curve. Of curves of rotations all linear quantities are zero, as are
/// rates that were not requested.
template <class S>
class body_motion {
public:
  quaternion<S> rotation;          ///< rotation q from body to fixed axes
  vector3<S> position;             ///< p, origin of the body in fixed axes
  vector3<S> angular_velocity;     ///< ω in body axes
  vector3<S> angular_acceleration; ///< α in body axes
  vector3<S> velocity;             ///< velocity Rᵀ ṗ of the origin in body axes
  vector3<S> acceleration;         ///< acceleration Rᵀ p̈ of the origin in body axes

  body_motion()
      : position(vector3<S>::Zero()), angular_velocity(position), angular_acceleration(position),
        velocity(position), acceleration(position) {}
};

namespace detail {
DUET_ABI_BEGIN

/// Basis and parameter blocks of control points.
template <int Order, class Block>
class control_blocks {
public:
  using basis_type = bspline_basis<Order>;

  control_blocks(std::shared_ptr<const basis_type> basis, std::vector<double*> blocks,
                 const Block& block)
      : basis_(std::move(basis)), blocks_(std::move(blocks)), block_(block) {
    require(blocks_.size() == basis_->size(), "duet: curve blocks: ", basis_->knots().size(),
            " knots of order ", Order, " need ", basis_->size(), " control points, got ",
            blocks_.size());
    if constexpr (requires { block.order(); }) {
      const auto controls = values();
      for (std::size_t i = 1; i < controls.size(); ++i) {
        if (innermost(dot(controls[i - 1], controls[i])) < 0) {
          raise(invalid_sample(
              i, "its sign is not aligned with that of the control point before (negate it)"));
        }
      }
    }
  }

  [[nodiscard]] const std::shared_ptr<const basis_type>& basis() const { return basis_; }
  [[nodiscard]] const Block& block() const { return block_; }

  /// Values in memory.
  [[nodiscard]] auto values() const {
    std::vector<typename Block::value_type> result;
    for (const double* x : blocks_) {
      result.push_back(block_.load(x));
    }
    return result;
  }

  /// First control point, and number of them, of the spans that a measurement may need.
  [[nodiscard]] std::pair<std::size_t, std::size_t> range(const measurement_time& when) const {
    const double begin = basis_->breaks().front(), end = basis_->breaks().back();
    require(when.time() >= begin && when.time() <= end, "duet: curve residual: the time is ",
            when.time(), ", outside the domain of the curve, ", begin, " to ", end);
    require(when.max_offset() >= 0 && std::isfinite(when.max_offset()),
            "duet: curve residual: max_offset is ", when.max_offset(),
            " (expected a finite number that is not negative)");
    const auto first_at = [&](double u) {
      return basis_->first_function(basis_->find_span(std::clamp(u, begin, end)));
    };
    const std::size_t first = first_at(when.time() - when.max_offset());
    const std::size_t last = first_at(when.time() + when.max_offset());
    return {first, last - first + std::size_t(Order)};
  }

  /// Appends the blocks that a measurement may need.
  void append_blocks(const measurement_time& when, std::vector<double*>& result) const {
    const auto [first, count] = range(when);
    const auto begin = blocks_.begin() + std::ptrdiff_t(first);
    result.insert(result.end(), begin, begin + std::ptrdiff_t(count));
  }

  /// Adds all blocks with their manifolds.
  void add_to(ceres::Problem& problem, bool is_constant) const {
    for (double* x : blocks_) {
      if constexpr (requires { block_.order(); }) {
        problem.AddParameterBlock(x, Block::size, new block_manifold<Block>(block_.order()));
      } else {
        problem.AddParameterBlock(x, Block::size);
      }
      if (is_constant) {
        problem.SetParameterBlockConstant(x);
      }
    }
  }

private:
  std::shared_ptr<const basis_type> basis_;
  std::vector<double*> blocks_;
  Block block_;
};

/// Memory of control points that are not the caller's.
template <class Block>
class owned_blocks {
public:
  template <class Values>
  owned_blocks(const Block& block, const Values& values)
      : numbers_(std::make_shared<numbers>(values.size())) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if constexpr (requires { block.store(values[i], nullptr); }) {
        block.store(values[i], (*numbers_)[i].data());
      } else {
        std::copy(values[i].begin(), values[i].end(), (*numbers_)[i].begin());
      }
    }
  }
  owned_blocks() = default;

  [[nodiscard]] std::vector<double*> pointers() const {
    std::vector<double*> result;
    for (auto& each : *numbers_) {
      result.push_back(each.data());
    }
    return result;
  }

private:
  using numbers = std::vector<std::array<double, std::size_t(Block::size)>>;
  std::shared_ptr<numbers> numbers_;
};

/// Channels: the coordinates by which residuals are differentiated before the chain rule, for the
/// value and for each rate [linear; angular], or angular alone.
template <int Rates, bool IsRotationOnly>
inline constexpr int channel_count = (Rates + 1) * (IsRotationOnly ? 3 : 6);

/// Three channels as variables.
template <class D>
[[nodiscard]] vector3<D> channels(const vector3<double>& values, int first) {
  return {D::variable(values[0], first), D::variable(values[1], first + 1),
          D::variable(values[2], first + 2)};
}

/// Active control points of a cumulative B-spline among the blocks of a residual.
template <class T, int Order, class Block>
class active_controls {
public:
  static constexpr std::size_t factors = std::size_t(Order) - 1;

  /// Loads the control points at u; false if signs are not aligned or a number is not finite.
  ///
  /// \param first  number of the control point of block 0
  [[nodiscard]] bool load(const bspline_basis<Order>& basis, double u, std::size_t first,
                          const Block& block, const double* const* x) {
    span_ = basis.find_span(u);
    first_ = basis.first_function(span_) - first;
    for (std::size_t i = 0; i < controls_.size(); ++i) {
      controls_[i] = block.load(x[first_ + i]);
      if (i > 0 && !(innermost(dot(controls_[i - 1], controls_[i])) >= 0)) {
        return false;
      }
    }
    increments_ = increments_between<T, factors>(controls_.data(), "curve_blocks");
    return true;
  }
  [[nodiscard]] std::size_t span() const { return span_; }
  /// Block of the first active control point.
  [[nodiscard]] std::size_t first() const { return first_; }

  template <int Rates>
  [[nodiscard]] auto motion(const bspline_basis<Order>& basis, double u) const {
    return motion_of(product_of_exponentials<Rates>(controls_[0], increments_.data(),
                                                    basis.template weights<Rates>(span_, u)),
                     frame::body);
  }
  template <int Rates>
  [[nodiscard]] auto motion_jacobian(const bspline_basis<Order>& basis, double u) const {
    return jacobian_of_product<Rates, T, factors>(controls_.data(), increments_.data(),
                                                  basis.template weights<4>(span_, u), frame::body,
                                                  perturbation::right);
  }

  /// Writes Jacobians with respect to all blocks by the chain rule; zero for inactive ones.
  ///
  /// \tparam Width  tangent coordinates that residuals depend on, 3 for the angular ones
  /// \param level   of k: derivatives with respect to these coordinates of the value or k-th rate
  template <int Residuals, int Width, int Rates, class Jacobian, class Level>
  void write_blocks(const Jacobian& m, const Level& level, const Block& block, std::size_t count,
                    const double* const* x, double** jacobians) const {
    constexpr int begin = Block::dimension - Width;
    for (std::size_t i = 0; i < count; ++i) {
      if (jacobians[i] == nullptr) {
        continue;
      }
      Eigen::Map<row_major<Eigen::Matrix<double, Residuals, 1>, Block::size>> out(jacobians[i]);
      if (i < first_ || i >= first_ + controls_.size()) {
        out.setZero();
        continue;
      }
      const auto block_of = [&](const auto& blocks) -> Eigen::Matrix<double, Width, Width> {
        return blocks.block(int(i - first_)).template block<Width, Width>(begin, begin);
      };
      Eigen::Matrix<double, Residuals, Block::dimension> tangent;
      tangent.setZero();
      auto part = tangent.template rightCols<Width>();
      part = level(0) * block_of(m.value);
      if constexpr (Rates >= 1) {
        part += level(1) * block_of(m.velocity);
      }
      if constexpr (Rates >= 2) {
        part += level(2) * block_of(m.acceleration);
      }
      out = block.ambient_jacobian(tangent, x[i]);
    }
  }

  /// Derivative of the residuals with respect to the parameter, by the chain rule.
  template <int Residuals, int Width, int Rates, class Jacobian, class Level>
  [[nodiscard]] static Eigen::Matrix<double, Residuals, 1> by_parameter(const Jacobian& m,
                                                                        const Level& level) {
    const auto& rates = m.parameter_derivative;
    Eigen::Matrix<double, Residuals, 1> result = level(0) * rates.value.template tail<Width>();
    if constexpr (Rates >= 1) {
      result += level(1) * rates.velocity.template tail<Width>();
    }
    if constexpr (Rates >= 2) {
      result += level(2) * rates.acceleration.template tail<Width>();
    }
    return result;
  }

private:
  std::size_t span_ = 0, first_ = 0;
  std::array<quaternion<T>, std::size_t(Order)> controls_;
  std::array<vector3<T>, factors> increments_;
};

/// Evaluation of a cumulative B-spline for one residual.
template <class T, int Order, class Block>
class cumulative_evaluator {
  static constexpr bool is_pose = Block::dimension == 6;
  using basis_type = bspline_basis<Order>;

public:
  using active = active_controls<T, Order, Block>;

  cumulative_evaluator(const control_blocks<Order, Block>& controls, const measurement_time& when)
      : basis_(controls.basis()), block_(controls.block()), first_(controls.range(when).first),
        count_(controls.range(when).second) {}

  [[nodiscard]] const basis_type& basis() const { return *basis_; }
  [[nodiscard]] std::size_t block_count() const { return count_; }
  [[nodiscard]] static int block_size(std::size_t) { return Block::size; }

  [[nodiscard]] bool load(double u, const double* const* x, active& a) const {
    return a.load(*basis_, u, first_, block_, x);
  }
  template <int Rates, bool IsRotationOnly>
  [[nodiscard]] body_motion<double> motion(double u, const active& a) const {
    return body_motion_of<Rates, IsRotationOnly>(
        a.template motion<Rates>(*basis_, u), [](const auto& value) { return value; },
        [](const vector3<double>& values, int) { return values; });
  }
  template <int Rates>
  [[nodiscard]] auto motion_jacobian(double u, const active& a) const {
    return a.template motion_jacobian<Rates>(*basis_, u);
  }
  /// Motion over D, whose first partials are the channels.
  template <int Rates, bool IsRotationOnly, class D, class Jacobian>
  [[nodiscard]] static body_motion<D> moving(const Jacobian& m) {
    return body_motion_of<Rates, IsRotationOnly>(
        m.motion,
        [](const auto& value) {
          if constexpr (is_pose && !IsRotationOnly) {
            return moving_pose<D, 0>(value);
          } else {
            return moving_rotation<D, 0>(value);
          }
        },
        [](const vector3<double>& values, int first) { return channels<D>(values, first); });
  }
  /// Writes Jacobians of the control points and returns the derivative with respect to u.
  template <int Rates, bool IsRotationOnly, class Jacobian, class ByChannels>
  [[nodiscard]] auto chain(const Jacobian& m, const active& a, const ByChannels& by_channels,
                           const double* const* x, double** jacobians) const {
    constexpr int residuals = ByChannels::RowsAtCompileTime;
    constexpr int width = IsRotationOnly ? 3 : Block::dimension;
    const auto level = [&](int k) { return by_channels.template middleCols<width>(k * width); };
    a.template write_blocks<residuals, width, Rates>(m, level, block_, count_, x, jacobians);
    return active::template by_parameter<residuals, width, Rates>(m, level);
  }

private:
  /// \param moving_value  the value, and three channels, over the scalar of the result
  template <int Rates, bool IsRotationOnly, class Motion, class MovingValue, class Channels>
  [[nodiscard]] static auto body_motion_of(const Motion& m, const MovingValue& moving_value,
                                           const Channels& channels_of) {
    constexpr int width = IsRotationOnly ? 3 : Block::dimension;
    constexpr int begin = Block::dimension - width; // of the rates that are read
    using vector = std::decay_t<decltype(channels_of(vector3<double>(), 0))>;
    body_motion<typename vector::Scalar> result;
    if constexpr (width == 6) {
      const auto value = moving_value(m.value);
      result.rotation = rotation(value);
      result.position = translation(value);
    } else if constexpr (is_pose) {
      result.rotation = moving_value(rotation(m.value));
    } else {
      result.rotation = moving_value(m.value);
    }
    const auto rate = [&](const auto& r, int k, int at) {
      return channels_of(r.template segment<3>(begin + at), k * width + at);
    };
    if constexpr (Rates >= 1) {
      result.angular_velocity = rate(m.velocity, 1, width - 3);
      if constexpr (width == 6) {
        result.velocity = rate(m.velocity, 1, 0);
      }
    }
    if constexpr (Rates >= 2) {
      result.angular_acceleration = rate(m.acceleration, 2, width - 3);
      if constexpr (width == 6) { // Rᵀ p̈ = v̇ + ω × v
        result.acceleration =
            rate(m.acceleration, 2, 0) + result.angular_velocity.cross(result.velocity);
      }
    }
    return result;
  }

  std::shared_ptr<const basis_type> basis_;
  Block block_;
  std::size_t first_, count_;
};

/// Evaluation of a split curve for one residual: blocks are rotations, then positions.
template <int Order>
class split_evaluator {
  using basis_type = bspline_basis<Order>;
  using rotations = active_controls<double, Order, rotation_block>;

public:
  /// Active control points; derivatives of the position in fixed axes are known once they are read.
  struct active {
    rotations rotation;
    std::array<vector3<double>, std::size_t(Order)> positions = {};
  };

  split_evaluator(const control_blocks<Order, rotation_block>& controls,
                  const measurement_time& when)
      : basis_(controls.basis()), block_(controls.block()), first_(controls.range(when).first),
        count_(controls.range(when).second) {}

  [[nodiscard]] const basis_type& basis() const { return *basis_; }
  [[nodiscard]] std::size_t block_count() const { return 2 * count_; }
  [[nodiscard]] int block_size(std::size_t i) const {
    return i < count_ ? rotation_block::size : 3;
  }

  [[nodiscard]] bool load(double u, const double* const* x, active& a) const {
    if (!a.rotation.load(*basis_, u, first_, block_, x)) {
      return false;
    }
    for (std::size_t i = 0; i < a.positions.size(); ++i) {
      a.positions[i] = vector3<double>(x[count_ + a.rotation.first() + i]);
    }
    return true;
  }
  template <int Rates, bool IsRotationOnly>
  [[nodiscard]] body_motion<double> motion(double u, const active& a) const {
    return body_motion_of<Rates, IsRotationOnly>(
        a.rotation.template motion<Rates>(*basis_, u), linear_motion<Rates>(u, a),
        [](const auto& q) { return q; }, [](const vector3<double>& values, int) { return values; });
  }
  template <int Rates>
  [[nodiscard]] auto motion_jacobian(double u, const active& a) const {
    return std::pair(a.rotation.template motion_jacobian<Rates>(*basis_, u),
                     linear_motion<Rates + 1>(u, a));
  }
  template <int Rates, bool IsRotationOnly, class D, class Jacobian>
  [[nodiscard]] static body_motion<D> moving(const Jacobian& m) {
    return body_motion_of<Rates, IsRotationOnly>(
        m.first.motion, m.second,
        [](const auto& q) { return moving_rotation < D, IsRotationOnly ? 0 : 3 > (q); },
        [](const vector3<double>& values, int first) { return channels<D>(values, first); });
  }
  template <int Rates, bool IsRotationOnly, class Jacobian, class ByChannels>
  [[nodiscard]] auto chain(const Jacobian& m, const active& a, const ByChannels& by_channels,
                           const double* const* x, double** jacobians) const {
    constexpr int residuals = ByChannels::RowsAtCompileTime;
    constexpr int width = IsRotationOnly ? 3 : 6;
    const auto angular = [&](int k) {
      return by_channels.template middleCols<3>(k * width + width - 3);
    };
    a.rotation.template write_blocks<residuals, 3, Rates>(m.first, angular, block_, count_, x,
                                                          jacobians);
    Eigen::Matrix<double, residuals, 1> result =
        rotations::template by_parameter<residuals, 3, Rates>(m.first, angular);
    for (std::size_t i = 0; i < count_; ++i) {
      double* const out = jacobians[count_ + i];
      if (out == nullptr) {
        continue;
      }
      Eigen::Matrix<double, residuals, 3> sum = Eigen::Matrix<double, residuals, 3>::Zero();
      const std::size_t at = i - a.rotation.first(); // beyond all, if before the first
      if (!IsRotationOnly && at < a.positions.size()) {
        for (int k = 0; k <= Rates; ++k) {
          sum +=
              m.second.weights[std::size_t(k)][at] * by_channels.template middleCols<3>(k * width);
        }
      }
      Eigen::Map<row_major<decltype(sum), 3>> block(out);
      block = sum;
    }
    if constexpr (!IsRotationOnly) {
      for (int k = 0; k <= Rates; ++k) {
        result += by_channels.template middleCols<3>(k * width) *
                  m.second.derivatives[std::size_t(k) + 1];
      }
    }
    return result;
  }

private:
  /// Position, its derivatives, and the weights of the control positions in them.
  template <int Derivatives>
  [[nodiscard]] auto linear_motion(double u, const active& a) const {
    return weighted_positions<double, std::size_t(Derivatives) + 1, std::size_t(Order)>(
        basis_->template weights<Derivatives>(a.rotation.span(), u), a.positions.data());
  }

  template <int Rates, bool IsRotationOnly, class Motion, class Linear, class MovingValue,
            class Channels>
  [[nodiscard]] static auto body_motion_of(const Motion& m, const Linear& p,
                                           const MovingValue& moving_value,
                                           const Channels& channels_of) {
    constexpr int width = IsRotationOnly ? 3 : 6;
    using vector = std::decay_t<decltype(channels_of(vector3<double>(), 0))>;
    body_motion<typename vector::Scalar> result;
    result.rotation = moving_value(m.value);
    if constexpr (Rates >= 1) {
      result.angular_velocity = channels_of(m.velocity, width + width - 3);
    }
    if constexpr (Rates >= 2) {
      result.angular_acceleration = channels_of(m.acceleration, 2 * width + width - 3);
    }
    if constexpr (!IsRotationOnly) {
      const auto to_body = [&](const vector& x) { return rotate(conj(result.rotation), x); };
      result.position = channels_of(p.derivatives[0], 0);
      if constexpr (Rates >= 1) {
        result.velocity = to_body(channels_of(p.derivatives[1], width));
      }
      if constexpr (Rates >= 2) {
        result.acceleration = to_body(channels_of(p.derivatives[2], 2 * width));
      }
    }
    return result;
  }

  std::shared_ptr<const basis_type> basis_;
  rotation_block block_;
  std::size_t first_, count_;
};

DUET_ABI_END
} // namespace detail

/// Control points of a cumulative B-spline in parameter blocks of Ceres: four numbers of a rotation
/// (T = double), seven [t; q] of a pose (T = `screw_dual<double>`). A reference to them, cheap to
/// copy.
template <class T, int Order = 4>
class curve_blocks {
public:
  using basis_type = bspline_basis<Order>;
  using curve_type = cumulative_bspline<T, Order>;
  static constexpr bool has_positions =
      manifold<quaternion<T>>::dimension == 6; ///< true for curves of poses
  /// Type of the parameter block of a control point.
  using block_type = std::conditional_t<has_positions, pose_block, rotation_block>;

  /// Control points in the caller's memory.
  ///
  /// \param controls       a pointer to the numbers of each
  /// \param storage_order  order of the numbers of quaternions
  /// \throws invalid_input for a count that does not match and for a quaternion of norm 0
  /// \throws invalid_sample for a control point whose sign is not aligned with that of the control
  /// point before: it would be reached by the longer arc
  curve_blocks(basis_type basis, std::vector<double*> controls, quaternion_order storage_order)
      : controls_(std::make_shared<const basis_type>(std::move(basis)), std::move(controls),
                  block_type(storage_order)) {}
  /// Control points copied from a curve to memory that all copies of this object share.
  explicit curve_blocks(const curve_type& curve,
                        quaternion_order storage_order = quaternion_order::wxyz)
      : memory_(block_type(storage_order), curve.control_points()),
        controls_(std::make_shared<const basis_type>(curve.basis()), memory_.pointers(),
                  block_type(storage_order)) {}

  /// Curve through the present control points.
  ///
  /// \throws invalid_sample as `cumulative_bspline`
  [[nodiscard]] curve_type curve() const { return {*controls_.basis(), controls_.values()}; }

  /// Parameter blocks of a residual: control points, then `more`.
  ///
  /// \throws invalid_input for a time outside the domain
  [[nodiscard]] std::vector<double*> blocks(const measurement_time& when,
                                            const std::vector<double*>& more = {}) const {
    std::vector<double*> result;
    controls_.append_blocks(when, result);
    result.insert(result.end(), more.begin(), more.end());
    return result;
  }

  /// Adds all control points with their manifolds to a problem.
  void add_to(ceres::Problem& problem, bool is_constant = false) const {
    controls_.add_to(problem, is_constant);
  }

  /// For those who extend duet: evaluation for one residual.
  [[nodiscard]] auto evaluator(const measurement_time& when) const {
    return detail::cumulative_evaluator<T, Order, block_type>(controls_, when);
  }

private:
  detail::owned_blocks<block_type> memory_; // unless it is the caller's
  detail::control_blocks<Order, block_type> controls_;
};

/// Control points of a `split_bspline` in parameter blocks of Ceres: four numbers of each rotation,
/// three of each position. A reference to them, cheap to copy.
template <int Order = 4>
class split_curve_blocks {
public:
  using basis_type = bspline_basis<Order>;
  using curve_type = split_bspline<double, Order>;
  static constexpr bool has_positions = true; ///< as for curves of poses

  /// Control points in the caller's memory.
  ///
  /// \param rotations      a pointer to the four numbers of each
  /// \param positions      a pointer to the three numbers of each
  /// \param storage_order  order of the numbers of quaternions
  /// \throws invalid_input, invalid_sample as `curve_blocks`
  split_curve_blocks(basis_type basis, std::vector<double*> rotations,
                     std::vector<double*> positions, quaternion_order storage_order)
      : rotations_(std::make_shared<const basis_type>(std::move(basis)), std::move(rotations),
                   rotation_block(storage_order)),
        positions_(rotations_.basis(), std::move(positions), {}) {}
  /// Control points copied from a curve to memory that all copies of this object share.
  explicit split_curve_blocks(const curve_type& curve,
                              quaternion_order storage_order = quaternion_order::wxyz)
      : rotation_memory_(rotation_block(storage_order), curve.rotation().control_points()),
        position_memory_({}, curve.positions()),
        rotations_(std::make_shared<const basis_type>(curve.rotation().basis()),
                   rotation_memory_.pointers(), rotation_block(storage_order)),
        positions_(rotations_.basis(), position_memory_.pointers(), {}) {}

  /// Curve through the present control points.
  ///
  /// \throws invalid_sample as `split_bspline`
  [[nodiscard]] curve_type curve() const {
    return {*rotations_.basis(), rotations_.values(), positions_.values()};
  }

  /// Parameter blocks of a residual: control rotations, control positions, then `more`.
  ///
  /// \throws invalid_input for a time outside the domain
  [[nodiscard]] std::vector<double*> blocks(const measurement_time& when,
                                            const std::vector<double*>& more = {}) const {
    std::vector<double*> result;
    rotations_.append_blocks(when, result);
    positions_.append_blocks(when, result);
    result.insert(result.end(), more.begin(), more.end());
    return result;
  }

  /// Adds all control points, rotations with their manifolds, to a problem.
  void add_to(ceres::Problem& problem, bool is_constant = false) const {
    rotations_.add_to(problem, is_constant);
    positions_.add_to(problem, is_constant);
  }

  /// For those who extend duet: evaluation for one residual.
  [[nodiscard]] auto evaluator(const measurement_time& when) const {
    return detail::split_evaluator<Order>(rotations_, when);
  }

private:
  detail::owned_blocks<rotation_block> rotation_memory_; // unless it is the caller's
  detail::owned_blocks<vector_block<3>> position_memory_;
  detail::control_blocks<Order, rotation_block> rotations_;
  detail::control_blocks<Order, vector_block<3>> positions_;
};

} // namespace duet
