// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

/// \file
/// Independent implementation of the algebra, written out component by component from the
/// definitions, for closed forms that share no code with duet.

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

/// sin θ/θ and cos θ of s = θ², and their derivatives with respect to s.
template <class T>
struct arc {
  T c, s, dc, ds;
  explicit arc(const T& square) {
    using std::cos, std::sin, std::sqrt;
    if (square < T(1e-12)) {
      // For smaller s the closed forms cancel; these sums are exact to 60 digits.
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
  v3<T> axis, daxis; ///< zero if there is no axis
  T length;          ///< norm of the vector part
  polar(const q4<T>& q, const q4<T>& dq) {
    using std::atan2, std::sqrt;
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

/// N19, A (A* B)^τ of the displacements (a, ta) and (b, tb), through the axis of the screw, and its
/// derivative with respect to τ.
template <class T>
struct screw_displacement {
  q4<T> alpha, dalpha;
  v3<T> position, dposition;
  screw_displacement(const q4<T>& a, const v3<T>& ta, q4<T> b, const v3<T>& tb, const T& tau,
                     const T& dtau) {
    using std::atan2, std::cos, std::sin, std::sqrt;
    if (dot(a, b) < 0) {
      b = times(T(-1), b);
    }
    // The displacement from A to B in axes of A: a rotation `rel`, a translation t.
    const q4<T> rel = product(conj(a), b);
    const v3<T> t = vec(product(product(conj(a), pure(plus(tb, times(T(-1), ta)))), a));
    const T length = sqrt(dot(vec(rel), vec(rel)));
    const T half = atan2(length, rel[0]);
    q4<T> q{T(1), T(0), T(0), T(0)}, dq{};
    v3<T> s = times(tau, t), ds = times(dtau, t);
    if (length > T(1e-20)) { // for smaller rotations the axis is too far away for 50 digits
      const v3<T> n = times(T(1 / length), vec(rel));
      const T along = dot(n, t);
      // The point of the axis nearest to the origin: ½(t⊥ + cot(φ/2) n × t).
      const v3<T> near =
          times(T(0.5), plus(plus(t, times(T(-along), n)), times(T(rel[0] / length), cross(n, t))));
      const T c = cos(T(half * tau)), h = sin(T(half * tau)), speed = half * dtau;
      q = {c, T(h * n[0]), T(h * n[1]), T(h * n[2])};
      dq = {T(-h * speed), T(c * speed * n[0]), T(c * speed * n[1]), T(c * speed * n[2])};
      const v3<T> moved = vec(product(product(q, pure(near)), conj(q)));
      s = plus(plus(near, times(T(-1), moved)), times(T(along * tau), n));
      ds = plus(times(T(-2 * speed), cross(n, moved)), times(T(along * dtau), n));
    }
    // A times the screw motion.
    alpha = product(a, q);
    dalpha = product(a, dq);
    position = plus(ta, vec(product(product(a, pure(s)), conj(a))));
    dposition = vec(product(product(a, pure(ds)), conj(a)));
  }
};

} // namespace by_hand
