// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "loop_equation.hpp"

#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <vector>

/// \file
/// Solutions of a loop of six joints as zeros of a determinant in the angle of the
/// third, by elimination after M. Raghavan and B. Roth (1993). The third and the sixth
/// joint must be revolute.
///
/// The axis of the sixth joint displaced by joints 3 to 5 is the axis of the goal displaced by
/// joints 2 and 1 backwards. Of the 14 equations of its `line_coordinates` six remain after
/// elimination of the eight products of θ₁ and θ₂; multiplied by cos θ₄/2 and sin θ₄/2 they are
/// twelve, linear in twelve products of θ₄/2 and θ₅, with a matrix that depends on θ₃; see
/// docs/explanation/six_joint_solver.md.

namespace duet::detail {
DUET_ABI_BEGIN

/// Vector (1, p, p·p, l, p×l, p·l, (p·p) l − 2 (p·l) p) of a point p and a
/// direction l, or a sum of such.
struct line_coordinates {
  three_vector<double> p{0, 0, 0}, l{0, 0, 0}, m{0, 0, 0}, c{0, 0, 0};
  double one = 0, pp = 0, pl = 0;

  [[nodiscard]] static line_coordinates of(const three_vector<double>& p,
                                           const three_vector<double>& l) {
    const double pp = dot(p, p), pl = dot(p, l);
    return {p, l, cross(p, l), pp * l - 2 * pl * p, 1, pp, pl};
  }

  /// Coordinates of p + t and l.
  [[nodiscard]] line_coordinates moved(const three_vector<double>& t) const {
    const double tt = dot(t, t), tl = dot(t, l);
    return {p + one * t,
            l,
            m + cross(t, l),
            c - 2 * cross(t, m) + tt * l - 2 * (pl + tl) * t,
            one,
            pp + 2 * dot(t, p) + tt * one,
            pl + tl};
  }

  /// All coordinates except the first, which is 1.
  [[nodiscard]] Eigen::Matrix<double, 14, 1> equations() const {
    Eigen::Matrix<double, 14, 1> result;
    result << p.x, p.y, p.z, l.x, l.y, l.z, m.x, m.y, m.z, c.x, c.y, c.z, pp, pl;
    return result;
  }
};

/// Coordinates displaced by a joint: the sum of the result with the weights 1, cos θ, sin θ; for a
/// prismatic joint 1, d, d².
[[nodiscard]] inline std::array<line_coordinates, 3> by_joint(const loop_joint& j,
                                                              const line_coordinates& x) {
  const three_vector<double>& n = j.axis;
  const three_vector<double> none{0, 0, 0};
  if (!j.is_revolute) {
    return {x,
            {x.one * n, none, cross(n, x.l), -2 * (cross(n, x.m) + x.pl * n), 0, 2 * dot(n, x.p),
             dot(n, x.l)},
            {none, none, none, x.l - 2 * dot(n, x.l) * n, 0, x.one, 0}};
  }
  const line_coordinates at = x.moved(-1 * j.point);
  const auto along = [&](const three_vector<double>& v) { return dot(n, v) * n; };
  const line_coordinates still{along(at.p), along(at.l), along(at.m), along(at.c),
                               at.one,      at.pp,       at.pl};
  const line_coordinates cosine{
      at.p - still.p, at.l - still.l, at.m - still.m, at.c - still.c, 0, 0, 0};
  const line_coordinates sine{
      cross(n, at.p), cross(n, at.l), cross(n, at.m), cross(n, at.c), 0, 0, 0};
  return {still.moved(j.point), cosine.moved(j.point), sine.moved(j.point)};
}

/// Zeros e^{iα} of the determinant of a system of equations that depends on an angle.
struct determinant_zeros {
  std::vector<std::complex<double>> values;
  double regularity = 0; ///< close to 0 if the determinant vanishes for all angles
};

/// Raghavan–Roth elimination for a loop of six joints.
class elimination {
  using complex = std::complex<double>;

public:
  using matrix = Eigen::Matrix<double, 12, 12>;

