// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "kinematics/arms.hpp"
#include "support/skip.hpp"

#if DUET_TEST_KDL

#include <duet/io/urdf.hpp>
#include <duet/kinematics/jacobian_rate.hpp>
#include <duet/kinematics/tree_jacobian.hpp>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>

#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacdotsolver.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <kdl/tree.hpp>
#include <kdl/treefksolverpos_recursive.hpp>
#include <kdl/treejnttojacsolver.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

// Every link of every robot description in the folder of outside data, against Orocos KDL, whose
// chains are made here from the description without the help of duet.

namespace test_kinematics_kdl {
namespace {

using namespace duet;
using duet_test::max_abs_difference;
using element = boost::property_tree::ptree;
using vector = Eigen::VectorXd;

KDL::Vector three_numbers(const element& joint, const std::string& path, const char* otherwise) {
  std::istringstream text(joint.get<std::string>(path, otherwise));
  double x = 0, y = 0, z = 0;
  text >> x >> y >> z;
  return {x, y, z};
}

class description {
public:
  explicit description(const std::string& path) {
    element document;
    boost::property_tree::read_xml(path, document);
    for (const auto& [tag, child] : document.get_child("robot")) {
      if (tag == "link") {
        links.push_back(child.get<std::string>("<xmlattr>.name"));
        link_of[links.back()] = child;
      } else if (tag == "joint") {
        joint_above[child.get<std::string>("child.<xmlattr>.link")] = child;
      }
    }
  }

  [[nodiscard]] std::string root() const {
    std::string link = links.front();
    while (joint_above.count(link) != 0) {
      link = parent(link);
    }
    return link;
  }
  [[nodiscard]] std::string parent(const std::string& link) const {
    return joint_above.at(link).get<std::string>("parent.<xmlattr>.link");
  }
  [[nodiscard]] bool follows_another(const std::string& link) const {
    return joint_above.count(link) != 0 && joint_above.at(link).count("mimic") != 0;
  }

  [[nodiscard]] KDL::Chain chain_to(const std::string& link) const {
    if (joint_above.count(link) == 0) {
      return {};
    }
    KDL::Chain chain = chain_to(parent(link));
    chain.addSegment(segment(link));
    return chain;
  }

  /// All links below the root, which has no segment.
  [[nodiscard]] KDL::Tree tree() const {
    KDL::Tree result(root());
    add_below(result, root());
    return result;
  }

  std::vector<std::string> links;
  std::map<std::string, element> joint_above, link_of;

private:
  void add_below(KDL::Tree& tree, const std::string& link) const {
    for (const auto& [child, joint] : joint_above) {
      if (parent(child) == link) {
        REQUIRE(tree.addSegment(segment(child), link));
        add_below(tree, child);
      }
    }
  }

  [[nodiscard]] KDL::Segment segment(const std::string& link) const {
    const element& joint = joint_above.at(link);
    const KDL::Vector rpy = three_numbers(joint, "origin.<xmlattr>.rpy", "0 0 0");
    const KDL::Frame origin(KDL::Rotation::RPY(rpy.x(), rpy.y(), rpy.z()),
                            three_numbers(joint, "origin.<xmlattr>.xyz", "0 0 0"));
    const KDL::Vector axis = origin.M * three_numbers(joint, "axis.<xmlattr>.xyz", "1 0 0");
    const std::string type = joint.get<std::string>("<xmlattr>.type");
    const std::string name = joint.get<std::string>("<xmlattr>.name");
    const KDL::Joint moves =
        type == "fixed"
            ? KDL::Joint(name, KDL::Joint::Fixed)
            : KDL::Joint(name, origin.p, axis,
                         type == "prismatic" ? KDL::Joint::TransAxis : KDL::Joint::RotAxis);
    return KDL::Segment(link, moves, origin);
  }
};

KDL::JntArray as_kdl(const vector& x) {
  KDL::JntArray result(unsigned(x.size()));
  result.data = x;
  return result;
}

Eigen::Matrix4d matrix_of(const KDL::Frame& frame) {
  Eigen::Matrix4d result = Eigen::Matrix4d::Identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 4; ++j) {
      result(i, j) = frame(i, j);
    }
  }
  return result;
}

