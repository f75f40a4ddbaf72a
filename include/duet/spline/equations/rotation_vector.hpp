// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/spline/blocks.hpp>
#include <duet/spline/end_conditions.hpp>
#include <duet/spline/equations/newton.hpp>
#include <duet/spline/orientations.hpp>
#include <duet/spline/rotation_vector_spline.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

/// \file
/// Equations for the rates at the knots of cubic and quintic rotation-vector splines.

namespace duet::detail {

/// Vector equation at an end: the derivative of w of this order has a given value (joint 0), or is
/// equal on both sides of the joint-th inner knot, counted from the end.
struct end_equation {
  std::size_t joint, derivative;
};

/// End conditions of a rotation-vector spline of order k: k/2 − 1 equations at each end, the same
/// at both ends except for the given values; no equations if periodic. The highest derivative of w
/// on a segment is the (k−2)-th.
template <class T, int Order>
struct rotation_vector_ends {
  static constexpr std::size_t rates_per_end = std::size_t(Order) / 2 - 1;
  static constexpr std::size_t highest = std::size_t(Order) - 2;

  bool is_cyclic;
  std::array<end_equation, rates_per_end> equations;
  /// Values of the equations with joint 0: halved rates in body axes, at the start and at the end.
  std::array<std::array<vector3<T>, rates_per_end>, 2> values;

  rotation_vector_ends(const curve_ends<T>& ends, const quaternion<T>& first,
                       const quaternion<T>& last)
      : is_cyclic(ends.kind == end_condition_kind::periodic), equations(equations_of(ends.kind)) {
    for (std::size_t k = 0; k < rates_per_end; ++k) {
      for (const std::size_t end : {0U, 1U}) {
        // The third derivative, if prescribed, is zero: no snap.
        const auto& rates = equations[k].derivative == 0 ? ends.velocity : ends.acceleration;
        values[end][k] = equations[k].derivative < 2
                             ? rotate(conj(end == 0 ? first : last), rates[end])
                             : vector3<T>(vector3<T>::Constant(T(real_type_t<T>(0))));
      }
    }
  }

  /// Highest joint; equations reach one knot further.
  [[nodiscard]] std::size_t reach() const { return reach(equations); }
  /// Minimum number of samples; fewer leave an equation without its knots, or make two equations
  /// equal.
  [[nodiscard]] static std::size_t min_samples(end_condition_kind kind) {
    return kind == end_condition_kind::periodic ? 3 : 2 + 2 * reach(equations_of(kind));
  }

private:
  [[nodiscard]] static std::array<end_equation, rates_per_end>
  equations_of(end_condition_kind kind) {
    // In the order of the kinds; the cubic uses the first column. Natural ends have no snap: a
    // curve reflected at such an end is smooth.
    constexpr end_equation all[][2] = {
        {{0, 1}, {0, 3}}, {{0, 0}, {1, highest}},       {{0, 1}, {1, highest}},
        {{0, 0}, {0, 1}}, {{1, highest}, {2, highest}}, {{0, 0}, {0, 0}}};
    std::array<end_equation, rates_per_end> result;
    std::copy_n(all[std::size_t(kind)], rates_per_end, result.begin());
    return result;
  }
  [[nodiscard]] static std::size_t reach(const std::array<end_equation, rates_per_end>& equations) {
    return equations.back().joint; // no less than that of the first
  }
};

/// Samples of a rotation-vector spline, as steps and rotations between neighbours, and its end
/// conditions. The unit of the parameter is about one step, so that all derivatives are of similar
/// size.
///
/// \tparam Piece  segment, constructed from a step and a rotation, which are constant while rates
///                are solved for
template <class T, int Order, class Piece>
class rotation_vector_equations {
protected:
  using R = real_type_t<T>;
  using ends_type = rotation_vector_ends<T, Order>;

public:
  using real_type = R;

