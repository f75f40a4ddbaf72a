// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/tangent.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/motion.hpp>
#include <duet/spline/orientations.hpp>

#include <array>
#include <cstddef>
#include <sstream>
#include <utility>
#include <vector>

/// \file
/// The cumulative B-spline curve over rotations (P2), with exact rates (P3, P4).

namespace duet {

/// For control quaternions: q and −q, the same rotation, are not to be exchanged.
struct signs_as_given {};

/// Q(u) = q_0 ∏_{i≥1} exp(ω_i B̃_i(u)), ω_i = log(q_{i−1}⁻¹ q_i): order k (degree k − 1), C^{k−2} at
/// simple knots.
///
/// \tparam T      scalar of the control quaternions
/// \tparam Order  k; 4 is the cubic
///
/// Control elements are numbered from 0 here (the paper's q_{−1}). The ω_i are half-angle vectors,
/// computed once; evaluation uses no heap. Rates are with respect to u: rad per unit of u.
template <class T, int Order = 4>
class cumulative_bspline {
public:
  using scalar_type = T;
  using real_type = real_type_t<T>;
  using basis_type = bspline_basis<Order, real_type>;
  static constexpr int order = Order;

  /// As many control quaternions as the knots have basis functions. They are normalised, and their
  /// signs aligned from the first to the last, so that the curve takes the short way round.
  /// \throws invalid_input for a count that does not match, and as `aligned_orientations`
  cumulative_bspline(std::vector<real_type> knots, std::vector<quaternion<T>> controls)
      : cumulative_bspline(std::move(knots), aligned_orientations(std::move(controls)),
                           signs_as_given{}) {}

  /// The same with the signs as they are: from q_{i−1} to −q_i is the other way round than to q_i.
  /// This is how to make a copy from another curve's `controls()`.
  /// \throws invalid_input for a count that does not match, and as `unit_quaternions`
  cumulative_bspline(std::vector<real_type> knots, std::vector<quaternion<T>> controls,
                     signs_as_given)
      : basis_(std::move(knots)), controls_(unit_quaternions(std::move(controls))) {
    if (controls_.size() != basis_.size()) {
      std::ostringstream message;
      message << "duet: cumulative_bspline: " << basis_.knots().size() << " knots of order "
              << Order << " take " << basis_.size() << " control quaternions, got "
              << controls_.size();
      throw invalid_input(message.str());
    }
    increments_.reserve(controls_.size());
    increments_.push_back(vector3<T>::Zero());
    for (std::size_t i = 1; i < controls_.size(); ++i) {
      increments_.push_back(log(conj(controls_[i - 1]) * controls_[i]).vec());
    }
  }

  [[nodiscard]] const basis_type& basis() const { return basis_; }
  [[nodiscard]] const std::vector<quaternion<T>>& controls() const { return controls_; }
  /// ω_i = log(q_{i−1}⁻¹ q_i), half angles; ω_0 is zero.
  [[nodiscard]] const std::vector<vector3<T>>& increments() const { return increments_; }

  /// Q(u).
  /// \throws invalid_input outside the domain
  template <class S>
  [[nodiscard]] auto operator()(const S& u) const {
    return evaluate<0>(u).value;
  }

  /// Value, angular velocity, acceleration and jerk with respect to u.
  /// \throws invalid_input outside the domain
  template <class S, class Frame>
  [[nodiscard]] DUET_ALWAYS_INLINE auto motion(const S& u, Frame frame_of_result) const {
    auto m = evaluate<3>(u);
    using D = typename decltype(m.value)::scalar_type;
    if constexpr (detail::is_spatial(frame_of_result)) {
      m.jerk = detail::sum<2>(m.jerk, detail::cross(m.velocity, m.acceleration));
      m.velocity = rotate(m.value, m.velocity);
      m.acceleration = rotate(m.value, m.acceleration);
      m.jerk = rotate(m.value, m.jerk);
    }
    const real_type_t<D> two(2);
    return duet::motion<D>{m.value, detail::product(two, m.velocity),
                           detail::product(two, m.acceleration), detail::product(two, m.jerk)};
  }

  /// Q, Q′ = Q w and Q″ = Q (a − |w|²) (P3, P4 in their true form).
  /// \throws invalid_input outside the domain
  template <class S>
  [[nodiscard]] auto derivatives(const S& u) const {
    const auto m = evaluate<2>(u);
    using Q = std::decay_t<decltype(m.value)>;
    using D = typename Q::scalar_type;
    return std::array<Q, 3>{m.value, m.value * Q(D(0), m.velocity),
                            m.value * Q(-m.velocity.squaredNorm(), m.acceleration)};
  }

private:
  template <int Rates, class S>
  [[nodiscard]] DUET_ALWAYS_INLINE auto evaluate(const S& parameter) const {
    using P = std::conditional_t<Arithmetic<S>, real_type, S>;
    using D = promote_t<T, P>;
    const P u(parameter);
    const std::size_t span = basis_.span_of(static_cast<real_type>(innermost(u)));
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

  basis_type basis_;
  std::vector<quaternion<T>> controls_;
  std::vector<vector3<T>> increments_;
};

} // namespace duet
