// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/dual/storage/partials.hpp>

#include <array>
#include <cstddef>

/// \file
/// Storage of a symmetric matrix of second derivatives.

namespace duet::detail {

/// Maximum number of packets for which all loops are unrolled.
inline constexpr int triangle_unroll_limit = 32;

/// The rows of the lower triangle of an N × N matrix, each in as many packets as it needs; the
/// contents of the last packet of a row beyond the diagonal are ignored.
template <class T, int N>
class lower_triangle {
  static constexpr int width = packing<T, N>::width;
  using packet = typename packing<T, N>::packet;
  using row_type = partials<T, N>;

  /// Number of packets in all rows before one; row i has ⌊i / width⌋ + 1. Unsigned: the rounding of
  /// a signed division costs clang's Hessian of 3 a sixth.
  static constexpr int packets_before(int row) {
    const unsigned i = unsigned(row), full = i / width;
    return int((full + 1) * (2 * i - width * full) / 2);
  }

public:
  static constexpr int packet_count = packets_before(N);

  lower_triangle() {
    unrolled<packet_count>([&](int k) DUET_INLINE_LAMBDA { packets_[k] = packet{}; });
  }
  DUET_ALWAYS_INLINE lower_triangle(const lower_triangle& other) { assign(other); }
  DUET_ALWAYS_INLINE lower_triangle& operator=(const lower_triangle& other) {
    assign(other);
    return *this;
  }

  [[nodiscard]] T get(int i, int j) const { return i < j ? get(j, i) : element(i, j); }
  /// j ≤ i
  void set(int i, int j, const T& x) {
    if constexpr (width > 1) {
      packets_[packets_before(i) + j / width][j % width] = x;
    } else {
      packets_[packets_before(i) + j] = x;
    }
  }
  [[nodiscard]] const packet& packet_at(int k) const { return packets_[k]; }

  /// result = f(triangles…), packet by packet.
  template <class F, class... Triangles>
  [[nodiscard]] DUET_ALWAYS_INLINE static lower_triangle map(F&& f, const Triangles&... t) {
    lower_triangle result(uninitialised{});
    unrolled<packet_count>([&](int k)
                               DUET_INLINE_LAMBDA { result.packets_[k] = f(t.packets_[k]...); });
    return result;
  }

  /// result_ij = start_ij + a_i b_j
  template <class F>
  [[nodiscard]] DUET_ALWAYS_INLINE static lower_triangle
  with_outer_products(F&& start, const row_type& a, const row_type& b) {
    lower_triangle result(uninitialised{});
    for_each_packet([&](int k, int row, int p) DUET_INLINE_LAMBDA {
      result.packets_[k] = start(k) + b.packet_at(p) * a.get(row);
    });
    return result;
  }
  /// result_ij = start_ij + a_i b_j + c_i d_j
  template <class F>
  [[nodiscard]] DUET_ALWAYS_INLINE static lower_triangle
  with_outer_products(F&& start, const row_type& a, const row_type& b, const row_type& c,
                      const row_type& d) {
    lower_triangle result(uninitialised{});
    for_each_packet([&](int k, int row, int p) DUET_INLINE_LAMBDA {
      result.packets_[k] = start(k) + b.packet_at(p) * a.get(row) + d.packet_at(p) * c.get(row);
    });
    return result;
  }

private:
  struct uninitialised {};
  DUET_ALWAYS_INLINE explicit lower_triangle(uninitialised) {}

  /// f(number, row, number in the row) for every packet.
  template <class F>
  DUET_ALWAYS_INLINE static void for_each_packet(F&& f) {
    if constexpr (packet_count <= triangle_unroll_limit) {
      unrolled<N>([&](int row) DUET_INLINE_LAMBDA {
        unrolled<(N + width - 1) / width>([&](int p) DUET_INLINE_LAMBDA {
          if (p <= row / width) {
            f(packets_before(row) + p, row, p);
          }
        });
      });
    } else {
      int k = 0;
      for (int row = 0; row < N; ++row) {
        for (int p = 0; p <= row / width; ++p) {
          f(k++, row, p);
        }
      }
    }
  }

  [[nodiscard]] T element(int i, int j) const {
    if constexpr (width > 1) {
      return packets_[packets_before(i) + j / width][j % width];
    } else {
      return packets_[packets_before(i) + j];
    }
  }
  DUET_ALWAYS_INLINE void assign(const lower_triangle& other) {
    unrolled<packet_count>([&](int k) DUET_INLINE_LAMBDA { packets_[k] = other.packets_[k]; });
  }

  packet packets_[std::size_t(packet_count)];
};

} // namespace duet::detail
