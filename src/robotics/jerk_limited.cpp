// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "timed_curve.hpp"

#include <duet/core/errors.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace duet::detail {
DUET_ABI_BEGIN

namespace {

/// Polynomial of degree at most nine in u, 0 ≤ u ≤ 1, by its powers.
struct piece_polynomial {
  std::array<double, 10> of{};

  friend piece_polynomial operator+(piece_polynomial p, const piece_polynomial& q) {
    for (std::size_t i = 0; i < 10; ++i) {
      p.of[i] += q.of[i];
    }
    return p;
  }
  friend piece_polynomial operator*(double x, piece_polynomial p) {
    for (double& each : p.of) {
      each *= x;
    }
    return p;
  }
  friend piece_polynomial operator*(const piece_polynomial& p, const piece_polynomial& q) {
    piece_polynomial result;
    for (std::size_t i = 0; i < 10; ++i) {
      for (std::size_t j = 0; p.of[i] != 0 && i + j < 10; ++j) {
        result.of[i + j] += p.of[i] * q.of[j];
      }
    }
    return result;
  }
};

/// Cubic polynomial by its Bernstein coefficients, with the amount by which the middle two have to
/// be moved up and down to enclose another polynomial.
struct cubic_approximation {
  std::array<double, 4> at{};
  double error = 0;

  cubic_approximation() = default;
  /// Interpolates a polynomial at 0, 1/3, 2/3 and 1. The difference, with Bernstein coefficients
  /// e_j, e_0 = e_9 = 0, is u (1 − u) Σ 72 / (j (9 − j)) e_j B_{j−1}(u) with those of seventh
  /// degree, and the middle two coefficients are multiplied by 3 u (1 − u).
  explicit cubic_approximation(piece_polynomial p) {
    double end = 0, third = 0, two_thirds = 0;
    for (std::size_t i = 10; i-- > 0;) {
      end += p.of[i];
      third = third / 3 + p.of[i];
      two_thirds = two_thirds * 2 / 3 + p.of[i];
    }
    const double start = p.of[0];
    at = {start, 3 * third - 1.5 * two_thirds + end / 3 - 5 * start / 6,
          3 * two_thirds - 1.5 * third + start / 3 - 5 * end / 6, end};
    p.of[0] = 0;
    p.of[1] -= 3 * (at[1] - at[0]);
    p.of[2] -= 3 * (at[0] - 2 * at[1] + at[2]);
    p.of[3] -= at[3] - at[0] + 3 * (at[1] - at[2]);
    for (std::size_t j = 1; j < 9; ++j) {
      double sum = 0, share = 1; // binomial(j, i) / binomial(9, i)
      for (std::size_t i = 0; i <= j; ++i) {
        sum += share * p.of[i];
        share *= double(j - i) / double(9 - i);
      }
      error = std::max(error, 24.0 / double(j * (9 - j)) * std::abs(sum));
    }
  }
};

/// Smallest number from `low` to 1 at which an increasing function is not below
/// a value, by bisection.
double crossing(const auto& f, double value, double low) {
  double high = 1;
  for (double middle; middle = (low + high) / 2, low < middle && middle < high;) {
    (f(middle) < value ? low : high) = middle;
  }
  return high;
}

} // namespace

reference_parametrisation::reference_parametrisation(const std::vector<double>& arc_lengths,
                                                     ends_at_rest rest) {
  const std::size_t n = arc_lengths.size() - 1;
  c_.assign(n + 3, arc_lengths.back());
  std::fill_n(c_.begin(), 3, arc_lengths.front());
  const std::size_t first = rest.first ? 2 : 1, last = rest.last ? n - 2 : n - 1;
  for (std::size_t i = first; i <= last; ++i) {
    // Subtracting a sixth of the second difference reproduces cubic polynomials.
    const double before = arc_lengths[i] - arc_lengths[i - 1],
                 after = arc_lengths[i + 1] - arc_lengths[i];
    c_[i + 1] = arc_lengths[i] - std::clamp((after - before) / 6, -after / 2, before / 2);
  }
  if (!rest.first) {
    advance(arc_lengths[0], arc_lengths[1], arc_lengths[2], c_[2], c_[1], c_[0]);
  }
  if (!rest.last) {
    advance(arc_lengths[n], arc_lengths[n - 1], arc_lengths[n - 2], c_[n], c_[n + 1], c_[n + 2]);
  }
}

