// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/batch.hpp>
#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/derivative/manifold.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/exponential_jacobian.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/blocks.hpp>
#include <duet/spline/end_conditions.hpp>
#include <duet/spline/matrix_rows.hpp>
#include <duet/spline/motion.hpp>
#include <duet/spline/motion_jacobian.hpp>
#include <duet/spline/orientations.hpp>
#include <duet/spline/piecewise_curve.hpp>
#include <duet/spline/product_jacobian.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Piecewise-polynomial rotation vectors: curves that are more accurate than the cumulative ones of
/// the same order; among them Hermite interpolation, through data points with given velocities.

namespace duet {

namespace detail {

template <std::size_t Count, class T, std::size_t Size, class S>
[[nodiscard]] auto taylor_shift(const std::array<vector3<T>, Size>& c, const S& t);
template <class T, int Order>
class rotation_vector_segment;
template <class T, int Order, class Piece>
class rotation_vector_equations;
template <int Rates, int Order, class T, class Frame>
[[nodiscard]] curve_jacobian<T, 2, Rates, Frame>
jacobian_of_segment(const std::array<quaternion<T>, 2>& ends, const real_type_t<T>& h,
                    const std::array<vector3<T>, std::size_t(Order)>& piece,
                    const real_type_t<T>& t, Frame frame, perturbation side);

} // namespace detail

/// Piecewise-polynomial rotation-vector curve Q(u) = Q_i exp(x_i(u − u_i)) between the knots u_i
/// and u_{i+1}, with polynomials x_i of half-angle vectors, x_i(0) = 0, exp(x_i(u_{i+1} − u_i)) =
/// Q_i* Q_{i+1}.
///
/// \tparam T      scalar of the data points: a real number for rotations, dual<R, 1, screw_tag> for
///                poses, derivative duals inside either
/// \tparam Order  4: cubic, made from angular velocities at the knots; 6: quintic, from angular
///                velocities and accelerations
///
/// `interpolate` finds the rates that make the curve C² or, for order 6, C⁴. Given rates make it a
/// Hermite curve, C¹ or C². Rates are with respect to u: rad per unit of u, for poses twists [v;
/// ω].
///
/// `motion_jacobian` is with respect to the data points Q_i and Q_{i+1} of the span, the rates at
/// the knots fixed in body axes: those of Q = Q_i exp(x) and of log(Q_i* Q_{i+1}) in closed form,
/// that of the polynomial with respect to this logarithm by dual numbers with three partials.
template <class T, int Order = 4>
class rotation_vector_spline
    : public piecewise_curve<rotation_vector_spline<T, Order>, real_type_t<T>> {
  using segment = detail::rotation_vector_segment<T, Order>;

public:
  using scalar_type = T;
  using real_type = real_type_t<T>;
  static constexpr int order = Order;
  /// Order of convergence: for smooth motion the interpolation error decreases as this power of the
  /// step.
  static constexpr int convergence = Order;

  /// Constructs the Hermite curve from data points and halved rates at the knots in body axes:
  /// element [i][0] is w with Q′ = Q w, [i][1] its derivative (order 6 only). Data points are
  /// normalised and their signs aligned.
  ///
  /// \throws invalid_sample as `align_quaternion_signs`, for parameters that do not increase and
  /// for a rate that is not finite
  /// \throws invalid_input for fewer than two data points, counts that differ, or parameters so far
  /// apart or so close that derivatives underflow or overflow
  rotation_vector_spline(
      const std::vector<real_type>& parameters, std::vector<quaternion<T>> elements,
      const std::vector<std::array<vector3<T>, std::size_t(Order) / 2 - 1>>& half_rates)
      : spans_(spans_over(checked(parameters, elements, half_rates, "rates", 0))),
        elements_(align_quaternion_signs(std::move(elements))) {
    for (std::size_t i = 0; i < half_rates.size(); ++i) {
      for (const vector3<T>& rate : half_rates[i]) {
        if (!rate.allFinite()) {
          detail::raise(invalid_sample(i, "a rate is not finite"));
        }
      }
    }
    pieces_.reserve(parameters.size() - 1);
    for (std::size_t i = 0; i + 1 < parameters.size(); ++i) {
      const segment s(parameters[i + 1] - parameters[i],
                      detail::log_vector(detail::relative_rotation(elements_[i], elements_[i + 1]),
                                         "rotation_vector_spline"));
      pieces_.push_back(s.polynomial(half_rates[i], half_rates[i + 1]));
    }
  }

  /// Returns the curve with these polynomials, constant terms first, as for a copy from another
  /// curve's `knots()`, `elements()` and `pieces()`. Data points are normalised; signs stay as they
  /// are.
  ///
  /// \throws invalid_sample as `normalized_quaternions`, for parameters that do not increase and if
  /// a piece does not end at the next data point
  /// \throws invalid_input for fewer than two data points, counts that differ, or parameters so far
  /// apart or so close that derivatives underflow or overflow
  [[nodiscard]] static rotation_vector_spline
  from_pieces(const std::vector<real_type>& parameters, std::vector<quaternion<T>> elements,
              std::vector<std::array<vector3<T>, std::size_t(Order)>> pieces) {
    checked(parameters, elements, pieces, "pieces", 1);
    rotation_vector_spline result(from_segments_tag{}, parameters,
                                  normalized_quaternions(std::move(elements)), std::move(pieces));
    for (std::size_t i = 0; i < result.pieces_.size(); ++i) {
      const auto x =
          detail::taylor_shift<1>(result.pieces_[i], real_type(parameters[i + 1] - parameters[i]));
      const auto step = conj(result.elements_[i]) * result.elements_[i + 1];
      const auto miss = detail::innermost_of(step - duet::exp(x[0]));
      if (!(norm(miss) <= real_type(unit_norm_tolerance))) {
        detail::raise(invalid_sample(i + 1, "the polynomial piece before does not end at it"));
      }
    }
    return result;
  }

  /// Knots u_0 … u_n.
  [[nodiscard]] const std::vector<real_type>& knots() const { return spans_.breaks(); }
  /// Data points Q_0 … Q_n, unit quaternions or poses.
  [[nodiscard]] const std::vector<quaternion<T>>& elements() const { return elements_; }
  /// Coefficients of the polynomials x_i, constant terms first.
  [[nodiscard]] const std::vector<std::array<vector3<T>, std::size_t(Order)>>& pieces() const {
    return pieces_;
  }

private:
  using polynomial = std::array<vector3<T>, std::size_t(Order)>;
  friend class piecewise_curve<rotation_vector_spline, real_type_t<T>>;
  template <int Rates, int K, class S, class Frame>
  friend curve_jacobian<S, 2, Rates, Frame>
  detail::jacobian_of_segment(const std::array<quaternion<S>, 2>&, const real_type_t<S>&,
                              const std::array<vector3<S>, std::size_t(K)>&, const real_type_t<S>&,
                              Frame, perturbation);
  template <class, int, class>
  friend class detail::rotation_vector_equations;

  struct from_segments_tag {};
  rotation_vector_spline(from_segments_tag, const std::vector<real_type>& parameters,
                         std::vector<quaternion<T>> elements, std::vector<polynomial> pieces)
      : spans_(spans_over(parameters)), elements_(std::move(elements)), pieces_(std::move(pieces)) {
  }

  /// \param missing  number by which the parts are fewer than the data points
  template <class Elements, class Parts>
  static const std::vector<real_type>& checked(const std::vector<real_type>& parameters,
                                               const Elements& elements, const Parts& parts,
                                               const char* what, std::size_t missing) {
    detail::check_samples("rotation_vector_spline", parameters, elements.size(), 2);
    detail::require(parts.size() + missing == elements.size(),
                    "duet: rotation_vector_spline: ", elements.size(), " samples need ",
                    elements.size() - missing, " ", what, ", got ", parts.size());
    return parameters;
  }

  /// \throws invalid_input if parameters are so far apart, or so close, that derivatives underflow
  /// or overflow
  [[nodiscard]] static knot_spans<real_type> spans_over(const std::vector<real_type>& u) {
    const auto is_finite = [](const real_type& x) { return x - x == 0; };
    detail::require(is_finite(u.back() - u.front()),
                    "duet: rotation_vector_spline: the distance from ", u.front(), " to ", u.back(),
                    " overflows");
    for (std::size_t i = 0; i + 1 < u.size(); ++i) {
      real_type power(1); // of the step, as in the highest derivative
      for (int k = 1; k < Order; ++k) {
        power *= u[i + 1] - u[i];
      }
      const bool is_long = power > 1;
      detail::require(
          is_finite(power) && is_finite(1 / power), "duet: rotation_vector_spline: parameter ", i,
          " = ", u[i], " and parameter ", i + 1, " = ", u[i + 1], " are too ",
          is_long ? "far apart: a derivative underflows" : "close: a derivative overflows");
    }
    return knot_spans<real_type>(u);
  }

  [[nodiscard]] const knot_spans<real_type>& spans() const { return spans_; }

  /// Q, w, w′, w″.
  template <int Rates, class P>
  [[nodiscard]] DUET_ALWAYS_INLINE auto on_span(std::size_t i, const P& u) const {
    return on_piece<Rates>(elements_[i], pieces_[i], P(u - knots()[i]));
  }
  template <int Rates, std::size_t W, class P>
  [[nodiscard]] DUET_ALWAYS_INLINE auto on_span(const std::array<std::size_t, W>& spans,
                                                const P& u) const {
    return on_piece<Rates>(detail::gathered(spans, elements_), detail::gathered(spans, pieces_),
                           P(u - detail::gathered(spans, knots())));
  }

  template <int Rates, class P, class Frame>
  [[nodiscard]] auto jacobian_on_span(std::size_t i, const P& u, Frame frame,
                                      perturbation side) const {
    static_assert(std::is_same_v<P, real_type>,
                  "duet: motion_jacobian of a rotation_vector_spline takes a real parameter");
    auto result = detail::jacobian_of_segment<Rates, Order, T>(
        {elements_[i], elements_[i + 1]}, knots()[i + 1] - knots()[i], pieces_[i],
        real_type(u - knots()[i]), frame, side);
    result.first = i;
    return result;
  }

  template <int Rates, class S, class P>
  [[nodiscard]] DUET_ALWAYS_INLINE static auto
  on_piece(const quaternion<S>& start, const std::array<vector3<S>, std::size_t(Order)>& piece,
           const P& t) {
    using D = promote_t<S, P>;
    const auto x = detail::taylor_shift<std::size_t(Rates) + 1>(piece, t);
    detail::half_motion<D> m{start * duet::exp(x[0]), {}, {}, {}};
    if constexpr (Rates > 0) {
      const auto at = detail::components(x[0]);
      const detail::jacobian_coefficients<std::size_t(Rates), D> jacobian(dot(at, at));
      std::array<vector3<D>, std::size_t(Rates)> rates;
      std::copy(x.begin() + 1, x.end(), rates.begin());
      const auto w = detail::half_body_rates(jacobian, x[0], rates);
      m.velocity = detail::components(w[0]);
      if constexpr (Rates > 1) {
        m.acceleration = detail::components(w[1]);
      }
      if constexpr (Rates > 2) {
        m.jerk = real_type_t<D>(2) * detail::components(w[2]);
      }
    }
    return m;
  }

  knot_spans<real_type> spans_;
  std::vector<quaternion<T>> elements_;
  std::vector<polynomial> pieces_;
};

namespace detail {

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

