// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "support/message.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>

/// \file
/// Knots, parameters and control quaternions for tests of splines, and independent implementations
/// of the definitions P1 and P2 over any scalar.

namespace duet_test {

struct named_knots {
  std::string name;
  std::vector<double> knots;
};

/// Knot vectors of every kind that this order allows: simple, repeated at the ends, repeated
/// inside.
[[nodiscard]] inline std::vector<named_knots> knot_vectors(int order) {
  random_source random(std::uint64_t(order) + 40);
  std::vector<double> uniform, simple, uneven;
  double u = -1, v = -1;
  for (int i = 0; i < 2 * order + 5; ++i) {
    uniform.push_back((i - order) * 0.25);
    u += random.uniform(0.2, 1);
    simple.push_back(u);
    v += random.log_uniform(1e-2, 2);
    uneven.push_back(v);
  }
  std::vector<named_knots> result = {
      {"uniform", uniform}, {"not uniform", simple}, {"very uneven", uneven}};
  const std::vector<double> parameters = {-0.3, 0.1, 0.4, 1, 1.2, 2.1, 2.5};
  result.push_back({"repeated at the ends", duet::clamped_knots(parameters, order)});
  result.push_back({"one span", duet::clamped_knots(std::vector<double>{0.5, 2}, order)});
  for (int times = 2; times <= std::min(order, 3); ++times) {
    std::vector<double> repeated = parameters;
    repeated.insert(repeated.begin() + 3, std::size_t(times) - 1, repeated[3]);
    result.push_back(
        {std::to_string(times) + "-fold inside", duet::clamped_knots(repeated, order)});
    result.push_back({std::to_string(times) + "-fold anywhere", uneven});
    std::vector<double>& anywhere = result.back().knots;
    for (std::size_t i = 2; i + 2 < anywhere.size(); i += 5) {
      std::fill_n(anywhere.begin() + long(i), times, anywhere[i]);
    }
  }
  return result;
}

/// Parameters at both ends and at some inner points of every span of the domain.
[[nodiscard]] inline std::vector<double> parameters_on(const std::vector<double>& knots, int order,
                                                       int inside = 5) {
  random_source random(7);
  std::vector<double> result;
  for (std::size_t i = std::size_t(order) - 1; i + std::size_t(order) < knots.size(); ++i) {
    const double left = knots[i], right = knots[i + 1];
    if (left < right) {
      result.push_back(left);
      result.push_back(std::nextafter(right, left));
      for (int j = 0; j < inside; ++j) {
        result.push_back(std::min(random.uniform(left, right), std::nextafter(right, left)));
      }
    }
  }
  result.push_back(knots[knots.size() - std::size_t(order)]);
  return result;
}

/// Increasing parameters with steps of 0.4 to 1.2.
[[nodiscard]] inline std::vector<double> uneven_parameters(std::size_t count) {
  random_source random(count + 5);
  std::vector<double> result = {-2};
  while (result.size() < count) {
    result.push_back(result.back() + random.uniform(0.4, 1.2));
  }
  return result;
}

/// Unit quaternions, each rotated relative to the one before by up to `step` radians about a random
/// axis.
[[nodiscard]] inline std::vector<duet::quaternion<double>>
random_orientations(std::size_t count, double step, std::uint64_t seed = 1) {
  random_source random(seed);
  std::vector<duet::quaternion<double>> result;
  duet::quaternion<double> q(1.0);
  for (std::size_t i = 0; i < count; ++i) {
    const auto n = random.direction<3>();
    const double half = random.uniform(0.3, 0.5) * (i == 0 ? 6 : step);
    const duet::vector3<double> v(n[0] * half, n[1] * half, n[2] * half);
    q = normalized(q * duet::exp(v));
    result.push_back(q);
  }
  return result;
}

/// Unit quaternions, each rotated relative to the one before by exactly `angle` about a random
/// axis.
[[nodiscard]] inline std::vector<duet::quaternion<double>>
rotated_by(double angle, std::size_t count, std::uint64_t seed) {
  random_source random(seed);
  std::vector<duet::quaternion<double>> result = {duet::quaternion<double>(1)};
  while (result.size() < count) {
    const auto n = random.direction<3>();
    const duet::vector3<double> half(n[0] * angle / 2, n[1] * angle / 2, n[2] * angle / 2);
    result.push_back(normalized(result.back() * duet::exp(half)));
  }
  return result;
}

/// Poses with rotations as `random_orientations` and coordinates of up to 2. The last one has the
/// opposite sign, which must have no effect.
[[nodiscard]] inline std::vector<duet::dual_quaternion<double>> random_poses(std::size_t count,
                                                                             double step) {
  random_source random(count);
  std::vector<duet::dual_quaternion<double>> result;
  for (const auto& q : random_orientations(count, step)) {
    const duet::vector3<double> t{random.uniform(-2, 2), random.uniform(-2, 2),
                                  random.uniform(-2, 2)};
    result.push_back(duet::pose(q, t));
  }
  result.back() = -result.back();
  return result;
}

/// Largest difference of components.
template <class A, class B>
[[nodiscard]] double max_abs_difference(const duet::quaternion<A>& p,
                                        const duet::quaternion<B>& q) {
  using std::abs;
  return double(std::max(std::max(abs(p.w() - q.w()), abs(p.x() - q.x())),
                         std::max(abs(p.y() - q.y()), abs(p.z() - q.z()))));
}

template <class R>
[[nodiscard]] std::vector<R> cast(const std::vector<double>& x) {
  return {x.begin(), x.end()};
}
template <class T>
[[nodiscard]] std::vector<duet::quaternion<T>>
cast(const std::vector<duet::quaternion<double>>& q) {
  std::vector<duet::quaternion<T>> result;
  for (const auto& each : q) {
    result.push_back({T(each.w()), T(each.x()), T(each.y()), T(each.z())});
  }
  return result;
}

/// Basis function B_i^k(u), P1. The interval is selected by `at` alone, so that B is a polynomial
/// in u, which can be differentiated. At the end of the domain the last interval is used.
template <class R, class S>
[[nodiscard]] S b_definition(const std::vector<R>& knots, std::size_t i, int k, const S& u,
                             const R& at, const R& end) {
  if (k == 1) {
    const bool counts =
        at == end ? knots[i] < at && knots[i + 1] == at : knots[i] <= at && at < knots[i + 1];
    return S(R(counts ? 1 : 0));
  }
  const auto uk = std::size_t(k);
  S sum(R(0));
  if (knots[i] < knots[i + uk - 1]) {
    sum = sum + (u - knots[i]) * b_definition(knots, i, k - 1, u, at, end) /
                    R(knots[i + uk - 1] - knots[i]);
  }
  if (knots[i + 1] < knots[i + uk]) {
    sum = sum + (knots[i + uk] - u) * b_definition(knots, i + 1, k - 1, u, at, end) /
                    R(knots[i + uk] - knots[i + 1]);
  }
  return sum;
}

/// Cumulative function B̃_i(u) = Σ_{j≥i} B_j(u), P2, by definition.
template <class R, class S>
[[nodiscard]] S cumulative_definition(const std::vector<R>& knots, std::size_t i, int order,
                                      const S& u, const R& at) {
  const std::size_t size = knots.size() - std::size_t(order);
  S sum(R(0));
  for (std::size_t j = i; j < size; ++j) {
    sum = sum + b_definition(knots, j, order, u, at, knots[size]);
  }
  return sum;
}

/// Curve q_0 ∏ exp(ω_i B̃_i(u)), P2: the product over all given ω_i, with `at` as above.
template <class R, class S>
[[nodiscard]] duet::quaternion<S>
product_definition(const std::vector<R>& knots, int order, const duet::quaternion<R>& first,
                   const std::vector<duet::vector3<R>>& increments, const S& u, const R& at) {
  duet::quaternion<S> q(first);
  for (std::size_t i = 1; i < increments.size(); ++i) {
    const S b = cumulative_definition(knots, i, order, u, at);
    const duet::vector3<R>& omega = increments[i];
    q = q * duet::exp(duet::vector3<S>(omega[0] * b, omega[1] * b, omega[2] * b));
  }
  return q;
}

/// Increments ω_i = log(q_{i−1}⁻¹ q_i), P2, of aligned control quaternions.
template <class R>
[[nodiscard]] std::vector<duet::vector3<R>>
increments_of(const std::vector<duet::quaternion<R>>& controls) {
  std::vector<duet::vector3<R>> result(controls.size());
  for (std::size_t i = 1; i < controls.size(); ++i) {
    result[i] = log(inverse(controls[i - 1]) * controls[i]).vec();
  }
  return result;
}

} // namespace duet_test
