// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/identical.hpp"
#include "support/multiprecision.hpp"
#include "support/random.hpp"
#include "support/shared_tag.hpp"
#include "support/test.hpp"

#include <duet/derivative/gradient.hpp>
#include <duet/kinematics/closest_points.hpp>

#include <Eigen/Geometry>

namespace test_kinematics_closest_points {
namespace {

using namespace duet;
using duet_test::real_50;
using vector = Eigen::Vector3d;

vector point(duet_test::random_source& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

dual_quaternion<double> random_pose(duet_test::random_source& random) {
  return pose(from_rotation_vector(point(random, 3)), point(random, 1));
}

// Signed distances of a point, each by another formula than in the library.

double reference(const sphere<>& s, const vector& x) { return (x - s.centre).norm() - s.radius; }
double reference(const half_space<>& h, const vector& x) {
  return (x - h.offset * h.normal).dot(h.normal);
}
double reference(const box<>& b, const vector& x) {
  const Eigen::Matrix3d r = rotation_matrix(rotation(b.pose));
  const vector local = r.transpose() * (x - translation(b.pose));
  const vector inside = local.cwiseMin(b.half_extents).cwiseMax(-b.half_extents);
  if (inside != local) {
    return (local - inside).norm();
  }
  // Distances to the planes of the six faces.
  return -std::min((b.half_extents - local).minCoeff(), (b.half_extents + local).minCoeff());
}

double reference(const capsule<>& c, const vector& x) {
  const vector along = c.to - c.from;
  const double t = along.norm() == 0 ? 0 : (x - c.from).dot(along) / along.squaredNorm();
  return (c.from + std::clamp(t, 0.0, 1.0) * along - x).norm() - c.radius;
}

/// Minimum of a convex function on [0, 1], by ternary search.
template <class F>
double minimum(F&& f) {
  double low = 0, high = 1;
  for (int i = 0; i < 90; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    (f(a) < f(b) ? high : low) = f(a) < f(b) ? b : a;
  }
  return std::min({f(0), f(1), f((low + high) / 2)});
}

template <class Obstacle>
void check(const capsule<>& c, const Obstacle& obstacle) {
  const auto p = closest_points(c, obstacle);
  const vector along = c.to - c.from;
  const double expected =
      minimum([&](double t) { return reference(obstacle, vector(c.from + t * (c.to - c.from))); }) -
      c.radius;
  const double scale = 1 + c.from.norm() + along.norm();
  CHECK(std::abs(p.distance - expected) < 1e-14 * scale);
  CHECK(std::abs(p.normal.norm() - 1) < 1e-14);
  CHECK((p.on_obstacle + p.distance * p.normal - p.on_body).norm() < 1e-14 * scale);
  CHECK(std::abs(reference(obstacle, p.on_obstacle)) < 1e-14 * scale);
  // The body's point is one radius from its axis.
  const vector x = p.on_body + c.radius * p.normal;
  const double t = along.norm() == 0 ? 0 : (x - c.from).dot(along) / along.squaredNorm();
  CHECK((c.from + std::clamp(t, 0.0, 1.0) * along - x).norm() < 1e-14 * scale);
}

template <class F>
void for_each_obstacle(duet_test::random_source& random, F&& f) {
  f(sphere<>{point(random, 1), random.uniform(0, 1)});
  f(box<>{random_pose(random), point(random, 1).cwiseAbs()});
  f(box<>{random_pose(random), vector(random.uniform(0, 1), 0, random.uniform(0, .01))}); // a plate
  f(half_space<>{point(random, 1).normalized(), random.uniform(-1, 1)});
  f(capsule<>(point(random, 1), point(random, 1), random.uniform(0, .3)));
}

capsule<real_50> with_50_digits(const capsule<>& c) {
  return {c.from.cast<real_50>(), c.to.cast<real_50>(), c.radius};
}

/// Two capsules both ways round: as far from each other as at 50 digits, where at no parameters of
/// a grid, nor near the computed ones, any pair of points is nearer.
void check_with_50_digits(const capsule<>& a, const capsule<>& b) {
  const double scale = 1 + a.from.norm() + a.to.norm() + b.from.norm() + b.to.norm();
  const auto c = with_50_digits(a), d = with_50_digits(b);
  const auto exact = closest_points(c, d);
  const real_50 swapped = closest_points(d, c).distance;
  CHECK(abs(real_50(swapped - exact.distance)) < 1e-45 * scale);
  CHECK(abs(real_50(closest_points(a, b).distance - exact.distance)) < 2e-15 * scale);
  CHECK(abs(real_50(closest_points(b, a).distance - exact.distance)) < 2e-15 * scale);
  const auto distance_at = [&](const real_50& s, const real_50& t) {
    return real_50((c.from + s * (c.to - c.from) - d.from - t * (d.to - d.from)).norm() - c.radius -
                   d.radius);
  };
  for (int i = 0; i <= 8; ++i) {
    for (int k = 0; k <= 8; ++k) {
      CHECK(distance_at(real_50(i) / 8, real_50(k) / 8) - exact.distance > -1e-45 * scale);
    }
  }
  const vector3<real_50> u = c.to - c.from, v = d.to - d.from;
  const auto parameter = [](const vector3<real_50>& x, const vector3<real_50>& from,
                            const vector3<real_50>& along) {
    const real_50 square = along.squaredNorm();
    return square == 0 ? real_50(0) : real_50((x - from).dot(along) / square);
  };
  const real_50 s = parameter(exact.on_body + c.radius * exact.normal, c.from, u);
  const real_50 t = parameter(exact.on_obstacle - d.radius * exact.normal, d.from, v);
  for (const double step : {1e-3, 1e-8, 1e-15}) {
    for (const int i : {-1, 0, 1}) {
      for (const int k : {-1, 0, 1}) {
        const real_50 x = s + i * step, y = t + k * step;
        if (x >= 0 && x <= 1 && y >= 0 && y <= 1) {
          CHECK(distance_at(x, y) - exact.distance > -1e-45 * scale);
        }
      }
    }
  }
}

TEST_CASE("closest_points: capsules and obstacles agree with a numerical search") {
  duet_test::random_source random(1);
  for (int k = 0; k < 150; ++k) {
    const double length = k % 3 == 0 ? 3 : random.log_uniform(1e-9, 1);
    const vector from = point(random, 1.5);
    const capsule<> c(from, vector(from + point(random, length)), k % 2 == 0 ? 0 : .2);
    for_each_obstacle(random, [&](const auto& obstacle) { check(c, obstacle); });
  }
}

TEST_CASE("closest_points: capsule axes in degenerate positions relative to a box") {
  duet_test::random_source random(2);
  for (const auto& where : {pose(quaternion<double>(1), vector(0, 0, 0)), random_pose(random)}) {
    const box<> b{where, vector(.5, 1, 2)};
    const auto at = [&](double x, double y, double z) {
      return transform_point(where, vector(x, y, z));
    };
    const auto run = [&](const vector& from, const vector& to) {
      check(capsule<>(from, to, .1), b);
      check(capsule<>(to, from, .1), b);
      check(capsule<>(from, from, 0), b);
    };
    run(at(1, 0, -1), at(1, 0, 1));             // parallel to a face
    run(at(1, -3, 0), at(1, 5, 0));             // and longer than it
    run(at(1, 1.5, -1), at(1, 1.5, 3));         // parallel to an edge
    run(at(.5, 1, -1), at(.5, 1, 1));           // on an edge
    run(at(.5, -.3, 0), at(.5, .3, 1));         // in a face
    run(at(0, 0, 0), at(.5, 1, 2));             // from the centre to a corner
    run(at(-.5, -1, -2), at(.5, 1, 2));         // from corner to corner
    run(at(1, 2, 4), at(.5, 1, 2));             // to a corner
    run(at(.1, -5, .2), at(.1, 5, .2));         // right through
    run(at(0, 0, -1), at(0, 0, 1));             // as near to two faces all along
    run(at(.5 + 1e-12, -9, 0), at(.5, 9, 0));   // grazing
    run(at(1e4, 0, 0), at(1, 1e-9, 0));         // long
    run(at(.3, .2, .1), at(.3, .2, .1 + 1e-9)); // inside, tiny
  }
  const box<> nothing{pose(quaternion<double>(1), vector(1, 2, 3)), vector::Zero()};
  check(capsule<>(vector(1, 2, 0), vector(1, 2, 5), .3), nothing);
  const sphere<> ball{vector(0, 0, 0), 1};
  check(capsule<>(vector(-1, 0, 0), vector(1, 0, 0), .1), ball);
  check(capsule<>(ball.centre, ball.centre, .1), ball);
  CHECK(closest_points(sphere<>{ball.centre, .1}, ball).distance == -1.1);
  check(capsule<>(vector(-1, 0, 1), vector(1, 0, 1), .1), half_space<>{vector::UnitZ(), 0});
}

TEST_CASE("closest_points: pairs of capsules agree with results in 50 digits") {
  duet_test::random_source random(5);
  for (int k = 0; k < 12; ++k) {
    const double length = k % 2 == 0 ? 1 : random.log_uniform(1e-9, 1);
    const vector from = point(random, 1), to = from + point(random, length);
    check_with_50_digits(capsule<>(from, to, .1),
                         capsule<>(point(random, 1), point(random, 1), .2));
    // Nearly parallel, of all angles down to none; nearly in touch.
    for (const double angle : {1e-2, 1e-5, 1e-7, 1e-8, 1e-10, 1e-15, 0.0}) {
      for (const double aside : {1., 1e-6, 0.}) {
        const vector off = aside * point(random, 1), tilt = angle * point(random, 1);
        check_with_50_digits(capsule<>(from, to, 0),
                             capsule<>(vector(from + off - tilt), vector(to + off + tilt), 0));
        check_with_50_digits(capsule<>(from, to, .1),
                             capsule<>(vector(to + off), vector(2 * to - from + off + tilt), .1));
      }
    }
  }
  const vector o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const auto run = [](const vector& a, const vector& b, const vector& c, const vector& d) {
    check_with_50_digits(capsule<>(a, b, .1), capsule<>(c, d, .3));
    check_with_50_digits(capsule<>(b, a, 0), capsule<>(c, d, .3));
  };
  run(-x, x, -y, y);                                     // crossing
  run(-x, x, vector(-y + .5 * z), vector(y + .5 * z));   // skew
  run(o, x, o, y);                                       // a corner
  run(o, x, x, vector(2 * x));                           // in line, touching
  run(o, x, vector(2 * x), vector(3 * x));               // in line, apart
  run(o, vector(3 * x), x, vector(2 * x));               // one in the other
  run(o, x, o, x);                                       // the same
  run(o, x, y, vector(x + y));                           // side by side
  run(o, x, vector(5 * x + y), vector(9 * x + y));       // parallel, without overlap
  run(o, x, vector(.5 * x + y), vector(.5 * x + 3 * y)); // an end above the middle
  run(o, o, x, x);                                       // points
  run(o, o, o, o);                                       // one point
  run(o, o, vector(x - y), vector(x + y));               // a point and a line
  run(vector(-1e4 * x), vector(1e4 * x), vector(-1e4 * x + 1e-9 * y), vector(1e4 * x - y)); // long
}

TEST_CASE("closest_points: the normal of crossing axes is perpendicular to both") {
  const vector o(0, 0, 0), x(1, 0, 0), y(0, 1, 0);
  const auto crossed = closest_points(capsule<>(-x, x, .1), capsule<>(-y, y, .2));
  CHECK(crossed.distance == doctest::Approx(-.3).epsilon(1e-15));
  CHECK(std::abs(crossed.normal[2]) == 1);
  const auto through = closest_points(capsule<>(-x, x, .1), sphere<>{o, .2});
  CHECK(through.normal[0] == 0);
  CHECK(std::abs(through.normal.norm() - 1) < 1e-15);
  const auto same = closest_points(capsule<>(-y, y, .1), capsule<>(-y, y, .1));
  CHECK(same.distance == -.2);
  CHECK(same.normal[1] == 0);
  CHECK(std::abs(same.normal.norm() - 1) < 1e-15);
  CHECK(std::abs(same.on_body[1]) == 0); // the middle of where they are beside each other
  const auto alongside =
      closest_points(capsule<>(o, x, 0), capsule<>(vector(.5 * x + y), vector(9 * x + y), 0));
  CHECK(alongside.on_body == vector(.75, 0, 0));
  // The distance grows along the normal, whatever moves.
  const auto distance_gradient = gradient<duet_test::shared_tag>(
      [&](const auto& move) {
        using T = std::decay_t<decltype(move[0])>;
        const vector3<T> a = -x.cast<T>() + move, b = x.cast<T>() + move;
        return closest_points(capsule<T>(a, b, T(.1)), capsule<>(-y, y, .2)).distance;
      },
      o);
  CHECK((distance_gradient.gradient - crossed.normal).norm() == 0);
}

TEST_CASE("closest_points: segments parallel to a face of a rotated box") {
  const auto run = [](const capsule<>& c, const box<>& b) {
    check(c, b);
    Eigen::Matrix<double, 6, 1> ends;
    ends << c.from, c.to;
    const auto distance_gradient = gradient<duet_test::shared_tag>(
        [&](const auto& x) {
          using T = std::decay_t<decltype(x[0])>;
          const vector3<T> first = x.template head<3>(), last = x.template tail<3>();
          return closest_points(capsule<T>(first, last, T(c.radius)), b).distance;
        },
        ends);
    if (distance_gradient.value + c.radius > 1e-9) {
      const vector first = distance_gradient.gradient.head<3>(),
                   last = distance_gradient.gradient.tail<3>();
      CHECK((first + last - closest_points(c, b).normal).norm() < 1e-9);
      CHECK(first.norm() + last.norm() < 1 + 1e-9);
    }
  };
  duet_test::random_source random(11);
  for (int k = 0; k < 300; ++k) {
    const dual_quaternion<double> where = random_pose(random);
    const box<> b{where, k % 3 == 0 ? vector(.5, 1, 0) : vector(.5, 1, 2)};
    // Round-off tilts the segment by up to 1e-16 in the frame of the box.
    vector from = point(random, 3), to = point(random, 3);
    from[k % 3] = to[k % 3] = random.uniform(0, 3);
    if (k % 2 == 0) {
      from[(k + 1) % 3] = to[(k + 1) % 3] = random.uniform(-3, 3);
    }
    run(capsule<>(transform_point(where, from), transform_point(where, to), .1), b);
  }
  // Round-off puts the nearest point within the segment.
  const auto rotated_by = [](double w, double x, double y, double z) {
    return pose(quaternion<double>(w, x, y, z), vector(0, 0, 0));
  };
  run(capsule<>(vector(0.016625076805275363, -0.24058689145783807, -0.4794871711223409),
                vector(-0.49458398608485266, -1.1592226023610437, -0.036278608030170745), 0),
      {rotated_by(-0.94763009375035523, 0.22074204032129013, 0.067739504341646897,
                  0.22063888280408525),
       vector(0, 0.94135876768341431, 0)});
  run(capsule<>(vector(-0.7575699361890561, 0.070779250782768255, -0.5170834761609675),
                vector(-1.3989547020142603, 1.5224790980273635, 0.084706213544185172), 0),
      {rotated_by(-0.55631362439303478, -0.66979911385548385, -0.47816698171290928,
                  0.11506796249460698),
       vector(0, 0.20000000000000001, 0.46617421301107731)});
}

TEST_CASE("closest_points: axes that cross or coincide up to round-off") {
  duet_test::random_source random(12);
  for (int k = 0; k < 300; ++k) {
    const vector along = point(random, 1), axis = point(random, 1);
    const auto on = [&](const vector& direction) {
      return vector(random.uniform(-2, 2) * direction);
    };
    // Through the origin, where the coordinates of the nearest points are round-off.
    check(capsule<>(on(along), vector(random.uniform(-2, 0) * on(along)), .1),
          capsule<>(vector(-random.uniform(0, 2) * axis), vector(random.uniform(0, 2) * axis), .2));
    check(capsule<>(vector::Zero(), vector::Zero(), 0),
          capsule<>(vector(-random.uniform(0, 2) * axis), vector(random.uniform(0, 2) * axis), .2));
    // On one line.
    const vector middle = point(random, 1);
    check(capsule<>(vector(middle + on(along)), vector(middle + on(along)), .1),
          capsule<>(vector(middle + on(along)), vector(middle + on(along)), .2));
  }
}

TEST_CASE("closest_points: results in 50 digits are exact, in double accurate to round-off") {
  duet_test::random_source random(3);
  for (int k = 0; k < 15; ++k) {
    const vector from = point(random, 1.2);
    const capsule<> c(from, vector(from + point(random, 2)), .1);
    for_each_obstacle(random, [&](auto obstacle) {
      if constexpr (requires { obstacle.pose; }) {
        // A unit vector in double is not a unit vector to 50 digits.
        const dual_quaternion<real_50> exact = normalized(dual_quaternion<real_50>(obstacle.pose));
        const box<real_50> b{exact, obstacle.half_extents.template cast<real_50>()};
        const capsule<real_50> d(c.from.cast<real_50>(), c.to.cast<real_50>(), c.radius);
        const auto p = closest_points(d, b);
        CHECK(abs(real_50(closest_points(c, obstacle).distance - p.distance)) < 2e-15);
        // At 50 digits the nearest point is on the box to 50 digits, and no sample is nearer.
        CHECK(abs(closest_points(sphere<real_50>{p.on_obstacle, 0}, b).distance) < 1e-48);
        for (int i = 0; i <= 20; ++i) {
          const vector3<real_50> x = d.from + real_50(i) / 20 * (d.to - d.from);
          CHECK(closest_points(sphere<real_50>{x, d.radius}, b).distance - p.distance > -1e-48);
        }
      }
    });
  }
}

TEST_CASE("closest_points: the gradient by dual numbers is the normal, weighted by the point on "
          "the axis") {
  duet_test::random_source random(4);
  for (int k = 0; k < 100; ++k) {
    const vector from = point(random, 1.5);
    const capsule<> c(from, vector(from + point(random, 2)), .1);
    for_each_obstacle(random, [&](const auto& obstacle) {
      const auto p = closest_points(c, obstacle);
      Eigen::Matrix<double, 6, 1> ends;
      ends << c.from, c.to;
      const auto distance_gradient = gradient<duet_test::shared_tag>(
          [&](const auto& x) {
            using T = std::decay_t<decltype(x[0])>;
            return closest_points(
                       capsule<T>(x.template head<3>(), x.template tail<3>(), T(c.radius)),
                       obstacle)
                .distance;
          },
          ends);
      const vector along = c.to - c.from;
      const double t = (p.on_body + c.radius * p.normal - c.from).dot(along) / along.squaredNorm();
      CHECK(std::abs(distance_gradient.value - p.distance) < 1e-15 + duet_test::if_fused(1e-15));
      const vector first = distance_gradient.gradient.template head<3>(),
                   second = distance_gradient.gradient.template tail<3>();
      // Inside a box, where the nearest face changes, the gradient is that of the edge.
      CHECK((first + second).norm() <= 1 + 1e-12);
      if (p.distance + c.radius > 0) {
        CHECK((first - (1 - t) * p.normal).norm() < 1e-9);
        CHECK((second - t * p.normal).norm() < 1e-9);
      }
      // Against a difference quotient, where the nearest face stays the same.
      const vector step = 1e-6 * point(random, 1);
      const auto moved = [&](double sign) {
        return closest_points(
                   capsule<>(vector(c.from + sign * step), vector(c.to - sign * step), c.radius),
                   obstacle)
            .distance;
      };
      const double change = (moved(1) - moved(-1)) / 2;
      CHECK(std::abs(change - step.dot(first - second)) < 1e-9);
    });
  }
}

TEST_CASE("closest_points: gradients are finite for touching and coinciding shapes") {
  const auto distance_gradient = [](const auto& obstacle, const vector& x) {
    return gradient<duet_test::shared_tag>(
               [&](const auto& y) {
                 using T = std::decay_t<decltype(y[0])>;
                 return closest_points(sphere<T>{y, T(0)}, obstacle).distance;
               },
               x)
        .gradient;
  };
  const box<> b{pose(quaternion<double>(1), vector(0, 0, 0)), vector(1, 1, 1)};
  CHECK(distance_gradient(b, vector(1, .2, 0)) == vector(1, 0, 0));
  CHECK(distance_gradient(b, vector(-1, .2, 0)) == vector(-1, 0, 0));
  CHECK(distance_gradient(b, vector(1, 1, 1)).norm() == 1);
  CHECK(distance_gradient(sphere<>{vector::Zero(), 1}, vector::Zero()).norm() == 1);
  CHECK(closest_points(sphere<>{vector(1, .2, 0), 0}, b).distance == 0);
}

/// Checks the derivatives of the distance along all coordinates and the half extents of a box.
template <class Obstacle>
void check_derivatives(const capsule<>& body, const Obstacle& obstacle) {
  constexpr bool is_box = requires { obstacle.half_extents; };
  const auto distance = [&](const auto& x) {
    using T = std::decay_t<decltype(x[0])>;
    const capsule<T> c(vector3<T>(body.from.cast<T>() + x.template head<3>()),
                       vector3<T>(body.to.cast<T>() + x.template segment<3>(3)), T(body.radius));
    if constexpr (is_box) {
      return closest_points(c, box<T>{dual_quaternion<T>(obstacle.pose),
                                      vector3<T>(obstacle.half_extents.template cast<T>() +
                                                 x.template tail<3>())})
          .distance;
    } else {
      return closest_points(c, obstacle).distance;
    }
  };
  using coordinates = Eigen::Matrix<double, 9, 1>;
  const auto by_duals =
      gradient<duet_test::shared_tag>(distance, coordinates(coordinates::Zero())).gradient;
  for (int i = 0; i < 9; ++i) {
    const coordinates step = 1e-6 * coordinates::Unit(i);
    const double above = (distance(step) - distance(coordinates::Zero())) / 1e-6;
    const double below = (distance(coordinates::Zero()) - distance(coordinates(-step))) / 1e-6;
    CAPTURE(i);
    CHECK(by_duals[i] >= std::min(above, below) - 1e-5);
    CHECK(by_duals[i] <= std::max(above, below) + 1e-5);
  }
}

TEST_CASE("closest_points: derivatives where ends are nearest and where faces balance") {
  // The end is the nearest point of the line to the other line, too, but not to its segment.
  check_derivatives(capsule<>(vector(0, 1, .5), vector(1, -.5, 1), 1),
                    capsule<>(vector(2, -2, -1), vector(2, -1, -1), .5));
  // An end touches a face.
  check_derivatives(capsule<>(vector(.5, .5, 0), vector(.6, .5, -.5), 1),
                    box<>{pose(quaternion<double>(1), vector(.5, 1, 1)), vector(.25, 1, 1)});
  // Faces ±z balance where x and y do, which are not the nearest.
  check_derivatives(capsule<>(vector(0, 0, -1), vector(1, -1, 1), .5),
                    box<>{pose(quaternion<double>(1), vector(1, 0, 0)), vector(1, 1, .25)});
  // At the same point the opposite faces of a square balance, which are the farthest.
  duet_test::random_source random(9);
  for (int k = 0; k < 20; ++k) {
    const vector along = point(random, 1);
    const vector middle(random.uniform(.3, .5), random.uniform(.3, .5), 0);
    check_derivatives(capsule<>(vector(middle - along), vector(middle + along), .1),
                      box<>{pose(quaternion<double>(1), vector(0, 0, 0)), vector(1, 1, 3)});
  }
}

TEST_CASE("require_shape: invalid shapes are rejected") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto identity_pose = pose(quaternion<double>(1), vector(0, 0, 0));
  require_shape(sphere<>{vector::Zero(), 0}, "it");
  CHECK_THROWS_WITH_AS(require_shape(sphere<>{vector::Zero(), -1}, "obstacle 2"),
                       "duet: the radius of obstacle 2 is -1 (expected a non-negative number)",
                       invalid_input);
  CHECK_THROWS_WITH_AS(require_shape(sphere<>{vector(0, nan, 0), 1}, "obstacle 2"),
                       "duet: the centre of obstacle 2 is not finite", invalid_input);
  CHECK_THROWS_AS(require_shape(capsule<>(vector::Zero(), vector(0, 0, nan), 1), "it"),
                  invalid_input);
  CHECK_THROWS_AS(require_shape(capsule<>(vector::Zero(), vector::Zero(), nan), "it"),
                  invalid_input);
  CHECK_THROWS_WITH_AS(require_shape(box<>{identity_pose, vector(1, -.5, 1)}, "it"),
                       "duet: half extent 1 of it is -0.5 (expected a non-negative number)",
                       invalid_input);
  CHECK_THROWS_AS(require_shape(box<>{identity_pose * 2.0, vector(1, 1, 1)}, "it"), invalid_input);
  CHECK_THROWS_AS(require_shape(half_space<>{vector(0, 0, 2), 1}, "it"), invalid_input);
  CHECK_THROWS_AS(require_shape(half_space<>{vector(0, 0, 1), nan}, "it"), invalid_input);
}

} // namespace
} // namespace test_kinematics_closest_points
