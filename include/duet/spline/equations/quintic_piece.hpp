// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/spline/blocks/products.hpp>
#include <duet/spline/rotation_vector_segment.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>

/// \file
/// Segment of a quintic rotation-vector spline, described by all rates that it shares with its
/// neighbours.

namespace duet::detail {

/// Equations of a segment of degree five and length h from zero to d. With the Taylor coefficients
/// x_1 … x_4 about its start and y_1 … y_4 about its end, which give the rates w_0 … w_3 there,
/// they are
///   x_1 + h x_2 + h² x_3 + h³ (4 x_4 + y_4)/5 = d/h
///   y_1 = x_1 + 2h x_2 + 3h² x_3 + h³ (3 x_4 + y_4)
///   y_2 = x_2 + 3h x_3 + 2h² (2 x_4 + y_4)
///   y_3 = x_3 + 2h (x_4 + y_4)
/// and x_5 = (y_4 − x_4)/(5h).
template <class T>
class quintic_piece {
  using R = real_type_t<T>;
  using segment = rotation_vector_segment<T, 6>;

public:
  static constexpr std::size_t count = 4;
  using coefficients = std::array<vector3<T>, count>;
  using factors = std::array<std::array<R, count>, count>;

  quintic_piece(const R& h, const vector3<T>& d) : h_(h), d_(d), segment_(h, d) {}

  struct ends {
    coefficients x, y;
  };
  [[nodiscard]] ends taylor(const coefficients& at_start, const coefficients& at_end) const {
    return {segment_.template taylor_at_start<count>(at_start),
            segment_.template taylor_at_end<count>(at_end)};
  }

  /// Derivatives with respect to all rates of a knot, w_0 … w_3.
  using gradient = Eigen::Matrix<R, 3, 3 * int(count)>;
  struct end_gradients {
    std::array<gradient, count> x, y;
  };
  /// Derivatives of x_1 … x_4 with respect to the rates at the start, and of y_1 … y_4 with respect
  /// to those at the end. For real T.
  [[nodiscard]] end_gradients taylor_gradients(const ends& e) const {
    return {inverted(segment_.gradients_at_start(e.x), matrix3<R>::Identity()),
            inverted(segment_.gradients_at_end(e.y), segment_.inverse())};
  }

  /// Factors of x_1 … x_4 in the equations, with right sides taken to the left; the equations of
  /// second and third rates are multiplied by l and l², which scales them to the size of the
  /// others.
  [[nodiscard]] factors factors_of_start(const R& l) const {
    const R h = h_, hh = h * h, ll = l * l, o(0);
    return {{{R(1), h, hh, R(hh * h * 4 / 5)},
             {R(-1), R(-2 * h), R(-3 * hh), R(-3 * hh * h)},
             {o, R(-l), R(-3 * h * l), R(-4 * hh * l)},
             {o, o, R(-ll), R(-2 * h * ll)}}};
  }
  /// Factors of y_1 … y_4 in the same equations.
  [[nodiscard]] factors factors_of_end(const R& l) const {
    const R h = h_, hh = h * h, ll = l * l, o(0);
    return {{{o, o, o, R(hh * h / 5)},
             {R(1), o, o, R(-hh * h)},
             {o, l, o, R(-2 * hh * l)},
             {o, o, ll, R(-2 * h * ll)}}};
  }
  /// Residuals of the equations for x and y.
  [[nodiscard]] coefficients residuals(const ends& e, const R& l) const {
    const factors a = factors_of_start(l), b = factors_of_end(l);
    coefficients result;
    for (std::size_t m = 0; m < count; ++m) {
      three_vector<T> sum = R(m > 0 ? 0 : -1 / h_) * components(d_);
      for (std::size_t k = 0; k < count; ++k) {
        sum = sum + (a[m][k] * components(e.x[k]) + b[m][k] * components(e.y[k]));
      }
      result[m] = sum;
    }
    return result;
  }