std::vector<reference_piece>
reference_parametrisation::pieces(const std::vector<double>& knots) const {
  std::vector<reference_piece> result;
  std::size_t edge = 0;
  for (std::size_t k = 0; k + 3 < c_.size(); ++k) {
    const auto [p_0, p_1, p_2, p_3] = powers(k);
    const auto arc_length = [p_0 = p_0, p_1 = p_1, p_2 = p_2, p_3 = p_3](double t) {
      return p_0 + t * (p_1 + t * (p_2 + t * p_3));
    };
    for (double from = 0; from < 1;) {
      const bool is_last = edge + 2 == knots.size();
      const double end = knots[edge + 1];
      const double to = is_last || arc_length(1) <= end ? 1 : crossing(arc_length, end, from);
      if (to > from) {
        result.push_back({edge, k, from, to - from,
                          std::clamp(arc_length(from) - knots[edge], 0.0, end - knots[edge]),
                          p_1 + from * (2 * p_2 + 3 * from * p_3), p_2 + 3 * from * p_3, p_3});
      }
      edge += !is_last && (to < 1 || arc_length(1) >= end);
      from = to;
    }
  }
  return result;
}

void reference_parametrisation::advance(double p_0, double p_1, double p_2, double c_2, double& c_1,
                                        double& c_0) {
  // The differences have one sign. ds/dτ at the end is c_2 + 2 c_1 − 3 p_0: at least a twentieth
  // of c_2 − p_0 remains.
  const double near_end = p_1 - p_0, next = p_2 - p_1, max_bend = 2.85 * (c_2 - p_0);
  const double bend = std::clamp((next - near_end) / near_end, -.5, max_bend / near_end) * near_end;
  c_1 = p_0 - bend / 6;
  c_0 = 6 * p_0 - 4 * c_1 - c_2;
}

std::array<double, 4> reference_parametrisation::powers(std::size_t k) const {
  const double d_0 = c_[k + 1] - c_[k], d_1 = c_[k + 2] - c_[k + 1], d_2 = c_[k + 3] - c_[k + 2];
  return {c_[k + 1] + (d_1 - d_0) / 6, (d_0 + d_1) / 2, (d_1 - d_0) / 2, (d_2 - 2 * d_1 + d_0) / 6};
}

namespace {

/// Bernstein coefficients of p u² for cubic polynomials u and p given by theirs; those of p are
/// linear forms.
std::array<linear_form, 10> times_square(const std::array<linear_form, 4>& p,
                                         const std::array<double, 4>& u) {
  constexpr std::array<double, 4> of_3{1, 3, 3, 1}; // binomial coefficients
  constexpr std::array<double, 10> of_9{1, 9, 36, 84, 126, 126, 84, 36, 9, 1};
  std::array<linear_form, 10> result{};
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < 4; ++b) {
      for (std::size_t r = 0; r < 4; ++r) {
        const double factor = of_3[a] * of_3[b] * of_3[r] / of_9[a + b + r] * u[a] * u[b];
        for (std::size_t i = 0; i < 3; ++i) {
          result[a + b + r][i] += factor * p[r][i];
        }
      }
    }
  }
  return result;
}

} // namespace

std::array<linear_form, 3> path_velocity_powers(std::size_t k, std::size_t intervals) {
  const linear_form start = k == 0 ? linear_form{1, 0, 0} : linear_form{.5, .5, 0};
  const linear_form end = k + 1 == intervals ? linear_form{0, 0, 1} : linear_form{0, .5, .5};
  std::array<linear_form, 3> result{start, {}, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    const double middle = i == 1 ? 1 : 0;
    result[1][i] = 2 * (middle - start[i]);
    result[2][i] = start[i] - 2 * middle + end[i];
  }
  return result;
}

path_velocity_constraints::path_velocity_constraints(const std::vector<joint_cubic>& curve,
                                                     const std::vector<reference_piece>& path,
                                                     std::size_t intervals,
                                                     const Eigen::VectorXd& velocity,
                                                     const Eigen::VectorXd& acceleration,
                                                     const Eigen::VectorXd& jerk) {
  pieces.reserve(path.size());
  joints.reserve(path.size() * std::size_t(velocity.size()));
  for (const reference_piece& piece : path) {
    add(curve[piece.edge], piece, intervals, velocity, acceleration, jerk);
  }
}

