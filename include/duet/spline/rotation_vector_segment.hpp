// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/quaternion/exponential_jacobian.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>

/// \file
/// One piece of a rotation-vector spline: exp(x(t)) with a polynomial x of half-angle vectors that
/// goes from zero to a given one, and what its rates at both ends have to do with each other.

namespace duet::detail {

/// A polynomial's Taylor coefficients about t, the first `Count` of them, from those about zero.
/// Constant term first.
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

/// The part of a piece that does not change while its rates are sought: it takes the parameter h
/// and ends at exp(d), d of the scalar T.
///
/// A knot's rates are Taylor coefficients of w, Q′ = Q w: the halved angular velocity in body axes,
/// its derivative, half its second derivative … The polynomial of order k (degree k − 1) has room
/// for k/2 − 1 of them at each end.
template <class T, int Order>
class rotation_vector_segment {
  static_assert(Order == 4 || Order == 6,
                "duet: a rotation_vector_spline is of order 4, the cubic, or 6, the quintic");

public:
  using real = real_type_t<T>;
  /// How many rates a knot has of its own.
  static constexpr std::size_t own = std::size_t(Order) / 2 - 1;
  template <class S>
  using knot_rates = std::array<vector3<S>, own>;

  rotation_vector_segment(const real& h, const vector3<T>& d)
      : h_(h), d_(d), at_start_(real(0)), at_end_(dot(components(d), components(d))),
        inverse_(right_jacobian_inverse((real(2) * components(d)).eigen())) {}

  /// x_0 … x_{k−1} about the start, where x_0 = 0, over the scalar S of the rates, T or above.
  template <class S>
  [[nodiscard]] std::array<vector3<S>, std::size_t(Order)>
  polynomial(const knot_rates<S>& start, const knot_rates<S>& end) const {
    std::array<vector3<S>, std::size_t(Order)> x;
    x[0] = vector3<S>::Constant(S(real(0)));
    x[1] = start[0];
    const real per_h = 1 / h_;
    const vector3<S> v = times_inverse(end[0]); // ẋ at the end
    const vector3<T> mean = per_h * components(d_);
    // What is missing to go straight on at the start's rates, in powers of h.
    if constexpr (Order == 4) {
      for (int i = 0; i < 3; ++i) {
        const S a = mean[i] - start[0][i];
        const S b = v[i] - start[0][i];
        x[2][i] = (3 * a - b) * per_h;
        x[3][i] = (b - 2 * a) * (per_h * per_h);
      }
    } else {
      const vector3<S> twice = second_at_end(end);
      for (int i = 0; i < 3; ++i) {
        const S& second = start[1][i];
        x[2][i] = second / 2;
        const S a = (mean[i] - start[0][i]) * per_h - x[2][i];
        const S b = (v[i] - start[0][i]) * per_h - second;
        const S c = (twice[i] - second) / 2;
        x[3][i] = (10 * a - 4 * b + c) * per_h;
        x[4][i] = (7 * b - 15 * a - 2 * c) * (per_h * per_h);
        x[5][i] = (6 * a - 3 * b + c) * (per_h * per_h * per_h);
      }
    }
    return x;
  }

  /// The cubic once more, where velocities and accelerations of the knots are known that agree with
  /// each other: from its ends and ẍ there. However short the piece, differences of velocities are
  /// not divided by h: the accelerations are met to rounding, and so are the velocities.
  template <class S>
  [[nodiscard]] std::array<vector3<S>, 4>
  polynomial_of_accelerations(const std::array<vector3<S>, 2>& start,
                              const std::array<vector3<S>, 2>& end) const {
    static_assert(Order == 4);
    std::array<vector3<S>, 4> x;
    x[0] = vector3<S>::Constant(S(real(0)));
    const vector3<S> last = second_at_end(end);
    const real per_h = 1 / h_;
    for (int i = 0; i < 3; ++i) {
      const S& first = start[1][i];
      x[1][i] = d_[i] * per_h - (2 * first + last[i]) * (h_ / 6);
      x[2][i] = first / 2;
      x[3][i] = (last[i] - first) * (per_h / 6);
    }
    return x;
  }