  /// \param u     increasing parameters, as many as `ends` need or more
  /// \param q     as many unit quaternions or poses, signs aligned
  /// \param ends  end conditions
  rotation_vector_equations(const std::vector<R>& u, const std::vector<quaternion<T>>& q,
                            const curve_ends<T>& ends)
      : ends_(ends, q.front(), q.back()) {
    using std::frexp;
    using std::ldexp;
    const std::size_t last = u.size() - 1;
    int exponent = 0;
    static_cast<void>(frexp(R((u.back() - u.front()) / R(last)), &exponent));
    unit_ = ldexp(R(1), exponent);
    steps_.resize(last);
    rotations_.resize(last);
    for (std::size_t i = 0; i < last; ++i) {
      steps_[i] = (u[i + 1] - u[i]) / unit_;
      rotations_[i] = log_out_of_line(relative_rotation(q[i], q[i + 1]));
    }
    make_pieces();
  }

  [[nodiscard]] static std::size_t min_samples(end_condition_kind kind) {
    return ends_type::min_samples(kind);
  }

  /// Changes the equations to those of a smaller motion: rotations between samples and rates at the
  /// ends times λ.
  void scale(const R& lambda) {
    for (vector3<T>& half_angle : rotations_) {
      half_angle = lambda * components(half_angle);
    }
    for (auto& end : ends_.values) {
      for (vector3<T>& rate : end) {
        rate = lambda * components(rate);
      }
    }
    make_pieces();
  }

  /// Ratio of the longest to the shortest interval of the parameter.
  [[nodiscard]] R unevenness() const {
    const auto [shortest, longest] = std::minmax_element(steps_.begin(), steps_.end());
    return *longest / *shortest;
  }

  /// Largest rotation angle between neighbouring samples, rad, and the index of the sample before
  /// it.
  [[nodiscard]] std::pair<R, std::size_t> max_rotation() const {
    return largest_rotation(rotations_);
  }

  /// Size of a step from x relative to the values it changes. The unknowns are several rates at
  /// each knot, from velocities upwards: each is compared with its own size and with the size that
  /// follows from the rotations of the adjacent segments. For real T.
  template <int N>
  [[nodiscard]] R relative_step(const std::vector<Eigen::Matrix<R, N, 1>>& x,
                                const std::vector<Eigen::Matrix<R, N, 1>>& step) const {
    R result(0);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto [left, right] = segments_at(i);
      R size = std::max(R(length(rotations_[left]) / steps_[left]),
                        R(length(rotations_[right]) / steps_[right]));
      for (int k = 0; k < N; k += 3) {
        const R moved = length(step[i], k);
        const R now = length(x[i], k);
        const R ratio = moved > 0 ? R(moved / std::max(size, std::max(now, moved))) : moved;
        result = larger_or_nan(result, ratio);
        size /= std::max(steps_[left], steps_[right]);
      }
    }
    return result;
  }

protected:
  /// Number of knots; the first and the last knot of a closed curve count once.
  [[nodiscard]] std::size_t knots() const { return steps_.size() + (ends_.is_cyclic ? 0 : 1); }

  /// Segments before and after a knot; twice the same at an end.
  [[nodiscard]] std::pair<std::size_t, std::size_t> segments_at(std::size_t knot) const {
    const std::size_t last = steps_.size() - 1;
    return {knot > 0 ? knot - 1 : ends_.is_cyclic ? last : 0, std::min(knot, last)};
  }

  /// Velocity and acceleration at a sample of the parabola through it and its neighbours, as for
  /// small rotations.
  [[nodiscard]] std::pair<vector3<T>, vector3<T>> parabola(std::size_t i) const {
    const auto [left, right] = segments_at(i);
    const R h = steps_[left] + steps_[right];
    std::pair<vector3<T>, vector3<T>> result;
    for (int k = 0; k < 3; ++k) {
      const T before = rotations_[left][k] / steps_[left],
              after = rotations_[right][k] / steps_[right];
      result.first[k] = (before * steps_[right] + after * steps_[left]) / h;
      result.second[k] = (after - before) * (2 / h);
    }
    return result;
  }

  /// Power of the unit of the parameter.
  [[nodiscard]] R unit_to(std::size_t exponent) const {
    R result(1);
    for (std::size_t i = 0; i < exponent; ++i) {
      result *= unit_;
    }
    return result;
  }

