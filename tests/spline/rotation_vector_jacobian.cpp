// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curve_jacobians.hpp"

namespace test_spline_rotation_vector_jacobian {
namespace {

using duet::perturbation;
using duet_test::real_50;
using screw = duet::screw_dual<double>;

template <class T, int Order>
struct data {
  static constexpr std::size_t rates_per_knot = std::size_t(Order) / 2 - 1;
  std::vector<double> parameters{0, 0.4, 1.5, 1.8};
  std::vector<duet::quaternion<T>> elements;
  std::vector<std::array<duet::vector3<T>, rates_per_knot>> rates;

  data() {
    duet_test::random_source random(4);
    const auto controls =
        duet_test::curve_of_steps<T, 4>(duet_test::knot_vectors(4)[0].knots, 1.1, 7);
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      elements.push_back(controls.control_points()[i]);
      rates.emplace_back();
      for (auto& rate : rates.back()) {
        for (int c = 0; c < 3; ++c) {
          rate[c] = number(random);
        }
      }
    }
  }
  static T number(duet_test::random_source& random) {
    if constexpr (duet_test::is_pose<T>) {
      return {random.uniform(-1, 1), random.uniform(-1, 1)};
    } else {
      return random.uniform(-1, 1);
    }
  }
};

template <class T, int Order, class Frame>
void compare(Frame frame, perturbation side) {
  using W = duet_test::wide<T>;
  using tangent_space = duet::manifold<duet::quaternion<W>>;
  constexpr int dimension = tangent_space::dimension;
  const data<T, Order> given;
  const duet::rotation_vector_spline<T, Order> s(given.parameters, given.elements, given.rates);
  std::vector<duet::quaternion<W>> elements;
  std::vector<std::array<duet::vector3<W>, data<T, Order>::rates_per_knot>> rates;
  for (std::size_t i = 0; i < given.elements.size(); ++i) {
    const auto& q = s.elements()[i];
    elements.push_back({duet_test::widened(q.w()), duet_test::widened(q.x()),
                        duet_test::widened(q.y()), duet_test::widened(q.z())});
    rates.emplace_back();
    for (std::size_t k = 0; k < rates[i].size(); ++k) {
      for (int c = 0; c < 3; ++c) {
        rates[i][k][c] = duet_test::widened(given.rates[i][k][c]);
      }
    }
  }
  for (const double u : {0.1, 0.4, 1.1, 1.7999}) {
    const auto m = s.template motion_jacobian<3>(u, frame, side);
    const auto at = s.motion(u, frame);
    CHECK((m.motion.jerk - at.jerk).norm() <= 1e-12 * (1 + at.jerk.norm()));
    std::array<double, 4> error{}, largest{};
    const real_50 h("1e-17");
    for (int i = 0; i < 2; ++i) {
      const std::array blocks{m.value.block(i), m.velocity.block(i), m.acceleration.block(i),
                              m.jerk.block(i)};
      for (int c = 0; c < dimension; ++c) {
        const auto moved = [&](const real_50& step) {
          auto points = elements;
          auto& q = points[m.first + std::size_t(i)];
          Eigen::Matrix<real_50, dimension, 1> d = Eigen::Matrix<real_50, dimension, 1>::Zero();
          d[c] = step;
          q = side == perturbation::right ? tangent_space::plus(q, d, duet::frame::body)
                                          : tangent_space::plus(q, d, duet::frame::spatial);
          const duet::rotation_vector_spline<W, Order> curve(
              duet_test::cast<real_50>(given.parameters), points, rates);
          return curve.motion(real_50(u), frame);
        };
        const auto after = moved(h), before = moved(-h);
        const auto sigma = duet_test::tangent_of_step(normalized(after.value + before.value),
                                                      after.value - before.value, side);
        for (int r = 0; r < dimension; ++r) {
          const std::array<real_50, 4> steps{sigma[r], after.velocity[r] - before.velocity[r],
                                             after.acceleration[r] - before.acceleration[r],
                                             after.jerk[r] - before.jerk[r]};
          for (std::size_t k = 0; k < 4; ++k) {
            const double exact = double(real_50(steps[k] / (2 * h)));
            error[k] = std::max(error[k], std::abs(exact - blocks[k](r, c)));
            largest[k] = std::max(largest[k], std::abs(exact));
          }
        }
      }
    }
    for (std::size_t k = 0; k < 4; ++k) {
      CHECK_MESSAGE(error[k] <= 1e-12 * largest[k], "derivative "
                                                        << k << ": " << error[k] / largest[k]
                                                        << ", order " << Order << ", u = " << u);
    }
  }
}

TEST_CASE("rotation_vector_spline: motion_jacobian agrees with 50 digits") {
  compare<double, 4>(duet::frame::body, perturbation::right);
  compare<double, 6>(duet::frame::spatial, perturbation::left);
  compare<screw, 4>(duet::frame::hybrid, perturbation::right);
}

} // namespace
} // namespace test_spline_rotation_vector_jacobian
