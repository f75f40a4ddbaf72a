// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>
#include <duet/spline/fit.hpp>

namespace test_spline_fit {
namespace {

using duet::vector3;
using duet_test::random_source;
using rotation = duet::quaternion<double>;
using pose_type = duet::dual_quaternion<double>;
template <class Q>
using curve = duet::cumulative_bspline<typename Q::scalar_type, 4>;

vector3<double> random_vector(random_source& random, double size) {
  const auto d = random.direction<3>();
  return vector3<double>(d[0], d[1], d[2]) * size;
}

/// Perturbs q by a random rotation (and translation) of the given size.
rotation moved(const rotation& q, random_source& random, double size) {
  return q * duet::from_rotation_vector(random_vector(random, size));
}
pose_type moved(const pose_type& a, random_source& random, double size) {
  return a * duet::pose(duet::from_rotation_vector(random_vector(random, size)),
                        random_vector(random, size));
}

template <class Q>
double between(const Q& a, const Q& b) {
  if constexpr (std::is_same_v<Q, rotation>) {
    return duet::rotation_vector(conj(a) * b).norm();
  } else {
    return duet::distance(a, b, 1);
  }
}

std::vector<double> steps(double end, int count) {
  std::vector<double> u;
  for (int i = 0; i <= count; ++i) {
    u.push_back(end * i / count);
  }
  return u;
}

/// Curve over [0, 8] with rotations of 0.7 rad from control point to control point.
template <class Q>
curve<Q> some_curve() {
  random_source random(5);
  std::vector<Q> controls{Q(1.0)};
  while (controls.size() < 11) {
    controls.push_back(moved(controls.back(), random, 0.7));
  }
  return curve<Q>(duet::clamped_knots(steps(8, 8), 4), controls);
}

template <class Curve>
auto samples_of(const Curve& s, const std::vector<double>& u) {
  std::vector<decltype(s(0.0))> samples;
  for (const double x : u) {
    samples.push_back(s(x));
  }
  return samples;
}

template <class Curve>
double largest_distance(const Curve& a, const Curve& b) {
  double largest = 0;
  for (const double x : steps(8, 150)) {
    const auto p = a(x);
    const auto q = b(x);
    largest = std::max(largest, between(p, q));
  }
  return largest;
}

TEST_CASE_TEMPLATE("fit: exact samples of a curve reproduce it", Q, rotation, pose_type) {
  const auto reference = some_curve<Q>();
  const auto u = steps(8, 60);
  auto samples = samples_of(reference, u);
  for (std::size_t i = 0; i < samples.size(); i += 3) {
    samples[i] = -samples[i]; // the same rotation
  }
  const auto result = duet::fit<curve<Q>>(u, samples, reference.basis().knots());
  CHECK(largest_distance(result.curve, reference) <= 1e-13);
  CHECK(result.rms <= 1e-14);
  CHECK(result.iterations <= 8);
  CHECK(result.residuals.size() == samples.size());
}

TEST_CASE("fit: as many samples as control points are interpolated") {
  const auto reference = some_curve<rotation>();
  std::vector<double> u = steps(8, 8);
  u.insert(u.begin() + 1, 0.4);
  u.insert(u.end() - 1, 7.7);
  const auto result =
      duet::fit<curve<rotation>>(u, samples_of(reference, u), reference.basis().knots());
  CHECK(result.rms <= 1e-13);
}

TEST_CASE_TEMPLATE("fit: noise is smoothed", Q, rotation, pose_type) {
  constexpr double noise = 0.01;
  const auto reference = some_curve<Q>();
  const auto u = steps(8, 400);
  random_source random(7);
  auto samples = samples_of(reference, u);
  for (Q& sample : samples) {
    sample = moved(sample, random, noise);
  }
  const auto result = duet::fit<curve<Q>>(u, samples, reference.basis().knots());
  // With 401 samples and 11 control points the error is about √(11/401) = 0.17 of the noise.
  CHECK(largest_distance(result.curve, reference) <=
        0.5 * noise * (std::is_same_v<Q, rotation> ? 1 : 2));
  const double expected = noise * (std::is_same_v<Q, rotation> ? 1 : std::sqrt(2.0));
  CHECK(result.rms == doctest::Approx(expected).epsilon(0.05));
}

/// Outlier: translated by `size` in a random direction and rotated by a random angle.
pose_type thrown(const pose_type& a, random_source& random, double size) {
  const auto any = duet::from_rotation_vector(random_vector(random, random.uniform(0, 3.1415)));
  const vector3<double> shift = random_vector(random, size);
  return duet::pose(rotation(duet::rotation(a) * any),
                    vector3<double>(duet::translation(a) + shift));
}
rotation thrown(const rotation& a, random_source& random, double) {
  return a * duet::from_rotation_vector(random_vector(random, random.uniform(0.1, 3.1415)));
}

TEST_CASE_TEMPLATE("fit with an outlier threshold: outliers of any size do not move the curve", Q,
                   rotation, pose_type) {
  constexpr double noise = 0.001, limit = 3 * noise;
  const auto reference = some_curve<Q>();
  const auto u = steps(8, 80);
  const auto& knots = reference.basis().knots();
  const auto check = [&](double fraction, double size, bool all_alike, double outlier,
                         double tolerance) {
    CAPTURE(fraction);
    CAPTURE(size);
    random_source random(17);
    auto samples = samples_of(reference, u);
    std::vector<double> good_u;
    std::vector<Q> good;
    const Q common = thrown(Q(1.0), random, size);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      samples[i] = moved(samples[i], random, noise);
      if (i == 57 || random.uniform(0, 1) < fraction) {
        samples[i] = all_alike ? common * samples[i] : thrown(samples[i], random, size);
      } else {
        good_u.push_back(u[i]);
        good.push_back(samples[i]);
      }
    }
    const auto expected = duet::fit<curve<Q>>(good_u, good, knots, {.outlier_threshold = limit});
    const auto result = duet::fit<curve<Q>>(u, samples, knots, {.outlier_threshold = outlier});
    CHECK(largest_distance(result.curve, expected.curve) <= tolerance);
    CHECK(result.residuals[57] > 4 * limit);
    CHECK(std::isfinite(result.rms));
    CHECK(result.outlier_threshold == doctest::Approx(limit).epsilon(0.5));
  };
  // The curve is that of the good samples alone, to the tolerance of the iteration. An estimated
  // threshold (0) differs from `limit`, which changes the curve by a fraction of the noise.
  check(0.3, 1, false, limit, 1e-9);
  check(0.2, 1, false, 0, 0.3 * noise);
  if constexpr (std::is_same_v<Q, pose_type>) {
    check(0, 1e300, false, limit, 1e-9);
    check(0.3, 1e160, false, limit, 1e-9);
    check(0.2, 100, true, limit, 1e-9);
  }
}

TEST_CASE("fit: if a residual overflows, rms is infinite") {
  const auto reference = some_curve<pose_type>();
  const auto u = steps(8, 100);
  auto samples = samples_of(reference, u);
  samples[40] = duet::pose(rotation(1.0), vector3<double>(1.2e308, 1.2e308, 1.2e308));
  const auto result = duet::fit<curve<pose_type>>(u, samples, reference.basis().knots(),
                                                  {.outlier_threshold = 0.01});
  CHECK(std::isinf(result.residuals[40]));
  CHECK(std::isinf(result.rms));
}

TEST_CASE("fit by least squares: the error names a sample whose squared distance overflows") {
  const auto reference = some_curve<pose_type>();
  const auto u = steps(8, 100);
  auto samples = samples_of(reference, u);
  samples[40] = duet::pose(rotation(1.0), vector3<double>(1e160, 0, 0));
  const auto message = duet_test::message_of<duet::invalid_sample>(
      [&] { (void)duet::fit<curve<pose_type>>(u, samples, reference.basis().knots()); });
  CHECK(message.rfind("duet: sample 40: is 1", 0) == 0);
  CHECK(message.find("e+160 from the samples around it, too far for least squares "
                     "(fit_options::outlier_threshold makes the fit robust)") != std::string::npos);
}

TEST_CASE("fit: equal samples give a constant curve with any outlier threshold") {
  const auto u = steps(8, 100);
  const auto knots = duet::clamped_knots(steps(8, 8), 4);
  const rotation q = duet::from_rotation_vector(vector3<double>(1, 2, 3));
  for (const double outlier : {0.0, 0.1, double(std::numeric_limits<double>::infinity())}) {
    CAPTURE(outlier);
    const auto result = duet::fit<curve<rotation>>(u, std::vector<rotation>(101, q), knots,
                                                   {.outlier_threshold = outlier});
    CHECK(result.rms <= 1e-15);
    CHECK(between(result.curve(4.3), q) <= 1e-15);
  }
}

TEST_CASE("fit: no_convergence gives the number of steps and the last step") {
  const auto reference = some_curve<rotation>();
  const auto u = steps(8, 100);
  const auto message = duet_test::message_of<duet::no_convergence>([&] {
    (void)duet::fit<curve<rotation>>(u, samples_of(reference, u), reference.basis().knots(),
                                     {.max_iterations = 1});
  });
  CHECK(message.rfind("duet: fit: the iteration does not converge after 1 steps, the last one 0.",
                      0) == 0);
  // For robust fits the number includes the steps before the last stage.
  random_source random(17);
  auto noisy = samples_of(reference, u);
  for (rotation& q : noisy) {
    q = moved(q, random, 0.1);
  }
  const auto robust = duet_test::message_of<duet::no_convergence>([&] {
    (void)duet::fit<curve<rotation>>(u, noisy, reference.basis().knots(),
                                     {.outlier_threshold = 0.02, .max_iterations = 1});
  });
  CHECK(robust.rfind("duet: fit: the iteration does not converge after ", 0) == 0);
  CHECK(robust.find(" after 1 steps") == std::string::npos);
}

/// Error 2 log(S* Q); for poses [v; ω].
template <class Q>
Eigen::VectorXd error_of(const Q& s, const Q& sample) {
  if constexpr (std::is_same_v<Q, rotation>) {
    return duet::rotation_vector(conj(s) * sample);
  } else {
    return duet::twist(pose_type(1.0), log(conj(s) * sample), duet::frame::spatial);
  }
}

/// Covariance of an ellipsoid about ten times as long as wide, not aligned with the body axes.
Eigen::MatrixXd random_covariance(random_source& random, Eigen::Index n) {
  Eigen::MatrixXd root(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      root(i, j) = 0.01 * random.normal();
    }
  }
  return root * root.transpose() + 1e-6 * Eigen::MatrixXd::Identity(n, n);
}