  using curve = rotation_vector_spline<T, Order>;
  /// Curve with these polynomials, whose parameter is in multiples of the unit.
  [[nodiscard]] curve made_of(const std::vector<R>& u, std::vector<quaternion<T>> q,
                              std::vector<typename curve::polynomial> polynomials) const {
    for (auto& each : polynomials) {
      R per_unit(1);
      for (vector3<T>& coefficient : each) {
        coefficient = per_unit * components(coefficient);
        per_unit /= unit_;
      }
    }
    return curve(typename curve::from_segments_tag(), u, std::move(q), std::move(polynomials));
  }

  ends_type ends_;
  R unit_;
  std::vector<R> steps_;              ///< steps of the parameter, in multiples of the unit
  std::vector<vector3<T>> rotations_; ///< rotations between samples, half-angle vectors
  std::vector<Piece> pieces_;

private:
  void make_pieces() {
    pieces_.clear();
    pieces_.reserve(steps_.size());
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      pieces_.emplace_back(steps_[i], rotations_[i]);
    }
  }
};

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

  /// x_1 … x_4 and y_1 … y_4.
  using ends = std::array<coefficients, 2>;
  [[nodiscard]] ends taylor(const coefficients& at_start, const coefficients& at_end) const {
    return {segment_.template taylor_at<0>(at_start), segment_.template taylor_at<1>(at_end)};
  }

  /// Derivatives with respect to all rates of a knot, w_0 … w_3.
  using gradient = Eigen::Matrix<R, 3, 3 * int(count)>;
  /// Derivatives of x_1 … x_4 with respect to the rates at the start, and of y_1 … y_4 with respect
  /// to those at the end. For real T.
  [[nodiscard]] std::array<std::array<gradient, count>, 2> taylor_gradients(const ends& e) const {
    return {inverted(segment_.gradients_at(0, e[0]), matrix3<R>::Identity()),
            inverted(segment_.gradients_at(1, e[1]), segment_.inverse())};
  }

  /// Factors of x_1 … x_4 and of y_1 … y_4 in the equations, with right sides taken to the left;
  /// the equations of second and third rates are multiplied by l and l², which scales them to the
  /// size of the others.
  [[nodiscard]] std::array<factors, 2> factors_of_ends(const R& l) const {
    const R h = h_, hh = h * h, ll = l * l, o(0);
    return {factors{{{R(1), h, hh, R(hh * h * 4 / 5)},
                     {R(-1), R(-2 * h), R(-3 * hh), R(-3 * hh * h)},
                     {o, R(-l), R(-3 * h * l), R(-4 * hh * l)},
                     {o, o, R(-ll), R(-2 * h * ll)}}},
            factors{{{o, o, o, R(hh * h / 5)},
                     {R(1), o, o, R(-hh * h)},
                     {o, l, o, R(-2 * hh * l)},
                     {o, o, ll, R(-2 * h * ll)}}}};
  }
  /// Residuals of the equations for x and y.
  [[nodiscard]] coefficients residuals(const ends& e, const R& l) const {
    const auto [a, b] = factors_of_ends(l);
    coefficients result;
    for (std::size_t m = 0; m < count; ++m) {
      three_vector<T> sum = R(m > 0 ? 0 : -1 / h_) * components(d_);
      for (std::size_t k = 0; k < count; ++k) {
        sum = sum + (a[m][k] * components(e[0][k]) + b[m][k] * components(e[1][k]));
      }
      result[m] = sum;
    }
    return result;
  }

  /// Contributions of the rates at the start and at the end to the fifth rate w_4 at an end, where
  /// x_5 = (x_4 − x_4 of the other end)/(5h), with the sign of h towards the other.
  template <std::size_t End>
  [[nodiscard]] std::array<vector3<T>, 2> last_rate_at(const ends& e) const {
    constexpr std::size_t other = 1 - End;
    const R per_h = R(End == 0 ? -1 : 1) / h_;
    const auto in_body_axes = [&](const vector3<T>& x, const R& factor) {
      return components(
          segment_.template rates_at<End>(std::array<vector3<T>, 1>{factor * components(x)})[0]);
    };
    std::array<vector3<T>, 2> result;
    result[End] = components(segment_.template rates_at<End>(with_zero(e[End]))[count]) +
                  in_body_axes(e[End][3], per_h);
    result[other] = in_body_axes(e[other][3], R(-per_h));
    return result;
  }
  /// Derivatives of these two contributions, each with respect to the rates of its knot. For real
  /// T.
  [[nodiscard]] std::array<gradient, 2> last_rate_gradients_at(std::size_t end,
                                                               const ends& e) const {
    const std::size_t other = 1 - end;
    const R per_h = R(end == 0 ? -1 : 1) / h_;
    const auto by = taylor_gradients(e);
    const auto of = segment_.gradients_at(end, with_zero(e[end]));
    std::array<gradient, 2> result{gradient::Zero(), gradient::Zero()};
    for (std::size_t m = 0; m < count; ++m) {
      add_product(result[end], R(1), of[count][m], by[end][m]);
    }
    add_product(result[end], per_h, of[0][0], by[end][count - 1]);
    add_product(result[other], R(-per_h), of[0][0], by[other][count - 1]);
    return result;
  }

  /// Coefficients x_0 … x_5.
  [[nodiscard]] std::array<vector3<T>, 6> polynomial(const ends& e) const {
    const auto& [x, y] = e;
    std::array<vector3<T>, 6> result;
    result[0] = vector3<T>::Constant(T(R(0)));
    for (int k = 0; k < 3; ++k) {
      result[1][k] =
          d_[k] / h_ - h_ * (x[1][k] + h_ * (x[2][k] + h_ * ((4 * x[3][k] + y[3][k]) / 5)));
      result[2][k] = x[1][k];
      result[3][k] = x[2][k];
      result[4][k] = x[3][k];
      result[5][k] = (y[3][k] - x[3][k]) / (5 * h_);
    }
    return result;
  }

