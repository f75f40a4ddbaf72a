// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "branches/elimination.hpp"
#include "branches/loop_equation.hpp"
#include "branches/singular_value.hpp"
#include "branches/subproblems.hpp"

#include "splitmix64.hpp"
#include "tip_pose.hpp"
#include <duet/core/config.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace duet::detail {
DUET_ABI_BEGIN

namespace {

/// Squared ratio of the goal's translation to ten times the size of the loop, as by long travels of
/// prismatic joints; at least 1.
[[nodiscard]] double squared_travel(const loop_equation& loop) {
  const vector3d offset = .1 * loop.closing.translation;
  return std::max(1., dot(offset, offset));
}

/// Solutions of a loop found so far.
class loop_solutions {
public:
  explicit loop_solutions(const loop_equation& loop) : loop_(loop) {}

  [[nodiscard]] const std::vector<loop_solution>& all() const { return all_; }
  /// Number of isolated solutions, with multiplicity.
  [[nodiscard]] int count() const {
    int result = -on_curves_;
    for (const loop_solution& x : all_) {
      result += x.multiplicity;
    }
    return result;
  }

  static constexpr std::size_t not_found = std::size_t(-1);

  /// Smallest singular value of all solutions found.
  [[nodiscard]] double smallest_singular_value() const { return min_sigma_; }
  /// Number of solutions on curves of solutions.
  [[nodiscard]] int on_curves() const { return on_curves_; }

  /// True if a singular solution is on what would be a curve of solutions except
  /// for 1e-5 of the size.
  [[nodiscard]] bool is_near_curve() const { return is_near_curve_; }
  /// False if a singular solution may be more than double.
  [[nodiscard]] bool is_count_certain() const { return degenerate_ == 0; }
  [[nodiscard]] bool is_singular(std::size_t i) const { return all_[i].sigma < nearly_singular; }

  /// Refines θ and adds the solution it leads to, and its neighbour near a singularity.
  ///
  /// \return the index of the solution, or `not_found` if it leads to no solution
  std::size_t add(six_coordinates theta) {
    constexpr std::size_t max_count = 100; // more than there are isolated ones
    if (all_.size() == max_count || !close_loop(loop_, theta)) {
      return not_found;
    }
    theta = loop_.wrapped(theta);
    for (std::size_t i = 0; i < all_.size(); ++i) {
      if (is_same(all_[i].theta, theta)) {
        return i;
      }
    }
    const std::size_t last = all_.size();
    all_.push_back({theta, 1});
    return find_neighbour(last);
  }

private:
  static constexpr double close_together = 1e-3; // half the distance of coinciding solutions
  static constexpr double nearly_singular = 1e-5;

  /// True if two solutions coincide to round-off: then the configuration halfway is one, too.
  [[nodiscard]] bool is_same(const six_coordinates& a, const six_coordinates& b) const {
    const six_coordinates half = loop_.wrapped(b - a) / 2;
    return half.cwiseAbs().maxCoeff() < close_together && is_closed(a + half);
  }
  /// True if two singular solutions coincide to round-off. If more than two coincide, the
  /// closure error vanishes to round-off on a curve; for two separate ones σ would be as
  /// large as their distance.
  [[nodiscard]] bool is_same_singularity(std::size_t a, std::size_t b) const {
    constexpr double singular = 1e-8, fraction = 1e-3;
    const double sigma = std::max(all_[a].sigma, all_[b].sigma),
                 distance = loop_.wrapped(all_[b].theta - all_[a].theta).cwiseAbs().maxCoeff();
    return sigma < singular && distance < 2 * close_together && sigma < fraction * distance;
  }
  [[nodiscard]] bool is_closed(const six_coordinates& theta) const {
    constexpr double rounding = 3e-13;
    const closure_error closure(loop_, theta);
    return closure.twist.norm() < rounding * closure.size;
  }

