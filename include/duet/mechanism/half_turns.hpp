// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/vector_sine_cosine.hpp>
#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/seed.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/rules/lift.hpp>
#include <duet/dual/storage/partials.hpp>

#include <array>
#include <concepts>
#include <cstddef>

/// \file
/// sin(θ/2) and cos(θ/2) of the joints of a chain: those of doubles, and of the values of duals
/// over doubles, in vectors, a quarter of the time that the C library takes for one after the
/// other.

namespace duet::detail {

/// \tparam S  scalar of the results
/// \tparam N  number of joints; negative: up to −N
/// \tparam X  of the coordinates θ
template <class S, int N, class X>
class half_turns {
  static constexpr int most = N > 0 ? N : -N;
  static constexpr bool at_once = most > 1 && std::same_as<real_type_t<S>, double>;
  // Eight lanes would not make it faster.
  static constexpr int lanes = DUET_VECTOR_BYTES < 32 ? 2 : 4;
  static constexpr int vectors = at_once ? (most + lanes - 1) / lanes : 0;
  typedef double packet __attribute__((vector_size(lanes * sizeof(double))));

public:
  /// \param size   how many joints there are
  /// \param count  of how many of the first the sines are wanted
  DUET_ALWAYS_INLINE half_turns(const X& theta, int size, int count) : theta_(theta) {
    if constexpr (at_once) {
      const auto take = [&](int v) DUET_INLINE_LAMBDA {
        const auto at = [&](int k) DUET_INLINE_LAMBDA {
          const int i = v * lanes + k;
          return i < (N > 0 ? N : size) ? innermost(half(i)) : 0.;
        };
        if (v * lanes < count) {
          if constexpr (lanes == 2) {
            values_[std::size_t(v)] = vector_sine_and_cosine(packet{at(0), at(1)});
          } else {
            values_[std::size_t(v)] = vector_sine_and_cosine(packet{at(0), at(1), at(2), at(3)});
          }
        }
      };
      if constexpr (N > 0) { // indices that the compiler knows leave coordinates in registers
        unrolled<vectors>(take);
      } else {
        for (int v = 0; v * lanes < count; ++v) {
          take(v);
        }
      }
    }
  }
  [[nodiscard]] DUET_ALWAYS_INLINE sine_cosine<S> operator[](int i) const {
    if constexpr (at_once) {
      const auto& both = values_[std::size_t(i / lanes)];
      return sine_and_cosine_from(sine_cosine<double>{both.sine[i % lanes], both.cosine[i % lanes]},
                                  half(i));
    } else {
      return sine_and_cosine_of(half(i));
    }
  }

private:
  [[nodiscard]] DUET_ALWAYS_INLINE S half(int i) const {
    return S(S(vector_argument<X>::get(theta_, i)) / 2);
  }

  const X& theta_;
  std::array<sine_cosine<packet>, std::size_t(vectors)> values_;
};

} // namespace duet::detail
