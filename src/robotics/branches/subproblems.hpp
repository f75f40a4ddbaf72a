// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "../tip_pose.hpp"
#include "loop_equation.hpp"

#include <duet/core/batch/vector_sine_cosine.hpp>
#include <duet/core/config.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <vector>

/// \file
/// Paden–Kahan subproblems: rotations about given axes that map one vector to another, or whose
/// product is a given rotation.

namespace duet::detail {
DUET_ABI_BEGIN

/// Zeros z = e^{iθ} of f(θ) = Σ d_k e^{ikθ}, k = −n … n, d_−k = d̄_k.
///
/// \tparam Degree  n
template <int Degree>
class circle_roots {
public:
  static constexpr int samples = 2 * Degree + 1, count = 2 * Degree;
  using values = std::array<double, std::size_t(samples)>;
  using half_of_coefficients = std::array<std::complex<double>, std::size_t(Degree + 1)>;

  /// Angle of the k-th value of f that `interpolated` requires.
  [[nodiscard]] static double angle(int k) { return 2 * std::numbers::pi * k / samples; }

  /// Coefficients d_0 … d_n of the f with given values at the angles `angle(k)`.
  [[nodiscard]] static half_of_coefficients interpolated(const values& f) {
    static const auto weights = [] {
      std::array<std::complex<double>, std::size_t(samples)> result;
      for (int k = 0; k < samples; ++k) {
        result[std::size_t(k)] = std::polar(1 / double(samples), -angle(k));
      }
      return result;
    }();
    half_of_coefficients result;
    for (int k = 0; k <= Degree; ++k) {
      std::complex<double> sum = 0;
      for (int j = 0; j < samples; ++j) {
        sum += f[std::size_t(j)] * weights[std::size_t(k * j % samples)];
      }
      result[std::size_t(k)] = sum;
    }
    return result;
  }

  /// Finds the zeros.
  ///
  /// \param d  coefficients d_0 … d_n
  explicit circle_roots(const half_of_coefficients& d) {
    double largest = 0;
    for (const auto& x : d) {
      largest = std::max(largest, std::abs(x));
    }
    for (int k = 0; k <= Degree; ++k) {
      const std::complex<double> x = largest > 0 ? d[std::size_t(k)] / largest : 0;
      coefficients_[std::size_t(Degree + k)] = x;
      coefficients_[std::size_t(Degree - k)] = std::conj(x);
    }
    find();
  }

  [[nodiscard]] std::complex<double> operator[](int i) const { return {x_[i], y_[i]}; }
  /// Displacement of the i-th zero by errors of the coefficients, per unit of
  /// the largest coefficient.
  [[nodiscard]] double sensitivity(int i) const { return sensitivity_[i]; }

private:
  using lanes = Eigen::Array<double, count, 1>;

  /// Finds all zeros simultaneously by the Ehrlich–Aberth method, Newton's method with the other
  /// zeros divided out: z_i moves by −1/(f′/f − Σ_{j≠i} 1/(z_i − z_j)).
  void find() {
    for (int i = 0; i < count; ++i) {
      const auto z = std::polar(i % 2 == 0 ? 1.1 : .9, 2 * std::numbers::pi * (i + .3) / count);
      x_[i] = z.real();
      y_[i] = z.imag();
    }
    for (int k = 0; k < 50; ++k) {
      if (step() < 1e-13) {
        break;
      }
    }
  }

  double step() {
    lanes px = lanes::Constant(coefficients_[count].real()), py, qx = lanes::Zero(), qy = qx;
    py.setConstant(coefficients_[count].imag());
    for (int k = count; k-- > 0;) {
      const auto& d = coefficients_[std::size_t(k)];
      const lanes rx = qx * x_ - qy * y_ + px;
      qy = qx * y_ + qy * x_ + py;
      qx = rx;
      const lanes sx = px * x_ - py * y_ + d.real();
      py = px * y_ + py * x_ + d.imag();
      px = sx;
    }
    const lanes p = px.square() + py.square(), q = qx.square() + qy.square();
    const lanes size = (x_.square() + y_.square()).sqrt();
    sensitivity_ = 1 / q.sqrt();
    lanes sum_x = lanes::Zero(), sum_y = sum_x;
    for (int j = 0; j < count; ++j) {
      const lanes dx = x_ - x_[j], dy = y_ - y_[j];
      lanes square = dx.square() + dy.square();
      square[j] = 1; // not 0, as dx = dy = 0
      sum_x += dx / square;
      sum_y -= dy / square;
    }
    // 1/(q/p − sum) = p / (q − p sum)
    const lanes nx = qx - (px * sum_x - py * sum_y), ny = qy - (px * sum_y + py * sum_x);
    const lanes n = nx.square() + ny.square();
    double largest = 0;
    for (int i = 0; i < count; ++i) {
      const double wx = (px[i] * nx[i] + py[i] * ny[i]) / n[i];
      const double wy = (py[i] * nx[i] - px[i] * ny[i]) / n[i];
      // Zeros far from the circle, or at infinity if the degree is lower, are ignored.
      const bool is_far = size[i] > 1e4 || size[i] < 1e-4;
      if (is_far || !(p[i] > 0) || !(wx * wx + wy * wy < 1e12)) {
        continue;
      }
      x_[i] -= wx;
      y_[i] -= wy;
      const bool is_near = size[i] < 3 && size[i] > .3; // others need less accuracy
      largest =
          std::max(largest, (is_near ? 1 : 1e-12) * (wx * wx + wy * wy) / (size[i] * size[i]));
    }
    return std::sqrt(largest);
  }