  /// Finds the neighbour of a solution near a singularity. Along the direction v that changes the
  /// loop least, by u σ t, the change is u (σ t + κ t²/2) to second order: near t = −2σ/κ is
  /// another solution. If σ is 0 the solution may be on a curve.
  ///
  /// \return the index of the solution; `not_found` for most points of curves
  std::size_t find_neighbour(std::size_t at) {
    constexpr double close_by = .05, closer = 1e-2, h = 1e-3, fold = 1e-4;
    constexpr std::size_t enough = 24; // number of singular solutions: others are on curves
    const six_coordinates theta = all_[at].theta;
    six_columns jacobian = closure_error(loop_, theta).jacobian;
    for (int k = 0; k < 36; ++k) {
      jacobian(k) += 1e-13 * double(k * k % 41); // no pivot is zero
    }
    const Eigen::PartialPivLU<six_columns> lu(jacobian);
    six_coordinates v, u;
    v << 1, .7, -.4, .9, -.6, .5;
    double sigma = 0;
    for (int k = 0; k < 3; ++k) { // inverse iteration
      u = lu.transpose().solve(v).normalized();
      v = lu.solve(u);
      sigma = 1 / v.norm();
      v *= sigma;
    }
    all_[at].sigma = sigma;
    min_sigma_ = std::min(min_sigma_, sigma);
    if (!(sigma < close_by)) {
      return at;
    }
    if (sigma < nearly_singular) {
      for (std::size_t i = 0; i < at; ++i) {
        if (is_same_singularity(i, at)) {
          all_.pop_back();
          return i;
        }
      }
      if (singular_ == enough) {
        all_.pop_back();
        return not_found;
      }
      ++singular_;
      if (is_on_curve(theta, v) || is_on_curve(theta, -v)) {
        ++on_curves_;
        return at;
      }
    }
    if (sigma < closer) { // terms of third order may count
      const double almost_none = 1e-5 / squared_travel(loop_);
      const double forwards = search_along(theta, u, v), backwards = search_along(theta, -u, -v);
      is_near_curve_ = is_near_curve_ ||
                       (sigma < nearly_singular && std::max(forwards, backwards) < almost_none);
    }
    const auto along = [&](double t) { return u.dot(closure_error(loop_, theta + t * v).twist); };
    const double derivative = u.dot(closure_error(loop_, theta).jacobian * v);
    const double curvature = (along(h) + along(-h)) / (h * h), t = 2 * derivative / curvature;
    degenerate_ += sigma < nearly_singular && !(std::abs(curvature) > fold);
    if (!(std::abs(t) < 1)) {
      return at;
    }
    // The neighbour may coincide with this solution once it is refined.
    const bool is_one = is_closed(theta + t / 2 * v) ||
                        (add(theta + t * v) == at && std::abs(t) < 2 * close_together);
    if (is_one) {
      all_[at].multiplicity = 2;
    }
    return at;
  }

  /// Adds the solutions near a nearly singular one by a Lyapunov–Schmidt reduction: with v·(x − θ)
  /// fixed at t, the closure error is made 0 except for μ(t) u; solutions are zeros of μ.
  ///
  /// \return the largest |μ| in the range of the search
  double search_along(const six_coordinates& theta, const six_coordinates& u,
                      const six_coordinates& v) {
    six_coordinates x = theta, x_before = theta;
    double largest = 0, ratio_before = 0; // ratio of μ to t, without the zero at t = 0
    for (const double t : {.004, .01, .02, .04, .07, .1, .15, .22, .33, .5}) {
      double mu = 0;
      for (int k = 0; k < 2; ++k) {
        const closure_error closure(loop_, x);
        Eigen::Matrix<double, 7, 7> bordered;
        bordered << closure.jacobian, u, v.transpose(), 0;
        Eigen::Matrix<double, 7, 1> right_side;
        right_side << closure.twist, t - v.dot(x - theta);
        const Eigen::Matrix<double, 7, 1> step =
            Eigen::PartialPivLU<Eigen::Matrix<double, 7, 7>>(bordered).solve(right_side);
        x += step.head<6>();
        mu = step[6];
      }
      if (!((x - theta).norm() < 3 * t)) {
        return largest;
      }
      largest = std::max(largest, std::abs(mu));
      const double ratio = mu / t;
      if (ratio * ratio_before < 0) {
        const double fraction = ratio / (ratio - ratio_before);
        static_cast<void>(add(x + fraction * (x_before - x)));
      }
      x_before = x;
      ratio_before = ratio;
    }
    return largest;
  }

