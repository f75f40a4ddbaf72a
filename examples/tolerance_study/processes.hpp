// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <cstddef>
#include <exception>
#include <optional>
#include <vector>

#ifdef DUET_EXAMPLE_MPI
#include <boost/mpi/collectives/broadcast.hpp>
#include <boost/mpi/communicator.hpp>
#include <boost/mpi/environment.hpp>
#include <boost/serialization/vector.hpp>
#endif

/// \file
/// The processes that share a study: those that mpirun started, or this one alone.

namespace tolerance_study {

class processes {
public:
#ifdef DUET_EXAMPLE_MPI
  processes(int& argc, char**& argv)
      : environment_(argc, argv, boost::mpi::threading::funneled, false) {}

  [[nodiscard]] std::size_t rank() const { return std::size_t(world_.rank()); }
  [[nodiscard]] std::size_t size() const { return std::size_t(world_.size()); }

  /// Waits until all processes call it.
  void wait() const { world_.barrier(); }
#else
  processes(int&, char**&) {}

  [[nodiscard]] static std::size_t rank() { return 0; }
  [[nodiscard]] static std::size_t size() { return 1; }
  static void wait() {}
#endif

  /// The numbers that `compute` returns in the first process, sent to all. If it throws, the first
  /// process throws, and the others return nothing.
  template <class F>
  [[nodiscard]] std::optional<std::vector<std::size_t>> from_first(const F& compute) const {
    std::vector<std::size_t> numbers;
    std::exception_ptr error;
    if (rank() == 0) {
      try {
        numbers = compute();
      } catch (...) {
        error = std::current_exception();
      }
    }
    bool is_good = error == nullptr;
#ifdef DUET_EXAMPLE_MPI
    boost::mpi::broadcast(world_, is_good, 0);
    boost::mpi::broadcast(world_, numbers, 0);
#endif
    if (error) {
      std::rethrow_exception(error);
    }
    return is_good ? std::optional(numbers) : std::nullopt;
  }

#ifdef DUET_EXAMPLE_MPI
private:
  boost::mpi::environment environment_;
  boost::mpi::communicator world_;
#endif
};

} // namespace tolerance_study
