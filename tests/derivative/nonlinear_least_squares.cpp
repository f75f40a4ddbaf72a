// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/derivative/nonlinear_least_squares.hpp>
#include <duet/derivative/tangent_coordinates.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/rotation.hpp>

#include <filesystem>
#include <fstream>

// Nonlinear least squares against certified regressions, problems whose solution is known, and the
// conditions of a minimum.

namespace test_derivative_nonlinear_least_squares {
namespace {

using duet::least_squares_stop, duet::loss_function, duet::nonlinear_least_squares,
    duet::nonlinear_least_squares_options, Eigen::MatrixXd, Eigen::VectorXd;
using pose = duet::dual_quaternion<double>;
using rotation = duet::quaternion<double>;

struct regression {
  std::string name;
  VectorXd starts[2], certified, deviations, y;
  std::vector<VectorXd> x;
  double squares;
};

std::vector<regression> regressions() {
  std::ifstream in(std::filesystem::path(__FILE__).parent_path() / "strd.txt");
  std::vector<regression> result;
  std::string line;
  while (in.peek() == '#') {
    std::getline(in, line);
  }
  regression r;
  for (int parameters, observations, predictors;
       in >> r.name >> parameters >> observations >> predictors >> r.squares;) {
    for (VectorXd* v : {&r.starts[0], &r.starts[1], &r.certified, &r.deviations}) {
      v->resize(parameters);
    }
    for (int k = 0; k < parameters; ++k) {
      in >> r.starts[0][k] >> r.starts[1][k] >> r.certified[k] >> r.deviations[k];
    }
    r.y.resize(observations);
    r.x.assign(std::size_t(observations), VectorXd(predictors));
    for (int i = 0; i < observations; ++i) {
      in >> r.y[i];
      for (double& each : r.x[std::size_t(i)]) {
        in >> each;
      }
    }
    if (r.name == "Nelson") {
      r.y = r.y.array().log();
    }
    result.push_back(r);
  }
  return result;
}

template <class T>
T model(const std::string& name, const Eigen::Matrix<T, Eigen::Dynamic, 1>& b, const VectorXd& of) {
  using std::atan2, std::cos, std::exp, std::pow, std::sin, std::sqrt;
  const double x = of[0], pi = std::acos(-1.);
  const auto is = [&](const char* start) { return name.starts_with(start); };
  const auto square = [](const T& t) { return T(t * t); };
  const auto wave = [&](const T& c, const T& s, const T& period) {
    return T(c * cos(2 * pi * x / period) + s * sin(2 * pi * x / period));
  };
  if (is("Misra1a") || is("BoxBOD")) {
    return b[0] * (1 - exp(-b[1] * x));
  } else if (is("Misra1b")) {
    return b[0] * (1 - 1 / square(1 + b[1] * (x / 2)));
  } else if (is("Misra1c")) {
    return b[0] * (1 - 1 / sqrt(1 + 2 * b[1] * x));
  } else if (is("Misra1d")) {
    return b[0] * b[1] * x / (1 + b[1] * x);
  } else if (is("Chwirut")) {
    return exp(-b[0] * x) / (b[1] + b[2] * x);
  } else if (is("Lanczos")) {
    return b[0] * exp(-b[1] * x) + b[2] * exp(-b[3] * x) + b[4] * exp(-b[5] * x);
  } else if (is("Gauss")) {
    return b[0] * exp(-b[1] * x) + b[2] * exp(-square((x - b[3]) / b[4])) +
           b[5] * exp(-square((x - b[6]) / b[7]));
  } else if (is("DanWood")) {
    return b[0] * pow(x, b[1]);
  } else if (is("Kirby2")) {
    return (b[0] + b[1] * x + b[2] * (x * x)) / (1 + b[3] * x + b[4] * (x * x));
  } else if (is("Hahn1") || is("Thurber")) {
    return (b[0] + b[1] * x + b[2] * (x * x) + b[3] * (x * x * x)) /
           (1 + b[4] * x + b[5] * (x * x) + b[6] * (x * x * x));
  } else if (is("Nelson")) {
    return b[0] - b[1] * x * exp(-b[2] * of[1]);
  } else if (is("MGH17")) {
    return b[0] + b[1] * exp(-x * b[3]) + b[2] * exp(-x * b[4]);
  } else if (is("Roszman1")) {
    return b[0] - b[1] * x - atan2(b[2], x - b[3]) / pi;
  } else if (is("ENSO")) {
    return b[0] + wave(b[1], b[2], T(12)) + wave(b[4], b[5], b[3]) + wave(b[7], b[8], b[6]);
  } else if (is("MGH09")) {
    return b[0] * (x * x + x * b[1]) / (x * x + x * b[2] + b[3]);
  } else if (is("MGH10")) {
    return b[0] * exp(b[1] / (x + b[2]));
  } else if (is("Rat42")) {
    return b[0] / (1 + exp(b[1] - b[2] * x));
  } else if (is("Rat43")) {
    return b[0] / pow(1 + exp(b[1] - b[2] * x), 1 / b[3]);
  } else if (is("Eckerle4")) {
    return b[0] / b[1] * exp(-square((x - b[2]) / b[1]) / 2);
  }
  return b[0] * pow(b[1] + x, -1 / b[2]); // Bennett5
}

/// (a t + b) exp(c t) − y at t = 0, .1, …, with y for known a, b, c
struct curve {
  VectorXd y;
  template <class T>
  Eigen::Matrix<T, Eigen::Dynamic, 1> operator()(const T& a, const T& b, const T& c) const {
    using std::exp;
    Eigen::Matrix<T, Eigen::Dynamic, 1> r(y.size());
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      const double t = .1 * double(i);
      r[i] = (a * t + b) * exp(c * t) - y[i];
    }
    return r;
  }
};

curve noisy_curve(double noise, int size = 30) {
  duet_test::random_source random(7);
  curve f{VectorXd::Zero(size)};
  f.y = f(2., .5, -.7);
  for (double& each : f.y) {
    each += noise * random.uniform(-1, 1);
  }
  return f;
}

/// Image of a point in a camera, a pose with focal lengths and centre.
template <class P, class V>
auto image(const P& camera, const V& intrinsics, const Eigen::Vector3d& point) {
  using T = typename V::Scalar;
  const duet::vector3<T> p = transform_point(conj(camera), duet::vector3<T>(point.cast<T>()));
  return Eigen::Matrix<T, 2, 1>(intrinsics[0] * p[0] / p[2] + intrinsics[2],
                                intrinsics[1] * p[1] / p[2] + intrinsics[3]);
}

TEST_CASE("estimates and standard deviations of the NIST regressions, from both starts") {
  int solved = 0;
  double digits = 0;
  for (const regression& r : regressions()) {
    for (const VectorXd& start : r.starts) {
      CAPTURE(r.name);
      const auto f = [&]<class T>(const Eigen::Matrix<T, Eigen::Dynamic, 1>& b) {
        Eigen::Matrix<T, Eigen::Dynamic, 1> residuals(r.y.size());
        for (Eigen::Index i = 0; i < r.y.size(); ++i) {
          residuals[i] = model<T>(r.name, b, r.x[std::size_t(i)]) - r.y[i];
        }
        return residuals;
      };
      const auto result = nonlinear_least_squares(f, start);
      CHECK(result.converged());
      CHECK(result.undetermined.empty());
      CHECK(result.degrees_of_freedom == r.y.size() - start.size());
      const VectorXd errors = (result.estimate.array() / r.certified.array() - 1).abs();
      CHECK(errors.maxCoeff() < 1e-6);
      const VectorXd deviations = result.covariance.diagonal().cwiseSqrt();
      // The variance of Lanczos1 is that of the round-off of its data.
      CHECK((deviations.array() / r.deviations.array() - 1).abs().maxCoeff() <
            (r.name == "Lanczos1" ? .5 : 1e-5));
      digits += std::min(11., -std::log10(errors.maxCoeff()));
      ++solved;
    }
  }
  CHECK(solved == 54);
  CHECK(digits / solved > 9.5);
}

TEST_CASE("hand-eye calibration, A X = X B") {
  duet_test::random_source random(1);
  const auto any_pose = [&] {
    const auto v = [&](double size) {
      return Eigen::Vector3d::NullaryExpr([&] { return random.uniform(-size, size); }).eval();
    };
    return duet::pose(duet::from_rotation_vector(v(1.5)), v(1));
  };
  const pose x = any_pose();
  std::vector<pose> a, b;
  for (int i = 0; i < 12; ++i) {
    b.push_back(any_pose());
    a.push_back(x * b.back() * conj(x));
  }
  const auto f = [&]<class P>(const P& candidate) {
    std::vector<duet::vector6<typename duet::manifold<P>::scalar>> r;
    for (std::size_t i = 0; i < a.size(); ++i) {
      r.push_back(twist_of(log(conj(a[i] * candidate) * (candidate * b[i])).vec()));
    }
    return r;
  };
  for (const pose& start :
       {pose(1), x * duet::pose(rotation(0, 1, 0, 0), Eigen::Vector3d(3, 0, 0))}) {
    const auto result = nonlinear_least_squares(f, start);
    CHECK(result.converged());
    CHECK(duet::translation(conj(result.estimate) * x).norm() < 1e-14);
    CHECK(std::abs(std::abs(dot(result.estimate, x).value()) - 1) < 1e-15);
    CHECK(result.degrees_of_freedom == 66);
  }
}

TEST_CASE("camera resection with outliers") {
  duet_test::random_source random(2);
  const pose camera = duet::pose(duet::from_rotation_vector(Eigen::Vector3d(.2, -.4, .1)),
                                 Eigen::Vector3d(.3, -.2, -5));
  const Eigen::Vector4d intrinsics(800, 790, 320, 240);
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector2d> pixels;
  for (int i = 0; i < 40; ++i) {
    points.push_back(Eigen::Vector3d::NullaryExpr([&] { return random.uniform(-2, 2); }));
    pixels.push_back(image(camera, intrinsics, points.back()));
    if (i % 8 == 0) { // outliers
      pixels.back() += Eigen::Vector2d(random.uniform(20, 90), random.uniform(-90, -20));
    }
  }
  const auto f = [&]<class P, class V>(const P& of, const V& with) {
    std::vector<Eigen::Matrix<typename V::Scalar, 2, 1>> r;
    for (std::size_t i = 0; i < points.size(); ++i) {
      r.push_back(image(of, with, points[i]) - pixels[i]);
    }
    return r;
  };
  const std::tuple start(pose(duet::pose(rotation(1), Eigen::Vector3d(0, 0, -6))),
                         Eigen::Vector4d(700, 700, 300, 260));
  // Biweight: outliers do not count at all, so that the true values remain.
  const auto rough = nonlinear_least_squares(f, start, {.loss = loss_function::cauchy(3)});
  const auto result =
      nonlinear_least_squares(f, rough.estimate, {.loss = loss_function::tukey(10)});
  CHECK(rough.converged());
  CHECK(result.converged());
  CHECK((duet::translation(std::get<0>(result.estimate)) - duet::translation(camera)).norm() <
        1e-10);
  CHECK((std::get<1>(result.estimate) - intrinsics).norm() < 1e-7);
  // Least squares are far off, and Huber's loss is between them.
  const auto plain = nonlinear_least_squares(f, start);
  const auto huber = nonlinear_least_squares(f, start, {.loss = loss_function::huber(3)});
  CHECK(plain.converged());
  CHECK(huber.converged());
  const auto error = [&](const auto& of) { return (std::get<1>(of.estimate) - intrinsics).norm(); };
  CHECK(error(plain) > 3 * error(huber));
  CHECK(error(huber) > 3 * error(rough));
}

TEST_CASE("at the minimum of every loss the gradient of the cost vanishes") {
  curve f = noisy_curve(.01);
  f.y[4] += 1;
  f.y[17] -= .4;
  for (const loss_function& loss : {loss_function::squares(), loss_function::huber(.02),
                                    loss_function::cauchy(.02), loss_function::tukey(.1)}) {
    CAPTURE(int(loss.form));
    const auto r = nonlinear_least_squares(f, std::tuple(2.1, .45, -.72), {.loss = loss});
    CHECK(r.converged());
    const auto cost = [&]<class T>(const Eigen::Matrix<T, 3, 1>& x) {
      using std::abs, std::log;
      T sum(0);
      for (const T& residual : f(x[0], x[1], x[2])) {
        const double k = loss.scale;
        const T s = abs(residual), u = s / k;
        sum += loss.form == loss_function::kind::squares ? T(s * s / 2)
               : loss.form == loss_function::kind::huber
                   ? (s < k ? T(s * s / 2) : T(k * (s - k / 2)))
               : loss.form == loss_function::kind::cauchy
                   ? T(k * k / 2 * log(1 + u * u))
                   : (u < 1 ? T(k * k / 6 * (1 - (1 - u * u) * (1 - u * u) * (1 - u * u)))
                            : T(k * k / 6));
      }
      return sum;
    };
    const auto [a, b, c] = r.estimate;
    const auto [value, gradient, hessian] = duet::hessian(cost, Eigen::Vector3d(a, b, c));
    CHECK(r.cost == doctest::Approx(value).epsilon(1e-13));
    CHECK(gradient.norm() < 1e-13 * hessian.norm());
    CHECK(hessian.llt().info() == Eigen::Success);
    // Sandwich of the curvatures and the gradients of single losses.
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero(), curvatures = squares;
    double psi_2 = 0, curved_psi_2 = 0, sum = 0, sum_2 = 0; // of ψ², ψ²W, W and W²
    const auto j = duet::jacobian([&](const auto& x) { return f(x[0], x[1], x[2]); },
                                  Eigen::Vector3d(a, b, c));
    for (int i = 0; i < 30; ++i) {
      const double s = j.value[i], u = std::abs(s) / loss.scale;
      const double weight = loss.form == loss_function::kind::squares ? 1
                            : loss.form == loss_function::kind::huber ? std::min(1., 1 / u)
                            : loss.form == loss_function::kind::cauchy
                                ? 1 / (1 + u * u)
                                : std::pow(std::max(0., 1 - u * u), 2);
      const double curvature = loss.form == loss_function::kind::huber ? (u < 1 ? 1 : 0)
                               : loss.form == loss_function::kind::cauchy
                                   ? (1 - u * u) * weight * weight
                                   : std::max(0., 1 - u * u) * (1 - 5 * u * u);
      const Eigen::Matrix3d outer = j.jacobian.row(i).transpose() * j.jacobian.row(i);
      squares += weight * weight * s * s * outer;
      curvatures += curvature * outer;
      psi_2 += weight * weight * s * s;
      curved_psi_2 += curvature * weight * weight * s * s;
      sum += curvature;
      sum_2 += curvature * curvature;
    }
    const Eigen::Matrix3d inverse = curvatures.inverse();
    const double shrunk = .1 * (2 * curved_psi_2 / (sum / 30 * psi_2) - 30 * sum_2 / (sum * sum));
    const Eigen::Matrix3d covariance =
        loss.form == loss_function::kind::squares
            ? Eigen::Matrix3d((j.jacobian.transpose() * j.jacobian).inverse() * 2 * r.cost / 27)
            : Eigen::Matrix3d(inverse * squares * inverse / (1 - shrunk));
    CHECK((r.covariance - covariance).norm() < 1e-9 * covariance.norm());
  }
}

TEST_CASE("a loss that counts no residual determines nothing") {
  const curve f = noisy_curve(0);
  const auto r =
      nonlinear_least_squares(f, std::tuple(9., 9., 9.), {.loss = loss_function::tukey(.1)});
  CHECK(r.undetermined.size() == 3);
  CHECK(r.estimate == std::tuple(9., 9., 9.));
}

TEST_CASE("weights count like repeated residuals, covariances like scaled ones") {
  const curve f = noisy_curve(.01);
  const std::tuple start(1.5, 1., -.5);
  std::vector<double> weights(30, 1);
  weights[3] = weights[20] = 2;
  const auto weighted = nonlinear_least_squares(f, start, {.weights = weights});
  const auto repeated = nonlinear_least_squares(
      [&]<class T>(const T& a, const T& b, const T& c) {
        Eigen::Matrix<T, Eigen::Dynamic, 1> r(32);
        r << f(a, b, c), f(a, b, c)[3], f(a, b, c)[20];
        return r;
      },
      start);
  CHECK(std::get<0>(weighted.estimate) ==
        doctest::Approx(std::get<0>(repeated.estimate)).epsilon(1e-13));
  CHECK(std::get<2>(weighted.estimate) ==
        doctest::Approx(std::get<2>(repeated.estimate)).epsilon(1e-13));

  // Pairs of residuals with correlated errors, and the same whitened by hand.
  Eigen::Matrix2d sigma, root;
  sigma << 4, 1.5, 1.5, 1;
  root = sigma.llt().matrixL().solve(Eigen::Matrix2d::Identity());
  const auto pairs = [&]<class T>(const T& a, const T& b, const T& c) {
    const auto r = f(a, b, c);
    std::vector<Eigen::Matrix<T, 2, 1>> result;
    for (int i = 0; i < 15; ++i) {
      result.emplace_back(r[2 * i], r[2 * i + 1]);
    }
    return result;
  };
  const auto whitened = [&]<class T>(const T& a, const T& b, const T& c) {
    auto result = pairs(a, b, c);
    for (auto& each : result) {
      each = (root.cast<T>() * each).eval();
    }
    return result;
  };
  const auto first = nonlinear_least_squares(pairs, start, {.covariances = {sigma}});
  const auto second = nonlinear_least_squares(whitened, start);
  CHECK(std::get<1>(first.estimate) ==
        doctest::Approx(std::get<1>(second.estimate)).epsilon(1e-13));
  CHECK(first.cost == doctest::Approx(second.cost).epsilon(1e-13));
  // The size of the errors is known.
  CHECK((first.covariance * 2 * second.cost / 27 - second.covariance).norm() <
        1e-12 * second.covariance.norm());
}

TEST_CASE("bounds hold, and the others are at their minimum given them") {
  const curve f = noisy_curve(.01);
  nonlinear_least_squares_options options;
  const double infinity = std::numeric_limits<double>::infinity();
  options.lower = Eigen::Vector3d(-infinity, -infinity, -.5);
  options.upper = Eigen::Vector3d(infinity, .3, infinity);
  const auto r = nonlinear_least_squares(f, std::tuple(1., .2, 0.), options);
  CHECK(r.converged());
  const auto [a, b, c] = r.estimate;
  const auto [y, j] =
      duet::jacobian([&](const auto& x) { return f(x[0], x[1], x[2]); }, Eigen::Vector3d(a, b, c));
  const Eigen::Vector3d gradient = j.transpose() * y;
  const double tolerance = 1e-12 * j.norm();
  const auto holds = [&](double at, double slope, double lower, double upper) {
    return at >= lower && at <= upper &&
           (std::abs(slope) < tolerance || (at == lower && slope > 0) ||
            (at == upper && slope < 0));
  };
  CHECK(holds(a, gradient[0], -infinity, infinity));
  CHECK(holds(b, gradient[1], -infinity, .3));
  CHECK(holds(c, gradient[2], -.5, infinity));
  CHECK((b == .3 || c == -.5));
  // A parameter at a bound has no error; the free ones have that of the problem without it.
  for (int k = 0; k < 3; ++k) {
    const bool is_at_bound = (k == 1 && b == .3) || (k == 2 && c == -.5);
    CHECK((r.covariance(k, k) == 0) == is_at_bound);
  }
  // A start at the bound leaves it if the cost decreases inwards.
  options.lower = Eigen::Vector3d(-infinity, -infinity, -5);
  options.upper = Eigen::Vector3d(infinity, 3, 0);
  const auto inside = nonlinear_least_squares(f, std::tuple(1., 3., 0.), options);
  const auto free = nonlinear_least_squares(f, std::tuple(1., 3., 0.));
  CHECK(std::get<1>(inside.estimate) == doctest::Approx(std::get<1>(free.estimate)).epsilon(1e-12));
  // Bounds are reached exactly, also where start + (bound - start) is another number.
  for (const double start : {.7, .9, 3.3}) {
    const auto distance = [](const auto& x) { return x * x + 1; };
    const auto up =
        nonlinear_least_squares(distance, start, {.lower = Eigen::VectorXd::Constant(1, .1)});
    CHECK(up.estimate == .1);
    CHECK(up.covariance(0) == 0);
    const auto down =
        nonlinear_least_squares(distance, -start, {.upper = Eigen::VectorXd::Constant(1, -.1)});
    CHECK(down.estimate == -.1);
  }
}

TEST_CASE("chain of poses in a vector") {
  duet_test::random_source random(5);
  std::vector<pose> truth, start;
  for (int i = 0; i < 7; ++i) {
    const auto v = [&](double size) {
      return Eigen::Vector3d::NullaryExpr([&] { return random.uniform(-size, size); }).eval();
    };
    truth.push_back(duet::pose(duet::from_rotation_vector(v(1.5)), v(2)));
    start.push_back(truth.back() * duet::pose(duet::from_rotation_vector(v(.3)), v(.5)));
  }
  const auto f = [&]<class P>(const std::vector<P>& x) {
    std::vector<duet::vector6<typename duet::manifold<P>::scalar>> r;
    r.push_back(twist_of(log(conj(truth[0]) * x[0]).vec()));
    for (std::size_t i = 1; i < x.size(); ++i) {
      r.push_back(
          twist_of(log(conj(conj(truth[i - 1]) * truth[i]) * (conj(x[i - 1]) * x[i])).vec()));
    }
    return r;
  };
  const auto result = nonlinear_least_squares(f, start); // 42 parameters, several passes
  CHECK(result.converged());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    CHECK(duet::translation(conj(truth[i]) * result.estimate[i]).norm() < 1e-13);
    CHECK(std::abs(squared_norm(result.estimate[i]).value() - 1) < 1e-15);
  }
}

