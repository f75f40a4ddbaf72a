// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual/math.hpp>

#include <boost/math/policies/policy.hpp>
#include <boost/math/special_functions/bessel.hpp>

#include <cmath>
#include <limits>

/// \file
/// Derivatives of the Bessel functions of special_functions.hpp; see dual/rules/elementary.hpp.

namespace duet::detail {

namespace policies = boost::math::policies;
/// Infinities and NaN instead of exceptions, as in `<cmath>`.
using quiet_policy = policies::policy<policies::domain_error<policies::ignore_error>,
                                      policies::pole_error<policies::ignore_error>,
                                      policies::overflow_error<policies::ignore_error>,
                                      policies::evaluation_error<policies::ignore_error>>;

/// Base of the rules below: `plain(x)` is the value of a plain number.
template <class Rule>
struct rule_by_boost {
  template <class T>
  T value(const T& x) const {
    if constexpr (Infinitesimal<T>) {
      return lift(static_cast<const Rule&>(*this), x);
    } else {
      return static_cast<const Rule&>(*this).plain(x);
    }
  }
};

enum class bessel { j, y, i, k };

/// 2 C_ν′ = ±C_{ν−1} ± C_{ν+1}, without a division by x.
///
/// If x² is negligible beside 1, one of the two terms is the complete sum: the rest of the other,
/// and of its derivatives, would be ∞ − ∞.
template <bessel Kind>
struct cylinder : rule_by_boost<cylinder<Kind>> {
  static constexpr bool is_second = Kind == bessel::y || Kind == bessel::k;
  double order;
  constexpr explicit cylinder(double nu) : order(nu) {}

  template <class T>
  T plain(const T& x) const {
    if (x == 0) {
      return at_zero<T>();
    }
    if (Kind == bessel::y && order < 0 && is_integer()) { // Boost has another sign for small x
      const T y = cylinder(-order).plain(x);
      return std::fmod(order, 2) == 0 ? y : T(-y);
    }
    const T nu(order);
    if constexpr (Kind == bessel::j) {
      return boost::math::cyl_bessel_j(nu, x, quiet_policy());
    } else if constexpr (Kind == bessel::y) {
      return boost::math::cyl_neumann(nu, x, quiet_policy());
    } else if constexpr (Kind == bessel::i) {
      return boost::math::cyl_bessel_i(nu, x, quiet_policy());
    } else {
      return boost::math::cyl_bessel_k(nu, x, quiet_policy());
    }
  }
  template <class T>
  T slope(const T& x, const T&) const {
    using std::isinf;
    constexpr bool is_sum = Kind == bessel::i || Kind == bessel::k;
    T above = cylinder(order + 1).value(x);
    if (order == 0) {
      return Kind == bessel::i ? above : T(-above);
    }
    T below = cylinder(order - 1).value(x);
    const auto& z = innermost(x);
    const T& larger = is_larger_above() ? above : below;
    if (has_branch_point() &&
        (z * z < std::numeric_limits<real_type_t<T>>::min() || isinf(innermost(larger)))) {
      (is_larger_above() ? below : above) = T(0);
    }
    const T sum = is_sum ? T(below + above) : T(below - above);
    return Kind == bessel::k ? T(-sum / 2) : T(sum / 2);
  }

private:
  [[nodiscard]] bool is_integer() const { return std::trunc(order) == order; }
  /// Y_−½, Y_−3/2, …, which are ±J_½, ±J_3/2, …
  [[nodiscard]] bool is_of_first_kind() const {
    return !is_second ||
           (Kind == bessel::y && order < 0 && !is_integer() && cylinder(order + 0.5).is_integer());
  }
  /// True if it is not a power series at 0.
  [[nodiscard]] bool has_branch_point() const { return is_second || !is_integer(); }
  /// True if `above` is the larger of the two terms of the slope near 0.
  [[nodiscard]] bool is_larger_above() const {
    return is_second && (order > 0 || is_of_first_kind());
  }

  /// The limit from above.
  template <class T>
  [[nodiscard]] T at_zero() const {
    const double size = std::abs(order);
    const bool is_odd = std::fmod(std::floor(size), 2) == 1;
    const T infinity = std::numeric_limits<T>::infinity();
    if constexpr (Kind == bessel::k) {
      return infinity;
    } else if constexpr (Kind == bessel::y) {
      if (is_of_first_kind()) {
        return T(0);
      }
      // Y_−ν = cos νπ Y_ν + sin νπ J_ν
      const bool is_positive = order < 0 && std::fmod(std::floor(size + 0.5), 2) == 1;
      return is_positive ? infinity : T(-infinity);
    } else {
      if (order > 0 || (order != 0 && is_integer())) {
        return T(0);
      }
      return order == 0 ? T(1) : is_odd ? T(-infinity) : infinity; // (x/2)^ν/Γ(ν + 1)
    }
  }
};

/// (2n + 1) f_n′ = n f_{n−1} − (n + 1) f_{n+1}
template <bool IsNeumann>
struct spherical_bessel_rule : rule_by_boost<spherical_bessel_rule<IsNeumann>> {
  unsigned order;
  constexpr explicit spherical_bessel_rule(unsigned n) : order(n) {}

  template <class T>
  T plain(const T& x) const {
    if constexpr (IsNeumann) {
      return boost::math::sph_neumann(order, x, quiet_policy());
    } else {
      return boost::math::sph_bessel(order, x, quiet_policy());
    }
  }
  template <class T>
  T slope(const T& x, const T&) const {
    using std::isinf;
    using real = real_type_t<T>;
    const T above = spherical_bessel_rule(order + 1).value(x);
    if (order == 0) {
      return -above;
    }
    if (IsNeumann && isinf(innermost(above))) { // it is the larger one
      return -above;
    }
    return (real(order) * spherical_bessel_rule(order - 1).value(x) - real(order + 1) * above) /
           real(2 * order + 1);
  }
};

} // namespace duet::detail
