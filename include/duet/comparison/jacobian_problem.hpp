// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/quaternion_order.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

/// \file
/// A function, its handwritten Jacobian, and the meaning of their numbers. For `judge_jacobian`.

namespace duet {

/// A single slip that explains a wrong Jacobian at all inputs that were tried.
struct jacobian_slip {
  std::string name{};  ///< as "left perturbation for right"
  std::string block{}; ///< what is wrong: as "row 2 of d f / d q"
};

namespace detail {
DUET_ABI_BEGIN

/// An argument or result, or one element of it. Its state is the number, the vector, the quaternion
/// (w first), or the quaternion and then the translation of a pose.
struct jacobian_part {
  enum class kind { number, vector, rotation, pose };
  kind type = kind::number;
  std::string name{};
  Eigen::Index state = 0;     ///< index of its first number in the state
  Eigen::Index first = 0;     ///< index of its first tangent coordinate
  Eigen::Index dimension = 1; ///< number of its tangent coordinates

  [[nodiscard]] bool is_motion() const { return type == kind::rotation || type == kind::pose; }
  [[nodiscard]] Eigen::Index state_size() const { return dimension + (is_motion() ? 1 : 0); }
  /// A translation, a number or a vector: its name, its first number in the state, and its size.
  [[nodiscard]] std::string vector_name() const {
    return type == kind::pose ? name + ".translation" : name;
  }
  [[nodiscard]] Eigen::Index vector_first() const { return type == kind::pose ? state + 4 : state; }
  [[nodiscard]] Eigen::Index vector_size() const { return is_motion() ? dimension - 3 : dimension; }
  /// Index of a translation or a vector of three components in the state; or −1.
  [[nodiscard]] Eigen::Index vector_state() const {
    return type != kind::number && vector_size() == 3 ? vector_first() : -1;
  }
};

using long_matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

/// Value and derivative of a function in tangent coordinates.
struct jacobian_evaluation {
  Eigen::VectorXd value{}; ///< states of the results
  long_matrix jacobian{};
  double error = 0;           ///< estimated error of the derivative, not counting round-off
  long_matrix by_constants{}; ///< with a column for each tangent coordinate of a constant
};

/// A function, its handwritten Jacobian, and what their numbers mean.
struct jacobian_problem {
  std::vector<jacobian_part> arguments{}, results{};
  /// Further arguments, without columns: their tangent coordinates follow the others'.
  std::vector<jacobian_part> constants{};
  std::function<jacobian_evaluation(const Eigen::VectorXd& state)> truth{};
  /// The handwritten matrix as it is returned: with columns for tangent coordinates, or for
  /// stored numbers (quaternions in `order`, poses as [t; q]).
  std::function<Eigen::MatrixXd(const Eigen::VectorXd& state)> written{};
  std::vector<jacobian_part> context{}; ///< further numbers of the state
  /// Constant axes n and numbers t on which the function depends by exp(n t), as joints of an arm.
  std::vector<std::pair<jacobian_part, jacobian_part>> joints{};
  perturbation side = perturbation::right;
  quaternion_order order = quaternion_order::wxyz;

