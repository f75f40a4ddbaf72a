// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/structure.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/kinematics/serial_chain.hpp>

#include <Eigen/Core>

#include <cmath>
#include <concepts>
#include <functional>

/// \file
/// Null-space (secondary) objectives: functions of the joint coordinates that are minimised in the
/// null space of the Jacobian.

namespace duet {

struct scene;
/// Scene without obstacles.
struct no_scene {};

/// No objective.
struct no_objective {};

/// Preferred posture θ̂ of weight w as an objective: w/2 Σ (θᵢ − θ̂ᵢ)².
template <class V>
struct preferred_posture {
  V posture = detail::zero_initialized<V>(); ///< θ̂, preferred joint coordinates
  double weight = 1;                         ///< w, weight of the posture

  /// Value at joint coordinates θ.
  template <class X>
  [[nodiscard]] auto operator()(const X& theta) const {
    auto sum = (theta[0] - posture[0]) * (theta[0] - posture[0]);
    for (Eigen::Index i = 1; i < posture.size(); ++i) {
      sum += (theta[i] - posture[i]) * (theta[i] - posture[i]);
    }
    return sum * (weight / 2);
  }
  /// Gradient at joint coordinates θ.
  template <class X>
  [[nodiscard]] V gradient(const X& theta) const {
    return weight * (theta - posture);
  }
};
template <class V, class... W>
preferred_posture(V, W...) -> preferred_posture<detail::own_t<V>>;

namespace detail {
DUET_ABI_BEGIN

/// \throws invalid_input for a posture of another number of joints, and entries that are not finite
template <class Objective>
void require_objective(const Objective&, int) {}
template <class V>
void require_objective(const preferred_posture<V>& preferred, int joints) {
  require(preferred.posture.size() == joints, "duet: preferred_posture: ", preferred.posture.size(),
          " coordinates (expected ", joints, ", one per joint)");
  for (int i = 0; i < joints; ++i) {
    require(std::isfinite(double(preferred.posture[i])), "duet: preferred_posture: joint ", i,
            " is ", preferred.posture[i], " (expected a finite number)");
  }
  require(std::isfinite(preferred.weight), "duet: preferred_posture: weight is ", preferred.weight,
          " (expected a finite number)");
}

/// View of an objective of any type, which it calls with vectors of the type that the chain has;
/// or no objective.
class objective_view {
  using joints_view = Eigen::Ref<const Eigen::VectorXd>; // of vectors of any size, without a copy

public:
  /// \tparam N  number of joints, as in `serial_chain`
  template <int N, class F>
  [[nodiscard]] static objective_view of(const F& f) {
    objective_view result;
    if constexpr (!std::same_as<F, no_objective>) {
      using vector = joint_vector<double, N>;
      if constexpr (requires(const vector& x) { double(f(x)); }) {
        result.value_ = [&f](const joints_view& x) { return double(f(vector(x))); };
      } // an objective that only has a gradient is enough for `follow_path`
      // Its own gradient, or automatic differentiation by dual numbers.
      if constexpr (requires(const vector& x) { f.gradient(x); }) {
        result.gradient_ = [&f](const joints_view& x, Eigen::Ref<Eigen::VectorXd> out) {
          out = result_of_call(f.gradient(vector(x)));
        };
      } else {
        result.gradient_ = [&f](const joints_view& x, Eigen::Ref<Eigen::VectorXd> out) {
          out = duet::gradient(f, vector(x)).gradient;
        };
      }
    }
    return result;
  }

  [[nodiscard]] explicit operator bool() const { return gradient_ != nullptr; }
  /// Value at joint coordinates; 0 if the objective has none.
  [[nodiscard]] double operator()(const joints_view& x) const { return value_ ? value_(x) : 0; }
  /// Gradient at joint coordinates, in a vector of the same type.
  template <class V>
  [[nodiscard]] V gradient(const V& joints) const {
    V result(joints.size());
    gradient_(joints, result);
    return result;
  }

private:
  std::function<double(const joints_view&)> value_;
  std::function<void(const joints_view&, Eigen::Ref<Eigen::VectorXd>)> gradient_;
};

/// Preferences among solutions: an objective, and clearance of obstacles.
struct solution_preferences {
  objective_view objective;
  const scene* around = nullptr; ///< null without obstacles
};

/// Preferences from an objective and a scene. (The return type is deduced, so that messages on
/// types of arguments precede other compiler errors.)
///
/// \throws invalid_input for a preferred posture of another size
template <class C, class Objective, class Scene>
[[nodiscard]] auto preferences_of(const C& chain, const Objective& objective, const Scene& around) {
  static_assert(!std::same_as<Objective, scene>,
                "duet: a scene is passed as the objective; pass no_objective{} before the scene");
  static_assert(std::same_as<Scene, scene> || std::same_as<Scene, no_scene>,
                "duet: the argument after the objective is not a scene; pass obstacles as a scene");
  require_objective(objective, chain.size());
  solution_preferences result{objective_view::of<C::joints>(objective)};
  if constexpr (std::same_as<Scene, scene>) {
    result.around = &around;
  }
  return result;
}

DUET_ABI_END
} // namespace detail
} // namespace duet
