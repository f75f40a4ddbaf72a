// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/core/errors.hpp>
#include <duet/core/random_source.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/interop/ceres.hpp>
#include <duet/interop/ceres_curves.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/split_bspline.hpp>

#include <Eigen/Core>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <memory>
#include <thread>

#include "support/test.hpp"

// Residuals of curves for Ceres: against dual numbers through whole curves, by formulas of their
// own, and in problems with known solutions.

namespace test_interop_ceres_curves {
namespace {

using duet::quaternion_order;
using screw = duet::screw_dual<double>;
using vector3 = duet::vector3<double>;
using rotation = duet::quaternion<double>;
using number = duet::dual<double>;
using owned = std::unique_ptr<ceres::CostFunction>;
using duet::measurement_time;

const double infinity = std::numeric_limits<double>::infinity();

/// Uneven knots with control points a given angle apart.
struct scene {
  std::vector<double> knots;
  std::vector<rotation> rotations;
  std::vector<vector3> positions;

  explicit scene(double step, double distance = 0) {
    for (int i = 0; i < 16; ++i) {
      knots.push_back(.3 * i + .01 * i * i);
    }
    rotations.emplace_back(1.);
    for (int i = 0; i < 12; ++i) {
      const vector3 axis = vector3(std::sin(i), std::cos(2. * i), .3).normalized();
      rotations.push_back(rotations.back() * duet::from_rotation_vector(vector3(step * axis)));
      positions.emplace_back(distance + step * std::sin(i), .3 * step * i - distance,
                             std::cos(.5 * i));
    }
    rotations.erase(rotations.begin());
  }
  [[nodiscard]] std::vector<duet::dual_quaternion<double>> poses() const {
    std::vector<duet::dual_quaternion<double>> result;
    for (std::size_t i = 0; i < rotations.size(); ++i) {
      result.push_back(duet::pose(rotations[i], positions[i]));
    }
    return result;
  }
  [[nodiscard]] auto rotation_curve() const {
    return duet::cumulative_bspline<double>(knots, rotations);
  }
  [[nodiscard]] auto pose_curve() const { return duet::cumulative_bspline<screw>(knots, poses()); }
  [[nodiscard]] auto split_curve() const {
    return duet::split_bspline<double>(duet::bspline_basis<4>(knots), rotations, positions);
  }
};

/// Reads numbers in memory as dual numbers; one of them is the variable.
struct reader {
  const double* variable;

  number operator()(const double& x) const {
    return &x == variable ? number::variable(x) : number(x);
  }
  [[nodiscard]] duet::vector3<number> vector(const double* x) const {
    return {(*this)(x[0]), (*this)(x[1]), (*this)(x[2])};
  }
  [[nodiscard]] duet::quaternion<number> rotation(const double* x, quaternion_order order) const {
    const std::array<number, 4> q{(*this)(x[0]), (*this)(x[1]), (*this)(x[2]), (*this)(x[3])};
    return normalized(duet::load_quaternion(q.data(), order));
  }
};

/// Motion in fixed axes.
struct reference_motion {
  duet::quaternion<number> q;
  duet::vector3<number> p, p_ddot, omega, alpha;
};

/// Parameter blocks of all kinds, and the motion by whole curves over dual numbers.
struct parameter_memory {
  const scene& data;
  quaternion_order order;
  double offset = .03;
  std::array<double, 3> bias{.1, -.2, .3}, gravity{.1, .2, -9.8}, point{.3, -.4, .5};
  std::array<double, 7> sensor{};
  std::vector<std::array<double, 4>> rotations{};
  std::vector<std::array<double, 7>> poses{};
  std::vector<std::array<double, 3>> positions{};

