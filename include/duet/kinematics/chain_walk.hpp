// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/vector_sine_cosine.hpp>
#include <duet/core/compiler/vector.hpp>
#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/partials.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual/rules/elementary.hpp>
#include <duet/dual_quaternion/displacement.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>

/// \file
/// Joints as evaluation steps, their validation, and the traversal of a chain from its base to one
/// of its links, as a loop over a table in memory or unrolled over a table known to the compiler.
/// For those who extend duet.

namespace duet {

namespace detail {

/// A joint prepared for evaluation. With the joint's frame displaced by (a, l) from the previous
/// one and n its axis, the rotation q of the previous link becomes q (cos(θ/2) a + sin(θ/2) a n).
template <class T>
struct joint_step {
  quaternion<T> a{T(1)};
  quaternion<T> an{};
  three_vector<T> offset{}; ///< l
  three_vector<T> axis{};   ///< a n a*, the axis in the frame of the previous joint
  T pitch{};                ///< translation along the axis per unit of θ; 1 if purely prismatic
  bool is_rotational = true;
  bool is_translational = false;
};

/// A step of a table in memory. (If functions of chains read `joint_step` directly, clang takes 8 %
/// more instructions for a Jacobian.)
template <class T>
struct step_in_memory {
  const joint_step<T>& s;

  [[nodiscard]] bool is_rotational() const { return s.is_rotational; }
  [[nodiscard]] bool is_translational() const { return s.is_translational; }
  template <class S, class HalfAngles>
  [[nodiscard]] DUET_ALWAYS_INLINE quaternion<S> rotation(const HalfAngles& half_angles,
                                                          Eigen::Index i) const {
    if (!s.is_rotational) {
      return quaternion<S>(s.a);
    }
    const sine_cosine<S> half = half_angles[int(i)];
    const S &c = half.cosine, &sine = half.sine; // no intermediate quaternions of duals
    return {c * s.a.w() + sine * s.an.w(), c * s.a.x() + sine * s.an.x(),
            c * s.a.y() + sine * s.an.y(), c * s.a.z() + sine * s.an.z()};
  }
  [[nodiscard]] const three_vector<T>& offset() const { return s.offset; }
  [[nodiscard]] const three_vector<T>& axis() const { return s.axis; }
  [[nodiscard]] T pitch() const { return s.pitch; }
};

/// The I-th step of a table known to the compiler.
template <class Arm, std::size_t I>
struct known_step {
  static constexpr const auto& s() { return Arm::chain.steps()[I]; }

