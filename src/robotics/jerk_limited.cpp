// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "timed_curve.hpp"

#include <duet/core/errors.hpp>
#include <duet/spline/blocks.hpp>

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
using piece_polynomial = Eigen::Matrix<double, 10, 1>;

[[nodiscard]] piece_polynomial polynomial(const std::array<double, 4>& powers) {
  piece_polynomial result = piece_polynomial::Zero();
  result.head<4>() = Eigen::Map<const Eigen::Vector4d>(powers.data());
  return result;
}
[[nodiscard]] piece_polynomial product(const piece_polynomial& p, const piece_polynomial& q) {
  piece_polynomial result = piece_polynomial::Zero();
  for (Eigen::Index i = 0; i < 10; ++i) {
    if (p[i] != 0) {
      result.tail(10 - i) += p[i] * q.head(10 - i);
    }
  }
  return result;
}

/// Cubic polynomial by its Bernstein coefficients, with the amount by which the middle two have to
/// be moved up and down to enclose another polynomial.
struct cubic_approximation {
  Eigen::Vector4d at;
  double error = 0;

  /// Interpolates a polynomial at 0, 1/3, 2/3 and 1. The difference, with Bernstein coefficients
  /// e_j, e_0 = e_9 = 0, is u (1 − u) Σ 72 / (j (9 − j)) e_j B_{j−1}(u) with those of seventh
  /// degree, and the middle two coefficients are multiplied by 3 u (1 − u).
  explicit cubic_approximation(piece_polynomial p) {
    double end = 0, third = 0, two_thirds = 0;
    for (int i = 10; i-- > 0;) {
      end += p[i];
      third = third / 3 + p[i];
      two_thirds = two_thirds * 2 / 3 + p[i];
    }
    const double start = p[0];
    at << start, 3 * third - 1.5 * two_thirds + end / 3 - 5 * start / 6,
        3 * two_thirds - 1.5 * third + start / 3 - 5 * end / 6, end;
    p[0] = 0;
    p[1] -= 3 * (at[1] - at[0]);
    p[2] -= 3 * (at[0] - 2 * at[1] + at[2]);
    p[3] -= at[3] - at[0] + 3 * (at[1] - at[2]);
    for (int j = 1; j < 9; ++j) {
      double sum = 0, share = 1; // binomial(j, i) / binomial(9, i)
      for (int i = 0; i <= j; ++i) {
        sum += share * p[i];
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

/// Computes the last two coefficients c_1 and c_0 of a reference parametrisation at an end in
/// motion at p_0, from the next two positions and the coefficient before them.
void advance(double p_0, double p_1, double p_2, double c_2, double& c_1, double& c_0) {
  // The differences have one sign. ds/dτ at the end is c_2 + 2 c_1 − 3 p_0: at least a twentieth
  // of c_2 − p_0 remains.
  const double near_end = p_1 - p_0, next = p_2 - p_1, max_bend = 2.85 * (c_2 - p_0);
  const double bend = std::clamp((next - near_end) / near_end, -.5, max_bend / near_end) * near_end;
  c_1 = p_0 - bend / 6;
  c_0 = 6 * p_0 - 4 * c_1 - c_2;
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
    // s by powers of τ − k.
    const double d_0 = c_[k + 1] - c_[k], d_1 = c_[k + 2] - c_[k + 1], d_2 = c_[k + 3] - c_[k + 2];
    const double p_0 = c_[k + 1] + (d_1 - d_0) / 6, p_1 = (d_0 + d_1) / 2, p_2 = (d_1 - d_0) / 2,
                 p_3 = (d_2 - 2 * d_1 + d_0) / 6;
    const auto arc_length = [&](double t) { return p_0 + t * (p_1 + t * (p_2 + t * p_3)); };
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

namespace {

/// Polynomial in τ − k, by the columns for its powers, of a squared path velocity in interval k.
/// The latter is a quadratic B-spline whose outer coefficients are its values at the ends.
Eigen::Matrix3d path_velocity_powers(std::size_t k, std::size_t intervals) {
  const Eigen::Vector3d start = k == 0 ? Eigen::Vector3d(1, 0, 0) : Eigen::Vector3d(.5, .5, 0),
                        middle = Eigen::Vector3d::UnitY(),
                        end = k + 1 == intervals ? Eigen::Vector3d(0, 0, 1)
                                                 : Eigen::Vector3d(0, .5, .5);
  Eigen::Matrix3d result;
  result << start, 2 * (middle - start), start - 2 * middle + end;
  return result;
}

/// Linear forms of the three B-spline coefficients of the squared path velocity that are active in
/// a segment, as columns.
template <int Count>
using linear_forms = Eigen::Matrix<double, 3, Count>;

/// Bernstein coefficients of p u² for cubic polynomials u and p given by theirs; those of p are
/// linear forms.
linear_forms<10> times_square(const linear_forms<4>& p, const Eigen::Array4d& u) {
  constexpr std::array<double, 4> of_3{1, 3, 3, 1}; // binomial coefficients
  constexpr std::array<double, 10> of_9{1, 9, 36, 84, 126, 126, 84, 36, 9, 1};
  linear_forms<10> result = linear_forms<10>::Zero();
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < 4; ++b) {
      for (std::size_t r = 0; r < 4; ++r) {
        result.col(Eigen::Index(a + b + r)) += of_3[a] * of_3[b] * of_3[r] / of_9[a + b + r] *
                                               u[int(a)] * u[int(b)] * p.col(Eigen::Index(r));
      }
    }
  }
  return result;
}

/// Constraints |x c| ≤ limit of one joint, relative to its limits: accelerations, and jerks divided
/// by τ̇, by their four Bernstein coefficients in a segment. `beyond` c bounds the error of the
/// middle two; the outer ones are values at the ends.
struct joint_bounds {
  linear_forms<4> acceleration, jerk;
  Eigen::Vector3d beyond_acceleration, beyond_jerk;
};

/// Bernstein coefficients in a segment of the squared path velocity, and of the square of the
/// largest joint velocity relative to its limit.
struct piece_bounds {
  std::size_t first; ///< index of the coefficient that c[0] is
  double length;     ///< length of the segment in τ
  linear_forms<4> squared_velocity = linear_forms<4>::Zero();
  Eigen::Vector3d middle = Eigen::Vector3d::Zero(); ///< squared path velocity in the middle
  linear_forms<10> square_rate = linear_forms<10>::Zero();
};

/// Constraints on a squared path velocity b = τ̇² that is a quadratic B-spline of τ
/// with positive coefficients, one more than nodes of τ; the outer ones are its values at
/// the ends. Joint velocities are q' s' √b with s' = ds/dτ; accelerations and jerks /
/// √b are linear in it:
///
///     q̈     = q'' s'² b + q' change,               change = s̈ = s'' b + s' b' / 2
///     q⃛ / τ̇ = q''' s'³ b + 3 q'' s' change + q' third,
///     third  = s''' b + 3/2 s'' b' + s' b'' / 2
struct path_velocity_constraints {
  std::vector<piece_bounds> pieces;
  std::vector<joint_bounds> joints; ///< constraints of each segment, one per joint

  /// Collects the constraints of all segments of a path.
  ///
  /// \param intervals  number of intervals of τ
  path_velocity_constraints(const std::vector<joint_cubic>& curve,
                            const std::vector<reference_piece>& path, std::size_t intervals,
                            const Eigen::VectorXd& velocity, const Eigen::VectorXd& acceleration,
                            const Eigen::VectorXd& jerk) {
    pieces.reserve(path.size());
    joints.reserve(path.size() * std::size_t(velocity.size()));
    for (const auto& [edge, interval, f, l, begin, a, b, c] : path) {
      // With x = s − start: q' = p_0 + p_1 x + p_2 x² / 2, q'' = p_1 + p_2 x, q''' = p_2.
      const joint_cubic& q = curve[edge];
      Eigen::Matrix<double, Eigen::Dynamic, 3> p(velocity.size(), 3);
      p << q.first(begin), q.second(begin), 6 * q.c3;
      const auto offset = polynomial({0, a * l, b * l * l, c * l * l * l}),
                 slope = polynomial({a, 2 * b * l, 3 * c * l * l}),
                 bend = polynomial({2 * b, 6 * c * l}),
                 half_square = piece_polynomial(.5 * product(offset, offset));
      // Factors of p_0, p_1 and p_2; those of accelerations and jerks for each coefficient.
      Eigen::Matrix<double, 4, 3> rates;
      Eigen::Vector3d rate_errors;
      std::array<linear_forms<4>, 3> changes, jerks;
      Eigen::Matrix3d change_errors, jerk_errors;
      const auto set_rate = [&](int k, const piece_polynomial& of) {
        const cubic_approximation cubic(of);
        rates.col(k) = cubic.at;
        rate_errors[k] = cubic.error;
      };
      set_rate(0, slope);
      set_rate(1, product(offset, slope));
      set_rate(2, product(half_square, slope));
      piece_bounds bounds{interval, l};
      const Eigen::Matrix3d powers = path_velocity_powers(interval, intervals);
      for (int i = 0; i < 3; ++i) {
        const double curvature = powers(i, 2), rise = powers(i, 1) + 2 * f * curvature,
                     start = powers(i, 0) + f * (powers(i, 1) + f * curvature);
        bounds.squared_velocity.row(i) << start, start + rise * l / 3,
            start + l * (2 * rise + l * curvature) / 3, start + l * (rise + l * curvature);
        const auto squared_velocity = polynomial({start, rise * l, curvature * l * l}),
                   half_rise = polynomial({rise / 2, curvature * l}),
                   square = product(product(slope, slope), squared_velocity);
        const piece_polynomial change = product(bend, squared_velocity) + product(slope, half_rise),
                               both = 3 * product(slope, change),
                               third = 6 * c * squared_velocity + 3 * product(bend, half_rise) +
                                       curvature * slope;
        const auto set = [i](auto& forms, auto& errors, std::size_t k, const piece_polynomial& of) {
          const cubic_approximation cubic(of);
          forms[k].row(i) = cubic.at.transpose();
          errors(i, Eigen::Index(k)) = cubic.error;
        };
        set(changes, change_errors, 0, change);
        set(changes, change_errors, 1, square + product(offset, change));
        set(changes, change_errors, 2, product(offset, square) + product(half_square, change));
        set(jerks, jerk_errors, 0, third);
        set(jerks, jerk_errors, 1, both + product(offset, third));
        set(jerks, jerk_errors, 2,
            product(slope, square) + product(offset, both) + product(half_square, third));
      }
      Eigen::Array4d largest_rate = Eigen::Array4d::Zero();
      for (Eigen::Index j = 0; j < velocity.size(); ++j) {
        const Eigen::Vector3d factors = p.row(j), sizes = factors.cwiseAbs();
        Eigen::Array4d rate = (rates * factors).cwiseAbs();
        rate.segment<2>(1) += sizes.dot(rate_errors);
        largest_rate = largest_rate.max(rate / velocity[j]);
        const auto sum = [&](const std::array<linear_forms<4>, 3>& of) {
          return factors[0] * of[0] + factors[1] * of[1] + factors[2] * of[2];
        };
        joints.push_back({sum(changes) / acceleration[j], sum(jerks) / jerk[j],
                          change_errors * sizes / acceleration[j], jerk_errors * sizes / jerk[j]});
      }
      bounds.square_rate = times_square(bounds.squared_velocity, largest_rate);
      bounds.middle = bounds.squared_velocity * Eigen::Vector4d(1, 3, 3, 1) / 8;
      pieces.push_back(bounds);
    }
  }
};

/// Constraint |x| + beyond ≤ limit on a squared path velocity, with the derivatives of all three
/// with respect to its coefficients from `first` on. `order` n: limit of the n-th time derivative,
/// for velocities of their squares.
struct barrier_constraint {
  int order;
  std::optional<std::size_t> joint; ///< joint, if the constraint is of a single joint
  Eigen::Index first;
  double limit, beyond, x;
  const Eigen::Vector3d &limit_by, &beyond_by;
  const double* x_by;
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
  log_barrier_solver(const path_velocity_constraints& bounds, const Eigen::Array2d& ends)
      : bounds_(bounds), ends_(ends),
        squares_(Eigen::VectorXd::Ones(Eigen::Index(bounds.pieces.back().first) + 3)) {
    double stretch = 0;
    for_each_bound(squares_, [&](const barrier_constraint& b) {
      stretch = std::max(stretch, std::pow((std::abs(b.x) + b.beyond) / b.limit, 1.0 / b.order));
    });
    double slow = .7 / (stretch * stretch);
    for (const double end : ends_) {
      slow = end > 0 ? std::min(slow, end) : slow;
    }
    squares_.fill(slow);
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
    for_each_bound(squares_, [&](const barrier_constraint&) { count += 2; });
    const auto fraction = [&](int e) { return is_slow(e) ? squares_[end_of(e)] / ends_[e] : 1; };
    for (double lift = count / 64; are_ends_slow() && lift < 1e9 * count &&
                                   count > .01 * lift * (1 - std::min(fraction(0), fraction(1)));
         lift *= 4) {
      for (int steps = 0; steps < 60 && are_ends_slow() && step({0, lift}) > .1; ++steps) {
      }
    }
    return {fraction(0), fraction(1)};
  }

  /// Joint whose acceleration and jerk limits are the nearest, summed over the path.
  [[nodiscard]] std::size_t nearest_joint() const {
    std::vector<double> sums(bounds_.joints.size() / bounds_.pieces.size());
    for_each_bound(squares_, [&](const barrier_constraint& b) {
      if (b.joint) {
        sums[*b.joint] += b.limit / (b.limit - b.beyond - std::abs(b.x));
      }
    });
    return std::size_t(std::max_element(sums.begin(), sums.end()) - sums.begin());
  }

  /// Coefficients of a nearly minimum-time squared path velocity: the margins to the limits that
  /// the barrier leaves cost about 10 / accuracy of the time. Ends that were not attained stay near
  /// their values.
  [[nodiscard]] const Eigen::VectorXd& solve(double accuracy) {
    if (are_ends_slow()) {
      squares_ *= .95;
      for (int e = 0; e < 2; ++e) {
        ends_[e] = ends_[e] > 0 ? squares_[end_of(e)] : 0;
      }
      is_attained_ = {true, true};
    }
    const double unit = double(bounds_.pieces.size()) / time(squares_);
    for (double weight = 40 * unit; weight < accuracy * unit; weight *= 4) {
      for (int steps = 0; steps < 60 && step({weight, 0}) > .1; ++steps) {
      }
    }
    return squares_;
  }

private:
  /// Weights of the objective without the logarithms: `time` · time − `lift` · Σ b / end.
  struct barrier_weights {
    double time, lift;
  };

  [[nodiscard]] Eigen::Index end_of(int e) const { return e == 0 ? 0 : squares_.size() - 1; }
  [[nodiscard]] bool is_slow(int e) const { return ends_[e] > 0 && !is_attained_[std::size_t(e)]; }
  [[nodiscard]] bool are_ends_slow() const { return is_slow(0) || is_slow(1); }

  void for_each_bound(const Eigen::VectorXd& squares, const auto& f) const {
    const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
    const joint_bounds* joint = bounds_.joints.data();
    const std::size_t joints = bounds_.joints.size() / bounds_.pieces.size();
    for (const piece_bounds& piece : bounds_.pieces) {
      const auto first = Eigen::Index(piece.first);
      const Eigen::Vector3d c = squares.segment<3>(first);
      const double m = piece.middle.dot(c), scale = 1 / (m * std::sqrt(m));
      Eigen::Vector4d limit;
      std::array<Eigen::Vector3d, 4> limit_by;
      for (int r = 0; r < 4; ++r) {
        const double p = piece.squared_velocity.col(r).dot(c);
        limit[r] = (3 * m - p) * scale / 2;
        limit_by[std::size_t(r)] =
            (1.5 * (p / m - 1) * piece.middle - piece.squared_velocity.col(r)) * scale / 2;
      }
      const bool is_first = &piece == &bounds_.pieces.front();
      const bool is_last = &piece == &bounds_.pieces.back();
      // At ends with a required velocity nothing remains to be optimised.
      for (int r = is_first && ends_[0] > 0; r + (is_last && ends_[1] > 0) < 10; ++r) {
        const auto by = piece.square_rate.col(r);
        f(barrier_constraint{2, {}, first, 1, 0, by.dot(c), zero, zero, by.data()});
      }
      for (std::size_t j = 0; j < joints; ++j, ++joint) {
        const double change = joint->beyond_acceleration.dot(c), jerk = joint->beyond_jerk.dot(c);
        for (int r = 0; r < 4; ++r) {
          const bool is_end = r == 0 || r == 3;
          const auto by = joint->acceleration.col(r), jerk_by = joint->jerk.col(r);
          f(barrier_constraint{2, j, first, 1, is_end ? 0 : change, by.dot(c), zero,
                               is_end ? zero : joint->beyond_acceleration, by.data()});
          f(barrier_constraint{3, j, first, limit[r], is_end ? 0 : jerk, jerk_by.dot(c),
                               limit_by[std::size_t(r)], is_end ? zero : joint->beyond_jerk,
                               jerk_by.data()});
        }
      }
    }
  }
  /// Value of b in the middle of a segment.
  [[nodiscard]] static double middle_of(const piece_bounds& piece, const Eigen::VectorXd& squares) {
    return piece.middle.dot(squares.segment<3>(Eigen::Index(piece.first)));
  }

  [[nodiscard]] double time(const Eigen::VectorXd& squares) const {
    double result = 0;
    for (const piece_bounds& piece : bounds_.pieces) {
      result += piece.length / std::sqrt(middle_of(piece, squares));
    }
    return result;
  }
  /// Weight of log(b) per limit proportional to 1 / √b, half a logarithm each: otherwise the
  /// margins to these limits would grow as the velocity falls.
  [[nodiscard]] double rooted_limits() const {
    return 4 * (double(bounds_.joints.size()) / double(bounds_.pieces.size()));
  }

  /// Objective with its barrier terms; infinite outside the feasible set.
  [[nodiscard]] double value(const Eigen::VectorXd& squares, barrier_weights weights) const {
    double sum = weights.time * time(squares), product = 1;
    for (int e = 0; e < 2; ++e) {
      sum -= is_slow(e) ? weights.lift * squares[end_of(e)] / ends_[e] : 0;
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
    std::for_each(squares.begin(), squares.end(), take);
    for_each_bound(squares, [&](const barrier_constraint& b) {
      const double limit = b.limit - b.beyond;
      is_inside = is_inside && limit > 0;
      take((limit - b.x) * (limit + b.x));
    });
    for (const piece_bounds& piece : bounds_.pieces) {
      sum -= rooted_limits() * std::log(middle_of(piece, squares));
    }
    return is_inside ? sum - std::log(product) : std::numeric_limits<double>::infinity();
  }

  /// Takes one Newton step with a backtracking line search.
  ///
  /// \return twice the decrease that the model predicts; 0 if no step is found
  double step(barrier_weights weights) {
    Eigen::VectorXd gradient = -squares_.cwiseInverse();
    block_band_matrix<double, 1, 2> hessian;
    hessian.set_zero(std::size_t(squares_.size()));
    const auto entry = [&](Eigen::Index i, Eigen::Index j) -> double& {
      return hessian.at(std::size_t(i), std::size_t(j))(0, 0);
    };
    for (Eigen::Index i = 0; i < squares_.size(); ++i) {
      entry(i, i) = gradient[i] * gradient[i];
    }
    // Adds a function f of a linear form of the coefficients, given f' and f''.
    const auto add = [&](Eigen::Index first, const Eigen::Vector3d& by, double derivative,
                         double curvature) {
      gradient.segment<3>(first) += derivative * by;
      for (Eigen::Index i = 0; i < 3; ++i) {
        for (Eigen::Index j = 0; j <= i; ++j) {
          entry(first + i, first + j) += curvature * by[i] * by[j];
        }
      }
    };
    for_each_bound(squares_, [&](const barrier_constraint& b) {
      for (const int sign : {-1, 1}) {
        const double inverse = 1 / (b.limit - b.beyond + sign * b.x);
        add(b.first, b.limit_by - b.beyond_by + sign * Eigen::Map<const Eigen::Vector3d>(b.x_by),
            -inverse, inverse * inverse);
      }
    });
    for (const piece_bounds& piece : bounds_.pieces) {
      const double m = middle_of(piece, squares_),
                   by_time = weights.time * piece.length / (2 * m * std::sqrt(m));
      add(Eigen::Index(piece.first), piece.middle, -by_time - rooted_limits() / m,
          (1.5 * by_time + rooted_limits() / m) / m);
    }
    for (int e = 0; e < 2; ++e) {
      const Eigen::Index i = end_of(e);
      if (is_slow(e)) {
        gradient[i] -= weights.lift / ends_[e];
      } else if (ends_[e] > 0) { // stays constant
        gradient[i] = 0;
        entry(i, i) = 1;
        for (const Eigen::Index k : {1, 2}) {
          (e == 0 ? entry(k, 0) : entry(i, i - k)) = 0;
        }
      }
    }
    Eigen::VectorXd newton_step = -gradient;
    if (!hessian.factorise()) {
      return 0;
    }
    hessian.solve(newton_step);
    const double decrease = -gradient.dot(newton_step);
    // Step length at which an end attains its required value.
    std::array<double, 2> arrival{2, 2};
    for (int e = 0; e < 2; ++e) {
      const Eigen::Index i = end_of(e);
      if (is_slow(e) && squares_[i] + newton_step[i] >= ends_[e]) {
        arrival[std::size_t(e)] = (ends_[e] - squares_[i]) / newton_step[i];
      }
    }
    const double before = value(squares_, weights);
    for (double fraction = std::min({1.0, arrival[0], arrival[1]}); fraction > 1e-6;
         fraction /= 2) {
      const Eigen::VectorXd next = squares_ + fraction * newton_step;
      if (value(next, weights) < before - 1e-3 * fraction * decrease) {
        squares_ = next;
        for (int e = 0; e < 2; ++e) {
          if (fraction == arrival[std::size_t(e)]) {
            squares_[end_of(e)] = ends_[e];
            is_attained_[std::size_t(e)] = true;
          }
        }
        return decrease;
      }
    }
    return 0;
  }

  const path_velocity_constraints& bounds_;
  Eigen::Array2d ends_;
  std::array<bool, 2> is_attained_{};
  Eigen::VectorXd squares_;
};

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

} // namespace

timed_path trajectory_from_path_velocity(const std::vector<joint_cubic>& curve,
                                         const std::vector<reference_piece>& path, std::size_t n,
                                         const Eigen::VectorXd& squared_velocity) {
  timed_path result;
  result.pieces.reserve(path.size());
  for (const auto& [edge, interval, from, l, start, a, b, c] : path) {
    const Eigen::Vector3d powers = path_velocity_powers(interval, n).transpose() *
                                   squared_velocity.segment<3>(Eigen::Index(interval));
    const double curvature = powers[2], rise = powers[1] + 2 * from * curvature,
                 before = powers[0] + from * (powers[1] + from * curvature);
    const double rate = std::sqrt(before),
                 end_rate = std::sqrt(before + l * (rise + l * curvature));
    result.pieces.push_back({{result.duration, rate, rise / 2, curvature, a, b, c},
                             curve[edge].part(start, l * (a + l * (b + l * c)))});
    result.duration += time_over(l, rate, end_rate, curvature);
  }
  return result;
}

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

namespace {

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
/// \param accuracy  as of `log_barrier_solver::solve`
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
  const Eigen::Array2d end_rates(speeds[0] > 0 ? speeds[0] / reference.first_slope() : 0,
                                 speeds[1] > 0 ? speeds[1] / reference.last_slope() : 0);
  log_barrier_solver search(bounds, end_rates.square());
  const auto [first, last] = search.find_feasible_start();
  jerk_search_result result{{}, {std::sqrt(first), std::sqrt(last)}, search.nearest_joint()};
  result.motion = trajectory_from_path_velocity(curve, path, intervals, search.solve(accuracy));
  return result;
}

/// Motion found with relaxed jerk limits, which are then tightened step by step, so that the
/// velocities at the ends are right throughout; empty if none is found.
///
/// \param find  (initial guess, divisor of the number of intervals, factor of the jerk limits) ↦
/// `jerk_search_result`
template <class Find>
[[nodiscard]] std::optional<timed_path> tightened(const timed_path& gentle, const Find& find) {
  double scale = 2;
  jerk_search_result last = find(gentle, 3, scale);
  while (!last.is_feasible() && scale < 1e4) {
    scale *= 2;
    last = find(gentle, 3, scale);
  }
  for (double step = 1.5; last.is_feasible() && step > 1.01;) {
    const double narrower = std::max(1.0, scale / step);
    jerk_search_result next = find(last.motion, 2, narrower);
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

} // namespace

/// The search proceeds from a motion with small accelerations by successive refinement, each result
/// being the initial guess (warm start) of the next.
timed_path timed_within_jerks(const time_parametrisation_input& problem,
                              const std::vector<joint_cubic>& curve) {
  require_smooth(problem, curve);
  require_feasible_ends(problem, curve);
  const auto find = [&](const timed_path& from, double divisor, double scale) {
    time_parametrisation_input loose = problem;
    loose.jerk *= scale;
    return timed_by_jerks(loose, curve, from, std::size_t(std::max(16.0, problem.parts / divisor)),
                          scale > 1 ? 200 : 5e4); // relaxed limits only roughly
  };
  const timed_path gentle = min_acceleration_motion(problem, curve);
  timed_path last = gentle;
  std::optional<timed_path> result;
  jerk_search_result nearest; // among those that violate the limits
  for (const double divisor : {6, 3, 2}) {
    jerk_search_result next = find(last, divisor, 1);
    if (next.is_feasible()) {
      result = next.motion;
    } else if (next.reached[next.end()] > nearest.reached[nearest.end()]) {
      nearest = next;
    }
    last = std::move(next.motion);
  }
  result = result ? result : tightened(gentle, find);
  const std::size_t end = nearest.end(), joint = nearest.nearest_joint;
  require(result.has_value(), "duet: time_optimal_trajectory: the ", end == 0 ? "initial" : "final",
          " velocities are too large for the limits (expected at most ",
          std::floor(1e4 * nearest.reached[end]) / 1e4, " of them; joint ", joint,
          ", with the velocity ", end_velocities(problem, curve)[end][Eigen::Index(joint)],
          ", is nearest to its limits)");
  return *result;
}

DUET_ABI_END
} // namespace duet::detail
