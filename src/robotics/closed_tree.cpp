// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "loop_closure_solver.hpp"

#include <duet/core/errors.hpp>
#include <duet/core/random_source.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/dual_quaternion/displacement.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/kinematics/constrained_mechanism.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/kinematic_tree.hpp>
#include <duet/kinematics/robot_description.hpp>
#include <duet/kinematics/tree_loop.hpp>
#include <duet/kinematics/tree_table.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/robotics/closed_tree.hpp>

#include <Eigen/Core>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace duet::detail {
namespace {

class assembly_search {
public:
  assembly_search(const closed_chain_mechanism& of, const Eigen::VectorXd& at,
                  const std::vector<int>& fixed)
      : of_(of), at_(at), free_(all_but(of.size(), fixed)), periodic_(of) {}

  [[nodiscard]] assembly_search_result run(const assembly_search_options& options) {
    assembly_search_result result;
    random_source random(options.seed);
    const auto is_enough = [&] {
      const double chance = result.missing_probability() + 1. / std::max(1, result.converged);
      return result.starts >= options.random_starts &&
             (result.starts >= options.max_starts || chance <= options.missing_probability);
    };
    for (; !is_enough(); ++result.starts) {
      const loop_closure_solver solver(of_, guess(random), free_, 100);
      if (solver.has_closed()) {
        ++result.converged;
        add(result, wrapped(solver.coordinates()));
      }
    }
    std::sort(result.positions.begin(), result.positions.end(), &comes_first);
    return result;
  }

private:
  [[nodiscard]] Eigen::VectorXd guess(random_source& random) const {
    Eigen::VectorXd q = at_;
    for (const int i : free_) {
      const joint_limits<double>& limits = of_.tree().limits(i);
      const double reach = std::numbers::pi * of_.units()[i];
      const bool has_limits = std::isfinite(limits.lower) && std::isfinite(limits.upper);
      q[i] =
          has_limits ? random.uniform(limits.lower, limits.upper) : random.uniform(-reach, reach);
    }
    return q;
  }

  /// The coordinates without full turns.
  [[nodiscard]] Eigen::VectorXd wrapped(Eigen::VectorXd q) const {
    constexpr double full_turn = 2 * std::numbers::pi;
    for (const int i : free_) {
      if (periodic_.angles[std::size_t(i)]) {
        const double x = std::remainder(q[i], full_turn);
        q[i] = x <= -std::numbers::pi ? std::numbers::pi : x;
      }
    }
    for (const int i : periodic_.vectors) {
      if (std::find(free_.begin(), free_.end(), i) != free_.end()) {
        const double angle = q.segment<3>(i).norm();
        if (angle > std::numbers::pi) {
          q.segment<3>(i) *= std::remainder(angle, full_turn) / angle;
        }
      }
    }
    return q;
  }

  /// Poses of all links, (w, x, y, z, t) as columns: two configurations are the same if all links
  /// have the same poses.
  using poses = Eigen::Matrix<double, 7, Eigen::Dynamic>;

  [[nodiscard]] poses link_poses(const Eigen::VectorXd& q) const {
    const auto all = of_.tree().poses(q);
    poses result(7, Eigen::Index(all.size()));
    for (std::size_t i = 0; i < all.size(); ++i) {
      const quaternion<double> r = rotation(all[i]);
      result.col(Eigen::Index(i)) << r.w(), r.x(), r.y(), r.z(), translation(all[i]) / of_.length();
    }
    return result;
  }
  [[nodiscard]] static bool are_same(const poses& a, const poses& b) {
    constexpr double rounding = 1e-6; // singular configurations are known to half the digits
    const auto r = a.topRows<4>(), s = b.topRows<4>();
    return (r - s).colwise().norm().cwiseMin((r + s).colwise().norm()).maxCoeff() <= rounding &&
           (a - b).bottomRows<3>().colwise().norm().maxCoeff() <= rounding;
  }

