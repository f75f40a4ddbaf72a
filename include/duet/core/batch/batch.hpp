// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

// First, as it checks the C++ version.
#include <duet/core/config.hpp>

#include <duet/core/batch/packets.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>

#include <concepts>
#include <cstddef>
#include <limits>
#include <ostream>
#include <type_traits>
#include <utility>

/// \file
/// Several real numbers at once as one scalar (SIMD): every formula of the library over `batch` is
/// its own vector version. Functions of batches are in batch/math.hpp.

namespace duet {
DUET_ABI_BEGIN

/// Result of comparing two batches, lane by lane. It is not a `bool`: branch by `select`, or reduce
/// it by `any` or `all`.
template <class T, int W>
class lane_mask {
public:
  using storage = detail::packets<T, W>;
  using packet = typename storage::mask;

  /// False in all lanes.
  DUET_ALWAYS_INLINE lane_mask() : packets_{} {}
  /// x in all lanes.
  lane_mask(bool x) {
    for (int i = 0; i < W; ++i) {
      set(i, x);
    }
  }
  /// For those who extend duet: the p-th vector of the target is f(p).
  template <class F>
  [[nodiscard]] DUET_ALWAYS_INLINE static lane_mask from_packets(F&& f) {
    lane_mask result;
    storage::for_each([&](int p) DUET_INLINE_LAMBDA { result.packets_[p] = f(p); });
    return result;
  }

  /// For those who extend duet: the p-th vector of the target.
  [[nodiscard]] DUET_ALWAYS_INLINE const packet& packet_at(int p) const { return packets_[p]; }
  [[nodiscard]] bool operator[](int i) const {
    return packets_[i / storage::width][i % storage::width] != 0;
  }
  /// Sets lane i.
  void set(int i, bool x) {
    using element = std::remove_cvref_t<decltype(packets_[0][0])>;
    packets_[i / storage::width][i % storage::width] = element(x ? -1 : 0);
  }

  [[nodiscard]] friend DUET_ALWAYS_INLINE bool any(const lane_mask& m) {
    bool result = false;
    storage::for_each(
        [&](int p) DUET_INLINE_LAMBDA { result = result || detail::any_lane(m.packets_[p]); });
    return result;
  }
  [[nodiscard]] friend DUET_ALWAYS_INLINE bool all(const lane_mask& m) { return !any(!m); }

  [[nodiscard]] friend DUET_ALWAYS_INLINE lane_mask operator!(const lane_mask& m) {
    return from_packets([&](int p) DUET_INLINE_LAMBDA { return ~m.packets_[p]; });
  }
  // Both sides are always evaluated: if the right side must not be, use `select`.
  [[nodiscard]] friend DUET_ALWAYS_INLINE lane_mask operator&&(const lane_mask& a,
                                                               const lane_mask& b) {
    return from_packets([&](int p) DUET_INLINE_LAMBDA { return a.packets_[p] & b.packets_[p]; });
  }
  [[nodiscard]] friend DUET_ALWAYS_INLINE lane_mask operator||(const lane_mask& a,
                                                               const lane_mask& b) {
    return from_packets([&](int p) DUET_INLINE_LAMBDA { return a.packets_[p] | b.packets_[p]; });
  }
  [[nodiscard]] friend DUET_ALWAYS_INLINE lane_mask operator==(const lane_mask& a,
                                                               const lane_mask& b) {
    return from_packets([&](int p) DUET_INLINE_LAMBDA { return ~(a.packets_[p] ^ b.packets_[p]); });
  }

private:
  packet packets_[std::size_t(storage::count)];
};

/// W numbers of type T that take every step together, lane by lane (SIMD).
///
/// Arithmetic types convert implicitly, to that number in all lanes. The result in a lane does not
/// depend on the others. Comparisons are lane by lane too, a `lane_mask`.
///
/// \tparam T  float or double, in vectors of the target; another floating-point type, in an array
/// \tparam W  number of lanes, a power of two; by default as many as one vector of the target holds
template <std::floating_point T, int W = detail::native_lanes<T>>
class batch {
  static_assert(W >= 1 && (W & (W - 1)) == 0, "duet: batch<T, W> needs a power of two as W");

public:
  using value_type = T;
  using mask_type = lane_mask<T, W>;
  using storage = detail::packets<T, W>;
  using packet = typename storage::packet;
  static constexpr int lanes = W;

