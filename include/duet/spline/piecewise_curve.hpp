// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/batch.hpp>
#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/motion.hpp>

#include <array>
#include <cstddef>
#include <type_traits>
#include <vector>

/// \file
/// Evaluation of piecewise curves: value, rates and behaviour outside the domain.

namespace duet {

/// Curve Q(u) over the spans of a basis.
///
/// \tparam Curve  derived class with `spans()`, the basis, and `on_span<Rates>(span, u)`, which
///                returns Q and the given number of its rates in body axes, halved; for a batch of
///                parameters with an array of spans, one for each lane
/// \tparam R      real type of the parameter
template <class Curve, class R>
class piecewise_curve {
public:
  /// Parameters at which the pieces meet, and the ends of the domain, increasing.
  [[nodiscard]] const std::vector<R>& breaks() const { return curve().spans().breaks(); }
  /// Behaviour of the curve outside its domain; default `out_of_domain::error`.
  [[nodiscard]] out_of_domain behaviour_out_of_domain() const { return behaviour_; }
  /// Sets the behaviour of the curve outside its domain.
  void set_out_of_domain(out_of_domain behaviour) { behaviour_ = behaviour; }

  /// Value Q(u).
  ///
  /// \throws invalid_input outside the domain, unless `set_out_of_domain` permits it
  template <class S>
  [[nodiscard]] auto operator()(const S& u) const {
    return evaluate<0>(u, no_hint{}).value;
  }
  template <class S>
  [[nodiscard]] auto operator()(const S& u, span_hint& hint) const {
    return evaluate<0>(u, hint).value;
  }

  /// Value, velocity, acceleration and jerk with respect to u, in `frame::body` or
  /// `frame::spatial`. For poses these are twists [v; ω] and their derivatives; in `frame::hybrid`
  /// the linear parts are the derivatives of translation(Q). (For rotations `frame::hybrid` is
  /// `frame::spatial`.)
  ///
  /// \throws invalid_input outside the domain, unless `set_out_of_domain` permits it
  template <class S, FrameConstant Frame>
  [[nodiscard]] DUET_ALWAYS_INLINE auto motion(const S& u, Frame frame) const {
    return detail::motion_of(evaluate<3>(u, no_hint{}), frame);
  }
  template <class S, FrameConstant Frame>
  [[nodiscard]] DUET_ALWAYS_INLINE auto motion(const S& u, Frame frame, span_hint& hint) const {
    return detail::motion_of(evaluate<3>(u, hint), frame);
  }
  /// Rejected: a motion without its frame, which would be ambiguous.
  template <class S>
  DUET_REFUSED("the frame is missing: motion(u, frame::spatial) or frame::body, of poses also "
               "frame::hybrid")
  auto motion(const S& u) const -> decltype(motion(u, frame::body));

  /// Motion at u, as by `motion`, with the Jacobians of the value and of `Rates` rates with respect
  /// to the active control points and to u. The frame is that of the rates; the side is that on
  /// which control points and value are perturbed. No heap.
  ///
  /// \tparam Rates  0 to 3: none, velocity, acceleration, jerk
  /// \return `curve_jacobian`
  /// \throws invalid_input outside the domain, unless `set_out_of_domain` permits it; at rest
  /// beyond an end all Jacobians of rates are zero
  template <int Rates, class S, FrameConstant Frame>
  [[nodiscard]] auto motion_jacobian(const S& u, Frame frame,
                                     perturbation side = perturbation::right) const {
    no_hint hint;
    return jacobian_at<Rates>(u, frame, side, hint);
  }
  template <int Rates, class S, FrameConstant Frame>
  [[nodiscard]] auto motion_jacobian(const S& u, Frame frame, perturbation side,
                                     span_hint& hint) const {
    return jacobian_at<Rates>(u, frame, side, hint);
  }

  /// Derivatives Q, Q′ = Q w, Q″ = Q (a − |w|²) and Q‴ = Q (j − |w|² w + w × a − 3 w·a), with
  /// halved rates in body axes (P3, P4 in their true form).
  ///
  /// \throws invalid_input outside the domain, unless `set_out_of_domain` permits it
  template <class S>
  [[nodiscard]] auto derivatives(const S& u) const {
    const auto m = evaluate<3>(u, no_hint{});
    using Q = std::decay_t<decltype(m.value)>;
    using D = typename Q::scalar_type;
    const auto& w = m.velocity;
    const auto& a = m.acceleration;
    const D square = dot(w, w);
    const auto third = m.jerk - square * w + cross(w, a);
    return std::array<Q, 4>{m.value, m.value * Q(D(0), w), m.value * Q(-square, a),
                            m.value * Q(-3 * dot(w, a), third)};
  }

private:
  friend Curve;
  piecewise_curve() = default;

  struct no_hint {};

  [[nodiscard]] const Curve& curve() const { return static_cast<const Curve&>(*this); }

