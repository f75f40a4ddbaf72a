// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual/storage/partials.hpp>
#include <duet/dual/storage/structural_zero.hpp>
#include <duet/dual/stumpff.hpp>
#include <duet/dual/taylor.hpp>

#include <array>
#include <cstddef>

/// \file
/// Sine and cosine of a multiple of a constant angle, given by the square of the angle: the
/// functions in the exponential of b v, if v does not depend on the variables of b.
///
/// With the universal functions U_n(b; α) = bⁿ c_n(αb²), derivatives with respect to b need no
/// further Stumpff functions: U_0′ = −α U_1, U_1′ = U_0. That with respect to α needs one more,
/// H = ∂U_1/∂α = b³ c₁′(αb²), with ∂U_0/∂α = −½ b U_1 and H′ = −½ b U_1.

namespace duet::detail {

/// U_0, U_1 and, if `Count` is 3, H.
template <class T, std::size_t Count>
using universal_values = std::array<T, Count>;

/// c₀, c₁ and c₁′ beyond z = 1.
template <class R>
[[nodiscard]] DUET_OUT_OF_LINE std::array<R, 3> first_stumpff_functions_of_large(R z) {
  const auto c = first_stumpff_pair(z);
  return {c[0], c[1], rule::stumpff<1>{}.slope(z, c[1])};
}

/// c₀, c₁ and c₁′ of a real number: those of a small one by c₂ and c₃, of which c₁′ is half the
/// difference.
template <Real R>
[[nodiscard]] DUET_ALWAYS_INLINE std::array<R, 3> first_stumpff_functions(const R& z) {
  return select(
      z <= R(1),
      [&]() DUET_INLINE_LAMBDA {
        const R c2 = stumpff_of_small<2, 1>(z);
        const R c3 = stumpff_of_small<3, 1>(z);
        return std::array<R, 3>{R(1 - z * c2), R(1 - z * c3), R((c3 - c2) / 2)};
      },
      [&]() DUET_INLINE_LAMBDA { return first_stumpff_functions_of_large(z); });
}

template <std::size_t Count, class B, class A>
[[nodiscard]] DUET_ALWAYS_INLINE auto universal_functions(const B& b, const A& alpha);

/// Universal functions by the Stumpff functions of αb², for any dependence of b and α.
template <std::size_t Count, class D>
[[nodiscard]] DUET_ALWAYS_INLINE universal_values<D, Count>
universal_functions_by_square(const D& b, const D& alpha) {
  const D square = b * b;
  const D z = alpha * square;
  if constexpr (!Infinitesimal<D> && Count == 3) {
    const auto c = first_stumpff_functions(z);
    return {c[0], b * c[1], square * b * c[2]};
  } else {
    const auto c = first_stumpff_pair(z);
    universal_values<D, Count> result{c[0], D(b * c[1])};
    if constexpr (Count == 3) {
      result[2] = square * b * rule::stumpff<1>{}.slope(z, c[1]);
    }
    return result;
  }
}

/// Lifts the functions of the value of b to those of b; α is the same for both.
template <std::size_t Count, class T, int K, class Tag, class V, class A>
[[nodiscard]] DUET_ALWAYS_INLINE auto lifted_by_b(const universal_values<V, Count>& below,
                                                  const taylor<T, K, Tag>& b, const A& alpha) {
  universal_values<taylor<V, K, Tag>, Count> u;
  for (std::size_t i = 0; i < Count; ++i) {
    u[i].set_coefficient(0, below[i]);
  }
  // k u_k = Σ j b_j f_{k−j}, where f is the slope
  unrolled<K>([&](int i) DUET_INLINE_LAMBDA {
    const int k = i + 1;
    V d0(0), d1(0), d2(0);
    unrolled<K>([&](int m) DUET_INLINE_LAMBDA {
      const int j = m + 1;
      if (j <= k) {
        const T db = b.coefficient(j) * integer<T>(j);
        d0 = j == 1 ? V(u[1].coefficient(k - j) * db) : V(d0 + u[1].coefficient(k - j) * db);
        d1 = j == 1 ? V(u[0].coefficient(k - j) * db) : V(d1 + u[0].coefficient(k - j) * db);
        if constexpr (Count == 3) {
          V moment = u[1].coefficient(k - j) * b.coefficient(0);
          unrolled<K>([&](int n) DUET_INLINE_LAMBDA {
            if (n < k - j) {
              moment = moment + u[1].coefficient(k - j - 1 - n) * b.coefficient(n + 1);
            }
          });
          d2 = d2 + moment * db;
        }
      }
    });
    u[0].set_coefficient(k, divided_by_order(V(-(d0 * alpha)), k));
    u[1].set_coefficient(k, divided_by_order(d1, k));
    if constexpr (Count == 3) {
      u[2].set_coefficient(k, divided_by_order(V(d2 * real_type_t<V>(-0.5)), k));
    }
  });
  return u;
}
template <std::size_t Count, class B, class V, class A>
[[nodiscard]] DUET_ALWAYS_INLINE auto lifted_by_b(const universal_values<V, Count>& below,
                                                  const B& b, const A& alpha) {
  using D = over<B, V>;
  const D x(b);
  const V first = -(below[1] * alpha);
  universal_values<D, Count> u{x.composed(below[0], first, V(-(below[0] * alpha))),
                               x.composed(below[1], below[0], first)};
  if constexpr (Count == 3) {
    const real_type_t<V> factor(-0.5);
    u[2] = x.composed(below[2], V(below[1] * b.value() * factor),
                      V((below[1] + below[0] * b.value()) * factor));
  }
  return u;
}

/// Lifts the functions of the value of α to those of α, of first order, by all three of them; b is
/// the same for both.
template <class V, class B, class A>
[[nodiscard]] DUET_ALWAYS_INLINE auto lifted_by_alpha(const universal_values<V, 3>& below,
                                                      const B& b, const A& alpha) {
  using D = over<A, V>;
  const D x(alpha);
  const V slope = below[1] * b * real_type_t<V>(-0.5);
  return universal_values<D, 2>{x.composed(below[0], slope), x.composed(below[1], below[2])};
}

/// True if T has the outermost level of D.
template <class T, class D>
[[nodiscard]] constexpr bool has_level_of() {
  if constexpr (Infinitesimal<D>) {
    return contains_tag<T, level_tag<D>>();
  } else {
    return false;
  }
}

/// A number whose functions are determined by value and slope alone.
template <class A>
concept FirstOrder = requires(const A& x) {
  x.composed(x.value(), x.value());
};

/// U_0(b; α) and U_1(b; α), α ≥ 0; with `Count` 3 also H. Neither argument is widened to the
/// variables of the other.
template <std::size_t Count, class B, class A>
[[nodiscard]] DUET_ALWAYS_INLINE auto universal_functions(const B& b, const A& alpha) {
  using D = promote_t<B, A>;
  constexpr bool moves_b = has_level_of<B, D>();
  constexpr bool moves_alpha = has_level_of<A, D>();
  if constexpr (moves_b && !moves_alpha) {
    return lifted_by_b<Count>(universal_functions<Count>(b.value(), alpha), b, alpha);
  } else if constexpr (moves_alpha && !moves_b && FirstOrder<A> && Count == 2) {
    return lifted_by_alpha(universal_functions<3>(b, alpha.value()), b, alpha);
  } else {
    return universal_functions_by_square<Count>(D(b), D(alpha));
  }
}

} // namespace duet::detail
