// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/dual/stumpff.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <utility>

/// \file
/// Jacobians of the exponential map exp(½r) with respect to the rotation vector r, and their
/// inverses, in closed form; and rates of exp(x(t)) along a curve x(t) of half-angle vectors to any
/// order, by many Stumpff functions of one argument at little more than the cost of two.
///
/// Over dual numbers the same functions are those of rigid motion, see dual_quaternion/.

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

/// c_0(s) … c_Highest(s) of lanes beyond the series.
template <std::size_t Size, class B>
[[nodiscard]] DUET_OUT_OF_LINE std::array<B, Size> stumpff_sequence_of_large(const B& s) {
  using R = lane_type_t<B>;
  constexpr auto table = inverse_factorials<R, Size>();
  std::array<B, Size> c;
  const auto pair = first_stumpff_pair_of_large(s);
  c[0] = pair[0];
  c[1] = pair[1];
  const B reciprocal = 1 / s;
  for (std::size_t i = 2; i < Size; ++i) {
    c[i] = (table[i - 2] - c[i - 2]) * reciprocal;
  }
  return c;
}

/// c_0(s) … c_{Size−1}(s) of batches, out of line, as they are long: all lanes share the series or
/// one sine and cosine.
template <std::size_t Size, class B>
[[nodiscard]] DUET_OUT_OF_LINE std::array<B, Size> stumpff_sequence_of_lanes(const B& s) {
  constexpr auto table = inverse_factorials<lane_type_t<B>, Size>();
  return select(
      !is_beyond_series(s),
      [&]() DUET_INLINE_LAMBDA {
        std::array<B, Size> c;
        c[Size - 1] = stumpff_of_small<int(Size) - 1>(s);
        c[Size - 2] = stumpff_of_small<int(Size) - 2>(s);
        for (std::size_t i = Size - 2; i-- > 0;) {
          c[i] = table[i] - s * c[i + 2];
        }
        return c;
      },
      [&]() DUET_INLINE_LAMBDA { return stumpff_sequence_of_large<Size>(s); });
}

} // namespace detail

/// Stumpff functions c_0(s) … c_Highest(s), s ≥ 0, by c_n = 1/n! − s c_{n+2}: downwards from the
/// two highest where their series converge fast, upwards from cosine and sine elsewhere. Errors are
/// relative to 1/n! below s = 4, to the larger of c_n and √s^−n above.
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
  if constexpr (lane_traits<T>::is_batch && Highest > 2) {
    return detail::stumpff_sequence_of_lanes<n + 1>(s);
  } else if constexpr (std::floating_point<lane_type_t<R>>) {
    constexpr auto table = detail::inverse_factorials<lane_type_t<R>, n + 1>();
    return run(table);
  } else {
    return run(detail::inverse_factorials<R, n + 1>());
  }
}

namespace detail {

/// f(0), f(1) … f(Count−1): unrolled for plain numbers, so that indices are constants, but not for
/// dual numbers, which would take too long to compile.
template <class T, std::size_t Count, class F>
DUET_ALWAYS_INLINE void each_index(F&& f) {
  if constexpr (Real<T>) {
    [&]<std::size_t... I>(std::index_sequence<I...>) DUET_INLINE_LAMBDA { (f(I), ...); }
    (std::make_index_sequence<Count>{});
  } else {
    for (std::size_t i = 0; i < Count; ++i) {
      f(i);
    }
  }
}

/// Taylor coefficients, at one s, of the functions a, b, c of s = x·x in the right Jacobian of the
/// exponential, in half angles: J(x) = a I − b x̂ + c x xᵀ, a = c₁(4s), b = 2c₂(4s), c = 4c₃(4s).
/// Element k is the k-th derivative with respect to s, divided by k!.
template <std::size_t Count, class T>
struct jacobian_coefficients {
  std::array<T, Count> a, b, c;

