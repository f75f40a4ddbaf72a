// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "timing/path_velocity_constraints.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace duet::detail {
DUET_ABI_BEGIN

namespace {

/// Constraint |x| + beyond ≤ limit on a squared path velocity, with the derivatives of all three
/// with respect to its coefficients from `first` on. `order` n: limit of the n-th time derivative,
/// for velocities of their squares.
struct barrier_constraint {
  int order;
  std::optional<std::size_t> joint; ///< joint, if the constraint is of a single joint
  std::size_t first;
  double limit, beyond, x;
  const linear_form &limit_by, &beyond_by, &x_by;
};

/// Gradient of a function of the coefficients, and the band of its Hessian: (i, i), (i, i + 1) and
/// (i, i + 2).
struct barrier_newton_model {
  std::vector<double> gradient;
  std::vector<linear_form> matrix;

  explicit barrier_newton_model(std::size_t n) : gradient(n), matrix(n) {}
  /// Adds a function f of a linear form of the coefficients, given f' and f''.
  void add(std::size_t first, const linear_form& by, double derivative, double curvature) {
    for (std::size_t i = 0; i < 3; ++i) {
      gradient[first + i] += derivative * by[i];
      for (std::size_t j = i; j < 3; ++j) {
        matrix[first + i][j - i] += curvature * by[i] * by[j];
      }
    }
  }
  /// Keeps coefficient i constant.
  void fix(std::size_t i) {
    gradient[i] = 0;
    matrix[i] = {1, 0, 0};
    for (std::size_t k = 1; k < 3 && k <= i; ++k) {
      matrix[i - k][k] = 0;
    }
  }
  /// Newton step to the minimum of the model, by a factorisation L D Lᵀ of the matrix,
  /// which is overwritten.
  [[nodiscard]] std::vector<double> solution() {
    const std::size_t n = gradient.size();
    matrix[n - 1][1] = matrix[n - 1][2] = matrix[n - 2][2] = 0;
    std::vector<double> x(n + 2);
    for (std::size_t i = 0; i < n; ++i) {
      auto& [d, one, two] = matrix[i];
      x[i] -= gradient[i];
      if (i + 1 < n) {
        matrix[i + 1][0] -= one * one / d;
        matrix[i + 1][1] -= one * two / d;
      }
      if (i + 2 < n) {
        matrix[i + 2][0] -= two * two / d;
      }
      one /= d;
      two /= d;
      x[i + 1] -= one * x[i];
      x[i + 2] -= two * x[i];
    }
    x.resize(n);
    for (std::size_t i = n; i-- > 0;) {
      x[i] /= matrix[i][0];
      for (std::size_t k = 1; k < 3 && i + k < n; ++k) {
        x[i] -= matrix[i][k] * x[i + k];
      }
    }
    return x;
  }
};

/// Minimum-time squared path velocity b = τ̇² within limits by a primal log-barrier
/// (interior-point) method. Each iterate is feasible, so the search may stop at any time. A step is
/// a Newton step for weight · time − Σ log(margin to each limit), with those second derivatives
/// that may be negative left out, halved until it is feasible and decreases the objective.
///
/// A limit proportional to 1 / √p, with p = b, is replaced by (3 m − p) / (2 m √m), its tangent at
/// the value m of b in the middle of a segment, which is below it.
class log_barrier_solver {
public:
  /// Starts from a constant path velocity that is low enough: in a time k times as long,
  /// velocities, accelerations and jerks are smaller by k, k² and k³.
  ///
  /// \param bounds  constraints; must outlive the search
  /// \param ends    squared path velocities required at the ends, where joint velocities satisfy
  /// their limits; 0: free
  explicit log_barrier_solver(const path_velocity_constraints& bounds,
                              const std::array<double, 2>& ends = {0, 0})
      : bounds_(bounds), ends_(ends), squared_velocity_(bounds.pieces.back().first + 3, 1.0) {
    double stretch = 0;
    for_each_bound(squared_velocity_, [&](const barrier_constraint& b) {
      stretch = std::max(stretch, std::pow((std::abs(b.x) + b.beyond) / b.limit, 1.0 / b.order));
    });
    double slow = .7 / (stretch * stretch);
    for (const double end : ends_) {
      slow = end > 0 ? std::min(slow, end) : slow;
    }
    std::fill(squared_velocity_.begin(), squared_velocity_.end(), slow);
    is_attained_ = {ends_[0] == slow, ends_[1] == slow};
  }

