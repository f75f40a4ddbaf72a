// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/kinematics/chain_walk.hpp>
#include <duet/kinematics/joint.hpp>

#include <Eigen/Core>

#include <array>
#include <concepts>
#include <cstddef>
#include <span>
#include <string>
#include <type_traits>

/// \file
/// Serial chains of joints, and their forward kinematics.

namespace duet {

namespace detail {

/// Largest number of joints for N as in `serial_chain`; `Eigen::Dynamic` if N is 0.
template <int N>
inline constexpr int max_joints = N > 0   ? N
                                  : N < 0 ? -N
                                          : Eigen::Dynamic;

/// Column of joint coordinates, of fixed size N, of up to −N, or of any size if N is 0.
template <class S, int N>
using joint_vector =
    Eigen::Matrix<S, (N > 0 ? N : Eigen::Dynamic), 1, Eigen::ColMajor, max_joints<N>, 1>;

/// Forward kinematics of a chain.
template <class C>
struct poses_of {
  /// Forward kinematics: pose of a frame relative to the base at the configuration θ.
  ///
  /// \param at  the frame: the tip (end effector) by default, a link number or an `attached_frame`
  ///
  /// \throws invalid_input if the number of coordinates differs from `size()`, or the link
  /// does not exist
  template <VectorLike X, FrameOnChain<C> At = tip_of_chain>
  [[nodiscard]] DUET_ALWAYS_INLINE auto pose(const X& theta, const At& at = {}) const {
    using S = chain_scalar<C, X>;
    const C& chain = static_cast<const C&>(*this);
    const auto& frame = frame_on(chain, at);
    const auto at_frame =
        attached(walk<true, S>(chain, theta, frame.link, visit_nothing), frame.offset);
    return pose_of_unit(at_frame.rotation, at_frame.translation.eigen());
  }
  template <class... X>
    requires(is_matrix_argument<X> || ...)
  DUET_REFUSED("pose takes the coordinates of one configuration: chain.pose(thetas.col(i))")
  dual_quaternion<double> pose(const X&...) const;
};

} // namespace detail

/// A serial chain of links connected by revolute, continuous, prismatic, helical or fixed joints,
/// for example a robot arm.
///
/// Joints are numbered from 0, links from 0, the base: joint i moves link i + 1. A configuration θ
/// is an Eigen vector, `std::array` or `std::vector` over any scalar, in radians, or units of
/// length for prismatic joints. Limits are stored and not enforced. No heap memory is used.
///
/// \tparam N  number of moving joints; negative: up to −N, with their number given at run time
/// \tparam T  scalar of the table, a real number
template <int N, class T = double>
class serial_chain : public detail::poses_of<serial_chain<N, T>> {
  static_assert(N != 0, "duet: serial_chain<N> needs its number of joints, or -capacity");
  static_assert(
      !Infinitesimal<T>,
      "duet: serial_chain: the table is real, only coordinates have derivatives: pose(theta)");

public:
  using scalar_type = T;
  using own_jacobian = void;
  static constexpr int joints = N;
  static constexpr std::size_t capacity = std::size_t(N > 0 ? N : -N);

  /// \param input        the joints from the base on; fixed joints are merged with the joint or tip
  ///                     that they carry
  /// \param tool         pose of the tip in the frame of the last joint
  /// \param link_frames  for each given joint, the pose of the frame of the link that it moves, in
  ///                     the frame of the joint; empty: they coincide
  /// \throws invalid_input if the number of moving joints is not N (exceeds −N), an axis or a
  /// rotation is not of unit norm, a number is not finite, or a lower limit exceeds the upper one
  constexpr explicit serial_chain(std::span<const joint<T>> input, const placement<T>& tool = {},
                                  std::span<const placement<T>> link_frames = {}) {
    placement<T> carried{};
    for (std::size_t i = 0; i < input.size(); ++i) {
      detail::require_joint(input[i], i);
      if (input[i].coordinates() > 1) {
        detail::bad_joint(i, "it has several coordinates (use a kinematic_tree)");
      }
      carried = carried * input[i].origin;
      if (input[i].kind != joint_kind::fixed) {
        if (size_ == int(capacity)) {
          detail::bad_joint(i, "the chain has capacity for " + std::to_string(capacity) +
                                   " moving joints");
        }
        frames_[std::size_t(size_)] = link_frames.empty() ? placement<T>{} : link_frames[i];
        add(input[i], carried);
        carried = {};
      }
    }
    if (N > 0 && size_ != N) {
      detail::raise(invalid_input("duet: serial_chain<" + std::to_string(N) +
                                  ">: " + std::to_string(size_) + " moving joints (expected " +
                                  std::to_string(N) + ")"));
    }
    tip_ = {size_, carried * tool};
  }
  template <std::size_t M>
  constexpr explicit serial_chain(const std::array<joint<T>, M>& input,
                                  const placement<T>& tool = {})
      : serial_chain(std::span<const joint<T>>(input), tool) {}

