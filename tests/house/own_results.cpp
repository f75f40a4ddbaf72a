// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// No public function whose result type is deduced returns an expression of Eigen: it would refer to
// arguments and local variables that are gone when `auto` keeps the result.

#include <duet/duet.hpp>
#include <duet/robotics/objective.hpp>

#include <array>
#include <tuple>
#include <type_traits>
#include <utility>

namespace {

using namespace duet;

/// Types that own their numbers.
template <class X>
concept Own = !detail::refers_elsewhere<X>;

template <class... X>
constexpr void check(const X&...) {
  static_assert((Own<X> && ...));
}

using vector = vector3<double>;
using rotation_type = quaternion<double>;
using pose_type = dual_quaternion<double>;
using joints = Eigen::Matrix<double, 7, 1>;
using several = Eigen::VectorXd;

// Expressions are accepted as arguments.
void check_vectors(const vector& x, const several& y) {
  const auto twice = [](const auto& v) { return (v + v).eval(); };
  const auto [a, j] = jacobian(twice, x + x);
  const auto [b, g] = gradient([](const auto& v) { return v.squaredNorm(); }, y + y);
  const auto equations = [](const auto& v, const auto& u) {
    return make_vector(v[0] - u, v[1] + u);
  };
  using loop = decltype(constrained_mechanism(equations, x.head<2>() * 2, 1));
  static_assert(std::is_same_v<loop, constrained_mechanism<std::remove_const_t<decltype(equations)>,
                                                           Eigen::Vector2d, double>>);
  check(a, j, b, g, make_vector(1.0, 2), map_scalars([](double z) { return z; }, x + x));
}

void check_rotations(const rotation_type& q, const vector& x) {
  check(q.vec(), rotate(q, x), rotation_vector(q), rotation_matrix(q), log(q), exp(x),
        angular_velocity(q, q, frame::body), quaternion_rate(q, x, frame::spatial),
        quaternion_rate_matrix(q, frame::body), euler<zyx>(q), euler_rate_matrix<zyx>(.1, .2),
        from_euler<zyx>(.1, .2, 0), slerp(q, q, .5), left_jacobian(x), right_jacobian_inverse(x));
}

void check_poses(const pose_type& a, const vector& x, const vector6<double>& v) {
  check(translation(a), transform_point(a, x), transform_direction(a, x), transform_matrix(a),
        transform_line(a, make_dual_vector(x, x)), twist(a, a, frame::hybrid),
        pose_rate(a, v, frame::body), twist_of(make_dual_vector(x, x)), dual_vector_of(v), Ad(a),
        ad(v), coAd(a), coad(v), left_jacobian(v), right_jacobian_inverse(v), pose_coordinates(a),
        pose_rate_matrix(a), pose_coordinates_rate(a, v), sclerp(a, a, .5));
  const auto screw = screw_parameters(a);
  check(screw.axis, screw.moment, transform_plane(a, plane<double>{x, 1}).normal);
}

void check_chains(const joints& theta, const vector6<double>& w) {
  const auto arm = robots::panda();
  const auto spatial = frame::spatial;
  check(arm.pose(theta + theta), jacobian(arm, theta + theta, spatial),
        kinematic_hessian(arm, theta, spatial)[0], jacobian_rate(arm, theta, theta, spatial),
        pose_coordinates_jacobian(arm, theta), euler_jacobian<zyx>(arm, theta),
        joint_efforts(arm, theta, w, spatial), lower_limits(arm), upper_limits(arm));
  const auto [a, j] = pose_and_jacobian(arm, theta + theta, spatial);
  const auto [m, rate] = jacobian_with_rate(arm, theta, theta + theta, spatial);
  const preferred_posture posture{theta + theta, 2.0};
  check(a, j, m, rate, posture.posture, posture.gradient(theta + theta));
}

void check_ends(const vector& x) {
  const clamped given{x + x, x - x};
  const end_acceleration accelerated{x + x, x};
  check(given.start, given.end, accelerated.start, accelerated.end);
}

void check_formulas(const vector& x) {
  using namespace duet::expression;
  constexpr vector_symbol<"w"> w;
  constexpr symbol<"u"> u;
  constexpr quaternion_symbol<"q"> q;
  const auto f = u * cross(w, x + x) + rotate(q, w);
  const rotation_type identity(1);
  check(f(u = 1, w = x + x, q = identity), derivative(f, u)(u = 1, w = x, q = identity));
}

} // namespace

int main() {
  check_vectors(vector(1, 2, 3), several::Ones(2));
  check_rotations(rotation_type(1), vector(1, 2, 3));
  check_poses(pose_type(rotation_type(1)), vector(1, 2, 3), vector6<double>::Ones());
  check_chains(joints::Zero(), vector6<double>::Ones());
  check_ends(vector(1, 2, 3));
  check_formulas(vector(1, 2, 3));
}