void path_velocity_constraints::add(const joint_cubic& q, const reference_piece& piece,
                                    std::size_t intervals, const Eigen::VectorXd& velocity,
                                    const Eigen::VectorXd& acceleration,
                                    const Eigen::VectorXd& jerk) {
  using polynomial = piece_polynomial;
  const double l = piece.length, f = piece.from;
  // With x = s − start: q' = p_0 + p_1 x + p_2 x² / 2, q'' = p_1 + p_2 x, q''' = p_2.
  const std::array<Eigen::VectorXd, 3> p{q.first(piece.start), q.second(piece.start),
                                         Eigen::VectorXd(6 * q.c3)};
  const polynomial offset{{0, piece.a * l, piece.b * l * l, piece.c * l * l * l}};
  const polynomial slope{{piece.a, 2 * piece.b * l, 3 * piece.c * l * l}};
  const polynomial bend{{2 * piece.b, 6 * piece.c * l}};
  const polynomial half_square = .5 * (offset * offset);

  // Factors of p_0, p_1 and p_2; those of accelerations and jerks for each coefficient.
  const std::array rates{cubic_approximation(slope), cubic_approximation(offset * slope),
                         cubic_approximation(half_square * slope)};
  std::array<std::array<cubic_approximation, 3>, 3> changes, jerks;
  piece_bounds bounds{piece.interval, l, {}, {}};
  const auto b = path_velocity_powers(piece.interval, intervals);
  for (std::size_t i = 0; i < 3; ++i) {
    const double start = b[0][i] + f * (b[1][i] + f * b[2][i]);
    const double rise = b[1][i] + 2 * f * b[2][i], curvature = b[2][i];
    bounds.squared_velocity[0][i] = start;
    bounds.squared_velocity[1][i] = start + rise * l / 3;
    bounds.squared_velocity[2][i] = start + l * (2 * rise + l * curvature) / 3;
    bounds.squared_velocity[3][i] = start + l * (rise + l * curvature);
    const polynomial squared_velocity{{start, rise * l, curvature * l * l}};
    const polynomial half_rise{{rise / 2, curvature * l}};
    const polynomial square = slope * slope * squared_velocity;
    const polynomial change = bend * squared_velocity + slope * half_rise;
    const polynomial both = 3 * (slope * change);
    const polynomial third =
        6 * piece.c * squared_velocity + 3 * (bend * half_rise) + curvature * slope;
    changes[i] = {cubic_approximation(change), cubic_approximation(square + offset * change),
                  cubic_approximation(offset * square + half_square * change)};
    jerks[i] = {cubic_approximation(third), cubic_approximation(both + offset * third),
                cubic_approximation(slope * square + offset * both + half_square * third)};
  }
  std::array<double, 4> largest_rate{};
  for (Eigen::Index j = 0; j < velocity.size(); ++j) {
    joint_bounds rows;
    double beyond = 0;
    std::array<double, 4> rate{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double factor = p[k][j], size = std::abs(factor);
      for (std::size_t r = 0; r < 4; ++r) {
        rate[r] += factor * rates[k].at[r];
      }
      beyond += size * rates[k].error;
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t r = 0; r < 4; ++r) {
          rows.acceleration[r][i] += factor * changes[i][k].at[r] / acceleration[j];
          rows.jerk[r][i] += factor * jerks[i][k].at[r] / jerk[j];
        }
        rows.beyond_acceleration[i] += size * changes[i][k].error / acceleration[j];
        rows.beyond_jerk[i] += size * jerks[i][k].error / jerk[j];
      }
    }
    for (std::size_t r = 0; r < 4; ++r) {
      const double size = std::abs(rate[r]) + (r == 1 || r == 2 ? beyond : 0);
      largest_rate[r] = std::max(largest_rate[r], size / velocity[j]);
    }
    joints.push_back(rows);
  }
  bounds.square_rate = times_square(bounds.squared_velocity, largest_rate);
  pieces.push_back(bounds);
}

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

