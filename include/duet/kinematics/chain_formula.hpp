// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/derivative/frame.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual/level.hpp>
#include <duet/dual_quaternion/displacement.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/recorded.hpp>
#include <duet/kinematics/chain_walk.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Chains as formulas: forward kinematics, geometric Jacobian and its rate, by as few operations as
/// one needs by hand.

namespace duet {

/// Outputs of the formula of a chain beside the pose of its tip.
struct chain_formula_options {
  bool has_jacobian = true;       ///< the geometric Jacobian
  bool has_jacobian_rate = false; ///< its derivative by time, which takes the joint velocities
};

namespace detail {

/// The components of a matrix or vector of a table, where those within round-off of 0 and ±1 are
/// these numbers.
template <class M>
[[nodiscard]] M cleaned_table(M m) {
  constexpr double tolerance = 8 * std::numeric_limits<double>::epsilon();
  for (Eigen::Index i = 0; i < m.size(); ++i) {
    double& x = m.data()[i];
    const double whole = std::round(x);
    x = std::abs(x - whole) <= tolerance && std::abs(whole) <= 1 ? whole + 0.0 : x;
  }
  return m;
}

/// The coordinate axis e_k or −e_k that a unit vector is, by k; −1 for other vectors.
[[nodiscard]] inline int coordinate_axis(const Eigen::Vector3d& n) {
  Eigen::Index k = 0;
  return n.cwiseAbs().maxCoeff(&k) == 1 && n.cwiseAbs().sum() == 1 ? int(k) : -1;
}

/// A frame of a chain as rotation matrix and origin, over recorded numbers or dual numbers of them.
template <class S>
struct recorded_frame {
  Eigen::Matrix<S, 3, 3> rotation = Eigen::Matrix<S, 3, 3>::Identity();
  Eigen::Matrix<S, 3, 1> origin = Eigen::Matrix<S, 3, 1>::Zero();

  /// R x of a vector of the table, which is 0 in most components.
  [[nodiscard]] Eigen::Matrix<S, 3, 1> rotated(const Eigen::Vector3d& x) const {
    Eigen::Matrix<S, 3, 1> result = Eigen::Matrix<S, 3, 1>::Zero();
    for (int k = 0; k < 3; ++k) {
      if (x[k] != 0) {
        result += rotation.col(k) * S(x[k]);
      }
    }
    return result;
  }
  /// Multiplies the rotation by one about an axis of the table, of sine and cosine s and c.
  void rotate(const Eigen::Vector3d& n, const S& s, const S& c) {
    const int k = coordinate_axis(n);
    if (k >= 0) {
      const S sine = n[k] < 0 ? S(-s) : s;
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      const Eigen::Matrix<S, 3, 1> x = rotation.col(i), y = rotation.col(j);
      rotation.col(i) = x * c + y * sine;
      rotation.col(j) = y * c - x * sine;
      return;
    }
    Eigen::Matrix<S, 3, 3> about; // Rodrigues' formula, a constant axis
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const S symmetric = (1 - c) * S(n[i] * n[j]);
        const int other = 3 - i - j;
        about(i, j) = i == j                 ? S(symmetric + c)
                      : (j - i + 3) % 3 == 1 ? S(symmetric - s * S(n[other]))
                                             : S(symmetric + s * S(n[other]));
      }
    }
    multiply(about);
  }
  void multiply(const Eigen::Matrix<S, 3, 3>& m) {
    const Eigen::Matrix<S, 3, 3> product = rotation.lazyProduct(m);
    rotation = product;
  }
  void multiply(const Eigen::Matrix3d& m) {
    const Eigen::Matrix<S, 3, 1> x = rotated(m.col(0)), y = rotated(m.col(1)),
                                 z = rotated(m.col(2));
    rotation << x, y, z;
  }
};

/// The pose of the tip and the Jacobian, an array of columns [v; ω].
template <class S>
struct recorded_chain {
  recorded_frame<S> tip;
  Eigen::Matrix<S, 6, Eigen::Dynamic> jacobian;
};