  template <int Rates, class S, class Hint>
  [[nodiscard]] DUET_ALWAYS_INLINE auto evaluate(const S& parameter, Hint&& hint) const {
    std::conditional_t<Arithmetic<S>, R, S> u(parameter);
    if constexpr (Batched<decltype(u)>) {
      return evaluate_lanes<Rates>(u, hint);
    } else {
      std::size_t span = 0;
      const bool is_at_rest = locate(u, span, hint);
      auto m = curve().template on_span<Rates>(span, u);
      if (Rates > 0 && is_at_rest) [[unlikely]] {
        m.velocity = m.acceleration = m.jerk = {};
      }
      return m;
    }
  }

  template <int Rates, class S, class Frame, class Hint>
  [[nodiscard]] auto jacobian_at(const S& parameter, Frame frame, perturbation side,
                                 Hint& hint) const {
    static_assert(Rates >= 0 && Rates <= 3, "duet: motion_jacobian<Rates> takes 0 to 3 rates");
    std::conditional_t<Arithmetic<S>, R, S> u(parameter);
    std::size_t span = 0;
    const bool is_at_rest = locate(u, span, hint);
    auto result = curve().template jacobian_on_span<Rates>(span, u, frame, side);
    if (is_at_rest) [[unlikely]] {
      result.set_at_rest();
    }
    return result;
  }

  /// Finds the span of u, and moves u into the domain if it is outside; true if the curve is at
  /// rest there.
  template <class P, class Hint>
  [[nodiscard]] DUET_ALWAYS_INLINE bool locate(P& u, std::size_t& span, Hint& hint) const {
    const auto& spans = curve().spans();
    if constexpr (detail::is_recording<real_type_t<P>> && std::is_same_v<Hint, span_hint>) {
      span = hint.span; // the formula of that span
      return false;
    }
    const auto value = static_cast<R>(innermost(u));
    if (!spans.contains(value)) [[unlikely]] {
      const evaluation_point point = clamp_to_domain(value);
      span = point.span;
      u = point.is_at_rest ? P(point.u) : P(u + (point.u - value));
      return point.is_at_rest;
    }
    if constexpr (std::is_same_v<Hint, span_hint>) {
      span = spans.find_span(value, hint);
    } else {
      span = spans.find_span(value);
    }
    return false;
  }

  /// Evaluates a batch of parameters; lanes may be on different spans.
  template <int Rates, class P, class Hint>
  [[nodiscard]] DUET_ALWAYS_INLINE auto evaluate_lanes(P u, Hint& hint) const {
    using reals = real_type_t<P>;
    const auto& spans = curve().spans();
    const reals value = innermost(u);
    std::array<std::size_t, std::size_t(reals::lanes)> span;
    bool is_inside = true;
    for (int k = 0; k < reals::lanes; ++k) {
      const auto in_lane = static_cast<R>(value[k]);
      std::size_t& i = span[std::size_t(k)];
      if (!spans.contains(in_lane)) [[unlikely]] {
        i = clamp_to_domain(in_lane).span;
        is_inside = false;
      } else if constexpr (std::is_same_v<Hint, span_hint>) {
        i = spans.find_span(in_lane, hint);
      } else {
        i = spans.find_span(in_lane);
      }
    }
    if (is_inside) [[likely]] {
      return curve().template on_span<Rates>(span, u);
    }
    typename reals::mask_type is_at_rest(false);
    reals end(R(0)), rounding(R(0));
    for (int k = 0; k < reals::lanes; ++k) {
      const auto in_lane = static_cast<R>(value[k]);
      if (!spans.contains(in_lane)) {
        const evaluation_point point = clamp_to_domain(in_lane);
        is_at_rest.set(k, point.is_at_rest);
        end.set(k, point.u);
        rounding.set(k, point.is_at_rest ? R(0) : R(point.u - in_lane));
      }
    }
    u = blended(is_at_rest, P(end), P(u + rounding));
    auto m = curve().template on_span<Rates>(span, u);
    if constexpr (Rates > 0) {
      for (auto* rate : {&m.velocity, &m.acceleration, &m.jerk}) {
        *rate = map_scalars(
            [&](const auto& x) { return blended(is_at_rest, std::decay_t<decltype(x)>(R(0)), x); },
            *rate);
      }
    }
    return m;
  }

  /// Point of evaluation for a parameter outside the domain.
  struct evaluation_point {
    std::size_t span; ///< first or last span
    R u;
    bool is_at_rest;
  };
  /// \throws invalid_input if the curve is not defined at u
  [[nodiscard]] DUET_COLD evaluation_point clamp_to_domain(const R& u) const {
    const auto& spans = curve().spans();
    const bool is_before = u < spans.front();
    const std::size_t span = is_before ? 0 : spans.breaks().size() - 2;
    const R& end = is_before ? spans.front() : spans.back();
    if (spans.rounded_into_domain(u) == end) {
      return {span, end, false};
    }
    const bool is_usable = behaviour_ == out_of_domain::clamp ? u == u : u - u == 0;
    if (behaviour_ == out_of_domain::error || !is_usable) {
      static_cast<void>(spans.find_span(u)); // throws
    }
    return {span, behaviour_ == out_of_domain::clamp ? end : u, behaviour_ == out_of_domain::clamp};
  }

  out_of_domain behaviour_ = out_of_domain::error;
};

} // namespace duet