  /// True if there is another solution, or nearly one, in the direction v from a singular one.
  [[nodiscard]] bool is_on_curve(const six_coordinates& theta, const six_coordinates& v) const {
    constexpr double fraction = 1e-2, nearly = 1e-7, rounding = 1e-12;
    const double size = closure_error(loop_, theta).size;
    double h = HUGE_VAL;
    for (Eigen::Index i = 0; i < 6; ++i) {
      h = std::min(h, fraction * (loop_.joints[std::size_t(i)].is_revolute ? 1 : size) /
                          std::abs(v[i]));
    }
    six_coordinates other = theta + h * v;
    static_cast<void>(close_loop(loop_, other));
    const double distance = (other - theta).norm();
    return closure_error(loop_, other).twist.norm() < std::max(nearly, rounding * size) &&
           distance > h / 10 && distance < 10 * h;
  }

  loop_equation loop_;
  std::vector<loop_solution> all_;
  int on_curves_ = 0, degenerate_ = 0;
  std::size_t singular_ = 0;
  bool is_near_curve_ = false;
  double min_sigma_ = HUGE_VAL;
};

/// System of equations for a loop of four revolute and two prismatic joints.
class two_prismatic {
  using complex = std::complex<double>;

public:
  explicit two_prismatic(const loop_equation& loop) : loop_(loop) {
    for (std::size_t i = 0, revolute_count = 0, prismatic_count = 0; i < 6; ++i) {
      (loop.joints[i].is_revolute ? revolute_[revolute_count++] : prismatic_[prismatic_count++]) =
          i;
    }
  }

  static constexpr int max_solutions = 8; ///< maximum number of solutions
  static constexpr int hidden = 0; ///< index of the joint whose angle the polynomial depends on

  /// Zeros of the polynomial.
  [[nodiscard]] determinant_zeros roots() const {
    using all_roots = circle_roots<4>;
    determinant_zeros result;
    all_roots::values values;
    for (int k = 0; k < all_roots::samples; ++k) {
      values[std::size_t(k)] = loop_at(*this, all_roots::angle(k) + start).determinant();
      result.regularity = std::max(result.regularity, std::abs(values[std::size_t(k)]));
    }
    const all_roots roots_of_polynomial(all_roots::interpolated(values));
    for (int i = 0; i < all_roots::count; ++i) {
      result.values.push_back(std::polar(1., start) * roots_of_polynomial[i]);
    }
    return result;
  }

  /// Calls visit(θ) with coordinates near the real solutions with the angle of a zero.
  void solution_at(double alpha, const auto& visit) const {
    const loop_at at(*this, alpha);
    const auto size = [&](std::size_t k) { return std::abs(at.branches[k].determinant); };
    const std::size_t best = size(0) < size(1) ? 0 : 1;
    constexpr double rounding = 1e-3;
    const bool both = std::max(size(0), size(1)) < rounding;
    for (const std::size_t k : {best, 1 - best}) {
      const auto& branch = at.branches[k];
      if ((k == best || both) && std::abs(std::log(std::abs(branch.z))) < .1) {
        visit(coordinates(alpha, std::arg(branch.z)));
      }
    }
  }

private:
  using matrix = Eigen::Matrix3cd;
  using vector = Eigen::Vector3cd;

  /// First angle at which the polynomial is sampled: no known arm has parallel axes there.
  static constexpr double start = .37;