TEST_CASE_TEMPLATE("fit, also with weights and covariances: perturbed control points increase the "
                   "cost",
                   Q, rotation, pose_type) {
  const auto reference = some_curve<Q>();
  const auto knots = reference.basis().knots();
  const auto u = steps(8, 100);
  random_source random(17);
  auto samples = samples_of(reference, u);
  const Eigen::Index n = std::is_same_v<Q, rotation> ? 3 : 6;
  duet::fit_options options;
  for (Q& sample : samples) {
    sample = moved(sample, random, 0.02);
    options.weights.push_back(random.uniform(0.1, 3));
    options.covariances.push_back(random_covariance(random, n));
  }
  const auto check_minimum = [&](const auto& fitted, const duet::fit_options& of) {
    const auto residual = [&](const curve<Q>& s, std::size_t i) {
      const Eigen::VectorXd e = error_of(Q(s(u[i])), samples[i]);
      const Eigen::MatrixXd sigma = of.covariances.empty()
                                        ? Eigen::MatrixXd(Eigen::MatrixXd::Identity(n, n))
                                        : of.covariances[of.covariances.size() > 1 ? i : 0];
      return std::sqrt(e.dot(sigma.inverse() * e));
    };
    const auto cost = [&](const curve<Q>& s) {
      double sum = 0;
      for (std::size_t i = 0; i < u.size(); ++i) {
        const double r = residual(s, i);
        const double c = of.outlier_threshold;
        sum += (of.weights.empty() ? 1 : of.weights[i]) * (r <= c ? r * r / 2 : c * (r - c / 2));
      }
      return sum;
    };
    const double minimum = cost(fitted.curve);
    for (std::size_t k = 0; k < fitted.curve.control_points().size(); ++k) {
      for (const double size : {1e-4, -1e-4}) {
        for (int axis = 0; axis < n; ++axis) {
          auto controls = fitted.curve.control_points();
          const vector3<double> step = vector3<double>::Unit(axis % 3) * size;
          if constexpr (std::is_same_v<Q, rotation>) {
            controls[k] = controls[k] * duet::from_rotation_vector(step);
          } else {
            controls[k] = controls[k] * (axis < 3 ? duet::pose(rotation(1.0), step)
                                                  : pose_type(duet::from_rotation_vector(step)));
          }
          CHECK(cost({reference.basis(), controls}) > minimum);
        }
      }
    }
    for (const std::size_t i : {std::size_t(0), u.size() / 2}) {
      CHECK(fitted.residuals[i] == doctest::Approx(residual(fitted.curve, i)).epsilon(1e-9));
    }
  };
  check_minimum(duet::fit<curve<Q>>(u, samples, knots, {.characteristic_length = 1}), {});
  check_minimum(duet::fit<curve<Q>>(u, samples, knots, options), options);
  duet::fit_options robust = options;
  robust.outlier_threshold = 2;
  check_minimum(duet::fit<curve<Q>>(u, samples, knots, robust), robust);
  duet::fit_options one_for_all{.weights = options.weights};
  one_for_all.covariances.push_back(options.covariances[0]);
  check_minimum(duet::fit<curve<Q>>(u, samples, knots, one_for_all), one_for_all);
}