  explicit elimination(const loop_equation& loop) : loop_(loop) {
    const auto& joints = loop.joints;
    const auto backwards = [](loop_joint j) {
      j.axis = -1 * j.axis;
      return j;
    };
    const loop_joint last = displaced(loop.closing, joints[5]);
    const auto by_first =
        by_joint(backwards(joints[0]), line_coordinates::of(last.point, last.axis));
    Eigen::Matrix<double, 14, 9> goal;
    for (int i = 0; i < 3; ++i) {
      const auto by_second = by_joint(backwards(joints[1]), by_first[std::size_t(i)]);
      for (int j = 0; j < 3; ++j) {
        goal.col(3 * i + j) = by_second[std::size_t(j)].equations();
      }
    }
    const auto by_fifth =
        by_joint(joints[4], line_coordinates::of(joints[5].point, joints[5].axis));
    for (int k = 0; k < 3; ++k) {
      const auto by_fourth = by_joint(joints[3], by_fifth[std::size_t(k)]);
      for (int j = 0; j < 3; ++j) {
        const auto by_third = by_joint(joints[2], by_fourth[std::size_t(j)]);
        for (int i = 0; i < 3; ++i) {
          arm_.col(9 * i + 3 * j + k) = by_third[std::size_t(i)].equations();
        }
      }
    }
    arm_.col(0) -= goal.col(0);
    const Eigen::ColPivHouseholderQR<Eigen::Matrix<double, 14, 8>> factors(goal.rightCols<8>());
    arm_.applyOnTheLeft(factors.householderQ().adjoint());
    eliminated_ =
        factors.colsPermutation() *
        factors.matrixR().topRows<8>().triangularView<Eigen::Upper>().solve(arm_.topRows<8>());
  }

  /// Matrix at an angle θ₃. Columns: cos θ₄/2, sin θ₄/2, cos 3θ₄/2, sin 3θ₄/2, or 1, d₄, d₄², d₄³,
  /// each times 1, cos θ₅, sin θ₅, or 1, d₅, d₅².
  [[nodiscard]] matrix at(double theta) const {
    const auto remaining = arm_.bottomRows<6>();
    const Eigen::Matrix<double, 6, 9> a = remaining.leftCols<9>() +
                                          std::cos(theta) * remaining.middleCols<9>(9) +
                                          std::sin(theta) * remaining.rightCols<9>();
    const auto one = a.leftCols<3>(), cosine = a.middleCols<3>(3), sine = a.rightCols<3>();
    matrix m;
    if (loop_.joints[3].is_revolute) {
      m.topLeftCorner<6, 3>() = one + .5 * cosine;
      m.block<6, 3>(0, 3) = .5 * sine;
      m.block<6, 3>(0, 6) = .5 * cosine;
      m.block<6, 3>(0, 9) = .5 * sine;
      m.block<6, 3>(6, 0) = .5 * sine;
      m.block<6, 3>(6, 3) = one - .5 * cosine;
      m.block<6, 3>(6, 6) = -.5 * sine;
      m.block<6, 3>(6, 9) = .5 * cosine;
    } else {
      m.setZero();
      m.topLeftCorner<6, 9>() = a;
      m.bottomRightCorner<6, 9>() = a;
    }
    return m;
  }

  static constexpr int max_solutions = 16; ///< maximum number of solutions
  static constexpr int hidden = 2; ///< index of the joint whose angle the determinant depends on

  /// Zeros e^{iθ₃} of the determinant; eight of the 24 are extraneous.
  ///
  /// With x the tangent of half the angle from one at which no known arm has a solution to θ₃, the
  /// matrix is M₀ + 2 x M₁ + x² M₂ up to a factor: x is an eigenvalue of a 24 × 24 matrix, as
  /// accurate as solutions are regular, also if these share θ₃. (Zeros of a polynomial of which m
  /// coincide have an error of ε^{1/m}.)
  [[nodiscard]] determinant_zeros roots() const {
    constexpr double start = .7345;
    const matrix constant = at(start), quadratic = at(start + std::numbers::pi),
                 linear = at(start + std::numbers::pi / 2) - .5 * (constant + quadratic);
    const Eigen::PartialPivLU<matrix> lu(quadratic);
    Eigen::Matrix<double, 24, 24> companion;
    companion.topRows<12>() << matrix::Zero(), matrix::Identity();
    companion.bottomLeftCorner<12, 12>() = -lu.solve(constant);
    companion.bottomRightCorner<12, 12>() = -2 * lu.solve(linear);
    const Eigen::EigenSolver<Eigen::Matrix<double, 24, 24>> solver(companion, false);
    determinant_zeros result;
    const auto pivots = lu.matrixLU().diagonal().cwiseAbs().eval();
    result.regularity = pivots.minCoeff() / pivots.maxCoeff();
    for (Eigen::Index i = 0; i < 24; ++i) {
      const complex i_x = complex(0, 1) * solver.eigenvalues()[i];
      result.values.push_back(std::polar(1., start) * (1. + i_x) / (1. - i_x));
    }
    return result;
  }

