// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/robotics/branches/circle_roots.hpp>
#include <duet/robotics/branches/loop_equation.hpp>
#include <duet/robotics/branches/subproblems.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>

/// \file
/// Solutions of a loop of four revolute and two prismatic joints as zeros of a polynomial in the
/// angle α of the first joint, which must be revolute.
///
/// Prismatic joints do not rotate anything: at an α the other three angles β, γ and δ make a given
/// rotation, on two branches, z = e^{iγ} being the zeros of a quadratic. The remaining translation
/// must then be in the plane of the prismatic axes n₁ and n₂: f = (n₁ × n₂)·t = 0. With w the
/// cosine of the angle between the axes of β and δ, f₊ f₋ (1 − w²) is a trigonometric polynomial of
/// degree 4 in α, with eight zeros. (Page: all_inverse_kinematics.)

namespace duet::detail {

/// System of equations for a loop of four revolute and two prismatic joints.
class two_prismatic {
  using complex = std::complex<double>;

public:
  explicit two_prismatic(const loop_equation& loop) : loop_(loop) {
    for (std::size_t i = 0, revolute_count = 0, prismatic_count = 0; i < 6; ++i) {
      (loop.joints[i].is_revolute ? revolute_[revolute_count++] : prismatic_[prismatic_count++]) =
          i;
    }
  }

  static constexpr int max_solutions = 8; ///< maximum number of solutions
  static constexpr int hidden = 0; ///< index of the joint whose angle the polynomial depends on

  struct zeros {
    std::array<complex, 8> values; ///< e^{iα}
    double regularity = 0;         ///< close to 0 if the polynomial vanishes for all angles
  };

  /// Zeros of the polynomial.
  [[nodiscard]] zeros roots() const {
    using all_roots = circle_roots<4>;
    zeros result;
    all_roots::values values;
    for (int k = 0; k < all_roots::samples; ++k) {
      values[std::size_t(k)] = loop_at(*this, all_roots::angle(k) + start).determinant();
      result.regularity = std::max(result.regularity, std::abs(values[std::size_t(k)]));
    }
    const all_roots roots_of_polynomial(all_roots::interpolated(values));
    for (int i = 0; i < all_roots::count; ++i) {
      result.values[std::size_t(i)] = std::polar(1., start) * roots_of_polynomial[i];
    }
    return result;
  }

  /// Calls visit(θ) with coordinates near the real solutions with the angle of a zero.
  template <class Visit>
  void solution_at(double alpha, const Visit& visit) const {
    const loop_at at(*this, alpha);
    const auto size = [&](std::size_t k) { return std::abs(at.branches[k].determinant); };
    const std::size_t best = size(0) < size(1) ? 0 : 1;
    constexpr double rounding = 1e-3;
    const bool both = std::max(size(0), size(1)) < rounding;
    for (const std::size_t k : {best, 1 - best}) {
      const auto& branch = at.branches[k];
      if ((k == best || both) && std::abs(std::log(std::abs(branch.z))) < .1) {
        visit(coordinates(alpha, std::arg(branch.z)));
      }
    }
  }

private:
  using matrix = Eigen::Matrix3cd;
  using vector = Eigen::Vector3cd;

  /// First angle at which the polynomial is sampled: no known arm has parallel axes there.
  static constexpr double start = .37;

  [[nodiscard]] const loop_joint& revolute(std::size_t k) const {
    return loop_.joints[revolute_[k]];
  }

