// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/duet.hpp>

namespace test_spline_lookup_table {
namespace {

using duet::vector3;
using rotation = duet::quaternion<double>;
using screw = duet::dual<double, 1, duet::screw_tag>;
using pose_type = duet::dual_quaternion<double>;
using rotation_curve = duet::cumulative_bspline<double>;
using pose_curve = duet::cumulative_bspline<screw>;

/// Slow rotation with a fast section around u = 1.
rotation rotating(double u) {
  return duet::from_rotation_vector(
      vector3<double>(0.3 * u, 0.2 * std::sin(u), 0.1 * std::tanh(20 * (u - 1))));
}
pose_type moving(double u) {
  return duet::pose(rotating(u), vector3<double>(std::cos(u), std::sin(2 * u), 0.1 * u));
}

template <class Spline, class F>
double largest_error(const Spline& s, const F& f) {
  double largest = 0;
  for (int i = 0; i <= 20'000; ++i) {
    const double u = 3.0 * i / 20'000;
    largest = std::max(largest, duet::detail::miss(s(u), f(u), 1.0));
  }
  return largest;
}

template <class T, class F>
duet::lookup_table<T> uniform_table(const F& f, int intervals) {
  duet::lookup_table<T> table;
  for (int i = 0; i <= intervals; ++i) {
    table.parameters.push_back(3.0 * i / intervals);
    table.elements.push_back(f(table.parameters.back()));
  }
  return table;
}

TEST_CASE(
    "adaptive_table: the error is within the bound, with fewer samples than a uniform table") {
  for (const double tolerance : {1e-3, 1e-5, 1e-6}) {
    const auto result = duet::adaptive_table<rotation_curve>(rotating, 0.0, 3.0, tolerance);
    CHECK(result.error <= tolerance);
    CHECK(largest_error(result.curve, rotating) <= 1.1 * tolerance);
  }
  const auto result = duet::adaptive_table<rotation_curve>(rotating, 0.0, 3.0, 1e-6);
  const auto samples = int(result.table.parameters.size());
  const auto uniform = uniform_table<double>(rotating, samples - 1);
  const auto s =
      duet::interpolate<rotation_curve>(uniform.parameters, uniform.elements, duet::not_a_knot{});
  CHECK(largest_error(s, rotating) > 20e-6); // for as many samples in equal steps
  CHECK(result.table.parameters.front() == 0.0);
  CHECK(result.table.parameters.back() == 3.0);
}

TEST_CASE("adaptive_table: the characteristic length changes the number of samples of poses") {
  const auto near = duet::adaptive_table<pose_curve>(moving, 0.0, 3.0, 1e-5);
  CHECK(largest_error(near.curve, moving) <= 1.1e-5);
  const auto coarse = duet::adaptive_table<pose_curve>(moving, 0.0, 3.0, 1e-5, duet::not_a_knot{},
                                                       {.characteristic_length = 1e-3});
  CHECK(coarse.table.parameters.size() != near.table.parameters.size());
}

TEST_CASE("estimated_errors: within a factor of 3 of the error, largest where the motion is fast") {
  for (const int intervals : {400, 401, 800}) {
    const auto table = uniform_table<double>(rotating, intervals);
    const auto errors = duet::estimated_errors<rotation_curve>(table);
    CHECK(errors.size() == table.parameters.size() - 2);
    const auto s =
        duet::interpolate<rotation_curve>(table.parameters, table.elements, duet::not_a_knot{});
    const double estimate = *std::max_element(errors.begin(), errors.end());
    const double reference = largest_error(s, rotating);
    CHECK(estimate > reference / 3);
    CHECK(estimate < reference * 3);
    // The motion is fast near u = 1.
    const auto worst = std::max_element(errors.begin(), errors.end()) - errors.begin() + 1;
    CHECK(std::abs(table.parameters[std::size_t(worst)] - 1) < 0.15);
  }
}

TEST_CASE_TEMPLATE("estimated_errors: not below the error, for even and uneven steps", Spline,
                   rotation_curve, duet::rotation_vector_spline<double, 4>) {
  const auto rotated = [](double x, double y, double z) {
    return duet::from_rotation_vector(vector3<double>(x, y, z));
  };
  const auto motion = [&](int kind, double u) {
    return kind == 0   ? rotated(0, 0, std::sin(2 * u))
           : kind == 1 ? rotated(std::cos(u), std::sin(u), 0)
           : kind == 2 ? rotated(0, .3 * std::sin(6 * u), 0) * rotated(u, 0, 0)
           : kind == 3 ? rotated(.1 * u * u, 0, .02 * u * u * u)
           : kind == 4 ? rotated(0, 0, std::exp(-8 * (u - 1.5) * (u - 1.5)))
                       : rotated(0, .2 * std::exp(u), 0) * rotated(0, 0, u);
  };
  for (const int intervals : {60, 61}) {
    for (int steps = 0; steps < 4; ++steps) {
      for (int kind = 0; kind < 6; ++kind) {
        duet::lookup_table<double> table;
        for (int i = 0; i <= intervals; ++i) {
          const double x = double(i) / intervals;
          const double u = steps == 0   ? x
                           : steps == 1 ? x + .0267 * std::sin(18.85 * x)
                           : steps == 2 ? (i % 2 == 0 ? i : i + .4) / double(intervals + 1)
                                        : (std::exp(2 * x) - 1) / (std::exp(2.) - 1);
          table.parameters.push_back(3 * u);
          table.elements.push_back(motion(kind, 3 * u));
        }
        const auto errors = duet::estimated_errors<Spline>(table);
        const auto s =
            duet::interpolate<Spline>(table.parameters, table.elements, duet::not_a_knot{});
        double reference = 0;
        for (int i = 0; i <= 1000; ++i) {
          const double u = table.parameters.back() * i / 1000;
          reference = std::max(reference, duet::detail::miss(s(u), motion(kind, u), 1.0));
        }
        CAPTURE(intervals);
        CAPTURE(steps);
        CAPTURE(kind);
        const double estimate = *std::max_element(errors.begin(), errors.end());
        CHECK_GE(estimate, reference);
        CHECK_LE(estimate, (steps == 2 ? 18 : 6) * reference);
      }
    }
  }
}

TEST_CASE("estimated_errors: not below the error that natural ends cause") {
  const auto motion = [](double u) { // accelerates at both ends
    return duet::from_rotation_vector(vector3<double>(.3 * u * u, std::sin(u + 1), .1 * u));
  };
  for (int intervals = 30; intervals < 60; ++intervals) {
    const auto table = uniform_table<double>(motion, intervals);
    const auto s = duet::interpolate<duet::rotation_vector_spline<double>>(
        table.parameters, table.elements, duet::natural{});
    const auto errors =
        duet::estimated_errors<duet::rotation_vector_spline<double>>(table, duet::natural{});
    const double estimate = *std::max_element(errors.begin(), errors.end());
    const double reference = largest_error(s, motion);
    CHECK_GE(estimate, reference);
    CHECK_LE(estimate, 3 * reference);
  }
}

TEST_CASE("adaptive_table: ripples are within the bound; errors name values that are not finite or "
          "not units") {
  for (const double size : {1e-2, 1e-4}) {
    for (const double frequency : {8., 16., 12.566, 50.26}) {
      const auto ripple = [&](double u) {
        return duet::from_rotation_vector(vector3<double>(
            .3 * u, .2 * std::sin(u), size * std::sin(frequency * 3.141592653589793 * u)));
      };
      for (const double tolerance : {1e-3, 1e-5}) {
        const auto result = duet::adaptive_table<rotation_curve>(ripple, 0.0, 1.0, tolerance);
        double largest = 0;
        for (int i = 0; i <= 5000; ++i) {
          largest = std::max(largest,
                             duet::detail::miss(result.curve(i / 5000.), ripple(i / 5000.), 1.0));
        }
        CHECK_LE(largest, tolerance);
        CHECK_LE(largest, 1.01 * result.error);
      }
    }
  }
  const auto message = [](double bad, const rotation& value) {
    try {
      (void)duet::adaptive_table<rotation_curve>(
          [&](double u) { return std::abs(u - bad) < .01 ? value : rotation(1.0); }, 0.0, 1.0,
          1e-3);
    } catch (const duet::invalid_input& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  const double nan = std::nan("");
  CHECK(message(.3, rotation(nan, 0, 0, 0))
            .starts_with("duet: adaptive_table: the function is not finite at 0.29"));
  CHECK(message(.25, rotation(nan, 0, 0, 0)).find("is not finite at 0.25") != std::string::npos);
  CHECK(message(.3, rotation(.5, 0, 0, 0)).ends_with(" has norm 0.5, not 1"));
}

TEST_CASE("adaptive_table, estimated_errors: errors name invalid bounds and too few samples") {
  const auto message = [](double first, double last, double tolerance, std::size_t max_samples) {
    try {
      (void)duet::adaptive_table<rotation_curve>(rotating, first, last, tolerance,
                                                 duet::not_a_knot{}, {.max_samples = max_samples});
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  CHECK(message(1, 1, 1e-3, 100) ==
        "duet: adaptive_table: the range is from 1 to 1 and the tolerance 0.001 (expected a range "
        "that is not empty and a positive tolerance)");
  CHECK(message(0, 1, 0, 100).find("tolerance 0 (expected") != std::string::npos);
  CHECK(message(0, 3, 1e-9, 100).ends_with(", and options.max_samples is 100"));
  CHECK(message(0, 3, 1e-1, 8) ==
        "duet: adaptive_table: begins with 9 samples, more than options.max_samples, which is 8");
  CHECK_THROWS_AS((void)duet::estimated_errors<rotation_curve>(uniform_table<double>(rotating, 7)),
                  duet::invalid_input);
}

} // namespace
} // namespace test_spline_lookup_table
