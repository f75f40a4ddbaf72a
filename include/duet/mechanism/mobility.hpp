// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/random_source.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/mechanism/closed_tree.hpp>
#include <duet/mechanism/loop_closing.hpp>

#include <Eigen/Core>
#include <Eigen/QR>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

/// \file
/// In how many ways a mechanism with loops moves.

namespace duet {

/// What a mobility is known by.
enum class mobility_evidence {
  full_rank,       ///< the equations do not depend on each other here: certain
  no_rates,        ///< no rates fulfil the equations: rigid, certain
  no_acceleration, ///< of the rates that fulfil them none has an acceleration: rigid, certain
  nearby_positions ///< positions were looked for around this one
};

/// In how many ways a mechanism moves, and what simpler counts would say.
struct mobility_result {
  int mobility = 0;    ///< how many coordinates the positions around this one have
  int counted = 0;     ///< coordinates − equations, as Grübler and Kutzbach count
  int first_order = 0; ///< coordinates − rank of ∂F/∂q here: independent rates
  int nearby = 0;      ///< the same at positions nearby
  mobility_evidence evidence = mobility_evidence::full_rank; ///< what it is known by

  /// Does counting coordinates and equations say something else?
  [[nodiscard]] bool is_miscounted() const { return counted != mobility; }
  /// Are there rates with which it does not move: is it shaky, or do several motions meet here?
  [[nodiscard]] bool is_singular() const { return first_order != mobility; }
};

/// `mobility 1: counted -2, first order 1 here, 1 nearby`
[[nodiscard]] inline std::string to_text(const mobility_result& m) {
  return "mobility " + std::to_string(m.mobility) + ": counted " + std::to_string(m.counted) +
         ", first order " + std::to_string(m.first_order) + " here, " + std::to_string(m.nearby) +
         " nearby";
}

namespace detail {

/// Looks around a position. Lengths are in parts of the mechanism's.
class surroundings {
public:
  explicit surroundings(const closed_tree& of) : of_(of) {}

  /// Is there, among the rates that fulfil the equations, one with an acceleration: a v in the
  /// kernel K of ∂F/∂q for which wᵀ ∂²F(v, v) = 0 for all w across its image? Newton's method on
  /// the unit sphere, from many starts.
  [[nodiscard]] bool has_acceleration(const Eigen::VectorXd& q, const ranked_matrix& a) {
    const Eigen::MatrixXd kernel = a.kernel();
    const Eigen::MatrixXd across = a.cokernel();
    const Eigen::MatrixXd rates = of_.units().asDiagonal() * kernel;
    std::vector<Eigen::MatrixXd> forms; // column k of the i-th: wᵀ ∂²F(Kᵢ, K_k)
    for (Eigen::Index i = 0; i < kernel.cols(); ++i) {
      const auto change =
          directional_derivative([&](const auto& x) { return of_.constraint_jacobian(x); }, q,
                                 Eigen::VectorXd(rates.col(i)));
      forms.push_back(across.transpose() * change.derivative * rates);
    }
    const Eigen::Index n = kernel.cols();
    for (int start = 0; start < 20; ++start) {
      Eigen::VectorXd v = direction(n);
      Eigen::VectorXd f(across.cols() + 1);
      for (int i = 0; i < 40; ++i) {
        Eigen::MatrixXd j(across.cols() + 1, n);
        j.topRows(across.cols()).setZero();
        for (Eigen::Index k = 0; k < n; ++k) {
          j.topRows(across.cols()) += v[k] * forms[std::size_t(k)];
        }
        f.head(across.cols()) = j.topRows(across.cols()) * v;
        f[across.cols()] = (v.squaredNorm() - 1) / 2;
        j.topRows(across.cols()) *= 2;
        j.row(across.cols()) = v.transpose();
        if (f.norm() < 1e-7) {
          return true;
        }
        v -= j.completeOrthogonalDecomposition().solve(f);
      }
    }
    return false;
  }