  /// Product a·b without conjugation, also of complex vectors.
  [[nodiscard]] static complex product(const vector& a, const vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
  [[nodiscard]] static matrix rotation_matrix(const three_vector<double>& axis, complex cosine,
                                              complex sine) {
    const Eigen::Vector3d n = axis;
    Eigen::Matrix3d cross_with_n;
    cross_with_n << 0, -n[2], n[1], n[2], 0, -n[0], -n[1], n[0], 0;
    const Eigen::Matrix3d along = n * n.transpose();
    return along + cosine * (Eigen::Matrix3d::Identity() - along) + sine * cross_with_n;
  }

  /// Values at an angle of the first joint, on both branches of the other angles, real or complex.
  struct loop_at {
    struct branch {
      complex z;           ///< e^{iγ}
      complex determinant; ///< f
    };
    std::array<branch, 2> branches;
    double across; ///< 1 − w²

    loop_at(const two_prismatic& loop, double alpha) {
      const loop_joint &b = loop.revolute(1), &c = loop.revolute(2), &d = loop.revolute(3);
      std::array<matrix, 4> rotations;
      rotations[0] = rotation_matrix(loop.revolute(0).axis, std::cos(alpha), std::sin(alpha));
      const matrix closing = rotation_matrix_of(loop.loop_.closing.rotation);
      const matrix rest = rotations[0].transpose() * closing; // rotation by β, γ and δ
      const vector first = Eigen::Vector3d(b.axis).cast<complex>();
      const vector last = Eigen::Vector3d(d.axis).cast<complex>();
      const vector goal = rest * last;
      const complex w = product(first, goal);
      across = 1 - (w * w).real();
      // b·R_γ d = w, a quadratic of z.
      const rotating_vector by_c(c.axis, d.axis);
      const complex cosine = dot(b.axis, by_c.across) / 2;
      const complex sine = complex(0, -.5) * dot(b.axis, by_c.normal);
      const complex constant = dot(b.axis, by_c.along) - w;
      const complex root = std::sqrt(constant * constant - 4. * (cosine + sine) * (cosine - sine));
      for (std::size_t k = 0; k < 2; ++k) {
        branch& x = branches[k];
        x.z = (-constant + (k == 0 ? root : -root)) / (2. * (cosine + sine));
        rotations[2] =
            rotation_matrix(c.axis, (x.z + 1. / x.z) / 2., (x.z - 1. / x.z) / complex(0, 2));
        const vector from = rotations[2] * last;
        const vector normal(from[1] * goal[2] - from[2] * goal[1],
                            from[2] * goal[0] - from[0] * goal[2],
                            from[0] * goal[1] - from[1] * goal[0]);
        rotations[1] = rotation_matrix(b.axis, (product(from, goal) - w * w) / across,
                                       product(first, normal) / across);
        rotations[3] = (rotations[1] * rotations[2]).transpose() * rest;
        x.determinant = loop.closure_condition(rotations);
      }
    }

    [[nodiscard]] double determinant() const {
      return (branches[0].determinant * branches[1].determinant).real() * across;
    }
  };

  [[nodiscard]] static matrix rotation_matrix_of(const quaternion<double>& q) {
    matrix result;
    for (int k = 0; k < 3; ++k) {
      const three_vector<double> e{k == 0 ? 1. : 0., k == 1 ? 1. : 0., k == 2 ? 1. : 0.};
      result.col(k) = Eigen::Vector3d(rotated(q, e)).cast<complex>();
    }
    return result;
  }

  /// Closure condition (n₁ × n₂)·t, with t the remaining translation if prismatic joints are at 0.
  [[nodiscard]] complex closure_condition(const std::array<matrix, 4>& rotations) const {
    matrix link = matrix::Identity(), columns; // n₁, n₂, t
    vector at = vector::Zero();
    for (std::size_t i = 0, revolute_count = 0, prismatic_count = 0; i < 6; ++i) {
      const loop_joint& j = loop_.joints[i];
      if (j.is_revolute) {
        const matrix& by = rotations[revolute_count++];
        const vector p = Eigen::Vector3d(j.point).cast<complex>();
        at += link * (p - by * p);
        link = link * by;
      } else {
        columns.col(Eigen::Index(prismatic_count++)) =
            link * Eigen::Vector3d(j.axis).cast<complex>();
      }
    }
    columns.col(2) = Eigen::Vector3d(loop_.closing.translation).cast<complex>() - at;
    return columns.determinant();
  }

  /// All coordinates for given α and γ.
  [[nodiscard]] six_coordinates coordinates(double alpha, double gamma) const {
    const loop_joint &a = revolute(0), &b = revolute(1), &c = revolute(2), &d = revolute(3);
    six_coordinates result = six_coordinates::Zero();
    const auto set = [&](std::size_t k, double x) { result[Eigen::Index(revolute_[k])] = x; };
    const quaternion<double> rest =
        conj(rotation_about_axis(a.axis, std::sin(alpha / 2), std::cos(alpha / 2))) *
        loop_.closing.rotation;
    const double beta = subproblem1_angle_about(b.axis, rotating_vector(c.axis, d.axis).at(gamma),
                                                rotated(rest, d.axis));
    set(0, alpha);
    set(1, beta);
    set(2, gamma);
    set(3, angle_of(conj(rotation_product(b.axis, beta, c.axis, gamma)) * rest, d.axis));
    const closure_error closure(loop_, result);
    const auto linear_part = [](const auto& x) { return Eigen::Vector3d(x.template head<3>()); };
    const auto direction = [&](std::size_t k) {
      return linear_part(closure.jacobian.col(Eigen::Index(prismatic_[k])));
    };
    // Component of the closure error in the plane of both axes. If these are parallel nothing is
    // finite, which `close_loop` rejects as an initial guess.
    const Eigen::Vector3d first = direction(0), second = direction(1),
                          remaining = linear_part(closure.twist);
    const Eigen::Vector3d across = first.cross(second);
    const double square = across.squaredNorm();
    result[Eigen::Index(prismatic_[0])] = remaining.cross(second).dot(across) / square;
    result[Eigen::Index(prismatic_[1])] = first.cross(remaining).dot(across) / square;
    return result;
  }

  loop_equation loop_;
  std::array<std::size_t, 4> revolute_{};
  std::array<std::size_t, 2> prismatic_{};
};

} // namespace duet::detail
