// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "support/multiprecision.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Numbers of the oracles: truncated polynomials in t, s and ε in 100 digits. They share neither
/// code nor formulas with the library: functions are composed with Taylor coefficients from their
/// power series.

namespace duet_test::accuracy {

using real = real_100;

/// Monomials t^i s^j u^k ε^l of jets, k and l up to 1; products outside of the list vanish. t and s
/// are the variables of differentiation, u serves derivatives inside of a definition, and ε is
/// that of rigid motion.
class jet_shape {
public:
  using monomial = std::array<int, 4>;

  /// Monomials in t and s, each multiplied by those in u (if `has_u`) and ε.
  explicit jet_shape(const std::vector<std::array<int, 2>>& powers, bool has_u = true);

  /// t up to the fourth power.
  static jet_shape line();
  /// t and s up to the second degree in both.
  static jet_shape plane();
  /// t up to the fifth power, without u.
  static jet_shape curve();

  std::vector<monomial> monomials;
  std::vector<std::array<std::size_t, 3>> products; ///< indices of two factors and of their product
  int degree = 0; ///< maximum number of infinitesimals in a nonzero product

  /// Index of a monomial.
  [[nodiscard]] std::size_t find(const monomial& m) const;

  /// Shape of all existing jets; only one shape at a time is possible.
  static const jet_shape* current;
};

class jet {
public:
  jet() : jet(0) {}
  jet(int constant) : jet(real(constant)) {}
  jet(const real& constant);

  std::vector<real> c; ///< one coefficient per monomial, the first for 1
};

jet operator+(const jet& a, const jet& b);
jet operator-(const jet& a, const jet& b);
jet operator-(const jet& a);
jet operator*(const jet& a, const jet& b);
jet operator/(const jet& a, const jet& b);

jet sqrt(const jet& x);
jet exp(const jet& x);
jet log(const jet& x);
jet sin(const jet& x);
jet cos(const jet& x);
jet atan2(const jet& y, const jet& x);
/// Σ (−s)^k/(2k + n)!: cos √s for n = 0, sin √s/√s for n = 1
jet even_series(const jet& s, int n);
/// atan2(√s, w)/√s
jet angle_over_root(const jet& s, const jet& w);

/// a + εb
jet with_epsilon(const jet& a, const jet& b);
jet without_epsilon(const jet& a);
jet epsilon_part(const jet& a);
jet u_variable();
jet coefficient_of_u(const jet& a);
jet t_variable();
/// ∂a/∂t
jet derivative(const jet& a);

using jets = std::vector<jet>;
/// w, x, y, z
using jet_quaternion = std::array<jet, 4>;

jet_quaternion operator*(const jet_quaternion& p, const jet_quaternion& q);
jet_quaternion operator*(const jet_quaternion& p, const jet& factor);
jet_quaternion conj(const jet_quaternion& q);
jet squared_norm(const jet_quaternion& q);
jet_quaternion exp(const jet_quaternion& q);
jet_quaternion log(const jet_quaternion& q);
/// a (a* b)^τ with a* b normalised.
jet_quaternion slerp(const jet_quaternion& a, const jet_quaternion& b, const jet& tau);

} // namespace duet_test::accuracy
