// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "support/random.hpp"

#include <duet/dual/math.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

/// \file
/// Every smooth function of one argument: how to call it on any scalar, its derivative in wide
/// arithmetic (derived by hand, not by the rules of the library), and inputs that are hard.

namespace duet_test {

/// Points at which a function is tested.
struct domain {
  std::vector<double> inputs;

  /// ± magnitudes from 1e-300 to `largest`, signed zeros, and random numbers.
  static domain line(double largest) {
    domain d{{0.0, -0.0}};
    for (const double x : {1e-300, 1e-160, 1e-30, 1e-8, 1e-4, 0.3, 0.7, 0.9, 1.0, 1.5, 3.0, 10.0,
                           26.0, 300.0, 700.0, 1e8, 1e15, 1e160, 1e300}) {
      if (x <= largest) {
        d.inputs.insert(d.inputs.end(), {x, -x});
      }
    }
    return d.with_random(-std::min(largest, 20.0), std::min(largest, 20.0));
  }
  static domain positive() {
    domain d{{1e-307, 1e-300, 1e-160, 1e-30, 1e-8, 0.5, 1 - 1e-12, 1.0, 1 + 1e-12, 7.0, 1e8, 1e160,
              1e300}};
    return d.with_random(0, 5);
  }
  static domain both_signs() {
    domain d = positive();
    const auto positive_inputs = d.inputs;
    for (const double x : positive_inputs) {
      d.inputs.push_back(-x);
    }
    return d;
  }
  static domain between_ones() {
    domain d{{0.0, -0.0}};
    for (const double x : {1e-300, 1e-160, 1e-8, 0.1, 0.5, 0.75, 0.99, 1 - 1e-8, 1 - 0x1p-53}) {
      d.inputs.insert(d.inputs.end(), {x, -x});
    }
    return d.with_random(-1, 1);
  }
  static domain above_one() {
    domain d{{1 + 0x1p-52, 1 + 1e-8, 1.001, 1.5, 2.0, 30.0, 1e8, 1e160, 1e300}};
    return d.with_random(1, 4);
  }
  static domain above_minus_one() {
    domain d = positive();
    d.inputs.insert(d.inputs.end(), {0.0, -0.0, -1e-300, -1e-8, -0.5, -0.99, -1 + 0x1p-53});
    return d.with_random(-1, 0);
  }

private:
  domain with_random(double low, double high) {
    random_source random(20260726);
    for (int i = 0; i < 60; ++i) {
      inputs.push_back(random.uniform(low, high));
    }
    return *this;
  }
};

/// visit(name, f, df, domain, length): f over any scalar, df over a wide real, and how far from x
/// both are smooth, which sets the step of difference quotients.
template <class Visit>
void for_each_function(Visit&& visit) {
  using std::acos, std::acosh, std::asin, std::asinh, std::atan, std::atanh, std::cbrt, std::cos,
      std::cosh, std::erf, std::erfc, std::exp, std::exp2, std::expm1, std::log, std::log10,
      std::log1p, std::log2, std::sin, std::sinh, std::sqrt, std::tan, std::tanh;
  const auto unit = []<class R>(const R&) { return R(1); };
  const auto size = []<class R>(const R& x) -> R { return abs(x) > 1 ? abs(x) : R(1); };
  const auto from_zero = []<class R>(const R& x) -> R { return abs(x); };
  const auto from_ones = []<class R>(const R& x) -> R { return 1 - abs(x); };

  visit(
      "sqrt", [](const auto& x) { return sqrt(x); },
      []<class R>(const R& x) -> R { return pow(x, R(-0.5)) / 2; }, domain::positive(), from_zero);
  visit(
      "cbrt", [](const auto& x) { return cbrt(x); },
      []<class R>(const R& x) -> R { return pow(R(abs(x)), R(-2) / 3) / 3; }, domain::both_signs(),
      from_zero);
  visit(
      "exp", [](const auto& x) { return exp(x); }, []<class R>(const R& x) -> R { return exp(x); },
      domain::line(700), unit);
  visit(
      "exp2", [](const auto& x) { return exp2(x); },
      []<class R>(const R& x) -> R { return exp(R(x * log(R(2)))) * log(R(2)); }, domain::line(700),
      unit);
  visit(
      "expm1", [](const auto& x) { return expm1(x); },
      []<class R>(const R& x) -> R { return exp(x); }, domain::line(700), unit);
  visit(
      "log", [](const auto& x) { return log(x); }, []<class R>(const R& x) -> R { return 1 / x; },
      domain::positive(), from_zero);
  visit(
      "log2", [](const auto& x) { return log2(x); },
      []<class R>(const R& x) -> R { return 1 / (x * log(R(2))); }, domain::positive(), from_zero);
  visit(
      "log10", [](const auto& x) { return log10(x); },
      []<class R>(const R& x) -> R { return 1 / (x * log(R(10))); }, domain::positive(), from_zero);
  visit(
      "log1p", [](const auto& x) { return log1p(x); },
      []<class R>(const R& x) -> R { return 1 / (1 + x); }, domain::above_minus_one(),
      []<class R>(const R& x) -> R { return 1 + x; });
  visit(
      "sin", [](const auto& x) { return sin(x); }, []<class R>(const R& x) -> R { return cos(x); },
      domain::line(1e15), unit);
  visit(
      "cos", [](const auto& x) { return cos(x); }, []<class R>(const R& x) -> R { return -sin(x); },
      domain::line(1e15), unit);
  visit(
      "tan", [](const auto& x) { return tan(x); },
      []<class R>(const R& x) -> R {
        const R c = cos(x);
        return 1 / (c * c);
      },
      domain::line(1e15), []<class R>(const R& x) -> R { return abs(cos(x)); });
  visit(
      "asin", [](const auto& x) { return asin(x); },
      []<class R>(const R& x) -> R { return 1 / sqrt(R(1 - x * x)); }, domain::between_ones(),
      from_ones);
  visit(
      "acos", [](const auto& x) { return acos(x); },
      []<class R>(const R& x) -> R { return -1 / sqrt(R(1 - x * x)); }, domain::between_ones(),
      from_ones);
  visit(
      "atan", [](const auto& x) { return atan(x); },
      []<class R>(const R& x) -> R { return 1 / (1 + x * x); }, domain::line(1e300), size);
  visit(
      "sinh", [](const auto& x) { return sinh(x); },
      []<class R>(const R& x) -> R { return (exp(x) + exp(R(-x))) / 2; }, domain::line(700), unit);
  visit(
      "cosh", [](const auto& x) { return cosh(x); },
      []<class R>(const R& x) -> R { return sinh(x); }, domain::line(700), unit);
  visit(
      "tanh", [](const auto& x) { return tanh(x); },
      []<class R>(const R& x) -> R {
        const R c = exp(x) + exp(R(-x));
        return 4 / (c * c);
      },
      domain::line(700), unit);
  visit(
      "asinh", [](const auto& x) { return asinh(x); },
      []<class R>(const R& x) -> R { return 1 / sqrt(R(1 + x * x)); }, domain::line(1e300), size);
  visit(
      "acosh", [](const auto& x) { return acosh(x); },
      []<class R>(const R& x) -> R { return 1 / sqrt(R((x - 1) * (x + 1))); }, domain::above_one(),
      []<class R>(const R& x) -> R { return x - 1; });
  visit(
      "atanh", [](const auto& x) { return atanh(x); },
      []<class R>(const R& x) -> R { return 1 / (1 - x * x); }, domain::between_ones(), from_ones);
  visit(
      "erf", [](const auto& x) { return erf(x); },
      []<class R>(const R& x) -> R { return exp(R(-x * x)) / sqrt(R(atan(R(1)))); },
      domain::line(26), unit);
  visit(
      "erfc", [](const auto& x) { return erfc(x); },
      []<class R>(const R& x) -> R { return -exp(R(-x * x)) / sqrt(R(atan(R(1)))); },
      domain::line(26), unit);
}

} // namespace duet_test
