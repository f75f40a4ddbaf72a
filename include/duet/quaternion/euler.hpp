// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/batch.hpp>
#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/dual/level.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <type_traits>

/// \file
/// Intrinsic Euler angles in all twelve sequences. `zyx` (SciPy's upper-case "ZYX") means
/// R = R_z(first) R_y(second) R_x(third): successive rotations about the axes of the moving body in
/// the order of the letters; read from the right, extrinsic rotations about fixed axes.

namespace duet::detail {

/// a b + c d to two units in its last place, unless something overflows or underflows.
template <Real R>
[[nodiscard]] R sum_of_products(const R& a, const R& b, const R& c, const R& d) {
  if constexpr (std::floating_point<R>) { // Kahan's
    const R cd = c * d;
    const R error = std::fma(c, d, -cd);
    return std::fma(a, b, cd) + error;
  } else { // Dekker's: Boost.Multiprecision's fma rounds twice
    const auto upper_half = [](const R& x) {
      const R raised = ldexp(x, (std::numeric_limits<R>::digits + 1) / 2) + x;
      return R(raised - R(raised - x));
    };
    const auto error_of = [&](const R& p, const R& q, const R& pq) {
      const R p1 = upper_half(p), q1 = upper_half(q);
      const R p2 = p - p1, q2 = q - q1;
      return R(R(R(R(p1 * q1 - pq) + p1 * q2) + p2 * q1) + p2 * q2);
    };
    const R ab = a * b, cd = c * d;
    return R(R(ab + cd) + error_of(a, b, ab)) + error_of(c, d, cd);
  }
}

} // namespace duet::detail

namespace duet {

/// Three axes, 0 = x, 1 = y, 2 = z, no two neighbours equal.
struct euler_sequence {
  /// Axes of the moving body, rotated about in this order; the default is `zyx`.
  int first = 2, second = 1, third = 0;

