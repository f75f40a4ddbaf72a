// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"

// Curves of all kinds through data: they pass through it, are as smooth as their order says and
// meet their end conditions.

namespace test_spline_interpolate {
namespace {

using duet::interpolate;
using duet_test::max_abs_difference;
using duet_test::random_orientations;

using number = duet::screw_dual<double>;
using quaternion = duet::quaternion<double>;
using vector = duet::vector3<double>;
using parameters = std::vector<double>;
using table = std::vector<quaternion>;
using cumulative = duet::cumulative_bspline<double>;
template <class T, int Order>
using rotation_vectors = duet::rotation_vector_spline<T, Order>;

template <class Spline>
using element = std::decay_t<decltype(std::declval<Spline>()(0.0))>;
template <class Spline>
constexpr bool is_of_poses = duet::manifold<element<Spline>>::dimension == 6;

#define DUET_TEST_SPLINES                                                                          \
  cumulative, rotation_vectors<double, 4>, rotation_vectors<double, 6>,                            \
      duet::cumulative_bspline<number>, rotation_vectors<number, 4>, rotation_vectors<number, 6>

parameters uniform(std::size_t count) {
  parameters result;
  for (std::size_t i = 0; i < count; ++i) {
    result.push_back(-0.5 + 0.25 * double(i));
  }
  return result;
}

template <class Spline>
std::vector<element<Spline>> random_samples(std::size_t count, double step) {
  if constexpr (is_of_poses<Spline>) {
    return duet_test::random_poses(count, step);
  } else {
    return random_orientations(count, step, count);
  }
}

/// Samples `angle` apart, and poses 3 units of length as well, about and along random axes.
template <class Spline>
std::vector<element<Spline>> distant_samples(double angle, std::uint64_t seed) {
  std::vector<element<Spline>> result;
  duet_test::random_source random(seed);
  vector t(0, 0, 0);
  for (const quaternion& q : duet_test::rotated_by(angle, 20, seed)) {
    if constexpr (is_of_poses<Spline>) {
      const auto n = random.direction<3>();
      t += 3 * vector(n[0], n[1], n[2]);
      result.push_back(duet::pose(q, t));
    } else {
      result.push_back(q);
    }
  }
  return result;
}

/// Two rates, of an angular velocity or a twist.
template <class Spline>
auto end_rates() {
  const vector start(0.3, -0.2, 0.5), end(-1, 0, 0.4);
  if constexpr (is_of_poses<Spline>) {
    duet::vector6<double> start_twist, end_twist;
    start_twist << 0.4, 0.1, -1, start;
    end_twist << 0, 0.3, 0.7, end;
    return std::array{start_twist, end_twist};
  } else {
    return std::array{start, end};
  }
}

double size_of(const quaternion& q) { return norm(q); }
double size_of(const duet::dual_quaternion<double>& a) {
  return std::hypot(norm(real_part(a)), norm(dual_part(a)));
}
template <class Q>
double miss(const Q& a, const Q& b) {
  return std::min(size_of(a - b), size_of(a + b));
}

/// Checks that the curve passes through the data, that its derivatives up to the (k−2)-th are
/// continuous at inner knots, and that the next one is continuous only at the `joints` outermost
/// inner knots.
template <class Spline>
void check_curve(const Spline& s, const parameters& u, const std::vector<element<Spline>>& samples,
                 std::size_t joints, double tolerance = 1e-14) {
  constexpr std::size_t smooth = Spline::order - 2;
  const auto at = [&](double x) {
    // Taylor numbers through the value: independent of the closed form.
    return duet::derivatives<int(smooth) + 1>([&](const auto& p) { return s(p); }, x);
  };
  std::vector<std::array<decltype(at(0.0)), 2>> sides; // of inner knots
  std::array<double, smooth + 2> size{};
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double translation = is_of_poses<Spline> ? 10 : 1;
    CHECK(miss(s(u[i]), samples[i]) < tolerance * translation);
    const auto after = at(u[i]);
    for (std::size_t k = 0; k < smooth + 2; ++k) {
      size[k] = std::max(size[k], size_of(after[k]));
    }
    if (i > 0 && i + 1 < u.size()) {
      sides.push_back({at(std::nextafter(u[i], -1e9)), after});
    }
  }
  for (std::size_t i = 0; i < sides.size(); ++i) {
    CAPTURE(i);
    const auto jump = [&](std::size_t k) { return size_of(sides[i][0][k] - sides[i][1][k]); };
    for (std::size_t k = 0; k <= smooth; ++k) {
      CAPTURE(k);
      CHECK(jump(k) < 3e-12 * size[k] + 1e-13);
    }
    if (std::min(i, sides.size() - 1 - i) < joints) {
      CHECK(jump(smooth + 1) < 1e-10 * size[smooth + 1] + 1e-12);
    } else if (size[1] > 1e-3) {
      CHECK(jump(smooth + 1) > 1e-6 * size[smooth + 1]);
    }
  }
}

template <class Spline>
void check_all_ends(const parameters& u, const std::vector<element<Spline>>& samples) {
  constexpr bool is_quintic = Spline::order == 6;
  const auto [start, end] = end_rates<Spline>();
  const auto through = [&](const auto& ends, std::size_t joints) {
    const Spline s = interpolate<Spline>(u, samples, ends);
    check_curve(s, u, samples, joints);
    return s;
  };
  const auto check_rates = [&](const Spline& s, const auto& rate, const auto& from,
                               const auto& to) {
    CHECK((rate(s.motion(u.front(), duet::frame::spatial)) - from).norm() < 1e-11);
    CHECK((rate(s.motion(u.back(), duet::frame::spatial)) - to).norm() < 1e-11);
  };
  const auto velocity = [](const auto& m) { return m.velocity; };
  const auto acceleration = [](const auto& m) { return m.acceleration; };
  const auto snap = [](const Spline& s, double x) {
    return duet::derivative([&](const auto& p) { return s.motion(p, duet::frame::body).jerk; }, x)
        .derivative;
  };
  const auto none = (0 * start).eval();
  const Spline free = through(duet::natural{}, 0);
  check_rates(free, acceleration, none, none);
  if constexpr (is_quintic) {
    CHECK(snap(free, u.back()).norm() < 1e-8);
    const auto s = through(
        duet::fully_clamped{duet::clamped{start, end}, duet::end_acceleration{end, start}}, 0);
    check_rates(s, velocity, start, end);
    check_rates(s, acceleration, end, start);
  }
  if (u.size() >= 4 || !is_quintic) {
    check_rates(through(duet::clamped{start, end}, is_quintic), velocity, start, end);
    check_rates(through(duet::end_acceleration{start, end}, is_quintic), acceleration, start, end);
  }
  if (u.size() >= std::size_t(Spline::order)) {
    through(duet::not_a_knot{}, is_quintic ? 2 : 1);
  }
  if (u.size() >= 3) {
    auto closed = samples;
    closed.back() = -closed.front();
    const Spline s = interpolate<Spline>(u, closed, duet::periodic{});
    check_curve(s, u, closed, 0);
    const auto a = s.motion(u.front(), duet::frame::body),
               b = s.motion(u.back(), duet::frame::body);
    CHECK((a.velocity - b.velocity).norm() < 1e-11 * (1 + a.velocity.norm()));
    CHECK((a.acceleration - b.acceleration).norm() < 1e-11 * (1 + a.acceleration.norm()));
    if constexpr (is_quintic) {
      CHECK((a.jerk - b.jerk).norm() < 1e-9 * (1 + a.jerk.norm()));
      CHECK((snap(s, u.front()) - snap(s, u.back())).norm() < 1e-8 * (1 + a.jerk.norm()));
    }
  }
}

TEST_CASE_TEMPLATE("interpolate: the curve is C^(k−2), passes through the data and meets its end "
                   "conditions",
                   Spline, DUET_TEST_SPLINES) {
  for (const std::size_t count : {2, 3, 4, 6, 20}) {
    for (const double step : {0.0, 1e-9, 0.003, 0.3, 1.5}) {
      CAPTURE(count);
      CAPTURE(step);
      const auto samples = random_samples<Spline>(count, step);
      check_all_ends<Spline>(duet_test::uneven_parameters(count), samples);
      if (step == 0.3 && Spline::order == 4) {
        check_all_ends<Spline>(uniform(count), samples);
      }
    }
  }
}

TEST_CASE_TEMPLATE("interpolate: rotations of up to 2.8 rad about random axes give a curve, of "
                   "order 6 a curve or an error with the largest rotation",
                   Spline, DUET_TEST_SPLINES) {
  int converged = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    CAPTURE(seed);
    const auto samples = distant_samples<Spline>(seed % 2 == 0 ? 2.0 : 2.8, seed);
    parameters u;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      u.push_back(double(i));
    }
    try {
      check_curve(interpolate<Spline>(u, samples), u, samples, 0, 1e-13);
      ++converged;
    } catch (const duet::no_convergence& error) {
      CHECK(std::string(error.what()).find("rad, from sample") != std::string::npos);
    }
  }
  CHECK(converged >= (Spline::order == 6 ? 11 : 12));
}