  parameter_memory(const scene& from, quaternion_order storage_order)
      : data(from), order(storage_order) {
    const duet::pose_block block(order);
    block.store(duet::pose(duet::from_rotation_vector(vector3(.3, -.4, 2.5)), vector3(.1, .2, -.3)),
                sensor.data());
    for (std::size_t i = 0; i < from.rotations.size(); ++i) {
      duet::store_quaternion(from.rotations[i], rotations.emplace_back().data(), order);
      block.store(duet::pose(from.rotations[i], from.positions[i]), poses.emplace_back().data());
      positions.push_back({from.positions[i][0], from.positions[i][1], from.positions[i][2]});
      for (int k = 0; k < 4; ++k) { // quaternions need not be of norm 1
        rotations[i][std::size_t(k)] *= 1 + .01 * double(i);
        poses[i][std::size_t(3 + k)] *= 1 + .01 * double(i);
      }
    }
  }
  template <class Blocks>
  static std::vector<double*> pointers(Blocks& blocks) {
    std::vector<double*> result;
    for (auto& each : blocks) {
      result.push_back(each.data());
    }
    return result;
  }
  auto rotation_blocks() {
    return duet::curve_blocks<double>(duet::bspline_basis<4>(data.knots), pointers(rotations),
                                      order);
  }
  auto pose_blocks() {
    return duet::curve_blocks<screw>(duet::bspline_basis<4>(data.knots), pointers(poses), order);
  }
  auto split_blocks() {
    return duet::split_curve_blocks<4>(duet::bspline_basis<4>(data.knots), pointers(rotations),
                                       pointers(positions), order);
  }