  /// A chain of any other type without its number of joints in the type, so that code is compiled
  /// once for all chains of up to −N joints.
  ///
  /// \throws invalid_input if a `chain_view` has more joints
  template <SerialChain C>
    requires(C::joints != N && N < 0 && detail::max_joints<C::joints> <= -N &&
             std::same_as<typename C::scalar_type, T>)
  constexpr serial_chain(const C& other) : tip_(other.tip()), size_(other.size()) {
    detail::require(size_ <= -N, "duet: serial_chain: ", size_, " joints (expected at most ", -N,
                    ")");
    for (int i = 0; i < size_; ++i) {
      take(other, i, std::size_t(i));
    }
  }

  /// Number of moving joints.
  [[nodiscard]] constexpr int size() const { return size_; }
  /// The tip frame (end-effector frame).
  [[nodiscard]] constexpr const attached_frame<T>& tip() const { return tip_; }
  /// The frame of link i.
  ///
  /// \throws invalid_input for i outside 0 … size()
  [[nodiscard]] constexpr attached_frame<T> link(int i) const {
    if (i < 0 || i > size_) {
      detail::raise(invalid_input("duet: serial_chain: link " + std::to_string(i) +
                                  " does not exist, the chain has " + std::to_string(size_) +
                                  " joints"));
    }
    return {i, i == 0 ? placement<T>{} : frames_[std::size_t(i - 1)]};
  }
  /// Type of joint i.
  [[nodiscard]] constexpr joint_kind kind(int i) const { return kinds_[std::size_t(i)]; }
  /// The limits of joint i.
  [[nodiscard]] constexpr const joint_limits<T>& limits(int i) const {
    return limits_[std::size_t(i)];
  }

  // For those who extend duet: the members of a `SerialChain`.

  /// The table of evaluation steps.
  [[nodiscard]] constexpr const auto& steps() const { return steps_; }
  /// Another chain without joint i, whose successor frames are displaced by the
  /// constant pose `locked`.
  template <int M>
  constexpr serial_chain(const serial_chain<M, T>& other, int i, const placement<T>& locked)
      : tip_{other.size() - 1, other.tip().offset}, size_(other.size() - 1) {
    for (int to = 0; to < size_; ++to) {
      take(other, to < i ? to : to + 1, std::size_t(to));
    }
    displace(i, locked);
  }
  /// Displaces all frames after link i, relative to the frame of link i.
  constexpr void displace(int i, const placement<T>& by) {
    if (i == size_) {
      tip_.offset = by * tip_.offset;
    } else {
      steps_[std::size_t(i)] = detail::displaced(by, steps_[std::size_t(i)]);
    }
  }
  /// Replaces the offset of the tip.
  constexpr void set_tip_offset(const placement<T>& offset) { tip_.offset = offset; }
  /// Replaces the limits of joint i, without checks. A `continuous` joint that gets a bound
  /// becomes `revolute`.
  constexpr void set_limits(int i, const joint_limits<T>& limits) {
    joint_kind& kind = kinds_[std::size_t(i)];
    kind = detail::kind_within(kind, limits);
    limits_[std::size_t(i)] = limits;
  }

private:
  template <class C>
  constexpr void take(const C& other, int from, std::size_t to) {
    steps_[to] = other.steps()[std::size_t(from)];
    frames_[to] = other.link(from + 1).offset;
    kinds_[to] = other.kind(from);
    limits_[to] = other.limits(from);
  }
  constexpr void add(const joint<T>& joint, const placement<T>& origin) {
    const auto i = std::size_t(size_);
    steps_[i] = detail::step_of(joint, origin);
    kinds_[i] = joint.kind;
    limits_[i] = joint.effective_limits();
    ++size_;
  }

