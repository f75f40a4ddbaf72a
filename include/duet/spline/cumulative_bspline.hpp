// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/tangent.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/location.hpp>
#include <duet/spline/motion.hpp>
#include <duet/spline/orientations.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <sstream>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// The cumulative B-spline curve over rotations and poses (P2), with exact rates (P3, P4).

namespace duet {

/// Q(u) = q_0 ∏_{i≥1} exp(ω_i B̃_i(u)), ω_i = log(q_{i−1}⁻¹ q_i): order k (degree k − 1), C^{k−2} at
/// simple knots.
///
/// \tparam T      scalar of the control elements: of rotations `double`, of poses
///                `dual<double, 1, screw_tag>`, either with any infinitesimals
/// \tparam Order  k; 4 is the cubic
///
/// Control elements are numbered from 0 here (the paper's q_{−1}). The ω_i are half-angle vectors,
/// computed once; evaluation uses no heap. Rates are with respect to u: rad per unit of u, of poses
/// twists [v; ω] per unit of u.
template <class T, int Order = 4>
class cumulative_bspline {
public:
  using scalar_type = T;
  using real_type = real_type_t<T>;
  using basis_type = bspline_basis<Order, real_type>;
  static constexpr int order = Order;
  /// Against smooth motion, interpolation misses by as much as this power of the step.
  static constexpr int convergence = 3;

  /// As many control elements as the basis, or what its knots make, has functions. They are
  /// normalised, and their signs aligned from the first to the last, so that the curve takes the
  /// short way round. \throws invalid_input for a count that does not match, and as
  /// `aligned_orientations`
  cumulative_bspline(basis_type basis, std::vector<quaternion<T>> controls)
      : basis_(std::move(basis)), controls_(aligned_orientations(std::move(controls))) {
    check_count("control elements", controls_.size());
    increments_.reserve(controls_.size());
    increments_.push_back(vector3<T>::Zero());
    for (std::size_t i = 1; i < controls_.size(); ++i) {
      increments_.push_back(log(conj(controls_[i - 1]) * controls_[i]).vec());
    }
  }

  cumulative_bspline(std::vector<real_type> knots, std::vector<quaternion<T>> controls)
      : cumulative_bspline(basis_type(std::move(knots)), std::move(controls)) {}

  /// The same with signs as they are and with increments of any length: how to go the long way
  /// round, several times too, and how to make a copy from another curve's `controls()` and
  /// `increments()`. ω_0 does not count.
  /// \throws invalid_input for counts that do not match; invalid_row as `unit_quaternions`, and
  /// where exp(ω_i) is not q_{i−1}⁻¹ q_i
  cumulative_bspline(basis_type basis, std::vector<quaternion<T>> controls,
                     std::vector<vector3<T>> increments)
      : basis_(std::move(basis)), controls_(unit_quaternions(std::move(controls))),
        increments_(std::move(increments)) {
    check_count("control elements", controls_.size());
    check_count("increments", increments_.size());
    for (std::size_t i = 1; i < controls_.size(); ++i) {
      const auto step = conj(controls_[i - 1]) * controls_[i];
      const auto miss = detail::innermost_of(step - duet::exp(increments_[i]));
      if (!(norm(miss) <= real_type(unit_norm_tolerance))) {
        throw invalid_row(i, "the increment does not lead here from the control before");
      }
    }
    increments_.front() = vector3<T>::Zero();
  }

  [[nodiscard]] const basis_type& basis() const { return basis_; }
  [[nodiscard]] const std::vector<quaternion<T>>& controls() const { return controls_; }
  /// ω_i with exp(ω_i) = q_{i−1}⁻¹ q_i, half angles; ω_0 is zero.
  [[nodiscard]] const std::vector<vector3<T>>& increments() const { return increments_; }

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

  /// Q, Q′ = Q w, Q″ = Q (a − |w|²) and Q‴ = Q (j − |w|² w + w × a − 3 w·a), with halved rates in
  /// body axes (P3, P4 in their true form).
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
  struct no_hint {};

  void check_count(const char* what, std::size_t count) const {
    if (count != basis_.size()) {
      std::ostringstream message;
      message << "duet: cumulative_bspline: " << basis_.knots().size() << " knots of order "
              << Order << " take " << basis_.size() << " " << what << ", got " << count;
      throw invalid_input(message.str());
    }
  }

  template <int Rates, class S, class Hint>
  [[nodiscard]] DUET_ALWAYS_INLINE auto evaluate(const S& parameter, Hint&& hint) const {
    using P = std::conditional_t<Arithmetic<S>, real_type, S>;
    P u(parameter);
    const auto value = static_cast<real_type>(innermost(u));
    std::size_t span = 0;
    bool is_at_rest = false;
    if (!basis_.contains(value)) [[unlikely]] {
      span = span_beside(value);
      is_at_rest = outside_ == outside::clamp;
      if (is_at_rest) {
        u = P(value < basis_.front() ? basis_.front() : basis_.back());
      }
    } else if constexpr (std::is_same_v<std::decay_t<Hint>, span_hint>) {
      span = basis_.span_of(value, hint);
    } else {
      span = basis_.span_of(value);
    }
    auto m = evaluate_on<Rates>(span, u);
    if (Rates > 0 && is_at_rest) [[unlikely]] {
      m.velocity.setZero();
      m.acceleration.setZero();
      m.jerk.setZero();
    }
    return m;
  }

  template <int Rates, class P>
  [[nodiscard]] DUET_ALWAYS_INLINE auto evaluate_on(std::size_t span, const P& u) const {
    using D = promote_t<T, P>;
    const std::size_t first = basis_.first_function(span);
    const auto weights = basis_.template weights<Rates>(span, u);
    if constexpr (std::same_as<D, T>) {
      return detail::product_of_exponentials<Rates>(controls_[first], &increments_[first + 1],
                                                    weights);
    } else {
      std::array<vector3<D>, std::size_t(Order) - 1> increments;
      for (std::size_t j = 0; j < increments.size(); ++j) {
        increments[j] = increments_[first + 1 + j].template cast<D>();
      }
      return detail::product_of_exponentials<Rates>(quaternion<D>(controls_[first]),
                                                    increments.data(), weights);
    }
  }

  /// The first or last span, for what is outside the domain.
  /// \throws invalid_input where there is no going on
  [[nodiscard, gnu::cold]] std::size_t span_beside(const real_type& u) const {
    const bool is_usable = outside_ == outside::clamp ? u == u : u - u == 0;
    if (outside_ == outside::error || !is_usable) {
      return basis_.span_of(u); // throws
    }
    return u < basis_.front() ? 0 : basis_.breaks().size() - 2;
  }

  basis_type basis_;
  std::vector<quaternion<T>> controls_;
  std::vector<vector3<T>> increments_;
  outside outside_ = outside::error;
};

} // namespace duet
