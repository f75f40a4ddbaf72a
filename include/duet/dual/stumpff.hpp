// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/partials.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual/rules/elementary.hpp>
#include <duet/dual/taylor.hpp>

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>

/// \file
/// Functions underlying exp and log of quaternions, over every scalar: regular where sine, cosine
/// and arctangent forms are not, with exact derivatives of every order. For those who extend duet.
///
/// Stumpff functions c_n(s) = Σ_k (−s)^k / (2k+n)! of s ≥ 0 are sine and cosine without the
/// removable singularities of exp and log at the identity: c₀ = cos √s, c₁ = sin √s / √s, c₂ = (1 −
/// c₀)/s, c₃ = (1 − c₁)/s, …

namespace duet::detail {

/// 1/(2k+n)!, k = 0, 1, …
template <class T, int Terms>
[[nodiscard]] constexpr std::array<T, std::size_t(Terms)> stumpff_coefficients(int n) {
  std::array<T, std::size_t(Terms)> result{};
  long double factorial = 1;
  for (int i = 2; i <= n; ++i) {
    factorial *= i;
  }
  for (int k = 0; k < Terms; ++k) {
    result[std::size_t(k)] = static_cast<T>(1 / factorial);
    factorial *= (2.0L * k + n + 1) * (2.0L * k + n + 2);
  }
  return result;
}

/// Every other term from the K-th on by Horner's rule, unrolled.
template <int N, int Terms, int K, class T>
[[nodiscard]] DUET_ALWAYS_INLINE T stumpff_half_polynomial(const T& square) {
  constexpr auto coefficient = stumpff_coefficients<lane_type_t<T>, Terms>(N)[K];
  if constexpr (K + 2 >= Terms) {
    return coefficient;
  } else {
    return coefficient + square * stumpff_half_polynomial<N, Terms, K + 2>(square);
  }
}

/// The first terms of the series. Separate sums of even and odd terms take half as long, as neither
/// waits for the other.
template <int N, int Terms, class T>
[[nodiscard]] DUET_ALWAYS_INLINE T stumpff_polynomial(const T& s) {
  const T square = s * s;
  return stumpff_half_polynomial<N, Terms, 0>(square) -
         s * stumpff_half_polynomial<N, Terms, 1>(square);
}

/// The series, summed until its terms vanish, for types without a fixed number of digits.
template <int N, class T>
[[nodiscard]] T stumpff_series(const T& s) {
  T term(1);
  for (int i = 2; i <= N; ++i) {
    term /= i;
  }
  T sum = term;
  for (int k = 0; abs(term) > std::numeric_limits<T>::epsilon() * abs(sum) / 8; ++k) {
    term *= -s / ((2 * k + N + 1) * (2 * k + N + 2));
    sum += term;
  }
  return sum;
}

/// 1/(n−2)!, the initial value of the recurrence c_n = (1/(n−2)! − c_{n−2})/s.
template <class T>
[[nodiscard]] constexpr T inverse_factorial(int n) {
  T factorial(1);
  for (int i = 2; i <= n; ++i) {
    factorial = factorial * T(i);
  }
  return T(1) / factorial;
}

/// True above the threshold at which the closed forms of c₂, c₃ … and of derivatives replace the
/// series: below, the closed forms cancel; above, the series does.
template <Real T>
[[nodiscard]] constexpr auto is_beyond_series(const T& s) {
  return s > T(4);
}

/// c_n(s) of small s: up to 4, and up to 1 for c₀ and c₁ or if no more is needed.
template <int N, int Limit = (N < 2 ? 1 : 4), Real T>
[[nodiscard]] DUET_ALWAYS_INLINE T stumpff_of_small(const T& s) {
  if constexpr (std::floating_point<lane_type_t<T>>) {
    // The first omitted term is 4e-19 at s = 1 and 2e-22 at s = 4, with more digits 3e-27 and
    // 4e-27.
    constexpr int terms = Limit > 1 ? 13 : N < 2 ? 10 : 9;
    constexpr int more_terms = Limit > 1 ? 15 : N < 2 ? 13 : 12;
    constexpr int count = std::numeric_limits<T>::digits <= 53 ? terms : more_terms;
    return stumpff_polynomial<N, count>(s);
  } else {
    return stumpff_series<N>(s);
  }
}

template <int N, Real T>
[[nodiscard]] DUET_ALWAYS_INLINE T stumpff_of_real(const T& s);

/// c_n(s) of large s, by sine or cosine.
template <int N, Real T>
[[nodiscard]] DUET_ALWAYS_INLINE T stumpff_of_large(const T& s) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  if constexpr (N == 0) {
    return cos(T(sqrt(s)));
  } else if constexpr (N == 1) {
    const T root = sqrt(s);
    return sin(root) / root;
  } else {
    return (inverse_factorial<lane_type_t<T>>(N - 2) - stumpff_of_real<N - 2>(s)) / s;
  }
}

/// c_n(s) of a real number.
template <int N, Real T>
[[nodiscard]] DUET_ALWAYS_INLINE T stumpff_of_real(const T& s) {
  if constexpr (is_recording<T>) {
    if (!s.is_constant()) {
      return recorded_stumpff(s, N);
    }
  }
  return select(
      N < 2 ? s <= T(1) : !is_beyond_series(s),
      [&]() DUET_INLINE_LAMBDA { return stumpff_of_small<N>(s); },
      [&]() DUET_INLINE_LAMBDA { return stumpff_of_large<N>(s); });
}

} // namespace duet::detail