template <class Chain, class Frame>
double rate_gap(const Chain& arm, const KDL::Chain& other, int representation, const vector& theta,
                const vector& rates, Frame frame_of_rate) {
  KDL::ChainJntToJacDotSolver solver(other);
  solver.setRepresentation(representation);
  KDL::Jacobian expected(other.getNrOfJoints());
  REQUIRE(solver.JntToJacDot(KDL::JntArrayVel(as_kdl(theta), as_kdl(rates)), expected) == 0);
  return max_abs_difference(jacobian_rate(arm, theta, rates, frame_of_rate), expected.data);
}

/// Configurations: zero, straight angles, right angles, then random.
vector configuration(int which, Eigen::Index size, duet_test::random_source& random) {
  vector theta =
      vector::Constant(size, which == 1 ? 3.141592653589793 : 1.5707963267948966 * which / 2);
  if (which > 2) {
    for (double& x : theta) {
      x = random.uniform(-3, 3);
    }
  }
  return theta;
}

/// The folder of robot files; empty if KDL aligns matrices differently from this test, as both free
/// them.
std::optional<std::filesystem::path> robot_files() {
  if (EIGEN_MAX_ALIGN_BYTES > 16) {
    duet_test::skip("Orocos KDL was compiled for matrices aligned to 16 bytes, this is not");
    return std::nullopt;
  }
  return duet_test::outside_data("urdf");
}

} // namespace

TEST_CASE("poses, Jacobians and Jacobian rates of every link agree with Orocos KDL") {
  const auto data = robot_files();
  if (!data) {
    return;
  }
  duet_test::random_source random(3);
  std::map<std::string, int> moving;
  for (const char* name : {"panda", "ur5_robot", "kinova", "tiago_no_hand", "double_pendulum"}) {
    const std::string path = data->string() + "/" + name + ".urdf";
    const description robot(path);
    for (const std::string& link : robot.links) {
      if (robot.follows_another(link)) {
        CHECK(link == "panda_rightfinger");
        continue;
      }
      CAPTURE(link);
      const auto arm = read_urdf(path, robot.root(), link);
      const KDL::Chain other = robot.chain_to(link);
      REQUIRE(unsigned(arm.size()) == other.getNrOfJoints());
      moving[name] = std::max(moving[name], arm.size());
      KDL::ChainFkSolverPos_recursive forward(other);
      KDL::ChainJntToJacSolver by_angles(other);
      for (int which = 0; which < 6 && arm.size() > 0; ++which) {
        const vector theta = configuration(which, arm.size(), random);
        const vector rates = configuration(3, arm.size(), random);
        KDL::Frame tip;
        REQUIRE(forward.JntToCart(as_kdl(theta), tip) == 0);
        CHECK(max_abs_difference(transform_matrix(arm.pose(theta)), matrix_of(tip)) < 1e-12);
        KDL::Jacobian columns(other.getNrOfJoints());
        REQUIRE(by_angles.JntToJac(as_kdl(theta), columns) == 0);
        CHECK(max_abs_difference(jacobian(arm, theta, frame::hybrid), columns.data) < 1e-12);
        using solver = KDL::ChainJntToJacDotSolver;
        CHECK(rate_gap(arm, other, solver::HYBRID, theta, rates, frame::hybrid) < 1e-10);
        CHECK(rate_gap(arm, other, solver::BODYFIXED, theta, rates, frame::body) < 1e-10);
        CHECK(rate_gap(arm, other, solver::INERTIAL, theta, rates, frame::spatial) < 1e-10);
      }
    }
  }
  CHECK(moving["panda"] == 8);
  CHECK(moving["ur5_robot"] == 6);
  CHECK(moving["kinova"] == 6);
  CHECK(moving["tiago_no_hand"] == 8);
  CHECK(moving["double_pendulum"] == 2);
}

