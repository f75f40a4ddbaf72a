// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/lanes.hpp>
#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/exponential_jacobian.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/knots.hpp>
#include <duet/spline/motion.hpp>
#include <duet/spline/orientations.hpp>
#include <duet/spline/piecewise_curve.hpp>
#include <duet/spline/rotation_vector_segment.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Piecewise-polynomial rotation vectors: curves that are more accurate than the cumulative ones of
/// the same order.

namespace duet {

namespace detail {
template <class T, int Order, class Piece>
class rotation_vector_equations;
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
  /// apart or so close that derivatives overflow
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
  /// apart or so close that derivatives overflow
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

  /// \throws invalid_input if parameters are so far apart, or so close, that derivatives overflow
  [[nodiscard]] static knot_spans<real_type> spans_over(const std::vector<real_type>& u) {
    const auto is_finite = [](const real_type& x) { return x - x == 0; };
    detail::require(is_finite(u.back() - u.front()),
                    "duet: rotation_vector_spline: the distance from ", u.front(), " to ", u.back(),
                    " overflows");
    for (std::size_t i = 0; i + 1 < u.size(); ++i) {
      detail::require(is_finite(1 / (u[i + 1] - u[i])), "duet: rotation_vector_spline: parameter ",
                      i, " = ", u[i], " and parameter ", i + 1, " = ", u[i + 1],
                      " are too close: a derivative overflows");
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

} // namespace duet