TEST_CASE("fit: equal covariances act as a characteristic length, equal weights have no effect") {
  const auto reference = some_curve<pose_type>();
  const auto knots = reference.basis().knots();
  const auto u = steps(8, 60);
  random_source random(19);
  auto samples = samples_of(reference, u);
  for (auto& sample : samples) {
    sample = moved(sample, random, 0.02);
  }
  const auto plain = duet::fit<curve<pose_type>>(u, samples, knots, {.characteristic_length = 0.5});
  duet::fit_options options{.weights = std::vector<double>(samples.size(), 7.0)};
  options.covariances.emplace_back(
      Eigen::Matrix<double, 6, 1>(0.25, 0.25, 0.25, 1, 1, 1).asDiagonal());
  const auto same = duet::fit<curve<pose_type>>(u, samples, knots, options);
  CHECK(largest_distance(same.curve, plain.curve) <= 1e-13);
  CHECK(same.rms == doctest::Approx(plain.rms).epsilon(1e-13));
}

TEST_CASE("fit: results agree with long double to round-off, with and without outlier threshold") {
  using wide = long double;
  const auto reference = some_curve<rotation>();
  const auto knots = reference.basis().knots();
  const auto u = steps(8, 60);
  const auto check = [&](double noise, double outlier) {
    CAPTURE(noise);
    CAPTURE(outlier);
    random_source random(3);
    std::vector<rotation> samples;
    std::vector<duet::quaternion<wide>> wide_samples;
    for (const double x : u) {
      samples.push_back(moved(reference(x), random, noise));
      const rotation& q = samples.back();
      wide_samples.push_back(normalized(duet::quaternion<wide>(q.w(), q.x(), q.y(), q.z())));
    }
    const auto s =
        duet::fit<curve<rotation>>(u, samples, knots, {.outlier_threshold = outlier}).curve;
    const auto exact =
        duet::fit<duet::cumulative_bspline<wide>>(
            std::vector<wide>(u.begin(), u.end()), wide_samples,
            std::vector<wide>(knots.begin(), knots.end()), {.outlier_threshold = outlier})
            .curve;
    for (const double x : steps(8, 50)) {
      const auto q = s(x);
      const auto miss = duet::quaternion<wide>(q.w(), q.x(), q.y(), q.z()) - exact(wide(x));
      CHECK(double(norm(miss)) < 32 * std::numeric_limits<double>::epsilon());
    }
  };
  check(0.3, std::numeric_limits<double>::infinity());
  check(0.3, 0.05);
  check(1e-6, std::numeric_limits<double>::infinity());
}

