// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/math.hpp>
#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/parallel_for.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/location.hpp>
#include <duet/spline/motion.hpp>
#include <duet/spline/orientations.hpp>

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <span>
#include <sstream>
#include <string>
#include <string_view>

/// \file
/// A curve at many parameters.

namespace duet {
namespace detail {

/// Scalars that are quickest several at a time, in the lanes of batches.
template <class T>
concept QuickInLanes = std::same_as < real_type_t<T>,
double > &&(std::same_as<T, double> || std::same_as<T, screw_dual<double>>);

/// To be called where f threw: its error again, with the first parameter from i on that has one,
/// taken one by one. As it was where none has.
template <class R, class F>
[[noreturn]] void rethrow_with_row(std::span<const R> parameters, std::size_t i, const F& f) {
  span_hint hint;
  for (; i < parameters.size(); ++i) {
    catching<invalid_input>(
        [&] { static_cast<void>(f(parameters[i], hint)); },
        [&](const auto& error) {
          const std::string_view reason = error.what(); // begins as that of invalid_row does
          raise(invalid_row(i, std::string(reason.substr(std::string_view("duet: ").size()))));
        });
  }
  raise_again();
}

/// out[i] = f(parameters[i], hint) with a hint for every block.
template <class T, class R, class Out, class F>
void evaluate_blocks(const char* function, std::span<const R> parameters, std::span<Out> out,
                     execution how, const F& f) {
  if (parameters.size() != out.size()) {
    std::ostringstream message;
    message << "duet: " << function << ": " << parameters.size() << " parameters, but room for "
            << out.size() << " results";
    raise(invalid_input(message.str()));
  }
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
            [&](const auto&) { rethrow_with_row(parameters, i, f); });
      },
      how);
}

} // namespace detail

/// out[i] = s(parameters[i]), quickest where parameters increase; on one core unless more are asked
/// for, with the same results. Rotations and poses over double are evaluated several at a time, in
/// the lanes of batches.
/// \throws invalid_input where the sizes differ; invalid_row for the first parameter outside the
/// domain of s
/// \throws cancelled where `how.report` asks for that, see `parallel_for_blocks`
template <class Spline>
void evaluate(const Spline& s, std::span<const typename Spline::real_type> parameters,
              std::span<quaternion<typename Spline::scalar_type>> out, execution how = one_core) {
  detail::evaluate_blocks<typename Spline::scalar_type>(
      "evaluate", parameters, out, how,
      [&](const auto& u, span_hint& hint) DUET_INLINE_LAMBDA { return s(u, hint); });
}

/// out[i] = s.motion(parameters[i], frame), as `evaluate`.
template <class Spline, class Frame>
void evaluate_motion(const Spline& s, std::span<const typename Spline::real_type> parameters,
                     Frame frame, std::span<motion<typename Spline::scalar_type>> out,
                     execution how = one_core) {
  detail::evaluate_blocks<typename Spline::scalar_type>(
      "evaluate_motion", parameters, out, how,
      [&](const auto& u, span_hint& hint) DUET_INLINE_LAMBDA { return s.motion(u, frame, hint); });
}

} // namespace duet
