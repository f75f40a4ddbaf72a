// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// A point of a rotating body moves along a curve on the sphere, and its velocity is tangent to that
// curve. The velocity from the true derivative of the quaternion B-spline (P3) is; the one from the
// formula as printed, which adds rotations as if they commuted, is not. Writes
// printed_velocity.csv, the animation moving_point.svg and, with gnuplot, a picture.

#include "support/curves.hpp"
#include "support/drawing.hpp"
#include "support/folder.hpp"
#include "support/gnuplot.hpp"
#include "support/moving_picture.hpp"
#include "support/program.hpp"

#include <duet/core/text/csv.hpp>
#include <duet/core/text/file.hpp>
#include <duet/quaternion/euler.hpp>
#include <duet/quaternion/rate.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/interpolate.hpp>
#include <duet/spline/printed.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <iostream>
#include <numbers>
#include <string>
#include <vector>

namespace {

using rotation = duet::quaternion<double>;
using spline = duet::cumulative_bspline<double>;
using duet::vector3;

const vector3<double> mark(1, 0, 0); // the point, on the body

/// A spline through six orientations, each about one radian from the next.
spline motion() {
  const std::vector<double> u{0, 1, 2, 3, 4, 5};
  const std::vector<rotation> rows{duet::from_euler<duet::zyx>(-1.15, 0.35, 0.0),
                                   duet::from_euler<duet::zyx>(-0.75, -0.45, 0.9),
                                   duet::from_euler<duet::zyx>(-0.15, -0.65, 1.7),
                                   duet::from_euler<duet::zyx>(0.35, 0.1, 2.2),
                                   duet::from_euler<duet::zyx>(0.7, 0.5, 3.0),
                                   duet::from_euler<duet::zyx>(1.2, -0.1, 3.8)};
  return duet::interpolate<spline>(u, rows, duet::not_a_knot{});
}

struct sample {
  double u;
  vector3<double> position, velocity, printed;
  /// Angle between both velocities, degrees.
  [[nodiscard]] double angle() const {
    return std::atan2(velocity.cross(printed).norm(), velocity.dot(printed)) * 180 /
           std::numbers::pi;
  }
};

sample sample_at(const spline& s, double u) {
  const rotation q = s(u);
  const auto velocity = [&](const rotation& rate) -> vector3<double> {
    return duet::angular_velocity(q, rate, duet::frame::spatial).cross(duet::rotate(q, mark));
  };
  return {u, duet::rotate(q, mark), velocity(s.derivatives(u)[1]),
          velocity(duet::printed_derivative(s, u).from_zero_first)};
}

/// Meridians and parallels.
std::vector<std::vector<vector3<double>>> circles() {
  const double step = std::numbers::pi / 6;
  std::vector<std::vector<vector3<double>>> result;
  const auto add = [&](const auto& circle) {
    result.emplace_back();
    for (int i = 0; i <= 120; ++i) {
      result.back().push_back(circle(i * std::numbers::pi / 60));
    }
  };
  for (int k = -2; k < 4; ++k) {
    const double angle = k * step;
    add([&](double t) {
      return vector3<double>(std::sin(t) * std::cos(angle), std::sin(t) * std::sin(angle),
                             std::cos(t));
    });
    add([&](double t) {
      return vector3<double>(-std::cos(angle) * std::cos(t), -std::cos(angle) * std::sin(t),
                             std::sin(angle));
    });
  }
  return result;
}

/// The parts of the circles that are on the visible side.
void add_grid(example::drawing& d) {
  for (const auto& circle : circles()) {
    std::vector<vector3<double>> part;
    for (std::size_t i = 0; i < circle.size(); ++i) {
      part.push_back(circle[i]);
      if (d.seen(part.back())[2] < 0 || i + 1 == circle.size()) {
        part.pop_back();
        if (part.size() > 1) {
          d.line(part, "#a9bccd", "lw 1");
        }
        part.clear();
      }
    }
  }
}

const vector3<double> view(1, .12, .2);

std::string moving_picture(const std::vector<sample>& samples) {
  std::vector<example::moving_point> instants;
  for (std::size_t i = 0; i < samples.size(); i += 3) {
    const sample& each = samples[i];
    instants.push_back({each.position, each.velocity, each.printed, each.angle()});
  }
  return example::moving_picture(example::drawing(view), instants).svg(circles());
}

/// The ball with the curve, the rows, and both velocities at even parameters.
example::drawing drawing_of(const spline& s, const std::vector<sample>& samples) {
  example::drawing d(view);
  d.ball(vector3<double>::Zero(), 1, "#c9d7e4");
  add_grid(d);
  std::vector<vector3<double>> curve;
  for (const sample& each : samples) {
    curve.push_back(each.position);
  }
  d.line(curve, "#24292f", "lw 4");
  for (const double u : {0., 1., 2., 3., 4., 5.}) {
    d.ball(1.01 * duet::rotate(s(u), mark), .022, "#24292f");
  }
  constexpr double length = .5;
  for (std::size_t i = 38; i < samples.size(); i += 38) {
    const auto& [u, position, velocity, printed] = samples[i];
    d.arrow(position, position + length * printed, "#d55e00", "lw 3");
    d.arrow(position, position + length * velocity, "#0072b2", "lw 3");
  }
  return d;
}

std::string picture_script(const example::drawing& d, double worst) {
  const auto label = [](const std::string& text, double y, const char* colour) {
    return "set label " + text + " at screen .56," + duet::to_text(y) + " front tc rgb " + colour +
           "\n";
  };
  char angle[20];
  std::snprintf(angle, sizeof angle, "%.0f", worst);
  return label(example::title("A point of a turning body"), .87, "ink") +
         label("'draws this curve; its velocity'", .81, "ink") +
         label("'must be tangent to the curve.'", .75, "ink") +
         label(example::title("True formula:"), .6, "blue") +
         label("'tangent everywhere.'", .54, "blue") +
         label(example::title("Printed formula:"), .39, "vermillion") +
         label("'off by up to " + std::string(angle) + " degrees: it adds rotations'", .33,
               "vermillion") +
         label("'as if they commuted.'", .27, "vermillion") +
         "set lmargin at screen .02\nset rmargin at screen .52\nset tmargin 1\nset bmargin 1\n" +
         d.script("printed_velocity_shapes.csv");
}

void run() {
  example::require_folder(".");
  const spline s = motion();
  std::vector<sample> samples;
  std::string csv = "u,x,y,z,vx,vy,vz,printed_vx,printed_vy,printed_vz\n";
  for (int i = 0; i <= 300; ++i) {
    samples.push_back(sample_at(s, i / 60.0));
    const auto& [u, x, v, p] = samples.back();
    csv += duet::csv_line({u, x[0], x[1], x[2], v[0], v[1], v[2], p[0], p[1], p[2]});
  }
  const auto worst =
      std::max_element(samples.begin(), samples.end(),
                       [](const sample& a, const sample& b) { return a.angle() < b.angle(); });
  std::printf("The printed formula's velocity is off by up to %.1f degrees, at u = %.3f\n",
              worst->angle(), worst->u);
  duet::write_file("printed_velocity.csv", csv);
  duet::write_file("moving_point.svg", moving_picture(samples));
  const example::drawing d = drawing_of(s, samples);
  duet::write_file("printed_velocity_shapes.csv", d.csv());
  if (!example::draw(".", "printed_velocity", 420, picture_script(d, worst->angle()))) {
    std::cout << "No picture: gnuplot is not installed\n";
  }
}

} // namespace

int main() {
  return example::run_program("printed_velocity", [] {
    run();
    return 0;
  });
}
