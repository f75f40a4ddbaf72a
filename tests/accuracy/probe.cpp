// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "accuracy/probe.hpp"

#include "support/random.hpp"
#include "support/ulp.hpp"

namespace duet_test::accuracy {

namespace {

/// x + t d and, with a second direction, + s d₂.
jets variables(const numbers& x, const numbers& d, const numbers& d2) {
  const jet_shape& shape = *jet_shape::current;
  jets result;
  for (std::size_t i = 0; i < x.size(); ++i) {
    jet v{real(x[i])};
    v.c[shape.find({1, 0, 0, 0})] = d[i];
    if (!d2.empty()) {
      v.c[shape.find({0, 1, 0, 0})] = d2[i];
    }
    result.push_back(v);
  }
  return result;
}

/// The variables changed by 1e-30 of the norms of the parts that they belong to, in any direction.
jets changed(jets x, const std::vector<std::size_t>& parts, random_source& random) {
  std::size_t first = 0;
  for (const std::size_t count : parts) {
    for (std::size_t m = 0; m < x[first].c.size(); ++m) {
      real square = 0;
      for (std::size_t i = first; i < first + count; ++i) {
        square += x[i].c[m] * x[i].c[m];
      }
      if (square != 0) {
        const real norm = sqrt(real(square / int(count))) * real("1e-30");
        for (std::size_t i = first; i < first + count; ++i) {
          x[i].c[m] += random.uniform(0, 1) < 0.5 ? norm : real(-norm);
        }
      }
    }
    first += count;
  }
  return x;
}

/// The variables with other rates; the rates of each part have the same norm as before.
jets with_other_rates(jets x, const std::vector<std::size_t>& parts, random_source& random) {
  std::size_t first = 0;
  for (const std::size_t count : parts) {
    for (std::size_t m = 1; m < x[first].c.size(); ++m) {
      real square = 0, other = 0;
      for (std::size_t i = first; i < first + count; ++i) {
        square += x[i].c[m] * x[i].c[m];
      }
      if (square != 0) {
        for (std::size_t i = first; i < first + count; ++i) {
          x[i].c[m] = random.normal();
          other += x[i].c[m] * x[i].c[m];
        }
        for (std::size_t i = first; i < first + count; ++i) {
          x[i].c[m] *= sqrt(real(square / other));
        }
      }
    }
    first += count;
  }
  return x;
}

numbers coefficients_of(const line& x) {
  return {x.coefficient(0), x.coefficient(1), x.coefficient(2), x.coefficient(3), x.coefficient(4)};
}
numbers coefficients_of(const plane& x) {
  return {x.value(),
          x.partial(0),
          x.partial(1),
          x.second_partial(0, 0) / 2,
          x.second_partial(0, 1),
          x.second_partial(1, 1) / 2};
}

void set_variable(line& x, double rate, double) { x.set_coefficient(1, rate); }
void set_variable(plane& x, double rate, double rate2) {
  plane::gradient_type g;
  g.set(0, rate);
  g.set(1, rate2);
  x = plane(x.value(), g, {});
}

template <class T>
row probe(const probed<T>& f, int count, const jet_shape& shape) {
  jet_shape::current = &shape;
  row r{f.name};
  random_source random(101);
  for (int n = 0; n < count; ++n) {
    const input at = f.inputs(n, random);
    numbers d2;
    std::vector<T> x;
    for (std::size_t i = 0; i < at.x.size(); ++i) {
      d2.push_back(std::is_same_v<T, plane> ? random.normal() : 0);
      x.emplace_back(at.x[i]);
      set_variable(x.back(), at.direction[i], d2.back());
    }
    computed_results computed{{}, f.parts, {}};
    for (const T& y : f.function(x)) {
      computed.coefficients.push_back(coefficients_of(y));
    }
    judge(r, at, std::is_same_v<T, plane> ? d2 : numbers{}, f.exact, computed);
  }
  return r;
}

} // namespace

row worst_of(const std::string& name, const rows& each) {
  row result{name};
  double max_error = -1;
  for (const row& r : each) {
    result.inputs += r.inputs;
    result.orders = std::max(result.orders, r.orders);
    const double worst = *std::max_element(r.worst.begin(), r.worst.end());
    if (worst > max_error) {
      max_error = worst;
      result.worst_where = r.name + "; " + r.worst_where;
    }
    for (std::size_t k = 0; k < r.worst.size(); ++k) {
      result.worst[k] = std::max(result.worst[k], r.worst[k]);
    }
  }
  return result;
}

void judge(row& r, const input& at, const numbers& d2, const oracle_function& exact,
           const computed_results& computed) {
  const auto& [coefficients, parts, orders] = computed;
  const jet_shape& shape = *jet_shape::current;
  const jets x = variables(at.x, at.direction, d2);
  const jets reference = exact(x);
  constexpr int samples = 4;
  random_source random(77);
  std::vector<jets> neighbours, elsewhere;
  for (int n = 0; n < samples; ++n) {
    neighbours.push_back(exact(changed(x, at.parts, random)));
    elsewhere.push_back(exact(with_other_rates(x, at.parts, random)));
  }
  ++r.inputs;
  std::size_t first = 0;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    const std::size_t count = parts[part];
    for (std::size_t m = 0; m < coefficients[first].size(); ++m) {
      const auto& monomial = shape.monomials[m];
      const int order = monomial[0] + monomial[1] + (orders.empty() ? 0 : orders[part]);
      real error = 0, size = 0, change = 0, typical = 0;
      bool is_finite = true;
      for (std::size_t i = first; i < first + count; ++i) {
        const double c = coefficients[i][m];
        is_finite = is_finite && c - c == 0;
        error += is_finite ? pow(real(c) - reference[i].c[m], 2) : real(0);
        size += pow(reference[i].c[m], 2);
        for (const jets& y : elsewhere) {
          typical += pow(y[i].c[m], 2) / samples;
        }
        for (const jets& y : neighbours) {
          change += pow((y[i].c[m] - reference[i].c[m]) * real("1e30"), 2) / samples;
        }
      }
      if (sqrt(size) > std::numeric_limits<double>::max() / 4) {
        continue; // after an overflow the error is infinite or NaN
      }
      const double ulps =
          is_finite ? ulps_of_error<double>(real(sqrt(error)),
                                            real(sqrt(size) + sqrt(change) + sqrt(typical)))
                    : std::numeric_limits<double>::infinity();
      r.orders = std::max(r.orders, order);
      double& worst = r.worst[std::size_t(order)];
      if (ulps > *std::max_element(r.worst.begin(), r.worst.end())) {
        r.worst_where = at.where + ", order " + std::to_string(order);
      }
      worst = std::max(worst, ulps);
    }
    first += count;
  }
}

row probe_lines(const probed<line>& f, int count) {
  static const jet_shape shape = jet_shape::line();
  return probe(f, count, shape);
}
row probe_planes(const probed<plane>& f, int count) {
  static const jet_shape shape = jet_shape::plane();
  return probe(f, count, shape);
}

} // namespace duet_test::accuracy