  /// Zeros.
  DUET_ALWAYS_INLINE batch() : batch(T(0)) {}
  template <Arithmetic U>
  DUET_ALWAYS_INLINE batch(const U& x) {
    storage::for_each(
        [&](int p) DUET_INLINE_LAMBDA { packets_[p] = storage::broadcast(static_cast<T>(x)); });
  }
  DUET_ALWAYS_INLINE batch(const batch& other) noexcept { assign(other); }
  DUET_ALWAYS_INLINE batch& operator=(const batch& other) noexcept {
    assign(other);
    return *this;
  }

  /// W numbers from memory.
  [[nodiscard]] DUET_ALWAYS_INLINE static batch load(const T* from) {
    return from_lanes([from](int i) DUET_INLINE_LAMBDA { return from[i]; });
  }
  /// Lane i is f(i).
  template <class F>
  [[nodiscard]] DUET_ALWAYS_INLINE static batch from_lanes(F&& f) {
    return from_packets([&](int p) DUET_INLINE_LAMBDA {
      return [&]<int... I>(std::integer_sequence<int, I...>) DUET_INLINE_LAMBDA {
        return packet{T(f(p * storage::width + I))...};
      }
      (std::make_integer_sequence<int, storage::width>{});
    });
  }
  /// For those who extend duet: the p-th vector of the target is f(p).
  template <class F>
  [[nodiscard]] DUET_ALWAYS_INLINE static batch from_packets(F&& f) {
    batch result(uninitialised{});
    storage::for_each([&](int p) DUET_INLINE_LAMBDA { result.packets_[p] = f(p); });
    return result;
  }
  /// Writes W numbers.
  DUET_ALWAYS_INLINE void store(T* to) const {
    storage::for_each([&](int p) DUET_INLINE_LAMBDA {
      for (int i = 0; i < storage::width; ++i) {
        to[p * storage::width + i] = packets_[p][i];
      }
    });
  }

  [[nodiscard]] T operator[](int i) const {
    return packets_[i / storage::width][i % storage::width];
  }
  /// Sets lane i.
  void set(int i, T x) { packets_[i / storage::width][i % storage::width] = x; }
  /// For those who extend duet: the p-th vector of the target.
  [[nodiscard]] DUET_ALWAYS_INLINE const packet& packet_at(int p) const { return packets_[p]; }

  [[nodiscard]] friend DUET_ALWAYS_INLINE batch operator+(const batch& a) { return a; }
  [[nodiscard]] friend DUET_ALWAYS_INLINE batch operator-(const batch& a) {
    return from_packets([&](int p) DUET_INLINE_LAMBDA { return -a.packets_[p]; });
  }
  [[nodiscard]] friend DUET_ALWAYS_INLINE batch operator+(const batch& a, const batch& b) {
    return from_packets([&](int p) DUET_INLINE_LAMBDA {
      DUET_CONTRACTED
      return a.packets_[p] + b.packets_[p];
    });
  }
  [[nodiscard]] friend DUET_ALWAYS_INLINE batch operator-(const batch& a, const batch& b) {
    return from_packets([&](int p) DUET_INLINE_LAMBDA {
      DUET_CONTRACTED
      return a.packets_[p] - b.packets_[p];
    });
  }
  [[nodiscard]] friend DUET_ALWAYS_INLINE batch operator*(const batch& a, const batch& b) {
    return from_packets([&](int p) DUET_INLINE_LAMBDA {
      DUET_CONTRACTED
      return a.packets_[p] * b.packets_[p];
    });
  }
  [[nodiscard]] friend DUET_ALWAYS_INLINE batch operator/(const batch& a, const batch& b) {
    return from_packets([&](int p) DUET_INLINE_LAMBDA { return a.packets_[p] / b.packets_[p]; });
  }
  DUET_ALWAYS_INLINE batch& operator+=(const batch& b) { return *this = *this + b; }
  DUET_ALWAYS_INLINE batch& operator-=(const batch& b) { return *this = *this - b; }
  DUET_ALWAYS_INLINE batch& operator*=(const batch& b) { return *this = *this * b; }
  DUET_ALWAYS_INLINE batch& operator/=(const batch& b) { return *this = *this / b; }

