// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "kinematics/arms.hpp"
#include "kinematics/everything.hpp"

#include <duet/kinematics/constrained_mechanism.hpp>

#include <thread>

namespace test_kinematics_threads {
namespace {

using namespace duet;

/// Checks that f(0) … f(count − 1) are equal in four concurrent threads and in one.
template <class F>
void check_in_threads(std::size_t count, const F& f) {
  std::vector<double> expected;
  for (std::size_t i = 0; i < count; ++i) {
    expected.push_back(f(i));
  }
  std::vector<std::vector<double>> results(4, std::vector<double>(count));
  std::vector<std::thread> threads;
  for (auto& result : results) {
    threads.emplace_back([&] {
      for (std::size_t i = 0; i < count; ++i) {
        result[i] = f(i);
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (const auto& result : results) {
    CHECK(result == expected);
  }
}

TEST_CASE("serial_chain: several threads give identical results") {
  const bounded_chain<16> chain = robots::panda().table();
  const auto all = duet_test::configurations(robots::panda().table(), 60);
  check_in_threads(all.size(), [&](std::size_t i) { return duet_test::everything(chain, all[i]); });
}

TEST_CASE("constrained_mechanism: several threads give identical results") {
  const constrained_mechanism slider([](const auto& x, const auto& u) { return x * x + u * u - 1; },
                                     1.0, 0);
  check_in_threads(60, [&](std::size_t i) { return slider(std::sin(double(i))); });
}

} // namespace
} // namespace test_kinematics_threads
