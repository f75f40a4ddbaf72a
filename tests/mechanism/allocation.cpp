// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "mechanism/arms.hpp"
#include "mechanism/everything.hpp"
#include "support/allocations.hpp"

#include <cstddef>
#include <vector>

namespace test_mechanism_allocation {

using namespace duet;

TEST_CASE("evaluation allocates nothing") {
  const auto known = robots::panda();
  const serial_chain<-16> chain = robots::panda().table();
  const auto theta = duet_test::configurations(known.table(), 3).back();
  const std::size_t before = duet_test::allocations;
  double sum = duet_test::everything(known, theta);
  sum += duet_test::everything(known.table(), theta);
  sum += duet_test::everything(chain, theta);
  const std::size_t during = duet_test::allocations - before;
  CHECK(during == 0);
  CHECK(sum == sum);

  const std::size_t start = duet_test::allocations; // the counter itself works
  const std::vector<double> copy(3);
  CHECK(duet_test::allocations > start);
}

} // namespace test_mechanism_allocation