  /// Phase one: raises the squared path velocities at the ends to the required values. Among all
  /// feasible ones, each together with those smaller by a common factor, those with the fastest
  /// ends are searched for.
  ///
  /// \return the fraction of the required value attained at each end; 1 where
  /// it is attained or free
  [[nodiscard]] std::array<double, 2> find_feasible_start() {
    double count = 0; // number of logarithms: for a convex set the fraction missing is count / lift
    for_each_bound(squared_velocity_, [&](const barrier_constraint&) { count += 2; });
    const auto missing = [&] {
      double result = 0;
      for (std::size_t e = 0; e < 2; ++e) {
        result = std::max(result, is_slow(e) ? 1 - squared_velocity_[end_of(e)] / ends_[e] : 0);
      }
      return result;
    };
    for (double lift = count / 64;
         are_ends_slow() && lift < 1e9 * count && count > .01 * lift * missing(); lift *= 4) {
      for (int steps = 0; steps < 60 && are_ends_slow() && step({0, lift}) > .1; ++steps) {
      }
    }
    return {is_slow(0) ? squared_velocity_.front() / ends_[0] : 1,
            is_slow(1) ? squared_velocity_.back() / ends_[1] : 1};
  }

  /// Joint whose acceleration and jerk limits are the nearest, summed over the path.
  [[nodiscard]] std::size_t nearest_joint() const {
    std::vector<double> sums(bounds_.joints.size() / bounds_.pieces.size());
    for_each_bound(squared_velocity_, [&](const barrier_constraint& b) {
      if (b.joint) {
        sums[*b.joint] += b.limit / (b.limit - b.beyond - std::abs(b.x));
      }
    });
    return std::size_t(std::max_element(sums.begin(), sums.end()) - sums.begin());
  }

  /// Coefficients of a nearly minimum-time squared path velocity: the margins to the limits that
  /// the barrier leaves cost about 10 / accuracy of the time. Ends that were not attained stay near
  /// their values.
  [[nodiscard]] const std::vector<double>& solve(double accuracy) {
    if (are_ends_slow()) {
      for (double& each : squared_velocity_) {
        each *= .95;
      }
      for (std::size_t e = 0; e < 2; ++e) {
        ends_[e] = ends_[e] > 0 ? squared_velocity_[end_of(e)] : 0;
      }
      is_attained_ = {true, true};
    }
    const double unit = double(bounds_.pieces.size()) / time(squared_velocity_);
    for (double weight = 40 * unit; weight < accuracy * unit; weight *= 4) {
      for (int steps = 0; steps < 60 && step({weight, 0}) > .1; ++steps) {
      }
    }
    return squared_velocity_;
  }

private:
  /// Weights of the objective without the logarithms: `time` · time − `lift` · Σ b / end.
  struct barrier_weights {
    double time, lift;
  };

  [[nodiscard]] std::size_t end_of(std::size_t e) const {
    return e == 0 ? 0 : squared_velocity_.size() - 1;
  }
  [[nodiscard]] bool is_slow(std::size_t e) const { return ends_[e] > 0 && !is_attained_[e]; }
  [[nodiscard]] bool are_ends_slow() const { return is_slow(0) || is_slow(1); }

