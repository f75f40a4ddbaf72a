// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/core/parallel_for.hpp>

#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace test_core_parallel_for {

TEST_CASE("every element is visited once, whatever the number of threads") {
  for (const std::size_t count : {0, 1, 2, 7, 64, 1000, 10007}) {
    for (const unsigned threads : {0U, 1U, 2U, 3U, 16U}) {
      std::vector<int> visits(count, 0);
      duet::parallel_for(
          count, [&](std::size_t i) { ++visits[i]; }, duet::execution{threads});
      CHECK(visits == std::vector<int>(count, 1));
    }
  }
}

TEST_CASE("results are the same as of one core, bit for bit") {
  const auto table = [](duet::execution how) {
    std::vector<double> result(5000);
    duet::parallel_for(
        result.size(), [&](std::size_t i) { result[i] = std::sin(double(i)) / double(i + 1); },
        how);
    return result;
  };
  CHECK(table(duet::all_cores) == table(duet::one_core));
}

TEST_CASE("one core is the caller's own thread") {
  std::set<std::thread::id> threads;
  duet::parallel_for(
      100, [&](std::size_t) { threads.insert(std::this_thread::get_id()); }, duet::one_core);
  CHECK(threads == std::set<std::thread::id>{std::this_thread::get_id()});
}

TEST_CASE("several threads do work") {
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

TEST_CASE("blocks are as asked for") {
  std::vector<std::size_t> sizes;
  duet::parallel_for_blocks(
      10, [&](std::size_t first, std::size_t last) { sizes.push_back(last - first); },
      duet::one_core, 4);
  CHECK(sizes == std::vector<std::size_t>{4, 4, 2});
}

TEST_CASE("the exception of the first block that fails is the one the caller sees") {
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

} // namespace test_core_parallel_for
