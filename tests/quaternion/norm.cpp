// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "quaternion/hard_inputs.hpp"
#include "quaternion/truth.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/norm.hpp>

// N3: |q|, q/|q| and q⁻¹, for |q| from 1e-140 to 1e140, with first and second derivatives, against
// 100 digits.

namespace test_quaternion_norm {
namespace {

using duet::quaternion, duet_test::random_source, duet_test::worst_error;
namespace reference = duet_test::reference;

reference::four exact_norm(const reference::four& q) { return {reference::length(q), 0, 0, 0}; }
reference::four exact_direction(const reference::four& q) {
  return reference::times(q, 1 / reference::length(q));
}
reference::four exact_inverse(const reference::four& q) {
  return reference::times(reference::conj(q), 1 / (reference::length(q) * reference::length(q)));
}

bool overflows(const reference::four& x) { return reference::length(x) > 1e308; }

/// The value and two derivatives along a direction of unit length. The function is homogeneous of
/// this degree: its k-th derivatives are about k! |q|^(degree − k).
template <class F, class G>
void check(const char* name, int degree, const F& f, const G& exact_f) {
  worst_error worst[3] = {worst_error(name), worst_error(name + std::string("'")),
                          worst_error(name + std::string("''"))};
  random_source random(41);
  constexpr int next_factorial[] = {1, 2, 6};
  for (const auto& q : duet_test::hard_quaternions()) {
    const auto d = random.direction<4>();
    const quaternion<double> q_dot(d[0], d[1], d[2], d[3]);
    const auto y = duet::derivatives<2>([&](const auto& t) { return f(q + t * q_dot); }, 0.0);
    const reference::four x = reference::wide(q);
    const reference::four dx = reference::wide(q_dot);
    const reference::real size = reference::length(x);
    std::array<reference::four, 3> exact;
    for (int k = 0; k <= 2; ++k) {
      exact[std::size_t(k)] = reference::difference(
          [&](const reference::real& t) { return exact_f(reference::sum(x, dx, t)); }, k, size);
    }
    for (std::size_t k = 0; k <= 2; ++k) {
      if (!overflows(exact[k])) {
        worst[k].add(
            reference::ulps(y[k], exact[k], next_factorial[k] * pow(size, degree - int(k))), q,
            q_dot);
      }
    }
  }
  for (const worst_error& w : worst) {
    CHECK_MESSAGE(w <= 4, w);
  }
}

TEST_CASE("N3: norm, direction, inverse, their derivatives agree with 100 digits at any size") {
  const auto norm_as_quaternion = [](const auto& q) {
    using T = typename std::decay_t<decltype(q)>::scalar_type;
    return quaternion<T>(norm(q));
  };
  check("norm", 1, norm_as_quaternion, exact_norm);
  const auto direction = [](const auto& q) { return normalized(q); };
  check("normalized", 0, direction, exact_direction);
  check(
      "inverse", -1, [](const auto& q) { return inverse(q); }, exact_inverse);
}

TEST_CASE("norm and normalized: no overflow or underflow at the ends of the range") {
  constexpr double smallest = 5e-324;
  constexpr double largest = 1.7976931348623157e308;
  CHECK(norm(quaternion<double>(0, smallest, 0, 0)) == smallest);
  CHECK(norm(quaternion<double>(0, 0, -largest, 0)) == largest);
  CHECK(std::isinf(norm(quaternion<double>(0, largest, largest, 0))));
  CHECK(norm(normalized(quaternion<double>(0, 1e308, 1e308, 1e308))) ==
        doctest::Approx(1).epsilon(1e-15));
  CHECK(normalized(quaternion<double>(0, 0, 0, smallest)) == quaternion<double>(0, 0, 0, 1));
  CHECK(std::isinf(norm(quaternion<double>(0, HUGE_VAL, 0, 0))));
  CHECK(std::isnan(norm(quaternion<double>(0, std::nan(""), 0, 1e200))));
  CHECK(norm(quaternion<float>(0, 1e-30F, 0, 1e-30F)) ==
        doctest::Approx(1.41421356e-30).epsilon(1e-6));
  CHECK(norm(quaternion<float>(0, 1e30F, 0, 1e30F)) ==
        doctest::Approx(1.41421356e30).epsilon(1e-6));
}

} // namespace
} // namespace test_quaternion_norm
