// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "accuracy/jet.hpp"

namespace duet_test::accuracy {

const jet_shape* jet_shape::current = nullptr;

jet_shape::jet_shape(const std::vector<std::array<int, 2>>& powers, bool has_u) {
  for (const auto& [u, e] : {std::array{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
    if (u == 1 && !has_u) {
      continue;
    }
    for (const auto& [t, s] : powers) {
      monomials.push_back({t, s, u, e});
    }
  }
  for (std::size_t i = 0; i < monomials.size(); ++i) {
    for (std::size_t j = 0; j < monomials.size(); ++j) {
      monomial product;
      for (std::size_t n = 0; n < 4; ++n) {
        product[n] = monomials[i][n] + monomials[j][n];
      }
      const std::size_t k = find(product);
      if (k < monomials.size()) {
        products.push_back({i, j, k});
        degree = std::max(degree, product[0] + product[1] + product[2] + product[3]);
      }
    }
  }
}

std::size_t jet_shape::find(const monomial& m) const {
  return std::size_t(std::find(monomials.begin(), monomials.end(), m) - monomials.begin());
}

jet_shape jet_shape::line() { return jet_shape({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}}); }
jet_shape jet_shape::curve() {
  return jet_shape({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}}, false);
}
jet_shape jet_shape::plane() { return jet_shape({{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}); }

jet::jet(const real& constant) : c(jet_shape::current->monomials.size(), real(0)) {
  c[0] = constant;
}

jet operator+(const jet& a, const jet& b) {
  jet r = a;
  for (std::size_t i = 0; i < r.c.size(); ++i) {
    r.c[i] += b.c[i];
  }
  return r;
}
jet operator-(const jet& a) {
  jet r = a;
  for (real& x : r.c) {
    x = -x;
  }
  return r;
}
jet operator-(const jet& a, const jet& b) { return a + -b; }
jet operator*(const jet& a, const jet& b) {
  jet r;
  for (const auto& [i, j, k] : jet_shape::current->products) {
    if (a.c[i] != 0 && b.c[j] != 0) {
      r.c[k] += a.c[i] * b.c[j];
    }
  }
  return r;
}

namespace {

/// Σ f[k] n^k, n the infinitesimal part of x.
jet composed(const std::vector<real>& f, const jet& x) {
  jet n = x;
  n.c[0] = 0;
  jet r(f.back());
  for (std::size_t k = f.size() - 1; k-- > 0;) {
    r = r * n;
    r.c[0] += f[k];
  }
  return r;
}

std::vector<real> coefficients() {
  return std::vector<real>(std::size_t(jet_shape::current->degree) + 1);
}

/// The Taylor coefficients at x of Σ a_m x^m, where a_m/a_{m−1} = ratio(m), summed until the sum
/// no longer changes.
template <class Ratio>
std::vector<real> of_power_series(const real& x, real a, const Ratio& ratio) {
  auto f = coefficients();
  std::vector<real> powers(f.size(), real(0)); // binom(m, k) x^(m−k)
  powers[0] = 1;
  for (int m = 0; m < 2000; ++m) {
    bool changes = m < int(f.size());
    for (std::size_t k = 0; k < f.size(); ++k) {
      const real term = a * powers[k];
      changes = changes || abs(term) > real("1e-110") * abs(f[k]);
      f[k] += term;
    }
    if (!changes) {
      return f;
    }
    for (std::size_t k = f.size(); k-- > 0;) { // binom(m + 1, k) = binom(m, k) + binom(m, k − 1)
      powers[k] = powers[k] * x + (k > 0 ? powers[k - 1] : real(0));
    }
    a *= ratio(m + 1);
  }
  return f;
}

} // namespace

jet operator/(const jet& a, const jet& b) {
  auto f = coefficients();
  real power = 1 / b.c[0];
  for (real& x : f) {
    x = power;
    power *= -1 / b.c[0];
  }
  return a * composed(f, b);
}

jet sqrt(const jet& x) {
  auto f = coefficients();
  real term = sqrt(x.c[0]);
  for (std::size_t k = 0; k < f.size(); ++k) {
    f[k] = term;
    term *= (real(1) / 2 - int(k)) / (int(k) + 1) / x.c[0];
  }
  return composed(f, x);
}

jet exp(const jet& x) {
  auto f = coefficients();
  real term = exp(x.c[0]);
  for (std::size_t k = 0; k < f.size(); ++k) {
    f[k] = term;
    term /= int(k) + 1;
  }
  return composed(f, x);
}

jet log(const jet& x) {
  auto f = coefficients();
  f[0] = log(x.c[0]);
  real power = -1;
  for (std::size_t k = 1; k < f.size(); ++k) {
    power *= -1 / x.c[0];
    f[k] = power / int(k);
  }
  return composed(f, x);
}

namespace {

jet from_sine_and_cosine(const jet& x, const real& value, const real& slope) {
  auto f = coefficients();
  real factorial = 1;
  for (std::size_t k = 0; k < f.size(); ++k) {
    f[k] = (k % 2 == 0 ? value : slope) * (k % 4 < 2 ? 1 : -1) / factorial;
    factorial *= int(k) + 1;
  }
  return composed(f, x);
}

} // namespace

jet sin(const jet& x) { return from_sine_and_cosine(x, sin(x.c[0]), cos(x.c[0])); }
jet cos(const jet& x) { return from_sine_and_cosine(x, cos(x.c[0]), -sin(x.c[0])); }

jet atan2(const jet& y, const jet& x) {
  // The imaginary part of log(1 + u) with 1 + u = (x + iy)/(x₀ + iy₀), u infinitesimal.
  const real square = x.c[0] * x.c[0] + y.c[0] * y.c[0];
  const jet x0(x.c[0] / square), y0(y.c[0] / square);
  jet u = x * x0 + y * y0, v = y * x0 - x * y0;
  u.c[0] = 0;
  v.c[0] = 0;
  jet power_u = u, power_v = v, sum(atan2(y.c[0], x.c[0]));
  for (int k = 1; k <= jet_shape::current->degree; ++k) {
    sum = sum + power_v * jet(real(k % 2 == 0 ? -1 : 1) / k);
    const jet next = power_u * u - power_v * v;
    power_v = power_u * v + power_v * u;
    power_u = next;
  }
  return sum;
}

jet even_series(const jet& s, int n) {
  real first = 1;
  for (int i = 2; i <= n; ++i) {
    first /= i;
  }
  return composed(
      of_power_series(s.c[0], first,
                      [&](int m) { return real(-1) / ((2 * m + n) * (2 * m + n - 1)); }),
      s);
}

jet angle_over_root(const jet& s, const jet& w) {
  if (w.c[0] > 0 && s.c[0] < w.c[0] * w.c[0] / 100) { // Σ (−z)^k/(2k + 1)
    const jet z = s / (w * w);
    return composed(
               of_power_series(z.c[0], 1, [](int m) { return real(-(2 * m - 1)) / (2 * m + 1); }),
               z) /
           w;
  }
  const jet root = sqrt(s);
  return atan2(root, w) / root;
}

namespace {

/// Coefficients of the monomials that, times t^i s^j ε^k, are monomials of the result.
jet shifted(const jet& a, const jet_shape::monomial& by) {
  jet r;
  for (std::size_t n = 0; n < r.c.size(); ++n) {
    auto m = jet_shape::current->monomials[n];
    for (std::size_t k = 0; k < 4; ++k) {
      m[k] += by[k];
    }
    const std::size_t from = jet_shape::current->find(m);
    r.c[n] = from < a.c.size() ? a.c[from] : real(0);
  }
  return r;
}

jet variable(const jet_shape::monomial& m) {
  jet r;
  r.c[jet_shape::current->find(m)] = 1;
  return r;
}
jet epsilon() { return variable({0, 0, 0, 1}); }

} // namespace

jet with_epsilon(const jet& a, const jet& b) { return a + epsilon() * b; }
jet without_epsilon(const jet& a) { return a - epsilon() * epsilon_part(a); }
jet epsilon_part(const jet& a) { return shifted(a, {0, 0, 0, 1}); }
jet u_variable() { return variable({0, 0, 1, 0}); }
jet coefficient_of_u(const jet& a) { return shifted(a, {0, 0, 1, 0}); }
jet t_variable() { return variable({1, 0, 0, 0}); }
jet derivative(const jet& a) {
  jet r = shifted(a, {1, 0, 0, 0});
  for (std::size_t n = 0; n < r.c.size(); ++n) {
    r.c[n] *= jet_shape::current->monomials[n][0] + 1;
  }
  return r;
}

jet_quaternion operator*(const jet_quaternion& p, const jet_quaternion& q) {
  // Product by the table of i, j, k.
  constexpr std::size_t unit[4][4] = {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}};
  constexpr int sign[4][4] = {{1, 1, 1, 1}, {1, -1, 1, -1}, {1, -1, -1, 1}, {1, 1, -1, -1}};
  jet_quaternion r;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      jet& sum = r[unit[i][j]];
      sum = sign[i][j] > 0 ? sum + p[i] * q[j] : sum - p[i] * q[j];
    }
  }
  return r;
}
jet_quaternion operator*(const jet_quaternion& p, const jet& factor) {
  return {p[0] * factor, p[1] * factor, p[2] * factor, p[3] * factor};
}
jet_quaternion conj(const jet_quaternion& q) { return {q[0], -q[1], -q[2], -q[3]}; }
jet squared_norm(const jet_quaternion& q) {
  return q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
}

jet_quaternion exp(const jet_quaternion& q) {
  const jet s = q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  jet_quaternion r = q * even_series(s, 1);
  r[0] = even_series(s, 0);
  return r * exp(q[0]);
}
jet_quaternion log(const jet_quaternion& q) {
  const jet s = q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  jet_quaternion r = q * angle_over_root(s, q[0]);
  r[0] = log(squared_norm(q)) * jet(real(1) / 2);
  return r;
}
jet_quaternion slerp(const jet_quaternion& a, const jet_quaternion& b, const jet& tau) {
  jet_quaternion half_arc = log(conj(a) * b);
  half_arc[0] = jet(0);
  return a * exp(half_arc * tau);
}

} // namespace duet_test::accuracy