  [[nodiscard]] static constexpr bool is_rotational() { return s().is_rotational; }
  [[nodiscard]] static constexpr bool is_translational() { return s().is_translational; }
  template <class S, class HalfAngles>
  [[nodiscard]] DUET_ALWAYS_INLINE static auto rotation(const HalfAngles& half_angles,
                                                        Eigen::Index i) {
    constexpr auto a = known_quaternion([] { return s().a; });
    if constexpr (!is_rotational()) {
      return a;
    } else {
      const sine_cosine<S> half = half_angles[int(i)];
      return half.cosine * a + half.sine * known_quaternion([] { return s().an; });
    }
  }
  [[nodiscard]] static constexpr auto offset() {
    return known_vector([] { return s().offset; });
  }
  [[nodiscard]] static constexpr auto axis() {
    return known_vector([] { return s().axis; });
  }
  [[nodiscard]] static constexpr auto pitch() { return s().pitch; }
};

/// Pose of the link after joint i. Calls `visit(i, step, axis, position)` with the joint's axis in
/// space and a point on it.
///
/// \tparam WithRotation  true if the rotation after the joint is required
template <bool WithRotation, class Link, class Step, class S, class HalfAngles, class Visit>
[[nodiscard]] DUET_ALWAYS_INLINE auto
after_joint(const Link& link, const Step& step, Eigen::Index i, const S& theta,
            const HalfAngles& half_angles, const Visit& visit) {
  three_vector<S> p = link.point(step.offset());
  const three_vector<S> axis = rotated(link.rotation, step.axis());
  if (step.is_translational()) {
    p = p + theta * step.pitch() * axis;
  }
  visit(i, step, axis, p);
  if constexpr (WithRotation) {
    return displacement{link.rotation * step.template rotation<S>(half_angles, i), p};
  } else {
    return displacement{link.rotation, p};
  }
}

/// Throws the error message for joint i.
///
/// \param name  name of the joint, if it has one
/// \throws invalid_input always
[[noreturn]] inline void bad_joint(std::size_t i, const std::string& reason,
                                   const char* function = "serial_chain",
                                   std::string_view name = {}) {
  const std::string named = name.empty() ? "" : message(" \"", name, "\"");
  raise(invalid_input(message("duet: ", function, ": joint ", i, named, ": ", reason)));
}

/// Checks that a joint has a coordinate within its limits and a velocity limit of at least 0.
///
/// \throws invalid_input for a lower limit above the upper one, NaN, and infinite bounds of the
/// wrong sign
template <class T>
constexpr void require_limits(const joint_limits<T>& limits, std::size_t i,
                              const char* function = "serial_chain", std::string_view name = {}) {
  const T infinity = std::numeric_limits<T>::infinity();
  if (!(limits.lower <= limits.upper && infinity > limits.lower && limits.upper > -infinity)) {
    bad_joint(i,
              message("the limits ", limits.lower, " to ", limits.upper, " contain no coordinate"),
              function, name);
  }
  if (!(limits.velocity >= 0)) {
    bad_joint(i, message("the velocity limit is ", limits.velocity, " (expected >= 0)"), function,
              name);
  }
}

template <class T>
constexpr void require_joint(const joint<T>& joint, std::size_t i,
                             const char* function = "serial_chain", std::string_view name = {}) {
  const auto check = [&](bool condition, const auto&... what) {
    if (!condition) {
      bad_joint(i, message(what...), function, name);
    }
  };
  const auto& t = joint.origin.translation;
  check(std::all_of(t.begin(), t.end(), [](const T& x) { return x - x == 0; }),
        "the origin is not finite");
  check(is_nearly_one(squared_norm(joint.origin.rotation)), "the rotation ", joint.origin.rotation,
        " of the origin is not a unit quaternion: normalized(q)");
  const auto n = components(joint.axis);
  check(joint.kind == joint_kind::fixed || is_nearly_one(dot(n, n)), "the axis (", n.x, ", ", n.y,
        ", ", n.z, ") is not a unit vector");
  check(joint.pitch - joint.pitch == 0, "the pitch ", joint.pitch, " is not finite");
  require_limits(joint.limits, i, function, name);
}

/// The type of a joint with limits: a `continuous` joint that gets a bound becomes `revolute`.
template <class T>
[[nodiscard]] constexpr joint_kind kind_within(joint_kind kind, const joint_limits<T>& limits) {
  const T infinity = std::numeric_limits<T>::infinity();
  const bool is_limited = limits.lower > -infinity || infinity > limits.upper;
  return kind == joint_kind::continuous && is_limited ? joint_kind::revolute : kind;
}

/// The evaluation step of a joint whose frame is at an origin.
template <class T>
[[nodiscard]] constexpr joint_step<T> step_of(const joint<T>& joint, const placement<T>& origin) {
  const quaternion<T> a = origin.rotation * inverse_root_near_one(squared_norm(origin.rotation));
  const auto axis = components(joint.axis);
  const auto n = inverse_root_near_one(dot(axis, axis)) * axis;
  joint_step<T> result;
  result.a = a;
  result.an = a * quaternion<T>(T(0), n.x, n.y, n.z);
  result.offset = components(origin.translation);
  result.axis = cleaned_direction(rotated(a, n));
  result.is_rotational = joint.is_rotational();
  result.is_translational = joint.is_translational();
  result.pitch = joint.translation_per_unit();
  return result;
}

/// The step of a joint after the previous frame has been displaced.
template <class T>
[[nodiscard]] constexpr joint_step<T> displaced(const placement<T>& by, joint_step<T> step) {
  const displacement frame{by.rotation, components(by.translation)};
  step.a = by.rotation * step.a;
  step.an = by.rotation * step.an;
  step.offset = frame.point(step.offset);
  step.axis = cleaned_direction(rotated(by.rotation, step.axis));
  return step;
}

/// Pose of a joint's frame at the coordinate θ relative to the previous frame.
template <class T>
[[nodiscard]] constexpr placement<T> placement_at(const joint_step<T>& step, const T& theta) {
  const auto half = sine_and_cosine_of_constant(T(theta / 2));
  const quaternion<T> r = step.is_rotational ? half.cosine * step.a + half.sine * step.an : step.a;
  const T travel = step.is_translational ? T(theta * step.pitch) : T(0);
  const three_vector<T> t = step.offset + travel * step.axis;
  return {r, {t.x, t.y, t.z}};
}

} // namespace detail

/// A serial chain, whose evaluation steps are in `steps()`.
template <class C>
concept SerialChain = requires(const C& chain) {
  typename C::scalar_type;
  typename C::own_jacobian;
  C::joints;
  chain.steps();
};

/// A serial chain or a kinematic tree, whose coordinates have limits.
template <class C>
concept HasLimits = requires(const C& chain) {
  typename C::scalar_type;
  chain.limits(chain.size()).velocity;
};

namespace detail {

/// The scalar of a chain's results at a configuration of type X.
template <class C, class X>
using chain_scalar = promote_t<typename C::scalar_type, typename vector_argument<X>::scalar>;

template <class C, class X>
void require_size(const C& chain, const X& theta) {
  using argument = vector_argument<X>;
  if constexpr (C::joints > 0 && argument::size_at_compile_time > 0) {
    static_assert(C::joints == argument::size_at_compile_time,
                  "duet: a chain takes as many coordinates as it has moving joints");
  } else if (argument::size(theta) != chain.size()) {
    raise(invalid_input("duet: serial_chain: " + std::to_string(argument::size(theta)) +
                        " coordinates (expected " + std::to_string(chain.size()) + ")"));
  }
}

/// sin(θ/2) and cos(θ/2) of the joints of a chain. For doubles, and values of duals over doubles,
/// they are computed in SIMD vectors, in a quarter of the time of one call of the C library after
/// the other.
///
/// \tparam S  scalar of the results
/// \tparam N  number of joints; negative: up to −N; 0: any
/// \tparam X  type of the configuration θ
template <class S, int N, class X>
class half_angle_sincos {
  static constexpr int max_joints = N > 0 ? N : -N;
  static constexpr bool at_once = max_joints > 1 && std::same_as<real_type_t<S>, double>;
  // Eight lanes are not faster.
  static constexpr int lanes = DUET_VECTOR_BYTES < 32 ? 2 : 4;
  static constexpr int vectors = at_once ? (max_joints + lanes - 1) / lanes : 0;
  using packet = vector_of<double, lanes>;

public:
  /// \param size   number of joints
  /// \param count  number of joints from the base on whose sines are required
  DUET_ALWAYS_INLINE half_angle_sincos(const X& theta, int size, int count) : theta_(theta) {
    if constexpr (at_once) {
      const auto take = [&](int v) DUET_INLINE_LAMBDA {
        const auto at = [&](int k) DUET_INLINE_LAMBDA {
          const int i = v * lanes + k;
          return i < (N > 0 ? N : size) ? innermost(half(i)) : 0.;
        };
        if (v * lanes < count) {
          if constexpr (lanes == 2) {
            values_[std::size_t(v)] = vector_sine_and_cosine(packet{at(0), at(1)});
          } else {
            values_[std::size_t(v)] = vector_sine_and_cosine(packet{at(0), at(1), at(2), at(3)});
          }
        }
      };
      if constexpr (N > 0) { // constant indices keep coordinates in registers
        unrolled<vectors>(take);
      } else {
        for (int v = 0; v * lanes < count; ++v) {
          take(v);
        }
      }
    }
  }
  [[nodiscard]] DUET_ALWAYS_INLINE sine_cosine<S> operator[](int i) const {
    if constexpr (at_once) {
      const auto& both = values_[std::size_t(i / lanes)];
      return sine_and_cosine_from(sine_cosine<double>{both.sine[i % lanes], both.cosine[i % lanes]},
                                  half(i));
    } else {
      return sine_and_cosine_of(half(i));
    }
  }

private:
  [[nodiscard]] DUET_ALWAYS_INLINE S half(int i) const {
    return S(S(vector_argument<X>::get(theta_, i)) / 2);
  }

