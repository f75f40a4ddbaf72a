// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/quaternion/three_vector.hpp>
#include <duet/robotics/branches/angle_pairs.hpp>
#include <duet/robotics/tip_pose.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

/// \file
/// Rotation about an axis that maps one vector to another, both of which rotate about other axes.

namespace duet::detail {

using vector3d = three_vector<double>;

/// Vector R v + t with a rotation R by θ about a unit vector n: `along` + cos θ
/// `across` + sin θ `normal`.
struct rotating_vector {
  vector3d along{}, across{}, normal{};

  rotating_vector(const vector3d& n, const vector3d& v, const vector3d& t = {})
      : along(dot(n, v) * n), across(v - along), normal(cross(n, v)) {
    along = along + t;
  }
  /// Constant vector.
  explicit rotating_vector(const vector3d& t) : along(t) {}

  [[nodiscard]] vector3d at(double theta) const {
    return along + std::cos(theta) * across + std::sin(theta) * normal;
  }
  [[nodiscard]] vector3d rate(double theta) const {
    return std::cos(theta) * normal - std::sin(theta) * across;
  }
};

/// Component n·v.
[[nodiscard]] inline first_harmonic part_along(const vector3d& n, const rotating_vector& v) {
  return {dot(n, v.along), dot(n, v.across), dot(n, v.normal)};
}

/// Angle of the rotation about n that maps u to v (Paden–Kahan subproblem 1), given n × u and
/// n × v; 0 if these vanish.
[[nodiscard]] inline double subproblem1_angle(const vector3d& n, const vector3d& u,
                                              const vector3d& v) {
  return std::atan2(dot(n, cross(u, v)), dot(u, v));
}
/// Angle of the rotation about n that maps u to v (Paden–Kahan subproblem 1).
[[nodiscard]] inline double subproblem1_angle_about(const vector3d& n, const vector3d& u,
                                                    const vector3d& v) {
  return subproblem1_angle(n, cross(n, u), cross(n, v));
}

/// Rotation about an axis n that maps one vector, rotated by θ, to another, rotated by φ. Both must
/// be at the same distance from the axis, and f(θ) = g(φ).
///
/// A small angle is ill-conditioned as a function of its cosine. Near the axis the perpendiculars
/// U = n × v are used instead: |U + U′t| = |V + V′t| along the line on which f = g has two
/// solutions. They are close in θ and φ, but not in the angle of the rotation.
class connecting_rotation {
public:
  connecting_rotation(const vector3d& axis, const rotating_vector& start,
                      const rotating_vector& end, const first_harmonic& f, const first_harmonic& g)
      : axis_(axis), start_(start), end_(end), f_(f), g_(g),
        close_by_(reach * reach *
                  std::max(dot(start.across, start.across), dot(end.across, end.across))) {}
  /// Rotation to a constant vector, with φ = 0.
  connecting_rotation(const vector3d& axis, const rotating_vector& start, const vector3d& end)
      : connecting_rotation(axis, start, rotating_vector(end), {0, 0, 0}, {0, 0, 1}) {}

  /// Calls visit(θ, φ, rotation angle, multiplicity) for a θ and φ that solve both equations to
  /// round-off; near the axis for all solutions close to them that have not been visited before.
  template <class Visit>
  void operator()(double theta, double phi, int multiplicity, const Visit& visit) {
    const angles x{theta, phi};
    const perpendiculars w(*this, x);
    if (w.square < close_by_) {
      const local_quadratic local(*this, x);
      if (local.is_close(1)) {
        visit_near_axis(x, local, visit);
        return;
      }
    }
    visit_one(x, w, rounding, multiplicity, visit);
  }

  /// Smallest distance of the visited vectors from the axis; 0 if a rotation angle is undetermined.
  [[nodiscard]] double nearest() const { return nearest_; }

  /// True if the rotation angle of the current visit is arbitrary.
  [[nodiscard]] bool is_open() const { return is_open_; }

private:
  /// Largest distance of coinciding solutions from their centre.
  static constexpr double rounding = 3e-13;
  /// Angle within which second order suffices for an initial guess.
  static constexpr double reach = 1e-3;

  struct angles {
    double theta = 0, phi = 0;
  };

  struct perpendiculars {
    vector3d from, to;
    double square; ///< squared distance from the axis

    perpendiculars(const connecting_rotation& rotation, const angles& x)
        : from(cross(rotation.axis_, rotation.start_.at(x.theta))),
          to(cross(rotation.axis_, rotation.end_.at(x.phi))), square(dot(from, from)) {}
  };

  /// Quadratic a t² + 2 b t + c = |U + U′t|² − |V + V′t|² along the line
  /// through `at` on which f = g.
  struct local_quadratic {
    angles at, direction{1, 0};
    double a = 0, b = 0, c = 0;
    double distance = 0;     ///< |U| + |V|
    double rate = 0;         ///< (U′² + V′²)^½
    double error = rounding; ///< error of U and V
    bool is_fold = false;    ///< f and g do not change to first order: `at` itself counts twice