  [[nodiscard]] std::vector<jacobian_part> arguments_and_constants() const {
    std::vector<jacobian_part> all = arguments;
    all.insert(all.end(), constants.begin(), constants.end());
    return all;
  }
};

/// A function and its handwritten Jacobian at one input.
struct jacobian_sample {
  Eigen::VectorXd state{};
  jacobian_evaluation truth{};
  Eigen::MatrixXd exact{};   ///< the derivative, rounded to double
  Eigen::MatrixXd raw{};     ///< as returned
  Eigen::MatrixXd written{}; ///< in tangent coordinates
  Eigen::MatrixXd outer{}; ///< factor A if A times the exact matrix is what is written, else empty
  double allowed = 0;      ///< allowed error of an entry
  bool is_wrong = false;
  /// Error, if it is little beside that at other inputs: it may be that of round-off as well.
  double little_error = 0;
};

[[nodiscard]] inline quaternion<double> rotation_at(const jacobian_part& part,
                                                    const Eigen::VectorXd& state) {
  return normalized(load_quaternion(state.data() + part.state, quaternion_order::wxyz));
}
/// Pose that a state stores; of a rotation, about the origin; of a vector, the rotation by it, or
/// by the last three of its numbers.
[[nodiscard]] inline dual_quaternion<double> pose_at(const jacobian_part& part,
                                                     const Eigen::VectorXd& state) {
  if (part.type == jacobian_part::kind::vector) {
    return dual_quaternion<double>(
        from_rotation_vector(vector3<double>(state.segment<3>(part.state + part.dimension - 3))));
  }
  const quaternion<double> q = rotation_at(part, state);
  return part.type == jacobian_part::kind::pose
             ? pose(q, vector3<double>(state.segment<3>(part.state + 4)))
             : dual_quaternion<double>(q);
}
/// a b. One function for all of them spares the compiler most of Eigen's products.
[[nodiscard]] inline Eigen::MatrixXd product_of(const Eigen::Ref<const Eigen::MatrixXd>& a,
                                                const Eigen::Ref<const Eigen::MatrixXd>& b) {
  return a.lazyProduct(b);
}
[[nodiscard]] inline Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0;
  return m;
}

/// Derivative of the stored numbers with respect to tangent coordinates: of a quaternion 4 × 3, of
/// a pose [t; q] 7 × 6.
[[nodiscard]] inline Eigen::MatrixXd chart_derivative(const jacobian_part& part,
                                                      const Eigen::VectorXd& state,
                                                      perturbation side, quaternion_order order) {
  if (!part.is_motion()) {
    return Eigen::MatrixXd::Identity(part.dimension, part.dimension);
  }
  const quaternion<double> q = rotation_at(part, state);
  Eigen::Matrix<double, 4, 3> by_rotation;
  for (int k = 0; k < 3; ++k) {
    const quaternion<double> half(0, k == 0 ? .5 : 0, k == 1 ? .5 : 0, k == 2 ? .5 : 0);
    const quaternion<double> rate = side == perturbation::right ? q * half : half * q;
    store_quaternion(rate, by_rotation.col(k).data(), order);
  }
  if (part.type == jacobian_part::kind::rotation) {
    return by_rotation;
  }
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(7, 6);
  result.bottomRightCorner<4, 3>() = by_rotation;
  if (side == perturbation::right) {
    result.topLeftCorner<3, 3>() = rotation_matrix(q);
  } else {
    result.topLeftCorner<3, 3>().setIdentity();
    result.topRightCorner<3, 3>() = -cross_matrix(state.segment<3>(part.state + 4));
  }
  return result;
}

/// Number of columns of a Jacobian by stored numbers.
[[nodiscard]] inline Eigen::Index stored_size(const std::vector<jacobian_part>& parts) {
  return parts.empty() ? 0 : parts.back().state + parts.back().state_size();
}
[[nodiscard]] inline Eigen::Index tangent_size(const std::vector<jacobian_part>& parts) {
  return parts.empty() ? 0 : parts.back().first + parts.back().dimension;
}

/// A Jacobian in tangent coordinates from one that may have columns for stored numbers.
[[nodiscard]] inline Eigen::MatrixXd to_tangent(const jacobian_problem& problem,
                                                const Eigen::VectorXd& state,
                                                const Eigen::MatrixXd& raw) {
  const Eigen::Index columns = tangent_size(problem.arguments);
  if (raw.cols() == columns) {
    return raw;
  }
  Eigen::MatrixXd result(raw.rows(), columns);
  for (const jacobian_part& part : problem.arguments) {
    result.middleCols(part.first, part.dimension) =
        product_of(raw.middleCols(part.state, part.state_size()),
                   chart_derivative(part, state, problem.side, problem.order));
  }
  return result;
}

[[nodiscard]] inline double largest_entry(const Eigen::MatrixXd& m) {
  return m.size() > 0 ? m.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() : 0;
}

/// True if no entry of an error exceeds `allowed` plus `relative` times the largest size in its row
/// or its column, of whichever is less. The round-off of D A B E, with diagonal D and E for units,
/// keeps that bound if `relative` exceeds some ulps times the condition number of A or B.
[[nodiscard]] inline bool is_within(const Eigen::MatrixXd& error, double allowed, double relative,
                                    const Eigen::MatrixXd& sizes, const Eigen::MatrixXd& others) {
  Eigen::VectorXd rows = Eigen::VectorXd::Zero(error.rows());
  Eigen::VectorXd columns = Eigen::VectorXd::Zero(error.cols());
  for (Eigen::Index k = 0; k < error.cols(); ++k) {
    for (Eigen::Index i = 0; i < error.rows(); ++i) {
      const double size = std::max(std::abs(sizes(i, k)), std::abs(others(i, k)));
      rows[i] = std::max(rows[i], size);
      columns[k] = std::max(columns[k], size);
    }
  }
  for (Eigen::Index k = 0; k < error.cols(); ++k) {
    for (Eigen::Index i = 0; i < error.rows(); ++i) {
      if (!(std::abs(error(i, k)) <= allowed + relative * std::min(rows[i], columns[k]))) {
        return false;
      }
    }
  }
  return true;
}

/// The X of least norm that minimises |A X − B|, by the singular values of A (one-sided Jacobi
/// method); singular values below 1e-13 of the largest count as zero. One function for all systems,
/// as decompositions of Eigen take seconds to compile.
[[nodiscard]] inline Eigen::MatrixXd least_norm_solution(Eigen::MatrixXd a,
                                                         const Eigen::MatrixXd& b) {
  const double scale = largest_entry(a) > 0 ? largest_entry(a) : 1;
  a *= 1 / scale;
  const double total = a.squaredNorm();
  const Eigen::Index n = a.cols();
  Eigen::MatrixXd v = Eigen::MatrixXd::Identity(n, n); // A = a vᵀ
  const auto rotate_columns = [](Eigen::MatrixXd& m, Eigen::Index i, Eigen::Index k, double c,
                                 double s) {
    for (Eigen::Index row = 0; row < m.rows(); ++row) {
      const double x = m(row, i), y = m(row, k);
      m(row, i) = c * x - s * y;
      m(row, k) = s * x + c * y;
    }
  };
  bool is_orthogonal = false;
  for (int sweep = 0; sweep < 30 && !is_orthogonal; ++sweep) {
    is_orthogonal = true;
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index k = i + 1; k < n; ++k) {
        const double x = a.col(i).squaredNorm(), y = a.col(k).squaredNorm();
        const double product = a.col(i).dot(a.col(k));
        if (std::abs(product) > 1e-15 * std::sqrt(x * y) && std::abs(product) > 1e-30 * total) {
          const double cotangent = (y - x) / (2 * product); // of twice the angle
          const double t =
              (cotangent < 0 ? -1 : 1) / (std::abs(cotangent) + std::hypot(1., cotangent));
          const double c = 1 / std::hypot(1., t);
          rotate_columns(a, i, k, c, c * t);
          rotate_columns(v, i, k, c, c * t);
          is_orthogonal = false;
        }
      }
    }
  }
  const Eigen::VectorXd squares = a.colwise().squaredNorm().transpose();
  const double least = 1e-26 * largest_entry(squares);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, b.cols());
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!(squares[i] <= least)) {
      for (Eigen::Index k = 0; k < b.cols(); ++k) {
        result.col(k) += a.col(i).dot(b.col(k)) / (scale * squares[i]) * v.col(i);
      }
    }
  }
  return result;
}
/// The X of least norm that minimises |X by − m|.
[[nodiscard]] inline Eigen::MatrixXd divided(const Eigen::MatrixXd& m, const Eigen::MatrixXd& by) {
  return least_norm_solution(by.transpose(), m.transpose()).transpose();
}

DUET_ABI_END
} // namespace detail
} // namespace duet
