// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/structure.hpp>
#include <duet/dual/eigen_traits.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/quaternion/foreign.hpp>

#include <Eigen/Core>

#include <concepts>
#include <ostream>
#include <string>
#include <type_traits>

/// \file
/// Quaternions and their algebra (N1–N3).

namespace duet {

/// A column of three scalars.
template <class T>
using vector3 = Eigen::Matrix<T, 3, 1>;
/// A 3 × 3 matrix, as of a rotation.
template <class T>
using matrix3 = Eigen::Matrix<T, 3, 3>;

/// A quaternion w + x i + y j + z k: Hamilton product (ij = k), scalar part first.
///
/// \tparam T  any scalar. Over a real number a unit quaternion is a rotation, acting as v ↦ q v q*.
///   Over derivative duals it carries its derivatives, over `dual<T, 1, screw_tag>` it is a dual
///   quaternion, a rigid motion. There is no other implementation.
template <class T>
class quaternion {
public:
  using scalar_type = T;

  /// Zero.
  constexpr quaternion() : w_(T(0)), x_(T(0)), y_(T(0)), z_(T(0)) {}
  /// The quaternion w + x i + y j + z k, scalar part first.
  constexpr quaternion(const T& w, const T& x, const T& y, const T& z)
      : w_(w), x_(x), y_(y), z_(z) {}
  /// A scalar as a quaternion: 1 is the identity rotation.
  constexpr explicit quaternion(const T& w) : w_(w), x_(T(0)), y_(T(0)), z_(T(0)) {}
  /// The quaternion with the scalar part w and the vector part v.
  quaternion(const T& w, const vector3<T>& v) : w_(w), x_(v[0]), y_(v[1]), z_(v[2]) {}
  template <detail::ForeignMotion X>
  DUET_REFUSED("a rotation or pose of Eigen: from_eigen(q) of <duet/interop/eigen.hpp>")
  quaternion(const X&);
  /// Conversion from a quaternion over another scalar; implicit if no precision or level is lost.
  template <class U>
    requires(!std::same_as<U, T> && std::constructible_from<T, U>)
  constexpr explicit(!std::convertible_to<U, T> || !std::same_as<promote_t<T, U>, T>)
      quaternion(const quaternion<U>& q)
      : w_(static_cast<T>(q.w())), x_(static_cast<T>(q.x())), y_(static_cast<T>(q.y())),
        z_(static_cast<T>(q.z())) {}

  template <class M>
    requires(std::derived_from<M, Eigen::MatrixBase<M>>&& M::SizeAtCompileTime != 4)
  DUET_REFUSED("the matrix of a rotation is rotation_matrix(q), that of a pose transform_matrix(A)")
  operator M() const;

  [[nodiscard]] constexpr const T& w() const { return w_; } ///< the scalar part
  [[nodiscard]] constexpr const T& x() const { return x_; } ///< coefficient of i
  [[nodiscard]] constexpr const T& y() const { return y_; } ///< coefficient of j
  [[nodiscard]] constexpr const T& z() const { return z_; } ///< coefficient of k
  /// The vector part (x, y, z).
  [[nodiscard]] vector3<T> vec() const { return {x_, y_, z_}; }

  [[nodiscard]] friend constexpr quaternion operator+(const quaternion& q) { return q; }
  [[nodiscard]] friend constexpr quaternion operator-(const quaternion& q) {
    return {-q.w_, -q.x_, -q.y_, -q.z_};
  }

  template <class U>
    requires std::convertible_to<quaternion<U>, quaternion>
  constexpr quaternion& operator+=(const quaternion<U>& q) { return *this = *this + q; }
  template <class U>
    requires std::convertible_to<quaternion<U>, quaternion>
  constexpr quaternion& operator-=(const quaternion<U>& q) { return *this = *this - q; }
  template <class U>
    requires std::convertible_to<quaternion<U>, quaternion>
  constexpr quaternion& operator*=(const quaternion<U>& q) { return *this = *this * q; }
  template <std::convertible_to<T> U>
  constexpr quaternion& operator*=(const U& a) {
    return *this = *this * a;
  }
  template <std::convertible_to<T> U>
  constexpr quaternion& operator/=(const U& a) {
    return *this = *this / a;
  }

