// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/instantiated.hpp"
#include "support/message.hpp"
#include "support/random.hpp"
#include "support/samples.hpp"
#include "support/test.hpp"

#include <duet/derivative/nonlinear_least_squares.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/fit.hpp>

// Statistics of fitted curves: covariances, degrees of freedom, runs test.

namespace test_spline_fit_covariance {
namespace {

using duet::fit_options;
using duet_test::random_source;
using rotation = duet::quaternion<double>;
using pose_type = duet::dual_quaternion<double>;
template <class Q>
using curve = duet::cumulative_bspline<typename Q::scalar_type, 4>;
template <class Q>
constexpr int dimension = duet::manifold<Q>::dimension;
template <class Q>
using tangent = Eigen::Matrix<double, dimension<Q>, 1>;
template <class Q>
using square = Eigen::Matrix<double, dimension<Q>, dimension<Q>>;

/// Errors of 0.01 rad, and of 0.002 in translations.
template <class Q>
tangent<Q> error_of_sample(random_source& random) {
  tangent<Q> d;
  for (int i = 0; i < dimension<Q>; ++i) {
    d[i] = (i < dimension<Q> - 3 ? 0.002 : 0.01) * random.normal();
  }
  return d;
}

/// Tangent coordinates of b at a in body axes.
template <class T>
auto difference(const duet::quaternion<T>& a, const duet::quaternion<T>& b) {
  const duet::vector3<T> half = duet::detail::log_vector(duet::conj(a) * b, "difference");
  if constexpr (duet::detail::contains_tag<T, duet::screw_tag>()) {
    return duet::twist_of(duet::vector3<T>(T(2) * half));
  } else {
    return duet::vector3<T>(T(2) * half);
  }
}

/// Samples of a curve of seven control points.
template <class Q>
struct problem {
  std::vector<double> u;
  std::vector<double> knots = duet::clamped_knots(std::vector<double>{0, .5, 1.2, 2, 3}, 4);
  std::vector<Q> controls, exact;

  explicit problem(int count = 61) {
    random_source random(7);
    Q q(1);
    for (int i = 0; i < 7; ++i) {
      controls.push_back(q);
      tangent<Q> step;
      for (int k = 0; k < dimension<Q>; ++k) {
        step[k] = .4 * random.normal();
      }
      q = duet::manifold<Q>::plus(q, step, duet::frame::body);
    }
    const curve<Q> truth(knots, controls);
    for (int i = 0; i < count; ++i) {
      u.push_back(3. * i / (count - 1));
      exact.push_back(truth(u.back()));
    }
  }