  /// Calls visit(θ) with coordinates near the real solution with this θ₃, if there is one.
  void solution_at(double theta3, const auto& visit) const {
    constexpr double nearly_real = .3;
    Eigen::Matrix<double, 12, 1> kernel;
    for (int i = 0; i < 12; ++i) {
      kernel[i] = std::cos(double(3 * i + 1));
    }
    const Eigen::PartialPivLU<matrix> lu(at(theta3 + 1e-10)); // no pivot is zero
    for (int k = 0; k < 3; ++k) {                             // inverse iteration
      kernel = lu.transpose().solve(kernel).eval().normalized();
      kernel = lu.solve(kernel).eval().normalized();
    }
    // The products of a solution times e^{iθ₄}, or d₄, are products of the same solution.
    const complex i(0, 1);
    Eigen::Matrix<complex, 9, 1> low, high;
    const bool is_revolute = loop_.joints[3].is_revolute;
    if (is_revolute) {
      low.head<3>() = kernel.segment<3>(6) - i * kernel.tail<3>();
      low.segment<3>(3) = kernel.head<3>() - i * kernel.segment<3>(3);
      low.tail<3>() = kernel.head<3>() + i * kernel.segment<3>(3);
      high.head<6>() = low.tail<6>();
      high.tail<3>() = kernel.segment<3>(6) + i * kernel.tail<3>();
    } else {
      low = kernel.head<9>().cast<complex>();
      high = kernel.tail<9>().cast<complex>();
    }
    const complex z = low.dot(high) / low.squaredNorm();
    if (!(is_revolute ? std::abs(std::log(std::abs(z))) < nearly_real
                      : std::abs(z.imag()) < nearly_real * (1 + std::abs(z)))) {
      return;
    }
    // Products of 1, cos θ₅, sin θ₅, or 1, d₅, d₅², which are real except for a common factor.
    Eigen::Vector3cd sum = Eigen::Vector3cd::Zero();
    for (int k = 0; k < 3; ++k) { // phases −3θ₄/2, −θ₄/2, θ₄/2; or weights 1, d₄, d₄²
      const complex weight =
          is_revolute ? std::polar(1., (1.5 - k) * std::arg(z)) : complex(std::pow(z.real(), k));
      sum += weight * low.segment<3>(3 * k);
    }
    const complex phase = std::sqrt(sum.cwiseProduct(sum).sum());
    Eigen::Vector3d factor = (sum * std::conj(phase)).real();
    six_coordinates theta;
    theta[2] = theta3;
    theta[3] = is_revolute ? std::arg(z) : z.real();
    if (loop_.joints[4].is_revolute) {
      factor *= std::copysign(1., factor[0]);
      theta[4] = std::atan2(factor[2], factor[1]);
    } else {
      const bool is_small = std::abs(factor[0]) > std::abs(factor[2]);
      theta[4] = is_small ? factor[1] / factor[0] : factor[2] / factor[1];
    }
    // The eliminated products, and θ₁ and θ₂ from them.
    const auto weights = [&](std::size_t joint) {
      const double x = theta[Eigen::Index(joint)];
      return loop_.joints[joint].is_revolute ? Eigen::Vector3d(1, std::cos(x), std::sin(x))
                                             : Eigen::Vector3d(1, x, x * x);
    };
    const Eigen::Vector3d by3 = weights(2), by4 = weights(3), by5 = weights(4);
    Eigen::Matrix<double, 27, 1> all;
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        all.segment<3>(9 * a + 3 * b) = by3[a] * by4[b] * by5;
      }
    }
    const Eigen::Matrix<double, 8, 1> x = eliminated_ * all;
    theta[1] = loop_.joints[1].is_revolute ? std::atan2(x[1], x[0]) : x[0];
    theta[0] = loop_.joints[0].is_revolute ? std::atan2(x[5], x[2]) : x[2];
    const tip_pose rest = inverse_pose(product_of_joints(loop_, theta, 0, 5)) * loop_.closing;
    theta[5] = angle_of(rest.rotation, loop_.joints[5].axis);
    if (theta.allFinite()) {
      visit(theta);
    }
  }

private:
  loop_equation loop_;
  Eigen::Matrix<double, 14, 27> arm_; // all equations, the last six without the eliminated products
  Eigen::Matrix<double, 8, 27> eliminated_; // eliminated products
};

DUET_ABI_END
} // namespace duet::detail
