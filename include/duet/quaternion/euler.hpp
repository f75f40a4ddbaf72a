// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/constants.hpp>
#include <duet/core/select.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>

#include <array>
#include <cmath>
#include <concepts>
#include <type_traits>

/// \file
/// Euler angles in all twelve sequences. `zyx` means R = R_z(first) R_y(second) R_x(third): the
/// letters are the axes of the moving body, turned about one after the other; read from the right,
/// fixed axes.

namespace duet {

/// Three axes, 0 = x, 1 = y, 2 = z, no two neighbours equal.
struct euler_sequence {
  int first, second, third;

  [[nodiscard]] constexpr bool is_proper() const { return first == third; }
  /// The axis that is neither first nor second.
  [[nodiscard]] constexpr int other() const { return 3 - first - second; }
  /// +1 where first, second, other follow x → y → z → x, else −1.
  [[nodiscard]] constexpr int sign() const { return (second - first + 3) % 3 == 1 ? 1 : -1; }
};

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

/// An angle within 2π of zero, brought into [−π, π].
template <class T>
[[nodiscard]] T wrapped(const T& angle) {
  const auto pi = constant::pi<real_type_t<T>>();
  const auto lowered = select(
      innermost(angle) > pi, [&] { return T(angle - 2 * pi); }, [&] { return angle; });
  return select(
      innermost(angle) < -pi, [&] { return T(angle + 2 * pi); }, [&] { return lowered; });
}

} // namespace detail

/// The rotation R_i(a) R_j(b) R_k(c) of the sequence ijk; angles in the letters' order, radians,
/// integers among them.
/// Example: `from_euler<zyx>(yaw, pitch, roll)`.
template <euler_sequence Sequence, class A, class B, class C>
  requires Promotable<A, promote_t<B, C>>
[[nodiscard]] auto from_euler(const A& a, const B& b, const C& c) {
  using common = promote_t<A, promote_t<B, C>>;
  using T = std::conditional_t<std::integral<common>, double, common>;
  return detail::axis_rotation(Sequence.first, T(a)) *
         detail::axis_rotation(Sequence.second, T(b)) * detail::axis_rotation(Sequence.third, T(c));
}

/// The angles of a rotation, q of any norm, in the letters' order.
///
/// First and third lie in [−π, π]; the second in [0, π] where the first and last letters are equal,
/// else in [−π/2, π/2]. At either end of the second angle's range (gimbal lock) only the sum or the
/// difference of the others is determined; the angles returned still give the rotation, but they
/// have no derivative there.
template <euler_sequence Sequence, class T>
[[nodiscard]] std::array<T, 3> euler(const quaternion<T>& q) {
  using std::atan2;
  using std::hypot;
  constexpr int sign = Sequence.sign();
  const std::array<T, 3> v{q.x(), q.y(), q.z()};
  const T& i = v[std::size_t(Sequence.first)];
  const T& j = v[std::size_t(Sequence.second)];
  const T k = sign * v[std::size_t(Sequence.other())];
  // With half angles α, β, γ, R_i R_j R_i is (cos β cos(α+γ), cos β sin(α+γ), sin β cos(α−γ),
  // sin β sin(α−γ)) in the basis 1, e_i, e_j, e_i e_j.
  const auto proper = [](const T& w, const T& x, const T& y, const T& z) {
    const T sum = atan2(x, w);
    const T difference = atan2(z, y);
    return std::array<T, 3>{detail::wrapped(T(sum + difference)),
                            T(2 * atan2(hypot(y, z), hypot(w, x))),
                            detail::wrapped(T(sum - difference))};
  };
  if constexpr (Sequence.is_proper()) {
    return proper(q.w(), i, j, k);
  } else {
    // A quarter turn about e_j takes e_i to the third axis: R_i R_j(b) R_k(c) R_j(π/2) is
    // R_i R_j(b + π/2) R_i(∓c). The factor √2 cancels.
    const auto angles = proper(q.w() - j, i - k, j + q.w(), k + i);
    const auto pi = constant::pi<real_type_t<T>>();
    return {angles[0], T(angles[1] - pi / 2), T(-sign * angles[2])};
  }
}

/// The matrix A with ω = A [a′, b′, c′]ᵀ in spatial axes, for the angles a, b of the sequence ijk;
/// the third angle does not enter. Columns are the axes being turned about: e_i, R_i e_j, R_i R_j
/// e_k.
///
/// P5 (true form): for `zyx` its columns belong to ψ′, θ′, φ′. Singular in gimbal lock.
template <euler_sequence Sequence, class T>
[[nodiscard]] matrix3<T> euler_rate_matrix(const T& a, const T& b) {
  const quaternion<T> first = detail::axis_rotation(Sequence.first, a);
  const quaternion<T> both = first * detail::axis_rotation(Sequence.second, b);
  matrix3<T> m;
  m.col(0) = vector3<T>::Unit(Sequence.first);
  m.col(1) = rotate(first, vector3<T>(vector3<T>::Unit(Sequence.second)));
  m.col(2) = rotate(both, vector3<T>(vector3<T>::Unit(Sequence.third)));
  return m;
}

} // namespace duet
