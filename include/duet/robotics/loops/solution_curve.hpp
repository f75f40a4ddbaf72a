// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/robotics/closed_tree.hpp>
#include <duet/robotics/loops/loop_closure_solver.hpp>
#include <duet/robotics/loops/rank_revealing_svd.hpp>
#include <duet/robotics/loops/second_derivatives.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

/// \file
/// Curve of configurations along a straight line of the driven coordinates. For those
/// who extend duet.

namespace duet::detail {

/// A configuration on the curve, x = (dependent coordinates per unit, s), with its derivatives.
struct curve_point {
  Eigen::VectorXd x;
  Eigen::VectorXd tangent;   ///< unit tangent dx per unit of arc length
  Eigen::MatrixXd matrix;    ///< the matrix A of `solution_curve`
  Eigen::MatrixXd image;     ///< orthonormal columns that span the image of A
  double min_singular_value; ///< smallest nonzero singular value of A

  [[nodiscard]] double s() const { return x[x.size() - 1]; }
  [[nodiscard]] double s_rate() const { return tangent[tangent.size() - 1]; }
};

/// The configurations q(s) of a mechanism whose driven coordinates are on the straight line u₀ + s
/// w, |w| = 1 in units of the coordinates, as a curve in (q_dependent, s), which is smooth where s
/// reverses: the kernel of A = (∂F/∂q_dependent, ∂F/∂u w) is its tangent.
class solution_curve {
public:
  /// \param direction  direction of the driven coordinates, each per unit; of any length except for
  /// 0
  solution_curve(const closed_chain_mechanism& of, const Eigen::VectorXd& q0,
                 std::vector<int> drives, const Eigen::VectorXd& direction)
      : of_(of), q0_(q0), drives_(std::move(drives)), dependent_(all_but(of.size(), drives_)),
        direction_(direction.normalized()) {}

  /// The first point; empty if the curve has no tangent there.
  [[nodiscard]] std::optional<curve_point> start(double direction) const {
    Eigen::VectorXd x(Eigen::Index(dependent_.size()) + 1);
    x << entries(q0_.cwiseQuotient(of_.units()), dependent_), 0;
    return point(x, Eigen::VectorXd::Unit(x.size(), x.size() - 1) * direction);
  }

  /// All coordinates of the tree.
  [[nodiscard]] Eigen::VectorXd coordinates(const Eigen::VectorXd& x) const {
    Eigen::VectorXd q = q0_.cwiseQuotient(of_.units());
    put(x.head(x.size() - 1), dependent_, q);
    put(entries(q, drives_) + x[x.size() - 1] * direction_, drives_, q);
    return q.cwiseProduct(of_.units());
  }
  /// Rates of all coordinates along a tangent.
  [[nodiscard]] Eigen::VectorXd rates(const Eigen::VectorXd& tangent) const {
    Eigen::VectorXd v(of_.size());
    put(tangent.head(tangent.size() - 1), dependent_, v);
    put(tangent[tangent.size() - 1] * direction_, drives_, v);
    return v.cwiseProduct(of_.units());
  }

  /// The next point, at a step along the tangent (predictor) and back to the curve (corrector).
  /// Empty if the step is too large for the direction of the tangent, the distance back to the
  /// curve, and the volume spanned by the equations and the tangent to change little. That volume
  /// keeps its sign unless another branch meets the curve. (If two more meet it, it may keep its
  /// sign: near such points half the step is checked.)
  [[nodiscard]] std::optional<curve_point> advance(const curve_point& from, double step) const {
    const auto to = reached(from, step);
    if (to && from.min_singular_value + to->min_singular_value < 2 * step &&
        !reached(from, step / 2)) {
      return std::nullopt;
    }
    return to;
  }

  /// The point near x that is reached by minimum-norm steps.
  ///
  /// \param before  the tangent to orient the new one by
  /// \param max_norm    maximum norm of the first step
  [[nodiscard]] std::optional<curve_point>
  nearest_point(Eigen::VectorXd x, const Eigen::VectorXd& before, double max_norm) const {
    return correct(x, false, max_norm) ? point(x, before) : std::nullopt;
  }

  /// The point at s, from a point near it.
  [[nodiscard]] std::optional<curve_point> at(double s, const curve_point& guess,
                                              double max_norm) const {
    Eigen::VectorXd x = guess.x;
    x[x.size() - 1] = s;
    return correct(x, true, max_norm) ? point(x, guess.tangent) : std::nullopt;
  }

