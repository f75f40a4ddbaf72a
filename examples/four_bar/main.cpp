// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// A crank drives a rocker through a coupler: a closed loop defined by its constraints alone. Its
// motion, velocities and accelerations are compared with the closed forms of textbooks.

#include "linkage.hpp"

#include "../support/command_line.hpp"
#include "../support/curves.hpp"
#include "../support/folder.hpp"
#include "../support/gnuplot.hpp"
#include "../support/program.hpp"

#include <duet/core/text/csv.hpp>
#include <duet/core/text/file.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/derivative/derivative.hpp>
#include <duet/kinematics/constrained_mechanism.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace four_bar {
namespace {

constexpr double degree = std::numbers::pi / 180;

struct options {
  linkage links{.2, .5, .4, .55};
  Eigen::Vector2d point{.3, .25};
  double from = 0, to = 360;
  double speed = 1;
  double side = -1;
  int samples = 361;
  std::string out = "four_bar_out";
};

std::optional<options> parse_options(int argc, char** argv) {
  example::option_list description(
      "A four-bar linkage as a closed loop: angles of coupler and rocker, angular velocity and\n"
      "acceleration of the rocker, and the curve of a coupler point, over the crank's angle.\n"
      "Lengths in metres, angles in degrees. Options");
  description.flag("help", "print this and stop")
      .value<double>("crank", "X", "length of the crank (default: 0.2)")
      .value<double>("coupler", "X", "length of the coupler (default: 0.5)")
      .value<double>("rocker", "X", "length of the rocker (default: 0.4)")
      .value<double>("ground", "X", "length of the ground link (default: 0.55)")
      .value<double>(
          "along", "X",
          "position of the coupler point along the coupler, from the crank (default: 0.3)")
      .value<double>("across", "X",
                     "position of the coupler point to the left of the coupler (default: 0.25)")
      .value<double>("from", "X", "first angle of the crank (default: 0)")
      .value<double>("to", "X", "last angle of the crank (default: 360)")
      .value<double>("speed", "X", "angular velocity of the crank, rad/s (default: 1)")
      .flag("crossed", "assemble it with crossed links instead of open")
      .value<int>("samples", "N", "number of positions (default: 361)")
      .value<std::string>("out", "DIR",
                          "folder for the table and the picture (default: four_bar_out)");
  const auto arguments = example::command_line::parse(argc, argv, description);
  if (!arguments) {
    return std::nullopt;
  }
  options result;
  const auto read = [&](const char* name, double& x, bool is_length) {
    x = arguments->get<double>(name).value_or(x);
    if (!std::isfinite(x) || (is_length && x <= 0)) {
      throw std::runtime_error(
          std::string("--") + name + " is " + duet::to_text(x) +
          (is_length ? " (expected a positive length)" : " (expected a finite number)"));
    }
  };
  read("crank", result.links.crank, true);
  read("coupler", result.links.coupler, true);
  read("rocker", result.links.rocker, true);
  read("ground", result.links.ground, true);
  read("along", result.point[0], false);
  read("across", result.point[1], false);
  read("from", result.from, false);
  read("to", result.to, false);
  read("speed", result.speed, false);
  result.side = arguments->has("crossed") ? 1 : -1;
  result.samples = arguments->get<int>("samples").value_or(result.samples);
  result.out = arguments->text("out").value_or(result.out);
  if (result.samples < 2) {
    throw std::runtime_error("--samples is " + std::to_string(result.samples) +
                             " (expected at least 2)");
  }
  return result;
}

struct sample {
  double crank;                              ///< rad
  angles x;                                  ///< rad
  double velocity, velocity_by_hand;         ///< of the rocker, rad/s
  double acceleration, acceleration_by_hand; ///< rad/s²
  Eigen::Vector2d point;                     ///< m
};

/// Solves the loop at one angle after the other, each warm-started with the previous solution.
std::vector<sample> run_through(const options& settings) {
  const double first = settings.from * degree;
  const angles start = closed_form(settings.links, first, settings.side);
  if (!start.allFinite()) {
    throw std::runtime_error("the links cannot close at a crank angle of " +
                             duet::to_text(settings.from) + " degrees");
  }
  duet::constrained_mechanism loop(settings.links, start, first);
  std::vector<sample> samples;
  for (int i = 0; i < settings.samples; ++i) {
    const double theta =
        (settings.from + (settings.to - settings.from) * i / (settings.samples - 1)) * degree;
    try {
      loop = loop.warm_started_at(theta);
    } catch (const duet::loop_closure_failure& error) {
      char text[100];
      std::snprintf(text, sizeof text,
                    "the links cannot close beyond a crank angle of %.6g degrees: a dead point",
                    error.parameter().front() / degree);
      throw std::runtime_error(text);
    }
    const auto x = duet::derivatives<2>(loop, theta);
    const rocker_rates rates(settings.links, theta, x[0]);
    const double w = settings.speed;
    samples.push_back({theta, x[0], x[1][1] * w, rates.first * w, x[2][1] * w * w,
                       rates.second * w * w,
                       coupler_point(settings.links, settings.point, x[0], theta)});
  }
  return samples;
}

/// The largest difference from the closed form, over the largest value.
template <class Automatic, class ByHand>
double difference(const std::vector<sample>& samples, Automatic automatic, ByHand by_hand) {
  double worst = 0, largest = 0;
  for (const sample& s : samples) {
    worst = std::max(worst, std::abs(s.*automatic - s.*by_hand));
    largest = std::max(largest, std::abs(s.*by_hand));
  }
  return largest > 0 ? worst / largest : worst;
}

/// The largest difference of ψ from its closed form, in radians.
double angle_difference(const std::vector<sample>& samples, const options& settings) {
  double worst = 0;
  for (const sample& s : samples) {
    const double psi = closed_form(settings.links, s.crank, settings.side)[1];
    worst = std::max(worst, std::abs(std::remainder(s.x[1] - psi, 2 * std::numbers::pi)));
  }
  return worst;
}

std::string motion_csv(const std::vector<sample>& samples) {
  std::string text = "crank_deg,coupler_deg,rocker_deg,rocker_velocity,rocker_velocity_closed_form,"
                     "rocker_acceleration,rocker_acceleration_closed_form,point_x,point_y\n";
  for (const sample& s : samples) {
    text += duet::csv_line({s.crank / degree, s.x[0] / degree, s.x[1] / degree, s.velocity,
                            s.velocity_by_hand, s.acceleration, s.acceleration_by_hand, s.point[0],
                            s.point[1]});
  }
  return text;
}

/// The linkage at one of the positions, as a line: crank, coupler with its point, rocker.
std::string links_csv(const options& settings, const std::vector<sample>& samples) {
  const sample& s = samples[samples.size() / 6];
  const Eigen::Vector2d start(0, 0), foot(settings.links.ground, 0);
  const Eigen::Vector2d a =
      settings.links.crank * Eigen::Vector2d(std::cos(s.crank), std::sin(s.crank));
  const Eigen::Vector2d b =
      foot + settings.links.rocker * Eigen::Vector2d(std::cos(s.x[1]), std::sin(s.x[1]));
  std::string text = "x,y\n";
  for (const Eigen::Vector2d& p : {start, a, s.point, b, a, b, foot}) {
    text += duet::csv_line({p[0], p[1]});
  }
  return text;
}

/// Left: the linkage and the path of its coupler point. Right: velocity and acceleration of the
/// rocker.
std::string picture_script(const std::vector<sample>& samples) {
  const std::size_t rows = samples.size();
  const auto top =
      std::max_element(samples.begin(), samples.end(),
                       [](const sample& a, const sample& b) { return a.point[1] < b.point[1]; });
  using enum example::label_position;
  const char* const circles = "points pt 6 ps .9";
  return "set multiplot layout 1,2 title " +
         example::title("The loop's rates of the rocker (lines) are those of the closed form "
                        "(circles)") +
         "\nset xtics .1\nset ytics .1\nset size ratio -1\nset xlabel 'x / m'\nset ylabel 'y / m'\n"
         "set offsets .03,.03,.03,.03\nplot " +
         example::plot_element("motion.csv",
                               {"8:9", "blue", "coupler point", std::size_t(top - samples.begin()),
                                above, "lines lw 3"}) +
         ", \\\n     " +
         example::plot_element("links.csv",
                               {"1:2", "grey", "links", 0, right, "linespoints lw 2 pt 7 ps .8"}) +
         "\nset offsets 0,0,0,0\nset size noratio\nset xlabel 'crank / degrees'\n"
         "set ylabel 'of the rocker'\nset xtics 60\nset ytics .4\nset autoscale xfix\n" +
         example::plot_command("motion.csv", {{"1:5 every 15", "ink", "", 0, right, circles},
                                              {"1:7 every 15", "ink", "", 0, right, circles},
                                              {"1:4", "blue", "velocity / (rad/s)", 4 * rows / 10,
                                               above_right, "lines lw 3"},
                                              {"1:6", "vermillion", "acceleration / (rad/s²)",
                                               rows / 12, above_right, "lines lw 3"}}) +
         "unset multiplot\n";
}

void run(const options& settings) {
  example::require_folder(settings.out);
  const std::vector<sample> samples = run_through(settings);
  const auto [a, b, c, d] = settings.links;
  std::printf("Links %g, %g, %g, ground %g m: %s\n\n", a, b, c, d, settings.links.kind().c_str());
  std::printf("%8s %10s %10s %14s %14s %16s %16s\n", "crank", "coupler", "rocker", "velocity",
              "closed form", "acceleration", "closed form");
  for (std::size_t k = 0; k <= 6; ++k) {
    const sample& s = samples[k * (samples.size() - 1) / 6];
    std::printf("%8.2f %10.4f %10.4f %14.10f %14.10f %16.10f %16.10f\n", s.crank / degree,
                s.x[0] / degree, s.x[1] / degree, s.velocity, s.velocity_by_hand, s.acceleration,
                s.acceleration_by_hand);
  }
  std::filesystem::create_directories(settings.out);
  duet::write_file(settings.out + "/motion.csv", motion_csv(samples));
  duet::write_file(settings.out + "/links.csv", links_csv(settings, samples));
  const bool drawn = example::draw(settings.out, "four_bar", 400, picture_script(samples));
  std::cout << "\nTables" << (drawn ? " and picture (SVG, PNG)" : "") << " are in "
            << duet::printable(settings.out) << "\n";
  if (!drawn) {
    std::cout << "No picture: gnuplot is not installed\n";
  }
  std::printf("four bar: samples=%zu angle_difference=%.2g velocity_difference=%.2g "
              "acceleration_difference=%.2g\n",
              samples.size(), angle_difference(samples, settings),
              difference(samples, &sample::velocity, &sample::velocity_by_hand),
              difference(samples, &sample::acceleration, &sample::acceleration_by_hand));
}

} // namespace
} // namespace four_bar

int main(int argc, char** argv) {
  return example::run_program("four_bar", [&] {
    if (const auto settings = four_bar::parse_options(argc, argv)) {
      four_bar::run(*settings);
    }
    return 0;
  });
}
