// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "kinematics/trees.hpp"
#include "support/message.hpp"
#include "support/multiprecision.hpp"
#include "support/shared_tag.hpp"

#include <duet/duet.hpp>
#include <duet/kinematics/kinematic_tree.hpp>
#include <duet/kinematics/tree_jacobian.hpp>

namespace test_kinematics_kinematic_tree {
namespace {

using namespace duet;
using duet_test::all_joints;
using duet_test::coordinates_of;
using duet_test::for_each_frame;
using duet_test::max_abs_difference;
using Eigen::Vector3d;
using Eigen::VectorXd;

dual_quaternion<double> pose_of(const placement<double>& at) { return at.pose(); }

/// Frames of interest: links before and behind others, on the root, points, and frames relative to
/// others above, below and next to them.
template <class F>
void for_each_frame_of_interest(const kinematic_tree& tree, F&& f) {
  const auto hand = tree.link("hand").at_point({.3, -.2, .5});
  f(tree.link("finger"));
  f(tree.link("flange"));
  f(tree.link("tool").at_point({.1, .2, .3}));
  f(tree.link("screw"));
  f(relative_frame{hand, tree.link("screw")});
  f(relative_frame{tree.link("body"), hand});
  f(relative_frame{tree.link("thumb"), tree.link("finger").at_point({0, 1, 0})});
  f(relative_frame{hand, tree.link("flange").at_point({1, 0, 0})});
  f(relative_frame{hand, tree.link("tool")});
}

VectorXd random_vector(Eigen::Index n, duet_test::random_source& random) {
  VectorXd result(n);
  for (double& x : result) {
    x = random.uniform(-2, 2);
  }
  return result;
}

/// q + t v
template <class T>
auto along(const VectorXd& q, const VectorXd& v, const T& t) {
  Eigen::Matrix<T, Eigen::Dynamic, 1> x(q.size());
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    x[i] = q[i] + t * v[i];
  }
  return x;
}

TEST_CASE("kinematic_tree: coordinates have the names, order and limits of the joints") {
  const kinematic_tree tree(all_joints());
  CHECK(tree.size() == 1 + 6 + 3 + 1 + 1 + 3);
  CHECK(tree.coordinate_names() ==
        std::vector<std::string>{"grip", "free.x", "free.y", "free.z", "free.rx", "free.ry",
                                 "free.rz", "ball.rx", "ball.ry", "ball.rz", "bend", "turn",
                                 "slide.x", "slide.y", "slide.angle"});
  CHECK(tree.coordinate("bend") == 10);
  CHECK(duet_test::message_of([&] {
          (void)tree.coordinate("bent");
        }).starts_with("duet: kinematic_tree: no coordinate \"bent\": there are \"bend\", "));
  CHECK(tree.links().size() == 11);
  CHECK(tree.link("world").link == 1);
  CHECK(duet_test::message_of([&] {
          (void)tree.link("word");
        }).starts_with("duet: kinematic_tree: no link \"word\": there are \"world\", "));
  CHECK(duet_test::message_of([&] { (void)tree.link(11); }) ==
        "duet: kinematic_tree: link 11 does not exist, the tree has 11 links");
  CHECK(duet_test::message_of([&] { (void)tree.pose(VectorXd::Zero(14), 0); }) ==
        "duet: kinematic_tree: 14 coordinates (expected 15)");
  CHECK(tree.limits(0).lower == -INFINITY);
}

TEST_CASE("kinematic_tree: poses are the products of the joint displacements") {
  const auto robot = all_joints();
  const kinematic_tree tree(robot);
  for (const VectorXd& q : coordinates_of(tree, 20)) {
    const auto origin = [&](int j) { return pose_of(robot.joints[std::size_t(j)].motion.origin); };
    const auto axis = [&](int j) {
      const auto& n = robot.joints[std::size_t(j)].motion.axis;
      return Vector3d(n[0], n[1], n[2]);
    };
    const Vector3d none = Vector3d::Zero();
    const quaternion<double> one(1);
    const double grip = q[0], oppose = -2.5 * grip + .1, lead = .5 * oppose - .2;
    const auto body = origin(1) * pose(from_rotation_vector(Vector3d(q.segment<3>(4))),
                                       Vector3d(q.segment<3>(1)));
    const auto elbow = body * origin(2) *
                       pose(from_rotation_vector(Vector3d(q.segment<3>(7))), none) * origin(3) *
                       pose(from_axis_angle(axis(3), q[10]), none);
    const auto hand = elbow * origin(4) * pose(from_axis_angle(axis(4), q[11]), none);
    const auto finger = hand * origin(0) * pose(one, Vector3d(grip * axis(0)));
    const auto thumb = hand * origin(6) * pose(from_axis_angle(axis(6), oppose), none);
    // In the plane: e_x and e_y carried by the shortest rotation of e_z to the axis.
    const Vector3d n = axis(7);
    const Vector3d z(0, 0, 1);
    const auto tilt = from_axis_angle(Vector3d(z.cross(n).normalized()), std::acos(n[2]));
    const auto cart =
        origin(7) * pose(from_axis_angle(n, q[14]), rotate(tilt, Vector3d(q[12], q[13], 0)));
    const auto screw =
        cart * origin(8) * pose(from_axis_angle(axis(8), lead), Vector3d(.07 * lead * axis(8)));
    const auto all = tree.poses(q);
    const auto check = [&](const char* name, const auto& expected) {
      CAPTURE(name);
      CHECK(max_abs_difference(transform_matrix(tree.pose(q, tree.link(name))),
                               transform_matrix(expected)) < 4e-14);
      CHECK(max_abs_difference(transform_matrix(all[std::size_t(tree.link(name).link)]),
                               transform_matrix(expected)) < 4e-14);
    };
    check("world", pose(one, none));
    check("body", body);
    check("elbow", elbow);
    check("hand", hand);
    check("tool", hand * origin(5));
    check("finger", finger);
    check("thumb", thumb);
    check("cart", cart);
    check("screw", screw);
    check("flange", origin(9));
    const auto relative = tree.pose(q, relative_frame{tree.link("thumb"), tree.link("screw")});
    CHECK(max_abs_difference(transform_matrix(relative), transform_matrix(conj(screw) * thumb)) <
          4e-14);
  }
}

TEST_CASE("kinematic_tree: a planar joint moves in its plane, also for axes near -z") {
  for (const double small : {0., 1e-3, 1e-9, 1e-13, 1e-17}) {
    robot_description robot{{{"a"}, {"b"}}, {{"p", "a", "b", {joint_kind::planar}}}};
    const double z = -std::sqrt(1 - small * small);
    robot.joints[0].motion.axis = {small, 0, z};
    const kinematic_tree tree(robot);
    const Vector3d q(.3, .4, .5);
    const auto at = tree.pose(q, 1);
    const Vector3d n(small, 0, z);
    CHECK(std::abs(translation(at).dot(n)) < 1e-15);
    CHECK(std::abs(translation(at).norm() - .5) < 1e-15);
    CHECK(max_abs_difference(rotation_vector(rotation(at)), Vector3d(.5 * n)) < 1e-15);
    // The shortest rotation is about y, and for −z a half turn about x.
    CHECK(max_abs_difference(translation(at),
                             small > 1e-15 ? Vector3d(-.3, .4, 0) : Vector3d(.3, -.4, 0)) < 1e-3);
  }
}

TEST_CASE("kinematic_tree: Jacobians of frames, points and relative poses equal dual numbers") {
  const kinematic_tree tree(all_joints());
  for (const VectorXd& q : coordinates_of(tree, 5)) {
    for_each_frame_of_interest(tree, [&](const auto& at) {
      for_each_frame([&](auto frame) {
        const auto by_duals = jacobian<duet_test::shared_tag>(
            [&](const auto& x) { return tree.pose(x, at); }, q, frame);
        const auto closed = pose_and_jacobian(tree, q, frame, at);
        CHECK(max_abs_difference(closed.jacobian, by_duals.jacobian) < 2e-13);
        CHECK(max_abs_difference(transform_matrix(closed.value), transform_matrix(by_duals.value)) <
              2e-14);
        CHECK(max_abs_difference(jacobian(tree, q, frame, at), closed.jacobian) < 1e-14);
      });
    });
  }
  const auto m = jacobian(tree, coordinates_of(tree, 1).back(), frame::body,
                          relative_frame{tree.link("hand"), tree.link("body")});
  CHECK(m.leftCols(7).isZero(0)); // joints that move both frames
  CHECK(m.rightCols(3).isZero(0));
}

TEST_CASE("kinematic_tree: Jacobian rates and Hessians equal derivatives of the Jacobian") {
  const kinematic_tree tree(all_joints());
  duet_test::random_source random(5);
  for (const VectorXd& q : coordinates_of(tree, 2)) {
    const VectorXd v = random_vector(q.size(), random);
    for_each_frame_of_interest(tree, [&](const auto& at) {
      for_each_frame([&](auto frame) {
        const auto [m, m_dot] = derivative<duet_test::shared_tag>(
            [&](const auto& t) { return jacobian(tree, along(q, v, t), frame, at); }, 0.0);
        const auto closed = jacobian_with_rate(tree, q, v, frame, at);
        const double scale = 1 + m_dot.cwiseAbs().maxCoeff();
        CHECK(max_abs_difference(closed.jacobian, m) < 1e-13);
        CHECK(max_abs_difference(closed.rate, m_dot) < 1e-13 * scale);
        CHECK(max_abs_difference(jacobian_rate(tree, q, v, frame, at), closed.rate) <
              1e-13 * scale);
        const auto h = kinematic_hessian(tree, q, frame, at);
        Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(6, tree.size());
        for (Eigen::Index j = 0; j < q.size(); ++j) {
          sum += h[std::size_t(j)] * v[j];
        }
        CHECK(max_abs_difference(sum, m_dot) < 1e-13 * scale);
        if constexpr (std::same_as<decltype(frame), hybrid_frame>) {
          for (Eigen::Index j = 0; j < q.size(); ++j) {
            for (Eigen::Index k = 0; k < j; ++k) {
              CHECK(max_abs_difference(h[std::size_t(j)].col(k).template head<3>(),
                                       h[std::size_t(k)].col(j).template head<3>()) < 1e-13);
            }
          }
        }
      });
    });
  }
}

TEST_CASE("centre_of_mass: value, Jacobian, rate and Hessian equal sums and dual numbers") {
  const auto robot = all_joints();
  const kinematic_tree tree(robot);
  duet_test::random_source random(6);
  for (const VectorXd& q : coordinates_of(tree, 3)) {
    Vector3d sum = Vector3d::Zero();
    double mass = 0;
    const auto poses = tree.poses(q);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (const auto& inertia = robot.links[i].inertia) {
        sum += inertia->mass * transform_point(poses[i], translation(inertia->frame.pose()));
        mass += inertia->mass;
      }
    }
    CHECK(max_abs_difference(centre_of_mass(tree, q), Vector3d(sum / mass)) < 1e-14);
    const auto by_duals =
        jacobian<duet_test::shared_tag>([&](const auto& x) { return centre_of_mass(tree, x); }, q)
            .jacobian;
    CHECK(max_abs_difference(centre_of_mass_jacobian(tree, q), by_duals) < 1e-14);
    const VectorXd v = random_vector(q.size(), random);
    const auto rate = derivative<duet_test::shared_tag>(
        [&](const auto& t) { return centre_of_mass_jacobian(tree, along(q, v, t)); }, 0.0);
    CHECK(max_abs_difference(centre_of_mass_jacobian_rate(tree, q, v), rate.derivative) < 2e-14);
    const auto h = centre_of_mass_hessian(tree, q);
    Eigen::MatrixXd by_hessian = Eigen::MatrixXd::Zero(3, tree.size());
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      by_hessian += h[std::size_t(j)] * v[j];
      for (Eigen::Index k = 0; k < j; ++k) {
        CHECK(max_abs_difference(h[std::size_t(j)].col(k), h[std::size_t(k)].col(j)) < 1e-14);
      }
    }
    CHECK(max_abs_difference(by_hessian, rate.derivative) < 2e-14);
  }
  robot_description light = robot;
  for (tree_link& link : light.links) {
    link.inertia.reset();
  }
  const kinematic_tree massless(light);
  CHECK(duet_test::message_of([&] { (void)centre_of_mass(massless, VectorXd::Zero(15)); }) ==
        "duet: centre_of_mass: the mass of all links is 0 (expected > 0)");
  light.links[3].inertia = link_inertia{-1};
  CHECK(duet_test::message_of([&] { (void)kinematic_tree(light); }) ==
        "duet: kinematic_tree: <link name=\"shoulder\">: the mass is -1 (expected >= 0)");
}

