// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/core/random_source.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/interop/ceres.hpp>
#include <duet/interop/eigen.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <ceres/autodiff_cost_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/product_manifold.h>
#include <ceres/solver.h>

#include "support/samples.hpp"
#include "support/test.hpp"

// A pose graph on a sphere, as in the usual data sets, of 10 000 poses before a release and of 2500
// otherwise: by cost functions of duet on its manifold, by functors through `duet::cost_function`,
// and by Ceres' own means.

namespace test_interop_ceres_pose_graph {
namespace {

using pose = duet::dual_quaternion<double>;
using vector3 = duet::vector3<double>;
constexpr auto order = duet::quaternion_order::xyzw;

/// Measured pose of b relative to a.
struct edge {
  std::size_t a, b;
  pose measured;
};

/// Error of an edge in Ceres' example of pose graphs: translation, and twice the vector part of the
/// quaternion.
struct edge_error {
  Eigen::Quaterniond rotation;
  Eigen::Vector3d translation;

  template <class T>
  bool operator()(const T* a, const T* b, T* residuals) const {
    using vector = Eigen::Matrix<T, 3, 1>;
    const Eigen::Map<const vector> t_a(a), t_b(b);
    const Eigen::Map<const Eigen::Quaternion<T>> q_a(a + 3), q_b(b + 3);
    const Eigen::Quaternion<T> inverse = q_a.conjugate();
    const Eigen::Quaternion<T> error = rotation.cast<T>() * (inverse * q_b).conjugate();
    Eigen::Map<Eigen::Matrix<T, 6, 1>> r(residuals);
    r.template head<3>() = inverse * vector(t_b - t_a) - translation.cast<T>();
    r.template tail<3>() = T(2) * error.vec();
    return true;
  }
};

class pose_graph {
public:
  static constexpr std::size_t per_ring = 100;
  const std::size_t rings = std::size_t(duet_test::sample_count(100));

  pose_graph() {
    duet::random_source random(1);
    const auto noise = [&](double translation, double rotation) {
      const auto vector = [&](double size) {
        return vector3(size * vector3(random.normal(), random.normal(), random.normal()));
      };
      const vector3 v = vector(translation), omega = vector(rotation);
      return duet::pose(duet::from_rotation_vector(omega), v);
    };
    std::vector<pose> truth;
    for (std::size_t i = 0; i < rings * per_ring; ++i) { // a spiral on a sphere
      const double s = (double(i) + .5) / double(rings * per_ring);
      const double latitude = 3 * (s - .5), longitude = 2 * std::numbers::pi * double(i) / per_ring;
      const auto q = duet::from_rotation_vector(vector3(0, 0, longitude)) *
                     duet::from_rotation_vector(vector3(0, -latitude, 0));
      truth.push_back(duet::pose(q, rotate(q, vector3(50, 0, 0))));
    }
    for (std::size_t i = 0; i + 1 < truth.size(); ++i) {
      add(truth, i, i + 1, noise(.02, .002));
      if (i + per_ring < truth.size()) {
        add(truth, i, i + per_ring, noise(.02, .002));
      }
    }
    start_.push_back(truth[0]);
    for (std::size_t i = 1; i < truth.size(); ++i) {
      start_.push_back(truth[i] * noise(.5, .02));
    }
  }

  /// Final cost of a problem with the given cost functions.
  template <class MakeCost, class MakeManifold>
  ceres::Solver::Summary solved(const MakeCost& make_cost,
                                const MakeManifold& make_manifold) const {
    const duet::pose_block block(order);
    std::vector<std::array<double, 7>> x(start_.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      block.store(start_[i], x[i].data());
    }
    ceres::Problem problem;
    for (const edge& each : edges_) {
      problem.AddResidualBlock(make_cost(each), nullptr, x[each.a].data(), x[each.b].data());
    }
    for (auto& each : x) {
      problem.SetManifold(each.data(), make_manifold());
    }
    problem.SetParameterBlockConstant(x[0].data());
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.function_tolerance = 1e-12;
    options.gradient_tolerance = options.parameter_tolerance = 1e-14;
    options.initial_trust_region_radius = 1e10; // nearly Gauss-Newton steps: 6 iterations, not 14
    options.num_threads = 2;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    return summary;
  }

private:
  void add(const std::vector<pose>& truth, std::size_t a, std::size_t b, const pose& error) {
    edges_.push_back({a, b, conj(truth[a]) * truth[b] * error});
  }

  std::vector<edge> edges_;
  std::vector<pose> start_;
};

edge_error functor_of(const edge& e) {
  return {duet::to_eigen(rotation(e.measured)), translation(e.measured)};
}

TEST_CASE("pose graph: duet's and Ceres' cost functions reach the same cost") {
  const pose_graph graph;
  const auto of_ceres = [] {
    return new ceres::ProductManifold<ceres::EuclideanManifold<3>, ceres::EigenQuaternionManifold>;
  };
  const auto of_duet = [] { return new duet::pose_manifold(order); };
  const auto by_jets = [](const edge& e) {
    return new ceres::AutoDiffCostFunction<edge_error, 6, 7, 7>(new edge_error(functor_of(e)));
  };
  const auto by_functor = [](const edge& e) { return duet::cost_function<6, 7, 7>(functor_of(e)); };
  const auto by_poses = [](const edge& e) {
    const duet::pose_block block(order);
    return duet::cost_function(
        [q = rotation(e.measured), t = translation(e.measured)]<class P>(const P& a, const P& b) {
          using S = typename duet::manifold<P>::scalar;
          const auto relative = conj(a) * b;
          duet::vector6<S> r;
          r << duet::translation(relative) - t.template cast<S>(),
              S(2) * (q * conj(duet::rotation(relative))).vec();
          return r;
        },
        block, block);
  };
  const auto reference = graph.solved(by_jets, of_ceres);
  CHECK(reference.termination_type == ceres::CONVERGENCE);
  CHECK(reference.num_parameter_blocks == int(graph.rings * graph.per_ring));
  CHECK(reference.initial_cost > 1000 * reference.final_cost);
  const auto check = [&](const ceres::Solver::Summary& summary) {
    CHECK(summary.termination_type == ceres::CONVERGENCE);
    CHECK(std::abs(summary.initial_cost - reference.initial_cost) <= 1e-9 * reference.initial_cost);
    CHECK(std::abs(summary.final_cost - reference.final_cost) <= 1e-9 * reference.final_cost);
  };
  check(graph.solved(by_functor, of_ceres));
  check(graph.solved(by_poses, of_duet));
}

} // namespace
} // namespace test_interop_ceres_pose_graph
