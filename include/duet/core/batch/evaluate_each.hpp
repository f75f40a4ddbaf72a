// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/math.hpp>
#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/parallel_for.hpp>

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <span>

/// \file
/// Evaluation of a function at many inputs, in SIMD batches and several threads.

namespace duet {

/// Arrays of `double`, as vectors and spans.
template <class... X>
concept RealArrays = (std::constructible_from<std::span<const double>, const X&> && ...);

/// Evaluates a generic function at many inputs: out[i] = f(x[i], y[i], …), for any number of
/// inputs, which is no multiple of the batch width in general. A call of f takes `batch<double>`
/// and returns a number, vector, matrix, rotation or pose of batches; a formula is called by name
/// in it. The results of an element do not depend on its neighbours, nor on the number of threads.
///
/// \param how  `one_core`, `all_cores` or `execution{n}`
/// \param out  the results, as many as inputs
/// \throws invalid_input if the sizes differ
/// \throws cancelled if `how.report` requests it, see `parallel_for_blocks`
template <class F, class Out, class... Inputs>
  requires(sizeof...(Inputs) > 0 && RealArrays<Inputs...>)
void evaluate_each(execution how, const F& f, Out& out, const Inputs&... inputs) {
  using lanes = batch<double>;
  const std::span results(out);
  const auto check = [&](std::span<const double> x) {
    detail::require(x.size() == results.size(), "duet: evaluate_each: ", x.size(),
                    " inputs, but room for ", results.size(), " results");
  };
  (check(std::span<const double>(inputs)), ...);
  parallel_for_blocks(
      results.size(),
      [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; i += std::size_t(lanes::lanes)) {
          const std::size_t count = std::min(std::size_t(lanes::lanes), last - i);
          const auto values =
              f(detail::load_some<lanes>(std::span<const double>(inputs).data() + i, count)...);
          for (std::size_t k = 0; k < count; ++k) {
            results[i + k] = lane(values, int(k));
          }
        }
      },
      how);
}

/// Evaluates a generic function at many inputs on one core, likewise.
template <class F, class Out, class... Inputs>
  requires(sizeof...(Inputs) > 0 && RealArrays<Inputs...>)
void evaluate_each(const F& f, Out& out, const Inputs&... inputs) {
  evaluate_each(one_core, f, out, inputs...);
}

} // namespace duet