TEST_CASE("undetermined parameters are named") {
  const VectorXd y = VectorXd::LinSpaced(6, 1, 2);
  const auto sum = [&]<class T>(const T& a, const Eigen::Matrix<T, 2, 1>& b) {
    Eigen::Matrix<T, Eigen::Dynamic, 1> r(6);
    for (int i = 0; i < 6; ++i) {
      r[i] = (a + b[0]) * double(i) + b[1] - y[i];
    }
    return r;
  };
  const auto r = nonlinear_least_squares(sum, std::tuple(1., Eigen::Vector2d(0, 0)));
  CHECK(r.converged());
  CHECK(r.undetermined == std::vector<std::string>{"argument 0", "argument 1[0]"});
  CHECK(r.degrees_of_freedom == 4);
  CHECK(std::get<0>(r.estimate) + std::get<1>(r.estimate)[0] == doctest::Approx(.2));
  CHECK(std::isinf(r.covariance(0, 0)));
  CHECK(std::isfinite(r.covariance(2, 2)));

  // The direction of an axis says nothing about the angle around it.
  const auto axis = [](const auto& q) {
    return duet::vector3<typename duet::manifold<std::decay_t<decltype(q)>>::scalar>(
        rotate(q, duet::vector3<double>(0, 0, 1)) - Eigen::Vector3d(0, .6, .8));
  };
  const auto q = nonlinear_least_squares(axis, rotation(1));
  CHECK(q.undetermined == std::vector<std::string>{"rotation about z"});
  CHECK((rotate(q.estimate, Eigen::Vector3d(0, 0, 1)) - Eigen::Vector3d(0, .6, .8)).norm() < 1e-15);
  // One that has no effect at all.
  const auto one = nonlinear_least_squares(
      [](const auto& x) {
        return std::array{x[0] - 2, x[0] + x[0] - 5};
      },
      Eigen::Vector2d(0, 7));
  CHECK(one.undetermined == std::vector<std::string>{"[1]"});
  CHECK(one.estimate == Eigen::Vector2d(2.4, 7));
  // Units do not matter.
  const auto units = nonlinear_least_squares(
      [](const auto& x) {
        return std::array{1e12 * x[0] - 2, 1e-12 * x[1] + 1e12 * x[0] - 5};
      },
      Eigen::Vector2d(0, 0));
  CHECK(units.undetermined.empty());
  CHECK(units.estimate.isApprox(Eigen::Vector2d(2e-12, 3e12), 1e-14));
}