TEST_CASE("trees of every robot file agree with Orocos KDL, including mimic joints") {
  const auto data = robot_files();
  if (!data) {
    return;
  }
  duet_test::random_source random(4);
  int frames = 0, followers = 0;
  for (const auto& file : std::filesystem::recursive_directory_iterator(*data)) {
    if (file.path().extension() != ".urdf") {
      continue;
    }
    const std::string path = file.path().string();
    CAPTURE(path);
    const description robot(path);
    const KDL::Tree other = robot.tree();
    const kinematic_tree tree = read_urdf_tree(path);
    REQUIRE(other.getNrOfSegments() + 1 == tree.links().size());
    // Coordinates of KDL's tree as functions of those of duet, q = M y + c.
    Eigen::MatrixXd to_all = Eigen::MatrixXd::Zero(other.getNrOfJoints(), tree.size());
    vector offset = vector::Zero(other.getNrOfJoints());
    for (const auto& [link, joint] : robot.joint_above) {
      if (joint.get<std::string>("<xmlattr>.type") == "fixed") {
        continue;
      }
      const Eigen::Index row = GetTreeElementQNr(other.getSegment(link)->second);
      std::string name = joint.get<std::string>("<xmlattr>.name");
      double multiplier = 1;
      if (const auto mimic = joint.get_child_optional("mimic.<xmlattr>")) {
        name = mimic->get<std::string>("joint");
        multiplier = mimic->get<double>("multiplier", 1);
        offset[row] = mimic->get<double>("offset", 0);
        ++followers;
      }
      to_all(row, tree.coordinate(name)) = multiplier;
    }
    KDL::TreeFkSolverPos_recursive forward(other);
    KDL::TreeJntToJacSolver by_angles(other);
    for (int which = 0; which < 6 && tree.size() > 0; ++which) {
      const vector y = configuration(which, tree.size(), random);
      const auto q = as_kdl(vector(to_all * y + offset));
      const auto poses = tree.poses(y);
      double mass = 0;
      Eigen::Vector3d moment = Eigen::Vector3d::Zero();
      for (const std::string& link : robot.links) {
        CAPTURE(link);
        KDL::Frame expected;
        REQUIRE(forward.JntToCart(q, expected, link) >= 0);
        const int at = tree.link(link).link;
        CHECK(max_abs_difference(transform_matrix(tree.pose(y, at)), matrix_of(expected)) < 1e-12);
        CHECK(max_abs_difference(transform_matrix(poses[std::size_t(at)]), matrix_of(expected)) <
              1e-12);
        KDL::Jacobian columns(other.getNrOfJoints());
        if (link != robot.root()) {
          REQUIRE(by_angles.JntToJac(q, columns, link) >= 0);
        }
        CHECK(max_abs_difference(jacobian(tree, y, frame::hybrid, at),
                                 Eigen::MatrixXd(columns.data * to_all)) < 1e-12);
        ++frames;
        const double weight =
            robot.link_of.at(link).get<double>("inertial.mass.<xmlattr>.value", 0);
        mass += weight;
        const KDL::Vector centre =
            expected *
            three_numbers(robot.link_of.at(link), "inertial.origin.<xmlattr>.xyz", "0 0 0");
        moment += weight * Eigen::Vector3d(centre.x(), centre.y(), centre.z());
      }
      if (mass > 0) {
        CHECK(max_abs_difference(centre_of_mass(tree, y), Eigen::Vector3d(moment / mass)) < 1e-12);
      }
    }
  }
  CHECK(frames >= 6 * 70);
  CHECK(followers >= 1);
}

} // namespace test_kinematics_kdl

#else

#include <doctest/doctest.h>

TEST_CASE("poses, Jacobians and Jacobian rates of every link agree with Orocos KDL") {
  duet_test::skip("Orocos KDL (liborocos-kdl-dev) is not installed");
}

#endif