  [[nodiscard]] friend DUET_ALWAYS_INLINE mask_type operator==(const batch& a, const batch& b) {
    return mask_type::from_packets(
        [&](int p) DUET_INLINE_LAMBDA { return a.packets_[p] == b.packets_[p]; });
  }
  [[nodiscard]] friend DUET_ALWAYS_INLINE mask_type operator!=(const batch& a, const batch& b) {
    return mask_type::from_packets(
        [&](int p) DUET_INLINE_LAMBDA { return a.packets_[p] != b.packets_[p]; });
  }
  [[nodiscard]] friend DUET_ALWAYS_INLINE mask_type operator<(const batch& a, const batch& b) {
    return mask_type::from_packets(
        [&](int p) DUET_INLINE_LAMBDA { return a.packets_[p] < b.packets_[p]; });
  }
  [[nodiscard]] friend DUET_ALWAYS_INLINE mask_type operator<=(const batch& a, const batch& b) {
    return mask_type::from_packets(
        [&](int p) DUET_INLINE_LAMBDA { return a.packets_[p] <= b.packets_[p]; });
  }
  [[nodiscard]] friend DUET_ALWAYS_INLINE mask_type operator>(const batch& a, const batch& b) {
    return b < a;
  }
  [[nodiscard]] friend DUET_ALWAYS_INLINE mask_type operator>=(const batch& a, const batch& b) {
    return b <= a;
  }

  /// a where the mask is set, b elsewhere.
  [[nodiscard]] friend DUET_ALWAYS_INLINE batch blended(const mask_type& m, const batch& a,
                                                        const batch& b) {
    return from_packets([&](int p) DUET_INLINE_LAMBDA {
      return detail::blended_packets(m.packet_at(p), a.packets_[p], b.packets_[p]);
    });
  }

  /// Writes the numbers lane by lane, in brackets.
  friend std::ostream& operator<<(std::ostream& out, const batch& x) {
    for (int i = 0; i < W; ++i) {
      out << (i == 0 ? "[" : ", ") << x[i];
    }
    return out << "]";
  }

private:
  struct uninitialised {};
  DUET_ALWAYS_INLINE explicit batch(uninitialised) {}
  DUET_ALWAYS_INLINE void assign(const batch& other) {
    storage::for_each([&](int p) DUET_INLINE_LAMBDA { packets_[p] = other.packets_[p]; });
  }

  packet packets_[std::size_t(storage::count)];
};

DUET_ABI_END

template <class T, int W>
struct lane_traits<batch<T, W>> {
  static constexpr bool is_batch = true;
  static constexpr int lanes = W;
  using type = T;
};

/// Selection lane by lane: both callables are evaluated and blended lane by lane, only one if all
/// lanes agree.
template <class T, int W, std::invocable F, std::invocable G>
[[nodiscard]] DUET_ALWAYS_INLINE auto select(const lane_mask<T, W>& condition, F&& f, G&& g) {
  using result = std::common_type_t<std::invoke_result_t<F>, std::invoke_result_t<G>>;
  detail::require_owning_result<result>();
  if (!any(condition)) {
    return static_cast<result>(g());
  }
  const auto first = static_cast<result>(f());
  if (all(condition)) {
    return first;
  }
  return static_cast<result>(blended(condition, first, static_cast<result>(g())));
}

} // namespace duet

template <class T, int W>
class std::numeric_limits<duet::batch<T, W>> : public std::numeric_limits<T> {};