  [[nodiscard]] const loop_joint& revolute(std::size_t k) const {
    return loop_.joints[revolute_[k]];
  }

  /// Product a·b without conjugation, also of complex vectors.
  [[nodiscard]] static complex product(const vector& a, const vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
  [[nodiscard]] static matrix rotation_matrix(const three_vector<double>& axis, complex cosine,
                                              complex sine) {
    const Eigen::Vector3d n = axis;
    Eigen::Matrix3d cross_with_n;
    cross_with_n << 0, -n[2], n[1], n[2], 0, -n[0], -n[1], n[0], 0;
    const Eigen::Matrix3d along = n * n.transpose();
    return along + cosine * (Eigen::Matrix3d::Identity() - along) + sine * cross_with_n;
  }

  /// Values at an angle of the first joint, on both branches of the other angles, real or complex.
  struct loop_at {
    struct branch {
      complex z;           ///< e^{iγ}
      complex determinant; ///< f
    };
    std::array<branch, 2> branches;
    double across; ///< 1 − w²

    loop_at(const two_prismatic& loop, double alpha) {
      const loop_joint &b = loop.revolute(1), &c = loop.revolute(2), &d = loop.revolute(3);
      std::array<matrix, 4> rotations;
      rotations[0] = rotation_matrix(loop.revolute(0).axis, std::cos(alpha), std::sin(alpha));
      const matrix closing = duet::rotation_matrix(loop.loop_.closing.rotation).cast<complex>();
      const matrix rest = rotations[0].transpose() * closing; // rotation by β, γ and δ
      const vector first = Eigen::Vector3d(b.axis).cast<complex>();
      const vector last = Eigen::Vector3d(d.axis).cast<complex>();
      const vector goal = rest * last;
      const complex w = product(first, goal);
      across = 1 - (w * w).real();
      // b·R_γ d = w, a quadratic of z.
      const rotating_vector by_c(c.axis, d.axis);
      const complex cosine = dot(b.axis, by_c.across) / 2;
      const complex sine = complex(0, -.5) * dot(b.axis, by_c.normal);
      const complex constant = dot(b.axis, by_c.along) - w;
      const complex root = std::sqrt(constant * constant - 4. * (cosine + sine) * (cosine - sine));
      for (std::size_t k = 0; k < 2; ++k) {
        branch& x = branches[k];
        x.z = (-constant + (k == 0 ? root : -root)) / (2. * (cosine + sine));
        rotations[2] =
            rotation_matrix(c.axis, (x.z + 1. / x.z) / 2., (x.z - 1. / x.z) / complex(0, 2));
        const vector from = rotations[2] * last;
        const vector normal(from[1] * goal[2] - from[2] * goal[1],
                            from[2] * goal[0] - from[0] * goal[2],
                            from[0] * goal[1] - from[1] * goal[0]);
        rotations[1] = rotation_matrix(b.axis, (product(from, goal) - w * w) / across,
                                       product(first, normal) / across);
        rotations[3] = (rotations[1] * rotations[2]).transpose() * rest;
        x.determinant = loop.closure_condition(rotations);
      }
    }

    [[nodiscard]] double determinant() const {
      return (branches[0].determinant * branches[1].determinant).real() * across;
    }
  };

  /// Closure condition (n₁ × n₂)·t, with t the remaining translation if prismatic joints are at 0.
  [[nodiscard]] complex closure_condition(const std::array<matrix, 4>& rotations) const {
    matrix link = matrix::Identity(), columns; // n₁, n₂, t
    vector at = vector::Zero();
    for (std::size_t i = 0, revolute_count = 0, prismatic_count = 0; i < 6; ++i) {
      const loop_joint& j = loop_.joints[i];
      if (j.is_revolute) {
        const matrix& by = rotations[revolute_count++];
        const vector p = Eigen::Vector3d(j.point).cast<complex>();
        at += link * (p - by * p);
        link = link * by;
      } else {
        columns.col(Eigen::Index(prismatic_count++)) =
            link * Eigen::Vector3d(j.axis).cast<complex>();
      }
    }
    columns.col(2) = Eigen::Vector3d(loop_.closing.translation).cast<complex>() - at;
    return columns.determinant();
  }

  /// All coordinates for given α and γ.
  [[nodiscard]] six_coordinates coordinates(double alpha, double gamma) const {
    const loop_joint &a = revolute(0), &b = revolute(1), &c = revolute(2), &d = revolute(3);
    six_coordinates result = six_coordinates::Zero();
    const auto set = [&](std::size_t k, double x) { result[Eigen::Index(revolute_[k])] = x; };
    const quaternion<double> rest =
        conj(rotation_about_axis(a.axis, std::sin(alpha / 2), std::cos(alpha / 2))) *
        loop_.closing.rotation;
    const double beta = subproblem1_angle_about(b.axis, rotating_vector(c.axis, d.axis).at(gamma),
                                                rotated(rest, d.axis));
    set(0, alpha);
    set(1, beta);
    set(2, gamma);
    set(3, angle_of(conj(rotation_product(b.axis, beta, c.axis, gamma)) * rest, d.axis));
    const closure_error closure(loop_, result);
    // Component of the closure error in the plane of both axes. If these are parallel nothing is
    // finite, which `close_loop` rejects as an initial guess.
    Eigen::Matrix<double, 3, 2> directions;
    for (int k = 0; k < 2; ++k) {
      directions.col(k) = closure.jacobian.col(Eigen::Index(prismatic_[std::size_t(k)])).head<3>();
    }
    const Eigen::Vector2d travel = directions.householderQr().solve(closure.twist.head<3>());
    result[Eigen::Index(prismatic_[0])] = travel[0];
    result[Eigen::Index(prismatic_[1])] = travel[1];
    return result;
  }

  loop_equation loop_;
  std::array<std::size_t, 4> revolute_{};
  std::array<std::size_t, 2> prismatic_{};
};

/// Order of the joints of a loop, from one of them on, forwards or backwards.
struct loop_order {
  loop_equation loop;
  int first = 0;
  bool is_reversed = false;
  double quality = 0; ///< measure of how well equations can be solved in this order; 0: not at all

