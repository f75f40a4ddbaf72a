// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/derivative/frame.hpp>
#include <duet/derivative/manifold.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/spline/motion_jacobian.hpp>
#include <duet/spline/product_jacobian.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <limits>

/// \file
/// Derivatives of a curve with respect to its knots.

namespace duet {

/// Derivatives of the value and the rates of a curve with respect to the 2k − 2 knots that act on a
/// span, control points fixed.
///
/// Knots keep their order: the first of several equal knots moves down, the last up. For order 3
/// and more, a knot of multiplicity k − 1 or more, as at every clamped end, has no derivative: its
/// columns are NaN.
template <class T, int Order>
struct knot_jacobian_result {
  static constexpr int dimension = manifold<quaternion<T>>::dimension;
  static constexpr int count = 2 * Order - 2; ///< number of knots
  using matrix_type = Eigen::Matrix<typename manifold<quaternion<T>>::scalar, dimension, count>;
  std::size_t first = 0; ///< number of the first of these knots
  /// Element m is false if the derivative with respect to knot first + m does not exist.
  std::array<bool, std::size_t(count)> exists = {};
  /// Derivatives of the value; column m with respect to knot first + m.
  matrix_type value = detail::zero_initialized<matrix_type>();
  matrix_type velocity = value;     ///< of the velocity
  matrix_type acceleration = value; ///< of the acceleration
  matrix_type jerk = value;         ///< of the jerk, on this span
};

namespace detail {

/// Derivatives 0 to 3 at u of the B-spline of order k over k + 1 knots, its piece on the span that
/// begins at `low`: the Cox–de Boor recurrence (P1, P4).
template <int Order, class R>
[[nodiscard]] std::array<R, 4> bspline_piece(const std::array<R, std::size_t(Order) + 1>& knots,
                                             const R& low, const R& u) {
  std::array<std::array<R, std::size_t(Order)>, 4> b{}; // [d][l], order 1
  for (std::size_t l = 0; l < std::size_t(Order); ++l) {
    b[0][l] = R(knots[l] == low && low < knots[l + 1] ? 1 : 0);
  }
  for (std::size_t r = 2; r <= std::size_t(Order); ++r) {
    auto next = decltype(b){};
    for (std::size_t l = 0; l + r <= std::size_t(Order); ++l) {
      const R left = knots[l + r - 1] - knots[l], right = knots[l + r] - knots[l + 1];
      if (left > 0) {
        next[0][l] += (u - knots[l]) / left * b[0][l];
      }
      if (right > 0) {
        next[0][l] += (knots[l + r] - u) / right * b[0][l + 1];
      }
      for (std::size_t d = 1; d < 4; ++d) {
        if (left > 0) {
          next[d][l] += R(r - 1) / left * b[d - 1][l];
        }
        if (right > 0) {
          next[d][l] -= R(r - 1) / right * b[d - 1][l + 1];
        }
      }
    }
    b = next;
  }
  return {b[0][0], b[1][0], b[2][0], b[3][0]};
}

/// Derivatives with respect to the knots t_m of a span: weight j changes by
///   ∂b_j^(d)/∂t_m = −N^(d)(u; t_j … t_m, t_m … t_{j+k−1})/(t_{j+k−1} − t_j),
/// N the B-spline of order k over the k knots of b_j with t_m doubled. With β_j = ∂b_j/∂t_m the
/// value moves by σ = Σ_j β_j Φ_j and the rates by dw = σ′ + w × σ and its derivatives.
///
/// \param knots  t_0 … t_{2k−3}; the span begins at t_{k−2}
template <class T, int Order, class R, class Weights, class Frame>
[[nodiscard]] DUET_OUT_OF_LINE knot_jacobian_result<T, Order>
knot_jacobian_of_product(const quaternion<T>* controls, const vector3<T>* increments,
                         const R* knots, const R& u, const Weights& weights, Frame,
                         perturbation side) {
  constexpr std::size_t factors = std::size_t(Order) - 1, count = 2 * factors;
  constexpr std::size_t triples = (count + 2) / 3; // knots, each a column of a block
  using vector = three_vector<T>;
  const functions_of_factors<T, factors> functions(weights[0], increments);
  tail_vectors<T, factors> tails(controls[0], increments, functions);
  tails.add_rates(weights);
  const R two(2), three(3);
  const T zero(0);

  std::array<std::array<vector, 4>, 3 * triples> columns; // σ and the changes of the rates
  knot_jacobian_result<T, Order> result;
  for (std::size_t m = 0; m < 3 * triples; ++m) {
    std::array<vector, 4> sigma; // and its derivatives
    sigma.fill({zero, zero, zero});
    for (std::size_t j = 0; j < factors && m < count; ++j) {
      if (m < j || m > j + factors) {
        continue;
      }
      std::array<R, std::size_t(Order) + 1> doubled;
      for (std::size_t l = 0; l <= std::size_t(Order); ++l) {
        doubled[l] = knots[j + (j + l > m ? l - 1 : l)];
      }
      auto beta = bspline_piece<Order>(doubled, knots[factors - 1], u);
      for (R& x : beta) {
        x = -x / (knots[j + factors] - knots[j]);
      }
      const auto& v = tails.velocity[j];
      const vector phi = two * tails.omega[j];
      const vector phi_1 = cross(phi, v[0]);
      const vector phi_2 = cross(phi_1, v[0]) + cross(phi, v[1]);
      const vector phi_3 = cross(phi_2, v[0]) + two * cross(phi_1, v[1]) + cross(phi, v[2]);
      sigma[0] = sigma[0] + beta[0] * phi;
      sigma[1] = sigma[1] + beta[1] * phi + beta[0] * phi_1;
      sigma[2] = sigma[2] + beta[2] * phi + R(two * beta[1]) * phi_1 + beta[0] * phi_2;
      sigma[3] = sigma[3] + beta[3] * phi + R(three * beta[2]) * phi_1 +
                 R(three * beta[1]) * phi_2 + beta[0] * phi_3;
    }
    const auto& [w, a, j, s] = tails.rates;
    columns[m] = {sigma[0], sigma[1] + cross(w, sigma[0]),
                  sigma[2] + cross(a, sigma[0]) + cross(w, sigma[1]),
                  sigma[3] + cross(j, sigma[0]) + two * cross(a, sigma[1]) + cross(w, sigma[2])};
  }

  curve_jacobian<T, int(triples), 3, Frame> blocks;
  const block_pointers<3, T> pointers = pointers_to_blocks(blocks);
  for (std::size_t d = 0; d < 4; ++d) {
    for (std::size_t i = 0; i < triples; ++i) {
      const vector &x = columns[3 * i][d], &y = columns[3 * i + 1][d], &z = columns[3 * i + 2][d];
      pointers[d][i] = {matrix_row<T>::of(x.x, y.x, z.x), matrix_row<T>::of(x.y, y.y, z.y),
                        matrix_row<T>::of(x.z, y.z, z.z)};
    }
  }
  set_frame(blocks, side, tails.value, tails.rates,
            [](std::size_t) { return diagonal_rows<T>(T(1)); });
  using S = typename manifold<quaternion<T>>::scalar;
  for (std::size_t m = 0; m < count; ++m) {
    std::size_t multiplicity = 0;
    for (std::size_t l = 0; l < count; ++l) {
      multiplicity += knots[l] == knots[m] ? 1 : 0;
    }
    result.exists[m] = Order == 2 || multiplicity < factors;
    const auto column = [&](const auto& of) {
      const Eigen::Matrix<S, manifold<quaternion<T>>::dimension, 1> tangent =
          of.block(int(m / 3)).template rightCols<3>().col(Eigen::Index(m % 3));
      return result.exists[m]
                 ? tangent
                 : decltype(tangent)::Constant(S(std::numeric_limits<R>::quiet_NaN())).eval();
    };
    result.value.col(Eigen::Index(m)) = column(blocks.value);
    result.velocity.col(Eigen::Index(m)) = column(blocks.velocity);
    result.acceleration.col(Eigen::Index(m)) = column(blocks.acceleration);
    result.jerk.col(Eigen::Index(m)) = column(blocks.jerk);
  }
  return result;
}

} // namespace detail
} // namespace duet
