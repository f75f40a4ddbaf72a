// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/derivative/manifold.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual/tag.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/tangent.hpp>
#include <duet/spline/basis.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

/// \file
/// How far rows are from a cumulative B-spline, and how that changes with its control elements.

namespace duet::detail {

/// The residuals of rows at given parameters, over the control elements of the curve.
template <class T, int Order>
class bspline_residuals {
protected:
  using R = real_type_t<T>;
  using element = quaternion<T>;
  static constexpr int dimension = manifold<element>::dimension;
  static constexpr int unknowns = Order * dimension;
  using D = dual<R, dimension, derivative_tag<bspline_residuals>>; // one control element at a time
  template <class S>
  using tangent = Eigen::Matrix<S, dimension, 1>;
  using basis_type = bspline_basis<Order, R>;

  bspline_residuals(const basis_type& basis, const std::vector<R>& u, std::vector<element> rows,
                    const R& length)
      : rows_(std::move(rows)), length_(length) {
    for (const R& parameter : u) {
      const std::size_t span = basis.span_of(parameter);
      first_.push_back(basis.first_function(span));
      weights_.push_back(basis.template weights<0>(span, parameter)[0]);
    }
  }

  [[nodiscard]] const std::vector<element>& rows() const { return rows_; }
  /// Row by row the first control element that it depends on; `Order` of them.
  [[nodiscard]] const std::vector<std::size_t>& first() const { return first_; }

  /// The norm, without overflow.
  [[nodiscard]] static R size_of(const tangent<R>& r) {
    const R norm = r.norm();
    return norm <= std::numeric_limits<R>::max() ? norm : R(r.stableNorm());
  }

  [[nodiscard]] std::vector<R> residuals(const std::vector<element>& controls) const {
    std::vector<R> result;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      result.push_back(size_of(residual_at(i, controls)));
    }
    return result;
  }

  /// 2 log(S* Q), the shorter way; of poses [v/length; ω].
  template <class S>
  [[nodiscard]] tangent<S> residual(std::size_t i,
                                    const std::array<quaternion<promote_t<T, S>>, Order>& c) const {
    using P = promote_t<T, S>;
    quaternion<P> value = c[0];
    for (std::size_t j = 0; j + 1 < c.size(); ++j) {
      const vector3<P> increment = log(conj(c[j]) * c[j + 1]).vec();
      value = value * duet::exp(vector3<P>(increment * P(weights_[i][j])));
    }
    quaternion<P> error = conj(value) * quaternion<P>(rows_[i]);
    if (innermost(error.w()) < 0) {
      error = -error;
    }
    const vector3<P> half = log(error).vec();
    if constexpr (dimension == 3) {
      return half * S(R(2));
    } else {
      vector6<S> r = twist_of<S>(half) * S(R(2));
      r.template head<3>() /= S(length_);
      return r;
    }
  }

  [[nodiscard]] tangent<R> residual_at(std::size_t i, const std::vector<element>& controls) const {
    std::array<element, Order> c;
    std::copy_n(controls.begin() + std::ptrdiff_t(first_[i]), Order, c.begin());
    return residual<R>(i, c);
  }

  struct linear_residual {
    tangent<R> value;
    Eigen::Matrix<R, dimension, unknowns> slope;
  };

  [[nodiscard]] linear_residual linearised(std::size_t i,
                                           const std::vector<element>& controls) const {
    linear_residual result;
    std::array<quaternion<promote_t<T, D>>, Order> c;
    std::copy_n(controls.begin() + std::ptrdiff_t(first_[i]), Order, c.begin());
    tangent<D> delta;
    for (int b = 0; b < dimension; ++b) {
      delta[b] = D::variable(R(0), b);
    }
    for (int j = 0; j < Order; ++j) {
      const element& control = controls[first_[i] + std::size_t(j)];
      c[std::size_t(j)] = manifold<element>::plus(control, delta, frame::body);
      const tangent<D> r = residual<D>(i, c);
      c[std::size_t(j)] = quaternion<promote_t<T, D>>(control);
      for (int a = 0; a < dimension; ++a) {
        result.value[a] = r[a].value();
        for (int b = 0; b < dimension; ++b) {
          result.slope(a, dimension * j + b) = r[a].partial(b);
        }
      }
    }
    return result;
  }

private:
  std::vector<element> rows_;
  R length_;
  std::vector<std::size_t> first_;
  std::vector<std::array<R, std::size_t(Order) - 1>> weights_;
};

} // namespace duet::detail
