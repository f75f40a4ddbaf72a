// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Every curve of duet through the same samples of a smooth motion: errors of orientation and
// angular velocity over the number of samples. Writes spline_comparison.csv and, with gnuplot, a
// picture.

#include "support/curves.hpp"
#include "support/folder.hpp"
#include "support/gnuplot.hpp"
#include "support/program.hpp"
#include <duet/core/text/csv.hpp>
#include <duet/core/text/file.hpp>

#include <duet/derivative/derivative.hpp>
#include <duet/quaternion/curves.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/rate.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/interpolate.hpp>
#include <duet/spline/rotation_vector_spline.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <iostream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace {

using rotation = duet::quaternion<double>;
using duet::vector3;

constexpr double end = 4;

const auto rotating = [](const auto& u) {
  using std::cos;
  using std::sin;
  using S = std::decay_t<decltype(u)>;
  return duet::from_rotation_vector(
      vector3<S>(S(0.8 * sin(1.3 * u)), S(0.5 * u), S(0.6 * cos(0.7 * u))));
};

struct sample {
  rotation q;
  vector3<double> omega; ///< spatial
};

template <class F>
sample sample_of(const F& f, double u) {
  const auto [q, q_dot] = duet::derivative(f, u);
  return {q, duet::angular_velocity(q, q_dot, duet::frame::spatial)};
}
template <class Spline>
sample sample_of_spline(const Spline& s, double u) {
  const auto m = s.motion(u, duet::frame::spatial);
  return {m.value, m.velocity};
}

struct rows {
  std::vector<double> u;
  std::vector<rotation> q;
  std::vector<vector3<double>> omega;

  explicit rows(int count) {
    for (int i = 0; i < count; ++i) {
      u.push_back(end * i / (count - 1));
      const sample s = sample_of(rotating, u.back());
      q.push_back(s.q);
      omega.push_back(s.omega);
    }
    q = duet::align_quaternion_signs(q);
  }

  /// Index of the interval that contains u, and the local parameter in [0, 1].
  [[nodiscard]] std::pair<std::size_t, double> locate(double at) const {
    const double step = end / double(u.size() - 1);
    const std::size_t i = std::min(std::size_t(at / step), u.size() - 2);
    return {i, (at - u[i]) / step};
  }
  /// A rotation and its angular velocity of f(τ) on that interval.
  template <class F>
  [[nodiscard]] sample local(double at, const F& f) const {
    const auto [i, tau] = locate(at);
    sample s = sample_of([&, i = i](const auto& t) { return f(i, t); }, tau);
    s.omega *= double(u.size() - 1) / end;
    return s;
  }
};

struct curve {
  const char* name;
  const char* colour;
  std::function<std::function<sample(double)>(const rows&)> through;
};

template <class Spline>
std::function<sample(double)> evaluator(Spline s) {
  return [s = std::move(s)](double u) { return sample_of_spline(s, u); };
}

const std::vector<curve>& curves() {
  using cumulative = duet::cumulative_bspline<double>;
  using cubic = duet::rotation_vector_spline<double>;
  using quintic = duet::rotation_vector_spline<double, 6>;
  static const std::vector<curve> all{
      {"SLERP", "#999999",
       [](const rows& r) {
         return [r](double u) {
           return r.local(
               u, [&](std::size_t i, const auto& t) { return duet::slerp(r.q[i], r.q[i + 1], t); });
         };
       }},
      {"squad", "#ff7f0e",
       [](const rows& r) {
         std::vector<rotation> controls = r.q;
         for (std::size_t i = 1; i + 1 < r.q.size(); ++i) {
           controls[i] = duet::squad_control(r.q[i - 1], r.q[i], r.q[i + 1]);
         }
         return [r, controls](double u) {
           return r.local(u, [&](std::size_t i, const auto& t) {
             return duet::squad(r.q[i], controls[i], controls[i + 1], r.q[i + 1], t);
           });
         };
       }},
      {"cumulative, natural", "#aec7e8",
       [](const rows& r) {
         return evaluator(duet::interpolate<cumulative>(r.u, r.q, duet::natural{}));
       }},
      {"cumulative, not a knot", "#1f77b4",
       [](const rows& r) {
         return evaluator(duet::interpolate<cumulative>(r.u, r.q, duet::not_a_knot{}));
       }},
      {"Hermite, rates known", "#9467bd",
       [](const rows& r) {
         return evaluator(duet::hermite_spline(r.u, r.q, r.omega, duet::frame::spatial));
       }},
      {"rotation vectors, cubic, not a knot", "#2ca02c",
       [](const rows& r) {
         return evaluator(duet::interpolate<cubic>(r.u, r.q, duet::not_a_knot{}));
       }},
      {"rotation vectors, quintic, not a knot", "#d62728", [](const rows& r) {
         return evaluator(duet::interpolate<quintic>(r.u, r.q, duet::not_a_knot{}));
       }}};
  return all;
}

