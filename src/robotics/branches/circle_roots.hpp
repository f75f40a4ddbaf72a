// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

/// \file
/// Zeros of real trigonometric polynomials, including complex ones.

namespace duet::detail {
DUET_ABI_BEGIN

/// Zeros z = e^{iθ} of f(θ) = Σ d_k e^{ikθ}, k = −n … n, d_−k = d̄_k.
///
/// \tparam Degree  n
template <int Degree>
class circle_roots {
public:
  static constexpr int samples = 2 * Degree + 1, count = 2 * Degree;
  using values = std::array<double, std::size_t(samples)>;
  using half_of_coefficients = std::array<std::complex<double>, std::size_t(Degree + 1)>;

  /// Angle of the k-th value of f that `interpolated` requires.
  [[nodiscard]] static double angle(int k) { return 2 * std::numbers::pi * k / samples; }

  /// Coefficients d_0 … d_n of the f with given values at the angles `angle(k)`.
  [[nodiscard]] static half_of_coefficients interpolated(const values& f) {
    static const auto turns = [] {
      std::array<std::complex<double>, std::size_t(samples)> result;
      for (int k = 0; k < samples; ++k) {
        result[std::size_t(k)] = std::polar(1 / double(samples), -angle(k));
      }
      return result;
    }();
    half_of_coefficients result;
    for (int k = 0; k <= Degree; ++k) {
      std::complex<double> sum = 0;
      for (int j = 0; j < samples; ++j) {
        sum += f[std::size_t(j)] * turns[std::size_t(k * j % samples)];
      }
      result[std::size_t(k)] = sum;
    }
    return result;
  }

  /// Finds the zeros.
  ///
  /// \param d  coefficients d_0 … d_n
  explicit circle_roots(const half_of_coefficients& d) {
    double largest = 0;
    for (const auto& x : d) {
      largest = std::max(largest, std::abs(x));
    }
    for (int k = 0; k <= Degree; ++k) {
      const std::complex<double> x = largest > 0 ? d[std::size_t(k)] / largest : 0;
      coefficients_[std::size_t(Degree + k)] = x;
      coefficients_[std::size_t(Degree - k)] = std::conj(x);
    }
    find();
  }

  [[nodiscard]] std::complex<double> operator[](int i) const { return {x_[i], y_[i]}; }
  /// Displacement of the i-th zero by errors of the coefficients, per unit of
  /// the largest coefficient.
  [[nodiscard]] double sensitivity(int i) const { return sensitivity_[i]; }

private:
  using lanes = Eigen::Array<double, count, 1>;

  /// Finds all zeros simultaneously by the Ehrlich–Aberth method, Newton's method with the other
  /// zeros divided out: z_i moves by −1/(f′/f − Σ_{j≠i} 1/(z_i − z_j)).
  void find() {
    for (int i = 0; i < count; ++i) {
      const auto z = std::polar(i % 2 == 0 ? 1.1 : .9, 2 * std::numbers::pi * (i + .3) / count);
      x_[i] = z.real();
      y_[i] = z.imag();
    }
    for (int k = 0; k < 50; ++k) {
      if (step() < 1e-13) {
        break;
      }
    }
  }

  double step() {
    lanes px = lanes::Constant(coefficients_[count].real()), py, qx = lanes::Zero(), qy = qx;
    py.setConstant(coefficients_[count].imag());
    for (int k = count; k-- > 0;) {
      const auto& d = coefficients_[std::size_t(k)];
      const lanes rx = qx * x_ - qy * y_ + px;
      qy = qx * y_ + qy * x_ + py;
      qx = rx;
      const lanes sx = px * x_ - py * y_ + d.real();
      py = px * y_ + py * x_ + d.imag();
      px = sx;
    }
    const lanes p = px.square() + py.square(), q = qx.square() + qy.square();
    const lanes size = (x_.square() + y_.square()).sqrt();
    sensitivity_ = 1 / q.sqrt();
    lanes sum_x = lanes::Zero(), sum_y = sum_x;
    for (int j = 0; j < count; ++j) {
      const lanes dx = x_ - x_[j], dy = y_ - y_[j];
      lanes square = dx.square() + dy.square();
      square[j] = 1; // not 0, as dx = dy = 0
      sum_x += dx / square;
      sum_y -= dy / square;
    }
    // 1/(q/p − sum) = p / (q − p sum)
    const lanes nx = qx - (px * sum_x - py * sum_y), ny = qy - (px * sum_y + py * sum_x);
    const lanes n = nx.square() + ny.square();
    double largest = 0;
    for (int i = 0; i < count; ++i) {
      const double wx = (px[i] * nx[i] + py[i] * ny[i]) / n[i];
      const double wy = (py[i] * nx[i] - px[i] * ny[i]) / n[i];
      // Zeros far from the circle, or at infinity if the degree is lower, are ignored.
      const bool is_far = size[i] > 1e4 || size[i] < 1e-4;
      if (is_far || !(p[i] > 0) || !(wx * wx + wy * wy < 1e12)) {
        continue;
      }
      x_[i] -= wx;
      y_[i] -= wy;
      const bool is_near = size[i] < 3 && size[i] > .3; // others need less accuracy
      largest =
          std::max(largest, (is_near ? 1 : 1e-12) * (wx * wx + wy * wy) / (size[i] * size[i]));
    }
    return std::sqrt(largest);
  }

  std::array<std::complex<double>, std::size_t(samples)> coefficients_{};
  lanes x_, y_, sensitivity_;
};

DUET_ABI_END
} // namespace duet::detail