  /// True if the first and the third axis are the same (proper Euler angles).
  [[nodiscard]] constexpr bool is_proper() const { return first == third; }
  /// The axis that is neither first nor second.
  [[nodiscard]] constexpr int other() const { return 3 - first - second; }
  /// +1 if first, second, other follow x → y → z → x, else −1.
  [[nodiscard]] constexpr int sign() const { return (second - first + 3) % 3 == 1 ? 1 : -1; }
};

/// The twelve intrinsic sequences, named by the axes of the successive rotations.
inline constexpr euler_sequence xyz{0, 1, 2}, yzx{1, 2, 0}, zxy{2, 0, 1};
inline constexpr euler_sequence xzy{0, 2, 1}, yxz{1, 0, 2}, zyx{2, 1, 0};
inline constexpr euler_sequence xyx{0, 1, 0}, yzy{1, 2, 1}, zxz{2, 0, 2};
inline constexpr euler_sequence xzx{0, 2, 0}, yxy{1, 0, 1}, zyz{2, 1, 2};

namespace detail {

/// exp(½ angle e_axis)
template <class T>
[[nodiscard]] quaternion<T> axis_rotation(int axis, const T& angle) {
  using std::cos;
  using std::sin;
  const T half = angle / 2;
  const T s = sin(half);
  const T zero(0);
  return {cos(half), axis == 0 ? s : zero, axis == 1 ? s : zero, axis == 2 ? s : zero};
}

/// w, then the components of q along the first and the second axis of the sequence and along their
/// product e_i e_j.
template <euler_sequence Sequence, class T>
[[nodiscard]] std::array<T, 4> along_axes(const quaternion<T>& q) {
  const std::array<T, 3> v{q.x(), q.y(), q.z()};
  return {q.w(), v[std::size_t(Sequence.first)], v[std::size_t(Sequence.second)],
          T(Sequence.sign() * v[std::size_t(Sequence.other())])};
}

/// q times a power of 2 that brings it near 1, so that products of its components stay in range.
template <class T>
[[nodiscard]] quaternion<T> of_moderate_norm(const quaternion<T>& q) {
  const auto near_one = [](const auto& p, int) { return p; };
  return by_lane([&](const auto& p) { return of_scaled(near_one, p); }, q);
}

/// Numbers proportional to cos β cos(α+γ), cos β sin(α+γ), sin β cos(α−γ), sin β sin(α−γ), which
/// for half angles α, β, γ are those components of R_i R_j R_i.
///
/// A quarter turn about e_j takes e_i to the third axis:
/// R_i R_j(b) R_k(c) R_j(π/2) = R_i R_j(b + π/2) R_i(∓c).
template <euler_sequence Sequence, class T>
[[nodiscard]] std::array<T, 4> proper_components(const std::array<T, 4>& q) {
  if constexpr (Sequence.is_proper()) {
    return q;
  } else {
    return {q[0] - q[2], q[1] - q[3], q[2] + q[0], q[3] + q[1]};
  }
}

/// Angles of a real quaternion. A quantity that vanishes with an angle is a sum of two products and
/// so has a small relative error. The other quantities need no small relative error.
template <euler_sequence Sequence, Real R>
[[nodiscard]] std::array<R, 3> euler_angles(const quaternion<R>& q) {
  using std::atan2;
  using std::hypot;
  require_not_zero(q, "euler");
  // The scale is so large that no product with the largest component underflows.
  constexpr int exponent = std::min(std::numeric_limits<R>::max_exponent, 16384) / 2 - 4;
  const std::array<R, 4> components =
      along_axes<Sequence>(scaled_down(q, binary_exponent(largest_component(q)) - exponent));
  const R &s = components[0], &i = components[1], &j = components[2], &k = components[3];
  const std::array<R, 4> halves = proper_components<Sequence>(components);
  const R &w = halves[0], &x = halves[1], &y = halves[2], &z = halves[3];
  // Sines and cosines of the first and the third angle, times sin β cos β; then the second angle.
  const R cosine_a = w * y - x * z, cosine_c = w * y + x * z;
  R sine_a, sine_c, second;
  if constexpr (Sequence.is_proper()) {
    sine_a = sum_of_products<R>(i, j, s, k);
    sine_c = sum_of_products<R>(i, j, -s, k);
    second = 2 * atan2(R(hypot(y, z)), R(hypot(w, x)));
  } else {
    sine_a = 2 * sum_of_products<R>(s, i, -j, k);
    sine_c = 2 * Sequence.sign() * sum_of_products<R>(s, k, -i, j);
    second = atan2(R(2 * sum_of_products<R>(s, j, i, k)), R(hypot(w, x) * hypot(y, z)));
  }
  // In gimbal lock only α + γ or α − γ is determined, and is split equally between both angles.
  const int sign = Sequence.is_proper() ? 1 : -Sequence.sign();
  const auto both = [&](const R& half_sum, int sign_of_last) {
    return std::array<R, 3>{half_sum, second, R(R(sign_of_last) * half_sum)};
  };
  return select(
      y == 0 && z == 0, [&] { return both(atan2(x, w), sign); },
      [&] {
        return select(
            w == 0 && x == 0, [&] { return both(atan2(z, y), -sign); },
            [&] {
              return std::array<R, 3>{atan2(sine_a, cosine_a), second, atan2(sine_c, cosine_c)};
            });
      });
}

/// Scalar of an angle: double for integers.
template <class T>
using angle_t = std::conditional_t<std::integral<T>, double, T>;

} // namespace detail

/// Rotation R_i(a) R_j(b) R_k(c) of the intrinsic sequence ijk; angles in the order of the letters,
/// in radians, integers among them (degrees are not recognised: 90 is 90 radians).
///
/// \return `quaternion<T>`
///
/// Example: `from_euler<zyx>(yaw, pitch, roll)`.
template <euler_sequence Sequence, class A, class B, class C>
  requires Promotable<A, promote_t<B, C>>
[[nodiscard]] auto from_euler(const A& a, const B& b, const C& c) {
  using T = detail::angle_t<promote_t<A, promote_t<B, C>>>;
  return detail::axis_rotation(Sequence.first, T(a)) *
         detail::axis_rotation(Sequence.second, T(b)) * detail::axis_rotation(Sequence.third, T(c));
}

/// Intrinsic Euler angles of a rotation, q of any norm, in the order of the letters, in radians.
///
/// First and third lie in [−π, π]; the second in [0, π] if the first and last letters are equal,
/// else in [−π/2, π/2]. Each is accurate to a few units in its last place, however small it is.
/// At either end of the second angle's range (gimbal lock) only the sum or the difference of the
/// others is determined; the angles returned still give the rotation, but have no derivatives
/// there.
///
/// \throws invalid_input for the zero quaternion
template <euler_sequence Sequence, class T>
[[nodiscard]] std::array<T, 3> euler(const quaternion<T>& q) {
  if constexpr (Infinitesimal<T>) {
    using std::atan2;
    using std::hypot;
    const auto values = euler<Sequence>(detail::innermost_of(q));
    // Infinitesimal parts of α + γ and α − γ stay accurate near gimbal lock too.
    const std::array<T, 4> components = detail::along_axes<Sequence>(detail::of_moderate_norm(q));
    const auto [w, x, y, z] = detail::proper_components<Sequence>(components);
    const T sum = atan2(x, w);
    const T difference = atan2(z, y);
    T second;
    if constexpr (Sequence.is_proper()) {
      second = 2 * atan2(hypot(y, z), hypot(w, x));
    } else { // sine and cosine by numbers as small as the angle, so that nothing cancels
      const auto& [s, i, j, k] = components;
      second = atan2(T(2 * (s * j + i * k)), hypot(T(w * y + x * z), T(w * z - x * y)));
    }
    constexpr int sign = Sequence.is_proper() ? 1 : -Sequence.sign();
    return {detail::with_innermost(T(sum + difference), values[0]),
            detail::with_innermost(second, values[1]),
            detail::with_innermost(T(sign * (sum - difference)), values[2])};
  } else {
    return detail::by_lane([](const auto& p) { return detail::euler_angles<Sequence>(p); }, q);
  }
}

/// Matrix A with ω = A [a′, b′, c′]ᵀ in spatial axes, for the angles a, b of the sequence ijk, in
/// radians; the third angle does not enter. Columns are the axes of the successive rotations: e_i,
/// R_i e_j, R_i R_j e_k.
///
/// P5 (true form): for `zyx` its columns belong to ψ′, θ′, φ′. Singular in gimbal lock.
template <euler_sequence Sequence, class A, Promotable<A> B>
[[nodiscard]] auto euler_rate_matrix(const A& a, const B& b) {
  using std::cos;
  using std::sin;
  using T = detail::angle_t<promote_t<A, B>>;
  constexpr int i = Sequence.first, j = Sequence.second, other = Sequence.other();
  constexpr int sign = Sequence.sign(); // e_i × e_j = ± e_other
  const T cosine(cos(a)), sine(sin(a));
  // R_j takes e_k to `along` e_i + `across` e_other; then R_i takes e_other to
  // cos a e_other ∓ sin a e_j.
  const T along = Sequence.is_proper() ? T(cos(b)) : T(sign * sin(b));
  const T across = Sequence.is_proper() ? T(-sign * sin(b)) : T(cos(b));
  matrix3<T> m;
  m.col(0) = vector3<T>::Unit(i);
  m(i, 1) = T(0);
  m(j, 1) = cosine;
  m(other, 1) = sign * sine;
  m(i, 2) = along;
  m(j, 2) = -sign * sine * across;
  m(other, 2) = cosine * across;
  return m;
}

/// P5 as printed in the available copy: the matrix A_K with ω = A_K [φ′, θ′, ψ′]ᵀ in spatial axes,
/// for R = R_z(ψ) R_y(θ) R_x(φ), **with an error in that copy or in print**: its element (3, 1)
/// reads −sin ψ. Columns are axes of rotation, of length 1; with −sin ψ the first is not, so that
/// no sequence of Euler angles has this matrix.
///
/// The correct element, −sin θ, is in `euler_rate_matrix<zyx>(psi, theta)`, whose columns are in
/// the order of the letters: ψ′, θ′, φ′. The two agree if sin ψ = sin θ. Source: Houdek, Verlinden,
/// Hajžman, "Derivatives of quaternion spline interpolation function for multibody dynamics",
/// equation (5).
template <class A, Promotable<A> B>
[[nodiscard]] auto printed_euler_rate_matrix(const A& psi, const B& theta) {
  using std::cos;
  using std::sin;
  using T = detail::angle_t<promote_t<A, B>>;
  const T zero(0);
  matrix3<T> a;
  a << T(cos(psi) * cos(theta)), T(-sin(psi)), zero, //
      T(sin(psi) * cos(theta)), T(cos(psi)), zero,   //
      T(-sin(psi)), zero, T(1);
  return a;
}

/// Rejected: without a sequence the axes are ambiguous.
template <class... X>
DUET_REFUSED("the Euler sequence is missing: from_euler<zyx>(yaw, pitch, roll), in radians")
quaternion<double> from_euler(const X&...);
template <class T>
DUET_REFUSED("the Euler sequence is missing: euler<zyx>(q)")
std::array<T, 3> euler(const quaternion<T>&);
template <class... X>
DUET_REFUSED("the Euler sequence is missing: euler_rate_matrix<zyx>(yaw, pitch)")
matrix3<double> euler_rate_matrix(const X&...);

template <euler_sequence Sequence, class V>
DUET_REFUSED("from_euler takes three angles: from_euler<zyx>(a[0], a[1], a[2])")
quaternion<typename V::Scalar> from_euler(const Eigen::MatrixBase<V>&);

} // namespace duet