  /// \param share  share of samples with errors ten times as large
  std::vector<Q> samples(random_source& random, double share = 0) const {
    std::vector<Q> result;
    for (const Q& q : exact) {
      const double size = random.uniform(0, 1) < share ? 10 : 1;
      result.push_back(duet::manifold<Q>::plus(q, tangent<Q>(size * error_of_sample<Q>(random)),
                                               duet::frame::body));
    }
    return result;
  }
};

/// Covariance of the errors of samples.
template <class Q>
square<Q> sample_covariance() {
  square<Q> result = 4e-6 * square<Q>::Identity();
  result.template bottomRightCorner<3, 3>() = 1e-4 * Eigen::Matrix3d::Identity();
  return result;
}

TEST_CASE("fit: the covariance is that of nonlinear_least_squares") {
  using Q = rotation;
  const problem<Q> p;
  random_source random(3);
  const auto samples = p.samples(random);
  std::vector<double> weights(samples.size(), 1);
  weights[5] = 3;
  weights[40] = .2;
  square<Q> covariance = sample_covariance<Q>();
  covariance(0, 1) = covariance(1, 0) = 3e-7;
  const auto residuals = [&]<class T>(const std::vector<duet::quaternion<T>>& controls) {
    const duet::cumulative_bspline<T, 4> s(p.knots, controls);
    using scalar = typename duet::manifold<duet::quaternion<T>>::scalar;
    std::vector<Eigen::Matrix<scalar, dimension<Q>, 1>> result;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      result.push_back(difference(s(p.u[i]), duet::quaternion<T>(samples[i])));
    }
    return result;
  };
  for (const fit_options& o :
       {fit_options{}, fit_options{.weights = weights}, fit_options{.covariances = {covariance}},
        fit_options{.outlier_threshold = .02},
        fit_options{.outlier_threshold = 2, .weights = weights, .covariances = {covariance}}}) {
    auto with_covariance = o;
    with_covariance.keeps_covariance = true;
    const auto fitted = duet::fit<curve<Q>>(p.u, samples, p.knots, with_covariance);
    const auto dense = duet::nonlinear_least_squares(
        residuals, fitted.curve.control_points(),
        {.loss = o.outlier_threshold < 1e9 ? duet::loss_function::huber(o.outlier_threshold)
                                           : duet::loss_function::squares(),
         .weights = o.weights,
         .covariances = o.covariances});
    CHECK(fitted.degrees_of_freedom == dense.degrees_of_freedom);
    const auto estimated = fitted.covariance();
    REQUIRE(estimated.size() == 7);
    for (std::size_t i = 0; i < 7; ++i) {
      for (std::size_t j = i - std::min<std::size_t>(i, 3); j < std::min<std::size_t>(i + 4, 7);
           ++j) {
        const square<Q> block = dense.covariance.block<dimension<Q>, dimension<Q>>(
            Eigen::Index(i) * dimension<Q>, Eigen::Index(j) * dimension<Q>);
        CHECK((estimated.block(i, j) - block).norm() < 1e-6 * block.norm());
      }
    }
  }
}

TEST_CASE("fit: the covariance is that of the samples through the derivatives of control points") {
  const problem<pose_type> p;
  constexpr int size = 6;
  square<pose_type> covariance = sample_covariance<pose_type>();
  covariance(0, 4) = covariance(4, 0) = 1e-6;
  const fit_options options{.covariances = {covariance}, .keeps_covariance = true};
  const auto fitted = duet::fit<curve<pose_type>>(p.u, p.exact, p.knots, options);
  constexpr double step = 1e-5;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(7 * size, 7 * size);
  const Eigen::MatrixXd root = covariance.llt().matrixL();
  for (std::size_t i = 0; i < p.u.size(); ++i) {
    for (int k = 0; k < size; ++k) {
      Eigen::VectorXd change = Eigen::VectorXd::Zero(7 * size); // of all control points, per step
      for (const double side : {-1., 1.}) {
        auto samples = p.exact;
        samples[i] = duet::manifold<pose_type>::plus(
            samples[i], tangent<pose_type>(side * step / root.norm() * root.col(k)),
            duet::frame::body);
        const auto moved = duet::fit<curve<pose_type>>(p.u, samples, p.knots, options);
        for (std::size_t c = 0; c < 7; ++c) {
          change.segment<size>(Eigen::Index(c) * size) +=
              side / (2 * step / root.norm()) *
              difference(p.controls[c], moved.curve.control_points()[c]);
        }
      }
      sum += change * change.transpose();
    }
  }
  const auto estimated = fitted.covariance();
  for (std::size_t i = 0; i < 7; ++i) {
    for (std::size_t j = i; j < std::min<std::size_t>(i + 4, 7); ++j) {
      const square<pose_type> expected =
          sum.block<size, size>(Eigen::Index(i) * size, Eigen::Index(j) * size);
      CHECK((estimated.block(i, j) - expected).norm() < 1e-4 * expected.norm());
    }
  }
}

/// Mean of estimated variances over the mean of squared errors, of values, velocities and
/// accelerations at a parameter.
template <class Q, class Frame>
Eigen::Vector3d variance_ratios(const problem<Q>& p, const fit_options& options, double share,
                                int count, double u, Frame frame) {
  const auto truth = curve<Q>(p.knots, p.controls).motion(u, frame);
  random_source random(11);
  Eigen::Vector3d estimated = Eigen::Vector3d::Zero(), squares = estimated;
  for (int k = 0; k < count; ++k) {
    const auto fitted = duet::fit<curve<Q>>(p.u, p.samples(random, share), p.knots, options);
    const auto m = fitted.curve.motion(u, frame);
    squares += Eigen::Vector3d(difference(truth.value, m.value).squaredNorm(),
                               (m.velocity - truth.velocity).squaredNorm(),
                               (m.acceleration - truth.acceleration).squaredNorm());
    const auto c = fitted.covariance().motion(u, frame);
    estimated += Eigen::Vector3d(c.value().trace(), c.velocity().trace(), c.acceleration().trace());
  }
  return estimated.cwiseQuotient(squares);
}

TEST_CASE("fit: covariances are those of the errors of many fits") {
  const int count = duet_test::sample_count(10000);
  const double tolerance = .03 * std::sqrt(10000. / count);
  const auto deviation = [](const Eigen::Vector3d& ratios) {
    return (ratios - Eigen::Vector3d::Ones()).cwiseAbs().maxCoeff();
  };
  CHECK(deviation(variance_ratios(
            problem<rotation>(),
            {.covariances = {sample_covariance<rotation>()}, .keeps_covariance = true}, 0, count,
            .8, duet::frame::spatial)) < tolerance);
  CHECK(deviation(variance_ratios(problem<pose_type>(),
                                  {.characteristic_length = .2, .keeps_covariance = true}, 0, count,
                                  1.37, duet::frame::body)) < tolerance);
}

TEST_CASE_TEMPLATE("fit: covariances of robust fits are those of the errors", Q, rotation,
                   pose_type) {
  const int count = duet_test::sample_count(3000);
  const auto ratios = variance_ratios(
      problem<Q>(181),
      {.characteristic_length = .2, .outlier_threshold = 0, .keeps_covariance = true}, .1, count,
      1.37, duet::frame::body);
  CAPTURE(ratios);
  CHECK((ratios - Eigen::Vector3d::Ones()).cwiseAbs().maxCoeff() < .05 * std::sqrt(3000. / count));
}

TEST_CASE("fit: plain least squares have no covariance without degrees of freedom") {
  const problem<rotation> p;
  const std::vector<double> u = {0, .3, .7, 1.2, 1.8, 2.5, 3};
  std::vector<rotation> samples;
  for (const double x : u) {
    samples.push_back(curve<rotation>(p.knots, p.controls)(x));
  }
  const auto plain = duet::fit<curve<rotation>>(u, samples, p.knots, {.keeps_covariance = true});
  CHECK(plain.degrees_of_freedom == 0);
  CHECK(std::isnan(plain.covariance().motion(1., duet::frame::body).joint(0, 0)));
  CHECK(plain.remark.empty());
  // With known covariances there is one: at a sample, that of the sample.
  const Eigen::Matrix3d covariance = Eigen::Vector3d(1e-4, 4e-4, 1e-6).asDiagonal();
  const auto whitened = duet::fit<curve<rotation>>(
      u, samples, p.knots, {.covariances = {covariance}, .keeps_covariance = true});
  CHECK((whitened.covariance().motion(u[3], duet::frame::body).value() - covariance).norm() <
        1e-15);
}

TEST_CASE("fit: errors name a covariance that was not requested, or is not stored") {
  const problem<rotation> p;
  const auto fitted = duet::fit<curve<rotation>>(p.u, p.exact, p.knots);
  CHECK(duet_test::message_of([&] { (void)fitted.covariance(); }) ==
        "duet: fit_result: there is no covariance (set fit_options::keeps_covariance)");
  const auto with =
      duet::fit<curve<rotation>>(p.u, p.exact, p.knots, {.keeps_covariance = true}).covariance();
  CHECK(duet_test::message_of([&] { (void)with.block(6, 2); }) ==
        "duet: curve_covariance: control points 6 and 2 of 7 (expected two less than 4 "
        "apart)");
  CHECK(duet_test::message_of([&] {
          (void)with.block(7, 6);
        }).find("control points 7 and 6 of 7") != std::string::npos);
}

TEST_CASE_TEMPLATE("fit: knots too wide for the motion are remarked upon, random errors are not", Q,
                   rotation, pose_type) {
  const problem<Q> p;
  random_source random(5);
  int remarks = 0;
  for (int k = 0; k < 300; ++k) {
    remarks += !duet::fit<curve<Q>>(p.u, p.samples(random), p.knots).remark.empty();
  }
  CHECK(remarks <= 2);
  // Knots at 0 and 3 alone miss the motion by several times the noise.
  const auto wide =
      duet::fit<curve<Q>>(p.u, p.samples(random), duet::clamped_knots(std::vector<double>{0, 3}, 4),
                          {.characteristic_length = .2});
  CAPTURE(wide.remark);
  CHECK(wide.remark.find("the residuals change their signs too rarely (runs test, component ") ==
        0);
  CHECK(wide.remark.find("the knots are too wide") != std::string::npos);
}

TEST_CASE("fit: round-off of a motion in a plane is not remarked upon") {
  std::vector<double> u;
  std::vector<pose_type> samples;
  random_source random(9);
  for (int i = 0; i < 200; ++i) {
    u.push_back(i / 100.);
    const double x = u.back();
    samples.push_back(duet::pose(
        duet::from_rotation_vector(duet::vector3<double>(0, 0, x + .01 * random.normal())),
        duet::vector3<double>(std::cos(x) + .01 * random.normal(),
                              std::sin(x) + .01 * random.normal(), 0)));
  }
  const auto fitted = duet::fit<curve<pose_type>>(u, samples, duet::knots_every(u, 40));
  CHECK(fitted.remark == "");
}

TEST_CASE_TEMPLATE("fit: exact samples of a curve are not remarked upon", Q, rotation, pose_type) {
  const problem<Q> p;
  const auto fitted = duet::fit<curve<Q>>(p.u, p.exact, p.knots);
  CHECK(fitted.rms < 1e-13);
  CHECK(fitted.remark == "");
  std::vector<double> u;
  std::vector<Q> samples; // at rest, far from the identity
  for (int i = 0; i < 60; ++i) {
    u.push_back(i);
    samples.push_back(p.exact[7]);
  }
  CHECK(duet::fit<curve<Q>>(u, samples, duet::knots_every(u, 10)).remark == "");
}

TEST_CASE("fit: the root mean square of inliers leaves outliers out") {
  const problem<rotation> p;
  random_source random(2);
  auto samples = p.samples(random);
  samples[30] = samples[30] * duet::from_rotation_vector(duet::vector3<double>(1, 1, 1));
  const auto fitted =
      duet::fit<curve<rotation>>(p.u, samples, p.knots, {.outlier_threshold = 0.04});
  double squares = 0;
  int count = 0;
  for (const double r : fitted.residuals) {
    squares += r <= 0.04 ? r * r : 0;
    count += r <= 0.04;
  }
  CHECK(count == 60);
  CHECK(fitted.inlier_rms == doctest::Approx(std::sqrt(squares / count)).epsilon(1e-12));
  CHECK(fitted.rms > 10 * fitted.inlier_rms);
  CHECK(fitted.degrees_of_freedom == 3 * (60 - 7));
}

} // namespace
} // namespace test_spline_fit_covariance
