// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual/partials.hpp>

#include <algorithm>
#include <cstddef>
#include <string>

/// \file
/// Dual numbers whose number of partials is known at run time, without heap allocation.

namespace duet {
namespace detail {

/// At most `Capacity` partials, stored in the object. A constant has no partials, and rows of zero
/// and of n partials combine as if the first were n zeros; so do rows of any two sizes.
template <class T, int Capacity>
class dynamic_partials {
  using row = packing<T, Capacity>;
  using packet = typename row::packet;
  static constexpr int width = row::width;
  static constexpr int max_packets = (Capacity + width - 1) / width;

public:
  dynamic_partials() : size_(0) {}
  dynamic_partials(const dynamic_partials& other) { assign(other); }
  dynamic_partials& operator=(const dynamic_partials& other) {
    assign(other);
    return *this;
  }

  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] T get(int i) const { return i < size_ ? T(row::get(packets_, i)) : T(0); }
  /// Sets the i-th partial, extending the row if necessary.
  ///
  /// \throws invalid_input beyond the capacity
  void set(int i, const T& x) {
    grow(i + 1);
    row::set(packets_, i, x);
  }

  /// Partials of the i-th of n variables.
  ///
  /// \throws invalid_input beyond the capacity
  [[nodiscard]] static dynamic_partials unit(int i, int n) {
    dynamic_partials result;
    result.grow(std::max(n, i + 1));
    row::set(result.packets_, i, T(1));
    return result;
  }

  /// result[i] = f(rows[i]...), where f is plain arithmetic on whole packets and f(0…) is 0.
  template <class F, class... Rows>
  [[nodiscard]] DUET_ALWAYS_INLINE static dynamic_partials map(F&& f, const Rows&... rows) {
    const int size = std::max({rows.size_...});
    if (!((rows.size_ == size || rows.size_ == 0) && ...)) [[unlikely]] {
      return map_elements(f, rows...);
    }
    dynamic_partials result{uninitialised{}, size};
    const int count = (size + width - 1) / width;
    for (int p = 0; p < count; ++p) {
      result.packets_[p] = packet(f(rows.packet_or_zero(p)...));
    }
    return result;
  }

  /// f of the rows for any f, one element at a time. (Inlined, g++ would warn of elements that no
  /// row holds.)
  template <class F, class... Rows>
  [[nodiscard]] DUET_OUT_OF_LINE DUET_COLD static dynamic_partials
  map_elements(F&& f, const Rows&... rows) {
    dynamic_partials result;
    result.grow(std::max({rows.size_...}));
    for (int i = 0; i < result.size_; ++i) {
      row::set(result.packets_, i, f(rows.get(i)...));
    }
    return result;
  }

private:
  struct uninitialised {};
  dynamic_partials(uninitialised, int size) : size_(size) {}

  [[nodiscard]] DUET_ALWAYS_INLINE packet packet_or_zero(int p) const {
    return size_ > 0 ? packets_[p] : packet{};
  }

  /// New partials are zero, and so is the padding of the last packet.
  void grow(int size) {
    if (size > Capacity) {
      raise(invalid_input("duet: dynamic_dual: " + std::to_string(size) +
                          " partials, but the capacity is " + std::to_string(Capacity)));
    }
    for (int p = (size_ + width - 1) / width; p < (size + width - 1) / width; ++p) {
      packets_[p] = packet{};
    }
    for (int i = size_; i < std::min(size, (size_ + width - 1) / width * width); ++i) {
      row::set(packets_, i, T(0));
    }
    size_ = std::max(size_, size);
  }
  DUET_ALWAYS_INLINE void assign(const dynamic_partials& other) {
    size_ = other.size_;
    for (int p = 0; p < (size_ + width - 1) / width; ++p) {
      packets_[p] = other.packets_[p];
    }
  }

  int size_;
  packet packets_[std::size_t(max_packets)];
};

template <class T, int N>
  requires(N < 0)
struct partials_of<T, N> {
  using type = dynamic_partials<T, -N>;
};

} // namespace detail

/// A dual number with as many partials as turn out to be needed, at most `Capacity`, stored in the
/// object: for sparse or adaptive sets of variables, if N is not known at compile time.
///
/// Everything that works with `dual<T, N>` works with it: it is the same class over another row of
/// partials. Numbers with different counts combine as if the missing partials were zero; a constant
/// has no partials. `variable(value, i, n)` is the i-th of n variables; `size()` counts the
/// partials.
template <class T, int Capacity, class Tag = derivative_tag<>>
using dynamic_dual = dual<T, -Capacity, Tag>;

} // namespace duet