  template <class Curve>
  [[nodiscard]] reference_motion motion(const Curve&, const number& u, const reader& read) const {
    reference_motion result;
    const duet::vector3<number> none = duet::vector3<number>::Zero();
    if constexpr (std::is_same_v<Curve, duet::curve_blocks<screw>>) {
      std::vector<duet::dual_quaternion<number>> controls;
      for (const auto& x : poses) {
        controls.push_back(duet::pose(read.rotation(x.data() + 3, order), read.vector(x.data())));
      }
      const duet::cumulative_bspline<duet::screw_dual<number>> s(duet::bspline_basis<4>(data.knots),
                                                                 controls);
      const auto m = s.motion(u, duet::frame::hybrid);
      result = {duet::rotation(m.value), duet::translation(m.value), m.acceleration.head<3>(),
                m.velocity.tail<3>(), m.acceleration.tail<3>()};
    } else {
      std::vector<duet::quaternion<number>> controls;
      for (const auto& x : rotations) {
        controls.push_back(read.rotation(x.data(), order));
      }
      const duet::cumulative_bspline<number> s(duet::bspline_basis<4>(data.knots), controls);
      const auto m = s.motion(u, duet::frame::spatial);
      result = {m.value, none, none, m.velocity, m.acceleration};
      if constexpr (Curve::has_positions) {
        const duet::bspline_basis<4> basis(data.knots);
        const std::size_t span = basis.find_span(u.value()), first = basis.first_function(span);
        const auto b = basis.weights<2>(span, u);
        result.p = read.vector(positions[first].data());
        for (std::size_t i = 0; i < 3; ++i) {
          const duet::vector3<number> step = read.vector(positions[first + i + 1].data()) -
                                             read.vector(positions[first + i].data());
          result.p += b[0][i] * step;
          result.p_ddot += b[2][i] * step;
        }
      }
    }
    return result;
  }
};

using residuals = std::vector<number>;

residuals listed(const Eigen::Matrix<number, Eigen::Dynamic, 1>& x) { return {x.begin(), x.end()}; }

/// Largest error of residuals and Jacobians by a cost function, relative to the largest entry of
/// the block.
double error_of(ceres::CostFunction* made, const std::vector<double*>& blocks,
                const std::function<residuals(const reader&)>& reference) {
  const owned cost(made);
  REQUIRE(cost->parameter_block_sizes().size() == blocks.size());
  const std::size_t rows = std::size_t(cost->num_residuals());
  std::vector<std::vector<double>> memory;
  std::vector<double*> jacobians;
  for (const int size : cost->parameter_block_sizes()) {
    jacobians.push_back(memory.emplace_back(rows * std::size_t(size), infinity).data());
  }
  std::vector<double> values(rows), alone(rows);
  REQUIRE(cost->Evaluate(blocks.data(), values.data(), jacobians.data()));
  REQUIRE(cost->Evaluate(blocks.data(), alone.data(), nullptr));
  const auto expected_values = reference(reader{nullptr});
  REQUIRE(expected_values.size() == rows);
  double worst = 0;
  for (std::size_t i = 0; i < rows; ++i) {
    const double expected = expected_values[i].value(), scale = 1 + std::abs(expected);
    worst = std::max(
        {worst, std::abs(values[i] - expected) / scale, std::abs(alone[i] - expected) / scale});
  }
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const std::size_t size = std::size_t(cost->parameter_block_sizes()[b]);
    double error = 0, scale = 1;
    for (std::size_t k = 0; k < size; ++k) {
      const auto column = reference(reader{blocks[b] + k});
      for (std::size_t i = 0; i < rows; ++i) {
        const double expected = column[i].epsilon();
        error = std::max(error, std::abs(memory[b][i * size + k] - expected));
        scale = std::max(scale, std::abs(expected));
      }
    }
    worst = std::max(worst, error / scale);
  }
  return worst;
}

/// Errors of all residuals of a kind of curve.
template <class Curve>
double largest_error(parameter_memory& x, const Curve& curve, const measurement_time& when) {
  const duet::pose_block block(x.order);
  const duet::rotation_block of_rotation(x.order);
  const auto motion = [&](const reader& read) {
    return x.motion(curve, number(when.time()) + (when.has_offset() ? read(x.offset) : number(0)),
                    read);
  };
  const auto blocks = [&](std::vector<double*> more) {
    if (when.has_offset()) {
      more.insert(more.begin(), &x.offset);
    }
    return curve.blocks(when, more);
  };
  const rotation q = duet::from_rotation_vector(vector3(.4, 1, -.7));
  const vector3 measured(.3, -1, 2);
  double worst =
      error_of(orientation_residual(curve, when, -q), blocks({}), [&](const reader& read) {
        return listed(rotation_vector(conj(q) * motion(read).q));
      });
  worst = std::max(worst, error_of(point_residual(curve, when, measured), blocks({x.point.data()}),
                                   [&](const reader& read) {
                                     const auto m = motion(read);
                                     return listed(rotate(m.q, read.vector(x.point.data())) + m.p -
                                                   measured.cast<number>());
                                   }));
  const auto gyroscope = [&](const reader& read) {
    const auto m = motion(read);
    const auto to_body = read.rotation(x.sensor.data() + 3, x.order);
    return listed(rotate(conj(to_body) * conj(m.q), m.omega) + read.vector(x.bias.data()) -
                  measured.cast<number>());
  };
  worst = std::max({worst,
                    error_of(gyroscope_residual(curve, when, measured, block),
                             blocks({x.bias.data(), x.sensor.data()}), gyroscope),
                    error_of(gyroscope_residual(curve, when, measured, of_rotation),
                             blocks({x.bias.data(), x.sensor.data() + 3}), gyroscope)});
  if constexpr (Curve::has_positions) {
    const auto target = duet::pose(q, measured);
    const duet::matrix3<double> weights{{1, .2, .3}, {0, 2, .5}, {-.4, .1, .7}};
    worst = std::max(
        {worst,
         error_of(
             position_residual(curve, when, measured), blocks({}),
             [&](const reader& read) { return listed(motion(read).p - measured.cast<number>()); }),
         error_of(pose_residual(curve, when, -target), blocks({}),
                  [&](const reader& read) {
                    const auto m = motion(read);
                    auto step = conj(target) * duet::pose(m.q, m.p);
                    if (innermost(step.w()) < 0) {
                      step = -step;
                    }
                    return listed(2 * duet::twist_of(duet::log(step).vec()));
                  }),
         error_of(accelerometer_residual(curve, when, measured, block, weights),
                  blocks({x.bias.data(), x.sensor.data(), x.gravity.data()}),
                  [&](const reader& read) {
                    const auto m = motion(read);
                    const auto to_body = read.rotation(x.sensor.data() + 3, x.order);
                    const duet::vector3<number> arm = rotate(m.q, read.vector(x.sensor.data()));
                    const duet::vector3<number> force = m.p_ddot + m.alpha.cross(arm) +
                                                        m.omega.cross(m.omega.cross(arm)) -
                                                        read.vector(x.gravity.data());
                    return listed(weights.cast<number>() *
                                  (rotate(conj(to_body) * conj(m.q), force) +
                                   read.vector(x.bias.data()) - measured.cast<number>()));
                  })});
  }
  return worst;
}

TEST_CASE("curve residuals: Jacobians agree with dual numbers through the whole curve") {
  // steps from nearly none to nearly half turns; times on several spans, near knots and at ends
  std::size_t count = 0;
  for (const double step : {1e-7, 1.2, std::numbers::pi - 1e-6}) {
    const scene data(step);
    const double begin = data.knots[3], end = data.knots[12];
    for (const auto& each : {std::pair(begin + .4, .03), std::pair(2.2, -.2),
                             std::pair(end - .01, 0.), std::pair(2.2, .99)}) {
      CAPTURE(step);
      CAPTURE(each.first);
      const bool is_w_first = (count + count / 4) % 2 == 0; // both orders at all times
      ++count;
      parameter_memory x(data, is_w_first ? quaternion_order::wxyz : quaternion_order::xyzw);
      x.offset = each.second;
      const measurement_time when(each.first, each.second == 0 ? 0 : 1.);
      CHECK(largest_error(x, x.rotation_blocks(), when) <= 2e-12);
      CHECK(largest_error(x, x.pose_blocks(), when) <= 2e-12);
      CHECK(largest_error(x, x.split_blocks(), when) <= 2e-12);
    }
  }
}

TEST_CASE("curve residuals: far from the origin errors grow with the distance alone") {
  const double distance = 1e6;
  const scene data(.7, distance);
  parameter_memory x(data, quaternion_order::xyzw);
  const measurement_time when(2.2, .3);
  CHECK(largest_error(x, x.pose_blocks(), when) <= 2e-14 * distance);
  CHECK(largest_error(x, x.split_blocks(), when) <= 2e-14 * distance);
}

TEST_CASE("curve residuals: control points of all spans within the offset, zero if not active") {
  const scene data(.5);
  parameter_memory x(data, quaternion_order::wxyz);
  const auto curve = x.rotation_blocks();
  const measurement_time when(2.2, .5); // knots 1.36, 1.75, 2.16, 2.59, 3.04
  const auto blocks = curve.blocks(when, {&x.offset});
  CHECK(blocks.size() == 4 + 3 + 1);
  const owned cost(orientation_residual(curve, when, rotation(1.)));
  REQUIRE(cost->parameter_block_sizes() == std::vector<int>{4, 4, 4, 4, 4, 4, 4, 1});
  const auto jacobians_at = [&](double offset) {
    x.offset = offset;
    std::array<std::array<double, 12>, 8> memory;
    std::array<double*, 8> pointers;
    for (std::size_t i = 0; i < 8; ++i) {
      memory[i].fill(infinity);
      pointers[i] = memory[i].data();
    }
    std::array<double, 3> residual;
    REQUIRE(cost->Evaluate(blocks.data(), residual.data(), pointers.data()));
    std::array<bool, 7> is_zero;
    for (std::size_t i = 0; i < 7; ++i) {
      is_zero[i] = std::all_of(memory[i].begin(), memory[i].end(), [](double d) { return d == 0; });
    }
    return is_zero;
  };
  CHECK(jacobians_at(-.5) == std::array{false, false, false, false, true, true, true});
  CHECK(jacobians_at(0) == std::array{true, true, false, false, false, false, true});
  CHECK(jacobians_at(.5) == std::array{true, true, true, false, false, false, false});
}

TEST_CASE("curve residuals: false beyond max_offset, outside the domain and for wrong signs") {
  const scene data(.5);
  parameter_memory x(data, quaternion_order::xyzw);
  const auto curve = x.rotation_blocks();
  std::array<double, 3> residual;
  const auto is_evaluated = [&](const measurement_time& when, double offset) {
    x.offset = offset;
    const owned cost(orientation_residual(curve, when, rotation(1.)));
    return cost->Evaluate(curve.blocks(when, {&x.offset}).data(), residual.data(), nullptr);
  };
  CHECK(is_evaluated({2.2, .1}, .1));
  CHECK(is_evaluated({2.2, .1}, -.1));
  CHECK_FALSE(is_evaluated({2.2, .1}, std::nextafter(.1, 1)));
  CHECK_FALSE(is_evaluated({2.2, .1}, std::nan("")));
  const double end = data.knots[12];
  CHECK(is_evaluated({end, .1}, 0));
  CHECK(is_evaluated({end, .1}, -.1));
  CHECK_FALSE(is_evaluated({end, .1}, .01));
  CHECK_FALSE(is_evaluated({data.knots[3], .1}, -.01));

  auto& third = x.rotations[5];
  for (double& each : third) {
    each = -each;
  }
  CHECK_FALSE(is_evaluated({2.2, .1}, 0));
  third = {0, 0, 0, 0};
  CHECK_FALSE(is_evaluated({2.2, .1}, 0));
  third[0] = std::nan("");
  CHECK_FALSE(is_evaluated({2.2, .1}, 0));
}

TEST_CASE("curve residuals: errors of construction say what is wrong") {
  const scene data(.5);
  parameter_memory x(data, quaternion_order::wxyz);
  const auto curve = x.rotation_blocks();
  const rotation one(1.);
  CHECK_THROWS_WITH_AS((void)orientation_residual(curve, .5, one),
                       "duet: curve residual: the time is 0.5, outside the domain of the curve, "
                       "0.99 to 5.04",
                       duet::invalid_input);
  CHECK_THROWS_AS((void)orientation_residual(curve, std::nan(""), one), duet::invalid_input);
  CHECK_THROWS_WITH_AS((void)orientation_residual(curve, {2, -1}, one),
                       "duet: curve residual: max_offset is -1 (expected a finite number that is "
                       "not negative)",
                       duet::invalid_input);
  CHECK_THROWS_AS((void)curve.blocks({2, infinity}), duet::invalid_input);
  CHECK_THROWS_WITH_AS(duet::curve_blocks<double>(duet::bspline_basis<4>(data.knots),
                                                  {x.rotations[0].data()}, x.order),
                       "duet: curve blocks: 16 knots of order 4 need 12 control points, got 1",
                       duet::invalid_input);
  for (double& each : x.rotations[5]) {
    each = -each;
  }
  CHECK_THROWS_WITH_AS(x.rotation_blocks(),
                       "duet: sample 5: its sign is not aligned with that of the control point "
                       "before (negate it)",
                       duet::invalid_sample);
  CHECK_THROWS_AS(x.split_blocks(), duet::invalid_sample);
  for (std::size_t k = 3; k < 7; ++k) {
    x.poses[7][k] = -x.poses[7][k];
  }
  CHECK_THROWS_AS(x.pose_blocks(), duet::invalid_sample);
  x.rotations[5] = {};
  CHECK_THROWS_AS(x.rotation_blocks(), duet::invalid_input);
}

TEST_CASE("curve_blocks: memory of a curve, shared by copies") {
  const scene data(.5);
  const auto original = data.rotation_curve();
  const auto poses = data.pose_curve();
  const auto split = data.split_curve();
  const duet::curve_blocks<double> blocks(original, quaternion_order::xyzw);
  const duet::curve_blocks<screw> pose_blocks(poses);
  const duet::split_curve_blocks<4> split_blocks(split);
  const double u = 2.2;
  CHECK(rotation_vector(conj(original(u)) * blocks.curve()(u)).norm() <= 1e-15);
  const auto step = conj(poses(u)) * pose_blocks.curve()(u);
  CHECK(rotation_vector(rotation(step)).norm() + translation(step).norm() <= 1e-14);
  const auto a = split.motion_jacobian<0>(u, duet::frame::body),
             b = split_blocks.curve().motion_jacobian<0>(u, duet::frame::body);
  CHECK((a.position - b.position).norm() <= 1e-14);
  const auto copy = blocks;
  double* const x = copy.blocks(u)[1];
  CHECK(x == blocks.blocks(u)[1]);
  x[0] += .1; // x of a quaternion
  CHECK(rotation_vector(conj(original(u)) * blocks.curve()(u)).norm() >= .01);

  ceres::Problem problem;
  split_blocks.add_to(problem);
  blocks.add_to(problem, true);
  CHECK(problem.NumParameterBlocks() == 3 * 12);
  CHECK(problem.ParameterBlockTangentSize(split_blocks.blocks(u).front()) == 3);
  CHECK(problem.ParameterBlockSize(split_blocks.blocks(u).front()) == 4);
  CHECK(problem.ParameterBlockSize(split_blocks.blocks(u).back()) == 3);
  CHECK_FALSE(problem.IsParameterBlockConstant(split_blocks.blocks(u).back()));
  CHECK(problem.IsParameterBlockConstant(x));
}

ceres::Solver::Summary solved(ceres::Problem& problem, int threads = 1) {
  ceres::Solver::Options options;
  options.function_tolerance = options.parameter_tolerance = options.gradient_tolerance = 1e-16;
  options.max_num_iterations = 100;
  options.num_threads = threads;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary;
}

TEST_CASE("curve residuals: threads evaluate the same object") {
  const scene data(.6);
  parameter_memory x(data, quaternion_order::wxyz);
  const auto curve = x.pose_blocks();
  const measurement_time when(2.2, .5);
  const auto blocks =
      curve.blocks(when, {&x.offset, x.bias.data(), x.sensor.data(), x.gravity.data()});
  const owned cost(
      accelerometer_residual(curve, when, vector3(1, 2, 3), duet::pose_block(x.order)));
  const auto evaluated = [&](double offset) {
    auto own = blocks;
    own[own.size() - 4] = &offset;
    std::vector<double> result(3 + 3 * 7 * blocks.size());
    std::vector<double*> jacobians;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      jacobians.push_back(result.data() + 3 + 21 * i);
    }
    result.push_back(double(cost->Evaluate(own.data(), result.data(), jacobians.data())));
    return result;
  };
  std::array<std::vector<double>, 4> expected;
  for (std::size_t i = 0; i < 4; ++i) {
    expected[i] = evaluated(.1 * double(i));
    CHECK(expected[i].back() == 1);
  }
  std::array<int, 4> different{};
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < 4; ++i) {
    threads.emplace_back([&, i] {
      for (int k = 0; k < 200; ++k) {
        different[i] += evaluated(.1 * double(i)) != expected[i] ? 1 : 0;
      }
    });
  }
  for (auto& each : threads) {
    each.join();
  }
  CHECK(different == std::array<int, 4>{});
}

