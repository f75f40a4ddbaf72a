// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/select.hpp>
#include <duet/core/stumpff.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/rules/lift.hpp>

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>

/// \file
/// The functions that exp and log of quaternions are made of, over every scalar: regular where
/// sine, cosine and arctangent forms are not, with exact derivatives of every order.

namespace duet {
namespace rule {

template <int N>
struct stumpff;

} // namespace rule

/// Stumpff function c_n(s) = Σ_k (−s)^k/(2k+n)!, s ≥ 0: c₀ = cos √s, c₁ = sin √s/√s, c₂ = (1 −
/// c₀)/s … Its derivative is c_n′ = (n c_{n+2} − c_{n+1})/2 = (c_{n−1} − n c_n)/(2s).
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
      // s, and asks for no functions but the pair that the closed forms start from.
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
/// where φ² = L² s. In the last form nothing cancels and nothing is divided by s, which further
/// derivatives need where φ is small. The other costs less, and loses no more than a factor of 6
/// above φ = ½.
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
[[nodiscard, gnu::noinline]] std::array<B, 2> first_stumpff_pair_of_large(B s) {
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

/// L(s, w) = atan2(√s, w)/√s, s ≥ 0: what turns the vector part v of a quaternion, s = v·v, into
/// that of its logarithm. At s = 0 it is 1/w for w > 0; for w < 0 it is infinite there.
template <Scalar T>
[[nodiscard]] inline T arc_ratio(const T& s, const T& w) {
  if constexpr (Infinitesimal<T>) {
    return detail::lift(rule::arc_ratio{}, s, w);
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

namespace detail {

/// 1/0!, 1/1! … 1/(Count−1)!
template <Real R, std::size_t Count>
[[nodiscard]] constexpr std::array<R, Count> inverse_factorials() {
  std::array<R, Count> result{};
  for (std::size_t n = 0; n < Count; ++n) {
    result[n] = inverse_factorial<R>(int(n));
  }
  return result;
}

} // namespace detail

/// c_0(s) … c_Highest(s), s ≥ 0, by c_n = 1/n! − s c_{n+2}: downwards from the two highest where
/// their series converge fast, upwards from cosine and sine elsewhere. Errors are relative to 1/n!
/// below s = 4, to the larger of c_n and √s^−n above.
template <int Highest, Scalar T>
[[nodiscard]] DUET_ALWAYS_INLINE std::array<T, std::size_t(Highest) + 1>
stumpff_sequence(const T& s) {
  static_assert(Highest >= 2, "duet: for one or two Stumpff functions use stumpff<N>");
  using R = real_type_t<T>;
  constexpr auto n = std::size_t(Highest);
  using sequence = std::array<T, n + 1>;
  const auto run = [&](const auto& inverse_factorial) DUET_INLINE_LAMBDA {
    return select(
        !detail::is_beyond_series(innermost(s)),
        [&]() DUET_INLINE_LAMBDA {
          sequence c;
          c[n] = stumpff<Highest>(s);
          c[n - 1] = stumpff<Highest - 1>(s);
          for (std::size_t i = n - 1; i-- > 0;) {
            c[i] = inverse_factorial[i] - s * c[i + 2];
          }
          return c;
        },
        [&]() DUET_INLINE_LAMBDA {
          sequence c;
          c[0] = stumpff<0>(s);
          c[1] = stumpff<1>(s);
          const T reciprocal = 1 / s;
          for (std::size_t i = 2; i <= n; ++i) {
            c[i] = (inverse_factorial[i - 2] - c[i - 2]) * reciprocal;
          }
          return c;
        });
  };
  if constexpr (std::floating_point<lane_type_t<R>>) {
    constexpr auto table = detail::inverse_factorials<lane_type_t<R>, n + 1>();
    return run(table);
  } else {
    return run(detail::inverse_factorials<R, n + 1>());
  }
}

} // namespace duet
