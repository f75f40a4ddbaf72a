// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <duet/core/compiler/instructions.hpp>
#include <duet/core/compiler/vector.hpp>
#include <duet/core/owning_result.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/core/structure.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <limits>
#include <ostream>
#include <type_traits>
#include <utility>

/// \file
/// Several real numbers at once as one scalar (SIMD): every formula of the library over `batch` is
/// its own vector version. Functions of batches are in batch/math.hpp.
///
/// Batches are split into lanes, and lanes joined to batches, for tables and for code with too many
/// branches to take all lanes in one step. These functions reach the scalars inside any object by
/// `structure`, and infinitesimal numbers by their parts.

namespace duet::detail {

template <class T>
inline constexpr int native_lanes = 1;
template <>
inline constexpr int native_lanes<float> = DUET_BATCH_BYTES / int(sizeof(float));
template <>
inline constexpr int native_lanes<double> = DUET_BATCH_BYTES / int(sizeof(double));

/// One packet of W lanes of T.
template <class T, int W>
struct packet_type {
  using type = lane_array<T, W>;
};
template <class T, int W>
  requires(W > 1 && (std::same_as<T, float> || std::same_as<T, double>))
struct packet_type<T, W> {
  using type = vector_of<T, W>;
};

/// Storage of W lanes of T: `count` packets of `width` lanes.
template <class T, int W>
struct packets {
  static constexpr int width = native_lanes<T> > 1 && W > native_lanes<T> ? native_lanes<T> : W;
  static constexpr int count = W / width;
  using packet = typename packet_type<T, width>::type;
  using mask = decltype(packet{} == packet{});

  template <class F>
  DUET_ALWAYS_INLINE static void for_each(F&& f) {
    [&]<int... P>(std::integer_sequence<int, P...>) DUET_INLINE_LAMBDA { (f(P), ...); }
    (std::make_integer_sequence<int, count>{});
  }
  [[nodiscard]] DUET_ALWAYS_INLINE static packet broadcast(T x) {
    return [&]<int... I>(std::integer_sequence<int, I...>) DUET_INLINE_LAMBDA {
      return packet{((void)I, x)...};
    }
    (std::make_integer_sequence<int, width>{});
  }
};

} // namespace duet::detail

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

namespace duet {

/// x in lane i; an x without batches is the same in all lanes.
template <class X>
  requires(Structured<X> || std::is_enum_v<X>)
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto lane(const X& x, [[maybe_unused]] int i) {
  const auto of_part = [i](const auto& part) DUET_INLINE_LAMBDA { return lane(part, i); };
  if constexpr (lane_traits<X>::is_batch) {
    return x[i];
  } else if constexpr (Infinitesimal<X> && Batched<X>) {
    return x.zip(of_part);
  } else if constexpr (Scalar<X> || Arithmetic<X> || std::is_enum_v<X>) {
    return x;
  } else {
    return map_scalars(of_part, x);
  }
}

namespace detail {

/// The object over batches that has x… in its lanes.
template <class X, class... Rest>
[[nodiscard]] DUET_ALWAYS_INLINE auto joined(const X& x, const Rest&... rest) {
  const auto of_parts = [](const auto&... part) DUET_INLINE_LAMBDA { return joined(part...); };
  if constexpr (Arithmetic<X>) {
    const X lanes[] = {x, rest...};
    return batch<X, 1 + int(sizeof...(Rest))>::from_lanes(
        [&](int i) DUET_INLINE_LAMBDA { return lanes[i]; });
  } else if constexpr (Infinitesimal<X>) {
    return x.zip(of_parts, rest...);
  } else {
    return map_scalars(of_parts, x, rest...);
  }
}

} // namespace detail

/// The object over batches whose lane i of W is get(i).
template <std::size_t W, class Get>
[[nodiscard]] DUET_ALWAYS_INLINE auto from_lanes(const Get& get) {
  return [&]<std::size_t... I>(std::index_sequence<I...>) DUET_INLINE_LAMBDA {
    return detail::joined(get(I)...);
  }
  (std::make_index_sequence<W>{});
}

/// a in the lanes that are set in the mask, b in the others.
template <class T, int W, class X>
[[nodiscard]] DUET_ALWAYS_INLINE X blended(const lane_mask<T, W>& m, const X& a, const X& b) {
  const auto of_parts = [&](const auto& p, const auto& q)
                            DUET_INLINE_LAMBDA { return blended(m, p, q); };
  if constexpr (Infinitesimal<X>) {
    return a.zip(of_parts, b);
  } else {
    return map_scalars(of_parts, a, b);
  }
}

/// Number of lanes of the scalars in an object.
template <class X>
inline constexpr int lane_count = lane_traits<real_type_t<typename structure<X>::scalar>>::lanes;

namespace detail {

/// The first `count` numbers in memory, then repeats the last of them: surplus lanes at the end of
/// a range must not matter.
template <class B>
[[nodiscard]] DUET_ALWAYS_INLINE B load_some(const typename B::value_type* from,
                                             std::size_t count) {
  if (count == std::size_t(B::lanes)) [[likely]] {
    return B::load(from);
  }
  return B::from_lanes([&](int i) { return from[std::min(std::size_t(i), count - 1)]; });
}

/// Elements of a row, one for each lane.
template <std::size_t W, class Row>
[[nodiscard]] DUET_ALWAYS_INLINE auto gathered(const std::array<std::size_t, W>& indices,
                                               const Row& row) {
  return from_lanes<W>([&](std::size_t k)
                           DUET_INLINE_LAMBDA -> const auto& { return row[indices[k]]; });
}

/// f of the lanes of the arguments one after the other, the results joined again; each is that of
/// plain numbers. For arguments without lanes it is f itself.
template <class F, class... X>
[[nodiscard]] auto by_lane(const F& f, const X&... x) {
  if constexpr (!(Batched<typename structure<X>::scalar> || ...)) {
    return f(x...);
  } else {
    constexpr int width = std::max({lane_count<X>...});
    using result = std::decay_t<decltype(f(lane(x, 0)...))>;
    std::array<result, std::size_t(width)> results;
    for (int i = 0; i < width; ++i) {
      results[std::size_t(i)] = f(lane(x, i)...);
    }
    return from_lanes<std::size_t(width)>(
        [&](std::size_t i) DUET_INLINE_LAMBDA -> const result& { return results[i]; });
  }
}

} // namespace detail
} // namespace duet