  /// Contributions of the rates at the start and at the end to the fifth rate w_4 at the start.
  [[nodiscard]] std::array<vector3<T>, 2> last_rate_at_start(const ends& e) const {
    const R per_h = 1 / h_;
    const vector3<T> w = segment_.template rates_at_start<count + 1>(with_zero(e.x))[count];
    return {components(w) + R(-per_h) * components(e.x[3]), per_h * components(e.y[3])};
  }
  /// Contributions of the rates at the start and at the end to the fifth rate w_4 at the end.
  [[nodiscard]] std::array<vector3<T>, 2> last_rate_at_end(const ends& e) const {
    const R per_h = 1 / h_;
    const vector3<T> w = segment_.template rates_at_end<count + 1>(with_zero(e.y))[count];
    const auto in_body_axes = [&](const vector3<T>& x, const R& factor) {
      return segment_.template rates_at_end<1>(
          std::array<vector3<T>, 1>{factor * components(x)})[0];
    };
    return {in_body_axes(e.x[3], R(-per_h)),
            components(w) + components(in_body_axes(e.y[3], per_h))};
  }
  /// Derivatives of these two contributions, each with respect to the rates of its knot. For real
  /// T.
  [[nodiscard]] std::array<gradient, 2> gradients_of_last_rate_at_start(const ends& e) const {
    const end_gradients by = taylor_gradients(e);
    return last_rate_gradients(segment_.gradients_at_start(with_zero(e.x)), by.x, by.y[3],
                               R(-1 / h_));
  }
  [[nodiscard]] std::array<gradient, 2> gradients_of_last_rate_at_end(const ends& e) const {
    const end_gradients by = taylor_gradients(e);
    const auto [of_end, of_start] =
        last_rate_gradients(segment_.gradients_at_end(with_zero(e.y)), by.y, by.x[3], R(1 / h_));
    return {of_start, of_end};
  }

  /// Coefficients x_0 … x_5.
  [[nodiscard]] std::array<vector3<T>, 6> polynomial(const ends& e) const {
    std::array<vector3<T>, 6> result;
    result[0] = vector3<T>::Constant(T(R(0)));
    for (int k = 0; k < 3; ++k) {
      result[1][k] =
          d_[k] / h_ - h_ * (e.x[1][k] + h_ * (e.x[2][k] + h_ * ((4 * e.x[3][k] + e.y[3][k]) / 5)));
      result[2][k] = e.x[1][k];
      result[3][k] = e.x[2][k];
      result[4][k] = e.x[3][k];
      result[5][k] = (e.y[3][k] - e.x[3][k]) / (5 * h_);
    }
    return result;
  }

private:
  [[nodiscard]] static std::array<vector3<T>, count + 1> with_zero(const coefficients& x) {
    return {x[0], x[1], x[2], x[3], vector3<T>::Constant(T(R(0)))};
  }

  template <std::size_t Count>
  using rate_gradients = std::array<std::array<matrix3<R>, Count>, Count>;

  /// Derivatives with respect to the rates at the same and at the other end of the segment, where
  /// x_5 = `per_h` (x_4 − other x_4)/5. `own` are the derivatives of the coefficients at the same
  /// end, `other` those of the fourth coefficient at the other end.
  [[nodiscard]] static std::array<gradient, 2>
  last_rate_gradients(const rate_gradients<count + 1>& of, const std::array<gradient, count>& own,
                      const gradient& other, const R& per_h) {
    const matrix3<R>& jacobian = of[0][0];
    std::array<gradient, 2> result{gradient::Zero(), gradient::Zero()};
    for (std::size_t m = 0; m < count; ++m) {
      add_product(result[0], R(1), of[count][m], own[m]);
    }
    add_product(result[0], per_h, jacobian, own[count - 1]);
    add_product(result[1], R(-per_h), jacobian, other);
    return result;
  }

  /// Derivatives of x_1 … x_4 with respect to w_0 … w_3, from those of w_0 … w_3 with respect to
  /// x_1 … x_4.
  [[nodiscard]] static std::array<gradient, count> inverted(const rate_gradients<count>& of,
                                                            const matrix3<R>& inverse) {
    std::array<gradient, count> result;
    for (std::size_t k = 0; k < count; ++k) {
      gradient right_side = gradient::Zero();
      for (int i = 0; i < 3; ++i) {
        right_side(i, 3 * int(k) + i) = R(1);
      }
      for (std::size_t m = 0; m < k; ++m) {
        add_product(right_side, R(-1), of[k][m], result[m]);
      }
      result[k].setZero();
      add_product(result[k], R(1) / R(k + 1), inverse, right_side);
    }
    return result;
  }

  R h_;
  vector3<T> d_;
  segment segment_;
};

} // namespace duet::detail