  friend std::ostream& operator<<(std::ostream& out, const quaternion& q) {
    return out << "(" << q.w_ << ", " << q.x_ << ", " << q.y_ << ", " << q.z_ << ")";
  }

private:
  T w_, x_, y_, z_;
};

/// A rotation, or any quaternion, as (w, x, y, z), numbers to six digits.
template <class T>
[[nodiscard]] std::string to_text(const quaternion<T>& q) {
  return detail::message(q);
}

/// Rejects scalars that cannot be divided.
template <class T>
  requires(!Scalar<T>)
class quaternion<T> {
public:
  template <class... X>
  DUET_REFUSED("a quaternion<T> needs a real number, an infinitesimal or another scalar for T, as "
               "quaternion<double>: integers cannot be divided")
  quaternion(const X&...);
};

template <class T>
struct structure<quaternion<T>> {
  using scalar = T;
  template <class F, class... Rest>
  [[nodiscard]] DUET_ALWAYS_INLINE static constexpr auto map(F&& f, const quaternion<T>& q,
                                                             const Rest&... rest) {
    using result = std::decay_t<decltype(f(q.w(), rest.w()...))>;
    return quaternion<result>{f(q.w(), rest.w()...), f(q.x(), rest.x()...), f(q.y(), rest.y()...),
                              f(q.z(), rest.z()...)}; // in this order
  }
};

/// Deduces the scalar of a product of the four numbers and constants.
template <class A, class B, class C, class D>
quaternion(const A&, const B&, const C&, const D&)
    -> quaternion<promote_t<promote_t<A, B>, promote_t<C, D>>>;

/// True if T is a `quaternion`. For those who extend duet.
template <class T>
inline constexpr bool is_quaternion = false;
template <class T>
inline constexpr bool is_quaternion<quaternion<T>> = true;

/// A scalar that may multiply a quaternion over T. For those who extend duet.
template <class S, class T>
concept ScalarFor = (Scalar<S> || Arithmetic<S>)&&Promotable<S, T>;

template <class A, Promotable<A> B>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr quaternion<promote_t<A, B>>
operator+(const quaternion<A>& p, const quaternion<B>& q) {
  return {p.w() + q.w(), p.x() + q.x(), p.y() + q.y(), p.z() + q.z()};
}
template <class A, Promotable<A> B>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr quaternion<promote_t<A, B>>
operator-(const quaternion<A>& p, const quaternion<B>& q) {
  return {p.w() - q.w(), p.x() - q.x(), p.y() - q.y(), p.z() - q.z()};
}

/// N1: pq = (p₀q₀ − p⃗·q⃗, p₀q⃗ + q₀p⃗ + p⃗×q⃗)
template <class A, Promotable<A> B>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr quaternion<promote_t<A, B>>
operator*(const quaternion<A>& p, const quaternion<B>& q) {
  // All four sums grow by one component of p at a time, which keeps fewer numbers in registers than
  // finishing one sum after the other.
  using T = promote_t<A, B>;
  T w = p.w() * q.w();
  T x = p.w() * q.x();
  T y = p.w() * q.y();
  T z = p.w() * q.z();
  w = w - p.x() * q.x();
  x = x + p.x() * q.w();
  y = y - p.x() * q.z();
  z = z + p.x() * q.y();
  w = w - p.y() * q.y();
  x = x + p.y() * q.z();
  y = y + p.y() * q.w();
  z = z - p.y() * q.x();
  w = w - p.z() * q.z();
  x = x - p.z() * q.y();
  y = y + p.z() * q.x();
  z = z + p.z() * q.w();
  return {w, x, y, z};
}

template <class T, ScalarFor<T> S>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr quaternion<promote_t<T, S>>
operator*(const quaternion<T>& q, const S& a) {
  const auto factor = detail::as_constant<promote_t<T, S>>(a);
  return {q.w() * factor, q.x() * factor, q.y() * factor, q.z() * factor};
}
template <class T, ScalarFor<T> S>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr quaternion<promote_t<T, S>>
operator*(const S& a, const quaternion<T>& q) {
  return q * a;
}
template <class T, ScalarFor<T> S>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr quaternion<promote_t<T, S>>
operator/(const quaternion<T>& q, const S& a) {
  const auto divisor = detail::as_constant<promote_t<T, S>>(a);
  return {q.w() / divisor, q.x() / divisor, q.y() / divisor, q.z() / divisor};
}

template <class T, detail::ForeignMotion X>
DUET_REFUSED("a product with a rotation or pose of Eigen: q * from_eigen(p)")
quaternion<T> operator*(const quaternion<T>&, const X&);
template <class T, detail::ForeignMotion X>
DUET_REFUSED("a product with a rotation or pose of Eigen: from_eigen(p) * q")
quaternion<T> operator*(const X&, const quaternion<T>&);

/// Rejects products with vectors and matrices: to rotate a vector, or to transform a point by a
/// pose, takes a product on either side, and a matrix is another representation of a rotation.
template <class T, class V>
  requires(V::ColsAtCompileTime == 1)
DUET_REFUSED("a quaternion times a vector: rotate(q, v) rotates it, transform_point(A, v) "
             "transforms a point by a pose")
vector3<T> operator*(const quaternion<T>&, const Eigen::MatrixBase<V>&);
template <class T, class V>
  requires(V::ColsAtCompileTime == 1)
DUET_REFUSED("a vector times a quaternion: rotate(q, v) rotates it, transform_point(A, v) "
             "transforms a point by a pose")
vector3<T> operator*(const Eigen::MatrixBase<V>&, const quaternion<T>&);
template <class T, class M>
  requires(M::ColsAtCompileTime != 1)
DUET_REFUSED("a quaternion times a matrix: q * from_rotation_matrix(R), or rotation_matrix(q) * R")
matrix3<T> operator*(const quaternion<T>&, const Eigen::MatrixBase<M>&);
template <class T, class M>
  requires(M::ColsAtCompileTime != 1)
DUET_REFUSED("a matrix times a quaternion: from_rotation_matrix(R) * q, or R * rotation_matrix(q)")
matrix3<T> operator*(const Eigen::MatrixBase<M>&, const quaternion<T>&);

/// Componentwise equality of values. q and −q are the same rotation but not the same quaternion.
template <class A, Promotable<A> B>
[[nodiscard]] constexpr auto operator==(const quaternion<A>& p, const quaternion<B>& q) {
  return p.w() == q.w() && p.x() == q.x() && p.y() == q.y() && p.z() == q.z();
}

/// N2: the conjugate q* = (q₀, −q⃗); (pq)* = q* p*
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr quaternion<T> conj(const quaternion<T>& q) {
  return {q.w(), -q.x(), -q.y(), -q.z()};
}

/// The scalar product of p and q as vectors of R⁴.
template <class A, Promotable<A> B>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr promote_t<A, B> dot(const quaternion<A>& p,
                                                               const quaternion<B>& q) {
  return p.w() * q.w() + p.x() * q.x() + p.y() * q.y() + p.z() * q.z();
}

/// N3: the squared norm |q|² = q q*
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr T squared_norm(const quaternion<T>& q) {
  return dot(q, q);
}

} // namespace duet
