// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>
#include <duet/expression/graph/evaluate.hpp>
#include <duet/kinematics/chain_formula.hpp>

#include <Eigen/Core>

namespace test_kinematics_chain_formula {
namespace {

using duet::expression::count_operations;
using duet::expression::formula_graph;

/// Every type of joint, oblique axes, and offsets along and across them.
duet::bounded_chain<8> odd_arm() {
  using duet::joint_kind;
  std::vector<duet::joint<double>> joints(7);
  joints[0] = {.kind = joint_kind::prismatic, .axis = {1, 0, 0}};
  joints[1] = {.kind = joint_kind::revolute,
               .origin = {duet::exp(duet::vector3<double>(.3, -.2, .4)), {.1, .2, .3}},
               .axis = {.6, 0, -.8}};
  joints[2] = {.kind = joint_kind::helical,
               .origin = {duet::quaternion<double>(1), {0, .3, .2}},
               .axis = {0, 0, -1},
               .pitch = .05};
  joints[3] = {
      .kind = joint_kind::fixed,
      .origin = {duet::exp(duet::vector3<double>(std::numbers::pi / 4, 0, 0)), {0, 0, .1}}};
  joints[4] = {.kind = joint_kind::continuous, .axis = {0, 1, 0}};
  joints[5] = {.kind = joint_kind::prismatic,
               .origin = {duet::exp(duet::vector3<double>(0, .1, .2)), {.2, 0, -.1}},
               .axis = {0, .6, .8}};
  joints[6] = {.kind = joint_kind::revolute, .origin = {duet::quaternion<double>(1), {0, .1, 0}}};
  return duet::bounded_chain<8>(std::span<const duet::joint<double>>(joints),
                                {duet::exp(duet::vector3<double>(.1, .2, .3)), {.1, 0, .2}});
}

template <class C, class F>
void check(const C& chain, F frame) {
  const int n = chain.size();
  const formula_graph f = duet::formula_of(chain, frame, {.has_jacobian_rate = true});
  duet_test::random_source random(5);
  double error = 0;
  for (int k = 0; k < 20; ++k) {
    Eigen::VectorXd theta(n), rate(n);
    for (int i = 0; i < n; ++i) {
      // among them zeros and quarter turns
      theta[i] = k < 5 ? (k + i) % 4 * std::numbers::pi / 2 : random.uniform(-3, 3);
      rate[i] = random.uniform(-2, 2);
    }
    std::vector<double> inputs(theta.data(), theta.data() + n);
    inputs.insert(inputs.end(), rate.data(), rate.data() + n);
    const std::vector<double> values = evaluate(f, inputs);
    const auto pose = chain.pose(theta);
    const auto J = duet::jacobian(chain, theta, frame);
    const auto dJ = duet::jacobian_rate(chain, theta, rate, frame);
    REQUIRE(values.size() == std::size_t(12 + 12 * n));
    const Eigen::Matrix3d R = duet::rotation_matrix(duet::rotation(pose));
    const duet::vector3<double> t = duet::translation(pose);
    const auto compare = [&](std::size_t begin, const auto& m) {
      for (Eigen::Index i = 0; i < m.size(); ++i) {
        error = std::max(error, std::abs(values[begin + std::size_t(i)] - m.data()[i]) /
                                    (1 + std::abs(m.data()[i])));
      }
    };
    compare(0, R);
    compare(9, t);
    compare(12, Eigen::MatrixXd(J));
    compare(std::size_t(12 + 6 * n), Eigen::MatrixXd(dJ));
  }
  CHECK(error < 1e-14);
}

template <class C>
void check_in_all_frames(const C& chain) {
  check(chain, duet::frame::spatial);
  check(chain, duet::frame::body);
  check(chain, duet::frame::hybrid);
}

TEST_CASE("formula_of a chain: pose, Jacobian and its rate are those of the chain") {
  check_in_all_frames(duet::robots::panda_arm::chain);
  check_in_all_frames(duet::robots::ur5e_arm::chain);
  check_in_all_frames(odd_arm());
}

TEST_CASE("formula_of the Panda takes as few operations as one needs by hand") {
  const auto n =
      count_operations(duet::formula_of(duet::robots::panda_arm::chain, duet::frame::spatial));
  CHECK(n.multiplications == 108);
  CHECK(n.additions == 56);
  CHECK(n.sines == 7);
  CHECK(n.total() == 108 + 56 + 7);
  const auto body = count_operations(
      duet::formula_of(duet::robots::panda_arm::chain, duet::frame::body, {.has_jacobian = false}));
  CHECK(body.multiplications == 80);
}

} // namespace
} // namespace test_kinematics_chain_formula
