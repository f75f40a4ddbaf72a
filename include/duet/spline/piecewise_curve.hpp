// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/lanes.hpp>
#include <duet/core/compiler/refused.hpp>
#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/spline/location.hpp>
#include <duet/spline/motion.hpp>

#include <array>
#include <cstddef>
#include <type_traits>
#include <vector>

/// \file
/// What curves made of pieces have in common: how they are evaluated.

namespace duet {

/// A curve Q(u) over the spans of a basis.
///
/// \tparam Curve  what derives from it, with `spans()`, the basis, and `on_span<Rates>(span, u)`,
///                Q with so many of its rates in body axes, halved; for a batch of parameters with
///                an array of spans, one for each lane
/// \tparam R      the parameter's real type
template <class Curve, class R>
class piecewise_curve {
public:
  /// Where the pieces meet, and the ends of the domain: increasing parameters.
  [[nodiscard]] const std::vector<R>& breaks() const { return curve().spans().breaks(); }
  /// What the curve does outside its domain: `outside::error` until told otherwise.
  [[nodiscard]] outside outside_domain() const { return outside_; }
  /// Says what the curve does outside its domain.
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
  /// `frame::spatial`; of poses as twists [v; ω] and their derivatives, in `frame::hybrid` with the
  /// derivatives of translation(Q) as linear parts. (Of rotations hybrid is spatial.)
  /// \throws invalid_input outside the domain, unless told otherwise
  template <class S, FrameConstant Frame>
  [[nodiscard]] DUET_ALWAYS_INLINE auto motion(const S& u, Frame frame) const {
    return detail::motion_of(evaluate<3>(u, no_hint{}), frame);
  }
  template <class S, FrameConstant Frame>
  [[nodiscard]] DUET_ALWAYS_INLINE auto motion(const S& u, Frame frame, span_hint& hint) const {
    return detail::motion_of(evaluate<3>(u, hint), frame);
  }
  /// Without a frame it is not clear which is meant.
  template <class S>
  DUET_REFUSED("in which axes? motion(u, frame::spatial) or frame::body, of poses also "
               "frame::hybrid")
  auto motion(const S& u) const -> decltype(motion(u, frame::body));

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
    using P = std::conditional_t<Arithmetic<S>, R, S>;
    P u(parameter);
    if constexpr (Batched<P>) {
      return evaluate_lanes<Rates>(u, hint);
    } else {
      return evaluate_one<Rates>(u, hint);
    }
  }

  template <int Rates, class P, class Hint>
  [[nodiscard]] DUET_ALWAYS_INLINE auto evaluate_one(P u, Hint& hint) const {
    const auto& spans = curve().spans();
    const auto value = static_cast<R>(innermost(u));
    std::size_t span = 0;
    bool is_at_rest = false;
    if (!spans.contains(value)) [[unlikely]] {
      const place there = place_beside(value);
      span = there.span;
      is_at_rest = there.is_at_rest;
      u = is_at_rest ? P(there.u) : P(u + (there.u - value));
    } else if constexpr (std::is_same_v<Hint, span_hint>) {
      span = spans.span_of(value, hint);
    } else {
      span = spans.span_of(value);
    }
    auto m = curve().template on_span<Rates>(span, u);
    if (Rates > 0 && is_at_rest) [[unlikely]] {
      m.velocity = m.acceleration = m.jerk = {};
    }
    return m;
  }

  /// Lanes may be on different spans.
  template <int Rates, class P, class Hint>
  [[nodiscard]] DUET_ALWAYS_INLINE auto evaluate_lanes(P u, Hint& hint) const {
    using reals = real_type_t<P>;
    const auto& spans = curve().spans();
    const reals value = innermost(u);
    std::array<std::size_t, std::size_t(reals::lanes)> span;
    bool is_inside = true;
    for (int k = 0; k < reals::lanes; ++k) {
      const auto here = static_cast<R>(value[k]);
      std::size_t& i = span[std::size_t(k)];
      if (!spans.contains(here)) [[unlikely]] {
        i = place_beside(here).span;
        is_inside = false;
      } else if constexpr (std::is_same_v<Hint, span_hint>) {
        i = spans.span_of(here, hint);
      } else {
        i = spans.span_of(here);
      }
    }
    if (is_inside) [[likely]] {
      return curve().template on_span<Rates>(span, u);
    }
    typename reals::mask_type is_at_rest(false);
    reals there(R(0)), rounding(R(0));
    for (int k = 0; k < reals::lanes; ++k) {
      const auto here = static_cast<R>(value[k]);
      if (!spans.contains(here)) {
        const place at = place_beside(here);
        is_at_rest.set(k, at.is_at_rest);
        there.set(k, at.u);
        rounding.set(k, at.is_at_rest ? R(0) : R(at.u - here));
      }
    }
    u = blended(is_at_rest, P(there), P(u + rounding));
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

  /// Where a parameter outside the domain is evaluated.
  struct place {
    std::size_t span; ///< the first or the last
    R u;
    bool is_at_rest;
  };
  /// \throws invalid_input where there is no going on
  [[nodiscard]] DUET_COLD place place_beside(const R& u) const {
    const auto& spans = curve().spans();
    const bool is_before = u < spans.front();
    const std::size_t span = is_before ? 0 : spans.breaks().size() - 2;
    const R& end = is_before ? spans.front() : spans.back();
    if (spans.rounded_into_domain(u) == end) {
      return {span, end, false};
    }
    const bool is_usable = outside_ == outside::clamp ? u == u : u - u == 0;
    if (outside_ == outside::error || !is_usable) {
      static_cast<void>(spans.span_of(u)); // throws
    }
    return {span, outside_ == outside::clamp ? end : u, outside_ == outside::clamp};
  }

  outside outside_ = outside::error;
};

} // namespace duet
