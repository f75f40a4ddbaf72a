// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/select.hpp>
#include <duet/core/stumpff.hpp>
#include <duet/dual/stumpff.hpp>

#include <array>
#include <cstddef>

/// \file
/// Many Stumpff functions of one argument at little more than the price of two.

namespace duet {
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
