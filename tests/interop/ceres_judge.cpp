// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/comparison/rotations.hpp>
#include <duet/interop/ceres_judge.hpp>

#include <ceres/manifold.h>
#include <ceres/sized_cost_function.h>

#include "support/test.hpp"

namespace test_interop_ceres_judge {
namespace {

using namespace duet;
using Eigen::Matrix3d;
using Eigen::Vector3d;

enum class slip { none, no_chart, sign, transposed };

/// Residual R(q) p, in whose Jacobian is a slip.
class rotated_point : public ceres::SizedCostFunction<3, 4, 3> {
public:
  explicit rotated_point(slip s) : slip_(s) {}
  bool Evaluate(const double* const* x, double* residuals, double** jacobians) const override {
    const auto q = load_quaternion(x[0], quaternion_order::wxyz);
    const Vector3d p(x[1]), moved = rotate(q, p);
    std::copy_n(moved.data(), 3, residuals);
    const Matrix3d r = rotation_matrix(q);
    const Matrix3d hat = (Matrix3d() << 0, -p[2], p[1], p[2], 0, -p[0], -p[1], p[0], 0).finished();
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> j(jacobians[0]);
      if (slip_ == slip::no_chart) {
        j << -r * hat, Vector3d::Zero();
      } else {
        j = ambient(Matrix3d((slip_ == slip::sign ? r : Matrix3d(-r)) * hat), q,
                    quaternion_order::wxyz);
      }
    }
    if (jacobians != nullptr && jacobians[1] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> j(jacobians[1]);
      j = slip_ == slip::transposed ? Matrix3d(r.transpose()) : r;
    }
    return true;
  }

private:
  slip slip_;
};

/// Plus of a rotation, with an identity for its derivative.
class plain_manifold : public ceres::Manifold {
public:
  int AmbientSize() const override { return 4; }
  int TangentSize() const override { return 3; }
  bool Plus(const double* x, const double* delta, double* moved) const override {
    return exact_.Plus(x, delta, moved);
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    std::fill_n(jacobian, 12, 0.);
    jacobian[0] = jacobian[4] = jacobian[8] = 1;
    return true;
  }
  bool Minus(const double* y, const double* x, double* delta) const override {
    return exact_.Minus(y, x, delta);
  }
  bool MinusJacobian(const double* x, double* jacobian) const override {
    return exact_.MinusJacobian(x, jacobian);
  }

private:
  rotation_manifold exact_{quaternion_order::wxyz};
};

/// Parameter blocks of 4 and 2 numbers.
struct plane_point : ceres::SizedCostFunction<2, 4, 2> {
  bool Evaluate(const double* const*, double*, double**) const override { return false; }
};

jacobian_judgement judged(const ceres::CostFunction& f, const ceres::Manifold* manifold = nullptr) {
  const auto inputs =
      sampler(rotations{}, vectors<3>{1})
          .named("q", "p")
          .where([](const auto& q, const Vector3d& p) { return q.x() != 0 && p[0] != 0; });
  const std::tuple blocks{rotation_block{quaternion_order::wxyz}, vector_block<3>{}};
  return judge_jacobian("rotated point", f, inputs, blocks, {manifold, nullptr}, {.samples = 20});
}
jacobian_judgement judged(slip s, const ceres::Manifold* manifold = nullptr) {
  return judged(rotated_point(s), manifold);
}

TEST_CASE("Jacobians of cost functions are judged, and slips named") {
  const rotation_manifold manifold(quaternion_order::wxyz);
  const ceres::QuaternionManifold other;
  CHECK(judged(slip::none, &manifold));
  const auto right = judged(slip::none, &other);
  CHECK(right);
  CHECK(right.notes.empty());
  const auto sign = judged(slip::sign, &manifold);
  CHECK(sign.outcome == verdict::disagrees);
  REQUIRE(!sign.slips.empty());
  CHECK(sign.slips[0].name == "sign");
  CHECK(sign.slips[0].block == "d f / d q");
  const auto transposed = judged(slip::transposed);
  REQUIRE(!transposed.slips.empty());
  CHECK(transposed.slips[0].block == "d f / d p");
}

TEST_CASE("a PlusJacobian that is not the derivative of Plus is noted") {
  const plain_manifold plain;
  const auto both = judged(slip::no_chart, &plain);
  CHECK(both.outcome == verdict::disagrees);
  REQUIRE(both.notes.size() == 1);
  CHECK(both.notes[0] ==
        "PlusJacobian of the manifold of q is not the derivative of its Plus: right "
        "only together with this Jacobian, wrong with any other manifold");
  CHECK(to_text(both).find("  note: PlusJacobian of the manifold of q") != std::string::npos);
  const auto alone = judged(slip::none, &plain);
  CHECK(alone);
  REQUIRE(alone.notes.size() == 1);
  CHECK(alone.notes[0] ==
        "PlusJacobian of the manifold of q is not the derivative of its Plus, and "
        "its product with the Jacobian is wrong");
}

TEST_CASE("blocks of other sizes are refused") {
  CHECK_THROWS_WITH_AS((void)judged(plane_point()),
                       "duet: judge_jacobian: parameter block 1 has 2 numbers (expected 3)",
                       invalid_input);
}

} // namespace
} // namespace test_interop_ceres_judge
