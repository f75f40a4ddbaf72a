// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/planning/branches/circle_roots.hpp>
#include <duet/planning/branches/complex_eigenvectors.hpp>
#include <duet/planning/branches/joint_loop.hpp>
#include <duet/planning/branches/line_coordinates.hpp>
#include <duet/planning/branches/orthonormalise.hpp>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>

/// \file
/// A loop of six joints as the zeros of a determinant in the angle of the third, which must turn,
/// as must the sixth.
///
/// The line of the sixth joint, displaced by the joints 3 to 5, is where it comes to from the goal
/// by the joints 2 and 1 backwards. Of the 14 equations of its `line_coordinates` six are left once
/// the eight products of the two are eliminated; times cos θ₄/2 and sin θ₄/2 they are twelve,
/// linear in twelve products of θ₄/2 and θ₅, of a matrix that depends on θ₃. (Page:
/// all_inverse_kinematics.)

namespace duet::detail {

class elimination {
  using complex = std::complex<double>;

public:
  using matrix = Eigen::Matrix<double, 12, 12>;
  using decomposition = Eigen::PartialPivLU<matrix>;

  explicit elimination(const joint_loop& loop) : loop_(loop) {
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
    Eigen::ColPivHouseholderQR<Eigen::Matrix<double, 14, 8>> factors;
    factors.setThreshold(1e-10);
    factors.compute(goal.rightCols<8>());
    const auto& r = factors.matrixQR();
    // One by one: by blocks, as Eigen applies them by itself, compilers take longer.
    Eigen::Matrix<double, 27, 1> workspace;
    for (Eigen::Index k = 0; k < 8; ++k) {
      arm_.bottomRows(14 - k).applyHouseholderOnTheLeft(r.col(k).tail(13 - k), factors.hCoeffs()[k],
                                                        workspace.data());
    }
    const auto& order = factors.colsPermutation().indices();
    rank_ = factors.rank();
    for (Eigen::Index k = rank_; k-- > 0;) {
      auto row = eliminated_.row(order[k]) = arm_.row(k);
      for (Eigen::Index j = k + 1; j < rank_; ++j) {
        row -= r(k, j) * eliminated_.row(order[j]);
      }
      row /= r(k, k);
    }
    if (rank_ == 8) {
      left_ = arm_.bottomRows<6>();
    } else { // more equations than needed: six sums of them
      left_.setZero();
      for (Eigen::Index i = rank_; i < 14; ++i) {
        for (Eigen::Index k = 0; k < 6; ++k) {
          left_.row(k) += std::cos(double((i + 1) * (i + 1) * (k + 1))) * arm_.row(i);
        }
      }
    }
  }

