// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual/stumpff.hpp>
#include <duet/quaternion/exponential_jacobian.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/spline/blocks/products.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

/// \file
/// Derivatives of the rates of exp(x(t)) with respect to x(t), and of products of exponentials and
/// their rates with respect to their factors.

namespace duet::detail {

/// Derivatives of the half body rates of exp(x(t)) (`half_body_rates` over a real R): element
/// [k][m − 1] is ∂w_k/∂x_m for k < `Count` and m ≤ k + 1, where w_k and x_m are the Taylor
/// coefficients in t. With η = J(x) δx, the perturbation in body axes, δw = η̇ + 2 w × η. The last
/// element of `rates` is not used.
template <std::size_t Count, std::size_t Terms, class R>
[[nodiscard]] std::array<std::array<matrix3<R>, Count>, Count>
half_body_rate_gradients(const jacobian_coefficients<Terms, R>& jacobian, const vector3<R>& at,
                         const std::array<vector3<R>, Count>& rates) {
  static_assert(Count <= Terms);
  std::array<vector3<R>, Count> x;
  x[0] = at;
  std::copy_n(rates.begin(), Count - 1, x.begin() + 1);
  std::array<R, Count> s{};
  for (std::size_t m = 0; m < Count; ++m) {
    for (std::size_t k = 0; k <= m; ++k) {
      s[m] += dot(components(x[k]), components(x[m - k]));
    }
  }
  const auto a = composed(jacobian.a, s);
  const auto b = composed(jacobian.b, s);
  const auto c = composed(jacobian.c, s);
  std::array<matrix3<R>, Count> j; // of J(x) = a I − b x̂ + c x xᵀ
  for (std::size_t m = 0; m < Count; ++m) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        R sum(row == column ? a[m] : R(0));
        const int third = 3 - row - column;
        const int sign = row == column ? 0 : (row + 1) % 3 == column ? 1 : -1;
        for (std::size_t k = 0; k <= m; ++k) {
          if (sign != 0) {
            sum += sign * b[m - k] * x[k][third];
          }
          for (std::size_t l = 0; k + l <= m; ++l) {
            sum += c[m - k - l] * x[k][row] * x[l][column];
          }
        }
        j[m](row, column) = sum;
      }
    }
  }
  std::array<vector3<R>, Count> w;
  std::array<std::array<matrix3<R>, Count>, Count> result;
  for (std::size_t k = 0; k < Count; ++k) {
    w[k] = vector3<R>(R(0), R(0), R(0));
    for (std::size_t m = 1; m <= k + 1; ++m) {
      if (m < Count) {
        add_product(w[k], R(m), j[k + 1 - m], x[m]);
      }
      matrix3<R>& sum = result[k][m - 1];
      for (int column = 0; column < 3; ++column) {
        three_vector<R> total{R(0), R(0), R(0)};
        for (std::size_t i = 0; i + m <= k; ++i) {
          const matrix3<R>& of = j[k - m - i];
          total = total + cross(components(w[i]),
                                three_vector<R>{of(0, column), of(1, column), of(2, column)});
        }
        const R sums[3] = {total.x, total.y, total.z};
        for (int row = 0; row < 3; ++row) {
          sum(row, column) = R(k + 1) * j[k + 1 - m](row, column) + 2 * sums[row];
        }
      }
    }
  }
  return result;
}

/// Derivatives of a vector with respect to three vectors.
template <class R>
using gradient_by_three = std::array<matrix3<R>, 3>;

/// Transposed rotation matrix of e = exp(v), and J(v).
template <class R>
struct rotation_factor {
  matrix3<R> back, jacobian;
  explicit rotation_factor(const vector3<R>& v) {
    const R s = dot(components(v), components(v));
    const auto [cosine, ratio] = first_stumpff_pair(s);
    // c_1(4s), 2c_2(4s) and 4c_3(4s) from those of s
    jacobian = axial_matrix<R>(cosine * ratio, -ratio * ratio, 4 * stumpff<3>(R(4 * s)), v);
    back = axial_matrix<R>(cosine * cosine - s * ratio * ratio, -2 * cosine * ratio,
                           2 * ratio * ratio, v);
  }
};

/// Derivatives of −P* δP with respect to ω_0, ω_1 and ω_2 for the product P = e_1 e_2 …, e = exp(b
/// ω_j) for each factor (j, b). Each factor rotates the derivatives back and adds b J(b ω_j) δω_j.
template <class R, std::size_t Factors>
[[nodiscard]] gradient_by_three<R>
minus_product_gradient(const std::array<std::pair<std::size_t, R>, Factors>& factors,
                       const std::array<vector3<R>, 3>& omega) {
  gradient_by_three<R> by;
  by.fill(matrix3<R>::Zero());
  std::array<bool, 3> is_taken_in{};
  for (const auto& [j, b] : factors) {
    if (b != 0) {
      const rotation_factor<R> e(b * components(omega[j]));
      for (std::size_t k = 0; k < 3; ++k) {
        if (is_taken_in[k]) {
          by[k] = product(e.back, by[k]);
        }
      }
      is_taken_in[j] = true;
      add_multiple(by[j], R(-b), e.jacobian);
    }
  }
  return by;
}

/// Derivatives of e* (b_0 ω_0 + b_1 ω_1) e + b_2 ω_2, e = exp(ω_2), with respect to ω_0, ω_1 and
/// ω_2; or without e.
template <class R>
[[nodiscard]] gradient_by_three<R>
end_gradient(const std::array<R, 3>& b, const std::array<vector3<R>, 3>& omega, bool is_rotated) {
  gradient_by_three<R> by;
  by.fill(matrix3<R>::Zero());
  for (std::size_t j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      by[j](i, i) = b[j];
    }
  }
  if (is_rotated) { // ŵ = e* w e changes by 2 ŵ × J δω_2
    const rotation_factor<R> e(omega[2]);
    vector3<R> twice_rate = vector3<R>::Zero();
    for (std::size_t j = 0; j < 2; ++j) {
      by[j] = product(e.back, by[j]);
      add_product(twice_rate, R(2), by[j], omega[j]);
    }
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3, other = (k + 2) % 3;
      for (int i = 0; i < 3; ++i) {
        by[2](k, i) +=
            twice_rate[next] * e.jacobian(other, i) - twice_rate[other] * e.jacobian(next, i);
      }
    }
  }
  return by;
}

} // namespace duet::detail