  void add(assembly_search_result& result, const Eigen::VectorXd& q) {
    const poses all = link_poses(q);
    const auto known = std::find_if(known_poses_.begin(), known_poses_.end(),
                                    [&](const poses& other) { return are_same(all, other); });
    if (known != known_poses_.end()) {
      ++result.positions[std::size_t(known - known_poses_.begin())].hits;
      return;
    }
    known_poses_.push_back(all);
    assembly_configuration configuration{q, 0, 1, true};
    const Eigen::MatrixXd j = columns(unit_jacobian(of_, q), free_);
    const Eigen::VectorXd s = rank_revealing_svd(j).s;
    configuration.smallest_singular_value =
        s.size() == 0 || s.size() < j.cols() ? 0 : s[s.size() - 1];
    for (int i = 0; i < of_.size(); ++i) {
      const joint_limits<double>& limits = of_.tree().limits(i);
      configuration.within_limits &= limits.lower <= q[i] && q[i] <= limits.upper;
    }
    result.positions.push_back(configuration);
  }

  [[nodiscard]] static bool comes_first(const assembly_configuration& a,
                                        const assembly_configuration& b) {
    const Eigen::VectorXd &p = a.coordinates, &q = b.coordinates;
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end(),
                                        [](double x, double y) { return y - x > 1e-6; });
  }

  const closed_chain_mechanism& of_;
  Eigen::VectorXd at_;
  std::vector<int> free_;
  periodic_coordinates periodic_;
  std::vector<poses> known_poses_;
};

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
      if (common_zero(forms, random_direction(random_, kernel.cols()), 1e-7)) {
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
        rank_revealing_svd(kernel.transpose().lazyProduct(displacements)).s;
    return int((spans.array() > .1).count());
  }

private:
  /// Closes the loops from a distance along a random direction of the kernel.
  [[nodiscard]] loop_closure_solver closed_near(const Eigen::VectorXd& q,
                                                const Eigen::MatrixXd& kernel, double distance) {
    const Eigen::VectorXd displacement = kernel * random_direction(random_, kernel.cols());
    return {of_, q + distance * displacement.cwiseProduct(of_.units()), all_but(of_.size(), {})};
  }

  const closed_chain_mechanism& of_;
  random_source random_{1};
};

} // namespace
} // namespace duet::detail