  const X& theta_;
  std::array<sine_cosine<packet>, std::size_t(vectors)> values_;
};

/// Pose of a link relative to the base.
template <class S>
using link_displacement = displacement<quaternion<S>, three_vector<S>>;

/// Traversal from the I-th joint on of a table known to the compiler.
template <bool WithRotation, class C, int I, class S, class Link, class X, class HalfAngles,
          class Visit>
[[nodiscard]] DUET_ALWAYS_INLINE link_displacement<S>
traverse_static(const Link& link, const X& theta, const HalfAngles& half_angles, int links,
                const Visit& visit) {
  if constexpr (I == C::joints) {
    return link;
  } else {
    if (I == links) {
      return link;
    }
    const known_step<typename C::arm, std::size_t(I)> step;
    const S x(vector_argument<X>::get(theta, I));
    if constexpr (!WithRotation) {
      if (I + 1 == links) {
        return after_joint<false>(link, step, I, x, half_angles, visit);
      }
    }
    return traverse_static<WithRotation, C, I + 1, S>(
        after_joint<true>(link, step, I, x, half_angles, visit), theta, half_angles, links, visit);
  }
}

/// Calls visit(i, step, axis, point on it) for the first `links` joints and returns the frame of
/// the last of them, with its rotation only if required.
template <bool WithRotation, class S, class C, class X, class Visit>
[[nodiscard]] DUET_ALWAYS_INLINE link_displacement<S> walk(const C& chain, const X& theta,
                                                           int links, const Visit& visit) {
  require_size(chain, theta);
  const half_angle_sincos<S, C::joints, X> half_angles(theta, chain.size(), links);
  if constexpr (requires { typename C::arm; }) {
    const known_one one;
    const known_zero zero;
    return traverse_static<WithRotation, C, 0, S>(
        displacement{partially_constant_quaternion{one, zero, zero, zero},
                     three_vector{zero, zero, zero}},
        theta, half_angles, links, visit);
  } else {
    link_displacement<S> link{quaternion<S>(S(1)), {S(0), S(0), S(0)}};
    for (int i = 0; i < links; ++i) {
      const step_in_memory<typename C::scalar_type> step{chain.steps()[std::size_t(i)]};
      const S x(vector_argument<X>::get(theta, i));
      if (!WithRotation && i + 1 == links) {
        return after_joint<false>(link, step, i, x, half_angles, visit);
      }
      link = after_joint<true>(link, step, i, x, half_angles, visit);
    }
    return link;
  }
}

/// Pose of a frame attached to a link.
template <class S, class T>
[[nodiscard]] DUET_ALWAYS_INLINE link_displacement<S> attached(const link_displacement<S>& link,
                                                               const placement<T>& offset) {
  const bool has_rotation = !(offset.rotation == quaternion<T>(T(1)));
  return {has_rotation ? link.rotation * offset.rotation : link.rotation,
          link.point(components(offset.translation))};
}

inline constexpr auto visit_nothing = [](const auto&...) {};

} // namespace detail

/// Default frame of the functions of a chain: its tip.
struct tip_of_chain {};

/// A frame argument of a function of a chain: the tip, a link number, or a frame on a link.
template <class At, class C>
concept FrameOnChain = std::same_as<At, tip_of_chain> || std::integral<At> ||
    std::same_as<At, attached_frame<typename C::scalar_type>>;

namespace detail {

template <class C, FrameOnChain<C> At>
[[nodiscard]] constexpr decltype(auto) frame_on(const C& chain, const At& at) {
  if constexpr (std::same_as<At, tip_of_chain>) {
    return chain.tip();
  } else if constexpr (std::integral<At>) {
    return chain.link(int(at));
  } else {
    return (at);
  }
}

} // namespace detail
} // namespace duet
