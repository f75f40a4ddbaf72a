// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/structure.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <array>
#include <type_traits>

/// \file
/// Three components in registers, used for vectors inside duet; users pass and receive Eigen's
/// vectors. Eigen's expressions are not `constexpr`, and would load two coefficients at once just
/// after they were stored one by one, which stalls the processor.
///
/// Components that are 0 or ±1 may be types, so that products with them vanish at compile time. (A
/// compiler may not drop 0·x by itself: x could be infinite.)

namespace duet::detail {

template <int N>
struct static_number {
  static_assert(-1 <= N && N <= 1);
};
using known_zero = static_number<0>;
using known_one = static_number<1>;

template <class X>
concept Number = Scalar<X> || Arithmetic<X>;

template <int N, int M>
[[nodiscard]] constexpr auto operator*(static_number<N>, static_number<M>) {
  return static_number<N * M>{};
}
template <int N, Number B>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator*(static_number<N> zero, const B& b) {
  if constexpr (N == 0) {
    return zero;
  } else if constexpr (N > 0) {
    return b;
  } else {
    return B(-b);
  }
}
template <Number A, int N>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator*(const A& a, static_number<N> n) {
  return n * a;
}

template <int N>
[[nodiscard]] constexpr auto operator-(static_number<N>) {
  return static_number<-N>{};
}

template <int N, int M>
[[nodiscard]] constexpr auto operator+(static_number<N>, static_number<M>) {
  return static_number<N + M>{};
}
template <Number A, int N>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator+(const A& a, static_number<N>) {
  if constexpr (N == 0) {
    return a;
  } else {
    return A(a + N);
  }
}
template <int N, Number B>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator+(static_number<N> n, const B& b) {
  return b + n;
}

template <class A, int N>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator-(const A& a, static_number<N> n) {
  return a + -n;
}
template <int N, Number B>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator-(static_number<N>, const B& b) {
  if constexpr (N == 0) {
    return B(-b);
  } else {
    return B(N - b);
  }
}

/// The constant returned by a stateless callable, as a type if it is 0 or ±1.
template <class Get>
[[nodiscard]] constexpr auto known(Get get) {
  constexpr auto value = Get{}();
  if constexpr (value == 0 || value == 1 || value == -1) {
    return static_number<int(value)>{};
  } else {
    return get();
  }
}

/// Conversion of any of them to a number.
template <class S, class X>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr S number(const X& x) {
  return S(x);
}
template <class S, int N>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr S number(static_number<N>) {
  return S(N);
}

/// (x, y, z): each a scalar or a constant known at compile time.
template <class X, class Y = X, class Z = X>
struct three_vector {
  X x;
  Y y;
  Z z;

  /// Conversion of all three to one scalar.
  template <class S>
  DUET_ALWAYS_INLINE constexpr operator three_vector<S>() const {
    return {number<S>(x), number<S>(y), number<S>(z)};
  }
  DUET_ALWAYS_INLINE operator vector3<std::remove_cvref_t<X>>() const { return {x, y, z}; }
  [[nodiscard]] DUET_ALWAYS_INLINE vector3<std::remove_cvref_t<X>> eigen() const { return *this; }
  constexpr operator std::array<X, 3>() const { return {x, y, z}; }
};
template <class X, class Y, class Z>
three_vector(X, Y, Z) -> three_vector<X, Y, Z>;

/// The components of a user's vector.
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE three_vector<T> components(const vector3<T>& v) {
  return {v[0], v[1], v[2]};
}
template <class T>
[[nodiscard]] constexpr three_vector<T> components(const std::array<T, 3>& v) {
  return {v[0], v[1], v[2]};
}

template <class X, class Y, class Z, class U, class V, class W>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator+(const three_vector<X, Y, Z>& a,
                                                          const three_vector<U, V, W>& b) {
  return three_vector{a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class X, class Y, class Z, class U, class V, class W>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator-(const three_vector<X, Y, Z>& a,
                                                          const three_vector<U, V, W>& b) {
  return three_vector{a.x - b.x, a.y - b.y, a.z - b.z};
}
template <Number S, class X, class Y, class Z>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator*(const S& s,
                                                          const three_vector<X, Y, Z>& a) {
  return three_vector{s * a.x, s * a.y, s * a.z};
}

template <class X, class Y, class Z, class U, class V, class W>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto dot(const three_vector<X, Y, Z>& a,
                                                    const three_vector<U, V, W>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class X, class Y, class Z, class U, class V, class W>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto cross(const three_vector<X, Y, Z>& a,
                                                      const three_vector<U, V, W>& b) {
  return three_vector{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Matrix of three rows. (Eigen's `m << …` takes longer to compile.)
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE matrix3<T>
matrix_of_rows(const three_vector<T>& a, const three_vector<T>& b, const three_vector<T>& c) {
  matrix3<T> m;
  m(0, 0) = a.x, m(0, 1) = a.y, m(0, 2) = a.z;
  m(1, 0) = b.x, m(1, 1) = b.y, m(1, 2) = b.z;
  m(2, 0) = c.x, m(2, 1) = c.y, m(2, 2) = c.z;
  return m;
}

/// q v q* of a unit quaternion: v + 2 q₀ (q⃗ × v) + 2 q⃗ × (q⃗ × v).
template <class Q, class X, class Y, class Z>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto rotated(const Q& q,
                                                        const three_vector<X, Y, Z>& v) {
  const auto tx = 2 * (q.y() * v.z - q.z() * v.y);
  const auto ty = 2 * (q.z() * v.x - q.x() * v.z);
  const auto tz = 2 * (q.x() * v.y - q.y() * v.x);
  return three_vector{v.x + q.w() * tx + (q.y() * tz - q.z() * ty),
                      v.y + q.w() * ty + (q.z() * tx - q.x() * tz),
                      v.z + q.w() * tz + (q.x() * ty - q.y() * tx)};
}

} // namespace duet::detail

/// Three scalars.
template <class T>
struct duet::structure<duet::detail::three_vector<T>> {
  using scalar = T;
  template <class F, class... Rest>
  [[nodiscard]] DUET_ALWAYS_INLINE static constexpr auto
  map(F&& f, const duet::detail::three_vector<T>& v, const Rest&... rest) {
    using result = std::decay_t<decltype(f(v.x, rest.x...))>;
    return duet::detail::three_vector<result>{f(v.x, rest.x...), f(v.y, rest.y...),
                                              f(v.z, rest.z...)};
  }
};
