// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "../wheel_carrier/carrier.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/dual/eigen_traits.hpp>
#include <duet/dual/math.hpp>

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <type_traits>
#include <vector>

/// \file
/// The mechanisms of the folder `files` and their closed forms.

namespace closed_mechanisms {

using Eigen::VectorXd;

/// A point, and its first and second derivative along the line of the driven coordinates.
using path = std::array<Eigen::Vector3d, 3>;

/// Value and derivatives of f(u) along u = from + part · direction.
template <class F>
path along_line(const F& f, const VectorXd& from, const VectorXd& direction, double part) {
  return path(duet::derivatives<2>(
      [&](const auto& s) {
        using S = std::decay_t<decltype(s)>;
        Eigen::Matrix<S, Eigen::Dynamic, 1> u(from.size());
        for (Eigen::Index i = 0; i < u.size(); ++i) {
          u[i] = from[i] + s * direction[i];
        }
        return f(u);
      },
      part));
}

/// A mechanism and its motion.
struct mechanism {
  std::string name;
  std::vector<std::string> drives;
  VectorXd guess;    ///< initial guess of all coordinates
  VectorXd from, to; ///< start and end of the driven coordinates
  std::string link;  ///< link of the observed point
  std::array<double, 3> point;
  Eigen::Vector3d view; ///< direction from which it is drawn
  /// The point at a part of the motion, and its derivatives with respect to that part.
  std::function<path(const VectorXd& from, const VectorXd& direction, double part)> by_hand;
};

namespace detail {

/// Turns a formula of the driven coordinates into a function of `by_hand`.
template <class F>
auto along(const F& f) {
  return [f](const VectorXd& from, const VectorXd& direction, double part) {
    return along_line(f, from, direction, part);
  };
}

/// The joint between coupler and rocker, by Freudenstein's equation.
inline constexpr auto four_bar = [](const auto& u) {
  using std::atan2;
  using std::cos;
  using std::sin;
  using std::sqrt;
  const auto k = .2 * cos(u[0]) - .55, s = .2 * sin(u[0]);
  const auto q = (.4 * .4 + k * k + s * s - .5 * .5) / .8;
  const auto psi = atan2(s, k) - atan2(sqrt(k * k + s * s - q * q), q);
  return duet::make_vector(.55 + .4 * cos(psi), .4 * sin(psi), 0 * psi);
};

/// The upper intersection of the circles about the ends of the cranks.
inline constexpr auto five_bar = [](const auto& u) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  const auto ax = -.15 + .25 * cos(u[0]), ay = .25 * sin(u[0]);
  const auto dx = .15 + .25 * cos(u[1]) - ax, dy = .25 * sin(u[1]) - ay;
  const auto up = sqrt(.16 / (dx * dx + dy * dy) - .25);
  return duet::make_vector(ax + dx / 2 - up * dy, ay + dy / 2 + up * dx, 0 * up);
};

/// The lower intersection of the spheres about the ends of the arms, which are moved inwards by the
/// radius of the plate.
inline constexpr auto delta = [](const auto& u) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  using S = std::decay_t<decltype(u[0] + 0.)>;
  std::array<duet::vector3<S>, 3> c;
  for (int i = 0; i < 3; ++i) {
    const double angle = 2 * std::numbers::pi * i / 3;
    const S out = .15 + .25 * cos(u[i]);
    c[std::size_t(i)] = {out * std::cos(angle), out * std::sin(angle), -.25 * sin(u[i])};
  }
  const duet::vector3<S> a = c[1] - c[0], b = c[2] - c[0];
  const duet::vector3<S> n = a.cross(b); // points upwards for arms in the order of the axes
  const S area = n.dot(n);
  const duet::vector3<S> centre = (a.dot(a) * b.cross(n) + b.dot(b) * n.cross(a)) / (2 * area);
  const S height = sqrt((.36 - centre.dot(centre)) / area);
  return duet::vector3<S>(c[0] + centre - height * n);
};

/// The wheel centre by the constraints of the example `wheel_carrier`.
inline path wheel_centre(const VectorXd& from, const VectorXd& direction, double part) {
  static const ::wheel_carrier::carrier carrier(::wheel_carrier::example_hardpoints());
  const auto state = carrier.at(from[0] + part * direction[0]);
  return {state.centre, state.centre_first * direction[0],
          state.centre_second * direction[0] * direction[0]};
}

inline VectorXd numbers(std::initializer_list<double> x) {
  return Eigen::Map<const VectorXd>(x.begin(), Eigen::Index(x.size()));
}

} // namespace detail

/// Metres and radians.
inline std::vector<mechanism> known_mechanisms() {
  using detail::along;
  using detail::numbers;
  const double full_turn = 2 * std::numbers::pi;
  return {{"four_bar",
           {"crank"},
           numbers({0, 1.1, 2.1}),
           numbers({0}),
           numbers({full_turn}),
           "rocker",
           {.4, 0, 0},
           {0, -1e-3, 1},
           along(detail::four_bar)},
          {"five_bar",
           {"left", "right"},
           numbers({2.2, -1.4, .9, 1.4}),
           numbers({2.2, .9}),
           numbers({1.5, -.4}),
           "left_coupler",
           {.4, 0, 0},
           {0, -1e-3, 1},
           along(detail::five_bar)},
          {"delta",
           {"arm_1", "arm_2", "arm_3"},
           numbers({.2, .2, .2, 0, 0, -.6, 0, 0, 0}),
           numbers({.2, .2, .2}),
           numbers({.9, -.1, .5}),
           "plate",
           {0, 0, 0},
           {3, -4, 1.5},
           along(detail::delta)},
          {"stewart", {}, {}, {}, {}, "platform", {0, 0, 0}, {3, -4, 2}, {}},
          {"wheel_carrier",
           {"carrier.z"},
           numbers({0, 0, 0, 0, 0, 0}),
           numbers({-.19}),
           numbers({.2}),
           "carrier",
           {0, 0, 0},
           {3, -4, 2},
           detail::wheel_centre}};
}

} // namespace closed_mechanisms