TEST_CASE_TEMPLATE("fit: small steps far from the identity have all digits", Q, rotation,
                   pose_type) {
  const auto along = [](double x) {
    if constexpr (std::is_same_v<Q, rotation>) {
      return duet::from_rotation_vector(vector3<double>(0, x, 2 * x));
    } else {
      return duet::pose(duet::from_rotation_vector(vector3<double>(0, x, 2 * x)),
                        vector3<double>(x, 0, -x));
    }
  };
  random_source random(7);
  const Q origin = moved(Q(1.0), random, 1.3);
  const auto u = steps(8, 60);
  for (const double step : {1e-12, 1e-8}) {
    // The reference is fitted to the rounded samples relative to the first of them.
    std::vector<Q> samples, relative;
    for (const double x : u) {
      samples.push_back(origin * along(step * (x + .1 * std::sin(x))));
      relative.push_back(duet::detail::relative_rotation(samples[0], samples.back()));
    }
    const auto knots = duet::clamped_knots(steps(8, 8), 4);
    const auto fitted = duet::fit<curve<Q>>(u, samples, knots).curve;
    const auto expected = duet::fit<curve<Q>>(u, relative, knots).curve;
    double largest = 0;
    for (const double x : steps(8, 40)) {
      const auto rate = fitted.motion(x, duet::frame::body).velocity;
      const auto reference = expected.motion(x, duet::frame::body).velocity;
      largest = std::max(largest, (rate - reference).norm() / reference.norm());
    }
    CHECK_LT(largest, 1e-12);
  }
}

