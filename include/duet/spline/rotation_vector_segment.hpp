// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/quaternion/exponential_jacobian.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/spline/blocks/products.hpp>
#include <duet/spline/equations/rate_gradients.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>

/// \file
/// Segment of a rotation-vector spline, exp(x(t)) with a polynomial x of half-angle vectors from
/// zero to a given one, and the relations between its rates at both ends.

namespace duet::detail {

/// First `Count` Taylor coefficients of a polynomial about t, from those about zero. Constant term
/// first.
template <std::size_t Count, class T, std::size_t Size, class S>
[[nodiscard]] DUET_ALWAYS_INLINE auto taylor_shift(const std::array<vector3<T>, Size>& c,
                                                   const S& t) {
  static_assert(Count <= Size);
  using D = promote_t<T, S>;
  using R = real_type_t<D>;
  std::array<vector3<D>, Count> result;
  each_index<D, Count>([&](std::size_t m) DUET_INLINE_LAMBDA {
    // Σ_k binomial(k, m) c_k t^{k−m}, binomials as products of the quotients of neighbours
    three_vector<D> sum = components(c[Size - 1]);
    each_index<D, Size - 1>([&](std::size_t done) DUET_INLINE_LAMBDA {
      const std::size_t k = Size - 1 - done;
      if (k > m) {
        sum = D(t * (R(k) / R(k - m))) * sum + components(c[k - 1]);
      }
    });
    result[m] = sum;
  });
  return result;
}

/// Data of a segment that are constant while its rates are solved for: its length h in the
/// parameter and its end exp(d), d over the scalar T.
///
/// The rates at a knot are Taylor coefficients of w, Q′ = Q w: the halved angular velocity in body
/// axes, its derivative, half its second derivative … The polynomial of order k (degree k − 1)
/// takes k/2 − 1 of them at each end.
template <class T, int Order>
class rotation_vector_segment {
  static_assert(Order == 4 || Order == 6,
                "duet: a rotation_vector_spline is of order 4, the cubic, or 6, the quintic");

public:
  using real = real_type_t<T>;
  /// Number of rates given at each knot.
  static constexpr std::size_t rates_per_knot = std::size_t(Order) / 2 - 1;
  using knot_rates = std::array<vector3<T>, rates_per_knot>;
  using coefficients = std::array<vector3<T>, std::size_t(Order)>;

  rotation_vector_segment(const real& h, const vector3<T>& d)
      : h_(h), d_(d), at_end_(dot(components(d), components(d))),
        inverse_(right_jacobian_inverse((real(2) * components(d)).eigen())) {}

  /// Coefficients x_0 … x_{k−1} about the start, where x_0 = 0.
  [[nodiscard]] coefficients polynomial(const knot_rates& start, const knot_rates& end) const {
    coefficients x;
    x[0] = vector3<T>::Constant(T(real(0)));
    x[1] = start[0];
    const real per_h = 1 / h_;
    const vector3<T> v = times_inverse(end[0]); // ẋ at the end
    const vector3<T> mean = per_h * components(d_);
    // Deviations from straight continuation at the start's rates, in powers of h.
    if constexpr (Order == 4) {
      for (int i = 0; i < 3; ++i) {
        const T a = mean[i] - start[0][i];
        const T b = v[i] - start[0][i];
        x[2][i] = (3 * a - b) * per_h;
        x[3][i] = (b - 2 * a) * (per_h * per_h);
      }
    } else {
      const vector3<T> twice = second_at_end(end);
      for (int i = 0; i < 3; ++i) {
        const T& second = start[1][i];
        x[2][i] = second / 2;
        const T a = (mean[i] - start[0][i]) * per_h - x[2][i];
        const T b = (v[i] - start[0][i]) * per_h - second;
        const T c = (twice[i] - second) / 2;
        x[3][i] = (10 * a - 4 * b + c) * per_h;
        x[4][i] = (7 * b - 15 * a - 2 * c) * (per_h * per_h);
        x[5][i] = (6 * a - 3 * b + c) * (per_h * per_h * per_h);
      }
    }
    return x;
  }

  /// Coefficients of the cubic with given values and second derivatives ẍ at both ends. Velocities
  /// are not subtracted and divided by h, so that short segments lose no digits.
  [[nodiscard]] coefficients
  polynomial_of_accelerations(const std::array<vector3<T>, 2>& start,
                              const std::array<vector3<T>, 2>& end) const {
    static_assert(Order == 4);
    coefficients x;
    x[0] = vector3<T>::Constant(T(real(0)));
    const vector3<T> last = second_at_end(end);
    const real per_h = 1 / h_;
    for (int i = 0; i < 3; ++i) {
      const T& first = start[1][i];
      x[1][i] = d_[i] * per_h - (2 * first + last[i]) * (h_ / 6);
      x[2][i] = first / 2;
      x[3][i] = (last[i] - first) * (per_h / 6);
    }
    return x;
  }

