// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "loop_closure_solver.hpp"

#include <duet/robotics/closed_tree.hpp>

#include <Eigen/Core>

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Curve of configurations along a straight line of the driven coordinates. For those
/// who extend duet.

namespace duet::detail {
DUET_ABI_BEGIN

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
  [[nodiscard]] std::optional<curve_point> start(double direction) const;

  /// All coordinates of the tree.
  [[nodiscard]] Eigen::VectorXd coordinates(const Eigen::VectorXd& x) const;
  /// Rates of all coordinates along a tangent.
  [[nodiscard]] Eigen::VectorXd rates(const Eigen::VectorXd& tangent) const;

  /// The next point, at a step along the tangent (predictor) and back to the curve (corrector).
  /// Empty if the step is too large for the direction of the tangent, the distance back to the
  /// curve, and the volume spanned by the equations and the tangent to change little. That volume
  /// keeps its sign unless another branch meets the curve. (If two more meet it, it may keep its
  /// sign: near such points half the step is checked.)
  [[nodiscard]] std::optional<curve_point> advance(const curve_point& from, double step) const;

  /// The point near x that is reached by minimum-norm steps.
  ///
  /// \param before  the tangent to orient the new one by
  /// \param max_norm    maximum norm of the first step
  [[nodiscard]] std::optional<curve_point>
  nearest_point(Eigen::VectorXd x, const Eigen::VectorXd& before, double max_norm) const;

  /// The point at s, from a point near it.
  [[nodiscard]] std::optional<curve_point> at(double s, const curve_point& guess,
                                              double max_norm) const;

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
  [[nodiscard]] Eigen::VectorXd residuals(const Eigen::VectorXd& x) const;
  /// The matrix A at x.
  [[nodiscard]] Eigen::MatrixXd matrix(const Eigen::VectorXd& x) const;

  /// The quadratic forms wᵀ ∂²F(K v, K v) in v, for each column w.
  [[nodiscard]] std::vector<Eigen::MatrixXd>
  forms(const Eigen::VectorXd& x, const Eigen::MatrixXd& w, const Eigen::MatrixXd& k) const;

private:
  [[nodiscard]] std::optional<curve_point> reached(const curve_point& from, double step) const;

  [[nodiscard]] std::optional<curve_point> point(const Eigen::VectorXd& x,
                                                 const Eigen::VectorXd& before) const;

  [[nodiscard]] static double volume(const curve_point& at, const Eigen::MatrixXd& image);

  /// Corrector: Newton's method with minimum-norm steps, of which the first must not exceed
  /// `max_norm`.
  [[nodiscard]] bool correct(Eigen::VectorXd& x, bool s_is_fixed, double max_norm) const;

  const closed_chain_mechanism& of_;
  Eigen::VectorXd q0_;
  std::vector<int> drives_, dependent_;
  Eigen::VectorXd direction_;
};

/// Names of the coordinates that move most, among those whose rates are not zero.
[[nodiscard]] std::string moving_coordinates(const closed_chain_mechanism& of,
                                             const Eigen::VectorXd& rates);

DUET_ABI_END
} // namespace duet::detail