  void for_each_bound(const std::vector<double>& squared_velocity, const auto& f) const {
    static constexpr linear_form zero{};
    const joint_bounds* joint = bounds_.joints.data();
    const std::size_t joints = bounds_.joints.size() / bounds_.pieces.size();
    for (const piece_bounds& piece : bounds_.pieces) {
      const double* c = &squared_velocity[piece.first];
      const linear_form row = middle_of(piece);
      const double m = times(row, c), scale = 1 / (m * std::sqrt(m));
      std::array<double, 4> limit;
      std::array<linear_form, 4> limit_by;
      for (std::size_t r = 0; r < 4; ++r) {
        const double p = times(piece.squared_velocity[r], c);
        limit[r] = (3 * m - p) * scale / 2;
        for (std::size_t i = 0; i < 3; ++i) {
          limit_by[r][i] = (1.5 * (p / m - 1) * row[i] - piece.squared_velocity[r][i]) * scale / 2;
        }
      }
      const bool is_first = &piece == &bounds_.pieces.front();
      const bool is_last = &piece == &bounds_.pieces.back();
      // At ends with a required velocity nothing remains to be optimised.
      for (std::size_t r = is_first && ends_[0] > 0; r + (is_last && ends_[1] > 0) < 10; ++r) {
        f(barrier_constraint{2,
                             {},
                             piece.first,
                             1,
                             0,
                             times(piece.square_rate[r], c),
                             zero,
                             zero,
                             piece.square_rate[r]});
      }
      for (std::size_t j = 0; j < joints; ++j, ++joint) {
        const double change = times(joint->beyond_acceleration, c);
        const double jerk = times(joint->beyond_jerk, c);
        for (std::size_t r = 0; r < 4; ++r) {
          const bool is_end = r == 0 || r == 3;
          f(barrier_constraint{2, j, piece.first, 1, is_end ? 0 : change,
                               times(joint->acceleration[r], c), zero,
                               is_end ? zero : joint->beyond_acceleration, joint->acceleration[r]});
          f(barrier_constraint{3, j, piece.first, limit[r], is_end ? 0 : jerk,
                               times(joint->jerk[r], c), limit_by[r],
                               is_end ? zero : joint->beyond_jerk, joint->jerk[r]});
        }
      }
    }
  }
  [[nodiscard]] static linear_form middle_of(const piece_bounds& piece) {
    linear_form result;
    for (std::size_t i = 0; i < 3; ++i) {
      result[i] = (piece.squared_velocity[0][i] +
                   3 * (piece.squared_velocity[1][i] + piece.squared_velocity[2][i]) +
                   piece.squared_velocity[3][i]) /
                  8;
    }
    return result;
  }
  void for_each_middle(const std::vector<double>& squared_velocity, const auto& f) const {
    for (const piece_bounds& piece : bounds_.pieces) {
      const linear_form row = middle_of(piece);
      f(piece, row, times(row, &squared_velocity[piece.first]));
    }
  }

  [[nodiscard]] double time(const std::vector<double>& squared_velocity) const {
    double result = 0;
    for_each_middle(squared_velocity, [&](const piece_bounds& piece, const linear_form&, double m) {
      result += piece.length / std::sqrt(m);
    });
    return result;
  }
  /// Weight of log(b) per limit proportional to 1 / √b, half a logarithm each: otherwise the
  /// margins to these limits would grow as the velocity falls.
  [[nodiscard]] double rooted_limits() const {
    return 4 * (double(bounds_.joints.size()) / double(bounds_.pieces.size()));
  }

  /// Objective with its barrier terms; infinite outside the feasible set.
  [[nodiscard]] double value(const std::vector<double>& squared_velocity,
                             barrier_weights weights) const {
    double sum = weights.time * time(squared_velocity), product = 1;
    for (std::size_t e = 0; e < 2; ++e) {
      sum -= is_slow(e) ? weights.lift * squared_velocity[end_of(e)] / ends_[e] : 0;
    }
    bool is_inside = true;
    const auto take = [&](double factor) {
      is_inside = is_inside && factor > 0;
      product *= factor;
      if (!(product > 1e-100 && product < 1e100)) {
        sum -= std::log(product);
        product = 1;
      }
    };
    std::for_each(squared_velocity.begin(), squared_velocity.end(), take);
    for_each_bound(squared_velocity, [&](const barrier_constraint& b) {
      const double limit = b.limit - b.beyond;
      is_inside = is_inside && limit > 0;
      take((limit - b.x) * (limit + b.x));
    });
    for_each_middle(squared_velocity, [&](const piece_bounds&, const linear_form&, double m) {
      sum -= rooted_limits() * std::log(m);
    });
    return is_inside ? sum - std::log(product) : std::numeric_limits<double>::infinity();
  }