TEST_CASE(
    "fit: converges with residuals as large as the motion, half of them beyond the threshold") {
  // Gauss–Newton steps alone would shrink by only a twentieth each.
  random_source random(2091);
  std::vector<double> u;
  std::vector<pose_type> samples;
  for (int i = 0; i < 300; ++i) {
    u.push_back(.05 * i);
    const auto at = duet::pose(duet::from_rotation_vector(vector3<double>(.3 * u[std::size_t(i)], 0,
                                                                          .9 * u[std::size_t(i)])),
                               vector3<double>(.4 * u[std::size_t(i)], .1, 0));
    samples.push_back(moved(at, random, i % 10 < 3 ? 2.5 : .5));
  }
  const auto result = duet::fit<curve<pose_type>>(u, samples, duet::knots_every(u, 5, 4),
                                                  {.outlier_threshold = 1e-3});
  CHECK_LT(result.iterations, 100);
}

TEST_CASE("fit by least squares: no_convergence names a sample far from the others") {
  std::vector<double> u;
  std::vector<pose_type> samples;
  for (int i = 0; i < 60; ++i) {
    u.push_back(.05 * i);
    samples.push_back(duet::pose(duet::from_rotation_vector(vector3<double>(0, 0, u.back())),
                                 vector3<double>(u.back(), 0, 0)));
  }
  samples[23] = duet::pose(duet::rotation(samples[23]), vector3<double>(1e6, -2e6, 5e5));
  const auto knots = duet::knots_every(u, 5, 4);
  const std::string message = duet_test::message_of<duet::no_convergence>(
      [&] { (void)duet::fit<curve<pose_type>>(u, samples, knots); });
  CHECK_MESSAGE(message.find(": sample 23 is 2.29") != std::string::npos, message);
  CHECK(message.ends_with(
      " from the samples around it (fit_options::outlier_threshold makes the fit robust)"));
  CHECK(duet::fit<curve<pose_type>>(u, samples, knots, {.outlier_threshold = .1}).residuals[22] <
        1e-3);
}

TEST_CASE("fit by least squares: no_convergence names control points half a turn apart") {
  // A row 1 km off bends the curve until it jumps; for plain least squares there is no minimum.
  random_source random(7);
  const auto u = steps(3, 59);
  const auto knots = duet::knots_every(u, 5, 4);
  std::vector<pose_type> controls{pose_type(1.0)};
  while (controls.size() + 4 < knots.size()) {
    controls.push_back(moved(controls.back(), random, .7));
  }
  auto samples = samples_of(curve<pose_type>(knots, controls), u);
  samples[31] = duet::pose(duet::rotation(samples[31]), vector3<double>(600, 0, -800));
  const std::string message = duet_test::message_of<duet::no_convergence>(
      [&] { (void)duet::fit<curve<pose_type>>(u, samples, knots); });
  CHECK_MESSAGE(message.find(" half a turn apart, where the curve jumps: sample 31 is ") !=
                    std::string::npos,
                message);
}