  std::array<std::complex<double>, std::size_t(samples)> coefficients_{};
  lanes x_, y_, sensitivity_;
};

/// Trigonometric polynomial a + b cos θ + c sin θ.
struct first_harmonic {
  double a = 0, b = 0, c = 0;

  [[nodiscard]] double at(double theta) const {
    return a + b * std::cos(theta) + c * std::sin(theta);
  }
  [[nodiscard]] double rate(double theta) const {
    return c * std::cos(theta) - b * std::sin(theta);
  }
  /// Squared amplitude, that of the largest deviation from a.
  [[nodiscard]] double square() const { return b * b + c * c; }
};

/// Distance below which two zeros count as one, of multiplicity 2: round-off
/// separates them by as much.
inline constexpr double one_angle = 3e-7;

/// Calls visit(θ, multiplicity) for the zeros of a + b cos θ + c sin θ, also where it is nearly
/// zero: the pair of zeros there may be complex only because of round-off in a, b and c, which come
/// from ill-conditioned angles.
///
/// \param error  error of a, b and c, if it exceeds round-off
/// \return false if the function is zero to round-off, or an error decides whether there are zeros
bool visit_zeros(const first_harmonic& f, const auto& visit, double error = 0) {
  constexpr double rounding = 1e-12, nearly = 1e-9;
  const double r = std::sqrt(f.b * f.b + f.c * f.c);
  if (!(r > rounding)) {
    return std::abs(f.a) > rounding;
  }
  const double cosine = -f.a / r, centre = std::atan2(f.c, f.b);
  if (std::abs(cosine) <= 1 - one_angle * one_angle) {
    const double half_distance = std::acos(cosine);
    visit(centre + half_distance, 1);
    visit(centre - half_distance, 1);
  } else if (std::abs(cosine) <= 1 + std::max(nearly, error / r)) {
    visit(cosine > 0 ? centre : centre + std::acos(-1.), 2);
  }
  return std::abs(std::abs(cosine) - 1) * r >= error;
}

/// System of two equations f(θ) = g(φ).
struct angle_pairs {
  std::array<first_harmonic, 2> f, g;

  /// Calls visit(θ, φ, multiplicity) for each solution.
  ///
  /// \return false if one of the angles is undetermined
  bool operator()(const auto& visit) const {
    const double by_theta = regularity(f), by_phi = regularity(g);
    const auto swapped = [&](double x, double y, int m) { visit(y, x, m); };
    if (is_constant(f) || is_constant(g)) {
      is_constant(f) ? solve_constant(f, g, visit) : solve_constant(g, f, swapped);
      return false;
    }
    constexpr double singular = 1e-9;
    if (std::min(by_theta, by_phi) > singular) {
      if (by_theta >= by_phi) {
        return solve_regular(f, g, visit);
      }
      return solve_regular(g, f, swapped);
    }
    return by_theta < by_phi ? solve_dependent(f, g, visit) : solve_dependent(g, f, swapped);
  }

private:
  using two_values = std::array<first_harmonic, 2>;

  [[nodiscard]] static double determinant(const two_values& f) {
    return f[0].b * f[1].c - f[0].c * f[1].b;
  }
  /// Determinant relative to the squared size of its rows.
  [[nodiscard]] static double regularity(const two_values& f) {
    const double size = f[0].b * f[0].b + f[0].c * f[0].c + f[1].b * f[1].b + f[1].c * f[1].c;
    return size > 1e-18 ? std::abs(determinant(f)) / size : 0;
  }