private:
  [[nodiscard]] static std::array<vector3<T>, count + 1> with_zero(const coefficients& x) {
    return {x[0], x[1], x[2], x[3], vector3<T>::Constant(T(R(0)))};
  }

  template <std::size_t Count>
  using rate_gradients = std::array<std::array<matrix3<R>, Count>, Count>;

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

/// Equations for the first rate w_0 of each knot, half the angular velocity in body axes. The next
/// rate must be equal on both sides of an inner knot, which involves the knot and its two
/// neighbours; an end condition at each end completes the system.
template <class T>
class rotation_vector_cubic_equations
    : public rotation_vector_equations<T, 4, rotation_vector_segment<T, 4>> {
  using piece = rotation_vector_segment<T, 4>;
  using base = rotation_vector_equations<T, 4, piece>;
  using base::ends_, base::steps_, base::pieces_;
  using typename base::ends_type, typename base::R;
  static constexpr std::size_t highest = ends_type::highest;
  using polynomial = std::array<vector3<T>, 4>;

public:
  using curve_type = rotation_vector_spline<T, 4>;
  using unknown = vector3<T>;
  using unknowns = std::vector<unknown>;
  using matrix = block_tridiagonal<R>;

  using base::base;

  /// Initial guess of Newton's method: velocities of parabolas through three samples, as for small
  /// rotations.
  [[nodiscard]] unknowns start() const {
    unknowns x(this->knots());
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = this->parabola(i).first;
    }
    return x;
  }

  /// Residuals of the equations at x.
  void residuals(const unknowns& x, unknowns& r) const {
    r.resize(x.size());
    for (unknown& each : r) {
      each = unknown::Constant(T(R(0)));
    }
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const auto w = pieces_[i].rates(polynomial_of(i, x), rates_of(i));
      for_each_term(i, [&](std::size_t row, int sign, std::size_t end, std::size_t derivative) {
        for (int a = 0; a < 3; ++a) {
          r[row][a] += sign * w[end][derivative][a];
        }
      });
    }
    if (!ends_.is_cyclic) {
      const R scale = this->unit_to(ends_.equations[0].derivative + 1);
      for (int a = 0; a < 3; ++a) {
        r.front()[a] -= ends_.values[0][0][a] * scale;
        r.back()[a] -= ends_.values[1][0][a] * scale;
      }
    }
  }

  /// Computes residuals and the factorised Jacobian; false if it is singular. For real T.
  [[nodiscard]] bool linearise(const unknowns& x, unknowns& r, matrix& jacobian) const {
    static_assert(Real<T>);
    residuals(x, r);
    auto& rows = jacobian.rows();
    rows.resize(x.size());
    for (auto& row : rows) {
      row.lower = row.diagonal = row.upper = matrix3<R>::Zero();
    }
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const auto gradients =
          pieces_[i].gradients_by_velocities(x[i], x[(i + 1) % x.size()], rates_of(i));
      for_each_term(i, [&](std::size_t row, int sign, std::size_t end, std::size_t derivative) {
        const std::size_t equation = ends_.is_cyclic && row < i ? i + 1 : row;
        for (const std::size_t k : {0U, 1U}) {
          // The third block of an end equation is stored at the position of the corner block.
          add_multiple(rows[row].at((4 + i + k - equation) % 3), R(sign),
                       gradients[end][derivative][k]);
        }
      });
    }
    const std::size_t last = pieces_.size(), reach = ends_.reach();
    return jacobian.factorise(ends_.is_cyclic ? corners{last - 1, 0}
                                              : corners{1 + reach, last - 1 - reach});
  }

  /// Curve of a solution. Segments that meet at a knot are computed from the same rates at it.
  [[nodiscard]] curve_type curve(const std::vector<R>& u, std::vector<quaternion<T>> q,
                                 const unknowns& x) const {
    std::vector<polynomial> pieces(pieces_.size());
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      pieces[i] = polynomial_of(i, x);
    }
    share_accelerations(pieces);
    return this->made_of(u, std::move(q), std::move(pieces));
  }

