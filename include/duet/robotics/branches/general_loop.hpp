// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/robotics/branches/connecting_rotation.hpp>
#include <duet/robotics/branches/elimination.hpp>
#include <duet/robotics/branches/loop_equation.hpp>
#include <duet/robotics/branches/loop_solution_set.hpp>
#include <duet/robotics/branches/loop_solutions.hpp>
#include <duet/robotics/branches/singular_value.hpp>
#include <duet/robotics/branches/two_prismatic.hpp>
#include <duet/robotics/splitmix64.hpp>
#include <duet/robotics/tip_pose.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// All solutions of a loop of six joints in general position.

namespace duet::detail {

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
/// 0 if their axes meet or are parallel; |n₁ × n₂| if both are prismatic, a quarter of it if one
/// is. The third and the sixth joint must be revolute.
[[nodiscard]] inline double quality_of(const loop_equation& loop, const elimination*) {
  const loop_joint &a = loop.joints[0], &b = loop.joints[1];
  const auto across = cross(a.axis, b.axis);
  return !loop.joints[2].is_revolute || !loop.joints[5].is_revolute ? 0
         : a.is_revolute && b.is_revolute ? std::abs(dot(a.point - b.point, across))
         : a.is_revolute || b.is_revolute ? length_of(across) / 4
                                          : length_of(across);
}
/// Quality of an order for two prismatic joints: the first joint must be revolute, and no axis of
/// the other three revolute joints parallel to the next.
[[nodiscard]] inline double quality_of(const loop_equation& loop, const two_prismatic*) {
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

/// Loop with a goal close to the given one.
[[nodiscard]] inline loop_equation with_disturbed_goal(loop_equation loop, double by,
                                                       std::uint64_t seed) {
  loop.closing = small_vectors(loop, by, seed).displacement() * loop.closing;
  return loop;
}
/// Loop with a goal and axes in general position, close to the given ones.
[[nodiscard]] inline loop_equation disturbed(loop_equation loop, double by, std::uint64_t seed) {
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
};

[[nodiscard]] inline std::vector<zero_on_circle>
zeros_on_circle(std::span<const std::complex<double>> roots) {
  constexpr double real = 1e-9, nearly_real = .2, neighbourhood = .02;
  std::vector<zero_on_circle> result;
  for (const std::complex<double>& z : roots) {
    const double off = std::log(std::abs(z)); // the conjugate pair has −off
    if (off > -real && off < nearly_real) {
      result.push_back({std::arg(z), off, off < real});
    }
  }
  for (zero_on_circle& one : result) {
    one.is_single = std::count_if(result.begin(), result.end(), [&](const zero_on_circle& other) {
                      return std::abs(wrap_angle(other.angle - one.angle)) < neighbourhood;
                    }) == 1;
  }
  return result;
}

/// Solutions of a loop, from those of slightly displaced loops.
template <class System>
class general_solver {
public:
  explicit general_solver(const loop_equation& loop) : solutions_(loop) {}

  [[nodiscard]] const loop_solutions& solutions() const { return solutions_; }
  /// True if there may be solutions on curves of which no point was found.
  [[nodiscard]] bool is_doubtful() const { return is_doubtful_; }

  /// True if the loop that was solved last is well conditioned and all its zeros near the circle
  /// are real and separate.
  [[nodiscard]] bool is_certain() const { return is_certain_; }

  /// True if a displaced loop had two complex solutions that may be real without the displacement.
  [[nodiscard]] bool has_close_pair() const { return has_close_pair_; }

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
    constexpr double singular = 1e-4, vanishing = 1e-6, sound = .05, nearly_real = .05;
    constexpr int max_coinciding = 4;
    const System system(disturbed(order.loop, by, seed));
    const auto roots = system.roots();
    if (!is_doubtful_ && !(roots.regularity > singular)) {
      is_doubtful_ = true;
      add_from_random_guesses();
    }
    std::vector<std::size_t> hits;
    bool is_clear = roots.regularity * squared_travel(order.loop) > vanishing;
    is_certain_ = roots.regularity > 100 * singular && order.quality > sound;
    for (const zero_on_circle& zero : zeros_on_circle(roots.values)) {
      std::size_t at = zero.is_real && zero.is_single ? known(order, zero.angle) : not_found;
      if (at == not_found) {
        system.solution_at(zero.angle, [&](const six_coordinates& theta) {
          at = solutions_.add(order.in_loop(theta));
        });
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

private:
  static constexpr std::size_t not_found = loop_solutions::not_found;

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

  loop_solutions solutions_;
  bool is_doubtful_ = false, is_certain_ = false, has_close_pair_ = false;
};

/// True if the goal is farther away than the joints can reach.
[[nodiscard]] inline bool is_beyond_reach(const loop_equation& loop) {
  double reach = 0; // upper bound
  for (const loop_joint& j : loop.joints) {
    reach += j.is_revolute ? 2 * length_of(j.point) : HUGE_VAL;
  }
  return length_of(loop.closing.translation) > reach;
}

/// True if no solution is regular, whatever the goal, as if two neighbouring joints rotate about
/// one axis.
[[nodiscard]] inline bool is_always_singular(const loop_equation& loop) {
  six_coordinates theta;
  theta << .3, -1.1, .7, 1.9, -.6, 2.3;
  return smallest_singular_value(closure_error(loop, theta).jacobian) < 1e-9;
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
/// curve, or near what is nearly a curve.
template <class System>
[[nodiscard]] loop_solution_set solve_general_loop(const loop_equation& loop) {
  constexpr std::array by{1e-4, 1e-5, 1e-6, 1e-4, 1e-7, 1e-3, 1e-8, 1e-5};
  const auto orders = orders_of<System>(loop, disturbed(loop, by[0], 1));
  general_solver<System> solver(loop);
  const loop_solutions& solutions = solver.solutions();
  const auto needed = [&] {
    const double sigma = solutions.smallest_singular_value();
    return solutions.all().empty()                  ? 5 // each may make a double solution complex
           : sigma < .01 || solver.has_close_pair() ? 3
           : sigma < .04 || !solver.is_certain()    ? 2
                                                    : 1;
  };
  int agreeing = 0, quiet = 0;
  const auto is_even = [&] { return !solutions.is_count_certain() || solutions.count() % 2 == 0; };
  const auto is_enough = [&](std::size_t loops) {
    return agreeing >= needed() || (solutions.on_curves() > 0 && loops == 5);
  };
  for (std::size_t k = 0; k < by.size() && !is_enough(k); ++k) {
    const auto before = solutions.all().size();
    const bool is_clear = solver.add(orders[k % orders.size()], by[k], k + 2) && is_even();
    const bool has_grown = solutions.all().size() != before;
    quiet = has_grown ? 0 : quiet + 1;
    agreeing = has_grown ? int(is_clear) : agreeing + is_clear;
  }
  const bool agree = agreeing >= needed() || (quiet >= 3 && agreeing > 0 && is_even());
  if (solutions.all().empty()) {
    solver.add_from_random_guesses(); // finds a singular solution, or a curve of them
  }
  loop_solution_set result;
  result.solutions = solutions.all();
  result.complex_solutions = std::max(0, System::max_solutions - solutions.count());
  result.is_complete =
      agree && solutions.on_curves() == 0 && !solutions.is_near_curve() &&
      !(solutions.all().empty() && (solver.is_doubtful() || solver.has_close_pair()));
  return result;
}

} // namespace duet::detail
