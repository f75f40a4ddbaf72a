// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "kinematics/trees.hpp"
#include "support/message.hpp"

#include <duet/robotics.hpp>

#include <Eigen/Core>

#include <fstream>

namespace test_robotics_capsules_of {
namespace {

using namespace duet;
using point = Eigen::Vector3d;

/// Signed distance of a point from the surface of a capsule.
double outside(const capsule<>& c, const point& x) {
  return closest_points(sphere<>{x, 0}, c).distance;
}

point corner(const collision_box& b, int k) {
  return {(k % 2 - .5) * b.size[0], (k / 2 % 2 - .5) * b.size[1], (k / 4 - .5) * b.size[2]};
}

/// Checks that the largest distance of the points is 0 up to round-off: they are inside and touch.
template <class Points>
void check_touches(const capsule<>& c, const Points& points, double scale) {
  double max_outside = -INFINITY;
  for (const point& x : points) {
    max_outside = std::max(max_outside, outside(c, x));
  }
  CHECK(std::abs(max_outside) < 1e-13 * scale);
}

std::vector<point> inside_cylinder(const collision_cylinder& c, int count, bool is_on_rim) {
  duet_test::random_source random(1);
  std::vector<point> result;
  for (int i = 0; i < count; ++i) {
    const double angle = random.uniform(-4, 4);
    const double r = is_on_rim ? c.radius : c.radius * random.uniform(0, 1);
    const double z = is_on_rim ? (i % 2 - .5) * c.length : c.length * random.uniform(-.5, .5);
    result.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  return result;
}

/// An octahedron with its vertices at these distances from the origin, with outward faces.
triangle_mesh octahedron(double a, double b, double c) {
  triangle_mesh result;
  for (int k = 0; k < 8; ++k) {
    const double x = k % 2 == 0 ? a : -a, y = k / 2 % 2 == 0 ? b : -b, z = k / 4 == 0 ? c : -c;
    const bool is_mirrored = x * y * z < 0;
    result.vertices.push_back({x, 0, 0});
    result.vertices.push_back(is_mirrored ? std::array{0., 0., z} : std::array{0., y, 0.});
    result.vertices.push_back(is_mirrored ? std::array{0., y, 0.} : std::array{0., 0., z});
  }
  return result;
}

TEST_CASE(
    "bounding_capsule: contains a cylinder, and no capsule along its axis has a smaller volume") {
  for (const double r : {1e-3, .1, .5, 1., 3.}) {
    for (const double length : {0., 1e-6, .3, 1., 1.1, 1.2, 4., 1000.}) {
      const collision_cylinder cylinder{r, length};
      const capsule<> c = bounding_capsule(cylinder);
      check_touches(c, inside_cylinder(cylinder, 50, true), r + length);
      for (const point& x : inside_cylinder(cylinder, 2500, false)) {
        CHECK(outside(c, x) < 1e-13 * (r + length));
      }
      const double h = length / 2;
      double min_volume = INFINITY;
      for (int i = 0; i <= 2000; ++i) {
        const double end = h * i / 2000, radius = std::hypot(r, h - end);
        min_volume = std::min(min_volume, volume_of(capsule<>({0, 0, -end}, {0, 0, end}, radius)));
      }
      CHECK(volume_of(c) <= min_volume * (1 + 1e-14));
      CHECK(volume_of(c) >=
            min_volume * (1 - 2e-4)); // of a long one the grid is coarse at its ends
      const bool is_ball = c.to[2] == 0;
      CHECK(is_ball == (h <= r / std::numbers::sqrt3));
    }
  }
}

TEST_CASE("bounding_capsule: contains a box, along the edge with the smallest volume") {
  duet_test::random_source random(2);
  for (int k = 0; k < 8; ++k) {
    const collision_box b{
        {random.log_uniform(.1, 10), random.log_uniform(.1, 10), random.log_uniform(.1, 10)}};
    const double scale = b.size[0] + b.size[1] + b.size[2];
    const capsule<> c = bounding_capsule(b);
    std::vector<point> vertices;
    for (int i = 0; i < 8; ++i) {
      vertices.push_back(corner(b, i));
    }
    check_touches(c, vertices, scale);
    for (int i = 0; i < 12500; ++i) {
      CHECK(outside(c, {b.size[0] * random.uniform(-.5, .5), b.size[1] * random.uniform(-.5, .5),
                        b.size[2] * random.uniform(-.5, .5)}) < 1e-13 * scale);
    }
    // What is sought in all directions is not smaller, by more than rounding and its own accuracy.
    const capsule<> sought = bounding_capsule(vertices);
    check_touches(sought, vertices, scale);
    CHECK(volume_of(sought) > volume_of(c) * (1 - 1e-3));
    CHECK(volume_of(sought) < volume_of(c) * 1.01);
  }
  CHECK(bounding_capsule(collision_box{{0, 0, 0}}).radius == 0);
}

TEST_CASE("bounding_capsule: returns spheres and capsules unchanged") {
  const capsule<> ball = bounding_capsule(collision_sphere{.3});
  CHECK(ball.from == ball.to);
  CHECK(ball.radius == .3);
  const capsule<> c = bounding_capsule(collision_capsule{.2, 1});
  CHECK(c.from == point(0, 0, -.5));
  CHECK(c.to == point(0, 0, .5));
  CHECK(c.radius == .2);
  CHECK(volume_of(c) == doctest::Approx(volume_of(collision_capsule{.2, 1})).epsilon(1e-15));
  CHECK(volume_of(collision_capsule{.2, 1}) ==
        doctest::Approx(std::numbers::pi * (.04 + 4 * .008 / 3)).epsilon(1e-15));
}

TEST_CASE("bounding_capsule: contains all points and recovers a capsule from its points") {
  duet_test::random_source random(3);
  for (int k = 0; k < 6; ++k) {
    const auto at = [&](double size) {
      return point(random.uniform(-size, size), random.uniform(-size, size),
                   random.uniform(-size, size));
    };
    const double unit = random.log_uniform(1e-6, 1e3);
    const point from = unit * at(3), to = from + unit * at(k % 4);
    const double radius = unit * random.uniform(.1, 1);
    std::vector<point> points;
    for (int i = 0; i < 3000; ++i) {
      const auto d = random.direction<3>();
      const double t = random.uniform(0, 1);
      points.push_back((1 - t) * from + t * to + radius * point(d[0], d[1], d[2]));
    }
    const capsule<> c = bounding_capsule(points);
    check_touches(c, points, unit);
    CHECK(volume_of(c) < 1.02 * volume_of(capsule<>(from, to, radius)));
    CHECK(volume_of(c) > .8 * volume_of(capsule<>(from, to, radius)));
  }
}

TEST_CASE("bounding_capsule: few, collinear, coplanar and repeated points are accepted, no points "
          "rejected") {
  const point x(1, 2, 3), y(-1, 0, 2);
  CHECK(bounding_capsule(std::vector{x}).from == x);
  CHECK(bounding_capsule(std::vector{x, x, x}).radius == 0);
  const auto line = bounding_capsule(std::vector<point>{x, y, (x + y) / 2});
  CHECK(line.radius < 1e-3);
  CHECK(outside(line, x) < 1e-15);
  CHECK(outside(line, y) < 1e-15);
  const auto square =
      bounding_capsule(std::vector<point>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {.5, .5, 0}});
  CHECK(volume_of(square) < 1.001 * volume_of(bounding_capsule(collision_box{{1, 1, 0}})));
  DUET_CHECK_REFUSED("duet: bounding_capsule: the list of points is empty",
                     bounding_capsule(std::vector<point>{}));
  DUET_CHECK_REFUSED("duet: bounding_capsule: point 1 is not finite",
                     bounding_capsule(std::vector<point>{x, point(0, NAN, 0)}));
}

TEST_CASE("volume_of: closed meshes of either orientation have their volume, open ones nan") {
  auto m = octahedron(1, 2, .5);
  CHECK(volume_of(m) == doctest::Approx(4. / 3).epsilon(1e-14));
  for (auto& x : m.vertices) {
    x = {-x[0] + 7, x[1] - 5, x[2] + 1e3};
  }
  CHECK(volume_of(m) == doctest::Approx(4. / 3).epsilon(1e-10));
  m.vertices.resize(m.vertices.size() - 3);
  CHECK(std::isnan(volume_of(m)));
}

TEST_CASE("bounding_capsules: shapes of trees and chains have the poses of their links") {
  const std::string folder = "test_robotics_capsules_of", file = folder + ".obj";
  std::ofstream(file) << "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
                         "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";
  robot_description robot;
  robot.links = {{"base"}, {"arm"}, {"weld"}, {"hand"}};
  robot.joints = {
      {"shoulder",
       "base",
       "arm",
       {joint_kind::revolute, duet_test::placement_at(.1, .2, .3, 0, 0, 1)}},
      {"fixed", "arm", "weld", {joint_kind::fixed, duet_test::placement_at(.5, 0, 1, .3, .1, 0)}},
      {"wrist",
       "weld",
       "hand",
       {joint_kind::revolute, duet_test::placement_at(0, 1, 0, 0, 0, .5)}}};
  const placement<double> shape_placement = duet_test::placement_at(.7, -.2, .4, .1, .2, -.3);
  robot.links[0].collision = {{shape_placement, collision_cylinder{.1, 1}},
                              {{}, collision_sphere{.2}}};
  robot.links[2].collision = {
      {shape_placement, collision_box{{.1, .2, .5}}},
      {shape_placement, collision_mesh{"package://" + file, {.1, -.2, .3}}}};
  robot.links[3].collision = {{shape_placement, collision_capsule{.05, .3}}};
  const kinematic_tree tree(robot);
  const auto chain = tree.chain("base", "hand");
  const bounding_capsules_result of_tree = bounding_capsules(tree, "."),
                                 of_chain = bounding_capsules(chain, ".");
  REQUIRE(of_tree.bodies.size() == 5);
  REQUIRE(of_chain.bodies.size() == 5);
  const std::array<double, 2> theta = {.3, -.8};
  for (std::size_t i = 0; i < 5; ++i) {
    const collision_body &a = of_tree.bodies[i], &b = of_chain.bodies[i];
    CHECK(a.name == b.name);
    CHECK(of_tree.volume_ratios[i] == of_chain.volume_ratios[i]);
    const auto x = transformed(tree.pose(theta, a.link), a.shape);
    const auto y = transformed(chain.pose(theta, b.link), b.shape);
    CHECK((x.from - y.from).norm() < 1e-14);
    CHECK((x.to - y.to).norm() < 1e-14);
    CHECK(x.radius == y.radius);
  }
  CHECK(of_chain.bodies[2].link == 1);
  CHECK(of_chain.bodies[2].name == "weld");
  CHECK(of_tree.volume_ratios[1] == doctest::Approx(1).epsilon(1e-15));
  CHECK(of_tree.volume_ratios[4] == doctest::Approx(1).epsilon(1e-15));
  CHECK(of_tree.volume_ratios[0] > 1);
  CHECK(of_tree.volume_ratios[2] > 1);
  // The vertices of the mesh, scaled, in the frame of the link.
  const auto& meshed = of_tree.bodies[3];
  const auto where = pose(shape_placement.rotation, point(shape_placement.translation.data()));
  for (int axis = 0; axis < 3; ++axis) {
    for (const int sign : {-1, 1}) {
      const point x = transform_point(where, point(sign * (axis + 1) / 10. * point::Unit(axis)));
      CHECK(outside(meshed.shape, x) < 1e-15);
    }
  }
  CHECK(of_tree.volume_ratios[3] ==
        doctest::Approx(volume_of(meshed.shape) / (4. / 3 * .006)).epsilon(1e-12));
  // Bodies of links that are fixed to each other or adjacent form no pairs.
  CHECK(self_collision_pairs(tree, of_tree.bodies).size() == 2); // hand and base
  CHECK(self_collision_pairs(chain, of_chain.bodies).size() == 2);

  // Another format, twice as large by the description.
  std::ofstream(folder + ".obj") << "v 0 0 0\nv .3 0 0\nv 0 .4 0\nf 1 2 3\n";
  robot.links[3].collision = {{{}, collision_mesh{"package://" + folder + ".obj", {2, 2, 2}}}};
  const auto triangle = bounding_capsules(kinematic_tree(robot), ".").bodies.back().shape;
  check_touches(triangle, std::vector<point>{{0, 0, 0}, {.6, 0, 0}, {0, .8, 0}}, 1);

  robot.links[3].collision = {{{}, collision_mesh{"package://nowhere/hand.stl"}}};
  CHECK(duet_test::message_of<file_error>([&] {
          (void)bounding_capsules(kinematic_tree(robot), ".");
        }) == "duet: ./nowhere/hand.stl: cannot be read");
}

} // namespace
} // namespace test_robotics_capsules_of
