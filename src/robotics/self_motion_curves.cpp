// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "branches/chain_loop.hpp"
#include "branches/loop_equation.hpp"
#include "planning_model.hpp"
#include "splitmix64.hpp"
#include "tip_pose.hpp"

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/robotics/self_motion_curves.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SVD>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace duet::detail {
namespace {

using seven_coordinates = Eigen::Matrix<double, 7, 1>;
using seven_columns = Eigen::Matrix<double, 6, 7>;

/// Consecutive points of a curve, or a sample of a component of another dimension.
struct traced_curve {
  std::vector<seven_coordinates> points;
  bool is_closed = false;
  int dimension = 1;
  int kernel = 1; ///< dimension of the Jacobian's null space at almost all points
};

/// Collects the components of the self-motion set M = {θ : the tip is at the goal} of one arm of
/// seven joints at one goal, with angles modulo full turns.
///
/// At a regular point M is a curve along the Jacobian's null space. If the null space has more
/// dimensions, M may still be a curve (two that coincide, as for a straight elbow), curves that
/// cross, an isolated point, or have as many dimensions: neighbouring points of M decide.
///
/// Curves are followed by predictor–corrector continuation: steps along the Jacobian's null space,
/// or along the projection of the previous step onto it where it has more dimensions, and
/// projections back onto the set. On components of two and more dimensions walks lead to samples.
class component_search {
public:
  component_search(const chain_view& chain, const dual_quaternion<double>& goal, double resolution)
      : chain_(chain), model_(chain), goal_(to_tip_pose(goal)),
        scaled_goal_(model_.scaled_pose(goal)), unit_(model_.unit.head<7>()),
        resolution_(resolution) {}

  [[nodiscard]] std::vector<traced_curve> operator()() {
    add_slices();
    // Points of components on which no joint can be fixed alone, from random configurations.
    const int random_points = is_degenerate_ || seeds_[1].empty() ? 256 : 0;
    for (int k = 0; k < random_points; ++k) {
      if (const auto x = any_point()) {
        add_seed(*x);
      }
    }
    // Seeds with the smallest null spaces first: almost all points of a component have a null space
    // of the same dimension, some have larger ones.
    for (std::size_t kernel = 1; kernel < seeds_.size(); ++kernel) {
      for (const seven_coordinates& x : seeds_[kernel]) {
        add(x, int(kernel));
      }
    }
    return std::move(components_);
  }

private:
  using null_space = Eigen::Matrix<double, 7, Eigen::Dynamic, Eigen::ColMajor, 7, 7>;
  using square = Eigen::Matrix<double, 7, 7>;
  using decomposition = Eigen::JacobiSVD<square>;

  // Points of the set.

  [[nodiscard]] bool is_revolute(int joint) const {
    return model_.is_rotational[std::size_t(joint)];
  }
  /// State of the chain, with lengths relative to the arm's size.
  [[nodiscard]] chain_state<8> at(const seven_coordinates& x) const {
    return model_.at(model_.joints(x));
  }
  [[nodiscard]] small_twist tip_error(const chain_state<8>& state) const {
    return error_twist(state.tip, scaled_goal_);
  }

  /// Difference b − a, rotation angles by the shorter arc; lengths relative to the arm's size.
  [[nodiscard]] seven_coordinates difference(const seven_coordinates& b,
                                             const seven_coordinates& a) const {
    seven_coordinates d = (b - a).cwiseQuotient(unit_);
    for (int i = 0; i < 7; ++i) {
      d[i] = is_revolute(i) ? wrap_angle(d[i]) : d[i];
    }
    return d;
  }

  [[nodiscard]] seven_coordinates moved(const seven_coordinates& x,
                                        const seven_coordinates& d) const {
    return x + d.cwiseProduct(unit_);
  }

  /// Point of M that damped least squares (Levenberg–Marquardt) leads to from an initial guess. If
  /// the Jacobian is singular on M convergence is linear, with a factor of one half per step.
  ///
  /// \param max_distance  maximum distance from the initial guess
  /// \return empty if it does not converge within that distance
  [[nodiscard]] std::optional<seven_coordinates> projected(const seven_coordinates& from,
                                                           double max_distance) const {
    constexpr int iterations = 60;
    constexpr double rounding = 1e-15;
    constexpr double enough = 2e-15; // near a double point half of the digits are lost
    seven_coordinates x = from, best = from;
    double min_error = std::numeric_limits<double>::infinity();
    int since = 0; // steps since the error last fell
    for (int k = 0; k < iterations && since < (min_error < max_error ? 2 : 8); ++k) {
      const chain_state<8> state = at(x);
      const seven_columns j = state.jacobian;
      const small_twist e = tip_error(state);
      const double size = e.norm();
      ++since;
      if (size < .9 * min_error) {
        since = 0;
      }
      if (size < min_error) {
        min_error = size;
        best = x;
      }
      if (size < enough) {
        break;
      }
      Eigen::Matrix<double, 6, 6> gram = j * j.transpose();
      gram.diagonal().array() += std::min(.02 * size * size, .08) + rounding;
      x = moved(x, j.transpose() * gram.llt().solve(e));
      if (!(difference(x, from).norm() < max_distance)) {
        return {};
      }
    }
    return min_error < max_error ? std::optional(best) : std::nullopt;
  }

  /// Orthonormal basis of the Jacobian's null space.
  [[nodiscard]] null_space null_space_at(const seven_coordinates& x) const {
    const seven_columns j = at(x).jacobian;
    // The product of the singular values gives a bound on the smallest: the mean square of the
    // others is not below their geometric mean. If it is far from 0 normal equations suffice.
    constexpr double regular = 1e-3;
    const Eigen::LLT<Eigen::Matrix<double, 6, 6>> gram(j * j.transpose());
    const double product = gram.matrixLLT().diagonal().prod(), squares = j.squaredNorm();
    if (gram.info() == Eigen::Success &&
        product > regular * std::sqrt(squares) * std::pow(squares / 5, 2.5)) {
      const square projector = square::Identity() - j.transpose() * gram.solve(j);
      Eigen::Index largest = 0;
      projector.diagonal().maxCoeff(&largest);
      const seven_coordinates column = projector.col(largest);
      return (column - j.transpose() * gram.solve(j * column)).normalized();
    }
    square rows = square::Zero();
    rows.topRows<6>() = j;
    const decomposition svd(rows, Eigen::ComputeFullV);
    const auto& sizes = svd.singularValues();
    Eigen::Index rank = 0;
    while (rank < 6 && sizes[rank] > singular_ratio * sizes[0]) {
      ++rank;
    }
    return svd.matrixV().rightCols(7 - rank);
  }

  /// Random unit vector of a null space.
  [[nodiscard]] seven_coordinates any_direction(const null_space& basis) {
    seven_coordinates result;
    do {
      result.setZero();
      for (Eigen::Index k = 0; k < basis.cols(); ++k) {
        result += (2 * random_() - 1) * basis.col(k);
      }
    } while (!(result.norm() > .1));
    return result.normalized();
  }

  /// Dimension of M at a point, from the projections of points at a distance `step` in
  /// directions of the Jacobian's null space. (At crossings: the dimension of the span of all
  /// curves that meet there.)
  [[nodiscard]] int dimension_at(const seven_coordinates& x, double step) {
    const null_space basis = null_space_at(x);
    if (basis.cols() == 1) {
      return 1;
    }
    constexpr double min_fraction = .01; // fraction of the mean square; curvature contributes step²
    square spread = square::Zero();
    const int count = 4 * int(basis.cols());
    for (int k = 0; k < count; ++k) {
      const auto point = neighbour_of(x, step, basis);
      if (point) {
        const seven_coordinates d = difference(*point, x) / step;
        spread += d * d.transpose() / count;
      }
    }
    const auto sizes = decomposition(spread).singularValues();
    return int((sizes.array() > min_fraction).count());
  }

  /// Neighbouring point of M at about the distance `step`, or nearer; empty if
  /// the projection fails.
  [[nodiscard]] std::optional<seven_coordinates>
  neighbour_of(const seven_coordinates& x, double step, const null_space& basis) {
    return projected(moved(x, step * any_direction(basis)), 3 * step);
  }

  /// Random point of M; empty if the search from a random configuration fails.
  [[nodiscard]] std::optional<seven_coordinates> any_point() {
    seven_coordinates x;
    for (int i = 0; i < 7; ++i) {
      const double part = 2 * random_() - 1;
      x[i] = part * (is_revolute(i) ? std::numbers::pi : unit_[i]);
    }
    return projected(x, std::numeric_limits<double>::infinity());
  }

  // Components.

  /// Adds all solutions of the other six joints with one joint fixed, for each joint at values one
  /// resolution apart.
  void add_slices() {
    const int count = int(std::ceil(2 * std::numbers::pi / resolution_));
    for (int fixed = 0; fixed < 7; ++fixed) {
      for (int k = 0; k < count && is_revolute(fixed); ++k) {
        // not at round numbers from tables, where arms are singular
        const double value = 2 * std::numbers::pi * (k + .37) / count - std::numbers::pi;
        const chain_screws axes(chain_, seven_coordinates(value * seven_coordinates::Unit(fixed)),
                                fixed);
        const loop_solution_set all = solutions_of(axes.loop_to(goal_));
        for (const loop_solution& solution : all.solutions) {
          // If other joints can move while this one is fixed, its value is singular, or the set has
          // more dimensions.
          is_degenerate_ = is_degenerate_ || !all.is_complete;
          seven_coordinates theta;
          for (int i = 0, other = 0; i < 7; ++i) {
            theta[i] =
                i == fixed ? value : solution.theta[other++] * (is_revolute(i) ? 1 : axes.size);
          }
          if (const auto on_set = projected(theta, .1)) {
            add_seed(*on_set);
          }
        }
      }
    }
  }

  void add_seed(const seven_coordinates& x) {
    const auto kernel = std::size_t(null_space_at(x).cols());
    is_degenerate_ = is_degenerate_ || kernel > 1;
    seeds_[kernel].push_back(x);
  }

  [[nodiscard]] bool is_known(const seven_coordinates& x, int kernel) {
    return std::any_of(components_.begin(), components_.end(), [&](const traced_curve& component) {
      return component.dimension > 1 ? kernel > 1 && is_on_surface(component, x)
                                     : is_on_curve(component, x, kernel);
    });
  }

  void add(const seven_coordinates& x, int kernel) {
    if (is_known(x, kernel)) {
      return;
    }
    if (kernel == 1) {
      components_.push_back(trace(x, null_space_at(x).col(0), 1));
    } else if (dimension_at(x, start_step) == 0) {
      components_.push_back({{x}, false, 0, kernel});
    } else {
      add_near(x);
    }
  }

  /// Adds components near a singular point, at which several of them may cross.
  void add_near(const seven_coordinates& singular) {
    struct neighbour {
      seven_coordinates x;
      int kernel;
    };
    const auto basis = null_space_at(singular);
    std::vector<neighbour> neighbours;
    for (int k = 0; k < 4 * basis.cols(); ++k) {
      const auto x = neighbour_of(singular, start_step, basis);
      if (x && difference(*x, singular).norm() > small_step) {
        neighbours.push_back({*x, int(null_space_at(*x).cols())});
      }
    }
    std::sort(neighbours.begin(), neighbours.end(),
              [](const neighbour& a, const neighbour& b) { return a.kernel < b.kernel; });
    for (const auto& [x, kernel] : neighbours) {
      if (is_known(x, kernel)) {
        continue;
      }
      const int dimension = std::min(dimension_at(x, small_step), dimension_at(x, small_step / 8));
      if (dimension > 1) {
        components_.push_back(sample(x, dimension, kernel));
      } else if (dimension == 1) {
        const seven_coordinates along = difference(x, singular).normalized();
        components_.push_back(trace(x, along, kernel));
      }
    }
  }

  // Curves.

  /// Curve through one of its points: closed, or followed to both ends.
  ///
  /// \param leaving  direction of the curve at that point
  /// \param kernel   dimension of the Jacobian's null space on the curve
  [[nodiscard]] traced_curve trace(const seven_coordinates& start, const seven_coordinates& leaving,
                                   int kernel) const {
    traced_curve result{{start}, false, 1, kernel};
    const auto first = direction(null_space_at(start), leaving);
    if (!first || follow(result, *first)) {
      return result;
    }
    std::reverse(result.points.begin(), result.points.end());
    follow(result, -*first);
    return result;
  }

  /// True if a point of the set is on a curve.
  ///
  /// \param kernel  dimension of the Jacobian's null space at x
  [[nodiscard]] bool is_on_curve(const traced_curve& curve, const seven_coordinates& x,
                                 int kernel) const {
    const double same = curve.kernel == 1 && kernel == 1 ? same_regular : same_rough;
    const std::size_t n = curve.points.size(), segments = curve.is_closed ? n : n - 1;
    for (std::size_t k = 0; k < segments; ++k) {
      const seven_coordinates& a = curve.points[k];
      const seven_coordinates to_x = difference(x, a),
                              chord = difference(curve.points[(k + 1) % n], a);
      if (to_x.squaredNorm() > 4 * chord.squaredNorm()) {
        continue;
      }
      // If x is on the curve, it is the point of the curve that is nearest to x,
      // found along the chord.
      double fraction = std::clamp(to_x.dot(chord) / chord.squaredNorm(), 0., 1.);
      for (int round = 0; round < 8 && fraction > -.5 && fraction < 1.5; ++round) {
        const auto between = projected(moved(a, fraction * chord), resolution_);
        if (!between) {
          break;
        }
        const seven_coordinates residual = difference(x, *between);
        if (residual.norm() < same) {
          return true;
        }
        fraction += residual.dot(chord) / chord.squaredNorm();
      }
    }
    return difference(x, curve.points.front()).norm() < same;
  }

  struct continuation_step {
    seven_coordinates x, ahead; ///< new point, direction of the curve there
    double bend, length;        ///< deflection and length of the step
    bool is_crossing;           ///< true if the null space has more dimensions than on the curve
  };

  /// Unit vector of a null space that is nearest to the direction of the previous step; empty if
  /// that is nearly orthogonal to it.
  [[nodiscard]] static std::optional<seven_coordinates> direction(const null_space& basis,
                                                                  const seven_coordinates& before) {
    const seven_coordinates along = basis * (basis.transpose() * before);
    const double size = along.norm();
    return size > .1 ? std::optional<seven_coordinates>(along / size) : std::nullopt;
  }

  /// Step along the curve; empty if the curve does not continue in about the same direction.
  [[nodiscard]] std::optional<continuation_step> take_step(const seven_coordinates& x,
                                                           const seven_coordinates& along,
                                                           double step, int kernel) const {
    const auto next = projected(moved(x, step * along), resolution_);
    if (!next) {
      return {};
    }
    const seven_coordinates displacement = difference(*next, x);
    const auto basis = null_space_at(*next);
    const auto ahead = direction(basis, basis.cols() == 1 ? along : displacement.normalized());
    if (basis.cols() < kernel || !ahead || displacement.norm() > resolution_) {
      return {};
    }
    const double bend = (*ahead - along).norm();
    return bend < .3 ? std::optional<continuation_step>(
                           {*next, *ahead, bend, displacement.norm(), basis.cols() > kernel})
                     : std::nullopt;
  }

  /// Step past points where curves cross, if they are not too close to each other.
  [[nodiscard]] std::optional<continuation_step> step_past_crossing(const seven_coordinates& x,
                                                                    const seven_coordinates& along,
                                                                    double step, int kernel) const {
    auto result = take_step(x, along, step, kernel);
    for (const double fraction : {.62, .81, .38}) {
      if (!result || !result->is_crossing) {
        break;
      }
      const auto other = take_step(x, along, fraction * step, kernel);
      result = other && !other->is_crossing ? other : result;
    }
    return result;
  }

  /// Adds points until the curve returns to its first one.
  ///
  /// \return true if it does
  bool follow(traced_curve& curve, seven_coordinates along) const {
    constexpr double min_step = 1e-5, max_crossing = .6;
    const int max_points = int(400 / resolution_);
    const seven_coordinates start = curve.points.front(), leaving = along;
    double step = resolution_ / 2, crossing = 0;
    for (int k = 0; k < max_points && step > min_step; ++k) {
      const seven_coordinates last = curve.points.back();
      const auto next = step_past_crossing(last, along, step, curve.kernel);
      if (!next) {
        step *= .6; // not a half: structured curves cross at such fractions
        continue;
      }
      crossing = next->is_crossing ? crossing + next->length : 0;
      if (crossing > max_crossing) {
        return false; // it has reached a component of more dimensions
      }
      const seven_coordinates back = difference(start, last);
      const double remaining = back.dot(along);
      const bool is_back = curve.points.size() > 3 && remaining > 0 && remaining <= 1.5 * step &&
                           back.norm() < std::min(2 * remaining, resolution_) &&
                           along.dot(leaving) > .5;
      if (is_back) {
        curve.is_closed = true;
        return true;
      }
      curve.points.push_back(next->x);
      along = next->ahead;
      step = std::min(resolution_ / 2, next->bend < .1 ? 2 * step : step);
    }
    return false;
  }

  // Components of two and more dimensions.

  /// Up to 64 points of the component that contains x, as far from each other as they can be found.
  [[nodiscard]] traced_curve sample(const seven_coordinates& x, int dimension, int kernel) {
    constexpr std::size_t count = 64;
    constexpr int tries = 32;
    traced_curve result{{x}, false, dimension, kernel};
    auto& points = result.points;
    for (double separation = 2; separation > .05 && points.size() < count; separation *= .7) {
      for (int failed = 0; failed < tries && points.size() < count; ++failed) {
        const auto& from = points[std::size_t(random_() * double(points.size()))];
        const auto end = wander(from, std::numbers::pi * random_());
        const auto is_near = [&](const auto& p) { return difference(end, p).norm() < separation; };
        if (std::none_of(points.begin(), points.end(), is_near)) {
          points.push_back(end);
          failed = 0;
        }
      }
    }
    return result;
  }

  /// True if a walk on the component leads from x to one of the sample's points.
  [[nodiscard]] bool is_on_surface(const traced_curve& component, const seven_coordinates& x) {
    constexpr int detours = 4;
    bool result = leads_to_sample(component, x);
    for (int k = 0; k < detours && !result; ++k) {
      result = leads_to_sample(component, wander(x, std::numbers::pi * random_()));
    }
    return result;
  }

  /// True if a walk leads to one of the nearest points of a sample.
  [[nodiscard]] bool leads_to_sample(const traced_curve& component,
                                     const seven_coordinates& x) const {
    constexpr std::size_t max_count = 8;
    std::vector<seven_coordinates> nearest = component.points;
    std::sort(nearest.begin(), nearest.end(), [&](const auto& a, const auto& b) {
      return difference(a, x).norm() < difference(b, x).norm();
    });
    nearest.resize(std::min(max_count, nearest.size()));
    return std::any_of(nearest.begin(), nearest.end(),
                       [&](const auto& s) { return is_straight(x, s); }) ||
           std::any_of(nearest.begin(), nearest.end(), [&](const auto& s) { return leads(x, s); });
  }

  /// True if the straight line between two points is on the set.
  [[nodiscard]] bool is_straight(const seven_coordinates& x, const seven_coordinates& end) const {
    constexpr std::array parts{.07, .19, .31, .5, .62, .74, .83, .93};
    constexpr double close = 1e-7;
    const seven_coordinates direction = difference(end, x);
    return std::all_of(parts.begin(), parts.end(), [&](double part) {
      return tip_error(at(moved(x, part * direction))).norm() < close;
    });
  }

  /// Step on the component in a direction; empty if no step stays on it.
  [[nodiscard]] std::optional<seven_coordinates>
  walked(const seven_coordinates& x, const seven_coordinates& direction, double max_length) const {
    const auto basis = null_space_at(x);
    const seven_coordinates along = basis * (basis.transpose() * direction);
    const double size = along.norm();
    if (!(size > .1 * direction.norm())) {
      return {};
    }
    return projected(moved(x, std::min(1., max_length / size) * along), 2 * stride);
  }

  /// True if a walk towards `end` reaches it.
  [[nodiscard]] bool leads(seven_coordinates x, const seven_coordinates& end) const {
    constexpr int steps = 100;
    for (int k = 0; k < steps; ++k) {
      const seven_coordinates direction = difference(end, x);
      const double remaining = direction.norm();
      if (remaining < same_rough) {
        return true;
      }
      const auto next = walked(x, direction, stride);
      if (!next || !(difference(end, *next).norm() < .95 * remaining)) {
        return false;
      }
      x = *next;
    }
    return false;
  }

  /// End of a walk of a given length in a random direction.
  [[nodiscard]] seven_coordinates wander(seven_coordinates x, double length) {
    seven_coordinates direction = any_direction(null_space_at(x));
    for (; length > 0; length -= stride) {
      const auto next = walked(x, direction, std::min(length, stride));
      const seven_coordinates step = next ? difference(*next, x) : seven_coordinates::Zero();
      if (!(step.norm() > 0)) {
        break;
      }
      x = *next;
      direction = step.normalized();
    }
    return x;
  }

  static constexpr double start_step = .05,
                          small_step = .005; ///< steps from a singular point to others
  static constexpr double stride = .2;       ///< length of a step of a walk

  static constexpr double max_error = 1e-12;     ///< error of the pose on the set
  static constexpr double singular_ratio = 1e-5; ///< singular value, relative to the largest
  static constexpr double same_regular = 1e-6; ///< distance of coinciding points of regular curves
  static constexpr double same_rough = 1e-4;   ///< distance where the Jacobian is singular

  known_size_view<7> chain_;
  planning_model<8> model_;
  tip_pose goal_, scaled_goal_;
  seven_coordinates unit_; ///< 1 for angles, the arm's size for lengths
  double resolution_;
  splitmix64 random_{1};
  bool is_degenerate_ = false; ///< true if the tip pose is known to be singular
  std::array<std::vector<seven_coordinates>, 8> seeds_; ///< seeds by null-space dimension
  std::vector<traced_curve> components_;
};

} // namespace
} // namespace duet::detail

namespace duet {
DUET_ABI_BEGIN

std::vector<self_motion_curve> self_motion_curves(const chain_view& chain,
                                                  const dual_quaternion<double>& goal,
                                                  const self_motion_options& options) {
  detail::require_algebraic(chain, 7, "self_motion_curves");
  detail::require_pose(goal, "self_motion_curves", "the goal");
  detail::require_option("self_motion_curves", "resolution", options.resolution,
                         options.resolution > 0 && options.resolution <= 1, "within (0, 1]");
  detail::component_search search(chain, normalized(goal), options.resolution);
  std::vector<self_motion_curve> result;
  for (const detail::traced_curve& curve : search()) {
    result.push_back(
        {{curve.points.begin(), curve.points.end()}, curve.is_closed, curve.dimension});
  }
  return result;
}

DUET_ABI_END
} // namespace duet