  /// A position about so far away, along the kernel.
  [[nodiscard]] std::optional<Eigen::VectorXd>
  position(const Eigen::VectorXd& q, const Eigen::MatrixXd& kernel, double far_away) {
    const Eigen::VectorXd way = kernel * direction(kernel.cols());
    const closing found(of_, q + far_away * way.cwiseProduct(of_.units()), all_but(of_.size(), {}));
    const double moved = (found.coordinates() - q).cwiseQuotient(of_.units()).norm();
    if (found.has_closed() && moved > far_away / 3 && moved < 3 * far_away) {
      return found.coordinates();
    }
    return std::nullopt;
  }

  /// The dimension that positions around q span: shaky directions lead back.
  [[nodiscard]] int dimension(const Eigen::VectorXd& q, const Eigen::MatrixXd& kernel) {
    constexpr double step = .02;
    const Eigen::Index count = 2 * kernel.cols() + 2;
    Eigen::MatrixXd ways(q.size(), count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const Eigen::VectorXd way = kernel * direction(kernel.cols());
      const closing found(of_, q + step * way.cwiseProduct(of_.units()), all_but(of_.size(), {}));
      ways.col(k) = (found.coordinates() - q).cwiseQuotient(of_.units()) / step;
      if (!found.has_closed()) {
        ways.col(k).setZero();
      }
    }
    const Eigen::VectorXd spans =
        Eigen::JacobiSVD<Eigen::MatrixXd>(kernel.transpose() * ways).singularValues();
    return int((spans.array() > .1).count());
  }

private:
  [[nodiscard]] Eigen::VectorXd direction(Eigen::Index n) {
    Eigen::VectorXd result(n);
    do {
      for (double& x : result) {
        x = random_.normal();
      }
    } while (result.norm() < 1e-3);
    return result.normalized();
  }

  const closed_tree& of_;
  random_source random_{1};
};

} // namespace detail

/// In how many ways a mechanism moves from a position.
///
/// Where equations depend on each other neither their number nor the rank of ∂F/∂q says so: planar
/// mechanisms and those of Bennett and Goldberg have more equations than they need, a shaky frame
/// has rates and does not move, and where motions meet there are more rates than ways to go on.
/// Then second derivatives are asked whether any of the rates has an acceleration, and if so,
/// positions are looked for 0.05 radians (or parts of `length()`) away along random rates, and
/// around those that are found; the largest dimension of what they span is the mobility.
///
/// \param q  a position
/// \throws invalid_input for a q at which the loops are not closed
[[nodiscard]] inline mobility_result mobility(const closed_tree& mechanism,
                                              const Eigen::VectorXd& q) {
  const double residual = mechanism.residuals(q).norm();
  detail::require(residual <= 1e-9, "duet: mobility: the loops are not closed: residual ",
                  residual);
  const detail::ranked_matrix here = detail::linearised(mechanism, q);
  const int n = mechanism.size();
  mobility_result result;
  result.counted = n - mechanism.equations();
  result.first_order = n - int(here.rank());
  result.mobility = result.nearby = result.first_order;
  if (here.rank() == mechanism.equations()) {
    return result;
  }
  if (result.first_order == 0) {
    result.evidence = mobility_evidence::no_rates;
    return result;
  }
  detail::surroundings around(mechanism);
  result.mobility = 0;
  if (!around.has_acceleration(q, here)) {
    result.evidence = mobility_evidence::no_acceleration;
    return result;
  }
  result.evidence = mobility_evidence::nearby_positions;
  for (int attempt = 0; attempt < 8; ++attempt) {
    if (const auto other = around.position(q, here.kernel(), .05)) {
      const detail::ranked_matrix there = detail::linearised(mechanism, *other);
      const int dimension = around.dimension(*other, there.kernel());
      if (dimension > result.mobility) {
        result.mobility = dimension;
        result.nearby = n - int(there.rank());
      }
    }
  }
  return result;
}

} // namespace duet