template <class S, class C>
[[nodiscard]] recorded_chain<S> record_chain(const C& chain, const std::vector<S>& theta,
                                             const FrameConstant auto& frame) {
  using vector = Eigen::Matrix<S, 3, 1>;
  recorded_frame<S> link;
  std::vector<vector> axes, points, velocities;
  for (int i = 0; i < chain.size(); ++i) {
    const auto& step = chain.steps()[std::size_t(i)];
    const Eigen::Vector3d n = cleaned_table(Eigen::Vector3d(step.axis.eigen()));
    const Eigen::Vector3d offset = step.offset.eigen();
    const Eigen::Matrix3d fixed = cleaned_table(Eigen::Matrix3d(rotation_matrix(step.a)));
    const vector axis = link.rotated(n);
    // A point on the axis: without what of the offset is along it, if that makes it simpler.
    const double along = n.dot(offset);
    const Eigen::Vector3d across = coordinate_axis(n) >= 0 ? (offset - along * n).eval() : offset;
    link.origin += link.rotated(across);
    axes.push_back(axis);
    points.push_back(link.origin);
    if (coordinate_axis(n) >= 0 && along != 0) {
      link.origin += axis * S(along);
    }
    if (step.is_translational) {
      link.origin += axis * S(theta[std::size_t(i)] * S(step.pitch));
    }
    if (step.is_rotational) {
      using std::cos;
      using std::sin;
      const S& angle = theta[std::size_t(i)];
      const Eigen::Vector3d in_child = cleaned_table(Eigen::Vector3d(fixed.transpose() * n));
      if (coordinate_axis(n) >= 0 || coordinate_axis(in_child) < 0) {
        link.rotate(n, S(sin(angle)), S(cos(angle)));
        link.multiply(fixed);
      } else {
        link.multiply(fixed);
        link.rotate(in_child, S(sin(angle)), S(cos(angle)));
      }
    } else {
      link.multiply(fixed);
    }
  }
  recorded_chain<S> result{link, {6, chain.size()}};
  const auto& offset = chain.tip().offset;
  result.tip.origin += link.rotated(components(offset.translation).eigen());
  result.tip.multiply(cleaned_table(Eigen::Matrix3d(rotation_matrix(offset.rotation))));
  using frame_type = std::remove_cvref_t<decltype(frame)>;
  const Eigen::Matrix<S, 3, 3> to_body = result.tip.rotation.transpose();
  for (int i = 0; i < chain.size(); ++i) {
    const auto& step = chain.steps()[std::size_t(i)];
    const vector& axis = axes[std::size_t(i)];
    vector omega = vector::Zero(), v = vector::Zero();
    if (step.is_rotational) {
      omega = axis;
      if constexpr (std::is_same_v<frame_type, spatial_frame>) {
        v = points[std::size_t(i)].cross(axis);
      } else {
        v = axis.cross(vector(result.tip.origin - points[std::size_t(i)]));
      }
    }
    if (step.is_translational) {
      v += axis * S(step.pitch);
    }
    if constexpr (std::is_same_v<frame_type, body_frame>) {
      const vector v_body = to_body.lazyProduct(v), omega_body = to_body.lazyProduct(omega);
      v = v_body;
      omega = omega_body;
    }
    result.jacobian.col(i) << v, omega;
  }
  return result;
}

template <class M, class Number>
void add_matrix_output(expression::formula_graph& f, const std::string& name, const M& m,
                       const Number& number) {
  expression::named_value y{.name = name,
                            .kind = expression::shape::matrix,
                            .rows = int(m.rows()),
                            .columns = int(m.cols())};
  for (Eigen::Index j = 0; j < m.cols(); ++j) {
    for (Eigen::Index i = 0; i < m.rows(); ++i) {
      y.nodes.push_back(number(m(i, j)).node_in(f.operations()));
    }
  }
  f.add_output(std::move(y));
}

} // namespace detail

/// The forward kinematics of a chain as a formula: input `theta`, the configuration; outputs
/// `rotation`, a matrix, and `position` of the tip, `jacobian`, the geometric Jacobian with columns
/// [v; ω] in the axes of the frame, and on request `jacobian_rate`, J̇, with the joint velocities as
/// a second input `theta_rate`. Numbers of the table within round-off of 0 and ±1 are taken as
/// these: the pose differs by that from `chain.pose(theta)`.
///
/// \param chain  any serial chain over double, whose number of joints may be known at run time
/// \param frame  `frame::spatial`, `frame::body` or `frame::hybrid`
template <class C, FrameConstant F>
[[nodiscard]] expression::formula_graph formula_of(const C& chain, F frame,
                                                   const chain_formula_options& options = {}) {
  expression::formula_graph f;
  const int n = chain.size();
  const auto numbers = [&](const char* name) {
    std::vector<recorded> result;
    const std::vector<int> nodes =
        f.add_input({.name = name, .kind = expression::shape::matrix, .rows = n}).nodes;
    for (const int node : nodes) {
      result.emplace_back(f.operations(), node);
    }
    return result;
  };
  const std::vector<recorded> theta = numbers("theta");
  const auto itself = [](const recorded& x) { return x; };
  const auto at_theta = detail::record_chain(chain, theta, frame);
  detail::add_matrix_output(f, "rotation", at_theta.tip.rotation, itself);
  detail::add_matrix_output(f, "position", at_theta.tip.origin, itself);
  if (options.has_jacobian) {
    detail::add_matrix_output(f, "jacobian", at_theta.jacobian, itself);
  }
  if (options.has_jacobian_rate) {
    using moving = dual<recorded>;
    const std::vector<recorded> rates = numbers("theta_rate");
    std::vector<moving> moving_theta;
    for (std::size_t i = 0; i < theta.size(); ++i) {
      moving_theta.emplace_back(theta[i], rates[i]);
    }
    detail::add_matrix_output(f, "jacobian_rate",
                              detail::record_chain(chain, moving_theta, frame).jacobian,
                              [](const moving& x) { return x.epsilon(); });
  }
  return f;
}

} // namespace duet
