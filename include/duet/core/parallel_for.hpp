// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/progress.hpp>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

/// \file
/// Multithreading: many independent calls on several cores.

namespace duet {

namespace detail {

/// Blocks are handed out from the first to the last, so that when one throws all before it are
/// finished or running: the exception that is kept, the first block's, does not depend on timing,
/// and the completed elements of a cancelled run have no gaps.
class block_queue {
public:
  block_queue(std::size_t count, std::size_t block, progress_callback report)
      : count_(count), block_(block), report_(report) {}

  template <class Body>
  void work(const Body& body) {
    while (!has_stopped_) {
      const std::size_t first = next_.fetch_add(block_);
      if (first >= count_) {
        return;
      }
      const std::size_t last = std::min(first + block_, count_);
      catching<void>(
          [&] {
            body(first, last);
            if (report_) {
              tell(last - first);
            }
          },
          [&] { keep(first, std::current_exception()); });
    }
  }

  /// Rethrows a stored exception or reports cancellation, after all threads have ended.
  void finish() const {
    if (error_) {
      std::rethrow_exception(error_);
    }
    if (report_ && done_ < count_) {
      raise(cancelled({done_, count_}));
    }
  }

private:
  void tell(std::size_t size) {
    const std::lock_guard lock(mutex_);
    done_ += size;
    if (has_stopped_) {
      return;
    }
    catching<void>(
        [&] {
          if (!report_({done_, count_})) {
            has_stopped_ = true;
          }
        },
        [&] { // while the others still wait for the lock, so that they do not call it again
          has_stopped_ = true;
          raise_again();
        });
  }
  void keep(std::size_t first, std::exception_ptr error) {
    has_stopped_ = true;
    const std::lock_guard lock(mutex_);
    if (!error_ || first < failed_) {
      error_ = std::move(error);
      failed_ = first;
    }
  }

  std::size_t count_;
  std::size_t block_;
  progress_callback report_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> has_stopped_ = false;
  std::mutex mutex_;
  std::size_t done_ = 0;
  std::exception_ptr error_;
  std::size_t failed_ = 0;
};

} // namespace detail

/// Calls `body(first, last)` for blocks [first, last) that make up [0, count), on the requested
/// number of threads; one thread runs everything in the calling thread. The threads live as long as
/// the call.
///
/// The blocks must not write to the same memory. Results then do not depend on the number of
/// threads. If blocks throw, the exception of the first of them is rethrown once all threads have
/// ended; blocks behind it may not have been called.
///
/// `how.report` is called after each block with the progress so far, until it returns `false` or
/// throws: running blocks are then finished, and no more are started. Its exceptions are rethrown
/// like those of `body`.
///
/// \param block  maximum number of elements per block; 0 (the default): a 32nd of a thread's share,
///   with one thread all, and with `how.report` no more than a 128th of all
/// \throws cancelled if `how.report` returned `false` before everything was done: it holds the
///   number of completed elements, from the first on
template <class Body>
void parallel_for_blocks(std::size_t count, const Body& body, execution how = all_cores,
                         std::size_t block = 0) {
  const std::size_t wanted =
      how.threads > 0 ? how.threads : std::max(1U, std::thread::hardware_concurrency());
  const std::size_t blocks_for_threads = wanted == 1 ? 1 : 32 * wanted;
  const std::size_t min_blocks =
      how.report ? std::max<std::size_t>(128, blocks_for_threads) : blocks_for_threads;
  const std::size_t size = block > 0 ? block : std::max<std::size_t>(1, count / min_blocks);
  detail::block_queue queue(count, size, how.report);
  std::vector<std::thread> helpers;
  const std::size_t blocks = count / size + (count % size > 0 ? 1 : 0);
  detail::catching<std::system_error>(
      [&] {
        while (helpers.size() + 1 < std::min(wanted, blocks)) {
          helpers.emplace_back([&] { queue.work(body); });
        }
      },
      [](const auto&) {}); // no more threads available: the existing ones do everything
  queue.work(body);
  for (std::thread& helper : helpers) {
    helper.join();
  }
  queue.finish();
}

/// Calls `body(i)` for i = 0 … count − 1, as `parallel_for_blocks`.
template <class Body>
void parallel_for(std::size_t count, const Body& body, execution how = all_cores) {
  parallel_for_blocks(
      count,
      [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
          body(i);
        }
      },
      how);
}

} // namespace duet