  /// Taylor coefficients x_1 … x_Count at the start, or about the end, for the rates w_0 …
  /// w_{Count−1}.
  template <std::size_t Count>
  [[nodiscard]] std::array<vector3<T>, Count>
  taylor_at_start(const std::array<vector3<T>, Count>& w) const {
    return taylor_of_rates(at_start(), zero(), w, [](const vector3<T>& v) { return v; });
  }
  template <std::size_t Count>
  [[nodiscard]] std::array<vector3<T>, Count>
  taylor_at_end(const std::array<vector3<T>, Count>& w) const {
    return taylor_of_rates(at_end_, d_, w,
                           [this](const vector3<T>& v) { return times_inverse(v); });
  }

  /// Rates of the cubic at its start and its end: w_0, w_1 and, for `count` = 3, w_2.
  [[nodiscard]] std::array<std::array<vector3<T>, 3>, 2> rates(const coefficients& x,
                                                               std::size_t count) const {
    static_assert(Order == 4);
    const auto y = taylor_shift<4>(x, h_);
    std::array<std::array<vector3<T>, 3>, 2> w;
    w[0][0] = x[1];
    w[0][1] = real(2) * components(x[2]);
    if (count < 3) {
      w[1][0] = times_jacobian(y[1]);
      w[1][1] = components(times_jacobian_rate(y[1])) + real(2) * components(times_jacobian(y[2]));
    } else {
      w[0][2] = real(3) * components(x[3]) - cross(components(x[1]), components(x[2]));
      w[1] = rates_at_end<3>({y[1], y[2], y[3]});
    }
    return w;
  }

  /// Rates w_0 … w_{Count−1} at the start, or the end, from x_1 … x_Count about it.
  template <std::size_t Count>
  [[nodiscard]] std::array<vector3<T>, Count>
  rates_at_start(const std::array<vector3<T>, Count>& x) const {
    return half_body_rates(at_start(), zero(), x);
  }
  template <std::size_t Count>
  [[nodiscard]] std::array<vector3<T>, Count>
  rates_at_end(const std::array<vector3<T>, Count>& x) const {
    return half_body_rates(at_end_, d_, x);
  }

  /// Derivatives of w_0 … w_{Count−1} at one end with respect to x_1 … x_Count about it, see
  /// `half_body_rate_gradients`.
  template <std::size_t Count>
  [[nodiscard]] auto gradients_at_start(const std::array<vector3<T>, Count>& x) const {
    return half_body_rate_gradients(at_start(), zero(), x);
  }
  template <std::size_t Count>
  [[nodiscard]] auto gradients_at_end(const std::array<vector3<T>, Count>& x) const {
    return half_body_rate_gradients(at_end_, d_, x);
  }
  /// Inverse Jacobian J(d)⁻¹.
  [[nodiscard]] const matrix3<T>& inverse() const { return inverse_; }

  using rate_gradients = std::array<std::array<std::array<matrix3<T>, 2>, 3>, 2>;
  /// Derivatives of the cubic's rates: element [end][k][knot] is ∂w_k/∂w_0, w_k at its start (end
  /// 0) or its end (1), k < `count`, w_0 at its start (knot 0) or its end (1).
  [[nodiscard]] rate_gradients
  gradients_by_velocities(const vector3<T>& start, const vector3<T>& end, std::size_t count) const {
    static_assert(Order == 4);
    const matrix3<T> none = matrix3<T>::Zero(), one = matrix3<T>::Identity();
    const real per_h = 1 / h_;
    rate_gradients result;
    result[0][0] = {one, none};
    result[1][0] = {none, one};
    // w_1 is 2 x_2 at the start and 2 J y_2 + J̇ v at the end; the term J̇ v changes by 2 (J̇ + ŵ J)
    // δv.
    const vector3<T> v = times_inverse(end);
    const T square_rate = 2 * dot(components(d_), components(v)); // of |x|²
    matrix3<T> jacobian_rate = axial_matrix<T>(
        square_rate * at_end_.a[1], -square_rate * at_end_.b[1], square_rate * at_end_.c[1], d_);
    add_axial(jacobian_rate, T(-at_end_.b[0]), v);
    for (int i = 0; i < 9; ++i) {
      jacobian_rate(i / 3, i % 3) += at_end_.c[0] * (d_[i / 3] * v[i % 3] + v[i / 3] * d_[i % 3]);
    }
    result[0][1] = result[1][1] = {none, none};
    add_multiple(result[0][1][0], real(-4) * per_h, one);
    add_multiple(result[0][1][1], real(-2) * per_h, inverse_);
    add_multiple(result[1][1][0], 2 * per_h,
                 axial_matrix<T>(at_end_.a[0], -at_end_.b[0], at_end_.c[0], d_));
    add_product(result[1][1][1], real(2), jacobian_rate, inverse_);
    add_multiple(result[1][1][1], real(4) * per_h, one);
    add_axial(result[1][1][1], T(2), end);
    if (count > 2) {
      const coefficients x = polynomial({start}, {end}), y = taylor_shift<4>(x, h_);
      const std::array of{gradients_at_start<3>({x[1], x[2], x[3]})[2],
                          gradients_at_end<3>({y[1], y[2], y[3]})[2]};
      // Derivatives of x_1, x_2, x_3 and of y_1, y_2, y_3 with respect to ẋ at the start and at the
      // end.
      const real a = per_h, aa = a * a, o(0);
      const real factors[2][2][3] = {{{real(1), -2 * a, aa}, {o, -a, aa}},
                                     {{o, a, aa}, {real(1), 2 * a, aa}}};
      for (std::size_t at = 0; at < 2; ++at) {
        result[at][2] = {none, none};
        for (std::size_t m = 0; m < 3; ++m) {
          add_multiple(result[at][2][0], factors[at][0][m], of[at][m]);
          add_product(result[at][2][1], factors[at][1][m], of[at][m], inverse_);
        }
      }
    }
    return result;
  }

private:
  [[nodiscard]] static vector3<real> zero() { return vector3<real>::Zero(); }
  [[nodiscard]] static const jacobian_coefficients<std::size_t(Order) - 1, real>& at_start() {
    static const jacobian_coefficients<std::size_t(Order) - 1, real> result(real(0));
    return result;
  }