TEST_CASE(
    "interpolate, cumulative cubic: rotations of 2.8 rad at uneven parameters, and of 2.9 rad "
    "about slowly changing axes converge") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    const table q = duet_test::rotated_by(2.8, 20, seed);
    duet_test::random_source random(seed);
    parameters u = {0};
    while (u.size() < 20) {
      u.push_back(u.back() + random.uniform(0.5, 1.5));
    }
    check_curve(interpolate<cumulative>(u, q, duet::clamped{vector(1, 0, 0), vector(0, -2, 0)}), u,
                q, 0, 1e-13);
  }
  table q = {quaternion(1)};
  for (int i = 1; i < 20; ++i) {
    const vector axis(std::cos(0.1 * i), std::sin(0.1 * i), 0);
    q.push_back(normalized(q.back() * duet::from_axis_angle(axis, 2.9)));
  }
  check_curve(interpolate<cumulative>(uniform(20), q), uniform(20), q, 0, 1e-13);
}

TEST_CASE_TEMPLATE("interpolate: about one axis polynomials of the degree of the spline are "
                   "reproduced",
                   Spline, cumulative, rotation_vectors<double, 4>, rotation_vectors<double, 6>) {
  const vector axis(2.0 / 3, -1.0 / 3, 2.0 / 3);
  const auto rotated = [&](double u) {
    const double angle = 0.3 + u - 0.4 * std::pow(u, 3);
    return duet::from_axis_angle(axis, angle + (Spline::order == 6 ? 0.1 * std::pow(u, 5) : 0));
  };
  const parameters u = {0, 0.3, 0.5, 1.1, 1.3, 1.9, 2};
  table q;
  for (const double x : u) {
    q.push_back(rotated(x));
  }
  const Spline s = interpolate<Spline>(u, q, duet::not_a_knot{});
  for (double x = 0; x <= 2; x += 0.07) {
    CHECK(max_abs_difference(s(x), rotated(x)) < 1e-13);
  }
}

