// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "loops/branch_finder.hpp"
#include "loops/loop_closure_solver.hpp"
#include "loops/rank_revealing_svd.hpp"
#include "loops/second_derivatives.hpp"
#include "loops/solution_curve.hpp"

#include <duet/core/errors.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/kinematics/closed_loop.hpp>
#include <duet/robotics/closed_tree.hpp>
#include <duet/robotics/loop_motion.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace duet {
DUET_ABI_BEGIN

driven_motion::driven_motion(closed_chain_mechanism mechanism, const Eigen::VectorXd& q0,
                             std::vector<int> drives, const driven_motion_options& options)
    : mechanism_(std::move(mechanism)), drives_(std::move(drives)),
      dependent_(detail::all_but(mechanism_.size(), drives_)), options_(options),
      start_(mechanism_.assemble(q0, drives_)), solve_(solver(start_)) {
  const detail::rank_revealing_svd all = detail::linearised(mechanism_, start_);
  const Eigen::Index free = mechanism_.size() - all.rank();
  detail::require(free == Eigen::Index(drives_.size()), "duet: driven_motion: ", drives_.size(),
                  " driven coordinates (expected ", free, ", the degrees of freedom at the start)");
  require_accelerations();
}

driven_motion driven_motion::warm_started_at(const Eigen::VectorXd& u) const {
  driven_motion result = *this;
  result.start_ = (*this)(u);
  result.solve_ = solver(result.start_);
  return result;
}

Eigen::MatrixXd driven_motion::solver(const Eigen::VectorXd& q) const {
  const Eigen::MatrixXd j = detail::columns(detail::unit_jacobian(mechanism_, q), dependent_);
  const detail::rank_revealing_svd svd(j);
  detail::require(svd.rank() == j.cols(), "duet: driven_motion: ", driven(),
                  " does not determine the rates of the other coordinates (dead point)");
  Eigen::MatrixXd result(j.cols(), j.rows());
  for (Eigen::Index i = 0; i < j.rows(); ++i) {
    result.col(i) = svd.solve(Eigen::VectorXd::Unit(j.rows(), i), j.cols())
                        .cwiseProduct(mechanism_.units()(dependent_));
  }
  return result;
}

void driven_motion::require_accelerations() const {
  using T = detail::along_line;
  for (const int drive : drives_) {
    Eigen::Matrix<T, Eigen::Dynamic, 1> q = start_.cast<T>();
    q[drive] = T::variable(start_[drive]);
    q[drive] = start_[drive] + mechanism_.units()[drive] * (q[drive] - start_[drive]);
    add_infinitesimals(q, solve_);
    double residual = 0;
    for (const T& f : mechanism_.residuals(q)) {
      residual = std::max(residual, std::abs(f.derivative(2)));
    }
    double max_derivative = 1;
    for (const T& x : q) {
      max_derivative =
          std::max({max_derivative, std::abs(x.derivative(1)), std::abs(x.derivative(2))});
    }
    detail::require(residual <= 1e-7 * max_derivative * max_derivative,
                    "duet: driven_motion: a rate of ",
                    mechanism_.tree().coordinate_names()[std::size_t(drive)],
                    " satisfies the equations to first order only: the mechanism does not move");
  }
}

std::string driven_motion::driven() const {
  std::string result;
  for (const int i : drives_) {
    result += (result.empty() ? "" : ", ") + mechanism_.tree().coordinate_names()[std::size_t(i)];
  }
  return printable(result);
}
std::string driven_motion::text(const Eigen::VectorXd& q) const {
  std::string result;
  for (const int i : drives_) {
    result += (result.empty() ? "" : ", ") + duet::to_text(q[i]);
  }
  return drives_.size() == 1 ? result : "(" + result + ")";
}
[[noreturn]] void driven_motion::fail(const std::string& what, const Eigen::VectorXd& q,
                                      const Eigen::VectorXd& target) const {
  const Eigen::VectorXd u = q(drives_);
  Eigen::VectorXd to = q;
  to(drives_) = target;
  detail::raise(loop_closure_failure("duet: driven_motion: the loops do not close beyond " +
                                         driven() + " = " + text(q) + " on the line from " +
                                         text(start_) + " to " + text(to) + ": " + what,
                                     {u.begin(), u.end()}));
}

Eigen::VectorXd driven_motion::followed(const Eigen::VectorXd& target) const {
  detail::require(target.allFinite(), "duet: driven_motion: the driven coordinates are not finite");
  const Eigen::VectorXd displacement =
      (target - start_(drives_)).cwiseQuotient(mechanism_.units()(drives_));
  const double length = displacement.norm();
  if (length == 0) {
    return start_;
  }
  const detail::solution_curve curve(mechanism_, start_, drives_, displacement);
  constexpr double min_step = 1e-7;
  auto current = *curve.start(1); // its tangent is defined: drives determine all rates
  const auto require_step = [&](double step) {
    if (step < min_step) {
      fail("continuation fails, branches touch or coordinates are singular",
           curve.coordinates(current.x), target);
    }
  };
  for (double step = options_.largest_step;;) {
    const auto next = curve.advance(current, step);
    if (!next) {
      step /= 2;
      if (const auto met = detail::branch_point_ahead(curve, current, step)) {
        const Eigen::VectorXd& along = met->tangents[0];
        const double s = met->x[met->x.size() - 1], rate = along[along.size() - 1];
        current = met->points[0];
        step = (current.x - met->x).norm();
        if (current.s() >= length) {
          detail::curve_point guess = current;
          guess.x = met->x + (length - s) / rate * along;
          const auto reached = curve.at(length, guess, step);
          if (reached || curve.residuals(guess.x).norm() <= 1e-12) {
            Eigen::VectorXd q = curve.coordinates(reached ? reached->x : guess.x);
            q(drives_) = target;
            return q;
          }
        }
        if (current.s() >= length || current.s_rate() <= 0) {
          fail("dead point at a branch point", curve.coordinates(met->x), target);
        }
        continue;
      }
      require_step(step);
      continue;
    }
    detail::solution_curve::curve_interval to{*next, step};
    if (next->s_rate() <= 0) {
      to = curve.zero(current, *next, step, [](const auto& at) { return at.s_rate(); });
    }
    if (to.end.s() >= length) { // between both points it reaches the target
      const double part = (length - current.s()) / (to.end.s() - current.s());
      const auto guess = curve.advance(current, part * to.step);
      if (const auto reached = curve.at(length, guess ? *guess : to.end, step)) {
        Eigen::VectorXd q = curve.coordinates(reached->x);
        q(drives_) = target;
        return q;
      }
    }
    if (next->s_rate() <= 0 && (to.end.s() < length || step < min_step)) {
      fail("dead point, " + detail::moving_coordinates(mechanism_, curve.rates(to.end.tangent)) +
               " still move",
           curve.coordinates(to.end.x), target);
    }
    if (to.end.s() >= length) {
      step /= 2;
      require_step(step);
      continue;
    }
    current = to.end;
    step = std::min(options_.largest_step, 2 * step);
  }
}
DUET_ABI_END
} // namespace duet