/// The largest errors of the orientation, rad, and of the angular velocity, rad per unit.
std::array<double, 2> largest_errors(const curve& c, int count) {
  const auto at = c.through(rows(count));
  std::array<double, 2> largest{};
  for (int i = 0; i <= 3001; ++i) {
    const double u = end * i / 3001;
    const sample s = at(u);
    const sample reference = sample_of(rotating, u);
    largest[0] =
        std::max(largest[0], duet::rotation_vector(rotation(conj(s.q) * reference.q)).norm());
    largest[1] = std::max(largest[1], (s.omega - reference.omega).norm());
  }
  return largest;
}

/// Five of the curves: SLERP and natural ends are near squad.
std::string picture_script(const std::vector<std::vector<std::array<double, 2>>>& errors) {
  using enum example::label_position;
  const auto gain = [&](std::size_t curve) {
    const auto& e = errors[curve];
    return example::two_digits(e[e.size() - 2][0] / e.back()[0]);
  };
  struct drawn {
    std::size_t curve;
    const char *colour, *name;
  };
  const drawn all[] = {{1, "grey", "squad"},
                       {3, "vermillion", "cumulative cubic"},
                       {5, "blue", "rotation-vector cubic"},
                       {4, "orange", "Hermite"},
                       {6, "green", "quintic"}};
  std::string text = "set multiplot layout 1,2 title " +
                     example::title("Twice the rows divide the error of squad by " + gain(1) +
                                    ", that of the quintic by " + gain(6)) +
                     "\nset logscale xy\nset format y '10^{%T}'\nset ytics 100\n"
                     "set xlabel 'rows'\nset xrange [8:290]\nset xtics (9, 33, 129)\n";
  for (const std::size_t what : {std::size_t(0), std::size_t(1)}) {
    std::vector<example::named_line> lines;
    for (const drawn& each : all) {
      lines.push_back({"1:" + std::to_string(2 * each.curve + 2 + what), each.colour,
                       what == 1 ? each.name : "", 5, right, "linespoints pt 7 ps .6 lw 2"});
    }
    text += std::string(what == 0 ? "set lmargin at screen .1\nset rmargin at screen .4\n"
                                    "set ylabel 'largest error of orientation / rad'\n"
                                  : "set lmargin at screen .52\nset rmargin at screen .8\n"
                                    "set ylabel 'of angular velocity / (rad per unit)'\n") +
            example::plot_command("spline_comparison.csv", lines);
  }
  return text + "unset multiplot\n";
}

void run() {
  example::require_folder(".");
  std::vector<std::string> names{"rows"};
  for (const curve& c : curves()) {
    names.push_back(std::string("value ") + c.name);
    names.push_back(std::string("velocity ") + c.name);
  }
  std::string csv = duet::csv_header(names);
  std::vector<std::vector<std::array<double, 2>>> errors(curves().size());
  const std::array counts{9, 17, 33, 65, 129, 257};
  for (const int count : counts) {
    std::vector<double> numbers{double(count)};
    for (std::size_t k = 0; k < curves().size(); ++k) {
      errors[k].push_back(largest_errors(curves()[k], count));
      numbers.insert(numbers.end(), errors[k].back().begin(), errors[k].back().end());
    }
    csv += duet::csv_line(numbers);
  }
  std::printf("largest errors, and the orders seen from 129 to 257 rows\n%-38s %10s %6s %10s %6s\n",
              "257 rows", "value", "order", "velocity", "order");
  for (std::size_t k = 0; k < curves().size(); ++k) {
    const auto& last = errors[k].back();
    const auto& before = errors[k][counts.size() - 2];
    std::printf("%-38s %10.1e %6.1f %10.1e %6.1f\n", curves()[k].name, last[0],
                std::log2(before[0] / last[0]), last[1], std::log2(before[1] / last[1]));
  }
  duet::write_file("spline_comparison.csv", csv);
  if (!example::draw(".", "spline_comparison", 420, picture_script(errors))) {
    std::cout << "No picture: gnuplot is not installed\n";
  }
}

} // namespace

int main() {
  return example::run_program("spline_comparison", [] {
    run();
    return 0;
  });
}
