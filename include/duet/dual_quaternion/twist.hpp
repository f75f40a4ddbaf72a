// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/select.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/derivative/manifold.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rate.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Core>

#include <concepts>
#include <type_traits>

/// \file
/// Twists, the velocities of rigid motion (N18), as columns [v; ω] and as dual vectors ω + εv; and
/// wrenches, dual to them, forces and moments [f; m] with the power f·v + m·ω, which is independent
/// of the frame.

namespace duet {

/// [v; ω]: linear part first, then angular part.
template <class T>
using vector6 = Eigen::Matrix<T, 6, 1>;
/// 6 × 6 matrix, a linear map of twists [v; ω].
template <class T>
using matrix6 = Eigen::Matrix<T, 6, 6>;

/// ω + εv as the column [v; ω].
template <class T>
[[nodiscard]] vector6<T> twist_of(const dual_vector<T>& v) {
  vector6<T> result;
  for (Eigen::Index i = 0; i < 3; ++i) {
    result[i] = v[i].epsilon();
    result[i + 3] = v[i].value();
  }
  return result;
}
/// The column [v; ω] as ω + εv.
template <class T>
[[nodiscard]] dual_vector<detail::differentiable_t<T>> dual_vector_of(const vector6<T>& twist) {
  return make_dual_vector(vector3<T>(twist.template tail<3>()),
                          vector3<T>(twist.template head<3>()));
}

namespace detail {

/// A twist of `frame::spatial` in `frame::hybrid`: v + ω × t, where t is the origin of the body.
template <class A, class T>
[[nodiscard]] vector6<T> hybrid_twist(const dual_quaternion<A>& a, vector6<T> spatial) {
  const three_vector<T> omega{spatial[3], spatial[4], spatial[5]};
  spatial.template head<3>() += cross(omega, components(translation(a))).eigen();
  return spatial;
}
/// The inverse of `hybrid_twist`: v + t × ω.
template <class A, class T>
[[nodiscard]] vector6<promote_t<A, T>> spatial_twist(const dual_quaternion<A>& a,
                                                     const vector6<T>& hybrid) {
  const three_vector<T> omega{hybrid[3], hybrid[4], hybrid[5]};
  vector6<promote_t<A, T>> spatial = hybrid.template cast<promote_t<A, T>>();
  spatial.template head<3>() += cross(components(translation(a)), omega).eigen();
  return spatial;
}

} // namespace detail

/// N18: the twist [v; ω] of a moving pose with Ȧ = ½ V^s A = ½ A V^b, V = ω + εv.
///
/// `frame::spatial`: fixed axes, v the velocity of the body point at the fixed origin,
/// v^s = ṫ + t × ω^s. `frame::body`: moving axes, v^b = Rᵀṫ. `frame::hybrid`: fixed axes, v = ṫ.
template <class A, Promotable<A> B, FrameConstant Frame>
[[nodiscard]] vector6<promote_t<A, B>> twist(const dual_quaternion<A>& a,
                                             const dual_quaternion<B>& a_dot, Frame frame) {
  using T = promote_t<A, B>;
  if constexpr (std::same_as<Frame, hybrid_frame>) {
    return detail::hybrid_twist(a, twist(a, a_dot, frame::spatial));
  } else {
    return twist_of<T>(angular_velocity(a, a_dot, frame));
  }
}

/// Rejected: without a frame the axes are ambiguous.
template <class A, class B>
DUET_REFUSED("the frame is missing: twist(a, a_dot, frame::hybrid), frame::spatial or frame::body")
vector6<promote_t<A, B>> twist(const dual_quaternion<A>&, const dual_quaternion<B>&);

/// N18: the rate Ȧ of a pose that moves with a twist [v; ω], Ȧ = ½ V^s A = ½ A V^b; in
/// `frame::hybrid` V^s = [v + t × ω; ω].
template <class A, Promotable<A> B, FrameConstant Frame>
[[nodiscard]] dual_quaternion<promote_t<A, B>> pose_rate(const dual_quaternion<A>& a,
                                                         const vector6<B>& twist, Frame frame) {
  if constexpr (std::same_as<Frame, hybrid_frame>) {
    return pose_rate(a, detail::spatial_twist(a, twist), frame::spatial);
  } else {
    using S = detail::as_real_of<B, promote_t<A, B>>;
    return quaternion_rate(a, dual_vector_of(vector6<S>(twist.template cast<S>())), frame);
  }
}

/// Rejected: without a frame the axes are ambiguous.
template <class A, class B>
DUET_REFUSED(
    "the frame is missing: pose_rate(a, twist, frame::hybrid), frame::spatial or frame::body")
dual_quaternion<promote_t<A, B>> pose_rate(const dual_quaternion<A>&, const vector6<B>&);

/// Adjoint matrix [R t̂R; 0 R]: V^s = Ad(A) V^b for twists [v; ω]; changes the frame of a twist.
template <class T>
[[nodiscard]] matrix6<T> Ad(const dual_quaternion<T>& a) {
  const matrix3<T> r = rotation_matrix(rotation(a));
  const vector3<T> t = translation(a);
  matrix6<T> m;
  m << r, matrix3<T>::Zero(), matrix3<T>::Zero(), r;
  for (int j = 0; j < 3; ++j) {
    m.template block<3, 1>(0, 3 + j) = t.cross(vector3<T>(r.col(j)));
  }
  return m;
}

/// [ω̂ v̂; 0 ω̂]: ad(V) W is the derivative of Ad(exp(½ V t)) W at t = 0, the Lie bracket of twists.
template <class T>
[[nodiscard]] matrix6<T> ad(const vector6<T>& twist) {
  matrix6<T> m = matrix6<T>::Zero();
  const auto hat = [](const vector3<T>& w) {
    const T zero(0);
    matrix3<T> h;
    h << zero, -w[2], w[1], w[2], zero, -w[0], -w[1], w[0], zero;
    return h;
  };
  m.template topLeftCorner<3, 3>() = hat(twist.template tail<3>());
  m.template bottomRightCorner<3, 3>() = m.template topLeftCorner<3, 3>();
  m.template topRightCorner<3, 3>() = hat(twist.template head<3>());
  return m;
}

/// Tangent space of poses: a small twist δ = [v; ω] is a left perturbation exp(δ/2) A in
/// `frame::spatial`, a right perturbation A exp(δ/2) in `frame::body`; in `frame::hybrid` the
/// origin is translated by v and the rotation multiplied by exp(ω/2) from the left, independently.
/// Rates are twists.
template <class T>
struct manifold<quaternion<dual<T, 1, screw_tag>>> {
  static constexpr int dimension = 6;
  using scalar = T;
  template <class Delta, class Frame = spatial_frame>
  [[nodiscard]] static auto plus(const dual_quaternion<T>& a, const Delta& delta,
                                 Frame frame = {}) {
    using S = std::decay_t<decltype(delta[0])>;
    if constexpr (std::is_same_v<Frame, hybrid_frame>) {
      // (1 + ½εv)(1 + ½εt) e (1 − ½εt), where t e − e t = 2 t × e⃗
      const auto e = duet::exp(vector3<S>(delta[3] / 2, delta[4] / 2, delta[5] / 2));
      const detail::three_vector<S> axis{e.x(), e.y(), e.z()};
      const vector3<S> across = detail::cross(detail::components(translation(a)), axis);
      const vector3<S> half(delta[0] / 2, delta[1] / 2, delta[2] / 2);
      const auto step =
          make_dual_quaternion(e, quaternion<S>(S(0), across) + quaternion<S>(S(0), half) * e);
      return step * a;
    } else {
      const auto step =
          duet::exp(dual_vector<S>(dual_vector_of(vector6<S>(delta)) * real_type_t<S>(0.5)));
      return detail::composed_in(frame, step, a);
    }
  }
  static constexpr bool takes_rates_of_any_scalar = true;
  template <class R, class Frame>
  [[nodiscard]] static vector6<promote_t<T, R>>
  velocity(const dual_quaternion<T>& a, const dual_quaternion<R>& rate, Frame frame) {
    return twist(a, rate, frame);
  }
};

/// The constant twist δ = [v; ω] that takes the pose A to the pose B in unit time, an error between
/// poses with axes: the inverse of the perturbations of `jacobian`, with |ω| ≤ π.
///
/// `frame::body`: 2 log(A* B), B = A exp(δ/2). `frame::spatial`: 2 log(B A*), B = exp(δ/2) A.
/// `frame::hybrid`: v = t_B − t_A, ω of `frame::spatial`. The signs of A and B do not matter. Both
/// are of unit norm; half a turn apart δ jumps.
template <class A, Promotable<A> B, FrameConstant Frame>
[[nodiscard]] vector6<promote_t<A, B>> twist_between(const dual_quaternion<A>& a,
                                                     const dual_quaternion<B>& b, Frame /*frame*/) {
  using T = promote_t<A, B>;
  if constexpr (std::same_as<Frame, hybrid_frame>) {
    vector6<T> delta = twist_between(a, b, frame::spatial);
    delta.template head<3>() = translation(b) - translation(a);
    return delta;
  } else {
    const dual_quaternion<T> step = std::same_as<Frame, body_frame> ? conj(a) * b : b * conj(a);
    const dual_quaternion<T> shorter = select(
        innermost(step.w()) < 0, [&] { return -step; }, [&] { return step; });
    return twist_of<T>(
        dual_vector<T>(detail::log_vector(shorter, "twist_between") * real_type_t<T>(2)));
  }
}

/// Rejected: without a frame the axes are ambiguous.
template <class A, class B>
DUET_REFUSED("the frame is missing: twist_between(a, b, frame::hybrid), frame::spatial or "
             "frame::body")
vector6<promote_t<A, B>> twist_between(const dual_quaternion<A>&, const dual_quaternion<B>&);

/// Coadjoint matrix [R 0; t̂R R] = Ad(A)⁻ᵀ: transforms wrenches [f; m], m about the origin, as
/// Ad(A) transforms twists: F^s = coAd(A) F^b, and (coAd(A) F)·(Ad(A) V) = F·V.
template <class T>
[[nodiscard]] matrix6<T> coAd(const dual_quaternion<T>& a) {
  const matrix6<T> m = Ad(a);
  matrix6<T> result = matrix6<T>::Zero();
  result.template topLeftCorner<3, 3>() = m.template topLeftCorner<3, 3>();
  result.template bottomRightCorner<3, 3>() = m.template topLeftCorner<3, 3>();
  result.template bottomLeftCorner<3, 3>() = m.template topRightCorner<3, 3>();
  return result;
}

/// −ad(V)ᵀ: the rate of coAd(exp(½ V t)) F at t = 0 is coad(V) F.
template <class T>
[[nodiscard]] matrix6<T> coad(const vector6<T>& twist) {
  return -ad(twist).transpose();
}

DUET_REFUSES_FOREIGN(twist, vector6<double>)
DUET_REFUSES_FOREIGN(pose_rate, dual_quaternion<double>)
DUET_REFUSES_FOREIGN(Ad, matrix6<double>)

} // namespace duet