    local_quadratic(const connecting_rotation& rotation, const angles& x) : at(x) {
      const double difference = rotation.f_.at(x.theta) - rotation.g_.at(x.phi);
      const double by_theta = rotation.f_.rate(x.theta), by_phi = -rotation.g_.rate(x.phi);
      const double squared_gradient = by_theta * by_theta + by_phi * by_phi;
      is_fold = !(squared_gradient >
                  2 * one_angle * one_angle * (rotation.f_.square() + rotation.g_.square()));
      if (!is_fold) {
        const double size = std::sqrt(squared_gradient);
        direction = {by_phi / size, -by_theta / size};
        at = {x.theta - difference * by_theta / squared_gradient,
              x.phi - difference * by_phi / squared_gradient};
      }
      const perpendiculars w(rotation, at);
      const vector3d by_start = cross(rotation.axis_, rotation.start_.rate(at.theta)),
                     by_end = cross(rotation.axis_, rotation.end_.rate(at.phi));
      // The error of f − g, at its smallest, moves the line; along the line |U| = |V| compensates
      // for it as far as possible.
      const double start = length_of(by_start), end = length_of(by_end),
                   along = std::hypot(start * by_phi, end * by_theta);
      if (!is_fold && along > 0) {
        error = std::max(rounding, 1e-14 * start * end / along);
      }
      const vector3d from_rate = direction.theta * by_start, to_rate = direction.phi * by_end;
      const double from = std::sqrt(w.square), to = length_of(w.to);
      const double square = dot(from_rate, from_rate), other = dot(to_rate, to_rate);
      distance = from + to;
      rate = std::sqrt(square + other);
      a = square - other;
      b = dot(w.from, from_rate) - dot(w.to, to_rate);
      c = (from - to) * distance;
    }

    [[nodiscard]] bool is_close(double times) const { return distance < times * 2 * reach * rate; }
    [[nodiscard]] angles point_at(double t) const {
      return {at.theta + t * direction.theta, at.phi + t * direction.phi};
    }
    [[nodiscard]] bool has_centre() const { return std::abs(b) < 2 * reach * std::abs(a); }
    [[nodiscard]] angles centre() const { return point_at(-b / a); }
    [[nodiscard]] double discriminant() const { return b * b - a * c; }
    /// Nearer or farther zero of the quadratic.
    [[nodiscard]] angles zero(bool is_nearer) const {
      const double q = -b - std::copysign(std::sqrt(std::max(0., discriminant())), b);
      return point_at(is_nearer ? c / q : q / a);
    }
  };

  template <class Visit>
  void visit_near_axis(const angles& seed, local_quadratic local, const Visit& visit) {
    constexpr int steps = 5; // the error is squared in each
    for (int k = 0; k < steps && local.has_centre(); ++k) {
      local = local_quadratic(*this, local.centre());
    }
    const double off = local.discriminant(),
                 half = local.rate * std::sqrt(std::abs(off)) / std::abs(local.a);
    const bool is_on_axis = local.distance + half <= local.error,
               is_double = half <= .01 * local.distance &&
                           std::abs(off) <= rounding * local.distance * std::abs(local.a);
    const int folds = local.is_fold ? 2 : 1;
    if (local.has_centre() && (is_on_axis || is_double)) {
      visit_new(local.centre(), local.error, 2 * folds, visit);
      return;
    }
    if (!local.has_centre() &&
        std::abs(local.b) <= rounding * local.rate) { // all points of the line are solutions
      nearest_ = 0;
      visit_new(seed, local.error, 2 * folds, visit);
      return;
    }
    if (off < 0) {
      return; // the zeros are a complex pair
    }
    for (const bool is_nearer : {true, false}) {
      angles x = local.zero(is_nearer);
      for (int k = 0; k < steps; ++k) {
        x = local_quadratic(*this, x).zero(true);
      }
      if (local_quadratic(*this, x).is_close(2)) { // otherwise it is a separate solution
        visit_new(x, local.error, folds, visit);
      }
    }
  }

  template <class Visit>
  void visit_new(const angles& x, double error, int multiplicity, const Visit& visit) {
    const perpendiculars w(*this, x);
    const double separation = 1e-8 * std::sqrt(std::max(rounding, std::sqrt(w.square)));
    const auto is_same = [&](const angles& y) {
      const double full_turn = 2 * std::numbers::pi;
      return std::abs(std::remainder(x.theta - y.theta, full_turn)) < separation &&
             std::abs(std::remainder(x.phi - y.phi, full_turn)) < separation;
    };
    if (std::none_of(visited_.begin(), visited_.end(), is_same)) {
      visited_.push_back(x);
      visit_one(x, w, error, multiplicity, visit);
    }
  }

  template <class Visit>
  void visit_one(const angles& x, const perpendiculars& w, double error, int multiplicity,
                 const Visit& visit) {
    is_open_ = !(w.square > error * error);
    nearest_ = is_open_ ? 0 : std::min(nearest_, std::sqrt(w.square));
    visit(x.theta, x.phi, subproblem1_angle(axis_, w.from, w.to), multiplicity);
  }

  vector3d axis_;
  rotating_vector start_, end_;
  first_harmonic f_, g_;
  double close_by_; ///< squared distance from the axis
  double nearest_ = HUGE_VAL;
  bool is_open_ = false;
  std::vector<angles> visited_; ///< solutions near the axis
};

} // namespace duet::detail