  /// Rates w_0 … w_{Count−1} at an end, 0 the start, from x_1 … x_Count about it.
  template <std::size_t End, std::size_t Count>
  [[nodiscard]] std::array<vector3<T>, Count>
  rates_at(const std::array<vector3<T>, Count>& x) const {
    if constexpr (End == 0) {
      return half_body_rates(at_start(), zero(), x);
    } else {
      return half_body_rates(at_end_, d_, x);
    }
  }
  /// Taylor coefficients x_1 … x_Count about an end for the rates w_0 … w_{Count−1}: each x_{k+1}
  /// from w_k minus the contribution of the coefficients x_1 … x_k.
  template <std::size_t End, std::size_t Count>
  [[nodiscard]] std::array<vector3<T>, Count>
  taylor_at(const std::array<vector3<T>, Count>& w) const {
    std::array<vector3<T>, Count> x;
    const auto next = [&]<std::size_t K>(std::integral_constant<std::size_t, K>) {
      std::array<vector3<T>, K + 1> lower;
      std::copy_n(x.begin(), K, lower.begin());
      lower[K] = vector3<T>::Constant(T(real(0)));
      const vector3<T> rest = w[K] - rates_at<End>(lower)[K];
      x[K] = (End == 0 ? rest : times_inverse(rest)) * (real(1) / real(K + 1));
    };
    [&]<std::size_t... K>(std::index_sequence<K...>) {
      (next(std::integral_constant<std::size_t, K>{}), ...);
    }
    (std::make_index_sequence<Count>{});
    return x;
  }
  /// Derivatives of w_0 … w_{Count−1} at an end with respect to x_1 … x_Count about it, see
  /// `half_body_rate_gradients`.
  template <std::size_t Count>
  [[nodiscard]] auto gradients_at(std::size_t end, const std::array<vector3<T>, Count>& x) const {
    return end == 0 ? half_body_rate_gradients(at_start(), zero(), x)
                    : half_body_rate_gradients(at_end_, d_, x);
  }
  /// Inverse Jacobian J(d)⁻¹.
  [[nodiscard]] const matrix3<T>& inverse() const { return inverse_; }

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
      w[1] = rates_at<1, 3>({y[1], y[2], y[3]});
    }
    return w;
  }

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
      const std::array of{gradients_at<3>(0, {x[1], x[2], x[3]})[2],
                          gradients_at<3>(1, {y[1], y[2], y[3]})[2]};
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

