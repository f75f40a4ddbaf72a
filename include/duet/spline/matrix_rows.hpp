// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/batch.hpp>
#include <duet/core/config.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <concepts>

/// \file
/// 3 × 3 matrices by rows, each in the lanes of one vector: v̂ M is `cross(v, M)`, so that products
/// with skew matrices, numbers and sums take all columns in one step. Over dual numbers of rigid
/// motion A + εB, the matrix of columns [v; ω] is [A B; 0 A].

namespace duet::detail {
DUET_ABI_BEGIN

/// Numbers of which vectors of the target hold some.
template <class R>
concept LaneReal = std::same_as<R, double> || std::same_as<R, float>;

/// Row of a 3 × 3 matrix.
template <class T>
struct matrix_row {
  T x, y, z;

  [[nodiscard]] static matrix_row of(const T& x, const T& y, const T& z) { return {x, y, z}; }
  [[nodiscard]] T operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
  [[nodiscard]] friend matrix_row operator+(const matrix_row& a, const matrix_row& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  [[nodiscard]] friend matrix_row operator-(const matrix_row& a, const matrix_row& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  [[nodiscard]] friend matrix_row operator*(const T& s, const matrix_row& a) {
    return {s * a.x, s * a.y, s * a.z};
  }
};

/// Three numbers in the lanes of a batch, the last of which is zero.
template <LaneReal R>
[[nodiscard]] DUET_ALWAYS_INLINE batch<R, 4> three_lanes(R x, R y, R z) {
  return batch<R, 4>::from_lanes([&](int i) DUET_INLINE_LAMBDA {
    return i == 0 ? x : i == 1 ? y : i == 2 ? z : R(0);
  });
}

/// The last lane is not used.
template <LaneReal R>
struct matrix_row<R> {
  batch<R, 4> a;

  [[nodiscard]] DUET_ALWAYS_INLINE static matrix_row of(R x, R y, R z) {
    return {three_lanes<R>(x, y, z)};
  }
  [[nodiscard]] DUET_ALWAYS_INLINE R operator[](int i) const { return a[i]; }
  [[nodiscard]] friend DUET_ALWAYS_INLINE matrix_row operator+(const matrix_row& x,
                                                               const matrix_row& y) {
    return {x.a + y.a};
  }
  [[nodiscard]] friend DUET_ALWAYS_INLINE matrix_row operator-(const matrix_row& x,
                                                               const matrix_row& y) {
    return {x.a - y.a};
  }
  [[nodiscard]] friend DUET_ALWAYS_INLINE matrix_row operator*(R s, const matrix_row& x) {
    return {s * x.a};
  }
};

template <LaneReal R>
struct matrix_row<screw_dual<R>> {
  using T = screw_dual<R>;
  batch<R, 4> a, b; ///< a + εb

  [[nodiscard]] DUET_ALWAYS_INLINE static matrix_row of(const T& x, const T& y, const T& z) {
    return {three_lanes<R>(x.value(), y.value(), z.value()),
            three_lanes<R>(x.epsilon(), y.epsilon(), z.epsilon())};
  }
  [[nodiscard]] DUET_ALWAYS_INLINE T operator[](int i) const { return {a[i], b[i]}; }
  [[nodiscard]] friend DUET_ALWAYS_INLINE matrix_row operator+(const matrix_row& x,
                                                               const matrix_row& y) {
    return {x.a + y.a, x.b + y.b};
  }
  [[nodiscard]] friend DUET_ALWAYS_INLINE matrix_row operator-(const matrix_row& x,
                                                               const matrix_row& y) {
    return {x.a - y.a, x.b - y.b};
  }
  [[nodiscard]] friend DUET_ALWAYS_INLINE matrix_row operator*(const T& s, const matrix_row& x) {
    return {s.value() * x.a, s.value() * x.b + s.epsilon() * x.a};
  }
  [[nodiscard]] friend DUET_ALWAYS_INLINE matrix_row operator*(R s, const matrix_row& x) {
    return {s * x.a, s * x.b};
  }
};

/// A of a row A + εB, and the row εA.
template <class S>
[[nodiscard]] DUET_ALWAYS_INLINE matrix_row<S> value_of(const matrix_row<screw_dual<S>>& row) {
  if constexpr (LaneReal<S>) {
    return {row.a};
  } else {
    return {row.x.value(), row.y.value(), row.z.value()};
  }
}
template <class S>
[[nodiscard]] DUET_ALWAYS_INLINE matrix_row<screw_dual<S>>
value_to_epsilon(const matrix_row<screw_dual<S>>& row) {
  const S zero(0);
  if constexpr (LaneReal<S>) {
    return {zero * row.a, row.a};
  } else {
    const auto moved = [&](const screw_dual<S>& x) { return screw_dual<S>(zero, x.value()); };
    return {moved(row.x), moved(row.y), moved(row.z)};
  }
}

/// 3 × 3 matrix.
template <class T>
using matrix_rows = three_vector<matrix_row<T>>;

template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE matrix_row<T> row_of(const three_vector<T>& v) {
  return matrix_row<T>::of(v.x, v.y, v.z);
}

/// s I.
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE matrix_rows<T> diagonal_rows(const T& s) {
  const T zero(0);
  return {matrix_row<T>::of(s, zero, zero), matrix_row<T>::of(zero, s, zero),
          matrix_row<T>::of(zero, zero, s)};
}
/// v̂, the matrix of v ×.
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE matrix_rows<T> skew_rows(const three_vector<T>& v) {
  const T zero(0);
  return {matrix_row<T>::of(zero, T(-v.z), v.y), matrix_row<T>::of(v.z, zero, T(-v.x)),
          matrix_row<T>::of(T(-v.y), v.x, zero)};
}

/// s M.
template <class S, class T>
[[nodiscard]] DUET_ALWAYS_INLINE matrix_rows<T> scaled(const S& s, const matrix_rows<T>& m) {
  return {s * m.x, s * m.y, s * m.z};
}
/// −M.
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE matrix_rows<T> negated(const matrix_rows<T>& m) {
  return scaled(real_type_t<T>(-1), m);
}
/// −v̂ M.
template <class V, class T>
[[nodiscard]] DUET_ALWAYS_INLINE matrix_rows<T> minus_cross(const three_vector<V>& v,
                                                            const matrix_rows<T>& m) {
  return {v.z * m.y - v.y * m.z, v.x * m.z - v.z * m.x, v.y * m.x - v.x * m.y};
}
/// v wᵀ.
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE matrix_rows<T> outer_product(const three_vector<T>& v,
                                                              const matrix_row<T>& w) {
  return {v.x * w, v.y * w, v.z * w};
}
/// A M.
template <class S, class T>
[[nodiscard]] DUET_ALWAYS_INLINE matrix_rows<T> rows_product(const matrix_rows<S>& a,
                                                             const matrix_rows<T>& m) {
  const auto row = [&](const matrix_row<S>& r)
                       DUET_INLINE_LAMBDA { return r[0] * m.x + r[1] * m.y + r[2] * m.z; };
  return {row(a.x), row(a.y), row(a.z)};
}

template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE matrix_rows<T> rows_of(const matrix3<T>& m) {
  return {matrix_row<T>::of(m(0, 0), m(0, 1), m(0, 2)),
          matrix_row<T>::of(m(1, 0), m(1, 1), m(1, 2)),
          matrix_row<T>::of(m(2, 0), m(2, 1), m(2, 2))};
}
/// Ad(q), the matrix of v ↦ q v q*.
template <class T>
[[nodiscard]] matrix_rows<T> adjoint_rows(const quaternion<T>& q) {
  return rows_of(rotation_matrix(q));
}

/// The rows as a matrix of Eigen.
template <class T>
[[nodiscard]] matrix3<T> matrix_of(const matrix_rows<T>& m) {
  matrix3<T> result;
  for (int j = 0; j < 3; ++j) {
    result(0, j) = m.x[j];
    result(1, j) = m.y[j];
    result(2, j) = m.z[j];
  }
  return result;
}

DUET_ABI_END
} // namespace duet::detail