TEST_CASE("curve residuals: an inertial sensor and a camera calibrate pose and split curves") {
  // Positions of two points of the body and an inertial sensor determine the curve, the pose of the
  // sensor, its biases, its offset in time and the direction of gravity.
  const scene data(.3);
  const auto check = [&](const auto& truth_blocks, auto curve) {
    parameter_memory x(data, quaternion_order::wxyz);
    const duet::pose_block block(quaternion_order::wxyz);
    const auto truth = truth_blocks;
    const auto sensor = block.load(x.sensor.data());
    const double true_offset = .07;
    std::array<double, 3> true_accelerometer_bias{.05, .02, -.03};
    // Noise-free measurements are minus the residuals of zero at the truth.
    const auto reading = [&](ceres::CostFunction* made, std::vector<double*> blocks) {
      const owned cost(made);
      std::vector<double> residual(std::size_t(cost->num_residuals()));
      REQUIRE(cost->Evaluate(blocks.data(), residual.data(), nullptr));
      return vector3(residual.data());
    };
    ceres::Problem problem;
    double offset = 0;
    std::array<double, 3> gyroscope_bias{}, accelerometer_bias{}, gravity{0, 0, -9.7};
    std::array<double, 7> pose_of_sensor;
    block.store(sensor * duet::exp(duet::make_dual_vector(vector3(.05, .02, -.04),
                                                          vector3(.02, -.01, .03))),
                pose_of_sensor.data());
    curve.add_to(problem);
    const vector3 zero = vector3::Zero();
    std::array<std::array<double, 3>, 3> points{{{.3, .1, -.2}, {-.4, .5, .2}, {.1, -.6, .5}}};
    for (int i = 0; i < 120; ++i) {
      const double time = 1.1 + .032 * i;
      const measurement_time when(time, .1);
      double exact = true_offset;
      problem.AddResidualBlock(
          gyroscope_residual(curve, when,
                             reading(gyroscope_residual(truth, when, zero, block),
                                     truth.blocks(when, {&exact, x.bias.data(), x.sensor.data()})),
                             block),
          nullptr, curve.blocks(when, {&offset, gyroscope_bias.data(), pose_of_sensor.data()}));
      problem.AddResidualBlock(
          accelerometer_residual(curve, when,
                                 reading(accelerometer_residual(truth, when, zero, block),
                                         truth.blocks(when, {&exact, true_accelerometer_bias.data(),
                                                             x.sensor.data(), x.gravity.data()})),
                                 block),
          nullptr,
          curve.blocks(
              when, {&offset, accelerometer_bias.data(), pose_of_sensor.data(), gravity.data()}));
      for (auto& point : points) {
        problem.AddResidualBlock(point_residual(curve, time,
                                                reading(point_residual(truth, time, zero),
                                                        truth.blocks(time, {point.data()}))),
                                 nullptr, curve.blocks(time, {point.data()}));
        problem.SetParameterBlockConstant(point.data());
      }
    }
    problem.SetParameterLowerBound(&offset, 0, -.1);
    problem.SetParameterUpperBound(&offset, 0, .1);
    problem.SetManifold(pose_of_sensor.data(), new duet::pose_manifold(quaternion_order::wxyz));
    const auto summary = solved(problem, 2);
    CHECK(summary.initial_cost > .1);
    CHECK(summary.final_cost <= 1e-20);
    CHECK(std::abs(offset - true_offset) <= 1e-9);
    const auto error = conj(sensor) * block.load(pose_of_sensor.data());
    CHECK(rotation_vector(rotation(error)).norm() <= 1e-8);
    CHECK(translation(error).norm() <= 1e-8);
    CHECK((vector3(gravity.data()) - vector3(x.gravity.data())).norm() <= 1e-8);
    CHECK((vector3(gyroscope_bias.data()) - vector3(x.bias.data())).norm() <= 1e-8);
    CHECK((vector3(accelerometer_bias.data()) - vector3(true_accelerometer_bias.data())).norm() <=
          1e-8);
  };
  // The start is a copy of the truth whose control points are moved.
  const auto moved = [](auto curve) {
    duet::random_source random(4);
    for (const double time : {1., 2.5, 4., 5.}) {
      for (double* x : curve.blocks(time)) {
        for (int k = 0; k < 3; ++k) {
          x[k] += .02 * random.normal();
        }
      }
    }
    return curve;
  };
  check(duet::curve_blocks<screw>(data.pose_curve()),
        moved(duet::curve_blocks<screw>(data.pose_curve())));
  check(duet::split_curve_blocks<4>(data.split_curve()),
        moved(duet::split_curve_blocks<4>(data.split_curve())));
}

