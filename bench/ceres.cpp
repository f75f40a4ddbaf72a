// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Cost functions of Ceres: one evaluation with all Jacobian blocks, by `duet::cost_function` and
/// by `ceres::AutoDiffCostFunction`. The reprojection error of a camera of nine parameters is one
/// functor for both; the error of a relative pose is written with poses of duet and, for Jets, with
/// ceres/rotation.h and Eigen, both without the sign of quaternions.

#if DUET_BENCH_CERES

#include "support/contest.hpp"

#include <duet/interop/ceres.hpp>
#include <duet/interop/eigen.hpp>

#include <ceres/autodiff_cost_function.h>
#include <ceres/rotation.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <type_traits>

namespace duet_bench {
namespace {

/// Reprojection error of bundle adjustment: rotation vector, translation, focal length, two
/// coefficients of radial distortion; a point.
struct reprojection_error {
  double u, v;

  template <class T>
  bool operator()(const T* camera, const T* point, T* residuals) const {
    T p[3];
    ceres::AngleAxisRotatePoint(camera, point, p);
    p[0] += camera[3];
    p[1] += camera[4];
    p[2] += camera[5];
    const T x = -p[0] / p[2], y = -p[1] / p[2];
    const T square = x * x + y * y;
    const T scale = camera[6] * (1.0 + square * (camera[7] + camera[8] * square));
    residuals[0] = scale * x - u;
    residuals[1] = scale * y - v;
    return true;
  }
};

const Eigen::Quaterniond measured_rotation(.8, .2, -.4, .4); // w first
const Eigen::Vector3d measured_translation(1, 2, -.5);

/// Error of a relative pose [t; q], q in the order x, y, z, w, as in Ceres' example of pose graphs.
struct relative_pose_error {
  template <class T>
  bool operator()(const T* a, const T* b, T* residuals) const {
    using vector = Eigen::Matrix<T, 3, 1>;
    using rotation = Eigen::Quaternion<T>;
    const Eigen::Map<const vector> t_a(a), t_b(b);
    const Eigen::Map<const rotation> q_a(a + 3), q_b(b + 3);
    const rotation inverse = q_a.conjugate();
    const rotation relative = inverse * q_b;
    const vector t = inverse * (t_b - t_a);
    const rotation error = measured_rotation.cast<T>() * relative.conjugate();
    Eigen::Map<Eigen::Matrix<T, 6, 1>> r(residuals);
    r.template head<3>() = t - measured_translation.cast<T>();
    r.template tail<3>() = T(2) * error.vec();
    return true;
  }
};

/// All Jacobian blocks of one evaluation, one after the other, then the residuals.
template <int Residuals, int... Sizes>
class evaluation {
  static constexpr int size = (Sizes + ...);

public:
  using inputs = std::array<double, std::size_t(size)>;
  using result = std::array<double, std::size_t(Residuals*(size + 1))>;

  explicit evaluation(ceres::CostFunction* cost) : cost_(cost) {}

  result operator()(const inputs& x) const {
    result y;
    std::array<const double*, sizeof...(Sizes)> blocks;
    std::array<double*, sizeof...(Sizes)> jacobians;
    const double* block = x.data();
    double* jacobian = y.data();
    std::size_t i = 0;
    ((blocks[i] = block, jacobians[i] = jacobian, block += Sizes, jacobian += Residuals * Sizes,
      ++i),
     ...);
    cost_->Evaluate(blocks.data(), jacobian, jacobians.data());
    return y;
  }

private:
  std::shared_ptr<const ceres::CostFunction> cost_;
};

const bool registered = [] {
  const auto inputs = []<std::size_t N>(std::array<double, N> x) {
    for (std::size_t i = 0; i < N; ++i) {
      x[i] = 0.3 + 0.9 * std::sin(1.0 + double(i));
    }
    return x;
  };
  {
    const reprojection_error f{.3, -.2};
    using camera = evaluation<2, 9, 3>;
    const camera duet(duet::cost_function<2, 9, 3>(f));
    const camera jets(
        new ceres::AutoDiffCostFunction<reprojection_error, 2, 9, 3>(new reprojection_error(f)));
    const auto x = inputs(camera::inputs{});
    expect_agreement("reprojection", "ceres", duet(x), jets(x));
    register_benchmark("reprojection", "duet", x, duet);
    register_benchmark("reprojection", "ceres", x, jets);
  }
  {
    using edge = evaluation<6, 7, 7>;
    const auto measured = duet::pose(duet::from_eigen(measured_rotation), measured_translation);
    const duet::pose_block block(duet::quaternion_order::xyzw);
    const edge poses(duet::cost_function(
        [measured](const auto& a, const auto& b) {
          const auto relative = conj(a) * b;
          const auto t = translation(relative);
          const auto error = rotation(measured) * conj(rotation(relative));
          Eigen::Matrix<std::decay_t<decltype(t[0])>, 6, 1> r;
          r << t - translation(measured), 2 * error.vec();
          return r;
        },
        block, block));
    const edge functor(duet::cost_function<6, 7, 7>(relative_pose_error{}));
    const edge jets(
        new ceres::AutoDiffCostFunction<relative_pose_error, 6, 7, 7>(new relative_pose_error));
    auto x = inputs(edge::inputs{});
    for (double* q : {x.data() + 3, x.data() + 10}) {
      Eigen::Map<Eigen::Vector4d>(q).normalize();
    }
    expect_agreement("relative_pose_functor", "ceres", functor(x), jets(x));
    register_benchmark("relative_pose", "duet", x, poses);
    register_benchmark("relative_pose", "ceres", x, jets);
    register_benchmark("relative_pose_functor", "duet", x, functor);
    register_benchmark("relative_pose_functor", "ceres", x, jets);
  }
  return true;
}();

} // namespace
} // namespace duet_bench

#endif
