// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "branches/loop_equation.hpp"
#include "branches/subproblems.hpp"

#include "tip_pose.hpp"
#include <duet/core/config.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace duet::detail {
DUET_ABI_BEGIN

bool close_loop(const loop_equation& loop, six_coordinates& theta, double size_of_angles) {
  constexpr double rounding = 2e-15, good = 1e-13, hopeful = 1e-6, singular = 1e-7;
  double before = HUGE_VAL;
  six_coordinates last = six_coordinates::Zero(), measured = theta;
  for (int k = 0; k < 60; ++k) {
    const closure_error closure(loop, theta);
    const double to_angle = closure.size / std::min(closure.size, size_of_angles);
    const double residual = std::sqrt(closure.twist.head<3>().squaredNorm() +
                                      to_angle * to_angle * closure.twist.tail<3>().squaredNorm()) /
                            closure.size;
    if (residual <= rounding || (residual <= good && residual >= before / 2)) {
      return true;
    }
    if ((k >= 20 && !(residual < .1)) || (k >= 40 && !(residual < hopeful))) {
      return false;
    }
    before = residual;
    measured = theta;
    six_coordinates step = closure.jacobian.partialPivLu().solve(closure.twist);
    if (residual <= good && !(step.norm() < singular)) {
      return true; // the residual is round-off, which a step would amplify
    }
    // Steps of this length close an error of fourth order.
    const double max_step = std::min(.5, 2 * closure.size * std::sqrt(std::sqrt(residual)));
    if (!(step.norm() < max_step)) { // damped least squares: min |J x − e|² + |e|² |x|²
      if (residual > 1e-7) {         // beyond the round-off of normal equations
        six_columns gram = closure.jacobian * closure.jacobian.transpose();
        gram.diagonal().array() += residual * residual;
        step = closure.jacobian.transpose() * gram.llt().solve(closure.twist);
      } else {
        Eigen::Matrix<double, 12, 7> equations; // with their right side as last column
        equations << closure.jacobian, closure.twist, residual * six_columns::Identity(),
            six_coordinates::Zero();
        const Eigen::HouseholderQR<Eigen::Matrix<double, 12, 7>> factors(equations);
        const auto r = factors.matrixQR().topRows<6>();
        step = r.leftCols<6>().triangularView<Eigen::Upper>().solve(r.col(6));
      }
      step *= std::min(1.0, max_step / step.norm());
      if (!step.allFinite()) {
        return false;
      }
    }
    // At a singularity step lengths decrease by a factor q: 1 + q + q² + … of
    // them are taken at once.
    const double lengths = last.norm() * step.norm(), q = step.norm() / last.norm();
    if (k % 3 == 2 && q < .95 && last.dot(step) > .9 * lengths) {
      theta += q / (1 - q) * step;
    }
    theta += step;
    last = step;
  }
  theta = measured;
  return before <= 5 * good; // round-off limits the accuracy where many solutions coincide
}

namespace {

/// Three rotations that move a point to its goal, if the goal is close to the point in which the
/// second axis meets the first, or the point to that in which it meets the third.
///
/// The distance of the point from the intersection is known to round-off as the length of a vector;
/// its square would lose half of the digits. The third rotation alone determines that length
/// (subproblem 3), and the other two then map one direction to another (subproblem 2).
struct folded_elbow {
  struct angles {
    double first = 0, second = 0, third = 0;
    int multiplicity = 1;
  };

  bool is_folded = false; ///< true if the goal or the point is that close
  bool is_certain = true; ///< true if all solutions are included and determined
  bool is_any = false;    ///< true if two angles are arbitrary: multiples of 90° are given
  std::vector<angles> all = {};

