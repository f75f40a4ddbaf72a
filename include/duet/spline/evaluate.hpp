// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/math.hpp>
#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/parallel_for.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/motion.hpp>
#include <duet/spline/orientations.hpp>

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

/// \file
/// Evaluation of a curve at many parameters, in SIMD batches and several threads.

namespace duet {
namespace detail {

/// True for scalars that are fastest in SIMD batches.
template <class T>
concept QuickInLanes = std::same_as < real_type_t<T>,
double > &&(std::same_as<T, double> || std::same_as<T, screw_dual<double>>);

/// Rethrows the error of f with the index of the first parameter from i on that causes it, found by
/// evaluating one parameter after the other; rethrows the original error if none does. To be called
/// in the handler of the original error.
template <class R, class F>
[[noreturn]] void rethrow_with_index(std::span<const R> parameters, std::size_t i, const F& f) {
  span_hint hint;
  for (; i < parameters.size(); ++i) {
    catching<invalid_input>(
        [&] { static_cast<void>(f(parameters[i], hint)); },
        [&](const auto& error) {
          const std::string_view reason = error.what(); // starts with the prefix of invalid_sample
          raise(invalid_sample(i, std::string(reason.substr(std::string_view("duet: ").size()))));
        });
  }
  raise_again();
}

/// Computes out[i] = f(parameters[i], hint), with one hint for every block.
template <class T, class R, class Out, class F>
void evaluate_blocks(const char* function, std::span<const R> parameters, std::span<Out> out,
                     execution how, const F& f) {
  require(parameters.size() == out.size(), "duet: ", function, ": ", parameters.size(),
          " parameters, but room for ", out.size(), " results");
  parallel_for_blocks(
      parameters.size(),
      [&](std::size_t first, std::size_t last) {
        span_hint hint;
        std::size_t i = first;
        catching<invalid_input>(
            [&]() DUET_INLINE_LAMBDA {
              if constexpr (QuickInLanes<T>) {
                using B = batch<R>;
                for (; i < last; i += std::size_t(B::lanes)) {
                  const std::size_t count = std::min(std::size_t(B::lanes), last - i);
                  const auto u = detail::load_some<B>(&parameters[i], count);
                  const auto result = f(u, hint);
                  for (std::size_t k = 0; k < count; ++k) {
                    out[i + k] = lane(result, int(k));
                  }
                }
              } else {
                for (; i < last; ++i) {
                  out[i] = f(parameters[i], hint);
                }
              }
            },
            [&](const auto&) { rethrow_with_index(parameters, i, f); });
      },
      how);
}

} // namespace detail

/// Evaluates a curve at many parameters: out[i] = s(parameters[i]), fastest if parameters increase.
/// Single-threaded by default; more threads give the same results. Rotations and poses over double
/// are evaluated in SIMD batches.
///
/// \throws invalid_input if the sizes differ
/// \throws invalid_sample for the first parameter outside the domain of s
/// \throws cancelled if `how.report` requests it, see `parallel_for_blocks`
template <class Spline>
void evaluate(const Spline& s, std::span<const typename Spline::real_type> parameters,
              std::span<quaternion<typename Spline::scalar_type>> out, execution how = one_core) {
  detail::evaluate_blocks<typename Spline::scalar_type>(
      "evaluate", parameters, out, how,
      [&](const auto& u, span_hint& hint) DUET_INLINE_LAMBDA { return s(u, hint); });
}

/// Evaluates value and rates at many parameters, as `evaluate`: out[i] = s.motion(parameters[i],
/// frame).
template <class Spline, class Frame>
void evaluate_motion(const Spline& s, std::span<const typename Spline::real_type> parameters,
                     Frame frame, std::span<motion<typename Spline::scalar_type>> out,
                     execution how = one_core) {
  detail::evaluate_blocks<typename Spline::scalar_type>(
      "evaluate_motion", parameters, out, how,
      [&](const auto& u, span_hint& hint) DUET_INLINE_LAMBDA { return s.motion(u, frame, hint); });
}

} // namespace duet