  /// True if f does not depend on its angle, to round-off.
  [[nodiscard]] static bool is_constant(const two_values& f) {
    constexpr double rounding = 1e-12;
    return std::max(f[0].square(), f[1].square()) <= rounding * rounding;
  }
  /// Solves for φ if θ is arbitrary: by the equation with the larger amplitude, where the other one
  /// holds, too.
  static void solve_constant(const two_values& f, const two_values& g, const auto& visit) {
    constexpr double rounding = 1e-6; // for φ where the zeros nearly coincide
    const std::size_t k = g[0].square() >= g[1].square() ? 0 : 1;
    static_cast<void>(
        visit_zeros({g[k].a - f[k].a, g[k].b, g[k].c}, [&](double phi, int multiplicity) {
          if (std::abs(g[1 - k].at(phi) - f[1 - k].a) < rounding) {
            visit(0., phi, multiplicity);
          }
        }));
  }

  /// Solves a system of which a linear combination of both equations does not depend on θ.
  static bool solve_dependent(const two_values& f, const two_values& g, const auto& visit) {
    const double at_0 = std::hypot(f[0].b, f[0].c), at_1 = std::hypot(f[1].b, f[1].c);
    const std::size_t larger = at_0 >= at_1 ? 0 : 1, other = 1 - larger;
    const first_harmonic &fl = f[larger], &fo = f[other], &gl = g[larger], &go = g[other];
    const double size = fl.b * fl.b + fl.c * fl.c;
    const double ratio = size > 0 ? (fl.b * fo.b + fl.c * fo.c) / size : 0;
    bool is_determined = true;
    const first_harmonic in_phi{go.a - fo.a - ratio * (gl.a - fl.a), go.b - ratio * gl.b,
                                go.c - ratio * gl.c};
    const bool has_phi = visit_zeros(in_phi, [&](double phi, int m) {
      const bool has_theta = visit_zeros({fl.a - gl.at(phi), fl.b, fl.c},
                                         [&](double theta, int n) { visit(theta, phi, m * n); });
      is_determined = is_determined && has_theta;
    });
    return has_phi && is_determined;
  }

