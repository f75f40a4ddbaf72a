// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/rules/of_many.hpp>
#include <duet/expression/algebra/product.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/function.hpp>
#include <duet/expression/tree/latex_arithmetic.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>
#include <duet/expression/tree/printed.hpp>

#include <cmath>
#include <concepts>
#include <cstdint>
#include <string>
#include <type_traits>

/// \file
/// Powers of scalars.

namespace duet::expression {

namespace op {

struct log;

/// x^n for an integer n known at compile time: by products from −4 to 5, with an error of at most 4
/// units in the last place, otherwise by `pow`.
template <int Exponent>
struct whole_power {
  static_assert(Exponent >= 2 || Exponent <= -1);
  static constexpr kind kind_of(kind a) { return a; }
  template <class X>
  static constexpr X value(const X& x) {
    if constexpr (!detail::is_accurate_by_products(Exponent) &&
                  std::floating_point<real_type_t<X>> && !Infinitesimal<X>) {
      if (!std::is_constant_evaluated()) {
        using std::pow;
        return X(pow(x, X(Exponent)));
      }
    }
    return detail::power_by_products<Exponent>(x);
  }
};

/// x^p.
struct power : detail::function<power, duet::rule::pow> {
  static constexpr bool slopes_take_value = true;
  /// Powers by integers from −16 to 16 are `whole_power`.
  static constexpr auto simplified(auto x, auto p) {
    const double n = p.is_zero() ? 0 : p.entry().number;
    const bool is_whole = x.tape->is_number(p.index) && n >= -16 && n <= 16 && n == int(n);
    return x.index == 1 || p.is_zero() ? x.at(1)
           : is_whole                  ? x.at(x.tape->power(x.index, int(n)))
                                       : x.none();
  }
  template <class X, class P>
  static auto value(const X& x, const P& p) {
    using std::pow;
    return static_cast<promote_t<X, P>>(pow(x, p));
  }
  /// The slope with respect to x is that for constant p, and vice versa.
  template <int I, class Y, class X, class P>
  static Y slope_at(const Y& y, const X& x, const P& p) {
    if constexpr (I == 0 && std::is_same_v<X, Y>) {
      return duet::rule::power<P>{p}.slope(x, y);
    } else if constexpr (I == 1 && std::is_same_v<P, Y>) {
      return duet::rule::exponential<X>{x}.slope(p, y);
    } else {
      return duet::rule::pow{}.slopes(y, Y(x), Y(p))[I];
    }
  }
  template <int I, class X, class P>
  static constexpr auto symbolic_derivative(X x, P p) {
    if constexpr (I == 0) {
      return p * apply<power>(x, p - whole<1>);
    } else {
      return apply<power>(x, p) * apply<log>(x);
    }
  }
  static printed print(notation style, const printed& x, const printed& p) {
    if (style != notation::text) {
      return detail::latex_power(x, p);
    }
    return {x.inside(precedence::atom) + "^" + p.inside(precedence::atom), precedence::power};
  }
};

} // namespace op

/// x^p of scalars. Integer exponents known at compile time, such as `c<2>`, are simplified.
template <class X, class P, class Tag = decltype([](op::power*) {})>
  requires Operands<X, P> &&(!QuaternionTerm<X> && !PoseTerm<X>)
      [[nodiscard]] constexpr auto pow(const X& x, const P& p) {
    return apply<op::power>(detail::term<Tag>(x), detail::term<Tag>(p));
  }

} // namespace duet::expression