TEST_CASE("interpolate, poses: rotations are the curve through the rotations") {
  const parameters u = duet_test::uneven_parameters(9);
  const auto poses = duet_test::random_poses(9, 1.8);
  table rotations;
  for (const auto& a : poses) {
    rotations.push_back(rotation(a));
  }
  const auto s = interpolate<duet::cumulative_bspline<number>>(u, poses);
  const auto r = interpolate<cumulative>(u, rotations);
  for (std::size_t i = 0; i < r.increments().size(); ++i) {
    CHECK((real_part(s.increments()[i]) - r.increments()[i]).norm() < 1e-14);
  }
}

TEST_CASE("interpolate: a copy from knots, control quaternions and increments is the same curve") {
  const table q = duet_test::rotated_by(2, 20, 1);
  const cumulative s = interpolate<cumulative>(uniform(20), q);
  const cumulative copy(s.basis().knots(), s.control_points(), s.increments());
  bool has_long_arc = false;
  for (std::size_t i = 1; i < s.control_points().size(); ++i) {
    has_long_arc = has_long_arc || dot(s.control_points()[i - 1], s.control_points()[i]) < 0;
  }
  CHECK(has_long_arc); // alignment of the signs would change the curve
  for (double u = s.basis().front(); u <= s.basis().back(); u += 0.07) {
    CHECK(max_abs_difference(copy(u), s(u)) < 1e-14);
  }
}

