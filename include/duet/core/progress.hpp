// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <concepts>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>

/// \file
/// Progress of a long run, its early termination, and the number of its threads.

namespace duet {

/// Completed part of a range.
struct progress {
  std::size_t done = 0;  ///< number of completed elements
  std::size_t count = 0; ///< number of elements of the whole range

  /// Completed fraction, from 0 to exactly 1; 1 for an empty range.
  [[nodiscard]] double share() const { return count == 0 ? 1.0 : double(done) / double(count); }
};

/// Progress callback of a long run: a reference to a callable object that takes a `progress`. If
/// the callable returns `false`, the run ends early.
///
/// It refers to a variable, which must live as long as the run does: give a lambda a name.
class progress_callback {
public:
  /// No callback.
  constexpr progress_callback() = default;
  template <class F>
    requires(std::is_object_v<F> && !std::is_same_v<std::remove_cv_t<F>, progress_callback> &&
             std::invocable<F&, const progress&>)
  constexpr progress_callback(F& f) : object_(std::addressof(f)), call_(&call<F>) {}

  [[nodiscard]] constexpr explicit operator bool() const { return call_ != nullptr; }
  /// True if the run is to continue.
  [[nodiscard]] bool operator()(const progress& p) const { return call_(object_, p); }

private:
  template <class F>
  [[nodiscard]] static bool call(const void* object, const progress& p) {
    F& f = *static_cast<F*>(const_cast<void*>(object));
    if constexpr (std::is_void_v<std::invoke_result_t<F&, const progress&>>) {
      f(p);
      return true;
    } else {
      return static_cast<bool>(f(p));
    }
  }

  const void* object_ = nullptr;
  bool (*call_)(const void*, const progress&) = nullptr;
};

/// Execution options: number of threads and progress report.
struct execution {
  unsigned threads = 1; ///< number of threads; 0: as many as the machine has cores
  /// Called after every block, by one thread at a time, with increasing progress, at last with all:
  /// see `parallel_for_blocks`.
  progress_callback report = {};
};

/// Single-threaded: everything in the calling thread.
inline constexpr execution one_core{1};
/// As many threads as the machine has cores.
inline constexpr execution all_cores{0};

/// A run ended early by its progress callback.
class cancelled : public std::runtime_error {
public:
  explicit cancelled(const progress& p)
      : runtime_error("duet: cancelled with " + std::to_string(p.done) + " of " +
                      std::to_string(p.count) + " elements done"),
        completed_(p.done) {}

  /// Number of completed elements from the first on; none behind them was started.
  [[nodiscard]] std::size_t completed() const noexcept { return completed_; }

private:
  std::size_t completed_;
};

} // namespace duet
