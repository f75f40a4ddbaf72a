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
    last_span last;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      result.push_back(size_of(residual_at(i, controls, last)));
    }
    return result;
  }

  /// What rows on one span have in common: the control element at its start, and the increments.
  template <class P>
  struct segment {
    quaternion<P> start;
    std::array<vector3<P>, std::size_t(Order) - 1> increments;

    explicit segment(const std::array<quaternion<P>, std::size_t(Order)>& c) : start(c[0]) {
      for (std::size_t j = 0; j + 1 < c.size(); ++j) {
        increments[j] = log(conj(c[j]) * c[j + 1]).vec();
      }
    }
  };
  /// The caller's memory of the span that the last row was on, for as long as the control elements
  /// stay as they are: its segment, and the same with tangents at one of these elements each.
  struct last_span {
    std::size_t first = std::size_t(-1);
    std::vector<segment<T>> numbers;
    std::vector<segment<promote_t<T, D>>> varied;
  };

  /// 2 log(S* Q), the shorter way; of poses [v/length; ω].
  /// \param factor  factor(j) is exp of the j-th increment times its weight
  template <class S, class P, class F>
  [[nodiscard]] tangent<S> residual(std::size_t i, quaternion<P> value, const F& factor) const {
    for (std::size_t j = 0; j + 1 < std::size_t(Order); ++j) {
      value = value * factor(j);
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
  template <class P>
  [[nodiscard]] quaternion<P> factor(std::size_t i, const segment<P>& s, std::size_t j) const {
    return duet::exp(vector3<P>(s.increments[j] * P(weights_[i][j])));
  }

  [[nodiscard]] tangent<R> residual_at(std::size_t i, const std::vector<element>& controls,
                                       last_span& last) const {
    if (last.first != first_[i]) {
      last.first = first_[i];
      last.numbers.assign(1, segment<T>(controls_at(controls, last.first)));
    }
    const segment<T>& s = last.numbers[0];
    return residual<R>(i, s.start, [&](std::size_t j) { return factor(i, s, j); });
  }

  struct linear_residual {
    tangent<R> value;
    Eigen::Matrix<R, dimension, unknowns> slope;
  };

  [[nodiscard]] linear_residual linearised(std::size_t i, const std::vector<element>& controls,
                                           last_span& last) const {
    using P = promote_t<T, D>;
    if (last.first != first_[i]) {
      vary(controls, first_[i], last);
    }
    std::array<quaternion<P>, std::size_t(Order) - 1> numbers;
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      numbers[k] = quaternion<P>(factor(i, last.numbers[0], k));
    }
    linear_residual result;
    for (std::size_t j = 0; j < std::size_t(Order); ++j) {
      const segment<P>& s = last.varied[j];
      // A control element is in the increments on both of its sides alone.
      const tangent<D> r = residual<D>(i, s.start, [&](std::size_t k) {
        return k == j || k + 1 == j ? factor(i, s, k) : numbers[k];
      });
      for (int a = 0; a < dimension; ++a) {
        result.value[a] = r[a].value();
        for (int b = 0; b < dimension; ++b) {
          result.slope(a, dimension * int(j) + b) = r[a].partial(b);
        }
      }
    }
    return result;
  }

private:
  [[nodiscard]] static std::array<element, std::size_t(Order)>
  controls_at(const std::vector<element>& controls, std::size_t first) {
    std::array<element, std::size_t(Order)> c;
    std::copy_n(controls.begin() + std::ptrdiff_t(first), Order, c.begin());
    return c;
  }

  void vary(const std::vector<element>& controls, std::size_t first, last_span& last) const {
    const auto numbers = controls_at(controls, first);
    std::array<quaternion<promote_t<T, D>>, std::size_t(Order)> c;
    std::copy(numbers.begin(), numbers.end(), c.begin());
    tangent<D> delta;
    for (int b = 0; b < dimension; ++b) {
      delta[b] = D::variable(R(0), b);
    }
    last.first = first;
    last.numbers.assign(1, segment<T>(numbers));
    last.varied.clear();
    for (std::size_t j = 0; j < std::size_t(Order); ++j) {
      c[j] = manifold<element>::plus(numbers[j], delta, frame::body);
      last.varied.emplace_back(c);
      c[j] = quaternion<promote_t<T, D>>(numbers[j]);
    }
  }

  std::vector<element> rows_;
  R length_;
  std::vector<std::size_t> first_;
  std::vector<std::array<R, std::size_t(Order) - 1>> weights_;
};

} // namespace duet::detail
