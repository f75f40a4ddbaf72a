// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curve_jacobians.hpp"

namespace test_spline_knot_jacobian {
namespace {

using duet::perturbation;
using duet_test::real_50;
using screw = duet::screw_dual<double>;

/// A curve over 50 digits with one knot moved.
template <class T, int Order>
auto moved_knot(const duet::cumulative_bspline<T, Order>& s, std::size_t knot, const real_50& h) {
  using W = duet_test::wide<T>;
  auto knots = duet_test::cast<real_50>(s.basis().knots());
  knots[knot] += h;
  std::vector<duet::quaternion<W>> controls;
  for (const auto& q : s.control_points()) {
    controls.push_back({duet_test::widened(q.w()), duet_test::widened(q.x()),
                        duet_test::widened(q.y()), duet_test::widened(q.z())});
  }
  return duet::cumulative_bspline<W, Order>(knots, controls);
}

template <class T, int Order, class Frame>
void compare(Frame frame, perturbation side) {
  constexpr int dimension = duet::manifold<duet::quaternion<T>>::dimension;
  const auto all = duet_test::knot_vectors(Order);
  for (const std::size_t which : {std::size_t(1), all.size() - (Order > 3 ? 3 : 1)}) {
    const std::string& name = all[which].name;
    const std::vector<double>& knots = all[which].knots;
    const auto s = duet_test::curve_of_steps<T, Order>(knots, 0.7, 3);
    for (const double u : duet_test::parameters_on(knots, Order, 1)) {
      if (std::find(knots.begin(), knots.end(), u) != knots.end() ||
          std::find(knots.begin(), knots.end(), std::nextafter(u, 100)) != knots.end()) {
        continue;
      }
      const auto m = s.knot_jacobian(u, frame, side);
      for (int k = 0; k < m.count; ++k) {
        const std::size_t knot = m.first + std::size_t(k);
        if (!m.exists[std::size_t(k)]) {
          CHECK(std::isnan(m.value(0, k)));
          continue;
        }
        // Of equal knots the first moves down, the last up; those between cannot move.
        const bool is_first = knot == 0 || knots[knot - 1] < knots[knot];
        const bool is_last = knot + 1 == knots.size() || knots[knot] < knots[knot + 1];
        if (!is_first && !is_last) {
          continue;
        }
        const real_50 h("1e-17");
        const real_50 up = is_last ? h : real_50(0), down = is_first ? real_50(-h) : real_50(0);
        const auto after = moved_knot(s, knot, up).motion(real_50(u), frame);
        const auto before = moved_knot(s, knot, down).motion(real_50(u), frame);
        const auto middle = normalized(after.value + before.value);
        const auto sigma = duet_test::tangent_of_step(middle, after.value - before.value, side);
        const real_50 step = up - down;
        const auto check = [&](const char* what, const auto& exact, const auto& column) {
          double error = 0, size = 1;
          for (int r = 0; r < dimension; ++r) {
            const double value = double(real_50(exact[r] / step));
            error = std::max(error, std::abs(value - column[r]));
            size = std::max(size, std::abs(value));
          }
          CHECK_MESSAGE(error <= 2e-11 * size, what << ", " << name << ", order " << Order
                                                    << ", knot " << k << ", u = " << u);
        };
        check("value", sigma, m.value.col(k));
        check("velocity", after.velocity - before.velocity, m.velocity.col(k));
        check("acceleration", after.acceleration - before.acceleration, m.acceleration.col(k));
        check("jerk", after.jerk - before.jerk, m.jerk.col(k));
      }
    }
  }
}

TEST_CASE("knot_jacobian: agrees with moved knots over 50 digits") {
  compare<double, 2>(duet::frame::body, perturbation::right);
  compare<double, 3>(duet::frame::spatial, perturbation::right);
  compare<double, 4>(duet::frame::body, perturbation::left);
  compare<double, 5>(duet::frame::body, perturbation::right);
  compare<screw, 4>(duet::frame::hybrid, perturbation::left);
}

TEST_CASE("knot_jacobian: knots of a clamped end have no derivative, others sum to a shift") {
  const auto knots = duet_test::knot_vectors(4)[3].knots;
  const auto s = duet_test::curve_of_steps<double, 4>(knots, 0.7, 3);
  const auto at_start = s.knot_jacobian(knots[3] + 0.01, duet::frame::body);
  CHECK(at_start.exists == std::array{false, false, false, true, true, true});
  CHECK(at_start.first == 1);

  const auto simple = duet_test::knot_vectors(4)[1].knots;
  const auto free = duet_test::curve_of_steps<double, 4>(simple, 0.7, 3);
  for (const double u : duet_test::parameters_on(simple, 4, 2)) {
    const auto m = free.knot_jacobian(u, duet::frame::body);
    const auto rates = free.motion(u, duet::frame::body);
    const auto is_minus = [](const auto& sum, const auto& rate) {
      return (sum + rate).norm() <= 1e-11 * (1 + rate.norm());
    };
    CHECK(is_minus(m.value.rowwise().sum(), rates.velocity));
    CHECK(is_minus(m.velocity.rowwise().sum(), rates.acceleration));
    CHECK(is_minus(m.acceleration.rowwise().sum(), rates.jerk));
  }
}

} // namespace
} // namespace test_spline_knot_jacobian