  /// Index in the loop of the k-th joint of this order.
  [[nodiscard]] Eigen::Index joint(int k) const { return ((is_reversed ? 5 - k : k) + first) % 6; }
  [[nodiscard]] six_coordinates in_loop(const six_coordinates& theta) const {
    six_coordinates result;
    for (int k = 0; k < 6; ++k) {
      result[joint(k)] = theta[k];
    }
    return result;
  }
};

/// Quality of an order for the elimination of the first two joints: |(p₁ − p₂)·(n₁ × n₂)|, which is
/// 0 if their axes meet or are parallel; a quarter of |n₁ × n₂| if one is prismatic. The third and
/// the sixth joint must be revolute.
[[nodiscard]] double quality_of(const loop_equation& loop, const elimination*) {
  const loop_joint &a = loop.joints[0], &b = loop.joints[1];
  const auto across = cross(a.axis, b.axis);
  return !loop.joints[2].is_revolute || !loop.joints[5].is_revolute ? 0
         : a.is_revolute && b.is_revolute ? std::abs(dot(a.point - b.point, across))
                                          : length_of(across) / 4;
}
/// Quality of an order for two prismatic joints: the first joint must be revolute, and no axis of
/// the other three revolute joints parallel to the next.
[[nodiscard]] double quality_of(const loop_equation& loop, const two_prismatic*) {
  double result = loop.joints[0].is_revolute ? 1 : 0;
  const loop_joint* before = nullptr;
  for (std::size_t i = 1; i < 6; ++i) {
    const loop_joint& j = loop.joints[i];
    if (j.is_revolute) {
      result = std::min(result, before == nullptr ? 1 : length_of(cross(before->axis, j.axis)));
      before = &j;
    }
  }
  return result;
}

/// Orders of a loop in which a system of equations can be solved, the best first.
///
/// \param general  loop in general position, for which the quality of orders is computed
template <class System>
[[nodiscard]] std::vector<loop_order> orders_of(const loop_equation& loop,
                                                const loop_equation& general) {
  std::vector<loop_order> result;
  result.reserve(12);
  const auto add = [&](const loop_equation& l, const loop_equation& rated, int first,
                       bool is_reversed) {
    const double quality = quality_of(rated, static_cast<const System*>(nullptr));
    if (quality > 0) {
      const loop_order next{l, first, is_reversed, quality};
      const auto is_better = [](const auto& a, const auto& b) { return a.quality > b.quality; };
      result.insert(std::upper_bound(result.begin(), result.end(), next, is_better), next);
    }
  };
  loop_equation from = loop, rated = general;
  for (int first = 0; first < 6; ++first) {
    add(from, rated, first, false);
    add(from.reversed(), rated.reversed(), first, true);
    from = from.shifted();
    rated = rated.shifted();
  }
  const auto is_worse = [&](const loop_order& o) { return o.quality < .01 * result[0].quality; };
  result.erase(std::find_if(result.begin(), result.end(), is_worse), result.end());
  return result;
}

/// Pseudo-random vectors of a size up to about `by`, reproducible for a seed; smaller for loops
/// with large prismatic displacements.
class small_vectors {
public:
  small_vectors(const loop_equation& loop, double by, std::uint64_t seed)
      : random_(seed), by_(by / squared_travel(loop)) {}
  [[nodiscard]] vector3d operator()() {
    const double x = random_(), y = random_(), z = random_();
    return by_ * vector3d{2 * x - 1, 2 * y - 1, 2 * z - 1};
  }
  [[nodiscard]] tip_pose displacement() {
    const vector3d rotation = (*this)(), translation = (*this)();
    return {normalized(quaternion<double>(1, rotation.x, rotation.y, rotation.z)), translation};
  }

private:
  splitmix64 random_;
  double by_;
};

/// Loop with a goal and axes in general position, close to the given ones.
[[nodiscard]] loop_equation disturbed(loop_equation loop, double by, std::uint64_t seed) {
  small_vectors any(loop, by, seed);
  for (loop_joint& j : loop.joints) {
    const vector3d axis = j.axis + any();
    j.axis = 1 / length_of(axis) * axis;
    j.point = j.point + any();
  }
  loop.closing = any.displacement() * loop.closing;
  return loop;
}

/// Zero e^{iθ} of a system's determinant, near which there may be solutions.
struct zero_on_circle {
  double angle = 0;
  double off = 0;        ///< logarithm of the distance from the origin
  bool is_real = false;  ///< true if the distance is 1 to round-off
  bool is_single = true; ///< true if no other zero is close

