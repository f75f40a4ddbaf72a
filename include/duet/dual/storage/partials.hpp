// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <duet/core/compiler/vector.hpp>
#include <duet/core/scalar_traits.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>

/// \file
/// Storage of the partial derivatives of a `dual`, and the one operation on it: `map`.
///
/// Built-in floating-point partials are kept in compiler vectors of the target's width, the last
/// one padded with zeros; others in a plain array. All loops are unrolled at compile time and
/// inlined, which keeps partials in registers.

namespace duet::detail {

[[nodiscard]] constexpr int ceil_to_power_of_two(int n) {
  int p = 1;
  while (p < n) {
    p *= 2;
  }
  return p;
}

/// Maximum number of packets or elements for which partials are unrolled; a longer row is a loop,
/// whose every intermediate result goes through memory.
inline constexpr int unroll_limit = 64;

/// True if rows are read again from memory after a compiler barrier. Rows of many packets leave few
/// registers for the operands of a statement, and compilers copy to the stack what they read
/// before. With a barrier they read it again from its original position. (Measured. With two or
/// three 512-bit packets, first derivatives and `second_order_dual` gain a tenth, duals over duals
/// lose a fifth; with four and more that is slower.)
[[nodiscard]] constexpr bool is_reread(int packets) {
  return DUET_VECTOR_BYTES < 64 ? packets >= 4 : packets == 2 || packets == 3;
}

template <int Count, class F>
DUET_ALWAYS_INLINE constexpr void unrolled(F&& f) {
  if constexpr (Count <= unroll_limit) {
    [&]<int... I>(std::integer_sequence<int, I...>) DUET_INLINE_LAMBDA { (f(I), ...); }
    (std::make_integer_sequence<int, Count>{});
  } else {
    for (int i = 0; i < Count; ++i) {
      f(i);
    }
  }
}

/// Packing of N numbers: in vectors of the target's width, or one by one.
template <class T, int N>
struct packing {
  static constexpr int width = 1;
  using packet = T;

  [[nodiscard]] static const T& get(const packet* packets, int i) { return packets[i]; }
  static void set(packet* packets, int i, const T& x) { packets[i] = x; }
};
template <class T, int N>
  requires(N > 1 && (std::same_as<T, float> || std::same_as<T, double>))
struct packing<T, N> {
  // If clang does better with halves of vectors, it does so for short rows only.
  static constexpr int bytes = N * int(sizeof(T)) > 128 ? DUET_BATCH_BYTES : DUET_VECTOR_BYTES;
  static constexpr int native = bytes / int(sizeof(T));
  static constexpr int width = ceil_to_power_of_two(N) < native ? ceil_to_power_of_two(N) : native;
  using packet = vector_of<T, width>;

  [[nodiscard]] static T get(const packet* packets, int i) { return packets[i / width][i % width]; }
  static void set(packet* packets, int i, T x) { packets[i / width][i % width] = x; }
};

/// N partials of any scalar type, in an array.
template <class T, int N>
class array_partials {
public:
  constexpr array_partials() : elements_{} {}

  [[nodiscard]] constexpr const T& get(int i) const { return elements_[std::size_t(i)]; }
  constexpr void set(int i, const T& x) { elements_[std::size_t(i)] = x; }
  [[nodiscard]] constexpr const T& packet_at(int p) const { return elements_[std::size_t(p)]; }

  /// result[i] = f(rows[i]...)
  template <class F, class... Rows>
  [[nodiscard]] DUET_ALWAYS_INLINE static constexpr array_partials map(F&& f, const Rows&... rows) {
    array_partials result;
    unrolled<N>([&](int i) DUET_INLINE_LAMBDA { result.set(i, f(rows.get(i)...)); });
    return result;
  }

  template <class F, class... Rows>
  [[nodiscard]] DUET_ALWAYS_INLINE static constexpr array_partials
  map_elements(F&& f, const Rows&... rows) {
    return map(f, rows...);
  }

private:
  std::array<T, std::size_t(N)> elements_;
};

/// N partials of a built-in floating-point type, in vectors.
///
/// Constant evaluation cannot use vectors, so it works on `elements_`; run time only ever touches
/// `packets_`, which lets the optimiser keep each packet in a register. The copy is written packet
/// by packet for the same reason: g++ copies a trivially copyable class as a block of memory.
template <std::floating_point T, int N>
class packed_partials {
  static constexpr int width = packing<T, N>::width;
  static constexpr int count = (N + width - 1) / width;
  static constexpr int size = width * count;
  using packet = typename packing<T, N>::packet;

public:
  static constexpr int packet_count = count;

