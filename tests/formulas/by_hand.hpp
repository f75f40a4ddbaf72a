// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

/// \file
/// The algebra once more, written out component by component from the definitions, for closed forms
/// that share no code with duet.

namespace by_hand {

template <class T>
using v3 = std::array<T, 3>;
template <class T>
using q4 = std::array<T, 4>;

/// N components from x[first] on.
template <std::size_t N, class T>
std::array<T, N> part(const std::vector<T>& x, std::size_t first) {
  std::array<T, N> result;
  for (std::size_t i = 0; i < N; ++i) {
    result[i] = x[first + i];
  }
  return result;
}

/// The components of all in a row.
template <class T, class... A>
std::vector<T> row(const A&... a) {
  std::vector<T> result;
  (result.insert(result.end(), a.begin(), a.end()), ...);
  return result;
}

template <class T, std::size_t N>
std::array<T, N> plus(const std::array<T, N>& a, const std::array<T, N>& b) {
  std::array<T, N> r;
  for (std::size_t i = 0; i < N; ++i) {
    r[i] = a[i] + b[i];
  }
  return r;
}
template <class T, std::size_t N>
std::array<T, N> times(const T& s, const std::array<T, N>& a) {
  std::array<T, N> r;
  for (std::size_t i = 0; i < N; ++i) {
    r[i] = s * a[i];
  }
  return r;
}
template <class T, std::size_t N>
T dot(const std::array<T, N>& a, const std::array<T, N>& b) {
  T sum(0);
  for (std::size_t i = 0; i < N; ++i) {
    sum += a[i] * b[i];
  }
  return sum;
}
template <class T>
v3<T> cross(const v3<T>& a, const v3<T>& b) {
  return {T(a[1] * b[2] - a[2] * b[1]), T(a[2] * b[0] - a[0] * b[2]), T(a[0] * b[1] - a[1] * b[0])};
}
template <class T>
q4<T> product(const q4<T>& p, const q4<T>& q) {
  return {T(p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3]),
          T(p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2]),
          T(p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1]),
          T(p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0])};
}
template <class T>
q4<T> conj(const q4<T>& q) {
  return {q[0], T(-q[1]), T(-q[2]), T(-q[3])};
}
template <class T>
q4<T> pure(const v3<T>& v) {
  return {T(0), v[0], v[1], v[2]};
}
template <class T>
v3<T> vec(const q4<T>& q) {
  return {q[1], q[2], q[3]};
}

/// sin θ/θ and cos θ of s = θ², and their derivatives by s.
template <class T>
struct arc {
  T c, s, dc, ds;
  explicit arc(const T& square) {
    using std::cos;
    using std::sin;
    using std::sqrt;
    if (square < T(1e-12)) {
      // Below, the closed forms lose the leading digits; these sums have 60 of them.
      c = s = dc = ds = T(0);
      T term(1); // (−s)^k / (2k)!
      T before(0);
      for (int k = 0; k < 6; ++k) {
        c += term;
        s += term / T(2 * k + 1);
        if (k > 0) {
          dc -= before * T(k) / T((2 * k - 1) * (2 * k));
          ds -= before * T(k) / T((2 * k - 1) * (2 * k) * (2 * k + 1));
        }
        before = term;
        term = -term * square / T((2 * k + 1) * (2 * k + 2));
      }
    } else {
      const T root = sqrt(square);
      c = cos(root);
      s = sin(root) / root;
      dc = -s / 2;
      ds = (c - s) / (2 * square);
    }
  }
};

/// The unit quaternion of a rotation vector, and its derivative.
template <class T>
struct unit {
  q4<T> q, dq;
  unit(const v3<T>& r, const v3<T>& dr) {
    const v3<T> v = times(T(0.5), r);
    const v3<T> dv = times(T(0.5), dr);
    const arc<T> a(dot(v, v));
    const T ds = 2 * dot(v, dv);
    q = {a.c, T(a.s * v[0]), T(a.s * v[1]), T(a.s * v[2])};
    dq = {T(a.dc * ds), T(a.s * dv[0] + a.ds * ds * v[0]), T(a.s * dv[1] + a.ds * ds * v[1]),
          T(a.s * dv[2] + a.ds * ds * v[2])};
  }
};

/// q in polar form |q| e^{ûφ} (N4) and the rates of its parts.
template <class T>
struct polar {
  T size, angle, dsize, dangle;
  v3<T> axis, daxis; ///< zero where there is none
  T length;          ///< of the vector part
  polar(const q4<T>& q, const q4<T>& dq) {
    using std::atan2;
    using std::sqrt;
    const v3<T> v = vec(q);
    const v3<T> dv = vec(dq);
    length = sqrt(dot(v, v));
    size = sqrt(dot(q, q));
    dsize = dot(q, dq) / size;
    angle = atan2(length, q[0]);
    axis = daxis = {T(0), T(0), T(0)};
    T dlength(0);
    if (length > 0) {
      axis = times(T(1 / length), v);
      dlength = dot(axis, dv);
      daxis = times(T(1 / length), plus(dv, times(T(-dlength), axis)));
    }
    dangle = (q[0] * dlength - length * dq[0]) / (size * size);
  }
};

} // namespace by_hand