  /// True if it may be a solution; others are nearly real only where two solutions meet slowly.
  [[nodiscard]] bool is_near() const { return off < .2; }
};

[[nodiscard]] std::vector<zero_on_circle>
zeros_on_circle(std::span<const std::complex<double>> roots) {
  constexpr double real = 1e-9, farthest = .5, neighbourhood = .02;
  std::vector<zero_on_circle> result;
  for (const std::complex<double>& z : roots) {
    const double off = std::log(std::abs(z)); // the conjugate pair has −off
    if (off > -real && off < farthest) {
      result.push_back({std::arg(z), off, off < real});
    }
  }
  for (zero_on_circle& one : result) {
    one.is_single =
        std::count_if(result.begin(), result.end(), [&](const zero_on_circle& other) {
          return other.is_near() && std::abs(wrap_angle(other.angle - one.angle)) < neighbourhood;
        }) == 1;
  }
  return result;
}

/// All solutions of a loop by a system of equations.
///
/// Axes at right angles and goals with round numbers make zeros coincide, hide solutions in an
/// order of the joints, or make the determinant vanish for all angles. Therefore loops with
/// displaced axes are solved, always with the same displacements, of 1e-8 to 1e-3 of the loop's
/// size, in more than one order. Newton's method leads from their solutions to those of the loop
/// itself. These are complete if successive displaced loops have as many real zeros as solutions
/// were found: one loop if it is well conditioned, two otherwise, three close to singularities,
/// five if there are no solutions; or if three loops add no others. They are not if some are on a
/// curve, or near what is nearly a curve. Five loops are solved then, or a single one if no
/// solution can be regular.
template <class System>
class general_solver {
public:
  explicit general_solver(const loop_equation& loop) : loop_(loop), solutions_(loop) {}