TEST_CASE("curve_residual: any function of the motion") {
  // the image of a fixed landmark in a camera on the body, with an unknown focal length
  const scene data(.3);
  parameter_memory x(data, quaternion_order::xyzw);
  std::array<double, 3> landmark{.3, 2, 9};
  double focal_length = 1.7;
  const measurement_time when(2.2, .1);
  const auto check = [&](const auto& curve) {
    const auto cost = duet::curve_residual<2>(
        curve, when,
        []<class S>(const duet::body_motion<S>& m, const duet::vector3<S>& p, const S& f) {
          const duet::vector3<S> y = rotate(conj(m.rotation), duet::vector3<S>(p - m.position));
          const duet::vector3<S> rates = m.velocity + m.acceleration;
          return std::array<S, 3>{f * y[0] / y[2], f * y[1] / y[2], rates.dot(p)};
        },
        duet::vector_block<3>(), duet::number_block());
    CHECK(cost->num_residuals() == 3);
    CHECK(error_of(
              cost, curve.blocks(when, {&x.offset, landmark.data(), &focal_length}),
              [&](const reader& read) {
                const number u = when.time() + read(x.offset);
                // velocities by dual numbers of another kind
                struct in_time;
                const auto m = x.motion(curve, u, read);
                const auto p = read.vector(landmark.data());
                const duet::vector3<number> y = rotate(conj(m.q), duet::vector3<number>(p - m.p));
                const number h(1e-3);
                const auto at = [&](int k) { return x.motion(curve, number(u + k * h), read).p; };
                const duet::vector3<number> velocity =
                    (45 * (at(1) - at(-1)) - 9 * (at(2) - at(-2)) + (at(3) - at(-3))) / (60 * h);
                const duet::vector3<number> rates =
                    rotate(conj(m.q), duet::vector3<number>(velocity + m.p_ddot));
                return residuals{read(focal_length) * y[0] / y[2], read(focal_length) * y[1] / y[2],
                                 rates.dot(p)};
              }) <= 1e-11);
  };
  check(x.pose_blocks());
  check(x.split_blocks());
}

} // namespace
} // namespace test_interop_ceres_curves
