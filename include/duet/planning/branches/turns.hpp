// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/vector_sine_cosine.hpp>
#include <duet/planning/branches/angle_pairs.hpp>
#include <duet/planning/branches/joint_loop.hpp>
#include <duet/planning/branches/middle_turn.hpp>
#include <duet/planning/planning_model.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

/// \file
/// Turns about given axes that make a given one.

namespace duet::detail {

[[nodiscard]] inline bool is_on(const vector3d& n, const vector3d& v) {
  constexpr double rounding = 1e-9;
  return length_of(cross(n, v)) < rounding;
}
/// The angle of a rotation about n.
[[nodiscard]] inline double angle_of(const quaternion<double>& q, const vector3d& n) {
  return 2 * std::atan2(n.x * q.x() + n.y * q.y() + n.z * q.z(), q.w());
}

/// The product of the rotations by α and β about axes a and b.
[[nodiscard]] inline quaternion<double> two_turns(const vector3d& a, double alpha,
                                                  const vector3d& b, double beta) {
  const sines_at_once<2> halves(alpha / 2, beta / 2);
  return turn_about(a, halves.sine(0), halves.cosine(0)) *
         turn_about(b, halves.sine(1), halves.cosine(1));
}

/// Two turns, first by β about b, then by α about a, that take one unit vector to another.
class two_turns_between {
public:
  struct solution {
    double alpha = 0, beta = 0;
    int multiplicity = 1;
  };

  /// \param error  of the vectors, if that is more than rounding
  two_turns_between(const vector3d& a, const vector3d& b, const vector3d& from, const vector3d& to,
                    double error = 0) {
    const turned_vector by_b(b, from);
    middle_turn first(a, by_b, to);
    const bool has_beta = visit_zeros(
        {dot(a, by_b.along) - dot(a, to), dot(a, by_b.across), dot(a, by_b.beside)},
        [&](double near_beta, int near_multiplicity) {
          first(near_beta, 0, near_multiplicity, [&](double beta, double, double alpha, int m) {
            all_[std::size_t(count_++)] = {alpha, beta, m};
          });
        },
        error);
    nearest_ = !has_beta ? 0 : first.nearest();
    if (error > 0) {
      nearest_ = std::min(nearest_, length_of(cross(a, to)));
    }
  }

  [[nodiscard]] const solution* begin() const { return all_.data(); }
  [[nodiscard]] const solution* end() const { return all_.data() + count_; }
  /// How far the vector has been from the axis a, at least; 0 where α or β are undetermined. With
  /// an error, which there decides if angles are complex, also how far it is to be.
  [[nodiscard]] double nearest() const { return nearest_; }

private:
  std::array<solution, 4> all_; // two values of β, beside each of which there may be another
  int count_ = 0;
  double nearest_ = 0;
};

/// Calls visit(α, β, γ, multiplicity) where turns by α, β and γ about the axes of three joints are,
/// one after the other, a given one.
/// \param error  of that one, if that is more than rounding
/// \return how far the last axis has been from the first, at least, as the sine of the angle
/// between them; 0 where α or β are undetermined
template <class Visit>
double visit_three_turns(const loop_joint& a, const loop_joint& b, const loop_joint& c,
                         const quaternion<double>& turn, const Visit& visit, double error = 0) {
  // The last axis stays where it is in the last turn, the angle between it and the first in that.
  const two_turns_between both(a.axis, b.axis, c.axis, rotated(turn, c.axis), error);
  for (const auto& [alpha, beta, multiplicity] : both) {
    const quaternion<double> before = two_turns(a.axis, alpha, b.axis, beta);
    visit(alpha, beta, angle_of(conj(before) * turn, c.axis), multiplicity);
  }
  return both.nearest();
}

} // namespace duet::detail
