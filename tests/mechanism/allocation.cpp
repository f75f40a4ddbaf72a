// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "mechanism/arms.hpp"
#include "support/allocations.hpp"

#include <duet/mechanism/analytic_jacobian.hpp>
#include <duet/mechanism/jacobian_rate.hpp>
#include <duet/mechanism/joint_efforts.hpp>
#include <duet/mechanism/sweep.hpp>

#include <cstddef>
#include <thread>
#include <vector>

namespace test_mechanism_allocation {
namespace {

using namespace duet;

template <class Chain, class X>
double everything(const Chain& chain, const X& theta) {
  double sum = chain.pose(theta).w().value() + chain.pose(theta, 3).x().value();
  sum += jacobian(chain, theta, frame::spatial).sum();
  sum += jacobian(chain, theta, frame::body, chain.link(4)).sum();
  sum += jacobian_rate(chain, theta, theta, frame::hybrid).sum();
  sum += kinematic_hessian(chain, theta, frame::body)[2].sum();
  sum += pose_coordinates_jacobian(chain, theta).sum();
  sum += euler_jacobian<zyx>(chain, theta).sum();
  sum += joint_efforts(chain, theta, vector6<double>(vector6<double>::Ones()), frame::body).sum();
  return sum;
}

} // namespace

TEST_CASE("evaluation allocates nothing") {
  const auto known = robots::panda();
  const serial_chain<-16> chain = robots::panda().table();
  const auto theta = duet_test::configurations(known.table(), 3).back();
  const std::size_t before = duet_test::allocations;
  double sum = everything(known, theta);
  sum += everything(known.table(), theta);
  sum += everything(chain, theta);
  const std::size_t during = duet_test::allocations - before;
  CHECK(during == 0);
  CHECK(sum == sum);

  const std::size_t start = duet_test::allocations; // the counter itself works
  const std::vector<double> copy(3);
  CHECK(duet_test::allocations > start);
}

TEST_CASE("sweeps on one core allocate nothing") {
  const serial_chain<-16> chain = robots::panda().table();
  const auto theta = duet_test::configurations(robots::panda().table(), 9);
  std::vector<dual_quaternion<double>> tips(theta.size());
  std::vector<Eigen::Matrix<double, 6, 7>> columns(theta.size());
  const std::size_t before = duet_test::allocations;
  poses(chain, theta, tips);
  jacobians(chain, theta, frame::body, columns);
  const std::size_t during = duet_test::allocations - before;
  CHECK(during == 0);
  CHECK(columns.back().norm() > 1);
}

TEST_CASE("one chain, several threads, identical results") {
  const serial_chain<-16> chain = robots::panda().table();
  const auto all = duet_test::configurations(robots::panda().table(), 60);
  std::vector<double> expected;
  for (const auto& theta : all) {
    expected.push_back(everything(chain, theta));
  }
  std::vector<std::vector<double>> results(4, std::vector<double>(all.size()));
  std::vector<std::thread> threads;
  for (auto& result : results) {
    threads.emplace_back([&] {
      for (std::size_t i = 0; i < all.size(); ++i) {
        result[i] = everything(chain, all[i]);
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

} // namespace test_mechanism_allocation
