// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// The experiment of Houdek, Verlinden and Hajžman (P5–P7) on a real mechanism: solve the closed
// loop of a wheel carrier, tabulate its orientation, interpolate the table by a quaternion
// B-spline, and see how well the spline's derivatives give the mechanism's angular velocity and
// acceleration.

#include "comparison.hpp"
#include "configuration.hpp"
#include "hardpoints_file.hpp"
#include "hermite.hpp"
#include "options.hpp"
#include "pictures.hpp"
#include "report.hpp"
#include "splines.hpp"
#include "table.hpp"
#include "tables.hpp"

#include "../support/folder.hpp"
#include "../support/gnuplot.hpp"
#include "../support/program.hpp"
#include <duet/core/text/csv.hpp>
#include <duet/core/text/file.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace wheel_carrier {
namespace {

constexpr int sample_count = 2001;

std::vector<double> uniform_samples(double from, double to) {
  std::vector<double> u;
  for (int i = 0; i < sample_count; ++i) {
    u.push_back(i + 1 == sample_count ? to : from + (to - from) * i / (sample_count - 1));
  }
  return u;
}

std::vector<state> solve(const carrier& mechanism, const std::vector<double>& samples) {
  std::vector<state> states;
  states.reserve(samples.size());
  for (const double u : samples) {
    try {
      states.push_back(mechanism.at(u));
    } catch (const duet::loop_closure_failure& error) {
      throw std::runtime_error(
          "the rods cannot close beyond u = " + duet::to_text(error.parameter().front()) + " m");
    }
  }
  return states;
}

end_rates rates_at(const state& first, const state& last) { return {first.omega(), last.omega()}; }

/// δ_E and dδ_E of every method for the chosen end conditions, and of the closed form for the
/// others.
std::vector<named_curve> compare_methods(const std::vector<double>& samples,
                                         const std::vector<state>& states, const spline& chosen,
                                         const std::string& chosen_name, const spline& other,
                                         const std::string& other_name) {
  std::printf("Errors against the mechanism, in percent\n\n");
  print_header_of_errors();
  std::vector<named_curve> curves;
  for (const method& w : methods) {
    const std::string name = chosen_name + " ends: " + w.name;
    const error_curve curve = errors(states, chosen, w);
    print_error_row(name, samples, curve);
    // The first three curves coincide, in the paper and in the figure.
    if (w.evaluate != automatic && w.evaluate != through_euler_angles) {
      curves.emplace_back(name, curve);
    }
  }
  curves.emplace_back(other_name + " ends: closed form", errors(states, other, methods[0]));
  print_error_row(curves.back().first, samples, curves.back().second);
  return curves;
}

/// q_K, q′_K and q″_K of the splines: the configuration as a table, and its errors.
std::vector<std::pair<std::string, std::string>>
configurations(const carrier& mechanism, const std::vector<double>& samples,
               const std::vector<state>& states, const table& t, const spline& orientation) {
  std::vector<vector3> rows;
  for (const double u : t.u) {
    rows.push_back(mechanism.at(u).centre);
  }
  const position_spline position(t.u, rows, states.front().centre_first,
                                 states.back().centre_first);
  std::vector<configuration> values;
  configuration_errors off;
  for (const state& exact : states) {
    values.push_back({position.at(exact.u), angles_of(orientation.derivatives(exact.u))});
    off.add(values.back(), configuration_of(exact));
  }
  std::printf("\nErrors of the configuration, in metres and radians, per metre, per metre twice\n\n"
              "| | median | maximum | at u | at lower, upper end |\n|---|---|---|---|---|\n");
  const char* const orders[] = {"", ", first derivative", ", second derivative"};
  for (std::size_t k = 0; k < 3; ++k) {
    std::printf("| x, y, z%s |%s\n", orders[k],
                error_cells(samples, off.position[k], 1e-12).c_str());
  }
  for (std::size_t k = 0; k < 3; ++k) {
    std::printf("| phi, theta, psi%s |%s\n", orders[k],
                error_cells(samples, off.angles[k], 1e-12).c_str());
  }
  return {{"configuration.csv", configuration_csv(samples, values)},
          {"configuration_errors.csv", configuration_errors_csv(samples, off)}};
}

constexpr int convergence_rows[] = {25, 50, 100, 200, 400};

/// Maximal errors for tables of 25 … 400 rows, with observed orders of convergence.
std::string convergence(const carrier& mechanism, const arc_length& arcs,
                        const std::vector<state>& states) {
  std::printf("\nConvergence: maximal errors in percent over the whole travel, observed order in "
              "parentheses\n\n| samples | velocity, clamped | acceleration, clamped | "
              "velocity, natural | acceleration, natural |\n|---|---|---|---|---|\n");
  std::string csv = "rows,delta_E_clamped,ddelta_E_clamped,delta_E_natural,ddelta_E_natural\n";
  const known_ends known = ends_of(states.front(), states.back());
  std::array<double, 4> before{};
  double steps_before = 0;
  for (const int rows : convergence_rows) {
    const table t = equal_arc_table(mechanism, arcs, rows);
    std::array<double, 4> now{};
    std::size_t k = 0;
    for (const char* const ends : {"clamped", "natural"}) {
      const error_curve curve = errors(states, cumulative_curve(t, ends, known), methods[0]);
      now[k++] = summarise(curve.delta).maximum;
      now[k++] = summarise(curve.delta_first).maximum;
    }
    std::printf("| %d |", rows);
    for (std::size_t i = 0; i < 4; ++i) {
      std::printf(" %s |", convergence_cell(now[i], before[i], rows - 1, steps_before).c_str());
    }
    std::printf("\n");
    csv += csv_line({double(rows), now[0], now[1], now[2], now[3]});
    before = now;
    steps_before = rows - 1;
  }
  return csv;
}

/// δ_E and dδ_E of every spline with every end condition, and of the Hermite spline. Those that
/// need more rows than the table has are skipped.
std::vector<named_curve> compare_splines(const carrier& mechanism,
                                         const std::vector<double>& samples,
                                         const std::vector<state>& states, const table& t) {
  std::printf("\nEvery spline, every end, as above\n\n");
  print_header_of_errors();
  const known_ends known = ends_of(states.front(), states.back());
  std::vector<named_curve> curves;
  const auto add = [&](const curve& c) {
    curves.emplace_back(c.name(), errors(states, c));
    print_error_row(c.name(), samples, curves.back().second);
  };
  for (const auto& [spline_name, ends] : all_curves) {
    try {
      add(make_curve(spline_name, t, ends, known));
    } catch (const duet::invalid_input&) {
      std::printf("| %s, %s | too few rows |\n", spline_name, ends);
    }
  }
  add(hermite_curve(t, mechanism));
  return curves;
}

/// Maximal dδ_E of every spline with every end condition for tables of 25 … 400 rows.
std::string spline_convergence(const carrier& mechanism, const arc_length& arcs,
                               const std::vector<state>& states) {
  const known_ends known = ends_of(states.front(), states.back());
  std::printf("\nEvery spline, every end: maximal error of the acceleration in percent for so many "
              "rows\n\n|");
  std::vector<std::vector<double>> columns;
  std::vector<table> made;
  for (const int rows : convergence_rows) {
    std::printf(" | %d", rows);
    made.push_back(equal_arc_table(mechanism, arcs, rows));
    columns.push_back({double(rows)});
  }
  std::printf(" |\n|---|---|---|---|---|---|\n");
  std::vector<std::string> names{"rows"};
  const auto add = [&](const auto& make) {
    std::string name;
    std::string cells;
    for (std::size_t i = 0; i < made.size(); ++i) {
      const curve c = make(made[i]);
      name = c.name();
      columns[i].push_back(summarise(errors(states, c).delta_first).maximum);
      cells += " " + error_text(columns[i].back(), min_delta_first) + " |";
    }
    names.push_back(name);
    std::printf("| %s |%s\n", name.c_str(), cells.c_str());
  };
  for (const auto& each : all_curves) {
    add([&](const table& t) { return make_curve(each.spline, t, each.ends, known); });
  }
  add([&](const table& t) { return hermite_curve(t, mechanism); });
  std::string csv = duet::csv_header(names);
  for (const auto& column : columns) {
    csv += csv_line(column);
  }
  return csv;
}

void run(const options& settings) {
  example::require_folder(settings.out);
  const bool has_reference = !settings.table || settings.hardpoints;
  const carrier mechanism(settings.hardpoints ? read_hardpoints(*settings.hardpoints)
                                              : example_hardpoints());
  std::optional<arc_length> arcs;
  table t;
  if (settings.table) {
    t = read_table(*settings.table);
  } else {
    solve(mechanism, {lowest, 0, highest}); // throws if the rods cannot close
    arcs.emplace(mechanism);
    const int rows = settings.rows.value_or(int(std::lround(arcs->total() / paper_angle)) + 1);
    t = equal_arc_table(mechanism, *arcs, rows);
  }
  const auto samples = uniform_samples(t.u.front(), t.u.back());
  std::vector<state> states;
  if (has_reference) {
    states = solve(mechanism, samples);
  }

  std::optional<end_rates> rates = settings.rates;
  if (!rates && has_reference) {
    rates = rates_at(states.front(), states.back());
  }
  known_ends known;
  if (has_reference) {
    known = ends_of(states.front(), states.back());
  }
  known.velocity = rates;
  const std::string ends = settings.ends.value_or(rates ? "clamped" : "natural");
  const curve chosen = make_curve(settings.spline, t, ends, known);
  // The formulas of the paper are those of the cumulative spline.
  const std::string paper_ends = ends == "both" ? "clamped" : ends;
  const spline paper = cumulative_curve(t, paper_ends, known);

  std::printf("%zu rows over u = %g ... %g m, %s ends\n\n", t.u.size(), t.u.front(), t.u.back(),
              ends.c_str());
  std::vector<std::pair<std::string, std::string>> files{{"table.csv", table_csv(t)},
                                                         {"rates.csv", rates_csv(chosen, samples)}};
  std::vector<named_curve> curves, splines, largest;
  std::vector<double> heights;
  const std::string others = paper_ends == "natural" ? "clamped" : "natural";
  if (has_reference) {
    curves = compare_methods(samples, states, paper, paper_ends, cumulative_curve(t, others, known),
                             others);
    const auto configuration_files = configurations(mechanism, samples, states, t, paper);
    files.insert(files.end(), configuration_files.begin(), configuration_files.end());
    splines = compare_splines(mechanism, samples, states, t);
    files.emplace_back("errors.csv", errors_csv(samples, curves));
    files.emplace_back("splines.csv", errors_csv(samples, splines));
    std::tie(heights, largest) = largest_between_rows(samples, curves, t.u);
    files.emplace_back("errors_between_rows.csv", errors_csv(heights, largest));
    files.emplace_back("splines_between_rows.csv",
                       errors_csv(heights, largest_between_rows(samples, splines, t.u).second));
    files.emplace_back("path.csv", path_csv(states, mechanism.points().wheel_centre));
  }
  if (arcs) {
    files.emplace_back("convergence.csv", convergence(mechanism, *arcs, states));
    files.emplace_back("spline_convergence.csv", spline_convergence(mechanism, *arcs, states));
  }

  std::filesystem::create_directories(settings.out);
  for (const auto& [name, content] : files) {
    duet::write_file(settings.out + "/" + name, content);
  }
  bool drawn = true;
  if (has_reference) {
    drawn = example::draw(settings.out, "errors", 620,
                          errors_script(curves, heights, largest, others)) &&
            example::draw(settings.out, "path", 380, path_script(states)) &&
            (!arcs || splines.size() <= std::size(all_curves) ||
             example::draw(settings.out, "splines", 700, splines_script(splines, heights.size())));
  }
  std::printf("\nTables%s are in %s\n", has_reference && drawn ? " and pictures (SVG, PNG)" : "",
              duet::printable(settings.out).c_str());
  if (!drawn) {
    std::printf("No pictures: gnuplot is not installed\n");
  }

  std::printf("wheel carrier: rows=%zu", t.u.size());
  if (has_reference) {
    const error_curve e = errors(states, chosen);
    std::printf(" delta_E_max=%.3g ddelta_E_max=%.3g", summarise(e.delta).maximum,
                summarise(e.delta_first).maximum);
  }
  std::printf(" ad_vs_closed_form=%.2g printed_formula_error=%.3g\n",
              automatic_against_closed_form(chosen.at, chosen.automatic, samples),
              printed_formula_error(paper, samples));
}

} // namespace
} // namespace wheel_carrier

int main(int argc, char** argv) {
  return example::run_program("wheel_carrier", [&] {
    if (const auto settings = wheel_carrier::parse_options(argc, argv)) {
      wheel_carrier::run(*settings);
    }
    return 0;
  });
}
