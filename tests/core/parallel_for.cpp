// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/core/parallel_for.hpp>

#include <atomic>
#include <mutex>
#include <set>
#include <thread>

namespace test_core_parallel_for {

TEST_CASE("parallel_for: visits every element once for any number of threads") {
  for (const std::size_t count : {0, 1, 2, 7, 64, 1000, 10007}) {
    for (const unsigned threads : {0U, 1U, 2U, 3U, 16U}) {
      std::vector<int> visits(count, 0);
      duet::parallel_for(
          count, [&](std::size_t i) { ++visits[i]; }, duet::execution{threads});
      CHECK(visits == std::vector<int>(count, 1));
    }
  }
}

TEST_CASE("parallel_for: results equal those of one thread bit for bit") {
  const auto table = [](duet::execution how) {
    std::vector<double> result(5000);
    duet::parallel_for(
        result.size(), [&](std::size_t i) { result[i] = std::sin(double(i)) / double(i + 1); },
        how);
    return result;
  };
  CHECK(table(duet::all_cores) == table(duet::one_core));
}

TEST_CASE("parallel_for: one thread is the caller's own") {
  std::set<std::thread::id> threads;
  duet::parallel_for(
      100, [&](std::size_t) { threads.insert(std::this_thread::get_id()); }, duet::one_core);
  CHECK(threads == std::set<std::thread::id>{std::this_thread::get_id()});
}

TEST_CASE("parallel_for: several threads run at the same time") {
  std::mutex mutex;
  std::set<std::thread::id> threads;
  std::atomic<int> waiting = 0;
  // Each block waits for the other, which one thread could not do.
  duet::parallel_for_blocks(
      2,
      [&](std::size_t, std::size_t) {
        ++waiting;
        while (waiting < 2) {
          std::this_thread::yield();
        }
        const std::lock_guard lock(mutex);
        threads.insert(std::this_thread::get_id());
      },
      duet::execution{2}, 1);
  CHECK(threads.size() == 2);
}

TEST_CASE("parallel_for_blocks: blocks have the requested size") {
  std::vector<std::size_t> sizes;
  duet::parallel_for_blocks(
      10, [&](std::size_t first, std::size_t last) { sizes.push_back(last - first); },
      duet::one_core, 4);
  CHECK(sizes == std::vector<std::size_t>{4, 4, 2});
}

TEST_CASE("parallel_for: rethrows the exception of the first failing block") {
  for (const unsigned threads : {1U, 2U, 5U}) {
    for (int run = 0; run < 50; ++run) {
      std::string message;
      try {
        duet::parallel_for_blocks(
            1000,
            [](std::size_t first, std::size_t) {
              if (first >= 300) {
                throw std::runtime_error(std::to_string(first));
              }
            },
            duet::execution{threads}, 10);
      } catch (const std::runtime_error& error) {
        message = error.what();
      }
      CHECK(message == "300");
    }
  }
}

TEST_CASE("parallel_for: progress increases to the total, reported by one thread at a time") {
  for (const std::size_t count : {1, 3, 127, 1000, 10007}) {
    for (const unsigned threads : {1U, 2U, 5U}) {
      std::vector<int> visits(count, 0);
      std::vector<std::size_t> reports; // not guarded: ThreadSanitizer watches
      const auto report = [&](const duet::progress& p) {
        CHECK(p.count == count);
        reports.push_back(p.done);
        if (reports.size() > 1) {
          CHECK(reports[reports.size() - 2] < p.done);
        }
        CHECK((p.share() == 1) == (p.done == count));
      };
      duet::parallel_for(
          count, [&](std::size_t i) { ++visits[i]; }, duet::execution{threads, report});
      CHECK(reports.back() == count);
      CHECK(reports.size() >= std::min<std::size_t>(count, 128));
      CHECK(visits == std::vector<int>(count, 1));
    }
  }
  const auto never = [](const duet::progress&) { FAIL("told"); };
  duet::parallel_for(
      0, [](std::size_t) {}, duet::execution{2, never});
}

TEST_CASE("parallel_for: cancelled between blocks, the completed elements have no gaps") {
  for (const unsigned threads : {1U, 2U, 5U}) {
    for (const std::size_t wanted : {1U, 30U, 500U}) {
      std::vector<int> visits(1000, 0);
      std::size_t calls_after = 0;
      bool has_cancelled = false;
      const auto report = [&](const duet::progress& p) {
        calls_after += has_cancelled;
        has_cancelled = has_cancelled || p.done >= wanted;
        return !has_cancelled;
      };
      std::size_t completed = 0;
      try {
        duet::parallel_for_blocks(
            visits.size(),
            [&](std::size_t first, std::size_t last) {
              for (std::size_t i = first; i < last; ++i) {
                ++visits[i];
              }
            },
            duet::execution{threads, report}, 10);
      } catch (const duet::cancelled& error) {
        completed = error.completed();
        CHECK(std::string(error.what()) ==
              "duet: cancelled with " + std::to_string(completed) + " of 1000 elements done");
      }
      CHECK(calls_after == 0);
      CHECK(completed >= wanted);
      CHECK((threads > 1 || completed == (wanted + 9) / 10 * 10));
      for (std::size_t i = 0; i < visits.size(); ++i) {
        CHECK(visits[i] == (i < completed ? 1 : 0));
      }
    }
  }
}

TEST_CASE("parallel_for: cancellation after the last block is ignored") {
  int calls = 0;
  const auto report = [&](const duet::progress& p) {
    ++calls;
    return p.done < p.count;
  };
  duet::parallel_for(
      50, [](std::size_t) {}, duet::execution{1, report});
  CHECK(calls == 50);
}

TEST_CASE(
    "parallel_for: after cancellation the callback is not called while running blocks finish") {
  for (int run = 0; run < 20; ++run) {
    std::atomic<int> begun = 0;
    int calls = 0;
    const auto report = [&](const duet::progress&) {
      ++calls;
      return false;
    };
    duet::parallel_for_blocks(
        2,
        [&](std::size_t, std::size_t) {
          ++begun;
          while (begun < 2) {
            std::this_thread::yield();
          }
        },
        duet::execution{2, report}, 1);
    CHECK(begun == 2);
    CHECK(calls == 1);
  }
}

TEST_CASE("parallel_for: another thread can cancel the run") {
  std::atomic<bool> stop = false;
  std::atomic<int> begun = 0;
  const auto report = [&](const duet::progress&) { return !stop; };
  std::thread other([&] {
    while (begun < 3) {
      std::this_thread::yield();
    }
    stop = true;
  });
  const auto wait = [&](std::size_t i) {
    ++begun;
    while (i == 5 && !stop) {
      std::this_thread::yield();
    }
  };
  CHECK_THROWS_AS(duet::parallel_for(100000, wait, duet::execution{1, report}), duet::cancelled);
  other.join();
}

TEST_CASE("parallel_for: an exception of the callback ends the run, and no further call follows") {
  int worst_calls = 0, max_visits = 0;
  bool has_thrown = true;
  for (int run = 0; run < 2000; ++run) {
    std::atomic<int> visits = 0;
    int calls = 0;
    const auto report = [&](const duet::progress&) -> bool {
      ++calls;
      throw std::runtime_error("enough");
    };
    std::string message;
    try {
      duet::parallel_for_blocks(
          1000, [&](std::size_t, std::size_t) { ++visits; },
          duet::execution{run % 3 == 0 ? 1U : 5U, report}, 1);
    } catch (const std::runtime_error& error) {
      message = error.what();
    }
    has_thrown = has_thrown && message == "enough";
    worst_calls = std::max(worst_calls, calls);
    max_visits = std::max(max_visits, visits.load());
  }
  CHECK(has_thrown);
  CHECK(worst_calls == 1);
  CHECK(max_visits <= 5); // one for each thread
}

TEST_CASE("parallel_for: an exception of the body takes precedence over cancellation") {
  const auto report = [](const duet::progress&) { return false; };
  const auto fail = [](std::size_t) { throw std::logic_error("broken"); };
  CHECK_THROWS_AS(duet::parallel_for(100, fail, duet::execution{2, report}), std::logic_error);
}

} // namespace test_core_parallel_for
