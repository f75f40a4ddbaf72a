// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Checks the formulas that are incorrect in the copy of the paper at hand, and their corrected
/// forms, against automatic differentiation; if the verdict may depend on the numbering of the
/// basis functions, under both readings. Prints the table of docs/case-studies/two_sources.md;
/// exits with 1 if a verdict is not the expected one.

#include "support/program.hpp"

#include <duet/duet.hpp>
#include <duet/interop/multiprecision.hpp>

#include <array>
#include <cstddef>
#include <iostream>
#include <string>
#include <vector>

namespace {

using namespace duet;

std::vector<comparison> table;
bool as_expected = true;

template <class F, class G, class Inputs>
void check(const std::string& label, verdict expected, const F& automatic, const G& closed_form,
           const Inputs& inputs) {
  table.push_back(compare<double, real_50>(label, automatic, closed_form, inputs, {.samples = 60}));
  as_expected = as_expected && table.back().outcome == expected;
}

// The curve of the spline tests: cubic over uniform knots, two spans, five control quaternions of
// given half-angle increments. The first is the paper's q_{-1} or q_0, as one counts.
constexpr std::array<double, 9> knots = {-3, -2, -1, 0, 1, 2, 3, 4, 5};
constexpr std::size_t order = 4;
constexpr std::size_t controls = knots.size() - order;

template <class T>
using increments = std::array<vector3<T>, controls - 1>;

template <class T>
[[nodiscard]] quaternion<T> first_control() {
  return from_rotation_vector(vector3<T>(T(1), T(0), T(0)));
}

template <class T>
[[nodiscard]] cumulative_bspline<T> make_curve(const increments<T>& omega) {
  std::vector<quaternion<T>> q = {first_control<T>()};
  std::vector<vector3<T>> increments_of_all = {vector3<T>::Zero()};
  for (const vector3<T>& w : omega) {
    q.push_back(q.back() * exp(w));
    increments_of_all.push_back(w);
  }
  return {std::vector<T>(knots.begin(), knots.end()), q, increments_of_all};
}

/// B_i^k by the recurrence of de Boor and Cox (P1). With `closed`, spans contain both of their
/// ends, as printed.
template <class T>
[[nodiscard]] T basis_function(std::size_t i, std::size_t k, const T& u, bool closed) {
  if (k == 1) {
    return T(u >= knots[i] && (u < knots[i + 1] || (closed && u == knots[i + 1])));
  }
  const T left = (u - knots[i]) / (knots[i + k - 1] - knots[i]);
  const T right = (knots[i + k] - u) / (knots[i + k] - knots[i + 1]);
  return left * basis_function(i, k - 1, u, closed) +
         right * basis_function(i + 1, k - 1, u, closed);
}

template <class T>
[[nodiscard]] T cumulative_function(std::size_t i, const T& u) {
  T sum(0);
  for (; i < controls; ++i) {
    sum += basis_function(i, order, u, false);
  }
  return sum;
}

/// Derivative of the cumulative basis function by P3, as printed.
template <class T>
[[nodiscard]] T first_derivative(std::size_t i, const T& u) {
  return 3 / (knots[i + 3] - knots[i]) * basis_function(i, 3, u, false);
}

/// Second derivative by P4: as printed, or with the term of B_{i+1}^{k-2}.
template <class T>
[[nodiscard]] T second_derivative(std::size_t i, const T& u, bool as_printed) {
  const T next =
      as_printed ? T(0) : basis_function(i + 1, 2, u, false) / (knots[i + 3] - knots[i + 1]);
  return 6 / (knots[i + 3] - knots[i]) *
         (basis_function(i, 2, u, false) / (knots[i + 2] - knots[i]) - next);
}

const auto parameter = real_numbers{0, 1.999};

void basis() {
  // The weights of the curve: B_i is the difference of neighbours in the cumulative basis.
  const auto automatic = [](const auto& u) {
    using T = std::decay_t<decltype(u)>;
    const bspline_basis<int(order), T> functions(std::vector<T>(knots.begin(), knots.end()));
    const std::size_t span = functions.find_span(u);
    const std::size_t first = functions.first_function(span);
    const auto weights = functions.template weights<0>(span, u);
    std::array<T, controls> b{};
    for (std::size_t j = 0; j < order; ++j) {
      b[first + j] = (j == 0 ? T(1) : weights[0][j - 1]) - (j + 1 < order ? weights[0][j] : T(0));
    }
    return b;
  };
  const auto by_recurrence = [](bool closed) {
    return [closed](const auto& u) {
      std::array<std::decay_t<decltype(u)>, controls> b{};
      for (std::size_t i = 0; i < controls; ++i) {
        b[i] = basis_function(i, order, u, closed);
      }
      return b;
    };
  };
  const auto inputs = sampler(parameter).named("u");
  check("P1 as printed: spans closed at both ends", verdict::disagrees, automatic,
        by_recurrence(true), inputs);
  check("P1: half-open spans", verdict::agrees, automatic, by_recurrence(false), inputs);
}

const auto curve_inputs =
    sampler(parameter, arrays<controls - 1, vectors<3>>{{0.5}}).named("u", "omega");

void curve() {
  const auto automatic = [](const auto& u, const auto& omega) { return make_curve(omega)(u); };
  // The factors after the first control, whatever its name.
  const auto others = [](auto q, const auto& u, const auto& omega) {
    for (std::size_t i = 1; i < controls; ++i) {
      q = q * exp((omega[i - 1] * cumulative_function(i, u)).eval());
    }
    return q;
  };
  const auto from_minus_one = [=](std::size_t exponent) {
    return [=](const auto& u, const auto& omega) {
      using T = std::decay_t<decltype(u)>;
      return others(pow(first_control<T>(), cumulative_function(exponent, u)), u, omega);
    };
  };
  const auto from_zero = [=](const auto& u, const auto& omega) {
    using T = std::decay_t<decltype(u)>;
    const T exponent = cumulative_function(0, u);
    const auto before = from_rotation_vector(vector3<T>(T(0), T(2), T(0))); // q_-1: any
    const auto omega_0 = log(conj(before) * first_control<T>()).vec();
    return others(pow(before, exponent) * exp((omega_0 * exponent).eval()), u, omega);
  };
  check("P2 as printed, functions from B_-1", verdict::disagrees, automatic, from_minus_one(1),
        curve_inputs);
  check("P2 as printed, functions from B_0", verdict::agrees, automatic, from_zero, curve_inputs);
  check("P2 from B_-1, the first exponent B~_-1", verdict::agrees, automatic, from_minus_one(0),
        curve_inputs);
}

// Derivatives of the cumulative functions that vary.
void basis_rates() {
  const auto inputs = sampler(parameter).named("u");
  const auto each = [](const auto& f, const auto& u) {
    return Eigen::Matrix<std::decay_t<decltype(f(1, u))>, controls - 1, 1>(f(1, u), f(2, u),
                                                                           f(3, u), f(4, u));
  };
  const auto all = [&](const auto& u) {
    return each([](std::size_t i, const auto& t) { return cumulative_function(i, t); }, u);
  };
  const auto first = [&](const auto& u) { return derivative(all, u).derivative; };
  const auto second = [&](const auto& u) { return derivatives<2>(all, u)[2]; };
  check(
      "P3: B~'_i as printed", verdict::agrees, first,
      [&](const auto& u) {
        return each([](std::size_t i, const auto& t) { return first_derivative(i, t); }, u);
      },
      inputs);
  for (const bool as_printed : {true, false}) {
    check(
        as_printed ? "P4: B~''_i as printed, one term" : "P4: B~''_i, both terms",
        as_printed ? verdict::disagrees : verdict::agrees, second,
        [&](const auto& u) {
          return each(
              [&](std::size_t i, const auto& t) { return second_derivative(i, t, as_printed); }, u);
        },
        inputs);
  }
}

/// Q' and Q'' of the curve: Q w and Q (a + w^2), the square being that of quaternions.
template <class T>
[[nodiscard]] std::array<quaternion<T>, 2> true_derivatives(const T& u,
                                                            const increments<T>& omega) {
  quaternion<T> q = first_control<T>();
  quaternion<T> w(T(0)), a(T(0));
  for (std::size_t i = 1; i < controls; ++i) {
    const quaternion<T> log_e(T(0), omega[i - 1]);
    const auto e = exp((omega[i - 1] * cumulative_function(i, u)).eval());
    const auto rate = log_e * first_derivative(i, u);
    w = conj(e) * w * e + rate;
    a = conj(e) * a * e + log_e * second_derivative(i, u, false) + (w * rate - rate * w);
    q = q * e;
  }
  return {q * w, q * (a + w * w)};
}

void curve_rates() {
  const auto first = [](const auto& u, const auto& omega) {
    const auto s = make_curve(omega);
    return derivative([&](const auto& t) { return s(t); }, u).derivative;
  };
  const auto second = [](const auto& u, const auto& omega) {
    const auto s = make_curve(omega);
    return derivatives<2>([&](const auto& t) { return s(t); }, u)[2];
  };
  const auto check_printed = [&](const std::string& label, const auto& automatic, auto select) {
    check(
        label, verdict::disagrees, automatic,
        [select](const auto& u, const auto& omega) {
          return select(printed_derivative(make_curve(omega), u));
        },
        curve_inputs);
  };
  const auto check_corrected = [&](const std::string& label, const auto& automatic, std::size_t k) {
    check(
        label, verdict::agrees, automatic,
        [k](const auto& u, const auto& omega) { return true_derivatives(u, omega)[k]; },
        curve_inputs);
  };
  check_printed("P3 as printed, functions from B_-1", first,
                [](const auto& p) { return p.literal_first; });
  check_printed("P3 as printed, functions from B_0", first,
                [](const auto& p) { return p.from_zero_first; });
  check_corrected("P3: Q' = Q w", first, 0);
  check_printed("P4 as printed, functions from B_-1", second,
                [](const auto& p) { return p.literal_second; });
  check_printed("P4 as printed, functions from B_0", second,
                [](const auto& p) { return p.from_zero_second; });
  check_printed("P4 with the basis corrected, commuting", second,
                [](const auto& p) { return p.commuting_second; });
  check_corrected("P4: Q'' = Q (a + w^2)", second, 1);
}

// P5: angular velocity from the rates of the Euler angles.
void euler_angles() {
  const auto automatic = [](const auto& angles, const auto& rates) {
    const auto rotation = [&](const auto& t) {
      return from_euler<zyx>(angles[0] + t * rates[0], angles[1] + t * rates[1],
                             angles[2] + t * rates[2]);
    };
    const auto [q, q_dot] = derivative(rotation, 0);
    return angular_velocity(q, q_dot, frame::spatial);
  };
  const auto printed = [](const auto& angles, const auto& rates) {
    using vector = std::decay_t<decltype(angles)>;
    return vector(printed_euler_rate_matrix(angles[0], angles[1]) *
                  vector(rates[2], rates[1], rates[0]));
  };
  const auto closed_form = [](const auto& angles, const auto& rates) {
    return (euler_rate_matrix<zyx>(angles[0], angles[1]) * rates).eval();
  };
  const auto inputs = sampler(vectors<3>{3}, vectors<3>{1}).named("psi theta phi", "rates");
  check("P5 as in the copy: -sin psi", verdict::disagrees, automatic, printed, inputs);
  check("P5: -sin theta", verdict::agrees, automatic, closed_form, inputs);
}

int run() {
  basis();
  curve();
  basis_rates();
  curve_rates();
  euler_angles();
  std::cout << to_markdown(table);
  return as_expected ? 0 : 1;
}

} // namespace

int main() { return example::run_program("printed_formulas", run); }
