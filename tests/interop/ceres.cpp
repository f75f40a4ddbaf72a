// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/multiprecision.hpp"

#include <duet/core/errors.hpp>
#include <duet/core/random_source.hpp>
#include <duet/derivative/derivative.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/derivative/tangent_coordinates.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/interop/ceres.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Core>
#include <ceres/autodiff_cost_function.h>
#include <ceres/gradient_checker.h>
#include <ceres/rotation.h>

#include <memory>

#include "support/test.hpp"

// Manifolds, ambient Jacobians and cost functions for Ceres: against differences in 50 digits,
// Ceres' own manifolds and Jets.

namespace test_interop_ceres {
namespace {

using duet::quaternion_order;
using duet_test::real_50;
using pose = duet::dual_quaternion<double>;
using vector3 = duet::vector3<double>;
constexpr std::array orders{quaternion_order::wxyz, quaternion_order::xyzw};
constexpr double infinity = std::numeric_limits<double>::infinity();

using owned = std::unique_ptr<ceres::CostFunction>;

/// At the identity, near it and near half turns, both signs, and anywhere.
std::vector<duet::quaternion<double>> rotations() {
  std::vector<duet::quaternion<double>> result;
  const vector3 axis = vector3(1, -2, 3).normalized();
  for (const double angle : {0., 1e-9, .7, std::numbers::pi - 1e-9, std::numbers::pi, 5.}) {
    result.push_back(duet::from_rotation_vector(vector3(angle * axis)));
    result.push_back(-result.back());
  }
  return result;
}

std::vector<pose> poses() {
  std::vector<pose> result;
  for (const auto& q : rotations()) {
    const double distance = std::array{0., 1., 1e6}[result.size() % 3];
    result.push_back(duet::pose(q, vector3(distance * vector3(.3, -.9, .5))));
  }
  return result;
}

/// The object in a parameter block over any scalar, normalised.
template <class T>
auto value_in(const duet::rotation_block& block, const T* x) {
  return normalized(duet::load_quaternion(x, block.order()));
}
template <class T>
auto value_in(const duet::pose_block& block, const T* x) {
  return duet::pose(normalized(duet::load_quaternion(x + 3, block.order())),
                    duet::vector3<T>(x[0], x[1], x[2]));
}
template <class T>
auto value_in(const duet::dual_quaternion_block& block, const T* x) {
  return normalized(duet::make_dual_quaternion(duet::load_quaternion(x, block.order()),
                                               duet::load_quaternion(x + 4, block.order())));
}

/// Functions of a rotation or pose, with values near 1.
const auto test_function = []<class Q>(const Q& x) {
  using S = typename duet::manifold<Q>::scalar;
  Eigen::Matrix<S, 4, 1> r;
  if constexpr (duet::manifold<Q>::dimension == 3) {
    const duet::vector3<S> v = rotate(x, duet::vector3<S>(S(1), S(-2), S(.5)));
    r << v, v[0] * x.w() * x.y();
  } else {
    const auto q = rotation(x);
    const duet::vector3<S> v =
        transform_point(x, duet::vector3<S>(S(1), S(-2), S(.5))) / S(1 + 1e-3);
    r << v, rotate(q, v)[1] / (1 + v.squaredNorm());
  }
  return r;
};

/// Largest error of a Jacobian relative to its largest entry in the same column or 1.
template <class A, class B>
double error_of(const A& a, const B& b) {
  double worst = 0;
  for (Eigen::Index k = 0; k < a.cols(); ++k) {
    const double scale = std::max(1., double(b.col(k).cwiseAbs().maxCoeff()));
    worst = std::max(worst, (a.col(k) - b.col(k)).cwiseAbs().maxCoeff() / scale);
  }
  return worst;
}

/// Derivatives of f with respect to `size` numbers by central differences in 50 digits.
template <int Rows, int Columns, class F>
Eigen::Matrix<double, Rows, Columns> differences(const F& f,
                                                 const std::array<real_50, Columns>& x) {
  const real_50 h(1e-17);
  Eigen::Matrix<double, Rows, Columns> result;
  for (int k = 0; k < Columns; ++k) {
    auto left = x, right = x;
    left[std::size_t(k)] -= h;
    right[std::size_t(k)] += h;
    const auto y_left = f(left), y_right = f(right);
    for (int i = 0; i < Rows; ++i) {
      const real_50 change =
          duet::detail::component(y_right, i) - duet::detail::component(y_left, i);
      result(i, k) = double(real_50(change / (2 * h)));
    }
  }
  return result;
}

template <std::size_t N>
std::array<real_50, N> in_50_digits(const std::array<double, N>& x) {
  std::array<real_50, N> result;
  std::copy(x.begin(), x.end(), result.begin());
  return result;
}

/// Ambient Jacobians at numbers in memory, units and others.
template <class Block>
double ambient_error(const Block& block, const std::array<double, Block::size>& x, double scale) {
  auto numbers = x;
  const int first = Block::size == 7 ? 3 : 0;
  for (std::size_t i = first; i < numbers.size(); ++i) {
    numbers[i] *= scale;
  }
  if (Block::size == 8) { // not orthogonal any more
    numbers[5] += .1 * (scale - 1);
  }
  const auto tangent =
      duet::jacobian(test_function, block.load(numbers.data()), duet::frame::body).jacobian;
  const auto expected = differences<4, Block::size>(
      [&](const auto& at) { return test_function(value_in(block, at.data())); },
      in_50_digits(numbers));
  // A tangent Jacobian from dual quaternions has round-off in proportion to the translation.
  const double length = Block::size == 7 ? std::max(1., vector3(numbers.data()).norm()) : 1.;
  return error_of(block.ambient_jacobian(tangent, numbers.data()), expected) / length;
}

template <class Block, class X>
std::array<double, Block::size> stored(const Block& block, const X& x) {
  std::array<double, Block::size> result;
  block.store(x, result.data());
  return result;
}

/// Tests of Plus, Minus and their Jacobians at x.
template <class Block>
void check_manifold(const Block& block, const std::array<double, Block::size>& x,
                    duet::random_source& random) {
  constexpr int size = Block::size, dimension = Block::dimension;
  using tangent = Eigen::Matrix<double, dimension, 1>;
  using numbers = Eigen::Matrix<double, size, 1>;
  const duet::block_manifold<Block> manifold(block.order());
  const Eigen::Map<const numbers> at(x.data());
  const double length = std::max(1., at.cwiseAbs().maxCoeff()); // far from the origin
  CHECK(manifold.AmbientSize() == size);
  CHECK(manifold.TangentSize() == dimension);

  numbers same;
  CHECK(manifold.Plus(x.data(), tangent::Zero().eval().data(), same.data()));
  CHECK((same - at).norm() <= 1e-15 * length);
  tangent none;
  CHECK(manifold.Minus(x.data(), x.data(), none.data()));
  CHECK(none.norm() == 0);

  for (const double step : {1e-12, 1e-3, 1., 2.9}) {
    tangent delta;
    for (int i = 0; i < dimension; ++i) {
      delta[i] = random.normal();
    }
    delta *= step / delta.norm();
    numbers y;
    tangent back;
    CHECK(manifold.Plus(x.data(), delta.data(), y.data()));
    CHECK(manifold.Minus(y.data(), x.data(), back.data()));
    CHECK((back - delta).norm() <= 2e-15 * (length + step));
    numbers again;
    CHECK(manifold.Plus(x.data(), back.data(), again.data()));
    CHECK((again - y).norm() <= 2e-15 * length);
    // Plus is duet's q exp(δ/2).
    const auto moved = duet::manifold<typename Block::value_type>::plus(block.load(x.data()), delta,
                                                                        duet::frame::body);
    CHECK((Eigen::Map<const numbers>(stored(block, moved).data()) - y).norm() <= 2e-15 * length);
  }

  Eigen::Matrix<double, size, dimension, Eigen::RowMajor> plus;
  Eigen::Matrix<double, dimension, size, Eigen::RowMajor> minus;
  CHECK(manifold.PlusJacobian(x.data(), plus.data()));
  CHECK(manifold.MinusJacobian(x.data(), minus.data()));
  CHECK((minus * plus - Eigen::Matrix<double, dimension, dimension>::Identity()).norm() <=
        4e-15 * length * length);
  const auto value = value_in(block, in_50_digits(x).data());
  using value_50 = std::decay_t<decltype(value)>;
  const auto plus_50 = differences<size, dimension>(
      [&](const std::array<real_50, dimension>& d) {
        Eigen::Matrix<real_50, dimension, 1> delta;
        std::copy(d.begin(), d.end(), delta.begin());
        const auto y = duet::manifold<value_50>::plus(value, delta, duet::frame::body);
        std::array<real_50, size> result;
        if constexpr (dimension == 3) {
          duet::store_quaternion(y, result.data(), block.order());
        } else if constexpr (size == 7) {
          const auto t = translation(y);
          std::copy(t.begin(), t.end(), result.begin());
          duet::store_quaternion(rotation(y), result.data() + 3, block.order());
        } else {
          duet::store_quaternion(real_part(y), result.data(), block.order());
          duet::store_quaternion(dual_part(y), result.data() + 4, block.order());
        }
        return result;
      },
      {});
  CHECK(error_of(plus, plus_50) <= 1e-15);
  // D Minus(y, x) at y = x, on the manifold and off it
  const auto minus_50 = differences<dimension, size>(
      [&](const auto& y) {
        const auto step = conj(value) * value_in(block, y.data());
        const auto log_of_step = duet::log(step).vec();
        Eigen::Matrix<real_50, dimension, 1> result;
        if constexpr (dimension == 3) {
          result = 2 * log_of_step;
        } else {
          result = 2 * duet::twist_of(log_of_step);
        }
        return result;
      },
      in_50_digits(x));
  CHECK(error_of(minus, minus_50) <= 2e-15);
}

TEST_CASE("ambient: Jacobians agree with 50 digits, on the unit sphere and off it") {
  double worst = 0;
  for (const auto order : orders) {
    for (const auto& q : rotations()) {
      const duet::rotation_block block(order);
      for (const double scale : {1., 1.3}) {
        worst = std::max(worst, ambient_error(block, stored(block, q), scale));
      }
    }
    for (const auto& a : poses()) {
      const duet::pose_block seven(order);
      const duet::dual_quaternion_block eight(order);
      for (const double scale : {1., .8}) {
        worst = std::max({worst, ambient_error(seven, stored(seven, a), scale),
                          ambient_error(eight, stored(eight, a), scale)});
      }
    }
  }
  CHECK(worst <= 1e-13);
}

TEST_CASE("ambient: functions agree with blocks") {
  const auto a = poses()[4];
  const auto q = rotation(a);
  const auto by_pose = duet::jacobian(test_function, a, duet::frame::body).jacobian;
  const auto by_rotation = duet::jacobian(test_function, q, duet::frame::body).jacobian;
  for (const auto order : orders) {
    const duet::rotation_block four(order);
    const duet::pose_block seven(order);
    const duet::dual_quaternion_block eight(order);
    CHECK(ambient(by_rotation, q, order) ==
          four.ambient_jacobian(by_rotation, stored(four, q).data()));
    CHECK((ambient(by_pose, a, order) - seven.ambient_jacobian(by_pose, stored(seven, a).data()))
              .norm() <= 1e-15);
    CHECK(ambient_of_dual_quaternion(by_pose, a, order) ==
          eight.ambient_jacobian(by_pose, stored(eight, a).data()));
    // rows: a gradient is one
    CHECK((ambient(by_pose.row(2), a, order) - ambient(by_pose, a, order).row(2)).norm() <= 1e-15);
  }
  // of numbers and vectors they are the Jacobians themselves
  const Eigen::Matrix<double, 2, 3, Eigen::RowMajor> j{{1, 2, 3}, {4, 5, 6}};
  CHECK(duet::vector_block<3>::ambient_jacobian(j, nullptr) == j);
  const Eigen::Vector2d column(1, 2);
  CHECK(duet::number_block::ambient_jacobian(column, nullptr) == column);
}

TEST_CASE("manifolds: Plus, Minus and their Jacobians, in both orders") {
  duet::random_source random(1);
  for (const auto order : orders) {
    for (const auto& q : rotations()) {
      const duet::rotation_block block(order);
      check_manifold(block, stored(block, q), random);
    }
    for (const auto& a : poses()) {
      const duet::pose_block seven(order);
      check_manifold(seven, stored(seven, a), random);
      const duet::dual_quaternion_block eight(order);
      check_manifold(eight, stored(eight, a), random);
    }
  }
}

TEST_CASE("manifolds: a full turn, and numbers that are no poses") {
  const duet::rotation_manifold rotations(quaternion_order::wxyz);
  const std::array q{.6, .8, 0., 0.}, negative{-.6, -.8, 0., 0.};
  std::array<double, 3> delta;
  CHECK(rotations.Minus(negative.data(), q.data(), delta.data()));
  CHECK(std::hypot(delta[0], delta[1], delta[2]) == doctest::Approx(2 * std::numbers::pi));
  std::array<double, 4> sum;
  CHECK(rotations.Plus(q.data(), delta.data(), sum.data()));
  CHECK(std::abs(sum[0] + .6) <= 1e-15);
  const std::array<double, 4> zero{};
  CHECK_FALSE(rotations.Minus(q.data(), zero.data(), delta.data()));
  std::array<double, 12> jacobian;
  CHECK_FALSE(rotations.MinusJacobian(zero.data(), jacobian.data()));
  CHECK_FALSE(rotations.Plus(zero.data(), delta.data(), sum.data()));
  CHECK_FALSE(rotations.PlusJacobian(zero.data(), jacobian.data()));
  delta[1] = infinity;
  CHECK_FALSE(rotations.Plus(q.data(), delta.data(), sum.data()));

  const duet::pose_manifold poses(quaternion_order::xyzw);
  const std::array<double, 7> a{1, 2, 3, 0, 0, 0, 1}, none{1, 2, 3, 0, 0, 0, 0};
  std::array<double, 6> twist;
  CHECK_FALSE(poses.Minus(a.data(), none.data(), twist.data()));
  std::array<double, 7> moved;
  std::array<double, 42> of_pose;
  twist = {1, 2, 3, .1, .2, .3};
  CHECK_FALSE(poses.Plus(none.data(), twist.data(), moved.data()));
  CHECK_FALSE(poses.PlusJacobian(none.data(), of_pose.data()));
  CHECK_FALSE(poses.MinusJacobian(none.data(), of_pose.data()));
  CHECK(poses.MinusJacobian(a.data(), of_pose.data()));
  const duet::dual_quaternion_manifold eight(quaternion_order::xyzw);
  const std::array<double, 8> unit{0, 0, 0, 1, 0, 0, 0, 0}, zeros{};
  std::array<double, 8> moved_eight;
  std::array<double, 48> of_eight;
  CHECK_FALSE(eight.Plus(zeros.data(), twist.data(), moved_eight.data()));
  CHECK_FALSE(eight.PlusJacobian(zeros.data(), of_eight.data()));
  CHECK_FALSE(eight.Minus(unit.data(), zeros.data(), twist.data()));
}

TEST_CASE("blocks: what is stored is loaded") {
  for (const auto order : orders) {
    for (const auto& a : poses()) {
      const duet::pose_block seven(order);
      const duet::dual_quaternion_block eight(order);
      const auto difference = [&](const auto& block) {
        const auto step = conj(a) * block.load(stored(block, a).data());
        return rotation_vector(rotation(step)).norm() + translation(step).norm();
      };
      const double length = 1 + translation(a).norm();
      CHECK(difference(seven) <= 1e-15 * length);
      CHECK(difference(eight) <= 1e-15 * length);
      CHECK(eight.order() == order);
    }
  }
  // [t; q], x, y, z, w
  const auto a = duet::pose(duet::quaternion<double>(.6, .8, 0, 0), vector3(1, 2, 3));
  const auto numbers = stored(duet::pose_block(quaternion_order::xyzw), a);
  const std::array<double, 7> expected{1, 2, 3, .8, 0, 0, .6};
  for (std::size_t i = 0; i < 7; ++i) {
    CHECK(std::abs(numbers[i] - expected[i]) <= 1e-15);
  }
}

struct reprojection_error {
  double u, v;