  folded_elbow(const loop_equation& loop, const vector3d& point, const vector3d& goal) {
    for (const bool is_goal : {true, false}) {
      if (!is_folded) {
        find(loop, point, goal, is_goal);
      }
    }
  }

private:
  /// Finds the solutions in one of both cases.
  ///
  /// \param is_goal  true: goal close to axes 1 and 2; false: point close to axes 2 and 3
  void find(const loop_equation& loop, const vector3d& point, const vector3d& goal, bool is_goal) {
    constexpr double close_by = 1e-3, rounding = 4e-15, coincident = 3e-14, certain = 3e-13;
    const loop_joint &first = loop.joints[0], &second = loop.joints[1], &third = loop.joints[2];
    const loop_joint &other = is_goal ? first : third, &elbow = is_goal ? third : first;
    const vector3d meeting = nearest_point(second, other);
    const vector3d fixed = (is_goal ? goal : point) - meeting;
    const double distance = length_of(fixed),
                 separation = length_of(cross(other.axis, meeting - other.point));
    if (!(distance < close_by && separation < close_by)) {
      return;
    }
    if (separation >
        rounding + 1e-3 * distance) { // too close for `angle_pairs`, too distant for subproblem 3
      is_certain = false;
      return;
    }
    is_folded = true;
    is_certain = distance > certain;
    is_any = !(distance > coincident);
    const rotating_vector moving(is_goal ? elbow.axis : -1 * elbow.axis,
                                 (is_goal ? point : goal) - elbow.point, elbow.point - meeting);
    for (const auto& [theta, multiplicity] : subproblem3(moving, distance)) {
      const auto add = [&, angle = theta, times = multiplicity](double alpha, double beta, int m) {
        all.push_back(is_goal ? angles{alpha, beta, angle, times * m}
                              : angles{angle, alpha, beta, times * m});
      };
      if (is_any) {
        constexpr double quarter_turn = std::numbers::pi / 2;
        for (int k = 0; k < 16; ++k) {
          add(k / 4 * quarter_turn, k % 4 * quarter_turn, 1);
        }
        continue;
      }
      const vector3d v = moving.at(theta), moved_direction = 1 / length_of(v) * v,
                     fixed_direction = 1 / distance * fixed;
      const subproblem2 both(is_goal ? first.axis : second.axis, is_goal ? second.axis : third.axis,
                             is_goal ? moved_direction : fixed_direction,
                             is_goal ? fixed_direction : moved_direction,
                             (rounding + separation) / distance);
      for (const auto& [alpha, beta, m] : both) {
        add(alpha, beta, m);
      }
      is_certain = is_certain && both.nearest() > 2 * close_by;
    }
  }
};

/// Error of the first three coordinates by round-off in the position of the centre.
[[nodiscard]] double first_error(const loop_equation& loop, const vector3d& centre,
                                 const six_coordinates& theta) {
  constexpr double rounding = 3e-15;
  const six_columns all = closure_error(loop, theta).jacobian;
  const Eigen::Vector3d goal = loop.closing.point(centre);
  Eigen::Matrix3d velocities;
  for (int i = 0; i < 3; ++i) {
    velocities.col(i) = all.col(i).head<3>() + all.col(i).tail<3>().cross(goal);
  }
  return rounding * velocities.inverse().norm();
}

/// Solves for the last three angles.
///
/// \param error  error of the first three coordinates, if it exceeds round-off
/// \return false if coordinates are undetermined
[[nodiscard]] bool solve_wrist(const loop_equation& loop, const vector3d& centre,
                               six_coordinates& theta, int multiplicity, double error,
                               const auto& visit) {
  const quaternion<double> rotation =
      conj(product_of_joints(loop, theta, 0, 3).rotation) * loop.closing.rotation;
  const double nearest = for_each_three_axis_decomposition(
      loop.joints[3], loop.joints[4], loop.joints[5], rotation,
      [&](double alpha, double beta, double gamma, int m) {
        theta.tail<3>() << alpha, beta, gamma;
        visit(theta, multiplicity * m);
      },
      error);
  constexpr double close_by = 1e-3;
  return error > 0
             ? nearest > std::max(2 * close_by, error)
             : nearest > close_by || (nearest > 0 && nearest > first_error(loop, centre, theta));
}

/// Closed-form solutions of a loop whose joints 4 to 6 have axes that meet in `centre`: calls
/// visit(θ, multiplicity) for each. exp(θ₁S₁) exp(θ₂S₂) exp(θ₃S₃) moves the centre to its goal, and
/// a rotation remains.
///
/// \return false if coordinates are undetermined
[[nodiscard]] bool solve_spherical(const loop_equation& loop, const vector3d& centre,
                                   const auto& visit) {
  const auto &first = loop.joints[0], &second = loop.joints[1], &third = loop.joints[2];
  const vector3d goal = loop.closing.point(centre);
  const folded_elbow folded(loop, centre, goal);
  bool is_determined = folded.is_certain;
  if (folded.is_folded) {
    bool is_met = false;
    const auto met = [&](const six_coordinates& all, int multiplicity) {
      is_met = true;
      visit(all, multiplicity);
    };
    for (const auto& [theta1, theta2, theta3, multiplicity] : folded.all) {
      if (!(folded.is_any && is_met)) {
        six_coordinates theta;
        theta << theta1, theta2, theta3, 0, 0, 0;
        const double error = folded.is_any ? 0 : first_error(loop, centre, theta);
        is_determined = solve_wrist(loop, centre, theta, multiplicity, error, met) && is_determined;
      }
    }
    return is_determined;
  }
  // In a frame with its origin on the second axis: the points e₃ c and e₁⁻¹ goal have the same
  // component along that axis and the same squared norm.
  const rotating_vector from(third.axis, centre - third.point, third.point - second.point);
  const rotating_vector to(-1 * first.axis, goal - first.point, first.point - second.point);
  const auto height = [&](const rotating_vector& x) { return part_along(second.axis, x); };
  const auto square = [&](const rotating_vector& x) {
    const double constant = dot(x.across, x.across) + dot(x.along, x.along);
    return first_harmonic{constant, 2 * dot(x.along, x.across), 2 * dot(x.along, x.normal)};
  };
  const angle_pairs pairs{{height(to), square(to)}, {height(from), square(from)}};
  connecting_rotation middle(second.axis, from, to, pairs.g[0], pairs.f[0]);
  const bool has_pairs = pairs([&](double near1, double near3, int m) {
    middle(near3, near1, m, [&](double theta3, double theta1, double theta2, int multiplicity) {
      six_coordinates theta;
      theta << theta1, theta2, theta3, 0, 0, 0;
      is_determined = solve_wrist(loop, centre, theta, multiplicity, 0, visit) && is_determined;
    });
  });
  return has_pairs && middle.nearest() > 0 && is_determined;
}

/// Function of θ₅ for a fifth axis that has become parallel to the first three: 0 where the
/// distance of the third axis from the first is at the centre of its range.
[[nodiscard]] first_harmonic beyond_reach(const loop_equation& loop, const six_coordinates& theta) {
  const auto &first = loop.joints[0], &second = loop.joints[1], &third = loop.joints[2],
             &fifth = loop.joints[4];
  const tip_pose after = loop.closing * inverse_pose(product_of_joints(loop, theta, 5, 1)),
                 before = inverse_pose(product_of_joints(loop, theta, 3, 1));
  const rotating_vector offset(-1 * fifth.axis, before.point(third.point) - fifth.point);
  const vector3d fixed_part =
      orthogonal_part(fifth.point - inverse_pose(after).point(first.point), fifth.axis);
  const double a = length_of(orthogonal_part(second.point - first.point, first.axis)),
               c = length_of(fixed_part),
               b = length_of(orthogonal_part(third.point - second.point, first.axis)),
               d = length_of(offset.across),
               radius = (std::max(std::abs(a - b), std::abs(c - d)) + std::min(a + b, c + d)) / 2;
  return {c * c + d * d - radius * radius, 2 * dot(fixed_part, offset.across),
          2 * dot(fixed_part, offset.normal)};
}

/// Solves for the first three angles.
///
/// \return false if coordinates are undetermined
[[nodiscard]] bool solve_plane(const loop_equation& loop, six_coordinates& theta, int multiplicity,
                               const auto& visit) {
  const auto &first = loop.joints[0], &second = loop.joints[1], &third = loop.joints[2];
  const tip_pose motion = loop.closing * inverse_pose(product_of_joints(loop, theta, 3, 3));
  const vector3d &n = first.axis, to = motion.point(third.point) - first.point;
  const double total_angle = angle_of(motion.rotation, n); // sum of angles about n and −n
  const vector3d offset = second.point - first.point;
  const rotating_vector arm(second.axis, third.point - second.point, offset);
  const vector3d across = orthogonal_part(offset, n), goal = orthogonal_part(to, n);
  connecting_rotation rotation(n, arm, to);
  const double error = multiplicity > 1 ? 2 * one_angle : 0; // error of the other angles
  const bool has_second = visit_zeros(
      {dot(across, across) + dot(arm.across, arm.across) - dot(goal, goal),
       2 * dot(across, arm.across), 2 * dot(across, arm.normal)},
      [&](double near2, int near_multiplicity) {
        rotation(near2, 0, near_multiplicity, [&](double theta2, double, double theta1, int m) {
          theta[0] = theta1;
          theta[1] = theta2;
          theta[2] = dot(n, third.axis) * (total_angle - theta1 - dot(n, second.axis) * theta2);
          visit(theta, multiplicity * m);
        });
      },
      error);
  // Angles that count as one may have put the third axis on the first.
  return has_second && rotation.nearest() > error;
}

/// Closed-form solutions of a loop whose joints 1 to 3 have parallel axes: calls visit(θ,
/// multiplicity) for each. exp(θ₅S₅) exp(θ₆S₆) closing⁻¹ and exp(−θ₄S₄) map the plane perpendicular
/// to the three axes to the same plane, and a motion of that plane remains.
///
/// \return false if coordinates are undetermined
[[nodiscard]] bool solve_planar(const loop_equation& loop, const auto& visit) {
  const auto &fourth = loop.joints[3], &fifth = loop.joints[4], &sixth = loop.joints[5];
  const vector3d n = loop.joints[0].axis;
  const tip_pose opening = inverse_pose(loop.closing);
  const vector3d goal_normal = rotated(opening.rotation, n);
  const double goal_distance = dot(goal_normal, opening.translation);
  // Rotations of a plane about the fifth axis preserve the component of its normal along that
  // axis and its distance from a point on that axis.
  const rotating_vector from(sixth.axis, goal_normal), to(-1 * fourth.axis, n);
  const auto distance = [&](const rotating_vector& x, double before, const vector3d& offset) {
    first_harmonic result = part_along(offset, x);
    result.a += before;
    return result;
  };
  const angle_pairs pairs{
      {part_along(fifth.axis, to), distance(to, -dot(n, fourth.point), fourth.point - fifth.point)},
      {part_along(fifth.axis, from),
       distance(from, goal_distance - dot(goal_normal, sixth.point), sixth.point - fifth.point)}};
  connecting_rotation middle(fifth.axis, from, to, pairs.g[1], pairs.f[1]);
  bool is_determined = true;
  const bool has_pairs = pairs([&](double near4, double near6, int m) {
    middle(near6, near4, m, [&](double theta6, double theta4, double theta5, int multiplicity) {
      six_coordinates theta;
      theta << 0, 0, 0, theta4, theta5, theta6;
      const auto visit_plane = [&](double angle, int times) {
        theta[4] = angle;
        is_determined = solve_plane(loop, theta, times, visit) && is_determined;
      };
      if (!middle.is_open() || !visit_zeros(beyond_reach(loop, theta), visit_plane)) {
        visit_plane(theta5, multiplicity);
      }
    });
  });
  return has_pairs && middle.nearest() > 0 && is_determined;
}

/// Closed-form solutions of a loop of three revolute and three prismatic joints: calls visit(θ,
/// multiplicity) for each. Revolute joints alone make the rotation, prismatic displacements the
/// rest.
///
/// \return false if coordinates are undetermined
[[nodiscard]] bool solve_three_prismatic(const loop_equation& loop, const auto& visit) {
  std::array<int, 3> revolute{}, prismatic{};
  for (int i = 0, revolute_count = 0, prismatic_count = 0; i < 6; ++i) {
    (loop.joints[std::size_t(i)].is_revolute ? revolute[std::size_t(revolute_count++)]
                                             : prismatic[std::size_t(prismatic_count++)]) = i;
  }
  const auto joint = [&](std::size_t k) { return loop.joints[std::size_t(revolute[k])]; };
  bool is_determined = true;
  const double nearest = for_each_three_axis_decomposition(
      joint(0), joint(1), joint(2), loop.closing.rotation,
      [&](double alpha, double beta, double gamma, int multiplicity) {
        six_coordinates theta = six_coordinates::Zero();
        theta[revolute[0]] = alpha;
        theta[revolute[1]] = beta;
        theta[revolute[2]] = gamma;
        const closure_error closure(loop, theta);
        Eigen::Matrix3d directions;
        for (int k = 0; k < 3; ++k) {
          directions.col(k) = closure.jacobian.col(prismatic[std::size_t(k)]).head<3>();
        }
        const Eigen::Matrix3d inverse = directions.inverse();
        is_determined = is_determined && inverse.norm() < 1e15 / directions.norm();
        const Eigen::Vector3d d = inverse * closure.twist.head<3>();
        for (int k = 0; k < 3; ++k) {
          theta[prismatic[std::size_t(k)]] = d[k];
        }
        visit(theta, multiplicity);
      });
  return nearest > 0 && is_determined;
}

/// Loop that begins with one of two such prismatic joints.
struct parallel_prismatic {
  loop_equation loop;
  std::size_t first;  ///< index of that joint in the given loop
  std::size_t second; ///< index of the other one in this loop
};

/// Pair of such prismatic joints, if only rotations about their common direction are between them,
/// in one direction of the loop or the other.
[[nodiscard]] std::optional<parallel_prismatic> parallel_prismatic_of(const loop_equation& loop) {
  loop_equation from = loop;
  for (std::size_t first = 0; first < 6; ++first) {
    const loop_joint& prismatic = from.joints[0];
    std::size_t k = 1;
    while (k < 6 && from.joints[k].is_revolute && is_on(prismatic.axis, from.joints[k].axis)) {
      ++k;
    }
    if (!prismatic.is_revolute && k < 6 && !from.joints[k].is_revolute &&
        is_on(prismatic.axis, from.joints[k].axis)) {
      return parallel_prismatic{from, first, k};
    }
    from = from.shifted();
  }
  return {};
}

/// Gauss–Newton method for all coordinates except one, which is fixed.
///
/// \return true if it closes the loop
[[nodiscard]] bool close_with_fixed(const loop_equation& loop, Eigen::Index fixed,
                                    six_coordinates& theta) {
  constexpr double rounding = 1e-12;
  for (int k = 0; k < 6; ++k) {
    const closure_error closure(loop, theta);
    Eigen::Matrix<double, 6, 5> moving;
    moving << closure.jacobian.leftCols(fixed), closure.jacobian.rightCols(5 - fixed);
    const Eigen::Matrix<double, 5, 1> step = moving.householderQr().solve(closure.twist);
    theta.head(fixed) += step.head(fixed);
    theta.tail(5 - fixed) += step.tail(5 - fixed);
  }
  const closure_error closure(loop, theta);
  return closure.twist.norm() <= rounding * closure.size;
}

/// Solutions in which the second of the prismatic joints is at 0.
[[nodiscard]] loop_solution_set solve_parallel_prismatic(const parallel_prismatic& pair) {
  const auto fixed = Eigen::Index(pair.second);
  const Eigen::Vector3d n = pair.loop.joints[pair.second].axis, u = n.unitOrthogonal();
  loop_equation across = pair.loop; // no known arm has an axis in that direction
  across.joints[pair.second].axis =
      components(Eigen::Vector3d(std::cos(.7) * u + std::sin(.7) * n.cross(u)));
  const loop_solution_set all = solve_two_prismatic(across);
  loop_solution_set result;
  for (loop_solution each : all.solutions) {
    constexpr double close_to_zero = 1e-5; // double solutions are less accurate
    const bool is_unused = std::abs(each.theta[fixed]) < close_to_zero;
    each.theta[fixed] = 0;
    if (is_unused && close_with_fixed(pair.loop, fixed, each.theta)) {
      six_coordinates theta;
      for (Eigen::Index k = 0; k < 6; ++k) {
        theta[(k + Eigen::Index(pair.first)) % 6] = each.theta[k];
      }
      result.solutions.push_back({theta, each.multiplicity});
    }
  }
  result.method = solution_method::two_prismatic;
  result.is_complete = all.is_complete && result.solutions.empty();
  const double second_factor =
      dot(pair.loop.joints[0].axis, pair.loop.joints[pair.second].axis) > 0 ? -1 : 1;
  result.coupled_pair = {int(pair.first), int((pair.first + pair.second) % 6), second_factor};
  return result;
}

/// Common point of the axes of three joints, if there is one.
[[nodiscard]] std::optional<vector3d> common_point(const loop_joint& a, const loop_joint& b,
                                                   const loop_joint& c) {
  constexpr double rounding = 1e-9, across = 1e-6;
  if (!a.is_revolute || !b.is_revolute || !c.is_revolute ||
      length_of(cross(a.axis, b.axis)) < across || length_of(cross(b.axis, c.axis)) < across) {
    return {};
  }
  const vector3d point = nearest_point(a, b);
  const auto is_on_axis = [&](const loop_joint& j) {
    return length_of(cross(j.axis, point - j.point)) < rounding;
  };
  return is_on_axis(b) && is_on_axis(c) ? std::optional(point) : std::nullopt;
}

[[nodiscard]] bool are_parallel(const loop_joint& a, const loop_joint& b) {
  return a.is_revolute && b.is_revolute && is_on(a.axis, b.axis);
}

/// Solutions of the loop that begins with joint number `first` by one of the closed forms; nothing
/// if none is found and coordinates are undetermined.
[[nodiscard]] std::optional<loop_solution_set>
solved(solution_method method, int first, const loop_equation& loop, const auto& solve_form) {
  const int max_solutions = method == solution_method::three_prismatic ? 2 : 8;
  constexpr double rounding = 1e-13, nearby = .01;
  loop_solution_set result{.complex_solutions = max_solutions, .method = method};
  result.is_complete = solve_form([&](six_coordinates theta, int multiplicity) {
    const closure_error closure(loop, theta);
    if (closure.twist.norm() > rounding * closure.size) { // near a singularity
      six_coordinates refined = theta;
      if (close_loop(loop, refined) && (refined - theta).norm() < nearby * closure.size) {
        theta = refined;
      } else if (multiplicity > 1) {
        return; // a complex pair that is nearly real
      }
    }
    loop_solution solution{theta, multiplicity};
    const six_coordinates wrapped = loop.wrapped(theta);
    for (int k = 0; k < 6; ++k) {
      solution.theta[(k + first) % 6] = wrapped[k];
    }
    result.solutions.push_back(solution);
    result.complex_solutions -= multiplicity;
  });
  if (!result.is_complete && result.solutions.empty()) {
    return {};
  }
  result.complex_solutions = std::max(0, result.complex_solutions);
  return result;
}

/// Solutions by the method that suits the geometry of the loop.
[[nodiscard]] loop_solution_set solved_by_geometry(const loop_equation& loop) {
  const auto& joints = loop.joints;
  const auto prismatic_count = std::count_if(joints.begin(), joints.end(),
                                             [](const loop_joint& j) { return !j.is_revolute; });
  if (prismatic_count == 3) {
    return solved(solution_method::three_prismatic, 0, loop,
                  [&](const auto& visit) { return solve_three_prismatic(loop, visit); })
        .value_or(loop_solution_set{});
  }
  if (prismatic_count == 2) {
    const auto pair = parallel_prismatic_of(loop);
    return pair ? solve_parallel_prismatic(*pair) : solve_two_prismatic(loop);
  }
  for (std::size_t i = 0; i < 4 && prismatic_count == 0; ++i) {
    const loop_joint &a = joints[i], &b = joints[i + 1], &c = joints[i + 2];
    const int first = int(i), after = (first + 3) % 6;
    std::optional<loop_solution_set> result;
    if (const auto centre = common_point(a, b, c)) {
      const vector3d in_loop = after == 0 ? *centre : inverse_pose(loop.closing).point(*centre);
      const loop_equation shifted = loop.shifted(after);
      result = solved(solution_method::spherical_wrist, after, shifted,
                      [&](const auto& visit) { return solve_spherical(shifted, in_loop, visit); });
    } else if (are_parallel(a, b) && are_parallel(b, c)) {
      const loop_equation shifted = loop.shifted(first);
      result = solved(solution_method::parallel_axes, first, shifted,
                      [&](const auto& visit) { return solve_planar(shifted, visit); });
    }
    if (result) {
      return std::move(*result);
    }
  }
  return eliminated(loop);
}

} // namespace

loop_solution_set solutions_of(const loop_equation& loop) {
  loop_solution_set result = solved_by_geometry(loop);
  if (result.method == solution_method::two_prismatic) {
    return result; // which detects permanent self-motion itself
  }
  const bool is_certain = result.solutions.empty() && is_beyond_reach(loop);
  // Round-off may have made a double solution complex: with a goal nearby it is complex or two real
  // ones. Elimination searches near the goal, too.
  constexpr int attempts = 6;
  constexpr double displacement = 1e-7;
  const bool is_near = !is_certain && result.method != solution_method::elimination;
  for (int k = 0; is_near && k < attempts && result.solutions.empty(); ++k) {
    const auto nearby = with_disturbed_goal(loop, displacement, std::uint64_t(k) + 1);
    for (loop_solution x : solved_by_geometry(nearby).solutions) {
      result.is_complete = false;
      if (result.solutions.empty() && close_loop(loop, x.theta)) {
        result.solutions.push_back(x);
        result.complex_solutions = std::max(0, result.complex_solutions - x.multiplicity);
      }
    }
  }
  result.is_complete = is_certain || (result.is_complete && !is_always_singular(loop));
  return result;
}

DUET_ABI_END
} // namespace duet::detail
