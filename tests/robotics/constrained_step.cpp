// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "../../src/robotics/constrained_step.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/dual_quaternion/twist.hpp>

#include <Eigen/Core>

namespace test_robotics_constrained_step {
namespace {

using namespace duet;
using detail::inequality;
using joints = Eigen::Matrix<double, 7, 1>;
using vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 10, 1>;

/// Normal numbers.
template <class M>
M random_matrix(duet_test::random_source& random, M m) {
  for (Eigen::Index j = 0; j < m.cols(); ++j) {
    for (Eigen::Index i = 0; i < m.rows(); ++i) {
      m(i, j) = random.normal();
    }
  }
  return m;
}

TEST_CASE("damped_gram: solve systems; an unknown without a positive pivot is 0") {
  duet_test::random_source random(4);
  for (int k = 0; k < 10; ++k) {
    const detail::gram_matrix root = random_matrix(random, detail::gram_matrix());
    const vector6<double> x = random_matrix(random, vector6<double>());
    // Only the lower half of a = root rootᵀ + 1/100 is used. The last unknown has a pivot of zero
    // or below in `cut`.
    const detail::gram_matrix a = root * root.transpose() + .01 * detail::gram_matrix::Identity();
    detail::gram_matrix lower = a;
    lower.triangularView<Eigen::StrictlyUpper>().setConstant(NAN);
    detail::gram_matrix cut = lower;
    cut.row(5).setZero();
    cut(5, 5) = -k % 2;
    const vector6<double> b = a * x;
    const detail::damped_gram full(lower, {0, 0}), reduced(cut, {0, 0});
    CHECK(full.is_positive());
    CHECK((full.solve(b) - x).norm() < 1e-10 * x.norm());
    CHECK(!reduced.is_positive());
    const vector6<double> found = reduced.solve(b);
    CHECK(found[5] == 0);
    CHECK((a * found - b).head<5>().norm() < 1e-10 * x.norm());
  }
}

TEST_CASE("constrained_step: satisfies twist, limits and inequalities and is nearest to the "
          "preferred step") {
  duet_test::random_source random(3);
  int found = 0, none = 0;
  for (int k = 0; k < 300; ++k) {
    const auto j = random_matrix(random, Eigen::Matrix<double, 6, 7>());
    const joints preferred = .3 * random_matrix(random, joints());
    const joints some = .1 * random_matrix(random, joints());
    const vector6<double> e = j * some;
    const joints lower = joints::Constant(-.3), upper = joints::Constant(.3);
    std::vector<inequality<joints>> inequalities;
    for (int i = 0; i < 3; ++i) {
      inequalities.push_back({random_matrix(random, joints()), .3 * random.normal()});
    }
    const auto step = detail::constrained_step(j, e, preferred, lower, upper, inequalities).step;
    // One degree of redundancy: the steps some + y z that satisfy all constraints, and the y
    // nearest to the preferred step.
    const joints any = random_matrix(random, joints());
    const joints z = detail::orthonormal_rows<joints>(j, 7)(any).normalized();
    CHECK((j * z).norm() < 1e-14);
    double low = -std::numeric_limits<double>::infinity(), high = -low;
    const auto keep = [&](const joints& normal, double bound) {
      const double rate = normal.dot(z), limit = (bound - normal.dot(some)) / rate;
      (rate > 0 ? low : high) = rate > 0 ? std::max(low, limit) : std::min(high, limit);
    };
    for (Eigen::Index i = 0; i < 7; ++i) {
      keep(joints::Unit(i), -.3);
      keep(-joints::Unit(i), -.3);
    }
    for (const auto& each : inequalities) {
      keep(each.normal, each.bound);
    }
    REQUIRE(std::abs(high - low) > 1e-6);
    CHECK(step.has_value() == (low < high));
    if (step) {
      ++found;
      const double y = std::clamp(z.dot(preferred - some), low, high);
      CHECK((*step - some - y * z).norm() < 1e-10);
    } else {
      ++none;
    }
  }
  CHECK(found > 20);
  CHECK(none > 20);
}

TEST_CASE("constrained_step: without redundancy returns the only step or none") {
  using six = Eigen::Matrix<double, 6, 1>;
  const Eigen::Matrix<double, 6, 6> j = Eigen::Matrix<double, 6, 6>::Identity();
  const six far = six::Constant(std::numeric_limits<double>::infinity()), none = six::Zero();
  const std::vector<inequality<six>> inequalities{{-six::Unit(2), -.5}}; // Δ_2 ≤ 0.5
  const six e = six::Constant(.4);
  const auto step =
      detail::constrained_step(j, e, six(six::Ones()), six(-far), far, inequalities).step;
  REQUIRE(step);
  CHECK((*step - e).norm() < 1e-15);
  CHECK(!detail::constrained_step(j, six(2 * e), none, six(-far), far, inequalities).step);
}

} // namespace
} // namespace test_robotics_constrained_step
