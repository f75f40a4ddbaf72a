// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/derivative/function.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/mechanism/manipulability.hpp>
#include <duet/mechanism/serial_chain.hpp>

#include <Eigen/Core>

#include <cmath>
#include <utility>

/// \file
/// What the joints do with the freedom that a pose of the tip leaves them: they lower a function of
/// their coordinates.

namespace duet {

/// No wish.
struct no_objective {};

/// w/2 Σ (θᵢ − θ̂ᵢ)²: a preferred posture θ̂, of weight w.
template <class V>
struct preferred_posture {
  V posture;
  double weight = 1;

  template <class X>
  [[nodiscard]] auto operator()(const X& theta) const {
    auto sum = (theta[0] - posture[0]) * (theta[0] - posture[0]);
    for (Eigen::Index i = 1; i < posture.size(); ++i) {
      sum += (theta[i] - posture[i]) * (theta[i] - posture[i]);
    }
    return sum * (weight / 2);
  }
  template <class X>
  [[nodiscard]] V gradient(const X& theta) const {
    return weight * (theta - posture);
  }
};
template <class V, class... W>
preferred_posture(V, W...) -> preferred_posture<detail::own_t<V>>;

/// −w log √det(J Jᵀ): away from singularities, with weight w.
template <class C>
struct high_manipulability {
  C chain;
  double weight = 1;

  template <class X>
  [[nodiscard]] auto operator()(const X& theta) const {
    using std::log;
    return -weight * log(manipulability(chain, theta));
  }
  template <class X>
  [[nodiscard]] auto gradient(const X& theta) const {
    auto [w, slope] = manipulability_gradient(chain, theta);
    slope *= -weight / w;
    return slope;
  }
};
template <class C, class... W>
high_manipulability(C, W...) -> high_manipulability<C>;

namespace detail {

/// ∇f by f's own formula, or else by automatic differentiation.
template <class F, class X>
[[nodiscard]] auto objective_gradient(const F& f, const X& theta) {
  if constexpr (requires { f.gradient(theta); }) {
    return result_of_call(f.gradient(theta));
  } else {
    return duet::gradient(f, theta).gradient;
  }
}

} // namespace detail
} // namespace duet