  std::array<detail::joint_step<T>, capacity> steps_{};
  std::array<placement<T>, capacity> frames_{};
  std::array<joint_kind, capacity> kinds_{};
  std::array<joint_limits<T>, capacity> limits_{};
  attached_frame<T> tip_{};
  int size_ = 0;
};

/// A chain whose number of joints, at most `Capacity`, is known at run time. No heap is used.
template <int Capacity, class T = double>
using bounded_chain = serial_chain<-Capacity, T>;

template <class T, std::size_t M, class... Tool>
serial_chain(const std::array<joint<T>, M>&, Tool...) -> serial_chain<int(M), T>;

/// A chain known to the compiler, which omits all products with zeros of the table: as fast as code
/// written for this arm. An empty object.
///
/// Example: `struct planar { static constexpr auto chain = from_dh(rows); }; constexpr
/// static_chain<planar> arm;`
///
/// \tparam Arm  a type with a `static constexpr` `serial_chain` named `chain`
template <class Arm>
class static_chain : public detail::poses_of<static_chain<Arm>> {
  using chain_type = std::remove_cvref_t<decltype(Arm::chain)>;
  static_assert(chain_type::joints > 0,
                "duet: static_chain needs a chain whose number of joints is in its type");

public:
  using arm = Arm;
  using scalar_type = typename chain_type::scalar_type;
  using own_jacobian = void;
  static constexpr int joints = chain_type::joints;

  /// Number of moving joints.
  [[nodiscard]] static constexpr int size() { return joints; }
  /// The tip frame (end-effector frame).
  [[nodiscard]] static constexpr const attached_frame<scalar_type>& tip() {
    return Arm::chain.tip();
  }
  /// The frame of link i.
  [[nodiscard]] static constexpr attached_frame<scalar_type> link(int i) {
    return Arm::chain.link(i);
  }
  /// Type of joint i.
  [[nodiscard]] static constexpr joint_kind kind(int i) { return Arm::chain.kind(i); }
  /// The limits of joint i.
  [[nodiscard]] static constexpr const joint_limits<scalar_type>& limits(int i) {
    return Arm::chain.limits(i);
  }
  /// This chain as a table in memory, whose type does not identify the arm.
  [[nodiscard]] static constexpr const chain_type& table() { return Arm::chain; }

  // For those who extend duet: the members of a `SerialChain`.

  [[nodiscard]] static constexpr const auto& steps() { return Arm::chain.steps(); }
};

namespace detail {

/// Column of `get(limits)` for each coordinate.
template <HasLimits C, class Get>
[[nodiscard]] auto column_of_limits(const C& chain, const Get& get) {
  constexpr int joints = [] {
    if constexpr (SerialChain<C>) {
      return C::joints;
    } else {
      return 0;
    }
  }();
  joint_vector<typename C::scalar_type, joints> result(chain.size());
  for (int i = 0; i < chain.size(); ++i) {
    result[i] = get(chain.limits(i));
  }
  return result;
}

} // namespace detail

/// Lower and upper limits of all coordinates of a chain or a tree.
///
/// \return a column with one number for each coordinate
template <HasLimits C>
[[nodiscard]] auto lower_limits(const C& chain) {
  return detail::column_of_limits(chain, [](const auto& limits) { return limits.lower; });
}
template <HasLimits C>
[[nodiscard]] auto upper_limits(const C& chain) {
  return detail::column_of_limits(chain, [](const auto& limits) { return limits.upper; });
}

/// Compile-time message for a matrix of configurations as the argument of `function` of a chain,
/// followed by the type of its result.
#define DUET_ASKS_FOR_ONE_CONFIGURATION(function, ...)                                             \
  template <SerialChain C, class... X>                                                             \
    requires(detail::is_matrix_argument<X> || ...)                                                 \
  DUET_REFUSED(#function " takes the coordinates of one configuration: thetas.col(i) of a matrix") \
  __VA_ARGS__ function(const C&, const X&...);

} // namespace duet
