// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/parallel_for.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/location.hpp>
#include <duet/spline/motion.hpp>
#include <duet/spline/orientations.hpp>

#include <cstddef>
#include <span>
#include <sstream>
#include <string>
#include <string_view>

/// \file
/// A curve at many parameters.

namespace duet {
namespace detail {

/// out[i] = f(parameters[i], hint) with a hint for every block.
template <class R, class Out, class F>
void evaluate_blocks(const char* function, std::span<const R> parameters, std::span<Out> out,
                     execution how, const F& f) {
  if (parameters.size() != out.size()) {
    std::ostringstream message;
    message << "duet: " << function << ": " << parameters.size() << " parameters, but room for "
            << out.size() << " results";
    throw invalid_input(message.str());
  }
  parallel_for_blocks(
      parameters.size(),
      [&](std::size_t first, std::size_t last) {
        span_hint hint;
        std::size_t i = first;
        try {
          for (; i < last; ++i) {
            out[i] = f(parameters[i], hint);
          }
        } catch (const invalid_input& error) {
          const std::string_view reason = error.what(); // begins as that of invalid_row does
          throw invalid_row(i, std::string(reason.substr(std::string_view("duet: ").size())));
        }
      },
      how);
}

} // namespace detail

/// out[i] = s(parameters[i]), quickest where parameters increase; on one core unless more are asked
/// for, with the same results.
/// \throws invalid_input where the sizes differ; invalid_row for the first parameter outside the
/// domain of s
template <class Spline>
void evaluate(const Spline& s, std::span<const typename Spline::real_type> parameters,
              std::span<quaternion<typename Spline::scalar_type>> out, execution how = one_core) {
  detail::evaluate_blocks("evaluate", parameters, out, how,
                          [&](const auto& u, span_hint& hint) { return s(u, hint); });
}

/// out[i] = s.motion(parameters[i], frame), as `evaluate`.
template <class Spline, class Frame>
void evaluate_motion(const Spline& s, std::span<const typename Spline::real_type> parameters,
                     Frame frame, std::span<motion<typename Spline::scalar_type>> out,
                     execution how = one_core) {
  detail::evaluate_blocks("evaluate_motion", parameters, out, how,
                          [&](const auto& u, span_hint& hint) { return s.motion(u, frame, hint); });
}

} // namespace duet
