// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// What the papers print, and what is true: every printed formula that duet knows to be wrong,
/// judged against automatic differentiation beside the true one. Prints the table of
/// docs/printed_formulas.md; ends with 1 where a verdict is not the expected one.

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
void judge(const std::string& label, verdict expected, const F& automatic, const G& closed_form,
           const Inputs& inputs) {
  table.push_back(
      compare<double, real_50>(label, automatic, closed_form, inputs, {.samples = 120}));
  as_expected = as_expected && table.back().outcome == expected;
}

// N6: the derivative of a product of quaternions.
void product_rule() {
  const auto automatic = [](const auto& p, const auto& p_rate, const auto& q, const auto& q_rate) {
    const auto product = [&](const auto& t) { return (p + t * p_rate) * (q + t * q_rate); };
    return derivative(product, 0).derivative;
  };
  const auto wrong = [](const auto& p, const auto& p_rate, const auto& q, const auto& q_rate) {
    return q * p_rate + q_rate * p;
  };
  const auto true_rule = [](const auto& p, const auto& p_rate, const auto& q, const auto& q_rate) {
    return p_rate * q + p * q_rate;
  };
  const auto inputs = sampler(quaternions{1}, quaternions{1}, quaternions{1}, quaternions{1})
                          .named("p", "p'", "q", "q'");
  judge("N6 in the wrong order: q p' + q' p", verdict::disagrees, automatic, wrong, inputs);
  judge("N6: p' q + p q'", verdict::agrees, automatic, true_rule, inputs);
}

// The curve of the spline tests: cubic over uniform knots, two spans, five control quaternions of
// given half-angle increments.
constexpr std::array<double, 9> knots = {-3, -2, -1, 0, 1, 2, 3, 4, 5};
constexpr std::size_t order = 4;
constexpr std::size_t controls = knots.size() - order;

template <class T>
using increments = std::array<vector3<T>, controls - 1>;

template <class T>
[[nodiscard]] cumulative_bspline<T> make_curve(const increments<T>& omega) {
  std::vector<quaternion<T>> q = {from_rotation_vector(vector3<T>(T(1), T(0), T(0)))};
  std::vector<vector3<T>> increments_of_all = {vector3<T>::Zero()};
  for (const vector3<T>& w : omega) {
    q.push_back(q.back() * exp(w));
    increments_of_all.push_back(w);
  }
  return {std::vector<T>(knots.begin(), knots.end()), q, increments_of_all};
}

/// B_i^k by de Boor and Cox's recurrence (P1); `closed` takes the print at its word, that spans
/// hold both their ends.
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

const auto parameter = real_numbers{0, 1.999};

void basis() {
  // The curve's own weights: B_i is the difference of neighbours in the cumulative basis.
  const auto automatic = [](const auto& u) {
    using T = std::decay_t<decltype(u)>;
    const bspline_basis<int(order), T> functions(std::vector<T>(knots.begin(), knots.end()));
    const std::size_t span = functions.span_of(u);
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
  judge("P1 as printed: spans closed at both ends", verdict::disagrees, automatic,
        by_recurrence(true), inputs);
  judge("P1: half-open spans", verdict::agrees, automatic, by_recurrence(false), inputs);
}

const auto curve_inputs =
    sampler(parameter, arrays<controls - 1, vectors<3>>{{0.5}}).named("u", "omega");

void curve() {
  const auto automatic = [](const auto& u, const auto& omega) { return make_curve(omega)(u); };
  const auto product = [](std::size_t exponent_of_first) {
    return [exponent_of_first](const auto& u, const auto& omega) {
      using T = std::decay_t<decltype(u)>;
      const quaternion<T> start = from_rotation_vector(vector3<T>(T(1), T(0), T(0)));
      quaternion<T> q = pow(start, cumulative_function(exponent_of_first, u));
      for (std::size_t i = 1; i < controls; ++i) {
        q = q * exp(vector3<T>(omega[i - 1] * cumulative_function(i, u)));
      }
      return q;
    };
  };
  judge("P2 as printed: the first exponent is that of q_0", verdict::disagrees, automatic,
        product(1), curve_inputs);
  judge("P2: the first exponent is that of q_-1", verdict::agrees, automatic, product(0),
        curve_inputs);
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
  const auto closed_form = [](std::size_t k) {
    return [k](const auto& u, const auto& omega) { return make_curve(omega).derivatives(u)[k]; };
  };
  const auto judge_printed = [&](const std::string& label, const auto& automatic, auto select) {
    judge(
        label, verdict::disagrees, automatic,
        [select](const auto& u, const auto& omega) {
          return select(printed_derivative(make_curve(omega), u));
        },
        curve_inputs);
  };
  judge_printed("P3 as printed", first, [](const auto& p) { return p.literal_first; });
  judge_printed("P3 without the lone scalar, commuting", first,
                [](const auto& p) { return p.commuting_first; });
  judge("P3: Q' = Q w", verdict::agrees, first, closed_form(1), curve_inputs);
  judge_printed("P4 as printed", second, [](const auto& p) { return p.literal_second; });
  judge_printed("P4 with the basis corrected, commuting", second,
                [](const auto& p) { return p.commuting_second; });
  judge("P4: Q'' = Q (a - w^2)", verdict::agrees, second, closed_form(2), curve_inputs);
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
  judge("P5 as printed: -sin psi", verdict::disagrees, automatic, printed, inputs);
  judge("P5: -sin theta", verdict::agrees, automatic, closed_form, inputs);
}

} // namespace

int main() {
  product_rule();
  basis();
  curve();
  curve_rates();
  euler_angles();
  std::cout << to_markdown(table);
  return as_expected ? 0 : 1;
}
