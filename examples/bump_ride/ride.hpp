// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "models.hpp"

#include <duet/quaternion/rotation.hpp>

#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

/// \file
/// A wheel that runs over a bump: Lagrange's equation with the single degree of freedom u.

namespace bump_ride {

/// Data of the vehicle in SI units. The chassis is fixed; the road moves.
struct vehicle {
  double mass = 38;                             ///< carrier and wheel
  vector3<double> inertia{0.7, 1.1, 0.7};       ///< about the wheel centre, in the carrier's axes
  double spring = 30e3, damper = 1500;          ///< on the height of the wheel centre
  double tyre = 220e3, load = 4000;             ///< stiffness, and force at rest
  double speed = 10;                            ///< m/s
  double bump_height = 0.05, bump_length = 0.6; ///< m
  double bump_start = 0.5;                      ///< m ahead at the start
};

/// The road under the wheel: a bump of the form (1 − cos)/2.
inline double road(const vehicle& v, double t) {
  const double x = (v.speed * t - v.bump_start) / v.bump_length;
  return x > 0 && x < 1 ? v.bump_height * (1 - std::cos(2 * std::numbers::pi * x)) / 2 : 0;
}

/// u, u̇, and the work of tyre and damper so far.
using state = std::array<double, 3>;

struct sample {
  double t, u, height, toe_in; ///< s, m, m, degrees
  double energy;               ///< kinetic + potential − work, a constant of the motion
  double kinetic;
};

/// T = ½ M(u) u̇², M = Vᵀ G V with the twist V per unit of u and G = diag(m, m, m, I); V carries
/// its own derivative, so M′ = 2 Vᵀ G V′. Spring, weight and static tyre load have the potential
/// ½ k z² + F₀ z of the wheel centre's height z.
template <class Model>
class ride {
public:
  ride(const Model& model, const vehicle& v) : model_(model), vehicle_(v) {
    inertia_ << v.mass, v.mass, v.mass, v.inertia;
  }

  /// Lagrange's equation M ü + ½ M′ u̇² = F z′.
  void operator()(const state& x, state& rate, double t) const {
    const auto [u, u_dot, work] = x;
    const motion_state p = model_.at(u);
    const vector6<double> momentum = inertia_.cwiseProduct(p.twist);
    const double mass = momentum.dot(p.twist);
    const double mass_first = 2 * momentum.dot(p.twist_first);
    const double height = duet::translation(p.pose)[2];
    const double height_first = rotate(duet::rotation(p.pose), linear(p))[2];
    const double external_force = tyre_and_damper(t, height, height_first * u_dot);
    const double force = external_force - vehicle_.load - vehicle_.spring * height;
    rate = {u_dot, (force * height_first - mass_first * u_dot * u_dot / 2) / mass,
            external_force * height_first * u_dot};
  }

  [[nodiscard]] sample sample_at(const state& x, double t) const {
    const auto [u, u_dot, work] = x;
    const motion_state p = model_.at(u);
    const double kinetic = inertia_.cwiseProduct(p.twist).dot(p.twist) * u_dot * u_dot / 2;
    const double height = duet::translation(p.pose)[2];
    return {t,
            u,
            height,
            wheel_carrier::toe_in(duet::rotation(p.pose)) * 180 / std::numbers::pi,
            kinetic + vehicle_.spring * height * height / 2 + vehicle_.load * height - work,
            kinetic};
  }

private:
  static vector3<double> linear(const motion_state& p) { return p.twist.head<3>(); }

  /// The tyre pushes, and cannot pull.
  [[nodiscard]] double tyre_and_damper(double t, double height, double height_rate) const {
    const double pushed = vehicle_.load + vehicle_.tyre * (road(vehicle_, t) - height);
    return std::max(0.0, pushed) - vehicle_.damper * height_rate;
  }

  const Model& model_;
  vehicle vehicle_;
  vector6<double> inertia_;
};

struct result {
  std::string name;
  std::vector<sample> samples;
  double seconds_per_step;
};

/// Simulates the ride from rest by the classical Runge–Kutta method.
template <class Model>
[[nodiscard]] result run_over_bump(std::string name, const Model& model, const vehicle& v,
                                   double duration, double step) {
  const ride<Model> system(model, v);
  boost::numeric::odeint::runge_kutta4<state> stepper;
  state x{};
  result r{std::move(name), {system.sample_at(x, 0)}, 0};
  const auto steps = std::size_t(std::lround(duration / step));
  std::chrono::duration<double> time{};
  for (std::size_t i = 0; i < steps; ++i) {
    const auto start = std::chrono::steady_clock::now();
    stepper.do_step(system, x, double(i) * step, step);
    time += std::chrono::steady_clock::now() - start;
    r.samples.push_back(system.sample_at(x, double(i + 1) * step));
  }
  r.seconds_per_step = time.count() / double(steps);
  return r;
}

/// The largest change of the conserved energy, relative to the largest kinetic energy.
inline double energy_error(const result& r) {
  double largest = 0;
  double kinetic = 0;
  for (const sample& s : r.samples) {
    largest = std::max(largest, std::abs(s.energy - r.samples.front().energy));
    kinetic = std::max(kinetic, s.kinetic);
  }
  return largest / kinetic;
}

/// The largest difference of heights, in metres.
inline double height_difference(const result& a, const result& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.samples.size(); ++i) {
    largest = std::max(largest, std::abs(a.samples[i].height - b.samples[i].height));
  }
  return largest;
}

} // namespace bump_ride