  [[nodiscard]] loop_solution_set solve() {
    constexpr std::array by{1e-4, 1e-5, 1e-6, 1e-4, 1e-7, 1e-3, 1e-8, 1e-5};
    const auto orders = orders_of<System>(loop_, disturbed(loop_, by[0], 1));
    const auto needed = [&] {
      const double sigma = solutions_.smallest_singular_value();
      return solutions_.all().empty()         ? 5 // each may make a double solution complex
             : sigma < .01 || has_close_pair_ ? 3
             : sigma < .04 || !is_certain_    ? 2
                                              : 1;
    };
    int agreeing = 0, quiet = 0;
    const auto is_even = [&] {
      return !solutions_.is_count_certain() || solutions_.count() % 2 == 0;
    };
    const auto is_enough = [&](std::size_t loops) {
      return agreeing >= needed() ||
             (solutions_.on_curves() > 0 && (loops == 5 || is_always_singular(loop_)));
    };
    for (std::size_t k = 0; k < by.size() && !is_enough(k); ++k) {
      const auto before = solutions_.all().size();
      const bool is_clear = add(orders[k % orders.size()], by[k], k + 2) && is_even();
      const bool has_grown = solutions_.all().size() != before;
      quiet = has_grown ? 0 : quiet + 1;
      agreeing = has_grown ? int(is_clear) : agreeing + is_clear;
    }
    const bool agree = agreeing >= needed() || (quiet >= 3 && agreeing > 0 && is_even());
    if (solutions_.all().empty()) {
      add_from_random_guesses(); // finds a singular solution, or a curve of them
    }
    loop_solution_set result;
    result.solutions = solutions_.all();
    result.complex_solutions = std::max(0, System::max_solutions - solutions_.count());
    result.is_complete = agree && solutions_.on_curves() == 0 && !solutions_.is_near_curve() &&
                         !(solutions_.all().empty() && (is_doubtful_ || has_close_pair_));
    return result;
  }

private:
  /// Adds solutions from random initial guesses: on curves of solutions those of a displaced loop
  /// may all be complex.
  void add_from_random_guesses() {
    constexpr int starts = 12;
    splitmix64 random(1);
    for (int k = 0; k < starts; ++k) {
      six_coordinates theta;
      for (double& x : theta) {
        x = 6 * random() - 3;
      }
      static_cast<void>(solutions_.add(theta));
    }
  }

