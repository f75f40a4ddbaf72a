// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "support/multiprecision.hpp"
#include "support/ulp.hpp"

#include <duet/quaternion/quaternion.hpp>

#include <array>
#include <cstddef>

/// \file
/// Quaternion functions in 100 digits by sine, cosine and arctangent, and their derivatives by
/// differences: nothing here shares code or formulas with the library.

namespace duet_test::reference {

using real = real_100;
/// w, x, y, z
using four = std::array<real, 4>;

template <class T>
[[nodiscard]] four wide(const duet::quaternion<T>& q) {
  return {real(q.w()), real(q.x()), real(q.y()), real(q.z())};
}

[[nodiscard]] inline four sum(const four& a, const four& b, const real& factor = 1) {
  four r;
  for (std::size_t i = 0; i < 4; ++i) {
    r[i] = a[i] + factor * b[i];
  }
  return r;
}
[[nodiscard]] inline four times(const four& a, const real& factor) {
  return {a[0] * factor, a[1] * factor, a[2] * factor, a[3] * factor};
}
[[nodiscard]] inline real length(const four& a) {
  return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2] + a[3] * a[3]);
}
[[nodiscard]] inline four conj(const four& a) { return {a[0], -a[1], -a[2], -a[3]}; }

/// Product by the table of i, j, k.
[[nodiscard]] inline four product(const four& p, const four& q) {
  constexpr int unit[4][4] = {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}};
  constexpr int sign[4][4] = {{1, 1, 1, 1}, {1, -1, 1, -1}, {1, -1, -1, 1}, {1, 1, -1, -1}};
  four r{0, 0, 0, 0};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      r[std::size_t(unit[i][j])] += sign[i][j] * p[i] * q[j];
    }
  }
  return r;
}

/// The direction of the vector part; arbitrary if that vanishes.
[[nodiscard]] inline four axis(const four& q) {
  const four v{0, q[1], q[2], q[3]};
  const real s = length(v);
  return s == 0 ? four{0, 1, 0, 0} : times(v, 1 / s);
}

[[nodiscard]] inline four exp(const four& q) {
  const real angle = length(four{0, q[1], q[2], q[3]});
  four r = times(axis(q), sin(angle));
  r[0] = cos(angle);
  return times(r, boost::multiprecision::exp(q[0]));
}

[[nodiscard]] inline four log(const four& q) {
  four r = times(axis(q), atan2(length(four{0, q[1], q[2], q[3]}), q[0]));
  r[0] = boost::multiprecision::log(length(q));
  return r;
}

/// |q|^ρ (cos ρφ + û sin ρφ)
[[nodiscard]] inline four pow(const four& q, const real& rho) {
  const real angle = rho * atan2(length(four{0, q[1], q[2], q[3]}), q[0]);
  four r = times(axis(q), sin(angle));
  r[0] = cos(angle);
  return times(r, boost::multiprecision::pow(length(q), rho));
}

/// a (a* b)^τ with a* b made a unit, the sign of b as it is.
[[nodiscard]] inline four slerp(const four& a, const four& b, const real& tau) {
  const four relative = product(conj(a), b);
  return product(a, pow(times(relative, 1 / length(relative)), tau));
}

/// The k-th derivative of f(t) at t = 0 by a central difference, relative error about 1e-60 for
/// k = 1, 1e-30 for k = 4. `smooth` is the radius in which f is smooth.
template <class F>
[[nodiscard]] four difference(F&& f, int k, const real& smooth = 1) {
  const real h = smooth * boost::multiprecision::pow(real(10), -90 / (k + 2));
  four total{0, 0, 0, 0};
  real binomial = 1;
  for (int i = 0; i <= k; ++i) {
    total = sum(total, f(real(h * (real(k) / 2 - i))), i % 2 == 0 ? binomial : real(-binomial));
    binomial = binomial * (k - i) / (i + 1);
  }
  return times(total, 1 / boost::multiprecision::pow(h, k));
}

/// Change of the derivative along d if each component of x changes by its own size: ‖f″‖‖x‖, or
/// less if components of x are small.
template <class F>
[[nodiscard]] real change_of_derivative(F&& f, const four& x, const four& d, const real& smooth) {
  const real h = smooth * real("1e-30");
  const four at_x = f(x);
  const four at_shifted = f(sum(x, d, h));
  real squares = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    four e{0, 0, 0, 0};
    e[i] = h;
    const four second =
        sum(sum(f(sum(sum(x, d, h), e)), f(sum(x, e)), -1), sum(at_shifted, at_x, -1), -1);
    squares += boost::multiprecision::pow(length(second) * x[i], 2);
  }
  return sqrt(squares) / (h * h);
}

/// Change of the value, as `change_of_derivative`.
template <class F>
[[nodiscard]] real change_of_value(F&& f, const four& x, const real& smooth) {
  const real h = smooth * real("1e-40");
  const four at_x = f(x);
  real squares = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    four e{0, 0, 0, 0};
    e[i] = h;
    squares += boost::multiprecision::pow(length(sum(f(sum(x, e)), at_x, -1)) * x[i], 2);
  }
  return sqrt(squares) / h;
}

/// ‖computed − exact‖ in ulps of Real on the given scale.
template <class T>
[[nodiscard]] double ulps(const duet::quaternion<T>& computed, const four& exact,
                          const real& scale) {
  const four c = wide(computed);
  if (!(c[0] == c[0] && c[1] == c[1] && c[2] == c[2] && c[3] == c[3])) {
    return std::numeric_limits<double>::infinity();
  }
  return ulps_of_error<T>(length(sum(c, exact, -1)), scale);
}

} // namespace duet_test::reference