  /// Computes each x_{k+1} from w_k minus the contribution of the coefficients x_1 … x_k.
  template <std::size_t Count, class Coefficients, class X, class Inverse>
  [[nodiscard]] static std::array<vector3<T>, Count>
  taylor_of_rates(const Coefficients& jacobian, const X& at, const std::array<vector3<T>, Count>& w,
                  const Inverse& inverse) {
    std::array<vector3<T>, Count> x;
    const auto next = [&]<std::size_t K>(std::integral_constant<std::size_t, K>) {
      std::array<vector3<T>, K + 1> lower;
      std::copy_n(x.begin(), K, lower.begin());
      lower[K] = vector3<T>::Constant(T(real(0)));
      const vector3<T> contribution = half_body_rates(jacobian, at, lower)[K];
      x[K] = inverse(vector3<T>(w[K] - contribution)) * (real(1) / real(K + 1));
    };
    [&]<std::size_t... K>(std::index_sequence<K...>) {
      (next(std::integral_constant<std::size_t, K>{}), ...);
    }
    (std::make_index_sequence<Count>{});
    return x;
  }

  /// Second derivative ẍ at the end for given w and its derivative.
  [[nodiscard]] vector3<T> second_at_end(const std::array<vector3<T>, 2>& end) const {
    return times_inverse(components(end[1]) -
                         components(times_jacobian_rate(times_inverse(end[0]))));
  }

  /// Product J v at the end.
  [[nodiscard]] vector3<T> times_jacobian(const vector3<T>& v) const {
    const three_vector<T> d = components(d_), x = components(v);
    return at_end_.a[0] * x - at_end_.b[0] * cross(d, x) + T(at_end_.c[0] * dot(d, x)) * d;
  }
  /// Product J̇ v at the end, for ẋ = v.
  [[nodiscard]] vector3<T> times_jacobian_rate(const vector3<T>& v) const {
    const three_vector<T> d = components(d_), x = components(v);
    const T p = dot(d, x), twice = p + p;
    return T(twice * at_end_.a[1] + p * at_end_.c[0]) * x - T(twice * at_end_.b[1]) * cross(d, x) +
           T(twice * p * at_end_.c[1] + dot(x, x) * at_end_.c[0]) * d;
  }

  /// Adds factor · v̂ to m, in place.
  static void add_axial(matrix3<T>& m, const T& factor, const vector3<T>& v) {
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      m(i, j) -= factor * v[k];
      m(i, k) += factor * v[j];
    }
  }

  [[nodiscard]] vector3<T> times_inverse(const vector3<T>& w) const {
    vector3<T> v;
    for (int i = 0; i < 3; ++i) {
      v[i] = inverse_(i, 0) * w[0] + inverse_(i, 1) * w[1] + inverse_(i, 2) * w[2];
    }
    return v;
  }

  real h_;
  vector3<T> d_;
  jacobian_coefficients<std::size_t(Order) - 1, T> at_end_;
  matrix3<T> inverse_; ///< J(d)⁻¹
};

} // namespace duet::detail
