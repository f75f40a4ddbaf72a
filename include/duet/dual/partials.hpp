// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/vector.hpp>
#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <utility>

/// \file
/// Storage of the partial derivatives of a `dual`, the one operation on it, `map`, and the chain
/// rule.
///
/// Built-in floating-point partials are kept in compiler vectors of the target's width, the last
/// one padded with zeros; others in a plain array. All loops are unrolled at compile time and
/// inlined, which keeps partials in registers.
///
/// An exactly zero partial is structural: it means "does not depend on". Multiplied by the infinite
/// or undefined slope of √, log, pow or a division at a singular point it must stay zero, or
/// constants would poison gradients with NaN.

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

  [[nodiscard]] static constexpr int size() { return N; }
  [[nodiscard]] constexpr const T& get(int i) const { return elements_[std::size_t(i)]; }
  constexpr void set(int i, const T& x) { elements_[std::size_t(i)] = x; }
  [[nodiscard]] constexpr const T& packet_at(int p) const { return elements_[std::size_t(p)]; }

  /// Partials of the i-th variable: 1 at i, else 0.
  [[nodiscard]] static constexpr array_partials unit(int i) {
    array_partials result;
    result.set(i, T(1));
    return result;
  }

  /// result[i] = f(i)
  template <class F>
  [[nodiscard]] DUET_ALWAYS_INLINE static constexpr array_partials generated(F&& f) {
    array_partials result;
    unrolled<N>([&](int i) DUET_INLINE_LAMBDA { result.set(i, f(i)); });
    return result;
  }

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
  static constexpr int padded_size = width * count;
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

  [[nodiscard]] static constexpr int size() { return N; }
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

  /// Partials of the i-th variable: 1 at i, else 0.
  [[nodiscard]] DUET_ALWAYS_INLINE static constexpr packed_partials unit(int i) {
    return generated([i](int k) DUET_INLINE_LAMBDA { return T(k == i); });
  }

  /// result[i] = f(i). Whole packets are stored, because a zero fill followed by a scalar store
  /// stalls the load of the packet.
  template <class F>
  [[nodiscard]] DUET_ALWAYS_INLINE static constexpr packed_partials generated(F&& f) {
    packed_partials result(uninitialised{});
    if (std::is_constant_evaluated()) {
      result.fill_elements(f);
    } else {
      unrolled<count>([&](int p) DUET_INLINE_LAMBDA {
        result.packets_[p] = [&]<int... L>(std::integer_sequence<int, L...>) DUET_INLINE_LAMBDA {
          return packet{(p * width + L < N ? f(p * width + L) : T(0))...};
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
    T filled[std::size_t(padded_size)] = {};
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
    std::array<T, std::size_t(padded_size)> elements_;
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

/// True if `x`, with every infinitesimal part, is an exact zero.
template <class T>
[[nodiscard]] constexpr auto is_structural_zero(const T& x) {
  if constexpr (Infinitesimal<T>) {
    return x.all_of([](const auto& part) { return is_structural_zero(part); });
  } else if constexpr (is_recording<T>) {
    return x.is_constant() && x.number() == 0;
  } else {
    return x == T(0);
  }
}

/// True if `x` and all its infinitesimal parts are finite. (x − x is NaN for infinities and NaN,
/// else 0; comparing by ≥ takes one branch, by = two: one for NaN.)
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto is_all_finite(const T& x) {
  if constexpr (Infinitesimal<T>) {
    return x.all_of([](const auto& part) { return is_all_finite(part); });
  } else if constexpr (is_recording<T>) {
    return true;
  } else if constexpr (Real<T>) {
    return quiet_less_equal(T(0), T(x - x));
  } else {
    return x - x == T(0);
  }
}

template <class T>
[[nodiscard]] constexpr T guarded_product(const T& slope, const T& partial);

/// slope · partial for a partial of a slope, which is zero if the slope does not depend on the
/// inner variable.
template <class T>
[[nodiscard]] constexpr T product_of_partial(const T& slope, const T& partial) {
  return select(
      is_structural_zero(slope), [] { return T(0); },
      [&] { return guarded_product(slope, partial); });
}

/// slope · partial, zero if the partial is a structural zero; for nested scalars part by part, or
/// parts that do not depend on the inner variable would be poisoned by it.
template <class T>
[[nodiscard]] constexpr T guarded_product(const T& slope, const T& partial) {
  return select(
      is_structural_zero(partial), [] { return T(0); },
      [&] {
        if constexpr (Infinitesimal<T>) {
          return T::zero_preserving_product(slope, partial);
        } else {
          return T(slope * partial);
        }
      });
}

/// slope · partial for a built-in number, a batch or a packet of them, without a branch: code in
/// one block is merged and scheduled better.
template <class T, class P>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr P masked_product(const T& slope, const P& partial) {
  if constexpr (lane_traits<T>::is_batch) {
    return blended(partial != T(0), T(slope * partial), T(0));
  } else if constexpr (!std::same_as<P, T>) {
    return blended_packets(partial != T(0), P(partial * slope), P{});
  } else {
    if (!std::is_constant_evaluated()) {
      return unless_zero(partial, T(slope * partial));
    }
    return partial == T(0) ? T(0) : T(slope * partial);
  }
}

/// slope · x of two numbers with surviving zeros.
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr T zero_preserving_product(const T& slope, const T& x) {
  if constexpr (std::floating_point<T> || lane_traits<T>::is_batch) {
    return masked_product(slope, x);
  } else {
    return all(is_all_finite(slope)) ? T(slope * x) : guarded_product(slope, x);
  }
}

/// A row of more packets than this is masked only if a slope turns out not to be finite. Masks of
/// 512-bit packets cost more than those of others, and those of 128 bits take copies of their
/// operands; clang does better without that branch if packets are larger.
inline constexpr int branch_limit = DUET_VECTOR_BYTES < 32 ? 0 : DUET_VECTOR_BYTES < 64 ? 2 : 1;
inline constexpr int mask_limit = !masks_beat_branches     ? branch_limit
                                  : DUET_VECTOR_BYTES > 16 ? std::numeric_limits<int>::max()
                                                           : 0;

/// Up to this many packets that is done inline: a call would cost the registers of values live
/// after it, even if it is never made.
inline constexpr int in_place_limit = 32;

// Combinations of partials: `kernel(product, p…)` for each of them, where product(slope, p) is
// slope · p with surviving zeros.

/// slope · p
template <class T>
struct unary_chain {
  static constexpr bool masks_numbers = true;
  static constexpr int masked_packets = mask_limit;
  T slope;

  [[nodiscard]] DUET_ALWAYS_INLINE constexpr auto is_finite() const { return is_all_finite(slope); }
  template <class Product, class P>
  [[nodiscard]] DUET_ALWAYS_INLINE constexpr P operator()(Product product, const P& p) const {
    return product(slope, p);
  }
};

/// slope_a · p + slope_b · q
template <class T>
struct binary_chain {
  static constexpr bool masks_numbers = true;
  static constexpr int masked_packets = mask_limit;
  T slope_a, slope_b;

  [[nodiscard]] DUET_ALWAYS_INLINE constexpr auto is_finite() const {
    return is_all_finite(slope_a) && is_all_finite(slope_b);
  }
  template <class Product, class P>
  [[nodiscard]] DUET_ALWAYS_INLINE constexpr P operator()(Product product, const P& p,
                                                          const P& q) const {
    return P(product(slope_a, p) + product(slope_b, q));
  }
};

/// (p − ratio · q) · inverse, where for numbers ratio = value · inverse and so is not finite if
/// `inverse` is not.
template <class T>
struct quotient_chain {
  // Two masks cost more than a branch.
  static constexpr bool masks_numbers = false;
  static constexpr int masked_packets = branch_limit;
  T ratio, inverse;

  [[nodiscard]] DUET_ALWAYS_INLINE constexpr auto is_finite() const {
    return is_all_finite(ratio) && (!Infinitesimal<T> || is_all_finite(inverse));
  }
  template <class Product, class P>
  [[nodiscard]] DUET_ALWAYS_INLINE constexpr P operator()(Product product, const P& p,
                                                          const P& q) const {
    return product(inverse, P(p - product(ratio, q)));
  }
};

template <class Kernel, class Row, class T>
[[nodiscard]] constexpr bool is_always_masked() {
  if constexpr (requires { Row::packet_count; }) {
    return Row::packet_count <= Kernel::masked_packets;
  } else {
    return (std::floating_point<T> && Kernel::masks_numbers) || lane_traits<T>::is_batch;
  }
}

/// Element by element. Out of line and by value: rows passed by reference would live in memory even
/// if all slopes are finite.
template <class Kernel, class Row, class... Rows>
[[nodiscard]] DUET_OUT_OF_LINE DUET_COLD constexpr Row guarded_chain(Kernel kernel, Row row,
                                                                     Rows... rows) {
  const auto product = [](const auto& slope, const auto& p) { return guarded_product(slope, p); };
  return Row::map_elements([&](const auto&... p) { return kernel(product, p...); }, row, rows...);
}

/// Applies the kernel to rows of partials; the mask is true if its slopes are finite.
template <template <class> class Kernel, class T, class Mask, class Row, class... Rows>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr Row
combined(const Kernel<T>& kernel, const Mask& is_finite, const Row& row, const Rows&... rows) {
  const auto with = [&](const auto& product) DUET_INLINE_LAMBDA {
    return Row::map([&](const auto&... p) DUET_INLINE_LAMBDA { return kernel(product, p...); }, row,
                    rows...);
  };
  const auto masked = [](const T& slope, const auto& p)
                          DUET_INLINE_LAMBDA { return masked_product(slope, p); };
  if constexpr (is_always_masked<Kernel<T>, Row, T>()) {
    return with(masked);
  } else {
    if (all(is_finite)) [[likely]] {
      return with([](const T& slope, const auto& p)
                      DUET_INLINE_LAMBDA { return std::remove_cvref_t<decltype(p)>(p * slope); });
    }
    if constexpr (requires { requires Row::packet_count <= in_place_limit; }) {
      return with(masked);
    } else {
      return guarded_chain(kernel, row, rows...);
    }
  }
}

/// slope · row
template <class T, class Row>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr Row chain(const T& slope, const Row& row) {
  const unary_chain<T> kernel{slope};
  return combined(kernel, kernel.is_finite(), row);
}

/// slope_a · a + slope_b · b
template <class T, class Row>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr Row chain(const T& slope_a, const Row& a,
                                                     const T& slope_b, const Row& b) {
  const binary_chain<T> kernel{slope_a, slope_b};
  return combined(kernel, kernel.is_finite(), a, b);
}

/// sum(product) with a product in which zeros on the right survive. If the probe, a sum of all
/// factors on the left, is finite, plain products suffice; the processor predicts that, and the
/// products need not wait for masks.
template <class T, class Sum>
DUET_ALWAYS_INLINE constexpr auto with_surviving_products([[maybe_unused]] const T& probe,
                                                          const Sum& sum) {
  if constexpr (!masks_beat_branches && std::floating_point<T>) {
    if (is_all_finite(probe)) [[likely]] {
      return sum([](const T& a, const T& b) DUET_INLINE_LAMBDA { return T(a * b); });
    }
  }
  return sum([](const T& a, const T& b)
                 DUET_INLINE_LAMBDA { return zero_preserving_product(a, b); });
}

} // namespace duet::detail
