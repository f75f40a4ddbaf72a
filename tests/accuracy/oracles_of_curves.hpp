// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "accuracy/jet.hpp"
#include "accuracy/probe.hpp"

#include <cstddef>
#include <vector>

/// \file
/// Curves by their definitions, over rotations or, with ε, over poses; and those through given rows
/// by equations that say no more than what is asked of them, solved to 60 digits and more.
///
/// Rotations are four numbers in a list, poses eight, real part first; vectors, three or six,
/// angular first.

namespace duet_test::accuracy::oracle {

enum class over { rotations, poses };

/// P2 on the span [u_{k−1}, u_k) of these 2k knots: c ∏ exp(ω_i B̃_i(u)), k − 1 factors, and its
/// rates. A function of u, c and the ω_i.
///
/// Of Q(u): Q, real part first; 2 Q′Q*, 2 Q*Q′; of poses, whose rates are angular first, also the
/// derivative of the translation.
[[nodiscard]] oracle_function cumulative_motion(std::vector<double> knots, over what);
/// Q exp(x_1 t + x_2 t² + …), t = u − from, and its rates. A function of u, Q and the x_i.
[[nodiscard]] oracle_function piece_motion(double from, over what);

enum class ends { natural, clamped, accelerated, fully_clamped, not_a_knot, periodic };

/// A curve through rows, by equations that are solved anew whenever the rows change.
class interpolation {
public:
  /// \param order  4 or 6 of rotation vectors, 0 for the cumulative cubic
  /// \param start  near the solution: the cubic's control elements, or of rotation vectors the
  ///               coefficients x_1 … of all pieces, three or six numbers each
  interpolation(int order, ends e, over what, std::vector<double> u, std::vector<double> start);

  /// x: the rows; of given ends the rates at the start and those at the end; and parameters, at
  /// each of which the motion is a part of the result.
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
  std::vector<jet_quaternion> guess_; ///< control elements that the unknowns start from
  std::vector<jet_quaternion> solution_;
  std::vector<std::vector<real>> inverse_; ///< of the Jacobian of the real parts
};

/// The cumulative cubic for which ½ Σ |2 log(S(u_i)* Q_i)|² is least, of poses with the linear part
/// over a length: the gradient, by differences, is solved for zero anew whenever the rows change.
class least_squares_fit {
public:
  /// \param knots  of the curve
  /// \param start  its control elements, near the minimum
  least_squares_fit(over what, std::vector<double> knots, std::vector<double> u, double length,
                    std::vector<double> start);

  /// x: the rows, and parameters, at each of which the motion is a part of the result.
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
  reals unknowns_; ///< by which the control elements are turned and shifted from those at the start
  std::vector<reals> inverse_; ///< of the Hessian
};

} // namespace duet_test::accuracy::oracle