  template <class T>
  bool operator()(const T* camera, const T* point, T* residuals) const {
    T p[3];
    ceres::AngleAxisRotatePoint(camera, point, p);
    p[0] += camera[3];
    p[1] += camera[4];
    p[2] += camera[5];
    residuals[0] = camera[6] * p[0] / p[2] - u;
    residuals[1] = camera[6] * p[1] / p[2] - v;
    return true;
  }
};

/// All of ceres/rotation.h that takes quaternions and rotation vectors.
struct rotation_functions {
  template <class T>
  void operator()(const T* q, const T* r, T* residuals) const {
    T of_r[4], product[4], matrix[9], angles[3], back[3];
    ceres::AngleAxisToQuaternion(r, of_r);
    ceres::QuaternionProduct(of_r, q, product);
    ceres::QuaternionToAngleAxis(product, residuals);
    ceres::UnitQuaternionRotatePoint(product, r, residuals + 3);
    ceres::AngleAxisToRotationMatrix(r, matrix);
    ceres::RotationMatrixToAngleAxis(matrix, back);
    ceres::CrossProduct(back, residuals, residuals + 6);
    for (int i = 0; i < 3; ++i) {
      angles[i] = T(20. * i) + 30. * r[i];
    }
    ceres::EulerAnglesToRotationMatrix(angles, 3, matrix);
    residuals[9] = ceres::DotProduct(matrix + 3, r);
    ceres::QuaternionRotatePoint(q, r, residuals + 10);
  }
};

/// A functor for both.
template <class F>
struct for_jets : F {
  template <class... P>
  bool operator()(const P&... p) const {
    F::operator()(p...);
    return true;
  }
};

struct distance_of_points { // of two points that coincide in x and y, one of them fixed there
  template <class T>
  bool operator()(const T* a, T* residuals) const {
    using std::sqrt;
    residuals[0] = sqrt((a[0] - 1.) * (a[0] - 1.)) + a[1];
    return true;
  }
};

/// Residuals, then all Jacobian blocks.
std::vector<double> evaluated(const ceres::CostFunction& cost,
                              const std::vector<const double*>& x) {
  std::size_t size = std::size_t(cost.num_residuals()), total = size;
  for (const int block : cost.parameter_block_sizes()) {
    total += size * std::size_t(block);
  }
  std::vector<double> result(total), values(size);
  std::vector<double*> jacobians;
  for (const int block : cost.parameter_block_sizes()) {
    jacobians.push_back(result.data() + size);
    size += values.size() * std::size_t(block);
  }
  REQUIRE(cost.Evaluate(x.data(), result.data(), jacobians.data()));
  // Values alone are the same, and blocks may be left out.
  REQUIRE(cost.Evaluate(x.data(), values.data(), nullptr));
  for (std::size_t i = 0; i < values.size(); ++i) {
    CHECK(std::abs(values[i] - result[i]) <= 1e-14 * (1 + std::abs(values[i])));
  }
  const std::vector<double> before = result;
  std::fill(jacobians.begin(), jacobians.end() - 1, nullptr);
  CHECK(cost.Evaluate(x.data(), values.data(), jacobians.data()));
  CHECK(result == before);
  return result;
}

void check_equal(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
  REQUIRE(a.size() == b.size());
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    worst = std::max(worst, std::abs(a[i] - b[i]) / (1 + std::abs(b[i])));
  }
  CHECK(worst <= tolerance);
}

TEST_CASE("cost_function: functors with ceres/rotation.h give what Jets give") {
  const std::array<double, 7> camera{.1, -.3, .2, 1, 2, 5, 3};
  const std::array<double, 3> point{.4, .7, -.2};
  const reprojection_error f{.2, .1};
  const owned by_duals(duet::cost_function<2, 7, 3>(f)),
      by_jets(
          new ceres::AutoDiffCostFunction<reprojection_error, 2, 7, 3>(new reprojection_error(f)));
  CHECK(by_duals->parameter_block_sizes() == by_jets->parameter_block_sizes());
  const std::vector<const double*> x{camera.data(), point.data()};
  check_equal(evaluated(*by_duals, x), evaluated(*by_jets, x), 1e-14);

  const owned all(duet::cost_function<13, 4, 3>(rotation_functions())),
      all_by_jets(new ceres::AutoDiffCostFunction<for_jets<rotation_functions>, 13, 4, 3>(
          new for_jets<rotation_functions>));
  for (const auto& q : rotations()) {
    const auto numbers = stored(duet::rotation_block(quaternion_order::wxyz), q);
    const std::vector<const double*> y{numbers.data(), point.data()};
    check_equal(evaluated(*all, y), evaluated(*all_by_jets, y), 1e-13);
  }
}

TEST_CASE("cost_function: every kind of block passes Ceres' check of gradients") {
  const auto f = [](const auto& q, const auto& a, const auto& b, const auto& v, const auto& s) {
    const auto p = transform_point(a, rotate(q, v));
    const auto x = transform_point(conj(b), p);
    // no entry of a Jacobian vanishes: the check is relative
    const auto mixed = [&](int k) { return x[k] + .3 * x[(k + 1) % 3] - .7 * x[(k + 2) % 3]; };
    return std::array{s * mixed(0), mixed(1) + s * s, mixed(2) * (p[0] + .4 * p[1] - p[2]),
                      (p.squaredNorm() + mixed(0)) / (1 + s * s)};
  };
  for (const auto order : orders) {
    const duet::rotation_block four(order);
    const duet::pose_block seven(order);
    const duet::dual_quaternion_block eight(order);
    const owned cost(
        duet::cost_function(f, four, seven, eight, duet::vector_block<3>(), duet::number_block()));
    CHECK(cost->num_residuals() == 4);
    CHECK(cost->parameter_block_sizes() == std::vector<int>{4, 7, 8, 3, 1});
    auto q = stored(four, rotations()[9]);
    auto a = stored(seven, poses()[1]);
    auto b = stored(eight, poses()[4]);
    std::array<double, 3> v{.3, .4, -.8};
    double s = 1.2;
    const std::vector<const double*> x{q.data(), a.data(), b.data(), v.data(), &s};
    // without manifolds: the derivatives off the sphere, too
    const std::vector<const ceres::Manifold*>* none = nullptr;
    const ceres::NumericDiffOptions options;
    CHECK(ceres::GradientChecker(cost.get(), none, options).Probe(x.data(), 1e-7, nullptr));
    // with those of Ceres and duet
    const ceres::QuaternionManifold w_first;
    const ceres::EigenQuaternionManifold w_last;
    const duet::pose_manifold of_seven(order);
    const duet::dual_quaternion_manifold of_eight(order);
    const ceres::Manifold* of_four = &w_last;
    if (order == quaternion_order::wxyz) {
      of_four = &w_first;
    }
    const std::vector<const ceres::Manifold*> manifolds{of_four, &of_seven, &of_eight, nullptr,
                                                        nullptr};
    CHECK(ceres::GradientChecker(cost.get(), &manifolds, options).Probe(x.data(), 1e-7, nullptr));
  }
}

TEST_CASE("cost_function: results of every shape") {
  const auto check = [](auto f, int count) {
    const owned cost(duet::cost_function(f, duet::number_block()));
    const double x = 2;
    const auto y = evaluated(*cost, {&x});
    CHECK(cost->num_residuals() == count);
    CHECK(y.size() == 2 * std::size_t(count));
    return y;
  };
  CHECK(check([](const auto& x) { return x * x; }, 1) == std::vector<double>{4, 4});
  CHECK(check(
            [](const auto& x) {
              return std::array{x, 3 * x};
            },
            2) == std::vector<double>{2, 6, 1, 3});
  CHECK(check([](const auto& x) { return Eigen::Matrix<std::decay_t<decltype(x)>, 2, 1>(x, 1); },
              2) == std::vector<double>{2, 1, 1, 0});
  CHECK(check([](const auto&) { return 7.; }, 1) == std::vector<double>{7, 0}); // a constant
  // derivatives inside
  CHECK(check(
            [](const auto& x) {
              return duet::derivative([&](const auto& y) { return x * y * y; }, x).derivative;
            },
            1) == std::vector<double>{8, 8}); // 2 x²
}

TEST_CASE("cost_function: finite where Jets are NaN") {
  const std::array<double, 2> a{1, 2};
  double value = 0;
  std::array<double, 2> by_duals{}, by_jets{};
  double* duals = by_duals.data();
  double* jets = by_jets.data();
  const double* x = a.data();
  const owned duet_cost(duet::cost_function<1, 2>(distance_of_points())),
      ceres_cost(new ceres::AutoDiffCostFunction<distance_of_points, 1, 2>(new distance_of_points));
  CHECK(duet_cost->Evaluate(&x, &value, &duals));
  CHECK(value == 2);
  CHECK(by_duals == std::array<double, 2>{0, 1});
  CHECK(ceres_cost->Evaluate(&x, &value, &jets));
  CHECK(std::isnan(by_jets[0]));
}

TEST_CASE("cost_function: false instead of exceptions") {
  const auto f = [](const auto& x) {
    if (x > 1) {
      throw duet::invalid_input("too large");
    }
    return x;
  };
  const owned cost(duet::cost_function(f, duet::number_block()));
  double x = .5, residual = 0, jacobian = 0;
  const double* block = &x;
  double* out = &jacobian;
  CHECK(cost->Evaluate(&block, &residual, &out));
  x = 2;
  CHECK_FALSE(cost->Evaluate(&block, &residual, &out));
  CHECK_FALSE(cost->Evaluate(&block, &residual, nullptr));

  const owned of_rotation(duet::cost_function([](const auto& q) { return q.x(); },
                                              duet::rotation_block(quaternion_order::wxyz)));
  const std::array<double, 4> zero{};
  block = zero.data();
  CHECK_FALSE(of_rotation->Evaluate(&block, &residual, nullptr));

  const owned functor(duet::cost_function<1, 1>([](const auto* a, auto* r) {
    r[0] = a[0];
    return a[0] < 1;
  }));
  block = &x;
  CHECK_FALSE(functor->Evaluate(&block, &residual, nullptr));
  CHECK_FALSE(functor->Evaluate(&block, &residual, &out));
}

} // namespace
} // namespace test_interop_ceres