namespace {

/// Time ∫ dτ / τ̇ over an interval of τ on which the squared path velocity τ̇² is a
/// quadratic polynomial.
[[nodiscard]] double time_over(double length, double first_rate, double last_rate,
                               double curvature) {
  const double half = length / (first_rate + last_rate);
  const double omega = std::sqrt(std::abs(curvature)), angle = omega * half;
  const double ratio = angle < 1e-9    ? 1
                       : curvature > 0 ? std::atanh(angle) / angle
                                       : std::atan(angle) / angle;
  return 2 * half * ratio;
}

/// Checks that second derivatives of a curve are continuous, as finite jerks require.
///
/// \throws invalid_input where second derivatives jump
void require_smooth(const time_parametrisation_input& problem,
                    const std::vector<joint_cubic>& curve) {
  for (std::size_t k = 1; k < curve.size(); ++k) {
    const auto &before = curve[k - 1], &after = curve[k];
    const auto jump = (after.second(0) - before.second(before.length)).eval();
    Eigen::Index joint = 0;
    const double largest = jump.cwiseAbs().maxCoeff(&joint);
    if (largest * std::min(before.length, after.length) > 1e-9) {
      const auto& at = problem.polygon.waypoint_s;
      const auto waypoint =
          std::lower_bound(at.begin(), at.end(), problem.polygon.s[k]) - at.begin();
      raise(invalid_input(
          message("duet: time_optimal_trajectory: the second derivative of joint ", joint,
                  " jumps at waypoint ", waypoint,
                  " (with jerk limits expected continuous, as of "
                  "waypoint_interpolation::natural_cubic if no joint leaves its range)")));
    }
  }
}

/// Velocities of all joints at the first and the last end of a curve.
[[nodiscard]] std::array<Eigen::VectorXd, 2>
end_velocities(const time_parametrisation_input& problem, const std::vector<joint_cubic>& curve) {
  const auto& last = curve.back();
  return {problem.initial_speed * curve.front().first(0),
          problem.final_speed * last.first(last.length)};
}

/// Checks the joint velocities at both ends against their limits.
///
/// \throws invalid_input for a velocity at an end that exceeds its limit by more than round-off
void require_feasible_ends(const time_parametrisation_input& problem,
                           const std::vector<joint_cubic>& curve) {
  const auto velocities = end_velocities(problem, curve);
  for (const bool is_last : {false, true}) {
    for (Eigen::Index i = 0; i < problem.velocity.size(); ++i) {
      require(std::abs(velocities[is_last][i]) <= problem.velocity[i] * (1 + 1e-12),
              "duet: time_optimal_trajectory: the ", is_last ? "final" : "initial",
              " velocity of joint ", i, " is ", velocities[is_last][i], " (expected at most ",
              problem.velocity[i], " in absolute value)");
    }
  }
}

/// Result of a search for a squared path velocity within velocity, acceleration and jerk limits.
struct jerk_search_result {
  timed_path motion;
  std::array<double, 2> reached{}; ///< fraction of the velocity at each end; 1: attained
  std::size_t nearest_joint = 0;   ///< joint whose limits are the nearest

  /// End at which the smaller fraction of the velocities is attained.
  [[nodiscard]] std::size_t end() const { return reached[1] < reached[0]; }
  [[nodiscard]] bool is_feasible() const { return reached[end()] == 1; }
};

/// Near-minimum-time trajectory within velocity, acceleration and jerk limits. Its squared path
/// velocity is a B-spline of a parameter τ that is proportional to the time of another motion, in a
/// given number of intervals.
///
/// \param motion    motion that defines τ
/// \param accuracy  as of `minimum_time_path_velocity`
[[nodiscard]] jerk_search_result timed_by_jerks(const time_parametrisation_input& problem,
                                                const std::vector<joint_cubic>& curve,
                                                const timed_path& motion, std::size_t intervals,
                                                double accuracy) {
  const auto& knots = problem.polygon.s;
  const std::array<double, 2> speeds{problem.initial_speed, problem.final_speed};
  const reference_parametrisation reference(arc_lengths_of(motion, intervals, knots.back()),
                                            {speeds[0] == 0, speeds[1] == 0});
  const auto path = reference.pieces(knots);
  const path_velocity_constraints bounds(curve, path, intervals, problem.velocity,
                                         problem.acceleration, problem.jerk);
  std::array<double, 2> ends{};
  for (std::size_t e = 0; e < 2; ++e) {
    const double rate = speeds[e] / (e == 0 ? reference.first_slope() : reference.last_slope());
    ends[e] = speeds[e] > 0 ? rate * rate : 0;
  }
  const path_velocity_result velocities = minimum_time_path_velocity(bounds, ends, accuracy);
  jerk_search_result result;
  result.reached = {std::sqrt(velocities.reached[0]), std::sqrt(velocities.reached[1])};
  result.nearest_joint = velocities.nearest_joint;
  result.motion = trajectory_from_path_velocity(curve, path, intervals, velocities.coefficients);
  return result;
}

/// Search for motions within jerk limits with given velocities at both ends. It proceeds from a
/// motion with small accelerations by successive refinement, each result being the initial guess
/// (warm start) of the next. If that fails it starts with jerk limits relaxed until it succeeds and
/// tightens them step by step, so that the velocities at the ends are right throughout.
class jerk_search {
public:
  jerk_search(const time_parametrisation_input& problem, const std::vector<joint_cubic>& curve)
      : problem_(problem), curve_(curve), gentle_(min_acceleration_motion(problem, curve)) {}

