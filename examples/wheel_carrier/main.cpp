// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// The experiment of Houdek, Verlinden and Hajžman (P5–P7) on a real mechanism: solve the closed
// loop of a wheel carrier, tabulate its orientation, interpolate the table by a quaternion
// B-spline, and see how well the spline's derivatives give the mechanism's angular velocity and
// acceleration.

#include "comparison.hpp"
#include "figures.hpp"
#include "hardpoints_file.hpp"
#include "options.hpp"
#include "splines.hpp"
#include "table.hpp"

#include "../support/folder.hpp"
#include "../support/gnuplot.hpp"
#include "../support/program.hpp"
#include <duet/core/csv.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
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
    } catch (const duet::cannot_close& error) {
      throw std::runtime_error(
          "the rods cannot close beyond u = " + duet::to_text(error.parameter().front()) + " m");
    }
  }
  return states;
}

spline through(const table& t, const std::optional<end_rates>& rates) {
  if (rates) {
    return duet::interpolate<spline>(t.u, t.q, duet::clamped{rates->start, rates->end});
  }
  return duet::interpolate<spline>(t.u, t.q, duet::natural{});
}

end_rates rates_at(const state& first, const state& last) { return {first.omega(), last.omega()}; }

void print_error_row(const std::string& name, const error_curve& curve) {
  const summary d = summarise(curve.delta);
  const summary dd = summarise(curve.delta_first);
  std::printf("  %-34s %9.2g %9.2g %9.2g   %9.2g %9.2g %9.2g\n", name.c_str(), d.median, d.interior,
              d.ends, dd.median, dd.interior, dd.ends);
}

/// δ_E and dδ_E of every way to the derivatives, for the chosen ends and beside them for the
/// others.
std::vector<named_curve> compare_ways(const std::vector<state>& states, const spline& chosen,
                                      const std::string& chosen_name, const spline& other,
                                      const std::string& other_name) {
  std::printf("Errors against the mechanism in percent (median; maximum in the middle 90 %% of the "
              "travel; at its ends)\n");
  std::printf("  %-34s %29s   %29s\n", "", "delta_E", "ddelta_E");
  std::vector<named_curve> curves;
  for (const way& w : ways) {
    const std::string name = chosen_name + ", " + w.name;
    const error_curve curve = errors(states, chosen, w);
    print_error_row(name, curve);
    // On paper the first three lie on one another, and so do they in the figure.
    if (w.evaluate != automatic && w.evaluate != through_euler_angles) {
      curves.emplace_back(name, curve);
    }
  }
  curves.emplace_back(other_name + ", closed form", errors(states, other, ways[0]));
  print_error_row(curves.back().first, curves.back().second);
  return curves;
}

/// Maximal errors for tables of 25 … 400 rows, with observed orders of convergence.
std::string convergence(const carrier& mechanism, const arc_length& arcs,
                        const std::vector<state>& states) {
  std::printf("\nConvergence: maximal errors in percent over the whole travel, observed order in "
              "parentheses\n");
  std::printf("  %6s %18s %18s %18s %18s\n", "rows", "delta_E clamped", "ddelta_E clamped",
              "delta_E natural", "ddelta_E natural");
  std::string csv = "rows,delta_E_clamped,ddelta_E_clamped,delta_E_natural,ddelta_E_natural\n";
  std::array<double, 4> before{};
  double arcs_before = 0;
  for (const int rows : {25, 50, 100, 200, 400}) {
    const table t = equal_arc_table(mechanism, arcs, rows);
    std::array<double, 4> now{};
    std::size_t k = 0;
    for (const bool is_clamped : {true, false}) {
      const auto rates =
          is_clamped ? std::optional(rates_at(states.front(), states.back())) : std::nullopt;
      const error_curve curve = errors(states, through(t, rates), ways[0]);
      now[k++] = summarise(curve.delta).maximum;
      now[k++] = summarise(curve.delta_first).maximum;
    }
    std::printf("  %6d", rows);
    for (std::size_t i = 0; i < 4; ++i) {
      std::string order;
      if (before[i] > 0) {
        char text[32];
        std::snprintf(text, sizeof text, "(%.1f)",
                      std::log(before[i] / now[i]) / std::log((rows - 1) / arcs_before));
        order = text;
      }
      std::printf(" %12.3g %5s", now[i], order.c_str());
    }
    std::printf("\n");
    csv += csv_line({double(rows), now[0], now[1], now[2], now[3]});
    before = now;
    arcs_before = rows - 1;
  }
  return csv;
}

/// δ_E and dδ_E of every spline with every end. What the table has too few rows for is left out.
std::vector<named_curve> compare_splines(const std::vector<state>& states, const table& t) {
  std::printf("\nEvery spline, every end, as above\n");
  const known_ends known = ends_of(states.front(), states.back());
  std::vector<named_curve> curves;
  for (const auto& [spline_name, ends] : all_curves) {
    try {
      const curve c = make_curve(spline_name, t, ends, known);
      curves.emplace_back(c.name(), errors(states, c));
      print_error_row(c.name(), curves.back().second);
    } catch (const duet::invalid_input&) {
      std::printf("  %s, %s: too few rows\n", spline_name, ends);
    }
  }
  return curves;
}