  /// Adds the solutions that those of a displaced loop, solved in one order, lead to.
  ///
  /// \return true if the determinant does not vanish identically and every real zero led to a
  /// separate solution
  bool add(const loop_order& order, double by, std::uint64_t seed) {
    constexpr double singular = 1e-4, vanishing = 1e-6, sound = .05, nearly_real = .05,
                     nearly_closed = .02;
    constexpr int max_coinciding = 4;
    const System system(disturbed(order.loop, by, seed));
    const auto roots = system.roots();
    if (!is_doubtful_ && !(roots.regularity > singular)) {
      is_doubtful_ = true;
      if (!is_always_singular(loop_)) { // otherwise one loop suffices
        add_from_random_guesses();
      }
    }
    std::vector<std::size_t> hits;
    bool is_clear = roots.regularity * squared_travel(order.loop) > vanishing;
    is_certain_ = roots.regularity > 100 * singular && order.quality > sound;
    for (const zero_on_circle& zero : zeros_on_circle(roots.values)) {
      std::size_t at = zero.is_real && zero.is_single ? known(order, zero.angle) : not_found;
      bool is_candidate = zero.is_near();
      if (at == not_found) {
        system.solution_at(zero.angle, [&](const six_coordinates& theta) {
          const six_coordinates start = order.in_loop(theta);
          // Two solutions between which the loop stays nearly closed may become a complex pair that
          // far off the circle; its real part nearly closes the loop.
          is_candidate = is_candidate || is_nearly_closed(start, nearly_closed);
          at = is_candidate ? solutions_.add(start) : not_found;
        });
      }
      if (!is_candidate) {
        continue;
      }
      is_certain_ = is_certain_ && zero.is_real && zero.is_single;
      has_close_pair_ = has_close_pair_ || (!zero.is_real && zero.off < nearly_real);
      if (zero.is_real) {
        const auto times = at == not_found ? 0 : std::count(hits.begin(), hits.end(), at);
        is_clear = is_clear && at != not_found &&
                   times < (solutions_.is_singular(at) ? max_coinciding
                                                       : solutions_.all()[at].multiplicity);
        hits.push_back(at);
      }
    }
    return is_clear;
  }

  static constexpr std::size_t not_found = loop_solutions::not_found;

  /// True if the closure error is below a fraction of the loop's size.
  [[nodiscard]] bool is_nearly_closed(const six_coordinates& theta, double fraction) const {
    const closure_error closure(loop_, theta);
    return closure.twist.norm() < fraction * closure.size;
  }

  /// Index of the only solution near an angle at which the determinant vanishes, if it was found.
  [[nodiscard]] std::size_t known(const loop_order& order, double angle) const {
    constexpr double neighbourhood = .02, close = 1e-3;
    std::size_t result = not_found;
    for (std::size_t i = 0; i < solutions_.all().size(); ++i) {
      const double theta = solutions_.all()[i].theta[order.joint(System::hidden)];
      const double off = std::abs(wrap_angle(theta - angle));
      if (off < neighbourhood) {
        if (result != not_found || off > close) {
          return not_found;
        }
        result = i;
      }
    }
    return result;
  }

  const loop_equation& loop_;
  loop_solutions solutions_;
  bool is_doubtful_ = false; ///< true if there may be curves of solutions without a point found
  /// True if the loop that was solved last is well conditioned and all its zeros near the circle
  /// are real and separate.
  bool is_certain_ = false;
  /// True if a displaced loop had two complex solutions that may be real without the displacement.
  bool has_close_pair_ = false;
};

} // namespace

loop_equation with_disturbed_goal(loop_equation loop, double by, std::uint64_t seed) {
  loop.closing = small_vectors(loop, by, seed).displacement() * loop.closing;
  return loop;
}

bool is_beyond_reach(const loop_equation& loop) {
  double reach = 0; // upper bound
  for (const loop_joint& j : loop.joints) {
    reach += j.is_revolute ? 2 * length_of(j.point) : HUGE_VAL;
  }
  return length_of(loop.closing.translation) > reach;
}

bool is_always_singular(const loop_equation& loop) {
  six_coordinates theta;
  theta << .3, -1.1, .7, 1.9, -.6, 2.3;
  return smallest_singular_value(closure_error(loop, theta).jacobian) < 1e-9;
}

loop_solution_set eliminated(const loop_equation& loop) {
  return general_solver<elimination>(loop).solve();
}

loop_solution_set solve_two_prismatic(const loop_equation& loop) {
  loop_solution_set result = general_solver<two_prismatic>(loop).solve();
  result.method = solution_method::two_prismatic;
  return result;
}

DUET_ABI_END
} // namespace duet::detail
