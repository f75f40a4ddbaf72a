// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>

// Tables with very uneven parameters and motions of uniform rate.

namespace test_spline_uneven {
namespace {

using rotation = duet::quaternion<double>;
using pose_type = duet::dual_quaternion<double>;
using vector = duet::vector3<double>;
using duet_test::random_source;
template <class Q>
using cumulative = duet::cumulative_bspline<typename Q::scalar_type>;
template <class Q, int Order>
using rotation_vectors = duet::rotation_vector_spline<typename Q::scalar_type, Order>;

vector random_vector(random_source& random, double size) {
  const auto d = random.direction<3>();
  return vector(d[0], d[1], d[2]) * size;
}

template <class Q>
struct table {
  std::vector<double> u{0};
  std::vector<Q> samples{Q(1.0)};
};

/// Samples at these intervals that rotate and move at this rate about and along random axes. If
/// `closes`, the motion returns through the same samples.
template <class Q>
table<Q> random_table(random_source& random, std::vector<double> intervals, double rate,
                      bool closes = false) {
  table<Q> t;
  const std::size_t n = intervals.size();
  for (std::size_t i = 0; i < n; ++i) {
    t.u.push_back(t.u.back() + intervals[i]);
    const double size = rate * intervals[i];
    rotation step = duet::from_rotation_vector(random_vector(random, size));
    if constexpr (std::is_same_v<Q, rotation>) {
      t.samples.push_back(t.samples.back() * step);
    } else {
      t.samples.push_back(t.samples.back() * duet::pose(step, random_vector(random, size)));
    }
  }
  for (std::size_t i = n; i-- > 0 && closes;) {
    t.u.push_back(t.u.back() + intervals[i]);
    t.samples.push_back(t.samples[i]);
  }
  return t;
}

std::vector<double> random_intervals(random_source& random, int count, double decades) {
  std::vector<double> result;
  for (int i = 0; i < count; ++i) {
    result.push_back(std::pow(10, random.uniform(-decades / 2, decades / 2)));
  }
  return result;
}

double largest(const std::vector<double>& x) { return *std::max_element(x.begin(), x.end()); }

/// Largest distance of the samples from the curve with these end conditions.
template <class Spline, class Q, class Ends>
double miss(const table<Q>& t, const Ends& ends) {
  const Spline s = duet::interpolate<Spline>(t.u, t.samples, ends);
  double worst = 0;
  for (std::size_t i = 0; i < t.u.size(); ++i) {
    const Q error = conj(t.samples[i]) * s(t.u[i]);
    if constexpr (std::is_same_v<Q, rotation>) {
      worst = std::max(worst, duet::rotation_vector(error).norm());
    } else {
      worst = std::max(worst, duet::rotation_vector(duet::rotation(error)).norm());
      worst = std::max(worst, duet::translation(error).norm());
    }
  }
  return worst;
}

template <class Spline>
void check_ends(random_source& random) {
  const std::vector<double> intervals = random_intervals(random, 4 + int(random.uniform(0, 8)), 12);
  const double longest = largest(intervals), rate = 1 / longest;
  const auto t = random_table<rotation>(random, intervals, rate);
  const vector first = random_vector(random, rate), last = random_vector(random, rate);
  CHECK(miss<Spline>(t, duet::natural{}) < 1e-13);
  CHECK(miss<Spline>(t, duet::clamped{first, last}) < 1e-13);
  CHECK(miss<Spline>(t, duet::end_acceleration{vector(first * rate), vector(last * rate)}) < 1e-13);
  const auto round = random_table<rotation>(random, intervals, rate, true);
  CHECK(miss<Spline>(round, duet::periodic{}) < 1e-13);
}

template <class Q>
using cubic = rotation_vectors<Q, 4>;

TEST_CASE(
    "interpolate: intervals of 1e-6 between intervals of 1e3, with a uniform rate, converge") {
  random_source random(1);
  for (int i = 0; i < 20; ++i) {
    CAPTURE(i);
    std::vector<double> intervals(5, 1e-6);
    intervals[1] = intervals[3] = 1e3;
    const auto t = random_table<rotation>(random, intervals, 1e-3);
    CHECK(miss<cumulative<rotation>>(t, duet::natural{}) < 1e-13);
    CHECK(miss<cubic<rotation>>(t, duet::natural{}) < 1e-13);
  }
}

TEST_CASE("interpolate: intervals over twelve decades converge with all end conditions except "
          "not-a-knot") {
  random_source random(2);
  for (int i = 0; i < 6; ++i) {
    CAPTURE(i);
    check_ends<cumulative<rotation>>(random);
    check_ends<cubic<rotation>>(random);
  }
  const std::vector<double> intervals = random_intervals(random, 8, 12);
  const auto t = random_table<pose_type>(random, intervals, 1 / largest(intervals));
  CHECK(miss<cumulative<pose_type>>(t, duet::natural{}) < 1e-13);
}

TEST_CASE(
    "interpolate: if not-a-knot ends fail for uneven parameters, the error gives the unevenness") {
  // The first segment is a cubic through three adjacent samples and a distant one.
  random_source random(3);
  const auto t = random_table<rotation>(random, {1, 1e-5, 1e-5, 1e-5, 1}, 1);
  const auto message = duet_test::message_of<duet::no_convergence>(
      [&] { (void)duet::interpolate<cumulative<rotation>>(t.u, t.samples, duet::not_a_knot{}); });
  CHECK(message.find("the parameters may be too uneven for these end conditions, the longest "
                     "interval is 100000 times the shortest") != std::string::npos);
  CHECK(miss<cumulative<rotation>>(t, duet::natural{}) < 1e-13);
}

/// Scale for the round-off of a derivative at a knot.
enum class measure {
  derivative, ///< largest value of this derivative at the ends of the two adjacent segments
  terms ///< largest term h^{j−k} Q^(j) of the Taylor series of these segments, h their length
};

/// Largest jumps of Q, Q′ … at the inner knots, in units of round-off.
template <std::size_t Count, class Spline>
std::array<double, Count> jumps(const Spline& s, const std::vector<double>& u, measure by) {
  const auto at = [&](double x) {
    const auto q = duet::derivatives<int(Count)>([&](const auto& p) { return s(p); }, x);
    std::array<rotation, Count + 1> result;
    std::copy(q.begin(), q.end(), result.begin());
    return result;
  };
  const auto size = [](const rotation& q) { return std::sqrt(squared_norm(q)); };
  std::array<double, Count> worst{};
  for (std::size_t i = 1; i + 1 < u.size(); ++i) {
    const double before = std::nextafter(u[i], u[0]);
    const std::array at_ends = {at(u[i - 1]), at(before), at(u[i]), at(u[i + 1])};
    for (std::size_t k = 0; k < Count; ++k) {
      const double jump = size(at_ends[2][k] - at_ends[1][k]);
      double step = 0, scale = 0;
      for (std::size_t end = 0; end < 4; ++end) {
        const auto& q = at_ends[end];
        step = std::max(step, (u[i] - before) * size(q[k + 1]));
        scale = std::max(scale, size(q[k]));
        for (std::size_t j = k > 0 ? 1 : 0; j < Count && by == measure::terms; ++j) {
          const double h = end < 2 ? u[i] - u[i - 1] : u[i + 1] - u[i];
          scale = std::max(scale, size(q[j]) * std::pow(h, int(j) - int(k)));
        }
      }
      worst[k] = std::max(worst[k], (jump - step) / scale);
    }
  }
  for (double& each : worst) {
    each /= std::numeric_limits<double>::epsilon();
  }
  return worst;
}

TEST_CASE("interpolate, cubics at uneven parameters: C² to round-off, rotation vectors relative to "
          "the derivatives") {
  random_source random(4);
  for (int i = 0; i < 12; ++i) {
    CAPTURE(i);
    const auto intervals = random_intervals(random, 6, i < 6 ? 6 : 9);
    const auto t = random_table<rotation>(random, intervals, 1 / largest(intervals));
    const auto s = duet::interpolate<cumulative<rotation>>(t.u, t.samples);
    for (const double each : jumps<3>(s, t.u, measure::terms)) {
      CHECK(each < 32);
    }
    const auto r = duet::interpolate<cubic<rotation>>(t.u, t.samples);
    for (const double each : jumps<3>(r, t.u, measure::derivative)) {
      CHECK(each < 32);
    }
  }
}

TEST_CASE("interpolate, quintic at uneven parameters: C⁴ to round-off") {
  random_source random(5);
  for (int i = 0; i < 20; ++i) {
    CAPTURE(i);
    // Samples of a smooth motion, because a quintic through random samples oscillates.
    const auto intervals = random_intervals(random, 8, i < 10 ? 2 : 9);
    table<rotation> t;
    for (const double each : intervals) {
      t.u.push_back(t.u.back() + each);
    }
    const double end = t.u.back();
    t.samples.clear();
    for (const double u : t.u) {
      const vector w(.8 * std::sin(3 * u / end), .5 * std::cos(2 * u / end), u / end);
      t.samples.push_back(duet::from_rotation_vector(w));
    }
    const auto s = duet::interpolate<rotation_vectors<rotation, 6>>(t.u, t.samples);
    for (const double each : jumps<5>(s, t.u, measure::derivative)) {
      CHECK(each < 32);
    }
  }
}

} // namespace
} // namespace test_spline_uneven