TEST_CASE("structured starts: the solution, its antipode, a half turn, a flat point") {
  const curve f = noisy_curve(0);
  const auto exact = nonlinear_least_squares(f, std::tuple(2., .5, -.7));
  CHECK(exact.converged());
  CHECK(exact.iterations <= 3);
  CHECK(exact.estimate == std::tuple(2., .5, -.7));

  const rotation goal = duet::from_rotation_vector(Eigen::Vector3d(.3, -.2, .5));
  const auto error = [&](const auto& q) { return rotation_vector(conj(goal) * q); };
  const rotation half_turn(0, 0, 1, 0),
      quarter = duet::from_rotation_vector(Eigen::Vector3d(std::acos(-1.) / 2, 0, 0));
  for (const rotation& start : {goal, rotation(-goal), rotation(goal * half_turn * quarter),
                                rotation(1), rotation(goal * quarter)}) {
    const auto r = nonlinear_least_squares(error, start);
    CHECK(r.converged());
    CHECK(rotation_vector(conj(goal) * r.estimate).norm() < 1e-15);
    CHECK(r.degrees_of_freedom == 0);
    CHECK(std::isnan(r.covariance(0, 0)));
  }
  // (x² − 2)²/2 has a maximum at 0, where no step is better than another.
  const auto flat = nonlinear_least_squares([](const auto& x) { return x * x - 2; }, 0.);
  CHECK(flat.estimate == 0);
  CHECK(flat.undetermined == std::vector<std::string>{"the parameter"});
  // Equal parameters with equal columns, more parameters than residuals.
  const auto equal = nonlinear_least_squares([](const auto& x) { return x[0] + x[1] + x[2] - 6; },
                                             Eigen::Vector3d(1, 1, 1));
  CHECK(equal.undetermined.size() == 3);
  CHECK(equal.estimate.sum() == doctest::Approx(6).epsilon(1e-15));
}

