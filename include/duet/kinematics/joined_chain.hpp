// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/derivative.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/serial_chain.hpp>

#include <Eigen/Core>

#include <concepts>
#include <tuple>
#include <type_traits>
#include <utility>

/// \file
/// Chains of arms and of joints whose pose is a user-defined function of one coordinate.

namespace duet {

/// A joint whose pose is a user-defined function of one coordinate, as a cam or a guide rail.
///
/// Its derivatives are those of `motion` by dual numbers.
///
/// Example: `custom_joint{[](const auto& x) { return pose_of(x); }, {.lower = 0, .upper = 1}}`
template <class F>
struct custom_joint {
  /// Pose (unit dual quaternion) of the moved frame in the previous frame, for a coordinate of any
  /// scalar.
  F motion;
  joint_limits<double> limits = {}; ///< limits of its coordinate, in units of the coordinate
};
template <class F>
custom_joint(F) -> custom_joint<F>;
template <class F>
custom_joint(F, joint_limits<double>) -> custom_joint<F>;

namespace detail {

template <class Part>
struct part_of_chain;
template <class F>
struct part_of_chain<custom_joint<F>> {
  static constexpr int joints = 1;
  static const joint_limits<double>& limits(const custom_joint<F>& part, int) {
    return part.limits;
  }
  template <class X>
  static auto pose(const custom_joint<F>& part, const X& theta) {
    return part.motion(theta[0]);
  }
  template <class X>
  static auto pose_and_jacobian(const custom_joint<F>& part, const X& theta) {
    const auto a = derivative(part.motion, theta[0]);
    const auto column = twist(a.value, a.derivative, frame::spatial);
    return value_and_jacobian<decltype(a.value), decltype(column)>{a.value, column};
  }
};
template <SerialChain C>
struct part_of_chain<C> {
  static_assert(C::joints > 0, "duet: join_chains needs chains whose number of joints is in their "
                               "type, as serial_chain<6> and static_chain");
  static constexpr int joints = C::joints;
  static const auto& limits(const C& part, int i) { return part.limits(i); }
  template <class X>
  static auto pose(const C& part, const X& theta) {
    return part.pose(theta);
  }
  template <class X>
  static auto pose_and_jacobian(const C& part, const X& theta) {
    return duet::pose_and_jacobian(part, theta, frame::spatial);
  }
};

} // namespace detail

/// A serial chain of parts one behind the other: chains with the number of joints in their type,
/// and joints of type `custom_joint`. The base of each part is the tip of the one before.
///
/// Coordinates are those of the parts in that order, over any scalar. Planners and inverse
/// kinematics take chains of the built-in joints only; equations of the pose are solved by
/// `nonlinear_least_squares` and `implicit_function`.
template <class... Parts>
class joined_chain {
public:
  using scalar_type = double;
  using own_jacobian = void;
  static constexpr int joints = (0 + ... + detail::part_of_chain<Parts>::joints);

  constexpr explicit joined_chain(Parts... parts) : parts_(std::move(parts)...) {}

  /// Number of moving joints.
  [[nodiscard]] static constexpr int size() { return joints; }
  /// The limits of joint i.
  ///
  /// \throws invalid_input for i outside 0 … size() − 1
  [[nodiscard]] joint_limits<double> limits(int i) const {
    detail::require(i >= 0 && i < joints, "duet: joined_chain: joint ", i,
                    " does not exist, the chain has ", joints, " joints");
    joint_limits<double> result;
    for_each_part([&](const auto& part, auto first) {
      using traits = detail::part_of_chain<std::remove_cvref_t<decltype(part)>>;
      if (i >= first && i < first + traits::joints) {
        result = traits::limits(part, i - first);
      }
    });
    return result;
  }

  /// Forward kinematics: pose of the tip relative to the base at the configuration θ.
  ///
  /// \throws invalid_input if the number of coordinates differs from `size()`
  template <VectorLike X>
  [[nodiscard]] auto pose(const X& theta) const {
    using S = detail::chain_scalar<joined_chain, X>;
    detail::require_size(*this, theta);
    dual_quaternion<S> a(S(1));
    for_each_part([&](const auto& part, auto first) {
      using traits = detail::part_of_chain<std::remove_cvref_t<decltype(part)>>;
      a = a * traits::pose(part, coordinates<traits::joints, S>(theta, first));
    });
    return a;
  }

  /// For those who extend duet: pose and spatial Jacobian of the tip.
  template <class X>
  [[nodiscard]] auto pose_and_spatial_jacobian(const X& theta) const {
    using S = detail::chain_scalar<joined_chain, X>;
    detail::require_size(*this, theta);
    value_and_jacobian<dual_quaternion<S>, Eigen::Matrix<S, 6, joints>> result;
    result.value = dual_quaternion<S>(S(1));
    for_each_part([&](const auto& part, auto first) {
      using traits = detail::part_of_chain<std::remove_cvref_t<decltype(part)>>;
      const auto next =
          traits::pose_and_jacobian(part, coordinates<traits::joints, S>(theta, first));
      result.jacobian.template middleCols<traits::joints>(first) = Ad(result.value) * next.jacobian;
      result.value = result.value * next.value;
    });
    return result;
  }

private:
  /// f(part, number of its first joint) of each part.
  template <class F>
  void for_each_part(const F& f) const {
    int first = 0;
    std::apply(
        [&](const auto&... part) {
          ((f(part, first),
            first += detail::part_of_chain<std::remove_cvref_t<decltype(part)>>::joints),
           ...);
        },
        parts_);
  }
  template <int N, class S, class X>
  [[nodiscard]] static Eigen::Matrix<S, N, 1> coordinates(const X& theta, int first) {
    Eigen::Matrix<S, N, 1> result;
    for (int i = 0; i < N; ++i) {
      result[i] = S(detail::vector_argument<X>::get(theta, first + i));
    }
    return result;
  }

  std::tuple<Parts...> parts_;
};

/// The chain of parts one behind the other: chains of fixed size and `custom_joint`s.
///
/// \return `joined_chain`
template <class... Parts>
  requires(sizeof...(Parts) > 0)
[[nodiscard]] constexpr auto join_chains(Parts... parts) {
  return joined_chain<Parts...>(std::move(parts)...);
}

/// The geometric Jacobian J of 6 rows of the tip of a joined chain: in closed form for its chains,
/// by dual numbers for user-defined joints. Frames and units as for other chains.
///
/// \throws invalid_input if the number of coordinates differs from `size()`
template <class... Parts, VectorLike X, FrameConstant Frame>
[[nodiscard]] auto jacobian(const joined_chain<Parts...>& chain, const X& theta, Frame) {
  auto [a, m] = chain.pose_and_spatial_jacobian(theta);
  if constexpr (std::same_as<Frame, body_frame>) {
    m = (Ad(conj(a)) * m).eval();
  } else if constexpr (std::same_as<Frame, hybrid_frame>) {
    for (Eigen::Index i = 0; i < m.cols(); ++i) {
      m.col(i) = detail::hybrid_twist(a, vector6<typename decltype(m)::Scalar>(m.col(i)));
    }
  }
  return m;
}

} // namespace duet