  /// The matrix at an angle θ₃. Columns: cos θ₄/2, sin θ₄/2, cos 3θ₄/2, sin 3θ₄/2, or 1, d₄, d₄²,
  /// d₄³, each times 1, cos θ₅, sin θ₅, or 1, d₅, d₅².
  [[nodiscard]] matrix at(double theta) const {
    const Eigen::Matrix<double, 6, 9> a = left_.leftCols<9>() +
                                          std::cos(theta) * left_.middleCols<9>(9) +
                                          std::sin(theta) * left_.rightCols<9>();
    const auto one = a.leftCols<3>(), cosine = a.middleCols<3>(3), sine = a.rightCols<3>();
    matrix m;
    if (loop_.joints[3].turns) {
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

  /// The determinant's degree in e^{iθ₃}, not 12: each of the rows that are left has that with only
  /// four products of the others.
  using roots = circle_roots<8>;

  /// Determinants at the angles of `roots`; nothing but zeros where they vanish for all θ₃.
  [[nodiscard]] roots::values determinants() const {
    roots::values result;
    double best = 0;
    for (int k = 0; k < roots::samples; ++k) {
      const decomposition lu(at(roots::angle(k)));
      const auto pivots = lu.matrixLU().diagonal().cwiseAbs();
      best = std::max(best, pivots.minCoeff() / pivots.maxCoeff());
      result[std::size_t(k)] = lu.determinant();
    }
    if (!(best > 1e-12)) {
      result.fill(0);
    }
    return result;
  }

  /// Calls visit(θ) with coordinates near the real solutions that have this θ₃, of which there are
  /// `count`, complex ones included.
  /// \return the number of real ones
  template <class Visit>
  int solutions_at(double theta, int count, const Visit& visit) const {
    Eigen::Matrix<double, 12, Eigen::Dynamic, Eigen::ColMajor, 12, 12> kernel(12, count);
    for (int j = 0; j < count; ++j) {
      for (int i = 0; i < 12; ++i) {
        kernel(i, j) = std::cos(double(3 * i + 1) * (j + 1));
      }
    }
    const decomposition lu(at(theta + 1e-10)); // no pivot is zero
    for (int k = 0; k < 3; ++k) {              // inverse iteration on the products of the matrix
      kernel = lu.transpose().solve(kernel).eval();
      orthonormalise(kernel);
      kernel = lu.solve(kernel).eval();
      orthonormalise(kernel);
    }
    // The products of a solution times e^{iθ₄}, or d₄, are products of the same solution.
    const complex i(0, 1);
    Eigen::Matrix<complex, 9, Eigen::Dynamic, Eigen::ColMajor, 9, 12> low(9, count), high(9, count);
    if (loop_.joints[3].turns) {
      low.topRows(3) = kernel.middleRows(6, 3) - i * kernel.bottomRows(3);
      low.middleRows(3, 3) = kernel.topRows(3) - i * kernel.middleRows(3, 3);
      low.bottomRows(3) = kernel.topRows(3) + i * kernel.middleRows(3, 3);
      high.topRows(6) = low.bottomRows(6);
      high.bottomRows(3) = kernel.middleRows(6, 3) + i * kernel.bottomRows(3);
    } else {
      low = kernel.topRows(9).template cast<complex>();
      high = kernel.bottomRows(9).template cast<complex>();
    }
    orthonormalise(low, high);
    const small_square right = low.adjoint().lazyProduct(high);
    if (count == 1) {
      return visit_factors(theta, right(0, 0), low.col(0), visit);
    }
    const complex_eigenvectors eigen(right);
    const auto& z = eigen.values;
    const auto products = low.lazyProduct(eigen.vectors).eval();
    int real = 0;
    for (int k = 0; k < count; ++k) {
      int other = -1; // a solution with the same θ₄
      for (int j = 0; j < count; ++j) {
        if (j != k && std::abs(z[j] - z[k]) < 1e-3 * (1 + std::abs(z[k]))) {
          other = j;
        }
      }
      if (other < 0) {
        real += visit_factors(theta, z[k], products.col(k), visit);
      } else if (other > k) {
        Eigen::Matrix<complex, 9, 2> both;
        both << products.col(k), products.col(other);
        real += visit_factors(theta, z[k], both, visit);
      }
    }
    return real;
  }

private:
  [[nodiscard]] bool is_real(complex z) const {
    return loop_.joints[3].turns ? std::abs(std::log(std::abs(z))) < .1
                                 : std::abs(z.imag()) < .1 * (1 + std::abs(z));
  }

  /// Of products of powers of e^{iθ₄}, or d₄, with 1, cos θ₅, sin θ₅, or 1, d₅, d₅², the latter.
  /// Two solutions with the same θ₃ and θ₄ are mixed: of the sums of these those whose squares are
  /// as they should be, c² + s² = 1, or d² = 1 d².
  template <class Products, class Visit>
  int visit_factors(double theta, complex z, const Products& products, const Visit& visit) const {
    if (!is_real(z)) {
      return 0;
    }
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    for (Eigen::Index j = 0; j < products.cols(); ++j) {
      Eigen::Vector3cd sum = Eigen::Vector3cd::Zero();
      for (int k = 0; k < 3; ++k) { // of phases −3θ₄/2, −θ₄/2, θ₄/2; or weights 1, d₄, d₄²
        const complex weight = loop_.joints[3].turns ? std::polar(1., (1.5 - k) * std::arg(z))
                                                     : complex(std::pow(z.real(), k));
        sum += weight * products.col(j).template segment<3>(3 * k);
      }
      squares += (sum * sum.adjoint()).real();
    }
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> span;
    span.computeDirect(squares);
    const Eigen::Vector3d a = span.eigenvectors().col(2), b = span.eigenvectors().col(1);
    if (products.cols() == 1) {
      return visit_factor(theta, z, a, visit);
    }
    const auto form = [&](const Eigen::Vector3d& x, const Eigen::Vector3d& y) {
      return loop_.joints[4].turns ? x[1] * y[1] + x[2] * y[2] - x[0] * y[0]
                                   : x[1] * y[1] - (x[0] * y[2] + x[2] * y[0]) / 2;
    };
    // Zeros of the form at a cos φ + b sin φ, where it is m + r cos(2φ − φ₀).
    const double aa = form(a, a), ab = form(a, b), bb = form(b, b);
    const double r = std::hypot((aa - bb) / 2, ab), start = std::atan2(ab, (aa - bb) / 2);
    const double cosine = -(aa + bb) / 2 / r;
    if (!(std::abs(cosine) < 1.01)) {
      return std::abs(cosine) < 2 ? 2 : 0;
    }
    const double turn = std::acos(std::clamp(cosine, -1., 1.));
    int real = 0;
    for (const double sign : {-1., 1.}) {
      const double phi = (start + sign * turn) / 2;
      real += visit_factor(theta, z, std::cos(phi) * a + std::sin(phi) * b, visit);
    }
    return real;
  }

  /// \return does it solve all 14 equations, not only the sums of them that are left?
  template <class Visit>
  bool visit_factor(double theta3, complex z, Eigen::Vector3d factor, const Visit& visit) const {
    six_coordinates theta;
    theta[2] = theta3;
    theta[3] = loop_.joints[3].turns ? std::arg(z) : z.real();
    if (loop_.joints[4].turns) {
      factor *= std::copysign(1., factor[0]);
      theta[4] = std::atan2(factor[2], factor[1]);
    } else {
      const bool is_small = std::abs(factor[0]) > std::abs(factor[2]);
      theta[4] = is_small ? factor[1] / factor[0] : factor[2] / factor[1];
    }
    // The eliminated products, and of them θ₁ and θ₂.
    const auto weights = [&](std::size_t joint) {
      const double x = theta[Eigen::Index(joint)];
      return loop_.joints[joint].turns ? Eigen::Vector3d(1, std::cos(x), std::sin(x))
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
    theta[1] = loop_.joints[1].turns ? std::atan2(x[1], x[0]) : x[0];
    theta[0] = loop_.joints[0].turns ? std::atan2(x[5], x[2]) : x[2];
    const tip_place rest = inverse_place(product_of_joints(loop_, theta, 0, 5)) * loop_.closing;
    const three_vector<double>& n = loop_.joints[5].axis;
    const quaternion<double>& q = rest.rotation;
    theta[5] = 2 * std::atan2(n.x * q.x() + n.y * q.y() + n.z * q.z(), q.w());
    if (!theta.allFinite()) {
      return false;
    }
    visit(theta);
    const Eigen::Matrix<double, 14, 1> right = arm_ * all;
    return right.tail(14 - rank_).norm() < 1e-3 * (1 + right.norm());
  }

  joint_loop loop_;
  Eigen::Index rank_;                 // of the products that are eliminated
  Eigen::Matrix<double, 14, 27> arm_; // all equations, the first `rank_` with those products
  Eigen::Matrix<double, 8, 27> eliminated_ = Eigen::Matrix<double, 8, 27>::Zero(); // the products
  Eigen::Matrix<double, 6, 27> left_;
};

} // namespace duet::detail