  /// Uses (cₙ)′ = (n c_{n+2} − c_{n+1})/2, so that one sequence of Stumpff functions suffices.
  DUET_ALWAYS_INLINE explicit jacobian_coefficients(const T& s) {
    using R = real_type_t<T>;
    auto e = stumpff_sequence<2 * int(Count) + 1>(T(4 * s));
    each_index<T, Count>([&](std::size_t k) DUET_INLINE_LAMBDA {
      a[k] = e[1];
      b[k] = 2 * e[2];
      c[k] = 4 * e[3];
      const R factor = R(2) / R(k + 1);
      each_index<T, 2 * Count>([&](std::size_t n) DUET_INLINE_LAMBDA {
        if (n > 0 && n + 2 * k + 1 <= 2 * Count) {
          e[n] = (R(n) * e[n + 2] - e[n + 1]) * factor;
        }
      });
    });
  }
};

/// f(s(t)), truncated, from f's Taylor coefficients at s(0) and s's with respect to t, of which the
/// first is not used.
template <std::size_t Count, class T, std::size_t InputCount, class S>
[[nodiscard]] DUET_ALWAYS_INLINE std::array<S, Count> composed(const std::array<T, InputCount>& f,
                                                               const std::array<S, Count>& s) {
  std::array<S, Count> result;
  result[0] = S(f[Count - 1]);
  each_index<S, Count - 1>([&](std::size_t done) DUET_INLINE_LAMBDA {
    const std::size_t i =
        Count - 2 - done; // result ← f_i + (s − s_0) result, from the highest order
    each_index<S, Count - 1>([&](std::size_t before) DUET_INLINE_LAMBDA {
      if (before <= done) {
        const std::size_t m = done + 1 - before;
        S sum = s[m] * result[0];
        each_index<S, Count>([&](std::size_t j) DUET_INLINE_LAMBDA {
          if (j > 0 && j < m) {
            sum = sum + s[m - j] * result[j];
          }
        });
        result[m] = sum;
      }
    });
    result[0] = S(f[i]);
  });
  return result;
}

/// w with Q′ = Q w, half the angular velocity in body axes, for Q = exp(x(t)): w = J(x) ẋ. Takes
/// and returns Taylor coefficients in t: takes x_1 … x_Count, returns w_0 … w_{Count−1}; the
/// coefficients of the Jacobian were computed at x = x_0.
///
/// \tparam S  scalar of the rates: T or above
template <std::size_t Count, std::size_t InputCount, class T, class S>
[[nodiscard]] DUET_ALWAYS_INLINE std::array<vector3<S>, Count>
half_body_rates(const jacobian_coefficients<InputCount, T>& jacobian, const vector3<T>& x,
                const std::array<vector3<S>, Count>& rates) {
  static_assert(Count <= InputCount);
  using R = real_type_t<S>;
  // With dx = ẋ: p = x·ẋ; s = x·x, ṡ = 2p; y = x × ẋ.
  const three_vector<T> at = components(x);
  std::array<three_vector<S>, Count> of, dx, y;
  std::array<S, Count> p, s;
  each_index<S, Count>([&](std::size_t m) DUET_INLINE_LAMBDA {
    of[m] = components(rates[m]);
    dx[m] = m == 0 ? of[0] : S(R(m + 1)) * of[m];
    p[m] = dot(at, dx[m]);
    y[m] = cross(at, dx[m]);
    each_index<S, Count>([&](std::size_t j) DUET_INLINE_LAMBDA {
      if (j < m) {
        const std::size_t k = m - 1 - j; // x_{j+1} and ẋ_k = (k+1) x_{k+1}
        p[m] = p[m] + dot(of[j], dx[k]);
        if (j != k) {
          y[m] = y[m] + cross(of[j], dx[k]);
        }
      }
    });
    if (m + 1 < Count) {
      s[m + 1] = p[m] * (R(2) / R(m + 1));
    }
  });
  const auto a = composed(jacobian.a, s);
  const auto b = composed(jacobian.b, s);
  const auto c = composed(jacobian.c, s);
  std::array<S, Count> k; // c p
  std::array<vector3<S>, Count> result;
  each_index<S, Count>([&](std::size_t m) DUET_INLINE_LAMBDA {
    k[m] = c[0] * p[m];
    three_vector<S> w = a[0] * dx[m] + S(-b[0]) * y[m];
    each_index<S, Count>([&](std::size_t j) DUET_INLINE_LAMBDA {
      if (j > 0 && j <= m) {
        k[m] = k[m] + c[j] * p[m - j];
        w = w + a[j] * dx[m - j] + S(-b[j]) * y[m - j] + k[m - j] * of[j - 1];
      }
    });
    result[m] = w + k[m] * at;
  });
  return result;
}

/// a I + b r̂ + c r rᵀ
template <class T>
[[nodiscard]] matrix3<T> axial_matrix(const T& a, const T& b, const T& c, const vector3<T>& r) {
  const vector3<T> axial(b * r[0], b * r[1], b * r[2]);
  const vector3<T> cr(c * r[0], c * r[1], c * r[2]);
  const T xy = cr[0] * r[1];
  const T xz = cr[0] * r[2];
  const T yz = cr[1] * r[2];
  return matrix_of_rows<T>({a + cr[0] * r[0], xy - axial[2], xz + axial[1]},
                           {xy + axial[2], a + cr[1] * r[1], yz - axial[0]},
                           {xz - axial[1], yz + axial[0], a + cr[2] * r[2]});
}

template <class T>
[[nodiscard]] matrix3<T> exponential_jacobian(const vector3<T>& r, int sign) {
  const T s = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
  return axial_matrix<T>(stumpff<1>(s), sign * stumpff<2>(s), stumpff<3>(s), r);
}

template <class T>
[[nodiscard]] matrix3<T> exponential_jacobian_inverse(const vector3<T>& r, int sign) {
  const T quarter = (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]) / 4;
  const T ratio = 1 / stumpff<1>(quarter);
  return axial_matrix<T>(stumpff<0>(quarter) * ratio, T(-sign) / 2,
                         (stumpff<2>(quarter) - stumpff<3>(quarter)) * ratio / 4, r);
}

} // namespace detail

