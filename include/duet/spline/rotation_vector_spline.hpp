// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/exponential_rates.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/knots.hpp>
#include <duet/spline/location.hpp>
#include <duet/spline/motion.hpp>
#include <duet/spline/orientations.hpp>
#include <duet/spline/rotation_vector_segment.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <sstream>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Piecewise-polynomial rotation vectors: curves that are more accurate than the cumulative ones of
/// the same order.

namespace duet {

/// Q(u) = Q_i exp(x_i(u − u_i)) between the knots u_i and u_{i+1}, with polynomials x_i of
/// half-angle vectors, x_i(0) = 0, exp(x_i(u_{i+1} − u_i)) = Q_i* Q_{i+1}.
///
/// \tparam T      scalar of the elements: a real number for rotations, dual<R, 1, screw_tag> for
///                poses, derivative duals inside either
/// \tparam Order  4: cubic, made from angular velocities at the knots; 6: quintic, from angular
///                velocities and accelerations
///
/// `interpolate` finds the rates that make the curve C² or, of order 6, C⁴. Given rates make it a
/// Hermite curve, C¹ or C². Rates are with respect to u: rad per unit of u.
template <class T, int Order = 4>
class rotation_vector_spline {
  using segment = detail::rotation_vector_segment<T, Order>;

public:
  using scalar_type = T;
  using real_type = real_type_t<T>;
  static constexpr int order = Order;

  /// The Hermite curve: halved rates at the knots in body axes, element [i][0] is w with Q′ = Q w,
  /// [i][1] its derivative (order 6 only). Elements are normalised and their signs aligned.
  /// \throws invalid_row as `aligned_orientations` and for parameters that do not increase;
  /// invalid_input for fewer than two rows or counts that differ
  rotation_vector_spline(
      const std::vector<real_type>& parameters, std::vector<quaternion<T>> elements,
      const std::vector<std::array<vector3<T>, std::size_t(Order) / 2 - 1>>& half_rates)
      : spans_(clamped_knots(checked(parameters, elements, half_rates), 2)),
        elements_(aligned_orientations(std::move(elements))) {
    pieces_.reserve(parameters.size() - 1);
    for (std::size_t i = 0; i + 1 < parameters.size(); ++i) {
      const segment s(parameters[i + 1] - parameters[i],
                      log(conj(elements_[i]) * elements_[i + 1]).vec());
      pieces_.push_back(s.polynomial(half_rates[i], half_rates[i + 1]));
    }
  }

  /// u_0 … u_n
  [[nodiscard]] const std::vector<real_type>& knots() const { return spans_.breaks(); }
  /// Q_0 … Q_n
  [[nodiscard]] const std::vector<quaternion<T>>& elements() const { return elements_; }

  /// What the curve does outside its domain: `outside::error` until told otherwise.
  [[nodiscard]] outside outside_domain() const { return outside_; }
  void set_outside_domain(outside way) { outside_ = way; }

  /// Q(u).
  /// \throws invalid_input outside the domain, unless told otherwise
  template <class S>
  [[nodiscard]] auto operator()(const S& u) const {
    return evaluate<0>(u, no_hint{}).value;
  }
  template <class S>
  [[nodiscard]] auto operator()(const S& u, span_hint& hint) const {
    return evaluate<0>(u, hint).value;
  }

  /// Value, velocity, acceleration and jerk with respect to u, in `frame::body` or
  /// `frame::spatial`; of poses as twists [v; ω] and their derivatives, and in `frame::hybrid` with
  /// the derivatives of translation(Q) as linear parts.
  /// \throws invalid_input outside the domain, unless told otherwise
  template <class S, class Frame>
  [[nodiscard]] DUET_ALWAYS_INLINE auto motion(const S& u, Frame frame) const {
    return detail::motion_of(evaluate<3>(u, no_hint{}), frame);
  }
  template <class S, class Frame>
  [[nodiscard]] DUET_ALWAYS_INLINE auto motion(const S& u, Frame frame, span_hint& hint) const {
    return detail::motion_of(evaluate<3>(u, hint), frame);
  }

