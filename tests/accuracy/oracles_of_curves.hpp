// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "accuracy/jet.hpp"
#include "accuracy/probe.hpp"

/// \file
/// Curves by their definitions, over rotations or, with ε, over poses; and interpolating
/// curves by the equations of their definition alone, solved to at least 60 digits.
///
/// Rotations are four numbers in a list, poses eight, real part first; vectors, three or six,
/// angular first.

namespace duet_test::accuracy::oracle {

enum class over { rotations, poses };

/// P2 on the span [u_{k−1}, u_k) of these 2k knots: c ∏ exp(ω_i B̃_i(u)), k − 1 factors, and its
/// rates. A function of u, c and the ω_i.
///
/// The motion of Q(u) is Q, real part first, 2 Q′Q* and 2 Q*Q′, for poses with angular rates first
/// and followed by the derivative of the translation.
[[nodiscard]] oracle_function cumulative_motion(std::vector<double> knots, over what);
/// Q exp(x_1 t + x_2 t² + …), t = u − from, and its rates. A function of u, Q and the x_i.
[[nodiscard]] oracle_function piece_motion(double from, over what);

enum class ends { natural, clamped, accelerated, fully_clamped, not_a_knot, periodic };

/// Interpolating curve; its equations are solved again whenever the rows change.
class interpolation {
public:
  /// \param order  4 or 6 for rotation vector splines, 0 for the cumulative cubic
  /// \param start  near the solution: control elements of the cubic, or coefficients x_1 … of
  ///               all segments of a rotation vector spline, three or six numbers each
  interpolation(int order, ends e, over what, std::vector<double> u, std::vector<double> start);

  /// Motions at all parameters. x: the rows; for prescribed ends the rates at the start and at the
  /// end; the parameters.
  [[nodiscard]] jets operator()(const jets& x);

private:
  [[nodiscard]] std::size_t numbers() const { return what_ == over::poses ? 6 : 3; }
  void solve(const jets& x);
  [[nodiscard]] jets residuals(const jets& x, const std::vector<jet_quaternion>& unknowns) const;
  [[nodiscard]] jets residuals_of_cubic(const jets& x,
                                        const std::vector<jet_quaternion>& unknowns) const;
  [[nodiscard]] jets residuals_of_pieces(const jets& x,
                                         const std::vector<jet_quaternion>& unknowns) const;
  [[nodiscard]] jet_quaternion miss(const jets& x, std::size_t i, const jet_quaternion& q) const;
  [[nodiscard]] jet_quaternion at(const jets& x, const std::vector<jet_quaternion>& unknowns,
                                  std::size_t span, const jet& u) const;

  int order_;
  ends ends_;
  over what_;
  std::vector<double> u_, knots_;
  std::vector<jet_quaternion> guess_; ///< initial control elements
  std::vector<jet_quaternion> solution_;
  std::vector<std::vector<real>> inverse_; ///< inverse Jacobian of the real parts
};

/// Cumulative cubic that minimises ½ Σ |2 log(S(u_i)* Q_i)|², for poses with the linear part
/// divided by the characteristic length. A zero of the gradient, by differences, is solved for
/// again whenever the rows change.
class least_squares_fit {
public:
  /// \param knots  knots of the curve
  /// \param start  control elements near the minimum
  least_squares_fit(over what, std::vector<double> knots, std::vector<double> u, double length,
                    std::vector<double> start);

  /// Motions at all parameters. x: the rows, then the parameters.
  [[nodiscard]] jets operator()(const jets& x);

private:
  using reals = std::vector<real>;

  [[nodiscard]] std::size_t numbers() const { return what_ == over::poses ? 6 : 3; }
  [[nodiscard]] std::size_t size() const { return what_ == over::poses ? 8 : 4; }
  [[nodiscard]] std::size_t find_span(double u) const;
  [[nodiscard]] jet_quaternion at(const reals& unknowns, std::size_t span, const jet& u) const;
  /// ½ |2 log(S(u_i)* Q_i)|²
  [[nodiscard]] real cost(const reals& rows, const reals& unknowns, std::size_t i) const;
  void solve(const reals& rows);

  over what_;
  std::vector<double> knots_, u_;
  real length_;
  std::vector<double> start_;
  reals unknowns_; ///< rotations and translations of the control elements from their initial values
  std::vector<reals> inverse_; ///< inverse Hessian
};

} // namespace duet_test::accuracy::oracle