TEST_CASE("iterations end for the reason that they give") {
  const curve f = noisy_curve(.01);
  const auto few = nonlinear_least_squares(f, std::tuple(1., 1., 1.), {.max_iterations = 2});
  CHECK(few.reason == least_squares_stop::iteration_limit);
  CHECK(few.iterations == 2);
  CHECK_FALSE(few.converged());
  const auto one = nonlinear_least_squares([](const auto& x) { return x - 3; }, 1.);
  CHECK(one.estimate == 3);
  CHECK(one.converged());
  CHECK(std::string(to_text(one.reason)) == "small_step");
  CHECK(one.degrees_of_freedom == 0);
}

TEST_CASE("bad input is refused with the value") {
  const curve f = noisy_curve(0, 5);
  const std::tuple start(1., 1., 1.);
  const auto text = [&](const nonlinear_least_squares_options& options) {
    return duet_test::message_of(
        [&] { static_cast<void>(nonlinear_least_squares(f, start, options)); });
  };
  const std::string name = "duet: nonlinear_least_squares: ";
  CHECK(text({.weights = {1, 2}}) == name + "2 weights for 5 residuals");
  CHECK(text({.weights = {1, 1, 0, 1, 1}}) ==
        name + "weight 2 is 0 (expected a finite positive number; omit residuals that should not "
               "count)");
  CHECK(text({.covariances = {MatrixXd::Identity(2, 2)}}) ==
        name + "covariance 0 is 2 x 2, not 1 x 1");
  CHECK(text({.covariances = {-MatrixXd::Identity(1, 1)}}) ==
        name + "covariance 0 is not positive definite");
  CHECK(text({.covariances = {MatrixXd::Identity(1, 1), MatrixXd::Identity(1, 1)}}) ==
        name + "2 covariances for 5 residuals (expected one for each, or one for all)");
  CHECK(text({.loss = loss_function::huber(0)}) ==
        name + "the scale of the loss is 0 (expected a finite positive number)");
  CHECK(text({.loss = loss_function::tukey(std::numeric_limits<double>::infinity())}) ==
        name + "the scale of the loss is inf (expected a finite positive number)");
  CHECK(text({.lower = Eigen::Vector3d(0, std::nan(""), 0)}) == name + "lower[1] is nan");
  CHECK(text({.lower = VectorXd::Zero(2)}) == name + "lower has 2 entries for 3 parameters");
  CHECK(text({.upper = VectorXd::Zero(3)}) == name + "argument 0 is 1, outside its bounds, -inf to "
                                                     "0 (rotations and poses cannot have bounds)");
  const auto of = [&](const auto& g, const auto& x, const nonlinear_least_squares_options& o = {}) {
    return duet_test::message_of([&] { static_cast<void>(nonlinear_least_squares(g, x, o)); });
  };
  CHECK(of([](const auto& x) { return log(x); }, 0.) == name + "residual 0 is -inf at the start");
  CHECK(of(
            [](const auto& x) {
              return std::array{x, sqrt(x)};
            },
            0.) ==
        name + "residual 1 has the derivative inf with respect to the parameter at the start");
  CHECK(of([](const auto& q) { return rotate(q, Eigen::Vector3d(1, 0, 0)); }, rotation(1),
           {.lower = VectorXd::Zero(3)}) ==
        name + "rotation about x is nan, outside its bounds, 0 to inf "
               "(rotations and poses cannot have bounds)");
  CHECK(of([](const auto& x) { return x; }, VectorXd()) == name + "there are no parameters");
}

} // namespace
} // namespace test_derivative_nonlinear_least_squares