/// Left Jacobian J_l with ω^s = J_l(r) ṙ for the rotation exp(½r), r its rotation vector in
/// radians: J_l = c₁ I + c₂ r̂ + c₃ r rᵀ, cₙ the Stumpff functions of r·r.
template <class T>
[[nodiscard]] matrix3<detail::differentiable_t<T>> left_jacobian(const vector3<T>& r) {
  using S = detail::differentiable_t<T>;
  return detail::exponential_jacobian<S>(r.template cast<S>(), 1);
}
/// Right Jacobian J_r with ω^b = J_r(r) ṙ: J_r(r) = J_l(−r) = J_l(r)ᵀ.
template <class T>
[[nodiscard]] matrix3<detail::differentiable_t<T>> right_jacobian(const vector3<T>& r) {
  using S = detail::differentiable_t<T>;
  return detail::exponential_jacobian<S>(r.template cast<S>(), -1);
}
/// Inverse left Jacobian J_l⁻¹ with ṙ = J_l⁻¹(r) ω^s:
/// J_l⁻¹ = (φ/2)cot(φ/2) I − ½ r̂ + (1 − (φ/2)cot(φ/2)) r rᵀ/φ², φ = |r|.
/// Infinite at full turns φ = 2π, 4π …, where exp(½r) is stationary in two directions of r.
template <class T>
[[nodiscard]] matrix3<detail::differentiable_t<T>> left_jacobian_inverse(const vector3<T>& r) {
  using S = detail::differentiable_t<T>;
  return detail::exponential_jacobian_inverse<S>(r.template cast<S>(), 1);
}
/// Inverse right Jacobian J_r⁻¹ with ṙ = J_r⁻¹(r) ω^b.
template <class T>
[[nodiscard]] matrix3<detail::differentiable_t<T>> right_jacobian_inverse(const vector3<T>& r) {
  using S = detail::differentiable_t<T>;
  return detail::exponential_jacobian_inverse<S>(r.template cast<S>(), -1);
}

} // namespace duet