  /// A step along the tangent from one point and the point of the curve that it leads to.
  struct curve_interval {
    curve_point end;
    double step;
  };
  /// The part of a step up to the zero of a rate, a function of points that changes sign along the
  /// step: by the Illinois variant of regula falsi (false position), which halves the weight of a
  /// bound that is kept.
  template <class Rate>
  [[nodiscard]] curve_interval zero(const curve_point& from, const curve_point& to, double step,
                                    const Rate& rate) const {
    double a = 0, b = step, at_a = rate(from), at_b = rate(to);
    curve_interval result{to, step};
    for (int i = 0, side = 0; i < 60 && at_a != at_b; ++i) {
      const double c = (a * at_b - b * at_a) / (at_b - at_a);
      const auto next = reached(from, c);
      if (!next) {
        break;
      }
      result = {*next, c};
      const double at_c = rate(*next);
      if (std::abs(at_c) < 1e-15 || std::abs(b - a) < 1e-15) {
        break;
      }
      const bool is_beyond = (at_c < 0) == (at_b < 0);
      (is_beyond ? b : a) = c;
      (is_beyond ? at_b : at_a) = at_c;
      const int now = is_beyond ? 1 : -1;
      (is_beyond ? at_a : at_b) *= side == now ? .5 : 1;
      side = now;
    }
    return result;
  }

  /// Residuals F at x.
  [[nodiscard]] Eigen::VectorXd residuals(const Eigen::VectorXd& x) const {
    return of_.residuals(coordinates(x));
  }
  /// The matrix A at x.
  [[nodiscard]] Eigen::MatrixXd matrix(const Eigen::VectorXd& x) const {
    const Eigen::MatrixXd j = unit_jacobian(of_, coordinates(x));
    Eigen::MatrixXd a(j.rows(), x.size());
    a << columns(j, dependent_), columns(j, drives_) * direction_;
    return a;
  }

  /// The quadratic forms wᵀ ∂²F(K v, K v) in v, for each column w.
  [[nodiscard]] std::vector<Eigen::MatrixXd>
  forms(const Eigen::VectorXd& x, const Eigen::MatrixXd& w, const Eigen::MatrixXd& k) const {
    Eigen::MatrixXd unit_rates(of_.size(), k.cols());
    for (Eigen::Index i = 0; i < k.cols(); ++i) {
      unit_rates.col(i) = rates(k.col(i)).cwiseQuotient(of_.units());
    }
    return quadratic_forms(of_, coordinates(x), w, unit_rates);
  }

private:
  [[nodiscard]] std::optional<curve_point> reached(const curve_point& from, double step) const {
    const auto to = nearest_point(from.x + step * from.tangent, from.tangent, step / 4);
    if (!to || to->tangent.dot(from.tangent) < .95) {
      return std::nullopt;
    }
    const double change = volume(*to, from.image) / volume(from, from.image);
    return change > .25 && change < 4 ? to : std::nullopt;
  }

  [[nodiscard]] std::optional<curve_point> point(const Eigen::VectorXd& x,
                                                 const Eigen::VectorXd& before) const {
    curve_point result{x, {}, matrix(x), {}, 0};
    const rank_revealing_svd svd(result.matrix);
    if (svd.rank() != x.size() - 1) {
      return std::nullopt;
    }
    result.tangent = svd.kernel();
    result.tangent *= result.tangent.dot(before) < 0 ? -1 : 1;
    result.image = svd.image();
    result.min_singular_value = svd.rank() > 0 ? svd.singular_values()[svd.rank() - 1] : 1;
    return result;
  }

  [[nodiscard]] static double volume(const curve_point& at, const Eigen::MatrixXd& image) {
    Eigen::MatrixXd m(at.x.size(), at.x.size());
    m << image.transpose().lazyProduct(at.matrix), at.tangent.transpose();
    return m.fullPivLu().determinant();
  }

  /// Corrector: Newton's method with minimum-norm steps, of which the first must not exceed
  /// `max_norm`.
  [[nodiscard]] bool correct(Eigen::VectorXd& x, bool s_is_fixed, double max_norm) const {
    const Eigen::Index n = x.size() - (s_is_fixed ? 1 : 0);
    double before = max_norm;
    for (int i = 0; i < 12; ++i) {
      const Eigen::VectorXd f = residuals(x);
      const rank_revealing_svd svd(matrix(x).leftCols(n));
      if (svd.rank() < x.size() - 1) {
        return false;
      }
      const Eigen::VectorXd dx = -svd.solve(f, x.size() - 1);
      const double length = dx.norm();
      if (!(length <= max_norm)) {
        return false;
      }
      const double rounding = 1e-14 * std::max(1.0, x.norm());
      x.head(n) += dx;
      if (length <= rounding || (length < 1e-10 && length > before / 4)) {
        return residuals(x).norm() <= 1e-11 * std::max(1.0, x.norm());
      }
      if (i > 0 && length > before / 2) {
        return false;
      }
      before = length;
    }
    return false;
  }

  const closed_chain_mechanism& of_;
  Eigen::VectorXd q0_;
  std::vector<int> drives_, dependent_;
  Eigen::VectorXd direction_;
};

} // namespace duet::detail