private:
  /// Recomputes the polynomials from accelerations at the knots, each of which is evaluated on the
  /// longer adjacent segment, where it is most accurate.
  void share_accelerations(std::vector<polynomial>& polynomials) const {
    const std::size_t knots = this->knots();
    std::vector<std::array<vector3<T>, 2>> rates(knots);
    std::vector<R> lengths(knots, R(0));
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const auto w = pieces_[i].rates(polynomials[i], 2);
      for (const std::size_t end : {0U, 1U}) {
        const std::size_t knot = (i + end) % knots;
        if (steps_[i] > lengths[knot]) {
          rates[knot] = {w[end][0], w[end][1]};
          lengths[knot] = steps_[i];
        }
      }
    }
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      polynomials[i] = pieces_[i].polynomial_of_accelerations(rates[i], rates[(i + 1) % knots]);
    }
  }

  [[nodiscard]] polynomial polynomial_of(std::size_t i, const unknowns& x) const {
    return pieces_[i].polynomial({x[i]}, {x[(i + 1) % x.size()]});
  }

  /// Number of derivatives of segment i that equations use; one more near the ends.
  [[nodiscard]] std::size_t rates_of(std::size_t i) const {
    const std::size_t reach = ends_.reach();
    const bool is_at_end = !ends_.is_cyclic && (i <= reach || i + reach + 1 >= pieces_.size());
    return is_at_end ? highest + 1 : highest;
  }

  /// Calls take(row, sign, end, derivative) for every term of piece i in the equations: a
  /// derivative of w at its start (end 0) or its end (1).
  template <class Take>
  void for_each_term(std::size_t i, const Take& take) const {
    const std::size_t last = pieces_.size();
    if (ends_.is_cyclic || i > 0) {
      take(i, -1, 0, 1);
    }
    if (ends_.is_cyclic || i + 1 < last) {
      take((i + 1) % last, 1, 1, 1);
    }
    if (!ends_.is_cyclic) {
      const auto [joint, derivative] = ends_.equations[0];
      if (joint == i) {
        take(0, joint > 0 ? -1 : 1, 0, derivative);
      }
      if (joint == i + 1) {
        take(0, 1, 1, derivative);
      }
      if (joint > 0 && i + joint == last) {
        take(last, -1, 0, derivative);
      }
      if (i + joint + 1 == last) {
        take(last, 1, 1, derivative);
      }
    }
  }
};

template <class Own, class T>
struct equations_of<rotation_vector_spline<Own, 4>, T> {
  using type = rotation_vector_cubic_equations<T>;
};

