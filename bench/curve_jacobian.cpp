// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Value, velocity and acceleration of a cubic at random parameters, with all Jacobians by its four
/// control points: from a curve, from control points in the caller's memory, and from these by dual
/// numbers with a partial for each coordinate, without heap.

#include "spline_workload.hpp"
#include "support/contest.hpp"

#include <duet/dual/dual.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/spline/bspline_segment.hpp>
#include <duet/spline/cumulative_bspline.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace duet_bench {
namespace {

using screw = duet::screw_dual<double>;

template <class T>
duet::cumulative_bspline<T> make_curve() {
  if constexpr (std::is_same_v<T, double>) {
    return make_spline();
  } else {
    std::vector<double> knots;
    for (int i = -3; i <= segments + 3; ++i) {
      knots.push_back(i * knot_distance);
    }
    std::vector<duet::dual_quaternion<double>> poses;
    for (const auto& q : controls()) {
      const double t = knot_distance * double(poses.size());
      poses.push_back(duet::pose(q, duet::vector3<double>(std::sin(t), t, std::cos(2 * t))));
    }
    return {knots, poses};
  }
}

/// The cubic of a curve's control points, with those of one span in memory.
template <class T>
class raw_controls {
public:
  static constexpr int dimension = duet::manifold<duet::quaternion<T>>::dimension;
  using number = duet::dual<double, 4 * dimension>;
  using wide = std::conditional_t<dimension == 3, number, duet::screw_dual<number>>;

  explicit raw_controls(const duet::cumulative_bspline<T>& s) : curve_(s) {
    for (std::size_t span = 0; span < std::size_t(segments); ++span) {
      bases_.emplace_back(std::span<const double, 6>(&s.basis().knots()[span + 1], 6));
    }
  }

  [[nodiscard]] auto closed_form(double u) const {
    const std::size_t span = curve_.basis().find_span(u);
    const duet::bspline_segment<T> segment(
        std::span<const duet::quaternion<T>, 4>(&curve_.control_points()[span], 4), bases_[span]);
    return segment.template motion_jacobian<2>(u, duet::frame::body);
  }

  /// By control points q + q d/2, with a partial for each coordinate of all d.
  [[nodiscard]] auto duals(double u) const {
    const std::size_t span = curve_.basis().find_span(u);
    std::array<duet::quaternion<wide>, 4> q;
    for (std::size_t i = 0; i < 4; ++i) {
      q[i] = seeded(curve_.control_points()[span + i], int(i) * dimension);
    }
    std::array<duet::vector3<wide>, 3> increments;
    for (std::size_t i = 0; i < 3; ++i) {
      increments[i] =
          duet::detail::log_vector(duet::detail::relative_rotation(q[i], q[i + 1]), "duals");
    }
    return duet::detail::motion_of(
        duet::detail::product_of_exponentials<2>(q[0], increments.data(),
                                                 bases_[span].weights().template at<2>(u)),
        duet::frame::body);
  }

private:
  [[nodiscard]] static duet::quaternion<wide> seeded(const duet::quaternion<T>& q, int first) {
    const auto units = [&](auto make) {
      return std::array{q * make(0) * 0.5, q * make(1) * 0.5, q * make(2) * 0.5};
    };
    const auto rotations =
        units([](int c) { return duet::quaternion<T>(T(0), T(c == 0), T(c == 1), T(c == 2)); });
    const auto with_partials = [&](auto component) {
      if constexpr (dimension == 3) {
        number x(component(q));
        for (int c = 0; c < 3; ++c) {
          x.set_partial(first + c, component(rotations[std::size_t(c)]));
        }
        return x;
      } else {
        number value(component(q).value()), epsilon(component(q).epsilon());
        for (int c = 0; c < 3; ++c) { // v moves q by ε, ω as for rotations
          const T rate = component(rotations[std::size_t(c)]);
          epsilon.set_partial(first + c, rate.value());
          value.set_partial(first + 3 + c, rate.value());
          epsilon.set_partial(first + 3 + c, rate.epsilon());
        }
        return wide(value, epsilon);
      }
    };
    return {with_partials([](const auto& x) { return x.w(); }),
            with_partials([](const auto& x) { return x.x(); }),
            with_partials([](const auto& x) { return x.y(); }),
            with_partials([](const auto& x) { return x.z(); })};
  }

  duet::cumulative_bspline<T> curve_;
  std::vector<duet::segment_basis<4>> bases_;
};

template <class T>
void add(const std::string& workload) {
  static const auto curve = make_curve<T>();
  static const raw_controls<T> raw(curve);
  random_parameters parameters;
  for (int k = 0; k < 100; ++k) {
    const double u = parameters.next();
    const auto a = raw.duals(u);
    const auto check = [&](std::string_view contender, const auto& m) {
      for (int i = 0; i < 4 * raw.dimension; ++i) {
        const auto column = [&](const auto& blocks) {
          return blocks.block(i / raw.dimension).col(i % raw.dimension).eval();
        };
        std::array<double, 12> expected{}, actual{};
        for (int r = 0; r < raw.dimension; ++r) {
          const std::size_t at = std::size_t(r);
          expected[at] = a.velocity[r].partial(i);
          actual[at] = column(m.velocity)[r];
          expected[6 + at] = 1e-3 * a.acceleration[r].partial(i);
          actual[6 + at] = 1e-3 * column(m.acceleration)[r];
        }
        expect_agreement(workload, contender, expected, actual);
      }
    };
    check("duet", curve.template motion_jacobian<2>(u, duet::frame::body));
    check("controls", raw.closed_form(u));
  }
  register_benchmark(workload, "duet", random_parameters(), [](random_parameters& u) {
    return curve.template motion_jacobian<2>(u.next(), duet::frame::body);
  });
  register_benchmark(workload, "controls", random_parameters(),
                     [](random_parameters& u) { return raw.closed_form(u.next()); });
  register_benchmark(workload, "duals", random_parameters(),
                     [](random_parameters& u) { return raw.duals(u.next()); });
}

const bool registered = [] {
  add<double>("rotation_jacobian");
  add<screw>("pose_jacobian");
  return true;
}();

} // namespace
} // namespace duet_bench