namespace duet {
namespace rule {

template <int N>
struct stumpff;

} // namespace rule

/// Stumpff function c_n(s) = Σ_k (−s)^k/(2k+n)!, s ≥ 0. Its derivative is c_n′ = (n c_{n+2} −
/// c_{n+1})/2 = (c_{n−1} − n c_n)/(2s).
template <int N, Scalar T>
[[nodiscard]] inline T stumpff(const T& s) {
  if constexpr (Infinitesimal<T>) {
    return detail::lift(rule::stumpff<N>{}, s);
  } else {
    return detail::stumpff_of_real<N>(s);
  }
}

namespace rule {

template <int N>
struct stumpff {
  template <class T>
  inline T value(const T& s) const {
    return duet::stumpff<N>(s);
  }
  template <class T>
  inline T slope(const T& s, const T&) const {
    if constexpr (N == 0) {
      return -duet::stumpff<1>(s) / 2;
    } else {
      // The first form is regular at 0. The second keeps the smallness of high derivatives at large
      // s, and needs only the pair of functions that the closed forms start from.
      return select(
          !detail::is_beyond_series(innermost(s)),
          [&] { return T((N * duet::stumpff<N + 2>(s) - duet::stumpff<N + 1>(s)) / 2); },
          [&] { return T((duet::stumpff<N - 1>(s) - N * duet::stumpff<N>(s)) / (2 * s)); });
    }
  }
};

/// L(s, w) = atan2(√s, w)/√s.
///
/// With φ = atan2(√s, w): ∂L/∂w = −1/(s + w²) and ∂L/∂s = (w/(s + w²) − L)/(2s) = −2 L³ c₃(4φ²),
/// where φ² = L² s. The last form has neither cancellation nor a division by s, as further
/// derivatives need for small φ. The other costs less, and loses no more than a factor of 6 above
/// φ = ½.
struct arc_ratio {
  template <class T>
  T value(const T& s, const T& w) const;
  template <class T>
  std::array<T, 2> slopes(const T& ratio, const T& s, const T& w) const {
    const T squared = ratio * ratio;
    const T argument = 4 * squared * s;
    const T reciprocal = 1 / (s + w * w);
    return {select(
                innermost(argument) > 1,
                [&] { return T((w * reciprocal - ratio) * (real_type_t<T>(0.5) / s)); },
                [&] { return T(-2 * squared * ratio * duet::stumpff<3>(argument)); }),
            -reciprocal};
  }
};

} // namespace rule

namespace detail {

template <class B>
[[nodiscard]] DUET_OUT_OF_LINE std::array<B, 2> first_stumpff_pair_of_large(B s) {
  const B root = sqrt(s);
  const auto both = sine_and_cosine_of(root);
  return {both.cosine, both.sine / root};
}

/// c₀(s) and c₁(s); the larger lanes of a batch share one sine and cosine.
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE std::array<T, 2> first_stumpff_pair(const T& s) {
  if constexpr (lane_traits<T>::is_batch) {
    return select(
        s <= 1,
        [&]() DUET_INLINE_LAMBDA {
          return std::array{stumpff_of_small<0>(s), stumpff_of_small<1>(s)};
        },
        [&]() DUET_INLINE_LAMBDA { return first_stumpff_pair_of_large(s); });
  } else {
    return {stumpff<0>(s), stumpff<1>(s)};
  }
}

} // namespace detail

/// L(s, w) = atan2(√s, w)/√s, s ≥ 0: the factor that takes the vector part v of a quaternion,
/// s = v·v, to that of its logarithm. At s = 0 it is 1/w for w > 0 and infinite for w < 0.
template <Scalar T>
[[nodiscard]] inline T arc_ratio(const T& s, const T& w) {
  if constexpr (Infinitesimal<T>) {
    return detail::lift(rule::arc_ratio{}, s, w);
  } else if constexpr (detail::is_recording<T>) {
    return recorded_arc_ratio(s, w);
  } else {
    using std::atan2;
    using std::sqrt;
    return select(
        s == T(0) && w > T(0), [&] { return T(T(1) / w); },
        [&] {
          const T root = sqrt(s);
          return T(atan2(root, w) / root);
        });
  }
}

template <class T>
T rule::arc_ratio::value(const T& s, const T& w) const {
  return duet::arc_ratio(s, w);
}

} // namespace duet

// Sine and cosine of a multiple of a constant angle, given by the square of the angle: the
// functions in the exponential of b v, if v does not depend on the variables of b.
//
// With the universal functions U_n(b; α) = bⁿ c_n(αb²), derivatives with respect to b need no
// further Stumpff functions: U_0′ = −α U_1, U_1′ = U_0. That with respect to α needs one more,
// H = ∂U_1/∂α = b³ c₁′(αb²), with ∂U_0/∂α = −½ b U_1 and H′ = −½ b U_1.

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
  if constexpr (is_recording<R>) {
    const R c1 = stumpff_of_real<1>(z);
    return {stumpff_of_real<0>(z), c1, rule::stumpff<1>{}.slope(z, c1)};
  }
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