TEST_CASE("interpolate, uniform knots: Q_i = q_i exp(−ω_i/6) exp(ω_{i+1}/6) at inner knots") {
  const table q = random_orientations(12, 1.2);
  const cumulative s = interpolate<cumulative>(uniform(12), q);
  const auto sixth = [&](std::size_t i, double sign) {
    return duet::exp(vector(s.increments()[i] * (sign / 6)));
  };
  for (std::size_t k = 3; k < 9; ++k) { // beyond the influence of repeated end knots
    const std::size_t i = k + 1;        // the control quaternion of the knot
    const quaternion expected = s.control_points()[i] * sixth(i, -1) * sixth(i + 1, 1);
    CHECK(max_abs_difference(s(uniform(12)[k]), expected) < 1e-14);
  }
}

TEST_CASE("interpolate: signs and rounded norms of the samples do not affect the curve") {
  const table q = random_orientations(15, 1.5);
  const parameters u = duet_test::uneven_parameters(15);
  table flipped = q, rounded = q;
  for (std::size_t i = 0; i < q.size(); ++i) {
    flipped[i] = i % 3 == 1 ? -q[i] : q[i];
    rounded[i] = q[i] * (1 + 2e-4);
  }
  const auto s = interpolate<cumulative>(u, q), t = interpolate<cumulative>(u, flipped),
             r = interpolate<cumulative>(u, rounded);
  for (double x = u.front(); x < u.back(); x += 0.1) {
    CHECK(s(x) == t(x));
    CHECK(max_abs_difference(s(x), r(x)) < 1e-14);
  }
}

TEST_CASE("interpolate: the unit of the parameters does not affect the curve") {
  const table q = random_orientations(8, 1.3);
  const parameters u = duet_test::uneven_parameters(8);
  const vector a(0.3, 0.1, -0.4), b(0.2, 0.5, 0);
  for (const double unit : {1e-9, 1e6}) {
    CAPTURE(unit);
    parameters v;
    for (const double x : u) {
      v.push_back(x * unit);
    }
    const auto check = [&](const auto& ends, const auto& scaled_ends) {
      const cumulative s = interpolate<cumulative>(u, q, ends);
      const cumulative t = interpolate<cumulative>(v, q, scaled_ends);
      for (std::size_t i = 0; i < s.increments().size(); ++i) {
        CHECK((s.increments()[i] - t.increments()[i]).norm() < 1e-13);
      }
    };
    check(duet::natural{}, duet::natural{});
    check(duet::not_a_knot{}, duet::not_a_knot{});
    check(duet::clamped{a, b}, duet::clamped{a / unit, b / unit});
    check(duet::end_acceleration{a, b},
          duet::end_acceleration{a / (unit * unit), b / (unit * unit)});
  }
}

TEST_CASE("interpolate, periodic: several full turns about one axis have a constant rate") {
  const vector axis(0.6, 0, 0.8);
  for (const int revolutions : {1, 2, 3}) { // an odd number ends in −q
    parameters u;
    table q;
    for (int i = 0; i <= 12; ++i) {
      u.push_back(i);
      q.push_back(duet::from_axis_angle(axis, std::acos(-1.0) * revolutions * i / 6));
    }
    const cumulative s = interpolate<cumulative>(u, q, duet::periodic{});
    for (double x = 0; x <= 12; x += 0.31) {
      const auto m = s.motion(x, duet::frame::body);
      CHECK((m.velocity - axis * (std::acos(-1.0) * revolutions / 6)).norm() < 1e-13);
    }
  }
}