  /// Q, Q′ = Q w, Q″ = Q (w′ − |w|²) and Q‴ = Q (w″ − |w|² w + w × w′ − 3 w·w′), Q w = Q′.
  /// \throws invalid_input outside the domain, unless told otherwise
  template <class S>
  [[nodiscard]] auto derivatives(const S& u) const {
    const auto m = evaluate<3>(u, no_hint{});
    using Q = std::decay_t<decltype(m.value)>;
    using D = typename Q::scalar_type;
    const auto& w = m.velocity;
    const auto& a = m.acceleration;
    const D square = w.squaredNorm();
    const vector3<D> third = m.jerk - w * square + detail::cross(w, a);
    return std::array<Q, 4>{m.value, m.value * Q(D(0), w), m.value * Q(-square, a),
                            m.value * Q(-3 * w.dot(a), third)};
  }

private:
  using polynomial = std::array<vector3<T>, std::size_t(Order)>;
  struct no_hint {};

  template <class Elements, class Rates>
  static const std::vector<real_type>& checked(const std::vector<real_type>& parameters,
                                               const Elements& elements, const Rates& rates) {
    detail::check_rows(parameters, elements.size(), 2);
    if (rates.size() != elements.size()) {
      std::ostringstream message;
      message << "duet: rotation_vector_spline: " << elements.size() << " rows need as many rates, "
              << "got " << rates.size();
      throw invalid_input(message.str());
    }
    return parameters;
  }

  template <std::size_t Rates, class S, class Hint>
  [[nodiscard]] DUET_ALWAYS_INLINE auto evaluate(const S& parameter, Hint&& hint) const {
    using P = std::conditional_t<Arithmetic<S>, real_type, S>;
    const P u(parameter);
    const auto value = static_cast<real_type>(innermost(u));
    if (!spans_.contains(value)) [[unlikely]] {
      return evaluate_outside<Rates>(u, value);
    }
    if constexpr (std::is_same_v<std::decay_t<Hint>, span_hint>) {
      return evaluate_on<Rates>(spans_.span_of(value, hint), u);
    } else {
      return evaluate_on<Rates>(spans_.span_of(value), u);
    }
  }

  /// Q, w, w′, w″.
  template <std::size_t Rates, class P>
  [[nodiscard]] DUET_ALWAYS_INLINE auto evaluate_on(std::size_t i, const P& u) const {
    using D = promote_t<T, P>;
    const auto x = detail::taylor_shift<Rates + 1>(pieces_[i], P(u - knots()[i]));
    detail::half_motion<D> m{elements_[i] * duet::exp(x[0]), {}, {}, {}};
    if constexpr (Rates > 0) {
      const detail::jacobian_coefficients<Rates, D> jacobian(detail::inner_product(x[0], x[0]));
      std::array<vector3<D>, Rates> rates;
      std::copy(x.begin() + 1, x.end(), rates.begin());
      const auto w = detail::half_body_rates(jacobian, x[0], rates);
      m.velocity = w[0];
      if constexpr (Rates > 1) {
        m.acceleration = w[1];
      }
      if constexpr (Rates > 2) {
        m.jerk = detail::product(real_type_t<D>(2), w[2]);
      }
    }
    return m;
  }

  template <std::size_t Rates, class P>
  [[nodiscard, gnu::cold, gnu::noinline]] auto evaluate_outside(const P& u,
                                                                const real_type& value) const {
    const bool is_before = value < spans_.front();
    const std::size_t i = is_before ? 0 : pieces_.size() - 1;
    const bool is_usable = outside_ == outside::extrapolate ? value - value == 0 : value == value;
    if (outside_ == outside::error || !is_usable) {
      static_cast<void>(spans_.span_of(value));
    }
    if (outside_ == outside::extrapolate) {
      return evaluate_on<Rates>(i, u);
    }
    auto m = evaluate_on<Rates>(i, P(is_before ? spans_.front() : spans_.back()));
    m.velocity.setZero();
    m.acceleration.setZero();
    m.jerk.setZero();
    return m;
  }

  bspline_basis<2, real_type> spans_; ///< broken lines over the same knots: it is here to search
  std::vector<quaternion<T>> elements_;
  std::vector<polynomial> pieces_;
  outside outside_ = outside::error;
};

} // namespace duet