/// Derivatives of the dual numbers in a vector: one column a partial.
template <class T, class D>
[[nodiscard]] matrix_rows<T> rows_of_partials(const three_vector<D>& v) {
  const auto row = [](const D& x) {
    const auto part = [&](int c) {
      if constexpr (contains_tag<T, screw_tag>()) {
        return T(x.value().partial(c), x.epsilon().partial(c));
      } else {
        return T(x.partial(c));
      }
    };
    return matrix_row<T>::of(part(0), part(1), part(2));
  };
  return {row(v.x), row(v.y), row(v.z)};
}

/// Jacobian of one segment Q_0 exp(x(t)) with respect to its ends, its rates there fixed. With
/// φ = 2 log(Q_0* Q_1), dφ = J_r⁻¹(φ) d_1 − J_l⁻¹(φ) d_0; the value moves by Ad(exp(x))⁻¹ d_0 and
/// by what dφ does to exp(x), the rates by what dφ does to them. (Over dual numbers of rigid motion
/// three partials suffice for six columns.)
template <int Rates, int Order, class T, class Frame>
[[nodiscard]] curve_jacobian<T, 2, Rates, Frame>
jacobian_of_segment(const std::array<quaternion<T>, 2>& ends, const real_type_t<T>& h,
                    const std::array<vector3<T>, std::size_t(Order)>& piece,
                    const real_type_t<T>& t, Frame, perturbation side) {
  using curve = rotation_vector_spline<T, Order>;
  using segment = rotation_vector_segment<T, Order>;
  using scalar = typename manifold<quaternion<T>>::scalar;
  using number = dual<scalar, 3, derivative_tag<curve>>;
  using time = dual<scalar, 1, derivative_tag<segment>>;
  using D = promote_t<T, number>;
  using R = real_type_t<T>;
  constexpr std::size_t count = segment::rates_per_knot;
  const auto at_end = taylor_shift<count + 1>(piece, h);
  const segment plain(h, vector3<T>(at_end[0]));
  std::array<vector3<T>, count> x_start, x_end;
  std::copy_n(piece.begin() + 1, count, x_start.begin());
  std::copy_n(at_end.begin() + 1, count, x_end.begin());
  const auto start = plain.template rates_at<0>(x_start), end = plain.template rates_at<1>(x_end);

  std::array<vector3<D>, count> wide_start, wide_end;
  vector3<D> d;
  for (int c = 0; c < 3; ++c) {
    d[c] = D(at_end[0][c]) + number::variable(scalar(0), c) * R(0.5); // by φ = 2d
    for (std::size_t k = 0; k < count; ++k) {
      wide_start[k][c] = D(start[k][c]);
      wide_end[k][c] = D(end[k][c]);
    }
  }
  const auto wide = rotation_vector_spline<T, Order>::template on_piece<3>(
      quaternion<D>(D(1)), rotation_vector_segment<D, Order>(h, d).polynomial(wide_start, wide_end),
      t);
  const auto m = curve::template on_piece<3>(quaternion<T>(T(1)), piece, t);
  const auto in_time =
      curve::template on_piece<3>(quaternion<T>(T(1)), piece, time::variable(scalar(t)));

  curve_jacobian<T, 2, Rates, Frame> result;
  const block_pointers<Rates, T> blocks = pointers_to_blocks(result);
  const vector3<T> phi = R(2) * components(vector3<T>(at_end[0]));
  const matrix_rows<T> by_last = rows_of(left_jacobian_inverse(phi));
  const matrix_rows<T> by_next = rows_of(right_jacobian_inverse(phi));
  const quaternion<D> back = conj(quaternion<D>(m.value));
  const quaternion<D> sigma = back * wide.value;
  const std::array<three_vector<D>, 4> moved{three_vector<D>{sigma.x(), sigma.y(), sigma.z()},
                                             wide.velocity, wide.acceleration, wide.jerk};
  for (std::size_t k = 0; k <= std::size_t(Rates); ++k) {
    const matrix_rows<T> by_phi = scaled(R(2), rows_of_partials<T>(moved[k]));
    blocks[k][0] = negated(rows_product(by_phi, by_last));
    blocks[k][1] = rows_product(by_phi, by_next);
  }
  blocks[0][0] = blocks[0][0] + adjoint_rows(conj(m.value));
  const auto snap = [](const auto& x) {
    if constexpr (contains_tag<T, screw_tag>()) {
      return T(x.value().epsilon(), x.epsilon().epsilon());
    } else {
      return T(x.epsilon());
    }
  };
  const R two(2);
  set_frame(
      result, side, quaternion<T>(ends[0] * m.value),
      {two * m.velocity, two * m.acceleration, two * m.jerk,
       two * three_vector<T>{snap(in_time.jerk.x), snap(in_time.jerk.y), snap(in_time.jerk.z)}},
      [&](std::size_t i) { return adjoint_rows(conj(ends[i])); });
  return result;
}

} // namespace detail

