// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curve_jacobians.hpp"

#include <duet/quaternion/quaternion_order.hpp>
#include <duet/spline/bspline_segment.hpp>
#include <duet/spline/split_bspline.hpp>

#include <span>

namespace test_spline_bspline_segment {
namespace {

using duet::perturbation;
using duet::quaternion;
using duet::quaternion_order;
using screw = duet::screw_dual<double>;

template <class T, int Order>
duet::bspline_segment<T, Order> segment_of(const duet::cumulative_bspline<T, Order>& s, double u) {
  const std::size_t first = s.basis().first_function(s.basis().find_span(u));
  const std::span<const double, 2 * std::size_t(Order) - 2> knots(&s.basis().knots()[first + 1],
                                                                  2 * std::size_t(Order) - 2);
  return {std::span<const quaternion<T>, std::size_t(Order)>(&s.control_points()[first],
                                                             std::size_t(Order)),
          knots};
}

template <class T, int Order>
void compare_with_curve(double step) {
  for (const auto& [name, knots] : duet_test::knot_vectors(Order)) {
    const auto s = duet_test::curve_of_steps<T, Order>(knots, step, 3);
    for (const double u : duet_test::parameters_on(knots, Order, 1)) {
      const auto segment = segment_of(s, u);
      const auto a = segment.template motion_jacobian<3>(u, duet::frame::spatial);
      const auto b = s.template motion_jacobian<3>(u, duet::frame::spatial);
      const auto is_close = [](const auto& x, const auto& y, double size) {
        return (x - y).cwiseAbs().maxCoeff() <= 1e-13 * std::max(size, y.cwiseAbs().maxCoeff());
      };
      CHECK(duet_test::max_abs_difference(a.motion.value, b.motion.value) <= 4e-15);
      CHECK(is_close(a.value.matrix(), b.value.matrix(), 1));
      CHECK(is_close(a.velocity.matrix(), b.velocity.matrix(), 1));
      CHECK(is_close(a.acceleration.matrix(), b.acceleration.matrix(), 1));
      CHECK(is_close(a.jerk.matrix(), b.jerk.matrix(), 1));
      CHECK(duet_test::max_abs_difference(segment(u), s(u)) <= 4e-15);
      CHECK(is_close(segment.motion(u, duet::frame::body).velocity,
                     s.motion(u, duet::frame::body).velocity, 0));
      const auto by_knots = segment.knot_jacobian(u, duet::frame::body);
      CHECK(by_knots.exists == s.knot_jacobian(u, duet::frame::body).exists);
    }
  }
}

TEST_CASE("bspline_segment: equals the curve that it is a span of") {
  compare_with_curve<double, 2>(0.7);
  compare_with_curve<double, 4>(1e-9);
  compare_with_curve<double, 5>(3.1);
  compare_with_curve<screw, 4>(0.7);
}

TEST_CASE("bspline_segment: reads both storage orders") {
  const auto knots = duet_test::knot_vectors(4)[0].knots;
  const auto s = duet_test::curve_of_steps<double, 4>(knots, 0.7, 3);
  const auto p = duet_test::curve_of_steps<screw, 4>(knots, 0.7, 3);
  const std::span<const double, 6> window(&knots[1], 6);
  const double u = (knots[3] + knots[4]) / 2;
  for (const auto order : {quaternion_order::wxyz, quaternion_order::xyzw}) {
    std::array<std::array<double, 7>, 4> numbers;
    std::array<const double*, 4> rotations, poses;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto t = translation(p.control_points()[i]);
      numbers[i] = {t[0], t[1], t[2], 0, 0, 0, 0};
      duet::store_quaternion(s.control_points()[i], &numbers[i][3], order);
      CHECK(duet::load_quaternion(&numbers[i][3], order) == s.control_points()[i]);
      poses[i] = numbers[i].data();
      rotations[i] = &numbers[i][3];
    }
    CHECK(numbers[0][order == quaternion_order::wxyz ? 3 : 6] == s.control_points()[0].w());
    const duet::bspline_segment<double> of_rotations(rotations.data(), order, window);
    CHECK(duet_test::max_abs_difference(of_rotations(u), s(u)) <= 1e-15);
    const duet::bspline_segment<screw> of_poses(poses.data(), order, window);
    CHECK(duet_test::max_abs_difference(rotation(of_poses(u)), rotation(p(u))) <= 1e-15);
    CHECK((translation(of_poses(u)) - translation(p(u))).norm() <= 1e-14);
  }
}

TEST_CASE("bspline_segment: rejects signs that are not aligned, norms, knots and parameters") {
  const auto knots = duet_test::knot_vectors(4)[0].knots;
  const auto s = duet_test::curve_of_steps<double, 4>(knots, 0.7, 3);
  const duet::segment_basis<4> basis(std::span<const double, 6>(&knots[1], 6));
  std::array<quaternion<double>, 4> controls{s.control_points()[0], s.control_points()[1],
                                             s.control_points()[2], s.control_points()[3]};
  using segment = duet::bspline_segment<double>;
  const segment right(controls, basis);
  CHECK_THROWS_AS((void)right(knots[4] + 0.01), duet::invalid_input);
  CHECK_THROWS_AS((void)right(knots[3] - 0.01), duet::invalid_input);
  controls[2] = -controls[2];
  CHECK_THROWS_WITH_AS(segment(controls, basis), doctest::Contains("sample 2: its sign"),
                       duet::invalid_sample);
  controls[2] = 1.1 * s.control_points()[2];
  CHECK_THROWS_AS(segment(controls, basis), duet::invalid_sample);
  const std::array<double, 6> wrong{0, 1, 2, 2, 3, 4}, decreasing{0, 1, 2, 3, 2.5, 4};
  CHECK_THROWS_AS(duet::segment_basis<4>{wrong}, duet::invalid_input);
  CHECK_THROWS_AS(duet::segment_basis<4>{decreasing}, duet::invalid_input);
}

TEST_CASE("point_jacobian: agrees with moved control points") {
  const auto knots = duet_test::knot_vectors(4)[1].knots;
  const duet::vector3<double> p(0.3, -1, 2);
  const auto compare = [&]<class T>(const duet::cumulative_bspline<T, 4>& s) {
    using tangent_space = duet::manifold<quaternion<T>>;
    const double u = knots[5] * 0.6 + knots[6] * 0.4;
    const auto point = [&](const auto& curve) {
      const auto value = curve(u);
      if constexpr (duet_test::is_pose<T>) {
        return duet::vector3<double>(duet::rotation_matrix(rotation(value)) * p +
                                     translation(value));
      } else {
        return duet::vector3<double>(duet::rotation_matrix(value) * p);
      }
    };
    for (const auto side : {perturbation::right, perturbation::left}) {
      const auto m = point_jacobian(s.template motion_jacobian<0>(u, duet::frame::body, side), p);
      CHECK((m.value - point(s)).norm() <= 1e-14);
      const std::size_t first = s.basis().first_function(s.basis().find_span(u));
      const double h = 1e-6;
      for (int i = 0; i < 4; ++i) {
        for (int c = 0; c < tangent_space::dimension; ++c) {
          const auto moved = [&](double step) {
            auto controls = s.control_points();
            auto& q = controls[first + std::size_t(i)];
            Eigen::Matrix<double, tangent_space::dimension, 1> d;
            d.setZero();
            d[c] = step;
            q = side == perturbation::right ? tangent_space::plus(q, d, duet::frame::body)
                                            : tangent_space::plus(q, d, duet::frame::spatial);
            return point(duet::cumulative_bspline<T, 4>(s.basis(), controls));
          };
          CHECK(((moved(h) - moved(-h)) / (2 * h) - m.block(i).col(c)).norm() <= 1e-8);
        }
      }
    }
  };
  compare(duet_test::curve_of_steps<double, 4>(knots, 0.7, 3));
  compare(duet_test::curve_of_steps<screw, 4>(knots, 0.7, 3));
}

TEST_CASE("split_bspline: positions are a B-spline, with weights as Jacobians") {
  const auto knots = duet_test::knot_vectors(4)[1].knots;
  const std::size_t count = knots.size() - 4;
  std::vector<duet::vector3<double>> positions;
  for (std::size_t i = 0; i < count; ++i) {
    positions.emplace_back(double(i * i), 1.0 - double(i), 0.1 * double(i * i * i));
  }
  const duet::split_bspline<double> s(knots, duet_test::random_orientations(count, 1), positions);
  const duet::vector3<double> x(1, 2, 3);
  for (const double u : duet_test::parameters_on(knots, 4, 2)) {
    const auto m = s.motion_jacobian<2>(u, duet::frame::body);
    duet::vector3<double> position(0, 0, 0), slope(0, 0, 0);
    for (std::size_t i = 0; i < count; ++i) {
      position += duet::basis_function(knots, i, 4, u) * positions[i];
    }
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      slope += m.weights[1][i] * positions[m.rotation.first + i];
      sum += m.weights[0][i];
    }
    CHECK(sum == doctest::Approx(1).epsilon(1e-15));
    CHECK((m.position - position).norm() <= 1e-11 * (1 + position.norm()));
    CHECK((m.velocity - slope).norm() <= 1e-10 * (1 + slope.norm()));
    const auto point = point_jacobian(m, x);
    CHECK((point.value - position - duet::rotation_matrix(s.rotation()(u)) * x).norm() <=
          1e-11 * (1 + position.norm()));
  }
}

} // namespace
} // namespace test_spline_bspline_segment
