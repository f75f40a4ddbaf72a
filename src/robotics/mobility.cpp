// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "loops/loop_closure_solver.hpp"
#include "loops/rank_revealing_svd.hpp"
#include "loops/second_derivatives.hpp"

#include <duet/core/errors.hpp>
#include <duet/core/random_source.hpp>
#include <duet/robotics/closed_tree.hpp>
#include <duet/robotics/mobility.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace duet::detail {
namespace {

/// Search around a configuration. Lengths are relative to that of the mechanism.
class neighbourhood {
public:
  explicit neighbourhood(const closed_chain_mechanism& of) : of_(of) {}

  /// True if one of the rates that fulfil the equations has an acceleration: a v in the kernel K of
  /// ∂F/∂q for which wᵀ ∂²F(v, v) = 0 for all w orthogonal to its image. By Newton's method on the
  /// unit sphere, from many starts.
  [[nodiscard]] bool has_acceleration(const Eigen::VectorXd& q, const rank_revealing_svd& a) {
    const Eigen::MatrixXd kernel = a.kernel();
    const std::vector<Eigen::MatrixXd> forms = quadratic_forms(of_, q, a.cokernel(), kernel);
    for (int start = 0; start < 20; ++start) {
      if (common_zero(forms, direction(kernel.cols()), 1e-7)) {
        return true;
      }
    }
    return false;
  }

  /// A configuration at about the distance `far_away`, along a random direction of the kernel.
  [[nodiscard]] std::optional<Eigen::VectorXd>
  position(const Eigen::VectorXd& q, const Eigen::MatrixXd& kernel, double far_away) {
    const loop_closure_solver solver = closed_near(q, kernel, far_away);
    const double moved = (solver.coordinates() - q).cwiseQuotient(of_.units()).norm();
    if (solver.has_closed() && moved > far_away / 3 && moved < 3 * far_away) {
      return solver.coordinates();
    }
    return std::nullopt;
  }

  /// Dimension spanned by the configurations around q; first-order flexible directions
  /// lead back to q.
  [[nodiscard]] int dimension(const Eigen::VectorXd& q, const Eigen::MatrixXd& kernel) {
    constexpr double step = .02;
    const Eigen::Index count = 2 * kernel.cols() + 2;
    Eigen::MatrixXd displacements(q.size(), count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const loop_closure_solver solver = closed_near(q, kernel, step);
      displacements.col(k) = (solver.coordinates() - q).cwiseQuotient(of_.units()) / step;
      if (!solver.has_closed()) {
        displacements.col(k).setZero();
      }
    }
    const Eigen::VectorXd spans =
        rank_revealing_svd(kernel.transpose().lazyProduct(displacements)).singular_values();
    return int((spans.array() > .1).count());
  }

private:
  [[nodiscard]] Eigen::VectorXd direction(Eigen::Index n) { return random_direction(random_, n); }
  /// Closes the loops from a distance along a random direction of the kernel.
  [[nodiscard]] loop_closure_solver closed_near(const Eigen::VectorXd& q,
                                                const Eigen::MatrixXd& kernel, double distance) {
    const Eigen::VectorXd displacement = kernel * direction(kernel.cols());
    return {of_, q + distance * displacement.cwiseProduct(of_.units()), all_but(of_.size(), {})};
  }

  const closed_chain_mechanism& of_;
  random_source random_{1};
};

} // namespace
} // namespace duet::detail

namespace duet {
DUET_ABI_BEGIN

mobility_result mobility(const closed_chain_mechanism& mechanism, const Eigen::VectorXd& q) {
  const double residual = mechanism.residuals(q).norm();
  detail::require(residual <= 1e-9, "duet: mobility: the loops are not closed: residual ",
                  residual);
  const detail::rank_revealing_svd at_start = detail::linearised(mechanism, q);
  const int n = mechanism.size();
  mobility_result result;
  result.kutzbach = n - mechanism.equation_count();
  result.instantaneous = n - int(at_start.rank());
  result.mobility = result.local = result.instantaneous;
  if (at_start.rank() == mechanism.equation_count()) {
    return result;
  }
  if (result.instantaneous == 0) {
    result.evidence = mobility_evidence::first_order_rigid;
    return result;
  }
  detail::neighbourhood around(mechanism);
  result.mobility = 0;
  if (!around.has_acceleration(q, at_start)) {
    result.evidence = mobility_evidence::second_order_rigid;
    return result;
  }
  result.evidence = mobility_evidence::sampled;
  for (int attempt = 0; attempt < 8; ++attempt) {
    if (const auto other = around.position(q, at_start.kernel(), .05)) {
      const detail::rank_revealing_svd at_other = detail::linearised(mechanism, *other);
      const int dimension = around.dimension(*other, at_other.kernel());
      if (dimension > result.mobility) {
        result.mobility = dimension;
        result.local = n - int(at_other.rank());
      }
    }
  }
  return result;
}
DUET_ABI_END
} // namespace duet