TEST_CASE("kinematic_tree: double agrees with 50 digits, also near full turns of a floating base") {
  using digits = duet_test::real_50;
  const kinematic_tree tree(all_joints());
  const auto at = tree.link("tool").at_point({.1, .2, .3});
  duet_test::random_source random(9);
  for (const double angle : {1e-12, 1., 3.14159, 6.2831853071795862, 6.2831853, 6.28, 12.5663706}) {
    VectorXd q = random_vector(tree.size(), random);
    q.segment<3>(4) = q.segment<3>(4).normalized().eval() * angle;
    q.segment<3>(7) = q.segment<3>(7).normalized().eval() * angle;
    Eigen::Matrix<digits, Eigen::Dynamic, 1> exact(q.size());
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      exact[i] = q[i];
    }
    for_each_frame([&](auto frame) {
      const auto m = jacobian(tree, exact, frame, at);
      CHECK(max_abs_difference(jacobian(tree, q, frame, at), m.template cast<double>()) < 1e-13);
      const auto rate = jacobian_rate(tree, exact, exact, frame, at);
      const Eigen::MatrixXd expected = rate.template cast<double>();
      CHECK(max_abs_difference(jacobian_rate(tree, q, q, frame, at), expected) <
            1e-13 * (1 + expected.cwiseAbs().maxCoeff()));
    });
    CHECK(max_abs_difference(transform_matrix(tree.pose(q, at)),
                             transform_matrix(tree.pose(exact, at)).template cast<double>()) <
          4e-14);
    CHECK(max_abs_difference(centre_of_mass_jacobian(tree, q),
                             centre_of_mass_jacobian(tree, exact).template cast<double>()) < 1e-14);
  }
}