/// Equations for all rates w_0 … w_3 that the segments share at each knot: those of every segment,
/// and two at each end. With w_0 and w_1 as the only unknowns, w_2 and w_3 would be differences
/// divided by powers of h, which lose all digits for a segment much shorter than its neighbours.
template <class T>
class rotation_vector_quintic_equations : public rotation_vector_equations<T, 6, quintic_piece<T>> {
  using piece = quintic_piece<T>;
  using base = rotation_vector_equations<T, 6, piece>;
  using base::ends_, base::steps_, base::pieces_;
  using typename base::R;
  static constexpr std::size_t count = piece::count;
  static constexpr int n = 3 * int(count);

public:
  using curve_type = rotation_vector_spline<T, 6>;
  using unknown = Eigen::Matrix<T, n, 1>;
  using unknowns = std::vector<unknown>;
  using matrix = block_band_lu<R, n>;

  rotation_vector_quintic_equations(const std::vector<R>& u, const std::vector<quaternion<T>>& q,
                                    const curve_ends<T>& ends)
      : base(u, q, ends), lengths_(this->knots(), R(0)) {
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      for (const std::size_t knot : {i, next(i)}) {
        lengths_[knot] = std::max(lengths_[knot], steps_[i]);
      }
    }
  }

  /// Initial guess of Newton's method: rates of parabolas through three samples, as for small
  /// rotations.
  [[nodiscard]] unknowns start() const {
    unknowns x(lengths_.size(), unknown::Zero());
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto [velocity, acceleration] = this->parabola(i);
      x[i].template head<3>() = velocity;
      x[i].template segment<3>(3) = acceleration;
    }
    return x;
  }

  /// Residuals of the equations at x: of each piece, then of the ends.
  void residuals(const unknowns& x, unknowns& r) const {
    r.assign(x.size(), unknown::Constant(T(R(0))));
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const auto of_piece = pieces_[i].residuals(taylor(i, x), scale_of(i));
      for (std::size_t m = 0; m < count; ++m) {
        r[i].template segment<3>(3 * int(m)) = of_piece[m];
      }
    }
    for_each_end_equation([&](std::size_t end, std::size_t k, std::size_t knot, const R& scale) {
      vector3<T> of_end;
      const auto [joint, derivative] = ends_.equations[k];
      if (joint == 0) {
        of_end =
            rates(x[knot])[derivative] - ends_.values[end][k] * T(this->unit_to(derivative + 1));
      } else {
        const auto before = pieces_[knot - 1].template last_rate_at<1>(taylor(knot - 1, x));
        const auto after = pieces_[knot].template last_rate_at<0>(taylor(knot, x));
        of_end = before[0] + before[1] - after[0] - after[1];
      }
      r.back().template segment<3>(end_row(end, k)) = (scale * components(of_end)).eigen();
    });
  }

  /// Computes residuals and the factorised Jacobian; false if it is singular. For real T.
  [[nodiscard]] bool linearise(const unknowns& x, unknowns& r, matrix& jacobian) const {
    static_assert(Real<T>);
    using equations = typename matrix::equations;
    using panel = typename matrix::panel;
    residuals(x, r);
    // Adds factor · v to three rows.
    const auto add = [](auto&& rows, const R& factor, const typename piece::gradient& v) {
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < n; ++b) {
          rows(a, b) += factor * v(a, b);
        }
      }
    };
    std::vector<equations> groups;
    groups.reserve(pieces_.size() + 4);
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const auto e = pieces_[i].taylor_gradients(taylor(i, x));
      const auto factors = pieces_[i].factors_of_ends(scale_of(i));
      panel at_start = panel::Zero(n, n), at_end = at_start;
      for (std::size_t m = 0; m < count; ++m) {
        for (std::size_t k = 0; k < count; ++k) {
          add(at_start.template middleRows<3>(3 * Eigen::Index(m)), factors[0][m][k], e[0][k]);
          add(at_end.template middleRows<3>(3 * Eigen::Index(m)), factors[1][m][k], e[1][k]);
        }
      }
      equations group{i, i * std::size_t(n), {}, {}};
      if (!ends_.is_cyclic || i + 2 < pieces_.size()) {
        group.coefficients.resize(n, 2 * n);
        group.coefficients << at_start, at_end;
      } else if (i + 2 == pieces_.size()) {
        group.coefficients = at_start;
        group.of_last = at_end;
      } else { // from the last knot to the first one
        group.first = 0;
        group.coefficients = at_end;
        group.of_last = at_start;
      }
      groups.push_back(std::move(group));
    }
    for_each_end_equation([&](std::size_t end, std::size_t k, std::size_t knot, const R& scale) {
      const auto [joint, derivative] = ends_.equations[k];
      const std::size_t row = pieces_.size() * std::size_t(n) + std::size_t(end_row(end, k));
      equations group{joint == 0 ? knot : knot - 1, row, {}, {}};
      if (joint == 0) {
        group.coefficients = panel::Zero(3, n);
        group.coefficients.template middleCols<3>(3 * Eigen::Index(derivative))
            .diagonal()
            .fill(scale);
      } else {
        group.coefficients = panel::Zero(3, 3 * n);
        const auto of = [&](int at) { return group.coefficients.template middleCols<n>(at * n); };
        const auto before = pieces_[knot - 1].last_rate_gradients_at(1, taylor(knot - 1, x));
        const auto after = pieces_[knot].last_rate_gradients_at(0, taylor(knot, x));
        add(of(0), scale, before[0]);
        add(of(1), scale, before[1]);
        add(of(1), R(-scale), after[0]);
        add(of(2), R(-scale), after[1]);
      }
      groups.push_back(std::move(group));
    });
    return jacobian.factorise(units(), std::move(groups), ends_.is_cyclic);
  }

  [[nodiscard]] curve_type curve(const std::vector<R>& u, std::vector<quaternion<T>> q,
                                 const unknowns& x) const {
    std::vector<std::array<vector3<T>, 6>> pieces(pieces_.size());
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      pieces[i] = pieces_[i].polynomial(taylor(i, x));
    }
    return this->made_of(u, std::move(q), std::move(pieces));
  }