  constexpr packed_partials() {
    if (std::is_constant_evaluated()) {
      fill_elements([](int) DUET_INLINE_LAMBDA { return T(0); });
    } else {
      unrolled<count>([&](int i) DUET_INLINE_LAMBDA { packets_[i] = packet{}; });
    }
  }
  DUET_ALWAYS_INLINE constexpr packed_partials(const packed_partials& other) noexcept {
    assign(other);
  }
  DUET_ALWAYS_INLINE constexpr packed_partials& operator=(const packed_partials& other) noexcept {
    assign(other);
    return *this;
  }

  [[nodiscard]] constexpr T get(int i) const {
    if (std::is_constant_evaluated()) {
      return elements_[std::size_t(i)];
    }
    return packets_[i / width][i % width];
  }
  constexpr void set(int i, T x) {
    if (std::is_constant_evaluated()) {
      elements_[std::size_t(i)] = x;
    } else {
      packets_[i / width][i % width] = x;
    }
  }
  [[nodiscard]] const packet& packet_at(int p) const { return packets_[p]; }

  /// Partials of the i-th variable: 1 at i, else 0. Whole packets are stored, because a zero fill
  /// followed by a scalar store stalls the load of the packet.
  [[nodiscard]] DUET_ALWAYS_INLINE static constexpr packed_partials unit(int i) {
    packed_partials result(uninitialised{});
    if (std::is_constant_evaluated()) {
      result.fill_elements([i](int k) DUET_INLINE_LAMBDA { return T(k == i); });
    } else {
      unrolled<count>([&](int p) DUET_INLINE_LAMBDA {
        result.packets_[p] = [&]<int... L>(std::integer_sequence<int, L...>) DUET_INLINE_LAMBDA {
          return packet{T(p * width + L == i)...};
        }
        (std::make_integer_sequence<int, width>{});
      });
    }
    return result;
  }

  /// result[i] = f(rows[i]...), where f takes and returns whole packets, so it must be plain
  /// arithmetic.
  template <class F, class... Rows>
  [[nodiscard]] DUET_ALWAYS_INLINE static constexpr packed_partials map(F&& f,
                                                                        const Rows&... rows) {
    packed_partials result(uninitialised{});
    if (std::is_constant_evaluated()) {
      result.fill_elements([&](int i)
                               DUET_INLINE_LAMBDA { return f(rows.elements_[std::size_t(i)]...); });
    } else {
      unrolled<count>([&](int i)
                          DUET_INLINE_LAMBDA { result.packets_[i] = f(rows.packets_[i]...); });
      if constexpr (sizeof...(Rows) > 1 && is_reread(count)) {
        DUET_REREAD_MEMORY();
      }
    }
    return result;
  }

  /// f of the rows for any f, one element at a time.
  template <class F, class... Rows>
  [[nodiscard]] static constexpr packed_partials map_elements(F&& f, const Rows&... rows) {
    packed_partials result;
    for (int i = 0; i < N; ++i) {
      result.set(i, f(rows.get(i)...));
    }
    return result;
  }

private:
  struct uninitialised {};
  DUET_ALWAYS_INLINE constexpr explicit packed_partials(uninitialised) {}

  template <class F>
  constexpr void fill_elements(F&& f) {
    T filled[std::size_t(size)] = {};
    for (int i = 0; i < N; ++i) {
      filled[i] = f(i);
    }
    elements_ = std::to_array(filled);
  }
  DUET_ALWAYS_INLINE constexpr void assign(const packed_partials& other) {
    if (std::is_constant_evaluated()) {
      elements_ = other.elements_;
    } else {
      unrolled<count>([&](int i) DUET_INLINE_LAMBDA { packets_[i] = other.packets_[i]; });
    }
  }

  union {
    packet packets_[std::size_t(count)];
    std::array<T, std::size_t(size)> elements_;
  };
};

template <class T, int N>
struct partials_of {
  using type = array_partials<T, N>;
};
template <class T, int N>
  requires(std::same_as<T, float> || std::same_as<T, double>)
&&(N > 1) struct partials_of<T, N> { using type = packed_partials<T, N>; };

template <class T, int N>
using partials = typename partials_of<T, N>::type;

} // namespace duet::detail