/// Hermite curve, C¹, through rotations or poses with a given velocity at each: Q(u) = Q_i
/// exp(x_i(u − u_i)) with cubic x_i. No equations are solved. For smooth motion it is fourth-order
/// accurate in value, third in velocity.
///
/// \param samples     data points Q_i, unit quaternions or poses; signs are aligned first
/// \param velocities  angular velocities, for poses twists [v; ω], per unit of the parameter
/// \param frame       axes of the velocities: `frame::spatial` or `frame::body`
/// \return `rotation_vector_spline<T, 4>`
/// \throws invalid_sample for a data point that no curve can pass through, and for a velocity that
/// is not finite
/// \throws invalid_input for fewer than two data points or counts that differ
template <class Q, class V, FrameConstant Frame>
[[nodiscard]] auto hermite_spline(const std::vector<real_type_t<Q>>& parameters,
                                  const std::vector<quaternion<Q>>& samples,
                                  const std::vector<V>& velocities, Frame frame) {
  using T = promote_t<Q, typename V::Scalar>;
  detail::check_samples("hermite_spline", parameters, samples.size(), 2);
  detail::require(velocities.size() == samples.size(), "duet: hermite_spline: ", samples.size(),
                  " samples, but ", velocities.size(), " velocities");
  auto elements =
      align_quaternion_signs(std::vector<quaternion<T>>(samples.begin(), samples.end()));
  std::vector<std::array<vector3<T>, 1>> rates;
  rates.reserve(velocities.size());
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    if (!velocities[i].allFinite()) {
      detail::raise(invalid_sample(i, "the velocity is not finite"));
    }
    const vector3<T> half = detail::half_rate<T>(velocities[i]);
    if constexpr (detail::is_spatial(frame)) {
      rates.push_back({rotate(conj(elements[i]), half)});
    } else {
      rates.push_back({half});
    }
  }
  return rotation_vector_spline<T, 4>(parameters, std::move(elements), rates);
}

/// Rejected: velocities without their frame, which would be ambiguous.
template <class T, class V>
DUET_REFUSED(
    "the frame is missing: hermite_spline(parameters, elements, velocities, frame::spatial) or "
    "frame::body")
rotation_vector_spline<T, 4> hermite_spline(const std::vector<real_type_t<T>>&,
                                            const std::vector<quaternion<T>>&,
                                            const std::vector<V>&);

} // namespace duet