namespace duet {
DUET_ABI_BEGIN

closed_chain_mechanism::closed_chain_mechanism(kinematic_tree tree, loop_constraints constraints)
    : tree_(std::move(tree)), constraints_(std::move(constraints)) {
  measure();
  for (std::size_t i = 0; i < constraints_.loops.size(); ++i) {
    const loop_constraint& loop = constraints_.loops[i];
    equations_.push_back({loop.kind, {frame(i, loop.second), frame(i, loop.first)}, loop.length});
    if (equations_.back().frames.frame.link == equations_.back().frames.observer.link) {
      detail::bad_loop(constraints_, i, "both frames are on the link \"" + loop.first.link + "\"");
    }
    if (loop.kind == constraint_kind::distance &&
        !(loop.length > 0 && std::isfinite(loop.length))) {
      detail::bad_loop(constraints_, i,
                       "the length is " + duet::to_text(loop.length) + " (expected > 0)");
    }
    rows_ += equations_.back().size();
  }
}

Eigen::VectorXd closed_chain_mechanism::assemble(const Eigen::VectorXd& guess,
                                                 const std::vector<int>& fixed) const {
  detail::require(guess.allFinite(),
                  "duet: closed_chain_mechanism: the initial guess is not finite");
  const detail::loop_closure_solver solver(*this, guess, detail::all_but(size(), fixed));
  if (!solver.has_closed()) {
    detail::raise(loop_closure_failure(
        "duet: closed_chain_mechanism: no configuration near the initial guess, residual " +
            duet::to_text(solver.residual()),
        {guess.begin(), guess.end()}));
  }
  return solver.coordinates();
}

Eigen::VectorXd closed_chain_mechanism::residuals(const Eigen::VectorXd& q) const {
  return residuals<Eigen::VectorXd>(q);
}
Eigen::MatrixXd closed_chain_mechanism::constraint_jacobian(const Eigen::VectorXd& q) const {
  return constraint_jacobian<Eigen::VectorXd>(q);
}

std::vector<int> closed_chain_mechanism::independent_coordinates(const Eigen::VectorXd& q) const {
  const Eigen::MatrixXd rates = detail::linearised(*this, q).kernel();
  if (rates.cols() == 0) {
    return {}; // Eigen does not factorise empty matrices
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(rates.transpose());
  const auto pivots = factors.colsPermutation().indices().head(rates.cols());
  std::vector<int> result(pivots.begin(), pivots.end());
  std::sort(result.begin(), result.end());
  return result;
}

attached_frame<double> closed_chain_mechanism::frame(std::size_t i,
                                                     const constraint_frame& at) const {
  const auto& links = tree_.table().link_numbers;
  const auto link = links.find(at.link);
  if (link == links.end()) {
    std::vector<std::string> names;
    for (const tree_link& each : tree_.links()) {
      names.push_back(each.name);
    }
    detail::bad_loop(constraints_, i,
                     "no link \"" + at.link + "\": " + detail::closest_names(at.link, names));
  }
  const auto& [r, t] = at.offset;
  if (!std::isfinite(t[0] + t[1] + t[2]) || !std::isfinite(squared_norm(r))) {
    detail::bad_loop(constraints_, i, "the frame on \"" + at.link + "\" is not finite");
  }
  return {link->second, at.offset};
}

void closed_chain_mechanism::measure() {
  const auto include_length = [&](const placement<double>& at) {
    const auto& t = at.translation;
    length_ = std::max(length_, std::hypot(t[0], t[1], t[2]));
  };
  for (const loop_constraint& loop : constraints_.loops) {
    include_length(loop.first.offset);
    include_length(loop.second.offset);
    length_ = std::max(length_, loop.length);
  }
  for (const tree_joint& each : tree_.joints()) {
    include_length(each.motion.origin);
  }
  length_ = length_ > 0 && std::isfinite(length_) ? length_ : 1;
  units_ = Eigen::VectorXd::Ones(size());
  Eigen::Index i = 0;
  for (const tree_joint& each : tree_.joints()) {
    if (each.mimic) {
      continue;
    }
    const joint_kind kind = each.motion.kind;
    const int lengths = kind == joint_kind::prismatic  ? 1
                        : kind == joint_kind::planar   ? 2
                        : kind == joint_kind::floating ? 3
                                                       : 0;
    units_.segment(i, lengths).setConstant(length_);
    i += each.motion.coordinates();
  }
}

assembly_search_result find_assembly_configurations(const closed_chain_mechanism& mechanism,
                                                    const std::vector<int>& fixed,
                                                    const Eigen::VectorXd& at,
                                                    const assembly_search_options& options) {
  detail::require(Eigen::Index(fixed.size()) == at.size(),
                  "duet: find_assembly_configurations: ", at.size(), " values for ", fixed.size(),
                  " fixed coordinates");
  detail::require(at.allFinite(),
                  "duet: find_assembly_configurations: the fixed coordinates are not finite");
  Eigen::VectorXd q = Eigen::VectorXd::Zero(mechanism.size());
  static_cast<void>(detail::all_but(mechanism.size(), fixed));
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    q[fixed[i]] = at[Eigen::Index(i)];
  }
  return detail::assembly_search(mechanism, q, fixed).run(options);
}

mobility_result mobility(const closed_chain_mechanism& mechanism, const Eigen::VectorXd& q) {
  const double residual = mechanism.residuals(q).norm();
  detail::require(residual <= 1e-9, "duet: mobility: the loops are not closed: residual ",
                  residual);
  const detail::rank_revealing_svd at_start = detail::linearised(mechanism, q);
  const int n = mechanism.size();
  mobility_result result;
  result.kutzbach = n - mechanism.equation_count();
  result.instantaneous = n - int(at_start.rank);
  result.mobility = result.local = result.instantaneous;
  if (at_start.rank == mechanism.equation_count()) {
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
        result.local = n - int(at_other.rank);
      }
    }
  }
  return result;
}

DUET_ABI_END
} // namespace duet