TEST_CASE("interpolation_report: iterations, residual and largest step") {
  duet::interpolation_report report;
  const parameters u = duet_test::uneven_parameters(30);
  (void)interpolate<cumulative>(u, duet_test::rotated_by(1.25, 30, 3), duet::natural{}, report);
  CHECK(report.largest_step == doctest::Approx(1.25).epsilon(1e-14));
  CHECK(report.residual < 5e-15);
  CHECK(report.iterations >= 3);
  CHECK(report.iterations < 60);
  (void)interpolate<rotation_vectors<double, 6>>(u, random_orientations(30, 0.003, 4),
                                                 duet::natural{}, report);
  CHECK(report.iterations >= 1);
  CHECK(report.iterations <= 6);
  CHECK(report.residual < 1e-14);
  CHECK(report.largest_step > 0.002);
  CHECK(report.largest_step < 0.004);
  (void)interpolate<cumulative>(duet_test::uneven_parameters(5), table(5, quaternion(1)),
                                duet::not_a_knot{}, report);
  CHECK(report.largest_step < 1e-15);
  CHECK(report.iterations == 1);
}

TEST_CASE("interpolate: float and long double agree with double to their precision") {
  using duet_test::cast;
  const auto q = random_orientations(10, 0.7);
  const parameters u = duet_test::uneven_parameters(10);
  const auto s = interpolate<cumulative>(u, q);
  const auto in_float =
      interpolate<duet::cumulative_bspline<float>>(cast<float>(u), cast<float>(q));
  const auto in_long_double = interpolate<duet::cumulative_bspline<long double>>(
      cast<long double>(u), cast<long double>(q));
  for (double x = u.front() + 0.01; x < u.back(); x += 0.0625) {
    CHECK(max_abs_difference(in_float(float(x)), s(x)) < 2e-6);
    CHECK(max_abs_difference(in_long_double(x), s(x)) < 1e-14);
  }
  for (std::size_t i = 0; i < u.size(); ++i) {
    const auto exact = normalized(cast<long double>(q)[i]);
    CHECK(max_abs_difference(in_long_double(u[i]), exact) < 1e-18);
  }
}

TEST_CASE(
    "interpolate, quintic over poses: given end velocities are reproduced far from the origin") {
  duet_test::random_source random(1);
  const duet::vector6<double> none = duet::vector6<double>::Zero();
  double sum = 0;
  constexpr int tables = 40;
  for (int n = 0; n < tables; ++n) {
    const auto about = random.direction<3>();
    const auto along = random.direction<3>();
    std::vector<duet::dual_quaternion<double>> samples;
    for (int i = 0; i < 4; ++i) {
      const vector half(0.003 * i * about[0], 0.003 * i * about[1], 0.001 * i * i * about[2]);
      samples.push_back(duet::pose(duet::exp(half), vector(1e4 * along[0] + 30 * i, 1e4 * along[1],
                                                           1e4 * along[2] - 7 * i * i)));
    }
    const auto direction = random.direction<6>();
    duet::vector6<double> velocity;
    for (int i = 0; i < 6; ++i) {
      velocity[i] = direction[std::size_t(i)] * (i < 3 ? 60 : 0.006);
    }
    const auto s = interpolate<rotation_vectors<number, 6>>(
        {0, 1, 2, 3}, samples,
        duet::fully_clamped{duet::clamped{velocity, none}, duet::end_acceleration{none, none}});
    const auto start = s.motion(0.0, duet::frame::spatial);
    const duet::vector6<double> error = start.velocity - velocity;
    sum += error.head<3>().squaredNorm() / velocity.head<3>().squaredNorm();
  }
  CHECK(std::sqrt(sum / tables) < 16 * std::ldexp(1.0, -53)); // 27 with one solve only
}

} // namespace
} // namespace test_spline_interpolate