  /// x_1 … x_Count at the start, or about the end, that make these rates w_0 … w_{Count−1}.
  template <std::size_t Count, class S>
  [[nodiscard]] std::array<vector3<S>, Count>
  taylor_at_start(const std::array<vector3<S>, Count>& w) const {
    return taylor_of_rates(at_start_, zero(), w, [](const vector3<S>& v) { return v; });
  }
  template <std::size_t Count, class S>
  [[nodiscard]] std::array<vector3<S>, Count>
  taylor_at_end(const std::array<vector3<S>, Count>& w) const {
    return taylor_of_rates(at_end_, d_, w,
                           [this](const vector3<S>& v) { return times_inverse(v); });
  }

  template <std::size_t Count, class S>
  struct end_rates {
    std::array<vector3<S>, Count> start, end;
  };

  /// w_0 … w_{Count−1} at both ends of the piece.
  template <std::size_t Count, class S>
  [[nodiscard]] end_rates<Count, S>
  rates(const std::array<vector3<S>, std::size_t(Order)>& x) const {
    const auto shifted = taylor_shift<Count + 1>(x, h_);
    std::array<vector3<S>, Count> before, after;
    std::copy_n(x.begin() + 1, Count, before.begin());
    std::copy_n(shifted.begin() + 1, Count, after.begin());
    return {rates_at_start(before), rates_at_end(after)};
  }

  /// w_0 … w_{Count−1} at the start, or the end, from x_1 … x_Count about it.
  template <std::size_t Count, class S>
  [[nodiscard]] std::array<vector3<S>, Count>
  rates_at_start(const std::array<vector3<S>, Count>& x) const {
    return half_body_rates(at_start_, zero(), x);
  }
  template <std::size_t Count, class S>
  [[nodiscard]] std::array<vector3<S>, Count>
  rates_at_end(const std::array<vector3<S>, Count>& x) const {
    return half_body_rates(at_end_, d_, x);
  }

private:
  [[nodiscard]] static vector3<real> zero() { return vector3<real>::Zero(); }

  /// Each x_{k+1} from w_k less what the ones before make of it.
  template <std::size_t Count, class S, class Coefficients, class X, class Inverse>
  [[nodiscard]] static std::array<vector3<S>, Count>
  taylor_of_rates(const Coefficients& jacobian, const X& at, const std::array<vector3<S>, Count>& w,
                  const Inverse& inverse) {
    std::array<vector3<S>, Count> x;
    const auto next = [&]<std::size_t K>(std::integral_constant<std::size_t, K>) {
      std::array<vector3<S>, K + 1> so_far;
      std::copy_n(x.begin(), K, so_far.begin());
      so_far[K] = vector3<S>::Constant(S(real(0)));
      const vector3<S> without = half_body_rates(jacobian, at, so_far)[K];
      x[K] = inverse(vector3<S>(w[K] - without)) * (real(1) / real(K + 1));
    };
    [&]<std::size_t... K>(std::index_sequence<K...>) {
      (next(std::integral_constant<std::size_t, K>{}), ...);
    }
    (std::make_index_sequence<Count>{});
    return x;
  }

  /// ẍ at the end, where w and its derivative are given.
  template <class S>
  [[nodiscard]] vector3<S> second_at_end(const std::array<vector3<S>, 2>& end) const {
    const vector3<S> none = vector3<S>::Constant(S(real(0)));
    const auto without = rates_at_end(std::array<vector3<S>, 2>{times_inverse(end[0]), none});
    return times_inverse(vector3<S>(end[1] - without[1]));
  }

  template <class S>
  [[nodiscard]] vector3<S> times_inverse(const vector3<S>& w) const {
    vector3<S> v;
    for (int i = 0; i < 3; ++i) {
      v[i] = inverse_(i, 0) * w[0] + inverse_(i, 1) * w[1] + inverse_(i, 2) * w[2];
    }
    return v;
  }

  real h_;
  vector3<T> d_;
  jacobian_coefficients<std::size_t(Order) - 1, real> at_start_;
  jacobian_coefficients<std::size_t(Order) - 1, T> at_end_;
  matrix3<T> inverse_; ///< J(d)⁻¹
};

} // namespace duet::detail