TEST_CASE("kinematic_tree: a single link has no coordinates and empty Jacobians") {
  const kinematic_tree alone(
      {.links = {{"a", link_inertia{2, duet_test::placement_at(0, 0, 0, 1, 2, 3)}}}});
  const VectorXd none(0);
  CHECK(alone.size() == 0);
  CHECK(alone.poses(none).size() == 1);
  CHECK(max_abs_difference(translation(alone.pose(none, alone.link(0).at_point({1, 0, 0}))),
                           Vector3d(1, 0, 0)) == 0);
  CHECK(jacobian(alone, none, frame::hybrid, 0).cols() == 0);
  CHECK(kinematic_hessian(alone, none, frame::hybrid, 0).empty());
  CHECK(max_abs_difference(centre_of_mass(alone, none), Vector3d(1, 2, 3)) == 0);
  CHECK(centre_of_mass_jacobian(alone, none).cols() == 0);
}

TEST_CASE("kinematic_tree: a chain of 20000 links has accurate poses and Jacobians") {
  constexpr int count = 20000;
  robot_description robot;
  robot.links.push_back({"0"});
  for (int i = 1; i <= count; ++i) {
    const std::string name = std::to_string(i);
    robot.links.push_back({name, link_inertia{1}});
    robot.joints.push_back({name,
                            std::to_string(i - 1),
                            name,
                            {i % 2 == 0 ? joint_kind::prismatic : joint_kind::revolute}});
    if (i > 2) {
      robot.joints.back().mimic = joint_mimic{std::to_string(i - 2), 1, 0};
    }
  }
  const kinematic_tree tree(robot);
  CHECK(tree.size() == 2);
  // Every second joint translates by ½ along z, the others rotate by 2⁻¹⁴ about it.
  const Eigen::Vector2d q(std::ldexp(1., -14), .5);
  const auto tip = tree.pose(q, count);
  CHECK(std::abs(translation(tip)[2] - count / 4.) < 1e-8);
  CHECK(std::abs(rotation_vector(rotation(tip))[2] - count / 2 * q[0]) < 1e-12);
  const auto m = jacobian(tree, q, frame::hybrid, count);
  CHECK(std::abs(m(2, 1) - count / 2) < 1e-8);
  CHECK(std::abs(m(5, 0) - count / 2) < 1e-8);
  CHECK(std::abs(centre_of_mass_jacobian(tree, q)(2, 1) - count / 4.) < 1e-8);
  CHECK(tree.poses(q).size() == count + 1);
  CHECK(jacobian_rate(tree, q, q, frame::body, count).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE(
    "kinematic_tree: paths of 1 to 41 joints with spherical ones have exact poses and Jacobians") {
  duet_test::random_source random(21);
  robot_description robot{.links = {{"0"}}};
  for (int i = 1; i <= 41; ++i) {
    const std::string name = std::to_string(i);
    robot.links.push_back({name});
    const auto kind = i == 18 || i == 35 || i == 36 ? joint_kind::spherical
                      : i % 3 == 0                  ? joint_kind::prismatic
                                                    : joint_kind::revolute;
    robot.joints.push_back(
        {name,
         std::to_string(i - 1),
         name,
         {kind, duet_test::placement_at(.1 * i, 1, -.2, .02, .1, .01 * i), {0, .6, .8}}});
  }
  const kinematic_tree tree(robot);
  const VectorXd q = random_vector(tree.size(), random);
  dual_quaternion<double> at{quaternion<double>(1)};
  int k = 0;
  for (int i = 1; i <= 41; ++i) {
    const joint<double>& moves = robot.joints[std::size_t(i - 1)].motion;
    const Vector3d axis(moves.axis[0], moves.axis[1], moves.axis[2]);
    at = at * moves.origin.pose();
    if (moves.kind == joint_kind::prismatic) {
      at = at * pose(quaternion<double>(1), Vector3d(q[k] * axis));
    } else {
      const Vector3d rotated_by =
          moves.kind == joint_kind::spherical ? Vector3d(q.segment<3>(k)) : Vector3d(q[k] * axis);
      at = at * pose(from_rotation_vector(rotated_by), Vector3d(0, 0, 0));
    }
    k += moves.coordinates();
    CHECK(max_abs_difference(transform_matrix(tree.pose(q, i)), transform_matrix(at)) < 1e-13);
    if (i % 8 <= 1) { // 16, 17, 32, 33 among them
      const auto by_duals = jacobian<duet_test::shared_tag>(
                                [&](const auto& x) { return tree.pose(x, i); }, q, frame::body)
                                .jacobian;
      CHECK(max_abs_difference(jacobian(tree, q, frame::body, i), by_duals) < 1e-12);
    }
  }
}

TEST_CASE("with_limits: replaces the limits of coordinates of a tree") {
  robot_description robot = all_joints();
  const kinematic_tree tree(robot);
  const int bend = tree.coordinate("bend");
  const auto one = with_limits(tree, "bend", {.lower = -7, .upper = 8});
  CHECK(one.limits(bend).lower == -7);
  CHECK(one.limits(bend).upper == 8);
  CHECK(one.limits(bend).velocity == INFINITY);
  for (int i = 0; i < tree.size(); ++i) {
    CHECK((i == bend || one.limits(i).upper == tree.limits(i).upper));
  }
  CHECK(one.chain("shoulder", "elbow").limits(0).upper == 8);
  CHECK(tree.chain("shoulder", "elbow").limits(0).upper != 8);
  const int x = tree.coordinate("free.x");
  const auto all = with_limits(one, VectorXd::Constant(tree.size(), -.5),
                               VectorXd::LinSpaced(tree.size(), 1, 2));
  CHECK(all.limits(x).lower == -.5);
  CHECK(all.limits(tree.size() - 1).upper == 2);
  CHECK(all.chain("shoulder", "elbow").limits(0).lower == -.5);
  CHECK(with_limits(all, x, {.velocity = 3}).limits(x).velocity == 3);
  CHECK(duet_test::message_of([&] {
          (void)with_limits(tree, "bent", {});
        }).rfind("duet: kinematic_tree: no coordinate \"bent\": ", 0) == 0);
  CHECK(duet_test::message_of([&] {
          (void)with_limits(tree, 99, {});
        }).rfind("duet: with_limits: coordinate 99 does not exist, the tree has ", 0) == 0);
  CHECK(duet_test::message_of([&] {
          (void)with_limits(tree, "free.x", {.lower = 1, .upper = 0});
        }).rfind("duet: with_limits: joint ", 0) == 0);
  CHECK(duet_test::message_of([&] {
          (void)with_limits(tree, VectorXd::Zero(2), VectorXd::Ones(tree.size()));
        }).rfind("duet: with_limits: 2 lower and ", 0) == 0);
}

TEST_CASE("kinematic_tree: mimic joints narrow the limits of the mimicked joint") {
  robot_description robot{{{"a"}, {"b"}, {"c"}, {"d"}},
                          {{"p", "a", "b", {joint_kind::revolute, {}, {0, 0, 1}, {-1, 2, 3}}},
                           {"q", "b", "c", {joint_kind::revolute, {}, {0, 0, 1}, {-3, .5, 3}}},
                           {"r", "c", "d", {joint_kind::prismatic, {}, {0, 0, 1}, {-.4, 9, 50}}}}};
  robot.joints[1].mimic = joint_mimic{"p", -2, .1};
  robot.joints[2].mimic = joint_mimic{"q", .5, -.25};
  const auto limits = kinematic_tree(robot).limits(0);
  // q = −2 p + 0.1 ≤ 0.5 and ≥ −3; r = −p − 0.2 ≥ −0.4
  CHECK(limits.lower == doctest::Approx(-.2).epsilon(1e-15));
  CHECK(limits.upper == doctest::Approx(.2).epsilon(1e-15));
  CHECK(limits.velocity == 1.5);
  const kinematic_tree tree(robot);
  CHECK(lower_limits(tree)[0] == limits.lower);
  CHECK(upper_limits(tree)[0] == limits.upper);
  CHECK(translation(tree.pose(Eigen::Matrix<double, 1, 1>(.1), 3))[2] ==
        doctest::Approx(-.3).epsilon(1e-15));
  const auto error_of = [&] { return duet_test::message_of([&] { (void)kinematic_tree(robot); }); };
  robot.joints[1].motion.limits = {2.2, 3};
  CHECK(error_of() ==
        "duet: kinematic_tree: <joint name=\"q\">: no coordinate of \"p\" satisfies its limits "
        "2.2 to 3");
  robot.joints[1].motion.limits = {-3, 3};
  robot.joints[1].mimic->multiplier = 0;
  CHECK(kinematic_tree(robot).limits(0).upper == 2);
  robot.joints[1].mimic->offset = 4;
  CHECK(error_of() ==
        "duet: kinematic_tree: <joint name=\"q\">: no coordinate of \"p\" satisfies its limits "
        "-3 to 3");
  robot.joints[1].mimic->offset = NAN;
  CHECK(error_of() == "duet: kinematic_tree: <joint name=\"q\">: the multiplier or the offset of "
                      "its mimic is not finite");
}

TEST_CASE("kinematic_tree: invalid descriptions are rejected with link, joint and value") {
  const auto error_of = [](const robot_description& robot) {
    return duet_test::message_of([&] { (void)kinematic_tree(robot); });
  };
  const std::string begin = "duet: kinematic_tree: ";
  const std::string p = begin + "<joint name=\"p\">: ";
  const std::vector<tree_link> links = {{"a"}, {"b"}, {"c"}};
  const joint<double> revolute;
  CHECK(error_of({}) == begin + "the description has no links");
  CHECK(error_of({{{"a"}, {"a"}}}) == begin + "<link name=\"a\">: another link has this name");
  CHECK(error_of({links, {{"p", "a", "b", revolute}}}) ==
        begin + "<link name=\"c\">: it is a second root, the first is \"a\"");
  CHECK(error_of({links, {{"p", "a", "d", revolute}}}) ==
        p + "no link \"d\": there are \"a\", \"b\", \"c\"");
  CHECK(error_of({links, {{"p", "a", "b", revolute}, {"p", "a", "c", revolute}}}) ==
        p + "another joint has this name");
  CHECK(error_of({links, {{"q", "a", "b", revolute}, {"p", "c", "b", revolute}}}) ==
        p + "the link \"b\" already has the parent joint \"q\"");
  CHECK(error_of({links, {{"p", "c", "b", revolute}, {"q", "b", "c", revolute}}}) ==
        p + "it closes a cycle at the link \"b\"");
  CHECK(error_of({{{"b"}}, {{"p", "b", "b", revolute}}}) ==
        p + "it closes a cycle at the link \"b\"");
  joint<double> bad;
  bad.axis = {0, 0, 2};
  CHECK(error_of({links, {{"p", "a", "b", bad}}}) ==
        begin + "joint 0 \"p\": the axis (0, 0, 2) is not a unit vector");
  const auto follows = [&](const std::string& leader, joint_kind kind, joint_kind of_leader) {
    robot_description robot{links, {{"q", "a", "b", {of_leader}}, {"p", "b", "c", {kind}}}};
    robot.joints[1].mimic = joint_mimic{leader};
    return error_of(robot);
  };
  CHECK(follows("q", joint_kind::revolute, joint_kind::prismatic).empty());
  CHECK(follows("x", joint_kind::revolute, joint_kind::prismatic) ==
        p + "it mimics no joint \"x\": there are \"q\", \"p\"");
  CHECK(follows("p", joint_kind::revolute, joint_kind::prismatic) == p + "it mimics itself");
  CHECK(follows("q", joint_kind::planar, joint_kind::revolute) ==
        p + "it mimics \"q\", but \"p\" has 3 coordinates (expected 1)");
  CHECK(follows("q", joint_kind::revolute, joint_kind::floating) ==
        p + "it mimics \"q\", but \"q\" has 6 coordinates (expected 1)");
  CHECK(follows("q", joint_kind::revolute, joint_kind::fixed) ==
        p + "it mimics \"q\", but \"q\" has 0 coordinates (expected 1)");
  robot_description circle{links, {{"p", "a", "b", revolute}, {"q", "b", "c", revolute}}};
  circle.joints[0].mimic = joint_mimic{"q"};
  circle.joints[1].mimic = joint_mimic{"p"};
  CHECK(error_of(circle) == p + "it mimics itself");
}

TEST_CASE("kinematic_tree::chain: chains up and down the tree have its relative poses") {
  robot_description robot = all_joints();
  for (tree_joint& joint : robot.joints) {
    joint.mimic.reset();
    if (joint.motion.coordinates() > 1) {
      joint.motion.kind = joint_kind::helical;
      joint.motion.pitch = .3;
    }
  }
  robot.joints[3].motion.limits = {-1, 2, 3};
  const kinematic_tree tree(robot);
  const auto check = [&](const std::string& base, const std::string& tip, int joints) {
    const auto chain = tree.chain(base, tip);
    CHECK(chain.size() == joints);
    for (const VectorXd& q : coordinates_of(tree, 3)) {
      VectorXd theta(chain.size());
      for (int i = 0; i < chain.size(); ++i) {
        theta[i] = q[tree.coordinate(chain.joint_names()[std::size_t(i)])];
      }
      const auto seen = [&](const std::string& name) {
        return tree.pose(q, relative_frame{tree.link(name), tree.link(base)});
      };
      CHECK(max_abs_difference(transform_matrix(chain.pose(theta)), transform_matrix(seen(tip))) <
            1e-14);
      for (const urdf_link& link : chain.links()) {
        CHECK(max_abs_difference(transform_matrix(chain.pose(theta, link.frame)),
                                 transform_matrix(seen(link.name))) < 1e-14);
      }
    }
    return chain;
  };
  CHECK(check("world", "tool", 4).limits(2).upper == 2);
  CHECK(check("tool", "world", 4).limits(1).upper == 2);
  check("finger", "thumb", 2);
  check("screw", "tool", 6);
  check("hand", "hand", 0);
  check("hand", "tool", 0);
  CHECK(check("tool", "hand", 0).links().size() == 2);
  CHECK(duet_test::message_of([&] { (void)tree.chain<3>("world", "tool"); }) ==
        "duet: kinematic_tree: 4 moving joints from \"world\" to \"tool\": use chain<4>");
  CHECK(duet_test::message_of([&] {
          (void)tree.chain("worlt", "tool");
        }).starts_with("duet: kinematic_tree: no link \"worlt\": there are \"world\", "));
  const kinematic_tree complete(all_joints());
  CHECK(duet_test::message_of([&] { (void)complete.chain("world", "tool"); }) ==
        "duet: kinematic_tree: <joint name=\"free\">: it has 6 coordinates (use a kinematic_tree)");
  CHECK(duet_test::message_of([&] { (void)complete.chain("hand", "thumb"); }) ==
        "duet: kinematic_tree: <joint name=\"oppose\">: it mimics \"grip\" (use a kinematic_tree)");
  CHECK(complete.chain("elbow", "tool").size() == 1);
}

} // namespace
} // namespace test_kinematics_kinematic_tree