TEST_CASE("knots_every: a knot at every n-th sample, usable by fit for any number of samples") {
  using knots = std::vector<double>;
  const knots u{0, 1, 2, 4, 8, 9, 10};
  CHECK(duet::knots_every(u, 3) == knots{0, 0, 0, 0, 4, 10, 10, 10, 10});
  CHECK(duet::knots_every(u, 2, 3) == knots{0, 0, 0, 2, 8, 10, 10, 10});
  CHECK(duet::knots_every(u, 4, 2) ==
        knots{0, 0, 10, 10}); // two more samples are too few for a knot
  CHECK(duet::knots_every(u, 1, 2) == knots{0, 0, 1, 2, 4, 8, 9, 10, 10});
  for (const std::size_t many : {6UL, 7UL, std::size_t(-1)}) {
    CHECK(duet::knots_every(u, many, 2) == knots{0, 0, 10, 10});
  }
  const auto error_message = [](const knots& parameters, std::size_t n) {
    return duet_test::message_of([&] { (void)duet::knots_every(parameters, n); });
  };
  CHECK(error_message(u, 0) ==
        "duet: knots_every: n is 0 with 7 parameters (expected n > 0 and two parameters or more)");
  CHECK(error_message({1}, 3) ==
        "duet: knots_every: n is 3 with 1 parameters (expected n > 0 and two parameters or more)");
  CHECK(!error_message({}, 3).empty());

  // Samples of any number and spacing can be fitted with these knots.
  const auto reference = some_curve<rotation>();
  for (const int count : {8, 9, 60, 61, 63}) {
    auto t = steps(8, count);
    for (double& x : t) {
      x = x * x / 8;
    }
    for (const std::size_t n : {2UL, 3UL, 7UL}) {
      const auto result =
          duet::fit<curve<rotation>>(t, samples_of(reference, t), duet::knots_every(t, n));
      CHECK(result.residuals.size() == t.size());
    }
  }
}

TEST_CASE("fit: errors name invalid arguments") {
  const auto reference = some_curve<rotation>();
  const auto knots = reference.basis().knots();
  const auto message = [&](std::vector<double> u, std::vector<rotation> samples,
                           const duet::fit_options& options = {}) {
    return duet_test::message_of(
        [&] { (void)duet::fit<curve<rotation>>(u, samples, knots, options); });
  };
  const auto u = steps(8, 40);
  const auto samples = samples_of(reference, u);
  CHECK(message(steps(8, 39), samples) == "duet: fit: 40 parameters, but 41 samples");
  CHECK(message(steps(9, 40), samples) ==
        "duet: sample 36: parameter 8.1 is outside the knots' domain, 0 to 8 (clamped_knots of "
        "parameters from 0 to 9 have all samples in it)");
  auto bad = samples;
  bad[3] = rotation(0.0);
  CHECK(message(u, bad) == "duet: sample 3: quaternion (0, 0, 0, 0) has norm 0, not 1");
  CHECK(message(steps(8, 5), std::vector<rotation>(6, rotation(1.0))) ==
        "duet: fit: there are too few samples for control point 2, which acts on parameters from "
        "0 to 3 (use fewer knots there)");
  CHECK(message(steps(1, 40), samples) ==
        "duet: fit: there are too few samples for control point 4, which acts on parameters from "
        "1 to 5 (use fewer knots there)");
  CHECK(message(u, samples, {.characteristic_length = 0}) ==
        "duet: fit: characteristic_length is 0 and outlier_threshold is inf (expected a positive "
        "length and a non-negative threshold)");
  CHECK(message(u, samples, {.weights = {1, 2}}) == "duet: fit: 2 weights for 41 samples");
  std::vector<double> weights(41, 1.0);
  weights[7] = 0;
  CHECK(message(u, samples, {.weights = weights}) ==
        "duet: fit: weight 7 is 0 (expected a finite positive number; omit samples that should not "
        "count)");
  Eigen::MatrixXd sigma = Eigen::MatrixXd::Identity(3, 3);
  CHECK(message(u, samples, {.covariances = {sigma, sigma}}) ==
        "duet: fit: 2 covariances for 41 samples (expected one for each, or one for all)");
  CHECK(message(u, samples, {.covariances = {Eigen::MatrixXd::Identity(6, 6)}}) ==
        "duet: fit: covariance 0 is 6 x 6, not 3 x 3");
  sigma(0, 1) = 0.5;
  CHECK(message(u, samples, {.covariances = {sigma}}) ==
        "duet: fit: covariance 0 is not symmetric");
  sigma(1, 0) = 0.5;
  sigma(2, 2) = -1;
  CHECK(message(u, samples, {.covariances = {sigma}}) ==
        "duet: fit: covariance 0 is not positive definite");
  auto repeated = u;
  repeated[8] = repeated[7];
  CHECK(message(repeated, samples) ==
        "duet: sample 8: parameter 1.4 does not increase, the sample before has 1.4");
}

} // namespace
} // namespace test_spline_fit
