// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch_lanes.hpp>
#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual/promotion.hpp>

#include <type_traits>

/// \file
/// Dual and Taylor numbers over batches: lanes and blends.

namespace duet {
namespace detail {

/// The number of type R whose every part is f of the same parts of x….
template <class R, class F, class First, class... Rest>
[[nodiscard]] DUET_ALWAYS_INLINE R combined_parts(const F& f, const First& x, const Rest&... rest) {
  if constexpr (requires { x.partials(); }) {
    R result(f(x.value(), rest.value()...));
    for (int i = 0; i < x.size(); ++i) {
      result.set_partial(i, f(x.partial(i), rest.partial(i)...));
    }
    return result;
  } else if constexpr (requires { x.hessian(); }) {
    typename R::gradient_type gradient;
    typename R::hessian_type hessian;
    for (int i = 0; i < First::variables; ++i) {
      gradient.set(i, f(x.partial(i), rest.partial(i)...));
      for (int j = 0; j <= i; ++j) {
        hessian.set(i, j, f(x.second_partial(i, j), rest.second_partial(i, j)...));
      }
    }
    return {f(x.value(), rest.value()...), gradient, hessian};
  } else {
    R result;
    constexpr int highest =
        scalar_traits<First>::order - scalar_traits<typename First::value_type>::order;
    for (int k = 0; k <= highest; ++k) {
      result.set_coefficient(k, f(x.coefficient(k), rest.coefficient(k)...));
    }
    return result;
  }
}

} // namespace detail

template <Infinitesimal D>
[[nodiscard]] DUET_ALWAYS_INLINE auto lane(const D& x, int i) {
  if constexpr (Batched<D>) {
    using part = std::decay_t<decltype(lane(x.value(), i))>;
    return detail::combined_parts<over<D, part>>(
        [i](const auto& p) DUET_INLINE_LAMBDA { return lane(p, i); }, x);
  } else {
    return x;
  }
}

template <int W, Infinitesimal D, class Get>
[[nodiscard]] DUET_ALWAYS_INLINE auto joined_lanes(lane_width<W>, const D& pattern,
                                                   const Get& get) {
  const auto joined = [](const auto& part_of) DUET_INLINE_LAMBDA {
    return joined_lanes(lane_width<W>{}, part_of(0), part_of);
  };
  const auto value = [&](int i) DUET_INLINE_LAMBDA { return get(i).value(); };
  using part = decltype(joined_lanes(lane_width<W>{}, pattern.value(), value));
  using R = over<D, part>;
  if constexpr (requires { pattern.partials(); }) {
    R result(joined(value));
    for (int k = 0; k < pattern.size(); ++k) {
      result.set_partial(k, joined([&](int i) DUET_INLINE_LAMBDA { return get(i).partial(k); }));
    }
    return result;
  } else if constexpr (requires { pattern.hessian(); }) {
    typename R::gradient_type gradient;
    typename R::hessian_type hessian;
    for (int k = 0; k < D::variables; ++k) {
      gradient.set(k, joined([&](int i) DUET_INLINE_LAMBDA { return get(i).partial(k); }));
      for (int j = 0; j <= k; ++j) {
        hessian.set(k, j,
                    joined([&](int i) DUET_INLINE_LAMBDA { return get(i).second_partial(k, j); }));
      }
    }
    return R(joined(value), gradient, hessian);
  } else {
    R result;
    for (int k = 0; k <= scalar_traits<D>::order - scalar_traits<typename D::value_type>::order;
         ++k) {
      result.set_coefficient(
          k, joined([&](int i) DUET_INLINE_LAMBDA { return get(i).coefficient(k); }));
    }
    return result;
  }
}

template <class T, int W, Infinitesimal D>
[[nodiscard]] DUET_ALWAYS_INLINE D blended(const lane_mask<T, W>& m, const D& a, const D& b) {
  return detail::combined_parts<D>(
      [&](const auto& p, const auto& q) DUET_INLINE_LAMBDA { return blended(m, p, q); }, a, b);
}

} // namespace duet