/// Maximal dδ_E of every spline with every end for tables of 25 … 400 rows.
std::string spline_convergence(const carrier& mechanism, const arc_length& arcs,
                               const std::vector<state>& states) {
  constexpr int tables[] = {25, 50, 100, 200, 400};
  const known_ends known = ends_of(states.front(), states.back());
  std::printf("\nEvery spline, every end: maximal ddelta_E in percent for so many rows\n  %-34s",
              "");
  std::vector<std::vector<double>> columns;
  std::vector<table> made;
  for (const int rows : tables) {
    std::printf(" %9d", rows);
    made.push_back(equal_arc_table(mechanism, arcs, rows));
    columns.push_back({double(rows)});
  }
  std::vector<std::string> names{"rows"};
  for (const auto& [spline_name, ends] : all_curves) {
    std::printf("\n  %-34s", (std::string(spline_name) + ", " + ends).c_str());
    names.push_back(std::string(spline_name) + " " + ends);
    for (std::size_t i = 0; i < made.size(); ++i) {
      const error_curve e = errors(states, make_curve(spline_name, made[i], ends, known));
      columns[i].push_back(summarise(e.delta_first).maximum);
      std::printf(" %9.2g", columns[i].back());
    }
  }
  std::printf("\n");
  std::string csv = duet::csv_header(names);
  for (const auto& column : columns) {
    csv += csv_line(column);
  }
  return csv;
}

void run(const options& given) {
  example::require_folder(given.out);
  const bool has_reference = !given.table || given.hardpoints;
  const carrier mechanism(given.hardpoints ? read_hardpoints(*given.hardpoints)
                                           : published_hardpoints());
  std::optional<arc_length> arcs;
  table t;
  if (given.table) {
    t = read_table(*given.table);
  } else {
    solve(mechanism, {lowest, 0, highest}); // says where the rods cannot close
    arcs.emplace(mechanism);
    const int rows = given.rows.value_or(int(std::lround(arcs->total() / paper_angle)) + 1);
    t = equal_arc_table(mechanism, *arcs, rows);
  }
  const auto samples = uniform_samples(t.u.front(), t.u.back());
  std::vector<state> states;
  if (has_reference) {
    states = solve(mechanism, samples);
  }

  std::optional<end_rates> rates = given.rates;
  if (!rates && has_reference) {
    rates = rates_at(states.front(), states.back());
  }
  known_ends known;
  if (has_reference) {
    known = ends_of(states.front(), states.back());
  }
  known.velocity = rates;
  const std::string ends = given.ends.value_or(rates ? "clamped" : "natural");
  const curve chosen = make_curve(given.spline, t, ends, known);
  // The formulas of the paper are those of the cumulative spline.
  const std::string paper_ends = ends == "both" ? "clamped" : ends;
  const spline paper = cumulative_curve(t, paper_ends, known);

  std::printf("%zu rows over u = %g ... %g m, %s ends\n\n", t.u.size(), t.u.front(), t.u.back(),
              ends.c_str());
  std::vector<std::pair<std::string, std::string>> files{{"table.csv", table_csv(t)},
                                                         {"rates.csv", rates_csv(chosen, samples)}};
  std::vector<named_curve> curves, splines;
  if (has_reference) {
    const std::string others = paper_ends == "natural" ? "clamped" : "natural";
    curves = compare_ways(states, paper, paper_ends, cumulative_curve(t, others, known), others);
    splines = compare_splines(states, t);
    files.emplace_back("errors.csv", errors_csv(samples, curves));
    files.emplace_back("splines.csv", errors_csv(samples, splines));
    files.emplace_back("path.csv", path_csv(states, mechanism.points().wheel_centre));
  }
  if (arcs) {
    files.emplace_back("convergence.csv", convergence(mechanism, *arcs, states));
    files.emplace_back("spline_convergence.csv", spline_convergence(mechanism, *arcs, states));
  }

  std::filesystem::create_directories(given.out);
  for (const auto& [name, content] : files) {
    duet::write_file(given.out + "/" + name, content);
  }
  bool drawn = true;
  if (has_reference) {
    drawn = example::draw(given.out, "errors", "1000,720", errors_script(curves)) &&
            example::draw(given.out, "path", "1000,420", path_script()) &&
            (!arcs || splines.size() < std::size(all_curves) ||
             example::draw(given.out, "splines", "1000,900", splines_script(splines)));
  }
  std::printf("\nTables%s are in %s\n", has_reference && drawn ? " and pictures (SVG, PNG)" : "",
              duet::printable(given.out).c_str());
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
    if (const auto given = wheel_carrier::parse_options(argc, argv)) {
      wheel_carrier::run(*given);
    }
    return 0;
  });
}
