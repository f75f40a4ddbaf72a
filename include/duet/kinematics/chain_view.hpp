// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/displacement.hpp>
#include <duet/kinematics/chain_walk.hpp>
#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/serial_chain.hpp>

#include <concepts>
#include <span>

/// \file
/// Chains of all types as one type, for compiled code.

namespace duet {
DUET_ABI_BEGIN

/// View of a chain of any type and length: its table, and one function for the pose and the
/// Jacobian of its tip, which is compiled for the type of the chain. It is a `SerialChain` itself,
/// and refers to the chain, which must outlive it.
///
/// Functions of duet::robotics take it, so that they are compiled once for all chains; chains
/// convert to it.
class chain_view : public detail::poses_of<chain_view> {
public:
  using scalar_type = double;
  using own_jacobian = void;
  static constexpr int joints = 0; ///< known at run time only

  template <SerialChain C>
    requires(!std::same_as<C, chain_view> && std::same_as<typename C::scalar_type, double>)
  chain_view(const C& chain)
      : chain_(&chain), functions_(functions_of<C>), steps_(chain.steps()), tip_(chain.tip()),
        size_(chain.size()) {}

  /// Number of moving joints.
  [[nodiscard]] int size() const { return size_; }
  /// The tip frame (end-effector frame).
  [[nodiscard]] const attached_frame<double>& tip() const { return tip_; }
  /// The frame of link i.
  ///
  /// \throws invalid_input for i outside 0 … size()
  [[nodiscard]] attached_frame<double> link(int i) const { return functions_.link(chain_, i); }
  /// Type of joint i.
  [[nodiscard]] joint_kind kind(int i) const { return functions_.kind(chain_, i); }
  /// The limits of joint i.
  [[nodiscard]] joint_limits<double> limits(int i) const { return functions_.limits(chain_, i); }

  // For those who extend duet.

  /// The table of evaluation steps.
  [[nodiscard]] std::span<const detail::joint_step<double>> steps() const { return steps_; }
  /// Forward kinematics and Jacobian in `frame::hybrid`, by the function of the chain's own type.
  ///
  /// \param theta    coordinates, as many as there are joints
  /// \param columns  memory for the Jacobian, column by column, six numbers for each joint
  /// \return the pose of the tip
  detail::link_displacement<double> pose_and_jacobian(const double* theta, double* columns) const {
    return functions_.pose_and_jacobian(chain_, theta, columns);
  }

private:
  struct functions {
    detail::link_displacement<double> (*pose_and_jacobian)(const void*, const double*, double*);
    attached_frame<double> (*link)(const void*, int);
    joint_kind (*kind)(const void*, int);
    joint_limits<double> (*limits)(const void*, int);
  };

  /// Matrix of six rows in the caller's memory.
  struct columns_in_memory {
    using Scalar = double;
    double* first;
    Eigen::Index count = 0;

    void resize(Eigen::Index, Eigen::Index n) { count = n; }
    [[nodiscard]] Eigen::Index cols() const { return count; }
    [[nodiscard]] double operator()(Eigen::Index i, Eigen::Index j) const {
      return first[6 * j + i];
    }
    [[nodiscard]] double& operator()(Eigen::Index i, Eigen::Index j) { return first[6 * j + i]; }
  };

  template <class C>
  [[nodiscard]] static detail::link_displacement<double>
  pose_and_jacobian_of(const void* chain, const double* theta, double* columns) {
    const C& c = *static_cast<const C*>(chain);
    detail::joint_vector<double, C::joints> x(c.size());
    for (int i = 0; i < c.size(); ++i) {
      x[i] = theta[i];
    }
    columns_in_memory matrix{columns};
    return detail::fill_jacobian<hybrid_frame, true, double>(matrix, c, x, tip_of_chain{});
  }

  template <class C>
  static constexpr functions functions_of = {
      pose_and_jacobian_of<C>,
      [](const void* c, int i) {
        return attached_frame<double>(static_cast<const C*>(c)->link(i));
      },
      [](const void* c, int i) { return static_cast<const C*>(c)->kind(i); },
      [](const void* c, int i) {
        return joint_limits<double>(static_cast<const C*>(c)->limits(i));
      }};

  const void* chain_;
  const functions& functions_;
  std::span<const detail::joint_step<double>> steps_;
  attached_frame<double> tip_;
  int size_;
};

DUET_ABI_END
} // namespace duet