  /// Motion within the limits; empty if none is found.
  [[nodiscard]] std::optional<timed_path> run() {
    std::optional<timed_path> result;
    timed_path last = gentle_;
    for (const double divisor : {6, 3, 2}) {
      auto next = find(last, divisor, 1);
      if (next.is_feasible()) {
        result = next.motion;
      } else if (next.reached[next.end()] > nearest_.reached[nearest_.end()]) {
        nearest_ = next;
      }
      last = std::move(next.motion);
    }
    return result ? result : narrowed();
  }
  /// Motion that comes nearest, among those that violate the limits.
  [[nodiscard]] const jerk_search_result& nearest() const { return nearest_; }

private:
  /// Searches with jerk limits multiplied by `scale`, coarsely if that is not 1.
  [[nodiscard]] jerk_search_result find(const timed_path& from, double divisor, double scale) {
    time_parametrisation_input loose = problem_;
    loose.jerk *= scale;
    return timed_by_jerks(loose, curve_, from,
                          std::size_t(std::max(16.0, problem_.parts / divisor)),
                          scale > 1 ? 200 : 5e4);
  }
  [[nodiscard]] std::optional<timed_path> narrowed() {
    double scale = 2;
    auto last = find(gentle_, 3, scale);
    while (!last.is_feasible() && scale < 1e4) {
      scale *= 2;
      last = find(gentle_, 3, scale);
    }
    for (double step = 1.5; last.is_feasible() && step > 1.01;) {
      const double narrower = std::max(1.0, scale / step);
      auto next = find(last.motion, 2, narrower);
      if (!next.is_feasible()) {
        next = find(last.motion, 1, narrower);
      }
      if (!next.is_feasible()) {
        step = std::sqrt(step);
      } else if (narrower == 1) {
        return next.motion;
      } else {
        scale = narrower;
        last = std::move(next);
      }
    }
    return {};
  }

  const time_parametrisation_input& problem_;
  const std::vector<joint_cubic>& curve_;
  timed_path gentle_;
  jerk_search_result nearest_;
};

} // namespace

std::vector<double> arc_lengths_of(const timed_path& path, std::size_t n, double length) {
  std::vector<double> result;
  std::size_t at = 0;
  double s = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = path.duration * double(i) / double(n);
    for (; at + 1 < path.pieces.size() && path.pieces[at + 1].scaling.time <= t; ++at) {
      s += path.pieces[at].path.length;
    }
    const auto& [scaling, edge] = path.pieces[at];
    result.push_back(std::min(s + scaling.at(t, edge.length).s, length));
  }
  result.push_back(length);
  return result;
}

timed_path trajectory_from_path_velocity(const std::vector<joint_cubic>& curve,
                                         const std::vector<reference_piece>& path, std::size_t n,
                                         const std::vector<double>& squared_velocity) {
  timed_path result;
  result.pieces.reserve(path.size());
  for (const auto& [edge, interval, from, l, start, a, b, c] : path) {
    const auto rows = path_velocity_powers(interval, n);
    const double* of = &squared_velocity[interval];
    const double curvature = times(rows[2], of), rise = times(rows[1], of) + 2 * from * curvature;
    const double before = times(rows[0], of) + from * (times(rows[1], of) + from * curvature);
    const double rate = std::sqrt(before),
                 end_rate = std::sqrt(before + l * (rise + l * curvature));
    result.pieces.push_back({{result.duration, rate, rise / 2, curvature, a, b, c},
                             curve[edge].part(start, l * (a + l * (b + l * c)))});
    result.duration += time_over(l, rate, end_rate, curvature);
  }
  return result;
}

timed_path timed_within_jerks(const time_parametrisation_input& problem,
                              const std::vector<joint_cubic>& curve) {
  require_smooth(problem, curve);
  require_feasible_ends(problem, curve);
  jerk_search search(problem, curve);
  if (auto result = search.run()) {
    return *result;
  }
  const auto& nearest = search.nearest();
  const std::size_t end = nearest.end(), joint = nearest.nearest_joint;
  raise(invalid_input(message("duet: time_optimal_trajectory: the ", end == 0 ? "initial" : "final",
                              " velocities are too large for the limits (expected at most ",
                              std::floor(1e4 * nearest.reached[end]) / 1e4, " of them; joint ",
                              joint, ", with the velocity ",
                              end_velocities(problem, curve)[end][Eigen::Index(joint)],
                              ", is nearest to its limits)")));
}

DUET_ABI_END
} // namespace duet::detail
