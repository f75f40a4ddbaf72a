// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"
#include "support/allocations.hpp"

#include <duet/spline/bspline_segment.hpp>

#include <span>

TEST_CASE("curves: evaluation does not allocate memory") {
  const auto knots = duet_test::knot_vectors(4)[1].knots;
  const duet::cumulative_bspline<double> s(knots,
                                           duet_test::random_orientations(knots.size() - 4, 1));
  const auto parameters = duet_test::parameters_on(knots, 4);
  std::vector<duet::dual_quaternion<double>> poses;
  for (const auto& q : s.control_points()) {
    poses.push_back(duet::pose(q, duet::vector3<double>(1, 2, 3)));
  }
  const duet::cumulative_bspline<duet::screw_dual<double>> p(knots, poses);
  // Curves of rotation vectors over the same domain.
  const std::vector<double> ends{parameters.front(), parameters.back()};
  const duet::vector3<double> w(0.1, 0.2, -0.3);
  const duet::rotation_vector_spline<double, 6> r(
      ends, {s.control_points()[0], s.control_points()[1]}, {{w, w}, {w, w}});
  using dual_vector = duet::dual_vector<double>;
  const dual_vector v = duet::make_dual_vector(w, w);
  const duet::rotation_vector_spline<duet::screw_dual<double>> rp(ends, {poses[0], poses[1]},
                                                                  {{v}, {v}});
  const duet::segment_basis<4> segment_basis(std::span<const double, 6>(&knots[1], 6));
  const std::span<const duet::quaternion<double>, 4> controls(s.control_points().data(), 4);
  const duet::bspline_segment<double> segment(controls, segment_basis);
  duet::span_hint hint;
  double sum = 0;
  const std::size_t before = duet_test::allocations;
  for (const double u : parameters) {
    sum += s(u).w();
    sum += s.motion(u, duet::frame::body).jerk[0];
    sum += s.motion(u, duet::frame::spatial).acceleration[1];
    sum += s.derivatives(u)[3].z();
    sum += s.motion(u, duet::frame::body, hint).jerk[0];
    sum += p.motion(u, duet::frame::hybrid).acceleration[0];
    sum += r(u).x() + r.motion(u, duet::frame::spatial).jerk[2] + r.derivatives(u)[3].x();
    sum += rp.motion(u, duet::frame::hybrid, hint).jerk[5];
    sum += s.motion_jacobian<3>(u, duet::frame::body).jerk.block(0)(0, 0);
    sum += p.motion_jacobian<2>(u, duet::frame::hybrid, duet::perturbation::left, hint)
               .acceleration.block(1)(5, 5);
    sum += s.knot_jacobian(u, duet::frame::body).exists[0] ? 1 : 0;
    sum +=
        segment.motion_jacobian<2>(segment_basis.front(), duet::frame::body).value.block(3)(0, 0);
    sum += r.motion_jacobian<1>(u, duet::frame::body).value.block(1)(0, 0);
    sum += duet::printed_derivative(s, u).literal_second.x();
    sum += s(duet::dual<double>::variable(u)).w().epsilon();
    sum += duet::derivatives<2>([&](const auto& x) { return s(x); }, u)[2].y();
  }
  const std::size_t during = duet_test::allocations - before;
  CHECK(during == 0);
  CHECK(sum == sum);

  const std::size_t start = duet_test::allocations; // the counter works
  const std::vector<double> copy = parameters;
  CHECK(duet_test::allocations > start);
  CHECK(copy.size() == parameters.size());
}