  [[nodiscard]] barrier_newton_model model_of(barrier_weights weights) const {
    barrier_newton_model result(squared_velocity_.size());
    for (std::size_t i = 0; i < squared_velocity_.size(); ++i) {
      const double inverse = 1 / squared_velocity_[i];
      result.gradient[i] -= inverse;
      result.matrix[i][0] += inverse * inverse;
    }
    for_each_bound(squared_velocity_, [&](const barrier_constraint& b) {
      const double limit = b.limit - b.beyond;
      for (const int sign : {-1, 1}) {
        const double inverse = 1 / (limit + sign * b.x);
        linear_form by;
        for (std::size_t i = 0; i < 3; ++i) {
          by[i] = b.limit_by[i] - b.beyond_by[i] + sign * b.x_by[i];
        }
        result.add(b.first, by, -inverse, inverse * inverse);
      }
    });
    for_each_middle(squared_velocity_,
                    [&](const piece_bounds& piece, const linear_form& row, double m) {
                      const double by_time = weights.time * piece.length / (2 * m * std::sqrt(m));
                      result.add(piece.first, row, -by_time - rooted_limits() / m,
                                 (1.5 * by_time + rooted_limits() / m) / m);
                    });
    for (std::size_t e = 0; e < 2; ++e) {
      if (is_slow(e)) {
        result.gradient[end_of(e)] -= weights.lift / ends_[e];
      } else if (ends_[e] > 0) {
        result.fix(end_of(e));
      }
    }
    return result;
  }

  /// Takes one Newton step with a backtracking line search.
  ///
  /// \return twice the decrease that the model predicts; 0 if no step is found
  double step(barrier_weights weights) {
    barrier_newton_model model = model_of(weights);
    const std::vector<double> gradient = model.gradient, newton_step = model.solution();
    double decrease = 0;
    for (std::size_t i = 0; i < newton_step.size(); ++i) {
      decrease -= gradient[i] * newton_step[i];
    }
    // Step length at which an end attains its required value.
    std::array<double, 2> arrival{2, 2};
    for (std::size_t e = 0; e < 2; ++e) {
      const std::size_t i = end_of(e);
      if (is_slow(e) && squared_velocity_[i] + newton_step[i] >= ends_[e]) {
        arrival[e] = (ends_[e] - squared_velocity_[i]) / newton_step[i];
      }
    }
    const double before = value(squared_velocity_, weights);
    std::vector<double> next(newton_step.size());
    for (double fraction = std::min({1.0, arrival[0], arrival[1]}); fraction > 1e-6;
         fraction /= 2) {
      for (std::size_t i = 0; i < newton_step.size(); ++i) {
        next[i] = squared_velocity_[i] + fraction * newton_step[i];
      }
      if (value(next, weights) < before - 1e-3 * fraction * decrease) {
        squared_velocity_ = next;
        for (std::size_t e = 0; e < 2; ++e) {
          if (fraction == arrival[e]) {
            squared_velocity_[end_of(e)] = ends_[e];
            is_attained_[e] = true;
          }
        }
        return decrease;
      }
    }
    return 0;
  }

  const path_velocity_constraints& bounds_;
  std::array<double, 2> ends_;
  std::array<bool, 2> is_attained_{};
  std::vector<double> squared_velocity_;
};

} // namespace

path_velocity_result minimum_time_path_velocity(const path_velocity_constraints& bounds,
                                                const std::array<double, 2>& ends,
                                                double accuracy) {
  log_barrier_solver search(bounds, ends);
  path_velocity_result result;
  result.reached = search.find_feasible_start();
  result.nearest_joint = search.nearest_joint();
  result.coefficients = search.solve(accuracy);
  return result;
}

DUET_ABI_END
} // namespace duet::detail