  /// Solves (cos θ, sin θ) = u + V (cos φ, sin φ), whose square is 1.
  ///
  /// \return false if the equation is zero to round-off
  static bool solve_regular(const two_values& f, const two_values& g, const auto& visit) {
    const double d = determinant(f);
    const auto solved = [&](double r0, double r1) {
      return std::array{(r0 * f[1].c - r1 * f[0].c) / d, (f[0].b * r1 - f[1].b * r0) / d};
    };
    const auto u = solved(g[0].a - f[0].a, g[1].a - f[1].a);
    const auto v = solved(g[0].b, g[1].b), w = solved(g[0].c, g[1].c);
    // u + q z + q̄/z
    using complex = std::complex<double>;
    const complex q0(v[0] / 2, -w[0] / 2), q1(v[1] / 2, -w[1] / 2);
    const double squares = u[0] * u[0] + u[1] * u[1] + 2 * (std::norm(q0) + std::norm(q1));
    const std::array<complex, 3> coefficients{squares - 1, 2. * (u[0] * q0 + u[1] * q1),
                                              q0 * q0 + q1 * q1};
    // Ratio of round-off to that of coefficients of which the largest is 1.
    const double noise =
        (squares + 1) / std::sqrt(std::max({std::norm(coefficients[0]), std::norm(coefficients[1]),
                                            std::norm(coefficients[2])}));
    constexpr double vanishing = 1e12;
    if (noise > vanishing) {
      return false; // for every φ there is a θ
    }
    const circle_roots<2> roots(coefficients);
    std::array<bool, 4> is_done{};
    for (int i = 0; i < 4; ++i) {
      const complex z = roots[i];
      const double off = std::sqrt(std::norm(z)) - 1, sensitivity = noise * roots.sensitivity(i),
                   error = std::min(1e-5, 1e-9 + 1e-13 * sensitivity);
      const auto visit_at = [&](double phi, int multiplicity) {
        const double c = std::cos(phi), s = std::sin(phi);
        visit(std::atan2(u[1] + v[1] * c + w[1] * s, u[0] + v[0] * c + w[0] * s), phi,
              multiplicity);
      };
      // Two zeros z and 1/z̄ that nearly coincide, which round-off may have made complex.
      if (off > error && off < std::min(1e-2, 1e-11 * sensitivity)) {
        visit_at(std::arg(z) - off, 1);
        visit_at(std::arg(z) + off, 1);
      }
      if (is_done[std::size_t(i)] || !(std::abs(off) < error)) {
        continue;
      }
      int multiplicity = 1;
      for (int j = i + 1; j < 4; ++j) {
        if (std::abs(roots[j] - z) < one_angle) {
          is_done[std::size_t(j)] = true;
          ++multiplicity;
        }
      }
      visit_at(std::arg(z), multiplicity);
    }
    return true;
  }
};

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
  void operator()(double theta, double phi, int multiplicity, const auto& visit) {
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

  void visit_near_axis(const angles& seed, local_quadratic local, const auto& visit) {
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

  void visit_new(const angles& x, double error, int multiplicity, const auto& visit) {
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

  void visit_one(const angles& x, const perpendiculars& w, double error, int multiplicity,
                 const auto& visit) {
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

[[nodiscard]] inline bool is_on(const vector3d& n, const vector3d& v) {
  constexpr double rounding = 1e-9;
  return length_of(cross(n, v)) < rounding;
}
/// Product of the rotations by α and β about axes a and b.
[[nodiscard]] inline quaternion<double> rotation_product(const vector3d& a, double alpha,
                                                         const vector3d& b, double beta) {
  const sines_at_once<2> halves(alpha / 2, beta / 2);
  return rotation_about_axis(a, halves.sine(0), halves.cosine(0)) *
         rotation_about_axis(b, halves.sine(1), halves.cosine(1));
}

/// Two rotations, first by β about b, then by α about a, that map one unit vector to another:
/// Paden–Kahan subproblem 2 for directions.
class subproblem2 {
public:
  struct solution {
    double alpha = 0, beta = 0;
    int multiplicity = 1;
  };

  /// Solves for both angles.
  ///
  /// \param error  error of the vectors, if it exceeds round-off
  subproblem2(const vector3d& a, const vector3d& b, const vector3d& from, const vector3d& to,
              double error = 0) {
    const rotating_vector by_b(b, from);
    connecting_rotation first(a, by_b, to);
    const bool has_beta = visit_zeros(
        {dot(a, by_b.along) - dot(a, to), dot(a, by_b.across), dot(a, by_b.normal)},
        [&](double near_beta, int near_multiplicity) {
          first(near_beta, 0, near_multiplicity, [&](double beta, double, double alpha, int m) {
            all_[std::size_t(count_++)] = {alpha, beta, m};
          });
        },
        error);
    nearest_ = !has_beta ? 0 : first.nearest();
    if (error > 0) {
      nearest_ = std::min(nearest_, length_of(cross(a, to)));
    }
  }

  [[nodiscard]] const solution* begin() const { return all_.data(); }
  [[nodiscard]] const solution* end() const { return all_.data() + count_; }
  /// Smallest distance of the rotated vector from the axis a; 0 if α or β is undetermined. With an
  /// error, which near the axis decides whether angles are complex, the distance of the target
  /// vector counts, too.
  [[nodiscard]] double nearest() const { return nearest_; }

private:
  std::array<solution, 4> all_; // two values of β, each of which may have a neighbour
  int count_ = 0;
  double nearest_ = 0;
};

/// Angle that satisfies an equation, with its multiplicity.
struct angle_solution {
  double theta = 0;
  int multiplicity = 1;
};

/// Angles θ with |v(θ)| = length (Paden–Kahan subproblem 3), for a length less than half of the
/// maximum. At x from the known angle of the minimum, |v|² = minimum² + 4 r sin²(x/2).
[[nodiscard]] inline std::vector<angle_solution> subproblem3(const rotating_vector& v,
                                                             double length) {
  constexpr double rounding = 1e-14;
  const double b = dot(v.along, v.across), c = dot(v.along, v.normal), r = std::hypot(b, c);
  const double at_minimum = std::atan2(-c, -b), minimum = length_of(v.at(at_minimum));
  const double square = (length - minimum) * (length + minimum) / (4 * r);
  if (std::abs(length - minimum) <= rounding) {
    return {{at_minimum, 2}};
  }
  if (square > 0 && square <= 1) {
    const double x = 2 * std::asin(std::sqrt(square));
    return {{at_minimum - x, 1}, {at_minimum + x, 1}};
  }
  return {};
}

/// Calls visit(α, β, γ, multiplicity) for each decomposition of a rotation into successive
/// rotations by α, β and γ about the axes of three joints.
///
/// \param error  error of the rotation, if it exceeds round-off
/// \return the sine of the smallest angle between the last axis and the first; 0 if
/// α or β is undetermined
double for_each_three_axis_decomposition(const loop_joint& a, const loop_joint& b,
                                         const loop_joint& c, const quaternion<double>& rotation,
                                         const auto& visit, double error = 0) {
  // The last rotation leaves its axis invariant; the first one preserves the angle between that
  // axis and its own.
  const subproblem2 both(a.axis, b.axis, c.axis, rotated(rotation, c.axis), error);
  for (const auto& [alpha, beta, multiplicity] : both) {
    const quaternion<double> before = rotation_product(a.axis, alpha, b.axis, beta);
    visit(alpha, beta, angle_of(conj(before) * rotation, c.axis), multiplicity);
  }
  return both.nearest();
}

DUET_ABI_END
} // namespace duet::detail