private:
  [[nodiscard]] std::size_t next(std::size_t i) const { return (i + 1) % lengths_.size(); }
  /// Factor that scales the rates at a piece's ends to one size.
  [[nodiscard]] R scale_of(std::size_t i) const { return std::min(lengths_[i], lengths_[next(i)]); }

  /// Rates at a knot.
  [[nodiscard]] static typename piece::coefficients rates(const unknown& x) {
    typename piece::coefficients result;
    for (int a = 0; a < n; ++a) {
      result[std::size_t(a / 3)][a % 3] = x[a];
    }
    return result;
  }

  /// Taylor coefficients of piece i for the rates at its knots.
  [[nodiscard]] auto taylor(std::size_t i, const unknowns& x) const {
    return pieces_[i].taylor(rates(x[i]), rates(x[next(i)]));
  }

  /// Calls f(end, k, knot, scale) for equation k of either end at its knot, with the factor that
  /// scales it to the size of the other equations.
  template <class F>
  void for_each_end_equation(F&& f) const {
    for (std::size_t end = 0; end < 2 && !ends_.is_cyclic; ++end) {
      for (std::size_t k = 0; k < 2; ++k) {
        const auto [joint, derivative] = ends_.equations[k];
        const std::size_t knot = end == 0 ? joint : pieces_.size() - joint;
        R scale(1);
        if (joint == 0) {
          for (std::size_t i = 0; i < derivative; ++i) {
            scale *= lengths_[knot];
          }
        } else {
          const R l = std::min({lengths_[knot - 1], lengths_[knot], lengths_[knot + 1]});
          scale = std::min(steps_[knot - 1], steps_[knot]) * l * l * l;
        }
        f(end, k, knot, scale);
      }
    }
  }
  [[nodiscard]] static int end_row(std::size_t end, std::size_t k) {
    return 6 * int(end) + 3 * int(k);
  }

  /// Units of the unknowns at each knot: the rates of a rotation by 1 over the longer adjacent
  /// segment.
  [[nodiscard]] std::vector<typename matrix::block> units() const {
    std::vector<typename matrix::block> result(lengths_.size());
    for (std::size_t i = 0; i < lengths_.size(); ++i) {
      R power(1);
      for (int k = 0; k < int(count); ++k) {
        result[i].template segment<3>(3 * k).fill(power);
        power /= lengths_[i];
      }
    }
    return result;
  }

  std::vector<R> lengths_; ///< length of the longer piece at each knot
};

template <class Own, class T>
struct equations_of<rotation_vector_spline<Own, 6>, T> {
  using type = rotation_vector_quintic_equations<T>;
};

} // namespace duet::detail
